//! Errors of cached indexes.

use std::io;
use std::path::{Path, PathBuf};

use trusted_files::TrustError;

/// Error of reading or saving an index. The map is then prepared without the cache.
#[derive(Debug, thiserror::Error)]
pub enum CacheError {
    #[error("neither XDG_CACHE_HOME nor HOME names a folder; --index-cache can")]
    NoHome,
    #[error("folder {path} cannot keep indexes: {why}")]
    Folder { path: PathBuf, why: String },
    #[error(transparent)]
    File(TrustError),
    #[error("the index is not read, and the map is prepared again")]
    Untrusted(#[from] TrustError),
    #[error("{path} cannot be used, and the map is prepared again")]
    Unusable { path: PathBuf, source: io::Error },
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
