//! Round trips: every format reads back what it writes, also with garbage in between, and damage
//! never passes where there is a checksum.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

use proptest::collection::vec;
use proptest::prelude::*;
use sick::Frame;
use sick::cola::{Channel, Channels, DeviceTime, Encoding, Framer, LmdScanData, Telegram};
use sick::framer::Protocol;
use sick::lms2xx::{Answer, Reply, ReplyFramer, Scan, Status, Unit};

/// Counters and times, layer, wide and narrow channels, name and comment, and whether there is a
/// clock.
type Parts = (
    ([u32; 4], [u16; 2], i16),
    Vec<(i32, u16, Vec<u16>)>,
    Vec<u8>,
    [Option<String>; 2],
    bool,
);

fn parts() -> impl Strategy<Value = Parts> {
    let text = || proptest::option::of("[ -~]{0,40}");
    let channel = (any::<i32>(), any::<u16>(), vec(any::<u16>(), 0..60));
    (
        any::<([u32; 4], [u16; 2], i16)>(),
        vec(channel, 0..4),
        vec(any::<u8>(), 0..60),
        [text(), text()],
        any::<bool>(),
    )
}

/// Passes the scan that these parts make to `take`.
fn with_scan<R>(parts: &Parts, take: impl FnOnce(LmdScanData<'_>) -> R) -> R {
    let ((numbers, counters, layer), wide, narrow, texts, has_time) = parts;
    let channel = |name, start, step, values| Channel {
        name,
        scale_factor: 1.5,
        scale_offset: -0.25,
        start_angle_raw_1e4_deg: start,
        step_raw_1e4_deg: step,
        values,
    };
    let wide = (b'1'..).zip(wide).map(|(number, (start, step, values))| {
        let name = [b'D', b'I', b'S', b'T', number];
        channel(name, *start, *step, values[..].into())
    });
    let wide: Vec<Channel<'_>> = wide.collect();
    let bytes: Vec<u16> = narrow.iter().map(|&byte| byte.into()).collect();
    let narrow = [channel(*b"RSSI1", -1, 1, bytes[..].into())];
    take(LmdScanData {
        version: 1,
        device_number: 3,
        serial_number: numbers[0],
        status: [0, 4],
        telegram_counter: counters[0],
        scan_counter: counters[1],
        time_since_start_up_us: numbers[1],
        time_of_transmission_us: numbers[2],
        digital_inputs: [1, 0],
        digital_outputs: [0, 255],
        layer_angle_raw: *layer,
        scan_frequency_raw_1e2_hz: numbers[3],
        measurement_frequency_raw: 360,
        channels_16_bit: Channels::from(&wide[..]),
        channels_8_bit: Channels::from(&narrow[..]),
        name: texts[0].as_ref().map(String::as_bytes),
        comment: texts[1].as_ref().map(String::as_bytes),
        time: has_time.then_some(DeviceTime {
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

/// Reads all frames of a stream that arrives in pieces of this length, and then ends.
fn read<P: Protocol>(
    mut framer: sick::Framer<P>,
    stream: &[u8],
    piece: usize,
    mut see: impl FnMut(Frame<'_, P::Telegram<'_>>),
) {
    for piece in stream.chunks(piece).chain([&[][..]]) {
        framer.push(piece);
        if piece.is_empty() {
            framer.finish();
        }
        while let Some(next) = framer.next_frame() {
            if let Ok(frame) = next {
                see(frame);
            }
        }
    }
}

fn lms_scan(readings: &[u16], quarter: u8) -> Reply<'_> {
    let scan = Scan {
        part: (quarter < 4).then_some(quarter),
        sub_range: (quarter == 5).then_some((1, readings.len() as u16)),
        counters: (quarter == 6).then_some((1, 2)),
        ..Scan::new(Unit::Centimetre, readings)
    };
    Reply::Answer(Answer::Scan(scan), Status(0x10))
}

proptest! {
    #[test]
    fn a_scan_in_either_encoding(parts in parts(), piece in 1usize..300) {
        for encoding in [Encoding::Text, Encoding::Binary] {
            let mut stream = Vec::new();
            with_scan(&parts, |scan| encoding.frame(&Telegram::ScanData(scan), &mut stream));
            let mut count = 0;
            read(Framer::new(encoding), &stream, piece, |frame| {
                with_scan(&parts, |scan| assert_eq!(frame.telegram, Telegram::ScanData(scan)));
                assert_eq!(frame.skipped, 0);
                count += 1;
            });
            prop_assert_eq!(count, 1);
        }
    }

    #[test]
    fn scans_of_the_lms2xx(
        readings in vec(any::<u16>(), 0..402), quarter in 0u8..7, piece in 1usize..300,
    ) {
        let mut stream = Vec::new();
        lms_scan(&readings, quarter).frame(&mut stream);
        let mut count = 0;
        read(ReplyFramer::default(), &stream, piece, |frame| {
            assert_eq!(frame.telegram, lms_scan(&readings, quarter));
            count += 1;
        });
        prop_assert_eq!(count, 1);
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
        read(ReplyFramer::default(), &stream, 64, |frame| {
            if let Reply::Answer(Answer::Scan(scan), _) = frame.telegram {
                assert!(scan.readings.eq(readings.iter().copied()));
            }
        });
    }

    #[test]
    fn no_bytes_panic(bytes in vec(any::<u8>(), 0..600), dense in any::<bool>()) {
        // Few distinct values reach deeper code: starts, addresses, lengths, codes.
        let few = [2, 3, 0, 0x80, 1, 6, 0x15, b's', b' ', 0xb0];
        let bytes: Vec<u8> = match dense {
            true => bytes.iter().map(|byte| few[usize::from(*byte) % few.len()]).collect(),
            false => bytes,
        };
        read(Framer::new(Encoding::Text), &bytes, 7, |_| {});
        read(Framer::new(Encoding::Binary), &bytes, 7, |_| {});
        read(ReplyFramer::default(), &bytes, 7, |_| {});
        let _ = Reply::read(&bytes);
        let _ = sick::lms2xx::Command::read(&bytes);
        let _ = LmdScanData::read(Encoding::Binary, &[b"sSN LMDscandata \0\x01", &bytes[..]].concat());
    }

    #[test]
    fn damaged_contents_never_panic(
        parts in parts(), edits in vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        for encoding in [Encoding::Text, Encoding::Binary] {
            let mut content = Vec::new();
            with_scan(&parts, |scan| scan.write(encoding, &mut content));
            for (at, byte) in &edits {
                let at = at.index(content.len());
                content[at] = *byte;
            }
            // Accepted scans can be read to the end.
            if let Ok(scan) = LmdScanData::read(encoding, &content) {
                let channels = scan.channels_16_bit.chain(scan.channels_8_bit);
                channels.for_each(|channel| assert_eq!(channel.values.count(), channel.values.len()));
            }
        }
    }
}
