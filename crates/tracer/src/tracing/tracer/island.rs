//! Closed boundaries between the places of a grid: margins whose minima are below zero.

use nalgebra::Matrix2;

use crate::family::{Family, FreeRun};
use crate::inverse;
use crate::tracing::corrector::derivatives;
use crate::tracing::runs::{Runs, Sampled, Traced};
use crate::window::Point;

/// Segments from a place of the grid to places nearby where a margin has the other sign.
///
/// A search starts for each margin that is closer to zero than at the neighbours. If it crosses no
/// boundary that `is_known`, more boundaries of the same margin may be as near; then searches start
/// from the places around too. `grid` holds columns of `rows` places each; `cell` is the distance
/// between neighbours.
pub(crate) fn beside<F: Family>(
    runs: &Runs<'_, F>,
    grid: &[Sampled<F>],
    rows: usize,
    index: usize,
    cell: &Point,
    is_known: impl Fn(&[Point; 2]) -> bool,
) -> Traced<Vec<[Point; 2]>, F> {
    let (point, run) = &grid[index];
    let mut found = Vec::new();
    for (margin, value) in &run.margins {
        if *value != 0.0
            && is_least(grid, rows, index, margin, *value)
            && let Some(low) = dive(runs, point, margin, *value, cell)?
        {
            found.push([*point, low]);
            if is_known(&[*point, low]) {
                continue;
            }
            for (start, value) in around(grid, rows, index, margin, value.signum()) {
                found.extend(dive(runs, &start, margin, value, cell)?.map(|low| [start, low]));
            }
        }
    }
    Ok(found)
}

/// The places of the grid at most two rows and columns away where the margin has this sign, with
/// its values there.
fn around<L, M: PartialEq>(
    grid: &[(Point, FreeRun<L, M>)],
    rows: usize,
    index: usize,
    margin: &M,
    sign: f64,
) -> Vec<(Point, f64)> {
    let (column, row, columns) = (index / rows, index % rows, grid.len() / rows);
    let near = |place: usize, count: usize| place.saturating_sub(2)..(place + 3).min(count);
    let places = near(column, columns).flat_map(|i| near(row, rows).map(move |j| i * rows + j));
    let value = |(point, run): &(Point, FreeRun<L, M>)| {
        let own = run.margins.iter().find(|(other, _)| other == margin);
        own.map(|(_, value)| (*point, *value)).filter(|(_, value)| value * sign > 0.0)
    };
    places.filter(|&place| place != index).filter_map(|place| value(&grid[place])).collect()
}

/// Whether no neighbour on the grid has the same margin closer to zero or with the other sign. In
/// the latter case a boundary passes between the two places, and no search is needed.
fn is_least<L, M: PartialEq>(
    grid: &[(Point, FreeRun<L, M>)],
    rows: usize,
    index: usize,
    margin: &M,
    value: f64,
) -> bool {
    let (column, row) = (index / rows, index % rows);
    let columns = grid.len() / rows;
    let mut neighbours = 0;
    for i in column.saturating_sub(1)..=(column + 1).min(columns - 1) {
        for j in row.saturating_sub(1)..=(row + 1).min(rows - 1) {
            if (i, j) == (column, row) {
                continue;
            }
            let own = grid[i * rows + j].1.margins.iter().find(|(other, _)| other == margin);
            if let Some((_, other)) = own {
                neighbours += 1;
                if (*other < 0.0) != (value < 0.0) || other.abs() < value.abs() {
                    return false;
                }
            }
        }
    }
    neighbours > 0
}

/// Descends from a place of the grid by quadratic models to a place where the margin has the other
/// sign; `None` if it does not change its sign nearby.
fn dive<F: Family>(
    runs: &Runs<'_, F>,
    start: &Point,
    margin: &F::Margin,
    value: f64,
    cell: &Point,
) -> Traced<Option<Point>, F> {
    let sign = value.signum();
    let (mut point, mut height) = (*start, value.abs());
    let mut trust = cell.max();
    let mut h = 0.25 * cell.min();
    for _ in 0..16 {
        let Some((slope, second)) = derivatives(runs, margin, &point, h)? else { return Ok(None) };
        let (slope, second) = (slope * sign, second * sign);
        let step = downhill(&slope, &second, trust);
        let gain = -(slope.dot(&step) + 0.5 * step.dot(&(second * step)));
        // The minimum is above zero by far more than the error of the model.
        if gain < 0.1 * height && step.norm() < 0.9 * trust {
            return Ok(None);
        }
        let next = point + step;
        if (next - start).amax() > 2.0 * cell.max() || !runs.window.contains(&next) {
            return Ok(None);
        }
        match runs.margin(&next, margin)? {
            Some(value) if sign * value < 0.0 => return Ok(Some(next)),
            Some(value) if sign * value < height => {
                (point, height) = (next, sign * value);
                h = (0.25 * step.norm()).min(h).max(runs.lengths.piece);
            }
            _ => {
                trust *= 0.25;
                h *= 0.25;
            }
        }
        if trust < runs.lengths.piece || h < runs.lengths.half {
            return Ok(None);
        }
    }
    Ok(None)
}

/// The step to the lowest point of a quadratic model, or downhill if it has none; no longer than
/// `trust`.
fn downhill(slope: &Point, second: &Matrix2<f64>, trust: f64) -> Point {
    let newton = inverse::of_two(second).map(|inverse| -(inverse * slope));
    match newton {
        Some(step) if second.trace() > 0.0 && second.determinant() > 0.0 => {
            step * (trust / step.norm()).min(1.0)
        }
        _ if slope.norm() > 0.0 => -slope * (trust / slope.norm()),
        _ => Point::zeros(),
    }
}
