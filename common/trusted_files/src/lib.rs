//! Files that only their owner could have changed.
//!
//! A file in a folder that others may write to, as `/tmp`, may be anything: another user's, a
//! link, a pipe that never ends. This crate opens what belongs to this user or to root and to
//! which nobody else can write, and refuses the rest by name and owner. It writes nothing.

mod error;
mod file;
mod folder;

pub use error::TrustError;
pub use file::{open, read};
pub use folder::check_place;

use std::fs::Metadata;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

/// The user that this process acts as.
fn current_user() -> u32 {
    nix::unistd::geteuid().as_raw()
}

/// Refuses what belongs neither to `user` nor to root.
fn check_owner(path: &Path, found: &Metadata, user: u32) -> Result<(), TrustError> {
    let owner = found.uid();
    if [0, user].contains(&owner) {
        return Ok(());
    }
    let path = path.to_owned();
    Err(TrustError::Foreign { path, owner, user })
}
