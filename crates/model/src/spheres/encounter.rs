//! Two bodies that touch and approach, in three dimensions: start reading here for spheres in SI
//! units.
//!
//! Source: Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008), equations (4)–(7), (11),
//! (12).

use nalgebra::Vector3;
use stickslip_contact::{Contact, InvalidValue};

use super::bodies::{Body, Sphere, Wall};
use super::forces::Forces;
use super::quantity;
use super::scaling::{BodyPair, Impact};

/// Largest relative difference between the distance of two bodies and their radii at which they
/// count as touching.
pub const TOUCH: f64 = 1e-6;

/// Position and motion of a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Position of the centre in m.
    pub position_m: Vector3<f64>,
    /// Velocity of the centre in m/s.
    pub velocity_m_per_s: Vector3<f64>,
    /// Angular velocity Ω in rad/s.
    pub spin_rad_per_s: Vector3<f64>,
}

/// Position and motion of a plane wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallMotion {
    /// A point of the surface of the wall in m.
    pub point_m: Vector3<f64>,
    /// Direction out of the wall, of any length.
    pub normal: Vector3<f64>,
    /// Velocity of the wall in m/s at the point of contact.
    pub velocity_m_per_s: Vector3<f64>,
}

/// Two bodies that touch and approach each other.
///
/// The positions decide the normal n, from the second body to the first, and the point of contact,
/// which divides the line between the centres in the ratio of the radii. During contact n and the
/// tangential direction t do not change. The lever arms are the distances of the centres from the
/// point of contact. They may differ from the radii by a part of [`TOUCH`], but momentum and
/// angular momentum about any point are conserved to rounding.
///
/// ```
/// use stickslip_model::Collider;
/// use stickslip_model::spheres::{Encounter, Material, Motion, Sphere, Surface, Vector3};
///
/// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
/// let surface = Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 0.0
/// }; let sphere = Sphere::homogeneous(0.02, &steel);
/// let rest = Motion {
///     position_m: Vector3::zeros(),
///     velocity_m_per_s: Vector3::zeros(),
///     spin_rad_per_s: Vector3::zeros(),
/// };
/// let falling = Motion {
///     position_m: Vector3::new(0.0, 0.0, 0.04),
///     velocity_m_per_s: Vector3::new(4.0, 0.0, -20.0),
///     ..rest
/// };
/// let encounter = Encounter::of_spheres((&sphere, &falling), (&sphere, &rest), &surface)?;
/// let collision = Collider::default().collide(encounter.contact())?;
/// let outcome = encounter.outcome(&collision);
/// let [first, second] = outcome.motions;
/// assert!((first.velocity_m_per_s.z - 0.0).abs() < 1e-9 && (second.velocity_m_per_s.z +
/// 20.0).abs() < 1e-9); let momentum = first.velocity_m_per_s + second.velocity_m_per_s -
/// falling.velocity_m_per_s; assert!(momentum.norm() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encounter {
    /// Point of contact in m.
    pub contact_point_m: Vector3<f64>,
    /// Unit vector n from the second body to the first.
    pub normal: Vector3<f64>,
    /// Unit vector t along the tangential velocity of the surfaces. A central impact has no such
    /// velocity and `None` here.
    pub tangent: Option<Vector3<f64>>,
    /// Normal velocity g_n > 0 of approach in m/s.
    pub normal_m_per_s: f64,
    /// Tangential velocity g_t of the surfaces in m/s, 0 in a central impact.
    pub tangential_m_per_s: f64,
    /// The impact, reduced to the numbers on which the contact depends. A central impact has no ψ;
    /// the ψ here then belongs to another impact with the same normal motion. That is exact, since
    /// the normal motion does not depend on the tangential one.
    pub impact: Impact,
    pub(crate) partners: [Partner; 2],
}

/// One of the two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Partner {
    /// The sphere; `None` is a wall, whose motion does not change.
    pub sphere: Option<Sphere>,
    /// Distance of the centre from the point of contact; 0 for a wall.
    pub arm_m: f64,
    pub motion: Motion,
}

impl Encounter {
    /// The encounter of two spheres.
    ///
    /// # Errors
    /// [`InvalidValue`]: a quantity is out of its range, the spheres do not touch, or they do not
    /// approach.
    pub fn of_spheres(
        first: (&Sphere, &Motion),
        second: (&Sphere, &Motion),
        forces: impl Into<Forces>,
    ) -> Result<Self, InvalidValue> {
        let pair = BodyPair::new(first.0, &Body::Sphere(*second.0), forces)?;
        let separation = first.1.position_m - second.1.position_m;
        let distance_m = separation.norm();
        let touching_m = first.0.radius_m + second.0.radius_m;
        require_touch("the distance of the centres", distance_m, touching_m)?;
        let normal = separation / distance_m;
        let partner = |(sphere, motion): (&Sphere, &Motion)| Partner {
            sphere: Some(*sphere),
            arm_m: sphere.radius_m * (distance_m / touching_m),
            motion: *motion,
        };
        let partners = [partner(first), partner(second)];
        let contact_point_m = second.1.position_m + normal * partners[1].arm_m;
        Self::new(pair, partners, normal, contact_point_m)
    }

    /// The encounter of a sphere, the first body, and a wall, the second body.
    ///
    /// # Errors
    /// [`InvalidValue`]: a quantity is out of its range, the sphere does not touch the wall on
    /// the side to which the wall's normal points, or they do not approach.
    pub fn with_wall(
        sphere: (&Sphere, &Motion),
        wall: (&Wall, &WallMotion),
        forces: impl Into<Forces>,
    ) -> Result<Self, InvalidValue> {
        let (WallMotion { point_m, normal, velocity_m_per_s }, position_m) =
            (*wall.1, sphere.1.position_m);
        let pair = BodyPair::new(sphere.0, &Body::Wall(*wall.0), forces)?;
        // Scaled first, so that the square of no length is too large or too small.
        let normal = normal / normal.amax();
        let normal = normal / normal.norm();
        if !normal.iter().all(|component| component.is_finite()) {
            let expected = "three finite numbers that are not all 0";
            return Err(InvalidValue::phrase("the wall's normal", "has no direction", expected));
        }
        let height_m = (position_m - point_m).dot(&normal);
        require_touch("the height of the centre above the wall", height_m, sphere.0.radius_m)?;
        let still =
            Motion { position_m: point_m, velocity_m_per_s, spin_rad_per_s: Vector3::zeros() };
        let partners = [
            Partner { sphere: Some(*sphere.0), arm_m: height_m, motion: *sphere.1 },
            Partner { sphere: None, arm_m: 0.0, motion: still },
        ];
        Self::new(pair, partners, normal, position_m - normal * height_m)
    }

    /// The encounter of bodies without spin whose surfaces have the velocities g_n and g_t in m/s.
    ///
    /// The second body rests, a sphere with its centre at the origin, a wall in the plane z = 0.
    /// The first one comes from above: n is along z and t along x. g_t = 0 is a central impact.
    ///
    /// ```
    /// use stickslip_model::spheres::{Body, BodyPair, Encounter, Material, Sphere, Surface};
    ///
    /// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3:
    /// 7850.0 }; let surface = Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9,
    /// damping_time_s: 0.0 }; let sphere = Sphere::homogeneous(0.02, &steel);
    /// let encounter = Encounter::of_velocities(&sphere, &Body::Sphere(sphere), (20.0, 4.0),
    /// &surface)?; let pair = BodyPair::equal_spheres(0.02, &steel, &surface)?;
    /// assert_eq!(encounter.impact, pair.impact(20.0, 4.0)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidValue`]: a quantity is out of its range.
    pub fn of_velocities(
        sphere: &Sphere,
        other: &Body,
        (normal_m_per_s, tangential_m_per_s): (f64, f64),
        forces: impl Into<Forces>,
    ) -> Result<Self, InvalidValue> {
        quantity::NORMAL_VELOCITY.check(normal_m_per_s)?;
        quantity::TANGENTIAL_VELOCITY.check(tangential_m_per_s)?;
        let pair = BodyPair::new(sphere, other, forces)?;
        let (below, below_m) = match other {
            Body::Sphere(below) => (Some(*below), below.radius_m),
            Body::Wall(_) => (None, 0.0),
        };
        let zero = Vector3::zeros();
        let still = Motion { position_m: zero, velocity_m_per_s: zero, spin_rad_per_s: zero };
        let motion = Motion {
            position_m: Vector3::z() * (sphere.radius_m + below_m),
            velocity_m_per_s: Vector3::new(tangential_m_per_s, 0.0, -normal_m_per_s),
            ..still
        };
        let partners = [
            Partner { sphere: Some(*sphere), arm_m: sphere.radius_m, motion },
            Partner { sphere: below, arm_m: below_m, motion: still },
        ];
        let sliding = (tangential_m_per_s > 0.0).then(|| (Vector3::x(), tangential_m_per_s));
        let place = (Vector3::z(), Vector3::z() * below_m);
        Self::assembled(pair, partners, place, (normal_m_per_s, sliding))
    }

    /// The parameters of the scaled collision that decides the outcome. For a central impact, the
    /// collision has the same normal motion.
    pub fn contact(&self) -> Contact {
        self.impact.contact
    }

    /// Whether the impact is central: the surfaces have no tangential velocity.
    pub fn is_central(&self) -> bool {
        self.tangent.is_none()
    }

    /// The spheres: two, or one if the second body is a wall.
    pub fn spheres(&self) -> impl Iterator<Item = &Sphere> {
        self.partners.iter().filter_map(|partner| partner.sphere.as_ref())
    }

    fn new(
        pair: BodyPair,
        partners: [Partner; 2],
        normal: Vector3<f64>,
        contact_point_m: Vector3<f64>,
    ) -> Result<Self, InvalidValue> {
        let [one, two] = partners.map(|partner| partner.motion);
        let approach = one.velocity_m_per_s - two.velocity_m_per_s;
        let turn = one.spin_rad_per_s * partners[0].arm_m + two.spin_rad_per_s * partners[1].arm_m;
        let normal_m_per_s = -approach.dot(&normal);
        if !normal_m_per_s.is_finite() || !turn.iter().all(|component| component.is_finite()) {
            let name = "the velocity of the surfaces";
            let expected = "finite velocities and spins";
            return Err(InvalidValue::phrase(name, "is not finite", expected));
        }
        if normal_m_per_s <= 0.0 {
            let phrase = format!("= {normal_m_per_s} m/s: the bodies do not approach");
            let name = "the normal velocity of approach";
            return Err(InvalidValue::phrase(name, phrase, "a finite number above 0"));
        }
        let sliding = tangential(&(approach - turn.cross(&normal)), &normal);
        let speeds = partners.map(|partner| {
            let Motion { velocity_m_per_s, spin_rad_per_s, .. } = partner.motion;
            velocity_m_per_s.norm() + partner.arm_m * spin_rad_per_s.norm()
        });
        let sliding = direction(&sliding, speeds[0] + speeds[1]);
        Self::assembled(pair, partners, (normal, contact_point_m), (normal_m_per_s, sliding))
    }

    /// The encounter of bodies whose surfaces approach with the first of the velocities, and slide
    /// in a direction with a velocity.
    fn assembled(
        pair: BodyPair,
        partners: [Partner; 2],
        (normal, contact_point_m): (Vector3<f64>, Vector3<f64>),
        (normal_m_per_s, sliding): (f64, Option<(Vector3<f64>, f64)>),
    ) -> Result<Self, InvalidValue> {
        let turning = partners.iter().filter_map(|partner| {
            partner
                .sphere
                .map(|sphere| partner.arm_m * partner.arm_m / sphere.moment_of_inertia_kg_m2)
        });
        let alpha = 1.0 / (1.0 + pair.effective_mass_kg * turning.sum::<f64>());
        let pair = BodyPair { alpha, ..pair };
        let (tangent, tangential_m_per_s) =
            sliding.map_or((None, 0.0), |(tangent, speed)| (Some(tangent), speed));
        // The normal motion does not depend on the tangential one: a central impact may use any.
        let tangential_or_any_m_per_s =
            if tangent.is_some() { tangential_m_per_s } else { normal_m_per_s };
        let impact = pair.impact(normal_m_per_s, tangential_or_any_m_per_s)?;
        Ok(Self {
            contact_point_m,
            normal,
            tangent,
            normal_m_per_s,
            tangential_m_per_s,
            impact,
            partners,
        })
    }
}

/// The part of `vector` that is perpendicular to `normal`.
pub(crate) fn tangential(vector: &Vector3<f64>, normal: &Vector3<f64>) -> Vector3<f64> {
    vector - normal * vector.dot(normal)
}

/// Direction and length of a difference of velocities whose sizes add up to `speed`; `None` if the
/// difference is rounding alone.
pub(crate) fn direction(difference: &Vector3<f64>, speed: f64) -> Option<(Vector3<f64>, f64)> {
    let length = difference.norm();
    (length > 8.0 * f64::EPSILON * speed).then(|| (difference / length, length))
}

fn require_touch(name: &'static str, value_m: f64, touching_m: f64) -> Result<(), InvalidValue> {
    if (value_m - touching_m).abs() <= TOUCH * touching_m {
        return Ok(());
    }
    let how = if value_m > touching_m { "are apart" } else { "overlap" };
    let phrase = format!("= {value_m} m: the bodies {how}");
    Err(InvalidValue::phrase(name, phrase, format!("{touching_m} m, within {TOUCH:e} of it")))
}
