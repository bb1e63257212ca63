//! Errors of cached indexes.

use std::io;
use std::path::{Path, PathBuf};

use engine::search::SectionError;
use trusted_files::TrustError;

/// Why an index could not be read or kept. The map is prepared without.
#[derive(Debug, thiserror::Error)]
pub enum CacheError {
    /// Nothing says where the user's cache folder is.
    #[error("neither XDG_CACHE_HOME nor HOME names a folder; --index-cache can")]
    NoHome,
    /// The path leads to something else.
    #[error("{0} is not a folder: indexes are kept in one; remove it, or set --index-cache")]
    NotAFolder(PathBuf),
    /// The folder is somebody else's.
    #[error(
        "folder {path} belongs to user {owner}, and this is user {user}: what lies there is not \
         trusted; set --index-cache"
    )]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
        /// Whose it is.
        owner: u32,
        /// Who this process acts as.
        user: u32,
    },
    /// Others may enter the folder.
    #[error(
        "folder {path} has mode {mode:03o}: others can use it, so what lies there is not trusted; \
         chmod 700 makes it private"
    )]
    SharedFolder {
        /// The folder.
        path: PathBuf,
        /// Its permissions.
        mode: u32,
    },
    /// The system refuses something.
    #[error("cannot {action} {path}")]
    File {
        /// What was tried.
        action: &'static str,
        /// With which file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Another user could have written a file.
    #[error("the index is not read, and the map is prepared again")]
    Untrusted(#[from] TrustError),
    /// A file is not what it should be.
    #[error("{path} cannot be used, and the map is prepared again")]
    Unusable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: FileError,
    },
    /// An index takes more than all are allowed to.
    #[error("the index takes {needed_mb} MB and --index-cache-limit allows {limit_mb}")]
    TooLarge {
        /// Megabytes of 10⁶ bytes.
        needed_mb: u64,
        /// The same.
        limit_mb: u64,
    },
}

/// The error of what the system refuses to do with a file or folder.
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

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// It does not begin as these files do on this machine.
    #[error("not an index file")]
    Foreign,
    /// Another release wrote it.
    #[error("it has version {found} and this is version {expected}")]
    Version {
        /// That of the file.
        found: u32,
        /// That of this release.
        expected: u32,
    },
    /// Another name belongs to what it holds.
    #[error("the index is of another map or other settings")]
    OtherKey,
    /// The checksum of its header is wrong.
    #[error("its header is damaged")]
    Header,
    /// Its length is not what its header says.
    #[error("it has {found} bytes instead of {expected}")]
    Length {
        /// Its bytes.
        found: u64,
        /// Those of all that it should hold.
        expected: u64,
    },
    /// The checksum of a section is wrong.
    #[error("section {0} is damaged")]
    Section(usize),
    /// The engine refuses what it holds.
    #[error(transparent)]
    Sections(#[from] SectionError),
    /// It cannot be read.
    #[error("it cannot be read")]
    Read(#[from] io::Error),
}
