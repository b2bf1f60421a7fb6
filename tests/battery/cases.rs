//! The battery: event-location cases with known events, read from cases.json.
//!
//! `truth.py` writes the cases, `peers.py` runs them with SciPy and heyoka. The example `battery`
//! and the tests of the facade share this file.

mod expression;
pub mod running;
pub mod text;
mod verdict;

use serde_json::Value;
use stickslip::solver::{Direction, Guard};

use expression::Expression;
pub use running::{Reading, run_case};
use verdict::Verdict;

/// A system, its start, and the events that it really has.
#[derive(Clone, Debug)]
pub struct Case {
    /// The name of the case.
    pub name: String,
    /// The same as a text.
    text: String,
    modes: Vec<Mode>,
    start: (usize, f64, Vec<f64>),
    end: f64,
    rtol: f64,
    atol: f64,
    /// The shortest time on which a guard changes, for black boxes.
    pub guard_scale: Option<f64>,
    outcome: ExpectedOutcome,
    truth: Truth,
    tolerance: f64,
}

/// A smooth regime of a case.
#[derive(Clone, Debug)]
struct Mode {
    field: Vec<Expression>,
    guards: Vec<CaseGuard>,
}

/// A guard, with what it causes.
#[derive(Clone, Debug)]
struct CaseGuard {
    value: Expression,
    guard: Guard,
    to: Option<usize>,
    reset: Option<Vec<Expression>>,
}

/// How a run of a case ends.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ExpectedOutcome {
    /// At the end of its span.
    End,
    /// By a terminal guard.
    Guard,
    /// The switches accumulate at this time.
    Zeno(f64),
    /// No solution continues from this time.
    Stuck(f64),
}

/// An event: its time and its guard.
type Place = (f64, usize);

/// The events that a case really has.
#[derive(Clone, Debug)]
enum Truth {
    /// All events, in the order of time. If they accumulate, those well before the accumulation.
    All(Vec<Place>),
    /// The number of events, and some of them with their index.
    Sampled(usize, Vec<(usize, Place)>),
}

/// All cases.
///
/// # Panics
/// The file is not as `truth.py` writes it.
pub fn cases() -> Vec<Case> {
    let file: Value = serde_json::from_str(include_str!("cases.json")).expect("JSON");
    let read = |case| Case::read(case).unwrap_or_else(|| panic!("{case} is not a case"));
    file.as_array().expect("an array of cases").iter().map(read).collect()
}

/// Every element of an array.
fn each<T>(value: &Value, read: impl Fn(&Value) -> Option<T>) -> Option<Vec<T>> {
    value.as_array()?.iter().map(read).collect()
}

fn index(value: &Value) -> Option<usize> {
    value.as_u64()?.try_into().ok()
}

impl Case {
    fn read(case: &Value) -> Option<Self> {
        let number = |name: &str| case[name].as_f64();
        let start = &case["start"];
        let outcome = match case["outcome"].as_str()? {
            "end" => ExpectedOutcome::End,
            "guard" => ExpectedOutcome::Guard,
            "zeno" => ExpectedOutcome::Zeno(number("accumulation")?),
            "stuck" => ExpectedOutcome::Stuck(number("accumulation")?),
            _ => return None,
        };
        let place = |time: &Value, guard: &Value| Some((time.as_f64()?, index(guard)?));
        let truth = if case["count"].is_null() {
            Truth::All(each(&case["events"], |event| place(&event[0], &event[1]))?)
        } else {
            let sample = |event: &Value| Some((index(&event[0])?, place(&event[1], &event[2])?));
            Truth::Sampled(index(&case["count"])?, each(&case["sampled"], sample)?)
        };
        Some(Self {
            name: case["name"].as_str()?.to_owned(),
            text: text::of(case)?,
            modes: each(&case["modes"], Mode::read)?,
            start: (
                index(&start["mode"])?,
                start["time"].as_f64()?,
                each(&start["state"], Value::as_f64)?,
            ),
            end: number("end")?,
            rtol: number("rtol")?,
            atol: number("atol")?,
            guard_scale: number("guard_scale"),
            outcome,
            truth,
            tolerance: number("tolerance")?,
        })
    }

    /// The number of components, and the largest number of guards in a mode.
    fn size(&self) -> (usize, usize) {
        (self.start.2.len(), self.modes.iter().map(|mode| mode.guards.len()).max().unwrap_or(0))
    }
}

impl Mode {
    fn read(mode: &Value) -> Option<Self> {
        Some(Self {
            field: each(&mode["field"], Expression::read)?,
            guards: each(&mode["guards"], CaseGuard::read)?,
        })
    }
}

impl CaseGuard {
    fn read(guard: &Value) -> Option<Self> {
        let direction = match guard["direction"].as_str()? {
            "below" => Direction::Below,
            "falling" => Direction::Falling,
            "rising" => Direction::Rising,
            "either" => Direction::Either,
            _ => return None,
        };
        let order = guard["zero_order"].as_u64().unwrap_or(0).try_into().ok()?;
        let plain = Guard::new(direction).from_zero(order);
        let reset = match &guard["reset"] {
            Value::Null => None,
            formulas => Some(each(formulas, Expression::read)?),
        };
        Some(Self {
            value: Expression::read(&guard["value"])?,
            guard: if guard["terminal"] == true { plain.terminal() } else { plain },
            to: index(&guard["to"]),
            reset,
        })
    }

    /// Whether the guard changes neither mode nor state.
    fn is_noted(&self) -> bool {
        self.to.is_none() && self.reset.is_none()
    }
}
