//! Detects changes of the files of a map or of a set, without reading the images.
//!
//! Polling, unlike listening for events, works on every file system, including network ones, and
//! with every way in which editors replace files. The contents are not checked here.

use std::fs;
use std::io::Read;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use transport::with_causes;

/// Number of bytes read of a description; a valid one has a few hundred.
const MAX_YAML_BYTES: u64 = 64 << 10;

/// Identity of a file's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Fingerprint {
    device: u64,
    /// Inode number; it changes if another file takes the place by renaming.
    inode: u64,
    size: u64,
    modified_s: i64,
    modified_ns: i64,
}

/// State of the files at one moment.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Seen {
    /// Each file with its state; `None` for a missing one.
    files: Vec<(PathBuf, Option<Fingerprint>)>,
    /// Error that makes a set invalid; none of its maps is then watched.
    problem: Option<String>,
}

#[derive(Deserialize)]
struct Named {
    image: String,
}

impl Seen {
    /// Looks at the description of a map, and at the image that it names.
    pub(crate) fn of_map(yaml: &Path) -> Self {
        let mut seen = Seen::default();
        seen.add_map(yaml);
        seen
    }

    /// Looks at the list of a set, if there is one, and at each map that it names; if `on` is not
    /// empty, only at the maps and floors with these names. The set is resolved each time, because
    /// no known file changes when a folder is added or filled later. Other files are ignored.
    pub(crate) fn of_set(path: &Path, on: &[String]) -> Self {
        let mut seen = Seen::default();
        seen.add(&map::list_of(path));
        match map::set_of(path).and_then(|set| set.select(on)) {
            Ok(set) => set.maps.iter().for_each(|map| seen.add_map(&map.yaml)),
            Err(error) => seen.problem = Some(with_causes(&error)),
        }
        seen
    }

    fn add_map(&mut self, yaml: &Path) {
        self.add(yaml);
        if let Some(image) = named_image(yaml) {
            self.add(&image);
        }
    }

    fn add(&mut self, path: &Path) {
        self.files.push((path.to_owned(), fingerprint(path)));
    }
}

fn fingerprint(path: &Path) -> Option<Fingerprint> {
    let metadata = fs::metadata(path).ok()?;
    Some(Fingerprint {
        device: metadata.dev(),
        inode: metadata.ino(),
        size: metadata.size(),
        modified_s: metadata.mtime(),
        modified_ns: metadata.mtime_nsec(),
    })
}

fn named_image(yaml: &Path) -> Option<PathBuf> {
    let mut text = String::new();
    let file = fs::File::open(yaml).ok()?;
    file.take(MAX_YAML_BYTES).read_to_string(&mut text).ok()?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let named: Named = serde_saphyr::from_str(text).ok()?;
    Some(yaml.parent()?.join(named.image.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(folder: &Path, name: &str, text: &str) {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    #[test]
    fn sees_both_files_change_and_follows_the_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let look = || Seen::of_map(&at.join("a.yaml"));
        let nothing = look();
        write(at, "a.yaml", "image: one.pgm\nresolution: 0.05\n");
        let without_image = look();
        assert_ne!(without_image, nothing);
        write(at, "one.pgm", "1");
        let one = look();
        assert_ne!(one, without_image);
        assert_eq!(look(), one);
        write(at, "one.pgm", "22");
        let grown = look();
        assert_ne!(grown, one);
        // Another file of the same size with the same name.
        write(at, "new", "33");
        fs::rename(at.join("new"), at.join("one.pgm")).unwrap();
        assert_ne!(look(), grown);
        write(at, "a.yaml", "image: two.pgm\n");
        let two = look();
        write(at, "one.pgm", "4444");
        assert_eq!(look(), two);
        write(at, "two.pgm", "4444");
        assert_ne!(look(), two);
        write(at, "a.yaml", "image: [");
        assert_eq!(look().files.len(), 1);
    }

    #[test]
    fn maps_of_a_folder_are_seen_as_they_come_and_other_files_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let look = || Seen::of_set(at, &[]);
        write(at, "ground/map.yaml", "image: map.pgm\n");
        let one = look();
        assert_eq!(look(), one);
        write(at, "notes.txt", "1");
        write(at, "params.yaml", "amcl: 1\n");
        fs::create_dir(at.join("first")).unwrap();
        assert_eq!(look(), one);
        write(at, "first/map.yaml", "image: map.pgm\n");
        let two = look();
        assert_ne!(two, one);
        write(at, "first/map.pgm", "1");
        assert_ne!(look(), two);
        fs::remove_dir_all(at.join("first")).unwrap();
        assert_eq!(look(), one);
    }

    #[test]
    fn the_maps_that_a_list_names_are_seen_and_a_list_that_is_gone() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let list = at.join("maps.yaml");
        let look = || Seen::of_set(&list, &["ground".to_owned()]);
        let named = |map: &str| {
            let other = "{name: yard, map: yard.yaml}";
            let text = format!("maps: [{{name: ground, map: {map}}}, {other}]\n");
            write(at, "maps.yaml", &text);
        };
        for map in ["old", "new", "yard"] {
            write(at, &format!("{map}.yaml"), "image: map.pgm\n");
        }
        named("old.yaml");
        let old = look();
        write(at, "new.yaml", "image: other.pgm\n");
        write(at, "yard.yaml", "image: other.pgm\n");
        assert_eq!(look(), old);
        named("new.yaml");
        let new = look();
        write(at, "old.yaml", "image: other.pgm\n");
        assert_eq!(look(), new);
        write(at, "new.yaml", "image: yet_another.pgm\n");
        assert_ne!(look(), new);
        fs::remove_file(&list).unwrap();
        let gone = look();
        assert!(gone.problem.is_some() && gone != new);
    }
}
