//! Names for the output files of a drive.

use std::path::{Component, Path, PathBuf};

/// Returns a name for each recording: its path relative to the common folder, without extension and
/// with `_` for `/`; for a single recording, its file name.
pub(super) fn of(recordings: &[PathBuf]) -> Vec<String> {
    let bare = recordings.iter().map(|path| path.with_extension(""));
    let bare: Vec<PathBuf> = bare.collect();
    let parts: Vec<Vec<&str>> = bare.iter().map(|path| parts(path)).collect();
    let shortest = parts.iter().map(|parts| parts.len() - 1).min();
    let is_common = |at: &usize| parts.iter().all(|path| path[*at] == parts[0][*at]);
    let common = match recordings {
        [_] => shortest.unwrap_or_default(),
        _ => (0..shortest.unwrap_or_default())
            .take_while(is_common)
            .count(),
    };
    let names = parts.iter().map(|parts| parts[common..].join("_"));
    names.collect()
}

/// Components of a path; at least one.
fn parts(path: &Path) -> Vec<&str> {
    let names = path.components().filter_map(|component| match component {
        Component::Normal(name) => Some(name.to_str().unwrap_or("drive")),
        _ => None,
    });
    let names: Vec<&str> = names.collect();
    match names.is_empty() {
        true => vec!["drive"],
        false => names,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drives_of_the_same_name_are_told_apart_by_their_folders() {
        let of = |paths: &[&str]| of(&paths.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(of(&["/data/a/recording.mcap"]), ["recording"]);
        let all = ["/data/a/recording.mcap", "/data/b/c/recording.mcap"];
        assert_eq!(of(&all), ["a_recording", "b_c_recording"]);
        assert_eq!(of(&["x/one.mcap", "x/two.db3"]), ["one", "two"]);
        assert_eq!(of(&["..", "two"]), ["drive", "two"]);
    }
}
