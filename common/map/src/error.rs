//! Errors of maps, with the value found, its place, and what is allowed.

use std::io;
use std::path::{Path, PathBuf};

/// Error of reading, building or writing a map.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    #[error("cannot read the map description {}", path.display())]
    Description { path: PathBuf, source: io::Error },
    #[error("map {name}")]
    OfSet { name: String, source: Box<MapError> },
    #[error(
        "a map of {width} x {height} cells takes about {needed_mb} MB in the graph{}; allowed are {limit_mb} MB (--memory-limit)",
        beside(*others_mb)
    )]
    Memory {
        width: u32,
        height: u32,
        needed_mb: u64,
        others_mb: u64,
        limit_mb: u64,
    },
    /// A value of the description is not allowed, or it is not YAML of the expected form: a syntax
    /// error, a missing or repeated key, or a list in place of a value.
    #[error("{}:{line}:{column}: {reason}", path.display())]
    Yaml {
        path: PathBuf,
        /// Line, from 1; 0 for the whole document.
        line: u64,
        column: u64,
        reason: String,
    },
    #[error("cannot read the image {}, named by {}:{line}:{column}", image.display(), yaml.display())]
    Image {
        image: PathBuf,
        yaml: PathBuf,
        line: u64,
        column: u64,
        source: io::Error,
    },
    #[error("{} is damaged or cut short", path.display())]
    ImageDecode {
        path: PathBuf,
        source: image::ImageError,
    },
    /// A file, a set or a grid breaks a rule: its name, the value found, and what is allowed.
    #[error("{0}")]
    Invalid(String),
    #[error("cannot write {}", path.display())]
    Write { path: PathBuf, source: io::Error },
}

impl MapError {
    /// Error of a file whose content breaks a rule; `found` follows its path.
    pub(crate) fn invalid(path: &Path, found: impl std::fmt::Display) -> Self {
        MapError::Invalid(format!("{} {found}", path.display()))
    }

    /// Error at a line and column of a description.
    pub(crate) fn at(path: &Path, (line, column): (u64, u64), reason: String) -> Self {
        MapError::Yaml {
            path: path.to_owned(),
            line,
            column,
            reason,
        }
    }

    /// Returns a function that converts an error of reading a description.
    pub(crate) fn unread(path: &Path) -> impl Fn(io::Error) -> Self + Copy {
        move |source| MapError::Description {
            path: path.to_owned(),
            source,
        }
    }

    /// Returns a function that converts an error of the image library.
    pub(crate) fn damaged(path: &Path) -> impl Fn(image::ImageError) -> Self + Copy {
        move |source| MapError::ImageDecode {
            path: path.to_owned(),
            source,
        }
    }
}

fn beside(others_mb: u64) -> String {
    match others_mb {
        0 => String::new(),
        _ => format!(", and the maps before it {others_mb} MB"),
    }
}
