//! Starts that exist under conditions.

use std::f64::consts::PI;

use stickslip_expression::{System, SystemFamily};
use stickslip_solver::Options;
use stickslip_solver::margin::Place;
use stickslip_tracer::{
    Atlas, AtlasOf, AtlasOptions, Family, Point, Window, hybrid::Itinerary, regions::VerifyOptions,
};

fn parsed(text: &str) -> System {
    System::parse(text).unwrap_or_else(|error| panic!("{error}"))
}

/// The atlas over the first two parameters, with nothing in doubt at any of 2000 points.
fn atlas(text: &str, [low, high]: [[f64; 2]; 2]) -> (SystemFamily, AtlasOf<SystemFamily>) {
    let system = parsed(text);
    // As text, the order of factors is that of nodes.
    let again = parsed(&system.text());
    assert_eq!(parsed(&again.text()).text(), again.text());
    assert_eq!(again.required.len(), system.required.len());
    let values = system.values();
    let runs = Options { max_step: 0.5, ..Options::with_tolerance(1e-13) };
    let family = SystemFamily::new(&system, [0, 1], &values, None, runs).expect("a family");
    let verify = VerifyOptions { random_points: 2000, ..VerifyOptions::default() };
    let options = AtlasOptions { verify, ..AtlasOptions::default() };
    let window = Window { low: low.into(), high: high.into() };
    let atlas = Atlas::of(&family, &window, &options).expect("an atlas");
    assert_eq!(atlas.objection(), None);
    assert!(atlas.agrees() && (atlas.sure_area() - 1.0).abs() < 1e-12);
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..2000 {
        let part = Point::new(random.f64(), random.f64());
        let point = window.low + window.extent().component_mul(&part);
        let label = family.label(&point).expect("a label");
        if let Some(known) = atlas.label(&point) {
            assert_eq!(*known, label, "{point:?}");
        } else {
            let near = atlas.plane.vertical_distance(&point);
            panic!("in doubt at {point:?}, {near:?} from a curve");
        }
    }
    (family, atlas)
}

/// The nodes on which a condition vanishes.
fn limits(atlas: &AtlasOf<SystemFamily>, condition: usize) -> Vec<Point> {
    let curves = atlas.plane.curves().iter();
    let limits = curves
        .filter(|curve| curve.margin.place == Place::Condition && curve.margin.guard == condition);
    limits.flat_map(|curve| &curve.nodes).map(|node| node.point).collect()
}

/// Periodic orbits with one impact in each period of the force cos(ωt), which begin behind their
/// impact: x = γ·cos(ωt) + free oscillations, γ = 1/(1 − ω²). With p = (1 + e)/2·cot(π/ω) and
/// q = (1 − e)/(2ω), the velocity u of the impact fulfils (wall + p·u)² + (q·u)² = γ².
const ORBITS: &str = "
parameter w = 1.6, wall = 2, e = 0.8
gamma = 1/(1 - w^2)
p = (1 + e)/2/tan(pi/w)
q = (1 - e)/(2*w)
room = gamma^2*(p^2 + q^2) - (q*wall)^2
speed = (sqrt(room) - wall*p)/(p^2 + q^2)
state x = wall, v = -e*speed
state phase = atan2(-q*speed/gamma, (wall + p*speed)/gamma)

x' = v
v' = cos(phase) - x
phase' = w
when x > wall \"impact\"
  x := wall
  v := -e*v

requires room >= 0
end = 8
";

#[test]
fn periodic_orbits_exist_up_to_a_known_boundary() {
    let (family, atlas) = atlas(ORBITS, [[1.4, 1.0], [1.9, 5.0]]);
    let nodes = limits(&atlas, 0);
    assert!(nodes.len() > 5);
    for point in nodes {
        let (w, e) = (point.x, 0.8);
        let (p, q) = (0.5 * (1.0 + e) / (PI / w).tan(), 0.5 * (1.0 - e) / w);
        let wall = (p.hypot(q) / (q * (1.0 - w * w))).abs();
        assert!((point.y - wall).abs() < 1e-9, "{point:?}: {wall}");
    }
    assert_eq!(family.label(&Point::new(1.9, 5.0)), Ok(Itinerary::NoStart(0)));
    // After two periods the next impact is at the end of the run.
    let begins = family.label(&Point::new(1.45, 1.5)).expect("a label");
    assert!(begins.fired().is_some_and(|fired| !fired.is_empty()), "{begins:?}");
    assert!(atlas.plane.regions().len() >= 3);
}

/// Where a start vanishes as a square root, a boundary behind it touches the end of its existence.
#[test]
fn a_boundary_that_touches_the_end_of_existence() {
    let text = "parameter p = 1, q = 1\nstate x = q + sqrt(p)\nx' = -1\nwhen x < 0 \"down\"\n\
                requires p >= 0\nend = 1";
    let (_, atlas) = atlas(text, [[-1.0, 0.1], [1.2, 1.9]]);
    assert_eq!(atlas.plane.regions().len(), 3);
    let away = |point: Point| (point - Point::new(0.0, 1.0)).norm();
    let ends = atlas.plane.vertices().iter().map(|vertex| away(vertex.point));
    assert!(ends.fold(1.0, f64::min) < 1e-9, "{:?}", atlas.plane.vertices());
}

/// What a start needs to have a value is a condition, whether the system says so or not.
#[test]
fn a_start_without_a_value_is_no_start() {
    let without = ORBITS.replace("requires room >= 0\n", "");
    let [said, found] = [ORBITS, &without].map(|text| atlas(text, [[1.4, 1.0], [1.9, 5.0]]).1);
    assert_eq!(said.plane.curves(), found.plane.curves());
    let text = "parameter a = 0, b = 0\nstate x = asin(a) + log(b)^1.5\n\
                discrete y = if a > 0 then sqrt(a) else 0\nx' = -1\nwhen x < 1 \"low\"\nend = 1";
    let (family, atlas) = atlas(text, [[-1.5, -0.5], [1.5, 4.0]]);
    // The root of a is not needed, and that of log(b) comes behind it.
    let labels = [[-1.2, 2.0], [1.2, 2.0], [0.5, -0.1], [0.5, 0.5]];
    let labels = labels.map(|[a, b]| family.label(&Point::new(a, b)).expect("a label"));
    assert!(labels.iter().all(|label| matches!(label, Itinerary::NoStart(_))), "{labels:?}");
    for a in [-0.5, 0.5] {
        let label = family.label(&Point::new(a, 2.0)).expect("a label");
        assert!(label.fired().is_some(), "{label:?}");
    }
    assert!(atlas.plane.regions().len() >= 6);
}

/// Several conditions are decided in their order; what the second one says where the first one does
/// not hold does not matter.
#[test]
fn several_conditions() {
    let text = "parameter a = 1, b = 1\nstate x = sqrt(b - sqrt(a))\nx' = -1\n\
                when x < 0 \"down\"\nrequires a > 0, b > sqrt(a)\nend = 0.5";
    let (family, atlas) = atlas(text, [[-0.5, 0.1], [1.0, 1.5]]);
    let label = |x, y| family.label(&Point::new(x, y)).expect("a label");
    assert_eq!(label(-0.1, 0.5), Itinerary::NoStart(0));
    assert_eq!(label(0.5, 0.2), Itinerary::NoStart(1));
    assert_eq!([label(0.0, 0.5), label(0.25, 0.5)], [0, 1].map(Itinerary::NoStart));
    assert_eq!(atlas.plane.regions().len(), 4);
    assert!(limits(&atlas, 0).iter().all(|node| node.x.abs() < 1e-12));
    assert!(limits(&atlas, 1).iter().all(|node| (node.y - node.x.sqrt()).abs() < 1e-9));
}

/// Conditions that are joined are several, whose common boundary has corners.
#[test]
fn joint_conditions_are_several() {
    let one =
        parsed("parameter a = 1, b = 1\nstate x = 1\nx' = -1\nrequires a > 0 and b >= a\nend = 1");
    let several =
        parsed("parameter a = 1, b = 1\nstate x = 1\nx' = -1\nrequires a > 0, b >= a\nend = 1");
    assert_eq!((one.text(), one.required.len()), (several.text(), 2));
    assert!(several.with(&[1.0, 1.0]).is_ok());
    for (wrong, said) in [([0.0, 1.0], "condition 1"), ([1.0, 0.5], "condition 2")] {
        let refused = several.with(&wrong).expect_err("no start").to_string();
        assert!(refused.contains(said) && refused.contains("not negative"), "{refused}");
    }
}
