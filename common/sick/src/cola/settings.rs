//! Settings of a device: its scan configuration and the content of its telegrams.

use super::writer::Writer;
use crate::SickError;
use crate::cursor::Cursor;

/// Scan configuration: `LMPscancfg`, `mLMPsetscancfg`. One sector.
///
/// | bytes | field | |
/// |---|---|---|
/// | 4 | scan frequency | u32, 1/100 Hz |
/// | 14 | range | see [`OutputRange`] |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScanConfig {
    pub frequency_raw_1e2_hz: u32,
    /// Range of angles that is measured.
    pub range: OutputRange,
}

/// Part of a scan that is sent: `LMPoutputRange`. One sector.
///
/// | bytes | field | |
/// |---|---|---|
/// | 2 | sectors | u16, 1 |
/// | 4 | angular resolution | u32, 1/10000° |
/// | 4 | start angle | i32, 1/10000° |
/// | 4 | stop angle | i32, 1/10000° |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OutputRange {
    pub resolution_raw_1e4_deg: u32,
    /// Angle of the first beam, in the device's convention (90° is ahead).
    pub start_angle_raw_1e4_deg: i32,
    pub stop_angle_raw_1e4_deg: i32,
}

/// Content of `LMDscandata`: `LMDscandatacfg`.
///
/// | bytes | field | |
/// |---|---|---|
/// | 2 | data channels | 2 · u8, a bit for each echo |
/// | 1 | remission | u8, 0 or 1 |
/// | 1 | resolution of the remission | u8, 0: 8 bits, 1: 16 bits |
/// | 1 | unit of the remission | u8, 0: digits |
/// | 2 | encoders | 2 · u8, a bit for each |
/// | 1 each | position, name, comment, time | u8, 0 or 1 |
/// | 2 | interval | u16, every n-th scan |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScanDataConfig {
    /// One bit per echo; the first echo is the low bit of the first byte.
    pub channels: [u8; 2],
    pub remission: bool,
    pub remission_16_bit: bool,
    pub remission_unit: u8,
    /// One bit per encoder.
    pub encoders: [u8; 2],
    pub position: bool,
    pub name: bool,
    pub comment: bool,
    /// True if the device's clock is sent.
    pub time: bool,
    /// Interval between scans that are sent: every n-th.
    pub interval: u16,
}

impl ScanConfig {
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Self, SickError> {
        Ok(ScanConfig {
            frequency_raw_1e2_hz: cursor.u32("scan frequency")?,
            range: OutputRange::read(cursor)?,
        })
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>) {
        writer.u32(self.frequency_raw_1e2_hz);
        self.range.write(writer);
    }
}

impl OutputRange {
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Self, SickError> {
        cursor.checked("sectors", Cursor::u16, |&count| count == 1, "1")?;
        Ok(OutputRange {
            resolution_raw_1e4_deg: cursor.u32("angular resolution")?,
            start_angle_raw_1e4_deg: cursor.i32("start angle")?,
            stop_angle_raw_1e4_deg: cursor.i32("stop angle")?,
        })
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>) {
        writer.u16(1);
        writer.u32(self.resolution_raw_1e4_deg);
        writer.i32(self.start_angle_raw_1e4_deg);
        writer.i32(self.stop_angle_raw_1e4_deg);
    }
}

impl ScanDataConfig {
    /// Only the distances of the first echo, of every scan.
    pub const DISTANCES: ScanDataConfig = ScanDataConfig {
        channels: [1, 0],
        remission: false,
        remission_16_bit: true,
        remission_unit: 0,
        encoders: [0, 0],
        position: false,
        name: false,
        comment: false,
        time: false,
        interval: 1,
    };

    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Self, SickError> {
        Ok(ScanDataConfig {
            channels: cursor.pair("data channels")?,
            remission: cursor.bool("remission")?,
            remission_16_bit: cursor.bool("resolution of the remission")?,
            remission_unit: cursor.u8("unit of the remission")?,
            encoders: cursor.pair("encoders")?,
            position: cursor.bool("position")?,
            name: cursor.bool("name")?,
            comment: cursor.bool("comment")?,
            time: cursor.bool("time")?,
            interval: cursor.u16("interval")?,
        })
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>) {
        writer.pair(self.channels);
        writer.bool(self.remission);
        writer.bool(self.remission_16_bit);
        writer.u8(self.remission_unit);
        writer.pair(self.encoders);
        for sent in [self.position, self.name, self.comment, self.time] {
            writer.bool(sent);
        }
        writer.u16(self.interval);
    }
}
