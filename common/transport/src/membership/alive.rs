//! Locks that show which processes are alive: unlike process ids and iceoryx2's folder, a lock on a
//! file in shared memory is seen by all containers that share it.

use std::fs::{File, Metadata, OpenOptions, read_to_string, remove_file};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use nix::errno::Errno;
use nix::fcntl::{Flock, FlockArg};
use nix::libc::O_NOFOLLOW;

use crate::membership::{Membership, SHARED_MEMORY};
use crate::{GraphName, TransportError};

/// Suffix of the file that every member locks.
pub(crate) const MEMBERS: &str = "alive";
/// Suffix of the file that a launcher locks.
pub(crate) const LAUNCHER: &str = "launcher";

/// Longest time for which a mere check may hold a claim's lock.
const LOOK: Duration = Duration::from_millis(200);

#[derive(Debug)]
pub(crate) struct Lock {
    _file: Flock<File>,
}

/// A launcher's exclusive right to a graph's name in this machine's shared memory.
#[derive(Debug)]
pub struct Claim {
    path: PathBuf,
    _lock: Lock,
}

impl Claim {
    /// Claims the name of `graph`; [`TransportError::StillRunning`] if another launcher has it.
    pub fn take(graph: &GraphName) -> Result<Self, TransportError> {
        let path = path(&Membership::of(graph), LAUNCHER);
        let begin = Instant::now();
        loop {
            if let Some(lock) = lock(&path, FlockArg::LockExclusiveNonblock)? {
                return Ok(Claim { path, _lock: lock });
            }
            if begin.elapsed() >= LOOK {
                return Err(TransportError::StillRunning {
                    graph: graph.clone(),
                    processes: vec![format!("its launcher holds {}", path.display())],
                });
            }
            std::thread::sleep(LOOK / 20);
        }
    }

    pub(crate) fn is_taken(graph: &GraphName) -> bool {
        let path = path(&Membership::of(graph), LAUNCHER);
        let mut options = OpenOptions::new();
        let file = options.read(true).custom_flags(O_NOFOLLOW).open(path);
        // Shared, so that concurrent checks do not take each other for a launcher.
        let look = |file| Flock::lock(file, FlockArg::LockSharedNonblock);
        matches!(file.map(look), Ok(Err((_, Errno::EWOULDBLOCK))))
    }
}

/// The files of the machine that are locked like a [`Claim`], by processes of any user.
pub(crate) struct LockedFiles(String);

impl LockedFiles {
    /// Reads locks: number, kind, mode, access, process, `major:minor:inode` and range per line.
    pub(crate) fn now() -> Self {
        LockedFiles(read_to_string("/proc/locks").unwrap_or_default())
    }

    pub(crate) fn hold(&self, file: &Metadata) -> bool {
        let ending = format!(":{}", file.ino());
        self.0.lines().any(|line| {
            let mut words = line.split_whitespace();
            words.nth(1) == Some("FLOCK") && words.nth(3).is_some_and(|at| at.ends_with(&ending))
        })
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // A process that waits for the lock finds another file at the path and tries again.
        let _ = remove_file(&self.path);
    }
}

pub(crate) fn as_member(membership: &Membership) -> Result<Lock, TransportError> {
    let path = path(membership, MEMBERS);
    let lock = lock(&path, FlockArg::LockShared)?;
    // Waiting for a shared lock ends only when it is taken.
    lock.ok_or(TransportError::File {
        action: "lock",
        path,
        source: Errno::EWOULDBLOCK.into(),
    })
}

/// Takes the exclusive lock; `None` while any member is alive.
pub(crate) fn as_only_one(membership: &Membership) -> Result<Option<Lock>, TransportError> {
    lock(&path(membership, MEMBERS), FlockArg::LockExclusiveNonblock)
}

pub(crate) fn path(membership: &Membership, whose: &str) -> PathBuf {
    Path::new(SHARED_MEMORY).join(format!("{}{whose}", membership.prefix))
}

fn lock(path: &Path, how: FlockArg) -> Result<Option<Lock>, TransportError> {
    let failed = |action: &'static str, source| TransportError::File {
        action,
        path: path.to_owned(),
        source,
    };
    loop {
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .mode(0o600)
            .custom_flags(O_NOFOLLOW)
            .open(path)
            .map_err(|source| failed("open", source))?;
        match Flock::lock(file, how) {
            Ok(file) if is_at(&file, path) => return Ok(Some(Lock { _file: file })),
            // The file was removed while we waited.
            Ok(_) | Err((_, Errno::EINTR)) => {}
            Err((_, Errno::EWOULDBLOCK)) => return Ok(None),
            Err((_, errno)) => return Err(failed("lock", errno.into())),
        }
    }
}

fn is_at(file: &File, path: &Path) -> bool {
    let same = |found: std::fs::Metadata| {
        let ours = file.metadata().ok()?;
        Some((ours.dev(), ours.ino()) == (found.dev(), found.ino()))
    };
    path.symlink_metadata().ok().and_then(same).unwrap_or(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(tag: &str) -> GraphName {
        GraphName::new(&format!("u{}-{tag}", std::process::id())).unwrap()
    }

    #[test]
    fn a_name_is_claimed_once_and_free_again_afterwards() {
        let name = name("claim");
        let claim = Claim::take(&name).unwrap();
        let path = claim.path.clone();
        let error = Claim::take(&name).unwrap_err();
        assert!(
            matches!(error, TransportError::StillRunning { .. }),
            "{error}"
        );
        drop(claim);
        assert!(!path.exists());
        drop(Claim::take(&name).unwrap());
    }

    #[test]
    fn to_look_whether_a_name_is_claimed_takes_it_from_nobody() {
        let name = name("look");
        assert!(!Claim::is_taken(&name));
        let claim = Claim::take(&name).unwrap();
        assert!(Claim::is_taken(&name));
        drop(claim);
        assert!(!Claim::is_taken(&name));
        // Other processes check all the time.
        let file = path(&Membership::of(&name), LAUNCHER);
        let looking = lock(&file, FlockArg::LockShared).unwrap();
        assert!(!Claim::is_taken(&name), "who looks is no launcher");
        std::thread::scope(|scope| {
            let taken = scope.spawn(|| Claim::take(&name));
            drop(looking);
            assert!(taken.join().unwrap().is_ok());
        });
    }

    #[test]
    fn a_lock_is_seen_while_it_is_held() {
        let file = tempfile::tempfile().unwrap();
        let found = file.metadata().unwrap();
        assert!(!LockedFiles::now().hold(&found));
        let lock = Flock::lock(file, FlockArg::LockExclusive).unwrap();
        assert!(LockedFiles::now().hold(&found));
        drop(lock);
    }

    #[test]
    fn nobody_is_the_only_one_beside_a_member() {
        let membership = Membership::of(&name("members"));
        let one = as_member(&membership).unwrap();
        let other = as_member(&membership).unwrap();
        assert!(as_only_one(&membership).unwrap().is_none());
        drop(one);
        assert!(as_only_one(&membership).unwrap().is_none());
        drop(other);
        let only = as_only_one(&membership).unwrap();
        assert!(only.is_some());
        remove_file(path(&membership, MEMBERS)).unwrap();
        // The locked file is no longer the one at its path.
        assert!(as_only_one(&membership).unwrap().is_some());
        remove_file(path(&membership, MEMBERS)).unwrap();
    }
}
