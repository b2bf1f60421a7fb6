//! A stick phase: spring and dashpot are an oscillator, Q̈ + c Q̇ + κ Q = 0 with c = b a.
//!
//! It ends where one of the gaps H = L ∓ Q falls through 0. What decides is that both gaps are
//! driven by the same oscillation P, which vanishes at most once in a stage:
//!
//! ```text
//! Ḧ + c Ḣ + κ H = P     P = (κ − 1) L + (c − a) L̇
//! ```
//!
//! Let u > 0 be an unforced motion of the spring on an interval: e^{−ct/2} cos θ with θ = μ(t − t₁)
//! between −π/2 and π/2, or e^{−λt} where spring and dashpot do not oscillate. The rate of H/u is
//! that of W = e^{ct} (u Ḣ − u̇ H) over (e^{ct/2} u)², and Ẇ = e^{ct} u P. Therefore:
//!
//! - Where P ≤ 0, W falls: H/u has no minimum inside. A gap that is open at the start of the
//!   interval closes once if it is closed at the end, and otherwise not at all.
//! - Where P > 0, W rises: H/u has at most one minimum, where W vanishes. The gap closes if it is
//!   closed there, or at the end.
//!
//! So every interval is decided by the signs of a few numbers.

use stickslip_contact::Side;
use stickslip_contact::numerics::root::{Jet, bracketed};

use super::Linear;
use super::falling;
use super::normal::{Moment, Place, Stage};
use super::oscillator::Oscillator;
use super::slip::Drive;
use super::unless_rounding;

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
    /// Q at the start, but 0 in a relaxed phase, in which the dashpot determines Q.
    force: f64,
    /// Whether the spring has no elongation at the start.
    relaxed: bool,
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
    /// The phase that starts with the velocity `velocity` and a spring without elongation, where
    /// the gaps on the side of the phase and on the other one, with their rates, are `gaps`.
    pub fn relaxed(
        linear: &'a Linear,
        (stage, start): (Stage, Moment),
        side: Side,
        velocity: f64,
        gaps: [(f64, f64); 2],
    ) -> Self {
        let drive = linear.drive(&linear.normal.at(stage, &start));
        Self { linear, stage, start, side, velocity, force: 0.0, relaxed: true, gaps, drive }
    }

    /// The phase that starts where the force has its limit on side `side`, from which it recedes at
    /// the rate `gap_rate`.
    pub fn at_limit(
        linear: &'a Linear,
        at: (Stage, Moment),
        side: Side,
        velocity: f64,
        gap_rate: f64,
    ) -> Self {
        let (limit, slope) = linear.normal.limit(at.0, &at.1);
        let gaps = [(0.0, gap_rate), (2.0 * limit, 2.0 * slope - gap_rate)];
        let force = side.sign() * limit;
        Self { force, relaxed: false, ..Self::relaxed(linear, at, side, velocity, gaps) }
    }

    /// The phase that starts where the limit vanishes, and with it the force of spring and dashpot.
    pub fn touched(linear: &'a Linear, at: (Stage, Moment), side: Side, velocity: f64) -> Self {
        let (_, slope) = linear.normal.limit(at.0, &at.1);
        let pull = side.sign() * linear.kappa * velocity;
        let gaps = [slope - pull, slope + pull].map(|gap| (0.0, unless_rounding(gap, slope)));
        Self { relaxed: false, ..Self::relaxed(linear, at, side, velocity, gaps) }
    }

    /// The end of its stage.
    pub fn end(&self) -> Place {
        self.linear.end(&self.start, self.stage)
    }

    /// The factors of S, Ṡ and −S̈ in Q, with the responses of the spring. Those of a relaxed phase
    /// lose no digits where the dashpot is strong.
    fn factors(&self) -> [f64; 3] {
        let Self { velocity, force, .. } = *self;
        if self.relaxed { [0.0, 0.0, velocity] } else { [self.linear.kappa * velocity, force, 0.0] }
    }

    /// w and Q after a part of the phase.
    pub fn motion_at(&self, since: f64) -> [f64; 2] {
        let response = self.linear.spring.after(since);
        let Self { velocity, force, .. } = *self;
        if self.relaxed {
            // y = w₀ S.
            return [velocity * response.ds, -velocity * response.dds];
        }
        [
            velocity * response.c - force * response.s,
            force * response.ds + self.linear.kappa * velocity * response.s,
        ]
    }

    /// The energy that the dashpot takes in a part of the phase: what the motion loses and the
    /// spring does not hold.
    pub fn taken_by_dashpot(&self, since: f64) -> f64 {
        let c = self.linear.dashpot;
        if c == 0.0 {
            return 0.0;
        }
        let response = self.linear.spring.after(since);
        let integral = self.linear.spring.position_integral(since, &response);
        let [velocity, force] = self.motion_at(since);
        let began = self.velocity;
        let first = if self.relaxed { c * began } else { self.force };
        let moved = began * (response.s + c * integral) - first * integral;
        let spring = 0.5 * (first - c * began + force - c * velocity);
        0.5 * (began - velocity) * (began + velocity) - moved * spring
    }

    /// How often w changes its sign until it is `now`.
    pub fn reversals(&self, since: f64, now: f64) -> usize {
        let Self { velocity, .. } = *self;
        let force = if self.relaxed { self.linear.dashpot * velocity } else { self.force };
        self.linear.spring.sign_changes(velocity, -force, now, since)
    }

    fn signs(&self) -> [f64; 2] {
        [self.side.sign(), -self.side.sign()]
    }

    /// Both gaps, and P, at a place.
    fn gaps_at(&self, place: Place) -> ([Jet; 2], Drive) {
        let Linear { normal, spring: Oscillator { damping, stiffness, .. }, fast, .. } =
            *self.linear;
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

    /// A gap and its rate early in the phase, where the difference of limit and force would lose
    /// its digits.
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
        // The gaps are L ∓ Q.
        let limit = 0.5 * (gaps[0].value + gaps[1].value).abs();
        let force = self.linear.spring.size(self.factors(), place.since);
        let rounding = super::ROUNDING * (limit + force);
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
        let interval = if oscillates { INTERVAL / frequency } else { f64::INFINITY };
        let mut from = self.edge(Place { since: 0.0, left: self.start.left });
        let mut leap = interval;
        let turn = self.linear.turn(&self.start, self.stage);
        for stop in turn.into_iter().chain([self.end()]) {
            while from.place.since < stop.since {
                let ahead = |length: f64| {
                    let since = from.place.since + length;
                    let place = Place { since, left: self.start.left - since };
                    self.edge(if since < stop.since { place } else { stop })
                };
                // Far from the limit many swings are decided at once.
                let mut to = ahead(leap);
                while leap > interval && !self.stays_below(&from, &to) {
                    leap = (0.25 * leap).max(interval);
                    to = ahead(leap);
                }
                if self.stays_below(&from, &to) {
                    leap *= 2.0;
                } else if let Some((index, place)) = self.first_closing([&from, &to]) {
                    return Some(self.released(index, place));
                }
                from = to;
            }
        }
        None
    }

    /// Whether the swings of the spring are below the limit throughout an interval. The limit has
    /// no minimum inside a stage.
    fn stays_below(&self, from: &Edge, to: &Edge) -> bool {
        let limit = |edge: &Edge| 0.5 * (edge.gaps[0].value + edge.gaps[1].value);
        let least = limit(from).min(limit(to));
        let most = self.linear.spring.amplitude(self.factors(), from.place.since);
        most + from.rounding.max(to.rounding) < least
    }

    /// Which gap closes first in an interval on which P has one sign, and where.
    fn first_closing(&self, ends: [&Edge; 2]) -> Option<(usize, Place)> {
        match [0, 1].map(|index| self.closing(index, ends)) {
            [Some(near), Some(far)] if far.since < near.since => Some((1, far)),
            [Some(near), _] => Some((0, near)),
            [None, far] => far.map(|far| (1, far)),
        }
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
