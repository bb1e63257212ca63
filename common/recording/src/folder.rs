//! Finds the files of a recording: a single one, or those of a rosbag2 bag.
//!
//! A bag is a folder. Its `metadata.yaml` lists the parts in their order. Without it, as after a
//! recorder was killed, the parts are the `.mcap` or `.db3` files of the folder, sorted by name,
//! with numbers in the names compared by value. A part may be compressed (`.zstd`) or not, also if
//! the list says otherwise.

use std::path::{Component, Path, PathBuf};

use serde::Deserialize;

use crate::RecordingError;
use crate::content::{Content, foreign, is_stream};

const METADATA: &str = "metadata.yaml";

const PACKED: [&str; 2] = ["zstd", "zst"];

/// Extensions of unsupported compression, found only to report them.
const PACKED_OTHERWISE: [&str; 4] = ["gz", "xz", "lz4", "bz2"];

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Listed {
    pub(crate) path: PathBuf,
    pub(crate) messages: Option<u64>,
}

pub(crate) fn files(path: &Path) -> Result<Vec<Listed>, RecordingError> {
    let unreadable = RecordingError::open(path);
    if is_stream(path) {
        let (path, messages) = (path.to_owned(), None);
        return Ok(vec![Listed { path, messages }]);
    }
    if std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        let metadata = path.join(METADATA);
        // A recorder that was killed leaves an empty one.
        return match std::fs::metadata(&metadata) {
            Ok(found) if found.len() > 0 => named(&metadata, path),
            _ => unnamed(path),
        };
    }
    let is_named = path.file_name().is_some_and(|name| name == METADATA);
    let folder = path.parent().unwrap_or(Path::new(""));
    match is_named || Content::of(path)? == Content::Metadata {
        true => named(path, folder),
        false => Ok(vec![Listed {
            messages: described(path, folder),
            path: path.to_owned(),
        }]),
    }
}

#[derive(Deserialize)]
struct Description {
    rosbag2_bagfile_information: Information,
}

/// The needed fields of a description, which has more.
#[derive(Deserialize)]
struct Information {
    relative_file_paths: Vec<String>,
    message_count: Option<u64>,
    /// Since ROS 2 Galactic.
    files: Option<Vec<Counted>>,
}

#[derive(Deserialize)]
struct Counted {
    path: String,
    message_count: Option<u64>,
}

impl Information {
    fn read(metadata: &Path) -> Result<Self, RecordingError> {
        let text = std::fs::read_to_string(metadata).map_err(RecordingError::open(metadata))?;
        let description: Description = serde_saphyr::from_str(&text).map_err(|error| {
            let error = error.to_string();
            let error = error.lines().next().unwrap_or_default();
            refused(
                metadata,
                format!("it is not a description of a bag: {error}"),
            )
        })?;
        Ok(description.rosbag2_bagfile_information)
    }

    fn messages(&self, name: &str) -> Option<u64> {
        let mut files = self.files.iter().flatten();
        let counted = files.find(|file| file.path == name);
        match (counted, &self.relative_file_paths[..]) {
            (Some(counted), _) => counted.message_count,
            (None, [_]) => self.message_count,
            (None, _) => None,
        }
    }
}

fn named(metadata: &Path, folder: &Path) -> Result<Vec<Listed>, RecordingError> {
    let information = Information::read(metadata)?;
    let names = &information.relative_file_paths;
    if names.is_empty() {
        return Err(refused(metadata, "it names no files".to_owned()));
    }
    let part = |name: &String| {
        let missing = || format!("it names {name}, which is not in {}", shown(folder));
        let path = found(folder, name).ok_or_else(|| refused(metadata, missing()))?;
        Ok(Listed {
            path,
            messages: information.messages(name),
        })
    };
    names.iter().map(part).collect()
}

/// Returns the path of a listed part; some writers prefix it with the folder's own name.
fn found(folder: &Path, name: &str) -> Option<PathBuf> {
    let name = Path::new(name);
    let is_inside = name.components().all(|c| matches!(c, Component::Normal(_)));
    let own = Path::new(name.file_name()?);
    let names = [name, own].into_iter().skip(usize::from(!is_inside));
    let mut paths = names.flat_map(|name: &Path| {
        let path = folder.join(name);
        let endings = PACKED.into_iter().chain(PACKED_OTHERWISE);
        let packed = endings.map(|ending| with_ending(&path, &format!(".{ending}")));
        let packed: Vec<PathBuf> = packed.collect();
        let unpacked = without_ending(&path);
        [path].into_iter().chain(packed).chain(unpacked)
    });
    paths.find(|path| path.is_file())
}

pub(crate) fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// Name of a compressed file without its compression extension.
fn without_ending(path: &Path) -> Option<PathBuf> {
    let ending = path.extension()?;
    let is_packed = PACKED.iter().any(|packed| ending == *packed);
    is_packed.then(|| path.with_extension(""))
}

/// Number of messages in a single file by the description next to it.
fn described(path: &Path, folder: &Path) -> Option<u64> {
    let information = Information::read(&folder.join(METADATA)).ok()?;
    let name = path.file_name()?.to_str()?;
    let mut names = information.relative_file_paths.iter();
    let is_listed = names.any(|listed| listed == name);
    is_listed.then(|| information.messages(name)).flatten()
}

fn unnamed(folder: &Path) -> Result<Vec<Listed>, RecordingError> {
    let unreadable = RecordingError::open(folder);
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        paths.push(entry.map_err(unreadable)?.path());
    }
    // A part that exists both compressed and uncompressed counts once.
    let all = paths.clone();
    let is_twice = |path: &Path| without_ending(path).is_some_and(|path| all.contains(&path));
    paths.retain(|path| storage(path).is_some() && path.is_file() && !is_twice(path));
    paths.sort_by_cached_key(|path| sort_key(&shown(path)));
    // A disk that was full for a while leaves empty parts between others. An empty part at the end
    // is kept, so that reading reports it.
    let is_empty = |path: &PathBuf| std::fs::metadata(path).is_ok_and(|found| found.len() == 0);
    if let Some(last) = paths.iter().rposition(|path| !is_empty(path)) {
        let after = paths.split_off(last);
        paths.retain(|path| !is_empty(path));
        paths.extend(after);
    }
    let Some(first) = paths.first() else {
        for path in all.iter().filter(|path| path.is_file()) {
            if let Content::Foreign(what, advice) = Content::of(path)? {
                return Err(foreign(path, what, advice));
            }
        }
        let reason = format!("it holds no {METADATA}, no .mcap and no .db3");
        return Err(refused(folder, reason));
    };
    if let Some(other) = paths.iter().find(|path| storage(path) != storage(first)) {
        let (first, other) = (shown(first), shown(other));
        return Err(refused(
            folder,
            format!(
                "it holds .mcap and .db3, as {first} and {other}, and no {METADATA} that says which \
                 of them belong to it: name the files"
            ),
        ));
    }
    let listed = |path| Listed {
        path,
        messages: None,
    };
    Ok(paths.into_iter().map(listed).collect())
}

/// Storage format by a part's name: `mcap` or `db3`.
fn storage(path: &Path) -> Option<String> {
    let unpacked = without_ending(path).unwrap_or_else(|| path.to_owned());
    let ending = unpacked.extension()?.to_str()?.to_lowercase();
    ["mcap", "db3"].contains(&ending.as_str()).then_some(ending)
}

/// Returns a key by which numbers in names count by their value: `r_2` comes before `r_10`.
fn sort_key(name: &str) -> String {
    let padded = |piece: &str| {
        let rest = piece.trim_start_matches(|c: char| c.is_ascii_digit());
        match &piece[..piece.len() - rest.len()] {
            "" => rest.to_owned(),
            digits => format!("{:0>20}{rest}", digits.trim_start_matches('0')),
        }
    };
    let pieces = name.split_inclusive(|c: char| !c.is_ascii_digit());
    pieces.map(padded).collect()
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

pub(crate) fn refused(path: &Path, reason: String) -> RecordingError {
    RecordingError::Bag {
        path: path.to_owned(),
        reason,
    }
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;

    fn folder(names: &[&str], metadata: Option<&str>) -> TempDir {
        let folder = TempDir::new().unwrap();
        for name in names {
            std::fs::write(folder.path().join(name), b"").unwrap();
        }
        if let Some(text) = metadata {
            std::fs::write(folder.path().join(METADATA), text).unwrap();
        }
        folder
    }

    fn description(names: &[&str]) -> String {
        let names: String = names.iter().map(|name| format!("  - {name}\n")).collect();
        format!(
            "rosbag2_bagfile_information:\n  version: 9\n  message_count: 5\n  \
             relative_file_paths:\n{names}  custom_data: ~\n"
        )
    }

    fn names(folder: &TempDir) -> Result<Vec<String>, String> {
        let files = files(folder.path()).map_err(|error| error.to_string())?;
        let name = |file: &Listed| file.path.file_name().unwrap().to_str().unwrap().to_owned();
        Ok(files.iter().map(name).collect())
    }

    #[test]
    fn a_description_says_which_files_and_in_which_order() {
        let text = description(&["r_1.mcap", "r_0.mcap"]);
        let folder = folder(&["r_0.mcap", "r_1.mcap", "r_2.mcap"], Some(&text));
        let expected = ["r_1.mcap", "r_0.mcap"].map(str::to_owned).to_vec();
        assert_eq!(names(&folder), Ok(expected));
        let by_metadata = files(&folder.path().join(METADATA)).unwrap();
        assert_eq!(by_metadata, files(folder.path()).unwrap());
    }

    #[test]
    fn a_part_is_found_packed_unpacked_and_by_its_own_name() {
        let text = description(&["a_0.mcap", "a_1.mcap.zstd", "a/a_2.db3", "../a_3.db3"]);
        let there = ["a_0.mcap.zstd", "a_1.mcap", "a_2.db3", "a_3.db3"];
        assert_eq!(
            names(&folder(&there, Some(&text))),
            Ok(there.map(str::to_owned).to_vec())
        );
    }

    #[test]
    fn without_a_description_names_and_their_numbers_give_the_order() {
        let there = [
            "r_10.mcap",
            "r_2.mcap",
            "r_9.mcap.zstd",
            "r_2.mcap.zstd",
            "notes",
        ];
        let expected = ["r_2.mcap", "r_9.mcap.zstd", "r_10.mcap"].map(str::to_owned);
        for metadata in [None, Some("")] {
            assert_eq!(names(&folder(&there, metadata)), Ok(expected.to_vec()));
        }
    }

    #[test]
    fn parts_that_a_full_disk_left_empty_are_passed_over_where_others_follow() {
        let all = ["r_0.mcap", "r_1.mcap", "r_2.mcap", "r_3.mcap"];
        let folder = folder(&all, None);
        for name in ["r_0.mcap", "r_2.mcap"] {
            std::fs::write(folder.path().join(name), "messages").unwrap();
        }
        let expected = ["r_0.mcap", "r_2.mcap", "r_3.mcap"].map(str::to_owned);
        assert_eq!(names(&folder), Ok(expected.to_vec()));
    }

    #[test]
    fn what_is_not_clear_is_said() {
        let said = |there: &[&str], metadata: Option<&str>| {
            let refusal = names(&folder(there, metadata)).unwrap_err();
            refusal.split_once(": ").unwrap().1.to_owned()
        };
        let missing = said(&["r_0.mcap"], Some(&description(&["r_0.mcap", "r_1.mcap"])));
        assert!(
            missing.starts_with("it names r_1.mcap, which is not in "),
            "{missing}"
        );
        assert_eq!(
            said(
                &[],
                Some(&description(&[]))
                    .map(|text| text.replace("paths:", "paths: []"))
                    .as_deref()
            ),
            "it names no files"
        );
        let yaml = said(&[], Some("resolution: 0.05"));
        assert!(
            yaml.starts_with("it is not a description of a bag: "),
            "{yaml}"
        );
        assert_eq!(
            said(&["notes.txt"], None),
            "it holds no metadata.yaml, no .mcap and no .db3"
        );
        let mixed = said(&["r_0.mcap", "r_0.db3"], None);
        assert!(mixed.contains("it holds .mcap and .db3, as "), "{mixed}");
        let nothing = files(Path::new("no/such/bag")).unwrap_err().to_string();
        assert_eq!(nothing, "cannot read the recording no/such/bag");
    }

    #[test]
    fn messages_are_counted_for_a_file_or_for_the_only_one() {
        let text = description(&["r_0.db3"]);
        let one = folder(&["r_0.db3"], Some(&text));
        let counts = |path: &Path| {
            let files = files(path).unwrap();
            files.iter().map(|file| file.messages).collect::<Vec<_>>()
        };
        assert_eq!(counts(one.path()), [Some(5)]);
        assert_eq!(counts(&one.path().join("r_0.db3")), [Some(5)]);
        let counted = description(&["r_0.db3", "r_1.db3"])
            + "  files:\n  - path: r_1.db3\n    message_count: 3\n";
        let two = folder(&["r_0.db3", "r_1.db3"], Some(&counted));
        assert_eq!(counts(two.path()), [None, Some(3)]);
    }

    #[test]
    fn numbers_count_by_their_value() {
        let mut names = ["r_10", "r_9b", "r_9", "r_009a", "q", "r_"];
        names.sort_by_key(|name| sort_key(name));
        assert_eq!(names, ["q", "r_", "r_9", "r_009a", "r_9b", "r_10"]);
    }
}
