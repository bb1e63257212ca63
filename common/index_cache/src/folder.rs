//! The cache folder: private, with a limited total size of files.

use std::fs::{DirBuilder, read_dir, remove_file, symlink_metadata};
use std::io::{self, ErrorKind};
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use tempfile::NamedTempFile;

use crate::CacheError;
use crate::error::failed;

pub(crate) const ENDING: &str = "index";

pub(crate) fn of_user() -> Result<PathBuf, CacheError> {
    let folder = dirs::cache_dir().ok_or(CacheError::NoHome)?;
    Ok(folder.join("backcast"))
}

pub(crate) fn make(path: &Path) -> Result<(), CacheError> {
    let made = DirBuilder::new().mode(0o700).recursive(true).create(path);
    match made {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => {
            Err(failed("create folder", path)(error))
        }
        _ => is_there(path).map(|_| ()),
    }
}

/// Returns true if the folder exists.
///
/// # Errors
/// Another user could have written its files.
pub(crate) fn is_there(path: &Path) -> Result<bool, CacheError> {
    let user = nix::unistd::geteuid().as_raw();
    is_there_for(user, path)
}

fn is_there_for(user: u32, path: &Path) -> Result<bool, CacheError> {
    // A link is not followed: it could lead to a folder of another user.
    let found = match symlink_metadata(path) {
        Ok(found) => found,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
        Err(error) => return Err(failed("look at", path)(error)),
    };
    let (owner, mode) = (found.uid(), found.mode() & 0o777);
    let why = if !found.is_dir() {
        "it is no folder; remove it, or set --index-cache".to_owned()
    } else if owner != user {
        format!("it belongs to user {owner}, and this is user {user}; set --index-cache")
    } else if mode & 0o077 != 0 {
        format!("its mode is {mode:03o}, so others can use it; chmod 700 makes it private")
    } else {
        return Ok(true);
    };
    let path = path.to_owned();
    Err(CacheError::Folder { path, why })
}

/// Creates a temporary file, which is removed unless it is renamed.
pub(crate) fn new_file(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.suffix(&format!(".{ENDING}")).tempfile_in(folder)
}

/// Removes the least recently used files, including those of interrupted writes, until the total
/// size is at most `limit` bytes; `spared` is not removed.
pub(crate) fn trim(folder: &Path, spared: &Path, limit: u64) -> Result<(), CacheError> {
    let listed = read_dir(folder).map_err(failed("list", folder))?;
    let mut files: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
    // Files without metadata were removed meanwhile.
    for entry in listed.flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|ending| ending == ENDING)
            && let Ok(found) = entry.metadata()
            && let Ok(used) = found.modified()
            && found.is_file()
        {
            files.push((used, found.len(), path));
        }
    }
    files.sort();
    let mut total: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
    for (_, bytes, path) in files.iter().filter(|(_, _, path)| path != spared) {
        if total <= limit {
            break;
        }
        match remove_file(path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(failed("remove", path)(error));
            }
            _ => total -= bytes,
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs::{File, Permissions, create_dir, set_permissions, write};
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_folder_is_made_private_with_those_above_it() {
        let parent = tempfile::tempdir().unwrap();
        let path = parent.path().join("cache").join("backcast");
        assert!(!is_there(&path).unwrap());
        make(&path).unwrap();
        make(&path).unwrap();
        assert!(is_there(&path).unwrap());
        assert_eq!(symlink_metadata(&path).unwrap().mode() & 0o777, 0o700);
    }

    #[test]
    fn what_others_could_have_written_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let user = nix::unistd::geteuid().as_raw();
        let foreign = is_there_for(user + 1, folder.path()).unwrap_err();
        assert!(foreign.to_string().contains(&format!("user {user}, and")));
        for mode in [0o701, 0o720, 0o777] {
            set_permissions(folder.path(), Permissions::from_mode(mode)).unwrap();
            let shared = make(folder.path()).unwrap_err().to_string();
            assert!(shared.contains(&format!("mode is {mode:o}")), "{shared}");
        }
    }

    #[test]
    fn what_is_no_folder_is_refused_and_no_link_followed() {
        let parent = tempfile::tempdir().unwrap();
        let (folder, link, file) = ["folder", "link", "file"]
            .map(|name| parent.path().join(name))
            .into();
        create_dir(&folder).unwrap();
        symlink(&folder, &link).unwrap();
        write(&file, "").unwrap();
        for path in [link, file] {
            let refused = make(&path).unwrap_err().to_string();
            assert!(refused.contains("it is no folder"), "{refused}");
        }
    }

    #[test]
    fn the_files_that_were_not_used_for_longest_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let names = ["a.index", "b.index", ".tmp1.index", "d.index", "mine.txt"];
        for (i, name) in names.into_iter().enumerate() {
            write(path(name), [0; 10]).unwrap();
            let used = SystemTime::UNIX_EPOCH + Duration::from_secs(i as u64);
            File::open(path(name)).unwrap().set_modified(used).unwrap();
        }
        let left = |limit| {
            trim(folder.path(), &path("b.index"), limit).unwrap();
            names.map(|name| path(name).exists())
        };
        assert_eq!(left(40), [true; 5]);
        assert_eq!(left(39), [false, true, true, true, true]);
        assert_eq!(left(20), [false, true, false, true, true]);
        assert_eq!(
            left(0),
            [false, true, false, false, true],
            "one is spared, one not ours"
        );
    }
}
