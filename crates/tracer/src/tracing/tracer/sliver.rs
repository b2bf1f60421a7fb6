//! Regions so thin that they lie between two places with the same label: margins that come to zero
//! on the way.

use crate::family::Family;
use crate::lengths::Lengths;
use crate::tracing::runs::{Runs, Sampled, Traced};
use crate::window::Point;

/// Places between `here` and `there` just behind the zeros of margins of `here` at which the label
/// changes.
///
/// `before` is the place on the other side of `here`, as far away as `there`. It shows whether a
/// margin comes near zero on the way. Zeros on `known` curves, at these places from 0 to 1, are
/// left out.
pub(crate) fn between<F: Family>(
    runs: &Runs<'_, F>,
    known: &[f64],
    before: Option<&Sampled<F>>,
    here: &Sampled<F>,
    there: &Sampled<F>,
) -> Traced<Vec<Point>, F> {
    let mut found = Vec::new();
    for (margin, value) in &here.1.margins {
        let value_at = |(_, run): &Sampled<F>| {
            let own = run.margins.iter().find(|(other, _)| other == margin);
            own.map(|(_, value)| *value)
        };
        // A margin with the same sign at both places may have a minimum between them, which is not
        // looked for here.
        if value_at(there).is_none_or(|there| there * value <= 0.0) {
            let way = Way { runs, known, margin, ends: [here.0, there.0] };
            found.extend(way.vanishes(*value, before.and_then(value_at))?);
        }
    }
    Ok(found)
}

/// A margin on the way from one place to another, along which places run from 0 to 1.
struct Way<'r, F: Family> {
    runs: &'r Runs<'r, F>,
    known: &'r [f64],
    margin: &'r F::Margin,
    ends: [Point; 2],
}

impl<F: Family> Way<'_, F> {
    fn point(&self, place: f64) -> Point {
        self.ends[0].lerp(&self.ends[1], place)
    }

    fn value(&self, place: f64) -> Traced<Option<f64>, F> {
        self.runs.margin(&self.point(place), self.margin)
    }

    /// The point behind the zero of the margin, which has `value` at 0 and `before` at −1, where
    /// the label differs from the label before the zero. `None` if the margin does not come to
    /// zero, or if nothing changes there.
    fn vanishes(&self, value: f64, before: Option<f64>) -> Traced<Option<Point>, F> {
        /// A margin does not vanish on the way if more than this part of it is left at the end of
        /// the way by linear extrapolation.
        const LEFT: f64 = 0.5;
        // If there is no place before, the slope is taken near the first place.
        let near = Lengths::PARTS.around;
        if value == 0.0 {
            return Ok(None);
        }
        let slope = match before {
            Some(before) => value - before,
            None => match self.value(near)? {
                Some(ahead) => (ahead - value) / near,
                None => return Ok(None),
            },
        };
        if 1.0 + slope / value > LEFT {
            return Ok(None);
        }
        let Some(bracket) = self.bracket(value, slope)? else { return Ok(None) };
        let Some([ahead, behind]) = self.narrowed(bracket, value.signum())? else {
            return Ok(None);
        };
        let label = self.runs.label(&self.point(ahead))?;
        let mut offset = self.runs.options.offset / self.length();
        while behind + offset < 1.0 && offset <= near {
            let point = self.point(behind + offset);
            if self.runs.label(&point)? != label {
                return Ok(Some(point));
            }
            offset *= 10.0;
        }
        Ok(None)
    }

    /// Two places with other signs of the margin, by the secant method with steps that are a little
    /// too long. `None` if the zero between them is known.
    fn bracket(&self, value: f64, mut slope: f64) -> Traced<Option<[f64; 2]>, F> {
        const ROUNDS: usize = 40;
        let (mut low, mut height) = (0.0, value);
        // The nearest place without the margin.
        let mut end = None;
        for _ in 0..ROUNDS {
            let step = -1.05 * height / slope;
            let farthest = end.map_or(1.0, |end| f64::midpoint(low, end));
            let comes_to_zero = step > 0.0 && farthest - low > Lengths::PARTS.same;
            if !comes_to_zero {
                return Ok(None);
            }
            let next = farthest.min(low + step);
            match self.value(next)? {
                None => end = Some(next),
                Some(here) if here * value <= 0.0 => {
                    let width = next - low;
                    let zero = low + width * height / (height - here);
                    let is_known =
                        self.known.iter().any(|place| (place - zero).abs() < 0.1 * width);
                    return Ok((!is_known).then_some([low, next]));
                }
                Some(here) => {
                    slope = (here - height) / (next - low);
                    (low, height) = (next, here);
                }
            }
        }
        Ok(None)
    }

    /// The bracket of a zero, bisected. `None` if the margin does not exist everywhere in it.
    fn narrowed(&self, bracket: [f64; 2], sign: f64) -> Traced<Option<[f64; 2]>, F> {
        let [mut low, mut high] = bracket;
        let width = 10.0 * self.runs.options.tolerance / self.length();
        while high - low > width {
            let middle = f64::midpoint(low, high);
            if middle <= low || middle >= high {
                break;
            }
            match self.value(middle)? {
                None => return Ok(None),
                Some(here) if here * sign > 0.0 => low = middle,
                Some(_) => high = middle,
            }
        }
        Ok(Some([low, high]))
    }

    fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }
}
