//! The YAML description of a map: parsing, and checks of every value.
//!
//! The keys are those of `map_server`: image, resolution, origin, negate, occupied_thresh,
//! free_thresh, and mode, which is trinary by default (ROS 1 has no mode). Keys of other programs
//! are returned as unknown, so that a misspelt key can be reported. The image is not opened here.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use geometry::Pose;
use messages::limits::{origin_is_allowed, resolution_is_allowed};
use serde::de::IgnoredAny;
use serde_saphyr::{MessageFormatter, Spanned, UserMessageFormatter};

use crate::keys::{Keys, Scalar};
use crate::rules::{Mode, Rules, Thresholds};
use crate::{MAX_ORIGIN_M, MAX_RESOLUTION_M, MIN_RESOLUTION_M, MapError, UnknownKey};

#[derive(Debug, PartialEq)]
pub(crate) struct Description {
    /// Path of the image file, with a relative name resolved against the description's folder.
    pub(crate) image: PathBuf,
    /// Line and column of the image's name.
    pub(crate) image_named_at: (u64, u64),
    pub(crate) resolution_m: f64,
    pub(crate) map_from_grid: Pose,
    pub(crate) rules: Rules,
    pub(crate) unknown: Vec<UnknownKey>,
}

impl Description {
    pub(crate) fn parse(text: &str, path: &Path) -> Result<Self, MapError> {
        let keys: Keys =
            serde_saphyr::from_str(without_mark(text)).map_err(|error| syntax(path, &error))?;
        let unknown = keys.unknown.iter().map(|key| {
            let (line, column) = place(key);
            UnknownKey {
                path: path.to_owned(),
                line,
                column,
                key: key.value.clone(),
            }
        });
        Ok(Description {
            image: image_of(&keys.image, path)?,
            image_named_at: place(&keys.image),
            resolution_m: resolution_of(&keys.resolution, path)?,
            map_from_grid: origin_of(&keys.origin, path)?,
            rules: Rules {
                mode: mode_of(keys.mode.as_ref(), path)?,
                negate: negate_of(&keys.negate, path)?,
                thresholds: thresholds_of(&keys.occupied_thresh, &keys.free_thresh, path)?,
            },
            unknown: unknown.collect(),
        })
    }
}

/// True if a text is YAML of something other than a map: keys without `image`, or a list.
pub(crate) fn is_of_something_else(text: &str) -> bool {
    let text = without_mark(text);
    let keys: Result<BTreeMap<String, IgnoredAny>, _> = serde_saphyr::from_str(text);
    if let Ok(keys) = keys {
        return !keys.is_empty() && !keys.contains_key("image");
    }
    let list: Result<Vec<IgnoredAny>, _> = serde_saphyr::from_str(text);
    list.is_ok_and(|list| !list.is_empty())
}

/// Removes the byte order mark that Windows editors put at the start of a text.
fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

fn image_of(name: &Spanned<Scalar>, path: &Path) -> Result<PathBuf, MapError> {
    let text = name.value.text();
    if text.is_empty() {
        let allowed = "the name of a PGM, PNG or BMP file";
        return Err(refuse(path, name, "image", "empty", allowed));
    }
    // Joining an absolute path gives that path.
    Ok(path.parent().unwrap_or(Path::new("")).join(text))
}

fn resolution_of(side: &Spanned<Scalar>, path: &Path) -> Result<f64, MapError> {
    let number = side
        .value
        .number()
        .filter(|side| resolution_is_allowed(*side));
    number.ok_or_else(|| {
        let allowed = format!("{MIN_RESOLUTION_M}..={MAX_RESOLUTION_M} m a cell");
        refuse(path, side, "resolution", &side.value, allowed)
    })
}

fn origin_of(numbers: &Spanned<Vec<Scalar>>, path: &Path) -> Result<Pose, MapError> {
    let refused = |allowed: String| {
        let found: Vec<String> = numbers.value.iter().map(Scalar::to_string).collect();
        let found = format!("[{}]", found.join(", "));
        Err(refuse(path, numbers, "origin", found, allowed))
    };
    let parsed: Option<Vec<f64>> = numbers.value.iter().map(Scalar::number).collect();
    let Some(&[x, y, yaw]) = parsed.as_deref() else {
        return refused("[x, y, yaw], three numbers in metres and radians".to_owned());
    };
    let origin = Pose::new(x, y, yaw);
    if !origin_is_allowed(origin) {
        return refused(format!(
            "x and y within {MAX_ORIGIN_M} m, and a yaw within {TAU:.3} rad (radians, not degrees)"
        ));
    }
    Ok(origin)
}

/// Accepts 0 and 1, as map savers write it, or a boolean word.
fn negate_of(negate: &Spanned<Scalar>, path: &Path) -> Result<bool, MapError> {
    match negate.value.text().to_ascii_lowercase().as_str() {
        "true" | "yes" | "on" => return Ok(true),
        "false" | "no" | "off" => return Ok(false),
        _ => {}
    }
    match negate.value.number() {
        Some(0.0) => Ok(false),
        Some(1.0) => Ok(true),
        _ => {
            let allowed = "0, 1, false or true";
            Err(refuse(path, negate, "negate", &negate.value, allowed))
        }
    }
}

fn thresholds_of(
    occupied: &Spanned<Scalar>,
    free: &Spanned<Scalar>,
    path: &Path,
) -> Result<Thresholds, MapError> {
    let share = |key, threshold: &Spanned<Scalar>| {
        let number = threshold.value.number();
        number
            .filter(|share| (0.0..=1.0).contains(share))
            .ok_or_else(|| refuse(path, threshold, key, &threshold.value, "0..=1"))
    };
    let thresholds = Thresholds {
        occupied: share("occupied_thresh", occupied)?,
        free: share("free_thresh", free)?,
    };
    if thresholds.free >= thresholds.occupied {
        let allowed = format!("below occupied_thresh, which is {}", thresholds.occupied);
        return Err(refuse(path, free, "free_thresh", &free.value, allowed));
    }
    Ok(thresholds)
}

fn mode_of(mode: Option<&Spanned<Scalar>>, path: &Path) -> Result<Mode, MapError> {
    let Some(mode) = mode else {
        return Ok(Mode::default());
    };
    match mode.value.text().to_ascii_lowercase().as_str() {
        "trinary" => Ok(Mode::Trinary),
        "scale" => Ok(Mode::Scale),
        "raw" => Ok(Mode::Raw),
        _ => {
            let allowed = "trinary, scale or raw";
            Err(refuse(path, mode, "mode", &mode.value, allowed))
        }
    }
}

fn refuse<T>(
    path: &Path,
    value: &Spanned<T>,
    key: &'static str,
    found: impl Display,
    allowed: impl Display,
) -> MapError {
    let reason = format!("{key} is {found}; allowed: {allowed}");
    MapError::at(path, place(value), reason)
}

fn place<T>(value: &Spanned<T>) -> (u64, u64) {
    (value.referenced.line(), value.referenced.column())
}

fn syntax(path: &Path, error: &serde_saphyr::Error) -> MapError {
    let place = error.location();
    let place = place.map_or((0, 0), |place| (place.line(), place.column()));
    let reason = UserMessageFormatter.format_message(error.without_snippet());
    MapError::at(path, place, reason.into_owned())
}

#[cfg(test)]
mod tests;
