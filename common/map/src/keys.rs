//! Keys of a map's description, with their values as spelled in the file.
//!
//! Numbers may be in quotes, as some programs write them, and non-finite ones are accepted in the
//! spelling of YAML or C; values are checked elsewhere. Unknown keys are collected with their
//! place.

use std::fmt::{self, Display, Formatter};

use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, Visitor};
use serde_saphyr::Spanned;

const KNOWN: &[&str] = &[
    "image",
    "resolution",
    "origin",
    "negate",
    "occupied_thresh",
    "free_thresh",
    "mode",
];

pub(crate) struct Keys {
    pub(crate) image: Spanned<Scalar>,
    pub(crate) resolution: Spanned<Scalar>,
    pub(crate) origin: Spanned<Vec<Scalar>>,
    pub(crate) negate: Spanned<Scalar>,
    pub(crate) occupied_thresh: Spanned<Scalar>,
    pub(crate) free_thresh: Spanned<Scalar>,
    pub(crate) mode: Option<Spanned<Scalar>>,
    pub(crate) unknown: Vec<Spanned<String>>,
}

/// A value that is neither a list nor a map: the text without quotes, or null.
#[derive(Debug, Clone, PartialEq, Eq, serde::Deserialize)]
#[serde(transparent)]
pub(crate) struct Scalar(Option<String>);

impl Scalar {
    pub(crate) fn text(&self) -> &str {
        self.0.as_deref().unwrap_or_default().trim()
    }

    /// Parses the text as a number, which may be non-finite.
    pub(crate) fn number(&self) -> Option<f64> {
        let text = self.text();
        let unsigned = text.trim_start_matches(['+', '-']);
        // YAML's spelling of inf and nan.
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
        // The parser rejects duplicate keys.
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

/// An unknown key of a description: a key of another program, or a misspelt one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownKey {
    pub path: std::path::PathBuf,
    pub line: u64,
    pub column: u64,
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
