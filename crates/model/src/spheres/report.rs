//! The report on one impact: everything that a program prints of it.

use stickslip_contact::{Collision, ContactEnd, Damping, Normal, NotFinite};

use super::encounter::{Encounter, Motion};
use super::outcome::ImpactOutcome;
use crate::limits::{coulomb, normal};

/// One impact: the bodies, their collision in scaled variables, its outcome in SI units, and what
/// simpler laws say of it.
///
/// With the feature `serde` it becomes the JSON object that `stickslip impact` prints.
///
/// ```
/// use stickslip_model::Engine;
/// use stickslip_model::spheres::{Encounter, ImpactReport, Material, Motion, Sphere, Surface};
/// use stickslip_model::spheres::{Vector3, Wall, WallMotion};
///
/// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
/// let surface = Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 0.0
/// }; let sphere = Sphere::homogeneous(0.02, &steel);
/// let zero = Vector3::zeros();
/// let falling = Motion {
///     position_m: Vector3::new(0.0, 0.0, 0.02),
///     velocity_m_per_s: Vector3::new(0.0, 0.0, -1.0),
///     spin_rad_per_s: zero,
/// };
/// let floor = WallMotion { point_m: zero, normal: Vector3::z(), velocity_m_per_s: zero };
/// let encounter =
///     Encounter::with_wall((&sphere, &falling), (&Wall { elasticity: None }, &floor), &surface)?;
/// let (collision, _) = Engine::Auto.collide(encounter.contact())?;
/// let report = ImpactReport::new(&encounter, collision);
/// report.require_finite()?;
/// // The impact is central.
/// assert_eq!((report.psi(), report.itinerary().as_str()), (0.0, "o"));
/// assert_eq!(report.outcome.eps_t, None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactReport {
    /// The two bodies.
    pub encounter: Encounter,
    /// The collision of [`Encounter::contact`]. In a central impact only its normal motion counts:
    /// [`Self::psi`], [`Self::reversals`] and [`Self::itinerary`] describe the impact itself.
    pub collision: Collision,
    /// The bodies after the contact.
    pub outcome: ImpactOutcome,
    /// The same impact by simpler laws.
    pub comparison: Comparison,
}

/// What simpler laws say of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Comparison {
    /// ε_n by [`normal::series`]; `None` unless the normal force is the paper's.
    pub eps_n_series: Option<f64>,
    /// ε_n by [`normal::pade`]; `None` unless the normal force is the paper's.
    pub eps_n_pade: Option<f64>,
    /// ε_t of pure Coulomb sliding with the ε_n of the collision, [`coulomb::restitution`]; `None`
    /// in a central impact, or if the normal force may attract, the bodies too, or friction decays.
    pub eps_t_coulomb: Option<f64>,
    /// [`Impact::mindlin_stiffness_kg_per_s2`](super::Impact::mindlin_stiffness_kg_per_s2); `None`
    /// where the normal force is linear.
    pub mindlin_stiffness_kg_per_s2: Option<f64>,
    /// [`BodyPair::mindlin_kappa`](crate::spheres::BodyPair::mindlin_kappa); `None` where the
    /// normal force is linear.
    pub mindlin_kappa: Option<f64>,
    /// Largest compression ξ in m without damping and adhesion.
    pub undamped_compression_m: f64,
    /// Largest normal force F_n in N without damping and adhesion.
    pub undamped_normal_force_n: f64,
}

impl ImpactReport {
    /// The report on `encounter`, given the `collision` of its [`Encounter::contact`] from any
    /// engine.
    pub fn new(encounter: &Encounter, collision: Collision) -> Self {
        let outcome = encounter.outcome(&collision);
        let comparison = Comparison::new(encounter, &outcome);
        Self { encounter: *encounter, collision, outcome, comparison }
    }

    /// Reduced impact ratio ψ; 0 in a central impact.
    pub fn psi(&self) -> f64 {
        if self.encounter.is_central() { 0.0 } else { self.collision.contact.psi() }
    }

    /// Number of sign changes of the tangential velocity; 0 in a central impact.
    pub fn reversals(&self) -> usize {
        if self.encounter.is_central() { 0 } else { self.collision.reversals }
    }

    /// One character for each phase, as [`Collision::itinerary`]; a central impact sticks from its
    /// start to its end, and one without friction slips.
    pub fn itinerary(&self) -> String {
        if self.encounter.is_central() {
            "o".to_owned()
        } else if self.encounter.impact.pair.surface.friction == 0.0 {
            "+".to_owned()
        } else {
            self.collision.itinerary()
        }
    }

    /// The motions of the spheres after the contact, the first body first. A wall is left out.
    pub fn spheres(&self) -> &[Motion] {
        &self.outcome.motions[..self.encounter.spheres().count()]
    }

    /// Refuses a report with a result that is not a finite number, but for bodies that stay
    /// together. [`Collision::require_finite`] checks the collision.
    ///
    /// # Errors
    /// [`NotFinite`] names the first.
    pub fn require_finite(&self) -> Result<(), NotFinite> {
        let Self { encounter, outcome, comparison, .. } = self;
        // Bodies that stay together have no motion of their own afterwards.
        if outcome.adheres {
            return Ok(());
        }
        let vectors = self.spheres().iter().flat_map(|motion| {
            [("a velocity", motion.velocity_m_per_s), ("a spin", motion.spin_rad_per_s)]
        });
        let vectors = vectors.chain([("the impulse", outcome.impulse_n_s)]);
        let components = vectors.flat_map(|(name, v)| [(name, v.x), (name, v.y), (name, v.z)]);
        let energy = &outcome.energy;
        NotFinite::among(components.chain([
            ("eps_n_series", comparison.eps_n_series.unwrap_or(0.0)),
            ("mindlin_stiffness_kg_per_s2", comparison.mindlin_stiffness_kg_per_s2.unwrap_or(0.0)),
            ("mindlin_kappa", comparison.mindlin_kappa.unwrap_or(0.0)),
            ("undamped_compression_m", comparison.undamped_compression_m),
            ("undamped_normal_force_n", comparison.undamped_normal_force_n),
            ("time_unit_s", encounter.impact.time_unit_s),
            ("patch_psi_1", outcome.observed.patch_psi_1),
            ("kinetic_before_j", energy.kinetic_before_j),
            ("kinetic_after_j", energy.kinetic_after_j),
            ("sliding_j", energy.sliding_j),
            ("unbalanced_j", energy.unbalanced_j()),
        ]))
    }
}

impl Comparison {
    fn new(encounter: &Encounter, outcome: &ImpactOutcome) -> Self {
        let (impact, contact) = (&encounter.impact, encounter.contact());
        let coulomb = |_| coulomb::restitution(contact.psi(), outcome.eps_n);
        let (law, damped) = (contact.law(), contact.damping() > 0.0);
        let hertz = law.normal == Normal::Hertz;
        let adhesive = law.normal.is_adhesive();
        let viscoelastic = law.damping == Damping::Viscoelastic && law.end == ContactEnd::Force;
        let of_paper = hertz && (viscoelastic || !damped);
        let viscous = damped && law.damping.is_viscous();
        let steady = law.friction.is_constant();
        let attracts = viscous && law.end == ContactEnd::Overlap && !law.limit_damping;
        Self {
            eps_n_series: of_paper.then(|| normal::series(contact.damping())),
            eps_n_pade: of_paper.then(|| normal::pade(contact.damping())),
            eps_t_coulomb: outcome.eps_t.filter(|_| !attracts && steady && !adhesive).map(coulomb),
            mindlin_stiffness_kg_per_s2: hertz.then(|| impact.mindlin_stiffness_kg_per_s2()),
            mindlin_kappa: hertz.then(|| impact.pair.mindlin_kappa()),
            undamped_compression_m: impact.largest_compression_m(),
            undamped_normal_force_n: impact.largest_normal_force_n(),
        }
    }
}
