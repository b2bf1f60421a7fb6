//! Collisions of arrays of parameters.

use std::collections::HashMap;
use std::ops::Range;

use numpy::ndarray::s;
use numpy::{Element, IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use stickslip_model::{Collision, Contact, Engine, Law, Regime};

use crate::engines::{Choice, LawChoice};
use crate::failure::{Failure, bad_input, keeping};
use crate::parallel::{Threads, in_pieces};

/// Parameters of collisions: κ, ψ and damping, each with one value for all or for each.
pub struct Points {
    columns: [Vec<f64>; 3],
    count: usize,
    law: (Law, f64),
}

/// Three arrays of numbers. Python's are copied, because other threads may write to them.
#[derive(FromPyObject)]
pub struct Parameters<'py>(
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray1<'py, f64>,
);

/// Requires arrays to have one length.
pub fn expect_equal(lengths: impl IntoIterator<Item = usize>) -> PyResult<()> {
    let mut lengths = lengths.into_iter();
    let first = lengths.next();
    match lengths.find(|&other| Some(other) != first) {
        Some(other) => Err(bad_input(format!(
            "arrays of {} and {other} numbers; expected arrays of one length",
            first.unwrap_or(0)
        ))),
        None => Ok(()),
    }
}

/// The numbers of an array.
///
/// Those that do not lie as Rust reads them, such as a field of records, are refused: the package
/// passes copies.
pub fn numbers(array: &PyReadonlyArray1<'_, f64>) -> PyResult<Vec<f64>> {
    if array.data().is_aligned() { Ok(array.as_array().to_vec()) } else { Err(unaligned()) }
}

fn unaligned() -> PyErr {
    bad_input("an array that is not aligned; expected a copy of it")
}

/// Two arrays of numbers, of one length.
pub struct Pairs<'py>([PyReadonlyArray1<'py, f64>; 2]);

impl<'py> Pairs<'py> {
    pub fn new(x: PyReadonlyArray1<'py, f64>, y: PyReadonlyArray1<'py, f64>) -> PyResult<Self> {
        expect_equal([x.len()?, y.len()?])?;
        let arrays = [x, y];
        if arrays.iter().all(|array| array.data().is_aligned()) {
            Ok(Self(arrays))
        } else {
            Err(unaligned())
        }
    }

    pub fn count(&self) -> usize {
        self.0[0].as_array().len()
    }

    /// The values of all pairs.
    pub fn map<T: Element + Copy + Send>(
        &self,
        py: Python<'py>,
        threads: &Threads,
        value: impl Fn(f64, f64) -> T + Sync,
    ) -> PyResult<Bound<'py, PyArray1<T>>> {
        // NumPy takes large pages for large arrays.
        let values = PyArray1::zeros(py, self.count(), false);
        let mut written = values.readwrite();
        let mut columns = [const { Vec::new() }; 2];
        let written_values = written.as_slice_mut()?;
        in_pieces(py, self.count(), None, |piece| {
            // Other threads may write to the arrays, so that pieces are copied. The same memory
            // again and again is quicker than much new one.
            for (column, array) in columns.iter_mut().zip(&self.0) {
                let view = array.as_array();
                let part = view.slice(s![piece.clone()]);
                column.clear();
                match part.as_slice() {
                    Some(part) => column.extend_from_slice(part),
                    None => column.extend(part),
                }
            }
            threads.fill(py, &mut written_values[piece], |first, found| {
                let [x, y] = columns.each_ref().map(|column| &column[first..]);
                for ((found, &x), &y) in found.iter_mut().zip(x).zip(y) {
                    *found = value(x, y);
                }
            });
            Ok(())
        })?;
        drop(written);
        Ok(values)
    }
}

impl Points {
    pub fn new(parameters: &Parameters<'_>, law: &LawChoice) -> PyResult<Self> {
        let Parameters(kappa, psi, damping) = parameters;
        let columns = [numbers(kappa)?, numbers(psi)?, numbers(damping)?];
        let lengths = || columns.iter().map(Vec::len).filter(|&length| length != 1);
        expect_equal(lengths())?;
        let count = lengths().next().unwrap_or(1);
        Ok(Self { columns, count, law: law.law()? })
    }

    fn parameters(&self, index: usize) -> [f64; 3] {
        let value = |column: &Vec<f64>| if column.len() == 1 { column[0] } else { column[index] };
        [0, 1, 2].map(|column| value(&self.columns[column]))
    }

    /// The contacts.
    pub fn contacts(&self) -> PyResult<Vec<Contact>> {
        let contact = |index| {
            let [kappa, psi, damping] = self.parameters(index);
            Contact::new(kappa, psi, damping)
                .and_then(|contact| contact.with_law(self.law.0, self.law.1))
                .map_err(|error| Failure::from(error).exception(&self.place(index)))
        };
        (0..self.count).map(contact).collect()
    }

    /// Computes the collisions of a part, and tells `take` of each.
    fn collide(
        &self,
        engine: Engine,
        part: Range<usize>,
        mut take: impl FnMut(usize, Result<&Collision, Failure>),
    ) {
        // Any contact will do: only the memory is used.
        let Ok(any) = Contact::new(1.0, 1.0, 0.0) else { return };
        let mut collision = Collision::before(any);
        for index in part {
            let [kappa, psi, damping] = self.parameters(index);
            let contact = Contact::new(kappa, psi, damping)
                .and_then(|contact| contact.with_law(self.law.0, self.law.1))
                .map_err(Failure::from);
            let found = contact.and_then(|contact| {
                engine.collide_into(contact, &mut collision).map_err(Failure::from)
            });
            take(index, found.map(|_| &collision));
        }
    }

    /// The place of a case, for messages.
    fn place(&self, index: usize) -> String {
        let [kappa, psi, damping] = self.parameters(index);
        let number = if self.count == 1 { String::new() } else { format!("[{index}] ") };
        format!("{number}kappa = {kappa:?}, psi = {psi:?}, damping = {damping:?}: ")
    }
}

/// Cases without a result: their numbers and the reasons.
pub type Failures = Vec<(usize, Failure)>;

/// The first of the failures as an exception, if `strict`.
fn refuse(points: &Points, strict: bool, failures: &Failures) -> PyResult<()> {
    match failures.first() {
        Some((index, failure)) if strict => Err(failure.exception(&points.place(*index))),
        _ => Ok(()),
    }
}

/// ε_t and the number of switches of each collision; NaN and −1 where there is none, and the
/// numbers and reasons of those.
#[pyfunction]
#[pyo3(signature = (parameters, engine, law, strict, threads, progress=None))]
pub fn eps_t<'py>(
    py: Python<'py>,
    parameters: Parameters<'py>,
    engine: Choice,
    law: LawChoice,
    strict: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyTuple>> {
    let points = Points::new(&parameters, &law)?;
    let engine = engine.engine(points.law)?;
    let (mut eps_t, mut counts) = (Vec::new(), Vec::new());
    eps_t.reserve_exact(points.count);
    counts.reserve_exact(points.count);
    let mut failures = Vec::new();
    let work = |part: Range<usize>| {
        let mut failed = Failures::new();
        let mut results = Vec::with_capacity(part.len());
        points.collide(engine, part, |index, found| match found {
            Ok(found) => {
                let count = i32::try_from(found.switches.len()).unwrap_or(i32::MAX);
                results.push((found.eps_t(), count));
            }
            Err(failure) => {
                failed.push((index, failure));
                results.push((f64::NAN, -1));
            }
        });
        (results, failed)
    };
    let threads = Threads::new(threads, points.count)?.telling(progress);
    let ended = threads.each(py, points.count, work, |(results, failed)| {
        refuse(&points, strict, &failed)?;
        failures.extend(failed);
        eps_t.extend(results.iter().map(|result| result.0));
        counts.extend(results.iter().map(|result| result.1));
        Ok(())
    });
    let found =
        (eps_t.into_pyarray(py), counts.into_pyarray(py), messages(&failures)).into_pyobject(py)?;
    ended.map_err(|error| keeping(py, error, || Ok(found.clone().into_any())))?;
    Ok(found)
}

fn messages(failures: &Failures) -> Vec<(usize, String)> {
    failures.iter().map(|(index, failure)| (*index, failure.message())).collect()
}

/// Results of successive collisions, as columns.
#[derive(Default)]
pub struct Columns {
    eps_t: Vec<f64>,
    eps_n: Vec<f64>,
    final_velocity: Vec<f64>,
    contact_time: Vec<f64>,
    reversals: Vec<i64>,
    /// Numbers of itineraries, −1 where there is no collision.
    itinerary: Vec<i32>,
    itineraries: Vec<String>,
    numbers: HashMap<String, i32>,
    /// Numbers of switches.
    counts: Vec<i64>,
    times: Vec<f64>,
    times_left: Vec<f64>,
    stick: Vec<bool>,
    sides: Vec<i8>,
    springs: Vec<f64>,
    velocities: Vec<f64>,
    pub failures: Failures,
}

impl Columns {
    fn of(points: &Points, engine: Engine, part: Range<usize>) -> Self {
        let mut columns = Self::default();
        points.collide(engine, part, |index, found| match found {
            Ok(collision) => columns.push(collision),
            Err(failure) => columns.push_failure(index, failure),
        });
        columns
    }

    /// Adds the collision of a central impact, in which nothing is tangential.
    pub fn push_central(&mut self, collision: &Collision) {
        self.eps_t.push(f64::NAN);
        self.eps_n.push(collision.eps_n);
        self.final_velocity.push(0.0);
        self.contact_time.push(collision.contact_time);
        self.reversals.push(0);
        let number = self.number("o".to_owned());
        self.itinerary.push(number);
        self.counts.push(0);
    }

    pub fn push(&mut self, collision: &Collision) {
        self.eps_t.push(collision.eps_t());
        self.eps_n.push(collision.eps_n);
        self.final_velocity.push(collision.final_velocity);
        self.contact_time.push(collision.contact_time);
        self.reversals.push(i64::try_from(collision.reversals).unwrap_or(i64::MAX));
        let number = self.number(collision.itinerary());
        self.itinerary.push(number);
        self.counts.push(i64::try_from(collision.switches.len()).unwrap_or(i64::MAX));
        for switch in &collision.switches {
            self.times.push(switch.time);
            self.times_left.push(switch.time_left);
            self.stick.push(switch.to == Regime::Stick);
            self.sides.push(if switch.side.sign() > 0.0 { 1 } else { -1 });
            self.springs.push(switch.spring);
            self.velocities.push(switch.velocity);
        }
    }

    pub fn push_failure(&mut self, index: usize, failure: Failure) {
        for column in
            [&mut self.eps_t, &mut self.eps_n, &mut self.final_velocity, &mut self.contact_time]
        {
            column.push(f64::NAN);
        }
        self.reversals.push(-1);
        self.itinerary.push(-1);
        self.counts.push(0);
        self.failures.push((index, failure));
    }

    /// The number of an itinerary.
    fn number(&mut self, itinerary: String) -> i32 {
        let next = i32::try_from(self.itineraries.len()).unwrap_or(i32::MAX);
        *self.numbers.entry(itinerary).or_insert_with_key(|itinerary| {
            self.itineraries.push(itinerary.clone());
            next
        })
    }

    /// Adds the results of the collisions that follow.
    pub fn append(&mut self, part: Self) {
        let numbers: Vec<i32> = part.itineraries.into_iter().map(|one| self.number(one)).collect();
        let number = |index: &i32| usize::try_from(*index).map_or(-1, |index| numbers[index]);
        self.itinerary.extend(part.itinerary.iter().map(number));
        self.eps_t.extend(part.eps_t);
        self.eps_n.extend(part.eps_n);
        self.final_velocity.extend(part.final_velocity);
        self.contact_time.extend(part.contact_time);
        self.reversals.extend(part.reversals);
        self.counts.extend(part.counts);
        self.times.extend(part.times);
        self.times_left.extend(part.times_left);
        self.stick.extend(part.stick);
        self.sides.extend(part.sides);
        self.springs.extend(part.springs);
        self.velocities.extend(part.velocities);
        self.failures.extend(part.failures);
    }

    /// A dictionary of arrays.
    pub fn into_dictionary(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let mut offset = 0;
        let starts = self.counts.iter().map(|count| {
            offset += count;
            offset
        });
        let offsets: Vec<i64> = std::iter::once(0).chain(starts).collect();
        let arrays = PyDict::new(py);
        arrays.set_item("eps_t", self.eps_t.into_pyarray(py))?;
        arrays.set_item("eps_n", self.eps_n.into_pyarray(py))?;
        arrays.set_item("w_final", self.final_velocity.into_pyarray(py))?;
        arrays.set_item("contact_time", self.contact_time.into_pyarray(py))?;
        arrays.set_item("reversals", self.reversals.into_pyarray(py))?;
        arrays.set_item("itinerary", self.itinerary.into_pyarray(py))?;
        arrays.set_item("itineraries", self.itineraries)?;
        arrays.set_item("offsets", offsets.into_pyarray(py))?;
        arrays.set_item("time", self.times.into_pyarray(py))?;
        arrays.set_item("time_left", self.times_left.into_pyarray(py))?;
        arrays.set_item("stick", self.stick.into_pyarray(py))?;
        arrays.set_item("side", self.sides.into_pyarray(py))?;
        arrays.set_item("spring", self.springs.into_pyarray(py))?;
        arrays.set_item("velocity", self.velocities.into_pyarray(py))?;
        arrays.set_item("failures", messages(&self.failures))?;
        Ok(arrays)
    }
}

/// All results of each collision as a dictionary of arrays; switches lie one after another, those
/// of collision i from `offsets[i]` up to `offsets[i + 1]`.
#[pyfunction]
#[pyo3(signature = (parameters, engine, law, strict, threads, progress=None))]
pub fn collide_many<'py>(
    py: Python<'py>,
    parameters: Parameters<'py>,
    engine: Choice,
    law: LawChoice,
    strict: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let points = Points::new(&parameters, &law)?;
    let engine = engine.engine(points.law)?;
    let mut columns = Columns::default();
    let work = |part| Columns::of(&points, engine, part);
    let threads = Threads::new(threads, points.count)?.telling(progress);
    let ended = threads.each(py, points.count, work, |part| {
        refuse(&points, strict, &part.failures)?;
        columns.append(part);
        Ok(())
    });
    let found = columns.into_dictionary(py)?;
    ended.map_err(|error| keeping(py, error, || Ok(found.clone().into_any())))?;
    Ok(found)
}
