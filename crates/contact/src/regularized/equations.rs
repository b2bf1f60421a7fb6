//! The equations of the contact, for plain numbers and for numbers that carry a derivative.
//!
//! Runs integrate the equations with plain numbers; sensitivities use the same lines with dual
//! numbers. There is no second law that could disagree.

use num_dual::Dual64;
use stickslip_solver::Number;

use super::components::{GAP, RATE, SPRING, STATE, T as TIME, U, V, W};
use crate::contact::Contact;
use crate::phase::{GUARDS, Phase, PhaseProgress, Regime, Side, is_open};

/// The equations with the parameters of one contact.
#[derive(Clone, Copy, Debug)]
pub struct Equations<T> {
    kappa: T,
    damping: T,
    rate: Rate<T>,
    /// The factor c of [`SPRING`].
    pub scale: f64,
    /// 1/c².
    rate_scale: f64,
    /// 2ωc, the rate of the spring.
    pub spring_rate: T,
    /// 2ω/c, the rate of the velocity.
    velocity_rate: T,
    /// κ y divided by the component [`SPRING`].
    pub spring_force: T,
    /// σ = min(1, ψ), the size of the velocity.
    pub velocity_unit: f64,
}

/// How the component V stands for the rate v of the compression and for the force, where there is
/// damping: v = by_v·V + by_uu·u², and u² + a v = force_by_v·V + force_by_uu·u².
#[derive(Clone, Copy, Debug)]
struct Rate<T> {
    by_v: T,
    by_uu: T,
    force_by_v: T,
    force_by_uu: f64,
}

/// The least damping for which V is a³(v + u²/a).
///
/// Under strong damping the force falls to the part a⁻⁴ of what it was before it ends. The sum u² +
/// a v would then be rounding and errors of steps alone. As a component, with its own unit, it is
/// accurate to the end.
const STRONG: f64 = 1.0;

impl Rate<f64> {
    fn new(a: f64) -> Self {
        if a < STRONG {
            return Self { by_v: 1.0, by_uu: 0.0, force_by_v: a, force_by_uu: 1.0 };
        }
        let by_v = a.powi(-3);
        Self { by_v, by_uu: -1.0 / a, force_by_v: a * by_v, force_by_uu: 0.0 }
    }
}

/// The force F and its first two derivatives with respect to s.
#[derive(Clone, Copy)]
pub struct Force<T> {
    /// F.
    pub value: T,
    /// dF/ds.
    pub first: T,
    /// d²F/ds².
    pub second: T,
}

/// A parameter of the derivatives. Stiffness and impact ratio may have any size: their logarithms
/// are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactParameter {
    /// ln κ.
    LnKappa,
    /// ln ψ.
    LnPsi,
    /// The damping itself.
    Damping,
}

impl ContactParameter {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::LnKappa, Self::LnPsi, Self::Damping];
}

impl Equations<f64> {
    /// The equations of one contact.
    pub fn new(contact: &Contact) -> Self {
        let omega = contact.kappa().sqrt();
        let scale = omega.sqrt().max(1.0);
        let velocity_unit = contact.psi().min(1.0);
        Self {
            kappa: contact.kappa(),
            damping: contact.damping(),
            rate: Rate::new(contact.damping()),
            scale,
            rate_scale: 1.0 / (scale * scale),
            spring_rate: 2.0 * omega * scale,
            velocity_rate: 2.0 * omega / scale,
            spring_force: omega / scale * velocity_unit,
            velocity_unit,
        }
    }

    /// The same equations for other numbers.
    #[inline(always)]
    pub fn of<T: Number>(&self) -> Equations<T> {
        Equations {
            kappa: T::from(self.kappa),
            damping: T::from(self.damping),
            rate: Rate {
                by_v: T::from(self.rate.by_v),
                by_uu: T::from(self.rate.by_uu),
                force_by_v: T::from(self.rate.force_by_v),
                force_by_uu: self.rate.force_by_uu,
            },
            scale: self.scale,
            rate_scale: self.rate_scale,
            spring_rate: T::from(self.spring_rate),
            velocity_rate: T::from(self.velocity_rate),
            spring_force: T::from(self.spring_force),
            velocity_unit: self.velocity_unit,
        }
    }

    /// The same equations with their derivatives with respect to a parameter. The units c, σ and
    /// that of V are kept constant.
    pub fn by(&self, parameter: Option<ContactParameter>) -> Equations<Dual64> {
        let by_kappa = f64::from(parameter == Some(ContactParameter::LnKappa));
        let by_damping = f64::from(parameter == Some(ContactParameter::Damping));
        // Three of the numbers are proportional to ω = √κ.
        let like_root = |value: f64| Dual64::new(value, 0.5 * by_kappa * value);
        Equations {
            kappa: Dual64::new(self.kappa, by_kappa * self.kappa),
            damping: Dual64::new(self.damping, by_damping),
            rate: Rate {
                by_v: Dual64::from(self.rate.by_v),
                by_uu: Dual64::new(self.rate.by_uu, by_damping * self.rate.by_uu.powi(2)),
                force_by_v: Dual64::new(self.rate.force_by_v, by_damping * self.rate.by_v),
                force_by_uu: self.rate.force_by_uu,
            },
            scale: self.scale,
            rate_scale: self.rate_scale,
            spring_rate: like_root(self.spring_rate),
            velocity_rate: like_root(self.velocity_rate),
            spring_force: like_root(self.spring_force),
            velocity_unit: self.velocity_unit,
        }
    }

    /// Whether the gap of a stick phase is [open](crate::phase::Progress::Settled).
    #[inline(always)]
    pub(crate) fn is_open(&self, y: &[f64; STATE]) -> bool {
        let Rate { force_by_v, force_by_uu, .. } = self.rate;
        let terms = y[U] * (y[U] * y[U] * force_by_uu + (force_by_v * y[V]).abs());
        is_open(self.scale * y[GAP], terms)
    }

    /// The state at the start of contact.
    pub fn start(&self, psi: f64) -> [f64; STATE] {
        let mut y = [0.0; STATE];
        y[V] = 1.0 / self.rate.by_v;
        y[W] = psi / self.velocity_unit;
        y[RATE] = self.rate_scale * self.damping;
        y
    }

    /// The derivative of the state at the start of contact with respect to a parameter.
    pub fn start_by(&self, psi: f64, parameter: ContactParameter) -> [f64; STATE] {
        let mut y = [0.0; STATE];
        match parameter {
            ContactParameter::LnKappa => {}
            ContactParameter::LnPsi => y[W] = psi / self.velocity_unit,
            ContactParameter::Damping => y[RATE] = self.rate_scale,
        }
        y
    }
}

impl<T: Number> Equations<T> {
    /// Reduced tangential velocity w.
    #[inline(always)]
    pub fn velocity(&self, y: &[T; STATE]) -> T {
        y[W] * self.velocity_unit
    }

    /// The rate v of the compression, by the components U and V.
    #[inline(always)]
    pub fn compression_rate<const DAMPED: bool>(&self, u: T, v: T) -> T {
        if DAMPED { self.rate.by_v * v + self.rate.by_uu * (u * u) } else { v }
    }

    /// F/u by the components U and V. The contact ends where it vanishes.
    #[inline(always)]
    pub fn push<const DAMPED: bool>(&self, u: T, v: T) -> T {
        let uu = u * u;
        if DAMPED { uu * self.rate.force_by_uu + self.rate.force_by_v * v } else { uu }
    }

    /// The normal force and its derivatives, by the components U and V.
    #[inline(always)]
    pub fn force<const DAMPED: bool>(&self, u: T, v: T) -> Force<T> {
        let uu = u * u;
        if DAMPED {
            let a = self.damping;
            let f1 = self.push::<true>(u, v);
            let v = self.compression_rate::<true>(u, v);
            let dv = uu * -2.0 * f1;
            let df1 = u * 2.0 * v + a * dv;
            let ddv = u * -2.0 * (v * 2.0 * f1 + u * df1);
            let ddf1 = (v * v + u * dv) * 2.0 + a * ddv;
            Force {
                value: u * f1,
                first: v * f1 + u * df1,
                second: dv * f1 + v * 2.0 * df1 + u * ddf1,
            }
        } else {
            let dv = uu * -2.0 * uu;
            Force { value: uu * u, first: uu * 3.0 * v, second: u * 3.0 * (v * 2.0 * v + u * dv) }
        }
    }

    /// The right-hand side of slip.
    #[inline(always)]
    pub fn slip<const DAMPED: bool>(&self, side: Side, y: &[T; STATE]) -> [T; STATE] {
        let (u, zero) = (y[U], T::from(0.0));
        let v = self.compression_rate::<DAMPED>(u, y[V]);
        let dv = self.deceleration::<DAMPED>(u, y[V]);
        let pull = dv * (side.sign() / self.velocity_unit);
        let slope = self.component_rate::<DAMPED>(u, v, dv);
        [v, slope, zero, pull, u * 2.0, self.loss::<DAMPED>(u, v), zero, zero]
    }

    /// The right-hand side of stick.
    #[inline(always)]
    pub fn stick<const DAMPED: bool>(&self, y: &[T; STATE]) -> [T; STATE] {
        let (u, zero) = (y[U], T::from(0.0));
        let v = self.compression_rate::<DAMPED>(u, y[V]);
        let dv = self.deceleration::<DAMPED>(u, y[V]);
        let slope = self.component_rate::<DAMPED>(u, v, dv);
        let stretch = self.spring_rate * u * y[W];
        let pull = -(self.velocity_rate * u) * y[SPRING];
        [v, slope, stretch, pull, u * 2.0, self.loss::<DAMPED>(u, v), zero, zero]
    }

    /// The right-hand side of a stick phase that is not settled, with its gap.
    #[inline(always)]
    pub fn first_stick<const DAMPED: bool>(&self, side: Side, y: &[T; STATE]) -> [T; STATE] {
        let (u, w) = (y[U], self.velocity(y));
        let v = self.compression_rate::<DAMPED>(u, y[V]);
        let pull = self.spring_force * y[SPRING];
        let rate = self.force::<DAMPED>(u, y[V]).second
            + self.kappa * (2.0 * side.sign()) * (u * 2.0 * u * pull - v * w);
        let mut slope = self.stick::<DAMPED>(y);
        slope[GAP] = y[RATE] * self.scale;
        slope[RATE] = rate * self.rate_scale;
        slope
    }

    /// dv/ds, by the components U and V.
    #[inline(always)]
    pub fn deceleration<const DAMPED: bool>(&self, u: T, v: T) -> T {
        u * u * -2.0 * self.push::<DAMPED>(u, v)
    }

    /// The rate of the component V, by u, the rate v and dv/ds.
    #[inline(always)]
    fn component_rate<const DAMPED: bool>(&self, u: T, v: T, dv: T) -> T {
        if DAMPED { (dv - self.rate.by_uu * 2.0 * (u * v)) / self.rate.by_v } else { dv }
    }

    /// The rate in s of the energy that damping takes.
    #[inline(always)]
    fn loss<const DAMPED: bool>(&self, u: T, v: T) -> T {
        if DAMPED { self.damping * 2.0 * (u * v) * (u * v) } else { T::from(0.0) }
    }

    /// s κ w, which the guard of slip on side s contains.
    #[inline(always)]
    pub fn stretching(&self, side: Side, y: &[T; STATE]) -> T {
        self.kappa * side.sign() * self.velocity(y)
    }

    /// The right-hand side of a phase.
    #[inline(always)]
    pub fn field<const DAMPED: bool>(&self, phase: Phase, y: &[T; STATE]) -> [T; STATE] {
        match (phase.regime, phase.progress) {
            (Regime::Slip, _) => self.slip::<DAMPED>(phase.side, y),
            (Regime::Stick, PhaseProgress::Settled) => self.stick::<DAMPED>(y),
            (Regime::Stick, _) => self.first_stick::<DAMPED>(phase.side, y),
        }
    }

    /// The values of the guards. The guard of slip is s w − dL/dt, without damping in the form that
    /// does not vanish by itself where u = 0.
    #[inline(always)]
    pub fn guards<const DAMPED: bool>(&self, phase: Phase, y: &[T; STATE]) -> [T; GUARDS] {
        let (u, v) = (y[U], y[V]);
        let end = if DAMPED { self.push::<true>(u, v) } else { u };
        match phase.regime {
            Regime::Slip => {
                let pull = self.stretching(phase.side, y);
                let leave = if DAMPED {
                    u * 2.0 * pull - self.force::<true>(u, v).first
                } else {
                    pull - u * 1.5 * v
                };
                [end, leave, T::from(1.0)]
            }
            Regime::Stick => {
                let pull = (self.spring_force * y[SPRING]) * phase.side.sign();
                if phase.progress == PhaseProgress::Settled {
                    let force = u * self.push::<DAMPED>(u, v);
                    [end, force - pull, force + pull]
                } else if DAMPED {
                    // A phase may begin so late that u² + a v is rounding alone. The force is
                    // therefore computed from gap and spring.
                    let gap = y[GAP] * self.scale;
                    [gap + pull, gap, gap + pull * 2.0]
                } else {
                    [end, y[GAP], u * u * u + pull]
                }
            }
        }
    }

    /// The state with which the phase `next` begins, from the state `y` at the switch.
    #[inline(always)]
    pub fn enter<const DAMPED: bool>(&self, next: Phase, y: &[T; STATE]) -> [T; STATE] {
        let zero = T::from(0.0);
        let spring = match next.regime {
            Regime::Stick => {
                self.force::<DAMPED>(y[U], y[V]).value * next.side.sign() / self.spring_force
            }
            Regime::Slip => zero,
        };
        let mut y = *y;
        (y[TIME], y[GAP], y[RATE], y[SPRING]) = (zero, zero, zero, spring);
        y
    }
}
