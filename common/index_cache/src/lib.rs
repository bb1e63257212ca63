//! Prepared maps, kept in files between runs.
//!
//! Preparing a map for searches takes up to seconds; a node that starts again on a map that
//! was prepared before reads its index instead. What is read equals what would be made, to
//! the last bit: a file is named by a hash of all that its index is made of, and holds
//! checksums of all that is in it. A file that is damaged, cut short, foreign or old is an
//! error to be reported, after which the map is prepared as if there were none.
//!
//! Files are read and not mapped into memory: one that is cut while it is mapped would end
//! the process with SIGBUS, where reading is an error like any other.

mod cache;
mod config;
mod error;
mod file;
mod folder;
#[cfg(test)]
mod testing;

pub use cache::{IndexCache, Kept, Prepared, Unsaved};
pub use config::{CachePlace, IndexCacheConfig};
pub use error::{CacheError, FileError};
