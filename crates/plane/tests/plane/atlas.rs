use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip_model::regularized::SAME_SIDE;
use stickslip_model::{Collider, Contact, exact};
use stickslip_plane::atlas::{
    AtlasError, BoundaryKind, Frame, ParameterPlace, Unlocated, switch_count, trace,
};
use stickslip_plane::progress::{Progress, SILENT, Watch};
use stickslip_plane::{CollisionPlane, Range};
use stickslip_solver::margin::{Exit, Hint, Margin, Place};
use stickslip_tracer::{
    Family, VertexKind,
    regions::{Finding, Location},
};

use crate::laws::with_law;
use crate::windows::{crossing, empty, frame, traced};

fn contact(kappa: f64, psi: f64) -> Contact {
    Contact::new(kappa, psi, 0.0).unwrap()
}

#[test]
fn a_window_too_narrow_is_refused_with_its_size() {
    let narrow = frame((5.0, 20.0), (0.2, 0.2 + 1e-8));
    let refused = trace(narrow, 1e-10, SILENT).unwrap_err();
    assert!(matches!(refused, AtlasError::Parameter(_)), "{refused:?}");
    let (text, width) = (refused.to_string(), 4.0_f64.ln());
    let start = format!("the window is too narrow: {width:e} in ln(kappa) by ");
    let height = text.strip_prefix(&start).and_then(|rest| rest.split_once(' '));
    let (height, rest) = height.unwrap_or_else(|| panic!("{text}"));
    assert!((height.parse::<f64>().unwrap() - 5e-8).abs() < 1e-14, "{text}");
    assert_eq!(rest, "in ln(psi); expected from 2e-7 each");
    // In the other direction, too; a window just wide enough is traced.
    assert!(frame((5.0, 5.0 + 9e-7), (0.2, 2.0)).require_wide().is_err());
    assert!(frame((5.0, 5.0 + 1.1e-6), (0.2, 2.0)).require_wide().is_ok());
}

/// Windows that are tiny, or reach to tiny ψ, have charts of their own: around the crossing at
/// κ = 19.35 (three widths), around the cusp, and with κ and ψ over many decades.
#[test]
fn small_and_long_windows_are_right() {
    let atlas = crossing();
    let mut vertices = atlas.regions.vertices().iter();
    let crossing = vertices.find(|vertex| vertex.kind == VertexKind::Crossing).unwrap();
    let [kappa, psi] = atlas.plane.parameters(&crossing.point);
    for width in [1e-3, 1e-5, 5e-7] {
        let around = |value: f64| (value * (1.0 - width), value * (1.0 + width));
        let verified = traced(frame(around(kappa), around(psi)));
        assert!(verified.report.agrees, "{width:e}: {:?}", verified.objection());
        let regions = &verified.regions;
        assert_eq!((regions.curves().len(), regions.regions().len()), (4, 4), "{width:e}");
    }
    let long = traced(frame((0.01, 10.0), (1e-4, 3.0)));
    assert!(long.report.agrees, "{:?}", long.report.objection());
}

/// One boundary that ends in the cusp is ψ = 1 itself, and the wedge between the two is soon
/// thinner than runs can tell. In these windows an edge passes through the cusp or just beside it,
/// and their sides are very unequal.
#[test]
fn edges_may_pass_through_the_cusp() {
    for (kappa, psi) in [
        ((1.0, 3.0), (1.0, 1.00001)),
        ((1.2, 1.56846), (0.9999, 1.0)),
        ((1.56, 1.57), (1.0, 1.001)),
        ((1.5684, 1.5686), (0.999999, 1.5)),
        ((1.56845, 1.56847), (1.0, 1.001)),
    ] {
        let verified = traced(frame(kappa, psi));
        assert!(verified.report.agrees, "{kappa:?}, {psi:?}: {:?}", verified.objection());
        assert_eq!(verified.regions.regions().len(), 2, "{kappa:?}, {psi:?}");
    }
}

/// A region along the lower edge of these windows is 1e-10 high in ψ, a hundred times what margins
/// resolve. A collision in it shows that it is there.
#[test]
fn thin_regions_beside_the_cusp_are_there() {
    for kappa in [(1.5683, 1.5687), (1.5684, 1.5686)] {
        let verified = traced(frame(kappa, (0.9999, 1.0)));
        assert!(verified.report.agrees, "{kappa:?}: {:?}", verified.objection());
        let regions = &verified.regions;
        assert!(matches!(regions.findings(), [Finding::Thin { .. }]), "{:?}", regions.findings());
        assert_eq!(regions.regions().len(), 2);
    }
}

/// A vertex lies on a corner or on an edge, to rounding, and the sides are very unequal: two
/// boundaries are close together far from the vertex, as a part of the shorter side.
#[test]
fn a_vertex_may_lie_on_the_edge() {
    for (kappa, psi) in [
        ((42.8443035297909, 42.84603608457701), (0.2796520343202348, 0.28097688631363915)),
        ((59.69883880087375, 59.69934086979169), (0.5535993387024969, 0.5547138976196172)),
        ((76.6323348878188, 76.63337595142647), (0.4291076145068368, 0.4291463195935629)),
        ((77.52677359820228, 111.10436016173465), (0.7977300441825201, 0.7977390307265566)),
    ] {
        let verified = traced(frame(kappa, psi));
        assert!(verified.report.agrees, "{kappa:?}, {psi:?}: {:?}", verified.objection());
        assert_eq!(verified.regions.regions().len(), 3, "{kappa:?}, {psi:?}");
    }
}

/// The same, where only boundaries that are followed beyond the edge tell what meets there; with
/// another law, only those that are not.
#[test]
fn a_window_with_a_doubt_is_traced_in_another_way() {
    let paper = frame((0.8689966063196453, 2.967384774021437), (1.0, 1.0000181877830543));
    let hooke = frame((1.0, 1.000057293278027), (0.9999954665433843, 1.0));
    for window in [paper, with_law("gran/hooke/history", 0.0, hooke)] {
        let verified = traced(window);
        assert!(verified.report.agrees, "{window:?}: {:?}", verified.objection());
    }
}

/// With damping: three boundaries end in a vertex, and places in this window are known to 1e-7 of
/// it; a boundary that ends at another one leaves in a corner, where they meet; a graze runs so
/// close to the line it leaves that their crossing is found 6e-6 of the window beside the vertex; a
/// vertex is 2e-8 of the window beside the edge; and two windows are so narrow that a margin off by
/// 1e-13 would move a crossing by 3e-6 of them.
#[test]
fn damped_windows_at_a_vertex_are_right() {
    for (damping, kappa, psi, regions) in [
        (
            0.1,
            (3.9604088266622157, 3.9604127870730226),
            (0.06736491654633595, 0.06736498391128617),
            3,
        ),
        (
            0.1,
            (0.7320200445501938, 0.7468238338430033),
            (1.5283597624857523, 1.5283829503644435),
            2,
        ),
        (
            0.01,
            (0.9567599785578079, 0.9567609353182649),
            (0.1027289475246634, 0.10272905025366229),
            3,
        ),
        (
            0.3,
            (1.0623903864312139, 1.0639268773182513),
            (0.31619140480226515, 0.31707125176389084),
            3,
        ),
        (
            2.0,
            (55.926918196053556, 55.92697412299972),
            (0.17451678943165572, 0.17451696394853242),
            4,
        ),
        (
            5.0,
            (48.14109445674257, 48.141142597861105),
            (0.09330673581353068, 0.09330682912031314),
            4,
        ),
    ] {
        let verified = traced(Frame { damping, ..frame(kappa, psi) });
        assert!(verified.report.agrees, "{kappa:?}, {psi:?}: {:?}", verified.objection());
        assert_eq!(verified.regions.regions().len(), regions, "{kappa:?}, {psi:?}");
    }
}

/// Two boundaries cross in the upper right corner, to rounding: a step to the edge ends there.
#[test]
fn boundaries_may_cross_in_a_corner() {
    let (kappa, psi) =
        ((73.34140315565118, 73.39524206444307), (0.15321256238480244, 0.15403275473412606));
    let verified = traced(frame(kappa, psi));
    assert!(verified.report.agrees, "{:?}", verified.objection());
    assert_eq!(verified.regions.regions().len(), 3);
}

/// With little damping and small ψ: grazes just before the end of contact, and the place where one
/// leaves through it, at κψ = √a.
#[test]
fn a_window_of_late_grazes_is_right() {
    let window = Frame { damping: 5.4e-5, ..frame((77.0, 77.4), (8e-5, 1.2e-4)) };
    let verified = traced(window);
    assert!(verified.report.agrees, "{:?}", verified.objection());
    assert!(verified.regions.regions().len() > 1);
}

/// Vertical boundaries end at κ = 0.5701, ψ = 2, a place that the boundary across them gives more
/// accurately.
#[test]
fn a_vertex_that_is_found_twice_is_one() {
    let verified = traced(frame((0.1, 3.0), (1e-5, 3.0)));
    assert!(verified.report.agrees, "{:?}", verified.objection());
    assert_eq!(verified.regions.regions().len(), 5);
}

/// Three boundaries cross 2.5e-7 above the lower edge, and a region below is smaller than that.
#[test]
fn a_region_between_a_vertex_and_the_edge_beside_it_is_there() {
    let verified = traced(Frame { damping: 5.6806e-4, ..frame((0.5, 30.0), (0.05, 2.0)) });
    assert!(verified.report.agrees, "{:?}", verified.objection());
    assert_eq!(verified.regions.regions().len(), 16);
}

#[test]
fn a_tolerance_out_of_range_is_refused_with_the_range() {
    let frame = frame((18.0, 21.0), (0.55, 0.65));
    let range = frame.tolerances();
    assert!(range.finest <= range.usual && range.usual < range.coarsest);
    for asked in [0.99 * range.finest, 1.01 * range.coarsest, -range.usual, f64::NAN] {
        let AtlasError::Tolerance { tolerance, finest, coarsest } =
            trace(frame, asked, SILENT).unwrap_err()
        else {
            panic!("{asked} is not refused")
        };
        assert_eq!(tolerance.to_bits(), asked.to_bits());
        assert_eq!((finest, coarsest), (range.finest, range.coarsest));
    }
    let error = trace(frame, 1.0, SILENT).unwrap_err().to_string();
    let expected = format!("expected {:e} to {:e} in this window", range.finest, range.coarsest);
    assert_eq!(error, format!("the tolerance 1.0 is out of range; {expected}"));
}

#[test]
fn a_window_without_collisions_is_refused() {
    for frame in
        [frame((0.0, 20.0), (0.2, 2.0)), Frame { damping: -1.0, ..frame((5.0, 20.0), (0.2, 2.0)) }]
    {
        let error = trace(frame, 1e-10, SILENT).unwrap_err();
        assert!(matches!(error, AtlasError::Parameter(_)), "{error}");
    }
}

#[test]
fn a_window_that_cannot_be_verified_is_refused_first() {
    let weakly_damped = Frame { damping: 1e-9, ..frame((5.0, 20.0), (0.2, 2.0)) };
    for frame in [weakly_damped, frame((5.0, 1e11), (0.2, 2.0))] {
        let error = trace(frame, 1e-10, SILENT).unwrap_err();
        assert!(matches!(error, AtlasError::Unverifiable(_)), "{error}");
    }
}

#[test]
fn regions_have_the_switches_of_their_collisions() {
    let verified = crossing();
    assert!(verified.report.agrees, "{:?}", verified.report);
    assert_eq!(verified.objection(), None);
    let atlas = &verified;
    assert_eq!(atlas.regions.regions().len(), 4);
    let mut seen = [false; 4];
    for step in 0..100 {
        let (column, row) = (step % 10, step / 10);
        let (kappa, psi) = (18.15 + 0.3 * f64::from(column), 0.555 + 0.01 * f64::from(row));
        let located = atlas.locate([kappa, psi]);
        let region = located.region.unwrap();
        seen[region] = true;
        let collision = exact::collide(contact(kappa, psi)).unwrap();
        assert_eq!(atlas.itinerary(region), collision.itinerary(), "{kappa}, {psi}");
        assert_eq!(switch_count(atlas.itinerary(region)), collision.switches.len());
        let boundaries = atlas.boundaries_at(kappa).into_iter();
        let nearest = boundaries.map(|boundary| (boundary - psi).abs()).reduce(f64::min);
        assert!((located.distance.unwrap() - nearest.unwrap()).abs() < 1e-9);
    }
    assert_eq!(seen, [true; 4]);
}

/// The window has a cusp of slip grazes, late half swings with two tops, and a boundary on which a
/// contact that is all stick changes the side of its end: there √κ t_c = π.
#[test]
fn damped_boundaries_have_the_integrators_switches_beside_them() {
    let damping = 0.1;
    let verified = traced(Frame { damping, ..frame((0.7, 1.9), (0.1, 1.1)) });
    assert_eq!(verified.objection(), None, "{:?}", verified.report);
    let atlas = &verified;
    assert!(atlas.regions.regions().len() > 4);
    let damped = |kappa, psi| Contact::new(kappa, psi, damping).unwrap();
    for step in 0..100 {
        let (column, row) = (step % 10, step / 10);
        let contact = damped(0.76 + 0.12 * f64::from(column), 0.15 + 0.1 * f64::from(row));
        let region = atlas.locate([contact.kappa(), contact.psi()]).region.unwrap();
        let collision = Collider::default().collide(contact).unwrap();
        assert_eq!(atlas.itinerary(region), collision.itinerary(), "{contact:?}");
    }
    let contact_time = exact::collide(damped(1.0, 0.1)).unwrap().contact_time;
    let kappa = (std::f64::consts::PI / contact_time).powi(2);
    let beside = [1.0 - 1e-8, 1.0 + 1e-8].map(|part| {
        let region = atlas.locate([kappa * part, 0.11]).region.unwrap();
        atlas.itinerary(region)
    });
    assert_eq!(beside, ["o+", "o-"]);
}

/// Grazes while sliding and while sticking end at one vertex, in which the two turns of the limit
/// meet and the slip phase grazes. At its other end the slip graze meets the first of two tops,
/// which merges with the bottom between the tops.
#[test]
fn damped_grazes_end_in_cusps() {
    let damping = 0.41;
    let verified = traced(Frame { damping, ..frame((1.3, 1.9), (0.6, 1.0)) });
    assert_eq!(verified.objection(), None, "{:?}", verified.report);
    let (regions, chart) = (&verified.regions, verified.plane.chart());
    let ends_of = |kind: BoundaryKind| {
        let curves = regions.curves().iter().filter(move |curve| curve.margin == kind);
        curves.filter_map(|curve| curve.ends).flatten().collect::<Vec<_>>()
    };
    let slip = ends_of(BoundaryKind::SlipGraze);
    let [one, other] = slip[..] else { panic!("{slip:?}") };
    let x = |end: usize| regions.vertices()[end].point.x;
    let ends = if x(one) > x(other) { [one, other] } else { [other, one] };
    // The graze of the slip phase after the stick with which the contact begins.
    let graze = Margin {
        exits: vec![Exit::falling(SAME_SIDE, 2.0)],
        guard: SAME_SIDE,
        place: Place::Minimum { near: Hint(0.0), number: 0 },
    };
    let family = CollisionPlane::new((1.3, 1.9), (0.6, 1.0), damping).unwrap().family();
    for (end, pair) in ends.into_iter().zip(family.cusps(&graze)) {
        assert!(ends_of(BoundaryKind::StickGraze).contains(&end));
        let [kappa, psi] = chart.parameters(&regions.vertices()[end].point);
        let place = Contact::new(kappa, psi, damping).unwrap();
        for margin in pair {
            let value = exact::margin(&place, &margin).unwrap().unwrap();
            assert!(value.abs() < 1e-13, "{margin:?} {value:e}");
        }
    }
}

/// The boundaries of this window meet in a graze at the end which two curves determine to half the
/// digits. The third one, which begins there, is also led to it.
#[test]
fn a_graze_at_the_end_is_known_by_all_its_boundaries() {
    let verified = traced(Frame { damping: 1.05, ..frame((1.2, 1.5), (0.1, 0.4)) });
    assert_eq!(verified.objection(), None, "{:?}", verified.report);
    let verified = traced(Frame { damping: 1.05, ..frame((0.5, 30.0), (0.05, 2.0)) });
    assert_eq!(verified.objection(), None, "{:?}", verified.report);
}

#[test]
fn a_region_that_no_boundary_touches_has_an_itinerary() {
    let atlas = empty();
    assert_eq!((atlas.regions.curves().len(), atlas.regions.regions().len()), (0, 1));
    assert_eq!(atlas.itinerary(0), "+");
    let located = atlas.locate([5.5, 2.75]);
    assert_eq!((located.region, located.distance), (Ok(0), None));
    assert!(atlas.boundaries_at(5.5).is_empty() && atlas.polylines().is_empty());
}

#[test]
fn a_point_outside_the_window_is_refused_with_the_window() {
    for (kappa, psi) in [(17.9, 0.6), (21.1, 0.6), (19.0, 0.54), (19.0, 0.66)] {
        let located = crossing().locate([kappa, psi]);
        let range = |low, high| Range { low, high };
        let window = [range(18.0, 21.0), range(0.55, 0.65)];
        let place = ParameterPlace { names: ["kappa", "psi"], values: [kappa, psi] };
        let expected = Unlocated::Outside { place, window };
        assert_eq!(located.region, Err(expected));
        assert_eq!(
            expected.to_string(),
            format!(
                "kappa = {kappa:?}, psi = {psi:?} is outside the window of the atlas, kappa 18.0 to \
                 21.0, psi 0.55 to 0.65"
            )
        );
    }
}

#[test]
fn a_point_on_a_boundary_is_decided_by_its_collision() {
    let atlas = crossing();
    for psi in atlas.boundaries_at(20.0) {
        let place = atlas.plane.point(20.0, psi);
        assert!(matches!(atlas.regions.locate(&place), Location::OnBoundary { .. }));
        assert!(atlas.locate([20.0, psi]).distance.unwrap() < 1e-12);
        // Within the error of the boundary and beyond it, on either side.
        let mut found = Vec::new();
        for away in [-1e-6, -1e-11, -1e-13, 0.0, 1e-13, 1e-11, 1e-6] {
            let contact = contact(20.0, psi + away);
            let itinerary = exact::collide(contact).unwrap().itinerary();
            let region = atlas.locate([contact.kappa(), contact.psi()]).region.unwrap();
            assert_eq!(atlas.itinerary(region), itinerary, "{away:e}");
            found.push(itinerary);
        }
        found.dedup();
        assert_eq!(found.len(), 2);
    }
    assert_eq!(atlas.boundaries_at(20.0).len(), 2);
}

#[test]
fn boundaries_have_kinds_and_lines_through_their_points() {
    let atlas = crossing();
    let lines = atlas.polylines();
    assert_eq!(lines.len(), atlas.regions.curves().len());
    for (curve, line) in atlas.regions.curves().iter().zip(&lines) {
        assert!(matches!(curve.margin, BoundaryKind::EndOfContact | BoundaryKind::StickGraze));
        for node in &curve.nodes {
            let [kappa, psi] = atlas.plane.parameters(&node.point);
            let near = |point: &[f64; 2]| (point[0] - kappa).hypot(point[1] - psi) < 1e-12;
            assert!(line.iter().any(near));
        }
        // Straight lines do not leave the boundary by more than a picture shows.
        for pair in line.windows(2) {
            let [kappa, psi] = [0, 1].map(|i| f64::midpoint(pair[0][i], pair[1][i]));
            let boundaries = atlas.boundaries_at(kappa).into_iter();
            let distance = boundaries.map(|boundary| (boundary - psi).abs()).reduce(f64::min);
            assert!(distance.is_none_or(|distance| distance < 1e-4), "{distance:?}");
        }
    }
}

#[test]
fn progress_tells_of_as_many_steps_as_it_announced() {
    let (announced, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let frame = frame((5.0, 6.0), (2.5, 3.0));
    trace(frame, frame.tolerances().usual, &|progress| {
        let (counter, steps) = match progress {
            Progress::Begin { steps } => (&announced, steps),
            Progress::Advance { steps } => (&done, steps),
            Progress::Now { .. } => return,
        };
        counter.fetch_add(steps, Ordering::Relaxed);
    })
    .unwrap();
    assert!(announced.load(Ordering::Relaxed) >= 1);
    assert_eq!(announced.into_inner(), done.into_inner());
}

#[test]
fn a_damped_window_is_traced_by_integration() {
    let frame = Frame::new(Range { low: 10.0, high: 11.0 }, Range { low: 0.9, high: 1.0 }, 0.05);
    let verified = traced(frame);
    assert!(verified.report.agrees, "{:?}", verified.report);
    let itinerary = verified.itinerary(0);
    assert_eq!(switch_count(itinerary) % 2, 1, "a damped contact begins in stick: {itinerary}");
}

/// A slip phase within the second stick phase, in a region 2e-4 of ψ wide that ends at κ = 1.558.
/// The places of the grid have the same switches on both sides of it.
#[test]
fn a_region_thinner_than_a_cell_is_found() {
    let kappa = Range { low: 1.553_434_774_302_522_5, high: 3.0 };
    let frame = Frame::new(kappa, Range { low: 0.5, high: 1.5 }, 0.028_228_728_691_607_554);
    let verified = traced(frame);
    assert!(verified.report.agrees, "{:?}", verified.report);
    let atlas = verified;
    let thin = Contact::new(1.5535, 0.9791, frame.damping).unwrap();
    let region = atlas.locate([thin.kappa(), thin.psi()]).region.unwrap();
    assert_eq!(atlas.itinerary(region), "o+o+o-");
    assert_eq!(Collider::deciding().collide(thin).unwrap().itinerary(), "o+o+o-");
}

/// The window's own finest tolerance is not lost by rounding.
#[test]
fn narrow_windows_have_their_usual_tolerance() {
    for psi in [(1.9, 2.1), (0.3, 0.35)] {
        let window = frame((18.0, 19.0), psi);
        let tolerances = window.tolerances();
        for tolerance in [tolerances.finest, tolerances.coarsest] {
            assert!(trace(window, tolerance, SILENT).is_ok(), "{psi:?} {tolerance:e}");
        }
    }
}

/// The runs of the grid and of the verification are computed in parallel, and a cancelled trace
/// says that it is not finished.
#[test]
fn threads_do_not_change_an_atlas_and_cancelling_shows() {
    let frame = frame((18.0, 21.0), (0.55, 0.65));
    let tolerance = frame.tolerances().usual;
    for threads in [1, 4] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let verified = pool.install(|| trace(frame, tolerance, SILENT)).unwrap();
        assert_eq!(verified.regions.curves(), crossing().regions.curves());
        assert_eq!(verified.report, crossing().report, "{threads} threads");
    }
    for last in [0, 30, 300, 3000] {
        let asked = AtomicUsize::new(0);
        let cancel = || asked.fetch_add(1, Ordering::Relaxed) >= last;
        let watch = Watch::SILENT.cancelled_by(&cancel);
        let report = trace(frame, tolerance, watch).unwrap().report;
        let objection = report.objection().unwrap();
        assert!(!report.agrees && objection.contains("cancelled before the end"), "{objection}");
    }
}

/// With a small ψ the last graze is so close to the end of contact that its top leaves through the
/// end within 1e-11 of the boundary.
#[test]
fn grazes_at_the_very_end_of_contact_are_traced() {
    let verified = traced(frame((0.9, 1.0), (1e-6, 2e-6)));
    assert_eq!(verified.objection(), None);
    let regions = &verified.regions;
    assert_eq!((regions.curves().len(), regions.regions().len()), (1, 2));
}

/// Where ψ varies by a ten-millionth of itself, it is known badly as a part of the window, but
/// boundaries that run across are not: regions between them are narrow in κ, and are there.
#[test]
fn narrow_regions_across_a_flat_window_are_found() {
    let verified = traced(frame((600.0, 1100.0), (0.0066122, 0.00661220165)));
    assert_eq!(verified.objection(), None);
    let regions = &verified.regions;
    assert_eq!((regions.curves().len(), regions.regions().len()), (15, 16));
}
