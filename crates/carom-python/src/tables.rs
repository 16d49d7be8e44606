//! Columns as NumPy arrays.

use carom::record::metrics::Unit;
use carom::record::{ContactRow, History, contact_columns};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// A read-only array that owns these values; nothing is copied.
pub(crate) fn array(py: Python<'_>, values: Vec<f64>) -> PyResult<Bound<'_, PyArray1<f64>>> {
    let array = PyArray1::from_vec(py, values);
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// The same with rows of `width` values.
pub(crate) fn rows(py: Python<'_>, values: Vec<f64>, width: usize) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let height = values.len() / width.max(1);
    let rows = PyArray1::from_vec(py, values).reshape([height, width])?;
    rows.call_method1("setflags", (false,))?;
    Ok(rows)
}

/// A read-only array of integers.
pub(crate) fn integers(py: Python<'_>, values: Vec<i64>) -> PyResult<Bound<'_, PyArray1<i64>>> {
    let array = PyArray1::from_vec(py, values);
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// Unit labels of the columns of `contact.csv`, in the units of the history.
pub(crate) fn contact_units(history: &History, axes: usize) -> Vec<(&'static str, String)> {
    let unit = |name: &str| match name {
        "time" => Unit::Time,
        "x" | "y" | "z" | "gap" => Unit::Length,
        "multiplier" => Unit::Force,
        "pressure" => Unit::Stress,
        _ => Unit::None,
    };
    contact_columns(axes).into_iter().map(|name| (name, unit(name).label(history))).collect()
}

/// Rows of `contact.csv` by column.
pub(crate) fn contact<'py>(
    py: Python<'py>,
    rows: &[ContactRow],
    axes: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let names = contact_columns(axes);
    let count = |of: fn(&ContactRow) -> u64| integers(py, rows.iter().map(|row| of(row) as i64).collect());
    let reals = |of: &dyn Fn(&ContactRow) -> f64| array(py, rows.iter().map(of).collect());
    for (i, name) in names.iter().enumerate() {
        match *name {
            "step" => dict.set_item(name, count(|row| row.step)?)?,
            "node" => dict.set_item(name, count(|row| row.node)?)?,
            "facet" => dict.set_item(name, count(|row| row.facet)?)?,
            "contact" => dict.set_item(name, PyList::new(py, rows.iter().map(|row| &*row.contact))?)?,
            "time" => dict.set_item(name, reals(&|row| row.time)?)?,
            "xi" => dict.set_item(name, reals(&|row| row.xi)?)?,
            "gap" => dict.set_item(name, reals(&|row| row.gap)?)?,
            "multiplier" => dict.set_item(name, reals(&|row| row.multiplier)?)?,
            "pressure" => dict.set_item(name, reals(&|row| row.pressure)?)?,
            // The positions follow the first four columns, and the normals are last.
            _ if i < 4 + axes => dict.set_item(name, reals(&|row| row.point[i - 4])?)?,
            _ => dict.set_item(name, reals(&|row| row.normal[i + axes - names.len()])?)?,
        }
    }
    Ok(dict)
}
