//! JSON Schemas of objects, made from their types, for `docs/schemas`. Pure.
//!
//! They say what is written: a field that may be absent is not required, and further fields are
//! allowed.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};

use super::Versioned;

/// A schema with the name of its file, without its ending.
pub type Named = (&'static str, Schema);

/// Returns the schema of the objects that [`object`](super::object) prints of this type.
pub fn of_object<T: JsonSchema>(name: &'static str) -> Named {
    of_file::<Versioned<'_, T>>(name)
}

/// Returns the schema of a file with a value of this type, which has no field `schema`.
pub fn of_file<T: JsonSchema>(name: &'static str) -> Named {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    schema.insert("title".to_owned(), name.into());
    (name, schema)
}

/// Pose in the map.
// Stands for the poses of `geometry` and `messages`, which do not depend on `schemars`.
#[derive(JsonSchema)]
pub struct Pose {
    /// Position along x in metres.
    pub x: f64,
    /// Position along y in metres.
    pub y: f64,
    /// Heading in radians, counter-clockwise.
    pub yaw: f64,
}
