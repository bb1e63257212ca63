//! The folder where the processes of one user's graphs meet.
//!
//! iceoryx2 keeps its nodes, services and wake-up sockets in a folder that it
//! makes for whoever comes first; a second user is then locked out. So each
//! user has their own folder, which is locked against the cleaning of /tmp. Nothing
//! here decides for another user: a folder that is in the way is an error that says
//! whose it is.

use std::fs::{DirBuilder, File, Permissions, symlink_metadata};
use std::io::ErrorKind;
use std::os::unix::fs::{DirBuilderExt, MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};

use nix::fcntl::{Flock, FlockArg};

use crate::TransportError;

/// The user that this process acts as.
pub(crate) fn current_user() -> u32 {
    nix::unistd::geteuid().as_raw()
}

/// Where the graphs of `user` meet. Fixed, and not taken from the environment,
/// so that a service and a shell of the same user find each other.
pub(crate) fn path_for(user: u32) -> PathBuf {
    PathBuf::from(format!("/tmp/backcast-{user}"))
}

/// Makes sure that `path` is a folder of `user` that nobody else can use.
pub(crate) fn prepare(path: &Path, user: u32) -> Result<(), TransportError> {
    let failed = |action| {
        move |source| TransportError::File {
            action,
            path: path.to_owned(),
            source,
        }
    };
    match DirBuilder::new().mode(0o700).create(path) {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
        Err(error) => return Err(failed("create folder")(error)),
    }
    // A link is not followed: it could lead into a folder of somebody else.
    let found = symlink_metadata(path).map_err(failed("look at"))?;
    let owner = found.uid();
    if !found.is_dir() {
        let path = path.to_owned();
        return Err(TransportError::NotAFolder { path, owner });
    }
    if owner != user {
        let path = path.to_owned();
        return Err(TransportError::ForeignFolder { path, owner, user });
    }
    if found.mode() & 0o777 != 0o700 {
        let private = Permissions::from_mode(0o700);
        std::fs::set_permissions(path, private).map_err(failed("make private"))?;
    }
    Ok(())
}

/// Keeps systemd from cleaning `path`: it leaves out a folder that is locked, and all
/// that is below. One process of the user is enough, so nothing where another one has it.
pub(crate) fn keep_from_cleaning(path: &Path) -> Option<Flock<File>> {
    let folder = File::open(path).ok()?;
    Flock::lock(folder, FlockArg::LockExclusiveNonblock).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(path: &Path) -> u32 {
        symlink_metadata(path).unwrap().mode() & 0o777
    }

    #[test]
    fn one_process_keeps_the_folder_from_cleaning() {
        let folder = tempfile::tempdir().unwrap();
        let kept = keep_from_cleaning(folder.path());
        assert!(kept.is_some());
        assert!(keep_from_cleaning(folder.path()).is_none());
        drop(kept);
        assert!(keep_from_cleaning(folder.path()).is_some());
    }

    #[test]
    fn makes_a_private_folder_and_takes_it_again() {
        let parent = tempfile::tempdir().unwrap();
        let path = parent.path().join("mine");
        prepare(&path, current_user()).unwrap();
        assert_eq!(mode(&path), 0o700);
        std::fs::set_permissions(&path, Permissions::from_mode(0o777)).unwrap();
        prepare(&path, current_user()).unwrap();
        assert_eq!(mode(&path), 0o700);
    }

    #[test]
    fn names_the_owner_of_a_foreign_folder() {
        let folder = tempfile::tempdir().unwrap();
        let me = current_user();
        let error = prepare(folder.path(), me + 1).unwrap_err();
        let text = error.to_string();
        assert!(
            matches!(error, TransportError::ForeignFolder { owner, user, .. } if owner == me && user == me + 1)
        );
        assert!(
            text.contains(&folder.path().display().to_string()),
            "{text}"
        );
        assert!(text.contains("remove it"), "{text}");
    }

    #[test]
    fn refuses_what_is_no_folder_and_follows_no_link() {
        let parent = tempfile::tempdir().unwrap();
        let file = parent.path().join("file");
        std::fs::write(&file, "").unwrap();
        let link = parent.path().join("link");
        std::os::unix::fs::symlink(parent.path(), &link).unwrap();
        for path in [file, link] {
            let error = prepare(&path, current_user()).unwrap_err();
            assert!(matches!(error, TransportError::NotAFolder { path: p, .. } if p == path));
        }
    }

    #[test]
    fn says_what_it_could_not_create() {
        let parent = tempfile::tempdir().unwrap();
        let path = parent.path().join("missing").join("mine");
        let error = prepare(&path, current_user()).unwrap_err();
        assert!(
            matches!(&error, TransportError::File { path: p, .. } if *p == path),
            "{error}"
        );
    }
}
