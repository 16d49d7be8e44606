//! Plain data between Rust, TOML and Python.

use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde_json::Value as Json;
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use crate::error::CaseError;

/// A JSON value as Python object.
pub(crate) fn from_json<'py>(py: Python<'py>, value: &Json) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Json::Null => Ok(py.None().into_bound(py)),
        Json::Bool(value) => value.into_bound_py_any(py),
        Json::Number(number) => match (number.as_i64(), number.as_u64()) {
            (Some(integer), _) => integer.into_bound_py_any(py),
            (None, Some(integer)) => integer.into_bound_py_any(py),
            (None, None) => number.as_f64().into_bound_py_any(py),
        },
        Json::String(text) => text.into_bound_py_any(py),
        Json::Array(list) => {
            let list = list.iter().map(|value| from_json(py, value)).collect::<PyResult<Vec<_>>>()?;
            Ok(PyList::new(py, list)?.into_any())
        }
        Json::Object(map) => {
            let dict = PyDict::new(py);
            map.iter().try_for_each(|(key, value)| dict.set_item(key, from_json(py, value)?))?;
            Ok(dict.into_any())
        }
    }
}

/// A Python object as TOML value, on one line.
pub(crate) fn to_toml(object: &Bound<'_, PyAny>) -> PyResult<Value> {
    if object.is_instance_of::<PyBool>() {
        Ok(object.extract::<bool>()?.into())
    } else if object.is_instance_of::<PyInt>() {
        let number: i64 = object.extract().map_err(|_| {
            CaseError::new_err(format!("{object} is too large: an integer of a case has at most 64 bits"))
        })?;
        Ok(number.into())
    } else if object.is_instance_of::<PyFloat>() {
        Ok(object.extract::<f64>()?.into())
    } else if object.is_instance_of::<PyString>() {
        Ok(object.extract::<String>()?.into())
    } else if let Ok(dict) = object.cast::<PyDict>() {
        let mut table = InlineTable::new();
        for (key, value) in dict {
            table.insert(key.extract::<String>()?, to_toml(&value)?);
        }
        Ok(table.into())
    } else if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let mut array = Array::new();
        for value in object.try_iter()? {
            array.push(to_toml(&value?)?);
        }
        Ok(array.into())
    } else {
        let kind = object.get_type().name()?.to_string();
        Err(PyTypeError::new_err(format!(
            "a case has numbers, strings, lists and tables, not {kind}: {}",
            object.repr()?
        )))
    }
}

/// A Python dictionary as a TOML document: tables under headers, lists of tables under `[[…]]`.
pub(crate) fn to_document(dict: &Bound<'_, PyDict>) -> PyResult<DocumentMut> {
    Ok(DocumentMut::from(to_table(dict)?))
}

fn to_table(dict: &Bound<'_, PyDict>) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, value) in dict {
        let item = if let Ok(dict) = value.cast::<PyDict>() {
            Item::Table(to_table(dict)?)
        } else if let Ok(list) = value.cast::<PyList>()
            && !list.is_empty()
            && list.iter().all(|entry| entry.is_instance_of::<PyDict>())
        {
            let mut tables = ArrayOfTables::new();
            for entry in list {
                // The tables within are on one line, so that the text is that of a case file.
                tables.push(to_toml(&entry)?.as_inline_table().cloned().unwrap_or_default().into_table());
            }
            Item::ArrayOfTables(tables)
        } else {
            Item::Value(to_toml(&value)?)
        };
        table.insert(&key.extract::<String>()?, item);
    }
    Ok(table)
}

/// A TOML table as Python dictionary.
pub(crate) fn from_table<'py>(py: Python<'py>, table: &dyn TableLike) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, item) in table.iter() {
        let value = match item {
            Item::None => continue,
            Item::Value(value) => from_value(py, value)?,
            Item::Table(table) => from_table(py, table)?.into_any(),
            Item::ArrayOfTables(tables) => {
                let tables = tables.iter().map(|t| from_table(py, t)).collect::<PyResult<Vec<_>>>()?;
                PyList::new(py, tables)?.into_any()
            }
        };
        dict.set_item(key, value)?;
    }
    Ok(dict)
}

fn from_value<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::String(text) => text.value().into_bound_py_any(py),
        Value::Integer(number) => (*number.value()).into_bound_py_any(py),
        Value::Float(number) => (*number.value()).into_bound_py_any(py),
        Value::Boolean(value) => (*value.value()).into_bound_py_any(py),
        Value::Datetime(time) => time.value().to_string().into_bound_py_any(py),
        Value::Array(array) => {
            let list = array.iter().map(|v| from_value(py, v)).collect::<PyResult<Vec<_>>>()?;
            Ok(PyList::new(py, list)?.into_any())
        }
        Value::InlineTable(table) => Ok(from_table(py, table)?.into_any()),
    }
}
