//! Damage in the bytes of a recording, and the most that one of its records may hold.

/// Most bytes of a record, and most that a chunk may unpack to: twice the
/// largest map. Writers aim at chunks of about a megabyte, but a single message
/// makes one as large as itself.
///
/// It bounds the memory that a damaged length can cost: for a chunk with a
/// checksum the library takes, and fills with zeros, what the chunk claims.
pub const MAX_CHUNK_BYTES: u64 = 2 * map::MAX_CELLS;

/// Where a file stops being a sound recording, and why. Offsets are bytes from
/// its start.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// The file does not start as a recording does.
    #[error("the file starts with {found}; a recording starts with \"\\x89MCAP0\\r\\n\"")]
    NotMcap {
        /// Its first bytes.
        found: String,
    },
    /// The file ends before the recording does.
    #[error(
        "the file is cut short: it ends at byte {length}, within the record that starts at byte {at}"
    )]
    Truncated {
        /// Bytes of the file.
        length: u64,
        /// Start of the record that is not complete.
        at: u64,
    },
    /// A record's content is not what its type demands.
    #[error("the {kind} record at byte {at} is damaged: {reason}")]
    Record {
        /// Start of the record, or of the chunk that it is in.
        at: u64,
        /// Its type.
        kind: &'static str,
        /// What is wrong.
        reason: String,
    },
    /// A chunk's messages are not those that were written.
    #[error(
        "the chunk at byte {at} is damaged: its checksum is {found:08x}, written was {saved:08x}"
    )]
    ChunkChecksum {
        /// Start of the chunk.
        at: u64,
        /// The checksum that was written.
        saved: u32,
        /// The checksum of what is there.
        found: u32,
    },
    /// A chunk claims more than any sound one holds.
    #[error("the chunk at byte {at} claims {claimed} bytes; at most {MAX_CHUNK_BYTES} are allowed")]
    ChunkSize {
        /// Start of the chunk.
        at: u64,
        /// Bytes that it claims to unpack to.
        claimed: u64,
    },
    /// A chunk unpacks to another size than it claims.
    #[error("the chunk at byte {at} claims {claimed} bytes but holds {found}")]
    ChunkContent {
        /// Start of the chunk.
        at: u64,
        /// Bytes that it claims to unpack to.
        claimed: u64,
        /// Bytes that it unpacks to, or one more than claimed if there are more.
        found: u64,
    },
    /// A chunk cannot be unpacked.
    #[error("the chunk at byte {at} does not unpack: {reason}")]
    Unpack {
        /// Start of the chunk.
        at: u64,
        /// What the decompressor says.
        reason: String,
    },
    /// A chunk is packed in an unknown way.
    #[error("the chunk at byte {at} is packed as {found:?}; allowed: zstd, lz4, or not at all")]
    Compression {
        /// Start of the chunk.
        at: u64,
        /// The name of the packing.
        found: String,
    },
    /// A channel or schema is defined twice, differently.
    #[error("the {kind} record at byte {at} defines number {id} again, differently")]
    Conflict {
        /// Start of the second record, or of the chunk that it is in.
        at: u64,
        /// Its type.
        kind: &'static str,
        /// The number.
        id: u16,
    },
    /// A message or channel refers to something that was not defined before it.
    #[error(
        "the {kind} record at byte {at} refers to {missing} {id}, which is not defined before it"
    )]
    Undefined {
        /// Start of the record, or of the chunk that it is in.
        at: u64,
        /// Its type.
        kind: &'static str,
        /// The type of what it refers to.
        missing: &'static str,
        /// The number of what it refers to.
        id: u16,
    },
    /// The data section is not what was written.
    #[error(
        "the data, bytes 0 to {end}, is damaged: its checksum is {found:08x}, written was {saved:08x}"
    )]
    DataChecksum {
        /// Where the data ends.
        end: u64,
        /// The checksum that was written.
        saved: u32,
        /// The checksum of what is there.
        found: u32,
    },
    /// The summary is not what was written.
    #[error(
        "the summary at byte {at} is damaged: its checksum is {found:08x}, written was {saved:08x}"
    )]
    SummaryChecksum {
        /// Start of the summary.
        at: u64,
        /// The checksum that was written.
        saved: u32,
        /// The checksum of what is there.
        found: u32,
    },
    /// The summary counts other messages than there are.
    #[error("the summary counts {claimed} messages, {found} are there")]
    MessageCount {
        /// Messages by the summary.
        claimed: u64,
        /// Messages in the data.
        found: u64,
    },
    /// A bag in SQLite without the log that holds its last messages.
    #[error(
        "metadata.yaml counts {claimed} messages, {found} are there: the others are in {log}, which \
         is missing; copy it along"
    )]
    MissingLog {
        /// The file that is missing.
        log: String,
        /// Messages by the bag's description.
        claimed: u64,
        /// Messages that are there.
        found: u64,
    },
    /// The file does not end as a recording does.
    #[error("the recording's last 8 bytes should begin at byte {at}, but found is {found}")]
    End {
        /// Where the end belongs.
        at: u64,
        /// What is there.
        found: String,
    },
}

/// The first bytes of what should be something else, for an error.
pub(crate) fn shown(bytes: &[u8]) -> String {
    match &bytes[..bytes.len().min(8)] {
        [] => "nothing, as it is empty".to_owned(),
        start => format!("\"{}\"", start.escape_ascii()),
    }
}
