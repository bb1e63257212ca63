//! Reasons not to trust a file or a folder.

use std::io;
use std::path::PathBuf;

/// Reason not to trust a file or its folder, or error of reading it.
#[derive(Debug, thiserror::Error)]
pub enum TrustError {
    #[error("{0} is not a regular file: links, folders, pipes and devices are not used")]
    NotAFile(PathBuf),
    #[error(
        "{path} belongs to user {owner}: allowed are files and folders of user {user}, which this \
         process acts as, and of root"
    )]
    Foreign {
        path: PathBuf,
        owner: u32,
        user: u32,
    },
    #[error(
        "{path} belongs to user {owner} and has mode {mode:03o}: others can change it; chmod go-w \
         prevents that"
    )]
    Writable {
        path: PathBuf,
        owner: u32,
        mode: u32,
    },
    #[error("{0:?} names no file: allowed is the path of a file in a folder")]
    NoName(PathBuf),
    #[error("{path} has more than {most} bytes")]
    TooLong { path: PathBuf, most: u64 },
    #[error("cannot {action} {path}")]
    File {
        action: &'static str,
        path: PathBuf,
        source: io::Error,
    },
}
