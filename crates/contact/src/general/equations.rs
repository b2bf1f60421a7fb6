//! The equations of a contact with any law, for plain numbers and for all that act like them: what
//! holds along it. What holds at its start is in `start`.

mod start;

use std::ops::Index;

use stickslip_solver::Number;

use super::decay::{Decay, Jet, product};
use super::exponents::Exponents;
use super::hysteresis::{Hysteresis, Yielding};
use super::{
    ContactMode, DAMPING, DASHPOT, FAR_GAP, FAR_RATE, GAP, GUARDS, ModeProgress, RATE, SPRING,
    STATE, Stage, T as TIME, U, V, W,
};
use crate::contact::Contact;
use crate::phase::{OTHER_SIDE, Regime, SAME_SIDE, is_open};

/// The least damping for which the component V is a³(v + u^{p−d}/a); see
/// [`regularized`](crate::regularized).
const STRONG: f64 = 1.0;

/// How near to 1 the ratio of the tangential force to its limit may be at the start of contact.
/// Nearer contacts are computed at this distance: rounding would decide over them time and again.
pub(crate) const BORDER: f64 = 5e-14;

/// The gap over the limit below which a stick phase has only begun.
pub(crate) const AT_LIMIT: f64 = 1e-12;

/// Highest power of u in any equation.
const POWERS: usize = 9;

/// The powers of u, from u⁰.
#[derive(Clone, Copy)]
struct Powers<T>([T; POWERS]);

impl<T> Index<u8> for Powers<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, power: u8) -> &T {
        &self.0[usize::from(power)]
    }
}

/// The equations with the parameters of one contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Equations {
    pub exponents: Exponents,
    hysteresis: Option<Hysteresis>,
    /// The factor of a hysteretic force while the overlap falls, or 1.
    rebound: f64,
    /// The factor of Mindlin's stiffness while the overlap of yielded bodies falls, or 1: the
    /// contact radius is more than u there.
    widened: f64,
    kappa: f64,
    damping: f64,
    /// The part of the tangential damping that Coulomb's limit holds for.
    tangential_damping: f64,
    /// v = by_v·V + by_u·u^{p−d}.
    by_v: f64,
    by_u: f64,
    /// 1/by_v.
    per_v: f64,
    /// F/u^d = force_by_v·V + force_by_u·u^{p−d}.
    force_by_v: f64,
    force_by_u: f64,
    /// The factor c of [`SPRING`].
    pub scale: f64,
    /// Size σ of the velocity.
    velocity_unit: f64,
    /// Q = spring_force·u^ρ·[`SPRING`] + dashpot·u^d·[`W`].
    spring_force: f64,
    dashpot: f64,
    /// The part of the dashpot that Coulomb's limit holds for.
    tested: f64,
    /// The rate of [`SPRING`] is spring_rate·u^β·[`W`].
    spring_rate: f64,
    /// How the limit depends on [`W`], if it does.
    decay: Option<Decay>,
}

impl Equations {
    pub fn new(contact: &Contact) -> Self {
        let exponents = Exponents::new(contact);
        let kappa = contact.kappa();
        let a = if exponents.damped { contact.damping() } else { 0.0 };
        let hysteresis = Hysteresis::new(contact.law(), contact.damping());
        let rebound = hysteresis.map_or(1.0, |it| it.factor);
        let widened = hysteresis.filter(|_| exponents.r > 0).map_or(1.0, |it| 1.0 / it.turned);
        let strong = a >= STRONG;
        let by_v = if strong { a.powi(-3) } else { 1.0 };
        let omega = if exponents.remembers { kappa.sqrt() } else { 0.0 };
        let scale = omega.sqrt().max(1.0);
        let tangential_damping = contact.law().tested_damping(contact.tangential_damping());
        let velocity_unit = contact.psi().min(1.0);
        Self {
            exponents,
            decay: Decay::new(&contact.law().friction, velocity_unit),
            hysteresis,
            rebound,
            widened,
            kappa,
            damping: a,
            tangential_damping,
            by_v,
            per_v: if strong { a.powi(3) } else { 1.0 },
            by_u: if strong { -1.0 / a } else { 0.0 },
            force_by_v: a * by_v,
            force_by_u: if strong { 0.0 } else { 1.0 },
            scale,
            velocity_unit,
            spring_force: omega / scale * velocity_unit,
            dashpot: contact.tangential_damping() * a * velocity_unit,
            tested: tangential_damping * a * velocity_unit,
            spring_rate: f64::from(exponents.n) * omega * scale,
        }
    }

    /// The equations of a contact whose tangential force does not start as its limit does, to
    /// within rounding. A force that has just reached its limit sticks, in particle codes too.
    pub fn off_the_border(self, psi: f64) -> Self {
        let [Some(room), _] = self.beginning_margins(psi) else { return self };
        if room.abs() >= BORDER {
            return self;
        }
        let part = (1.0 - BORDER) / (1.0 - room);
        if self.exponents.damped {
            let tangential_damping = self.tangential_damping * part;
            let [dashpot, tested] = [self.dashpot, self.tested].map(|it| it * part);
            return Self { tangential_damping, dashpot, tested, ..self };
        }
        Self { kappa: self.kappa * part, spring_rate: self.spring_rate * part, ..self }
    }

    /// The factor of the stiffness in a stage.
    #[inline(always)]
    fn stiffening(&self, stage: Stage) -> f64 {
        if stage == Stage::Unloading { self.widened } else { 1.0 }
    }

    /// Whether there is no tangential force at all.
    #[inline(always)]
    pub fn is_frictionless(&self) -> bool {
        !self.exponents.remembers && self.dashpot == 0.0
    }

    /// Whether the bodies yield.
    pub fn yields(&self) -> bool {
        self.hysteresis.is_some_and(|it| it.yielding.is_some())
    }

    /// The part of F/u^d that depends on u where the bodies yield, with its derivatives by u.
    #[inline(always)]
    fn tangent_force<T: Number>(&self, stage: Stage, u: &Powers<T>) -> Option<[T; 3]> {
        if stage != Stage::Yielding {
            return None;
        }
        let Yielding { slope, offset, .. } = self.hysteresis?.yielding?;
        let inverse = u[0] / u[1];
        let [first, third] = [inverse * slope, inverse * inverse * inverse * offset];
        let value = first - third;
        let slope = (third * 3.0 - first) * inverse;
        Some([value, slope, (first * 2.0 - third * 12.0) * inverse * inverse])
    }

    /// Whether friction depends on the velocity.
    #[inline(always)]
    pub fn decays(&self) -> bool {
        self.decay.is_some()
    }

    /// Coulomb's limit in the mode, if it is `limit` at rest.
    #[inline(always)]
    pub fn rubbed<T: Number>(&self, mode: ContactMode, y: &[T; STATE], limit: T) -> T {
        match &self.decay {
            Some(decay) => decay.share(mode.heading, y[W]) * limit,
            None => limit,
        }
    }

    /// Tangential energy that the dashpot has taken.
    pub fn taken_by_dashpot(&self, y: &[f64; STATE]) -> f64 {
        y[DASHPOT] * self.velocity_unit * self.velocity_unit
    }

    /// Reduced tangential velocity w.
    #[inline(always)]
    pub fn velocity<T: Number>(&self, y: &[T; STATE]) -> T {
        y[W] * self.velocity_unit
    }

    /// The rate v of the overlap.
    #[inline(always)]
    pub fn compression_rate<T: Number>(&self, y: &[T; STATE]) -> T {
        self.rate(&powers(y[U]), y)
    }

    #[inline(always)]
    fn rate<T: Number>(&self, u: &Powers<T>, y: &[T; STATE]) -> T {
        y[V] * self.by_v + u[self.exponents.bend] * self.by_u
    }

    /// F/u^d, whose sign is that of the normal force.
    #[inline(always)]
    fn push<T: Number>(&self, stage: Stage, u: &Powers<T>, y: &[T; STATE]) -> T {
        if let Some([push, ..]) = self.tangent_force(stage, u) {
            return push;
        }
        let factor = if stage == Stage::Unloading { self.rebound } else { 1.0 };
        y[V] * self.force_by_v + u[self.exponents.bend] * (self.force_by_u * factor)
    }

    /// The normal force.
    pub fn normal_force(&self, stage: Stage, y: &[f64; STATE]) -> f64 {
        let u = &powers(y[U]);
        u[self.exponents.d] * self.push(stage, u, y)
    }

    /// The size Q of the tangential force of spring and dashpot, divided by u^m.
    #[inline(always)]
    fn pull<T: Number>(&self, stage: Stage, u: &Powers<T>, y: &[T; STATE]) -> T {
        self.pull_with(self.dashpot, stage, u, y)
    }

    /// The part of that for which Coulomb's limit holds.
    #[inline(always)]
    fn tested_pull<T: Number>(&self, stage: Stage, u: &Powers<T>, y: &[T; STATE]) -> T {
        self.pull_with(self.tested, stage, u, y)
    }

    #[inline(always)]
    fn pull_with<T: Number>(&self, dashpot: f64, stage: Stage, u: &Powers<T>, y: &[T; STATE]) -> T {
        let e = self.exponents.of(stage);
        u[e.rho - e.shared] * y[SPRING] * self.spring_force
            + u[self.exponents.d - e.shared] * y[W] * dashpot
    }

    /// The tangential force Q of spring and dashpot.
    pub fn tangential_force(&self, stage: Stage, y: &[f64; STATE]) -> f64 {
        let u = &powers(y[U]);
        u[self.exponents.of(stage).shared] * self.pull(stage, u, y)
    }

    /// The right-hand side of a mode.
    #[inline(always)]
    pub fn field<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> [T; STATE] {
        match (mode.regime, mode.progress) {
            (Regime::Slip, _) => self.slip(mode, y),
            (Regime::Stick, ModeProgress::Settled) => self.stick(mode, y),
            (Regime::Stick, _) => self.first_stick(mode, y),
        }
    }

    /// The right-hand side of a slip phase.
    #[inline(always)]
    pub fn slip<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> [T; STATE] {
        let (mut slope, dv) = self.normal(mode.stage, &powers(y[U]), y);
        let dv = self.rubbed(mode, y, dv);
        slope[W] = dv * (mode.side.sign() * mode.stage.sign() / self.velocity_unit);
        slope
    }

    /// The right-hand side of a stick phase that has settled.
    #[inline(always)]
    pub fn stick<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> [T; STATE] {
        let e = self.exponents;
        let of = e.of(mode.stage);
        let u = &powers(y[U]);
        let (mut slope, _) = self.normal(mode.stage, u, y);
        let pull = self.pull(mode.stage, u, y);
        slope[W] = u[e.last + of.shared] * pull * (-f64::from(e.n) / self.velocity_unit);
        slope[SPRING] = u[of.beta] * y[W] * (self.spring_rate * self.stiffening(mode.stage));
        if self.dashpot > 0.0 {
            let per_w = f64::from(e.n) * self.dashpot / self.velocity_unit;
            slope[DASHPOT] = u[e.last + e.d] * y[W] * y[W] * per_w;
        }
        slope
    }

    /// The right-hand side of a stick phase until it settles.
    #[inline(always)]
    pub fn first_stick<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> [T; STATE] {
        let mut slope = self.stick(mode, y);
        let [near, far] = self.gaps(mode, &powers(y[U]), y).map(|gap| gap.2);
        slope[GAP] = y[RATE] * self.scale;
        slope[FAR_GAP] = y[FAR_RATE] * self.scale;
        slope[RATE] = near / (self.scale * self.scale);
        slope[FAR_RATE] = far / (self.scale * self.scale);
        slope
    }

    /// The right-hand side of the normal motion, and the rate of v.
    #[inline(always)]
    fn normal<T: Number>(&self, stage: Stage, u: &Powers<T>, y: &[T; STATE]) -> ([T; STATE], T) {
        let e = self.exponents;
        let n = f64::from(e.n);
        let v = self.rate(u, y);
        let dv = u[e.last + e.d] * self.push(stage, u, y) * -n;
        let mut slope = [T::from(0.0); STATE];
        slope[U] = v;
        slope[V] = (dv - lowered(u, e.bend) * v * self.by_u) * self.per_v;
        slope[TIME] = u[e.last] * n;
        if e.damped {
            slope[DAMPING] = u[e.last + e.d] * v * v * (n * self.damping);
        }
        (slope, dv)
    }

    /// The gaps between the force and its limit in a stick phase, on the side of the phase and on
    /// the other one, divided by u^m.
    #[inline(always)]
    fn gaps<T: Number>(&self, mode: ContactMode, u: &Powers<T>, y: &[T; STATE]) -> [Jet<T>; 2] {
        let e = self.exponents;
        let of = e.of(mode.stage);
        let n = f64::from(e.n);
        let v = self.rate(u, y);
        let push = self.push(mode.stage, u, y);
        let damping = if e.damped { self.damping } else { 0.0 };
        // dv/ds = −n u^k F/u^d, with k = n − 1 + d.
        let k = e.last + e.d;
        let dv = u[k] * push * -n;
        let [elastic, bent] = match self.tangent_force(mode.stage, u) {
            Some([_, slope, bend]) => [slope, bend],
            None => [lowered(u, e.bend), twice_lowered(u, e.bend)],
        };
        let push1 = elastic * v + dv * damping;
        let ddv = (lowered(u, k) * v * push + u[k] * push1) * -n;
        let push2 = bent * v * v + elastic * dv + ddv * damping;
        let force = lifted(e.d - of.shared, u, v, dv, Jet(push, push1, push2));

        let pull = self.pull(mode.stage, u, y);
        let per_unit = -n / self.velocity_unit;
        let k = e.last + of.shared;
        let dw = u[k] * pull * per_unit;
        let spring_rate = self.spring_rate * self.stiffening(mode.stage);
        let dspring = u[of.beta] * y[W] * spring_rate;
        let ddspring = (lowered(u, of.beta) * v * y[W] + u[of.beta] * dw) * spring_rate;
        let spring = lifted(of.rho - of.shared, u, v, dv, Jet(y[SPRING], dspring, ddspring));
        let damping1 = lowered(u, e.d - of.shared) * v * y[W] + u[e.d - of.shared] * dw;
        let pull1 = spring.1 * self.spring_force + damping1 * self.dashpot;
        let ddw = (lowered(u, k) * v * pull + u[k] * pull1) * per_unit;
        let dashpot = lifted(e.d - of.shared, u, v, dv, Jet(y[W], dw, ddw));
        let force = match &self.decay {
            Some(decay) => product(force, decay.jet(mode.heading, Jet(y[W], dw, ddw))),
            None => force,
        };
        let pull = self.tested_pull(mode.stage, u, y);
        let pull1 = spring.1 * self.spring_force + damping1 * self.tested;
        let pull2 = spring.2 * self.spring_force + dashpot.2 * self.tested;
        let (sign, side) = (mode.stage.sign(), mode.side.sign());
        [-side, side].map(|side| {
            Jet(
                force.0 * sign + pull * side,
                force.1 * sign + pull1 * side,
                force.2 * sign + pull2 * side,
            )
        })
    }

    /// The values of the guards.
    #[inline(always)]
    pub fn guards<T: Number>(&self, mode: ContactMode, y: &[T; STATE]) -> [T; GUARDS] {
        let e = self.exponents;
        let u = &powers(y[U]);
        let of = e.of(mode.stage);
        let v = self.rate(u, y);
        let push = self.push(mode.stage, u, y);
        let end = if e.damped && mode.stage != Stage::Tail { push } else { y[U] };
        let (end, same, other) = match mode.regime {
            Regime::Slip if e.remembers => (end, self.stretching(mode, u, y), T::from(1.0)),
            Regime::Slip => {
                let pull = self.tested_pull(mode.stage, u, y) * mode.side.sign();
                let limit = u[e.d - of.shared] * push * mode.stage.sign();
                (end, pull - self.rubbed(mode, y, limit), T::from(1.0))
            }
            Regime::Stick => {
                if mode.progress == ModeProgress::Settled {
                    let pull = self.tested_pull(mode.stage, u, y) * mode.side.sign();
                    let limit = u[e.d - of.shared] * push * mode.stage.sign();
                    let limit = self.rubbed(mode, y, limit);
                    (end, limit - pull, limit + pull)
                } else {
                    let [near, far] = [y[GAP] * self.scale, y[FAR_GAP] * self.scale];
                    // Late in a contact the force is rounding alone, unlike the gaps.
                    let ends = e.damped && mode.stage == Stage::Main;
                    (if ends { near + far } else { end }, near, far)
                }
            }
        };
        let reversal = if self.decays() { y[W] * mode.heading.sign() } else { y[W] };
        let turn = match self.hysteresis {
            Some(Hysteresis { yielding: Some(it), .. }) if mode.stage == Stage::Main => {
                T::from(it.from) - u[e.n]
            }
            _ => v,
        };
        [end, same, other, turn, reversal]
    }

    /// The guard with which a stick phase is left whose limit has fallen to zero in the state `y`,
    /// and the time from there to the zero.
    pub fn last_slip(&self, mode: ContactMode, y: &[f64; STATE]) -> (usize, f64) {
        let u = &powers(y[U]);
        let [_, near, far, ..] = self.guards(mode, y);
        let falls = self.gaps(mode, u, y).map(|gap| gap.1);
        let length = (far - near).abs() / (falls[0] + falls[1]).abs();
        let time = length * u[self.exponents.last] * f64::from(self.exponents.n);
        (if near < far { SAME_SIDE } else { OTHER_SIDE }, time)
    }

    /// How fast the spring would leave its limit in stick, s dQ/ds − dL/ds, divided by a power of
    /// u. Slip ends where that vanishes.
    #[inline(always)]
    fn stretching<T: Number>(&self, mode: ContactMode, u: &Powers<T>, y: &[T; STATE]) -> T {
        let e = self.exponents;
        let of = e.of(mode.stage);
        let (side, sign) = (mode.side.sign(), mode.stage.sign());
        let (n, w) = (f64::from(e.n), self.velocity(y));
        let v = self.rate(u, y);
        let push = self.push(mode.stage, u, y);
        // One power more than that of the term, so that it is not negative.
        let power = |more: u8| u[more - of.leading];
        let kappa = self.kappa * self.stiffening(mode.stage);
        let mut sum = power(e.last + e.r + 1) * w * (n * kappa * side);
        let ahead = f64::from(of.rho) - f64::from(e.d);
        if ahead != 0.0 {
            let behind = self.rubbed(mode, y, push * sign)
                - w * (side * self.damping * self.tangential_damping);
            sum = sum + power(e.d) * v * behind * ahead;
        }
        if let Some([_, slope, _]) = self.tangent_force(mode.stage, u) {
            sum = sum - self.rubbed(mode, y, power(e.d + 1) * v * slope);
        }
        if e.bend > 0 {
            sum = sum - self.rubbed(mode, y, power(e.p) * v * (sign * f64::from(e.bend)));
        }
        // On the border of slip, b = 1 is moved by rounding. The term is none then.
        if e.uneven {
            let steep = sign * self.damping * n * (1.0 - self.tangential_damping);
            let term = power(2 * e.d + e.last + 1) * push;
            sum = sum + self.rubbed(mode, y, term * steep);
            // The limit grows while slip slows down.
            if let Some(decay) = &self.decay {
                let (excess, slope) = decay.excess_at(mode.heading, y[W]);
                let rate = slope / self.velocity_unit * n * side;
                sum = sum + self.rubbed(mode, y, term * push * excess) * rate;
            }
        }
        sum
    }

    /// The spring that makes the tangential force `size`, in units of u^m.
    fn spring_for(&self, stage: Stage, u: &Powers<f64>, y: &[f64; STATE], size: f64) -> f64 {
        if !self.exponents.remembers {
            return 0.0;
        }
        let of = self.exponents.of(stage);
        let rest = size - u[self.exponents.d - of.shared] * y[W] * self.tested;
        rest / (u[of.rho - of.shared] * self.spring_force)
    }

    /// The state with which `next` begins, from the state `y` at the switch.
    pub fn enter(&self, next: ContactMode, y: &[f64; STATE]) -> [f64; STATE] {
        let u = &powers(y[U]);
        let of = self.exponents.of(next.stage);
        // Where a contact is touched, the limit is zero, and so is the spring.
        let size = if next.progress == ModeProgress::Touched {
            0.0
        } else {
            let push = self.push(next.stage, u, y) * next.stage.sign();
            self.rubbed(next, y, u[self.exponents.d - of.shared] * push)
        };
        let mut y = *y;
        y[TIME] = 0.0;
        for component in [SPRING, GAP, RATE, FAR_GAP, FAR_RATE] {
            y[component] = 0.0;
        }
        if next.regime == Regime::Stick {
            // A contact starts without history.
            if (next.progress, next.stage) != (ModeProgress::Touched, Stage::Main) {
                y[SPRING] = self.spring_for(next.stage, u, &y, size * next.side.sign());
            }
            self.open(next, &mut y);
        }
        y
    }

    /// Sets the gaps with which a stick phase begins. What is zero there is exactly zero.
    fn open(&self, mode: ContactMode, y: &mut [f64; STATE]) {
        let [near, far] = self.gaps(mode, &powers(y[U]), y);
        let (length, rate) = (self.scale, self.scale * self.scale);
        match (mode.progress, mode.stage) {
            (ModeProgress::Touched, Stage::Tail) => {}
            (ModeProgress::Touched, _) => (y[GAP], y[FAR_GAP]) = (near.0 / length, far.0 / length),
            _ => y[FAR_GAP] = far.0 / length,
        }
        y[FAR_RATE] = far.1 / rate;
        // A limit that a history keeps is left with the rate 0.
        if mode.progress != ModeProgress::Switched || !self.exponents.remembers {
            y[RATE] = near.1 / rate;
        }
    }

    /// Whether the gaps of a stick phase are open: see [`is_open`].
    pub fn is_open(&self, mode: ContactMode, y: &[f64; STATE]) -> bool {
        let e = self.exponents;
        let u = &powers(y[U]);
        let [damping, dashpot] = [y[V] * self.force_by_v, y[W] * self.dashpot].map(f64::abs);
        let terms = self.rubbed(mode, y, u[e.bend] * self.force_by_u + damping) + dashpot;
        is_open(self.scale * y[GAP].min(y[FAR_GAP]), u[e.d - e.of(mode.stage).shared] * terms)
    }

    /// Whether the gap on the side of a stick phase, in its first step, grows from within
    /// rounding of 0. One that falls there is on its way to a graze.
    pub fn is_at_limit(&self, mode: ContactMode, y: &[f64; STATE]) -> bool {
        let u = &powers(y[U]);
        let limit = u[self.exponents.d - self.exponents.of(mode.stage).shared]
            * self.push(mode.stage, u, y);
        let near = (y[GAP] * self.scale).abs() < AT_LIMIT * self.rubbed(mode, y, limit);
        mode.regime == Regime::Stick && near && y[RATE] >= 0.0
    }

    /// The state `y` with the gaps with which a stick phase begins.
    pub fn at_limit(&self, mode: ContactMode, mut y: [f64; STATE]) -> [f64; STATE] {
        for component in [GAP, RATE, FAR_GAP, FAR_RATE] {
            y[component] = 0.0;
        }
        self.open(mode, &mut y);
        y
    }

    /// The state at greatest compression, with the history that is carried from there on and the
    /// overlap that a hysteretic force is left with.
    pub fn turn(&self, y: &[f64; STATE]) -> [f64; STATE] {
        let e = self.exponents;
        let [before, behind] = [Stage::Main, Stage::Unloading].map(|it| i32::from(e.of(it).rho));
        let mut y = *y;
        y[SPRING] *= y[U].powi(before - behind);
        if let Some(Hysteresis { turned, lost, .. }) = self.hysteresis {
            // The force is the same before and behind, and all energy is in the compression.
            y[U] *= turned;
            if e.remembers {
                y[SPRING] *= turned.powi(-behind);
            }
            y[DAMPING] = 0.5 * lost;
        }
        y
    }

    /// The overlap that a hysteretic force leaves in a stage.
    pub fn left_over(&self, stage: Stage) -> f64 {
        match self.hysteresis {
            Some(it) if stage == Stage::Unloading => it.left,
            _ => 0.0,
        }
    }
}

#[inline(always)]
fn powers<T: Number>(u: T) -> Powers<T> {
    let mut powers = [T::from(1.0); POWERS];
    powers[1] = u;
    for k in 2..POWERS {
        // Not one after the other, so that none waits for all others.
        powers[k] = powers[k / 2] * powers[k - k / 2];
    }
    Powers(powers)
}

/// d(u^k)/du.
#[inline(always)]
fn lowered<T: Number>(u: &Powers<T>, k: u8) -> T {
    if k == 0 { T::from(0.0) } else { u[k - 1] * f64::from(k) }
}

/// d²(u^k)/du².
#[inline(always)]
fn twice_lowered<T: Number>(u: &Powers<T>, k: u8) -> T {
    if k < 2 { T::from(0.0) } else { u[k - 2] * f64::from(k * (k - 1)) }
}

/// u^k times a quantity, with derivatives, where u' = v.
#[inline(always)]
fn lifted<T: Number>(k: u8, u: &Powers<T>, v: T, dv: T, Jet(x, x1, x2): Jet<T>) -> Jet<T> {
    let rise = lowered(u, k) * v;
    let bend = twice_lowered(u, k) * v * v + lowered(u, k) * dv;
    Jet(u[k] * x, rise * x + u[k] * x1, bend * x + rise * x1 * 2.0 + u[k] * x2)
}
