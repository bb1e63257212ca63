//! The YAML beside a map's image: parsed, and every value checked.
//!
//! The keys are those of `map_server`: image, resolution, origin, negate,
//! occupied_thresh, free_thresh, and mode where it is not trinary (ROS 1 has no
//! mode). Other programs add keys of their own: they are returned, so that a
//! misspelt one is not lost without a word. The image is named here, not opened.

use std::f64::consts::TAU;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use geometry::Pose;
use serde_saphyr::{MessageFormatter, Spanned, UserMessageFormatter};

use crate::grid::{origin_is_allowed, resolution_is_allowed};
use crate::keys::{Keys, Scalar};
use crate::rules::Rules;
use crate::{MAX_ORIGIN_M, MAX_RESOLUTION_M, MIN_RESOLUTION_M, MapError, UnknownKey};

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
    /// Keys that mean nothing here, in their order.
    pub(crate) unknown: Vec<UnknownKey>,
}

impl Description {
    /// Parses the text of the file at `path`.
    pub(crate) fn parse(text: &str, path: &Path) -> Result<Self, MapError> {
        // Editors of Windows begin a text with a byte order mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let keys: Keys = serde_saphyr::from_str(text).map_err(|error| syntax(path, &error))?;
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

fn image_of(name: &Spanned<Scalar>, path: &Path) -> Result<PathBuf, MapError> {
    let text = name.value.text();
    if text.is_empty() {
        let allowed = "the name of a PGM, PNG or BMP file";
        return Err(refuse(path, name, "image", "empty", allowed));
    }
    // Joining an absolute name gives that name.
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

/// 0 and 1 as the map savers write it, or a word.
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
            ("Scale", Mode::Scale),
            ("'RAW'", Mode::Raw),
            ("", Mode::Trinary),
        ] {
            let description = parse(&format!("{GOOD}mode: {name}\n")).unwrap();
            assert_eq!(description.rules.mode, mode);
        }
        for (word, negate) in [
            ("1", true),
            ("true", true),
            ("True", true),
            ("1.0", true),
            ("yes", true),
            ("\"1\"", true),
            ("'true'", true),
            ("false", false),
            ("0.0", false),
            ("\"0\"", false),
            ("off", false),
        ] {
            let text = GOOD.replace("negate: 0", &format!("negate: {word}"));
            assert_eq!(parse(&text).unwrap().rules.negate, negate);
        }
        let absolute = parse(&GOOD.replace("floor.pgm", "/srv/floor.pgm")).unwrap();
        assert_eq!(absolute.image, Path::new("/srv/floor.pgm"));
        let spaces = parse(&GOOD.replace("floor.pgm", "first floor/map 1.pgm  ")).unwrap();
        assert_eq!(spaces.image, Path::new("maps/first floor/map 1.pgm"));
    }

    #[test]
    fn numbers_may_be_quoted_and_lines_end_as_on_other_systems() {
        let good = parse(GOOD).unwrap();
        let quoted = GOOD
            .replace("0.05", "\"0.05\"")
            .replace("[-1.5, 2, 0.1]", "[\"-1.5\", '2', \"0.1\"]")
            .replace("negate: 0", "negate: '0'")
            .replace("0.65", "\"0.65\"")
            .replace("0.196", "' 0.196 '");
        assert_eq!(parse(&quoted).unwrap(), good);
        let block = GOOD.replace(" [-1.5, 2, 0.1]", "\n- -1.5\n- 2\n- 1e-1");
        assert_eq!(parse(&block).unwrap().map_from_grid, good.map_from_grid);
        for text in [
            GOOD.replace('\n', "\r\n"),
            GOOD.replace('\n', " \t\n"),
            GOOD.replace(": ", ":\t"),
            format!("\u{feff}{GOOD}"),
            format!("---\n{GOOD}...\n"),
        ] {
            let mut read = parse(&text).unwrap();
            read.image_named_at = good.image_named_at;
            assert_eq!(read, good, "{text:?}");
        }
    }

    #[test]
    fn unknown_keys_are_returned_with_their_place() {
        let text = format!("# by hand\nframe_id: map\n{GOOD}occupied_tresh: !x {{a: [1]}}\n2: ~\n");
        let unknown = parse(&text).unwrap().unknown;
        let found: Vec<_> = unknown
            .iter()
            .map(|key| (key.key.as_str(), key.line, key.column))
            .collect();
        assert_eq!(
            found,
            [("frame_id", 2, 1), ("occupied_tresh", 9, 1), ("2", 10, 1)]
        );
        assert_eq!(parse(GOOD).unwrap().unknown, []);
    }

    #[test]
    fn refused_values_name_file_place_and_what_is_allowed() {
        assert_eq!(
            refusal("resolution: 0.05", "resolution: 0"),
            "maps/floor.yaml:2:13: resolution is 0; allowed: 0.001..=10 m a cell"
        );
        for resolution in [
            ".nan", "nan", "-0.05", ".inf", "0.0005", "50", "fine", "'5 cm'",
        ] {
            let message = refusal("resolution: 0.05", &format!("resolution: {resolution}"));
            assert!(
                message.starts_with("maps/floor.yaml:2:13: resolution is "),
                "{message}"
            );
        }
        assert_eq!(
            refusal("resolution: 0.05", "resolution:"),
            "maps/floor.yaml:2:11: resolution is nothing; allowed: 0.001..=10 m a cell"
        );
        for (found, shown) in [
            ("[-1.5, 2]", "[-1.5, 2]"),
            ("[-1.5, 2, 0, 0]", "[-1.5, 2, 0, 0]"),
            ("[-1.5, two, 0]", "[-1.5, two, 0]"),
            ("[~, 2, 0]", "[nothing, 2, 0]"),
        ] {
            assert_eq!(
                refusal("[-1.5, 2, 0.1]", found),
                format!(
                    "maps/floor.yaml:3:9: origin is {shown}; allowed: [x, y, yaw], three numbers in \
                     metres and radians"
                )
            );
        }
        let degrees = refusal("[-1.5, 2, 0.1]", "[-1.5, 2, 90]");
        assert!(degrees.contains("radians, not degrees"), "{degrees}");
        for word in [
            ".nan", "nan", "-nan", "NaN", "'.NAN'", ".inf", "-.inf", "inf", "1e999",
        ] {
            let message = refusal("[-1.5, 2, 0.1]", &format!("[0, {word}, 0]"));
            assert_eq!(
                message,
                format!(
                    "maps/floor.yaml:3:9: origin is [0, {}, 0]; allowed: x and y within 100000000 m, and \
                     a yaw within 6.283 rad (radians, not degrees)",
                    word.trim_matches('\'')
                )
            );
        }
        assert_eq!(
            refusal("free_thresh: 0.196", "free_thresh: 0.65"),
            "maps/floor.yaml:6:14: free_thresh is 0.65; allowed: below occupied_thresh, which is 0.65"
        );
        assert_eq!(
            refusal("occupied_thresh: 0.65", "occupied_thresh: 65"),
            "maps/floor.yaml:5:18: occupied_thresh is 65; allowed: 0..=1"
        );
        for threshold in [".nan", "inf", "-0.1", "most"] {
            assert_eq!(
                refusal("free_thresh: 0.196", &format!("free_thresh: {threshold}")),
                format!("maps/floor.yaml:6:14: free_thresh is {threshold}; allowed: 0..=1")
            );
        }
        for negate in ["2", "0.5", "-1", "nan", "perhaps"] {
            assert_eq!(
                refusal("negate: 0", &format!("negate: {negate}")),
                format!("maps/floor.yaml:4:9: negate is {negate}; allowed: 0, 1, false or true")
            );
        }
        assert_eq!(
            refusal("image: floor.pgm", "image: ''"),
            "maps/floor.yaml:1:8: image is empty; allowed: the name of a PGM, PNG or BMP file"
        );
    }

    #[test]
    fn refused_documents_name_file_and_place() {
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
        let list = refusal("resolution: 0.05", "resolution: [0.05]");
        assert!(list.starts_with("maps/floor.yaml:2:13: "), "{list}");
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
