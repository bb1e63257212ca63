//! Names for new files.

use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use command_line::output::with_number;

use crate::RecorderError;

/// Largest number tried.
const MAX: u32 = 100_000;

/// Creates the file `path`; if it exists, the first free one of `stem_1.mcap`, `stem_2.mcap` and so
/// on. With `numbered`, the names start at `stem_0.mcap`, like the parts of a rosbag2 bag. Missing
/// folders are created.
pub(super) fn create(path: &Path, numbered: bool) -> Result<(PathBuf, File), RecorderError> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed(path))?;
    }
    let plain = (!numbered).then(|| path.to_owned());
    let first = u32::from(!numbered);
    let candidates = plain
        .into_iter()
        .chain((first..MAX).map(|n| with_number(path, n)));
    for candidate in candidates {
        match File::create_new(&candidate) {
            Ok(file) => return Ok((candidate, file)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(failed(&candidate)(error)),
        }
    }
    Err(RecorderError::NoFreeName {
        path: path.to_owned(),
        tried: MAX,
    })
}

fn failed(path: &Path) -> impl FnOnce(std::io::Error) -> RecorderError {
    RecorderError::file(format!("cannot create the recording {}", path.display()))
}

#[cfg(test)]
mod tests {
    use command_line::output::numbered;

    use super::*;

    #[test]
    fn what_exists_is_kept() {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("drive.mcap");
        let name = |numbered| {
            let (path, _) = create(&path, numbered).unwrap();
            path.file_name().unwrap().to_string_lossy().into_owned()
        };
        assert_eq!(
            [name(false), name(false), name(false)],
            ["drive.mcap", "drive_1.mcap", "drive_2.mcap"]
        );
        assert_eq!([name(true), name(true)], ["drive_0.mcap", "drive_3.mcap"]);
        for other in [
            "drive_x.mcap",
            "drive_01.mcap",
            "drive_1.db3",
            "other_1.mcap",
        ] {
            File::create_new(folder.path().join(other)).unwrap();
        }
        assert_eq!(numbered(&path).len(), 5);
        let nowhere = Path::new("/proc/no/such/r.mcap");
        let error = create(nowhere, false).unwrap_err();
        assert!(error.to_string().contains("/no/such/r.mcap"), "{error}");
        let new = folder.path().join("a/b/r.mcap");
        assert_eq!(create(&new, false).unwrap().0, new);
    }
}
