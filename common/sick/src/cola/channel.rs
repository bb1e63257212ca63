//! The channels of a scan telegram: one value for each angle.

use super::Values;
use super::writer::Writer;
use crate::SickError;
use crate::cursor::{Cursor, field_error};

/// Smallest raw distance; lower values are codes: 0 no return, 1 dazzled, 2 implausible, the others
/// reserved (SICK's operating instructions, "LMDscandata – reserved values").
pub const FIRST_DISTANCE: u16 = 16;

/// Values over equally spaced angles.
///
/// | bytes | field | |
/// |---|---|---|
/// | 5 | name | `DIST1` to `DIST5`, `RSSI1`, `ANGL1`, `VANG1`, … |
/// | 4 | scale factor | f32 |
/// | 4 | scale offset | f32 |
/// | 4 | start angle | i32, 1/10000° |
/// | 2 | angular step | u16, 1/10000° |
/// | 2 | count | u16 |
/// | count · width | values | u16 or u8 |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Channel<'a> {
    pub name: [u8; 5],
    /// Factor for the raw value; distances are then in millimetres.
    pub scale_factor: f32,
    pub scale_offset: f32,
    /// Angle of the first value, in the device's convention.
    pub start_angle_raw_1e4_deg: i32,
    pub step_raw_1e4_deg: u16,
    /// Values by increasing angle; at most 65535 can be sent.
    pub values: Values<'a>,
}

impl<'a> Channel<'a> {
    fn read(cursor: &mut Cursor<'a>, width: usize) -> Result<Self, SickError> {
        let offset = cursor.offset();
        let name = cursor.letters("channel name")?;
        if !name.iter().all(u8::is_ascii_alphanumeric) {
            let found = name.escape_ascii();
            return Err(field_error(
                "channel name",
                offset,
                &found,
                "five letters or digits",
            ));
        }
        Ok(Channel {
            name,
            scale_factor: cursor.f32("scale factor")?,
            scale_offset: cursor.f32("scale offset")?,
            start_angle_raw_1e4_deg: cursor.i32("start angle")?,
            step_raw_1e4_deg: cursor.u16("angular step")?,
            values: {
                let count = usize::from(cursor.u16("count")?);
                Values::read(cursor, count, width)?
            },
        })
    }

    fn write(&self, writer: &mut Writer<'_>, width: usize) {
        writer.characters(&self.name);
        writer.f32(self.scale_factor);
        writer.f32(self.scale_offset);
        writer.i32(self.start_angle_raw_1e4_deg);
        writer.u16(self.step_raw_1e4_deg);
        writer.u16(self.values.len() as u16);
        self.values.write(writer, width);
    }

    /// Returns the distances in metres; `None` for a code in place of a distance.
    pub fn distances_m(&self) -> impl Iterator<Item = Option<f64>> {
        let (scale, offset) = (f64::from(self.scale_factor), f64::from(self.scale_offset));
        self.values.map(move |raw| {
            (raw >= FIRST_DISTANCE).then(|| (f64::from(raw) * scale + offset) * 1e-3)
        })
    }
}

/// A block of channels of one width; iterating reads them in place.
///
/// | bytes | field | |
/// |---|---|---|
/// | 2 | count | u16 |
/// | … | channels | see [`Channel`] |
#[derive(Debug, Clone)]
pub struct Channels<'a>(Place<'a>);

#[derive(Debug, Clone)]
enum Place<'a> {
    /// Encoded in a telegram.
    Read {
        left: u16,
        width: usize,
        cursor: Cursor<'a>,
    },
    /// A slice in memory.
    Listed(&'a [Channel<'a>]),
}

impl<'a> Channels<'a> {
    /// Parses the block once to validate it; `width` is the number of bytes per value.
    pub(super) fn read(
        cursor: &mut Cursor<'a>,
        field: &'static str,
        width: usize,
    ) -> Result<Self, SickError> {
        let left = cursor.u16(field)?;
        let block = Place::Read {
            left,
            width,
            cursor: *cursor,
        };
        for _ in 0..left {
            Channel::read(cursor, width)?;
        }
        Ok(Channels(block))
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>, width: usize) {
        writer.u16(self.clone().count() as u16);
        for channel in self.clone() {
            channel.write(writer, width);
        }
    }

    pub fn named(&self, name: &[u8; 5]) -> Option<Channel<'a>> {
        self.clone().find(|channel| &channel.name == name)
    }
}

impl Default for Channels<'_> {
    fn default() -> Self {
        Channels(Place::Listed(&[]))
    }
}

impl<'a> From<&'a [Channel<'a>]> for Channels<'a> {
    fn from(channels: &'a [Channel<'a>]) -> Self {
        Channels(Place::Listed(channels))
    }
}

impl PartialEq for Channels<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.clone().eq(other.clone())
    }
}

impl<'a> Iterator for Channels<'a> {
    type Item = Channel<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        match &mut self.0 {
            Place::Read {
                left,
                width,
                cursor,
            } => {
                *left = left.checked_sub(1)?;
                Channel::read(cursor, *width).ok()
            }
            Place::Listed(channels) => {
                let (first, rest) = channels.split_first()?;
                *channels = rest;
                Some(*first)
            }
        }
    }
}
