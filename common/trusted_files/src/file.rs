//! Opens a file, and checks the open file.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;

use nix::errno::Errno;
use nix::libc::{O_NOCTTY, O_NOFOLLOW, O_NONBLOCK};

use crate::{TrustError, check_owner, current_user};

const WRITE: u32 = 0o022;

/// Opens a regular file of this user or of root that no other user can write; `None` if there is no
/// file. It neither follows a link nor waits for the writer of a pipe.
pub fn open(path: &Path) -> Result<Option<File>, TrustError> {
    open_as(current_user(), path)
}

/// Reads the text of such a file, with at most `most` bytes; `None` if there is no file.
pub fn read(path: &Path, most: u64) -> Result<Option<String>, TrustError> {
    let Some(file) = open(path)? else {
        return Ok(None);
    };
    let mut text = String::new();
    let read = file.take(most.saturating_add(1)).read_to_string(&mut text);
    read.map_err(failed("read", path))?;
    if text.len() as u64 > most {
        let path = path.to_owned();
        return Err(TrustError::TooLong { path, most });
    }
    Ok(Some(text))
}

fn open_as(user: u32, path: &Path) -> Result<Option<File>, TrustError> {
    let mut options = OpenOptions::new();
    options
        .read(true)
        .custom_flags(O_NOFOLLOW | O_NONBLOCK | O_NOCTTY);
    let not_a_file = || TrustError::NotAFile(path.to_owned());
    let file = match options.open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        // A link or a socket.
        Err(error)
            if [Errno::ELOOP, Errno::ENXIO]
                .map(|e| e as i32)
                .contains(&code(&error)) =>
        {
            return Err(not_a_file());
        }
        Err(error) => return Err(failed("open", path)(error)),
    };
    let found = file.metadata().map_err(failed("look at", path))?;
    if !found.is_file() {
        return Err(not_a_file());
    }
    check_owner(path, &found, user)?;
    let (owner, mode) = (found.uid(), found.mode() & 0o777);
    match mode & WRITE {
        0 => Ok(Some(file)),
        _ => {
            let path = path.to_owned();
            Err(TrustError::Writable { path, owner, mode })
        }
    }
}

fn code(error: &io::Error) -> i32 {
    error.raw_os_error().unwrap_or_default()
}

/// Returns a function that converts an error of a file operation.
pub fn failed(action: &'static str, path: &Path) -> impl Fn(io::Error) -> TrustError {
    move |source| TrustError::File {
        action,
        path: path.to_owned(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use std::fs::{Permissions, create_dir, set_permissions, write};
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::os::unix::net::UnixListener;

    use nix::sys::stat::Mode;
    use nix::unistd::mkfifo;

    use super::*;

    #[test]
    fn a_file_of_this_user_is_read_and_one_of_another_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        assert!(open(&path).unwrap().is_none());
        write(&path, "text").unwrap();
        assert_eq!(read(&path, 4).unwrap().as_deref(), Some("text"));
        let long = read(&path, 3).unwrap_err();
        assert!(matches!(long, TrustError::TooLong { most: 3, .. }));
        let me = current_user();
        // If root runs the tests, as in a container, files of root are always trusted.
        if me != 0 {
            let foreign = open_as(me + 1, &path).unwrap_err();
            assert!(matches!(foreign, TrustError::Foreign { owner, .. } if owner == me));
        } else {
            std::os::unix::fs::chown(&path, Some(65534), None).unwrap();
            let foreign = open(&path).unwrap_err();
            assert!(matches!(foreign, TrustError::Foreign { owner: 65534, .. }));
            assert!(open_as(65534, &path).is_ok());
        }
    }

    #[test]
    fn a_file_that_others_can_change_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        write(&path, "text").unwrap();
        for mode in [0o600, 0o644, 0o400] {
            set_permissions(&path, Permissions::from_mode(mode)).unwrap();
            assert!(open(&path).unwrap().is_some(), "{mode:o}");
        }
        for mode in [0o620, 0o602, 0o666] {
            set_permissions(&path, Permissions::from_mode(mode)).unwrap();
            let refused = open(&path).unwrap_err();
            assert!(matches!(refused, TrustError::Writable { mode: found, .. } if found == mode));
        }
    }

    #[test]
    fn what_is_no_file_is_refused_without_waiting() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        write(at("file"), "text").unwrap();
        symlink(at("file"), at("link")).unwrap();
        symlink("/dev/zero", at("endless")).unwrap();
        create_dir(at("folder")).unwrap();
        mkfifo(&at("pipe"), Mode::S_IRWXU).unwrap();
        let _socket = UnixListener::bind(at("socket")).unwrap();
        for name in ["link", "endless", "folder", "pipe", "socket"] {
            let refused = open(&at(name)).unwrap_err();
            assert!(
                matches!(&refused, TrustError::NotAFile(path) if *path == at(name)),
                "{refused}"
            );
        }
    }
}
