//! Contact laws of particle codes, against LAMMPS and closed forms.

use std::collections::{BTreeMap, BTreeSet};

use stickslip_model::history::Snapshot;
use stickslip_model::regularized::Regularized;
use stickslip_model::{
    Collider, Collision, CollisionError, Contact, ContactEnd, CoulombTest, Damping, Engine,
    HistoryOf, Law, Normal, Regime, SpringEnergy, Tangential, exact, presets,
};

use crate::common::file;
use crate::lammps::contact;
use crate::plain;

pub fn collide(contact: Contact) -> Collision {
    let (collision, _) =
        Engine::Auto.collide(contact).unwrap_or_else(|error| panic!("{contact:?}: {error}"));
    collision
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn collisions_are_those_of_lammps() {
    let reference = file("lammps_laws");
    let mut errors = BTreeMap::<&str, Vec<f64>>::new();
    for case in reference["cases"].as_array().unwrap() {
        let collision = collide(contact(case));
        let number = |name: &str| case[name].as_f64().unwrap();
        let name = case["law"].as_str().unwrap();
        // Their coefficient has the other sign.
        let error = (collision.eps_t() + number("eps_t")).abs();
        assert!(error < 1e-4 + number("eps_t_error"), "{error:e} {case}");
        let error_n = (collision.eps_n - number("eps_n")).abs();
        assert!(error_n < 1e-5 + number("eps_n_error"), "{error_n:e} {case}");
        errors.entry(name).or_default().push(error);
    }
    assert_eq!(errors.values().map(Vec::len).sum::<usize>(), 264);
    for (name, errors) in &errors {
        assert!(median(errors.clone()) < 1e-5, "{name}: {errors:?}");
    }
    assert!(median(errors.into_values().flatten().collect()) < 1e-6);
}

/// All laws that differ in more than terms without effect.
pub fn laws() -> Vec<Law> {
    let mut laws = Vec::new();
    for normal in [Normal::Linear, Normal::Hertz] {
        for damping in [Damping::None, Damping::Linear, Damping::Viscoelastic, Damping::Tsuji] {
            for (limit_damping, end) in [
                (false, ContactEnd::Force),
                (true, ContactEnd::Overlap),
                (false, ContactEnd::Overlap),
            ] {
                for tangential in [Tangential::Constant, Tangential::Mindlin] {
                    for history in [HistoryOf::Displacement, HistoryOf::Force] {
                        for rescaled in [false, true] {
                            laws.push(Law {
                                normal,
                                damping,
                                tangential,
                                history,
                                rescaled,
                                limit_damping,
                                end,
                                ..Law::PAPER
                            });
                        }
                    }
                }
            }
        }
    }
    laws
}

/// The laws without history that differ in effect, and those whose Coulomb test leaves out the
/// dashpot.
fn other_tests() -> [Vec<Law>; 2] {
    let damped = || laws().into_iter().filter(|law| law.damping != Damping::None);
    let plain = damped().filter(|law| {
        law.tangential == Tangential::Constant && law.history == HistoryOf::Force && !law.rescaled
    });
    [
        plain.map(|law| Law { history: HistoryOf::None, ..law }).collect(),
        damped().map(|law| Law { coulomb_test: CoulombTest::Spring, ..law }).collect(),
    ]
}

/// The dashpot of Becker, Schwager and Pöschel (2008), integrated elsewhere.
#[test]
fn a_contact_without_history_is_that_of_another_program() {
    let law = presets::find("gran/hooke").unwrap().law;
    for (end, expected) in [
        (ContactEnd::Overlap, [(0.5, 0.197_878), (2.0, 0.278_314)]),
        (ContactEnd::Force, [(0.5, 0.226_688), (2.0, 0.292_826)]),
    ] {
        for (psi, eps_t) in expected {
            let contact = Contact::new(1.0, psi, 0.3)
                .and_then(|contact| contact.with_law(Law { end, ..law }, 1.75))
                .unwrap();
            let found = collide(contact).eps_t();
            assert!((found - eps_t).abs() < 6e-7, "{found} {eps_t}");
        }
    }
}

/// Laws without history, by a newer LAMMPS.
#[test]
fn contacts_without_history_are_those_of_lammps() {
    let reference = file("lammps_2025");
    let cases = reference["cases"].as_array().unwrap();
    let mut names = BTreeSet::new();
    for case in cases {
        let number = |name: &str| case[name].as_f64().unwrap();
        let name = case["law"].as_str().unwrap();
        let preset = presets::find(name).unwrap();
        let contact = Contact::new(1.0, number("psi"), number("damping"))
            .and_then(|contact| contact.with_law(preset.law, number("tangential_damping")))
            .unwrap();
        let collision = collide(contact);
        let errors = [
            (collision.eps_t() - number("eps_t")).abs() - number("eps_t_error"),
            (collision.eps_n - number("eps_n")).abs() - number("eps_n_error"),
        ];
        assert!(errors.iter().all(|error| *error < 2e-5), "{errors:?} {case}");
        names.insert(preset.name);
    }
    assert_eq!((cases.len(), names.len()), (100, 5));
}

/// In plain time, with other equations, steps and searches for switches.
#[test]
fn other_tests_agree_with_plain_time() {
    let mut rng = fastrand::Rng::with_seed(55);
    let (mut others, mut refused) = (0, 0);
    for law in other_tests().into_iter().flatten() {
        for _ in 0..4 {
            let mut contact = random(law, &mut rng);
            if law.history == HistoryOf::None || contact.tangential_damping() == 0.0 {
                let dashpot = 0.05 * 100.0_f64.powf(rng.f64());
                contact = contact.with_law(law, dashpot).unwrap();
            }
            let found = match Engine::Auto.collide(contact) {
                Ok((collision, _)) => collision,
                Err(CollisionError::Creeping { .. }) => {
                    assert!(law.coulomb_test == CoulombTest::Spring, "{contact:?}");
                    refused += 1;
                    continue;
                }
                Err(error) => panic!("{error} {contact:?}"),
            };
            let plain = plain::collide(contact).unwrap_or_else(|| panic!("{contact:?}"));
            let error = (found.eps_t() - plain.eps_t).abs() * contact.psi();
            assert!(error < 1e-6, "{error:e} {contact:?}");
            let own = plain::lasting(&found, plain.end);
            others += usize::from(own != plain::longer(plain.phases.into_iter(), plain.end));
        }
    }
    assert!(refused <= 6, "{refused}");
    assert!(others <= 3, "{others}");
}

/// A random contact with `law`.
fn random(law: Law, random: &mut fastrand::Rng) -> Contact {
    let mut between = |low: f64, high: f64| low * (high / low).powf(random.f64());
    let (kappa, psi) = (between(0.05, 400.0), between(0.01, 3.0));
    let damping = match law.damping {
        Damping::None => 0.0,
        _ => between(0.01, law.endless_from().min(2.0)),
    };
    let tangential_damping = if random.bool() { 5.0 * random.f64() } else { 0.0 };
    Contact::new(kappa, psi, damping)
        .and_then(|contact| contact.with_law(law, tangential_damping))
        .unwrap()
}

/// The same contact with other terms.
fn with(contact: Contact, change: impl Fn(&mut Law)) -> Contact {
    let mut law = contact.law();
    change(&mut law);
    contact.with_law(law, contact.tangential_damping()).unwrap()
}

fn close(one: &Collision, other: &Collision, tolerance: f64) {
    assert_eq!(one.itinerary(), other.itinerary(), "{:?}", one.contact);
    let error = (one.final_velocity - other.final_velocity).abs();
    assert!(error < tolerance, "{error:e} {:?}", one.contact);
    assert!((one.eps_n - other.eps_n).abs() < tolerance, "{:?}", one.contact);
}

#[test]
fn every_law_runs_and_keeps_its_accounts() {
    let mut rng = fastrand::Rng::with_seed(19);
    for law in laws().into_iter().chain(other_tests().into_iter().flatten()) {
        for _ in 0..10 {
            let contact = random(law, &mut rng);
            let collision = match Engine::Auto.collide(contact) {
                Err(CollisionError::Creeping { .. }) if law.coulomb_test == CoulombTest::Spring => {
                    continue;
                }
                found => found.unwrap_or_else(|error| panic!("{contact:?}: {error}")).0,
            };
            let energy = &collision.energy;
            assert!(energy.normal_unbalanced().abs() < 1e-9, "{contact:?}");
            assert!(collision.eps_n >= 0.0 && collision.eps_n < 1.0 + 1e-9, "{contact:?}");
            let phases: Vec<char> = collision.itinerary().chars().collect();
            assert!(
                phases.windows(2).all(|pair| (pair[0] == 'o') != (pair[1] == 'o')),
                "{contact:?}"
            );
            let left: Vec<f64> = collision.switches.iter().map(|switch| switch.time_left).collect();
            assert!(left.windows(2).all(|pair| pair[0] >= pair[1]), "{contact:?}");
        }
    }
}

#[test]
fn terms_without_effect_have_none() {
    let mut rng = fastrand::Rng::with_seed(7);
    for law in laws() {
        let contact = random(law, &mut rng);
        let collision = collide(contact);
        if law.end == ContactEnd::Force {
            let limited = with(contact, |law| law.limit_damping = true);
            close(&collision, &collide(limited), 1e-11);
            // Where the force is limited, nothing happens behind its zero.
            let flying =
                with(contact, |law| (law.limit_damping, law.end) = (true, ContactEnd::Overlap));
            let flying = collide(flying);
            close(&collision, &flying, 1e-11);
            assert!(flying.contact_time >= collision.contact_time);
        }
        if law.tangential == Tangential::Constant {
            let other = match law.history {
                HistoryOf::Displacement => HistoryOf::Force,
                _ => HistoryOf::Displacement,
            };
            close(&collision, &collide(with(contact, |law| law.history = other)), 1e-11);
        }
    }
}

/// A tangential damping that is too small to matter leads the paper's law through the equations of
/// any law.
#[test]
fn the_paper_s_law_is_one_of_them() {
    let mut rng = fastrand::Rng::with_seed(3);
    for _ in 0..200 {
        let paper = random(Law::PAPER, &mut rng).with_law(Law::PAPER, 0.0).unwrap();
        let general = paper.with_law(Law::PAPER, 1e-300).unwrap();
        assert!(paper.obeys_paper() && !general.obeys_paper());
        close(&exact::collide(paper).unwrap(), &collide(general), 1e-11);
    }
}

/// While the contact slips all the time, the change of the tangential velocity is that of the
/// normal one.
#[test]
fn gross_sliding_has_a_closed_form() {
    for law in laws().into_iter().filter(|law| law.end == ContactEnd::Force || law.limit_damping) {
        let damping = if law.damping == Damping::None { 0.0 } else { 0.7 };
        let contact = Contact::new(5.0, 9.0, damping).and_then(|it| it.with_law(law, 0.0)).unwrap();
        let collision = collide(contact);
        assert!(matches!(&*collision.itinerary(), "+" | "o+"), "{contact:?}");
        if collision.itinerary() == "+" {
            let expected = 1.0 - (1.0 + collision.eps_n) / contact.psi();
            assert!((collision.eps_t() - expected).abs() < 1e-12, "{contact:?}");
        }
    }
}

/// With linear force and damping all is made of sines.
#[test]
fn a_linear_contact_has_a_closed_form() {
    let law = presets::find("gran/hooke/history").unwrap().law;
    for damping in [0.0, 1e-3, 0.3, 1.0, 1.5, 1.9] {
        // So stiff a dashpot needs no spring: the contact sticks throughout.
        let contact =
            Contact::new(0.3, 0.1, damping).and_then(|contact| contact.with_law(law, 0.0)).unwrap();
        let collision = collide(contact);
        let frequency = (1.0 - damping * damping / 4.0).sqrt();
        let duration = std::f64::consts::PI / frequency;
        assert!((collision.contact_time - duration).abs() < 1e-11 * duration);
        assert!((collision.eps_n - (-damping * duration / 2.0).exp()).abs() < 1e-11);
    }
}

#[test]
fn courses_obey_their_laws() {
    let mut rng = fastrand::Rng::with_seed(31);
    let (mut quotients, mut flights) = (0, 0);
    for law in laws() {
        let contact = random(law, &mut rng);
        let (collision, _, history) = Engine::Auto.followed(contact).unwrap();
        let same = |one: f64, other: f64| assert!((one - other).abs() < 1e-11, "{contact:?}");
        let phases: Vec<_> = history.phases().collect();
        assert_eq!(phases.len(), collision.switches.len() + 1);
        for (pair, switch) in phases.windows(2).zip(&collision.switches) {
            assert_eq!((pair[1].regime(), pair[1].side()), (switch.to, switch.side));
            for moment in [pair[0].end(), pair[1].begin(), history.at(switch.time).unwrap()] {
                same(moment.time, switch.time);
                same(moment.velocity, switch.velocity);
            }
        }
        let (first, last) = (history.at(0.0).unwrap(), history.at(history.duration()).unwrap());
        assert!(first.velocity == contact.psi() && first.compression < 1e-15);
        same(history.duration(), collision.contact_time);
        same(last.velocity, collision.final_velocity);
        same(last.normal_velocity, -collision.eps_n);
        if law.end == ContactEnd::Overlap {
            same(last.compression, 0.0);
        }
        for phase in phases {
            for pair in phase.samples(200).collect::<Vec<_>>().windows(2) {
                let time = 0.5 * (pair[0].time + pair[1].time);
                let now = history.at(time).unwrap();
                let step = pair[1].time - pair[0].time;
                let slope = |of: fn(&Snapshot) -> f64| (of(&pair[1]) - of(&pair[0])) / step;
                // Where attraction begins, the limit has a kink.
                let kink = pair[0].normal_force * pair[1].normal_force < 0.0;
                if step < 1e-4 || (now.compression < 0.3 && now.normal_force != 0.0) || kink {
                    continue;
                }
                // The quotient's error is that of the third derivative.
                let near = |one: f64, other: f64| {
                    let size = 1.0 + contact.kappa() * contact.kappa();
                    let error = (one - other).abs();
                    assert!(error < 2.0 * step * step * size, "{error} {step} {contact:?} {now:?}");
                };
                near(slope(|s| s.compression), now.normal_velocity);
                near(slope(|s| s.normal_velocity), -now.normal_force);
                near(slope(|s| s.velocity), now.tangential_force);
                let limit = now.normal_force.abs() + 1e-9;
                assert!(now.tangential_force.abs() <= limit, "{contact:?} {now:?}");
                quotients += 1;
                flights += usize::from(now.normal_force == 0.0);
            }
        }
    }
    assert!(quotients > 20_000 && flights > 20, "{quotients} {flights}");
}

#[test]
fn springs_create_energy_where_it_is_said() {
    let mut rng = fastrand::Rng::with_seed(77);
    let mut seen = BTreeMap::<String, [usize; 2]>::new();
    for law in laws() {
        let random = random(law, &mut rng);
        let contact = Contact::new(random.kappa(), random.psi(), 0.0).unwrap();
        let contact = contact.with_law(law, 0.0).unwrap();
        let (_, _, history) = Engine::Auto.followed(contact).unwrap();
        let energy = |moment: &Snapshot| {
            let stiffness = match law.tangential {
                Tangential::Constant => contact.kappa(),
                Tangential::Mindlin => contact.kappa() * moment.compression.sqrt(),
            };
            let force = moment.tangential_force;
            0.5 * moment.velocity * moment.velocity + 0.5 * force * force / stiffness
        };
        for phase in history.phases().filter(|phase| phase.regime() == Regime::Stick) {
            for pair in phase.samples(100).collect::<Vec<_>>().windows(2) {
                if pair.iter().any(|moment| moment.compression < 1e-3) {
                    continue;
                }
                let gained = energy(&pair[1]) - energy(&pair[0]);
                let loading = pair[0].normal_velocity > 0.0;
                if loading != (pair[1].normal_velocity > 0.0) {
                    continue;
                }
                let (most, least) = match (law.spring_energy(), loading) {
                    (SpringEnergy::Conserved, _) => (0.0, 0.0),
                    (SpringEnergy::CreatedLoading, true)
                    | (SpringEnergy::CreatedUnloading, false) => (f64::INFINITY, 0.0),
                    _ => (0.0, f64::NEG_INFINITY),
                };
                assert!(gained < most + 1e-10 && gained > least - 1e-10, "{gained} {contact:?}");
                let counts = seen.entry(law.spring_energy().to_string()).or_default();
                counts[usize::from(gained.abs() > 1e-6)] += 1;
            }
        }
    }
    assert_eq!(seen.len(), 4);
    for (name, [none, some]) in seen {
        assert!(name.contains("conserves") == (some == 0) && none > 0, "{name} {none} {some}");
    }
}

#[test]
fn what_is_known_of_the_paper_s_law_alone_is_refused() {
    let law = Law { normal: Normal::Linear, ..Law::PAPER };
    let contact = Contact::new(18.0, 0.4, 0.1).unwrap().with_law(law, 0.0).unwrap();
    let collider = Collider::default();
    let is_law = |error| matches!(error, CollisionError::Law(_));
    assert!(collider.sensitivity(contact).is_err_and(is_law));
    assert!(collider.collide_finely(contact).is_err_and(is_law));
    assert_eq!(exact::collide(contact).unwrap_err(), exact::ExactError::Law);
    let collision = collide(contact);
    let estimate = Engine::Auto.estimate(&collision).unwrap_err();
    assert!(matches!(estimate, CollisionError::Law(_)));
    // The equations in regularised coordinates are those of the paper, and say so.
    assert!(Regularized::new(contact).contact().obeys_paper());
}

#[test]
fn contacts_that_never_end_are_refused() {
    let refused = |law: Law, damping: f64| {
        Contact::new(1.0, 1.0, damping).and_then(|contact| contact.with_law(law, 0.0)).is_err()
    };
    for law in laws() {
        let threshold = law.endless_from();
        if threshold.is_finite() {
            assert!(refused(law, threshold) && refused(law, 1.1 * threshold));
            let contact = Contact::new(1.0, 0.5, 0.9 * threshold).unwrap();
            let collision = collide(contact.with_law(law, 0.0).unwrap());
            assert!(collision.eps_n > 0.0 && collision.contact_time > 4.0, "{law:?}");
        } else if law.damping != Damping::None {
            assert!(!refused(law, 100.0));
        }
    }
    let undamped = Law { damping: Damping::None, ..Law::PAPER };
    assert!(refused(undamped, 0.1) && !refused(undamped, 0.0));
}

#[test]
fn names_are_unique_and_laws_are_what_they_say() {
    let names: BTreeSet<_> = presets::ALL.iter().map(|preset| preset.name).collect();
    assert_eq!(names.len(), presets::ALL.len());
    for preset in presets::ALL {
        assert_eq!(presets::find(preset.name), Some(*preset));
        let limited = presets::find(&format!("{}+limit_damping", preset.name)).unwrap();
        assert!(limited.law.limit_damping);
        assert!(preset.law.equations().starts_with("F = "));
    }
    assert_eq!(presets::find("hooke"), None);
}

/// What the dashpot takes in stick, by a quadrature of the course: for laws of all kinds, among
/// them dashpots alone and those beside the Coulomb test.
#[test]
fn the_dashpot_takes_what_its_force_does() {
    for name in [
        "gran/hooke/history",
        "granular/hertz/tsuji/mindlin",
        "granular/hertz/viscoelastic/mindlin",
        "granular/hertz/tsuji/mindlin_rescale/force",
        "gran/hooke",
        "liggghts/hertz/history",
    ] {
        let law = presets::find(name).unwrap().law;
        let (a, b) = (0.3, 0.6);
        let contact = Contact::new(6.0, 0.7, a).and_then(|it| it.with_law(law, b)).unwrap();
        let (collision, _, history) = Engine::Auto.followed(contact).unwrap();
        let eta = |x: f64| match law.damping {
            Damping::Viscoelastic => a * x.sqrt(),
            Damping::Tsuji => a * x.sqrt().sqrt(),
            _ => a,
        };
        let mut taken = 0.0;
        for phase in history.phases().filter(|phase| phase.regime() == Regime::Stick) {
            let moments: Vec<Snapshot> = phase.samples(4000).collect();
            let power = |it: &Snapshot| b * eta(it.compression.max(0.0)) * it.velocity.powi(2);
            let step = |pair: &[Snapshot]| {
                0.5 * (power(&pair[0]) + power(&pair[1])) * (pair[1].time - pair[0].time)
            };
            taken += moments.windows(2).map(step).sum::<f64>();
        }
        let found = collision.energy.tangential_damping;
        assert!(found > 1e-3 && (found - taken).abs() < 1e-6, "{name} {found} {taken}");
        assert!(collision.energy.tangential_unbalanced().abs() < 1e-12);
    }
}
