//! Fills a file system for a limited time.

use std::fs::{File, remove_file};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use launcher::LauncherError;
use nix::sys::statvfs::statvfs;

use crate::SoakError;

/// Largest free space that may be filled, in bytes: a larger file system is shared with others, who
/// would be harmed, and memory may end before a large /dev/shm does.
const MAX_FREE: u64 = 1 << 30;

/// A file that fills its file system; removed on drop.
#[derive(Debug)]
pub(super) struct Filler(PathBuf);

/// Rejects a file system with too much free space.
///
/// # Errors
/// It has too much, or its state cannot be read.
pub(super) fn check(folder: &Path) -> Result<(), SoakError> {
    let found = statvfs(folder).map_err(|errno| failed("look at", folder, errno.into()))?;
    let free = found
        .blocks_available()
        .saturating_mul(found.fragment_size());
    if free <= MAX_FREE {
        return Ok(());
    }
    let folder = folder.display();
    let (free, allowed) = (free >> 20, MAX_FREE >> 20);
    Err(LauncherError::Usage(format!(
        "{folder} has {free} MiB free and is not filled: allowed are {allowed} MiB, since others may \
         need the room; give it its own: unshare --mount sh -c \
         'mount -t tmpfs -o size=256m tmpfs {folder} && backcast soak …'"
    ))
    .into())
}

impl Filler {
    /// Fills the file system of `folder`.
    ///
    /// # Errors
    /// A file cannot be created, or writing fails for a reason other than lack of space.
    pub(super) fn fill(folder: &Path) -> Result<Self, SoakError> {
        let path = folder.join(format!("backcast-soak-{}", std::process::id()));
        let mut file = File::create(&path).map_err(|source| failed("create", &path, source))?;
        let filler = Filler(path);
        // Smaller blocks fill the rest that is too small for a larger one.
        for size in [1 << 20, 1 << 12, 1] {
            let block = vec![0; size];
            loop {
                match file.write_all(&block) {
                    Ok(()) => {}
                    Err(error) if error.kind() == ErrorKind::StorageFull => break,
                    Err(source) => return Err(failed("write", &filler.0, source)),
                }
            }
        }
        Ok(filler)
    }
}

impl Drop for Filler {
    fn drop(&mut self) {
        // If another process removed the file, the space is free already.
        let _ = remove_file(&self.0);
    }
}

fn failed(action: &'static str, file: &Path, source: std::io::Error) -> SoakError {
    LauncherError::File {
        action,
        file: file.to_owned(),
        source,
    }
    .into()
}
