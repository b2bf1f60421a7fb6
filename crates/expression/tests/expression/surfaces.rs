//! Modes that slide along several surfaces at once.

use stickslip_expression::{Recording, System, SystemFamily};
use stickslip_solver::dynamic::{DynamicStart, run_dynamic};
use stickslip_solver::sliding::{SampledFilippov, SwitchedDynamic};
use stickslip_solver::{Dop853, EmbeddedPair, Options, RunError};
use stickslip_tracer::{Family, Point, hybrid::Itinerary};

/// With f = t·rate, both surfaces hold the state as long as f < 5/2.
const CROSS: &str = "parameter rate = 1, y0 = 0.75\nstate x = 1.5, y = y0\n\
                     x' = -sign(x) - sign(y)/2\ny' = rate*t - 2*sign(y) + sign(x)\n\
                     mode main\n  sliding on x = 0, y = 0\nend = 4";

fn run(system: &System, parameters: &[f64]) -> Result<Recording, RunError> {
    let runnable = system.with(parameters).expect("a system");
    runnable.record(EmbeddedPair::Dop853, runnable.end(), &Options::default())
}

fn labels(system: &System, found: &Recording) -> Vec<String> {
    let rule = |mode: usize, place: usize| system.modes[mode].rules[place].name(place);
    found.events.iter().map(|it| rule(it.from, it.guard)).collect()
}

#[test]
fn a_solution_slides_along_two_surfaces() {
    let cross = System::parse(CROSS).expect("a system");
    let found = run(&cross, &[1.0, 0.75]).expect("a run");
    assert!(found.run.decided);
    assert_eq!(labels(&cross, &found), ["arrives 1", "arrives 2", "leaves 2"]);
    // At 1, x vanishes, and y slides down beside it until both are held. The multipliers are
    // −f/5 and 2f/5, so that y is let go of at 5/2.
    let times = [1.0, 2.5 - 1.75_f64.sqrt(), 2.5];
    for (event, time) in found.events.iter().zip(times) {
        assert!((event.s - time).abs() < 1e-13, "{} {time}", event.s);
    }
    let names: Vec<_> = found.events.iter().map(|it| &*cross.modes[it.to].name).collect();
    let expected = ["main_sliding_above", "main_sliding_sliding", "main_sliding_above_released"];
    assert_eq!(names, expected);
    let state = &found.run.state;
    assert!(state[0] == 0.0 && (state[1] - 1.125).abs() < 1e-13, "{state:?}");
    // The text is what was written, and reads the same.
    let again = System::parse(&cross.text()).expect("a system");
    assert_eq!(again.text(), cross.text());
    assert_eq!(run(&again, &[1.0, 0.75]).expect("a run").run.state, *state);
}

#[test]
fn all_surfaces_are_decided_together() {
    // From both surfaces the run slides along both, without an event. A rule that puts the state
    // back there later, where y is pushed away, is no reason to stay.
    let start = CROSS.replace("x = 1.5", "x = 0").replace("y = y0", "y = 0");
    let with_rule = start.replace("end = 4", "  at 3 \"back\"\n    y := 0\nend = 4");
    let back = System::parse(&with_rule).expect("a system");
    let found = run(&back, &[1.0, 0.75]).expect("a run");
    assert_eq!(labels(&back, &found), ["leaves 2", "back"]);
    assert!((found.events[0].s - 2.5).abs() < 1e-13);
    assert_eq!(back.modes[found.run.mode].name, "main_sliding_above");
    assert!((found.run.state[1] - 1.0).abs() < 1e-13, "{:?}", found.run.state);
    // A spiral into both surfaces is faster and faster, and no loop at one instant.
    let spiral = "state x = 0, y = 0\nx' = sign(y) - sign(x)/2\ny' = -sign(x) - sign(y)/2\n\
                  mode main\n  sliding on x = 0\n  sliding on y = 0\nend = 1";
    let spiral = System::parse(spiral).expect("a system");
    let found = run(&spiral, &[]).expect("a run");
    assert!(found.events.is_empty() && found.run.state == [0.0, 0.0]);
    // Two ways to go on are none.
    let away = spiral.text().replace("- ", "+ ");
    let away = System::parse(&away).expect("a system");
    assert!(matches!(run(&away, &[]), Err(RunError::Field { .. })), "{}", away.text());
}

#[test]
fn a_family_tells_where_surfaces_are_left() {
    let cross = System::parse(CROSS).expect("a system");
    let family = SystemFamily::new(&cross, [0, 1], &cross.values(), None, Options::default());
    let family = family.expect("a family");
    // y is let go of before the end where 4·rate > 5/2.
    let held = family.label(&Point::new(0.62, 0.5)).expect("a label");
    let left = family.label(&Point::new(0.63, 0.5)).expect("a label");
    let (Itinerary::Fires(held), Itinerary::Fires(left)) = (held, left) else { panic!("runs") };
    assert_eq!((held.len(), left.len()), (2, 3));
    let found = family.free_run(&Point::new(0.62, 0.5)).expect("a run");
    let mut least = f64::INFINITY;
    for margin in &found.margins {
        let at = |rate: f64| family.margin(&Point::new(rate, 0.5), &margin.0).ok().flatten();
        if let Some(value) = at(0.625) {
            least = least.min(value.abs());
        }
    }
    assert!(least < 1e-12, "{least}: no margin vanishes at the boundary");
}

/// x″-like fields with random constant parts for each sign: z′ = c − z + Σ sᵢ bᵢ.
struct Random {
    constant: [f64; 3],
    jumps: [[f64; 3]; 2],
    wave: f64,
}

impl SwitchedDynamic for Random {
    type Mode = ();

    fn count(&self) -> usize {
        2
    }
    fn field(&self, (): (), signs: &[f64], s: f64, y: &[f64], slope: &mut [f64]) {
        for i in 0..3 {
            let jump = signs[0] * self.jumps[0][i] + signs[1] * self.jumps[1][i];
            slope[i] = self.constant[i] - y[i] + y[(i + 1) % 3] + jump;
        }
        slope[0] += self.wave * (3.0 * s).sin();
    }
    fn surfaces(&self, (): (), _s: f64, y: &[f64], values: &mut [f64]) {
        (values[0], values[1]) = (y[0], y[1] - y[2] / 2.0);
    }
}

#[test]
fn random_fields_slide_along_two_surfaces_as_the_solvers_own_do() {
    let mut random = fastrand::Rng::with_seed(11);
    let (mut slides, mut refused) = ([0; 3], 0);
    for case in 0..150 {
        let mut number = |size: f64| (random.f64() * 2.0 - 1.0) * size;
        let mut jumps = [(); 2].map(|()| [(); 3].map(|()| number(1.0)));
        (jumps[0][0], jumps[1][1]) = (-1.0 - jumps[0][0].abs(), -1.0 - jumps[1][1].abs());
        let constant = [(); 3].map(|()| number(1.5));
        let (wave, state) = (number(3.0), [(); 3].map(|()| number(2.0)));
        let system = Random { constant, jumps, wave };
        let mut text =
            String::from("h = x - 0\nk = y - z/2\nmode main\n  sliding on h = 0, k = 0\n");
        let names = ["x", "y", "z"];
        for i in 0..3 {
            let (name, next, wave) =
                (names[i], names[(i + 1) % 3], if i == 0 { wave } else { 0.0 });
            text = format!(
                "state {name} = {:?}\n{text}  {name}' = {:?} - {name} + {next} + sign(h)*{:?} + \
                 sign(k)*{:?} + {wave:?}*sin(3*t)\n",
                state[i], constant[i], jumps[0][i], jumps[1][i]
            );
        }
        // States are declared in the order of the last one first.
        let parsed = System::parse(&text).expect("a system");
        let options = Options::with_tolerance(1e-12);
        let runnable = parsed.with(&[]).expect("a system");
        let found = runnable.record(EmbeddedPair::Dop853, 5.0, &options);
        let filippov = SampledFilippov::new(system);
        let mode = filippov.mode((), 0.0, &state).expect("a start beside the surfaces");
        let start = DynamicStart { mode, s: 0.0, state: &state };
        let mut switches = Vec::new();
        let end = run_dynamic(Dop853, &filippov, start, 5.0, &options, &mut switches);
        let refuses = switches.last().is_some_and(|it| it.to.refusal().is_some());
        let (found, end) = match (found, end) {
            (Ok(found), Ok(end)) => (found, end),
            (found, end) => {
                assert!(found.is_err() == end.is_err() || refuses, "{case}\n{text}");
                refused += 1;
                continue;
            }
        };
        let times = |of: &[f64]| of.iter().map(|s| format!("{s:.9}")).collect::<Vec<_>>();
        let one: Vec<f64> = found.events.iter().map(|it| it.s).collect();
        let other: Vec<f64> = switches.iter().map(|it| it.s).collect();
        assert_eq!(one.len(), other.len(), "{case} {:?} {:?}\n{text}", times(&one), times(&other));
        assert!(one.iter().zip(&other).all(|(one, other)| (one - other).abs() < 1e-7), "{case}");
        for event in &found.events {
            slides[parsed.modes[event.to].name.matches("sliding").count()] += 1;
        }
        let state = found.run.state.iter().rev();
        assert!(state.zip(&end.state).all(|(one, other)| (one - other).abs() < 1e-7), "{case}");
    }
    assert!(slides.iter().all(|&count| count > 50) && refused < 8, "{slides:?} {refused}");
}

#[test]
fn what_cannot_slide_along_surfaces_is_refused() {
    let head = "state x = 1, y = 1, z = 1\nx' = -sign(x)\ny' = -sign(y)\nz' = 0\n";
    for (text, expected) in [
        ("sliding on x = 0, x = 0", "slides along this surface already"),
        ("sliding on x = 0, 0 = x", "slides along this surface already"),
        ("sliding on x = 0\nsliding on y = 0, z = 0", "moves no differently"),
        ("sliding on z = 0, z = 1", "no equation"),
        ("sliding on x = 0, x = 1, x = 2, x = 3, x = 4", "4 at most"),
        ("sliding on x = 0,", "expected"),
    ] {
        let error = System::parse(&format!("{head}{text}\n")).expect_err(text).to_string();
        assert!(error.contains(expected), "{text}: {error}");
    }
}
