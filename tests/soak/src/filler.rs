//! Fills a file system for a limited time.

use std::fs::{File, remove_file};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use nix::sys::statvfs::statvfs;

/// Largest free space that may be filled, in bytes: a larger file system is shared with others.
const MAX_FREE: u64 = 1 << 30;

#[derive(Debug)]
pub(super) struct Filler(PathBuf);

pub(super) fn check(folder: &Path) -> anyhow::Result<()> {
    let found = statvfs(folder).with_context(|| failed("look at", folder))?;
    let free = found
        .blocks_available()
        .saturating_mul(found.fragment_size());
    if free <= MAX_FREE {
        return Ok(());
    }
    bail!(
        "{} has {} MiB free, which others may need: at most {} MiB are filled",
        folder.display(),
        free >> 20,
        MAX_FREE >> 20
    );
}

impl Filler {
    pub(super) fn fill(folder: &Path) -> anyhow::Result<Self> {
        let path = folder.join(format!("backcast-soak-{}", std::process::id()));
        let mut file = File::create(&path).with_context(|| failed("create", &path))?;
        let filler = Filler(path);
        // Smaller blocks fill the rest that is too small for a larger one.
        for size in [1 << 20, 1 << 12, 1] {
            let block = vec![0; size];
            loop {
                match file.write_all(&block) {
                    Err(error) if error.kind() == ErrorKind::StorageFull => break,
                    outcome => outcome.with_context(|| failed("write", &filler.0))?,
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

fn failed(action: &str, file: &Path) -> String {
    format!("cannot {action} {}", file.display())
}
