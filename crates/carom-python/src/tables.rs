//! Columns as NumPy arrays.

use std::collections::HashMap;

use carom::record::{ContactCell, ContactColumns, ContactRow, ContactValue, History};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
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

/// Unit labels of the columns of `contact.csv`, in the units of the history.
pub(crate) fn contact_units(history: &History, columns: ContactColumns) -> HashMap<&'static str, String> {
    let mut row = ContactRow::default();
    row.cells(columns).into_iter().map(|cell| (cell.name, cell.unit.label(history))).collect()
}

/// Values of a column of `contact.csv`.
enum Values {
    Integers(Vec<i64>),
    Reals(Vec<f64>),
    Texts(Vec<String>),
}

/// Rows of `contact.csv` by column.
pub(crate) fn contact<'py>(
    py: Python<'py>,
    rows: &[ContactRow],
    columns: ContactColumns,
) -> PyResult<Bound<'py, PyDict>> {
    let empty = |cell: ContactCell| match cell.value {
        ContactValue::Count(_) => Values::Integers(Vec::new()),
        ContactValue::Real(_) => Values::Reals(Vec::new()),
        ContactValue::Text(_) => Values::Texts(Vec::new()),
    };
    let mut values: Vec<Values> = ContactRow::default().cells(columns).into_iter().map(empty).collect();
    for row in rows {
        for (column, cell) in values.iter_mut().zip(row.clone().cells(columns)) {
            match (column, cell.value) {
                (Values::Integers(column), ContactValue::Count(count)) => column.push(*count as i64),
                (Values::Reals(column), ContactValue::Real(real)) => column.push(*real),
                (Values::Texts(column), ContactValue::Text(text)) => column.push(text.to_string()),
                _ => unreachable!("the type of a column is that of its values"),
            }
        }
    }
    let dict = PyDict::new(py);
    for (name, column) in ContactRow::columns(columns).into_iter().zip(values) {
        match column {
            Values::Integers(values) => dict.set_item(name, integers(py, values)?)?,
            Values::Reals(values) => dict.set_item(name, array(py, values)?)?,
            Values::Texts(values) => dict.set_item(name, PyList::new(py, values)?)?,
        }
    }
    Ok(dict)
}
