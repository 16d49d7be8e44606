//! Python functions of time and place as loads and motions.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use carom::case::{Function, Functions};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyTuple};

/// The first exception that a function raised.
pub(crate) type Failure = Arc<Mutex<Option<PyErr>>>;

/// A callable f(t) or f(t, X) with X of shape (points, dimension).
struct Given {
    name: String,
    callable: Py<PyAny>,
    /// Whether it takes X.
    of_place: bool,
    failure: Failure,
}

impl fmt::Debug for Given {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

/// Functions by name, and the place of their first exception.
pub(crate) fn functions(given: &Bound<'_, PyDict>) -> PyResult<(Functions, Failure)> {
    let py = given.py();
    let mut functions = Functions::default();
    let failure = Failure::default();
    for (name, callable) in given {
        let name: String = name.extract()?;
        let of_place = py.import("carom.functions")?.call_method1("takes_place", (&callable,))?.extract()?;
        let callable = callable.unbind();
        let function = Given { name: name.clone(), callable, of_place, failure: failure.clone() };
        functions.0.insert(name, Arc::new(function));
    }
    Ok((functions, failure))
}

/// The exception of a function, if one raised.
pub(crate) fn raised(failure: &Failure) -> Option<PyErr> {
    failure.lock().unwrap_or_else(PoisonError::into_inner).take()
}

impl Given {
    /// Calls the function once for all points; its values as `parts` lists of numbers.
    fn call(&self, points: &[f64], width: usize, parts: usize) -> Option<Vec<Vec<f64>>> {
        let failure = || self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        if failure().is_some() {
            return None;
        }
        let called = Python::attach(|py| self.called(py, points, width, parts));
        called.map_err(|error| *failure() = Some(error)).ok()
    }

    fn called(&self, py: Python<'_>, points: &[f64], width: usize, parts: usize) -> PyResult<Vec<Vec<f64>>> {
        let d = width - 1;
        let count = points.len() / width;
        let time = points.first().map_or(0.0, |_| points[d]);
        let callable = self.callable.bind(py);
        let values = if self.of_place {
            let places = points.chunks_exact(width).flat_map(|point| point[..d].iter().copied()).collect();
            callable.call1((time, PyArray1::from_vec(py, places).reshape([count, d])?))?
        } else {
            callable.call1((time,))?
        };
        if parts == 1 {
            return Ok(vec![self.numbers(&values, count, "a number per point")?]);
        }
        let expected = "displacement, velocity and acceleration (u, v, a)";
        let tuple = values.cast::<PyTuple>().ok().filter(|tuple| tuple.len() == parts);
        let tuple = tuple.ok_or_else(|| self.wrong(&values, expected))?;
        tuple.iter().map(|part| self.numbers(&part, count, expected)).collect()
    }

    /// A number for all points, or an array with one for each.
    fn numbers(&self, values: &Bound<'_, PyAny>, count: usize, expected: &str) -> PyResult<Vec<f64>> {
        // Nearly always a number or such an array; anything else is what NumPy makes of it.
        if let Ok(number) = values.cast::<PyFloat>() {
            return Ok(vec![number.value(); count]);
        }
        if let Ok(array) = values.extract::<PyReadonlyArray1<'_, f64>>()
            && array.len()? == count
        {
            return Ok(array.as_array().to_vec());
        }
        let py = values.py();
        let array = py.import("numpy")?.call_method1("ravel", (values,))?;
        let array = array.call_method1("astype", ("float64",))?;
        let array: PyReadonlyArray1<'_, f64> = array.extract().map_err(|_| self.wrong(values, expected))?;
        let found = array.as_slice()?;
        match found.len() {
            1 => Ok(vec![found[0]; count]),
            n if n == count => Ok(found.to_vec()),
            found => Err(self.wrong_count(found, count, expected)),
        }
    }

    fn wrong(&self, values: &Bound<'_, PyAny>, expected: &str) -> PyErr {
        let got = values.repr().map_or_else(|_| "?".to_owned(), |text| text.to_string());
        PyValueError::new_err(format!("the function `{}` must return {expected}, not {got}", self.name))
    }

    fn wrong_count(&self, found: usize, count: usize, expected: &str) -> PyErr {
        let name = &self.name;
        PyValueError::new_err(format!(
            "the function `{name}` must return {expected}: one, or {count} for the {count} points, not {found}"
        ))
    }
}

impl Function for Given {
    fn values(&self, points: &[f64], width: usize) -> Vec<f64> {
        let count = points.len() / width;
        self.call(points, width, 1).and_then(|mut parts| parts.pop()).unwrap_or_else(|| vec![f64::NAN; count])
    }

    fn with_derivatives(&self, points: &[f64], width: usize) -> Vec<[f64; 3]> {
        let count = points.len() / width;
        self.call(points, width, 3).map_or_else(
            || vec![[f64::NAN; 3]; count],
            |parts| (0..count).map(|k| [parts[0][k], parts[1][k], parts[2][k]]).collect(),
        )
    }
}
