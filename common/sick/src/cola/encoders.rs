//! Incremental encoders on a device's inputs.

use super::cursor::Cursor;
use super::writer::Writer;
use crate::SickError;

/// Reading of an incremental encoder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Encoder {
    /// Position in ticks.
    pub position: u32,
    /// Speed in ticks per millimetre.
    pub speed: u16,
}

/// Sequence of encoders; iterating decodes them in place.
#[derive(Debug, Clone)]
pub struct Encoders<'a>(Place<'a>);

#[derive(Debug, Clone)]
enum Place<'a> {
    /// Encoded in a telegram.
    Read { left: u16, cursor: Cursor<'a> },
    /// A slice in memory.
    Listed(&'a [Encoder]),
}

impl Encoder {
    fn read(cursor: &mut Cursor<'_>) -> Result<Self, SickError> {
        Ok(Encoder {
            position: cursor.u32("encoder position")?,
            speed: cursor.u16("encoder speed")?,
        })
    }
}

impl<'a> Encoders<'a> {
    pub(super) fn read(cursor: &mut Cursor<'a>) -> Result<Self, SickError> {
        let left = cursor.u16_upto("number of encoders", 3, "0 to 3")?;
        let encoders = Place::Read {
            left,
            cursor: cursor.clone(),
        };
        for _ in 0..left {
            Encoder::read(cursor)?;
        }
        Ok(Encoders(encoders))
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>) {
        writer.u16(self.clone().count() as u16);
        for encoder in self.clone() {
            writer.u32(encoder.position);
            writer.u16(encoder.speed);
        }
    }
}

impl<'a> From<&'a [Encoder]> for Encoders<'a> {
    /// Keeps the first three encoders; no more can be sent.
    fn from(encoders: &'a [Encoder]) -> Self {
        Encoders(Place::Listed(encoders.get(..3).unwrap_or(encoders)))
    }
}

impl PartialEq for Encoders<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.clone().eq(other.clone())
    }
}

impl Iterator for Encoders<'_> {
    type Item = Encoder;

    fn next(&mut self) -> Option<Encoder> {
        match &mut self.0 {
            Place::Read { left, cursor } => {
                *left = left.checked_sub(1)?;
                Encoder::read(cursor).ok()
            }
            Place::Listed(encoders) => {
                let (first, rest) = encoders.split_first()?;
                *encoders = rest;
                Some(*first)
            }
        }
    }
}
