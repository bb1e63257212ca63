//! Results that Python can pickle, copy and compare: by their fields.

use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::numbers::PoseTuple;

/// A callable that restores an object, and its arguments.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyDict>,));

/// Defines a class of results, with the methods that all have.
macro_rules! by_fields {
    (
        $(#[$($of_class:tt)+])*
        struct $class:ident { $($(#[$($of_field:tt)+])* $field:ident: $type:ty,)+ }
    ) => {
        $(#[$($of_class)+])*
        pub(crate) struct $class { $($(#[$($of_field)+])* $field: $type,)+ }

        impl $class {
            const FIELDS: &[&str] = &[$(stringify!($field)),+];
        }

        #[pymethods]
        impl $class {
            /// Homogeneous matrix of pose, 3 × 3: map coordinates (x, y, 1) of a point in the frame
            /// of the pose; None if there is no pose.
            fn matrix(&self, py: Python<'_>) -> PyResult<Option<Py<PyArray2<f64>>>> {
                self.pose.map(|pose| numbers::homogeneous(py, pose)).transpose()
            }

            fn __eq__(slf: &Bound<'_, Self>, other: &Bound<'_, PyAny>) -> PyResult<bool> {
                kept::are_equal(slf, other, Self::FIELDS)
            }

            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<kept::Reduced<'py>> {
                kept::reduce(slf, Self::FIELDS)
            }

            #[staticmethod]
            fn _restore(fields: &Bound<'_, PyDict>) -> PyResult<Self> {
                Ok($class { $($field: kept::field(fields, stringify!($field))?.extract()?),+ })
            }

            fn __repr__(&self) -> String {
                self.shown()
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

/// Shows a result: its class with a verdict, the pose if there is one, and the reason.
pub(crate) fn shown(what: &str, frame: &str, pose: Option<PoseTuple>, why: &str) -> String {
    let place = pose.map_or(String::new(), |(x, y, yaw)| {
        format!("{frame} at x {x:.3} m, y {y:.3} m, yaw {yaw:.4} rad; ")
    });
    format!("<backcast.{what}: {place}{why}>")
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
