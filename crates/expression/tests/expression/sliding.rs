//! Modes that slide along a surface, and runs that go on behind an accumulation.

use stickslip_expression::{By, Recording, System, SystemFamily};
use stickslip_solver::dynamic::{DynamicStart, run_dynamic};
use stickslip_solver::sliding::{SampledFilippov, SurfaceSide, TwoFields};
use stickslip_solver::{Dop853, EmbeddedPair, Options, Outcome};
use stickslip_tracer::{Family, Point};

const BELT: &str = "parameter belt = 0.5, friction = 0.8\nstate x = -0.3, v = belt\n\
                    x' = v\nv' = -x - friction*sign(v - belt)\n\
                    mode move\n  sliding on v = belt\nend = 20";

fn run(system: &System, parameters: &[f64]) -> Recording {
    let runnable = system.with(parameters).expect("a system");
    let end = runnable.end();
    runnable.record(EmbeddedPair::Dop853, end, &Options::default()).expect("a run")
}

fn modes(system: &System, run: &Recording) -> Vec<String> {
    run.stays().iter().map(|stay| system.modes[stay.mode].name.clone()).collect()
}

#[test]
fn a_block_on_a_belt_sticks_and_slips() {
    let belt = System::parse(BELT).expect("a system");
    let found = run(&belt, &[0.5, 0.8]);
    assert!(found.run.decided && found.run.outcome == Outcome::ReachedEnd);
    // It is carried to x = 0.8, and swings about it, touching the velocity of the belt.
    let (slides, slips) = (found.events[0].s, found.events[1].s);
    assert_eq!(slides, 0.0);
    assert!((slips - 2.2).abs() < 1e-13, "{slips}");
    let names = modes(&belt, &found);
    assert_eq!(names, ["move_above", "move_sliding", "move_below_released"]);
    assert!((found.touches[0].s - slips - std::f64::consts::TAU).abs() < 1e-6);
    // Where friction is weaker the faster it slips, it sticks again, and stays on the surface.
    let weaker = BELT.replace("sign(v - belt)", "sign(v - belt) + 0.2*(v - belt)");
    let weaker = System::parse(&weaker).expect("a system");
    let found = run(&weaker, &[0.5, 0.8]);
    assert_eq!(&modes(&weaker, &found)[2..4], ["move_below_released", "move_sliding"]);
    let state = found.at(found.events[2].s + 1e-3).expect("within the run");
    assert!((state[1] - 0.5).abs() < 1e-13, "{state:?}");
    assert!((found.events[3].before[0] - 0.8).abs() < 1e-12, "it slips where it slipped before");
}

#[test]
fn a_relay_stays_at_zero_and_a_strong_push_crosses() {
    let relay = "parameter push = 0\nstate x = 1\nmode main\n  sliding on x = 0\n\
                 x' = push - sign(x)\nend = 3";
    let relay = System::parse(relay).expect("a system");
    let found = run(&relay, &[0.0]);
    assert_eq!(found.events.len(), 1);
    assert!((found.events[0].s - 1.0).abs() < 1e-14 && found.run.state[0].abs() < 1e-15);
    let found = run(&relay, &[-2.0]);
    assert_eq!(modes(&relay, &found), ["main_above", "main_below"]);
    assert!((found.events[0].s - 1.0 / 3.0).abs() < 1e-14);
    assert!((found.run.state[0] + 3.0 - 1.0 / 3.0).abs() < 1e-13);
    // A push that changes lets go of it, and the zero of the surface and its rate hides nothing.
    let swing = "state x = 0\nx' = 2*sin(t) - sign(x)\nmode main\n  sliding on x = 0\nend = 30";
    let swing = System::parse(swing).expect("a system");
    let found = run(&swing, &[]);
    let first = &found.events[1];
    assert!((first.s - std::f64::consts::FRAC_PI_6).abs() < 1e-13, "{}", first.s);
    // x = √3 − 2 cos s − s + π/6 is 0 again where the push has turned, so that it crosses.
    let back = found.events[2].s;
    let x = 3.0_f64.sqrt() - 2.0 * back.cos() - back + std::f64::consts::FRAC_PI_6;
    assert!(x.abs() < 1e-10 && modes(&swing, &found)[3] == "main_below", "{back}: {x:e}");
}

#[test]
fn a_run_starts_on_either_side_of_a_surface() {
    let belt =
        System::parse(&BELT.replace("0.3, v = belt", "0.3, v = 2*belt - 0.6")).expect("a system");
    for (speed, first) in [(0.9, "move_above"), (0.2, "move_below")] {
        let found = run(&belt, &[speed, 0.8]);
        assert_eq!(modes(&belt, &found)[0], first);
    }
    // In a plane of parameters the side is an event, whose condition has a margin.
    let family = SystemFamily::new(&belt, [0, 1], &belt.values(), None, Options::default());
    let family = family.expect("a family");
    let margins = |belt: f64| family.free_run(&Point::new(belt, 0.8)).expect("a run").margins;
    assert!(margins(0.9).iter().any(|(_, value)| (value - 0.3).abs() < 1e-15));
    assert!(margins(0.2).iter().any(|(_, value)| (value + 0.4).abs() < 1e-15));
    // A start by a condition goes to the right side, too.
    let text = BELT.replace("mode move", "mode rest\n  v' = 0\nmode move");
    let text = format!("{text}\nstart if belt > 0.4 in move else rest");
    let system = System::parse(&text.replace(", v = belt", ", v = belt - 0.1")).expect("a system");
    for (speed, first) in [(0.5, "move_below"), (0.3, "rest")] {
        assert_eq!(modes(&system, &run(&system, &[speed, 0.8]))[0], first);
    }
    assert_eq!(System::parse(&system.text()).expect("a system").text(), system.text());
}

#[test]
fn rules_enter_a_mode_that_slides_on_the_right_side() {
    let text = "state x = 1, v = 0\nx' = v\nmode fly\n  v' = -1\n  when x < 0 -> move\n    x := 0\n    \
                v := 0.5*v\nmode move\n  sliding on v = 0\n  v' = -0.5*sign(v)\n  \
                at 2, 4 \"kick\"\n    v := v + 1\n  at 7 -> fly\nstart in fly\nend = 7.5";
    let system = System::parse(text).expect("a system");
    let found = run(&system, &[]);
    assert_eq!(
        modes(&system, &found),
        ["fly", "move_below", "move_above", "move_sliding", "move_above", "move_sliding", "fly"]
    );
    // It arrives after √2 with the velocity −√2/2, and is kicked before it stops.
    let stops = 2.0_f64.sqrt();
    let kicked = -stops / 2.0 + 0.5 * (2.0 - stops) + 1.0;
    let times: Vec<f64> = found.events.iter().map(|event| event.s).collect();
    assert!((found.at(2.0).expect("within")[1] - kicked).abs() < 1e-12, "{times:?}");
}

#[test]
fn a_ball_comes_to_rest_and_the_run_goes_on() {
    let text = "parameter e = 0.5\nstate x = 0.5, v = 0\nx' = v\nmode fall\n  v' = -1\n  \
                when x < 0 \"floor\"\n    x := 0\n    v := -e*v\n    rest -> lie\n    x := 0\n    \
                v := 0\nmode lie\n  v' = 0\n  at 5 -> fall\n    v := 1\nend = 6";
    let ball = System::parse(text).expect("a system");
    let found = run(&ball, &[0.5]);
    assert_eq!(found.run.outcome, Outcome::ReachedEnd);
    // It lies from 1 + 2 = 3 on, and is thrown up at 5.
    assert_eq!(found.at(4.0), Some(vec![0.0, 0.0]));
    assert!((found.rests[0].s - 3.0).abs() < 1e-9, "{:?}", found.rests);
    assert_eq!(modes(&ball, &found), ["fall", "lie", "fall"]);
    assert_eq!([2.9, 4.0, 5.5].map(|s| found.mode_at(s)), [0, 1, 0]);
    assert!((found.run.state[0] - 0.5).abs() < 1e-12, "{:?}", found.run.state);
    let text = ball.text();
    assert!(text.contains("rest -> lie"), "{text}");
    assert_eq!(System::parse(&text).expect("the same").text(), text);
    assert_eq!(stickslip_expression::format(&text).expect("formatted").lines().count(), {
        text.trim_end().lines().count()
    });
    // Derivatives end at the accumulation.
    let options = Options::default();
    let moves = ball
        .sensitivities(&[By::Parameter(0)], &[0.5], EmbeddedPair::Dop853, None, &options)
        .expect("derivatives");
    assert!(matches!(moves.recording.run.outcome, Outcome::Zeno { .. }));
}

#[test]
fn a_sliding_system_is_text_that_runs_the_same() {
    for text in [BELT, &BELT.replace("sign(v - belt)", "(if v > belt then 1 else -1)")] {
        let system = System::parse(text).expect("a system");
        let again = System::parse(&system.text()).expect("the same");
        assert_eq!(again.text(), system.text());
        let (one, other) = (run(&system, &[0.4, 0.9]), run(&again, &[0.4, 0.9]));
        assert_eq!(one.events, other.events);
        assert_eq!(one.run, other.run);
    }
}

#[test]
fn derivatives_go_through_a_surface() {
    let belt = System::parse(BELT).expect("a system");
    let options = Options::with_tolerance(1e-12);
    let by = [By::Parameter(0), By::Parameter(1)];
    let found = belt.sensitivities(&by, &[0.5, 0.8], EmbeddedPair::Dop853, Some(20.0), &options);
    let found = found.expect("derivatives");
    // It slips at (friction − x₀)/belt.
    let slips = &found.places[1];
    assert!((slips.s_by[0] + 1.1 / 0.25).abs() < 1e-11, "{slips:?}");
    assert!((slips.s_by[1] - 2.0).abs() < 1e-11, "{slips:?}");
}

#[test]
fn what_cannot_slide_is_refused() {
    let head = "state x = 1, v = 0\nx' = v\nv' = -sign(v)\n";
    for (text, expected) in [
        ("mode a\n  sliding on x = 2\n", "no equation of mode `a` changes"),
        ("mode a\n  sliding on x = 2\n  v' = -sign(x - 2)\n", "moves no differently"),
        ("mode a\n  sliding on 1 = 0\n", "made of numbers alone"),
        ("mode a\n  sliding v = 0\n", "expected"),
        ("mode a\n  sliding on v = 0\n  when x < 0 if v > 0 -> a else -> b\nmode b\n", "chooses"),
        ("mode a\n  rest -> a\n", "expected a rule"),
        ("mode a\n  when x < 0 -> b\n    rest -> a\nmode b\n", "stays in its mode"),
        ("mode a\n  when x < 0\n    rest -> c\nmode b\n", "there is no mode `c`"),
        ("mode a\n  when x < 0\n    rest -> b\nmode b\n  sliding on v = 0\n", "comes to rest"),
        ("mode a\nmode b\nstart if x > 0 in a else b\n", "changes during a run"),
        ("mode a\nmode b\nstart if 1 > 0 in a\n", "else"),
    ] {
        let error = System::parse(&format!("{head}{text}")).expect_err(text).to_string();
        assert!(error.contains(expected), "{text}{error}");
    }
}

/// Random linear fields on both sides of a line, as text and as two closures.
#[test]
fn random_fields_slide_as_the_solvers_own_do() {
    let mut random = fastrand::Rng::with_seed(7);
    let mut number = || (random.f64() * 4.0 - 2.0, random.f64() * 4.0 - 2.0);
    let (mut slides, mut crossings, mut refused) = (0, 0, 0);
    for case in 0..300 {
        let [(a, b), (c, d), (g, k), (l, m)] = [number(), number(), number(), number()];
        let ((tilt, wave), (x0, y0)) = (number(), number());
        let text = format!(
            "state x = {x0:?}, y = {y0:?}\nh = y - {tilt:?}*x\nmode main\n  sliding on h = 0\n  \
             x' = if h > 0 then {a:?} - x + {b:?}*y else {g:?} - x + {k:?}*y\n  \
             y' = if h > 0 then {c:?} + {d:?}*x - y + {wave:?}*sin(3*t) else {l:?} + {m:?}*x - y\n"
        );
        let system = System::parse(&text).expect("a system");
        let runnable = system.with(&[]).expect("a system");
        let options = Options::with_tolerance(1e-12);
        let found = runnable.record(EmbeddedPair::Dop853, 6.0, &options);
        let filippov = SampledFilippov::new(TwoFields(
            |s: f64, y: &[f64], slope: &mut [f64]| {
                slope[0] = a - y[0] + b * y[1];
                slope[1] = c + d * y[0] - y[1] + wave * (3.0 * s).sin();
            },
            |_, y: &[f64], slope: &mut [f64]| {
                slope[0] = g - y[0] + k * y[1];
                slope[1] = l + m * y[0] - y[1];
            },
            |_, y: &[f64]| y[1] - tilt * y[0],
        ));
        let state = [x0, y0];
        let mode = filippov.mode((), 0.0, &state).expect("a start beside the surface");
        let start = DynamicStart { mode, s: 0.0, state: &state };
        let mut switches = Vec::new();
        let end = run_dynamic(Dop853, &filippov, start, 6.0, &options, &mut switches);
        let (found, end) = match (found, end) {
            (Ok(found), Ok(end)) => (found, end),
            // Where both fields become tangential at once, neither goes on.
            (one, other) => {
                println!("{case}: {:?} {:?} {text}", one.map(|_| ()), other.map(|_| ()));
                refused += 1;
                continue;
            }
        };
        assert_eq!(found.events.len(), switches.len(), "{case}\n{text}");
        for (one, other) in found.events.iter().zip(&switches) {
            assert!((one.s - other.s).abs() < 1e-8, "{case}: {} {}\n{text}", one.s, other.s);
            let slid = system.modes[one.to].name == "main_sliding";
            assert_eq!(slid, other.to.sides() == [SurfaceSide::Sliding], "{case}");
            slides += usize::from(slid);
            crossings += usize::from(!slid);
        }
        for (one, other) in found.run.state.iter().zip(&end.state) {
            assert!((one - other).abs() < 1e-8, "{case}: {:?} {:?}", found.run, end);
        }
    }
    assert!(slides > 100 && crossings > 100 && refused < 5, "{slides} {crossings} {refused}");
}

#[test]
fn what_is_called_rest_stays_a_name() {
    let text =
        "state rest = 1\nrest' = -rest\nmode main\n  when rest < 0.5\n    rest := 1\nend = 2";
    let system = System::parse(text).expect("a system");
    assert_eq!(run(&system, &[]).events.len(), 2);
}

/// Beside a surface that moves, and slopes that are constant there, the conditions under which it
/// is left never change. The text of the system reads as the same system all the same.
#[test]
fn constant_slopes_beside_a_surface_have_a_text() {
    let text = "state x = 2\nmode m\n  sliding on x = t\n  x' = -3*sign(x - t)\nend = 3\n";
    let system = System::parse(text).expect("a system");
    let again = System::parse(&system.text()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again.text(), system.text());
}
