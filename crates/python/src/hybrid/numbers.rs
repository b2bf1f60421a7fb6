//! Numbers that a callable returns.

use numpy::{PyArray1, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyString, PyTuple};

/// What is wrong with a returned object, without the place.
pub enum Problem {
    /// It is not made of real numbers.
    Type(String),
    /// Its shape is not the expected one.
    Shape(String),
    /// Python raised this while the object was read.
    Raised(PyErr),
}

impl From<PyErr> for Problem {
    fn from(error: PyErr) -> Self {
        Self::Raised(error)
    }
}

impl Problem {
    /// The exception, for what `function` has returned at `t`.
    pub fn exception(self, function: &str, t: f64) -> PyErr {
        match self {
            Self::Type(what) => PyTypeError::new_err(format!("{function}, at t = {t:?}: {what}")),
            Self::Shape(what) => PyValueError::new_err(format!("{function}, at t = {t:?}: {what}")),
            Self::Raised(error) => error,
        }
    }
}

/// Copies `result` to `out`, which has the length that is expected. A single number need not be in
/// a list. A `signed` number cannot be a truth value.
pub fn read(result: &Bound<'_, PyAny>, out: &mut [f64], signed: bool) -> Result<(), Problem> {
    if let ([out], Ok(number)) = (&mut *out, result.cast::<PyFloat>()) {
        *out = number.value();
        return Ok(());
    }
    if let Ok(array) = result.cast::<PyArray1<f64>>()
        && is_aligned(array)
    {
        return read_array(array, out);
    }
    let taken = if let Ok(list) = result.cast_exact::<PyList>() {
        list.len() == out.len() && read_items(list.iter(), out)?
    } else if let Ok(tuple) = result.cast_exact::<PyTuple>() {
        tuple.len() == out.len() && read_items(tuple.iter(), out)?
    } else {
        false
    };
    if taken { Ok(()) } else { read_anything(result, out, signed) }
}

/// Whether Rust can read the array where it lies. A field of records may lie at any byte.
fn is_aligned(array: &Bound<'_, PyArray1<f64>>) -> bool {
    array.data().is_aligned()
}

fn read_array(array: &Bound<'_, PyArray1<f64>>, out: &mut [f64]) -> Result<(), Problem> {
    if array.len() != out.len() {
        return Err(wrong_shape(&[array.len()], out.len()));
    }
    if !copy_contiguous(array, out) {
        out.copy_from_slice(&array.to_owned_array().to_vec());
    }
    Ok(())
}

/// Copies an array whose elements follow each other. Returns whether they do.
#[expect(unsafe_code, reason = "the checks of a borrow would cost more than the copy")]
fn copy_contiguous(array: &Bound<'_, PyArray1<f64>>, out: &mut [f64]) -> bool {
    // SAFETY: the slice lives for one copy, during which this thread is attached to the interpreter
    // and runs no other code, so that nothing writes to the array or frees it. `as_slice` checks
    // that the elements follow each other, and its length is that of the array.
    match unsafe { array.as_slice() } {
        Ok(slice) if slice.len() == out.len() => {
            out.copy_from_slice(slice);
            true
        }
        _ => false,
    }
}

/// Reads items that are floats or integers. Returns whether all are.
fn read_items<'py>(
    items: impl Iterator<Item = Bound<'py, PyAny>>,
    out: &mut [f64],
) -> PyResult<bool> {
    for (out, item) in out.iter_mut().zip(items) {
        if let Ok(number) = item.cast::<PyFloat>() {
            *out = number.value();
        } else if item.is_exact_instance_of::<PyInt>() {
            *out = item.extract()?;
        } else {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Reads what NumPy can make an array of real numbers of.
fn read_anything(result: &Bound<'_, PyAny>, out: &mut [f64], signed: bool) -> Result<(), Problem> {
    let py = result.py();
    if result.is_none() {
        return Err(Problem::Type(format!("it returns None; expected {}", numbers(out.len()))));
    }
    let as_array = {
        static AS_ARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        AS_ARRAY.import(py, "numpy", "asarray")?
    };
    let array = as_array.call1((result,)).map_err(|error| {
        // A list of lists of different lengths.
        if error.is_instance_of::<PyValueError>(py) {
            Problem::Shape(format!("{}; expected {}", error.value(py), numbers(out.len())))
        } else {
            Problem::Raised(error)
        }
    })?;
    let array = array.cast::<PyUntypedArray>().map_err(PyErr::from)?;
    let kind: String = array.dtype().getattr("kind")?.extract()?;
    let expected = out.len();
    let unfit = || {
        let name = result.get_type().name().map_or_else(|_| "object".into(), |n| n.to_string());
        let name = if kind == "c" { format!("complex numbers ({name})") } else { name };
        Problem::Type(format!("it returns {name}; expected {}", numbers(expected)))
    };
    let single_object = kind == "O" && array.ndim() == 0;
    if !matches!(kind.as_str(), "b" | "i" | "u" | "f" | "O")
        || (single_object && !result.hasattr("__float__")?)
        || result.is_instance_of::<PyString>()
    {
        return Err(unfit());
    }
    if signed && kind == "b" {
        let bool = if result.is_instance_of::<PyBool>() { "a bool" } else { "truth values" };
        return Err(Problem::Type(format!(
            "it returns {bool}; expected numbers that change their sign"
        )));
    }
    let fits = if out.len() == 1 { array.len() == 1 } else { array.shape() == [out.len()] };
    if !fits {
        return Err(wrong_shape(array.shape(), out.len()));
    }
    if kind == "O" {
        for (out, item) in out.iter_mut().zip(array.call_method0("ravel")?.try_iter()?) {
            let item = item?;
            if item.is_instance_of::<PyString>() || !item.hasattr("__float__")? {
                return Err(unfit());
            }
            *out = item.extract()?;
        }
        return Ok(());
    }
    let flat = array.call_method1("astype", ("float64",))?.call_method0("ravel")?;
    read_array(flat.cast::<PyArray1<f64>>().map_err(PyErr::from)?, out)
}

fn wrong_shape(shape: &[usize], expected: usize) -> Problem {
    let lengths: Vec<_> = shape.iter().map(ToString::to_string).collect();
    let comma = if shape.len() == 1 { "," } else { "" };
    let shape = format!("({}{comma})", lengths.join(", "));
    Problem::Shape(format!("it returns an array of shape {shape}; expected {}", numbers(expected)))
}

fn numbers(count: usize) -> String {
    match count {
        1 => "one number".into(),
        count => format!("{count} numbers, of shape ({count},)"),
    }
}
