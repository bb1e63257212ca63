//! Round trips: every format reads back what it writes, also with garbage in between, and damage
//! never passes where there is a checksum.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use proptest::collection::vec;
use proptest::prelude::*;
use sick::cola::{Channel, Channels, DeviceTime, Encoding, Framer, LmdScanData, Telegram};
use sick::lms2xx::{Answer, Part, Reply, ReplyFramer, Scan, Status, Unit};

/// Owned data of a scan.
#[derive(Debug, Clone)]
struct Parts {
    numbers: [u32; 4],
    counters: [u16; 2],
    layer: i16,
    wide: Vec<(i32, u16, Vec<u16>)>,
    narrow: Vec<u8>,
    texts: [Option<String>; 2],
    has_time: bool,
}

fn parts() -> impl Strategy<Value = Parts> {
    let text = || proptest::option::of("[ -~]{0,40}");
    let channel = (any::<i32>(), any::<u16>(), vec(any::<u16>(), 0..60));
    (
        any::<[u32; 4]>(),
        any::<[u16; 2]>(),
        any::<i16>(),
        vec(channel, 0..4),
        vec(any::<u8>(), 0..60),
        [text(), text()],
        any::<bool>(),
    )
        .prop_map(
            |(numbers, counters, layer, wide, narrow, texts, has_time)| Parts {
                numbers,
                counters,
                layer,
                wide,
                narrow,
                texts,
                has_time,
            },
        )
}

impl Parts {
    /// Passes the scan that these parts make to `take`.
    fn scan<R>(&self, take: impl FnOnce(LmdScanData<'_>) -> R) -> R {
        let channel = |name, start, step, values| Channel {
            name,
            scale_factor: 1.5,
            scale_offset: -0.25,
            start_angle_raw_1e4_deg: start,
            step_raw_1e4_deg: step,
            values,
        };
        let wide: Vec<Channel<'_>> = self
            .wide
            .iter()
            .enumerate()
            .map(|(i, (start, step, values))| {
                channel(
                    [b'D', b'I', b'S', b'T', b'1' + i as u8],
                    *start,
                    *step,
                    values[..].into(),
                )
            })
            .collect();
        let bytes: Vec<u16> = self.narrow.iter().map(|&byte| byte.into()).collect();
        let narrow = [channel(*b"RSSI1", -1, 1, bytes[..].into())];
        take(LmdScanData {
            version: 1,
            device_number: 3,
            serial_number: self.numbers[0],
            status: [0, 4],
            telegram_counter: self.counters[0],
            scan_counter: self.counters[1],
            time_since_start_up_us: self.numbers[1],
            time_of_transmission_us: self.numbers[2],
            digital_inputs: [1, 0],
            digital_outputs: [0, 255],
            layer_angle_raw: self.layer,
            scan_frequency_raw_1e2_hz: self.numbers[3],
            measurement_frequency_raw: 360,
            channels_16_bit: Channels::from(&wide[..]),
            channels_8_bit: Channels::from(&narrow[..]),
            name: self.texts[0].as_ref().map(String::as_bytes),
            comment: self.texts[1].as_ref().map(String::as_bytes),
            time: self.has_time.then_some(DeviceTime {
                year: 2024,
                month: 2,
                day: 29,
                hour: 23,
                minute: 59,
                second: 60,
                microsecond: 999_999,
            }),
        })
    }

    fn frame(&self, encoding: Encoding) -> Vec<u8> {
        let mut out = Vec::new();
        self.scan(|scan| encoding.frame(&Telegram::ScanData(scan), &mut out));
        out
    }
}

/// Returns the contents of the scans in a stream that is read in pieces of this length.
fn scans(encoding: Encoding, stream: &[u8], piece: usize) -> Vec<Vec<u8>> {
    let mut framer = Framer::new(encoding);
    let mut found = Vec::new();
    for piece in stream.chunks(piece).chain([&[][..]]) {
        framer.push(piece);
        if piece.is_empty() {
            framer.finish();
        }
        while let Some(next) = framer.next_frame() {
            if let Ok(frame) = next
                && matches!(frame.telegram, Telegram::ScanData(_))
            {
                found.push(frame.content.to_vec());
            }
        }
    }
    found
}

fn lms_scan(readings: &[u16], quarter: u8) -> Reply<'_> {
    let scan = Scan {
        unit: Unit::Centimetre,
        part: Part::at_quarter(quarter),
        sub_range: (quarter == 5).then_some((1, readings.len() as u16)),
        readings: readings.into(),
        counters: (quarter == 6).then_some((1, 2)),
    };
    Reply::Answer(Answer::Scan(scan), Status(0x10))
}

/// Returns the readings of the scans in a stream that is read in pieces of this length.
fn lms_scans(stream: &[u8], piece: usize) -> Vec<Vec<u16>> {
    let mut framer = ReplyFramer::default();
    let mut found = Vec::new();
    for piece in stream.chunks(piece) {
        framer.push(piece);
        while let Some(next) = framer.next_frame() {
            if let Ok(frame) = next
                && let Reply::Answer(Answer::Scan(scan), _) = frame.telegram
            {
                found.push(scan.readings.collect());
            }
        }
    }
    found
}

proptest! {
    #[test]
    fn a_scan_in_either_encoding(parts in parts(), piece in 1usize..300) {
        for encoding in [Encoding::Text, Encoding::Binary] {
            let mut framer = Framer::new(encoding);
            for piece in parts.frame(encoding).chunks(piece) {
                framer.push(piece);
            }
            let frame = framer.next_frame().unwrap().unwrap();
            let Telegram::ScanData(found) = frame.telegram else { panic!("no scan") };
            parts.scan(|expected| assert_eq!(found, expected));
            prop_assert_eq!(frame.skipped, 0);
        }
    }

    #[test]
    fn garbage_between_scans_costs_none_of_them(
        all in vec(parts(), 1..4),
        garbage in vec(0u8..5, 0..40),
        piece in 1usize..300,
    ) {
        // A start byte in the garbage would claim the bytes after it.
        let garbage: Vec<u8> = garbage.into_iter().map(|byte| byte + 4).collect();
        for encoding in [Encoding::Text, Encoding::Binary] {
            let mut stream = Vec::new();
            for parts in &all {
                stream.extend(&garbage);
                stream.extend(parts.frame(encoding));
            }
            prop_assert_eq!(scans(encoding, &stream, piece).len(), all.len());
        }
    }

    #[test]
    fn scans_of_the_lms2xx(
        readings in vec(any::<u16>(), 0..402), quarter in 0u8..7, piece in 1usize..300,
    ) {
        let mut stream = Vec::new();
        lms_scan(&readings, quarter).frame(&mut stream);
        let mut framer = ReplyFramer::default();
        for piece in stream.chunks(piece) {
            framer.push(piece);
        }
        let found = framer.next_frame().unwrap().unwrap().telegram;
        prop_assert_eq!(found, lms_scan(&readings, quarter));
    }

    #[test]
    fn damage_to_the_lms2xx_never_lets_a_wrong_scan_through(
        readings in vec(any::<u16>(), 181), at in 0usize..370, bits in 1u8..=255, cut in any::<bool>(),
    ) {
        let mut one = Vec::new();
        lms_scan(&readings, 4).frame(&mut one);
        let mut stream = [&one[..], &one, &one].concat();
        // All changed bits are in one byte: the CRC detects each such change, although a byte
        // enters it twice.
        match cut {
            true => { stream.drain(at..at + 3); }
            false => stream[at % one.len()] ^= bits,
        }
        for found in lms_scans(&stream, 64) {
            prop_assert_eq!(&found, &readings);
        }
    }

    #[test]
    fn no_bytes_panic(bytes in vec(any::<u8>(), 0..600), dense in any::<bool>()) {
        // Few distinct values reach deeper code: starts, addresses, lengths, codes.
        let few = [2, 3, 0, 0x80, 1, 6, 0x15, b's', b' ', 0xb0];
        let bytes: Vec<u8> = match dense {
            true => bytes.iter().map(|byte| few[usize::from(*byte) % few.len()]).collect(),
            false => bytes,
        };
        scans(Encoding::Text, &bytes, 7);
        scans(Encoding::Binary, &bytes, 7);
        lms_scans(&bytes, 7);
        let _ = Reply::read(&bytes);
        let _ = sick::lms2xx::Command::read(&bytes);
    }

    #[test]
    fn damaged_text_never_panics(
        parts in parts(), edits in vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut stream = parts.frame(Encoding::Text);
        for (at, byte) in edits {
            let at = at.index(stream.len());
            stream[at] = byte;
        }
        // There is no checksum, but accepted scans can be read to the end.
        let mut framer = Framer::new(Encoding::Text);
        framer.push(&stream);
        while let Some(next) = framer.next_frame() {
            if let Ok(frame) = next && let Telegram::ScanData(scan) = frame.telegram {
                let channels = scan.channels_16_bit.chain(scan.channels_8_bit);
                channels.for_each(|channel| assert_eq!(channel.values.count(), channel.len()));
            }
        }
    }
}
