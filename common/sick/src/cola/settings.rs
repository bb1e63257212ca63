//! What can be set on a device: how it scans, and what its telegrams carry.

use super::cursor::Cursor;
use super::writer::Writer;
use crate::SickError;

/// How the device scans: `LMPscancfg`, `mLMPsetscancfg`. One sector.
///
/// | bytes | field | |
/// |---|---|---|
/// | 4 | scan frequency | u32, 1/100 Hz |
/// | 2 | sectors | u16, 1 |
/// | 4 | angular resolution | u32, 1/10000° |
/// | 4 | start angle | i32, 1/10000° |
/// | 4 | stop angle | i32, 1/10000° |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScanConfig {
    /// Turns of the mirror, 1/100 Hz.
    pub frequency_raw_1e2_hz: u32,
    /// From one beam to the next.
    pub resolution_raw_1e4_deg: u32,
    /// Of the first beam, in the device's convention: 90° is ahead.
    pub start_angle_raw_1e4_deg: i32,
    /// Of the last beam.
    pub stop_angle_raw_1e4_deg: i32,
}

/// The part of a scan that is sent: `LMPoutputRange`. One sector.
///
/// | bytes | field | |
/// |---|---|---|
/// | 2 | sectors | u16, 1 |
/// | 4 | angular resolution | u32, 1/10000° |
/// | 4 | start angle | i32, 1/10000° |
/// | 4 | stop angle | i32, 1/10000° |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OutputRange {
    /// From one beam to the next.
    pub resolution_raw_1e4_deg: u32,
    /// Of the first beam, in the device's convention: 90° is ahead.
    pub start_angle_raw_1e4_deg: i32,
    /// Of the last beam.
    pub stop_angle_raw_1e4_deg: i32,
}

/// What `LMDscandata` carries: `LMDscandatacfg`.
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
    /// A bit for each echo, the first in the low bit of the first.
    pub channels: [u8; 2],
    /// Whether remissions are sent.
    pub remission: bool,
    /// Whether remissions have 16 bits.
    pub remission_16_bit: bool,
    /// 0: digits.
    pub remission_unit: u8,
    /// A bit for each encoder.
    pub encoders: [u8; 2],
    /// Whether the position is sent.
    pub position: bool,
    /// Whether the device's name is sent.
    pub name: bool,
    /// Whether the comment is sent.
    pub comment: bool,
    /// Whether the device's clock is sent.
    pub time: bool,
    /// Every n-th scan is sent.
    pub interval: u16,
}

impl ScanConfig {
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Self, SickError> {
        let frequency_raw_1e2_hz = cursor.u32("scan frequency")?;
        one_sector(cursor)?;
        Ok(ScanConfig {
            frequency_raw_1e2_hz,
            resolution_raw_1e4_deg: cursor.u32("angular resolution")?,
            start_angle_raw_1e4_deg: cursor.i32("start angle")?,
            stop_angle_raw_1e4_deg: cursor.i32("stop angle")?,
        })
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>) {
        writer.u32(self.frequency_raw_1e2_hz);
        writer.u16(1);
        writer.u32(self.resolution_raw_1e4_deg);
        writer.i32(self.start_angle_raw_1e4_deg);
        writer.i32(self.stop_angle_raw_1e4_deg);
    }
}

impl OutputRange {
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Self, SickError> {
        one_sector(cursor)?;
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
    /// The distances of the first echo of each scan, and nothing beside.
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

fn one_sector(cursor: &mut Cursor<'_>) -> Result<(), SickError> {
    let offset = cursor.offset();
    match cursor.u16("sectors")? {
        1 => Ok(()),
        found => Err(super::cursor::field_error("sectors", offset, &found, "1")),
    }
}
