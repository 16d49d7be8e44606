//! Columns as NumPy arrays.

use std::collections::HashMap;

use carom::record::metrics::Unit;
use carom::record::{ContactRow, History, contact_columns};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// A read-only array that owns these values; nothing is copied.
pub(crate) fn array(py: Python<'_>, values: Vec<f64>) -> PyResult<Bound<'_, PyArray1<f64>>> {
    let array = PyArray1::from_vec(py, values);
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// A read-only array with rows of `width` values.
pub(crate) fn rows(py: Python<'_>, values: Vec<f64>, width: usize) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let height = values.len() / width.max(1);
    // A view of a read-only array cannot be made writable again.
    array(py, values)?.reshape([height, width])
}

/// A read-only array of integers.
pub(crate) fn integers(py: Python<'_>, values: Vec<i64>) -> PyResult<Bound<'_, PyArray1<i64>>> {
    let array = PyArray1::from_vec(py, values);
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// The values of a column of `contact.csv`.
enum Values {
    Integer(fn(&ContactRow) -> u64),
    Real(fn(&ContactRow) -> f64),
    Text(for<'a> fn(&'a ContactRow<'_>) -> &'a str),
}

/// Unit and values of a column of `contact.csv`.
fn column(name: &str) -> PyResult<(Unit, Values)> {
    use Values::{Integer, Real, Text};
    Ok(match name {
        "step" => (Unit::None, Integer(|row| row.step)),
        "time" => (Unit::Time, Real(|row| row.time)),
        "contact" => (Unit::None, Text(|row| &row.contact)),
        "node" => (Unit::None, Integer(|row| row.node)),
        "x" => (Unit::Length, Real(|row| row.point[0])),
        "y" => (Unit::Length, Real(|row| row.point[1])),
        "z" => (Unit::Length, Real(|row| row.point[2])),
        "facet" => (Unit::None, Integer(|row| row.facet)),
        "xi" => (Unit::None, Real(|row| row.xi)),
        "eta" => (Unit::None, Real(|row| row.eta)),
        "gap" => (Unit::Length, Real(|row| row.gap)),
        "multiplier" => (Unit::Force, Real(|row| row.multiplier)),
        "pressure" => (Unit::Stress, Real(|row| row.pressure)),
        "normal_x" => (Unit::None, Real(|row| row.normal[0])),
        "normal_y" => (Unit::None, Real(|row| row.normal[1])),
        "normal_z" => (Unit::None, Real(|row| row.normal[2])),
        "friction" => (Unit::None, Text(|row| &row.friction)),
        "traction" => (Unit::Force, Real(|row| row.traction)),
        "slip" => (Unit::Length, Real(|row| row.slip)),
        "friction_x" => (Unit::Force, Real(|row| row.rubbing[0])),
        "friction_y" => (Unit::Force, Real(|row| row.rubbing[1])),
        "friction_z" => (Unit::Force, Real(|row| row.rubbing[2])),
        other => return Err(PyRuntimeError::new_err(format!("the column {other} has no type"))),
    })
}

/// Unit labels of the columns of `contact.csv`, in the units of the history.
pub(crate) fn contact_units(history: &History, axes: usize) -> PyResult<HashMap<&'static str, String>> {
    contact_columns(axes).into_iter().map(|name| Ok((name, column(name)?.0.label(history)))).collect()
}

/// Rows of `contact.csv` by column.
pub(crate) fn contact<'py>(
    py: Python<'py>,
    rows: &[ContactRow],
    axes: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for name in contact_columns(axes) {
        match column(name)?.1 {
            Values::Integer(of) => {
                dict.set_item(name, integers(py, rows.iter().map(|row| of(row) as i64).collect())?)?;
            }
            Values::Real(of) => dict.set_item(name, array(py, rows.iter().map(of).collect())?)?,
            Values::Text(of) => dict.set_item(name, PyList::new(py, rows.iter().map(of))?)?,
        }
    }
    Ok(dict)
}
