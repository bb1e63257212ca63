//! The keys of a map's description, with their values as the file spells them.
//!
//! Numbers may stand in quotes, as some programs write them, and as YAML's or
//! C's words for what is not finite; whether a value is allowed is not judged
//! here. Keys that are not known are collected with their place.

use std::fmt::{self, Display, Formatter};

use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, Visitor};
use serde_saphyr::Spanned;

/// All keys that have a meaning.
const KNOWN: &[&str] = &[
    "image",
    "resolution",
    "origin",
    "negate",
    "occupied_thresh",
    "free_thresh",
    "mode",
];

/// The values of a description.
pub(crate) struct Keys {
    pub(crate) image: Spanned<Scalar>,
    pub(crate) resolution: Spanned<Scalar>,
    pub(crate) origin: Spanned<Vec<Scalar>>,
    pub(crate) negate: Spanned<Scalar>,
    pub(crate) occupied_thresh: Spanned<Scalar>,
    pub(crate) free_thresh: Spanned<Scalar>,
    pub(crate) mode: Option<Spanned<Scalar>>,
    /// Other keys, in their order.
    pub(crate) unknown: Vec<Spanned<String>>,
}

/// A value that is no list and no mapping: the text of the file without quotes,
/// or nothing.
#[derive(Debug, Clone, PartialEq, Eq, serde::Deserialize)]
#[serde(transparent)]
pub(crate) struct Scalar(Option<String>);

impl Scalar {
    pub(crate) fn text(&self) -> &str {
        self.0.as_deref().unwrap_or_default().trim()
    }

    /// The number that the text is, which need not be finite.
    pub(crate) fn number(&self) -> Option<f64> {
        let text = self.text();
        let unsigned = text.trim_start_matches(['+', '-']);
        // YAML's words for what Rust and C call inf and nan.
        match unsigned.to_ascii_lowercase().as_str() {
            ".inf" if text.starts_with('-') => Some(f64::NEG_INFINITY),
            ".inf" => Some(f64::INFINITY),
            ".nan" => Some(f64::NAN),
            _ => text.parse().ok(),
        }
    }
}

impl Display for Scalar {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.text() {
            "" => f.write_str("nothing"),
            text => f.write_str(text),
        }
    }
}

impl<'de> Deserialize<'de> for Keys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Mapping)
    }
}

struct Mapping;

impl<'de> Visitor<'de> for Mapping {
    type Value = Keys;

    fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "the keys {}", KNOWN.join(", "))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Keys, A::Error> {
        let (mut image, mut resolution, mut origin, mut mode) = (None, None, None, None);
        let (mut negate, mut occupied, mut free) = (None, None, None);
        let mut unknown = Vec::new();
        // A key that stands twice is refused by the parser.
        while let Some(key) = map.next_key::<Spanned<String>>()? {
            match key.value.as_str() {
                "image" => image = Some(map.next_value()?),
                "resolution" => resolution = Some(map.next_value()?),
                "origin" => origin = Some(map.next_value()?),
                "negate" => negate = Some(map.next_value()?),
                "occupied_thresh" => occupied = Some(map.next_value()?),
                "free_thresh" => free = Some(map.next_value()?),
                "mode" => mode = map.next_value()?,
                _ => {
                    map.next_value::<IgnoredAny>()?;
                    unknown.push(key);
                }
            }
        }
        let missing = A::Error::missing_field;
        Ok(Keys {
            image: image.ok_or_else(|| missing("image"))?,
            resolution: resolution.ok_or_else(|| missing("resolution"))?,
            origin: origin.ok_or_else(|| missing("origin"))?,
            negate: negate.ok_or_else(|| missing("negate"))?,
            occupied_thresh: occupied.ok_or_else(|| missing("occupied_thresh"))?,
            free_thresh: free.ok_or_else(|| missing("free_thresh"))?,
            mode,
            unknown,
        })
    }
}

/// A key of a description that means nothing to this program: it may be another
/// program's, or a known one misspelt.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownKey {
    /// The YAML file.
    pub path: std::path::PathBuf,
    /// Line, from 1.
    pub line: u64,
    /// Column, from 1.
    pub column: u64,
    /// The key.
    pub key: String,
}

impl Display for UnknownKey {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (path, line, column) = (self.path.display(), self.line, self.column);
        let (key, known) = (&self.key, KNOWN.join(", "));
        write!(
            f,
            "{path}:{line}:{column}: the key {key} is not known and has no effect; known are {known}"
        )
    }
}
