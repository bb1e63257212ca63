//! Files and folders that commands write, made ready before the work starts.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use anyhow::Context;

use crate::wrong_use;

/// Makes the folder of an output file; fails if the file cannot be written or may not be replaced.
pub fn prepare(file: &Path, overwrites: bool) -> anyhow::Result<()> {
    let path = file.display();
    if file.exists() && !file.is_dir() {
        return match overwrites {
            true => Ok(()),
            false => Err(wrong_use(format!(
                "{path} is there already; --force overwrites it"
            ))),
        };
    }
    let prepared = match file.is_dir() {
        true => Err(ErrorKind::IsADirectory.into()),
        false => make_folder(folder_of(file)),
    };
    prepared.with_context(|| format!("cannot write {path}"))
}

/// Makes a folder and those above it; fails if files cannot be written into it.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    if folder.exists() && !folder.is_dir() {
        return Err(ErrorKind::NotADirectory.into());
    }
    fs::create_dir_all(folder)?;
    let trial = folder.join(format!(".backcast-trial-{}", std::process::id()));
    File::create_new(&trial)?;
    fs::remove_file(&trial)
}

/// Returns the folder that a file is in; for a bare name, the current one.
pub fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// Returns the existing files of this name and of [`with_number`], in any order.
pub fn numbered(path: &Path) -> Vec<PathBuf> {
    let folder = folder_of(path);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let is_one = |found: &Path| {
        let number = found.file_stem().unwrap_or_default().to_string_lossy();
        let number = number
            .strip_prefix(&*stem)
            .map(|rest| rest.strip_prefix('_'));
        found.file_name() == path.file_name()
            || number.flatten().is_some_and(|number| {
                number
                    .parse()
                    .is_ok_and(|number| with_number(path, number).file_name() == found.file_name())
            })
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.map(|entry| entry.path());
    files.filter(|found| is_one(found)).collect()
}

/// Returns the name with a number after its stem, as of a part: `drive_2.mcap`.
pub fn with_number(path: &Path, number: u32) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let suffix = path
        .extension()
        .unwrap_or("mcap".as_ref())
        .to_string_lossy();
    path.with_file_name(format!("{stem}_{number}.{suffix}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FAILED, WRONG_USE, exit_code};

    #[test]
    fn folders_are_made_and_what_cannot_be_written_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let prepared = |name: &str, overwrites| {
            let outcome = prepare(&folder.path().join(name), overwrites);
            outcome.map_err(|error| exit_code(&error))
        };
        assert_eq!(prepared("a/b/r.mcap", false), Ok(()));
        fs::write(folder.path().join("a/b/r.mcap"), "").unwrap();
        assert_eq!(prepared("a/b/r.mcap", true), Ok(()));
        assert_eq!(prepared("a/b/r.mcap", false), Err(WRONG_USE));
        assert_eq!(prepared("a/b", true), Err(FAILED));
        assert_eq!(prepared("a/b/r.mcap/s", true), Err(FAILED));
    }
}
