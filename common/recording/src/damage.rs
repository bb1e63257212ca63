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
    /// The file does not start with the magic of a recording.
    #[error("the file starts with {found}; a recording starts with \"\\x89MCAP0\\r\\n\"")]
    NotMcap {
        /// First bytes of the file, quoted.
        found: String,
    },
    /// The file ends before the recording does.
    #[error(
        "the file is cut short: it ends at byte {length}, within the record that starts at byte {at}"
    )]
    Truncated {
        /// Size of the file in bytes.
        length: u64,
        /// Start of the incomplete record.
        at: u64,
    },
    /// The content of a record is invalid for its type.
    #[error("the {kind} record at byte {at} is damaged: {reason}")]
    Record {
        /// Start of the record, or of the chunk that it is in.
        at: u64,
        kind: &'static str,
        reason: String,
    },
    /// The checksum of a chunk's messages is wrong.
    #[error(
        "the chunk at byte {at} is damaged: its checksum is {found:08x}, written was {saved:08x}"
    )]
    ChunkChecksum {
        at: u64,
        /// Checksum that was written.
        saved: u32,
        /// Checksum of the content.
        found: u32,
    },
    /// A chunk claims more bytes than the limit.
    #[error("the chunk at byte {at} claims {claimed} bytes; at most {MAX_CHUNK_BYTES} are allowed")]
    ChunkSize {
        at: u64,
        /// Claimed decompressed size, in bytes.
        claimed: u64,
    },
    /// A chunk has another size than it claims.
    #[error("the chunk at byte {at} claims {claimed} bytes but holds {found}")]
    ChunkContent {
        at: u64,
        /// Claimed decompressed size, in bytes.
        claimed: u64,
        /// Bytes of its content.
        found: u64,
    },
    /// A chunk cannot be decompressed.
    #[error("the chunk at byte {at} does not unpack: {reason}")]
    Unpack {
        at: u64,
        /// Message of the decompressor.
        reason: String,
    },
    /// A chunk has an unknown compression.
    #[error("the chunk at byte {at} is packed as {found:?}; allowed: zstd, lz4, or not at all")]
    Compression {
        at: u64,
        /// Name of the compression.
        found: String,
    },
    /// A channel or schema is defined twice with different content.
    #[error("the {kind} record at byte {at} defines number {id} again, differently")]
    Conflict {
        /// Start of the second record, or of the chunk that it is in.
        at: u64,
        kind: &'static str,
        id: u16,
    },
    /// A message or channel refers to a definition that does not come before it.
    #[error(
        "the {kind} record at byte {at} refers to {missing} {id}, which is not defined before it"
    )]
    Undefined {
        /// Start of the record, or of the chunk that it is in.
        at: u64,
        kind: &'static str,
        /// Type of the missing definition.
        missing: &'static str,
        /// Id of the missing definition.
        id: u16,
    },
    /// The checksum of the data section is wrong.
    #[error(
        "the data, bytes 0 to {end}, is damaged: its checksum is {found:08x}, written was {saved:08x}"
    )]
    DataChecksum {
        /// End of the data section.
        end: u64,
        /// Checksum that was written.
        saved: u32,
        /// Checksum of the content.
        found: u32,
    },
    /// The checksum of the summary is wrong.
    #[error(
        "the summary at byte {at} is damaged: its checksum is {found:08x}, written was {saved:08x}"
    )]
    SummaryChecksum {
        /// Start of the summary.
        at: u64,
        /// Checksum that was written.
        saved: u32,
        /// Checksum of the content.
        found: u32,
    },
    /// The message count of the summary is wrong.
    #[error("the summary counts {claimed} messages, {found} are there")]
    MessageCount {
        /// Message count of the summary.
        claimed: u64,
        /// Messages in the data.
        found: u64,
    },
    /// An SQLite bag without the log that holds its last messages.
    #[error(
        "metadata.yaml counts {claimed} messages, {found} are there: the others are in {log}, which \
         is missing; copy it along"
    )]
    MissingLog {
        log: String,
        /// Message count of the bag's description.
        claimed: u64,
        /// Messages found.
        found: u64,
    },
    /// The file does not end with the magic of a recording.
    #[error("the recording's last 8 bytes should begin at byte {at}, but found is {found}")]
    End {
        /// Expected position of the magic.
        at: u64,
        /// Bytes that were found instead.
        found: String,
    },
}

/// Shows the first bytes for an error.
pub(crate) fn shown(bytes: &[u8]) -> String {
    match &bytes[..bytes.len().min(8)] {
        [] => "nothing, as it is empty".to_owned(),
        start => format!("\"{}\"", start.escape_ascii()),
    }
}
