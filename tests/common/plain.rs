//! A second opinion on contact laws: the equations as particle codes write them, in plain time.
//!
//! Overlap, velocities and history are stepped by the classical Runge–Kutta method with small
//! steps, graded at both ends of contact. Switches are found by signs at the ends of steps and
//! bisection. Nothing is shared with the solver or the model but the parameters. Several packages
//! share this file.

use crate::model::{
    Collision, Contact, ContactEnd, CoulombTest, Damping, HistoryOf, Normal, Tangential,
};

/// Longest step in units of 1/(1 + √κ).
const STEP: f64 = 5e-3;
/// First step: so small that what it does to the start of a contact is over before anything lasts.
const FIRST: f64 = 1e-100;

/// Overlap, its rate, tangential velocity and history.
type State = [f64; 4];

/// What the second opinion finds.
pub struct Found {
    pub eps_t: f64,
    /// A character for each phase, and the time at which it begins.
    pub phases: Vec<(char, f64)>,
    /// The end of contact, or of its force where a free flight follows.
    pub end: f64,
}

/// The regime: stick, or slip with the sign of the force.
#[derive(Clone, Copy, PartialEq)]
enum Regime {
    Stick,
    Slip(f64),
}

impl Regime {
    fn name(self) -> char {
        match self {
            Self::Stick => 'o',
            Self::Slip(side) if side > 0.0 => '+',
            Self::Slip(_) => '-',
        }
    }
}

/// The law with its parameters.
struct Plain(Contact);

pub fn collide(contact: Contact) -> Option<Found> {
    let plain = Plain(contact);
    let step = STEP / (1.0 + contact.kappa().sqrt() + contact.damping() * 10.0);
    let mut y = [FIRST, 1.0, contact.psi(), plain.stiff_start(contact.psi())];
    let mut regime = plain.correct(&mut y, Regime::Stick);
    let mut phases = vec![(regime.name(), 0.0)];
    let (mut h, mut time) = (FIRST, 0.0);
    for _ in 0..100_000 {
        let near_end = if y[1] < 0.0 { (0.02 * y[0] / -y[1]).max(1e-13) } else { step };
        let mut dt = h.min(step).min(near_end);
        h *= 1.03;
        let ended = |y: &State| y[0] <= 0.0 || (plain.ends_by_force() && plain.force(y) <= 0.0);
        let sign = plain.force(&y) > 0.0;
        let changed =
            |y: &State| ended(y) || (plain.force(y) > 0.0) != sign || plain.leaves(regime, y);
        let mut next = plain.step(regime, &y, dt);
        if changed(&next) {
            let mut low = 0.0;
            for _ in 0..60 {
                let middle = 0.5 * (low + dt);
                let at = plain.step(regime, &y, middle);
                if changed(&at) {
                    (dt, next) = (middle, at);
                } else {
                    low = middle;
                }
            }
            h = h.min(1e-3 * step);
        }
        (y, time) = (next, time + dt);
        if ended(&y) || (plain.force(&y) <= 0.0 && plain.0.law().limit_damping) {
            let eps_t = y[2] / contact.psi();
            return Some(Found { eps_t, phases, end: time });
        }
        regime = plain.correct(&mut y, regime);
        if phases.last().is_none_or(|(last, _)| *last != regime.name()) {
            phases.push((regime.name(), time));
        }
    }
    None
}

impl Plain {
    fn ends_by_force(&self) -> bool {
        self.0.law().end == ContactEnd::Force && self.0.damping() > 0.0
    }

    fn eta(&self, x: f64) -> f64 {
        let x = x.max(0.0);
        self.0.damping()
            * match self.0.law().damping {
                Damping::None => 0.0,
                Damping::Linear => 1.0,
                Damping::Viscoelastic => x.sqrt(),
                Damping::Tsuji => x.sqrt().sqrt(),
                other => panic!("{other:?} is compared elsewhere"),
            }
    }

    /// The normal force.
    fn force(&self, &[x, v, ..]: &State) -> f64 {
        let x = x.max(0.0);
        let elastic = match self.0.law().normal {
            Normal::Linear => x,
            Normal::Hertz => x * x.sqrt(),
            other => panic!("{other:?} is compared elsewhere"),
        };
        elastic + self.eta(x) * v
    }

    /// Coulomb's limit.
    fn limit(&self, y: &State) -> f64 {
        self.force(y).abs() * self.0.law().friction.share(y[2])
    }

    fn stiffness(&self, x: f64) -> f64 {
        match self.0.law().tangential {
            Tangential::Constant => self.0.kappa(),
            Tangential::Mindlin => self.0.kappa() * x.max(0.0).sqrt(),
        }
    }

    fn of_force(&self) -> bool {
        self.0.law().history == HistoryOf::Force
    }

    /// The history after the first step.
    fn stiff_start(&self, psi: f64) -> f64 {
        let history = psi * FIRST;
        if self.of_force() { history * self.stiffness(FIRST) * 2.0 / 3.0 } else { history }
    }

    fn dashpot(&self, y: &State) -> f64 {
        self.0.tangential_damping() * self.eta(y[0]) * y[2]
    }

    /// The force of the spring.
    fn spring(&self, y: &State) -> f64 {
        match self.0.law().history {
            HistoryOf::None => 0.0,
            HistoryOf::Force => y[3],
            HistoryOf::Displacement => self.stiffness(y[0]) * y[3],
        }
    }

    /// The part of the dashpot's force for which Coulomb's limit holds.
    fn tested_dashpot(&self, y: &State) -> f64 {
        let law = self.0.law();
        let tested = law.coulomb_test == CoulombTest::Total || law.history == HistoryOf::None;
        if tested { self.dashpot(y) } else { 0.0 }
    }

    /// The force for which Coulomb's limit holds.
    fn trial(&self, y: &State) -> f64 {
        self.spring(y) + self.tested_dashpot(y)
    }

    fn slope(&self, regime: Regime, y: &State) -> State {
        let [x, v, w, h] = *y;
        let force = self.force(y);
        let pull = match regime {
            Regime::Stick => self.spring(y) + self.dashpot(y),
            Regime::Slip(side) => side * self.limit(y),
        };
        let mut stretch = if self.of_force() { self.stiffness(x) * w } else { w };
        if self.0.law().rescaled && v < 0.0 && x > 0.0 {
            stretch += h * v / (2.0 * x);
        }
        let stretch = if regime == Regime::Stick { stretch } else { 0.0 };
        [v, -force, -pull, stretch]
    }

    fn step(&self, regime: Regime, y: &State, h: f64) -> State {
        let along = |k: &State, h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
        let k1 = self.slope(regime, y);
        let k2 = self.slope(regime, &along(&k1, 0.5 * h));
        let k3 = self.slope(regime, &along(&k2, 0.5 * h));
        let k4 = self.slope(regime, &along(&k3, h));
        std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }

    /// Sets the history such that spring and dashpot have the force `size`.
    fn set(&self, y: &mut State, size: f64) {
        let spring = size - self.tested_dashpot(y);
        y[3] = if self.of_force() { spring } else { spring / self.stiffness(y[0]) };
    }

    /// Whether the spring leaves its limit inwards (slip), or is beyond it (stick).
    fn leaves(&self, regime: Regime, y: &State) -> bool {
        match regime {
            Regime::Stick => self.trial(y).abs() > self.limit(y),
            Regime::Slip(_) if self.0.law().history == HistoryOf::None => {
                self.trial(y).abs() < self.limit(y)
            }
            Regime::Slip(side) => {
                // What a short stick phase would do, by central differences.
                let mut start = *y;
                self.set(&mut start, side * self.limit(y));
                let growth = y[0] / y[1].abs();
                let short = (1e-3 * growth).min(1e-9);
                let speed = self.force(&self.step(regime, y, short)) - self.force(y);
                let until_zero = short * (self.force(y) / speed).abs();
                let h = (1e-4 * growth).min(1e-6).min(1e-2 * until_zero);
                let gap = |h: f64| {
                    let at = self.step(Regime::Stick, &start, h);
                    self.limit(&at) - side * self.trial(&at)
                };
                gap(h) - gap(-h) > 0.0
            }
        }
    }

    /// The regime that holds from `y` on, with its history.
    fn correct(&self, y: &mut State, regime: Regime) -> Regime {
        let limit = self.limit(y);
        match regime {
            Regime::Slip(side) if self.leaves(regime, y) => {
                self.set(y, side * limit);
                Regime::Stick
            }
            Regime::Stick if self.leaves(regime, y) => {
                let side = self.trial(y).signum();
                let slip = Regime::Slip(side);
                self.set(y, side * limit);
                slip
            }
            same => same,
        }
    }
}

/// The itinerary of a collision up to `end` without phases that plain time does not resolve.
pub fn lasting(collision: &Collision, end: f64) -> String {
    let itinerary = collision.itinerary();
    let times = std::iter::once(0.0).chain(collision.switches.iter().map(|switch| switch.time));
    longer(itinerary.chars().zip(times), end.min(collision.contact_time))
}

/// The phases that last, among phases with the times at which they begin.
pub fn longer(phases: impl Iterator<Item = (char, f64)>, end: f64) -> String {
    /// The shortest phase that counts.
    const SHORTEST: f64 = 1e-5;
    let phases: Vec<_> = phases.collect();
    let ends = phases.iter().skip(1).map(|(_, time)| *time).chain([end]);
    let mut itinerary = String::new();
    for ((phase, begin), end) in phases.iter().zip(ends) {
        if end - begin > SHORTEST && !itinerary.ends_with(*phase) {
            itinerary.push(*phase);
        }
    }
    itinerary
}
