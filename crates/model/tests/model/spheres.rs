//! Spheres in SI units against closed forms, limits and published numbers.

use std::f64::consts::FRAC_PI_4;

use stickslip_model::limits::{coulomb, normal};
use stickslip_model::spheres::{
    Body, BodyPair, Elasticity, Encounter, ImpactOutcome, Material, Motion, Sphere, Surface,
    Vector3, Wall, WallMotion,
};
use stickslip_model::{Collider, Contact, InvalidValue};

const STEEL: Material =
    Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
const SURFACE: Surface =
    Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 0.0 };
const REST: Motion = Motion {
    position_m: Vector3::new(0.0, 0.0, 0.0),
    velocity_m_per_s: Vector3::new(0.0, 0.0, 0.0),
    spin_rad_per_s: Vector3::new(0.0, 0.0, 0.0),
};

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value / expected - 1.0).abs() <= relative, "{value} is not {expected}");
}

fn outcome(encounter: &Encounter) -> ImpactOutcome {
    encounter.outcome(&Collider::default().collide(encounter.contact()).unwrap())
}

/// A steel sphere of 2 cm above z = 0, with a velocity and a spin.
fn steel(velocity: [f64; 3], spin: [f64; 3]) -> (Sphere, Motion) {
    let motion = Motion {
        position_m: Vector3::new(0.0, 0.0, 0.02),
        velocity_m_per_s: Vector3::from(velocity),
        spin_rad_per_s: Vector3::from(spin),
    };
    (Sphere::homogeneous(0.02, &STEEL), motion)
}

const FLOOR: (Wall, WallMotion) = (
    Wall { elasticity: None },
    WallMotion {
        point_m: Vector3::new(1.0, 2.0, 0.0),
        normal: Vector3::new(0.0, 0.0, 1.0),
        velocity_m_per_s: Vector3::new(0.0, 0.0, 0.0),
    },
);

fn on_floor((sphere, motion): (Sphere, Motion), surface: &Surface) -> Encounter {
    Encounter::with_wall((&sphere, &motion), (&FLOOR.0, &FLOOR.1), surface).unwrap()
}

/// Expected values: mpmath, 30 digits.
#[test]
fn the_steel_spheres_of_figure_2() {
    let impact =
        BodyPair::equal_spheres(0.02, &STEEL, &SURFACE).unwrap().impact(20.0, 4.0).unwrap();
    close(impact.contact.kappa(), 11224.915488627628618, 1e-14);
    close(impact.contact.psi(), 1.0 / 7.0, 1e-15);
    close(impact.time_unit_s, 2.0538401829028188491e-5, 1e-14);
    close(impact.largest_compression_m(), 4.4911819238533351e-4, 1e-14);
    close(impact.largest_normal_force_n(), 146429.17461406744938, 1e-14);

    // The same as an encounter in three dimensions, with its contact time.
    let (sphere, motion) = steel([4.0, 0.0, -20.0], [0.0; 3]);
    let below = Motion { position_m: Vector3::new(0.0, 0.0, -0.02), ..REST };
    let encounter = Encounter::of_spheres((&sphere, &motion), (&sphere, &below), &SURFACE).unwrap();
    close(encounter.contact().kappa(), impact.contact.kappa(), 1e-14);
    close(encounter.contact().psi(), impact.contact.psi(), 1e-14);
    close(outcome(&encounter).contact_time_s, 6.6093921523826032723e-5, 1e-12);
}

/// The footnote prints ζ = 1.109e5 m s²/kg / k_t for μ = 0.5. Its Y is in MPa instead of GPa, and
/// its number 250 should be 31.25: F_n⁵ = (31.25/243) π³ ρ³ R¹⁰ Y² g⁶/(1 − ν²)².
#[test]
fn footnote_2_and_its_correction() {
    let impact =
        BodyPair::equal_spheres(0.02, &STEEL, &SURFACE).unwrap().impact(20.0, 4.0).unwrap();
    let force_n = impact.largest_normal_force_n();
    close(force_n, 1.464e5, 5e-4);
    close(0.5 * force_n / 1e12, 0.073e-6, 5e-3);
    close(0.5 * force_n * (250.0_f64 / 31.25).powf(0.2), 1.109e5, 1e-3);
}

#[test]
fn mindlin_s_stiffness() {
    let pair = BodyPair::equal_spheres(0.02, &STEEL, &SURFACE).unwrap();
    close(pair.stiffness_ratio, 2.0 * (1.0 - 0.3) / (2.0 - 0.3), 1e-14);
    let impact = pair.impact(20.0, 4.0).unwrap();
    close(impact.mindlin_stiffness_kg_per_s2(), 4.0275166118739150e8, 1e-14);
    close(pair.mindlin_kappa(), 4.5208533597328577914, 1e-14);
    for normal_m_per_s in [1e-3, 1.0, 50.0] {
        let stiffness = pair.impact(normal_m_per_s, 1.0).unwrap().mindlin_stiffness_kg_per_s2();
        let surface = Surface { tangential_stiffness_kg_per_s2: stiffness, ..SURFACE };
        let pair = BodyPair { surface, ..pair };
        let kappa = pair.impact(normal_m_per_s, 1.0).unwrap().contact.kappa();
        close(kappa, pair.mindlin_kappa(), 1e-14);
    }
}

/// Every reduced quantity of two materials and two sizes has the value of its formula.
#[test]
fn unequal_spheres() {
    let glass = Material { young_modulus_pa: 63e9, poisson_ratio: 0.24, density_kg_per_m3: 2500.0 };
    let (one, two) = (Sphere::homogeneous(0.02, &STEEL), Sphere::homogeneous(0.005, &glass));
    let pair = BodyPair::new(&one, &Body::Sphere(two), &SURFACE).unwrap();
    let swapped = BodyPair::new(&two, &Body::Sphere(one), &SURFACE).unwrap();
    assert_eq!(pair, swapped);
    close(pair.effective_mass_kg, one.mass_kg * two.mass_kg / (one.mass_kg + two.mass_kg), 1e-15);
    close(pair.effective_radius_m, 0.004, 1e-15);
    let modulus = 1.0 / ((1.0 - 0.09) / 210e9 + (1.0 - 0.24 * 0.24) / 63e9);
    close(pair.elastic_constant, 4.0 / 3.0 * modulus * 0.004_f64.sqrt(), 1e-15);
    let [steel_shear, glass_shear] = [210e9 / 2.6, 63e9 / 2.48];
    let shear = 1.0 / (1.7 / steel_shear + 1.76 / glass_shear);
    close(pair.stiffness_ratio, 4.0 * shear / modulus, 1e-14);
    close(pair.alpha, 2.0 / 7.0, 1e-15);

    let hollow =
        Sphere { moment_of_inertia_kg_m2: 2.0 / 3.0 * two.mass_kg * 0.005_f64.powi(2), ..two };
    let pair = BodyPair::new(&one, &Body::Sphere(hollow), &SURFACE).unwrap();
    let share = pair.effective_mass_kg * (2.5 / one.mass_kg + 1.5 / two.mass_kg);
    close(pair.alpha, 1.0 / (1.0 + share), 1e-15);
}

#[test]
fn a_wall_is_a_sphere_without_end() {
    let moving = steel([3.0, 1.0, -2.0], [10.0, -40.0, 70.0]);
    let surface = Surface { tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 1e-6, ..SURFACE };
    let wall_motion = WallMotion { velocity_m_per_s: Vector3::new(0.5, 0.0, 0.25), ..FLOOR.1 };
    let wall = Wall { elasticity: Some(STEEL.elasticity()) };
    let limit =
        Encounter::with_wall((&moving.0, &moving.1), (&wall, &wall_motion), &surface).unwrap();
    let errors = [1e3, 1e5].map(|radius_m| {
        let large = Sphere::homogeneous(radius_m, &STEEL);
        let position_m = Vector3::new(0.0, 0.0, -radius_m);
        let velocity_m_per_s = wall_motion.velocity_m_per_s;
        let below = Motion { position_m, velocity_m_per_s, ..REST };
        let encounter =
            Encounter::of_spheres((&moving.0, &moving.1), (&large, &below), &surface).unwrap();
        let [ours, theirs] = [&encounter, &limit].map(|encounter| outcome(encounter).motions[0]);
        (ours.velocity_m_per_s - theirs.velocity_m_per_s).norm()
            + 0.02 * (ours.spin_rad_per_s - theirs.spin_rad_per_s).norm()
    });
    // The difference falls as R/R_j: 1.38e-6 and 1.38e-8.
    assert!(errors[1] < 2e-8);
    close(errors[0] / errors[1], 100.0, 1e-3);
}

#[test]
fn a_central_impact_has_no_tangential_force() {
    let surface = Surface { tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 1e-6, ..SURFACE };
    let spin = [0.0, 0.0, 300.0];
    let central = on_floor(steel([0.0, 0.0, -2.0], spin), &surface);
    let outcome_ = outcome(&central);
    assert_eq!((central.tangent, outcome_.eps_t), (None, None));
    assert!(outcome_.switches.is_empty());
    let [after, _] = outcome_.motions;
    assert_eq!(after.spin_rad_per_s, Vector3::from(spin));
    assert_eq!(after.velocity_m_per_s.xy(), Vector3::zeros().xy());
    close(after.velocity_m_per_s.z, 2.0 * outcome_.eps_n, 1e-15);
    let integrated =
        Collider::default().collide(Contact::new(3.0, 0.5, central.contact().damping()).unwrap());
    close(outcome_.eps_n, integrated.unwrap().eps_n, 1e-12);
    assert_eq!(outcome_.energy.sliding_j, 0.0);
    assert!(outcome_.energy.unbalanced_j().abs() < 1e-12 * outcome_.energy.kinetic_before_j);
    assert_eq!(outcome_.observed.centre_rebound_angle_rad, 0.0);

    // The central impact is the limit of small tangential velocities; those below rounding count as
    // none.
    for tangential in [1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 1e-20, 1e-300] {
        let encounter = on_floor(steel([tangential, 0.0, -2.0], spin), &surface);
        let [near, _] = outcome(&encounter).motions;
        let difference = (near.velocity_m_per_s - after.velocity_m_per_s).norm()
            + 0.02 * (near.spin_rad_per_s - after.spin_rad_per_s).norm();
        assert!(difference < 3.0 * tangential + 2e-12, "{tangential}: {difference}");
    }
}

/// The reference values have 15 digits.
#[test]
fn normal_restitution_with_damping() {
    for (damping, expected) in [
        (0.001, 0.998847357304096),
        (0.05, 0.94439677917763),
        (0.2, 0.800965468135765),
        (1.0, 0.393930603229873),
    ] {
        let contact = Contact::new(18.0, 0.7, damping).unwrap();
        let eps_n = Collider::default().collide(contact).unwrap().eps_n;
        assert!((eps_n - expected).abs() < 1e-12, "{damping}: {eps_n}");
        // The same in SI units, with the damping time that gives this a.
        let moving = steel([0.3, 0.0, -2.0], [0.0; 3]);
        let unit = on_floor(moving, &SURFACE).impact.time_unit_s;
        let surface = Surface { damping_time_s: damping * unit, ..SURFACE };
        let eps_n = outcome(&on_floor(moving, &surface)).eps_n;
        assert!((eps_n - expected).abs() < 1e-12, "{damping}: {eps_n}");
    }
}

#[test]
fn series_and_pade_approximant_of_the_normal_restitution() {
    let eps_n = |damping| {
        let contact = Contact::new(1.0, 2.0, damping).unwrap();
        Collider::default().collide(contact).unwrap().eps_n
    };
    // The first neglected term is of order a⁵, with a coefficient of 0.15.
    for (damping, most) in [(0.01, 0.19), (0.02, 0.21), (0.05, 0.23), (0.2, 0.30), (1.0, 0.34)] {
        let error = (normal::series(damping) - eps_n(damping)) / damping.powi(5);
        assert!(error > 0.14 && error < most, "{damping}: {error} a⁵");
    }
    // The first neglected term of the approximant is of order a³.
    let mut worst = 0.0_f64;
    for exponent in -32..=40 {
        let damping = 2.0_f64.powf(0.25 * f64::from(exponent));
        let error = normal::pade(damping) - eps_n(damping);
        if damping < 0.1 {
            assert!(error > 0.0 && error < 0.085 * damping.powi(3), "{damping}: {error}");
        }
        worst = worst.max(error.abs());
    }
    // Measured: 0.0086, at a = 2.8.
    assert!(worst < 0.009, "{worst}");
    // The coefficients as Müller and Pöschel (2011) print them: 0.501086, 1.15345, 0.577977,
    // 0.532178.
    let published = |a: f64| {
        let d = a.sqrt();
        let below = 1.0 + 0.501086 * d + 1.15345 * d.powi(2) + 0.577977 * d.powi(3);
        (1.0 + 0.501086 * d) / (below + 0.532178 * d.powi(4))
    };
    for damping in [0.01, 0.3, 1.0, 5.0] {
        close(normal::pade(damping), published(damping), 2e-6);
    }
}

#[test]
fn sliding_all_the_time_is_coulomb_s_law() {
    for damping_time_s in [0.0, 1e-6, 1e-5] {
        let surface = Surface { damping_time_s, ..SURFACE };
        let encounter = on_floor(steel([15.0, 0.0, -2.0], [0.0; 3]), &surface);
        let outcome = outcome(&encounter);
        let expected = coulomb::restitution(encounter.contact().psi(), outcome.eps_n);
        // With damping, a spring as stiff as this one sticks during the first 1e-16 s only.
        assert!((outcome.eps_t.unwrap() - expected).abs() < 1e-12, "{damping_time_s}");
        close(outcome.observed.impulse_ratio, 0.4, 1e-12);
    }
}

#[test]
fn what_experiments_report() {
    let surface = Surface { tangential_stiffness_kg_per_s2: 2e8, ..SURFACE };
    let encounter = on_floor(steel([0.0, 2.0, -2.0], [0.0; 3]), &surface);
    let outcome = outcome(&encounter);
    let (eps_t, observed) = (outcome.eps_t.unwrap(), outcome.observed);
    assert!(eps_t < 0.0, "the patch is thrown back");
    assert_eq!(observed.beta, Some(-eps_t));
    // A homogeneous sphere without spin has v' = v + α(ε_t − 1)v.
    close(observed.centre_e_t.unwrap(), 1.0 - 2.0 / 7.0 * (1.0 - eps_t), 1e-14);
    close(observed.patch_psi_1, 1.0, 1e-15);
    close(observed.patch_psi_2, eps_t, 1e-14);
    close(observed.patch_impact_angle_rad, FRAC_PI_4, 1e-15);
    close(observed.centre_impact_angle_rad, FRAC_PI_4, 1e-15);
    close(observed.patch_rebound_angle_rad.tan(), eps_t, 1e-12);
    let [after, _] = outcome.motions;
    let tangent = after.velocity_m_per_s.y / after.velocity_m_per_s.z;
    close(observed.centre_rebound_angle_rad.tan(), tangent, 1e-12);
    close(observed.impulse_ratio, 2.0 / 7.0 * (1.0 - eps_t) / (1.0 + outcome.eps_n), 1e-14);
    // Rolling: the sphere turns about −x when it moves along +y.
    assert!(after.spin_rad_per_s.x < 0.0 && after.spin_rad_per_s.yz().norm() == 0.0);

    // Backspin: the centre moves along +y, the surface the other way.
    let encounter = on_floor(steel([0.0, 0.1, -2.0], [100.0, 0.0, 0.0]), &surface);
    assert!(encounter.tangent.unwrap().y > 0.999);
    let topspin = on_floor(steel([0.0, 0.1, -2.0], [-100.0, 0.0, 0.0]), &surface);
    assert!(topspin.tangent.unwrap().y < -0.999);
}

#[test]
fn every_switch_is_at_the_limit_of_friction() {
    let surface = Surface { tangential_stiffness_kg_per_s2: 2e9, damping_time_s: 1e-6, ..SURFACE };
    let outcome = outcome(&on_floor(steel([0.0, 1.0, -2.0], [0.0; 3]), &surface));
    assert!(outcome.switches.len() > 4);
    let mut last = 0.0;
    for switch in &outcome.switches {
        assert!(switch.time_s > last && switch.time_left_s > 0.0);
        close(switch.time_s + switch.time_left_s, outcome.contact_time_s, 1e-12);
        close(switch.tangential_force_n.abs(), 0.4 * switch.normal_force_n, 1e-14);
        assert!(switch.tangential_force_n * switch.spring_m.unwrap() < 0.0);
        last = switch.time_s;
    }
}

#[test]
fn bodies_that_do_not_collide() {
    let (sphere, motion) = steel([0.0, 0.0, -1.0], [0.0; 3]);
    let meet =
        |second: Motion| Encounter::of_spheres((&sphere, &motion), (&sphere, &second), &SURFACE);
    let at = |z| Motion { position_m: Vector3::new(0.0, 0.0, z), ..REST };
    assert!(meet(at(-0.02)).is_ok() && meet(at(-0.02 + 3e-8)).is_ok());
    let message = |result: Result<Encounter, InvalidValue>| result.unwrap_err().to_string();
    for (z, word) in
        [(-0.021, "apart"), (-0.019, "overlap"), (0.02, "overlap"), (f64::NAN, "overlap")]
    {
        let message = message(meet(at(z)));
        assert!(message.contains("distance of the centres") && message.contains(word), "{message}");
    }
    for speed in [-1.0, -2.0] {
        let velocity_m_per_s = Vector3::new(0.0, 0.0, speed);
        let message = message(meet(Motion { velocity_m_per_s, ..at(-0.02) }));
        assert!(
            message.contains("velocity of approach") && message.contains("above 0"),
            "{message}"
        );
    }
    let velocity_m_per_s = Vector3::new(f64::INFINITY, 0.0, 0.0);
    assert!(message(meet(Motion { velocity_m_per_s, ..at(-0.02) })).contains("finite"));

    let hit = |wall_motion: WallMotion| {
        Encounter::with_wall((&sphere, &motion), (&FLOOR.0, &wall_motion), &SURFACE)
    };
    let wall_motion = FLOOR.1;
    assert!(hit(wall_motion).is_ok());
    assert!(
        message(hit(WallMotion { normal: -wall_motion.normal, ..wall_motion }))
            .contains("above the wall")
    );
    assert!(
        message(hit(WallMotion { normal: Vector3::zeros(), ..wall_motion })).contains("normal")
    );

    let bad =
        Sphere { elasticity: Elasticity { poisson_ratio: 0.6, ..sphere.elasticity }, ..sphere };
    let result = Encounter::with_wall((&bad, &motion), (&FLOOR.0, &wall_motion), &SURFACE);
    assert!(message(result).contains("poisson_ratio = 0.6"));
}
