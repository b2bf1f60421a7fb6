//! A stick phase: spring and dashpot are an oscillator, Q̈ + c Q̇ + κ Q = 0 with c = b a.
//!
//! It ends where one of the gaps H = L ∓ Q falls through 0. What decides is that both gaps are driven
//! by the same oscillation P, which vanishes at most once in a stage:
//!
//! ```text
//! Ḧ + c Ḣ + κ H = P     P = (κ − 1) L + (c − a) L̇
//! ```
//!
//! Let u > 0 be an unforced motion of the spring on an interval: e^{−ct/2} cos θ with θ = μ(t − t₁)
//! between −π/2 and π/2, or e^{−λt} where spring and dashpot do not oscillate. The rate of H/u is
//! that of W = e^{ct} (u Ḣ − u̇ H) over (e^{ct/2} u)², and Ẇ = e^{ct} u P. Therefore:
//!
//! - Where P ≤ 0, W falls: H/u has no minimum inside. A gap that is open at the start of the interval
//!   closes once if it is closed at the end, and otherwise not at all.
//! - Where P > 0, W rises: H/u has at most one minimum, where W vanishes. The gap closes if it is
//!   closed there, or at the end.
//!
//! So every interval is decided by the signs of a few numbers.

use super::Linear;
use super::normal::{Moment, Place, Stage};
use super::oscillator::Oscillator;
use super::places::falling;
use super::slip::Drive;
use super::unless_rounding;
use crate::laws::phase::Side;
use crate::numerics::root::{Jet, bracketed};

/// Length of an interval times μ; below π.
const INTERVAL: f64 = 3.0;
/// Terms of the series of a gap, for times of at most one over the fastest rate.
const TERMS: u32 = 26;

/// A stick phase.
pub struct Stick<'a> {
    linear: &'a Linear,
    pub stage: Stage,
    pub start: Moment,
    /// The side from which the spring comes.
    pub side: Side,
    /// w at the start.
    pub velocity: f64,
    /// Q at the start.
    pub force: f64,
    /// The gaps at the start, and their rates: on the side of the phase, and on the other one.
    gaps: [(f64, f64); 2],
    drive: Drive,
}

/// The end of a stick phase.
pub struct Release {
    /// Where it is.
    pub place: Place,
    /// The side of the slip that follows.
    pub side: Side,
    /// w.
    pub velocity: f64,
    /// The rate at which the spring would leave its limit.
    pub excess: f64,
}

/// Where an interval begins or ends: the gaps there, with their roundings.
#[derive(Clone, Copy)]
struct Edge {
    place: Place,
    gaps: [Jet; 2],
    rounding: f64,
}

impl<'a> Stick<'a> {
    /// The phase that starts with the velocity and the force Q, where the gaps on the side of the
    /// phase and on the other one, with their rates, are `gaps`.
    pub fn new(
        linear: &'a Linear,
        (stage, start): (Stage, Moment),
        side: Side,
        [velocity, force]: [f64; 2],
        gaps: [(f64, f64); 2],
    ) -> Self {
        let drive = linear.drive(&linear.normal.at(stage, &start));
        Self { linear, stage, start, side, velocity, force, gaps, drive }
    }

    /// The phase that a slip phase with the same side and velocity ends with.
    pub fn at_limit(
        linear: &'a Linear,
        (stage, start): (Stage, Moment),
        side: Side,
        velocity: f64,
        gap_rate: f64,
    ) -> Self {
        let (limit, slope) = linear.normal.limit(stage, &start);
        let far = (2.0 * limit, 2.0 * slope - gap_rate);
        let force = side.sign() * limit;
        Self::new(linear, (stage, start), side, [velocity, force], [(0.0, gap_rate), far])
    }

    /// The phase that starts where limit and spring vanish.
    pub fn touched(linear: &'a Linear, at: (Stage, Moment), side: Side, velocity: f64) -> Self {
        let (_, slope) = linear.normal.limit(at.0, &at.1);
        let pull = side.sign() * linear.kappa * velocity;
        let gaps = [slope - pull, slope + pull].map(|gap| (0.0, unless_rounding(gap, slope)));
        Self::new(linear, at, side, [velocity, 0.0], gaps)
    }

    /// The end of its stage.
    pub fn end(&self) -> Place {
        self.linear.end(&self.start, self.stage)
    }

    /// w and Q after a part of the phase.
    pub fn motion_at(&self, since: f64) -> [f64; 2] {
        let response = self.linear.spring.after(since);
        let Self { velocity, force, .. } = *self;
        [
            velocity * response.c - force * response.s,
            force * response.ds + self.linear.kappa * velocity * response.s,
        ]
    }

    /// How often w changes its sign until it is `now`.
    pub fn reversals(&self, since: f64, now: f64) -> usize {
        self.linear.spring.sign_changes(self.velocity, -self.force, now, since)
    }

    fn signs(&self) -> [f64; 2] {
        [self.side.sign(), -self.side.sign()]
    }

    /// Both gaps, and P, at a place.
    fn gaps_at(&self, place: Place) -> ([Jet; 2], Drive) {
        let Linear { normal, spring: Oscillator { damping, stiffness, .. }, fast, .. } = *self.linear;
        let (limit, slope) = normal.limit(self.stage, &self.start.after(place));
        let drive = self.linear.drive_of(limit, slope);
        let early = place.since * fast <= 1.0;
        let jet = |value: f64, slope: f64| {
            let curvature = drive.value - damping * slope - stiffness * value;
            Jet { value, slope, curvature }
        };
        if early && (self.stage == Stage::Tail || place.since <= place.left) {
            let gaps = self.gaps.map(|gap| self.series(gap, place.since));
            return (gaps.map(|(value, slope)| jet(value, slope)), drive);
        }
        let [velocity, force] = self.motion_at(place.since);
        let pull = stiffness * velocity - damping * force;
        (self.signs().map(|sign| jet(limit - sign * force, slope - sign * pull)), drive)
    }

    /// A gap and its rate early in the phase, where the difference of limit and force would lose its
    /// digits.
    fn series(&self, (gap, rate): (f64, f64), time: f64) -> (f64, f64) {
        if time == 0.0 {
            return (gap, rate);
        }
        let Linear { normal, spring: Oscillator { damping, stiffness, .. }, .. } = self.linear;
        let square = time * time;
        let [mut h0, mut h1] = [gap, rate * time];
        let [mut p0, mut p1] = [self.drive.value, self.drive.rate * time];
        let (mut value, mut slope) = (h0 + h1, h1);
        for n in 2..TERMS {
            let n = f64::from(n);
            let (both, one) = (square / (n * (n - 1.0)), time / n);
            let next = (p0 - stiffness * h0) * both - damping * h1 * one;
            (h0, h1) = (h1, next);
            let next = -p0 * both - normal.oscillator.damping * p1 * one;
            (p0, p1) = (p1, next);
            value += h1;
            slope += n * h1;
        }
        (value, slope / time)
    }

    fn edge(&self, place: Place) -> Edge {
        let (gaps, _) = self.gaps_at(place);
        let Linear { kappa, dashpot, spring, .. } = self.linear;
        let rate = kappa * self.velocity - dashpot * self.force;
        // The gaps are L ∓ Q.
        let limit = 0.5 * (gaps[0].value + gaps[1].value).abs();
        let rounding = super::ROUNDING * (limit + spring.rounding(self.force, rate, place.since));
        Edge { place, gaps, rounding }
    }

    /// Whether a gap closes as the phase begins.
    fn closes_at_once(&self, (gap, rate): (f64, f64)) -> bool {
        let Drive { value, rate: drive_rate, .. } = self.drive;
        let first = [gap, rate, value, drive_rate].into_iter().find(|&number| number != 0.0);
        first.is_some_and(|first| first < 0.0)
    }

    /// The end of the phase, unless it lasts to the end of its stage.
    pub fn release(&self) -> Option<Release> {
        if let Some(index) = (0..2).find(|&index| self.closes_at_once(self.gaps[index])) {
            let place = Place { since: 0.0, left: self.start.left };
            return Some(self.released(index, place));
        }
        let Oscillator { frequency, oscillates, .. } = self.linear.spring;
        let longest = if oscillates { INTERVAL / frequency } else { f64::INFINITY };
        let mut from = self.edge(Place { since: 0.0, left: self.start.left });
        let turn = self.linear.turn(&self.start, self.stage);
        for stop in turn.into_iter().chain([self.end()]) {
            while from.place.since < stop.since {
                let since = from.place.since + longest;
                let place = Place { since, left: self.start.left - since };
                let to = self.edge(if since < stop.since { place } else { stop });
                let closed = [0, 1].map(|index| self.closing(index, [&from, &to]));
                let first = match closed {
                    [Some(near), Some(far)] if far.since < near.since => Some((1, far)),
                    [Some(near), _] => Some((0, near)),
                    [None, far] => far.map(|far| (1, far)),
                };
                if let Some((index, place)) = first {
                    return Some(self.released(index, place));
                }
                from = to;
            }
        }
        None
    }

    /// Where a gap closes in an interval on which P has one sign, if it does.
    fn closing(&self, index: usize, [from, to]: [&Edge; 2]) -> Option<Place> {
        let gap = |place: Place| self.gaps_at(place).0[index];
        let [begin, end] = [from, to].map(|edge| edge.gaps[index]);
        let guess = from.place.since - begin.value / begin.slope;
        if end.value < -to.rounding {
            return Some(falling(&self.start, [from.place, to.place], guess, gap));
        }
        let middle = 0.5 * (from.place.since + to.place.since);
        let at = |since: f64| Place { since, left: self.start.left - since };
        let weighed = |since: f64, jet: Jet| self.weighed(since - middle, jet);
        // What is closed to rounding at the end counts as 0 there.
        let end = if end.value <= to.rounding { Jet { value: 0.0, ..end } } else { end };
        if weighed(from.place.since, begin) >= 0.0 || weighed(to.place.since, end) <= 0.0 {
            return None;
        }
        if self.gaps_at(at(middle)).1.value <= 0.0 {
            return None;
        }
        let lowest = bracketed(to.place.since, from.place.since, middle, |since| {
            let (gaps, drive) = self.gaps_at(at(since));
            self.weighed_jet(since - middle, gaps[index], drive)
        });
        let lowest = self.edge(at(lowest));
        let closed = lowest.gaps[index].value < -lowest.rounding;
        closed.then(|| falling(&self.start, [from.place, lowest.place], guess, gap))
    }

    /// W over a positive number, at a time from the middle of an interval.
    fn weighed(&self, time: f64, gap: Jet) -> f64 {
        let Oscillator { half, frequency, oscillates, slow, .. } = self.linear.spring;
        if !oscillates {
            return gap.slope + slow * gap.value;
        }
        let (sine, cosine) = (frequency * time).sin_cos();
        (gap.slope + half * gap.value) * cosine + frequency * gap.value * sine
    }

    /// The same with its rates.
    fn weighed_jet(&self, time: f64, gap: Jet, drive: Drive) -> Jet {
        let Oscillator { half, frequency, oscillates, .. } = self.linear.spring;
        let value = self.weighed(time, gap);
        if !oscillates {
            let faster = half + frequency;
            let slope = drive.value - faster * value;
            return Jet { value, slope, curvature: drive.rate - faster * slope };
        }
        let (sine, cosine) = (frequency * time).sin_cos();
        let slope = drive.value * cosine - half * value;
        let curvature = drive.rate * cosine - frequency * drive.value * sine - half * slope;
        Jet { value, slope, curvature }
    }

    fn released(&self, index: usize, place: Place) -> Release {
        let [velocity, _] = self.motion_at(place.since);
        let side = if index == 0 { self.side } else { self.side.opposite() };
        let excess = (-self.gaps_at(place).0[index].slope).max(0.0);
        Release { place, side, velocity, excess }
    }
}
