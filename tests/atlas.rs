//! The atlas of the undamped collision, κ from 0.05 to 100, ψ from 0.01 to 3: every boundary traced, the plane subdivided.
//!
//! Traced in x = ln κ and y = ln(1 + ψ).

#[expect(dead_code, reason = "shared with other tests")]
mod common;

use std::sync::LazyLock;

use stickslip::model::regularized::{OTHER_SIDE, Phase, Regularized, SAME_SIDE, STATE};
use stickslip::model::{Contact, Side, exact};
use stickslip::solver::{Dop853, Margin, Options, Place, Start};
use stickslip::tracer::{
    HybridFamily, Location, Point, Problem, Subdivision, TraceOptions, Window, trace,
};

struct Collisions;

impl Collisions {
    fn contact(point: &Point) -> Contact {
        // Tracing asks for points a little outside the window.
        let psi = point.y.exp_m1().max(1e-9);
        Contact::new(point.x.exp(), psi, 0.0).expect("in the window")
    }

    fn family(self) -> HybridFamily<Self, Dop853, STATE, 3> {
        let options = Options {
            rtol: 1e-14,
            atol: 1e-14,
            first_step: Some(0.1),
            max_step: 0.1,
            ..Options::default()
        };
        HybridFamily { problem: self, method: Dop853, options, end: f64::INFINITY }
    }
}

impl Problem<STATE, 3> for Collisions {
    type System = Regularized;

    fn at(&self, point: &Point) -> (Regularized, Start<Phase, STATE>) {
        let contact = Self::contact(point);
        let system = Regularized::new(contact);
        (system, Start { mode: Phase::first(&contact), s: 0.0, state: system.start() })
    }
}

fn window() -> Window {
    let at = |kappa: f64, psi: f64| Point::new(kappa.ln(), psi.ln_1p());
    Window { low: at(0.05, 0.01), high: at(100.0, 3.0) }
}

/// Without damping, to 2e-13 at the nodes and 2e-12 between them.
static ATLAS: LazyLock<Subdivision<Vec<usize>, Margin>> = LazyLock::new(|| {
    let family = Collisions.family();
    let options = TraceOptions {
        tolerance: 2e-13,
        interpolation: 2e-12,
        noise: 2e-14,
        ..TraceOptions::default()
    };
    let network = trace(&family, &window(), &options).expect("an atlas");
    assert!(network.unresolved.is_empty(), "{:?}", network.unresolved);
    Subdivision::new(network.window, network.curves, network.vertices, 1e-9).expect("a subdivision")
});

/// Guards that fire in the collision at `point`, by the exact engine.
fn fired(point: &Point) -> Vec<usize> {
    let collision = exact::collide(Collisions::contact(point)).expect("exact");
    let mut side = Side::Positive;
    let guard = |switch: &stickslip::model::Switch| {
        let same = switch.side == side;
        side = switch.side;
        if same { SAME_SIDE } else { OTHER_SIDE }
    };
    collision.switches.iter().map(guard).collect()
}

#[test]
fn the_subdivision_is_that_of_the_exact_engine() {
    let plane = &*ATLAS;
    assert!(plane.findings().is_empty(), "{:?}", plane.findings());
    assert_eq!(plane.regions().len(), 33);
    let mut random = fastrand::Rng::with_seed(1);
    let mut decided = 0;
    for _ in 0..100_000 {
        let kappa = if random.bool() {
            0.05 + 99.95 * random.f64()
        } else {
            0.05 * 2000_f64.powf(random.f64())
        };
        let psi = 0.01 + 2.99 * random.f64();
        let point = Point::new(kappa.ln(), psi.ln_1p());
        if let Location::Region(region) = plane.locate(&point) {
            decided += 1;
            let label = plane.regions()[region].label.as_ref();
            assert_eq!(label, Some(&fired(&point)), "κ = {kappa}, ψ = {psi}");
        }
    }
    assert!(decided > 99_990, "{decided}");
}

#[test]
fn reference_boundaries_lie_on_traced_curves() {
    let plane = &*ATLAS;
    let mut largest = 0.0_f64;
    let mut count = 0;
    for boundary in common::file("boundaries")["boundaries"].as_array().expect("boundaries") {
        let (kappa, psi) = (common::number(&boundary["kappa"]), common::number(&boundary["psi"]));
        let point = Point::new(kappa.ln(), psi.ln_1p());
        if !window().contains(&point) {
            continue;
        }
        let Location::OnBoundary { curve, .. } = plane.locate(&point) else {
            panic!("κ = {kappa}, ψ = {psi} lies on no boundary")
        };
        let curve = &plane.curves()[curve];
        let kind = match curve.margin.place {
            Place::End => "end-of-contact",
            Place::Minimum { .. } if curve.margin.exits.len().is_multiple_of(2) => "slip-graze",
            Place::Minimum { .. } => "stick-graze",
        };
        assert_eq!(boundary["kind"], kind, "κ = {kappa}, ψ = {psi}");
        let mut counts = curve.sides.clone().map(|label| label.len() as u64);
        counts.sort_unstable();
        let mut expected = [&boundary["below"], &boundary["above"]].map(|n| n.as_u64().unwrap());
        expected.sort_unstable();
        assert_eq!(counts, expected, "κ = {kappa}, ψ = {psi}");
        let distance = plane.vertical_distance(&point).expect("a curve at this κ");
        largest = largest.max(distance * (1.0 + psi));
        count += 1;
    }
    println!("{count} reference points, largest distance in ψ {largest:.1e}");
    assert!(count == 26 && largest < 1e-11);
}

#[test]
fn the_top_boundary_is_the_closed_form() {
    let mut largest = 0.0_f64;
    let mut nodes = 0;
    for curve in ATLAS.curves() {
        // No switch on one side.
        if !curve.sides.iter().any(Vec::is_empty) {
            continue;
        }
        for node in &curve.nodes {
            let (kappa, psi) = (node.point.x.exp(), node.point.y.exp_m1());
            if (window().high.y - node.point.y).abs() > 1e-9 {
                largest = largest.max((psi - top(kappa)).abs());
                nodes += 1;
            }
        }
    }
    println!("{nodes} nodes, largest distance {largest:.1e}");
    assert!(nodes > 100 && largest < 1e-11);
}

/// ψ above which the collision has no switch: max(2, 1 − cos q (1 − B sin^{2/5} q)) where (7/5)Bσ² − σ^{8/5} − (2/5)B = 0
/// for σ = sin q; the larger of both roots in (0, 1) belongs to the minimum of the guard.
fn top(kappa: f64) -> f64 {
    let b = 1.5 / kappa * 1.25_f64.powf(0.2);
    let stationary = |sine: f64| 1.4 * b * sine * sine - sine.powf(1.6) - 0.4 * b;
    if stationary(1.0) <= 0.0 {
        return 2.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while high - low > f64::EPSILON {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if stationary(middle) < 0.0 { low = middle } else { high = middle }
    }
    let cosine = (1.0 - low * low).sqrt();
    let graze = [1.0, -1.0].map(|sign| 1.0 - sign * cosine * (1.0 - b * low.powf(0.4)));
    graze.into_iter().fold(2.0, f64::max)
}
