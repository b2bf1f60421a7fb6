//! Guards of every kind with known zeros: steep, fast, kinked, with jumps and poles, nearly
//! tangent, clustered. They are found by enclosures where the system is readable, and sampled where
//! it is a black box.

use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, HybridSystem, Method, Number, Observer, Options, Outcome,
    ReadableSystem, RunError, Start, State, StepSize, SwitchEvent,
};

use crate::erased::run;

/// A guard as a function of x.
#[derive(Clone, Debug)]
pub enum Shape {
    /// tanh(k (x − r))
    Steep { k: f64, r: f64 },
    /// exp(k (x − r)) − 1
    Explosive { k: f64, r: f64 },
    /// sin(ω x + φ) − c
    Fast { omega: f64, phase: f64, level: f64 },
    /// 1 − d exp(−((x − c)/w)²)
    Dip { centre: f64, width: f64, depth: f64 },
    /// ± Π (x − rᵢ)
    Cluster { roots: Vec<f64>, sign: f64 },
    /// |x − a| − b
    Kink { a: f64, b: f64 },
    /// max(x − a, k (a − x)) − b
    Vee { a: f64, b: f64, k: f64 },
    /// −1 from a on, and 2 before it
    Jump { a: f64 },
    /// x/p − ⌊x/p⌋ − c
    Saw { period: f64, level: f64 },
    /// 1/(x − a) + c
    Pole { a: f64, c: f64 },
    /// tan(ω x) − c
    Tangent { omega: f64, c: f64 },
}

impl Shape {
    pub const KINDS: [&str; 11] = [
        "steep: tanh k(x − r), k to 1e9",
        "explosive: exp k(x − r) − 1, k to 600",
        "fast: sin(ωx + φ) − c, ω to 3000",
        "dip of width 1e-5 to 0.1",
        "cluster of two to five, 1e-6 to 0.1 apart",
        "kink: |x − a| − b, b from 1e-9",
        "vee: max of two lines",
        "jump",
        "saw: jumps and zeros",
        "pole and zero",
        "tan ωx − c, ω to 300",
    ];

    pub fn random(kind: usize, random: &mut fastrand::Rng) -> Self {
        let between =
            |random: &mut fastrand::Rng, low: f64, high: f64| low + (high - low) * random.f64();
        let power = |random: &mut fastrand::Rng, low: f64, high: f64| {
            10_f64.powf(low + (high - low) * random.f64())
        };
        let inside = between(random, 0.05, 0.95);
        match kind {
            0 => Self::Steep {
                k: power(random, 1.0, 9.0) * [1.0, -1.0][random.usize(0..2)],
                r: inside,
            },
            1 => Self::Explosive { k: power(random, 1.0, 2.7), r: inside },
            2 => Self::Fast {
                omega: power(random, 1.0, 3.4),
                phase: between(random, 0.0, 6.2),
                level: between(random, -0.95, 0.95),
            },
            3 => Self::Dip {
                centre: between(random, 0.2, 0.8),
                width: power(random, -5.0, -1.0),
                depth: between(random, 1.1, 3.0),
            },
            4 => {
                let gap = power(random, -6.0, -1.0);
                let count = random.usize(2..6).min(if gap < 1e-3 { 2 } else { 5 });
                let first = between(random, 0.05, 0.45);
                let roots = (0..count).map(|i| first + gap * i as f64).collect();
                Self::Cluster { roots, sign: [1.0, -1.0][random.usize(0..2)] }
            }
            5 => Self::Kink { a: between(random, 0.2, 0.8), b: power(random, -9.0, -1.0) },
            6 => Self::Vee {
                a: between(random, 0.2, 0.8),
                b: power(random, -6.0, -1.0),
                k: power(random, 0.0, 4.0),
            },
            7 => Self::Jump { a: inside },
            8 => Self::Saw { period: power(random, -2.0, -0.3), level: between(random, 0.1, 0.9) },
            9 => Self::Pole {
                a: inside,
                c: [1.0, -1.0][random.usize(0..2)] * power(random, 0.5, 4.0),
            },
            _ => Self::Tangent { omega: power(random, 0.5, 2.5), c: between(random, -3.0, 3.0) },
        }
    }

    pub fn value<T: Number>(&self, x: T) -> T {
        match *self {
            Self::Steep { k, r } => ((x - r) * k).tanh(),
            Self::Explosive { k, r } => ((x - r) * k).exp() - 1.0,
            Self::Fast { omega, phase, level } => (x * omega + phase).sin() - level,
            Self::Dip { centre, width, depth } => {
                -(-((x - centre) / width).powi(2)).exp() * depth + 1.0
            }
            Self::Cluster { ref roots, sign } => {
                roots.iter().fold(T::from(sign), |product, root| product * (x - *root))
            }
            Self::Kink { a, b } => (x - a).abs() - b,
            Self::Vee { a, b, k } => (x - a).max((-x + a) * k) - b,
            Self::Jump { a } => (x - a).select(T::from(-1.0), T::from(2.0)),
            Self::Saw { period, level } => x / period - (x / period).floor() - level,
            Self::Pole { a, c } => T::from(1.0) / (x - a) + c,
            Self::Tangent { omega, c } => (x * omega).tan() - c,
        }
    }

    /// The zeros and jumps over zero in ]0, 1[, in order.
    fn zeros(&self) -> Vec<f64> {
        let tau = std::f64::consts::TAU;
        let repeated = |first: f64, period: f64| {
            let begin = (-first / period).ceil();
            (0..).map(move |k| first + (begin + f64::from(k)) * period).take_while(|x| *x < 1.0)
        };
        let mut zeros: Vec<f64> = match *self {
            Self::Steep { r, .. } | Self::Explosive { r, .. } | Self::Jump { a: r } => vec![r],
            Self::Fast { omega, phase, level } => {
                let angle = level.asin();
                [angle, std::f64::consts::PI - angle]
                    .into_iter()
                    .flat_map(|angle| repeated((angle - phase) / omega, tau / omega))
                    .collect()
            }
            Self::Dip { centre, width, depth } => {
                let half = width * depth.ln().sqrt();
                vec![centre - half, centre + half]
            }
            Self::Cluster { ref roots, .. } => roots.clone(),
            Self::Kink { a, b } => vec![a - b, a + b],
            Self::Vee { a, b, k } => vec![a - b / k, a + b],
            Self::Saw { period, level } => {
                repeated(period, period).chain(repeated(level * period, period)).collect()
            }
            Self::Pole { a, c } => vec![a - 1.0 / c],
            Self::Tangent { omega, c } => repeated(c.atan() / omega, 0.5 * tau / omega).collect(),
        };
        zeros.retain(|zero| *zero > 0.0 && *zero < 1.0);
        zeros.sort_by(f64::total_cmp);
        zeros
    }

    /// The time on which the guard changes.
    pub fn scale(&self) -> f64 {
        match *self {
            Self::Steep { .. } | Self::Explosive { .. } | Self::Jump { .. } => 1.0,
            Self::Fast { omega, .. } | Self::Tangent { omega, .. } => 0.5 / omega,
            Self::Dip { width, .. } => 0.5 * width,
            Self::Cluster { ref roots, .. } => roots[1] - roots[0],
            Self::Kink { b, .. } => b,
            Self::Vee { b, k, .. } => b / k,
            Self::Saw { period, level } => 0.5 * period * level.min(1.0 - level),
            Self::Pole { c, .. } => 0.5 / c.abs(),
        }
    }

    /// Whether the zeros are far enough from the ends of the run, and from each other and from
    /// poles, to be told apart in double precision.
    fn is_fair(&self) -> bool {
        let zeros = self.zeros();
        let apart = zeros.windows(2).all(|pair| pair[1] - pair[0] > 1e-10);
        let inside = zeros.iter().all(|zero| *zero > 1e-6 && *zero < 1.0 - 1e-6);
        let pole = match *self {
            Self::Pole { a, c } => (a - 1.0 / c).abs() > 1e-6 && 1.0 / c.abs() > 1e-6,
            Self::Tangent { omega, .. } => {
                // The pole must not be at the end.
                ((omega / std::f64::consts::PI - 0.5).fract()).abs() > 1e-3
            }
            _ => true,
        };
        apart && inside && pole
    }
}

/// What x is along a run.
#[derive(Clone, Copy, Debug)]
pub enum Clock {
    /// The time.
    Time,
    /// A component with y' = 1.
    State,
    /// A component with y' = 1/(1 + y), which is √(1 + 2s) − 1.
    Curved,
}

impl Clock {
    fn field<T: Number>(self, y: T) -> T {
        match self {
            Self::Time | Self::State => T::from(1.0),
            Self::Curved => T::from(1.0) / (y + 1.0),
        }
    }

    fn place(self, x: f64) -> f64 {
        match self {
            Self::Time | Self::State => x,
            Self::Curved => x + 0.5 * x * x,
        }
    }
}

/// A planted guard.
#[derive(Clone, Debug)]
pub struct Planted {
    pub shape: Shape,
    pub clock: Clock,
    pub direction: Direction,
}

impl ReadableSystem<1, 1> for Planted {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _s: T, y: &[T; 1]) -> [T; 1] {
        [self.clock.field(y[0])]
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(self.direction)]
    }

    fn guard_values<T: Number>(&self, (): (), s: T, y: &[T; 1]) -> [T; 1] {
        let x = if let Clock::Time = self.clock { s } else { y[0] };
        [self.shape.value(x)]
    }
}

/// The same system as a black box.
struct BlackBox<'a>(&'a Planted);

impl HybridSystem<1, 1> for BlackBox<'_> {
    type Mode = ();

    fn field(&self, (): (), _s: f64, y: &State<1>) -> State<1> {
        State::from([self.0.clock.field(y[0])])
    }

    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(self.0.direction)]
    }

    fn guard_values(&self, (): (), s: f64, y: &State<1>) -> [f64; 1] {
        ReadableSystem::guard_values(self.0, (), s, &[y[0]])
    }
}

#[derive(Default)]
struct Times(Vec<f64>);

impl<Mode, const N: usize> Observer<Mode, N> for Times {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.push(event.s);
    }
}

/// How a case is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    Readable,
    BlackBox,
    BlackBoxWithScale,
}

/// The shortest time scale with which black boxes are run: each costs an expansion.
const SHORTEST: f64 = 1e-3;

/// What a run of a case was.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    Right,
    /// The guard's time scale is too short for a black box.
    TooFast,
    Wrong(String),
    Failed(RunError),
}

/// A random case of a kind, with its options and the places where the guard should fire.
pub struct Case {
    pub planted: Planted,
    pub options: Options,
    pub by_dopri5: bool,
    pub expected: Vec<f64>,
    end: f64,
    tolerance: f64,
}

pub fn random_case(kind: usize, random: &mut fastrand::Rng) -> Case {
    let shape = std::iter::repeat_with(|| Shape::random(kind, random)).find(Shape::is_fair);
    let shape = shape.expect("most are fair");
    let clock = [Clock::Time, Clock::State, Clock::Curved][random.usize(0..3)];
    let direction = [Direction::Falling, Direction::Rising, Direction::Either][random.usize(0..3)];
    let expected = shape
        .zeros()
        .into_iter()
        .filter(|zero| {
            // Zeros are at least 1e-10 apart.
            let falls = shape.value(zero - 3e-11) > shape.value(zero + 3e-11);
            match direction {
                Direction::Falling => falls,
                Direction::Rising => !falls,
                _ => true,
            }
        })
        .map(|zero| clock.place(zero))
        .collect();
    let step_size = match random.usize(0..4) {
        0 if !matches!(clock, Clock::Curved) => StepSize::Fixed(10_f64.powf(-2.0 * random.f64())),
        _ => StepSize::Adaptive,
    };
    let tight = random.bool();
    let options =
        Options { step_size, ..Options::with_tolerance(if tight { 1e-12 } else { 1e-7 }) };
    let tolerance = match (clock, step_size, tight) {
        (Clock::Time | Clock::State, ..) => 1e-12,
        (_, _, true) => 1e-9,
        (_, _, false) => 1e-5,
    };
    let by_dopri5 = random.bool();
    let planted = Planted { shape, clock, direction };
    Case { end: clock.place(1.0), planted, options, by_dopri5, expected, tolerance }
}

impl Case {
    pub fn found(&self, reading: Reading) -> Found {
        let mut options = self.options;
        if reading == Reading::BlackBoxWithScale {
            let scale = self.planted.shape.scale();
            if scale < SHORTEST {
                return Found::TooFast;
            }
            options.guard_scale = Some(scale);
        }
        let times = if self.by_dopri5 {
            self.times(Dopri5, reading, &options)
        } else {
            self.times(Dop853, reading, &options)
        };
        let times = match times {
            Ok(times) => times,
            Err(error) => return Found::Failed(error),
        };
        let off = times.iter().zip(&self.expected).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max);
        if times.len() == self.expected.len() && off <= self.tolerance {
            Found::Right
        } else {
            Found::Wrong(format!(
                "{:?} {:?} by dopri5: {}: {} places, not {}, {off:e} off",
                self.planted,
                self.options.step_size,
                self.by_dopri5,
                times.len(),
                self.expected.len()
            ))
        }
    }

    fn times<M: Method>(
        &self,
        method: M,
        reading: Reading,
        options: &Options,
    ) -> Result<Vec<f64>, RunError> {
        let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
        let mut times = Times::default();
        let end = match reading {
            Reading::Readable => run(method, &self.planted, start, self.end, options, &mut times),
            _ => run(method, &BlackBox(&self.planted), start, self.end, options, &mut times),
        }?;
        assert_eq!(end.outcome, Outcome::ReachedEnd);
        Ok(times.0)
    }
}

#[test]
fn readable_guards_of_every_kind_are_found() {
    for (kind, name) in Shape::KINDS.into_iter().enumerate() {
        for seed in 0..200 {
            let case = random_case(kind, &mut fastrand::Rng::with_seed(seed));
            assert_eq!(case.found(Reading::Readable), Found::Right, "{name}, seed {seed}");
        }
    }
}

/// The error of the dense output is wider than what these guards do: a dip, and a zero beside a
/// pole. A single step into that part did not show it.
#[test]
fn what_is_narrower_than_the_error_of_the_path_is_found() {
    for (kind, seed) in [(3, 16853), (9, 7666), (9, 8322)] {
        let case = random_case(kind, &mut fastrand::Rng::with_seed(seed));
        assert_eq!(case.found(Reading::Readable), Found::Right, "{}", Shape::KINDS[kind]);
    }
}

/// Steps to places beside these poles end some roundings away, on the other side of the pole.
#[test]
fn poles_that_rounding_moves_are_poles() {
    for seed in [21518, 160619, 471661] {
        let case = random_case(10, &mut fastrand::Rng::with_seed(seed));
        assert_eq!(case.found(Reading::Readable), Found::Right, "{seed}");
    }
}

/// The stated rate for black boxes that name their time scale: none wrong, but for poles that lie
/// closer to zeros than that scale.
#[test]
fn black_boxes_with_a_time_scale_are_found() {
    for (kind, name) in Shape::KINDS.into_iter().enumerate().take(9) {
        for seed in 0..100 {
            let case = random_case(kind, &mut fastrand::Rng::with_seed(seed));
            let found = case.found(Reading::BlackBoxWithScale);
            assert!(matches!(found, Found::Right | Found::TooFast), "{name} {seed}: {found:?}");
        }
    }
}

/// Steep guards and jumps show both signs, so that black boxes need no scale for them.
#[test]
fn steep_guards_and_jumps_of_black_boxes_are_found() {
    for kind in [0, 1, 7] {
        for seed in 0..200 {
            let case = random_case(kind, &mut fastrand::Rng::with_seed(seed));
            let found = case.found(Reading::BlackBox);
            assert_eq!(found, Found::Right, "{}, seed {seed}", Shape::KINDS[kind]);
        }
    }
}
