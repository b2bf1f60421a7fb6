//! Functions through points: polygons and splines.

use stickslip_expression::{Formula, Graph, Inputs, Program, System, Variable};
use stickslip_solver::{EmbeddedPair, Options};

/// The values of formulas of the time.
fn values(graph: &Graph, formulas: &[Formula], t: f64) -> Vec<f64> {
    let mut values = vec![0.0; formulas.len()];
    let inputs = Inputs { components: 0, parameters: 0, fixed: true };
    Program::compile(graph, formulas, inputs).run(t, &[], &mut values);
    values
}

/// Random points whose places ascend.
fn points(numbers: &mut fastrand::Rng, graph: &mut Graph) -> Vec<(f64, f64, Formula)> {
    let mut place = 4.0 * numbers.f64() - 2.0;
    (0..numbers.usize(2..40))
        .map(|_| {
            place += 0.01 + numbers.f64();
            let value = 6.0 * numbers.f64() - 3.0;
            (place, value, graph.constant(value))
        })
        .collect()
}

#[test]
fn a_polygon_is_linear_between_its_points() {
    let mut numbers = fastrand::Rng::with_seed(1);
    for _ in 0..300 {
        let mut graph = Graph::default();
        let points = points(&mut numbers, &mut graph);
        let t = graph.time();
        let given: Vec<_> = points.iter().map(|&(at, _, value)| (at, value)).collect();
        let polygon = graph.polygon(t, &given).expect("places ascend");
        for pair in points.windows(2) {
            let [(a, p, _), (b, q, _)] = [pair[0], pair[1]];
            for part in [0.0, 0.3, 0.9] {
                let right = p + part * (q - p);
                let found = values(&graph, &[polygon], a + part * (b - a))[0];
                assert!(
                    (found - right).abs() < 1e-14 * (b - a).recip().max(10.0),
                    "{found} {right}"
                );
            }
        }
        let [first, last] = [points[0], points[points.len() - 1]];
        assert_eq!(values(&graph, &[polygon], first.0 - 1.0), [first.1]);
        assert_eq!(values(&graph, &[polygon], last.0), [last.1]);
        assert_eq!(values(&graph, &[polygon], last.0 + 1.0), [last.1]);
    }
}

#[test]
fn a_spline_has_two_continuous_derivatives_and_ends_straight() {
    let mut numbers = fastrand::Rng::with_seed(2);
    for _ in 0..300 {
        let mut graph = Graph::default();
        let points = points(&mut numbers, &mut graph);
        let (t, one) = (graph.time(), graph.constant(1.0));
        let given: Vec<_> = points.iter().map(|&(at, _, value)| (at, value)).collect();
        let mut formulas = vec![graph.spline(t, &given).expect("places ascend")];
        for order in 0..3 {
            let slope = graph.slope(formulas[order], &mut |_, variable| {
                assert_eq!(variable, Variable::Time);
                one
            });
            formulas.push(slope);
        }
        let ends = [points[0].0, points[points.len() - 1].0];
        for &(at, value, _) in &points {
            let step = 1e-9;
            let [before, after] = [at - step, at].map(|at| values(&graph, &formulas, at));
            assert!((after[0] - value).abs() < 1e-12, "{after:?} {value}");
            for order in 0..3 {
                let most = after[order + 1].abs().max(before[order + 1].abs());
                let jump = (after[order] - before[order]).abs();
                let noise = 1e-11 * (1.0 + after[order].abs() + before[order].abs());
                assert!(jump <= 2.0 * step * most + noise, "{order}: {before:?} {after:?}");
            }
            if ends.contains(&at) {
                assert!(after[2].abs() < 1e-9 * (1.0 + before[3].abs()), "{after:?}");
            }
        }
        for at in [ends[0] - 3.0, ends[1] + 3.0] {
            assert_eq!(values(&graph, &formulas, at)[2..], [0.0, 0.0]);
        }
    }
}

/// A tank is emptied by a valve that opens and closes as a polygon says.
const VALVE: &str = "\
parameter open = 2
state level = 1
level' = -polygon(t, 0: 0, 1: open, 3: open, 4: 0)
when level < -4 \"low\"
at 1, 3, 4 \"corner\"
end = 5
";

#[test]
fn a_table_in_a_text() {
    let system = System::parse(VALVE).unwrap();
    let run = |values: &[f64]| {
        let runnable = system.with(values).unwrap();
        runnable.record(EmbeddedPair::Dop853, 5.0, &Options::default()).unwrap()
    };
    // The integral of the polygon is 3·open. Steps end at its corners.
    let found = run(&[2.1]);
    assert!((found.run.state[0] + 5.3).abs() < 1e-13, "{:?}", found.run.state);
    // −4 is reached where open·(t − ½) is 5.
    let low: Vec<f64> = found.events.iter().filter(|it| it.guard == 0).map(|it| it.s).collect();
    assert!(low.len() == 1 && (low[0] - 0.5 - 5.0 / 2.1).abs() < 1e-13, "{low:?}");
    assert!(run(&[1.5]).events.iter().all(|it| it.guard == 1));
    // The text that is written has the same run.
    let again = System::parse(&system.text()).unwrap().with(&[2.1]).unwrap();
    let again = again.record(EmbeddedPair::Dop853, 5.0, &Options::default()).unwrap();
    assert_eq!((again.run, again.events), (found.run, found.events));
    assert!(
        stickslip_expression::format(VALVE).unwrap().contains("polygon(t, 0:0, 1:open, 3:open")
    );
}

#[test]
fn a_narrow_tooth_of_a_table_is_found() {
    for width in [1e-2, 1e-5, 1e-8] {
        let text = format!(
            "state x = 0\nx' = 1\nwhen polygon(x, 3: 1, {}: -1, {}: 1) crosses 0\nend = 10",
            3.0 + width,
            3.0 + 2.0 * width
        );
        let runnable = System::parse(&text).unwrap().with(&[]).unwrap();
        let found = runnable.record(EmbeddedPair::Dopri5, 10.0, &Options::default()).unwrap();
        let times: Vec<f64> = found.events.iter().map(|event| event.s).collect();
        let right = [3.0 + 0.5 * width, 3.0 + 1.5 * width];
        assert_eq!(times.len(), 2, "{width}: {times:?}");
        assert!(times.iter().zip(right).all(|(t, right)| (t - right).abs() < 1e-12), "{times:?}");
    }
}
