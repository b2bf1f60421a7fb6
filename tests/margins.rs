//! Margins of prescribed runs vanish on the switch boundaries, at the places known to twenty digits.

#[expect(dead_code, reason = "shared with other tests")]
mod common;

use stickslip::model::Contact;
use stickslip::model::regularized::{Phase, Regularized};
use stickslip::solver::margin::{Margin, Margins, Place, margin, margins};
use stickslip::solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};

fn options() -> Options {
    Options { rtol: 1e-14, atol: 1e-14, first_step: Some(0.1), max_step: 0.1, ..Options::default() }
}

fn start(contact: Contact) -> (Regularized, Start<Phase, 8>) {
    let system = Regularized::new(contact);
    (system, Start { mode: Phase::first(&contact), s: 0.0, state: system.start() })
}

fn free(kappa: f64, psi: f64) -> Margins {
    let (system, start) = start(Contact::new(kappa, psi, 0.0).unwrap());
    margins(Dop853, &system, start, f64::INFINITY, &options()).unwrap()
}

fn value(kappa: f64, psi: f64, which: &Margin) -> f64 {
    let (system, start) = start(Contact::new(kappa, psi, 0.0).unwrap());
    let miss = margin(Dop853, &system, start, f64::INFINITY, &options(), which).unwrap();
    miss.expect("the margin exists near the boundary").value
}

#[test]
fn boundaries_are_the_zeros_of_margins() {
    let data = common::file("boundaries");
    let mut largest = 0.0_f64;
    let mut count = 0;
    for boundary in data["boundaries"].as_array().unwrap() {
        let (kappa, psi) = (common::number(&boundary["kappa"]), common::number(&boundary["psi"]));
        let (below, above) = (boundary["below"].as_u64(), boundary["above"].as_u64());
        // The side of fewer switches, a little off.
        let side = if below < above { -1.0 } else { 1.0 };
        let near = psi * (1.0 + side * 1e-5);
        let run = free(kappa, near);
        assert_eq!(Some(run.fired.len() as u64), if side < 0.0 { below } else { above });
        let nearest = run
            .near_misses
            .iter()
            .filter(|miss| miss.value > 0.0)
            .min_by(|a, b| a.value.total_cmp(&b.value))
            .expect("a near miss");
        let which = &nearest.margin;
        let kind = match which.place {
            Place::End => "end-of-contact",
            Place::Minimum { .. } if which.exits.len().is_multiple_of(2) => "slip-graze",
            Place::Minimum { .. } => "stick-graze",
        };
        assert_eq!(boundary["kind"], kind, "κ = {kappa}, ψ = {psi}");
        // Secant steps through zero: the margin exists on both sides.
        let (mut last, mut at) = (near, psi * (1.0 - side * 1e-6));
        let (mut last_value, mut at_value) = (nearest.value, value(kappa, at, which));
        assert!(at_value < 0.0, "beyond the boundary the margin is negative");
        for _ in 0..6 {
            if at_value == last_value {
                break;
            }
            let next = at - at_value * (at - last) / (at_value - last_value);
            (last, last_value) = (at, at_value);
            (at, at_value) = (next, value(kappa, next, which));
            if (at - last).abs() < 1e-14 {
                break;
            }
        }
        if (at - psi).abs() > 1e-12 {
            println!("{kind} κ = {kappa}, ψ = {psi}: off by {:.1e}, {which:?}", at - psi);
        }
        largest = largest.max((at - psi).abs());
        count += 1;
    }
    println!("{count} boundaries, largest error in ψ {largest:.1e}");
    assert!(largest < 1e-11);
}

/// A body that is dropped, with g = 1.
struct Drop;

impl HybridSystem<2, 1> for Drop {
    type Mode = ();

    fn field(&self, (): (), _s: f64, y: &State<2>) -> State<2> {
        State::from([y[1], -1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }

    fn guard_values(&self, (): (), _s: f64, y: &State<2>) -> [f64; 1] {
        [y[0]]
    }

    fn transition(&self, (): (), _guard: usize, _s: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([0.0, -0.5 * y[1]]))
    }
}

/// Height at the end of a run of length 1, above the floor and below: h − 1/2.
#[test]
fn the_end_of_the_span_leaves_a_margin() {
    let start = |height| Start { mode: (), s: 0.0, state: State::from([height, 0.0]) };
    let options = Options::with_tolerance(1e-14);
    let free = margins(Dop853, &Drop, start(0.6), 1.0, &options).unwrap();
    let [miss] = &free.near_misses[..] else { panic!("{:?}", free.near_misses) };
    assert_eq!(miss.margin.place, Place::End);
    assert!((miss.value - 0.1).abs() < 1e-15, "{}", miss.value);
    for height in [0.4, 0.5, 0.6] {
        let miss = margin(Dop853, &Drop, start(height), 1.0, &options, &miss.margin).unwrap();
        let value = miss.expect("a margin").value;
        // Measured: 1.0e-15.
        assert!((value - (height - 0.5)).abs() < 2e-15, "{height}: {value}");
    }
    // After a bounce it is the next flight that ends in the air.
    let free = margins(Dop853, &Drop, start(0.4), 1.0, &options).unwrap();
    assert_eq!(free.fired, [0]);
    assert!(
        free.near_misses.iter().any(|miss| miss.margin.place == Place::End && miss.value > 0.0)
    );
}

/// Phases that another one follows have no end of the run.
#[test]
fn only_the_last_phase_leaves_a_margin_at_the_end() {
    let run = free(63.0, 0.5);
    let at_end = run.near_misses.iter().filter(|miss| miss.margin.place == Place::End);
    let phases: Vec<usize> = at_end.map(|miss| miss.margin.exits.len()).collect();
    assert_eq!((run.fired.len(), &phases[..]), (6, &[6][..]));
}
