//! The folder where the processes of one user's graphs meet, each user with their own, locked
//! against the cleaning of /tmp. As another user can take a name in /tmp, the first of several
//! candidates that is the user's, or can be created, counts, in any environment.

use std::fs::{DirBuilder, File, Permissions, symlink_metadata};
use std::io::ErrorKind;
use std::os::unix::fs::{DirBuilderExt, MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};

use nix::fcntl::{Flock, FlockArg};
use nix::unistd::{Uid, User};

use crate::TransportError;

const NAME: &str = "backcast";

/// Longest path of the folder in bytes: a socket in it has a path of at most 107.
pub(crate) const MAX_BYTES: usize = 27;

pub(crate) fn current_user() -> u32 {
    nix::unistd::geteuid().as_raw()
}

pub(crate) fn path_for(user: u32) -> PathBuf {
    let places = Places::of(user);
    let found = places.all().find(|path| is_of(path, user));
    found.unwrap_or_else(|| places.temporary.clone())
}

pub(crate) fn prepare(user: u32) -> Result<PathBuf, TransportError> {
    Places::of(user).prepare()
}

struct Places {
    user: u32,
    /// Candidates in `$XDG_RUNTIME_DIR` and `/run/user`, if these are private folders of the user.
    own: Vec<PathBuf>,
    /// Candidate in `/tmp`, which another user may have taken.
    temporary: PathBuf,
}

impl Places {
    fn of(user: u32) -> Self {
        let variable = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
        // Usual place on most systems, for a service without the variable.
        let usual = PathBuf::from(format!("/run/user/{user}"));
        Self::among(user, variable.into_iter().chain([usual]), Path::new("/tmp"))
    }

    fn among(user: u32, own: impl Iterator<Item = PathBuf>, temporary: &Path) -> Self {
        let own = own.filter(|path| path.is_absolute() && is_private(path, user));
        Places {
            user,
            own: own
                .map(|path| path.join(NAME))
                .filter(|path| is_short(path))
                .collect(),
            temporary: temporary.join(format!("{NAME}-{user}")),
        }
    }

    /// Returns all candidates in order. The last one is in the home folder, where no other user can
    /// create files; it is the last resort.
    fn all(&self) -> impl Iterator<Item = PathBuf> {
        let user = self.user;
        let home = move || {
            let found = User::from_uid(Uid::from_raw(user)).ok()??;
            let path = found.dir.join(format!(".{NAME}"));
            (is_of(&found.dir, user) && is_short(&path)).then_some(path)
        };
        let fixed = self.own.iter().chain([&self.temporary]).cloned();
        fixed.chain(std::iter::once_with(home).flatten())
    }

    fn prepare(&self) -> Result<PathBuf, TransportError> {
        let user = self.user;
        if let Some(path) = self.all().find(|path| is_of(path, user)) {
            return make(&path, user).map(|()| path);
        }
        let mut failed = None;
        for path in self.all() {
            match make(&path, user) {
                Ok(()) => return Ok(path),
                // The error for /tmp is the most useful one.
                Err(error) if path == self.temporary => failed = Some(error),
                Err(error) => failed = failed.or(Some(error)),
            }
        }
        match failed {
            Some(error) => Err(error),
            None => make(&self.temporary, user).map(|()| self.temporary.clone()),
        }
    }
}

/// True if there is a folder that `user` owns; a link does not count.
fn is_of(path: &Path, user: u32) -> bool {
    symlink_metadata(path).is_ok_and(|found| found.is_dir() && found.uid() == user)
}

/// True if there is a folder that only `user` can access.
fn is_private(path: &Path, user: u32) -> bool {
    let has_mode = |found: std::fs::Metadata| found.mode() & 0o777 == 0o700;
    is_of(path, user) && symlink_metadata(path).is_ok_and(has_mode)
}

fn is_short(path: &Path) -> bool {
    path.as_os_str().len() <= MAX_BYTES && path.to_str().is_some()
}

fn make(path: &Path, user: u32) -> Result<(), TransportError> {
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
    // A link is not followed: it could lead into a folder of another user.
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

/// Locks `path`, so that systemd does not clean it; `None` if a process of the user has done so.
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
        make(&path, current_user()).unwrap();
        assert_eq!(mode(&path), 0o700);
        std::fs::set_permissions(&path, Permissions::from_mode(0o777)).unwrap();
        make(&path, current_user()).unwrap();
        assert_eq!(mode(&path), 0o700);
    }

    #[test]
    fn names_the_owner_of_a_foreign_folder() {
        let folder = tempfile::tempdir().unwrap();
        let me = current_user();
        let text = make(folder.path(), me + 1).unwrap_err().to_string();
        let (path, other) = (folder.path().display(), me + 1);
        let whose = format!("{path} belongs to user {me}, but this process runs as user {other}: ");
        assert!(text.starts_with(&whose), "{text}");
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
            let error = make(&path, current_user()).unwrap_err();
            assert!(matches!(error, TransportError::NotAFolder { path: p, .. } if p == path));
        }
    }

    /// Returns candidates in test folders: a shared one and a private one.
    fn places(folder: &Path, own: &Path) -> Places {
        let own = [own.to_owned()].into_iter();
        Places::among(current_user(), own, folder)
    }

    fn private(path: &Path) {
        DirBuilder::new().mode(0o700).create(path).unwrap();
    }

    #[test]
    fn the_folder_of_the_user_comes_first_unless_there_is_one_already() {
        let world = tempfile::tempdir_in("/tmp").unwrap();
        let own = world.path().join("o");
        private(&own);
        let (folder, own) = (world.path(), &*own);
        let first = Places {
            own: vec![own.join(NAME)],
            ..places(folder, own)
        };
        assert_eq!(first.prepare().unwrap(), own.join(NAME));
        assert_eq!(first.prepare().unwrap(), own.join(NAME));
        std::fs::remove_dir(own.join(NAME)).unwrap();
        // Another process without the variable has created this one before.
        make(&first.temporary, current_user()).unwrap();
        assert_eq!(first.prepare().unwrap(), first.temporary);
    }

    #[test]
    fn a_runtime_folder_that_others_can_use_or_that_is_too_long_is_passed_over() {
        let world = tempfile::tempdir_in("/tmp").unwrap();
        let short = tempfile::Builder::new()
            .rand_bytes(4)
            .prefix("b")
            .tempdir_in("/tmp")
            .unwrap();
        std::fs::set_permissions(short.path(), Permissions::from_mode(0o700)).unwrap();
        assert_eq!(
            places(world.path(), short.path()).own,
            [short.path().join(NAME)]
        );
        std::fs::set_permissions(short.path(), Permissions::from_mode(0o755)).unwrap();
        let long = world.path().join("a-name-that-is-long");
        private(&long);
        let [relative, missing] = ["relative", "/nowhere"].map(Path::new);
        for path in [short.path(), &long, relative, missing] {
            let own = places(world.path(), path).own;
            assert!(own.is_empty(), "{}", path.display());
        }
    }

    #[test]
    fn a_name_that_is_taken_keeps_nobody_from_another_place() {
        let world = tempfile::tempdir_in("/tmp").unwrap();
        let own = world.path().join("o");
        private(&own);
        let places = Places {
            own: vec![own.join(NAME)],
            ..places(world.path(), &own)
        };
        std::os::unix::fs::symlink(world.path(), &places.temporary).unwrap();
        assert_eq!(places.prepare().unwrap(), own.join(NAME));
        assert!(symlink_metadata(&places.temporary).unwrap().is_symlink());
    }
}
