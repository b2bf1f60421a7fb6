//! Random systems whose events have exact times.
//!
//! Slopes are constant and rational, guards are monotone functions of linear forms, and numbers are
//! multiples of [`UNIT`]⁻¹ with exact arithmetic. So it is known which events coincide.

use stickslip_solver::dynamic::{DynamicSystem, ReadableDynamic};
use stickslip_solver::{
    Direction, Guard, HybridSystem, Number, ReadableSystem, Schedule, State, Times,
};

/// A number in multiples of 1/[`UNIT`].
pub type Exact = i128;

/// 2⁶⁶ [`ODD`]: times are divided by slopes that have the factors 2, 3 and 5.
pub const UNIT: Exact = ODD << 66;

/// 3¹⁰ 5⁴.
const ODD: Exact = 59_049 * 625;

/// Components that have constant slopes. One more makes the steps short, or does nothing.
pub const LINEAR: usize = 3;
pub const N: usize = LINEAR + 1;
/// The largest number of guards.
pub const G: usize = 6;

/// The nearest double, up to one rounding; exact if the number has 53 bits.
pub fn double(exact: Exact) -> f64 {
    let power = 2.0_f64.powi(-66);
    if exact % ODD == 0 { (exact / ODD) as f64 * power } else { exact as f64 / ODD as f64 * power }
}

/// `quarters`/4 times a number, if it is a multiple of 1/[`UNIT`].
pub fn times(exact: Exact, quarters: i128) -> Option<Exact> {
    let product = exact.checked_mul(quarters)?;
    (product % 4 == 0).then_some(product / 4)
}

/// What a guard does to the linear form on which it depends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    Linear,
    /// x + x³/64
    Cubic,
    /// exp(x/8) − 1
    Exponential,
    /// tan⁻¹(x/4)
    ArcTangent,
}

/// A guard's function: a shape of the linear form Σ aᵢyᵢ + bs − c, times a power of two.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    pub components: [i8; LINEAR],
    pub time: i8,
    pub level: Exact,
    pub shape: Shape,
    pub scale: i32,
}

impl Function {
    pub fn form(&self, s: Exact, y: &[Exact; LINEAR]) -> Exact {
        let sum: Exact = (0..LINEAR).map(|i| Exact::from(self.components[i]) * y[i]).sum();
        sum + Exact::from(self.time) * s - self.level
    }

    /// The slope of the form in quarters, where those of the components are `slopes`.
    pub fn slope(&self, slopes: &[i8; LINEAR]) -> i128 {
        let sum: i32 =
            (0..LINEAR).map(|i| i32::from(self.components[i]) * i32::from(slopes[i])).sum();
        i128::from(sum + 4 * i32::from(self.time))
    }

    /// Whether both are the same, up to the sign.
    fn is(&self, other: &Self) -> bool {
        let opposite = Self {
            components: other.components.map(|factor| -factor),
            time: -other.time,
            level: -other.level,
            ..other.clone()
        };
        self == other || self.shape != Shape::Exponential && *self == opposite
    }

    /// The sum of the absolute terms of the form.
    pub fn size(&self, s: Exact, y: &[Exact; LINEAR]) -> f64 {
        let sum: f64 =
            (0..LINEAR).map(|i| f64::from(self.components[i]).abs() * double(y[i]).abs()).sum();
        sum + f64::from(self.time).abs() * double(s).abs() + double(self.level).abs()
    }

    fn value<T: Number>(&self, s: T, y: &[T], scales: Scales) -> T {
        let mut sum = T::from(-double(self.level));
        for (y, &factor) in y.iter().zip(&self.components) {
            if factor != 0 {
                sum = *y * (scales.state.recip() * f64::from(factor)) + sum;
            }
        }
        if self.time != 0 {
            sum = s * (scales.time.recip() * f64::from(self.time)) + sum;
        }
        let shaped = match self.shape {
            Shape::Linear => sum,
            Shape::Cubic => sum + sum.powi(3) * 0.015_625,
            Shape::Exponential => (sum * 0.125).exp() - 1.0,
            Shape::ArcTangent => (sum * 0.25).atan(),
        };
        shaped * 2.0_f64.powi(self.scale)
    }
}

/// What a transition does to a component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reset {
    Keep,
    Set(Exact),
    Add(Exact),
    /// Times `.0`/2.
    Halves(i8),
    /// The other component.
    Take(usize),
}

#[derive(Clone, Debug)]
pub struct Transition {
    pub to: usize,
    pub resets: [Reset; LINEAR],
}

#[derive(Clone, Debug)]
pub struct Kind {
    pub direction: Direction,
    pub priority: i8,
    pub terminal: bool,
    pub sees_jumps: bool,
    /// The times of a guard that fires at given times.
    pub clock: Option<Vec<Exact>>,
}

impl Kind {
    /// Whether its crossing is a fact.
    pub fn is_edge(&self) -> bool {
        self.direction != Direction::Below
    }
}

/// The units of state and time, powers of two.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    pub state: f64,
    pub time: f64,
}

/// A random system.
#[derive(Clone, Debug)]
pub struct Planted {
    pub scales: Scales,
    /// The amplitude of the last component.
    pub waves: f64,
    /// For each mode the slopes of the components in quarters.
    pub slopes: Vec<[i8; LINEAR]>,
    pub functions: Vec<Function>,
    pub kinds: Vec<Kind>,
    /// For each mode and guard the number of its function, or none if the guard is off.
    pub uses: Vec<[Option<usize>; G]>,
    pub transitions: Vec<[Transition; G]>,
    pub start: (Exact, usize, [Exact; LINEAR]),
    /// The guards of each mode.
    guards: Vec<[Guard; G]>,
    /// The times of each clock.
    times: Vec<Times>,
}

/// A multiple of 1/2, at most `most` in magnitude.
fn on_grid(random: &mut fastrand::Rng, most: i128) -> Exact {
    (random.i128(-2 * most..=2 * most)) * (UNIT / 2)
}

/// A multiple of 1/4, mostly not of 1/2, so that resets seldom end on the zero of a guard.
fn off_grid(random: &mut fastrand::Rng, most: i128) -> Exact {
    on_grid(random, most) + if random.f64() < 0.8 { UNIT / 4 } else { 0 }
}

/// Nothing, or ±2⁻³⁰ to ±2⁻⁴⁷.
fn offset(random: &mut fastrand::Rng) -> Exact {
    let size = if random.f64() < 0.25 { UNIT >> random.u32(30..48) } else { 0 };
    if random.bool() { size } else { -size }
}

fn choose<T: Copy>(random: &mut fastrand::Rng, from: &[T]) -> T {
    from[random.usize(0..from.len())]
}

fn random_function(random: &mut fastrand::Rng, s: Exact) -> Function {
    let mut components = [0; LINEAR];
    let sign = choose(random, &[1, -1]);
    let (mut time, mut level) = (0, on_grid(random, 2));
    match random.u32(0..10) {
        0..=5 => components[random.usize(0..LINEAR)] = sign,
        6 | 7 => {
            let first = random.usize(0..LINEAR);
            components[first] = sign;
            components[(first + 1) % LINEAR] = -sign;
        }
        8 => {
            time = sign;
            level = Exact::from(sign) * (s + UNIT / 2 * random.i128(0..16));
        }
        _ => {
            components[random.usize(0..LINEAR)] = sign;
            time = choose(random, &[1, -1]);
            level = Exact::from(time) * s + on_grid(random, 2);
        }
    }
    let shapes = [Shape::Linear, Shape::Cubic, Shape::Exponential, Shape::ArcTangent];
    Function {
        components,
        time,
        level: level + offset(random),
        shape: choose(random, &shapes),
        scale: choose(random, &[0, 0, -20, 20, 3]),
    }
}

impl Planted {
    pub fn random(random: &mut fastrand::Rng) -> Self {
        let modes = random.usize(2..=4);
        let count = random.usize(3..=G);
        let s = choose(random, &[0, 0, 0, -3, 100]) * UNIT;
        let speeds = [2, 4, 8, -2, -4, -8, 2, 4, 8, -2, -4, -8, 3, -6, 5, 0];
        let usual: [i8; LINEAR] = std::array::from_fn(|_| choose(random, &speeds));
        let mut slopes = Vec::new();
        for _ in 0..modes {
            slopes.push(
                usual.map(|slope| if random.f64() < 0.4 { slope } else { choose(random, &speeds) }),
            );
        }
        let mut functions: Vec<Function> = Vec::new();
        for _ in 0..count + 2 {
            let mut function = random_function(random, s);
            // Often the same zero as another one, in another shape, or a neighbour of it.
            if !functions.is_empty() && random.f64() < 0.3 {
                let other = &functions[random.usize(0..functions.len())];
                let sign: i8 = choose(random, &[1, -1]);
                function.components = other.components.map(|factor| sign * factor);
                function.time = sign * other.time;
                function.level = Exact::from(sign) * other.level + offset(random);
            }
            functions.push(function);
        }
        let directions = [
            Direction::Falling,
            Direction::Rising,
            Direction::Either,
            Direction::Falling,
            Direction::Rising,
            Direction::Below,
            Direction::Below,
        ];
        let kinds = (0..count).map(|_| Kind {
            direction: choose(random, &directions),
            priority: if random.f64() < 0.6 { 0 } else { choose(random, super::api::PRIORITIES) },
            terminal: random.f64() < 0.03,
            sees_jumps: super::api::HAS_JUMPS && random.f64() < 0.2,
            clock: None,
        });
        let mut kinds: Vec<Kind> = kinds.collect();
        for kind in &mut kinds {
            if super::api::HAS_CLOCKS && random.f64() < 0.15 {
                let first = s + UNIT / 2 * random.i128(1..7);
                let period = UNIT / 2 * random.i128(1..6);
                kind.direction = Direction::Rising;
                kind.sees_jumps = false;
                kind.clock = Some((0..40).map(|k| first + k * period).collect());
            }
        }
        let start = std::array::from_fn(|_| on_grid(random, 4) + offset(random));
        let first = random.usize(0..modes);
        Self::meet(random, (s, &start), &slopes[first], &mut functions, &mut kinds);
        let mut uses = Vec::new();
        for _ in 0..modes {
            uses.push(std::array::from_fn(|guard| {
                if guard >= count || random.f64() < 0.15 {
                    None
                } else if random.f64() < 0.1 && kinds[guard].clock.is_none() {
                    Some(count + random.usize(0..2))
                } else {
                    Some(guard)
                }
            }));
        }
        // Those that are equal, or opposite, are one.
        for function in uses.iter_mut().flatten().flatten() {
            let equal = functions.iter().position(|other| other.is(&functions[*function]));
            *function = equal.unwrap_or(*function);
        }
        let transitions =
            (0..modes).map(|mode| std::array::from_fn(|_| Self::transition(random, mode, modes)));
        let transitions = transitions.collect();
        let scales = Scales {
            state: 2.0_f64.powi(choose(random, &[0, 0, 0, -30, 20])),
            time: 2.0_f64.powi(choose(random, &[0, 0, 0, -20, 15])),
        };
        let waves = choose(random, &[0.0, 1.0]);
        let start = (s, first, start);
        let guards = Vec::new();
        let times = kinds.iter().map(|kind| {
            let times = kind.clock.iter().flatten().map(|time| double(*time) * scales.time);
            Times::new(times.collect()).expect("ascending times")
        });
        let times = times.collect();
        let mut planted = Self {
            scales,
            waves,
            slopes,
            functions,
            kinds,
            uses,
            transitions,
            start,
            guards,
            times,
        };
        for mode in 0..modes {
            planted.guards.push(std::array::from_fn(|guard| planted.guard(mode, guard)));
        }
        planted
    }

    /// Lets some guards of the first mode vanish at one time, or nearly.
    fn meet(
        random: &mut fastrand::Rng,
        (s, start): (Exact, &[Exact; LINEAR]),
        slopes: &[i8; LINEAR],
        functions: &mut [Function],
        kinds: &mut [Kind],
    ) {
        let time = UNIT / 2 * random.i128(1..12);
        let y = std::array::from_fn(|i| start[i] + time / 4 * i128::from(slopes[i]));
        for (function, kind) in functions.iter_mut().zip(kinds) {
            let slope = function.slope(slopes);
            if slope == 0 || kind.clock.is_some() || random.f64() < 0.4 {
                continue;
            }
            function.level += function.form(s + time, &y) + offset(random);
            if kind.direction != Direction::Below && random.f64() < 0.9 {
                kind.direction = choose(
                    random,
                    if slope < 0 {
                        &[Direction::Falling, Direction::Either]
                    } else {
                        &[Direction::Rising, Direction::Either]
                    },
                );
            }
        }
    }

    fn transition(random: &mut fastrand::Rng, mode: usize, modes: usize) -> Transition {
        let mut resets = [Reset::Keep; LINEAR];
        let kind = random.u32(0..20);
        if kind == 0 {
            return Transition { to: mode, resets };
        }
        if kind == 1 {
            resets[0] = Reset::Take(1);
            resets[1] = Reset::Take(0);
        } else {
            for reset in &mut resets {
                *reset = match random.u32(0..20) {
                    0..=10 => Reset::Keep,
                    11..=13 => Reset::Set(off_grid(random, 4)),
                    14..=16 => Reset::Add(off_grid(random, 2)),
                    _ => Reset::Halves(choose(random, &[-1, -2, 1, -2])),
                };
            }
        }
        Transition { to: random.usize(0..modes), resets }
    }

    fn guard(&self, mode: usize, guard: usize) -> Guard {
        if self.uses[mode][guard].is_none() {
            return Guard::OFF;
        }
        super::api::guard(&self.kinds[guard])
    }

    /// The state after a transition, exactly.
    pub fn after(&self, mode: usize, guard: usize, y: &[Exact; LINEAR]) -> Option<[Exact; LINEAR]> {
        let mut after = *y;
        for (after, (i, reset)) in
            after.iter_mut().zip(self.transitions[mode][guard].resets.iter().enumerate())
        {
            *after = match *reset {
                Reset::Keep => y[i],
                Reset::Set(value) => value,
                Reset::Add(value) => y[i] + value,
                // A component that is 0 goes on unchanged here alone, and not in a run that rounds.
                Reset::Halves(_) if y[i] == 0 => return None,
                Reset::Halves(halves) => times(y[i], 2 * i128::from(halves))?,
                Reset::Take(other) => y[other],
            };
        }
        Some(after)
    }

    pub fn state(&self, y: &[Exact; LINEAR]) -> [f64; N] {
        let linear = |i: usize| double(y[i]) * self.scales.state;
        std::array::from_fn(|i| if i < LINEAR { linear(i) } else { 0.0 })
    }

    fn slopes_of<T: Number>(&self, mode: usize, s: T, slopes: &mut [T]) {
        let unit = 0.25 * self.scales.state / self.scales.time;
        for (slope, quarters) in slopes.iter_mut().zip(&self.slopes[mode]) {
            *slope = T::from(unit * f64::from(*quarters));
        }
        slopes[LINEAR] = if self.waves == 0.0 {
            T::from(0.0)
        } else {
            (s * (7.0 / self.scales.time)).cos() * (self.waves * 4.0 * unit)
        };
    }

    fn values_of<T: Number>(&self, mode: usize, s: T, y: &[T], values: &mut [T]) {
        for (guard, value) in values.iter_mut().enumerate() {
            *value = match self.uses[mode][guard] {
                Some(function) if self.kinds[guard].clock.is_none() => {
                    self.functions[function].value(s, &y[..LINEAR], self.scales)
                }
                _ => T::from(1.0),
            };
        }
    }

    fn apply(&self, mode: usize, guard: usize, y: &mut [f64]) -> usize {
        let before: [f64; LINEAR] = std::array::from_fn(|i| y[i]);
        let transition = &self.transitions[mode][guard];
        for (i, reset) in transition.resets.iter().enumerate() {
            y[i] = match *reset {
                Reset::Keep => before[i],
                Reset::Set(value) => double(value) * self.scales.state,
                Reset::Add(value) => before[i] + double(value) * self.scales.state,
                Reset::Halves(halves) => before[i] * (0.5 * f64::from(halves)),
                Reset::Take(other) => before[other],
            };
        }
        transition.to
    }
}

/// A readable system of fixed dimension.
pub struct Fixed<'a>(pub &'a Planted);

impl ReadableSystem<N, G> for Fixed<'_> {
    type Mode = usize;

    fn field<T: Number>(&self, mode: usize, s: T, _y: &[T; N]) -> [T; N] {
        let mut slopes = [T::from(0.0); N];
        self.0.slopes_of(mode, s, &mut slopes);
        slopes
    }

    fn guards(&self, mode: usize) -> [Guard; G] {
        self.0.guards[mode]
    }

    fn guard_values<T: Number>(&self, mode: usize, s: T, y: &[T; N]) -> [T; G] {
        let mut values = [T::from(0.0); G];
        self.0.values_of(mode, s, y, &mut values);
        values
    }

    fn schedule(&self, _: usize, guard: usize) -> Schedule<'_> {
        Schedule::at(&self.0.times[guard])
    }

    fn transition(&self, mode: usize, guard: usize, _: f64, y: &State<N>) -> (usize, State<N>) {
        let mut after = *y;
        (self.0.apply(mode, guard, after.as_mut_slice()), after)
    }
}

/// A black box of fixed dimension.
pub struct FixedBox<'a>(pub &'a Planted);

impl HybridSystem<N, G> for FixedBox<'_> {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, y: &State<N>) -> State<N> {
        HybridSystem::field(&Fixed(self.0), mode, s, y)
    }

    fn guards(&self, mode: usize) -> [Guard; G] {
        self.0.guards[mode]
    }

    fn guard_values(&self, mode: usize, s: f64, y: &State<N>) -> [f64; G] {
        HybridSystem::guard_values(&Fixed(self.0), mode, s, y)
    }

    fn schedule(&self, _: usize, guard: usize) -> Schedule<'_> {
        Schedule::at(&self.0.times[guard])
    }

    fn transition(&self, mode: usize, guard: usize, s: f64, y: &State<N>) -> (usize, State<N>) {
        HybridSystem::transition(&Fixed(self.0), mode, guard, s, y)
    }
}

/// A readable system of any dimension.
pub struct Any<'a>(pub &'a Planted);

impl ReadableDynamic for Any<'_> {
    type Mode = usize;

    fn field<T: Number>(&self, mode: usize, s: T, _y: &[T], slope: &mut [T]) {
        self.0.slopes_of(mode, s, slope);
    }

    fn guards(&self, mode: usize) -> &[Guard] {
        &self.0.guards[mode]
    }

    fn guard_values<T: Number>(&self, mode: usize, s: T, y: &[T], values: &mut [T]) {
        self.0.values_of(mode, s, y, values);
    }

    fn reads(&self, _mode: usize) -> &[usize] {
        &[0, 1, 2]
    }

    fn schedule(&self, _: usize, guard: usize) -> Schedule<'_> {
        Schedule::at(&self.0.times[guard])
    }

    fn transition(&self, mode: usize, guard: usize, _: f64, y: &mut [f64]) -> usize {
        self.0.apply(mode, guard, y)
    }
}

/// A black box of any dimension.
pub struct AnyBox<'a>(pub &'a Planted);

impl DynamicSystem for AnyBox<'_> {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, _y: &[f64], slope: &mut [f64]) {
        self.0.slopes_of(mode, s, slope);
    }

    fn guards(&self, mode: usize) -> &[Guard] {
        &self.0.guards[mode]
    }

    fn guard_values(&self, mode: usize, s: f64, y: &[f64], values: &mut [f64]) {
        self.0.values_of(mode, s, y, values);
    }

    fn schedule(&self, _: usize, guard: usize) -> Schedule<'_> {
        Schedule::at(&self.0.times[guard])
    }

    fn transition(&self, mode: usize, guard: usize, _: f64, y: &mut [f64]) -> usize {
        self.0.apply(mode, guard, y)
    }
}
