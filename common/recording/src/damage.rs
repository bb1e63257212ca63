//! Damage in the bytes of a recording, and the size limit of its records.

/// Largest size of a record, and of a decompressed chunk, in bytes: twice the largest map. Writers
/// aim at chunks of about a megabyte, but a single message makes a chunk as large as itself.
///
/// It bounds the memory that a damaged length can cost: for a chunk with a checksum the library
/// allocates and zeroes the size that the chunk claims.
pub const MAX_CHUNK_BYTES: u64 = 2 * map::MAX_CELLS;

/// Damage of a file: its kind and position. Offsets are bytes from the start of the file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    #[error(
        "the file is cut short: it ends at byte {length}, within the record that starts at byte {at}"
    )]
    Truncated { length: u64, at: u64 },
    #[error("the {kind} record at byte {at} is damaged: {reason}")]
    Record {
        /// Start of the record, or of the chunk that it is in.
        at: u64,
        kind: &'static str,
        reason: String,
    },
    #[error("the chunk at byte {at} {reason}")]
    Chunk { at: u64, reason: String },
    #[error(
        "the data, bytes 0 to {end}, is damaged: its checksum is {found:08x}, written was {saved:08x}"
    )]
    DataChecksum { end: u64, saved: u32, found: u32 },
    /// Any other damage, with its position.
    #[error("{0}")]
    Other(String),
}

pub(crate) fn shown(bytes: &[u8]) -> String {
    match &bytes[..bytes.len().min(8)] {
        [] => "nothing, as it is empty".to_owned(),
        start => format!("\"{}\"", start.escape_ascii()),
    }
}
