//! Cache of prepared maps in files.
//!
//! Preparing a map for searches takes up to seconds; a node that restarts on a map that was
//! prepared before reads its index instead. The index read is bit-identical to the one that would
//! be computed: the file name is a hash of all inputs of the index, and checksums protect the
//! content. A damaged, truncated, foreign or old file is reported as an error, and then the map is
//! prepared as if there were no file.
//!
//! Files are read, not mapped: truncation of a mapped file would end the process with SIGBUS, while
//! reading returns an error.

mod cache;
mod config;
mod error;
mod file;
mod folder;
#[cfg(test)]
mod testing;

pub use cache::{IndexCache, Kept, Prepared, Unsaved, prepared_map};
pub use config::{CachePlace, IndexCacheConfig};
pub use error::CacheError;
