//! Random circles, cut where they meet each other and the window. Every region must be right.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use stickslip_tracer::{
    Point, Vertex, VertexKind,
    regions::{Location, VerifyOptions, verify_with},
};

use crate::subdivision::planes::{KnownPlane, TOLERANCE, UNIT, circle, even};

/// A circle: x, y and the radius.
type Circle = (f64, f64, f64);

/// The circles that contain a point, one bit for each.
fn truth(circles: &[Circle], point: &Point) -> i32 {
    circles.iter().enumerate().fold(0, |label, (bit, &(x, y, radius))| {
        label | i32::from((point - Point::new(x, y)).norm() < radius) << bit
    })
}

/// The angles on the first circle where it meets the second one.
fn meetings(&(x, y, r): &Circle, &(u, v, s): &Circle) -> Option<[f64; 2]> {
    let (towards, distance) = ((v - y).atan2(u - x), (u - x).hypot(v - y));
    let cosine = (distance * distance + r * r - s * s) / (2.0 * distance * r);
    (cosine.abs() < 1.0).then(|| [towards - cosine.acos(), towards + cosine.acos()])
}

/// The angles on a circle where it meets the sides of the window.
fn exits(&(x, y, r): &Circle) -> Vec<f64> {
    let mut angles = Vec::new();
    for (centre, quarter) in [(x, 0.0), (y, 0.5 * PI)] {
        for side in [0.0, 1.0] {
            let cosine: f64 = (side - centre) / r;
            if cosine.abs() < 1.0 {
                angles.extend([quarter + cosine.acos(), quarter - cosine.acos()]);
            }
        }
    }
    let on = |angle: f64| Point::new(x + r * angle.cos(), y + r * angle.sin());
    angles.retain(|&angle| {
        let place = on(angle) - Point::new(0.5, 0.5);
        place.x.abs().max(place.y.abs()) < 0.5 + 1e-12
    });
    angles
}

/// The arcs of the circles inside the window, between vertices.
fn arrangement(circles: &[Circle]) -> KnownPlane {
    let mut plane = KnownPlane::new(|_| 0);
    for (index, own) in circles.iter().enumerate() {
        let &(x, y, r) = own;
        let place = |angle: f64| Point::new(x + r * angle.cos(), y + r * angle.sin());
        let mut cuts: Vec<(f64, VertexKind)> =
            exits(own).into_iter().map(|angle| (angle, VertexKind::WindowEdge)).collect();
        let others = circles.iter().enumerate().filter(|&(other, _)| other != index);
        cuts.extend(
            others
                .filter_map(|(_, other)| meetings(own, other))
                .flatten()
                .filter(|&angle| UNIT.contains(&place(angle)))
                .map(|angle| (angle, VertexKind::Crossing)),
        );
        for cut in &mut cuts {
            cut.0 = cut.0.rem_euclid(TAU);
        }
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let vertices: Vec<usize> = cuts
            .iter()
            .map(|&(angle, kind)| {
                let point = place(angle);
                let known = plane
                    .vertices
                    .iter()
                    .position(|vertex| (vertex.point - point).norm() < 0.1 * TOLERANCE);
                known.unwrap_or_else(|| {
                    plane.vertices.push(Vertex { point, kind, margins: Vec::new() });
                    plane.vertices.len() - 1
                })
            })
            .collect();
        let arcs = if cuts.is_empty() { 1 } else { cuts.len() };
        for arc in 0..arcs {
            let (from, to, ends) = if cuts.is_empty() {
                (0.0, TAU, None)
            } else {
                let next = (arc + 1) % arcs;
                let turn = if next <= arc { TAU } else { 0.0 };
                (cuts[arc].0, cuts[next].0 + turn, Some([vertices[arc], vertices[next]]))
            };
            let middle = place(0.5 * (from + to));
            if !UNIT.contains(&middle) {
                continue;
            }
            let bit = 1 << index;
            let label = truth(circles, &middle);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let count = 1 + ((to - from) * 25.0) as u32;
            plane = plane.curve(
                circle(x, y, r),
                even(from, to, count),
                [label | bit, label & !bit],
                ends,
            );
        }
    }
    plane
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_circles(circles in prop::collection::vec(
        (-0.2..1.2_f64, -0.2..1.2_f64, 0.02..0.6_f64), 1..12,
    )) {
        let plane = arrangement(&circles);
        let made = plane.subdivision().expect("curves with a meaning");
        prop_assert!(made.findings().is_empty(), "{:?}", made.findings());
        let area: f64 = made.regions().iter().map(|region| region.area).sum();
        prop_assert!((area - 1.0).abs() < 1e-9);
        let options = VerifyOptions { random_points: 2_000, nearest: 1e-9, ..VerifyOptions::default() };
        let verification = verify_with(&made, &options, |points| {
            points.iter().map(|point| Ok::<i32, ()>(truth(&circles, point))).collect()
        }).expect("distances in order");
        prop_assert!(verification.mismatches.is_empty(), "{:?}", verification.mismatches);
        for (index, region) in made.regions().iter().enumerate() {
            prop_assert_eq!(made.locate(&region.sample), Location::Region(index));
        }
    }
}
