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

/// Passes each record of some bytes to `take`, by its opcode and body.
///
/// # Errors
/// The first error of `take`, or the error of the reader converted by `damage`.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the opcodes, the concatenated bodies, and the result.
    fn read(bytes: &[u8]) -> (Vec<u8>, Vec<u8>, Result<(), Damage>) {
        let (mut opcodes, mut bodies) = (Vec::new(), Vec::new());
        let take = |opcode, body: &[u8]| {
            opcodes.push(opcode);
            bodies.extend(body);
            Ok(())
        };
        let damage = |error: McapError| Damage::NotMcap {
            found: error.to_string(),
        };
        let reader = LinearReader::new_with_options(part_options());
        let result = each_record(reader, bytes, take, damage);
        (opcodes, bodies, result)
    }

    #[test]
    fn records_follow_each_other_until_the_bytes_end() {
        let bytes = b"\x05\x02\0\0\0\0\0\0\0hi\x81\0\0\0\0\0\0\0\0";
        assert_eq!(read(bytes), (vec![5, 0x81], b"hi".to_vec(), Ok(())));
        assert_eq!(read(b""), (Vec::new(), Vec::new(), Ok(())));
    }

    #[test]
    fn a_length_beyond_the_end_is_an_error() {
        for bytes in [
            &b"\x05"[..],
            b"\x05\x02\0\0",
            b"\x05\x02\0\0\0\0\0\0\0h",
            b"\x05\xff\xff\xff\xff\xff\xff\xff\xff",
        ] {
            let (opcodes, _, result) = read(bytes);
            assert!(opcodes.is_empty() && result.is_err(), "{bytes:x?}");
        }
    }
}
