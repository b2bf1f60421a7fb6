//! Fits: of measured impacts, and of data whose parameters are known.

use stickslip_model::Law;
use stickslip_model::spheres::BodyPair;
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
