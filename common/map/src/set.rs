//! Sets of maps: the floors of a building, or the buildings of a campus.
//!
//! A set is a folder of maps, or a file that lists them:
//!
//! ```yaml
//! maps:
//!   - name: ground          # 1 to 64 of a-z A-Z 0-9 - _ .
//!     map: ground/map.yaml  # from the file's folder
//!     floor: 0              # free text; may be left out
//!   - name: first
//!     map: first/map.yaml
//! transitions:              # where a robot goes from one map to another; may be left out
//!   - name: lift
//!     size: [1.6, 2.0]      # a rectangle: its sides along its own x and y, metres
//!     at:                   # its centre on each map, metres, and its x axis, degrees
//!       ground: [12.0, 3.5, 0]
//!       first: [11.8, 3.6, 90]
//! ```
//!
//! The order decides ties: of equally good poses, the one on the earlier map wins.

mod transition;

use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_saphyr::{MessageFormatter, UserMessageFormatter};

use crate::description::is_of_something_else;
use crate::keys::Scalar;
use crate::load::read_text;
use crate::{MapError, check_kind};
pub use transition::Transition;
use transition::TransitionEntry;

const LIST: &str = "maps.yaml";

const NO_MAPS: &str = "there are no maps: allowed are a folder with maps (*.yaml, or */map.yaml) \
                       and a file like maps.yaml";

pub const MAX_MAPS: usize = 1000;

const MAX_LIST_BYTES: u64 = 1 << 20;

/// Maps of a building or a campus.
#[derive(Debug, Clone, PartialEq)]
pub struct MapSet {
    pub maps: Vec<MapFile>,
    pub transitions: Vec<Transition>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MapFile {
    /// Name, unique in its set.
    pub name: String,
    /// Path of its description, a YAML file of map_server.
    pub yaml: PathBuf,
    pub floor: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    maps: Vec<Entry>,
    #[serde(default)]
    transitions: Vec<TransitionEntry>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: Scalar,
    map: Scalar,
    #[serde(default)]
    floor: Option<Scalar>,
}

/// Returns the maps of a set: those that a file lists, or those in a folder. A folder's `maps.yaml`
/// is its list; without it these are all YAML files in the folder with the key `image` and the
/// `map.yaml` of each subfolder, sorted by name.
///
/// # Errors
/// A file cannot be read or is invalid. The images of the maps are not opened.
pub fn set_of(path: impl AsRef<Path>) -> Result<MapSet, MapError> {
    set_of_noting(path, |_| {})
}

/// Like [`set_of`], and calls `note` with a line for each YAML file that is left out because it is
/// not a map, to be shown to the user.
pub fn set_of_noting(path: impl AsRef<Path>, note: impl FnMut(&str)) -> Result<MapSet, MapError> {
    let path = path.as_ref();
    let list = list_of(path);
    let set = match path.is_dir() && !list.is_file() {
        true => MapSet::without_transitions(in_folder(path, note)?),
        false => listed(&list)?,
    };
    check(path, &set.maps)?;
    Ok(set)
}

/// Returns the file that lists the maps of a set; it may be missing in a folder.
pub fn list_of(path: &Path) -> PathBuf {
    match path.is_dir() {
        true => path.join(LIST),
        false => path.to_owned(),
    }
}

/// Returns a set of individual maps; each is named by its file, or by its folder if the file is
/// `map.yaml` or `recording.yaml`.
///
/// # Errors
/// There are no maps, more than [`MAX_MAPS`], or two with the same name.
pub fn set_of_files(files: &[PathBuf]) -> Result<MapSet, MapError> {
    let maps: Vec<MapFile> = files.iter().map(|yaml| named(yaml)).collect();
    check(Path::new("--map"), &maps)?;
    Ok(MapSet::without_transitions(maps))
}

impl MapSet {
    fn without_transitions(maps: Vec<MapFile>) -> Self {
        MapSet {
            maps,
            transitions: Vec::new(),
        }
    }

    /// Keeps only the maps with a name or floor in `on`, in the order of the set, and the
    /// transitions between them; an empty `on` keeps all.
    ///
    /// # Errors
    /// A name is neither a map's nor a floor's; the error lists the allowed ones.
    pub fn select(self, on: &[String]) -> Result<Self, MapError> {
        let MapSet { maps, transitions } = self;
        let is_kept = selected(&maps, on)?;
        let number = |map: usize| is_kept[..map].iter().filter(|kept| **kept).count();
        let between = transitions.into_iter();
        let between = between.filter(|transition| transition.maps.iter().all(|&map| is_kept[map]));
        let transitions = between.map(|transition| Transition {
            maps: transition.maps.map(number),
            ..transition
        });
        let numbered = maps.into_iter().zip(&is_kept);
        Ok(MapSet {
            transitions: transitions.collect(),
            maps: numbered
                .filter_map(|(map, kept)| kept.then_some(map))
                .collect(),
        })
    }
}

/// Returns for each map if it is selected.
fn selected(maps: &[MapFile], on: &[String]) -> Result<Vec<bool>, MapError> {
    let is_called =
        |map: &MapFile, name: &String| map.name == *name || map.floor.as_ref() == Some(name);
    for name in on {
        if !maps.iter().any(|map| is_called(map, name)) {
            let reason = format!(
                "{name:?} is neither a map nor a floor: allowed are {}",
                all_names(maps)
            );
            return Err(refused(Path::new("--on"), reason));
        }
    }
    let is_asked = |map: &MapFile| on.is_empty() || on.iter().any(|name| is_called(map, name));
    Ok(maps.iter().map(is_asked).collect())
}

fn all_names(maps: &[MapFile]) -> String {
    let names = maps.iter().map(|MapFile { name, floor, .. }| match floor {
        Some(floor) => format!("{name} (floor {floor})"),
        None => name.clone(),
    });
    names.collect::<Vec<String>>().join(", ")
}

fn named(yaml: &Path) -> MapFile {
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into());
    let folder = || {
        let full = yaml.canonicalize().ok()?;
        Some(full.parent()?.file_name()?.to_string_lossy().into())
    };
    let name: Option<String> = match stem(yaml).as_deref() {
        Some("map" | "recording") => folder(),
        _ => None,
    };
    MapFile {
        name: name.or_else(|| stem(yaml)).unwrap_or_default(),
        yaml: yaml.to_owned(),
        floor: None,
    }
}

fn listed(path: &Path) -> Result<MapSet, MapError> {
    check_kind(path)?;
    let failed = MapError::unread(path);
    let bytes = fs::metadata(path).map_err(failed)?.len();
    if bytes > MAX_LIST_BYTES {
        let reason = format!("it has {bytes} bytes: allowed are {MAX_LIST_BYTES}");
        return Err(refused(path, reason));
    }
    let text = fs::read_to_string(path).map_err(failed)?;
    let list: List = serde_saphyr::from_str(&text).map_err(|error| {
        let reason = UserMessageFormatter.format_message(&error).into_owned();
        refused(path, reason)
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let maps = list.maps.into_iter().map(|entry| MapFile {
        name: entry.name.text().to_owned(),
        // Joining an absolute path gives that path.
        yaml: folder.join(entry.map.text()),
        floor: entry.floor.map(|floor| floor.text().to_owned()),
    });
    let maps: Vec<MapFile> = maps.collect();
    let between = list.transitions.iter();
    let between = between.map(|entry| {
        entry.transitions(&maps).map_err(|reason| {
            let name = entry.name();
            refused(path, format!("transition {name:?}: {reason}"))
        })
    });
    let transitions = between.collect::<Result<Vec<_>, _>>()?.concat();
    Ok(MapSet { maps, transitions })
}

fn in_folder(folder: &Path, mut note: impl FnMut(&str)) -> Result<Vec<MapFile>, MapError> {
    let failed = MapError::unread(folder);
    let (mut maps, mut others) = (Vec::new(), Vec::new());
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let below = path.join("map.yaml");
        let is_yaml = path
            .extension()
            .is_some_and(|ending| ending == "yaml" || ending == "yml");
        if path.is_dir() && below.is_file() {
            maps.push(named(&below));
        } else if is_yaml && path.is_file() {
            // An unreadable file may be a map that is being written, and loading it gives a better
            // error.
            match read_text(&path).is_ok_and(|text| is_of_something_else(&text)) {
                true => others.push(path),
                false => maps.push(named(&path)),
            }
        }
    }
    if let ([], [other, ..]) = (&*maps, &*others) {
        let (other, count) = (other.display(), others.len());
        let reason =
            format!("{NO_MAPS}; of {count} YAML files, as {other}, none has the key image");
        return Err(refused(folder, reason));
    }
    for other in others {
        let other = other.display();
        note(&format!(
            "{other} has no key image: it is taken for no map and left out"
        ));
    }
    maps.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(maps)
}

fn check(path: &Path, maps: &[MapFile]) -> Result<(), MapError> {
    if maps.is_empty() {
        return Err(refused(path, NO_MAPS));
    }
    if maps.len() > MAX_MAPS {
        let reason = format!("{} maps: allowed are {MAX_MAPS}", maps.len());
        return Err(refused(path, reason));
    }
    for (number, map) in maps.iter().enumerate() {
        let is_allowed = |letter: char| letter.is_ascii_alphanumeric() || "-_.".contains(letter);
        if !(1..=64).contains(&map.name.len()) || !map.name.chars().all(is_allowed) {
            let reason = format!(
                "a map is called {:?}: allowed are 1 to 64 of a-z A-Z 0-9 - _ .",
                map.name
            );
            return Err(refused(path, reason));
        }
        if let Some(other) = maps[..number].iter().find(|other| other.name == map.name) {
            let reason = format!(
                "{} and {} are both called {:?}: each map of a set has a name of its own",
                other.yaml.display(),
                map.yaml.display(),
                map.name
            );
            return Err(refused(path, reason));
        }
    }
    Ok(())
}

fn refused(path: &Path, reason: impl Display) -> MapError {
    MapError::Invalid(format!("{}: {reason}", path.display()))
}

#[cfg(test)]
mod tests;
