//! Sets of maps: the floors of a building, or the buildings of a campus.
//!
//! A set is a folder of maps, or a file that names them:
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
//! The order counts: of equally good poses, that on the map which is named first is the
//! better one.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use geometry::Pose;
use serde::Deserialize;
use serde_saphyr::{MessageFormatter, UserMessageFormatter};

use crate::MapError;
use crate::keys::Scalar;

/// The file of a folder that says which maps it has.
const LIST: &str = "maps.yaml";

/// Most maps of a set.
pub const MAX_MAPS: usize = 1000;

/// Most bytes of a file that names maps.
const MAX_LIST_BYTES: u64 = 1 << 20;

/// The longest side of a transition, metres.
const MAX_TRANSITION_M: f64 = 100.0;

/// The maps of a building or a campus.
#[derive(Debug, Clone, PartialEq)]
pub struct MapSet {
    /// In the order by which ties are decided.
    pub maps: Vec<MapFile>,
    /// Where a robot may go from one of them to another.
    pub transitions: Vec<Transition>,
}

/// A rectangle that two maps have, as a lift, stairs, or a door between two buildings. A robot
/// that is somewhere in it on one map is at the same place of it on the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Transition {
    /// What it is called.
    pub name: String,
    /// The numbers of the two maps in their set, from 0.
    pub maps: [usize; 2],
    /// The rectangle's centre and its x axis on each of them.
    pub map_from_region: [Pose; 2],
    /// Its sides along its x and y, metres.
    pub size_m: [f64; 2],
}

/// A map of a set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MapFile {
    /// What it is called; no two maps of a set have the same name.
    pub name: String,
    /// Its description, a YAML file as map_server reads it.
    pub yaml: PathBuf,
    /// The floor, where the set says so.
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
struct TransitionEntry {
    name: Scalar,
    size: [Scalar; 2],
    at: BTreeMap<String, [Scalar; 3]>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: Scalar,
    map: Scalar,
    #[serde(default)]
    floor: Option<Scalar>,
}

/// The maps of a set: those that a file names, or those in a folder. There, `maps.yaml` says
/// which; without it they are all YAML files in the folder and, in each folder below,
/// `map.yaml`, by their names.
///
/// # Errors
/// Says what cannot be read, or what is wrong and what is allowed. The maps themselves are
/// not opened.
pub fn set_of(path: impl AsRef<Path>) -> Result<MapSet, MapError> {
    let path = path.as_ref();
    let set = match path.is_dir() {
        true if path.join(LIST).is_file() => listed(&path.join(LIST))?,
        true => MapSet::without_transitions(in_folder(path)?),
        false => listed(path)?,
    };
    check(path, &set.maps)?;
    Ok(set)
}

/// Maps that are given one by one, as a set: each is called by its file, or by its folder
/// where the file is `map.yaml`.
///
/// # Errors
/// There is none, more than [`MAX_MAPS`], or two have one name.
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

    /// Those of the maps that are asked for, each by its name or by its floor's, in the order
    /// of the set, and the transitions between them; all of them where none is.
    ///
    /// # Errors
    /// A name is neither a map's nor a floor's; says which there are.
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

/// Which of the maps are asked for.
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

/// The maps, each with its floor where it has one.
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
    let failed = |source| MapError::Description {
        path: path.to_owned(),
        source,
    };
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
        // Joining an absolute name gives that name.
        yaml: folder.join(entry.map.text()),
        floor: entry.floor.map(|floor| floor.text().to_owned()),
    });
    let maps: Vec<MapFile> = maps.collect();
    let between = list.transitions.iter();
    let between = between.map(|entry| {
        entry.transitions(&maps).map_err(|reason| {
            let name = entry.name.text();
            refused(path, format!("transition {name:?}: {reason}"))
        })
    });
    let transitions = between.collect::<Result<Vec<_>, _>>()?.concat();
    Ok(MapSet { maps, transitions })
}

impl TransitionEntry {
    /// One for each two of its maps.
    fn transitions(&self, maps: &[MapFile]) -> Result<Vec<Transition>, String> {
        let number = |scalar: &Scalar| scalar.number().filter(|number| number.is_finite());
        let side = |scalar: &Scalar| number(scalar).filter(|m| *m > 0.0 && *m <= MAX_TRANSITION_M);
        let [Some(along_x), Some(along_y)] = self.size.each_ref().map(side) else {
            return Err(format!(
                "its size is {:?} x {:?}: allowed are two sides above 0 and up to \
                 {MAX_TRANSITION_M} m",
                self.size[0].text(),
                self.size[1].text()
            ));
        };
        let mut sides = Vec::new();
        for (name, pose) in &self.at {
            let Some(map) = maps.iter().position(|map| map.name == *name) else {
                let all = all_names(maps);
                return Err(format!("there is no map {name:?}: allowed are {all}"));
            };
            let [Some(x), Some(y), Some(degrees)] = pose.each_ref().map(number) else {
                return Err(format!(
                    "its place on {name:?} is not x and y in metres and an angle in degrees"
                ));
            };
            sides.push((map, Pose::new(x, y, degrees.to_radians())));
        }
        if sides.len() < 2 {
            return Err("it is on one map: needed are two at least".to_owned());
        }
        let pairs = sides.iter().enumerate();
        let pairs = pairs.flat_map(|(i, a)| sides[i + 1..].iter().map(move |b| (a, b)));
        let transition = |(a, b): (&(usize, Pose), &(usize, Pose))| Transition {
            name: self.name.text().to_owned(),
            maps: [a.0, b.0],
            map_from_region: [a.1, b.1],
            size_m: [along_x, along_y],
        };
        Ok(pairs.map(transition).collect())
    }
}

fn in_folder(folder: &Path) -> Result<Vec<MapFile>, MapError> {
    let failed = |source| MapError::Description {
        path: folder.to_owned(),
        source,
    };
    let mut maps = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let below = path.join("map.yaml");
        let is_yaml = path
            .extension()
            .is_some_and(|ending| ending == "yaml" || ending == "yml");
        if path.is_dir() && below.is_file() {
            maps.push(named(&below));
        } else if is_yaml && path.is_file() {
            maps.push(named(&path));
        }
    }
    maps.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(maps)
}

fn check(path: &Path, maps: &[MapFile]) -> Result<(), MapError> {
    if maps.is_empty() {
        let reason = format!(
            "there are no maps: allowed are a folder with maps (*.yaml, or */map.yaml) and a \
             file like {LIST}"
        );
        return Err(refused(path, reason));
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

fn refused(path: &Path, reason: String) -> MapError {
    MapError::Set {
        path: path.to_owned(),
        reason,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        folder
    }

    fn names(maps: &[MapFile]) -> Vec<&str> {
        maps.iter().map(|map| &*map.name).collect()
    }

    #[test]
    fn a_folder_of_maps_is_a_set_by_their_names() {
        let files = [
            ("b.yaml", ""),
            ("a/map.yaml", ""),
            ("c.png", ""),
            ("d/x", ""),
        ];
        let folder = folder(&files);
        let maps = set_of(folder.path()).unwrap().maps;
        assert_eq!(names(&maps), ["a", "b"]);
        assert_eq!(maps[0].yaml, folder.path().join("a/map.yaml"));
    }

    #[test]
    fn a_list_names_maps_in_its_order() {
        let list =
            "maps:\n  - {name: up, map: u.yaml, floor: 1}\n  - name: down\n    map: /d.yaml\n";
        let folder = folder(&[("maps.yaml", list), ("x.yaml", "")]);
        for path in [folder.path().to_owned(), folder.path().join("maps.yaml")] {
            let maps = set_of(path).unwrap().maps;
            assert_eq!(names(&maps), ["up", "down"]);
            assert_eq!(maps[0].yaml, folder.path().join("u.yaml"));
            assert_eq!(maps[0].floor.as_deref(), Some("1"));
            assert_eq!(
                (&*maps[1].yaml, &maps[1].floor),
                (Path::new("/d.yaml"), &None)
            );
        }
    }

    #[test]
    fn maps_are_selected_by_their_names_and_by_their_floors() {
        let map = |(name, floor): (&str, Option<&str>)| MapFile {
            name: name.to_owned(),
            yaml: PathBuf::from("x.yaml"),
            floor: floor.map(str::to_owned),
        };
        let floors = [
            ("east", Some("1")),
            ("west", Some("1")),
            ("roof", Some("2")),
        ];
        let maps: Vec<MapFile> = floors
            .into_iter()
            .chain([("yard", None)])
            .map(map)
            .collect();
        let check = |on: &[&str], expected: &[&str]| {
            let on: Vec<String> = on.iter().map(|&name| name.to_owned()).collect();
            let set = MapSet::without_transitions(maps.clone());
            assert_eq!(names(&set.select(&on).unwrap().maps), expected, "{on:?}");
        };
        check(&[], &["east", "west", "roof", "yard"]);
        check(&["yard", "west"], &["west", "yard"]);
        check(&["1"], &["east", "west"]);
        check(&["2", "east", "2", "roof"], &["east", "roof"]);
        for wrong in ["3", "", "Yard"] {
            let on = ["1".to_owned(), wrong.to_owned()];
            let set = MapSet::without_transitions(maps.clone());
            let error = set.select(&on).unwrap_err().to_string();
            assert!(error.contains(&format!("{wrong:?} is neither")), "{error}");
            let there = "east (floor 1), west (floor 1), roof (floor 2), yard";
            assert!(error.contains(there), "{error}");
        }
    }

    const FLOORS: &str = "maps:
  - {name: cellar, map: c.yaml}
  - {name: ground, map: g.yaml}
  - {name: first, map: f.yaml}
";

    #[test]
    fn transitions_are_between_each_two_of_their_maps() {
        let lift = "transitions:
  - name: lift
    size: [1.6, 2]
    at: {ground: [12, 3.5, 0], cellar: [1, 2, -90], first: [-1.5, '3', 90]}
";
        let folder = folder(&[("maps.yaml", &format!("{FLOORS}{lift}"))]);
        let set = set_of(folder.path()).unwrap();
        let maps: Vec<[usize; 2]> = set.transitions.iter().map(|t| t.maps).collect();
        assert_eq!(maps, [[0, 2], [0, 1], [2, 1]]);
        let [_, down, up] = &set.transitions[..] else {
            panic!("three pairs of three maps");
        };
        assert_eq!((&*up.name, up.size_m), ("lift", [1.6, 2.0]));
        let quarter = std::f64::consts::FRAC_PI_2;
        assert_eq!(down.map_from_region[0], Pose::new(1.0, 2.0, -quarter));
        assert_eq!(up.map_from_region[0], Pose::new(-1.5, 3.0, quarter));
        // Of some maps, those between them, by their new numbers.
        let on = ["ground".to_owned(), "first".to_owned()];
        let some = set.select(&on).unwrap();
        assert_eq!(names(&some.maps), ["ground", "first"]);
        let maps: Vec<[usize; 2]> = some.transitions.iter().map(|t| t.maps).collect();
        assert_eq!(maps, [[1, 0]]);
    }

    #[test]
    fn what_is_no_transition_is_refused_with_what_is_allowed() {
        let check = |lift: &str, expected: &str| {
            let list = format!("{FLOORS}transitions:\n  - {{name: lift, {lift}}}\n");
            let folder = folder(&[("maps.yaml", &list)]);
            let error = set_of(folder.path()).unwrap_err().to_string();
            assert!(error.contains(expected), "{lift}: {error}");
        };
        let two = "at: {ground: [1, 2, 3], first: [1, 2, 3]}";
        check(&format!("size: [0, 2], {two}"), "above 0 and up to 100 m");
        check(&format!("size: [1, 101], {two}"), "\"1\" x \"101\"");
        check(&format!("size: [1, 2, 3], {two}"), "3");
        check(&format!("size: [1, 2], sice: 3, {two}"), "sice");
        check("size: [1, 2], at: {ground: [1, 2, 3]}", "needed are two");
        check(
            "size: [1, 2], at: {ground: [1, 2, 3], roof: [1, 2, 3]}",
            "transition \"lift\": there is no map \"roof\": allowed are cellar, ground, first",
        );
        check(
            "size: [1, 2], at: {ground: [1, 2, x], first: [1, 2, 3]}",
            "its place on \"ground\" is not x and y",
        );
    }

    #[test]
    fn what_is_no_set_is_refused_with_what_is_allowed() {
        let check = |list: &str, expected: &str| {
            let folder = folder(&[("maps.yaml", list)]);
            let error = set_of(folder.path()).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        check("maps: []", "there are no maps");
        check(
            "maps:\n  - {name: a/b, map: x.yaml}",
            "1 to 64 of a-z A-Z 0-9",
        );
        check(
            "maps:\n  - {name: a, map: x.yaml}\n  - {name: a, map: y.yaml}",
            "both called \"a\"",
        );
        check("maps:\n  - {name: a, mapp: x.yaml}", "mapp");
        check("mapps: []", "mapps");
        let empty = folder(&[]);
        assert!(
            set_of(empty.path())
                .unwrap_err()
                .to_string()
                .contains("no maps")
        );
        assert!(set_of(empty.path().join("nowhere")).is_err());
        let twice = [PathBuf::from("a/x.yaml"), PathBuf::from("b/x.yaml")];
        assert!(set_of_files(&twice).is_err());
    }
}
