//! Errors of cached indexes.

use std::io;
use std::path::{Path, PathBuf};

use engine::search::SectionError;
use trusted_files::TrustError;

/// Error of reading or saving an index. The map is then prepared without the cache.
#[derive(Debug, thiserror::Error)]
pub enum CacheError {
    #[error("neither XDG_CACHE_HOME nor HOME names a folder; --index-cache can")]
    NoHome,
    #[error("{0} is not a folder: indexes are kept in one; remove it, or set --index-cache")]
    NotAFolder(PathBuf),
    #[error(
        "folder {path} belongs to user {owner}, and this is user {user}: what lies there is not \
         trusted; set --index-cache"
    )]
    ForeignFolder {
        path: PathBuf,
        owner: u32,
        user: u32,
    },
    #[error(
        "folder {path} has mode {mode:03o}: others can use it, so what lies there is not trusted; \
         chmod 700 makes it private"
    )]
    SharedFolder { path: PathBuf, mode: u32 },
    #[error(transparent)]
    File(TrustError),
    #[error("the index is not read, and the map is prepared again")]
    Untrusted(#[from] TrustError),
    #[error("{path} cannot be used, and the map is prepared again")]
    Unusable { path: PathBuf, source: FileError },
    #[error("the index takes {needed_mb} MB and --index-cache-limit allows {limit_mb}")]
    TooLarge {
        /// Size of the index in megabytes of 10⁶ bytes.
        needed_mb: u64,
        limit_mb: u64,
    },
}

/// Returns a function that converts an error of a file operation.
pub(crate) fn failed(action: &'static str, path: &Path) -> impl Fn(io::Error) -> CacheError {
    let failed = trusted_files::failed(action, path);
    move |source| CacheError::File(failed(source))
}

/// Error in the content of a file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file does not have the magic number of this machine.
    #[error("not an index file")]
    Foreign,
    #[error("it has version {found} and this is version {expected}")]
    Version { found: u32, expected: u32 },
    #[error("the index is of another map or other settings")]
    OtherKey,
    #[error("its header is damaged")]
    Header,
    #[error("it has {found} bytes instead of {expected}")]
    Length { found: u64, expected: u64 },
    #[error("section {0} is damaged")]
    Section(usize),
    #[error(transparent)]
    Sections(#[from] SectionError),
    #[error("it cannot be read")]
    Read(#[from] io::Error),
}
