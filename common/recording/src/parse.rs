//! Parses the fields of a record with the library, after a check of the lengths in it.

use std::borrow::Cow;

use mcap::McapError;
use mcap::records::{Record, op};

use crate::Damage;

/// Parses the fields of the record at byte `at`, or in the chunk there.
///
/// Records whose fields are not needed are returned as unknown. The library alone would panic on an
/// attachment that is shorter than its fields.
pub(crate) fn parse(opcode: u8, body: &[u8], at: u64) -> Result<Record<'_>, Damage> {
    let damaged = |reason| Damage::Record {
        at,
        kind: name(opcode),
        reason,
    };
    match opcode {
        op::SCHEMA | op::CHANNEL | op::CHUNK | op::ATTACHMENT | op::METADATA
            if lengths_fit(opcode, body).is_none() =>
        {
            let reason = "it ends within a field, or a field claims more bytes than are left";
            Err(damaged(reason.to_owned()))
        }
        op::SCHEMA
        | op::CHANNEL
        | op::CHUNK
        | op::MESSAGE
        | op::STATISTICS
        | op::ATTACHMENT
        | op::METADATA => mcap::parse_record(opcode, body).map_err(|error| damaged(reason(&error))),
        _ => Ok(Record::Unknown {
            opcode,
            data: Cow::Borrowed(body),
        }),
    }
}

/// `None` if a field with a length prefix exceeds the record.
///
/// The library allocates the claimed length of a text, up to four gigabytes, before it checks that
/// so many bytes are there; if memory is short, the process aborts. These are the fields with a
/// length prefix:
///
/// | record | bytes before | fields with a length prefix |
/// |---|---|---|
/// | schema | 2 | name, encoding, data |
/// | channel | 4 | topic, encoding, metadata (within it: keys and values) |
/// | chunk | 28 | compression |
/// | attachment | 16 | name, media type; then data, with a length of eight bytes, and four bytes more |
/// | metadata | 0 | name, entries (within it: keys and values) |
fn lengths_fit(opcode: u8, body: &[u8]) -> Option<()> {
    let (before, fields) = match opcode {
        op::SCHEMA => (2, 3),
        op::CHANNEL => (4, 3),
        op::ATTACHMENT => (16, 2),
        op::METADATA => (0, 2),
        _ => (28, 1),
    };
    let mut last = &[][..];
    let mut rest = body.get(before..)?;
    for _ in 0..fields {
        (last, rest) = split_field(rest)?;
    }
    while matches!(opcode, op::CHANNEL | op::METADATA) && !last.is_empty() {
        (_, last) = split_field(last)?;
    }
    if opcode == op::ATTACHMENT {
        let (length, data) = rest.split_first_chunk()?;
        let checksum = data.len().checked_sub(size_of::<u32>())?;
        (u64::from_le_bytes(*length) <= checksum as u64).then_some(())?;
    }
    Some(())
}

fn split_field(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    rest.split_at_checked(u32::from_le_bytes(*length) as usize)
}

/// Error message of the library, on one line.
pub(crate) fn reason(error: &McapError) -> String {
    match error {
        // The messages of these omit the cause or wrap it in other text.
        McapError::Parse(error) => error.root_cause().to_string(),
        McapError::Io(error) => error.to_string(),
        McapError::DecompressionError(reason) => reason.clone(),
        other => other.to_string(),
    }
}

pub(crate) fn name(opcode: u8) -> &'static str {
    match opcode {
        op::HEADER => "header",
        op::FOOTER => "footer",
        op::SCHEMA => "schema",
        op::CHANNEL => "channel",
        op::MESSAGE => "message",
        op::CHUNK => "chunk",
        op::ATTACHMENT => "attachment",
        op::STATISTICS => "statistics",
        op::METADATA => "metadata",
        op::DATA_END => "data end",
        _ => "index or unknown",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HUGE: [u8; 4] = u32::MAX.to_le_bytes();

    fn refused(opcode: u8, body: &[u8]) -> String {
        match parse(opcode, body, 7) {
            Err(Damage::Record { at: 7, reason, .. }) => reason,
            other => panic!("{other:?}"),
        }
    }

    fn channel(metadata: &[u8]) -> Vec<u8> {
        let start = b"\x01\0\x02\0\x01\0\0\0t\x03\0\0\0cdr";
        let length = (metadata.len() as u32).to_le_bytes();
        [&start[..], &length, metadata].concat()
    }

    #[test]
    fn sound_records_are_parsed() {
        let metadata = [&[1, 0, 0, 0][..], b"k", &[1, 0, 0, 0], b"v"].concat();
        let body = channel(&metadata);
        let Ok(Record::Channel(channel)) = parse(op::CHANNEL, &body, 7) else {
            panic!("it is a channel");
        };
        assert_eq!((channel.id, channel.schema_id), (1, 2));
        assert_eq!((&*channel.topic, &*channel.message_encoding), ("t", "cdr"));
        assert_eq!(channel.metadata["k"], "v");
        let schema = b"\x01\0\x01\0\0\0n\0\0\0\0\x02\0\0\0{}later";
        let Ok(Record::Schema { header, data }) = parse(op::SCHEMA, schema, 7) else {
            panic!("it is a schema, with a field of a later version");
        };
        assert_eq!((header.id, &*header.name, &*data), (1, "n", &b"{}"[..]));
    }

    #[test]
    fn claims_beyond_the_record_are_refused_wherever_they_stand() {
        let mut attachment = [0; 36];
        // No texts, no data, and no checksum.
        assert!(parse(op::ATTACHMENT, &attachment, 7).is_ok());
        attachment[24] = 1;
        for (opcode, body) in [
            (op::SCHEMA, [&[1, 0][..], &HUGE, b"/sca"].concat()),
            (op::CHANNEL, [&[1, 0, 1, 0][..], &HUGE].concat()),
            (op::CHUNK, [&[0; 28][..], &HUGE, &[0; 8]].concat()),
            (op::CHANNEL, channel(&HUGE)),
            (
                op::CHANNEL,
                channel(&[&[1, 0, 0, 0][..], b"k", &HUGE].concat()),
            ),
            (op::METADATA, [&[0; 4][..], &HUGE].concat()),
            (op::SCHEMA, vec![1]),
            (op::CHANNEL, vec![1]),
            (op::CHUNK, vec![1]),
            // The library alone would panic on these two.
            (op::ATTACHMENT, vec![0; 32]),
            (op::ATTACHMENT, attachment.to_vec()),
        ] {
            assert_eq!(
                refused(opcode, &body),
                "it ends within a field, or a field claims more bytes than are left",
                "{opcode}: {body:?}"
            );
        }
    }

    #[test]
    fn what_the_library_refuses_is_said_on_one_line() {
        let schema = b"\x01\0\x01\0\0\0\xff\0\0\0\0\0\0\0\0";
        assert!(refused(op::SCHEMA, schema).contains("invalid utf-8"));
        assert_eq!(
            refused(op::MESSAGE, &[0; 21]),
            "failed to fill whole buffer"
        );
        let twice = [&[1, 0, 0, 0][..], b"k", &[0; 4]].concat().repeat(2);
        assert!(refused(op::CHANNEL, &channel(&twice)).contains("Duplicate keys"));
    }

    proptest::proptest! {
        #[test]
        fn no_bytes_make_it_panic(body in proptest::collection::vec(proptest::num::u8::ANY, 0..100)) {
            for opcode in 0..=0x10 {
                let _ = parse(opcode, &body, 7);
            }
        }
    }
}
