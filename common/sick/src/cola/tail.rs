//! Optional blocks at the end of a scan telegram.

use chrono::{DateTime, Datelike, NaiveDate, Timelike};

use super::writer::Writer;
use crate::SickError;
use crate::cursor::Cursor;

/// Clock of the device; starts in 1970 if it was never set.
///
/// | bytes | field | |
/// |---|---|---|
/// | 2 | year | u16 |
/// | 1 each | month, day, hour, minute, second | u8; a second may be 60 |
/// | 4 | microsecond | u32 |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DeviceTime {
    pub year: u16,
    pub month: u8,
    pub day: u8,
    pub hour: u8,
    pub minute: u8,
    pub second: u8,
    pub microsecond: u32,
}

impl DeviceTime {
    /// Converts microseconds since 1970 (UTC); `None` outside the years 0 to 65535.
    pub fn from_unix_us(unix_us: i64) -> Option<Self> {
        let time = DateTime::from_timestamp_micros(unix_us)?;
        Some(DeviceTime {
            year: u16::try_from(time.year()).ok()?,
            month: time.month() as u8,
            day: time.day() as u8,
            hour: time.hour() as u8,
            minute: time.minute() as u8,
            second: time.second() as u8,
            microsecond: time.timestamp_subsec_micros(),
        })
    }

    /// Returns microseconds since 1970, taking the clock as UTC; `None` if the date does not exist,
    /// as on devices whose clock was never set. Second 60 is the first second of the next minute.
    pub fn unix_us(&self) -> Option<i64> {
        let (month, day) = (self.month.into(), self.day.into());
        let date = NaiveDate::from_ymd_opt(self.year.into(), month, day)?;
        let minute = date.and_hms_opt(self.hour.into(), self.minute.into(), 0)?;
        let within = i64::from(self.second) * 1_000_000 + i64::from(self.microsecond);
        Some(minute.and_utc().timestamp_micros() + within)
    }

    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<Self, SickError> {
        Ok(DeviceTime {
            year: cursor.u16("year")?,
            month: cursor.u8_upto("month", 12, "0 to 12")?,
            day: cursor.u8_upto("day", 31, "0 to 31")?,
            hour: cursor.u8_upto("hour", 23, "0 to 23")?,
            minute: cursor.u8_upto("minute", 59, "0 to 59")?,
            second: cursor.u8_upto("second", 60, "0 to 60")?,
            microsecond: {
                let is_below_second = |us: &u32| *us < 1_000_000;
                cursor.checked("microsecond", Cursor::u32, is_below_second, "0 to 999999")?
            },
        })
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>) {
        writer.u16(self.year);
        for value in [self.month, self.day, self.hour, self.minute, self.second] {
            writer.u8(value);
        }
        writer.u32(self.microsecond);
    }
}

/// Skips the incremental encoders on the device's inputs; each has a position (u32, ticks) and a
/// speed (u16, ticks per millimetre).
pub(super) fn skip_encoders(cursor: &mut Cursor<'_>) -> Result<(), SickError> {
    for _ in 0..cursor.u16_upto("number of encoders", 3, "0 to 3")? {
        cursor.u32("encoder position")?;
        cursor.u16("encoder speed")?;
    }
    Ok(())
}

/// Skips the configured mounting position.
///
/// | bytes | field | |
/// |---|---|---|
/// | 3 · 4 | x, y, z | f32 |
/// | 3 · 4 | rotation about x, y, z | f32 |
/// | 1 | kind of rotation | 0 none, 1 pitch, 2 roll, 3 free |
pub(super) fn skip_position(cursor: &mut Cursor<'_>) -> Result<(), SickError> {
    for field in ["position", "rotation"] {
        for _ in 0..3 {
            cursor.f32(field)?;
        }
    }
    cursor.u8_upto("kind of rotation", 3, "0 to 3")?;
    Ok(())
}

/// Skips an event at a fast digital input.
///
/// | bytes | field | |
/// |---|---|---|
/// | 4 | kind | `FDIN` |
/// | 4 | encoder position | u32, ticks |
/// | 4 | time since start-up | u32, µs |
/// | 4 | angle | i32, 1/10000° |
pub(super) fn skip_event(cursor: &mut Cursor<'_>) -> Result<(), SickError> {
    cursor.letters::<4>("kind of event")?;
    cursor.u32("encoder position of the event")?;
    cursor.u32("time of the event")?;
    cursor.i32("angle of the event")?;
    Ok(())
}

/// Reads a name or comment: its length in one byte, then its characters.
pub(super) fn text<'a>(
    cursor: &mut Cursor<'a>,
    field: &'static str,
) -> Result<&'a [u8], SickError> {
    let length = cursor.u8(field)?;
    cursor.characters(field, usize::from(length))
}

/// Writes a name or comment, truncated to 255 characters.
pub(super) fn write_text(text: &[u8], writer: &mut Writer<'_>) {
    let text = text.get(..255).unwrap_or(text);
    writer.u8(text.len() as u8);
    writer.characters(text);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cola::Encoding;

    fn over(bytes: &[u8]) -> Cursor<'_> {
        Cursor::new(Encoding::Binary, bytes, 0)
    }

    #[test]
    fn a_clock_counts_from_1970() {
        let first = DeviceTime {
            year: 1970,
            month: 1,
            day: 1,
            hour: 0,
            minute: 0,
            second: 0,
            microsecond: 0,
        };
        assert_eq!(first.unix_us(), Some(0));
        // `date --date=@1137772793.094057 --utc` is 2006-01-20 15:59:53.
        let drive = DeviceTime::from_unix_us(1_137_772_793_094_057).unwrap();
        let parts = (drive.year, drive.month, drive.day, drive.second);
        assert_eq!(parts, (2006, 1, 20, 53));
        assert_eq!(drive.unix_us(), Some(1_137_772_793_094_057));
        let leap = DeviceTime {
            second: 60,
            ..first
        };
        assert_eq!(leap.unix_us(), Some(60_000_000));
        assert_eq!(DeviceTime { day: 0, ..first }.unix_us(), None);
        assert_eq!(DeviceTime::from_unix_us(i64::MIN), None);
    }

    #[test]
    fn a_clock_out_of_range_is_refused_with_its_place() {
        let mut bytes = [0x07, 0xe8, 2, 29, 23, 59, 59, 0, 0x0f, 0x42, 0x3f];
        let time = DeviceTime::read(&mut over(&bytes)).unwrap();
        assert_eq!((time.year, time.day, time.microsecond), (2024, 29, 999_999));
        bytes[10] += 1;
        let text = DeviceTime::read(&mut over(&bytes)).unwrap_err().to_string();
        assert_eq!(
            text,
            "byte 7 of the telegram: `microsecond` is 1000000, allowed is 0 to 999999"
        );
        bytes[4] = 24;
        let text = DeviceTime::read(&mut over(&bytes)).unwrap_err().to_string();
        assert!(
            text.contains("byte 4") && text.contains("`hour` is 24"),
            "{text}"
        );
    }
}
