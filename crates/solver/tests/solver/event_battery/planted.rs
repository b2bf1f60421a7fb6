//! Guards with planted zeros.

use stickslip_solver::{
    Direction, Dop853, Dopri5, Grazing, Guard, HybridSystem, Method, Observer, Options, Outcome,
    RunError, Start, State, StepSize, SwitchEvent,
};

use crate::black_box::BlackBox;
use crate::erased::run;

/// y' = 1 with one guard, which is a function of y = s. A switch changes nothing.
pub struct Planted<'a> {
    value: &'a dyn Fn(f64) -> f64,
    guard: Guard,
}

impl<'a> Planted<'a> {
    pub fn new(value: &'a dyn Fn(f64) -> f64, guard: Guard) -> Self {
        Self { value, guard }
    }
}

impl HybridSystem<1, 1> for Planted<'_> {
    type Mode = ();

    fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [self.guard]
    }

    fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 1] {
        [(self.value)(y[0])]
    }

    fn transition(&self, (): (), _guard: usize, _s: f64, y: &State<1>) -> ((), State<1>) {
        ((), *y)
    }
}

/// The places where guards fired, and the places and values where they grazed.
#[derive(Debug, Default, PartialEq)]
pub struct Times {
    pub switches: Vec<f64>,
    pub grazings: Vec<(f64, f64)>,
}

impl<Mode, const N: usize> Observer<Mode, N> for Times {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.switches.push(event.s);
    }

    fn on_grazing(&mut self, grazing: &Grazing<Mode>) {
        self.grazings.push((grazing.s, grazing.margin));
    }
}

fn fixed(h: f64) -> Options {
    Options { step_size: StepSize::Fixed(h), ..Options::default() }
}

/// Runs a planted guard over [0, 1].
pub fn times<M: Method>(
    method: M,
    value: impl Fn(f64) -> f64,
    direction: Direction,
    options: &Options,
) -> Result<Times, RunError> {
    let system = Planted::new(&value, Guard::new(direction));
    let mut times = Times::default();
    let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
    let options = Options { max_switches: 100, max_steps: 20_000, ..*options };
    let end = run(method, &BlackBox(&system), start, 1.0, &options, &mut times)?;
    assert_eq!(end.outcome, Outcome::ReachedEnd, "{direction:?} {options:?}");
    Ok(times)
}

/// Steps from 1e-3 to the whole span, some of which divide the span, and adaptive steps.
pub fn step_sizes() -> Vec<Options> {
    let sizes = [1e-3, 0.01, 0.03, 1.0 / 16.0, 0.1, 0.25, 0.3, 1.0];
    sizes.map(fixed).into_iter().chain([Options::default()]).collect()
}

/// A guard with its known crossings.
pub struct Case {
    pub name: String,
    pub value: Box<dyn Fn(f64) -> f64>,
    pub falling: Vec<f64>,
    pub rising: Vec<f64>,
    /// A bound for the error of a root, mostly the rounding of the state over 1000 steps.
    /// Measured: 3e-15.
    pub tolerance: f64,
}

/// The result of a case: counts, and the largest error of a root that was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    pub planted: usize,
    pub found: usize,
    pub missed: usize,
    pub invented: usize,
    pub error: f64,
}

impl Score {
    pub fn add(&mut self, planted: &[f64], found: &[f64], tolerance: f64) {
        self.planted += planted.len();
        let mut free: Vec<f64> = found.to_vec();
        for &root in planted {
            let nearest = free
                .iter()
                .enumerate()
                .map(|(index, s)| (index, (s - root).abs()))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .filter(|(_, error)| *error <= tolerance);
            match nearest {
                Some((index, error)) => {
                    free.remove(index);
                    self.found += 1;
                    self.error = self.error.max(error);
                }
                None => self.missed += 1,
            }
        }
        self.invented += free.len();
    }
}

fn case(
    name: impl Into<String>,
    falling: &[f64],
    rising: &[f64],
    tolerance: f64,
    value: impl Fn(f64) -> f64 + 'static,
) -> Case {
    let (falling, rising) = (falling.to_vec(), rising.to_vec());
    Case { name: name.into(), value: Box::new(value), falling, rising, tolerance }
}

fn product(roots: &[f64], s: f64) -> f64 {
    roots.iter().map(|root| s - root).product()
}

/// Three simple roots whose distances are 1 and 1.5 times 10^−`digits`.
pub fn triple(digits: i32) -> Case {
    let d = 10.0_f64.powi(-digits);
    let roots = [CENTRE, CENTRE + d, CENTRE + 2.5 * d];
    let name = format!("three roots 1e-{digits} apart");
    // If a cluster is not resolved, the crossing that is found lies anywhere in it.
    let tolerance = if digits < 5 { 4e-15 } else { 1e-12 };
    case(name, &[roots[0], roots[2]], &[roots[1]], tolerance, move |s| -product(&roots, s))
}

/// The place of most roots. It is not the end of a step.
const CENTRE: f64 = 0.4375 + 1.0 / 3000.0;

/// The planted cases.
pub fn cases() -> Vec<Case> {
    let mut cases = vec![
        case("simple root", &[0.37], &[], 4e-15, |s| 0.37 - s),
        case("steep among slow: exp(−30 s) − 1/2", &[2.0_f64.ln() / 30.0], &[], 4e-15, |s| {
            (-30.0 * s).exp() - 0.5
        }),
    ];
    let c = CENTRE;
    for digits in [6, 8, 10, 12, 14] {
        let m = 10.0_f64.powi(-digits);
        let r = m.sqrt();
        cases.push(case(format!("minimum +1e-{digits}"), &[], &[], 4e-15, move |s| {
            (s - c) * (s - c) + m
        }));
        cases.push(case(format!("minimum −1e-{digits}"), &[c - r], &[c + r], 4e-15, move |s| {
            (s - c) * (s - c) - m
        }));
        cases.push(case(format!("maximum −1e-{digits}"), &[], &[], 4e-15, move |s| {
            -(s - c) * (s - c) - m
        }));
        cases.push(case(format!("maximum +1e-{digits}"), &[c + r], &[c - r], 4e-15, move |s| {
            m - (s - c) * (s - c)
        }));
    }
    cases.push(case("double root, minimum", &[], &[], 4e-15, move |s| (s - c) * (s - c)));
    cases.push(case("double root, maximum", &[], &[], 4e-15, move |s| -(s - c) * (s - c)));
    // This guard is flat: it is below 1e-39 within 6e-14 of the root.
    cases.push(case("triple root", &[c], &[], 2e-13, move |s| -(s - c) * (s - c) * (s - c)));
    for digits in 1..=13 {
        let d = 10.0_f64.powi(-digits);
        cases.push(case(format!("pair 1e-{digits} apart"), &[c], &[c + d], 4e-15, move |s| {
            (s - c) * (s - (c + d))
        }));
    }
    for digits in [1, 2, 3, 4] {
        cases.push(triple(digits));
    }
    let seven: [f64; 7] = [0.11, 0.23, 0.35, 0.47, 0.59, 0.71, 0.83];
    cases.push(case(
        "seven roots",
        &[0.11, 0.35, 0.59, 0.83],
        &[0.23, 0.47, 0.71],
        4e-15,
        move |s| -product(&seven, s),
    ));
    let ends = [0.25, 0.5, 0.75];
    cases.push(case("roots on the ends of steps", &[0.25, 0.75], &[0.5], 4e-15, move |s| {
        -product(&ends, s)
    }));
    cases.push(case("touch on the end of a step", &[], &[], 4e-15, |s| (s - 0.5) * (s - 0.5)));
    let zeros: Vec<f64> =
        (1..=6).map(|k| (f64::from(k) * std::f64::consts::PI - 1.0) / 20.0).collect();
    let (falling, rising): (Vec<_>, Vec<_>) = (
        zeros.iter().copied().step_by(2).collect(),
        zeros.iter().copied().skip(1).step_by(2).collect(),
    );
    cases.push(case("sin(20 s + 1)", &falling, &rising, 1e-12, |s| (20.0 * s + 1.0).sin()));
    cases
}

/// Runs a case in all directions with one method and step size.
fn score_one<M: Method>(method: M, case: &Case, options: &Options, score: &mut Score) {
    let mut either: Vec<f64> = case.falling.iter().chain(&case.rising).copied().collect();
    either.sort_by(f64::total_cmp);
    for (direction, planted) in [
        (Direction::Falling, &case.falling),
        (Direction::Rising, &case.rising),
        (Direction::Either, &either),
    ] {
        let times = times(method, &case.value, direction, options).expect(&case.name);
        score.add(planted, &times.switches, case.tolerance);
    }
}

pub fn score(case: &Case) -> Score {
    let mut score = Score::default();
    for options in step_sizes() {
        score_one(Dopri5, case, &options, &mut score);
        score_one(Dop853, case, &options, &mut score);
    }
    score
}

#[test]
fn planted_crossings_are_all_found_and_none_invented() {
    for case in cases() {
        let score = score(&case);
        let count = step_sizes().len() * 2 * 2 * (case.falling.len() + case.rising.len());
        assert_eq!(score.planted, count, "{}", case.name);
        assert_eq!((score.missed, score.invented), (0, 0), "{}: {score:?}", case.name);
    }
}

#[test]
fn clusters_below_the_rounding_of_a_step_keep_their_parity() {
    // Between three roots at distance d the guard stays below 0.7 d³. If that is below 64 units in
    // the last place of its largest value on the step, only the signs before and after the roots
    // can be told, and the three roots count as one.
    for digits in [5, 7, 9, 11, 13] {
        let case = triple(digits);
        let (mut merged, mut resolved) = (0, 0);
        for options in step_sizes() {
            for falls in [
                times(Dopri5, &case.value, Direction::Falling, &options),
                times(Dop853, &case.value, Direction::Falling, &options),
            ] {
                let falls = falls.expect("a polynomial").switches;
                match falls.len() {
                    1 => merged += 1,
                    2 => resolved += 1,
                    _ => panic!("{}, {options:?}: {falls:?}", case.name),
                }
                for s in falls {
                    let nearest = case.falling.iter().map(|root| (s - root).abs());
                    let error = nearest.fold(f64::INFINITY, f64::min);
                    assert!(error < 1e-12, "{error:e}");
                }
            }
        }
        // With smaller steps, smaller clusters are resolved.
        assert_eq!(merged == 0, digits == 5, "1e-{digits}: {merged} merged, {resolved} resolved");
    }
}

/// The result for a dip of half width `width` to −1, in a guard that is 1 elsewhere, in steps of
/// `h`.
pub fn dip(width: f64, h: f64) -> Score {
    let half = width * 2.0_f64.ln().sqrt();
    let mut score = Score::default();
    for k in 0..40 {
        let centre = 0.3 + 0.01 * f64::from(k);
        let value = |s: f64| 1.0 - 2.0 * (-((s - centre) / width).powi(2)).exp();
        let planted = [centre - half, centre + half];
        for found in [
            times(Dopri5, value, Direction::Either, &fixed(h)),
            times(Dop853, value, Direction::Either, &fixed(h)),
        ] {
            score.add(&planted, &found.expect("a smooth guard").switches, 1e-13);
        }
    }
    score
}

#[test]
fn a_dip_is_found_unless_it_is_narrow_against_the_step() {
    // A guard that is not a polynomial of the state can hide between the six values of the first
    // look, whatever is done with them. A bound on the step size excludes that. All dips are found
    // if the half width is at least a tenth of the step, and three fifths at a twentieth. None is
    // invented.
    for (width, h) in [(0.3, 1.0), (0.1, 1.0), (0.03, 0.1), (0.01, 0.1), (3e-3, 0.01), (1e-3, 0.01)]
    {
        let score = dip(width, h);
        assert_eq!((score.found, score.invented), (score.planted, 0), "{width} in steps of {h}");
    }
    assert_eq!(dip(0.05, 1.0).invented, 0);
}
