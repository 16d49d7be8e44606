//! Material laws that are Python objects.

use std::sync::{Arc, PoisonError};

use carom::algebra::{Mat, Vector};
use carom::solid::Past;
use carom::solid::material::{Material, NotPositive, Thickness, excess_det};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::function::Failure;

/// Largest count of numbers that a point remembers.
const MOST: usize = 16;

/// A Python object with the method `response(F, memory)`, which returns what a point of the
/// material stores, dissipates in the step, P, ∂P/∂F, and its new memory.
///
/// `MEMORY` is 0 for an object that remembers nothing, and otherwise the most that any may
/// remember.
#[derive(Clone)]
pub(crate) struct Law<const MEMORY: usize> {
    name: String,
    object: Arc<Py<PyAny>>,
    /// Count of numbers that a point remembers.
    memory: usize,
    failure: Failure,
}

/// Answer of the object at a point.
pub(crate) struct Point {
    f: [[f64; 3]; 3],
    det_f: f64,
    stored: f64,
    dissipated: f64,
    stress: Vec<f64>,
    moduli: Vec<f64>,
    memory: Vec<f64>,
}

/// The law of a material: what remembers nothing is evaluated where elastic laws are, also its
/// stress at probes.
pub(crate) enum OwnLaw {
    Elastic(Law<0>),
    WithMemory(Law<MOST>),
}

impl OwnLaw {
    /// The law of a material from its object, whose attribute `memory` is the count of numbers.
    pub(crate) fn new(name: String, object: &Bound<'_, PyAny>, failure: Failure) -> PyResult<Self> {
        let given = object.getattr("memory")?;
        let wrong = |why: String| {
            PyValueError::new_err(format!("the law of `{name}` remembers {given} numbers; {why}"))
        };
        let memory: usize =
            given.extract().map_err(|_| wrong("it must be a whole number from 0 on".into()))?;
        if memory > MOST {
            return Err(wrong(format!("the most is {MOST}")));
        }
        object.getattr("response")?;
        let object = Arc::new(object.clone().unbind());
        Ok(if memory == 0 {
            Self::Elastic(Law { name, object, memory, failure })
        } else {
            Self::WithMemory(Law { name, object, memory, failure })
        })
    }
}

impl<const MEMORY: usize> Law<MEMORY> {
    fn called(&self, py: Python<'_>, f: [[f64; 3]; 3], memory: &[f64]) -> PyResult<Point> {
        let numpy = py.import("numpy")?;
        let numbers = |values: &Bound<'_, PyAny>, count: usize, what: &str| -> PyResult<Vec<f64>> {
            let flat = numpy.call_method1("ravel", (values,))?.call_method1("astype", ("float64",))?;
            let flat: PyReadonlyArray1<'_, f64> = flat.extract()?;
            let found = flat.as_array().to_vec();
            if let Some(number) = found.iter().find(|number| !number.is_finite()) {
                return Err(self.not_finite(what, *number));
            }
            if found.len() == count { Ok(found) } else { Err(self.wrong(what, found.len(), count)) }
        };
        let finite = |number: f64, what: &str| {
            if number.is_finite() { Ok(number) } else { Err(self.not_finite(what, number)) }
        };
        let gradient = PyArray1::from_slice(py, f.as_flattened()).reshape([3, 3])?;
        let arguments = (gradient, PyArray1::from_slice(py, memory));
        let answer = self.object.bind(py).call_method1("response", arguments)?;
        let Ok(answer) = answer.cast::<PyTuple>() else {
            let kind = answer.get_type().name()?;
            let name = &self.name;
            return Err(PyValueError::new_err(format!(
                "`response` of the law of `{name}` must return a tuple (stored, dissipated, P, dP/dF, memory), not \
                 a {kind}"
            )));
        };
        if answer.len() != 5 {
            return Err(self.wrong("(stored, dissipated, P, dP/dF, memory)", answer.len(), 5));
        }
        Ok(Point {
            f,
            det_f: 0.0,
            stored: finite(answer.get_item(0)?.extract()?, "the stored energy")?,
            dissipated: finite(answer.get_item(1)?.extract()?, "the dissipated energy")?,
            stress: numbers(&answer.get_item(2)?, 9, "P of shape (3, 3)")?,
            moduli: numbers(&answer.get_item(3)?, 81, "dP/dF of shape (3, 3, 3, 3)")?,
            memory: numbers(&answer.get_item(4)?, self.memory, "the new memory")?,
        })
    }

    fn not_finite(&self, what: &str, number: f64) -> PyErr {
        let name = &self.name;
        PyValueError::new_err(format!("`response` of the law of `{name}` returns {number} for {what}"))
    }

    fn wrong(&self, what: &str, found: usize, count: usize) -> PyErr {
        let name = &self.name;
        PyValueError::new_err(format!(
            "`response` of the law of `{name}` must return {what}: {count} numbers or parts, not {found}"
        ))
    }
}

impl Point {
    fn stress<const D: usize>(&self) -> Mat<D> {
        Mat(std::array::from_fn(|i| std::array::from_fn(|j| self.stress[3 * i + j])))
    }
}

impl<const D: usize, const M: usize> Material<D> for Law<M> {
    const MEMORY: usize = M;
    type Point = Point;

    /// Unknown: the object does not say what its numbers mean.
    fn plastic_strain(&self, _: &[f64]) -> f64 {
        f64::NAN
    }

    fn after(&self, h: &Mat<D>, past: &Past) -> Result<Point, NotPositive> {
        let det_f = 1.0 + excess_det(h);
        if det_f.is_nan() || det_f <= 0.0 {
            return Err(NotPositive(det_f));
        }
        let failure = || self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        if failure().is_some() {
            return Err(NotPositive(f64::NAN));
        }
        let mut f = Mat::<3>::identity().0;
        for i in 0..D {
            for j in 0..D {
                f[i][j] += h.0[i][j];
            }
        }
        match Python::attach(|py| self.called(py, f, &past.memory[..self.memory])) {
            Ok(point) => Ok(Point { det_f, ..point }),
            Err(error) => {
                *failure() = Some(error);
                Err(NotPositive(f64::NAN))
            }
        }
    }

    fn remember(&self, p: &Point, memory: &mut [f64]) {
        memory[..self.memory].copy_from_slice(&p.memory);
    }

    fn dissipated(&self, p: &Point) -> f64 {
        p.dissipated
    }

    fn energy(&self, p: &Point) -> f64 {
        p.stored
    }

    fn stress(&self, p: &Point) -> Mat<D> {
        p.stress()
    }

    fn tangent(&self, p: &Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let mut block = Mat::ZERO;
        for i in 0..D {
            for k in 0..D {
                for j in 0..D {
                    for l in 0..D {
                        block.0[i][k] += p.moduli[((3 * i + j) * 3 + k) * 3 + l] * a[j] * b[l];
                    }
                }
            }
        }
        block
    }

    fn lateral(&self, p: &Point) -> f64 {
        if D < 3 { p.stress[8] * p.f[2][2] / p.det_f } else { 0.0 }
    }
}

impl<const MEMORY: usize> Thickness for Law<MEMORY> {}
