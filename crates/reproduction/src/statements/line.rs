//! The switches over ψ at one stiffness, with every boundary located.
//!
//! The boundaries are traced in a narrow window around the stiffness, and solved for at the
//! stiffness itself. So they are decided, where samples would guess. Boundaries of another model
//! are bisected between samples.
//!
//! At κ = 18 and 63 Figure 4 has the same boundaries, read off an atlas of its whole plane
//! (`figures::points`). They are computed twice on purpose, as an independent check: a test holds
//! that both agree.

use stickslip_plane::atlas::AtlasError;
use stickslip_plane::{Chart, CollisionPlane};
use stickslip_studies::search::change;
use stickslip_tracer::{Family, Point, TraceOptions, trace};

use super::spring::Spring;
use super::statement::Stop;
use super::statement::geometric;
use crate::error::ReproductionError;

/// Half the window's width in ln κ.
const REACH: f64 = 0.05;
/// The window in ψ. A sample below it tells that nothing changes there.
const PSI: (f64, f64) = (1e-3, 2.5);
/// The ψ of this sample.
const SMALL_PSI: f64 = 1e-6;
/// Collisions in each stretch that must have the same switches.
const SAMPLES: usize = 20;

/// All ψ from 0 to 2.5 at one κ.
#[derive(Clone, Debug)]
pub struct Line {
    pub kappa: f64,
    /// How the boundaries were found.
    pub method: &'static str,
    /// Divided by the boundaries, in order of rising ψ.
    pub stretches: Vec<Stretch>,
}

/// An interval of ψ in which collisions have the same switches.
#[derive(Clone, Debug)]
pub struct Stretch {
    pub low: f64,
    pub high: f64,
    pub itinerary: String,
    pub switch_count: usize,
    /// Divided further where the number of reversals changes.
    pub spans: Vec<Span>,
}

/// An interval of ψ in which collisions have the same switches and reversals.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    pub low: f64,
    pub high: f64,
    pub switch_count: usize,
    pub reversals: usize,
}

impl Line {
    /// The numbers of switches as ψ falls.
    pub fn falling(&self) -> String {
        let counts = self.stretches.iter().rev().map(|stretch| stretch.switch_count.to_string());
        counts.collect::<Vec<_>>().join(" ")
    }

    /// The largest number of switches.
    pub fn most(&self) -> usize {
        self.stretches.iter().map(|stretch| stretch.switch_count).max().unwrap_or(0)
    }

    /// The boundary above which there is no switch.
    pub fn top(&self) -> f64 {
        self.stretches.last().map_or(0.0, |stretch| stretch.low)
    }

    /// All spans of all stretches.
    pub fn spans(&self) -> impl Iterator<Item = &Span> {
        self.stretches.iter().flat_map(|stretch| &stretch.spans)
    }
}

/// The line at `kappa`.
///
/// # Errors
/// [`Stop::Failed`]: a collision cannot be computed. [`Stop::Open`]: the boundaries are in doubt,
/// because the tracer could not explain something, or because a collision does not have the
/// switches of its stretch.
pub fn line(spring: Spring, kappa: f64) -> Result<Line, Stop> {
    let (method, boundaries) = match spring {
        Spring::Reset => ("traced and solved for", traced(kappa)?),
        Spring::Unreset => ("bisected between 4000 samples", bisected(spring, kappa)?),
    };
    let ends = [&[0.0], &boundaries[..], &[PSI.1]].concat();
    let stretches = ends.windows(2).map(|ends| stretch(spring, kappa, ends[0], ends[1]));
    let stretches = stretches.collect::<Result<Vec<_>, _>>()?;
    match stretches.windows(2).find(|pair| pair[0].itinerary == pair[1].itinerary) {
        Some(pair) => {
            Err(Stop::Open(format!("nothing changes at κ = {kappa}, ψ = {}", pair[0].high)))
        }
        None => Ok(Line { kappa, method, stretches }),
    }
}

/// The stretch between two neighbouring boundaries. Samples must confirm it.
///
/// Away from boundaries, the number of reversals changes only where the velocity at the end passes
/// zero. With a reset spring this is a boundary itself; with another one it is bisected between
/// samples.
fn stretch(spring: Spring, kappa: f64, low: f64, high: f64) -> Result<Stretch, Stop> {
    let collide = |psi| spring.collide(kappa, psi, 0.0);
    let first = if low == 0.0 { SMALL_PSI } else { low + (high - low) * 1e-3 };
    let start = collide(first)?;
    let (itinerary, switch_count) = (start.itinerary(), start.switches.len());
    let mut span = Span { low, high, switch_count, reversals: start.reversals };
    let mut spans = Vec::new();
    let mut before = first;
    for i in 0..SAMPLES {
        let psi = low + (high - low) * (i as f64 + 0.5) / SAMPLES as f64;
        let other = collide(psi)?;
        if other.itinerary() != itinerary {
            let found = other.itinerary();
            let reason = format!("κ = {kappa}, ψ = {psi} has {found}, not {itinerary}");
            return Err(Stop::Open(reason));
        }
        if other.reversals != span.reversals {
            let same = |psi| Ok::<_, ReproductionError>(collide(psi)?.reversals == span.reversals);
            let high = change(before, psi, same)?;
            spans.push(Span { high, ..span });
            span = Span { low: high, reversals: other.reversals, ..span };
        }
        before = psi;
    }
    spans.push(span);
    Ok(Stretch { low, high, itinerary, switch_count, spans })
}

/// The ψ of all boundaries at `kappa`, in order.
fn traced(kappa: f64) -> Result<Vec<f64>, Stop> {
    let window = (kappa * (-REACH).exp(), kappa * REACH.exp());
    let plane = CollisionPlane::new(window, PSI, 0.0)?.with_chart(Chart::PLAIN);
    let (family, x) = (plane.family(), plane.point(kappa, PSI.0).x);
    let network = trace(&family, &plane.window(), &TraceOptions::default())
        .map_err(|error| AtlasError::of(&plane, error))?;
    if let Some(open) = network.unresolved.first() {
        let reason = format!("the boundaries at κ = {kappa} are in doubt: {open:?}");
        return Err(Stop::Open(reason));
    }
    let mut found = Vec::new();
    for curve in &network.curves {
        for pair in curve.nodes.windows(2) {
            let [from, to] = [pair[0].point, pair[1].point];
            if (from.x < x) == (to.x < x) {
                continue;
            }
            let guess = from.y + (to.y - from.y) * (x - from.x) / (to.x - from.x);
            let psi_at = |y| plane.parameters(&Point::new(x, y))[1];
            let failed = |source| AtlasError::Run { kappa, psi: psi_at(guess), source };
            let margin = family.moved(&from, &curve.margin).map_err(failed)?;
            let value = |y: f64| family.margin(&Point::new(x, y), &margin);
            let Some(y) = secant(value, guess).map_err(failed)? else {
                let reason = format!("no boundary at κ = {kappa} near ψ = {}", psi_at(guess));
                return Err(Stop::Open(reason));
            };
            found.push(psi_at(y));
        }
    }
    found.sort_by(f64::total_cmp);
    Ok(found)
}

/// The same boundaries from samples, for another model than the tracer's. A pair of boundaries
/// between two samples is missed.
fn bisected(spring: Spring, kappa: f64) -> Result<Vec<f64>, ReproductionError> {
    let itinerary = |psi| spring.collide(kappa, psi, 0.0).map(|collision| collision.itinerary());
    let psis: Vec<f64> = geometric(PSI.0, PSI.1, 4000).collect();
    let mut found = Vec::new();
    let mut before = itinerary(psis[0])?;
    for pair in psis.windows(2) {
        let after = itinerary(pair[1])?;
        if before != after {
            let same = |psi| Ok::<_, ReproductionError>(itinerary(psi)? == before);
            found.push(change(pair[0], pair[1], same)?);
        }
        before = after;
    }
    Ok(found)
}

/// The zero of `value` near `guess`; `None` if there is none, or if `value` ceases to exist.
fn secant<E>(value: impl Fn(f64) -> Result<Option<f64>, E>, guess: f64) -> Result<Option<f64>, E> {
    let (mut last, mut at) = (guess, guess + 1e-7);
    let (Some(mut last_value), Some(mut at_value)) = (value(last)?, value(at)?) else {
        return Ok(None);
    };
    for _ in 0..20 {
        if at_value == last_value {
            break;
        }
        let next = at - at_value * (at - last) / (at_value - last_value);
        if (next - at).abs() < 1e-15 {
            return Ok(Some(next));
        }
        let Some(next_value) = value(next)? else { return Ok(None) };
        (last, last_value) = (at, at_value);
        (at, at_value) = (next, next_value);
    }
    // Steps as small as the rounding of a margin need not become smaller.
    Ok(((at - last).abs() < 1e-12).then_some(at))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ways lead to the same boundaries: sampling finds all at this stiffness, and bisecting
    /// the exact solution is accurate to rounding.
    #[test]
    fn traced_boundaries_are_those_between_samples() {
        let (traced, bisected) = (traced(18.0).unwrap(), bisected(Spring::Reset, 18.0).unwrap());
        assert_eq!((traced.len(), bisected.len()), (7, 7));
        for (one, other) in traced.iter().zip(bisected) {
            assert!((one - other).abs() < 2e-14, "{one} {other}");
        }
    }

    #[test]
    fn a_margin_that_cannot_be_computed_is_an_error_and_not_a_missing_boundary() {
        assert_eq!(secant(|_| Err("broken"), 0.3), Err("broken"));
        let breaks = |y: f64| if y > 1.0 { Err("broken") } else { Ok(Some(2.0 - y)) };
        assert_eq!(secant(breaks, 0.3), Err("broken"));
        assert_eq!(secant(|_| Ok::<_, &str>(None), 0.3), Ok(None));
        let found = secant(|y| Ok::<_, &str>(Some(2.0 - y)), 0.3).unwrap();
        assert!(found.is_some_and(|y| (y - 2.0).abs() < 1e-12));
    }

    /// The velocity at the end of an unreset spring passes 0 between two boundaries.
    #[test]
    fn a_stretch_is_divided_where_the_reversals_change() {
        let spring = Spring::Unreset;
        let stretch = stretch(spring, 18.0, 0.0666, 0.116).unwrap();
        let [one, other] = stretch.spans.as_slice() else { panic!("{stretch:?}") };
        assert_eq!((one.reversals, other.reversals, one.high), (4, 3, other.low));
        let velocity = |psi| spring.collide(18.0, psi, 0.0).unwrap().final_velocity;
        assert!(velocity(one.high * (1.0 - 1e-9)) > 0.0 && velocity(one.high * (1.0 + 1e-9)) < 0.0);
    }
}
