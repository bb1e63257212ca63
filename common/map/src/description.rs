//! The YAML beside a map's image: parsed, and every value checked.
//!
//! The keys are those of `map_server`: image, resolution, origin, negate,
//! occupied_thresh, free_thresh, and mode where it is not trinary (ROS 1 has no
//! mode). Any other key is an error, because a misspelt one would otherwise be
//! lost without a word. The image is named here, not opened.

use std::f64::consts::TAU;
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};

use geometry::Pose;
use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
use serde_saphyr::{MessageFormatter, Spanned, UserMessageFormatter};

use crate::grid::{origin_is_allowed, resolution_is_allowed};
use crate::rules::Rules;
use crate::{MAX_ORIGIN_M, MAX_RESOLUTION_M, MIN_RESOLUTION_M, MapError};

/// How the shades of an image become occupancy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mode {
    /// Occupied, free or unknown by the thresholds.
    #[default]
    Trinary,
    /// As trinary, but between the thresholds 0..=100; transparent is unknown.
    Scale,
    /// The shade itself, 0..=100; brighter is unknown.
    Raw,
}

/// Where shares of occupancy, 0..=1, turn occupied and free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Thresholds {
    /// Above it a cell is occupied.
    pub(crate) occupied: f64,
    /// Below it a cell is free.
    pub(crate) free: f64,
}

/// What a description says.
#[derive(Debug, PartialEq)]
pub(crate) struct Description {
    /// The image file, relative to nothing but the working directory.
    pub(crate) image: PathBuf,
    /// Line and column of its name.
    pub(crate) image_named_at: (u64, u64),
    pub(crate) resolution_m: f64,
    pub(crate) map_from_grid: Pose,
    pub(crate) rules: Rules,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    image: Spanned<String>,
    resolution: Spanned<f64>,
    origin: Spanned<Vec<f64>>,
    negate: Negate,
    occupied_thresh: Spanned<f64>,
    free_thresh: Spanned<f64>,
    mode: Option<Spanned<String>>,
}

/// 0 and 1 as the map savers write it, or a word.
struct Negate(bool);

impl<'de> Deserialize<'de> for Negate {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrWord;
        impl Visitor<'_> for NumberOrWord {
            type Value = Negate;

            fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
                f.write_str("0, 1, false or true")
            }

            fn visit_bool<E: Error>(self, word: bool) -> Result<Negate, E> {
                Ok(Negate(word))
            }

            fn visit_u64<E: Error>(self, number: u64) -> Result<Negate, E> {
                match number {
                    0 => Ok(Negate(false)),
                    1 => Ok(Negate(true)),
                    other => Err(E::invalid_value(Unexpected::Unsigned(other), &self)),
                }
            }
        }
        deserializer.deserialize_any(NumberOrWord)
    }
}

impl Description {
    /// Parses the text of the file at `path`.
    pub(crate) fn parse(text: &str, path: &Path) -> Result<Self, MapError> {
        let keys: Keys = serde_saphyr::from_str(text).map_err(|error| syntax(path, &error))?;
        let mode = match &keys.mode {
            Some(mode) => mode_of(mode, path)?,
            None => Mode::default(),
        };
        Ok(Description {
            image: image_of(&keys.image, path)?,
            image_named_at: place(&keys.image),
            resolution_m: resolution_of(&keys.resolution, path)?,
            map_from_grid: origin_of(&keys.origin, path)?,
            rules: Rules {
                mode,
                negate: keys.negate.0,
                thresholds: thresholds_of(&keys.occupied_thresh, &keys.free_thresh, path)?,
            },
        })
    }
}

fn image_of(name: &Spanned<String>, path: &Path) -> Result<PathBuf, MapError> {
    if name.value.is_empty() {
        return Err(refuse(
            path,
            name,
            "image",
            "empty",
            "the name of a PGM or PNG file",
        ));
    }
    // Joining an absolute name gives that name.
    Ok(path
        .parent()
        .unwrap_or(Path::new(""))
        .join(name.value.as_str()))
}

fn resolution_of(side: &Spanned<f64>, path: &Path) -> Result<f64, MapError> {
    if !resolution_is_allowed(side.value) {
        let allowed = format!("{MIN_RESOLUTION_M}..={MAX_RESOLUTION_M} m a cell");
        return Err(refuse(path, side, "resolution", side.value, allowed));
    }
    Ok(side.value)
}

fn origin_of(numbers: &Spanned<Vec<f64>>, path: &Path) -> Result<Pose, MapError> {
    let refused = |allowed: String| {
        let found = format!("{:?}", numbers.value);
        Err(refuse(path, numbers, "origin", found, allowed))
    };
    let [x, y, yaw] = numbers.value[..] else {
        return refused("[x, y, yaw] in metres and radians".to_owned());
    };
    let origin = Pose::new(x, y, yaw);
    if !origin_is_allowed(origin) {
        return refused(format!(
            "x and y within {MAX_ORIGIN_M} m, and a yaw within {TAU:.3} rad (radians, not degrees)"
        ));
    }
    Ok(origin)
}

fn thresholds_of(
    occupied: &Spanned<f64>,
    free: &Spanned<f64>,
    path: &Path,
) -> Result<Thresholds, MapError> {
    for (key, threshold) in [("occupied_thresh", occupied), ("free_thresh", free)] {
        if !(0.0..=1.0).contains(&threshold.value) {
            return Err(refuse(path, threshold, key, threshold.value, "0..=1"));
        }
    }
    if free.value >= occupied.value {
        let allowed = format!("below occupied_thresh, which is {}", occupied.value);
        return Err(refuse(path, free, "free_thresh", free.value, allowed));
    }
    Ok(Thresholds {
        occupied: occupied.value,
        free: free.value,
    })
}

fn mode_of(mode: &Spanned<String>, path: &Path) -> Result<Mode, MapError> {
    match mode.value.as_str() {
        "trinary" => Ok(Mode::Trinary),
        "scale" => Ok(Mode::Scale),
        "raw" => Ok(Mode::Raw),
        other => Err(refuse(path, mode, "mode", other, "trinary, scale or raw")),
    }
}

fn refuse<T>(
    path: &Path,
    value: &Spanned<T>,
    key: &'static str,
    found: impl Display,
    allowed: impl Into<String>,
) -> MapError {
    let (line, column) = place(value);
    MapError::Value {
        path: path.to_owned(),
        line,
        column,
        key,
        found: found.to_string(),
        allowed: allowed.into(),
    }
}

fn place<T>(value: &Spanned<T>) -> (u64, u64) {
    (value.referenced.line(), value.referenced.column())
}

fn syntax(path: &Path, error: &serde_saphyr::Error) -> MapError {
    let (line, column) = error
        .location()
        .map_or((0, 0), |place| (place.line(), place.column()));
    MapError::Yaml {
        path: path.to_owned(),
        line,
        column,
        reason: UserMessageFormatter
            .format_message(error.without_snippet())
            .into_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "image: floor.pgm\nresolution: 0.05\norigin: [-1.5, 2, 0.1]\n\
                        negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

    fn parse(text: &str) -> Result<Description, MapError> {
        Description::parse(text, Path::new("maps/floor.yaml"))
    }

    /// The message for `GOOD` with one piece changed.
    fn refusal(piece: &str, by: &str) -> String {
        assert!(GOOD.contains(piece));
        parse(&GOOD.replace(piece, by)).unwrap_err().to_string()
    }

    #[test]
    fn reads_what_a_map_saver_writes() {
        let description = parse(GOOD).unwrap();
        assert_eq!(description.image, Path::new("maps/floor.pgm"));
        assert_eq!(description.image_named_at, (1, 8));
        assert_eq!(description.resolution_m, 0.05);
        assert_eq!(description.map_from_grid, Pose::new(-1.5, 2.0, 0.1));
        assert_eq!(description.rules.mode, Mode::Trinary);
        assert!(!description.rules.negate);
        assert_eq!(description.rules.thresholds.occupied, 0.65);
        assert_eq!(description.rules.thresholds.free, 0.196);
    }

    #[test]
    fn modes_negation_and_absolute_names() {
        for (name, mode) in [
            ("trinary", Mode::Trinary),
            ("scale", Mode::Scale),
            ("raw", Mode::Raw),
        ] {
            let description = parse(&format!("{GOOD}mode: {name}\n")).unwrap();
            assert_eq!(description.rules.mode, mode);
        }
        for (word, negate) in [("1", true), ("true", true), ("false", false)] {
            let text = GOOD.replace("negate: 0", &format!("negate: {word}"));
            assert_eq!(parse(&text).unwrap().rules.negate, negate);
        }
        let absolute = parse(&GOOD.replace("floor.pgm", "/srv/floor.pgm")).unwrap();
        assert_eq!(absolute.image, Path::new("/srv/floor.pgm"));
    }

    #[test]
    fn refused_values_name_file_place_and_what_is_allowed() {
        assert_eq!(
            refusal("resolution: 0.05", "resolution: 0"),
            "maps/floor.yaml:2:13: resolution is 0; allowed: 0.001..=10 m a cell"
        );
        for resolution in [".nan", "-0.05", ".inf", "0.0005", "50"] {
            let message = refusal("resolution: 0.05", &format!("resolution: {resolution}"));
            assert!(
                message.starts_with("maps/floor.yaml:2:13: resolution is "),
                "{message}"
            );
        }
        assert_eq!(
            refusal("[-1.5, 2, 0.1]", "[-1.5, 2]"),
            "maps/floor.yaml:3:9: origin is [-1.5, 2.0]; allowed: [x, y, yaw] in metres and radians"
        );
        let degrees = refusal("[-1.5, 2, 0.1]", "[-1.5, 2, 90]");
        assert!(degrees.contains("radians, not degrees"), "{degrees}");
        let endless = refusal("[-1.5, 2, 0.1]", "[.inf, 2, 0]");
        assert!(
            endless.starts_with("maps/floor.yaml:3:9: origin is [inf"),
            "{endless}"
        );
        assert_eq!(
            refusal("free_thresh: 0.196", "free_thresh: 0.65"),
            "maps/floor.yaml:6:14: free_thresh is 0.65; allowed: below occupied_thresh, which is 0.65"
        );
        assert_eq!(
            refusal("occupied_thresh: 0.65", "occupied_thresh: 65"),
            "maps/floor.yaml:5:18: occupied_thresh is 65; allowed: 0..=1"
        );
        assert_eq!(
            refusal("negate: 0", "negate: 2"),
            "maps/floor.yaml:4:1: invalid value: integer `2`, expected 0, 1, false or true"
        );
        assert_eq!(
            refusal("image: floor.pgm", "image: ''"),
            "maps/floor.yaml:1:8: image is empty; allowed: the name of a PGM or PNG file"
        );
    }

    #[test]
    fn refused_documents_name_file_and_place() {
        let unknown = parse(&format!("{GOOD}occupied_tresh: 0.65\n")).unwrap_err();
        let message = unknown.to_string();
        assert!(message.starts_with("maps/floor.yaml:7:1: "), "{message}");
        assert!(message.contains("occupied_tresh"), "{message}");
        assert!(
            message.contains("free_thresh"),
            "the allowed keys: {message}"
        );

        let mode = parse(&format!("{GOOD}mode: binary\n")).unwrap_err();
        assert_eq!(
            mode.to_string(),
            "maps/floor.yaml:7:7: mode is binary; allowed: trinary, scale or raw"
        );
        let missing = refusal("free_thresh: 0.196\n", "");
        assert!(missing.contains("free_thresh"), "{missing}");
        let twice = parse(&format!("{GOOD}negate: 1\n"))
            .unwrap_err()
            .to_string();
        assert!(twice.starts_with("maps/floor.yaml:7:1: "), "{twice}");
        let kind = refusal("resolution: 0.05", "resolution: fine");
        assert!(kind.starts_with("maps/floor.yaml:2:13: "), "{kind}");
        let word = refusal("negate: 0", "negate: perhaps");
        assert!(word.starts_with("maps/floor.yaml:4:1: "), "{word}");
        for nothing in ["", "[]", "just text", "image: [", "\u{0}"] {
            assert!(
                matches!(parse(nothing), Err(MapError::Yaml { .. })),
                "{nothing:?}"
            );
        }
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "\\PC{0,200}", cut in 0..GOOD.len(), byte in 0u8..128) {
            let _ = parse(&text);
            // One damaged character of a sound description.
            let mut bytes = GOOD.as_bytes().to_vec();
            bytes[cut] = byte;
            let _ = parse(std::str::from_utf8(&bytes).unwrap());
            let _ = parse(&GOOD[..cut]);
        }
    }
}
