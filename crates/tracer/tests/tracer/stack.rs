//! Stacks of families whose changes have closed forms.

use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip_tracer::{
    AtlasOptions, Family, FreeRun, Point, Progress, Serial, TraceOptions, Watch, Window,
    regions::VerifyOptions,
    stack::{Change, Effect, MeetingKind, Stack, StackOf, StackOptions},
};

use crate::any::any;
use crate::guards::{Failed, Label, Margin, SQUARE};

/// Guards that depend on a third parameter. Each fires where its function is negative.
struct Moving {
    guards: &'static [fn(&Point, f64) -> f64],
    value: f64,
}

impl Family for Moving {
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        Ok(self.guards.iter().map(|guard| guard(point, self.value) < 0.0).collect())
    }

    fn margin(&self, point: &Point, (margin, _): &Margin) -> Result<Option<f64>, Failed> {
        Ok(Some(self.guards[*margin](point, self.value)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let margins = self.guards.iter().enumerate();
        let value = |guard: &fn(&Point, f64) -> f64| guard(point, self.value);
        let margins = margins.map(|(index, guard)| ((index, Vec::new()), value(guard))).collect();
        Ok(FreeRun { label: self.label(point)?, margins })
    }
}

fn options() -> StackOptions {
    let trace = TraceOptions { noise: 1e-15, ..TraceOptions::default() };
    let verify = VerifyOptions { random_points: 1000, ..VerifyOptions::default() };
    let atlas = AtlasOptions { trace, verify, ..AtlasOptions::default() };
    StackOptions { atlas, ..StackOptions::default() }
}

/// The changes in the square, each of which must be solved for to 1e-9 and lie within its bracket,
/// which is narrow.
fn changes(
    guards: &'static [fn(&Point, f64) -> f64],
    values: &[f64],
    expected: &[(MeetingKind, f64, Point)],
) -> Vec<Change<Vec<bool>>> {
    let family = |value| any(Moving { guards, value });
    let stack = Stack::of(family, &SQUARE, values, &options()).unwrap();
    assert_eq!(stack.changes.len(), expected.len(), "{:?}", stack.changes);
    for (change, (kind, value, point)) in stack.changes.iter().zip(expected) {
        let meeting = change.meeting.unwrap_or_else(|| panic!("no meeting: {change:?}"));
        assert_eq!(meeting.kind, *kind, "{change:?}");
        assert!((meeting.value - value).abs() < 1e-9, "{change:?}, expected {value}");
        assert!((meeting.point - point).norm() < 1e-8, "{change:?}, expected {point}");
        let [low, high] = change.between;
        assert!(low < *value && *value < high && high - low < 1e-3, "{change:?}");
        assert!(!change.doubtful);
        assert_eq!(stack.labels(*value), None);
        assert!(stack.labels(low).is_some() && stack.labels(high).is_some());
        assert_ne!(stack.labels(low), None);
    }
    stack.changes
}

/// A disc of radius 0.3 around (t, 0.05) passes through a disc of radius 0.4 around the origin.
#[test]
fn discs_touch_from_outside_and_from_inside() {
    const DISCS: [fn(&Point, f64) -> f64; 2] = [
        |point, _| point.norm_squared() - 0.16,
        |point, at| (point - Point::new(at, 0.05)).norm_squared() - 0.09,
    ];
    // The centres have the distance √(t² + 0.05²).
    let [outside, inside] = [0.7_f64, 0.1].map(|distance| (distance * distance - 0.0025).sqrt());
    let touch = |at: f64| (MeetingKind::Touch, at, Point::new(at, 0.05).normalize() * 0.4);
    let expected = [-outside, -inside, inside, outside].map(touch);
    let found = changes(&DISCS, &[-0.699, 0.0, 0.699], &expected);
    let [both, second] = [vec![true, true], vec![false, true]];
    assert_eq!(found[0].effects, [Effect::Born(both.clone())]);
    assert_eq!(found[1].effects, [Effect::Dies(second.clone())]);
    assert_eq!(found[2].effects, [Effect::Born(second)]);
    assert_eq!(found[3].effects, [Effect::Dies(both)]);
}

/// A disc of radius √t is born at t = 0, and touches one side of the window after the other.
#[test]
fn a_disc_is_born_and_meets_the_edge() {
    const DISC: [fn(&Point, f64) -> f64; 1] =
        [|point, t| (point - Point::new(0.25, 0.125)).norm_squared() - t];
    let found = changes(
        &DISC,
        &[-0.5, 0.5, 0.7, 0.9],
        &[
            (MeetingKind::Flat, 0.0, Point::new(0.25, 0.125)),
            (MeetingKind::EdgeTouch, 0.75 * 0.75, Point::new(1.0, 0.125)),
            (MeetingKind::EdgeTouch, 0.875 * 0.875, Point::new(0.25, 1.0)),
        ],
    );
    assert_eq!(found[0].effects, [Effect::Born(vec![true])]);
    assert_eq!(found[1].effects, []);
    assert_eq!(found[2].effects, [Effect::Splits(vec![false])]);
}

/// The lines y = 0.3 x, y = −0.5 x and y = 0.1 + t cross at t = −0.1.
#[test]
fn three_lines_pass_through_one_point() {
    const LINES: [fn(&Point, f64) -> f64; 3] = [
        |point, _| point.y - 0.3 * point.x,
        |point, _| point.y + 0.5 * point.x,
        |point, t| point.y - 0.1 - t,
    ];
    let found = changes(&LINES, &[-0.3, 0.1], &[(MeetingKind::Crossing, -0.1, Point::zeros())]);
    let born = Effect::Born(vec![false, false, true]);
    assert_eq!(found[0].effects, [born, Effect::Dies(vec![true, true, false])]);
}

/// The line x = 0.8 y + t passes through a corner at t = 0.2, and crosses the line x = 0.7 − y on
/// the edge at t = 1 + 0.8 · 0.3.
#[test]
fn a_line_passes_through_a_corner_and_a_crossing_leaves() {
    const LINES: [fn(&Point, f64) -> f64; 2] =
        [|point, t| point.x - 0.8 * point.y - t, |point, _| point.x + point.y - 0.7];
    let found = changes(
        &LINES,
        &[0.0, 0.4, 1.6],
        &[
            (MeetingKind::Corner, 0.2, Point::new(1.0, 1.0)),
            (MeetingKind::Edge, 1.24, Point::new(1.0, -0.3)),
        ],
    );
    assert_eq!(found[0].effects, []);
    assert_eq!(found[1].effects, [Effect::Dies(vec![false, false])]);
}

/// The hyperbola x y = t reconnects at t = 0.
#[test]
fn the_branches_of_a_hyperbola_reconnect() {
    const HYPERBOLA: [fn(&Point, f64) -> f64; 1] = [|point, t| point.x * point.y - t];
    let found = changes(&HYPERBOLA, &[-0.2, 0.3], &[(MeetingKind::Flat, 0.0, Point::zeros())]);
    assert_eq!(found[0].effects, [Effect::Merge(vec![true]), Effect::Splits(vec![false])]);
}

/// What no conditions explain is a bracket: the guard jumps.
#[test]
fn a_jump_is_a_bracket() {
    const JUMP: [fn(&Point, f64) -> f64; 1] =
        [|point, t| point.norm_squared() - if t < 0.3 { 0.2 } else { 1.5 }];
    let stack =
        Stack::of(|value| any(Moving { guards: &JUMP, value }), &SQUARE, &[0.1, 0.6], &options())
            .unwrap();
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    let [low, high] = change.between;
    assert!(change.meeting.is_none() && !change.doubtful);
    assert!(stack.objection().unwrap().starts_with("nothing is known"));
    assert!(low < 0.3 && 0.3 <= high && high - low <= 1e-5 * high, "{change:?}");
    assert_eq!(stack.labels(0.2), Some(vec![vec![false], vec![true]]));
    assert_eq!(stack.labels(0.5).unwrap().len(), 5);
    assert_eq!(stack.labels(0.61), None);
}

/// A disc that dies at t = 1, and whose runs do not see it for some time before: so it is with
/// regions that are too small.
struct Unseen {
    value: f64,
    /// The square of the radius at t = 0.
    area: f64,
    seen_until: f64,
}

impl Family for Unseen {
    type Label = bool;
    type Margin = ();
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<bool, Failed> {
        Ok(self.value < self.seen_until && self.margin(point, &())?.is_some_and(|it| it < 0.0))
    }

    fn margin(&self, point: &Point, (): &()) -> Result<Option<f64>, Failed> {
        Ok(Some((point - Point::new(0.25, 0.125)).norm_squared() - self.area * (1.0 - self.value)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<bool, ()>, Failed> {
        let margin = self.margin(point, &())?.filter(|_| self.value < self.seen_until);
        let margins = margin.into_iter().map(|value| ((), value)).collect();
        Ok(FreeRun { label: self.label(point)?, margins })
    }
}

#[test]
fn the_cause_of_a_change_may_lie_beside_it() {
    let found = |area, seen_until| {
        let family = |value| any(Unseen { value, area, seen_until });
        Stack::of(family, &SQUARE, &[0.5, 1.5], &options()).unwrap()
    };
    let stack = found(1e-8, 0.998);
    assert_eq!(stack.objection(), None);
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    let meeting = change.meeting.unwrap();
    assert_eq!(meeting.kind, MeetingKind::Flat);
    assert!((meeting.value - 1.0).abs() < 1e-9, "{meeting:?}");
    let [low, high] = change.between;
    assert!(0.998 - 1e-5 < low && low < 0.998 && 1.0 < high && high < 1.001, "{change:?}");
    assert_eq!(change.effects, [Effect::Dies(true)]);
    // The other way round, it is born.
    let family = |value| any(Unseen { value: 2.0 - value, area: 1e-8, seen_until: 0.998 });
    let stack = Stack::of(family, &SQUARE, &[0.5, 1.5], &options()).unwrap();
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    assert!((change.meeting.unwrap().value - 1.0).abs() < 1e-9, "{change:?}");
    let [low, high] = change.between;
    assert!(0.999 < low && low < 1.0 && (high - 1.002).abs() < 2e-5, "{change:?}");
    // These are too far away to be the cause, and too large to be overlooked.
    for (area, seen_until) in [(1e-8, 0.99), (0.1, 0.998)] {
        let stack = found(area, seen_until);
        let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
        assert_eq!(change.meeting, None);
    }
}

/// A jump at t = 0, where a bracket cannot be narrow relative to its ends.
#[test]
fn a_jump_at_zero_is_a_bracket() {
    const JUMP: [fn(&Point, f64) -> f64; 1] =
        [|point, t| point.norm_squared() - if t < 0.0 { 0.2 } else { 1.5 }];
    let family = |value| any(Moving { guards: &JUMP, value });
    let stack = Stack::of(family, &SQUARE, &[-1.0, 1.0], &options()).unwrap();
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    let [low, high] = change.between;
    assert!(low < 0.0 && 0.0 <= high && high - low < 1e-11, "{change:?}");
    assert!(stack.atlases < 200, "{}", stack.atlases);
}

/// So few atlases do not isolate the birth, and the bracket that is left is in doubt.
#[test]
fn a_stack_of_few_atlases_is_in_doubt() {
    const DISC: [fn(&Point, f64) -> f64; 1] = [|point, t| point.norm_squared() - t];
    let family = |value| any(Moving { guards: &DISC, value });
    for atlases in [2, 3] {
        let few = StackOptions { atlases, ..options() };
        let stack = Stack::of(family, &SQUARE, &[-0.5, 0.5], &few).unwrap();
        assert!(stack.finished && stack.atlases <= atlases);
        let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
        assert!(change.doubtful);
        assert!(stack.objection().is_some());
    }
}

/// Close beside a corner that a line passes through, nothing tells that this is the cause.
#[test]
fn a_change_without_atlases_beside_it_is_in_doubt() {
    const LINE: [fn(&Point, f64) -> f64; 1] = [|point, t| point.x - 0.8 * point.y - t];
    let family = |value| any(Moving { guards: &LINE, value });
    let few = StackOptions { atlases: 2, ..options() };
    let stack = Stack::of(family, &SQUARE, &[0.19992, 0.20008], &few).unwrap();
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    assert!(change.doubtful && stack.atlases == 2);
}

/// A birth that is seen late, and a label that is another one for a while in between: the bracket
/// of the birth holds all three changes, which are one in doubt.
#[test]
fn brackets_that_overlap_are_one() {
    struct Both {
        late: Unseen,
        on: bool,
    }

    impl Family for Both {
        type Label = [bool; 2];
        type Margin = ();
        type Error = Failed;

        fn label(&self, point: &Point) -> Result<[bool; 2], Failed> {
            Ok([self.late.label(point)?, self.on])
        }

        fn margin(&self, point: &Point, (): &()) -> Result<Option<f64>, Failed> {
            self.late.margin(point, &())
        }

        fn free_run(&self, point: &Point) -> Result<FreeRun<[bool; 2], ()>, Failed> {
            let margins = self.late.free_run(point)?.margins;
            Ok(FreeRun { label: self.label(point)?, margins })
        }
    }

    let family = |value: f64| {
        let late = Unseen { value: 2.0 - value, area: 1e-8, seen_until: 0.998 };
        any(Both { late, on: (1.0006..1.0012).contains(&value) })
    };
    let stack = Stack::of(family, &SQUARE, &[0.9, 1.1], &options()).unwrap();
    let [change] = &stack.changes[..] else { panic!("{:?}", stack.changes) };
    assert!(change.doubtful);
    assert!((change.meeting.unwrap().value - 1.0).abs() < 1e-9, "{change:?}");
    let [low, high] = change.between;
    assert!(0.999 < low && low < 1.0 && (high - 1.002).abs() < 2e-5, "{change:?}");
    assert_eq!(change.effects, [Effect::Born([true, false])]);
}

/// Newton's method asks for margins close to the window only.
#[test]
fn margins_are_asked_for_near_the_window() {
    struct Bounded(Moving);

    impl Bounded {
        fn check(point: &Point) {
            let beyond = point.amax() - 1.0;
            assert!(beyond < 0.0201, "{point:?}");
        }
    }

    impl Family for Bounded {
        type Label = Label;
        type Margin = Margin;
        type Error = Failed;

        fn label(&self, point: &Point) -> Result<Label, Failed> {
            Self::check(point);
            self.0.label(point)
        }

        fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, Failed> {
            Self::check(point);
            self.0.margin(point, margin)
        }

        fn moved(&self, point: &Point, margin: &Margin) -> Result<Margin, Failed> {
            Self::check(point);
            Ok(margin.clone())
        }

        fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
            Self::check(point);
            self.0.free_run(point)
        }
    }

    const CURVES: [fn(&Point, f64) -> f64; 2] = [
        |point, t| (point - Point::new(0.7, 0.1)).norm_squared() - t,
        |point, t| point.y - 0.9 * t - 0.3 * point.x * point.x,
    ];
    let family = |value| any(Bounded(Moving { guards: &CURVES, value }));
    let stack = Stack::of(family, &SQUARE, &[-0.2, 0.05, 0.85], &options()).unwrap();
    assert_eq!(stack.objection(), None);
    assert!(stack.changes.len() > 3, "{:?}", stack.changes);
}

/// A disc that is born at t = 0, in a stack that ends when it has been asked so often whether to go
/// on; and the steps that begin and that are done.
fn asked(patience: usize) -> (StackOf<Moving>, [usize; 2]) {
    const DISC: [fn(&Point, f64) -> f64; 1] = [|point, t| point.norm_squared() - t];
    let (asked, begun, done) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
    let report = |progress: Progress| {
        match progress {
            Progress::Begin { steps } => begun.fetch_add(steps, Ordering::Relaxed),
            Progress::Advance { steps } => done.fetch_add(steps, Ordering::Relaxed),
            Progress::Now { .. } => 0,
        };
    };
    // It says so only once.
    let cancelled = || asked.fetch_add(1, Ordering::Relaxed) == patience;
    let watch = Watch::from(&report).cancelled_by(&cancelled);
    let family = |value| any(Moving { guards: &DISC, value });
    let values = [-0.5, 0.25, 0.5];
    let stack = Stack::watched(family, &SQUARE, &values, &options(), Serial, watch).unwrap();
    (stack, [begun, done].map(AtomicUsize::into_inner))
}

#[test]
fn a_stack_is_watched_and_cancelled() {
    let (whole, [begun, done]) = asked(usize::MAX);
    assert!(whole.finished && whole.objection().is_none());
    assert_eq!([begun, done], [whole.atlases; 2]);
    let [change] = &whole.changes[..] else { panic!("{:?}", whole.changes) };
    let mut seen = [false; 3];
    for patience in (0..20_000).step_by(500) {
        let (part, [begun, done]) = asked(patience);
        if part.finished {
            assert_eq!((&part.changes, part.atlases), (&whole.changes, whole.atlases));
            continue;
        }
        assert_eq!(part.objection().as_deref(), Some("it is not finished"));
        assert!(done <= begun && part.layers.len() <= 3);
        assert!(part.layers.iter().all(|layer| layer.atlas.agrees()));
        for other in &part.changes {
            assert!(other == change || other.doubtful, "{other:?}");
        }
        seen[part.changes.len() + usize::from(part.layers.len() == 3)] = true;
    }
    assert_eq!(seen, [true; 3]);
}

/// Values have to ascend.
#[test]
fn values_are_checked() {
    const LINE: [fn(&Point, f64) -> f64; 1] = [|point, t| point.x - t];
    let stack = |values: &[f64]| {
        let window = Window { low: Point::zeros(), high: Point::new(1.0, 1.0) };
        Stack::of(|value| any(Moving { guards: &LINE, value }), &window, values, &options())
    };
    for values in [&[][..], &[0.5], &[0.5, 0.5], &[0.5, 0.2], &[0.1, f64::NAN]] {
        assert!(stack(values).is_err(), "{values:?}");
    }
    let wide = StackOptions { width: 0.5, ..options() };
    let family = |value| any(Moving { guards: &LINE, value });
    assert!(Stack::of(family, &SQUARE, &[0.1, 0.2], &wide).is_err());
}
