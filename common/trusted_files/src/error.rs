//! Reasons not to trust a file or a folder.

use std::io;
use std::path::PathBuf;

/// Why a file or its place is not trusted.
#[derive(Debug, thiserror::Error)]
pub enum TrustError {
    /// The path leads to a link, a folder, a pipe or a device.
    #[error("{0} is not a regular file: links, folders, pipes and devices are not used")]
    NotAFile(PathBuf),
    /// It belongs to another user.
    #[error(
        "{path} belongs to user {owner}: allowed are files and folders of user {user}, which this \
         process acts as, and of root"
    )]
    Foreign {
        /// The file or folder.
        path: PathBuf,
        /// The user to whom it belongs.
        owner: u32,
        /// The user that this process acts as.
        user: u32,
    },
    /// Other users can change it.
    #[error(
        "{path} belongs to user {owner} and has mode {mode:03o}: others can change it; chmod go-w \
         prevents that"
    )]
    Writable {
        /// The file or folder.
        path: PathBuf,
        /// The user to whom it belongs.
        owner: u32,
        /// Its permissions.
        mode: u32,
    },
    /// The path names no file in a folder.
    #[error("{0:?} names no file: allowed is the path of a file in a folder")]
    NoName(PathBuf),
    /// A file is longer than any sound one.
    #[error("{path} has more than {most} bytes")]
    TooLong {
        /// The file.
        path: PathBuf,
        /// Most bytes.
        most: u64,
    },
    /// The system refuses something.
    #[error("cannot {action} {path}")]
    File {
        /// What was tried.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}
