//! Errors of cached indexes.

use std::io;
use std::path::{Path, PathBuf};

use engine::search::SectionError;
use trusted_files::TrustError;

/// Error of reading or saving an index. The map is then prepared without the cache.
#[derive(Debug, thiserror::Error)]
pub enum CacheError {
    /// The user's cache folder is unknown.
    #[error("neither XDG_CACHE_HOME nor HOME names a folder; --index-cache can")]
    NoHome,
    /// The path is not a folder.
    #[error("{0} is not a folder: indexes are kept in one; remove it, or set --index-cache")]
    NotAFolder(PathBuf),
    /// The folder belongs to another user.
    #[error(
        "folder {path} belongs to user {owner}, and this is user {user}: what lies there is not \
         trusted; set --index-cache"
    )]
    ForeignFolder {
        path: PathBuf,
        /// User id of the owner.
        owner: u32,
        /// User id of this process.
        user: u32,
    },
    /// Other users can access the folder.
    #[error(
        "folder {path} has mode {mode:03o}: others can use it, so what lies there is not trusted; \
         chmod 700 makes it private"
    )]
    SharedFolder {
        path: PathBuf,
        /// Permissions of the folder.
        mode: u32,
    },
    /// A file operation failed.
    #[error("cannot {action} {path}")]
    File {
        /// Verb of what was tried.
        action: &'static str,
        path: PathBuf,
        source: io::Error,
    },
    /// Another user could have written the file.
    #[error("the index is not read, and the map is prepared again")]
    Untrusted(#[from] TrustError),
    /// The file is invalid.
    #[error("{path} cannot be used, and the map is prepared again")]
    Unusable {
        /// Path of the file.
        path: PathBuf,
        source: FileError,
    },
    /// The index exceeds the size limit of the cache.
    #[error("the index takes {needed_mb} MB and --index-cache-limit allows {limit_mb}")]
    TooLarge {
        /// Size of the index in megabytes of 10⁶ bytes.
        needed_mb: u64,
        /// Size limit in megabytes of 10⁶ bytes.
        limit_mb: u64,
    },
}

/// Returns a function that converts an error of a file operation.
pub(crate) fn failed(
    action: &'static str,
    path: &Path,
) -> impl Fn(io::Error) -> CacheError + use<> {
    let path = path.to_owned();
    move |source| CacheError::File {
        action,
        path: path.clone(),
        source,
    }
}

/// Error in the content of a file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file does not have the magic number of this machine.
    #[error("not an index file")]
    Foreign,
    /// Another release wrote the file.
    #[error("it has version {found} and this is version {expected}")]
    Version {
        /// Format version found.
        found: u32,
        /// Format version expected.
        expected: u32,
    },
    /// The key in the file differs from its name.
    #[error("the index is of another map or other settings")]
    OtherKey,
    /// The checksum of the header is wrong.
    #[error("its header is damaged")]
    Header,
    /// The length differs from the one in the header.
    #[error("it has {found} bytes instead of {expected}")]
    Length {
        /// Length found in bytes.
        found: u64,
        /// Length expected in bytes.
        expected: u64,
    },
    /// The checksum of a section is wrong.
    #[error("section {0} is damaged")]
    Section(usize),
    /// The engine rejects the content.
    #[error(transparent)]
    Sections(#[from] SectionError),
    /// The file cannot be read.
    #[error("it cannot be read")]
    Read(#[from] io::Error),
}
