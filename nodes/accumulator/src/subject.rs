//! Subject of a log or health message: a map or a set of maps.

use std::fmt;

use messages::{MapHeader, MapName};

use crate::AccumulatorError;

/// Refused map or set, and the reason. The error is boxed because it is large and rare.
pub(crate) type Refused = (Subject, Box<AccumulatorError>);

/// Map, displayed by its name if it has one, or set of maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    Map {
        map_id: u64,
        /// Name of the map; empty for a map that is served alone.
        name: MapName,
    },
    /// All maps of a set, by the set's id.
    Set(u64),
}

impl Subject {
    pub fn map(header: &MapHeader) -> Self {
        Subject::Map {
            map_id: header.map_id,
            name: header.name,
        }
    }

    #[must_use]
    pub(crate) fn refused(self, error: impl Into<AccumulatorError>) -> Refused {
        (self, Box::new(error.into()))
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Subject::Set(set_id) => write!(f, "set of maps {set_id:016x}"),
            Subject::Map { map_id, name } => match name.as_str() {
                "" => write!(f, "map {map_id:016x}"),
                name => write!(f, "map {name} ({map_id:016x})"),
            },
        }
    }
}
