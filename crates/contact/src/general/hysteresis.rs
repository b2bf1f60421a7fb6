//! Normal forces that are other ones while the overlap falls: what follows from the energy at
//! greatest compression, in scaled units.

use crate::law::{Damping, Law, Normal};

/// A hysteretic force: while the overlap falls, it is `factor` (x − `left`)^q, where q is that of
/// the elastic force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hysteresis {
    pub factor: f64,
    /// u behind greatest compression over u before it, where uⁿ is the overlap that pushes.
    pub turned: f64,
    /// The overlap that is left where the force ends.
    pub left: f64,
    /// The part of the energy that is lost.
    pub lost: f64,
    pub yielding: Option<Yielding>,
}

/// A force that yields: behind an overlap it is `slope` x − `offset`, the tangent of x^{3/2}.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Yielding {
    /// The overlap.
    pub from: f64,
    pub slope: f64,
    pub offset: f64,
}

impl Hysteresis {
    /// The hysteresis of a contact with the scaled damping a; `None` if the force is elastic.
    pub fn new(law: Law, damping: f64) -> Option<Self> {
        match law.damping {
            Damping::Hysteretic | Damping::Hardening => Some(Self::stiffening(law, damping)),
            Damping::Yielding if damping > 1.0 => Some(Self::yielding(damping)),
            _ => None,
        }
    }

    /// The force is 1 + a times as stiff.
    fn stiffening(law: Law, damping: f64) -> Self {
        // The overlap and the energy are divided alike.
        let (power, greatest) = match law.normal {
            Normal::Linear => (1.0, 1.0),
            _ => (2.0 / 3.0, 1.25_f64.powf(0.4)),
        };
        let lost = -(-power * damping.ln_1p()).exp_m1();
        let turned = (1.0 + damping).powf(-1.0 / if power == 1.0 { 1.0 } else { 3.0 });
        Self { factor: 1.0 + damping, turned, left: greatest * lost, lost, yielding: None }
    }

    /// The radius of curvature grows, so that the contact radius stays what it is.
    fn yielding(damping: f64) -> Self {
        let from = 1.25_f64.powf(0.4) * damping.powf(-0.8);
        let ratio = overlap_ratio(damping);
        let root = from.sqrt();
        // The radius, over what it was.
        let radius = 2.0 * ratio * ratio.sqrt() / (3.0 * ratio - 1.0);
        Self {
            factor: radius.sqrt(),
            turned: 1.0 / radius.sqrt(),
            left: ratio * from * (1.0 - 1.0 / radius),
            lost: 1.0 - restored(ratio),
            yielding: Some(Yielding { from, slope: 1.5 * root, offset: 0.5 * root * from }),
        }
    }
}

impl Law {
    /// ε_n of a hysteretic force with the scaled damping a, in closed form; `None` for other
    /// forces.
    ///
    /// ```
    /// use stickslip_contact::{Damping, Law};
    ///
    /// // Thornton, J. Appl. Mech. 64, 383 (1997), eq. 45, with v_y/v = 1/4.
    /// let law = Law { damping: Damping::Yielding, ..Law::PAPER };
    /// let (ratio, e_n) = (0.25_f64, law.hysteretic_e_n(4.0).ok_or("no hysteresis")?);
    /// let elastic = ratio / (ratio + 2.0 * (1.2 - 0.2 * ratio * ratio).sqrt());
    /// let square = 1.2 * 3.0_f64.sqrt() * (1.0 - ratio * ratio / 6.0) * elastic.sqrt();
    /// assert!((e_n - square.sqrt()).abs() < 1e-15);
    /// assert_eq!(law.hysteretic_e_n(0.9), Some(1.0));
    /// # Ok::<(), &str>(())
    /// ```
    pub fn hysteretic_e_n(&self, damping: f64) -> Option<f64> {
        match (self.damping, self.normal) {
            (Damping::Yielding, _) => Some(restored(overlap_ratio(damping.max(1.0))).sqrt()),
            (Damping::Hysteretic | Damping::Hardening, Normal::Linear) => {
                Some((-0.5 * damping.ln_1p()).exp())
            }
            (Damping::Hysteretic | Damping::Hardening, _) => Some((-damping.ln_1p() / 3.0).exp()),
            _ => None,
        }
    }
}

/// The greatest overlap over that where yield begins, if the velocity is so many times that of
/// yield: with q for it, a² = 1 + (5/2)(q − 1) + (15/8)(q − 1)².
fn overlap_ratio(damping: f64) -> f64 {
    let excess = damping.mul_add(damping, -1.0);
    1.0 + 2.0 * excess / (2.5 + (6.25 + 7.5 * excess).sqrt())
}

/// The part of the energy that a force gives back that has yielded up to q times the overlap.
fn restored(q: f64) -> f64 {
    let force = 3.0 * q - 1.0;
    force * force / (q.sqrt() * ((7.5 * q - 5.0) * q + 1.5))
}
