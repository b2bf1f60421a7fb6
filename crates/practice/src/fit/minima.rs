//! Minima along a line of a grid, and which of them are minima of the plane: those that are not
//! above those to which one descends in the neighbouring lines.

/// A minimum along a line of the inner axis.
#[derive(Clone, Copy, Debug)]
pub struct LineMinimum {
    /// The first and the last of the places of the inner axis with the least misfit around.
    pub nodes: (usize, usize),
    /// The coordinate of the inner axis; 0 if there is none.
    pub at: f64,
    pub misfit: f64,
}

/// One line of the inner axis.
#[derive(Clone, Debug)]
pub struct Line {
    /// The coordinate of the outer axis.
    pub at: f64,
    /// The index of the minimum to which one descends from each place of the inner axis.
    pub basins: Vec<usize>,
    pub minima: Vec<LineMinimum>,
}

/// Whether two misfits differ by no more than rounding.
fn equal(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * (1.0 + a.abs().max(b.abs()))
}

impl Line {
    /// The least minimum, of which each line has one at least.
    pub fn best(&self) -> LineMinimum {
        let least = |a: &LineMinimum, b: &LineMinimum| a.misfit.total_cmp(&b.misfit);
        let nowhere = LineMinimum { nodes: (0, 0), at: f64::NAN, misfit: f64::NAN };
        self.minima.iter().copied().min_by(least).unwrap_or(nowhere)
    }
}

/// The lowest places of a list, as runs of equal values with higher ones, or the end, on both
/// sides; and for each place the index of the run to which one descends from there.
pub fn bottoms(values: &[f64]) -> (Vec<(usize, usize)>, Vec<usize>) {
    let ends =
        (0..values.len()).filter(|&i| i + 1 == values.len() || !equal(values[i], values[i + 1]));
    let mut runs = Vec::new();
    for last in ends {
        let first = runs.last().map_or(0, |&(_, last): &(usize, usize)| last + 1);
        runs.push((first, last));
    }
    // Whoever has gone on to a lower run never turns back: every way comes to an end.
    let next = |run: usize| {
        let (first, last) = runs[run];
        let left = first.checked_sub(1).map_or(0.0, |i| values[first] - values[i]);
        let right = values.get(last + 1).map_or(0.0, |value| values[last] - value);
        if left > 0.0 && left >= right {
            run - 1
        } else if right > 0.0 {
            run + 1
        } else {
            run
        }
    };
    let (mut found, mut lowest) = (Vec::new(), Vec::new());
    let mut ways = vec![0; runs.len()];
    for run in 0..runs.len() {
        let mut at = run;
        while next(at) != at {
            at = next(at);
        }
        ways[run] = at;
        if at == run {
            found.push(run);
            lowest.push(runs[run]);
        }
    }
    let mut basins = Vec::with_capacity(values.len());
    for (run, (first, last)) in runs.iter().enumerate() {
        let basin = found.iter().position(|&bottom| bottom == ways[run]).unwrap_or(0);
        basins.extend(std::iter::repeat_n(basin, last + 1 - first));
    }
    (lowest, basins)
}

/// The minima of the plane among those of its lines, as coordinates of the outer and the inner
/// axis. Of equal ones in successive lines, as on a plain, the last one counts.
pub fn candidates(lines: &[Line]) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    // Whether each minimum of the line before is reached from above.
    let mut reached: Vec<bool> = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let neighbour = |other: Option<usize>, minimum: &LineMinimum| {
            let line = lines.get(other?)?;
            let place = *line.basins.get(minimum.nodes.0)?;
            Some((place, line.minima.get(place)?.misfit))
        };
        let mut now = Vec::with_capacity(line.minima.len());
        for minimum in &line.minima {
            let from_above = match neighbour(index.checked_sub(1), minimum) {
                Some((place, misfit)) if equal(misfit, minimum.misfit) => {
                    reached.get(place).copied().unwrap_or(true)
                }
                Some((_, misfit)) => misfit > minimum.misfit,
                None => true,
            };
            let rises = neighbour(Some(index + 1), minimum).is_none_or(|(_, misfit)| {
                misfit > minimum.misfit && !equal(misfit, minimum.misfit)
            });
            if from_above && rises {
                found.push([line.at, minimum.at]);
            }
            now.push(from_above);
        }
        reached = now;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bottoms_of_lists() {
        let found = bottoms(&[3.0, 1.0, 2.0, 2.0, 5.0, 0.0]);
        assert_eq!(found, (vec![(1, 1), (5, 5)], vec![0, 0, 0, 0, 1, 1]));
        assert_eq!(bottoms(&[1.0, 1.0, 1.0]), (vec![(0, 2)], vec![0, 0, 0]));
        assert_eq!(bottoms(&[1.0, 2.0, 2.0, 1.0]).0, [(0, 0), (3, 3)]);
        assert_eq!(bottoms(&[]), (vec![], vec![]));
        // Steps that are rounding, down and up again.
        let slope: Vec<f64> = (0..9).map(|i| 1.0 - 1e-13 * f64::from((i - 4) * (i - 4))).collect();
        assert_eq!(bottoms(&slope), (vec![(0, 8)], vec![0; 9]));
    }

    /// Lines of a surface with its minima at places, without refinement.
    fn lines(surface: impl Fn(f64, f64) -> f64) -> Vec<Line> {
        let line = |x: usize| {
            let misfits: Vec<f64> = (0..40).map(|y| surface(x as f64, f64::from(y))).collect();
            let minimum = |nodes: (usize, usize)| LineMinimum {
                nodes,
                at: nodes.0 as f64,
                misfit: misfits[nodes.0],
            };
            let (bottoms, basins) = bottoms(&misfits);
            let minima = bottoms.into_iter().map(minimum).collect();
            Line { at: x as f64, basins, minima }
        };
        (0..40).map(line).collect()
    }

    #[test]
    fn minima_of_surfaces() {
        let bowls = |x: f64, y: f64| {
            let bowl = |a: f64, b: f64, c: f64| (x - a).powi(2) + (y - b).powi(2) + c;
            bowl(8.0, 9.0, 1.0).min(bowl(30.0, 8.0, 2.0)).min(bowl(21.0, 33.0, 0.0))
        };
        let mut found = candidates(&lines(bowls));
        found.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(found, [[8.0, 9.0], [21.0, 33.0], [30.0, 8.0]]);
        // A plain is one minimum.
        assert_eq!(candidates(&lines(|_, _| 1.0)), [[39.0, 0.0]]);
        // The bottom of a valley that falls to one end.
        let valley = |x: f64, y: f64| (y - 20.0).powi(2) - x;
        assert_eq!(candidates(&lines(valley)), [[39.0, 20.0]]);
    }
}
