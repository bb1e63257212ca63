//! Files that only their owner can have changed.
//!
//! A file in a folder that others can write to, such as `/tmp`, can be anything: another user's
//! file, a link, a pipe that never ends. This crate opens files of this user or of root that no
//! other user can write, and rejects others with their name and owner. It writes nothing.

mod error;
mod file;
mod folder;

pub use error::TrustError;
pub use file::{failed, open, read};
pub use folder::check_place;

use std::fs::Metadata;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

fn current_user() -> u32 {
    nix::unistd::geteuid().as_raw()
}

/// Fails unless the owner is `user` or root.
fn check_owner(path: &Path, found: &Metadata, user: u32) -> Result<(), TrustError> {
    let owner = found.uid();
    if [0, user].contains(&owner) {
        return Ok(());
    }
    let path = path.to_owned();
    Err(TrustError::Foreign { path, owner, user })
}
