//! The switches over ψ at one stiffness, with every boundary located.
//!
//! The boundaries are traced in a narrow window around the stiffness, and solved for at it; those
//! of another model are bisected between samples.

use stickslip::collisions::CollisionPlane;
use stickslip_tracer::{Family, Point, TraceOptions, trace};

use super::search::change;
use super::subject::{Model, Subject, geometric};
use crate::error::Failure;

/// Half the window's width in ln κ.
const REACH: f64 = 0.05;
/// The window in ψ; below it a sample tells that nothing changes.
const PSI: (f64, f64) = (1e-3, 2.5);
/// That sample.
const SMALL_PSI: f64 = 1e-6;
/// Collisions in each stretch that must have the same switches.
const SAMPLES: usize = 20;

/// All ψ from 0 to 2.5 at one κ.
#[derive(Debug)]
pub struct Line {
    pub kappa: f64,
    /// How the boundaries were found.
    pub method: &'static str,
    /// Parted by the boundaries, in order of rising ψ.
    pub stretches: Vec<Stretch>,
}

/// An interval of ψ in which collisions have the same switches.
#[derive(Debug)]
pub struct Stretch {
    pub low: f64,
    pub high: f64,
    pub itinerary: String,
    pub switch_count: usize,
    /// Parted further where the number of reversals changes.
    pub parts: Vec<Part>,
}

/// An interval of ψ in which collisions have the same switches and reversals.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    pub low: f64,
    pub high: f64,
    pub switch_count: usize,
    pub reversals: usize,
}

impl Line {
    /// Numbers of switches as ψ falls.
    pub fn falling(&self) -> Vec<usize> {
        self.stretches.iter().rev().map(|stretch| stretch.switch_count).collect()
    }

    /// The same as text.
    pub fn falling_text(&self) -> String {
        self.falling().iter().map(usize::to_string).collect::<Vec<_>>().join(" ")
    }

    /// The largest number of switches.
    pub fn most(&self) -> usize {
        self.stretches.iter().map(|stretch| stretch.switch_count).max().unwrap_or(0)
    }

    /// The boundary above which there is no switch.
    pub fn top(&self) -> f64 {
        self.stretches.last().map_or(0.0, |stretch| stretch.low)
    }

    /// All parts of all stretches.
    pub fn parts(&self) -> impl Iterator<Item = &Part> {
        self.stretches.iter().flat_map(|stretch| &stretch.parts)
    }
}

/// The line at `kappa`.
///
/// # Errors
/// Why the boundaries are in doubt: what the tracer could not explain, or a collision that does not
/// have the switches of its stretch.
pub fn line(subject: &Subject, kappa: f64) -> Result<Line, String> {
    let (method, boundaries) = match subject.model {
        Model::Reset => ("traced and solved for", traced(kappa)?),
        Model::UnresetSpring => ("bisected between 4000 samples", bisected(subject, kappa)?),
    };
    let ends = [&[0.0], boundaries.as_slice(), &[PSI.1]].concat();
    let stretches = ends.windows(2).map(|ends| stretch(subject, kappa, ends[0], ends[1]));
    let stretches = stretches.collect::<Result<Vec<_>, _>>()?;
    match stretches.windows(2).find(|pair| pair[0].itinerary == pair[1].itinerary) {
        Some(pair) => Err(format!("nothing changes at κ = {kappa}, ψ = {}", pair[0].high)),
        None => Ok(Line { kappa, method, stretches }),
    }
}

/// The stretch between two neighbouring boundaries, which samples must confirm.
///
/// Without a boundary, the number of reversals changes only where the velocity at the end passes 0.
/// With a reset spring that is a boundary itself; with another one it is bisected between samples.
fn stretch(subject: &Subject, kappa: f64, low: f64, high: f64) -> Result<Stretch, String> {
    let collide = |psi| subject.collide(kappa, psi, 0.0).map_err(|error| error.to_string());
    let first = if low == 0.0 { SMALL_PSI } else { low + (high - low) * 1e-3 };
    let start = collide(first)?;
    let (itinerary, switch_count) = (start.itinerary(), start.switches.len());
    let mut part = Part { low, high, switch_count, reversals: start.reversals };
    let mut parts = Vec::new();
    let mut before = first;
    for i in 0..SAMPLES {
        let psi = low + (high - low) * (i as f64 + 0.5) / SAMPLES as f64;
        let other = collide(psi)?;
        if other.itinerary() != itinerary {
            let found = other.itinerary();
            return Err(format!("κ = {kappa}, ψ = {psi} has {found}, not {itinerary}"));
        }
        if other.reversals != part.reversals {
            let same = |psi| Ok(subject.collide(kappa, psi, 0.0)?.reversals == part.reversals);
            let high = change(before, psi, same).map_err(|error| error.to_string())?;
            parts.push(Part { high, ..part });
            part = Part { low: high, reversals: other.reversals, ..part };
        }
        before = psi;
    }
    parts.push(part);
    Ok(Stretch { low, high, itinerary, switch_count, parts })
}

/// The ψ of all boundaries at `kappa`, in order.
fn traced(kappa: f64) -> Result<Vec<f64>, String> {
    let window = (kappa * (-REACH).exp(), kappa * REACH.exp());
    let plane = CollisionPlane::new(window, PSI, 0.0).map_err(|error| error.to_string())?;
    let (family, x) = (plane.family(), kappa.ln());
    let network = trace(&family, &plane.window(), &TraceOptions::default())
        .map_err(|error| error.to_string())?;
    if let Some(open) = network.unresolved.first() {
        return Err(format!("the boundaries at κ = {kappa} are in doubt: {open:?}"));
    }
    let mut found = Vec::new();
    for curve in &network.curves {
        for pair in curve.nodes.windows(2) {
            let [from, to] = [pair[0].point, pair[1].point];
            if (from.x < x) == (to.x < x) {
                continue;
            }
            let guess = from.y + (to.y - from.y) * (x - from.x) / (to.x - from.x);
            let margin = family.moved(&from, &curve.margin).map_err(|error| error.to_string())?;
            let value = |y: f64| family.margin(&Point::new(x, y), &margin).ok().flatten();
            let root = secant(value, guess);
            let y =
                root.ok_or_else(|| format!("no boundary at κ = {kappa} near ln(1 + ψ) = {guess}"))?;
            found.push(y.exp_m1());
        }
    }
    found.sort_by(f64::total_cmp);
    Ok(found)
}

/// The same from samples, for another model than the tracer's: what lies between two of them is
/// missed.
fn bisected(subject: &Subject, kappa: f64) -> Result<Vec<f64>, String> {
    let itinerary = |psi| subject.collide(kappa, psi, 0.0).map(|collision| collision.itinerary());
    let psis: Vec<f64> = geometric(PSI.0, PSI.1, 4000).collect();
    let found = || -> Result<Vec<f64>, Failure> {
        let mut found = Vec::new();
        let mut before = itinerary(psis[0])?;
        for pair in psis.windows(2) {
            let after = itinerary(pair[1])?;
            if before != after {
                found.push(change(pair[0], pair[1], |psi| Ok(itinerary(psi)? == before))?);
            }
            before = after;
        }
        Ok(found)
    };
    found().map_err(|error| error.to_string())
}

/// The zero of `value` near `guess`.
fn secant(value: impl Fn(f64) -> Option<f64>, guess: f64) -> Option<f64> {
    let (mut last, mut at) = (guess, guess + 1e-7);
    let (mut last_value, mut at_value) = (value(last)?, value(at)?);
    for _ in 0..20 {
        if at_value == last_value {
            break;
        }
        let next = at - at_value * (at - last) / (at_value - last_value);
        if (next - at).abs() < 1e-15 {
            return Some(next);
        }
        (last, last_value) = (at, at_value);
        (at, at_value) = (next, value(next)?);
    }
    // Steps of the size of a margin's rounding need not become smaller.
    ((at - last).abs() < 1e-12).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ways to the boundaries: sampling finds all at this stiffness, and bisecting the exact
    /// solution is good to rounding.
    #[test]
    fn traced_boundaries_are_those_between_samples() {
        let subject = Subject::new(Model::Reset);
        let (traced, bisected) = (traced(18.0).unwrap(), bisected(&subject, 18.0).unwrap());
        assert_eq!((traced.len(), bisected.len()), (7, 7));
        for (one, other) in traced.iter().zip(bisected) {
            assert!((one - other).abs() < 2e-14, "{one} {other}");
        }
    }

    /// The velocity at the end of an unreset spring passes 0 between two boundaries.
    #[test]
    fn a_stretch_is_parted_where_the_reversals_change() {
        let subject = Subject::new(Model::UnresetSpring);
        let stretch = stretch(&subject, 18.0, 0.0666, 0.116).unwrap();
        let [one, other] = stretch.parts.as_slice() else { panic!("{stretch:?}") };
        assert_eq!((one.reversals, other.reversals, one.high), (4, 3, other.low));
        let velocity = |psi| subject.collide(18.0, psi, 0.0).unwrap().final_velocity;
        assert!(velocity(one.high * (1.0 - 1e-9)) > 0.0 && velocity(one.high * (1.0 + 1e-9)) < 0.0);
    }
}
