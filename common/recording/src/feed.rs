//! Feeds bytes to the library's reader and takes records out of it.
//!
//! The library parses the container but does no input: it requests bytes. Here they come from
//! memory, at most as many as there are: a record that claims hundreds of megabytes only gets the
//! bytes that are left.

use mcap::McapError;
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

use crate::{Damage, MAX_CHUNK_BYTES};

/// Reader options for files: records longer than the limit are rejected.
pub(crate) fn options() -> LinearReaderOptions {
    LinearReaderOptions::default().with_record_length_limit(MAX_CHUNK_BYTES as usize)
}

/// Reader options for records alone, without the magic of a file around them.
pub(crate) fn part_options() -> LinearReaderOptions {
    options()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
}

/// Gives the reader the bytes that it requests, or those that are left; it is not told that the
/// input has ended.
pub(crate) fn feed(reader: &mut LinearReader, wanted: usize, rest: &mut &[u8]) {
    let (given, left) = rest.split_at(wanted.min(rest.len()));
    reader.insert(given.len()).copy_from_slice(given);
    reader.notify_read(given.len());
    *rest = left;
}

pub(crate) fn each_record(
    mut reader: LinearReader,
    mut bytes: &[u8],
    mut take: impl FnMut(u8, &[u8]) -> Result<(), Damage>,
    damage: impl FnOnce(McapError) -> Damage,
) -> Result<(), Damage> {
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => feed(&mut reader, wanted, &mut bytes),
            Ok(LinearReadEvent::Record { opcode, data }) => take(opcode, data)?,
            Err(error) => return Err(damage(error)),
        }
    }
    Ok(())
}
