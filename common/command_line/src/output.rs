//! Files and folders that commands write: made ready before the work starts, so that a failure costs
//! none.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::Path;

/// Makes the folder of an output file, and checks that the file can be written there.
///
/// # Errors
/// The folder cannot be made or written into, or there is a folder in place of the file; of kind
/// [`ErrorKind::AlreadyExists`] if the file exists and is not to be overwritten.
pub fn prepare(file: &Path, overwrites: bool) -> io::Result<()> {
    if file.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    match (file.exists(), overwrites) {
        (true, false) => Err(io::Error::new(
            ErrorKind::AlreadyExists,
            "it is there already; --force overwrites it",
        )),
        (true, true) => Ok(()),
        (false, _) => make_folder(folder_of(file)),
    }
}

/// Makes a folder and those above it, and checks that files can be written into it.
///
/// # Errors
/// It cannot be made or written into.
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
#[must_use]
pub fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_made_and_what_cannot_be_written_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let prepared = |name: &str, overwrites| {
            let outcome = prepare(&folder.path().join(name), overwrites);
            outcome.map_err(|error| error.kind())
        };
        assert_eq!(prepared("a/b/r.mcap", false), Ok(()));
        fs::write(folder.path().join("a/b/r.mcap"), "").unwrap();
        assert_eq!(prepared("a/b/r.mcap", true), Ok(()));
        assert_eq!(prepared("a/b/r.mcap", false), Err(ErrorKind::AlreadyExists));
        assert_eq!(prepared("a/b", true), Err(ErrorKind::IsADirectory));
        assert_eq!(
            prepared("a/b/r.mcap/s", true),
            Err(ErrorKind::NotADirectory)
        );
    }
}
