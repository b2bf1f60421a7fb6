//! Atlases of the collision: every boundary traced, the plane subdivided, and both held against
//! collisions, references and closed forms.
//!
//! `cargo run --release -p validation --example atlas_against_engines` does the same with more
//! points, also up to κ = 1000.

use std::sync::LazyLock;

use rayon::prelude::*;
use stickslip::model::{Collider, exact};
use stickslip::plane::{CollisionEvent, CollisionFamily, CollisionLabel, CollisionPlane};
use stickslip::solver::margin::{Margin, Place};
use stickslip::tracer::{
    Node, Point, TraceOptions,
    regions::{Location, Subdivision, VerifyOptions, verify_with},
    tracing::Tracer,
};

type Atlas = Subdivision<CollisionLabel, Margin>;

const KAPPA: (f64, f64) = (0.05, 100.0);
const PSI: (f64, f64) = (0.01, 3.0);

/// Without damping, to 2e-13 at the nodes and 2e-12 between them.
static ATLAS: LazyLock<Atlas> = LazyLock::new(|| {
    let options = TraceOptions {
        tolerance: 2e-13,
        interpolation: 2e-12,
        noise: 2e-14,
        ..TraceOptions::default()
    };
    atlas(&undamped(), &options)
});

fn undamped() -> CollisionPlane {
    CollisionPlane::new(KAPPA, PSI, 0.0).expect("collisions")
}

fn atlas(plane: &CollisionPlane, options: &TraceOptions) -> Atlas {
    traced(&plane.family(), plane, options)
}

/// An atlas in which nothing is unresolved or inconsistent.
fn traced(family: &CollisionFamily, plane: &CollisionPlane, options: &TraceOptions) -> Atlas {
    let mut tracer = Tracer::new(family, &plane.window(), options).expect("options in range");
    tracer.explore().expect("an atlas");
    let network = tracer.network();
    assert!(network.unresolved.is_empty(), "{:?}", network.unresolved);
    let atlas = Subdivision::new(network.window, network.curves, network.vertices, 1e-9)
        .expect("a subdivision");
    assert!(atlas.findings().is_empty(), "{:?}", atlas.findings());
    atlas
}

/// The switches of a collision, by integration, and without damping also by the exact solution.
fn label(plane: &CollisionPlane, point: &Point) -> Result<CollisionLabel, String> {
    let contact = plane.contact(point).expect("in the window");
    let integrated = Collider::default().collide(contact).map_err(|error| error.to_string())?;
    if contact.damping() == 0.0 {
        let exact = exact::collide(contact).map_err(|error| error.to_string())?;
        assert_eq!(exact.itinerary(), integrated.itinerary(), "{contact:?}");
    }
    Ok(CollisionEvent::label(&integrated))
}

/// Random points, half of them uniform in κ, half in ln κ, and points beside every boundary: all
/// have the switches of their regions.
fn assert_right(plane: &CollisionPlane, atlas: &Atlas, kappa: (f64, f64), psi: (f64, f64)) {
    const COUNT: usize = 20_000;
    let mut random = fastrand::Rng::with_seed(1);
    let points: Vec<Point> = (0..COUNT)
        .map(|index| {
            let part = random.f64();
            let kappa = if index.is_multiple_of(2) {
                kappa.0 + part * (kappa.1 - kappa.0)
            } else {
                kappa.0 * (kappa.1 / kappa.0).powf(part)
            };
            plane.point(kappa, psi.0 + random.f64() * (psi.1 - psi.0))
        })
        .collect();
    let decided: usize = points
        .par_iter()
        .map(|point| {
            let Location::Region(region) = atlas.locate(point) else { return 0 };
            let expected = atlas.regions()[region].label.clone().ok_or("no label".to_owned());
            assert_eq!(expected, label(plane, point), "{:?}", plane.parameters(point));
            1
        })
        .sum();
    assert!(decided > COUNT - 10, "{decided}");
    let near_points = 4_000_usize.div_ceil(2 * atlas.curves().len());
    let options = VerifyOptions { random_points: 0, near_points, seed: 3, ..Default::default() };
    let labels = |points: &[Point]| points.par_iter().map(|point| label(plane, point)).collect();
    let verification = verify_with(atlas, &options, labels).expect("distances in order");
    assert!(verification.agrees(), "{:?}", verification.mismatches);
    assert!(verification.tried.iter().sum::<usize>() > 3_800);
}

#[test]
fn the_subdivision_is_that_of_collisions() {
    assert_eq!(ATLAS.regions().len(), 33);
    assert_right(&undamped(), &ATLAS, KAPPA, PSI);
}

#[test]
fn both_engines_trace_the_same_window() {
    let plane = CollisionPlane::new((4.0, 6.0), (0.5, 1.0), 0.0).expect("collisions");
    assert_engines_agree(&plane, &atlas(&plane, &TraceOptions::default()));
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn both_engines_trace_the_same_atlas() {
    assert_engines_agree(&undamped(), &ATLAS);
}

/// Margins of the exact solution and of the integrator, which share nothing, lead to the same
/// vertices and curves; these have all nodes in common to 1e-9.
fn assert_engines_agree(plane: &CollisionPlane, exact: &Atlas) {
    let integrated = traced(&plane.integrated(), plane, &TraceOptions::default());
    let mut largest = 0.0_f64;
    for vertex in integrated.vertices() {
        let distances = exact.vertices().iter().filter(|other| other.kind == vertex.kind);
        let nearest = distances.map(|other| (other.point - vertex.point).norm());
        largest = largest.max(nearest.fold(f64::INFINITY, f64::min));
    }
    println!("vertices within {largest:.1e}");
    assert_eq!(integrated.vertices().len(), exact.vertices().len());
    assert!(largest < 1e-7);
    let curves = |atlas: &Atlas| {
        let kind = |place: &Place| *place == Place::End;
        let curves = atlas.curves().iter().map(|curve| {
            let mut sides = curve.sides.clone();
            sides.sort();
            (curve.margin.exits.len(), kind(&curve.margin.place), sides)
        });
        let mut curves: Vec<_> = curves.collect();
        curves.sort();
        curves
    };
    assert_eq!(curves(&integrated), curves(exact));
    // Ends are vertices.
    let between = integrated.curves().iter().flat_map(|c| &c.nodes[1..c.nodes.len() - 1]);
    for Node { point, .. } in between {
        let place = exact.locate(point);
        assert!(matches!(place, Location::OnBoundary { .. }), "{point:?}: {place:?}");
    }
}

#[test]
fn soft_springs_too() {
    let (kappa, psi) = ((0.001, 0.1), (0.01, 1100.0));
    let plane = CollisionPlane::new(kappa, psi, 0.0).expect("collisions");
    let atlas = atlas(&plane, &TraceOptions::default());
    assert_right(&plane, &atlas, kappa, psi);
}

fn assert_right_with_damping(damping: f64, regions: usize) {
    let plane = CollisionPlane::new(KAPPA, PSI, damping).expect("collisions");
    let atlas = atlas(&plane, &TraceOptions::default());
    assert_eq!(atlas.regions().len(), regions);
    assert_right(&plane, &atlas, KAPPA, PSI);
}

#[test]
fn with_little_damping_the_subdivision_is_that_of_free_runs() {
    assert_right_with_damping(0.01, 42);
}

#[test]
fn with_damping_the_subdivision_is_that_of_free_runs() {
    assert_right_with_damping(0.1, 50);
}

#[test]
fn with_strong_damping_the_subdivision_is_that_of_free_runs() {
    assert_right_with_damping(1.0, 45);
}

/// Where a stick phase shrinks to nothing at the end of contact, however short it and the slip
/// after it are.
#[test]
fn with_damping_every_collision_ends_in_slip() {
    let vertex = Point::new(2.1516695600135187, 0.011366168842137161);
    let plane = CollisionPlane::new(KAPPA, PSI, 0.01).expect("collisions");
    let mut counts = [0; 2];
    for step in [1e-9, 1e-10, 1e-11, 1e-12, 1e-13] {
        for i in -50..=50 {
            let fired = label(&plane, &(vertex + Point::new(0.0, step * f64::from(i))))
                .expect("a collision");
            assert!([1, 3].contains(&fired.len()), "{fired:?} {i} × {step}");
            counts[fired.len() / 2] += 1;
        }
    }
    assert!(counts[0] > 50 && counts[1] > 50, "{counts:?}");
}

#[test]
fn reference_boundaries_lie_on_traced_curves() {
    let plane = &*ATLAS;
    let mut largest = 0.0_f64;
    let mut count = 0;
    for boundary in crate::common::file("boundaries")["boundaries"].as_array().expect("boundaries")
    {
        let (kappa, psi) =
            (crate::common::number(&boundary["kappa"]), crate::common::number(&boundary["psi"]));
        let point = undamped().point(kappa, psi);
        if !plane.window().contains(&point) {
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
            place => panic!("{place:?}"),
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
    assert!(count == 26 && largest < 4e-12);
}

#[test]
fn vertices_are_where_they_must_be() {
    // The corner of the top boundary, where ψ_g passes 2, and the cusp, where the stationary points
    // of the guard merge.
    let known = [(0.5701023788418932873, 2.0, 1e-10), (1.568459328886909846, 1.0, 1e-14)];
    for (kappa, psi, accuracy) in known {
        let place = undamped().point(kappa, psi);
        let nearest = ATLAS.vertices().iter().map(|vertex| (vertex.point - place).norm());
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        println!("vertex at κ = {kappa}, ψ = {psi}: {nearest:.1e} off");
        assert!(nearest < accuracy);
    }
}

/// At small ψ boundaries cross at κ_n, with a distance that falls with ψ.
#[test]
fn boundaries_run_into_the_limits_of_small_impacts() {
    let mut last = f64::INFINITY;
    for low in [1e-2, 1e-3, 1e-4] {
        let plane = CollisionPlane::new((0.1, 25.0), (low, 0.05), 0.0).expect("collisions");
        let atlas = atlas(&plane, &TraceOptions::default());
        let bottom = atlas.window().low.y;
        let mut kappas: Vec<f64> = atlas
            .vertices()
            .iter()
            .filter(|vertex| (vertex.point.y - bottom).abs() < 1e-12)
            .map(|vertex| plane.parameters(&vertex.point)[0])
            .collect();
        kappas.sort_by(f64::total_cmp);
        // κ_10 is 23.8, κ_11 28.8.
        assert_eq!(kappas.len(), 10, "{kappas:?}");
        let distance =
            (1..).zip(&kappas).map(|(n, kappa)| kappa / exact::small_impact_boundary(n) - 1.0);
        let largest = distance.fold(0.0_f64, |most, distance| most.max(distance.abs()));
        println!("ψ = {low:e}: within {largest:.1e} of κ_n");
        assert!(largest < 0.3 * last);
        last = largest;
    }
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
            let [kappa, psi] = undamped().parameters(&node.point);
            if (ATLAS.window().high.y - node.point.y).abs() > 1e-9 {
                largest = largest.max((psi - exact::top_boundary(kappa)).abs());
                nodes += 1;
            }
        }
    }
    println!("{nodes} nodes, largest distance {largest:.1e}");
    assert!(nodes > 100 && largest < 1e-13);
}
