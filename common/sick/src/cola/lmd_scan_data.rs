//! `LMDscandata`: one scan in the device's format.
//!
//! The layout follows SICK's telegram listing for LiDAR sensors. Every field is read and checked,
//! in order, to the last byte; this module does not interpret the values. Encoders, the position and
//! the event are skipped, and written as missing.

use super::Encoding;
use super::channel::Channels;
use super::tail::{self, DeviceTime};
use super::writer::Writer;
use crate::SickError;
use crate::cursor::{Cursor, field_error};

/// Number of bytes before the first field.
const COMMAND: usize = 16;

/// Name of both the event and the variable.
pub(super) const NAME: &[u8] = b"LMDscandata";

/// Scan telegram. Offsets count from the start of the content in CoLa B. In CoLa A each number is a
/// word, and each u8 of a pair is a word of its own.
///
/// | offset | bytes | field | |
/// |---|---|---|---|
/// | 0 | 16 | command and name | `sSN LMDscandata ` or `sRA LMDscandata ` |
/// | 16 | 2 | version | u16, 0 or 1 |
/// | 18 | 2 | device number | u16 |
/// | 20 | 4 | serial number | u32 |
/// | 24 | 2 | device status | 2 · u8 |
/// | 26 | 2 | telegram counter | u16 |
/// | 28 | 2 | scan counter | u16 |
/// | 30 | 4 | time since start-up | u32, µs |
/// | 34 | 4 | time of transmission | u32, µs |
/// | 38 | 2 | digital inputs | 2 · u8 |
/// | 40 | 2 | digital outputs | 2 · u8 |
/// | 42 | 2 | layer angle | i16; 0 on devices with one layer |
/// | 44 | 4 | scan frequency | u32, 1/100 Hz |
/// | 48 | 4 | measurement frequency | u32, 100 Hz |
/// | 52 | 2 | number of encoders | u16, 0 to 3 |
/// | 54 | 6 each | encoders | position u32, speed u16 |
/// | … | … | 16-bit channels | see [`Channels`] |
/// | … | … | 8-bit channels | see [`Channels`] |
/// | … | 2 (+ 25) | position | u16 flag, f32 each, kind u8 |
/// | … | 2 (+ 1 + n) | name | u16 flag, u8 length, characters |
/// | … | 2 (+ 1 + n) | comment | u16 flag, u8 length, characters |
/// | … | 2 (+ 11) | time | u16 flag, [`DeviceTime`] |
/// | … | 2 (+ 16) | event | u16 flag, `FDIN`, u32, u32, i32 |
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LmdScanData<'a> {
    pub version: u16,
    pub device_number: u16,
    pub serial_number: u32,
    /// Device status: 0, 0 is ok; 0, 1 is an error; 0, 2 and 0, 4 are contamination.
    pub status: [u8; 2],
    /// Number of telegrams that the device has finished; wraps.
    pub telegram_counter: u16,
    /// Number of scans that the device has made; wraps.
    pub scan_counter: u16,
    /// Time since the device started, µs; wraps after 71.6 minutes.
    pub time_since_start_up_us: u32,
    /// Time on the same clock when the telegram was handed to the interface, µs.
    pub time_of_transmission_us: u32,
    /// Digital inputs, one bit each, in the low byte.
    pub digital_inputs: [u8; 2],
    pub digital_outputs: [u8; 2],
    /// Angle of the layer, on devices with several layers.
    pub layer_angle_raw: i16,
    pub scan_frequency_raw_1e2_hz: u32,
    /// Measurement frequency, in 100 Hz on most devices; depends on the firmware.
    pub measurement_frequency_raw: u32,
    /// Distances, and remissions if they have 16 bits.
    pub channels_16_bit: Channels<'a>,
    pub channels_8_bit: Channels<'a>,
    pub name: Option<&'a [u8]>,
    pub comment: Option<&'a [u8]>,
    pub time: Option<DeviceTime>,
}

impl<'a> LmdScanData<'a> {
    pub fn read(encoding: Encoding, content: &'a [u8]) -> Result<Self, SickError> {
        let mut whole = Cursor::new(Encoding::Binary, content, 0);
        let command = whole.take("command and name", COMMAND)?;
        let fields = whole.rest();
        if !LmdScanData::is_in(command) {
            let found = command.escape_ascii();
            return Err(field_error(
                "command and name",
                0,
                &found,
                "sSN LMDscandata or sRA LMDscandata",
            ));
        }
        LmdScanData::read_fields(&mut Cursor::new(encoding, fields, COMMAND))
    }

    pub(super) fn is_in(content: &[u8]) -> bool {
        content.starts_with(b"sSN LMDscandata ") || content.starts_with(b"sRA LMDscandata ")
    }

    fn read_fields(cursor: &mut Cursor<'a>) -> Result<Self, SickError> {
        let data = LmdScanData {
            version: cursor.u16_upto("version", 1, "0 or 1")?,
            device_number: cursor.u16("device number")?,
            serial_number: cursor.u32("serial number")?,
            status: cursor.pair("device status")?,
            telegram_counter: cursor.u16("telegram counter")?,
            scan_counter: cursor.u16("scan counter")?,
            time_since_start_up_us: cursor.u32("time since start-up")?,
            time_of_transmission_us: cursor.u32("time of transmission")?,
            digital_inputs: cursor.pair("digital inputs")?,
            digital_outputs: cursor.pair("digital outputs")?,
            layer_angle_raw: cursor.i16("layer angle")?,
            scan_frequency_raw_1e2_hz: cursor.u32("scan frequency")?,
            measurement_frequency_raw: cursor.u32("measurement frequency")?,
            channels_16_bit: {
                tail::skip_encoders(cursor)?;
                Channels::read(cursor, "number of 16-bit channels", 2)?
            },
            channels_8_bit: Channels::read(cursor, "number of 8-bit channels", 1)?,
            name: {
                optional(cursor, "position flag", tail::skip_position)?;
                optional(cursor, "name flag", |cursor| tail::text(cursor, "name"))?
            },
            comment: optional(cursor, "comment flag", |cursor| {
                tail::text(cursor, "comment")
            })?,
            time: optional(cursor, "time flag", DeviceTime::read)?,
        };
        optional(cursor, "event flag", tail::skip_event)?;
        cursor.end()?;
        Ok(data)
    }

    /// Appends the content of a pushed telegram (`sSN`).
    pub fn write(&self, encoding: Encoding, out: &mut Vec<u8>) {
        let mut writer = Writer::command(encoding, b"sSN", NAME, out);
        self.write_header(&mut writer);
        // No encoders.
        writer.u16(0);
        self.channels_16_bit.write(&mut writer, 2);
        self.channels_8_bit.write(&mut writer, 1);
        self.write_tail(&mut writer);
    }

    fn write_header(&self, writer: &mut Writer<'_>) {
        writer.u16(self.version);
        writer.u16(self.device_number);
        writer.u32(self.serial_number);
        writer.pair(self.status);
        writer.u16(self.telegram_counter);
        writer.u16(self.scan_counter);
        writer.u32(self.time_since_start_up_us);
        writer.u32(self.time_of_transmission_us);
        writer.pair(self.digital_inputs);
        writer.pair(self.digital_outputs);
        writer.u16(self.layer_angle_raw.cast_unsigned());
        writer.u32(self.scan_frequency_raw_1e2_hz);
        writer.u32(self.measurement_frequency_raw);
    }

    fn write_tail(&self, writer: &mut Writer<'_>) {
        // No position.
        writer.flag(false);
        for text in [self.name, self.comment] {
            writer.flag(text.is_some());
            if let Some(text) = text {
                tail::write_text(text, writer);
            }
        }
        writer.flag(self.time.is_some());
        if let Some(time) = self.time {
            time.write(writer);
        }
        // No event.
        writer.flag(false);
    }
}

/// Reads a flag, and the block after it if the flag is set.
fn optional<'a, T>(
    cursor: &mut Cursor<'a>,
    flag: &'static str,
    read: impl FnOnce(&mut Cursor<'a>) -> Result<T, SickError>,
) -> Result<Option<T>, SickError> {
    if cursor.flag(flag)? {
        return read(cursor).map(Some);
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a telegram with every optional block.
    fn full() -> Vec<u8> {
        let mut bytes = b"sSN LMDscandata ".to_vec();
        bytes.extend([0, 1, 0, 7, 0, 1, 2, 3, 0, 2, 0xff, 0xff, 0, 0]);
        bytes.extend([0xff, 0xff, 0xff, 0xf0, 0, 0, 0, 0x10, 3, 0, 7, 0]);
        bytes.extend([0xf5, 0xb2, 0, 0, 0x13, 0x88, 0, 0, 1, 0x68]);
        bytes.extend([0, 1, 0, 0, 0, 9, 0xff, 0xfe]);
        bytes.extend([0, 0, 0, 1]);
        bytes.extend(*b"RSSI1");
        bytes.extend([
            0x3f, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x13, 0x88, 0, 2, 200, 201,
        ]);
        bytes.extend([0, 1]);
        bytes.extend(
            [1f32, 2.0, 3.0, 0.1, 0.2, 0.3]
                .map(f32::to_be_bytes)
                .concat(),
        );
        bytes.push(3);
        bytes.extend(*b"\0\x01\x03LMS\0\x01\x02hi");
        bytes.extend([0, 1, 0x07, 0xb2, 1, 1, 0, 50, 14, 0, 2, 0x13, 0x40]);
        bytes.extend(*b"\0\x01FDIN");
        bytes.extend([0, 0, 0, 5, 0, 0, 0, 6, 0xff, 0xff, 0xff, 0xff]);
        bytes
    }

    #[test]
    fn every_field_that_is_kept_survives_both_encodings() {
        let bytes = full();
        let data = LmdScanData::read(Encoding::Binary, &bytes).unwrap();
        let mut again = Vec::new();
        data.write(Encoding::Binary, &mut again);
        assert_eq!(LmdScanData::read(Encoding::Binary, &again).unwrap(), data);
        let skipped = "sSN LMDscandata 1 7 10203 0 2 FFFF 0 FFFFFFF0 10 3 0 7 0 F5B2 1388 168 \
                       1 9 FFFE 0 1 RSSI1 3F800000 0 0 1388 2 C8 C9 \
                       1 3F800000 40000000 40400000 3DCCCCCD 3E4CCCCD 3E99999A 3 \
                       1 3 LMS 1 2 hi 1 7B2 1 1 0 32 E 21340 1 FDIN 5 6 FFFFFFFF";
        let read = LmdScanData::read(Encoding::Text, skipped.as_bytes());
        assert_eq!(read.unwrap(), data);
        let mut text = Vec::new();
        data.write(Encoding::Text, &mut text);
        let expected = "sSN LMDscandata 1 7 10203 0 2 FFFF 0 FFFFFFF0 10 3 0 7 0 F5B2 1388 168 \
                        0 0 1 RSSI1 3F800000 0 0 1388 2 C8 C9 \
                        0 1 3 LMS 1 2 hi 1 7B2 1 1 0 32 E 21340 0";
        assert_eq!(String::from_utf8(text.clone()).unwrap(), expected);
        assert_eq!(LmdScanData::read(Encoding::Text, &text).unwrap(), data);
    }

    #[test]
    fn every_shorter_and_every_longer_telegram_is_refused() {
        let mut bytes = full();
        for end in 0..bytes.len() {
            let error = LmdScanData::read(Encoding::Binary, &bytes[..end]).unwrap_err();
            assert!(matches!(error, SickError::Short { .. }), "{end}: {error}");
        }
        bytes.push(0);
        let error = LmdScanData::read(Encoding::Binary, &bytes).unwrap_err();
        assert!(
            matches!(error, SickError::Trailing { left: 1, .. }),
            "{error}"
        );
    }

    #[test]
    fn foreign_commands_versions_and_counts_are_refused() {
        let refuse = |at: usize, value: u8, expected: &str| {
            let mut bytes = full();
            bytes[at] = value;
            let text = LmdScanData::read(Encoding::Binary, &bytes)
                .unwrap_err()
                .to_string();
            assert!(text.contains(expected), "{text}");
        };
        refuse(
            1,
            b'W',
            "`command and name` is sWN LMDscandata , allowed is sSN",
        );
        refuse(
            17,
            2,
            "byte 16 of the telegram: `version` is 2, allowed is 0 or 1",
        );
        refuse(
            53,
            4,
            "byte 52 of the telegram: `number of encoders` is 4, allowed is 0 to 3",
        );
        // The name of the channel follows one encoder and two counts.
        refuse(
            66,
            0,
            r"byte 64 of the telegram: `channel name` is RS\x00I1",
        );
    }
}
