//! Systems from text against closed forms.

use std::f64::consts::PI;

use stickslip_expression::{Runnable, System, SystemFamily};
use stickslip_solver::dynamic::{DynamicRun, DynamicSwitch};
use stickslip_solver::{EmbeddedPair, Options};
use stickslip_tracer::{Family, Point, hybrid::Itinerary};

fn run(runnable: &Runnable) -> (DynamicRun<usize>, Vec<DynamicSwitch<usize>>) {
    let found = runnable.record(EmbeddedPair::Dop853, runnable.end(), &Options::default());
    let found = found.expect("a run");
    (found.run, found.events)
}

fn parsed(text: &str) -> System {
    System::parse(text).unwrap_or_else(|error| panic!("{error}"))
}

fn runs(text: &str) -> (DynamicRun<usize>, Vec<DynamicSwitch<usize>>) {
    let system = parsed(text);
    let found = run(&system.with(&system.values()).expect("parameters"));
    // As text that was written, the run is the same bit for bit.
    let again = parsed(&system.text());
    let other = run(&again.with(&again.values()).expect("parameters"));
    assert_eq!(found, other, "{}", system.text());
    let formatted = stickslip_expression::format(text).expect("a text");
    assert_eq!(stickslip_expression::format(&formatted).expect("a text"), formatted);
    assert_eq!(parsed(&formatted).text(), system.text(), "{formatted}");
    found
}

const BELT: &str = "
parameter belt = 0.5, static = 1, kinetic = 0.6   # friction forces
state x = 0, v = belt

mode stick
  x' = v
  v' = 0
  when x > static \"breaks away\" -> slip
mode slip
  x' = v
  v' = kinetic - x
  when v > belt \"stops\" -> stick
    v := belt

start in stick
end = 100
";

/// Sticks until x = 1 at 2; slides as x = 0.6 + 0.4·cos s + 0.5·sin s until v = 0.5 again.
#[test]
fn a_block_on_a_belt() {
    let (end, switches) = runs(BELT);
    assert!(end.decided && end.s == 100.0);
    assert!((switches[0].s - 2.0).abs() < 1e-13);
    let slide = 2.0 * (std::f64::consts::PI - (0.4_f64 / 0.5).atan());
    assert!((switches[1].s - switches[0].s - slide).abs() < 1e-9, "{}", switches[1].s - slide);
}

#[test]
fn parameters_are_given_when_it_runs() {
    let system = parsed(BELT);
    let slow = system.with(&[0.25, 1.0, 0.6]).expect("parameters");
    assert!((run(&slow).1[0].s - 4.0).abs() < 1e-12);
    let error = |values: &[f64]| system.with(values).unwrap_err().to_string();
    assert_eq!(
        error(&[1.0]),
        "the number of parameters = 1 is out of range; expected 3: belt, static, kinetic"
    );
    assert_eq!(
        error(&[1.0, f64::NAN, 1.0]),
        "static = NaN is out of range; expected a finite number"
    );
}

/// What is common to modes stands above them; a prime is the derivative along the flow.
#[test]
fn the_collision_of_spheres() {
    let (end, switches) = runs(include_str!("../../../../examples/systems/collision.slip"));
    let names: Vec<usize> = switches.iter().map(|switch| switch.to).collect();
    assert!(end.decided, "{end:?}");
    // touch, then o+o-o+, as the model has them; its coefficients follow from the end.
    assert_eq!(names, [3, 1, 4, 2, 3, 3]);
    let [_, v, time, _, w] = end.state[..] else { panic!("five components") };
    assert!((v + 0.8928588755).abs() < 1e-9 && (w - 0.09130132885).abs() < 1e-9, "{v} {w}");
    assert!((time - 3.157255656).abs() < 1e-8, "{time}");
}

#[test]
fn clocks_discrete_variables_and_branches() {
    let (end, switches) = runs(
        "
parameter dose = 2 in 0:10
state amount = 0
discrete count = 0, last = -1
amount' = -amount
every 1 from 0.5 \"dose\" priority 3
  amount := amount + dose
  count := count + 1
  last := t
at 2.25, 0.75 \"wash\" if count >= 2 and not amount < 0 -> late else -> early
  amount := 0
mode early
mode late
  when amount falls through 1 \"half\" -> end
start in early at 0
end = 10
",
    );
    // Washed at 0.75 (after one dose) and at 2.25 (after two).
    let at: Vec<f64> = switches.iter().map(|switch| switch.s).collect();
    assert_eq!(&at[..5], [0.5, 0.75, 1.5, 2.25, 2.5]);
    assert_eq!((switches[1].to, switches[3].to), (0, 1));
    assert!((end.s - (2.5 + 2.0_f64.ln())).abs() < 1e-10, "{end:?}");
    assert_eq!(end.state[1..], [3.0, 2.5]);
}

/// Jumps are decided, with and without a value between: sign(0) = 0.
#[test]
fn guards_that_jump_are_decided() {
    for jumps in ["(if sin(1000*t) > 0.99999 then 1 else -1)", "sign(sin(1000*t) - 0.99999)"] {
        let (end, switches) = runs(&format!(
            "state x = 0\nx' = 1\nmode before\nwhen {jumps} rises through 0 \"peak\" -> behind\nmode \
             behind\nend = 10"
        ));
        let expected = 1e-3 * 0.99999_f64.asin();
        assert!(end.decided && (switches[0].s - expected).abs() < 1e-12, "{jumps} {switches:?}");
        assert!(switches[0].jump != jumps.contains("sign"), "{switches:?}");
        assert_eq!(switches.len(), 1);
    }
}

#[test]
fn one_thousand_narrow_dips_are_found() {
    let mut numbers = fastrand::Rng::with_seed(4);
    for _ in 0..1000 {
        let width = 10.0_f64.powf(-3.0 + 2.0 * numbers.f64());
        let place = 1.0 + 8.0 * numbers.f64();
        let text = format!(
            "state x = 0\nx' = 1\nwhen 0.5 - exp(-((t - {place:?})/{width:?})^2) crosses 0\nend = 10"
        );
        let system = parsed(&text);
        let (end, switches) = run(&system.with(&[]).expect("no parameters"));
        let half = width * 2.0_f64.ln().sqrt();
        let found: Vec<f64> = switches.iter().map(|switch| switch.s).collect();
        assert!(end.decided && found.len() == 2, "{text}: {found:?}");
        assert!(
            (found[0] - (place - half)).abs() < 1e-12 && (found[1] - (place + half)).abs() < 1e-12
        );
    }
}

#[test]
fn runs_end_after_some_events() {
    let (end, switches) = runs(
        "state x = 0, v = 1\nx' = v\nv' = -x\n\
         when x crosses 0 \"node\" priority 2 end after 3 from zero 1\nend = 100",
    );
    let pi = std::f64::consts::PI;
    assert!((end.s - 3.0 * pi).abs() < 1e-9 && switches.len() == 3, "{end:?}");
}

/// Rules that stand at one place of two modes are counted apart, unless they have one label.
#[test]
fn rules_are_counted_one_by_one() {
    let text = |first: &str, second: &str| {
        format!(
            "state x = 0, y = 0\nmode a\n  x' = 1\n  y' = 0\n  when x > 1 {first} -> b\n    x := 0\n\
             mode b\n  x' = 1\n  y' = 1\n  when x > 1 {second} end after 3\n    x := 0\n  \
             when y > 1.5 -> a\n    y := 0\nstart in a\nend = 100\n"
        )
    };
    let end = |first, second| {
        let system = System::parse(&text(first, second)).expect("a system");
        let found = run(&system.with(&[]).expect("no parameters"));
        found.0.s
    };
    // b counts at 2, 4 and 6; a acts at 1, 3 and 5, and with it the third time is 3.
    assert!((end("", "") - 6.0).abs() < 1e-12);
    assert!((end("\"up\"", "\"count\"") - 6.0).abs() < 1e-12);
    assert!((end("\"one\"", "\"one\"") - 4.0).abs() < 1e-12);
    // A common rule counts wherever it acts.
    let common = "state x = 0\nx' = 1\nwhen x > 1 end after 3\n  x := 0\nmode a\n  at 1.5 -> b\n\
                  mode b\n  at 2.5 -> a\nstart in a\nend = 100\n";
    let system = System::parse(common).expect("a system");
    let found = run(&system.with(&[]).expect("no parameters"));
    assert!((found.0.s - 3.0).abs() < 1e-12, "{}", found.0.s);
}

#[test]
fn a_rule_that_leaves_everything_as_it_is_notes_where_its_condition_begins() {
    let found = |rule: &str| {
        let text = format!("state x = 0\nx' = cos(t)\nwhen {rule}\nend = 20");
        let runnable = System::parse(&text).unwrap().with(&[]).unwrap();
        let found = runnable.record(EmbeddedPair::Dop853, 20.0, &Options::default()).unwrap();
        found.events.iter().map(|event| event.s).collect::<Vec<f64>>()
    };
    let near = |found: &[f64], right: &[f64]| {
        assert_eq!(found.len(), right.len(), "{found:?}");
        assert!(found.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-8), "{found:?}");
    };
    let sixth = PI / 6.0;
    let above = [sixth, sixth + 2.0 * PI, sixth + 4.0 * PI, sixth + 6.0 * PI];
    near(&found("x > 0.5"), &above);
    near(&found("x >= 0.5 \"high\""), &above);
    near(&found("x > 0.5 and t > 3"), &above[1..]);
    near(&found("x > 0.5 end after 2"), &above[..2]);
    // It holds at the start, and begins to hold later.
    near(&found("x < 0.5"), &[5.0, 17.0, 29.0].map(|k| k * sixth));
    near(&found("t > -1 -> end"), &[0.0]);
}

#[test]
fn guards_that_start_from_zeros_of_higher_order_need_no_declaration() {
    // A block is held by friction, let go by a growing load, and held again where it stops. Its
    // guard of stopping starts from zero together with its rate.
    let text = "state v = 0, x = 0\nmode stick\n  v' = 0\n  x' = 0\n  when sin(t) > 0.5 -> slip\n\
                mode slip\n  v' = sin(t) - 0.5\n  x' = v\n  when v < 0 \"stops\" -> stick\n    v := 0\n\
                start in stick\nend = 7";
    let (_, events) = runs(text);
    let sixth = std::f64::consts::FRAC_PI_6;
    // It stops where cos(π/6) − cos t = (t − π/6)/2.
    let excess = |t: f64| sixth.cos() - t.cos() - 0.5 * (t - sixth);
    assert!(events.len() == 3 && excess(events[1].s).abs() < 1e-9, "{events:?}");
    assert!((events[0].s - sixth).abs() < 1e-10 && events[1].s > 2.5, "{events:?}");
    assert!((events[2].s - 13.0 * sixth).abs() < 1e-10, "{events:?}");
    // Of the third order: the load and its rate are balanced where the block is let go.
    let text = "state a = 0, v = 0, x = 0\nmode stick\n  a' = 0\n  v' = 0\n  x' = 0\n  at 1 -> slip\n\
                mode slip\n  a' = cos(t - 1)\n  v' = a\n  x' = v\n  when x < 0 -> end\nstart in stick\n\
                end = 30";
    let (end, events) = runs(text);
    // x = τ − sin τ never comes back.
    assert!(events.len() == 1 && end.s == 30.0, "{events:?}");
    let (end, _) = runs(&text.replace("cos(t - 1)", "1 - (t - 1)"));
    // x = τ³/6 − τ⁴/24 vanishes again at τ = 4.
    assert!((end.s - 5.0).abs() < 1e-9, "{end:?}");
}

#[test]
fn names_that_no_text_can_have_are_changed_in_it() {
    let mut system = parsed(
        "parameter a = 2, b = 3\nstate x = a, y = 0\nmode p\n  x' = -b*x\n  y' = 1\n\
                             \n  when y > 1 -> q\nmode q\n  x' = 0\n  y' = x\nstart in p\nend = 2",
    );
    for (own, name) in system.parameters.iter_mut().zip(["end", "end"]) {
        own.name = name.to_owned();
    }
    for (own, name) in system.components.iter_mut().zip(["sin", "2 y\n"]) {
        own.name = name.to_owned();
    }
    for (own, name) in system.modes.iter_mut().zip(["", "stick slip"]) {
        own.name = name.to_owned();
    }
    let again = parsed(&system.text());
    let names = |it: &System| it.modes.iter().map(|mode| mode.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&again), ["main", "stick_slip"]);
    assert_eq!(again.parameters[0].name, "end_");
    assert_eq!(again.parameters[1].name, "end__");
    assert_eq!([&again.components[0].name, &again.components[1].name], ["sin_", "_2_y_"]);
    let [one, other] = [system, again].map(|it| run(&it.with(&[2.0, 3.0]).expect("parameters")));
    assert_eq!(one, other);
}

#[test]
fn the_first_mode_of_a_family_has_a_margin() {
    // Above w = v/2 the ball rises, and else it falls before the end.
    let text = "parameter v = 1, w = 1\nstate x = 1, u = 0\nx' = u\nu' = -1\n\
                when x < 0 \"floor\"\n  x := 9\nmode up\n  u' = w\nmode down\n\
                start if 2*w >= v in up else down\nend = 2";
    let system = System::parse(text).expect("a system");
    let family = SystemFamily::new(&system, [0, 1], &system.values(), None, Options::default());
    let family = family.expect("a family");
    let start = family.rules().iter().position(|name| name == "start").expect("a rule");
    let (above, below) = (Point::new(1.0, 0.51), Point::new(1.0, 0.49));
    assert_eq!(family.label(&above), Ok(Itinerary::Fires(vec![start])));
    assert_eq!(family.label(&below), Ok(Itinerary::Fires(vec![start, 1 - start])));
    let margins = family.free_run(&above).expect("a run").margins;
    let at = |margin: &_, w: f64| family.margin(&Point::new(1.0, w), margin).expect("a margin");
    let zero = margins.iter().find(|(margin, _)| at(margin, 0.5) == Some(0.0));
    let (margin, value) = zero.expect("the condition vanishes at its limit");
    assert!((value - 0.02).abs() < 1e-15);
    assert!((at(margin, 0.49).expect("a value") + 0.02).abs() < 1e-15);
    // Rules at given times would not count at the start.
    let clock = text.replace("when x", "at 1\nwhen x");
    let system = System::parse(&clock).expect("a system");
    let refused = SystemFamily::new(&system, [0, 1], &system.values(), None, Options::default());
    assert!(refused.expect_err("clocks").to_string().contains("first mode"));
}

#[test]
fn a_count_may_stay_at_the_limit_of_a_condition() {
    let ends = |rule: &str| {
        let text = format!(
            "state x = 1\ndiscrete k = 0\nx' = -1\nwhen x < 0 \"hit\"\n  x := 1\n  k := k + 1\n\
             {rule}\nend = 10"
        );
        runs(&text).0.s
    };
    for (rule, s) in [
        ("when k >= 3 -> end", 3.0),
        ("when k > 2 -> end", 3.0),
        ("when not (k < 3) -> end", 3.0),
        ("when 3 <= k or x > 2 -> end", 3.0),
        ("when x < 0.5 and k >= 2 -> end", 2.5),
        ("when x < 0.5 and k > 2 -> end", 3.5),
        ("when x < 0.5 and k < 3\n  k := k + 1", 10.0),
    ] {
        assert!((ends(rule) - s).abs() < 1e-13, "{rule}: {}", ends(rule));
    }
    // So may what stands still in a mode.
    let still = "state x = 0\nmode a\n  x' = 1\n  when x > 1 -> b\n    x := 1\nmode b\n  x' = 0\n  \
                 when x < 1 -> a\n  when x >= 1 and t > 2 -> end\nend = 3";
    assert!((runs(still).0.s - 2.0).abs() < 1e-13);
    let text = parsed(still).text();
    assert_eq!(parsed(&text).text(), text);
}

#[test]
fn a_jump_may_end_at_the_limit_of_a_condition() {
    let ends = |rule: &str| runs(&format!("state x = 0.25\nx' = 1\n{rule}\nend = 10")).0.s;
    for (rule, s) in [
        ("when floor(x) >= 1 -> end", 0.75),
        ("when floor(x) > 1 -> end", 1.75),
        ("when 2 <= floor(x) -> end", 1.75),
        ("when not (floor(2*x) < 3) -> end", 1.25),
        ("when floor(t/2) >= 1 and x > 0 -> end", 2.0),
        ("when sign(x - 4) >= 0 -> end", 3.75),
    ] {
        assert!((ends(rule) - s).abs() < 1e-13, "{rule}: {}", ends(rule));
    }
}
