//! Fits: of measured impacts, and of data whose parameters are known.

use stickslip_model::spheres::{Body, BodyPair, Constants, Forces, Material, Sphere, Wall};
use stickslip_model::{Contact, Engine, Friction, Law, Tangential, presets};
use stickslip_plane::{Range, progress::SILENT};
use stickslip_practice::fit::{
    self, Datum, Fit, FitSettings, FittedBodies, Free, Measured, Minimum, Survey, Values,
};

use crate::oblique;

/// e_t of the centre is within this of the data, or the fit is not what others found.
const PUBLISHED: f64 = 0.0335;

fn root_mean_square(minimum: &Minimum) -> f64 {
    minimum.root_mean_squares[0].value
}

/// A minimum with κ and μ close to some.
fn near(found: &Fit, kappa: f64, mu: f64) -> Option<&Minimum> {
    let close = |minimum: &&Minimum| {
        (minimum.values.kappa / kappa - 1.0).abs() < 0.03 && (minimum.values.mu - mu).abs() < 0.01
    };
    found.minima.iter().find(close)
}

/// The minima of κ below 110 whose friction is plausible are known from an independent search.
#[test]
fn all_minima_of_the_aluminium_oxide_sphere() {
    let (bodies, data) = oblique::aluminium_oxide(Law::PAPER);
    let settings = FitSettings::new(bodies, data);
    let found = fit::run(&settings, SILENT).unwrap();
    let best = &found.minima[0];
    assert!((best.values.kappa - 2.8666).abs() < 1e-3, "{best:?}");
    assert!((best.values.mu - 0.09368).abs() < 1e-4, "{best:?}");
    assert!(root_mean_square(best) < PUBLISHED, "{best:?}");
    for (kappa, mu) in [(2.9, 0.094), (7.45, 0.077), (27.0, 0.087), (60.0, 0.091), (104.0, 0.099)] {
        assert!(near(&found, kappa, mu).is_some(), "{kappa}: {:#?}", found.minima);
    }
    // Two of the five cannot be told apart by these data.
    let kappa = &found.intervals[0];
    assert_eq!(kappa.pieces.as_ref().unwrap().len(), 2, "{kappa:?}");
    assert!(kappa.holds(2.9) == Some(true) && kappa.holds(60.0) == Some(true), "{kappa:?}");
    assert_eq!(kappa.holds(27.0), Some(false));
    // At the ends of the pieces the least misfit is the threshold.
    let survey = Survey::new(&settings, SILENT).unwrap();
    for piece in kappa.pieces.as_ref().unwrap() {
        for kappa in [piece.low, piece.high] {
            let misfit = |i: u32| {
                let mu = 0.02 * 25.0_f64.powf(f64::from(i) / 40_000.0);
                survey.misfit(&Values { kappa, mu, ..best.values }).unwrap()
            };
            let least = (0..=40_000).map(misfit).fold(f64::INFINITY, f64::min);
            let expected = found.threshold.unwrap();
            assert!((least / expected - 1.0).abs() < 1e-6, "{kappa}: {least} {expected}");
        }
    }
    // The friction that was measured.
    assert_eq!(found.intervals[1].holds(0.092), Some(true), "{:?}", found.intervals[1]);
    // Mindlin's stiffness looks like the obvious choice.
    let mindlin = found.mindlin.as_ref().unwrap();
    assert!(root_mean_square(&mindlin.best) > 3.0 * PUBLISHED && mindlin.excluded == Some(true));
}

/// A search on a grid of four times as many points finds no other minima.
#[test]
fn a_finer_grid_has_no_other_minima() {
    let (bodies, data) = oblique::aluminium_oxide(Law::PAPER);
    let mut settings = FitSettings::new(bodies, data);
    settings.ranges.kappa = Range { low: 0.2, high: 80.0 };
    settings.ranges.mu = Range { low: 0.05, high: 0.3 };
    let survey = Survey::new(&settings, SILENT).unwrap();
    let found = survey.fit().unwrap();
    let at = |i: usize, j: usize| {
        let root = 0.2_f64.sqrt() + (80.0_f64.sqrt() - 0.2_f64.sqrt()) * i as f64 / 639.0;
        Values {
            kappa: root * root,
            mu: 0.05 * 6.0_f64.powf(j as f64 / 127.0),
            tangential_damping: 0.0,
            damping: 0.0,
        }
    };
    let misfit = |values: &Values| survey.misfit(values).unwrap();
    let grid: Vec<Vec<f64>> =
        (0..640).map(|i| (0..128).map(|j| misfit(&at(i, j))).collect()).collect();
    let mut count = 0;
    for i in 1..639 {
        for j in 1..127 {
            let around = (i - 1..=i + 1).flat_map(|i| (j - 1..=j + 1).map(move |j| (i, j)));
            if around.into_iter().any(|(k, l)| grid[k][l] < grid[i][j]) {
                continue;
            }
            count += 1;
            let values = at(i, j);
            let known = found.minima.iter().any(|minimum| {
                (minimum.values.kappa / values.kappa - 1.0).abs() < 0.03
                    && (minimum.values.mu / values.mu - 1.0).abs() < 0.05
            });
            assert!(known, "{values:?} {:#?}", found.minima);
        }
    }
    assert!(count > 5, "{count}");
}

/// e_t and spins together, with the scatter of each as its error.
#[test]
fn spins_and_velocities_together() {
    let (bodies, mut data) = oblique::aluminium_oxide(Law::PAPER);
    data.extend(oblique::spins());
    for datum in &mut data {
        let error = if datum.quantity == Measured::Spin { 40.0 } else { 0.03 };
        datum.error = Some(error);
    }
    let found =
        fit::run(&FitSettings { relative_errors: true, ..FitSettings::new(bodies, data) }, SILENT);
    let found = found.unwrap();
    let best = &found.minima[0];
    let [e_t, spin] = &best.root_mean_squares[..] else { panic!("{best:?}") };
    assert_eq!([e_t.quantity, spin.quantity], [Measured::CentreRestitution, Measured::Spin]);
    assert!((best.values.kappa - 2.9).abs() < 0.2 && e_t.value < 0.04, "{best:?}");
    assert!(spin.value < 60.0, "{best:?}");
}

/// The spins alone, of up to 613 rad/s: the spring is that of the velocities, to within the
/// scatter.
#[test]
fn spins_alone_have_one_best_spring() {
    let (bodies, _) = oblique::aluminium_oxide(Law::PAPER);
    let found = fit::run(&FitSettings::new(bodies, oblique::spins()), SILENT).unwrap();
    let best = &found.minima[0];
    assert!((best.values.kappa - 3.279).abs() < 1e-3, "{best:?}");
    assert!((best.values.mu - 0.0943).abs() < 1e-4, "{best:?}");
    assert!(best.root_mean_squares[0].value < 21.3, "{best:?}");
    // κ = 3.37 and μ = 0.095 fit all but as well, to 21.7 rad/s, and are in both intervals.
    let values = Values { kappa: 3.37, mu: 0.095, ..best.values };
    let survey = Survey::new(&FitSettings::new(bodies, oblique::spins()), SILENT).unwrap();
    assert!((survey.misfit(&values).unwrap() / 7.0).sqrt() < best.root_mean_squares[0].value + 0.5);
    for (interval, value) in found.intervals.iter().zip([3.37, 0.095]) {
        assert_eq!(interval.holds(value), Some(true), "{interval:?}");
    }
}

fn known() -> (FittedBodies, Values) {
    let values = Values { kappa: 6.0, mu: 0.2, tangential_damping: 0.0, damping: 0.0 };
    (FittedBodies::scaled(Law::PAPER, 2.0 / 7.0, &values).unwrap(), values)
}

const ANGLES: [f64; 7] = [4.0, 10.0, 18.0, 27.0, 36.0, 50.0, 65.0];

fn exact(bodies: &FittedBodies, quantity: Measured, error: Option<f64>) -> Vec<Datum> {
    let angles = ANGLES.map(f64::to_radians);
    let values = fit::predicted(bodies, 1.0, quantity, &angles).unwrap();
    let datum = |(angle, value): (&f64, f64)| Datum::at_angle(*angle, 1.0, quantity, value, error);
    angles.iter().zip(values).map(datum).collect()
}

/// Data without errors have the numbers from which they were made as their best minimum.
#[test]
fn exact_data_give_back_their_numbers() {
    let (bodies, values) = known();
    for quantity in [Measured::EpsT, Measured::CentreRestitution, Measured::ReboundAngle] {
        let mut settings = FitSettings::new(bodies, exact(&bodies, quantity, None));
        settings.ranges.kappa.high = 40.0;
        let found = Survey::new(&settings, SILENT).unwrap().fit().unwrap();
        let best = &found.minima[0];
        assert!((best.values.kappa / values.kappa - 1.0).abs() < 1e-7, "{quantity:?} {best:?}");
        assert!((best.values.mu / values.mu - 1.0).abs() < 1e-8, "{quantity:?} {best:?}");
        let pieces = found.intervals[0].pieces.as_ref().unwrap();
        assert!(pieces.len() == 1 && pieces[0].high - pieces[0].low < 1e-3, "{pieces:?}");
    }
}

/// One free number, with the other one known.
#[test]
fn one_free_number() {
    let (bodies, values) = known();
    for (free, truth) in [(Free::Kappa, values.kappa), (Free::Mu, values.mu)] {
        let data = exact(&bodies, Measured::EpsT, Some(0.01));
        let mut settings = FitSettings { free: vec![free], ..FitSettings::new(bodies, data) };
        settings.ranges.kappa.high = 40.0;
        let found = Survey::new(&settings, SILENT).unwrap().fit().unwrap();
        let best = &found.minima[0].values;
        let value = if free == Free::Kappa { best.kappa } else { best.mu };
        assert!((value / truth - 1.0).abs() < 1e-7, "{free:?} {value}");
        assert_eq!(found.intervals[0].holds(truth), Some(true));
        let above = found.threshold.unwrap() - found.minima[0].misfit;
        assert!((above - 3.841458820694124).abs() < 1e-9, "{above}");
    }
}

/// ε_n decides the damping by itself, and the tangential motion the rest.
#[test]
fn damping_from_normal_restitution() {
    let truth = Values { kappa: 6.0, mu: 0.2, tangential_damping: 0.0, damping: 0.15 };
    let bodies = FittedBodies::scaled(Law::PAPER, 2.0 / 7.0, &truth).unwrap();
    let mut data = exact(&bodies, Measured::EpsN, Some(0.01));
    data.extend(exact(&bodies, Measured::EpsT, Some(0.01)));
    let start = Values { kappa: 1.0, mu: 0.5, damping: 0.0, ..truth };
    let unknown = FittedBodies::scaled(Law::PAPER, 2.0 / 7.0, &start).unwrap();
    let free = vec![Free::Damping, Free::Kappa, Free::Mu];
    let mut settings = FitSettings { free, ..FitSettings::new(unknown, data.clone()) };
    settings.ranges.kappa.high = 30.0;
    let found = Survey::new(&settings, SILENT).unwrap().fit().unwrap();
    let best = &found.minima[0].values;
    assert!((best.damping - 0.15).abs() < 1e-6 && (best.kappa - 6.0).abs() < 1e-4, "{best:?}");
    let damping = found.damping.as_ref().unwrap();
    assert_eq!((damping.data, damping.interval.holds(0.15)), (7, Some(true)));
    // The same damping from ε_n at normal incidence.
    let given = FitSettings {
        free: vec![Free::Kappa, Free::Mu],
        eps_n: Some(found.eps_n),
        ranges: settings.ranges,
        ..FitSettings::new(unknown, data)
    };
    let again = Survey::new(&given, SILENT).unwrap().fit().unwrap();
    assert!((again.minima[0].values.damping - best.damping).abs() < 1e-9);
}

/// Impacts in SI units are those of the encounter in three dimensions.
#[test]
fn predictions_are_those_of_encounters() {
    use stickslip_model::Engine;
    use stickslip_model::spheres::{Body, Wall, WallMotion};
    use stickslip_model::spheres::{Encounter, Material, Motion, Sphere, Surface, Vector3};
    let glass = Material { young_modulus_pa: 70e9, poisson_ratio: 0.2, density_kg_per_m3: 2500.0 };
    let sphere = Sphere::homogeneous(1.5e-3, &glass);
    let surface =
        Surface { friction: 0.15, tangential_stiffness_kg_per_s2: 4e6, damping_time_s: 4e-7 };
    let wall = Wall { elasticity: Some(glass.elasticity()) };
    let pair = BodyPair::new(&sphere, &Body::Wall(wall), &surface).unwrap();
    let bodies = FittedBodies::of_sphere(&sphere, pair);
    let zero = Vector3::zeros();
    let still = WallMotion { point_m: zero, normal: Vector3::z(), velocity_m_per_s: zero };
    for angle in [0.1_f64, 0.5, 1.2] {
        let motion = Motion {
            position_m: Vector3::new(0.0, 0.0, sphere.radius_m),
            velocity_m_per_s: Vector3::new(2.0 * angle.sin(), 0.0, -2.0 * angle.cos()),
            spin_rad_per_s: zero,
        };
        let encounter =
            Encounter::with_wall((&sphere, &motion), (&wall, &still), &surface).unwrap();
        let (collision, _) = Engine::Auto.collide(encounter.contact()).unwrap();
        let outcome = encounter.outcome(&collision);
        let observed = [
            (Measured::EpsN, outcome.eps_n),
            (Measured::EpsT, outcome.eps_t.unwrap()),
            (Measured::CentreRestitution, outcome.observed.centre_e_t.unwrap()),
            (Measured::Spin, outcome.motions[0].spin_rad_per_s.y),
            (Measured::ReboundAngle, outcome.observed.centre_rebound_angle_rad),
        ];
        for (quantity, value) in observed {
            let predicted = fit::predicted(&bodies, 2.0, quantity, &[angle]).unwrap()[0];
            let close = (predicted - value).abs() <= 1e-9 * value.abs().max(1e-3);
            assert!(close, "{quantity:?} at {angle}: {predicted} {value}");
        }
    }
}

/// Results do not depend on the number of threads.
#[test]
fn the_same_on_any_number_of_threads() {
    let (bodies, data) = oblique::benchmark(Law::PAPER);
    let mut settings = FitSettings::new(bodies, data);
    settings.ranges.kappa.high = 12.0;
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fit::run(&settings, SILENT)).unwrap()
    };
    assert_eq!(on(1), on(3));
}

/// 5 mm of aluminium oxide on a wall under a law.
fn sphere_under(law: Law, constants: &Constants) -> FittedBodies {
    let material =
        Material { young_modulus_pa: 380e9, poisson_ratio: 0.23, density_kg_per_m3: 4e3 };
    let sphere = Sphere::homogeneous(0.0025, &material);
    let wall = Body::Wall(Wall { elasticity: None });
    let forces = Forces::new(law, constants).unwrap();
    FittedBodies::of_sphere(&sphere, BodyPair::new(&sphere, &wall, forces).unwrap())
}

fn constants(friction: f64, stiffness: f64) -> Constants {
    Constants {
        friction,
        tangential_stiffness_kg_per_s2: Some(stiffness),
        damping_time_s: Some(0.0),
        ..Constants::default()
    }
}

/// A fit of e_t between the given angles, whose truth is `bodies`, from the start `other`.
fn recovered(bodies: &FittedBodies, other: FittedBodies) -> Fit {
    let angles = [6.0, 14.0, 23.0, 34.0, 47.0, 63.0].map(f64::to_radians);
    let quantity = Measured::CentreRestitution;
    let values = fit::predicted(bodies, 2.0, quantity, &angles).unwrap();
    let datum = |(angle, value): (&f64, f64)| Datum::at_angle(*angle, 2.0, quantity, value, None);
    let mut settings = FitSettings::new(other, angles.iter().zip(values).map(datum).collect());
    settings.ranges.kappa = Range { low: 1.0, high: 9.0 };
    settings.ranges.mu = Range { low: 0.1, high: 0.6 };
    fit::run(&settings, SILENT).unwrap()
}

/// Friction that decays keeps β and μ_d/μ_s while μ_s is fitted: a constant in s/m is what it is.
#[test]
fn friction_that_decays_is_fitted() {
    let decaying = |friction: f64, stiffness| {
        let rest = (Some(0.5 * friction), Some(2.0));
        let (dynamic_friction, friction_decay_s_per_m) = rest;
        let usual = constants(friction, stiffness);
        let constants = Constants { dynamic_friction, friction_decay_s_per_m, ..usual };
        sphere_under(Law::PAPER, &constants)
    };
    let found = recovered(&decaying(0.3, 6e7), decaying(0.2, 1e7));
    let best = &found.minima[0];
    assert!((best.values.mu - 0.3).abs() < 1e-6, "{best:?}");
    assert!((best.stiffness.unwrap() / 6e7 - 1.0).abs() < 1e-5, "{best:?}");
    let course = found.course.unwrap();
    assert!(course.boundaries.is_empty() && !course.resolved);
    assert!(course.untraced.unwrap().contains("a kink where the velocity reverses"));
    // In scaled units B is what is given.
    let law = Law { friction: Friction { dynamic: 0.5, decay: 1.0 }, ..Law::PAPER };
    let scaled = |kappa, mu| {
        let values = Values { kappa, mu, tangential_damping: 0.0, damping: 0.0 };
        FittedBodies::scaled(law, 2.0 / 7.0, &values).unwrap()
    };
    let data = |angle: f64| {
        // ψ = tan θ α/μ, and B is proportional to the normal velocity.
        let psi = angle.tan() * 2.0 / 7.0 / 0.3;
        let friction = Friction { decay: angle.cos(), ..law.friction };
        let kappa = 4.0 * angle.cos().powf(-0.4);
        let contact = Contact::new(kappa, psi, 0.0).unwrap();
        let contact = contact.with_law(Law { friction, ..law }, 0.0).unwrap();
        let (collision, _) = Engine::Auto.collide(contact).unwrap();
        Datum::at_angle(angle, 1.0, Measured::EpsT, collision.eps_t(), None)
    };
    let data = [0.1, 0.3, 0.5, 0.7, 1.0].map(data).to_vec();
    let mut settings = FitSettings::new(scaled(1.0, 1.0), data);
    settings.ranges.kappa = Range { low: 1.0, high: 9.0 };
    settings.ranges.mu = Range { low: 0.1, high: 0.6 };
    let best = &fit::run(&settings, SILENT).unwrap().minima[0];
    assert!((best.values.kappa - 4.0).abs() < 1e-5, "{best:?}");
    assert!((best.values.mu - 0.3).abs() < 1e-6, "{best:?}");
}

/// Adhesion, as long as the bodies separate; the curve ends at the angle at which they do not.
#[test]
fn adhesion_is_fitted_where_bodies_separate() {
    let jkr = presets::find("granular/jkr/viscoelastic/mindlin").unwrap().law;
    let law = Law { tangential: Tangential::Constant, ..jkr };
    let grains = |friction, stiffness, gamma| {
        let usual = constants(friction, stiffness);
        sphere_under(law, &Constants { surface_energy_j_per_m2: Some(gamma), ..usual })
    };
    let found = recovered(&grains(0.3, 6e7, 3700.0), grains(0.2, 1e7, 3700.0));
    let best = &found.minima[0];
    assert!((best.values.mu - 0.3).abs() < 1e-6, "{best:?}");
    assert!((best.stiffness.unwrap() / 6e7 - 1.0).abs() < 1e-5, "{best:?}");
    // 1 − ε_n² is 0.2456 (16 F_po/9)^(5/3), and falls with g_n² of the speed at normal incidence.
    let lost = 1.0 - found.eps_n * found.eps_n;
    let course = found.course.unwrap();
    let last = course.curves[0].points.last().unwrap().0;
    let (most, step) = (course.angles_rad.high.to_degrees(), course.angles_rad.high / 300.0);
    let held = lost.sqrt().acos().to_degrees();
    assert!(held < most && (held - last).abs() < step.to_degrees(), "{held} {last} {most}");
    // Bodies that stay together have no e_t, and a damping that may hold them is not looked for.
    let angles = [6.0_f64.to_radians()];
    let sticky = grains(0.3, 6e7, 1e5);
    let error = fit::predicted(&sticky, 2.0, Measured::EpsT, &angles).unwrap_err();
    assert!(error.to_string().contains("the bodies stay together"), "{error}");
    let datum = Datum::at_angle(0.0, 2.0, Measured::EpsN, 0.9, None);
    let mut settings = FitSettings::new(grains(0.3, 6e7, 200.0), vec![datum]);
    settings.free = vec![Free::Damping];
    let error = fit::run(&settings, SILENT).unwrap_err();
    assert!(error.to_string().contains("too much of it holds the bodies together"), "{error}");
}
