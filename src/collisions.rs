//! Collisions in the (κ, ψ) plane as what the tracer follows.

use stickslip_model::regularized::{GUARDS, OTHER_SIDE, Phase, Regularized, SAME_SIDE, STATE};
use stickslip_model::{Collision, Contact, InvalidParameter, Side};
use stickslip_solver::{Dop853, Options, Start};
use stickslip_tracer::{HybridFamily, Point, Problem, Window};

/// Collisions with κ and ψ in a window and one scaled damping.
///
/// They are traced in x = ln κ and y = ln(1 + ψ), in which their boundaries bend evenly.
///
/// ```
/// use stickslip::collisions::CollisionPlane;
/// use stickslip::tracer::{Location, Subdivision, TraceOptions, trace};
///
/// let plane = CollisionPlane::new((5.0, 8.0), (0.8, 1.2), 0.0)?;
/// let network = trace(&plane.family(), &plane.window(), &TraceOptions::default())?;
/// let regions = Subdivision::new(plane.window(), network.curves, network.vertices, 1e-9)?;
///
/// let place = CollisionPlane::point(7.5, 1.1);
/// let Location::Region(region) = regions.locate(&place) else { panic!("on a boundary") };
/// // As many guards fire as the collision has switches.
/// let switches = regions.regions()[region].label.as_ref().map(Vec::len);
/// let collision = stickslip::model::exact::collide(plane.contact(&place)?)?;
/// assert_eq!(switches, Some(collision.switches.len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CollisionPlane {
    low: Contact,
    high: Contact,
}

/// Collisions as a family of runs: labels are the guards that fired.
pub type CollisionFamily = HybridFamily<CollisionPlane, Dop853, STATE, GUARDS>;

impl CollisionPlane {
    /// Collisions with κ and ψ between two values each.
    ///
    /// # Errors
    /// A value that no collision can have.
    pub fn new(kappa: (f64, f64), psi: (f64, f64), damping: f64) -> Result<Self, InvalidParameter> {
        Ok(Self {
            low: Contact::new(kappa.0, psi.0, damping)?,
            high: Contact::new(kappa.1, psi.1, damping)?,
        })
    }

    /// The traced point of κ and ψ.
    #[must_use]
    pub fn point(kappa: f64, psi: f64) -> Point {
        Point::new(kappa.ln(), psi.ln_1p())
    }

    /// κ and ψ of a traced point.
    #[must_use]
    pub fn parameters(point: &Point) -> [f64; 2] {
        [point.x.exp(), point.y.exp_m1()]
    }

    /// The window in traced coordinates.
    #[must_use]
    pub fn window(&self) -> Window {
        let corner = |contact: &Contact| Self::point(contact.kappa(), contact.psi());
        Window { low: corner(&self.low), high: corner(&self.high) }
    }

    /// The collision at a traced point. Tracing asks for places a little outside of the window, where ψ may not be above 0; it is kept
    /// there.
    ///
    /// # Errors
    /// κ has left the range of numbers.
    pub fn contact(&self, point: &Point) -> Result<Contact, InvalidParameter> {
        let [kappa, psi] = Self::parameters(point);
        Contact::new(kappa, psi.max(0.5 * self.low.psi()), self.low.damping())
    }

    /// The runs to trace, with margins to about 1e-14.
    #[must_use]
    pub fn family(self) -> CollisionFamily {
        let options = Options {
            rtol: 1e-14,
            atol: 1e-14,
            first_step: Some(0.1),
            max_step: 0.1,
            ..Options::default()
        };
        HybridFamily { problem: self, method: Dop853, options, end: f64::INFINITY }
    }

    /// The label of a collision, by whatever engine.
    #[must_use]
    pub fn label(collision: &Collision) -> Vec<usize> {
        let mut side = Side::Positive;
        let guard = |switch: &stickslip_model::Switch| {
            let same = std::mem::replace(&mut side, switch.side) == switch.side;
            if same { SAME_SIDE } else { OTHER_SIDE }
        };
        collision.switches.iter().map(guard).collect()
    }
}

impl Problem<STATE, GUARDS> for CollisionPlane {
    type System = Regularized;

    fn at(&self, point: &Point) -> (Regularized, Start<Phase, STATE>) {
        // Where κ is no number there is nothing to find; any collision will do.
        let contact = self.contact(point).unwrap_or(self.low);
        let system = Regularized::new(contact);
        (system, Start { mode: Phase::first(&contact), s: 0.0, state: system.start() })
    }
}
