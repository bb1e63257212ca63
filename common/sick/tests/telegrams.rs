//! Tests the codec against telegrams of a real TiM781 and their decoded fields
//! (tests/data/SOURCE.txt).
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

use serde_json::Value;
use sick::Frame;
use sick::cola::{Encoding, Framer, LmdScanData, Telegram};

const CAPTURE: &[u8] = include_bytes!("data/tim781_colab_telegrams.bin");
const MANIFEST: &str = include_str!("data/tim781_manifest.json");

/// Passes each frame of the capture to `see` in order.
fn read(mut see: impl FnMut(Frame<'_, Telegram<'_>>)) {
    let mut framer = Framer::new(Encoding::Binary);
    framer.push(CAPTURE);
    framer.finish();
    while let Some(next) = framer.next_frame() {
        see(next.unwrap());
    }
}

#[test]
fn every_field_of_the_real_telegrams() {
    let manifest: Vec<Value> = serde_json::from_str(MANIFEST).unwrap();
    let mut index = 0;
    read(|frame| {
        check(&frame, &manifest[index], index);
        index += 1;
    });
    assert_eq!((index, manifest.len()), (16, 16));
}

fn check(frame: &Frame<'_, Telegram<'_>>, expected: &Value, index: usize) {
    let Telegram::ScanData(data) = &frame.telegram else {
        panic!("telegram {index} is {:?}", frame.telegram);
    };
    let number = |key: &str| expected[key].as_u64().unwrap();
    assert_eq!(frame.offset, number("offset"));
    assert_eq!(frame.skipped, 0);
    assert_eq!(frame.content.len() as u64 + 9, number("len"));
    assert_eq!(u64::from(data.serial_number), number("serial"));
    assert_eq!(u64::from(data.telegram_counter), number("telegram"));
    assert_eq!(u64::from(data.scan_counter), number("scan"));
    assert_eq!(u64::from(data.time_since_start_up_us), number("t_up_us"));
    assert_eq!(u64::from(data.time_of_transmission_us), number("t_tx_us"));
    let frequency = f64::from(data.scan_frequency_raw_1e2_hz) / 100.0;
    assert_eq!(frequency, expected["scan_freq"].as_f64().unwrap());
    check_channels(data, expected["channels"].as_array().unwrap());
    check_tail(data, frame.content, expected["tail"].as_str().unwrap());
    // Not in the manifest but read off the bytes: outputs and frequency of the device at rest,
    // 16200 shots per second.
    assert_eq!((data.version, data.device_number), (1, 1), "{index}");
    assert_eq!((data.status, data.digital_inputs), ([0, 0], [0, 0]));
    assert_eq!((data.digital_outputs, data.layer_angle_raw), ([8, 0], 0));
    assert_eq!(data.measurement_frequency_raw, 162);
}

fn check_channels(data: &LmdScanData<'_>, expected: &[Value]) {
    let channels: Vec<_> = data.channels_16_bit.clone().collect();
    assert_eq!(channels.len(), expected.len());
    for (channel, expected) in channels.iter().zip(expected) {
        assert_eq!(channel.name, expected[0].as_str().unwrap().as_bytes());
        assert_eq!(f64::from(channel.scale_factor), expected[1]);
        assert_eq!(f64::from(channel.scale_offset), expected[2]);
        let degrees = |raw: f64| raw / 1e4;
        assert_eq!(degrees(channel.start_angle_raw_1e4_deg.into()), expected[3]);
        assert_eq!(degrees(channel.step_raw_1e4_deg.into()), expected[4]);
        assert_eq!(channel.values.len() as u64, expected[5].as_u64().unwrap());
        let least = channel.values.min().map(u64::from);
        let most = channel.values.max().map(u64::from);
        assert_eq!((least, most), (expected[6].as_u64(), expected[7].as_u64()));
    }
    assert_eq!(data.channels_8_bit.clone().count(), 0);
}

/// Compares the blocks after the 16-bit channels, which the manifest gives as hex.
fn check_tail(data: &LmdScanData<'_>, content: &[u8], expected: &str) {
    let tail = &content[content.len() - expected.len() / 2..];
    let hex: String = tail.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(hex, expected);
    assert_eq!((data.name, data.comment), (None, None));
    let time = data.time.unwrap();
    assert_eq!(
        (time.year, time.month, time.day, time.hour),
        (1970, 1, 1, 0)
    );
    assert_eq!(time.minute, 50);
    let hex = format!("{:02x}{:08x}", time.second, time.microsecond);
    assert_eq!(hex, expected[expected.len() - 14..expected.len() - 4]);
}

#[test]
fn the_real_telegrams_say_the_same_in_text_and_binary_again() {
    read(|frame| {
        let mut binary = Vec::new();
        frame.telegram.write(Encoding::Binary, &mut binary);
        assert_eq!(binary, frame.content);
        let mut text = Vec::new();
        frame.telegram.write(Encoding::Text, &mut text);
        assert!(text.is_ascii());
        let read = Telegram::read(Encoding::Text, &text).unwrap();
        assert_eq!(read, frame.telegram);
    });
}
