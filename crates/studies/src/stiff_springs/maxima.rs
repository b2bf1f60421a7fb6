//! What is measured of full collisions at one stiffness.

use stickslip_model::{Collider, CollisionFailure, exact};
use stickslip_plane::Range;

use super::limit::{self, Crest, contact};
use crate::error::StudyError;

/// Up to this stiffness the integrator, whose work grows as √κ, repeats what the exact engine
/// found.
const MOST_INTEGRATED: f64 = 1e8;

/// Up to this stiffness single oscillations are resolved in a picture.
pub const MOST_RESOLVED: f64 = 3e3;
/// Points of an oscillation in such a picture.
const FINE: f64 = 40.0;

/// The largest |w_final| at one stiffness and around one ψ, and the switches there.
#[derive(Clone, Debug)]
pub struct LargestVelocity {
    /// The stiffness.
    pub kappa: f64,
    /// The impact ratio.
    pub psi: f64,
    /// The top of the oscillation around ψ.
    pub crest: Crest,
    /// |w_final| at this top by dop853; NaN above the largest stiffness that is integrated.
    pub integrated: f64,
    /// The number of switches at ψ itself.
    pub switch_count: usize,
    /// This number over √κ t_c/π.
    pub count_ratio: f64,
    /// The same ratio if all half swings lasted π/√κ, and if there were no switches while the
    /// spring cannot reach its limit.
    pub count_expected: f64,
}

impl LargestVelocity {
    pub(super) fn measure(kappa: f64, psi: f64) -> Result<Self, StudyError> {
        let crest = limit::envelope(kappa, psi)?;
        let integrated = if kappa <= MOST_INTEGRATED { integrated(&crest)? } else { f64::NAN };
        let collision = exact::collide(contact(kappa, psi)?)?;
        let (contact_time, switch_count) = (collision.contact_time, collision.switches.len());
        // Without a switch nothing swings.
        let time_of_switches =
            collision.switches.first().map_or(0.0, |first| first.time.min(first.time_left));
        Ok(Self {
            kappa,
            psi,
            crest,
            integrated,
            switch_count,
            count_ratio: switch_count as f64 * std::f64::consts::PI / (kappa.sqrt() * contact_time),
            count_expected: 2.0 * time_of_switches / contact_time,
        })
    }

    /// κ^{5/4} |w_final| at the top.
    pub fn scaled(&self) -> f64 {
        self.crest.velocity * self.kappa.powf(1.25)
    }
}

/// |w_final| at `crest`, integrated.
fn integrated(crest: &Crest) -> Result<f64, StudyError> {
    let contact = contact(crest.kappa, crest.psi)?;
    let failed = |error| CollisionFailure::new(&contact, error);
    Ok(Collider::default().collide(contact).map_err(failed)?.final_velocity.abs())
}

/// κ and |w_final| at one ψ, for stiffnesses in an interval up to [`MOST_RESOLVED`].
///
/// # Errors
/// A collision cannot be computed.
pub fn single(kappa: Range, psi: f64) -> Result<Vec<(f64, f64)>, StudyError> {
    if kappa.low > MOST_RESOLVED {
        return Ok(Vec::new());
    }
    let (from, to) = (kappa.low.sqrt(), kappa.high.min(MOST_RESOLVED).sqrt());
    // A half swing lasts π/√κ, and a contact 3.2: an oscillation is at least 1 long in √κ.
    let steps = ((to - from) * FINE).ceil();
    let places = (0..).map(f64::from).take_while(|step| *step <= steps);
    let point = |step: f64| {
        let kappa = (from + (to - from) * step / steps.max(1.0)).powi(2);
        Ok((kappa, exact::collide(contact(kappa, psi)?)?.final_velocity.abs()))
    };
    places.map(point).collect()
}

/// Where a range of ψ starts, in which the largest |ε_t| is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RangeStart {
    /// The range starts at ψ = 1/√κ times this. The bound (27) is 1 over this there.
    Bound(f64),
    /// The range starts at this ψ.
    Psi(f64),
}

impl RangeStart {
    /// All starts that are measured.
    pub const ALL: [Self; 3] = [Self::Bound(1.0), Self::Bound(10.0), Self::Psi(0.3)];

    /// The start as a formula.
    pub fn name(self) -> String {
        match self {
            Self::Bound(1.0) => "1/√κ".to_owned(),
            Self::Bound(factor) => format!("{factor}/√κ"),
            Self::Psi(psi) => format!("{psi}"),
        }
    }

    fn psi(self, kappa: f64) -> f64 {
        match self {
            Self::Bound(factor) => factor / kappa.sqrt(),
            Self::Psi(psi) => psi,
        }
    }
}

/// The largest |ε_t| of a range of ψ up to 2.
#[derive(Clone, Debug)]
pub struct LargestRestitution {
    /// The stiffness.
    pub kappa: f64,
    /// Where the range starts.
    pub start: RangeStart,
    /// The ψ at which the range starts.
    pub lowest: f64,
    /// The maximum; `None` if the range is empty.
    pub largest: Option<Crest>,
}

impl LargestRestitution {
    pub(super) fn measure(kappa: f64, start: RangeStart) -> Result<Self, StudyError> {
        let lowest = start.psi(kappa);
        let largest =
            (lowest < 2.0).then(|| limit::largest_restitution(kappa, lowest)).transpose()?;
        Ok(Self { kappa, start, lowest, largest })
    }

    /// The largest |ε_t|; NaN if the range is empty.
    pub fn eps_t(&self) -> f64 {
        self.largest.map_or(f64::NAN, |crest| crest.velocity / crest.psi)
    }
}
