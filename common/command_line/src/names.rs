//! Names of the recordings that a command is given.

use std::path::{Component, Path, PathBuf};

/// Returns a different name for each path: relative to the common folder, with `_` for `/`.
pub fn of(paths: &[PathBuf]) -> Vec<String> {
    let bare: Vec<PathBuf> = paths.iter().map(|path| path.with_extension("")).collect();
    let parts: Vec<Vec<&str>> = bare.iter().map(|path| parts(path)).collect();
    let shortest = parts.iter().map(|parts| parts.len() - 1).min();
    let is_common = |at: &usize| parts.iter().all(|path| path[*at] == parts[0][*at]);
    let common = match paths {
        [_] => shortest.unwrap_or_default(),
        _ => (0..shortest.unwrap_or_default())
            .take_while(is_common)
            .count(),
    };
    let mut names: Vec<String> = Vec::new();
    for name in parts.iter().map(|parts| parts[common..].join("_")) {
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let mut free = std::iter::once(name.clone()).chain(numbered);
        names.extend(free.find(|name| !names.contains(name)));
    }
    names
}

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
        assert_eq!(
            of(&["a/b.mcap", "a_b", "a/b.db3"]),
            ["a_b", "a_b_2", "a_b_3"]
        );
    }
}
