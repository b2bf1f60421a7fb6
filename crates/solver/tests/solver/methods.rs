//! Order conditions of both pairs by rooted trees, and orders observed in steps.
//!
//! Butcher's theorem: a Runge–Kutta method with weights b has order p exactly if Σ bᵢ Φᵢ(t) =
//! 1/γ(t) for every rooted tree t of at most p vertices (Hairer, Nørsett and Wanner, *Solving
//! Ordinary Differential Equations I*, 2nd ed., section II.2). The tests generate the trees. They
//! get the weights of the dense output from a step whose derivatives are unit vectors.

use std::cell::Cell;

use stickslip_solver::method::{Dense, Step, Trial};
use stickslip_solver::method::{INTERIOR_NODES, MAX_STAGES};
use stickslip_solver::{Dop853, Dopri5, Method, Observer, Options, State, StepSize};

use crate::erased::integrate;

/// A rooted tree: its number of vertices, its density γ, and the indices of the trees that hang on
/// its root.
struct Tree {
    order: usize,
    density: f64,
    branches: Vec<usize>,
}

/// All rooted trees of at most `most` vertices, with smaller ones first.
#[allow(clippy::cast_precision_loss)]
fn rooted_trees(most: usize) -> Vec<Tree> {
    let mut trees: Vec<Tree> = Vec::new();
    for order in 1..=most {
        let mut forests = Vec::new();
        collect_forests(&trees, order - 1, trees.len(), &mut Vec::new(), &mut forests);
        for branches in forests {
            let product: f64 =
                branches.iter().map(|&branch: &usize| trees[branch].density).product();
            trees.push(Tree { order, density: order as f64 * product, branches });
        }
    }
    trees
}

/// All multisets of trees with `vertices` vertices in total. The indices of a multiset do not rise,
/// and are below `limit`.
fn collect_forests(
    trees: &[Tree],
    vertices: usize,
    limit: usize,
    chosen: &mut Vec<usize>,
    forests: &mut Vec<Vec<usize>>,
) {
    if vertices == 0 {
        forests.push(chosen.clone());
        return;
    }
    for index in (0..limit).rev() {
        if trees[index].order <= vertices {
            chosen.push(index);
            collect_forests(trees, vertices - trees[index].order, index + 1, chosen, forests);
            chosen.pop();
        }
    }
}

type Row = [f64; MAX_STAGES];

fn dot(weights: &Row, stages: &Row) -> f64 {
    weights.iter().zip(stages).map(|(weight, stage)| weight * stage).sum()
}

/// Φᵢ(t) for every stage i of a method and every tree t.
fn stage_weights<M: Method>(trees: &[Tree]) -> Vec<Row> {
    let mut weights: Vec<Row> = Vec::new();
    for tree in trees {
        let mut row = [1.0; MAX_STAGES];
        for &branch in &tree.branches {
            for (stage, value) in row.iter_mut().enumerate() {
                *value *= dot(&M::TABLEAU.a[stage], &weights[branch]);
            }
        }
        row[M::DENSE_STAGES..].fill(0.0);
        weights.push(row);
    }
    weights
}

/// The largest |Σ wᵢ Φᵢ(t) − θ^ρ/γ(t)| over the trees of exactly `order` vertices.
#[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap)]
fn defect(trees: &[Tree], stages: &[Row], weights: &Row, order: usize, theta: f64) -> f64 {
    trees
        .iter()
        .zip(stages)
        .filter(|(tree, _)| tree.order == order)
        .map(|(tree, row)| (dot(weights, row) - theta.powi(order as i32) / tree.density).abs())
        .fold(0.0, f64::max)
}

/// The largest |Σ wᵢ Φᵢ(t)| over the trees of exactly `order` vertices, for differences of weights.
fn remainder(trees: &[Tree], stages: &[Row], weights: &Row, order: usize) -> f64 {
    defect(trees, stages, weights, order, 0.0)
}

/// A step whose k-th derivative is the k-th unit vector, so that states are rows of weights.
fn weights_of_dense<M: Method>() -> (Step<MAX_STAGES>, Dense<MAX_STAGES>) {
    let unit = |k: usize| State::<MAX_STAGES>::from_fn(|i, _| if i == k { 1.0 } else { 0.0 });
    let next = Cell::new(0);
    let mut field = |_s: f64, _y: &State<MAX_STAGES>| {
        next.set(next.get() + 1);
        unit(next.get())
    };
    let mut step = Step::blank();
    let (y, slope) = (State::zeros(), unit(0));
    let (rest, tolerances) = (Trial::NO_REST, (1.0, 1.0));
    let trial = Trial { s: 0.0, y: &y, rest, slope: &slope, h: 1.0, tolerances };
    step.take::<M>(&mut field, &trial);
    // The dense output takes the stages again.
    next.set(0);
    let dense = step.dense::<M>(&mut field);
    (step, dense)
}

fn row(state: &State<MAX_STAGES>) -> Row {
    std::array::from_fn(|i| state[i])
}

#[test]
fn the_trees_are_all_there() {
    let trees = rooted_trees(9);
    // The numbers of rooted trees are OEIS A000081. The densities of order 4 are in Hairer, Nørsett
    // and Wanner, table II.2.1.
    let counts: Vec<usize> =
        (1..=9).map(|order| trees.iter().filter(|tree| tree.order == order).count()).collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115, 286]);
    let mut densities: Vec<f64> =
        trees.iter().filter(|t| t.order == 4).map(|t| t.density).collect();
    densities.sort_by(f64::total_cmp);
    assert_eq!(densities, [4.0, 8.0, 12.0, 24.0]);
}

#[test]
fn nodes_are_row_sums() {
    fn check<M: Method>() {
        for stage in 0..M::DENSE_STAGES {
            let sum: f64 = M::TABLEAU.a[stage].iter().sum();
            // Measured: 2e-15, for 8(5,3) with weights up to 43.
            assert!((sum - M::TABLEAU.c[stage]).abs() < 1e-14, "{} row {stage}", M::NAME);
        }
        assert_eq!(M::TABLEAU.a[M::STAGES], M::TABLEAU.b, "{}: last row", M::NAME);
    }
    check::<Dopri5>();
    check::<Dop853>();
}

#[test]
fn propagated_solutions_have_their_order_and_no_more() {
    fn check<M: Method>() {
        let trees = rooted_trees(M::ORDER + 1);
        let stages = stage_weights::<M>(&trees);
        for order in 1..=M::ORDER {
            let worst = defect(&trees, &stages, &M::TABLEAU.b, order, 1.0);
            println!("{} order {order}: {worst:.1e}", M::NAME);
            assert!(worst < 1e-13, "{} order {order}: {worst:e}", M::NAME);
        }
        let beyond = defect(&trees, &stages, &M::TABLEAU.b, M::ORDER + 1, 1.0);
        println!("{} order {}: {beyond:.1e}", M::NAME, M::ORDER + 1);
        assert!(beyond > 1e-5, "{} would be of order {}", M::NAME, M::ORDER + 1);
    }
    check::<Dopri5>();
    check::<Dop853>();
}

#[test]
fn error_estimates_have_their_orders_and_no_more() {
    fn check<M: Method>(name: &str, weights: &Row, order: usize) {
        let trees = rooted_trees(order + 1);
        let stages = stage_weights::<M>(&trees);
        for below in 1..=order {
            let worst = remainder(&trees, &stages, weights, below);
            println!("{} {name} order {below}: {worst:.1e}", M::NAME);
            assert!(worst < 1e-13, "{} {name} order {below}: {worst:e}", M::NAME);
        }
        let leading = remainder(&trees, &stages, weights, order + 1);
        println!("{} {name} order {}: {leading:.1e}", M::NAME, order + 1);
        assert!(leading > 1e-4, "{} {name} would miss order {}", M::NAME, order + 1);
    }
    check::<Dopri5>("error", &Dopri5::TABLEAU.error, 4);
    check::<Dop853>("error", &Dop853::TABLEAU.error, 5);
    check::<Dop853>("coarse error", &Dop853::TABLEAU.coarse_error, 3);
    assert!(Dopri5::TABLEAU.coarse_error.iter().all(|&weight| weight == 0.0));
}

#[test]
fn a_step_on_unit_vectors_returns_the_tableau() {
    fn check<M: Method>() {
        let (step, dense) = weights_of_dense::<M>();
        assert_eq!(row(&step.y1), M::TABLEAU.b, "{}", M::NAME);
        assert_eq!(row(&dense.at(0.0)), [0.0; MAX_STAGES]);
        for (at_end, b) in row(&dense.at(1.0)).iter().zip(M::TABLEAU.b) {
            assert!((at_end - b).abs() < 1e-15, "{}: dense output at 1", M::NAME);
        }
    }
    check::<Dopri5>();
    check::<Dop853>();
}

#[test]
fn dense_outputs_have_their_order_and_no_more() {
    fn check<M: Method>(order: usize) {
        let trees = rooted_trees(order + 1);
        let stages = stage_weights::<M>(&trees);
        let (_, dense) = weights_of_dense::<M>();
        for theta in [0.0, 0.05, 0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9, 0.99, 1.0] {
            let weights = row(&dense.at(theta));
            for below in 1..=order {
                let worst = defect(&trees, &stages, &weights, below, theta);
                println!("{} θ = {theta}, order {below}: {worst:.1e}", M::NAME);
                assert!(worst < 1e-13, "{} θ = {theta} order {below}: {worst:e}", M::NAME);
            }
        }
        let halfway = row(&dense.at(0.4));
        let beyond = defect(&trees, &stages, &halfway, order + 1, 0.4);
        println!("{} θ = 0.4, order {}: {beyond:.1e}", M::NAME, order + 1);
        assert!(beyond > 1e-6, "{}: dense output of order {}", M::NAME, order + 1);
    }
    check::<Dopri5>(4);
    check::<Dop853>(7);
}

#[test]
fn dense_outputs_have_the_derivatives_of_the_ends() {
    fn check<M: Method>() {
        let (_, dense) = weights_of_dense::<M>();
        // Central differences are exact for quadratics. The cubic part is below 1e-9 at this
        // distance.
        let d = 1e-5;
        for (theta, stage) in [(0.0, 0), (1.0, M::STAGES)] {
            let slope = (dense.at(theta + d) - dense.at(theta - d)) / (2.0 * d);
            for (i, value) in slope.iter().enumerate() {
                let expected = if i == stage { 1.0 } else { 0.0 };
                assert!((value - expected).abs() < 2e-7, "{} θ = {theta} stage {i}", M::NAME);
            }
        }
    }
    check::<Dopri5>();
    check::<Dop853>();
}

#[test]
fn the_states_inside_a_step_have_their_orders() {
    // The quick look at guards uses these states: stages of 8(5,3), or the dense output of 5(4).
    // Both are of order 4, which means that their errors are of fifth order in the step size.
    fn check<M: Method>(order: usize) {
        let trees = rooted_trees(order + 1);
        let stages = stage_weights::<M>(&trees);
        let (step, _) = weights_of_dense::<M>();
        let mut beyond = 0.0_f64;
        for (state, theta) in step.interior.iter().zip(INTERIOR_NODES) {
            let weights = row(state);
            for below in 1..=order {
                let worst = defect(&trees, &stages, &weights, below, theta);
                println!("{} interior {theta:.3}, order {below}: {worst:.1e}", M::NAME);
                assert!(worst < 1e-13, "{} θ = {theta} order {below}: {worst:e}", M::NAME);
            }
            beyond = beyond.max(defect(&trees, &stages, &weights, order + 1, theta));
        }
        println!("{} interior order {}: {beyond:.1e}", M::NAME, order + 1);
        assert!(beyond > 1e-6, "{}: interior states of order {}", M::NAME, order + 1);
    }
    check::<Dopri5>(4);
    check::<Dop853>(4);
}

/// The eccentricity of Kepler's ellipse, which starts at the pericentre. It is small, so that order
/// 8 shows well above rounding.
const ECCENTRICITY: f64 = 0.02;

fn kepler(_s: f64, y: &State<4>) -> State<4> {
    let cube = (y[0] * y[0] + y[1] * y[1]).powf(1.5);
    State::from([y[2], y[3], -y[0] / cube, -y[1] / cube])
}

/// The exact state at `s`, by Kepler's equation.
fn on_ellipse(s: f64) -> State<4> {
    let e = ECCENTRICITY;
    let mut anomaly = s;
    for _ in 0..50 {
        anomaly -= (anomaly - e * anomaly.sin() - s) / (1.0 - e * anomaly.cos());
    }
    let (sin, cos) = anomaly.sin_cos();
    let (width, rate) = ((1.0 - e * e).sqrt(), 1.0 / (1.0 - e * cos));
    State::from([cos - e, width * sin, -sin * rate, width * cos * rate])
}

/// The largest error of the dense output at four tenths of the steps.
struct InsideSteps(f64);

impl Observer<(), 4> for InsideSteps {
    const WANTS_SEGMENTS: bool = true;

    fn on_segment(&mut self, (): (), dense: &Dense<4>) {
        let theta = 0.4;
        let exact = on_ellipse(dense.start() + theta * dense.size());
        self.0 = self.0.max((dense.at(theta) - exact).norm());
    }
}

/// The errors at the end of the span and inside the steps, with `steps` equal steps.
fn errors<M: Method>(method: M, steps: u32) -> (f64, f64) {
    let end = 20.0;
    let options =
        Options { step_size: StepSize::Fixed(end / f64::from(steps)), ..Options::default() };
    let mut inside = InsideSteps(0.0);
    let run = integrate(method, kepler, 0.0, on_ellipse(0.0), end, &options, &mut inside)
        .expect("a smooth problem");
    ((run.state - on_ellipse(end)).norm(), inside.0)
}

#[test]
fn observed_orders_in_fixed_steps() {
    // Measured: 4.93, 4.97 and 7.83, 7.88 at the end, and the same within 0.01 inside the steps.
    for steps in [800, 1000] {
        let (coarse, fine) = (errors(Dopri5, steps), errors(Dopri5, 2 * steps));
        let (end, inside) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        println!("dopri5 {steps}: {end:.3} {inside:.3}, errors {:.1e} {:.1e}", fine.0, fine.1);
        assert!((end - 5.0).abs() < 0.1 && (inside - 5.0).abs() < 0.1);
    }
    for steps in [80, 100] {
        let (coarse, fine) = (errors(Dop853, steps), errors(Dop853, 2 * steps));
        let (end, inside) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        println!("dop853 {steps}: {end:.3} {inside:.3}, errors {:.1e} {:.1e}", fine.0, fine.1);
        assert!((end - 8.0).abs() < 0.2 && (inside - 8.0).abs() < 0.2);
    }
}

#[test]
fn a_single_step_has_one_order_more_than_the_method() {
    /// The errors of one step from the exact state at 1: at its end, and at four tenths by the
    /// dense output.
    fn single<M: Method>(h: f64) -> (f64, f64) {
        let y0 = on_ellipse(1.0);
        let mut step = Step::blank();
        let mut field = kepler;
        let slope = kepler(1.0, &y0);
        let (rest, tolerances) = (Trial::NO_REST, (1.0, 1.0));
        let trial = Trial { s: 1.0, y: &y0, rest, slope: &slope, h, tolerances };
        step.take::<M>(&mut field, &trial);
        let inside = step.dense::<M>(&mut field).at(0.4) - on_ellipse(1.0 + 0.4 * h);
        ((step.y1 - on_ellipse(1.0 + h)).norm(), inside.norm())
    }
    fn check<M: Method>(h: f64, at_end: f64, inside: f64) {
        let (coarse, fine) = (single::<M>(h), single::<M>(0.5 * h));
        let orders = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        println!("{}: {orders:?}, errors {fine:?}", M::NAME);
        assert!((orders.0 - at_end).abs() < 0.3, "{}: {orders:?}", M::NAME);
        assert!((orders.1 - inside).abs() < 0.3, "{}: {orders:?}", M::NAME);
    }
    check::<Dopri5>(0.1, 6.0, 5.0);
    check::<Dop853>(0.3, 9.0, 8.0);
}
