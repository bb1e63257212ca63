//! `sensor_msgs/msg/PointCloud2`: points as bytes, laid out as the message itself says.
//!
//! The time of a point is optional and has no standard name. These are read:
//!
//! | field | written by |
//! |---|---|
//! | `t`, `offset_time` | Ouster, Livox: whole nanoseconds since the stamp |
//! | `time`, `time_stamp` | Velodyne: seconds since the stamp |
//! | `timestamp` | Hesai, `RoboSense`: seconds since 1970; `livox_ros_driver2`: nanoseconds |

use super::{ConversionError, Header};

declare! {
    /// A field of each point.
    part PointField = "sensor_msgs/PointField" with "\
uint8 INT8=1
uint8 UINT8=2
uint8 INT16=3
uint8 UINT16=4
uint8 INT32=5
uint8 UINT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
" [] {
        name: String,
        /// Bytes from the start of the point.
        offset: u32,
        /// One of the constants above.
        datatype: u8,
        /// Number of values; some writers leave it at 0 for one.
        count: u32,
    }

    /// A cloud of points in the frame of its header.
    message PointCloud2 = "sensor_msgs/msg/PointCloud2" [Header, PointField] {
        header: Header,
        /// Number of rows; 1 if the cloud is not organised.
        height: u32,
        /// Number of points of a row.
        width: u32,
        fields: Vec<PointField>,
        /// Byte order of the points, whatever that of the message is.
        is_bigendian: bool,
        /// Size of a point, in bytes.
        point_step: u32,
        /// Size of a row, in bytes.
        row_step: u32,
        data: Vec<u8>,
        /// True if there are no invalid points; not relied on.
        is_dense: bool,
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloudPoint {
    /// Place in the frame of the sensor, in metres; not finite or all zero without a return.
    pub place: [f64; 3],
    /// Time of measurement after the stamp of the cloud, in seconds; NaN if unknown.
    pub time_s: f64,
}

const TIMES: [&str; 5] = ["t", "time", "offset_time", "timestamp", "time_stamp"];

/// Floats above this are nanoseconds: as seconds, they are after the year 5000.
const MAX_SECONDS: f64 = 1e11;

/// Times above this are counted from 1970, not from the stamp: 11 days, in seconds.
const MAX_AFTER_STAMP_S: f64 = 1e6;

/// Offset of a number in a point, and its datatype.
#[derive(Debug, Clone, Copy)]
struct Number {
    at: usize,
    datatype: u8,
}

impl PointCloud2 {
    /// Iterates over all points, row by row.
    pub fn points(&self) -> Result<impl Iterator<Item = CloudPoint>, ConversionError> {
        let [x, y, z] = [self.place("x")?, self.place("y")?, self.place("z")?];
        let time = TIMES.iter().find_map(|name| self.number(name, 5..=8));
        let (point, row) = (self.point_step as usize, self.row_step as usize);
        let length = point.checked_mul(self.width as usize);
        let rows = if self.width == 0 {
            0
        } else {
            self.height as usize
        };
        let is_apart = rows < 2 || length.is_some_and(|length| row >= length);
        let end = row
            .checked_mul(rows.saturating_sub(1))
            .and_then(|before| before.checked_add(length?))
            .filter(|end| rows == 0 || (is_apart && *end <= self.data.len()));
        let (Some(_), Some(length)) = (end, length) else {
            return Err(ConversionError(format!(
                "the point cloud has {} bytes: {} rows of {} points, {point} bytes a point and \
                 {row} a row, do not fit",
                self.data.len(),
                self.height,
                self.width
            )));
        };
        let stamp_ns = self.header.stamp.as_ns();
        let point_of = move |bytes: &[u8]| CloudPoint {
            place: [x, y, z].map(|number| self.value(number, bytes)),
            time_s: time.map_or(f64::NAN, |number| {
                after_stamp_s(self.value(number, bytes), number.datatype < 7, stamp_ns)
            }),
        };
        // The sizes were checked: every slice is there, and a point has at least twelve bytes.
        let rows = (0..rows).filter_map(move |i| self.data.get(i * row..i * row + length));
        Ok(rows
            .flat_map(move |row| row.chunks_exact(point))
            .map(point_of))
    }

    fn place(&self, field: &'static str) -> Result<Number, ConversionError> {
        let describe = |f: &PointField| {
            let PointField { name, offset, .. } = f;
            format!("{name} of {} × {} at {offset}", f.count, f.datatype)
        };
        self.number(field, 7..=8).ok_or_else(|| {
            let found: Vec<String> = self.fields.iter().take(16).map(describe).collect();
            ConversionError(format!(
                "the point cloud has no usable field {field}: allowed is one float32 (7) or float64 \
                 (8) within its points of {} bytes; it has {}",
                self.point_step,
                found.join(", ")
            ))
        })
    }

    /// Finds a field of a single number, of one of the datatypes from 32 bits.
    fn number(&self, name: &str, datatypes: std::ops::RangeInclusive<u8>) -> Option<Number> {
        let field = self.fields.iter().find(|field| field.name == name)?;
        let size = if field.datatype == 8 { 8 } else { 4 };
        let fits = field.offset.checked_add(size)? <= self.point_step;
        (fits && field.count < 2 && datatypes.contains(&field.datatype)).then_some(Number {
            at: field.offset as usize,
            datatype: field.datatype,
        })
    }

    fn value(&self, number: Number, point: &[u8]) -> f64 {
        let bytes = |size| point.get(number.at..number.at + size).unwrap_or_default();
        if number.datatype == 8 {
            let word: [u8; 8] = bytes(8).try_into().unwrap_or_default();
            return match self.is_bigendian {
                true => f64::from_be_bytes(word),
                false => f64::from_le_bytes(word),
            };
        }
        let word: [u8; 4] = bytes(4).try_into().unwrap_or_default();
        let word = match self.is_bigendian {
            true => u32::from_be_bytes(word),
            false => u32::from_le_bytes(word),
        };
        match number.datatype {
            5 => f64::from(word.cast_signed()),
            6 => f64::from(word),
            _ => f64::from(f32::from_bits(word)),
        }
    }
}

/// Converts the time of a point to seconds after the stamp of its cloud.
fn after_stamp_s(time: f64, is_whole_ns: bool, stamp_ns: i64) -> f64 {
    let is_ns = is_whole_ns || time.abs() > MAX_SECONDS;
    let time_s = if is_ns { time * 1e-9 } else { time };
    match time_s.abs() > MAX_AFTER_STAMP_S {
        true => time_s - stamp_ns as f64 * 1e-9,
        false => time_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(name: &str, offset: u32, datatype: u8) -> PointField {
        PointField {
            name: name.to_owned(),
            offset,
            datatype,
            count: 1,
        }
    }

    /// Two rows of one point, with four bytes after each row.
    fn organised(is_bigendian: bool) -> PointCloud2 {
        let word = |word: u32| match is_bigendian {
            true => word.to_be_bytes(),
            false => word.to_le_bytes(),
        };
        let mut data = Vec::new();
        for point in [[1.0f32, 2.0, 3.0], [4.0, 5.0, 6.0]] {
            data.extend(point.into_iter().flat_map(|number| word(number.to_bits())));
            data.extend(word(1_000_000));
            data.extend([9; 4]);
        }
        PointCloud2 {
            height: 2,
            width: 1,
            fields: vec![
                field("x", 0, 7),
                field("y", 4, 7),
                field("z", 8, 7),
                field("t", 12, 6),
            ],
            is_bigendian,
            point_step: 16,
            row_step: 20,
            data,
            ..PointCloud2::default()
        }
    }

    #[test]
    fn both_byte_orders_and_rows_are_read() {
        for is_bigendian in [false, true] {
            let cloud = organised(is_bigendian);
            let points: Vec<CloudPoint> = cloud.points().unwrap().collect();
            let places: Vec<[f64; 3]> = points.iter().map(|point| point.place).collect();
            assert_eq!(places, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
            assert_eq!(points[1].time_s, 0.001);
        }
    }

    #[test]
    fn times_are_of_the_stamp_or_of_1970_in_seconds_or_nanoseconds() {
        let stamp_ns = 1_700_000_000_000_000_000;
        assert_eq!(after_stamp_s(-0.05, false, stamp_ns), -0.05);
        assert_eq!(after_stamp_s(5e7, true, stamp_ns), 0.05);
        for since_1970 in [1_700_000_000.25, 1_700_000_000_250_000_000.0] {
            // 64-bit floats represent the time to half a microsecond.
            assert!((after_stamp_s(since_1970, false, stamp_ns) - 0.25).abs() < 1e-6);
        }
    }

    #[test]
    fn sizes_and_fields_that_do_not_fit_are_refused() {
        let refuse = |spoil: fn(&mut PointCloud2), expected: &str| {
            let mut cloud = organised(false);
            spoil(&mut cloud);
            let error = cloud.points().err().expect("refused").to_string();
            assert!(error.contains(expected), "{error}");
        };
        refuse(|cloud| cloud.height = 3, "has 40 bytes: 3 rows of 1");
        refuse(|cloud| cloud.width = u32::MAX, "do not fit");
        refuse(|cloud| cloud.row_step = u32::MAX, "4294967295 a row");
        refuse(|cloud| cloud.row_step = 15, "15 a row");
        refuse(|cloud| cloud.point_step = 11, "no usable field z");
        refuse(|cloud| cloud.fields[0].offset = u32::MAX, "at 4294967295");
        refuse(|cloud| cloud.fields[1].datatype = 6, "no usable field y");
        refuse(|cloud| cloud.fields[2].count = 2, "z of 2 × 7 at 8");
        refuse(|cloud| cloud.fields.clear(), "no usable field x");
        let mut none = organised(false);
        (none.height, none.width, none.row_step) = (0, u32::MAX, u32::MAX);
        assert_eq!(none.points().unwrap().count(), 0);
    }

    proptest::proptest! {
        #[test]
        fn no_cloud_makes_it_panic(
            sizes in proptest::array::uniform4(0u32..40),
            offset in 0u32..40,
            data in proptest::collection::vec(proptest::num::u8::ANY, 0..200),
        ) {
            let [height, width, point_step, row_step] = sizes;
            let mut cloud = PointCloud2 { height, width, point_step, row_step, data, ..organised(true) };
            cloud.fields[1].offset = offset;
            if let Ok(points) = cloud.points() {
                proptest::prop_assert_eq!(points.count() as u32, height * width);
            }
        }
    }
}
