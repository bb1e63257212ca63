//! Reasons not to trust a file or a folder.

use std::io;
use std::path::PathBuf;

/// Reason not to trust a file or its folder, or error of reading it.
#[derive(Debug, thiserror::Error)]
pub enum TrustError {
    /// The path is a link, a folder, a pipe or a device.
    #[error("{0} is not a regular file: links, folders, pipes and devices are not used")]
    NotAFile(PathBuf),
    /// The file or folder belongs to another user.
    #[error(
        "{path} belongs to user {owner}: allowed are files and folders of user {user}, which this \
         process acts as, and of root"
    )]
    Foreign {
        path: PathBuf,
        /// User id of the owner.
        owner: u32,
        /// User id of this process.
        user: u32,
    },
    /// Other users can change the file or folder.
    #[error(
        "{path} belongs to user {owner} and has mode {mode:03o}: others can change it; chmod go-w \
         prevents that"
    )]
    Writable {
        path: PathBuf,
        /// User id of the owner.
        owner: u32,
        /// Permissions of the file or folder.
        mode: u32,
    },
    /// The path is not that of a file in a folder.
    #[error("{0:?} names no file: allowed is the path of a file in a folder")]
    NoName(PathBuf),
    /// The file is longer than allowed.
    #[error("{path} has more than {most} bytes")]
    TooLong {
        path: PathBuf,
        /// Largest length in bytes.
        most: u64,
    },
    /// A file operation failed.
    #[error("cannot {action} {path}")]
    File {
        /// Verb of what was tried.
        action: &'static str,
        path: PathBuf,
        source: io::Error,
    },
}
