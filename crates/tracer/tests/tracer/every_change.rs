//! One family for each way in which a sequence of switches can change. Every change happens where
//! h = y − x² vanishes.

use stickslip_solver::margin::Place;
use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};
use stickslip_tracer::{
    Point, TraceOptions, Window,
    hybrid::{HybridFamily, Itinerary, Problem},
    trace,
};

use crate::any::{any, any_system};

const WINDOW: Window = Window { low: Point::new(-0.5, -0.15), high: Point::new(0.45, 0.4) };
const OFF: Guard = Guard::OFF;
const BELOW: Guard = Guard::new(Direction::Below);
const FALLING: Guard = Guard::new(Direction::Falling);
const RISING: Guard = Guard::new(Direction::Rising);
const EITHER: Guard = Guard::new(Direction::Either);

/// A clock with guards that depend on h. Its mode is the number of switches so far.
#[derive(Clone, Copy)]
struct Clock {
    h: f64,
    /// The guards of each mode.
    guards: fn(usize) -> [Guard; 2],
    /// Their values at a time, in a mode.
    values: fn(f64, f64, usize) -> [f64; 2],
    /// The mode after the first one, and the condition of that transition.
    next: fn(f64) -> (usize, f64),
}

impl HybridSystem<1, 2> for Clock {
    type Mode = usize;

    fn field(&self, _: usize, _s: f64, _: &State<1>) -> State<1> {
        State::from([1.0])
    }
    fn guards(&self, mode: usize) -> [Guard; 2] {
        (self.guards)(mode)
    }
    fn guard_values(&self, mode: usize, s: f64, _: &State<1>) -> [f64; 2] {
        (self.values)(s, self.h, mode)
    }
    fn transition(&self, mode: usize, _: usize, _s: f64, y: &State<1>) -> (usize, State<1>) {
        (if mode == 0 { (self.next)(self.h).0 } else { mode + 1 }, *y)
    }
    fn transition_condition(&self, mode: usize, _: usize, _s: f64, _: &State<1>) -> f64 {
        if mode == 0 { (self.next)(self.h).1 } else { f64::NAN }
    }
}

/// Asserts that the sequence changes where h = 0, from `below` to `above`, at a margin of this
/// place.
fn changes(clock: Clock, [below, above]: [&[usize]; 2], is_place: fn(&Place) -> bool) {
    let problem = move |point: &Point| {
        let h = point.y - point.x * point.x;
        (any_system(Clock { h, ..clock }), Start { mode: 0, s: 0.0, state: State::from([0.0]) })
    };
    let options = Options { rtol: 1e-13, atol: 1e-13, max_step: 0.25, ..Options::default() };
    let family = any(HybridFamily { problem, method: Dop853, options, end: 2.0 });
    let network = trace(&family, &WINDOW, &TraceOptions::default()).expect("a trace");
    assert_eq!(network.unresolved, []);
    let [curve] = &network.curves[..] else { panic!("{:?}", network.curves) };
    assert!(is_place(&curve.margin.place), "{:?}", curve.margin);
    for node in &curve.nodes {
        let h = node.point.y - node.point.x * node.point.x;
        assert!(h.abs() < 2e-12, "{h:e} at {:?}", node.point);
    }
    // Seen along the curve, h is positive on the side to which x grows to the left.
    let [left, right] = curve.sides.clone();
    let rightwards = curve.nodes[0].tangent.x > 0.0;
    let sides = if rightwards { [right, left] } else { [left, right] };
    assert_eq!(sides, [below, above].map(|guards| Itinerary::Fires(guards.to_vec())));
}

fn starts(place: &Place) -> bool {
    matches!(place, Place::Start { .. })
}

fn onwards(_: f64) -> (usize, f64) {
    (1, f64::NAN)
}

fn only_first(guard: Guard, mode: usize) -> [Guard; 2] {
    if mode == 0 { [guard, OFF] } else { [OFF, OFF] }
}

/// A clock that starts where h is not negative.
struct Above;

impl Problem<1, 2> for Above {
    type System = Clock;

    fn at(&self, point: &Point) -> (Clock, Start<usize, 1>) {
        let h = point.y - point.x * point.x;
        let (guards, next) = (|_| [OFF, OFF], onwards);
        let clock = Clock { h, guards, values: |_, _, _| [1.0; 2], next };
        (clock, Start { mode: 0, s: 0.0, state: State::from([h.sqrt()]) })
    }
    fn conditions(&self, point: &Point) -> Vec<f64> {
        vec![1.0 - point.x, point.y - point.x * point.x]
    }
}

#[test]
fn a_start_that_exists_under_conditions() {
    let options = Options::with_tolerance(1e-13);
    let family = any(HybridFamily { problem: Above, method: Dop853, options, end: 2.0 });
    let network = trace(&family, &WINDOW, &TraceOptions::default()).expect("a trace");
    assert_eq!(network.unresolved, []);
    let [curve] = &network.curves[..] else { panic!("{:?}", network.curves) };
    assert_eq!((curve.margin.place, curve.margin.guard), (Place::Condition, 1));
    for node in &curve.nodes {
        assert!((node.point.y - node.point.x * node.point.x).abs() < 2e-12, "{node:?}");
    }
    let mut sides = curve.sides.clone();
    sides.sort();
    assert_eq!(sides, [Itinerary::Fires(Vec::new()), Itinerary::NoStart(1)]);
}

#[test]
fn two_guards_that_swap_their_order() {
    let clock = Clock {
        h: 0.0,
        guards: |mode| if mode < 2 { [BELOW, BELOW] } else { [OFF, OFF] },
        // A guard that has fired does not fire again.
        values: |s, h, mode| match mode {
            0 => [1.0 + 0.2 * h - s, 1.0 - 0.1 * h - s],
            _ if h > 0.0 => [1.0 + 0.2 * h - s, 1.0],
            _ => [1.0, 1.0 - 0.1 * h - s],
        },
        next: onwards,
    };
    changes(clock, [&[0, 1], &[1, 0]], |place| matches!(place, Place::Exit(_)));
}

#[test]
fn a_guard_that_is_negative_at_the_start_of_the_run() {
    let below = Clock {
        h: 0.0,
        guards: |mode| only_first(BELOW, mode),
        values: |s, h, _| [h + s, 1.0],
        next: onwards,
    };
    changes(below, [&[0], &[]], starts);
    let rising = Clock { guards: |mode| only_first(RISING, mode), ..below };
    changes(rising, [&[0], &[]], starts);
    let falling =
        Clock { guards: |mode| only_first(FALLING, mode), values: |s, h, _| [h - s, 1.0], ..below };
    changes(falling, [&[], &[0]], starts);
}

#[test]
fn a_guard_that_is_negative_where_a_phase_begins() {
    let clock = Clock {
        h: 0.0,
        guards: |mode| match mode {
            0 => [BELOW, OFF],
            1 => [OFF, BELOW],
            _ => [OFF, OFF],
        },
        values: |s, h, _| [1.0 - s, h + 2.0 * (s - 1.0)],
        next: onwards,
    };
    changes(clock, [&[0, 1], &[0]], starts);
}

#[test]
fn a_guard_that_leaves_zero_upwards_or_downwards() {
    let clock = Clock {
        h: 0.0,
        guards: |mode| only_first(BELOW.from_zero(1), mode),
        values: |s, h, _| [s * (h + s), 1.0],
        next: onwards,
    };
    changes(clock, [&[0], &[]], starts);
    let double = Clock {
        guards: |mode| only_first(BELOW.from_zero(2), mode),
        values: |s, h, _| [s * s * (h + s), 1.0],
        ..clock
    };
    changes(double, [&[0], &[]], starts);
}

#[test]
fn grazes_from_either_side() {
    let dip = Clock {
        h: 0.0,
        guards: |mode| only_first(BELOW, mode),
        values: |s, h, _| [(s - 1.0) * (s - 1.0) + h, 1.0],
        next: onwards,
    };
    changes(dip, [&[0], &[]], |place| matches!(place, Place::Minimum { .. }));
    // It falls and rises again: at the second zero it fires.
    let from_above = Clock { guards: |mode| only_first(RISING, mode), ..dip };
    changes(from_above, [&[0], &[]], |place| matches!(place, Place::Maximum { .. }));
    let either = Clock { guards: |mode| only_first(EITHER, mode), ..dip };
    changes(either, [&[0], &[]], |place| matches!(place, Place::Minimum { .. }));
    let bump: fn(f64, f64, usize) -> [f64; 2] = |s, h, _| [h - (s - 1.0) * (s - 1.0), 1.0];
    let rising = Clock { guards: |mode| only_first(RISING, mode), values: bump, ..dip };
    changes(rising, [&[], &[0]], |place| matches!(place, Place::Minimum { .. }));
    let either = Clock { guards: |mode| only_first(EITHER, mode), values: bump, ..dip };
    changes(either, [&[], &[0]], |place| matches!(place, Place::Maximum { .. }));
    let falling = Clock { guards: |mode| only_first(FALLING, mode), values: bump, ..dip };
    changes(falling, [&[], &[0]], |place| matches!(place, Place::Maximum { .. }));
}

/// An event that changes nothing, and goes on from its zero.
#[test]
fn a_second_graze_of_a_guard_that_goes_on() {
    let clock = Clock {
        h: 0.0,
        guards: |_| [EITHER, OFF],
        // It falls through zero at 0.5 and touches it from below at 1.3.
        values: |s, h, _| [(0.5 - s) * ((s - 1.3) * (s - 1.3) + h), 1.0],
        next: |_| (0, f64::NAN),
    };
    changes(clock, [&[0, 0, 0], &[0]], |place| {
        matches!(place, Place::Minimum { .. } | Place::Maximum { .. })
    });
}

#[test]
fn the_graze_of_a_terminal_guard() {
    let clock = Clock {
        h: 0.0,
        guards: |mode| if mode == 0 { [BELOW.terminal(), BELOW] } else { [OFF, OFF] },
        values: |s, h, _| [(s - 1.0) * (s - 1.0) + h, 1.5 - s],
        next: onwards,
    };
    changes(clock, [&[], &[1]], |place| matches!(place, Place::Minimum { .. }));
}

/// A guard that ends the run when it fires for the second time.
#[test]
fn the_graze_of_a_guard_that_ends_the_run_later() {
    let clock = Clock {
        h: 0.0,
        guards: |mode| match mode {
            0 | 1 => [BELOW.terminal_after(2), BELOW],
            _ => [OFF, OFF],
        },
        values: |s, h, mode| match mode {
            0 => [0.5 - s, 2.0],
            _ => [(s - 1.0) * (s - 1.0) + h, 1.5 - s],
        },
        next: onwards,
    };
    changes(clock, [&[0], &[0, 1]], |place| matches!(place, Place::Minimum { .. }));
}

#[test]
fn a_transition_that_branches() {
    let clock = Clock {
        h: 0.0,
        guards: |mode| match mode {
            0 => [BELOW, OFF],
            1 => [OFF, BELOW],
            _ => [OFF, OFF],
        },
        values: |s, _, _| [1.0 - s, 1.5 - s],
        next: |h| (if h > 0.0 { 1 } else { 2 }, h),
    };
    changes(clock, [&[0], &[0, 1]], |place| matches!(place, Place::Branch(_)));
}

#[test]
fn a_guard_at_the_end_of_the_run() {
    for guard in [BELOW, FALLING, EITHER] {
        let guards: fn(usize) -> [Guard; 2] = match guard.direction() {
            Direction::Below => |mode| only_first(BELOW, mode),
            Direction::Falling => |mode| only_first(FALLING, mode),
            _ => |mode| only_first(EITHER, mode),
        };
        let clock = Clock { h: 0.0, guards, values: |s, h, _| [2.0 + h - s, 1.0], next: onwards };
        changes(clock, [&[0], &[]], |place| *place == Place::End);
    }
}
