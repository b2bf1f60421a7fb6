//! Settings with which a particle code fails: what fails is said, and no number is called ok.

use stickslip_model::Contact;
use stickslip_plane::progress;
use stickslip_practice::time_steps::{
    self, Scheme, Status, SteppedQuantity, Stepping, TimeStepSettings, step,
};

use crate::time_steps::{contact, run, stepped};

#[test]
fn a_spring_that_is_not_resolved_is_unstable() {
    // κ dt² = 4 at 1000/(2·3.218…) steps a contact: 507.3.
    let kappa = 1e6 * 4.0 / 3.218_065_459_719_043_f64.powi(2) / 4.0;
    let stiff = Contact::new(kappa, 0.5, 0.0).expect("parameters");
    let result = run(vec![stiff], &[20.0, 400.0, 499.0, 501.0, 2000.0]);
    let statuses: Vec<Status> = result.rows.iter().map(|row| row.status).collect();
    let (ok, unstable) = (Status::Ok, Status::Unstable);
    assert_eq!(statuses, [unstable, unstable, unstable, ok, ok]);
    assert!(result.rows.iter().all(|row| (row.stiffness < 1.0) == (row.status == ok)));
    assert_eq!(result.rows[0].unstable, 16);
    // However large an error is wanted, the step has to resolve the spring.
    let largest = result.largest_step(SteppedQuantity::TangentialRestitution, 2.0);
    assert_eq!(largest, Some(1.0 / 501.0));
}

#[test]
fn a_dashpot_that_is_not_resolved_is_unstable() {
    // A dashpot in stick: 2 b a dt = 4 at b a = 2/dt.
    let steps = 100.0;
    let dt = std::f64::consts::PI / steps;
    for (factor, status) in [(0.9, Status::Ok), (1.1, Status::Unstable)] {
        let b = factor * 2.0 / dt / 0.5;
        let dashpot = contact("gran/hooke/history", [0.01, 1e-3, 0.5, b]);
        assert_eq!(run(vec![dashpot], &[steps]).rows[0].status, status);
    }
}

#[test]
fn two_steps_a_contact_are_errors_not_failures() {
    for law in ["gran/hooke/history", "gran/hertz/history", "granular/hertz/tsuji/mindlin/force"] {
        let result = run(vec![contact(law, [4.0, 0.5, 0.1, 0.5])], &[1.0, 2.0, 3.0]);
        for row in &result.rows {
            let error = row.eps_t.expect("errors").worst.error;
            assert!(error > 0.05 && error.is_finite(), "{law}: {row:?}");
        }
        assert_eq!(result.largest_step(SteppedQuantity::TangentialRestitution, 0.05), None);
    }
}

#[test]
fn millions_of_steps_leave_rounding_alone() {
    let [elastic, damped] = [0.0, 0.2].map(|damping| {
        let contact = contact("gran/hooke/history", [4.0, 0.5, damping, 0.0]);
        run(vec![contact], &[1e6]).rows[0]
    });
    assert_eq!((elastic.status, damped.status), (Status::Ok, Status::Ok));
    // Without damping ε_n is of second order, and ε_t too where the contact starts in slip.
    assert!(elastic.eps_n.expect("errors").worst.error < 1e-12, "{elastic:?}");
    assert!(elastic.eps_t.expect("errors").worst.error < 2e-11, "{elastic:?}");
    let eps_t = damped.eps_t.expect("errors").worst.error;
    assert!(eps_t > 1e-8 && eps_t < 1e-5, "{damped:?}");
}

#[test]
fn no_step_is_no_hang() {
    let elastic = contact("gran/hooke/history", [4.0, 0.5, 0.0, 0.0]);
    for dt in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(step(&elastic, dt, 0.5, &Stepping::default(), 3.0), None);
    }
    for phase in [-0.1, 1.0, f64::NAN] {
        assert_eq!(step(&elastic, 0.1, phase, &Stepping::default(), 3.0), None);
    }
    for dt in [1e30, f64::MAX] {
        let elapsed = Stepping { scheme: Scheme::Elapsed, ..Stepping::default() };
        let found = step(&elastic, dt, 0.5, &elapsed, 3.0);
        assert!(found.is_none_or(|found| !found.is_stable()), "{dt}: {found:?}");
    }
}

#[test]
fn more_contacts_than_memory_are_refused() {
    let settings = TimeStepSettings {
        contacts: vec![Contact::new(1.0, 1.0, 0.0).expect("parameters"); 2442],
        phases: 4096,
        ..TimeStepSettings::default()
    };
    let error = time_steps::run(&settings, progress::SILENT).expect_err("too many").to_string();
    let expected = "phases = 4096 with 2442 impacts make too many contacts; expected a product of \
                    at most 10000000";
    assert_eq!(error, expected);
}

/// Linear damping near 2 holds a contact for long. Leaps, whose damping lags, hold it for ever.
#[test]
fn contacts_that_do_not_end_have_no_errors() {
    let sticky = contact("gran/hooke/history", [4.0, 0.5, 1.99, 0.0]);
    let result = run(vec![contact("gran/hooke/history", [4.0, 0.5, 0.1, 0.0]), sticky], &[20.0]);
    let row = result.rows[0];
    assert_eq!((row.status, row.unfinished), (Status::Unfinished, 16));
    assert!(SteppedQuantity::ALL.into_iter().all(|quantity| row.errors(quantity).is_none()));
    assert!(SteppedQuantity::ALL.into_iter().all(|it| result.largest_step(it, 10.0).is_none()));
    assert!(stepped(&sticky, 20.0, 0.5).is_none());
}

#[test]
fn impacts_that_hardly_slide_have_errors_of_their_own() {
    for psi in [1e-9, 1e-12] {
        let contact = contact("gran/hertz/history", [4.0, psi, 0.2, 0.5]);
        let row = run(vec![contact], &[50.0]).rows[0];
        let error = row.eps_t.expect("errors").worst.error;
        assert!(error > 0.01 && error < 0.2, "{psi:e}: {error}");
        assert!(row.energy.expect("errors").worst.error.is_finite());
    }
    let tiny = TimeStepSettings {
        contacts: vec![contact("gran/hertz/history", [4.0, 1e-100, 0.2, 0.5])],
        ..TimeStepSettings::default()
    };
    let error = time_steps::run(&tiny, progress::SILENT).expect_err("out of range").to_string();
    assert!(error.starts_with("kappa = 4.0, psi = 1e-100, damping = 0.2: psi = 1e-100"), "{error}");
}
