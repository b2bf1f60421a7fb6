//! One call of a function of Python or of C.

use std::cell::RefCell;

use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyTuple};

use crate::failure::bad_input;
use crate::hybrid::arguments::{Callee, FunctionArguments};

/// A function of time and state, with what messages call it.
pub struct Function {
    pub label: String,
    pub code: Code,
}

/// What runs when a function is called.
pub enum Code {
    Compiled(Compiled),
    Python(Py<PyAny>),
}

impl Function {
    pub fn new(FunctionArguments(label, callee): FunctionArguments) -> PyResult<Self> {
        let code = match callee {
            Callee::Compiled(0, ..) => return Err(bad_input(format!("{label}: its address is 0"))),
            Callee::Compiled(address, parameters, keeper) => {
                Code::Compiled(Compiled { address, parameters, first: 0, keeper })
            }
            Callee::Python(callable) => Code::Python(callable),
        };
        Ok(Self { label, code })
    }

    pub fn is_compiled(&self) -> bool {
        matches!(self.code, Code::Compiled(_))
    }
}

/// A function `void f(double t, const double *y, double *out, const double *parameters)` of C.
pub struct Compiled {
    /// Where its code is; not 0.
    address: usize,
    /// Where its parameters are, or 0.
    parameters: usize,
    /// Its first parameter among those of a family.
    first: usize,
    /// What keeps both alive.
    keeper: Py<PyAny>,
}

type Signature = unsafe extern "C" fn(f64, *const f64, *mut f64, *const f64);

impl Compiled {
    /// The parameters of its own, which are copied to those of a family behind the two of the
    /// point, from `first` on.
    pub fn place_in_family(&mut self, py: Python<'_>, first: usize) -> PyResult<Vec<f64>> {
        self.first = first;
        let own = self.keeper.bind(py).getattr("parameters")?;
        let own: Option<PyReadonlyArray1<'_, f64>> = own.extract()?;
        Ok(own.map_or_else(Vec::new, |own| own.as_array().to_vec()))
    }

    /// Calls the function, with its own parameters or with those of a family. `y` is the state, and
    /// behind it the variables and the signs, where a system has such.
    #[expect(unsafe_code, reason = "code that Python names by its address can only be trusted")]
    pub fn call(&self, t: f64, y: &[f64], out: &mut [f64], family: Option<&[f64]>) {
        let family = family.map(|parameters| parameters[self.first..].as_ptr());
        // SAFETY: whoever made a `stickslip.Compiled` asserts what cannot be checked: at this
        // address is a function with this signature, it reads only the state, of the system's
        // dimension, and the parameters that are passed with it, writes only as many values as are
        // documented, and may be called by any thread. The documentation of `Compiled` says so. The
        // address is not 0, an integer of a pointer's size may be taken for a pointer to a
        // function, `keeper` keeps code and parameters alive, those of a family live during the
        // call as both slices do, and the slices do not overlap.
        unsafe {
            let function = std::mem::transmute::<usize, Signature>(self.address);
            let own = std::ptr::with_exposed_provenance(self.parameters);
            let parameters = family.unwrap_or(own);
            function(t, y.as_ptr(), out.as_mut_ptr(), parameters);
        }
    }
}

/// Callables that make named tuples of numbers, where a system has such.
pub struct Names {
    pub variables: Option<Py<PyAny>>,
    pub signs: Option<Py<PyAny>>,
}

/// What a function is called with.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    pub t: f64,
    pub y: &'a [f64],
    /// The values of the variables, and the number of the regime that has them.
    pub variables: (usize, &'a [f64]),
    /// The signs of surfaces, if the function is a right-hand side.
    pub signs: &'a [f64],
}

/// Calls callables of Python with a time and a state.
pub struct Caller {
    /// What follows time, state, variables and signs.
    args: Vec<Py<PyAny>>,
    /// The array of the last call, if nobody else has kept it.
    spare: RefCell<Option<Py<PyArray1<f64>>>>,
    /// The variables of the last call, with the number of their regime.
    variables: RefCell<Option<(usize, Py<PyAny>)>>,
    /// The signs of calls, by the bits of those that are positive.
    signs: RefCell<[Option<Py<PyAny>>; 16]>,
}

impl Caller {
    pub fn new(args: Vec<Py<PyAny>>) -> Self {
        let (spare, variables, signs) = Default::default();
        Self { args, spare, variables, signs }
    }

    /// Calls `callable`, and gives what it returns to `read`.
    ///
    /// The state is an array that belongs to the callable: it may keep and change it.
    pub fn call<T, E: From<PyErr>>(
        &self,
        callable: &Bound<'_, PyAny>,
        names: &Names,
        input: Input<'_>,
        read: impl FnOnce(&Bound<'_, PyAny>) -> Result<T, E>,
    ) -> Result<T, E> {
        let py = callable.py();
        let array = self.array(py, input.y);
        let data = array.data();
        let (variables, signs) = (self.variables(py, names, input)?, self.signs(py, names, input)?);
        let result = if self.args.is_empty() && variables.is_none() && signs.is_none() {
            callable.call1((input.t, &array))?
        } else {
            let first = [PyFloat::new(py, input.t).into_any(), array.clone().into_any()];
            let rest = self.args.iter().map(|one| one.bind(py).clone());
            let all: Vec<_> = first.into_iter().chain(variables).chain(signs).chain(rest).collect();
            callable.call1(PyTuple::new(py, all)?)?
        };
        let found = read(&result);
        drop(result);
        // Whoever keeps the array, or a view of it, holds another reference. The array itself may
        // have been given other memory.
        if has_one_owner(&array) && array.data() == data {
            *self.spare.borrow_mut() = Some(array.unbind());
        }
        found
    }

    /// The variables as callables get them, if there are any.
    fn variables<'py>(
        &self,
        py: Python<'py>,
        names: &Names,
        input: Input<'_>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(name) = &names.variables else { return Ok(None) };
        let (regime, values) = input.variables;
        let known =
            self.variables.borrow().as_ref().map(|(known, made)| (*known, made.clone_ref(py)));
        if let Some((known, made)) = known
            && known == regime
        {
            return Ok(Some(made.into_bound(py)));
        }
        let made = name.bind(py).call1((PyArray1::from_slice(py, values),))?;
        *self.variables.borrow_mut() = Some((regime, made.clone().unbind()));
        Ok(Some(made))
    }

    /// The signs as right-hand sides get them, if there are any.
    fn signs<'py>(
        &self,
        py: Python<'py>,
        names: &Names,
        input: Input<'_>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (Some(name), false) = (&names.signs, input.signs.is_empty()) else { return Ok(None) };
        let positive = |sum, &sign: &f64| 2 * sum + usize::from(sign > 0.0);
        let place = input.signs.iter().fold(0, positive);
        let known = self.signs.borrow()[place].as_ref().map(|made| made.clone_ref(py));
        if let Some(made) = known {
            return Ok(Some(made.into_bound(py)));
        }
        let made = name.bind(py).call1((PyTuple::new(py, input.signs)?,))?;
        self.signs.borrow_mut()[place] = Some(made.clone().unbind());
        Ok(Some(made))
    }

    /// An array of its own with the values of `y`.
    fn array<'py>(&self, py: Python<'py>, y: &[f64]) -> Bound<'py, PyArray1<f64>> {
        let spare = self.spare.borrow_mut().take().map(|array| array.into_bound(py));
        match spare {
            Some(array) if fill(&array, y) => array,
            _ => PyArray1::from_slice(py, y),
        }
    }
}

/// Whether there is no other reference to the array.
#[expect(unsafe_code, reason = "PyO3 counts references in no safe function")]
fn has_one_owner(array: &Bound<'_, PyArray1<f64>>) -> bool {
    // SAFETY: the pointer is that of an object which `array` keeps alive, and this thread is
    // attached to the interpreter.
    unsafe { pyo3::ffi::Py_REFCNT(array.as_ptr()) == 1 }
}

/// Writes `y` to an array to which nobody else has a reference. Returns whether it fits: whoever
/// had the array may have changed its shape.
#[expect(unsafe_code, reason = "the checks of a borrow would cost more than the copy")]
fn fill(array: &Bound<'_, PyArray1<f64>>, y: &[f64]) -> bool {
    // A callable may have changed the type of the elements.
    if array.as_any().cast::<PyArray1<f64>>().is_err() || array.len() != y.len() {
        return false;
    }
    // SAFETY: the only reference to the array is this one, so that no slice of it exists, and this
    // thread runs no other code during the copy. The elements are doubles, which was just checked;
    // `as_slice_mut` checks that they follow each other.
    match unsafe { array.as_slice_mut() } {
        Ok(slice) if slice.len() == y.len() => {
            slice.copy_from_slice(y);
            true
        }
        _ => false,
    }
}
