//! Intervals from profiles: where the least misfit over the other numbers is not above a threshold.

use super::FitError;
use super::free::Free;
use super::quantile::{normal, student};
use super::scan::{Line, Lines};
use super::search::root;

/// The interval of a fitted number, which may consist of several pieces.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(into = "IntervalFields")]
pub struct ConfidenceInterval {
    /// The number.
    pub parameter: Free,
    /// The pieces, in rising order. `None` if there are as many free numbers as data and the size
    /// of the errors is not known.
    pub pieces: Option<Vec<IntervalPiece>>,
}

/// An interval in the file of a fit.
#[derive(serde::Serialize)]
struct IntervalFields {
    parameter: Free,
    pieces: Option<Vec<IntervalPiece>>,
    verdict: String,
}
impl From<ConfidenceInterval> for IntervalFields {
    fn from(interval: ConfidenceInterval) -> Self {
        let verdict = interval.verdict();
        let ConfidenceInterval { parameter, pieces } = interval;
        Self { parameter, pieces, verdict }
    }
}

/// A piece of an interval.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct IntervalPiece {
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
    /// Whether the lower end is the end of the range, and the piece may go on below.
    pub from_end_of_range: bool,
    /// Whether the upper end is the end of the range, and the piece may go on above.
    pub to_end_of_range: bool,
}

impl ConfidenceInterval {
    /// Whether the interval holds a value; `None` without an interval.
    pub fn holds(&self, value: f64) -> Option<bool> {
        let pieces = self.pieces.as_ref()?;
        Some(pieces.iter().any(|piece| (piece.low..=piece.high).contains(&value)))
    }

    /// What the data decide of the number, and what they leave open, in a sentence.
    pub fn verdict(&self) -> String {
        let name = self.parameter.name();
        let Some(pieces) = &self.pieces else {
            return format!("{name} is open: there are no more data than free numbers");
        };
        let open = |piece: &IntervalPiece| piece.from_end_of_range || piece.to_end_of_range;
        let one = |piece: &IntervalPiece| {
            let IntervalPiece { low, high, from_end_of_range, to_end_of_range } = *piece;
            match (from_end_of_range, to_end_of_range) {
                (false, false) => format!("{low:.4} to {high:.4}"),
                (true, false) => format!("below {high:.4}"),
                (false, true) => format!("above {low:.4}"),
                (true, true) => "anything in its range".to_owned(),
            }
        };
        let all = pieces.iter().map(one).collect::<Vec<_>>().join(", or ");
        match &pieces[..] {
            [piece] if !open(piece) => format!("{name} is decided: {all}"),
            [piece] if piece.from_end_of_range && piece.to_end_of_range => {
                format!("{name} is open: the data fit with {all}")
            }
            [_] => format!("{name} is decided on one side only: {all}"),
            pieces if pieces.iter().any(open) => {
                format!("{name} is open: the data fit in {} places, {all}", pieces.len())
            }
            pieces => format!("{name} is decided up to {} places: {all}", pieces.len()),
        }
    }
}

/// The misfit up to which values are in the intervals of one number each. `None` if there are no
/// more data than free numbers, and the size of the errors is not known.
///
/// With known errors the least misfit over the other numbers, less the very least, has the
/// distribution χ² with one degree of freedom. Otherwise its ratio to the very least over the
/// degrees of freedom has the distribution F, with one degree of freedom in the numerator. Both
/// hold for many data or a linear model.
pub fn threshold(
    least: f64,
    level: f64,
    (data, free): (usize, usize),
    estimated: bool,
) -> Option<f64> {
    if !estimated {
        return Some(least + normal(level).powi(2));
    }
    let freedom = data.checked_sub(free).filter(|freedom| *freedom > 0)?;
    Some(least * (1.0 + student(level, freedom).powi(2) / freedom as f64))
}

/// A place of a profile.
#[derive(Clone, Copy)]
struct Place<'a> {
    at: f64,
    misfit: f64,
    /// The lines between which it is; twice the same if it is one of them.
    between: [&'a Line; 2],
}

/// The interval of the outer axis, given its lines and the values and misfits of all minima.
pub fn interval(
    lines: &Lines<'_>,
    found: &[Line],
    minima: impl Iterator<Item = (f64, f64)>,
    threshold: Option<f64>,
) -> Result<ConfidenceInterval, FitError> {
    let parameter = lines.outer.free;
    let Some(threshold) = threshold else {
        return Ok(ConfidenceInterval { parameter, pieces: None });
    };
    let mut places = Vec::new();
    for line in found {
        places.push(Place { at: line.at, misfit: line.best().misfit, between: [line, line] });
    }
    // A narrow piece may lie between two lines: then there is a minimum in it.
    let mut known = Vec::new();
    for (value, misfit) in minima {
        let at = lines.outer.coordinate(value);
        known.push((at, value));
        let upper = found.partition_point(|line| line.at < at).clamp(1, found.len() - 1);
        let between = [&found[upper - 1], &found[upper]];
        places.push(Place { at, misfit: misfit.min(lines.profile(at, between)?), between });
    }
    places.sort_by(|a, b| a.at.total_cmp(&b.at));
    let inside = |place: &Place<'_>| place.misfit <= threshold;
    let crossing = |a: &Place<'_>, b: &Place<'_>| {
        let ends = [a, b].map(|place| (place.at, place.misfit - threshold));
        let between = [a.between[0], b.between[1]];
        root(ends, |at| Ok(lines.profile(at, between)? - threshold))
    };
    let mut pieces = Vec::new();
    let mut open: Option<(f64, bool)> = None;
    for (index, place) in places.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| places[before]);
        match (open, inside(place)) {
            (None, true) => {
                let low = before.map(|before| crossing(&before, place)).transpose()?;
                open = Some((low.unwrap_or(place.at), low.is_none()));
            }
            (Some((low, from_end_of_range)), false) => {
                let high = before.map(|before| crossing(&before, place)).transpose()?;
                let high = high.unwrap_or(place.at);
                pieces.push(IntervalPiece { low, high, from_end_of_range, to_end_of_range: false });
                open = None;
            }
            _ => {}
        }
    }
    if let (Some((low, from_end_of_range)), Some(last)) = (open, places.last()) {
        pieces.push(IntervalPiece { low, high: last.at, from_end_of_range, to_end_of_range: true });
    }
    // An interval that is one minimum holds it, whatever the rounding of its coordinate.
    let value = |at: f64| {
        let minimum = known.iter().find(|minimum| minimum.0 == at);
        minimum.map_or_else(|| lines.outer.value(at), |minimum| minimum.1)
    };
    for piece in &mut pieces {
        (piece.low, piece.high) = (value(piece.low), value(piece.high));
    }
    Ok(ConfidenceInterval { parameter, pieces: Some(pieces) })
}

#[cfg(test)]
mod verdicts {
    use super::*;

    #[test]
    fn a_verdict_says_what_is_open() {
        let piece = |low, high, from_end_of_range, to_end_of_range| IntervalPiece {
            low,
            high,
            from_end_of_range,
            to_end_of_range,
        };
        let verdict = |pieces| ConfidenceInterval { parameter: Free::Mu, pieces }.verdict();
        for (pieces, expected) in [
            (None, "mu is open: there are no more data than free numbers"),
            (Some(vec![piece(0.1, 0.25, false, false)]), "mu is decided: 0.1000 to 0.2500"),
            (
                Some(vec![piece(0.1, 1.0, false, true)]),
                "mu is decided on one side only: above 0.1000",
            ),
            (
                Some(vec![piece(0.01, 1.0, true, true)]),
                "mu is open: the data fit with anything in its range",
            ),
            (
                Some(vec![piece(0.1, 0.2, false, false), piece(0.3, 0.4, false, false)]),
                "mu is decided up to 2 places: 0.1000 to 0.2000, or 0.3000 to 0.4000",
            ),
            (
                Some(vec![piece(0.1, 0.2, false, false), piece(0.3, 1.0, false, true)]),
                "mu is open: the data fit in 2 places, 0.1000 to 0.2000, or above 0.3000",
            ),
        ] {
            assert_eq!(verdict(pieces), expected);
        }
    }
}
