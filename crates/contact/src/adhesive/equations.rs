//! The equations of a contact with adhesion, for plain numbers and for all that act like them.

use stickslip_solver::Number;

use super::shape::Shape;
use crate::contact::Contact;
use crate::general::decay::{Jet, product};
use crate::general::equations::{AT_LIMIT, BORDER};
use crate::general::{
    Beginning, ContactMode, DAMPING, DASHPOT, FAR_GAP, FAR_RATE, GAP, ModeProgress, RATE, SPRING,
    STATE, Stage, T as TIME, U, V, W,
};
use crate::law::{Damping, HistoryOf, Tangential};
use crate::phase::{Regime, Side, is_open};

use super::GUARDS;

/// The equations with the parameters of one contact.
///
/// ```text
/// u' = v    v' = −x' (F_el(u) + η(u) v)    x' = dx/du = dt/ds
/// h' = ω x' r^j w    Q = ω r^i h + b η w
/// ```
///
/// where r is the contact radius and h the history over a power of it: what is rescaled while the
/// overlap falls is constant then over r. i + j is the power of r in the stiffness.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equations {
    pub shape: Shape,
    /// a, and the power of the radius that it goes with.
    damping: (f64, i32),
    /// b a.
    dashpot: f64,
    kappa: f64,
    /// The power of the radius in the stiffness.
    stiffness: i32,
    history: HistoryOf,
    /// Whether the history is rescaled while the overlap falls.
    pub rescaled: bool,
    /// The factor c of [`SPRING`], as in [`general`](crate::general).
    scale: f64,
    /// Size σ of the velocity.
    velocity_unit: f64,
    /// Q = spring_force·r^i·[`SPRING`] + b η w.
    spring_force: f64,
    /// The rate of [`SPRING`] is spring_rate·x'·r^j·[`W`].
    spring_rate: f64,
}

impl Equations {
    pub fn new(contact: &Contact) -> Self {
        let law = contact.law();
        let (kappa, a) = (contact.kappa(), contact.damping());
        let omega = if law.remembers() { kappa.sqrt() } else { 0.0 };
        let scale = omega.sqrt().max(1.0);
        let velocity_unit = contact.psi().min(1.0);
        Self {
            shape: Shape::new(&law),
            damping: (a, i32::from(law.damping == Damping::Viscoelastic)),
            dashpot: contact.tangential_damping() * a,
            kappa,
            stiffness: i32::from(law.tangential == Tangential::Mindlin),
            history: law.history,
            rescaled: law.rescaled && law.remembers(),
            scale,
            velocity_unit,
            spring_force: omega / scale * velocity_unit,
            spring_rate: omega * scale,
        }
    }

    pub fn remembers(&self) -> bool {
        self.history != HistoryOf::None
    }

    /// Whether there is no tangential force at all.
    pub fn is_frictionless(&self) -> bool {
        !self.remembers() && self.dashpot == 0.0
    }

    /// The powers i and j of the radius in the force of the history and in its rate.
    #[inline(always)]
    fn powers(&self, stage: Stage) -> (i32, i32) {
        let down = i32::from(self.rescaled && stage == Stage::Unloading);
        match self.history {
            HistoryOf::Displacement => (self.stiffness + down, -down),
            HistoryOf::Force => (down, self.stiffness - down),
            HistoryOf::None => (0, 0),
        }
    }

    /// One minus the ratio of the dashpot's force to its limit at the start of contact, if there is
    /// such a force.
    pub fn start_room(&self, psi: f64) -> Option<f64> {
        let first = self.shape.first();
        let force = self.dashpot_at(first).0 * psi;
        (force > 0.0).then(|| 1.0 - force / self.limit(first))
    }

    /// How the contact starts.
    pub fn beginning(&self, psi: f64) -> Beginning {
        let begins_to_slip = self.start_room(psi).is_some_and(|room| room <= 0.0);
        if !begins_to_slip {
            return Beginning::Stick;
        }
        let mode = ContactMode {
            regime: Regime::Slip,
            side: Side::Positive,
            stage: Stage::Main,
            progress: ModeProgress::Touched,
            heading: Side::Positive,
        };
        let soft = self.shape.starts_at_end() && self.powers(Stage::Main).0 > 0;
        if !self.remembers() {
            Beginning::Slip
        } else if soft {
            // The spring stiffens from 0: what it was set to turns it over.
            Beginning::Overturned
        } else if self.stretching(mode, &self.start(psi)) < 0.0 {
            Beginning::Reset
        } else {
            Beginning::Slip
        }
    }

    /// The equations of a contact whose dashpot does not start at the limit, to within rounding.
    pub fn off_the_border(self, psi: f64) -> Self {
        match self.start_room(psi) {
            Some(room) if room.abs() < BORDER => {
                Self { dashpot: self.dashpot * (1.0 - BORDER) / (1.0 - room), ..self }
            }
            _ => self,
        }
    }

    /// The state at the start of contact.
    pub fn start(&self, psi: f64) -> [f64; STATE] {
        let mut y = [0.0; STATE];
        (y[U], y[V], y[W]) = (self.shape.first(), 1.0, psi / self.velocity_unit);
        y
    }

    /// Reduced tangential velocity w.
    #[inline(always)]
    pub fn velocity<T: Number>(&self, y: &[T; STATE]) -> T {
        y[W] * self.velocity_unit
    }

    /// Tangential energy that the dashpot has taken.
    pub fn taken_by_dashpot(&self, y: &[f64; STATE]) -> f64 {
        y[DASHPOT] * self.velocity_unit * self.velocity_unit
    }

    /// Coulomb's limit: the elastic force plus twice the force of pull-off.
    #[inline(always)]
    pub fn limit<T: Number>(&self, u: T) -> T {
        self.shape.elastic(u).0 + 2.0 * self.shape.pull_off
    }

    /// η.
    #[inline(always)]
    fn damping_at<T: Number>(&self, u: T) -> T {
        self.shape.radius(self.damping.1, u).0 * self.damping.0
    }

    /// b η with two derivatives in u.
    #[inline(always)]
    fn dashpot_at<T: Number>(&self, u: T) -> Jet<T> {
        let Jet(power, by, bend) = self.shape.radius(self.damping.1, u);
        Jet(power * self.dashpot, by * self.dashpot, bend * self.dashpot)
    }

    /// The normal force.
    #[inline(always)]
    pub fn normal_force<T: Number>(&self, y: &[T; STATE]) -> T {
        self.shape.elastic(y[U]).0 + self.damping_at(y[U]) * y[V]
    }

    /// The tangential force Q of spring and dashpot.
    #[inline(always)]
    pub fn pull<T: Number>(&self, stage: Stage, y: &[T; STATE]) -> T {
        let carried = self.shape.radius(self.powers(stage).0, y[U]).0;
        carried * y[SPRING] * self.spring_force + self.dashpot_at(y[U]).0 * self.velocity(y)
    }

    /// The right-hand side of a mode.
    #[inline(always)]
    pub fn field<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> [T; STATE] {
        let (clock, _) = self.shape.clock(y[U]);
        let damping = self.damping_at(y[U]);
        let mut slope = [T::from(0.0); STATE];
        slope[U] = y[V];
        slope[V] = -(clock * (self.shape.elastic(y[U]).0 + damping * y[V]));
        slope[TIME] = clock;
        slope[DAMPING] = clock * damping * y[V] * y[V];
        if mode.regime == Regime::Slip {
            slope[W] = clock * self.limit(y[U]) * (-mode.side.sign() / self.velocity_unit);
            return slope;
        }
        let growth = self.shape.clock_by_radius(self.powers(mode.stage).1, y[U]).0;
        slope[W] = clock * self.pull(mode.stage, y) * (-1.0 / self.velocity_unit);
        slope[SPRING] = growth * y[W] * self.spring_rate;
        slope[DASHPOT] = clock * self.dashpot_at(y[U]).0 * y[W] * y[W];
        if matches!(mode.progress, ModeProgress::Switched | ModeProgress::Reset) {
            let [near, far] = self.gaps(mode, y).map(|gap| gap.2);
            slope[GAP] = y[RATE] * self.scale;
            slope[FAR_GAP] = y[FAR_RATE] * self.scale;
            slope[RATE] = near / (self.scale * self.scale);
            slope[FAR_RATE] = far / (self.scale * self.scale);
        }
        slope
    }

    /// The gaps between the force and its limit in a stick phase, on the side of the phase and on
    /// the other one, with their derivatives in s.
    #[inline(always)]
    fn gaps<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> [Jet<T>; 2] {
        let (u, v, w) = (y[U], y[V], y[W]);
        let (clock, clock_slope) = self.shape.clock(u);
        let dv = -(clock * self.normal_force(y));
        let along = |Jet(f, by, bend): Jet<T>| Jet(f, by * v, bend * v * v + by * dv);
        let limit = along(self.shape.elastic(u));

        let (carry, grow) = self.powers(mode.stage);
        let per_unit = -1.0 / self.velocity_unit;
        let pull = self.pull(mode.stage, y);
        let dw = clock * pull * per_unit;
        let (growth, growth_slope) = self.shape.clock_by_radius(grow, u);
        let history = Jet(
            y[SPRING],
            growth * w * self.spring_rate,
            (growth_slope * v * w + growth * dw) * self.spring_rate,
        );
        let spring = product(along(self.shape.radius(carry, u)), history);
        let dashpot = along(self.dashpot_at(u));
        let unit = self.velocity_unit;
        let pull1 = spring.1 * self.spring_force + (dashpot.1 * w + dashpot.0 * dw) * unit;
        let ddw = (clock_slope * v * pull + clock * pull1) * per_unit;
        let dashpot = product(dashpot, Jet(w, dw, ddw));
        let pull2 = spring.2 * self.spring_force + dashpot.2 * unit;
        let side = mode.side.sign();
        [-side, side].map(|side| {
            Jet(
                limit.0 + 2.0 * self.shape.pull_off + pull * side,
                limit.1 + pull1 * side,
                limit.2 + pull2 * side,
            )
        })
    }

    /// The values of the guards.
    #[inline(always)]
    pub fn guards<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> [T; GUARDS] {
        let end = y[U] - self.shape.last;
        let integrated = matches!(mode.progress, ModeProgress::Switched | ModeProgress::Reset);
        let (same, other) = match mode.regime {
            Regime::Slip if self.remembers() => (self.stretching(mode, y), T::from(1.0)),
            Regime::Slip => {
                let pull = self.pull(mode.stage, y) * mode.side.sign();
                (pull - self.limit(y[U]), T::from(1.0))
            }
            Regime::Stick if integrated => (y[GAP] * self.scale, y[FAR_GAP] * self.scale),
            Regime::Stick => {
                let pull = self.pull(mode.stage, y) * mode.side.sign();
                let limit = self.limit(y[U]);
                (limit - pull, limit + pull)
            }
        };
        let energy = y[V] * y[V] * 0.5 + self.shape.energy_since_end(y[U]);
        [end, same, other, y[V], y[W], energy]
    }

    /// How fast the spring would leave its limit in stick, s dQ/ds − dL/ds, times or over u:
    /// smooth, and not 0 at the ends of contact. Slip ends where it vanishes.
    #[inline(always)]
    fn stretching<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> T {
        let (u, v, w) = (y[U], y[V], self.velocity(y));
        let side = mode.side.sign();
        let limit = self.limit(u);
        let Jet(dashpot, dashpot_slope, _) = self.dashpot_at(u);
        let carried = self.powers(mode.stage).0 * self.shape.radius_power();
        let even = self.damping.1 == 0 || self.dashpot == 0.0;
        if self.shape.starts_at_end() && carried == 0 && even {
            // All terms vanish with u, at both ends of contact: it is divided out.
            let spring = self.shape.radius(self.stiffness, u).0 * w * (2.0 * self.kappa * side);
            return spring - dashpot * limit * 2.0 - u * v * 3.0;
        }
        let (clock, _) = self.shape.clock(u);
        let stiffness = self.shape.clock_by_radius(self.stiffness, u).0;
        let spring = stiffness * w * (self.kappa * side) + dashpot_slope * v * w * side;
        let rest = spring - dashpot * clock * limit - self.shape.elastic(u).1 * v;
        if carried == 0 {
            return rest;
        }
        rest * u + (limit - dashpot * w * side) * v * f64::from(carried)
    }

    /// The state with which `next` begins, from the state `y` at the switch.
    pub fn enter(&self, next: ContactMode, y: &[f64; STATE]) -> [f64; STATE] {
        let mut y = *y;
        y[TIME] = 0.0;
        for component in [SPRING, GAP, RATE, FAR_GAP, FAR_RATE] {
            y[component] = 0.0;
        }
        // A contact starts without history.
        if next.regime == Regime::Stick && next.progress != ModeProgress::Touched {
            if self.remembers() {
                let size = self.limit(y[U]) * next.side.sign();
                let rest = size - self.dashpot_at(y[U]).0 * self.velocity(&y);
                let carried = self.shape.radius(self.powers(next.stage).0, y[U]).0;
                y[SPRING] = rest / (carried * self.spring_force);
            }
            return self.at_limit(next, y);
        }
        y
    }

    /// The state `y` with the gaps with which a stick phase begins. What is zero there is exactly
    /// zero.
    pub fn at_limit(&self, mode: ContactMode, mut y: [f64; STATE]) -> [f64; STATE] {
        let [near, far] = self.gaps(mode, &y);
        (y[GAP], y[FAR_GAP]) = (0.0, far.0 / self.scale);
        y[FAR_RATE] = far.1 / (self.scale * self.scale);
        // A limit that a history keeps is left with the rate 0.
        let keeps = mode.progress == ModeProgress::Switched && self.remembers();
        y[RATE] = if keeps { 0.0 } else { near.1 / (self.scale * self.scale) };
        y
    }

    /// Whether the gaps of a stick phase are open: see [`is_open`].
    pub fn is_open(&self, mode: ContactMode, y: &[f64; STATE]) -> bool {
        let terms = self.limit(y[U]) + self.pull(mode.stage, y).abs();
        is_open(self.scale * y[GAP].min(y[FAR_GAP]), terms)
    }

    /// Whether the gap on the side of a stick phase grows from within rounding of 0.
    pub fn is_at_limit(&self, mode: ContactMode, y: &[f64; STATE]) -> bool {
        let near = (y[GAP] * self.scale).abs() < AT_LIMIT * self.limit(y[U]);
        mode.regime == Regime::Stick && near && y[RATE] >= 0.0
    }

    /// The state at greatest compression, with the history that is carried from there on.
    pub fn turn(&self, y: &[f64; STATE]) -> [f64; STATE] {
        let mut y = *y;
        y[SPRING] /= self.shape.radius(1, y[U]).0;
        y
    }
}
