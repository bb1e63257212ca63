//! Detects changes of the files of a set: the list, if there is one, and each map that it currently
//! names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use transport::with_causes;

use crate::files::{Files, Fingerprint, Seen, fingerprint};

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SetSeen {
    list: Option<Fingerprint>,
    maps: Vec<(PathBuf, Seen)>,
    /// Error that makes the set invalid now; the maps are then those named before.
    problem: Option<String>,
}

#[derive(Debug)]
pub(crate) struct SetFiles {
    path: PathBuf,
    on: Vec<String>,
    maps: BTreeMap<PathBuf, Files>,
}

impl SetFiles {
    /// Watches a set; if `on` is not empty, only the maps and floors with these names.
    pub(crate) fn new(path: &Path, on: &[String]) -> Self {
        SetFiles {
            path: path.to_owned(),
            on: on.to_owned(),
            maps: BTreeMap::new(),
        }
    }

    /// Returns the current state of the files. The set is resolved again each time, because no
    /// known file changes when a folder is added or filled later. Other files are ignored.
    pub(crate) fn look(&mut self) -> SetSeen {
        let set = map::set_of(&self.path).and_then(|set| set.select(&self.on));
        let problem = match set {
            Ok(set) => {
                let named = set.maps.into_iter().map(|map| {
                    let known = self.maps.remove(&map.yaml);
                    let files = known.unwrap_or_else(|| Files::new(&map.yaml));
                    (map.yaml, files)
                });
                self.maps = named.collect();
                None
            }
            Err(error) => Some(with_causes(&error)),
        };
        let maps = self.maps.iter_mut();
        SetSeen {
            list: fingerprint(&map::list_of(&self.path)),
            maps: maps
                .map(|(yaml, files)| (yaml.clone(), files.look()))
                .collect(),
            problem,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn write(folder: &Path, name: &str, text: &str) {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    #[test]
    fn maps_of_a_folder_are_seen_as_they_come_and_other_files_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        write(at, "ground/map.yaml", "image: map.pgm\n");
        let mut files = SetFiles::new(at, &[]);
        let one = files.look();
        assert_eq!(files.look(), one);
        write(at, "notes.txt", "1");
        write(at, "params.yaml", "amcl: 1\n");
        fs::create_dir(at.join("first")).unwrap();
        assert_eq!(files.look(), one);
        write(at, "first/map.yaml", "image: map.pgm\n");
        let two = files.look();
        assert_ne!(two, one);
        write(at, "first/map.pgm", "1");
        let with_image = files.look();
        assert_ne!(with_image, two);
        fs::remove_dir_all(at.join("first")).unwrap();
        assert_eq!(files.look(), one);
    }

    #[test]
    fn the_maps_that_a_list_names_are_seen_and_a_broken_list_keeps_them() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let list = at.join("maps.yaml");
        let named = |map: &str| {
            let other = "{name: yard, map: yard.yaml}";
            let text = format!("maps: [{{name: ground, map: {map}}}, {other}]\n");
            write(at, "maps.yaml", &text);
        };
        for map in ["old", "new", "yard"] {
            write(at, &format!("{map}.yaml"), "image: map.pgm\n");
        }
        named("old.yaml");
        let mut files = SetFiles::new(&list, &["ground".to_owned()]);
        let old = files.look();
        write(at, "new.yaml", "image: other.pgm\n");
        write(at, "yard.yaml", "image: other.pgm\n");
        assert_eq!(files.look(), old);
        named("new.yaml");
        let new = files.look();
        write(at, "old.yaml", "image: other.pgm\n");
        assert_eq!(files.look(), new);
        write(at, "new.yaml", "image: yet_another.pgm\n");
        assert_ne!(files.look(), new);

        fs::remove_file(&list).unwrap();
        let gone = files.look();
        assert!(gone.problem.is_some() && gone.list.is_none());
        write(at, "new.yaml", "image: map.pgm\n");
        assert_ne!(files.look().maps, gone.maps);
    }
}
