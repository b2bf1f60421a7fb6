//! How fast a guard changes, known or by differences, and what of that is rounding.
//!
//! If a system does not know its rates, they are replaced by differences. The reach of these
//! differences is a small part of the longest step so far. Error control knows the scale on which
//! the solution changes, so this works in any unit of time.
//!
//! A rate whose sign may be rounding says nothing. For a readable system the rate is enclosed, with
//! a state and a time that are known up to their last digit, so that this is decided. A black box
//! has no bounds: the effect of one rounding of each value is known, and noise beyond that is
//! measured where a step starts. It shows in differences of sixth order: along the solution, and
//! where all components move by some tolerances, since a state at rest rounds nothing.

use std::cell::{Cell, RefCell};

use stickslip_number::Interval;

use crate::events::isolate::noise;
use crate::method::control::first_step_of;
use crate::method::{Method, StepOf, Store, TrialOf};
use crate::options::{Options, StepSize};
use crate::system::{Room, System};

/// The part of a step over which differences reach. Its fourth power makes an error of 1e-11 of a
/// rate, and rounding one of some 1e-13.
const REACH: f64 = 1.0 / 256.0;

/// The length of the row of states along which noise is measured, in tolerances. They are 16 and 4
/// tolerances apart.
const TOLERANCES: f64 = 512.0;

/// The rounding of a guard or of its rate, relative to it; the rounding of time is a sixteenth.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A rate that exceeds its bounds where the step starts by this factor is no rounding, and need not
/// be enclosed.
const CLEAR: f64 = 1e10;

/// Nor is it then if it is at least this part of the largest rate on the step: the bounds may be
/// tiny where a state starts from rest.
const PART: f64 = 1e-5;

/// The bounds of the rate of a guard where a step starts.
#[derive(Clone, Copy)]
struct EnclosedStart<Mode> {
    guard: (Mode, usize),
    width: f64,
    /// The largest rate on the step so far.
    largest: f64,
}

/// The reach of the differences that replace unknown rates, and the noise of rates.
pub(super) struct Reach<S: System> {
    /// The start of the present step, NaN before the first one.
    start: Cell<f64>,
    /// The distance over which the differences reach.
    distance: Cell<f64>,
    /// The largest noise of the rate that was measured.
    noise: Cell<f64>,
    /// The guard whose rate was enclosed where the present step starts.
    enclosed: Cell<Option<EnclosedStart<S::Mode>>>,
    room: RefCell<Room<S>>,
}

impl<S: System> Reach<S> {
    /// The reach for the first step of a run.
    pub fn new<M: Method>(
        system: &S,
        (mode, s, y): (S::Mode, f64, &S::State),
        end: f64,
        options: &Options,
    ) -> Self {
        let mut room = Room::new(y.size());
        let longest = (end - s).min(options.max_step);
        let first = match (options.step_size, options.first_step) {
            (StepSize::Fixed(h), _) | (_, Some(h)) => h.min(longest),
            _ => {
                let mut field =
                    |s: f64, y: &S::State, slope: &mut S::State| system.field(mode, s, y, slope);
                let [mut slope, mut moved, mut other] = [(); 3].map(|()| room.state());
                field(s, y, &mut slope);
                let tolerances = (options.rtol, options.atol);
                let rooms = (&mut moved, &mut other);
                first_step_of::<M, _>(&mut field, (s, y, &slope), tolerances, longest, rooms)
            }
        };
        Self {
            start: Cell::new(f64::NAN),
            distance: Cell::new(REACH * first),
            noise: Cell::new(0.0),
            enclosed: Cell::new(None),
            room: RefCell::new(room),
        }
    }

    /// Adapts the reach to the step before, which was accepted up to `s`, where a step now starts.
    /// Returns whether that is a new place.
    pub fn follow(&self, s: f64) -> bool {
        let distance = REACH * (s - self.start.replace(s));
        // It changes seldom, so that rates seldom change between two steps.
        if distance >= 2.0 * self.distance.get() {
            self.distance.set(distance);
        }
        // True of NaN.
        distance != 0.0
    }

    /// Measures the noise of the rate of a guard where the step `trial` starts: along the solution,
    /// and where each component moves by a few tolerances, since a state at rest does not move and
    /// rounds nothing. The noise only grows, and seldom, so that it seldom changes between two
    /// steps.
    pub fn measure(&self, system: &S, at: (S::Mode, usize), trial: &TrialOf<'_, S::State>) {
        let &TrialOf { s, y, slope, tolerances: (rtol, atol), .. } = trial;
        let bounds = enclosed_rate(system, at, (s, y));
        self.enclosed.set(bounds.map(|bounds| EnclosedStart {
            guard: at,
            width: bounds.width(),
            largest: bounds.upper().abs(),
        }));
        if bounds.is_some() {
            return;
        }
        let room = &mut *self.room.borrow_mut();
        let (mut moved, mut tolerance) = (room.state(), room.state());
        S::State::each(&mut tolerance, [y], |_, [y]| atol + rtol * y.abs());
        let reach = self.distance.get();
        let knows = !known_rate(system, room, at, (s, y)).is_nan();
        let unit = if knows { 1.0 } else { reach };
        let known = self.noise.get();
        let mut along = |direction: &S::State, by: f64, time: f64| {
            let mut value = |part: f64| {
                S::State::shifted(&mut moved, y, direction, part * by);
                let s = s + part * time;
                if knows {
                    known_rate(system, room, at, (s, &moved))
                } else {
                    room.value(system, at, s, &moved)
                }
            };
            let measured = noise(&mut value, 0.0, 1.0, [0.0]) / unit;
            // A kink passes for noise at one place, but not at another one.
            if measured > known {
                measured.min(noise(&mut value, 0.0, 1.0, [0.5]) / unit)
            } else {
                0.0
            }
        };
        let measured = along(slope, reach, reach).max(along(&tolerance, TOLERANCES, 0.0));
        room.give(moved);
        room.give(tolerance);
        if measured > known {
            self.noise.set(2.0 * measured);
        }
    }

    /// A reach that is small for the solution through `y`: there, a step of its length is good
    /// enough.
    fn shortened<M: Method>(
        &self,
        system: &S,
        (mode, options): (S::Mode, &Options),
        (s, y): (f64, &S::State),
    ) -> Self {
        let n = y.size();
        let (rest, mut slope) = (S::State::room(n), S::State::room(n));
        system.field(mode, s, y, &mut slope);
        let tolerances = (options.rtol, options.atol);
        let mut step = StepOf::new(n);
        let mut h = self.distance.get() / REACH;
        // More would be below the rounding of any time.
        for _ in 0..50 {
            let trial = TrialOf { s, y, rest: &rest, slope: &slope, h, tolerances };
            system.step::<M>(mode, &trial, &mut step);
            if step.error < 1.0 {
                break;
            }
            h *= 0.25;
        }
        Self {
            start: Cell::new(f64::NAN),
            distance: Cell::new(REACH * h),
            noise: Cell::new(0.0),
            enclosed: Cell::new(None),
            room: RefCell::new(Room::new(n)),
        }
    }

    /// The rate of a guard, by differences if it is not known.
    pub fn rate(&self, system: &S, at: (S::Mode, usize), place: (f64, &S::State)) -> f64 {
        self.rate_and(system, at, place, |_| 0.0).0
    }

    /// The rate of a guard, and the part of it that may be rounding.
    pub fn rate_and_rounding(
        &self,
        system: &S,
        at: (S::Mode, usize),
        place: (f64, &S::State),
    ) -> (f64, f64) {
        self.rate_and(system, at, place, |known| {
            if let Some(start) = self.enclosed.get().filter(|start| start.guard == at) {
                let largest = start.largest.max(known.abs());
                self.enclosed.set(Some(EnclosedStart { largest, ..start }));
                if known.abs() > (CLEAR * start.width).max(PART * largest) {
                    return start.width;
                }
            }
            let bounds = enclosed_rate(system, at, place);
            let most = |bounds: Interval| (bounds.upper() - known).max(known - bounds.lower());
            bounds.map_or_else(|| self.noise.get(), most)
        })
    }

    /// The rate of a guard, and the part of it that may be rounding, which a function returns for a
    /// rate that is known.
    fn rate_and(
        &self,
        system: &S,
        at: (S::Mode, usize),
        (s, y): (f64, &S::State),
        rounding: impl Fn(f64) -> f64,
    ) -> (f64, f64) {
        let room = &mut *self.room.borrow_mut();
        let known = known_rate(system, room, at, (s, y));
        if !known.is_nan() {
            return (known, rounding(known));
        }
        let reach = self.distance.get();
        let (mut slope, mut moved) = (room.state(), room.state());
        system.field(at.0, s, y, &mut slope);
        let mut largest = 0.0_f64;
        let value = |reach: f64| {
            S::State::shifted(&mut moved, y, &slope, reach);
            let value = room.value(system, at, s + reach, &moved);
            largest = largest.max(value.abs());
            value
        };
        let rate = fourth_order(value, reach);
        room.give(slope);
        room.give(moved);
        (rate, (ROUNDING * largest / reach).max(self.noise.get()))
    }

    /// The derivative of the rate of a guard, by differences along steps of the method.
    fn bend<M: Method>(&self, system: &S, at: (S::Mode, usize), (s, y): (f64, &S::State)) -> f64 {
        let n = y.size();
        let (rest, mut slope) = (S::State::room(n), S::State::room(n));
        system.field(at.0, s, y, &mut slope);
        let mut step = StepOf::new(n);
        let rate = |h: f64| {
            let tolerances = (1.0, 1.0);
            let trial = TrialOf { s, y, rest: &rest, slope: &slope, h, tolerances };
            system.step::<M>(at.0, &trial, &mut step);
            self.rate(system, at, (s + h, &step.y1))
        };
        // Of the differences of differences, rounding is the greater part of the error.
        fourth_order(rate, 8.0 * self.distance.get())
    }
}

/// Bounds of the rate of a guard whose system is readable, except at jumps.
fn enclosed_rate<S: System>(
    system: &S,
    (mode, guard): (S::Mode, usize),
    (s, y): (f64, &S::State),
) -> Option<Interval> {
    let bounds = S::READABLE.then(|| system.enclose_rate(mode, s, y, guard));
    bounds.filter(|bounds| bounds.is_bounded())
}

/// The rate of a guard, NaN if the system does not know it.
fn known_rate<S: System>(
    system: &S,
    room: &mut Room<S>,
    (mode, guard): (S::Mode, usize),
    (s, y): (f64, &S::State),
) -> f64 {
    let mut rates = room.row();
    system.guard_rates(mode, s, y, &mut rates);
    let rate = rates[guard];
    room.give_row(rates);
    rate
}

/// A derivative of a guard along the solution, up to a positive factor; `None` for the third one
/// and higher ones.
pub(super) fn derivative<M: Method, S: System>(
    system: &S,
    reach: &Reach<S>,
    (mode, options): (S::Mode, &Options),
    (guard, derivative): (usize, u32),
    place: (f64, &S::State),
) -> Option<f64> {
    let at = (mode, guard);
    let good = || reach.shortened::<M>(system, (mode, options), place);
    match derivative {
        0 => Some(reach.room.borrow_mut().value(system, at, place.0, place.1)),
        1 => Some(good().rate(system, at, place)),
        2 => Some(good().bend::<M>(system, at, place)),
        _ => None,
    }
}

/// The derivative of `at` at 0, by a difference of fourth order.
fn fourth_order(mut at: impl FnMut(f64) -> f64, reach: f64) -> f64 {
    let near = at(reach) - at(-reach);
    let far = at(2.0 * reach) - at(-2.0 * reach);
    (8.0 * near - far) / (12.0 * reach)
}
