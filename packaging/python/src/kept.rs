//! Results that Python can pickle, copy and compare: by their fields.

use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What Python calls to restore an object, and its arguments.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyDict>,));

/// Names the fields of a result and restores it from them.
macro_rules! by_fields {
    ($class:ident { $($field:ident),+ $(,)? }) => {
        impl $class {
            const FIELDS: &[&str] = &[$(stringify!($field)),+];

            fn of_fields(fields: &pyo3::Bound<'_, pyo3::types::PyDict>) -> pyo3::PyResult<Self> {
                Ok($class { $($field: crate::kept::field(fields, stringify!($field))?.extract()?),+ })
            }
        }
    };
}
pub(crate) use by_fields;

/// Returns the static method `_restore` of the object's class, and the fields.
pub(crate) fn reduce<'py>(object: &Bound<'py, PyAny>, names: &[&str]) -> PyResult<Reduced<'py>> {
    let fields = PyDict::new(object.py());
    for name in names {
        fields.set_item(name, object.getattr(name)?)?;
    }
    Ok((object.get_type().getattr("_restore")?, (fields,)))
}

pub(crate) fn field<'py>(fields: &Bound<'py, PyDict>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let field = fields.get_item(name)?;
    field.ok_or_else(|| PyKeyError::new_err(name.to_owned()))
}

/// True if the other object is of the same class with equal fields.
pub(crate) fn are_equal(
    object: &Bound<'_, PyAny>,
    other: &Bound<'_, PyAny>,
    names: &[&str],
) -> PyResult<bool> {
    if !object.get_type().is(other.get_type()) {
        return Ok(false);
    }
    let array_equal = object.py().import("numpy")?.getattr("array_equal")?;
    for name in names {
        let same = array_equal.call1((object.getattr(name)?, other.getattr(name)?))?;
        if !same.extract::<bool>()? {
            return Ok(false);
        }
    }
    Ok(true)
}
