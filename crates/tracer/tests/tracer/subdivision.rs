//! Subdivisions with known answers: the number of regions, their areas and labels, and what is
//! wrong with bad input.

mod arrangements;
mod findings;
mod planes;

use std::f64::consts::{FRAC_PI_2, PI};

use self::planes::{
    KnownPlane, close_curves, crossing_circles, cusp, disturbed, edges_and_corner, figure_of_eight,
    grid, islands, short_frame_parts, touching_circles, upright_cusp, vertex_beside_the_frame,
};
use stickslip_tracer::{
    Point,
    regions::{Location, Subdivision, VerifyOptions, verify},
};

/// Asserts that the regions have these labels and areas, to 1e-9, and that labels are right at 1e5
/// random points and beside every curve, down to twice the tolerance.
fn holds(plane: &KnownPlane, areas: &[(i32, f64)]) -> Subdivision<i32, usize> {
    let made = plane.subdivision().expect("curves with a meaning");
    assert!(made.findings().is_empty(), "{:?}", made.findings());
    assert!(made.euler().holds());
    let mut found: Vec<(i32, f64)> = made
        .regions()
        .iter()
        .map(|region| (region.label.expect("a region with a curve"), region.area))
        .collect();
    let mut areas = areas.to_vec();
    for list in [&mut found, &mut areas] {
        list.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    }
    assert_eq!(found.len(), areas.len(), "{found:?}");
    for (found, expected) in found.iter().zip(&areas) {
        assert!(found.0 == expected.0 && (found.1 - expected.1).abs() < 1e-9, "{found:?}");
    }
    for (index, region) in made.regions().iter().enumerate() {
        assert_eq!(made.locate(&region.sample), Location::Region(index));
    }
    let options = VerifyOptions {
        random_points: 100_000,
        near_points: 2_000,
        nearest: 2.0 * planes::TOLERANCE,
        farthest: 1e-3,
        seed: 7,
    };
    let verification = verify(&made, plane, &options).expect("distances in order");
    assert!(verification.mismatches.is_empty(), "{:?}", &verification.mismatches[..1]);
    assert!(verification.agrees() && verification.untried_curves.is_empty());
    assert!((verification.tried_area - 1.0).abs() < 1e-12);
    // Undecided are only places beside one curve that are as close to another curve.
    let near = verification.unverified.len();
    assert!(near * 500 < 4_000 * plane.curves.len(), "{near} places undecided");
    made
}

/// The area that both circles of `crossing_circles` contain.
fn lens() -> f64 {
    let (radius, distance) = (0.25_f64, 0.2_f64);
    let half = distance / 2.0;
    2.0 * radius * radius * (half / radius).acos()
        - half * 2.0 * (radius * radius - half * half).sqrt()
}

#[test]
fn two_crossing_circles() {
    let disc = PI * 0.0625;
    let made = holds(
        &crossing_circles(),
        &[(0, 1.0 - 2.0 * disc + lens()), (1, disc - lens()), (2, disc - lens()), (3, lens())],
    );
    let lens = made.regions().iter().find(|region| region.label == Some(3)).expect("the lens");
    assert!(lens.clearance > 0.13, "half the lens's width is 0.15: {}", lens.clearance);
}

#[test]
fn circles_that_touch() {
    let (large, small) = (PI * 0.0625, PI * 0.01);
    holds(&touching_circles(0.0, true), &[(0, 1.0 - large), (1, large - small), (2, small)]);
    holds(&touching_circles(0.0, false), &[(0, 1.0 - large - small), (1, large), (2, small)]);
}

/// In some of the directions the common tangent of both circles is vertical or horizontal.
#[test]
fn circles_that_touch_in_any_direction() {
    let (large, small) = (PI * 0.0625, PI * 0.01);
    let turned = (0..12).map(|i| 0.3 + f64::from(i));
    for angle in [FRAC_PI_2, PI, -FRAC_PI_2].into_iter().chain(turned) {
        for within in [true, false] {
            let made =
                touching_circles(angle, within).subdivision().expect("curves with a meaning");
            assert!(made.findings().is_empty(), "{angle}: {:?}", made.findings());
            let rest = if within { large - small } else { large };
            let sky = if within { 1.0 - large } else { 1.0 - large - small };
            for (label, area) in [(0, sky), (1, rest), (2, small)] {
                let mut regions =
                    made.regions().iter().filter(|region| region.label == Some(label));
                let region = regions.next().expect("a region of that label");
                assert!((region.area - area).abs() < 1e-9 && regions.next().is_none());
            }
        }
    }
}

#[test]
fn cusps() {
    // ∫ 2x^{3/2} from 0 to 0.5^{2/3}, and the strip of full height to the right of it.
    let end = 0.5_f64.cbrt().powi(2);
    let between = 0.8 * end.powf(2.5) + 0.7 - end;
    holds(&cusp(), &[(0, 1.0 - between), (1, between)]);
    holds(&upright_cusp(), &[(0, 1.0 - between), (1, between)]);
}

#[test]
fn a_figure_of_eight() {
    let lobe = 0.16 * 2.0 / 3.0;
    holds(&figure_of_eight(), &[(0, 1.0 - 2.0 * lobe), (1, lobe), (2, lobe)]);
}

#[test]
fn an_island_in_an_island() {
    let (large, small) = (PI * 0.09, PI * 1e-6);
    let made = holds(&islands(), &[(0, 1.0 - large), (1, large - small), (2, small)]);
    assert_eq!(made.euler().components, 3);
}

#[test]
fn curves_one_millionth_apart() {
    let below = 0.5 + 0.1 * (1.0 - 6.0_f64.cos()) / 6.0;
    let made = holds(&close_curves(), &[(0, below), (1, 1e-6), (2, 1.0 - below - 1e-6)]);
    let strip = made.regions().iter().find(|region| region.label == Some(1)).expect("the strip");
    assert!(strip.clearance > 4e-7, "{}", strip.clearance);
}

#[test]
fn curves_through_sides_and_corners_of_the_window() {
    let wave = 1.0 / 3.0 + 0.2 / PI;
    let (quarter, disc) = (PI * 0.04, PI * 0.0225);
    holds(
        &edges_and_corner(),
        &[(0, wave - quarter), (2, quarter), (5, disc), (1, 1.0 - wave - disc)],
    );
}

#[test]
fn short_parts_of_the_frame() {
    let (beside, between) = (0.1, 0.1 / PI);
    let areas = [(0, 1.0 - beside - between), (1, beside), (2, between)];
    holds(&short_frame_parts(), &areas);
}

#[test]
fn a_vertex_beside_the_frame_with_a_curve_to_it() {
    holds(&vertex_beside_the_frame(), &[(0, 0.1), (1, 0.5), (2, 0.4)]);
}

#[test]
fn a_grid_of_lines() {
    let areas: Vec<(i32, f64)> = (0..16).map(|label| (label, 0.0625)).collect();
    let made = holds(&grid(), &areas);
    assert!(made.regions().iter().all(|region| region.clearance == 0.125));
}

/// The nodes are moved by a fifth of the tolerance. Curves that leave a vertex with one tangent
/// then cross each other many times beside it. The regions remain, and so do all labels that the
/// tolerance does not leave open.
#[test]
fn disturbed_curves_keep_their_regions() {
    let planes = [
        (cusp(), 2),
        (upright_cusp(), 2),
        (touching_circles(0.0, true), 3),
        (touching_circles(0.0, false), 3),
        (figure_of_eight(), 3),
        (crossing_circles(), 4),
        (close_curves(), 3),
        (edges_and_corner(), 4),
        (grid(), 16),
    ];
    for (plane, regions) in &planes {
        for seed in 0..20 {
            let traced = disturbed(plane.clone(), 0.2 * planes::TOLERANCE, 1e-8, seed);
            let made = traced.subdivision().expect("curves with a meaning");
            assert!(made.findings().is_empty(), "{:?}", made.findings());
            assert_eq!(made.regions().len(), *regions);
            let mut decided = 0;
            for vertex in &plane.vertices {
                for i in 0..1000 {
                    let (sin, cos) = (0.1 * f64::from(i)).sin_cos();
                    let radius = 1e-10 * 1e8_f64.powf(f64::from(i) / 1000.0);
                    let point = vertex.point + radius * Point::new(cos, sin);
                    if let Location::Region(region) = made.locate(&point) {
                        let label = made.regions()[region].label;
                        assert_eq!(label, Some((plane.truth)(&point)), "{point} {radius:e}");
                        decided += 1;
                    }
                }
            }
            assert!(decided > 200 * plane.vertices.len(), "{decided}");
        }
    }
}

#[test]
fn a_window_without_curves_is_one_region() {
    let plane = KnownPlane::new(|_| 4);
    let made = plane.subdivision().expect("a window");
    assert!(made.findings().is_empty());
    assert_eq!((made.regions().len(), made.regions()[0].label), (1, None));
    assert_eq!(made.regions()[0].area, 1.0);
    let verification = verify(&made, &plane, &VerifyOptions::default()).expect("in order");
    assert!(verification.agrees() && verification.wrong_area_bound < 3.0e-4);
    assert_eq!(made.vertical_distance(&Point::new(0.5, 0.5)), None);
}

#[test]
fn places_on_curves_outside_and_on_the_window() {
    let made = islands().subdivision().expect("curves with a meaning");
    let on = made.locate(&Point::new(0.5, 0.2 + 3e-11));
    let Location::OnBoundary { curve: 1, distance } = on else { panic!("{on:?}") };
    assert!((distance - 3e-11).abs() < 1e-12);
    // The leftmost place of the circle, where it is vertical.
    assert!(matches!(made.locate(&Point::new(0.2 - 9e-11, 0.5)), Location::OnBoundary { .. }));
    let outer = made.locate(&Point::new(0.2 - 2e-10, 0.5));
    for corner in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 1.0)] {
        assert_eq!(made.locate(&Point::new(corner.0, corner.1)), outer);
    }
    for outside in [(-1e-300, 0.5), (0.5, 1.0 + 1e-15), (f64::NAN, 0.5), (0.5, f64::INFINITY)] {
        assert_eq!(made.locate(&Point::new(outside.0, outside.1)), Location::Outside);
    }
}

#[test]
fn distances_along_the_second_coordinate() {
    let made = islands().subdivision().expect("curves with a meaning");
    for i in 0..1000 {
        let x = 0.2005 + 0.599 * f64::from(i) / 1000.0;
        let half = (0.09 - (x - 0.5) * (x - 0.5)).sqrt();
        for y in [0.01, 0.4, 0.55, 0.99] {
            let mut ends = vec![0.5 - half, 0.5 + half];
            if (x - 0.4).abs() < 1e-3 {
                let half = (1e-6 - (x - 0.4) * (x - 0.4)).sqrt();
                ends.extend([0.6 - half, 0.6 + half]);
            }
            let least = ends.iter().map(|end| (end - y).abs()).fold(f64::INFINITY, f64::min);
            let found = made.vertical_distance(&Point::new(x, y)).expect("a boundary");
            assert!((found - least).abs() < 1e-9, "({x}, {y}): {found}, expected {least}");
        }
    }
    assert_eq!(made.vertical_distance(&Point::new(0.1, 0.5)), None);
    // At the abscissa where the circle begins, it has a single point.
    let leftmost = made.vertical_distance(&Point::new(0.2, 0.4));
    assert!(leftmost.is_none_or(|distance| (distance - 0.1).abs() < 1e-4), "{leftmost:?}");
}
