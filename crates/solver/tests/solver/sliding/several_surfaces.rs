//! Several surfaces at once.

use super::{Relays, ran, refused, switches, zero};
use SurfaceSide::{Above, Below, Sliding};
use stickslip_solver::sliding::{Filippov, Refusal, SurfaceSide, Switched};
use stickslip_solver::{Number, State};

/// Two masses on a belt, each on a spring to a wall, with a spring between them. Both stick; one
/// is released after the other.
#[test]
fn two_masses_on_a_belt() {
    let (walls, between, frictions, belt) = ([1.0, 0.4], 0.3, [0.3, 0.35], 0.2);
    let system = Relays {
        matrix: [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-walls[0] - between, between, 0.0, 0.0],
            [between, -walls[1] - between, 0.0, 0.0],
        ],
        relays: [[0.0, 0.0], [0.0, 0.0], [-frictions[0], 0.0], [0.0, -frictions[1]]],
        normals: [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
        offsets: [-belt; 2],
        ..Relays::NONE
    };
    let start = [0.1, -0.2];
    let (found, _) = switches::<4, 2, 4>(&system, [start[0], start[1], belt, belt], 5.0);
    // Both move with the belt: k₁x₁ − c (x₂ − x₁) = F₁ where the first one is released.
    let first =
        (frictions[0] + between * (start[1] - start[0]) - walls[0] * start[0]) / (walls[0] * belt);
    assert!((found[0].0 - first).abs() < 1e-12, "{found:?} {first}");
    assert_eq!(found[0].1, [Below, Sliding]);
    // The first one swings: x″ + ω²x = c x₂(t) + F₁.
    let square: f64 = walls[0] + between;
    let omega = square.sqrt();
    let second_at = |t: f64| start[1] + belt * (first + t);
    let rest = |t: f64| (between * second_at(t) + frictions[0]) / square;
    let (x, v) = (start[0] + belt * first - rest(0.0), belt - between * belt / square);
    let first_at = |t: f64| rest(t) + x * (omega * t).cos() + v / omega * (omega * t).sin();
    let pull =
        |t: f64| -walls[1] * second_at(t) + between * (first_at(t) - second_at(t)) + frictions[1];
    let second = zero(pull, 0.0, 4.4);
    assert!((found[1].0 - first - second).abs() < 1e-11, "{found:?} {}", first + second);
    assert_eq!(found[1].1, [Below, Below]);
}

/// Equal masses are released at the same instant, and caught so.
#[test]
fn what_is_symmetric_switches_at_one_instant() {
    let system = Relays {
        matrix: [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-1.3, 0.3, 0.0, 0.0],
            [0.3, -1.3, 0.0, 0.0],
        ],
        relays: [[0.0, 0.0], [0.0, 0.0], [-0.5, 0.0], [0.0, -0.5]],
        normals: [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
        offsets: [-0.2; 2],
        ..Relays::NONE
    };
    let (found, _) = switches::<4, 2, 4>(&system, [0.1, 0.1, 0.2, 0.2], 4.0);
    let last = found.last().unwrap();
    assert!((last.0 - 2.0).abs() < 1e-9 && last.1 == [Below, Below], "{found:?}");
    // From slip both arrive at once: x = F (1 − cos t), as F sin t = v.
    let (found, _) = switches::<4, 2, 4>(&system, [0.0, 0.0, 0.0, 0.0], 1.0);
    let last = found.last().unwrap();
    assert!((last.0 - 0.4_f64.asin()).abs() < 1e-12 && last.1 == [Sliding; 2], "{found:?}");
}

/// K surfaces in K dimensions that pull towards 0, with couplings and a drift.
fn towards_zero<const K: usize>(coupling: f64) -> Relays<K, K> {
    let mut system = Relays::<K, K>::NONE;
    for i in 0..K {
        system.normals[i][i] = 1.0;
        for j in 0..K {
            system.relays[i][j] = if i == j { -1.0 } else { coupling / (1.0 + (i + 2 * j) as f64) };
        }
        system.constant[i] = 0.05 * (i as f64 - 1.0);
    }
    system
}

/// Three and four surfaces are reached one after the other, and nothing moves any more.
#[test]
fn all_surfaces_are_reached() {
    let (found, end) = switches::<3, 3, 6>(&towards_zero(0.5), [1.0, -0.7, 0.4], 20.0);
    assert_eq!(found.last().unwrap().1, [Sliding; 3], "{found:?}");
    assert!(end.amax() < 1e-14);
    let (found, end) = switches::<4, 4, 8>(&towards_zero(0.5), [1.0, -0.7, 0.4, -0.2], 20.0);
    assert_eq!(found.last().unwrap().1, [Sliding; 4], "{found:?}");
    assert!(end.amax() < 1e-14);
    // The multipliers solve four equations: with a fifth component, they can be read off.
    let mut system = Relays::<5, 4>::NONE;
    let four = towards_zero::<4>(0.5);
    for i in 0..4 {
        system.relays[i] = four.relays[i];
        system.normals[i][i] = 1.0;
        system.constant[i] = four.constant[i];
    }
    system.relays[4] = [1.0, 10.0, 100.0, 1000.0];
    let (_, end) = switches::<5, 4, 8>(&system, [0.0; 5], 1.0);
    let matrix = nalgebra::Matrix4::from_fn(|i, j| four.relays[i][j]);
    let lambda = -matrix.lu().solve(&nalgebra::Vector4::from(four.constant)).unwrap();
    let expected = lambda.dot(&nalgebra::Vector4::new(1.0, 10.0, 100.0, 1000.0));
    assert!((end[4] - expected).abs() < 1e-12 * expected.abs(), "{} {expected}", end[4]);
}

/// Two surfaces that are one: multipliers do not exist, or infinitely many.
#[test]
fn singular_equations_are_refused() {
    let system = Filippov::<_, 2, 4>(Relays::<1, 2> {
        relays: [[-1.0, -1.0]],
        normals: [[1.0], [1.0]],
        ..Relays::NONE
    });
    let y = State::from([0.0]);
    assert_eq!(system.mode((), 0.0, &y), Err(Refusal::Singular));
    let mode = system.mode((), 0.0, &State::from([1.0])).unwrap();
    assert_eq!(refused(ran::<_, 1, 2, 4>(&system, mode, (0.0, [1.0]), 2.0)), Refusal::Singular);
    // Where it crosses both, nothing is singular.
    let system = Filippov::<_, 2, 4>(Relays { constant: [-3.0], ..system.0 });
    let (ended, events) = ran::<_, 1, 2, 4>(&system, mode, (0.0, [1.0]), 2.0);
    assert_eq!(events.last().unwrap().to.sides(), [Below; 2]);
    assert!((ended.unwrap().state[0] + 1.8).abs() < 1e-12);
}

/// y₀′ = −λ₀ + λ₀λ₁.
struct Product;

impl Switched<2, 2, 4> for Product {
    type Mode = ();
    fn field<T: Number>(&self, (): (), signs: &[T; 2], _s: T, _y: &[T; 2]) -> [T; 2] {
        [-signs[0] + signs[0] * signs[1] * 0.1, -signs[1] * 2.0]
    }
    fn surfaces<T: Number>(&self, (): (), _s: T, y: &[T; 2]) -> [T; 2] {
        *y
    }
}

/// A product of two signs is not defined where both surfaces meet.
#[test]
fn a_field_that_is_not_affine_is_refused() {
    let system = Filippov(Product);
    let y = [1.0, 1.0];
    let mode = system.mode((), 0.0, &State::from(y)).unwrap();
    // It slides along the second surface first, alone, where nothing is ambiguous yet.
    let found = ran::<_, 2, 2, 4>(&system, mode, (0.0, y), 2.0);
    assert_eq!(found.1[0].to.sides(), [Above, Sliding]);
    assert_eq!(refused(found), Refusal::NotAffine);
}

/// Where the states spiral away from two surfaces, these are not slid along.
#[test]
fn surfaces_that_repel_are_not_slid_along() {
    let spiral = |pull: f64| {
        Filippov::<_, 2, 4>(Relays::<2, 2> {
            relays: [[-pull, 1.0], [-1.0, -pull]],
            normals: [[1.0, 0.0], [0.0, 1.0]],
            ..Relays::NONE
        })
    };
    let y = State::from([0.0, 0.0]);
    assert_eq!(spiral(0.1).mode((), 0.0, &y).unwrap().sides(), [Sliding; 2]);
    assert_eq!(spiral(-0.1).mode((), 0.0, &y), Err(Refusal::NoSolution));
}
