//! Atlases of contact laws of particle codes, against closed forms.

use std::f64::consts::PI;

use stickslip_model::spheres::{BodyPair, Material, Surface};
use stickslip_model::{ContactEnd, Damping, Law, Normal, presets};
use stickslip_plane::atlas::{self, BoundaryKind, CollisionAtlas, Frame};
use stickslip_plane::{CollisionPlane, Range, progress};
use stickslip_solver::margin::Margin;
use stickslip_tracer::{Family, TraceOptions, trace, tracing::Unresolved};

use crate::windows::{frame, traced};

pub fn with_law(name: &str, damping: f64, window: Frame) -> Frame {
    Frame { law: presets::find(name).unwrap().law, damping, ..window }
}

/// No collision has other switches than its region. The tracer may leave a change open where a
/// boundary that runs straight up meets the edge of the window.
fn agrees_with_collisions(verified: &CollisionAtlas) {
    let report = &verified.report;
    assert!(report.mismatches.is_empty() && report.findings.is_empty(), "{report:?}");
    assert!(report.unresolved.len() <= 1 && report.share_tried > 0.999, "{report:?}");
}

/// Without damping, a linear contact is made of sines: x = sin t, and Q = √κ ψ sin √κ t in stick.
/// It starts in slip above κψ = 1. In the slip that follows, the spring all but sticks at the end
/// where ψ = 2 − 1/κ; below κψ = 1 the spring is at zero at the end where κ is a square.
#[test]
fn a_linear_contact_has_its_closed_forms() {
    let verified = traced(with_law("gran/hooke/history", 0.0, frame((0.7, 3.5), (0.2, 1.9))));
    agrees_with_collisions(&verified);
    let atlas = &verified;
    for kappa in [0.8, 0.9] {
        let found = atlas.boundaries_at(kappa);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0] - 1.0 / kappa).abs() < 1e-9, "{found:?}");
    }
    for kappa in [1.3, 2.0, 3.0] {
        let found = atlas.boundaries_at(kappa);
        let expected = [1.0 / kappa, 2.0 - 1.0 / kappa];
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found.iter().zip(expected).all(|(one, other)| (one - other).abs() < 1e-9));
    }
    let curves = atlas.regions.curves().iter();
    let upright = curves.filter(|curve| curve.margin == BoundaryKind::EndOfContact);
    let upright: Vec<f64> = upright
        .flat_map(|curve| &curve.nodes)
        .map(|node| atlas.plane.parameters(&node.point))
        .filter(|[kappa, psi]| kappa * psi < 0.99)
        .map(|[kappa, _]| kappa)
        .collect();
    assert!(upright.len() > 1 && upright.iter().all(|kappa| (kappa - 1.0).abs() < 1e-8));
    assert_eq!(atlas.itinerary(region(atlas, 0.9, 0.5)), "o+");
    assert_eq!(atlas.itinerary(region(atlas, 1.5, 0.5)), "o-");
    assert_eq!(atlas.itinerary(region(atlas, 2.0, 1.6)), "+");
}

fn region(atlas: &stickslip_plane::atlas::CollisionAtlas, kappa: f64, psi: f64) -> usize {
    atlas.locate([kappa, psi]).region.unwrap()
}

/// With Mindlin's stiffness and force history a contact starts in slip above (2/3)κψ = 1.
#[test]
fn a_force_history_starts_in_slip() {
    let name = "granular/hertz/tsuji/mindlin/force";
    let verified = traced(with_law(name, 0.0, frame((1.0, 2.0), (0.5, 2.0))));
    agrees_with_collisions(&verified);
    for kappa in [1.1, 1.5, 1.9] {
        let found = verified.boundaries_at(kappa);
        let start = found.iter().any(|psi| (psi - 1.5 / kappa).abs() < 1e-9);
        assert!(start, "{kappa}: {found:?}");
    }
}

/// A vertex on a corner or an edge, to rounding, of a window with unequal sides. Runs are
/// integrated, and known less well than those of the exact engine: nothing is wrong, but a region
/// at the corner that is hardly wider than the error of its boundaries may be in doubt.
#[test]
#[ignore = "long; .ci/run --long runs it"]
fn a_vertex_of_another_law_may_lie_on_the_edge() {
    let window =
        frame((10.500000000000018, 10.500102478148793), (0.09522670593196017, 0.09523809523809512));
    let report = traced(with_law("gran/hertz/history", 0.0, window)).report;
    assert!(report.mismatches.is_empty(), "{:?}", report.objection());
    assert!(report.unresolved.is_empty() && report.euler.holds, "{:?}", report.objection());
    let narrow = |finding: &String| finding.contains("is not wider than the tolerance");
    assert!(report.findings.iter().all(narrow), "{:?}", report.findings);
}

/// On the border of slip at impact, runs fail that are not moved by more than rounding.
#[test]
fn a_narrow_window_of_another_law_may_have_runs_that_fail() {
    let window =
        frame((4.499997750000007, 4.500002250000007), (0.2222221111110953, 0.2222223333333175));
    let verified = traced(with_law("gran/hertz/history", 0.0, window));
    assert!(verified.report.agrees, "{:?}", verified.objection());
}

/// Where attraction is limited, damped contacts are divided completely too.
#[test]
#[ignore = "long; .ci/run --long runs it"]
fn a_limited_contact_is_traced_with_damping() {
    let name = "granular/hertz/viscoelastic/linear_history+limit_damping";
    let window = Frame { tangential_damping: 0.5, ..frame((1.0, 8.0), (0.2, 1.5)) };
    let verified = traced(with_law(name, 0.2, window));
    assert!(verified.report.agrees, "{:?}", verified.report);
    assert!(verified.regions.curves().len() > 3);
}

/// κ for which a linear contact that sticks until it attracts has no tangential force there:
/// √κ t = nπ. The normal force vanishes where tan ωt = −aω/(1 − a²/2), with ω² = 1 − a²/4.
fn kappa_without_force(n: f64, damping: f64) -> f64 {
    let omega = (1.0 - 0.25 * damping * damping).sqrt();
    let angle = PI - (damping * omega / (1.0 - 0.5 * damping * damping)).atan();
    (n * PI * omega / angle).powi(2)
}

/// Where the force attracts up to the end of contact, damped contacts are divided completely too:
/// around a crossing of six boundaries, and where an upright boundary is met by others.
#[test]
fn an_attracting_contact_is_traced_with_damping() {
    let window = frame((1.05, 1.2), (0.6, 0.7));
    let verified = traced(with_law("gran/hooke/history", 0.2, window));
    assert!(verified.report.agrees, "{:?}", verified.report);
    let atlas = &verified;
    let tails = atlas.regions.curves().iter();
    let tails = tails.filter(|curve| curve.margin == BoundaryKind::StartOfTail);
    let expected = kappa_without_force(1.0, 0.2);
    let upright = tails.flat_map(|curve| &curve.nodes).filter(|node| {
        let [kappa, _] = atlas.plane.parameters(&node.point);
        (kappa - expected).abs() < 1e-9
    });
    assert!(upright.count() > 3, "{expected}");
}

/// Slip that turns where attraction begins, and a spring that grazes its limit soon after, are
/// 2.6e-5 apart in ψ.
#[test]
fn boundaries_close_together_in_an_attracting_tail_are_told_apart() {
    let window = frame((29.0, 30.0), (1.37, 1.4));
    let verified = traced(with_law("gran/hooke/history", 0.2, window));
    assert!(verified.report.agrees, "{:?}", verified.report);
    let atlas = &verified;
    let found = atlas.boundaries_at(29.99);
    let close = found.windows(2).filter(|pair| (1e-5..5e-5).contains(&(pair[1] - pair[0])));
    assert_eq!(close.count(), 1, "{found:?}");
}

/// Boundaries meet 3.7e-8 beyond the edge κ = 1, where they are hardly apart.
#[test]
fn boundaries_that_meet_just_beyond_the_edge_are_told_apart() {
    let window = Frame { tangential_damping: 0.5, ..frame((1.0, 5.0), (1.9, 2.8)) };
    let verified = traced(with_law("gran/hertz/history", 0.2, window));
    assert!(verified.report.agrees, "{:?}", verified.report);
    let found = verified.boundaries_at(1.0 + 1e-4);
    assert!(found.windows(2).all(|pair| pair[0] < pair[1]) && found.len() >= 4, "{found:?}");
}

/// A graze touches an upright boundary where two others end. Its margin and that of the upright one
/// tell the place of the vertex only to half the digits.
#[test]
#[ignore = "long; .ci/run --long runs it"]
fn a_vertex_with_a_touch_stays_where_the_other_boundaries_meet() {
    let window = Frame { tangential_damping: 0.5, ..frame((1.0, 10.0), (0.1, 3.0)) };
    let verified = traced(with_law("gran/hooke/history", 0.2, window));
    assert!(verified.report.agrees, "{:?}", verified.report);
    let atlas = &verified;
    let vertices = atlas.regions.vertices().iter();
    let parameters = vertices.map(|vertex| atlas.plane.parameters(&vertex.point));
    // As found in the window of κ 4.4 to 4.5 and ψ 0.19 to 0.2.
    let there = parameters.filter(|[kappa, psi]| {
        (kappa - 4.452_416_452_242).abs() < 1e-10 && (psi - 0.193_737_575_742).abs() < 1e-10
    });
    assert_eq!(there.count(), 1);
}

/// A graze just behind greatest compression, where the gap of a rescaled history falls through zero
/// before it: the margin is smooth through its zero.
#[test]
fn a_graze_just_behind_greatest_compression_has_its_margin() {
    let law = Law {
        normal: Normal::Linear,
        damping: Damping::Tsuji,
        rescaled: true,
        end: ContactEnd::Overlap,
        ..Law::PAPER
    };
    let plane = CollisionPlane::new((1.0, 1.1), (1.2, 1.3), 0.3).unwrap();
    let plane = plane.with_law(law, 2.0).unwrap();
    let family = plane.family();
    let run = |psi| family.free_run(&plane.point(1.0422, psi)).unwrap();
    let near = |(_, value): &(Margin, f64)| value.abs() < 1e-9;
    let (which, above) = run(1.234_928).margins.into_iter().find(near).unwrap();
    assert!(above > 0.0, "{above}");
    let beyond = plane.point(1.0422, 1.234_928_35);
    let below = family.margin(&beyond, &which).unwrap().unwrap();
    assert!(-1e-9 < below && below < -1e-10, "{below}");
    assert_ne!(family.label(&beyond).unwrap(), run(1.234_928).label);
}

/// With much damping a Hertzian contact that ends with its overlap only creeps, and takes more
/// steps than a trace can afford. Such contacts have a label of their own, and the rest is traced.
#[test]
fn contacts_that_cannot_be_computed_stop_no_trace() {
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let surface =
        Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 1e-3 };
    let pair = BodyPair::equal_spheres(0.02, &steel, &surface).unwrap();
    let pair = BodyPair { law: presets::find("gran/hertz/history").unwrap().law, ..pair };
    let sides = [Range { low: 1e-4, high: 0.1 }, Range { low: 1e-4, high: 2e-4 }];
    let plane = CollisionPlane::velocities(pair, sides).unwrap();
    let (family, window) = (plane.family(), plane.window());
    let [computed, fails] = [1e-4, 0.1].map(|normal| {
        let label = family.label(&plane.point(normal, 1.5e-4)).unwrap();
        family.free_run(&plane.point(normal, 1.5e-4)).map(|run| (label, run.margins)).unwrap()
    });
    assert!(computed.0.len() > 1 && !computed.1.is_empty());
    assert!(fails.0.len() == 1 && fails.1.is_empty());
    let options = TraceOptions { cells: 4, ..TraceOptions::default() };
    let network = trace(&family, &window, &options).unwrap();
    assert!(!network.curves.is_empty());
    assert!(network.curves.iter().all(|curve| !curve.sides.contains(&fails.0)));
    // Where they begin, the label changes without a margin.
    assert!(!network.unresolved.is_empty());
    for open in &network.unresolved {
        let Unresolved::Change { labels, .. } = open else { panic!("{open:?}") };
        assert!(labels.contains(&fails.0), "{open:?}");
    }
}

/// Up to 20 000 steps, a contact that creeps is traced like others.
#[test]
fn a_contact_that_creeps_is_computed() {
    let plane = CollisionPlane::new((1.0, 2.0), (0.5, 1.0), 8.0).unwrap();
    let plane = plane.with_law(presets::find("gran/hertz/history").unwrap().law, 1.0).unwrap();
    let run = plane.family().free_run(&plane.point(1.5, 0.7)).unwrap();
    assert!(run.label.len() > 1 && !run.margins.is_empty(), "{run:?}");
}

/// A hysteretic force is traced where its kink is no graze, and refused elsewhere.
#[test]
fn hysteretic_forces_are_traced_or_refused() {
    let psi = Range { low: 0.3, high: 1.2 };
    for (normal, kappa) in [(Normal::Linear, (2.0, 2.5)), (Normal::Hertz, (0.8, 1.2))] {
        let law = Law { normal, ..presets::find("walton-braun").unwrap().law };
        let frame = |(low, high)| Frame { law, ..Frame::new(Range { low, high }, psi, 0.4) };
        let tolerance = frame(kappa).tolerances().usual;
        let atlas = atlas::trace(frame(kappa), tolerance, progress::SILENT).unwrap();
        assert!(atlas.report.agrees && atlas.regions.regions().len() > 1, "{normal:?}");
        for kappa in [(1.2, 1.6), (1.3, 5.0), (0.5, 1.7)] {
            let error = atlas::trace(frame(kappa), tolerance, progress::SILENT).unwrap_err();
            assert!(error.to_string().contains("which is not traced"), "{error}");
        }
    }
}
