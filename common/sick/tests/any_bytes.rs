//! No bytes of any kind make a parser panic, and what it accepts can be read to the end.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

use proptest::collection::vec;
use proptest::prelude::*;
use sick::cola::{Channel, Channels, DeviceTime, Encoding, Framer, LmdScanData};
use sick::framer::Protocol;
use sick::lms2xx::{CommandFramer, Reply, ReplyFramer};

/// Reads a stream that arrives in pieces of seven bytes, and then ends.
fn read<P: Protocol>(mut framer: sick::Framer<P>, stream: &[u8]) {
    for piece in stream.chunks(7) {
        framer.push(piece);
        while framer.next_frame().is_some() {}
    }
    framer.finish();
    while framer.next_frame().is_some() {}
}

/// Returns the content of a scan with wide and narrow channels, texts and a clock.
fn scan(encoding: Encoding) -> Vec<u8> {
    let channels = [*b"DIST1", *b"RSSI1"].map(|name| Channel {
        name,
        scale_factor: 1.5,
        scale_offset: -0.25,
        start_angle_raw_1e4_deg: -450_000,
        step_raw_1e4_deg: 5000,
        values: [0, 15, 16, 255][..].into(),
    });
    let scan = LmdScanData {
        channels_16_bit: Channels::from(&channels[..]),
        channels_8_bit: Channels::from(&channels[1..]),
        name: Some(b"LMS"),
        comment: Some(b"in the hall"),
        time: DeviceTime::from_unix_us(0),
        ..LmdScanData::default()
    };
    let mut content = Vec::new();
    scan.write(encoding, &mut content);
    content
}

proptest! {
    #[test]
    fn no_bytes_panic(bytes in vec(any::<u8>(), 0..600), dense in any::<bool>()) {
        // Few distinct values reach deeper code: starts, addresses, lengths, codes.
        let few = [2, 3, 0, 0x80, 1, 6, 0x15, b's', b' ', 0xb0];
        let bytes: Vec<u8> = match dense {
            true => bytes.iter().map(|byte| few[usize::from(*byte) % few.len()]).collect(),
            false => bytes,
        };
        read(Framer::new(Encoding::Text), &bytes);
        read(Framer::new(Encoding::Binary), &bytes);
        read(ReplyFramer::default(), &bytes);
        read(CommandFramer::default(), &bytes);
        let _ = Reply::read(&bytes);
        let _ = sick::lms2xx::Command::read(&bytes);
        let _ = LmdScanData::read(Encoding::Binary, &[b"sSN LMDscandata \0\x01", &bytes[..]].concat());
    }

    #[test]
    fn damaged_contents_never_panic(
        edits in vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
    ) {
        for encoding in [Encoding::Text, Encoding::Binary] {
            let mut content = scan(encoding);
            for (at, byte) in &edits {
                let at = at.index(content.len());
                content[at] = *byte;
            }
            let read = LmdScanData::read(encoding, &content);
            prop_assert!(read.is_ok() || !edits.is_empty());
            // Accepted scans can be read to the end.
            if let Ok(scan) = read {
                let channels = scan.channels_16_bit.chain(scan.channels_8_bit);
                channels.for_each(|channel| assert_eq!(channel.values.count(), channel.values.len()));
            }
        }
    }
}
