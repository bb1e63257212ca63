//! Points of a lidar of several rings over a map whose obstacles stand as walls on a floor.

use ros::{Header, PointCloud2, PointField};
use simulation::Bearings;

pub(super) const TOPIC: &str = "/points";

/// Height of the lidar over the floor, in metres.
pub(super) const HEIGHT_M: f64 = 0.4;

/// Elevation of the highest ring, in degrees; that of the lowest is its opposite, as of a VLP-16.
const ELEVATION_DEG: f64 = 15.0;

/// Size of a point: x, y, z as `float32`, in metres, and t as `uint32`, nanoseconds.
const POINT_BYTES: u32 = 16;

/// Converts the horizontal distances of all rings, the lowest one first, to a cloud with a row for
/// each. A ring that meets the floor before a wall has its point there; one without a return has
/// none finite.
pub(super) fn cloud<'a>(
    header: Header,
    bearings: Bearings,
    time_increment_s: f32,
    is_upside_down: bool,
    rings: impl Iterator<Item = &'a Vec<f32>> + Clone,
) -> PointCloud2 {
    let count = rings.clone().count();
    let mut data = Vec::with_capacity(count * bearings.count * POINT_BYTES as usize);
    let to_floor_m = if is_upside_down { HEIGHT_M } else { -HEIGHT_M };
    for (ring, ranges) in rings.enumerate() {
        let share = 2.0 * ring as f64 / (count - 1).max(1) as f64 - 1.0;
        let slope = (share * ELEVATION_DEG).to_radians().tan();
        let floor_m = Some(to_floor_m / slope).filter(|metres| *metres > 0.0);
        for (beam, range) in ranges.iter().enumerate() {
            let range_m = f64::from(*range).min(floor_m.unwrap_or(f64::INFINITY));
            let range_m = if range.is_nan() { f64::NAN } else { range_m };
            let (sin, cos) = bearings.get(beam).sin_cos();
            for metres in [range_m * cos, range_m * sin, range_m * slope] {
                data.extend((metres as f32).to_le_bytes());
            }
            let time_ns = beam as f64 * f64::from(time_increment_s) * 1e9;
            data.extend((time_ns as u32).to_le_bytes());
        }
    }
    let field = |(i, name): (u32, &str)| PointField {
        name: name.to_owned(),
        offset: 4 * i,
        datatype: if name == "t" { 6 } else { 7 },
        count: 1,
    };
    PointCloud2 {
        header,
        height: count as u32,
        width: bearings.count as u32,
        fields: (0..).zip(["x", "y", "z", "t"]).map(field).collect(),
        point_step: POINT_BYTES,
        row_step: POINT_BYTES * bearings.count as u32,
        data,
        ..PointCloud2::default()
    }
}
