//! What holds of every run of a hybrid system. Tests and fuzz targets share these checks.

use stickslip_solver::margin::margins;
use stickslip_solver::{
    Direction, Dop853, Dopri5, Guard, HybridSystem, Method, Observer, Options, Outcome, RunError,
    Start, State, StepSize, SwitchEvent, run,
};

/// Runs polynomials as guards by both methods, and checks that their signs change exactly where the
/// run reports it. The polynomials are made from bytes.
///
/// # Errors
/// A description of what does not hold.
pub fn polynomials(bytes: &[u8]) -> Result<(), String> {
    let mut bytes = Bytes(bytes);
    let step_size = bytes.step_size();
    signs([bytes.polynomial(), bytes.polynomial()], step_size)
}

/// Checks on [0, 1] that the signs of two polynomials change exactly where the run reports it.
/// Their coefficients are given, lowest first.
///
/// # Errors
/// A description of what does not hold.
pub fn signs(guards: [[f64; COEFFICIENTS]; 2], step_size: StepSize) -> Result<(), String> {
    follow_signs(Dop853, &Polynomials { guards }, step_size)?;
    follow_signs(Dopri5, &Polynomials { guards }, step_size)
}

/// Runs a system of any expressions by both methods, with its margins, and checks that results are
/// finite, in order and in the span. The system is made from bytes.
///
/// # Errors
/// A description of what does not hold.
pub fn expressions(bytes: &[u8]) -> Result<(), String> {
    let mut bytes = Bytes(bytes);
    let options = Options {
        step_size: bytes.step_size(),
        max_step: 1.0,
        max_steps: 100,
        max_switches: 20,
        ..Options::default()
    };
    let start =
        Start { mode: 0, s: bytes.number(), state: State::from([(); 2].map(|()| bytes.number())) };
    let system = Expressions {
        field: [(); MODES].map(|()| [bytes.expression(), bytes.expression()]),
        guards: [(); MODES].map(|()| [bytes.guard(), bytes.guard()]),
        values: [(); MODES].map(|()| [bytes.expression(), bytes.expression()]),
    };
    let end = start.s + 2.0;
    in_order(Dop853, &system, start, end, &options)?;
    in_order(Dopri5, &system, start, end, &options)
}

/// The number of coefficients. Up to this degree, the six values of the first look are decisive.
pub const COEFFICIENTS: usize = 6;

/// y' = 1 with two polynomials as guards that fire in either direction.
struct Polynomials {
    guards: [[f64; COEFFICIENTS]; 2],
}

impl HybridSystem<1, 2> for Polynomials {
    type Mode = ();

    fn field(&self, (): (), _s: f64, _y: &State<1>) -> State<1> {
        State::from([1.0])
    }

    fn guards(&self, (): ()) -> [Guard; 2] {
        self.guards.map(|coefficients| {
            let zero = coefficients == [0.0; COEFFICIENTS];
            if zero { Guard::OFF } else { Guard::new(Direction::Either) }
        })
    }

    fn guard_values(&self, (): (), _s: f64, y: &State<1>) -> [f64; 2] {
        self.guards.map(|coefficients| value(&coefficients, y[0]))
    }

    fn transition(&self, (): (), _guard: usize, _s: f64, y: &State<1>) -> ((), State<1>) {
        ((), *y)
    }
}

fn value(coefficients: &[f64; COEFFICIENTS], y: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * y + coefficient)
}

/// Whether a polynomial is so flat at a root that it may stay unresolved. Steps beside such a root
/// may be too short to show the scatter of the values. See the limits in `docs/numerics.md`.
fn is_double_root(coefficients: &[f64; COEFFICIENTS], s: f64) -> bool {
    let size: f64 = coefficients.iter().map(|coefficient| coefficient.abs()).sum();
    let slope =
        std::array::from_fn(|i| coefficients.get(i + 1).map_or(0.0, |c| c * (i + 1) as f64));
    value(coefficients, s).abs() <= 1e-14 * size && value(&slope, s).abs() <= 1e-6 * size
}

/// The guards that fired, one bit each, and the places where they fired.
struct Fired(Vec<(u64, f64)>);

impl<Mode, const N: usize> Observer<Mode, N> for Fired {
    fn on_switch(&mut self, event: &SwitchEvent<Mode, N>) {
        self.0.push((1 << event.guard | event.simultaneous, event.s));
    }
}

fn follow_signs<M: Method>(
    method: M,
    system: &Polynomials,
    step_size: StepSize,
) -> Result<(), String> {
    let options = Options { step_size, max_steps: 2000, max_switches: 100, ..Options::default() };
    let start = Start { mode: (), s: 0.0, state: State::from([0.0]) };
    // A guard that starts from zero would have to declare that.
    if system.guards.iter().any(|guard| *guard != [0.0; COEFFICIENTS] && guard[0] == 0.0) {
        return Ok(());
    }
    let mut fired = Fired(Vec::new());
    let place = |fired: &Fired| format!("{:?} in {step_size:?}: {:?}", system.guards, fired.0);
    let outcome = run(method, system, start, 1.0, &options, &mut fired);
    if let Err(RunError::GuardUnresolved { guard, s, .. }) = outcome
        && is_double_root(&system.guards[guard], s)
    {
        return Ok(());
    }
    let outcome = outcome.map_err(|error| format!("{}: {error}", place(&fired)))?.outcome;
    if outcome != Outcome::ReachedEnd {
        return Err(format!("{}: {outcome:?}", place(&fired)));
    }
    for (guard, coefficients) in system.guards.iter().enumerate() {
        let size: f64 = coefficients.iter().map(|coefficient| coefficient.abs()).sum();
        // In a cluster of roots where the guard stays below this, only the total counts.
        let clear = |value: f64| value.abs() > 1e-13 * size;
        let first = value(coefficients, 0.0);
        if !clear(first) {
            continue;
        }
        for i in 1..=512 {
            let s = f64::from(i) / 512.0;
            let here = value(coefficients, s);
            let crossings =
                fired.0.iter().filter(|(which, at)| which >> guard & 1 == 1 && *at < s).count();
            let expected = if crossings.is_multiple_of(2) { first } else { -first };
            if clear(here) && (here > 0.0) != (expected > 0.0) {
                return Err(format!("{}: guard {guard} is {here:e} at {s}", place(&fired)));
            }
        }
    }
    Ok(())
}

/// The number of modes of a system of expressions.
const MODES: usize = 2;

/// A system whose right-hand sides and guards are any expressions. Guard 0 leads to the other mode,
/// and guard 1 moves the state.
struct Expressions {
    field: [[Expression; 2]; MODES],
    guards: [[Guard; 2]; MODES],
    values: [[Expression; 2]; MODES],
}

impl HybridSystem<2, 2> for Expressions {
    type Mode = usize;

    fn field(&self, mode: usize, s: f64, y: &State<2>) -> State<2> {
        State::from(self.field[mode].map(|expression| expression.value(s, y)))
    }

    fn guards(&self, mode: usize) -> [Guard; 2] {
        self.guards[mode]
    }

    fn guard_values(&self, mode: usize, s: f64, y: &State<2>) -> [f64; 2] {
        self.values[mode].map(|expression| expression.value(s, y))
    }

    fn transition(&self, mode: usize, guard: usize, _s: f64, y: &State<2>) -> (usize, State<2>) {
        if guard == 0 { ((mode + 1) % MODES, *y) } else { (mode, State::from([y[1], -0.5 * y[0]])) }
    }
}

fn in_order<M: Method>(
    method: M,
    system: &Expressions,
    start: Start<usize, 2>,
    end: f64,
    options: &Options,
) -> Result<(), String> {
    struct Places(Vec<f64>, bool);
    impl Observer<usize, 2> for Places {
        fn on_switch(&mut self, event: &SwitchEvent<usize, 2>) {
            self.0.push(event.s);
            self.1 &= event.before.iter().all(|value| value.is_finite());
        }
    }
    let mut places = Places(Vec::new(), true);
    let ran = run(method, system, start, end, options, &mut places);
    let Places(places, finite) = places;
    let inside = |s: &f64| (start.s..=end).contains(s);
    if !finite || !places.iter().all(inside) || !places.is_sorted() {
        return Err(format!("{start:?}: switches at {places:?}, finite: {finite}"));
    }
    let Ok(ran) = ran else { return Ok(()) };
    if !inside(&ran.s) || !ran.state.iter().all(|value| value.is_finite()) {
        return Err(format!("{start:?}: {ran:?}"));
    }
    let Ok(margins) = margins(method, system, start, end, options) else { return Ok(()) };
    match margins.near_misses.iter().find(|miss| !inside(&miss.s) || miss.value.is_nan()) {
        Some(miss) => Err(format!("{start:?}: {miss:?}")),
        None => Ok(()),
    }
}

/// Operations on a stack of two numbers.
#[derive(Clone, Copy, Debug)]
struct Expression([(u8, f64); 8]);

impl Expression {
    fn value(&self, s: f64, y: &State<2>) -> f64 {
        let (mut top, mut below) = (0.0, 0.0);
        for &(operation, number) in &self.0 {
            (top, below) = match operation % 14 {
                0 => (number, top),
                1 => (s, top),
                2 => (y[0], top),
                3 => (y[1], top),
                4 => (below + top, below),
                5 => (below - top, below),
                6 => (below * top, below),
                7 => (below / top, below),
                8 => (top.sin(), below),
                9 => (top.abs(), below),
                10 => (top.sqrt(), below),
                11 => (top.exp(), below),
                12 => (top * number, below),
                _ => (top, below),
            };
        }
        top
    }
}

/// Bytes that are read from the front. After the last one, they are 0.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    fn word(&mut self) -> u64 {
        u64::from_le_bytes([(); 8].map(|()| self.byte()))
    }

    /// A small number, a number of any size between 1e-12 and 1e12, or any finite double.
    fn number(&mut self) -> f64 {
        let kind = self.byte();
        let small = f64::from(self.byte().cast_signed()) / 16.0;
        match kind % 8 {
            0..=5 => small,
            6 => small * 10_f64.powi(i32::from(self.byte() % 25) - 12),
            _ => {
                Some(f64::from_bits(self.word())).filter(|value| value.is_finite()).unwrap_or(small)
            }
        }
    }

    fn step_size(&mut self) -> StepSize {
        match self.byte() {
            0..=127 => StepSize::Adaptive,
            byte => StepSize::Fixed(f64::from(byte - 127) / 128.0),
        }
    }

    fn polynomial(&mut self) -> [f64; COEFFICIENTS] {
        [(); COEFFICIENTS].map(|()| f64::from(self.byte().cast_signed()) / 16.0)
    }

    fn guard(&mut self) -> Guard {
        let byte = self.byte();
        let directions = [
            Direction::Below,
            Direction::Falling,
            Direction::Rising,
            Direction::Either,
            Direction::Off,
        ];
        let guard =
            Guard::new(directions[usize::from(byte % 5)]).from_zero(u32::from(byte / 5 % 4 % 3));
        let guard = if byte & 64 == 0 { guard } else { guard.terminal() };
        if byte & 128 == 0 { guard } else { guard.priority(-1) }
    }

    fn expression(&mut self) -> Expression {
        Expression([(); 8].map(|()| {
            let operation = self.byte();
            let number = if operation.is_multiple_of(12) { self.number() } else { 0.0 };
            (operation, number)
        }))
    }
}
