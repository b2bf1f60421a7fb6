//! What is promised of errors of time steps.

use stickslip_model::{
    Contact, ContactEnd, Engine, HistoryOf, Law, Reduction, Tangential, exact, presets,
};
use stickslip_plane::progress::{self, Progress};
use stickslip_practice::time_steps::{
    self, Scheme, Status, Stepped, SteppedQuantity, Stepping, TimeStepSettings, TimeSteps,
    TimeStepsError, step, undamped_contact_time,
};

/// The contact of a law that has a name, with κ, ψ, damping and tangential damping.
pub fn contact(law: &str, [kappa, psi, damping, tangential]: [f64; 4]) -> Contact {
    let law = presets::find(law).expect("a law").law;
    let contact = Contact::new(kappa, psi, damping).expect("parameters");
    contact.with_law(law, tangential).expect("parameters")
}

pub fn run(contacts: Vec<Contact>, steps: &[f64]) -> TimeSteps {
    let settings = TimeStepSettings {
        contacts,
        steps_per_contact: steps.to_vec(),
        ..TimeStepSettings::default()
    };
    time_steps::run(&settings, progress::SILENT).expect("errors")
}

/// One collision in steps.
pub fn stepped(contact: &Contact, steps: f64, phase: f64) -> Option<Stepped> {
    let dt = undamped_contact_time(contact.law()) / steps;
    let (collision, _) = Engine::Auto.collide(*contact).expect("a collision");
    step(contact, dt, phase, &Stepping::default(), collision.contact_time)
}

#[test]
fn errors_fall_as_the_step_does() {
    // κ, ψ, damping, tangential damping, and where the energy weighs ε_t: damped laws.
    for law in ["gran/hooke/history", "gran/hertz/history", "granular/hertz/tsuji/mindlin/force"] {
        let result = run(vec![contact(law, [4.0, 0.7, 0.2, 1.0])], &[1e2, 1e3, 1e4, 1e5]);
        for quantity in SteppedQuantity::ALL {
            let errors = |row: usize| result.rows[row].errors(quantity).expect("errors");
            for row in 1..4 {
                let ratio = errors(row - 1).root_mean_square / errors(row).root_mean_square;
                assert!((5.0..30.0).contains(&ratio), "{law} {quantity:?} {row}: {ratio}");
            }
            let finest = errors(3);
            assert!(finest.worst.error < 1e-4, "{law} {quantity:?}: {finest:?}");
            assert!(finest.median <= finest.worst.error);
            assert!(finest.root_mean_square <= finest.worst.error);
        }
    }
}

/// Without damping the linear contact is a harmonic half swing of leaps: 2 sin(ω dt/2) = dt.
#[test]
fn the_normal_motion_of_leaps_has_a_closed_form() {
    let elastic = contact("gran/hooke/history", [1.0, 4.0, 0.0, 0.0]);
    for steps in [7.0, 20.5, 300.0] {
        let dt: f64 = std::f64::consts::PI / steps;
        let omega_dt = 2.0 * (0.5 * dt).asin();
        for phase in [0.0, 0.1, 0.5, 0.97] {
            let found = stepped(&elastic, steps, phase).expect("an end");
            // x_n = A sin(n ω dt + δ) with x_0 = −phase dt and x_1 − x_0 = dt, as long as x_0
            // counts as contact; leaps see the spring from x_1 on alone, so that the swing starts
            // at x_1.
            let (x1, mut x, mut v) = ((1.0 - phase) * dt, (1.0 - phase) * dt, 1.0);
            let amplitude_at = |n: f64| {
                // Solves A sin δ = x_1, A sin(δ + ω dt) = x_2 for x_{n+1}.
                let x2 = x1 + dt * (1.0 - dt * x1);
                (x2 * (n * omega_dt).sin() - x1 * ((n - 1.0) * omega_dt).sin()) / omega_dt.sin()
            };
            let mut count: u32 = 0;
            while x > 0.0 {
                v -= dt * x;
                x += dt * v;
                count += 1;
                assert!((x - amplitude_at(f64::from(count))).abs() < 1e-10);
            }
            assert!((found.eps_n + v).abs() < 1e-12, "{steps} {phase}");
            assert_eq!(found.steps, u64::from(count));
        }
    }
}

/// The contact radius of yielded bodies is what Mindlin's stiffness follows, in steps too.
#[test]
fn steps_of_yielded_bodies_come_to_the_collision() {
    for (history, rescaled) in [(HistoryOf::Displacement, false), (HistoryOf::Force, true)] {
        let yielding = presets::find("thornton").expect("a law").law;
        let law = Law { tangential: Tangential::Mindlin, history, rescaled, ..yielding };
        let contact = Contact::new(6.0, 0.7, 3.0).expect("parameters");
        let result = run(vec![contact.with_law(law, 0.0).expect("a law")], &[1e2, 1e3, 1e5]);
        for row in &result.rows {
            let worst = row.eps_t.expect("errors").worst.error;
            assert!(worst < 10.0 / row.steps_per_contact, "{row:?}");
        }
    }
}

#[test]
fn rows_are_sorted_and_steps_are_measured_once() {
    let contacts = vec![Contact::new(18.0, 0.5, 0.0).expect("parameters")];
    let result = run(contacts, &[100.0, 20.0, 100.0, 50.5]);
    let steps: Vec<f64> = result.rows.iter().map(|row| row.steps_per_contact).collect();
    assert_eq!(steps, [20.0, 50.5, 100.0]);
    assert!(result.rows.iter().all(|row| row.status == Status::Ok));
}

#[test]
fn the_largest_step_holds_for_all_shorter_ones() {
    let contacts = (1..20).map(|tenths| Contact::new(63.0, f64::from(tenths) / 10.0, 0.0));
    let contacts: Vec<Contact> = contacts.collect::<Result<_, _>>().expect("parameters");
    let steps: Vec<f64> = (4..40).map(|power| 1.3_f64.powi(power)).collect();
    let result = run(contacts, &steps);
    let mut broken = 0;
    for quantity in SteppedQuantity::ALL {
        let error =
            |row: &time_steps::TimeStepRow| row.errors(quantity).expect("errors").worst.error;
        for wanted in [1e-1, 1e-2, 1e-3, 1e-4] {
            let largest = result.largest_step(quantity, wanted);
            let parts = |row: &&time_steps::TimeStepRow| {
                largest.is_some_and(|largest| 1.0 / row.steps_per_contact <= largest)
            };
            let (inside, outside): (Vec<&time_steps::TimeStepRow>, Vec<&time_steps::TimeStepRow>) =
                result.rows.iter().partition(parts);
            assert!(inside.iter().all(|row| row.status == Status::Ok && error(row) <= wanted));
            let next = outside.last().expect("a step that is too long");
            assert!(next.status != Status::Ok || error(next) > wanted);
            broken += outside.iter().filter(|row| error(row) <= wanted).count();
        }
        assert_eq!(result.largest_step(quantity, 0.0), None);
    }
    // Errors do not fall evenly: some longer steps have smaller ones.
    assert!(broken > 0);
}

#[test]
fn results_do_not_depend_on_threads() {
    let mut random = fastrand::Rng::with_seed(5);
    let contacts = (0..40).map(|_| {
        let parameters = [100.0 * random.f64(), 2.0 * random.f64() + 1e-3, random.f64(), 1.0];
        contact("gran/hertz/history", parameters)
    });
    let contacts: Vec<Contact> = contacts.collect();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| run(contacts.clone(), &[20.0, 33.3]))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn progress_is_complete() {
    let (begun, advanced) =
        <(std::sync::atomic::AtomicUsize, std::sync::atomic::AtomicUsize)>::default();
    let settings = TimeStepSettings {
        contacts: vec![Contact::new(1.0, 1.0, 0.0).expect("parameters"); 3],
        ..TimeStepSettings::default()
    };
    let report = |progress| {
        let (counter, steps) = match progress {
            Progress::Begin { steps } => (&begun, steps),
            Progress::Advance { steps } => (&advanced, steps),
            Progress::Now { .. } => return,
        };
        counter.fetch_add(steps, std::sync::atomic::Ordering::Relaxed);
    };
    time_steps::run(&settings, &report).expect("errors");
    assert_eq!(begun.into_inner(), 21);
    assert_eq!(advanced.into_inner(), 21);
}

/// A contact that ends where its force does is one whose force is limited.
#[test]
fn the_paper_s_law_is_that_of_a_limited_force() {
    let limited = Law { limit_damping: true, end: ContactEnd::Overlap, ..Law::PAPER };
    for damping in [0.01, 0.3, 5.0, 300.0] {
        let paper = Contact::new(5.0, 0.5, damping).expect("parameters");
        let other = paper.with_law(limited, 0.0).expect("parameters");
        for phase in [0.0, 0.3, 0.9] {
            assert_eq!(stepped(&paper, 700.0, phase), stepped(&other, 700.0, phase));
            assert!(stepped(&paper, 700.0, phase).is_some());
        }
    }
}

/// The first step of a contact is a whole one for the history, which costs an order of accuracy
/// where the contact starts in stick and nothing else costs one.
#[test]
fn an_elapsed_first_step_is_more_accurate() {
    let contact = contact("gran/hooke/history", [2.0, 0.02, 0.0, 0.0]);
    let error = |scheme| {
        let settings = TimeStepSettings {
            contacts: vec![contact],
            steps_per_contact: vec![1000.0],
            stepping: Stepping { scheme, ..Stepping::default() },
            ..TimeStepSettings::default()
        };
        let result = time_steps::run(&settings, progress::SILENT).expect("errors");
        result.rows[0].eps_t.expect("errors").root_mean_square
    };
    let [whole, elapsed, same] = Scheme::ALL.map(error);
    assert_eq!(whole, same);
    assert!(elapsed < 0.2 * whole, "{whole} {elapsed}");
    for scheme in Scheme::ALL {
        assert_eq!(Scheme::find(scheme.name()), Some(scheme));
    }
    assert_eq!(Scheme::find("verlet"), None);
}

/// 24 contacts whose normal turns, integrated in polar coordinates by another program.
#[test]
fn turning_contacts_are_those_of_another_program() {
    let text = include_str!("../../../../tests/data/turning_contacts.json");
    let reference: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let cases = reference["cases"].as_array().expect("cases");
    for case in cases {
        let number = |name: &str| case[name].as_f64().expect("a number");
        let law = if number("power") == 1.0 { "gran/hooke/history" } else { "paper" };
        let contact = contact(law, [number("kappa"), number("psi"), 0.0, 0.0]);
        let reduction = Reduction { mu: number("mu"), alpha: number("alpha") };
        let dt = undamped_contact_time(contact.law()) / 1e4;
        for scheme in [Scheme::Lammps, Scheme::SynchronizedVerlet] {
            let stepping = Stepping { scheme, overlap: number("overlap"), reduction };
            let found = step(&contact, dt, 0.5, &stepping, 10.0).expect("an end");
            let off = (found.eps_t - number("eps_t")).abs();
            let apart = (found.eps_n - number("eps_n")).abs();
            assert!(off.max(apart) < 2e-3, "{scheme:?} {found:?} {case}");
        }
        // With a small overlap it is a normal that stands still.
        let still = step(&contact, dt, 0.5, &Stepping::default(), 10.0).expect("an end");
        let turned = [1e-4, 1e-5, 1e-6].map(|overlap| {
            let stepping = Stepping { scheme: Scheme::Lammps, overlap, reduction };
            let found = step(&contact, dt, 0.5, &stepping, 10.0).expect("an end");
            (found.eps_t - still.eps_t).abs()
        });
        assert!(turned[2] < 1e-4 && turned[2] <= turned[0], "{turned:?} {case}");
    }
    assert_eq!(cases.len(), 24);
    // The numbers of docs/particle-codes.md.
    let stepping = Stepping { overlap: 0.01, ..Stepping::default() };
    let hooke = contact("gran/hooke/history", [3.0, 2.0, 0.0, 0.0]);
    let found = step(&hooke, 1e-4, 0.5, &stepping, 4.0).expect("an end");
    let rounded = [found.eps_t, found.eps_n].map(|number| format!("{number:.2}"));
    assert_eq!(rounded, ["0.14", "0.82"]);
}

/// Without friction and at grazing impacts spheres pass each other.
#[test]
fn spheres_that_pass_each_other_in_a_step_have_no_contact() {
    let contact = contact("paper", [1.0, 200.0, 0.0, 0.0]);
    let stepping = Stepping { overlap: 0.4, ..Stepping::default() };
    assert_eq!(step(&contact, 0.3, 0.5, &stepping, 3.2), None);
}

/// Sliding throughout, the tangential velocity falls by the normal momentum, in steps too.
#[test]
fn energy_weighs_both_restitutions() {
    let contact = Contact::new(5.0, 9.0, 0.3).expect("parameters");
    let stepped = stepped(&contact, 50.0, 0.5).expect("an end");
    assert!((stepped.eps_t - (1.0 - (1.0 + stepped.eps_n) / 9.0)).abs() < 1e-13);
    let settings = TimeStepSettings {
        contacts: vec![contact],
        steps_per_contact: vec![50.0],
        phases: 1,
        ..TimeStepSettings::default()
    };
    let result = time_steps::run(&settings, progress::SILENT).expect("errors");
    let exact = exact::collide(contact).expect("a collision");
    // μ²/α ψ² = 0.56 · 81 is the tangential energy in units of the normal one.
    let energy = |n: f64, t: f64| (n * n + 0.56 * 81.0 * t * t) / (1.0 + 0.56 * 81.0);
    let expected =
        (energy(stepped.eps_n, stepped.eps_t) - energy(exact.eps_n, exact.eps_t())).abs();
    let found = result.rows[0].energy.expect("errors").worst;
    assert!((found.error - expected).abs() < 1e-13, "{found:?} {expected}");
    assert_eq!(found.phase, 0.5);
}

#[test]
fn settings_out_of_range_are_refused() {
    let usual = TimeStepSettings {
        contacts: vec![Contact::new(1.0, 1.0, 0.0).expect("parameters")],
        ..TimeStepSettings::default()
    };
    let message = |change: fn(&mut TimeStepSettings)| {
        let mut settings = usual.clone();
        change(&mut settings);
        let error = time_steps::run(&settings, progress::SILENT).expect_err("a refusal");
        assert!(matches!(error, TimeStepsError::Settings(_)));
        error.to_string()
    };
    assert_eq!(message(|it| it.contacts.clear()), "contacts: 0 impacts; expected at least one");
    assert_eq!(
        message(|it| it.steps_per_contact.clear()),
        "steps: 0 time steps; expected at least one"
    );
    let expected = "expected a number of steps in a contact from 1.0 to 10000000.0";
    let steps = message(|it| it.steps_per_contact.push(0.5));
    assert_eq!(steps, format!("steps = 0.5 is out of range; {expected}"));
    assert!(message(|it| it.steps_per_contact.push(f64::NAN)).starts_with("steps = NaN is out"));
    assert!(message(|it| it.steps_per_contact.push(1.1e7)).ends_with(expected));
    assert_eq!(message(|it| it.phases = 0), "phases = 0 is out of range; expected 1 to 4096");
    assert!(message(|it| it.phases = 4097).starts_with("phases = 4097"));
    for overlap in [-0.1, 0.6, f64::NAN] {
        let mut settings = usual.clone();
        settings.stepping.overlap = overlap;
        let error = time_steps::run(&settings, progress::SILENT).expect_err("a refusal");
        assert!(error.to_string().contains("a number from 0 to 0.5"), "{error}");
    }
    assert!(message(|it| it.stepping.reduction.mu = 0.0).starts_with("mu = 0.0 is out of range"));
    assert!(
        message(|it| it.stepping.reduction.alpha = 1.5).starts_with("alpha = 1.5 is out of range")
    );
}
