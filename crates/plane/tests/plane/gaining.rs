//! Where contact laws create tangential energy.

use stickslip_model::{Collider, Law, presets};
use stickslip_plane::atlas::{AtlasError, Frame};
use stickslip_plane::progress::SILENT;
use stickslip_plane::{Range, gaining};

use stickslip_tracer::Curve;

use crate::laws::with_law;

fn frame(name: &str, kappa: (f64, f64), psi: (f64, f64)) -> Frame {
    let range = |(low, high)| Range { low, high };
    with_law(name, 0.0, Frame::new(range(kappa), range(psi), 0.0))
}

/// ε_t is 1 in size along each boundary, and above 1 on one side only.
#[test]
fn the_boundary_is_where_the_restitution_is_one() {
    for (name, kappa, psi) in [
        ("gran/hertz/history", (1.5, 1.8), (0.5, 0.7)),
        ("granular/hertz/tsuji/mindlin/force", (1.2, 1.4), (0.2, 0.5)),
    ] {
        let frame = frame(name, kappa, psi);
        let gaining = gaining::trace(frame, frame.tolerances().usual, SILENT).unwrap();
        assert!(gaining.agrees(), "{name}: {:?}", gaining.atlas.unresolved);
        let plane = frame.plane().unwrap();
        let eps_t = |kappa, psi| {
            let contact = plane.contact(&plane.point(kappa, psi)).unwrap();
            (contact, Collider::default().collide(contact).unwrap().eps_t())
        };
        let lines = gaining.lines();
        assert!(!lines.is_empty() && gaining.objection().is_none(), "{name}");
        for line in lines {
            for [kappa, psi] in &line.points {
                let error = eps_t(*kappa, *psi).1 - line.eps_t;
                assert!(error.abs() < 1e-8, "{name} {kappa} {psi}: {error:e}");
            }
            let middle = line.points.len() / 2;
            let [[from, low], [to, high]] = [line.points[middle - 1], line.points[middle]];
            // 1e-4 to the left of the line.
            let (rise, length) = ([to - from, high - low], (to - from).hypot(high - low));
            let left = [from - 1e-4 * rise[1] / length, low + 1e-4 * rise[0] / length];
            assert_eq!(eps_t(left[0], left[1]).1.abs() > 1.0, line.gains_left, "{name}");
        }
        let mut both = [false; 2];
        let mut random = fastrand::Rng::with_seed(1);
        for _ in 0..300 {
            let part = |(low, high): (f64, f64), part: f64| low + (high - low) * part;
            let (contact, eps_t) = eps_t(part(kappa, random.f64()), part(psi, random.f64()));
            assert_eq!(gaining.gains(&contact), Some(eps_t.abs() > 1.0), "{contact:?}");
            both[usize::from(eps_t.abs() > 1.0)] = true;
        }
        assert_eq!(both, [true; 2], "{name}");
    }
}

/// At κψ = 1 the line touches a boundary of the switches, with κ = 4.5 and 10.5 for a history by
/// displacement: regions are those of |ε_t| alone.
#[test]
fn lines_do_not_depend_on_where_switches_change() {
    for (name, kappa, psi) in [
        ("gran/hertz/history", (10.0, 11.0), (0.05, 0.15)),
        ("granular/hertz/tsuji/mindlin/force", (4.0, 13.0), (0.05, 0.5)),
    ] {
        let frame = frame(name, kappa, psi);
        let gaining = gaining::trace(frame, frame.tolerances().usual, SILENT).unwrap();
        assert_eq!(gaining.objections(), [""; 0], "{name}");
        assert!(!gaining.lines().is_empty());
        let of_gain = |curve: &Curve<_, _>| curve.sides.iter().any(|side: &Vec<_>| side.is_empty());
        assert!(gaining.atlas.plane.curves().iter().all(of_gain), "{name}");
    }
}

/// A spring that conserves energy never gives back more than it took.
#[test]
fn the_paper_s_law_gains_nothing() {
    let range = |low, high| Range { low, high };
    let frame = Frame::new(range(2.0, 4.0), range(0.3, 0.6), 0.1);
    assert_eq!(frame.law, Law::PAPER);
    let gaining = gaining::trace(frame, frame.tolerances().usual, SILENT).unwrap();
    assert!(gaining.agrees() && gaining.lines().is_empty() && gaining.extent().is_none());
}

#[test]
fn what_cannot_be_traced_is_refused() {
    let good = frame("gran/hertz/history", (1.0, 2.0), (0.5, 1.0));
    let usual = good.tolerances().usual;
    for tolerance in [0.0, f64::NAN, 1.0] {
        let refused = gaining::trace(good, tolerance, SILENT);
        assert!(matches!(refused, Err(AtlasError::Tolerance { .. })), "{tolerance}");
    }
    let narrow = Range { low: 1.0, high: 1.0 + 1e-9 };
    let refused = gaining::trace(Frame { kappa: narrow, ..good }, usual, SILENT);
    assert!(matches!(refused, Err(AtlasError::Parameter(_))));
    let endless =
        Frame { damping: 5.0, law: presets::find("gran/hooke/history").unwrap().law, ..good };
    assert!(matches!(gaining::trace(endless, usual, SILENT), Err(AtlasError::Parameter(_))));
}
