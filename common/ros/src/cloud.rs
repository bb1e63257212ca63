//! A point cloud as a level laser: of all points within a band of heights over the floor, the
//! nearest at each bearing.
//!
//! A bearing without such a point is NaN: nothing is known there, because a lidar also has no point
//! where its rings pass above or below the band.

use std::f64::consts::{PI, TAU};
use std::str::FromStr;

use crate::livox::{self, CustomMsg};
use crate::sweep::Sweep;
use crate::{
    CloudMount, CloudPoint, ConversionError, Header, LaserScan, PointCloud2, RosMessage, Time, cdr,
};

/// Options that make a point cloud the laser.
#[derive(Debug, Clone, PartialEq, Default, clap::Args)]
pub struct CloudOptions {
    /// The topic of a point cloud, which is taken as the only laser: sensor_msgs/PointCloud2, or the
    /// CustomMsg of a Livox driver in recordings
    #[arg(long, value_name = "TOPIC")]
    pub cloud_topic: Option<String>,

    /// Heights over the floor that this laser sees, metres: those at which the map was made. The
    /// floor is that of base_footprint, else the base frame's height zero
    #[arg(
        long,
        value_name = "MIN,MAX",
        default_value = "0.2,0.6",
        requires = "cloud_topic",
        allow_hyphen_values = true
    )]
    pub heights: Heights,

    /// Pose of the lidar over the floor, metres and degrees, where /tf_static does not have it
    #[arg(
        long,
        value_name = "X,Y,Z,YAW_DEG[,PITCH_DEG,ROLL_DEG]",
        requires = "cloud_topic",
        allow_hyphen_values = true
    )]
    pub cloud_mount: Option<CloudMount>,
}

/// A band of heights over the floor, in metres, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heights {
    pub min_m: f64,
    pub max_m: f64,
}

impl Default for Heights {
    fn default() -> Self {
        Heights {
            min_m: 0.2,
            max_m: 0.6,
        }
    }
}

impl FromStr for Heights {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |word: &str| word.trim().parse().ok().filter(|n: &f64| n.is_finite());
        let heights = text
            .split_once(',')
            .and_then(|(min, max)| Some((number(min)?, number(max)?)));
        match heights {
            Some((min_m, max_m)) if min_m < max_m => Ok(Heights { min_m, max_m }),
            _ => Err("expected are two heights in metres, the lower one first: MIN,MAX".into()),
        }
    }
}

impl std::fmt::Display for Heights {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{},{}", self.min_m, self.max_m)
    }
}

/// A point cloud of any of the known types.
#[derive(Debug, Clone, PartialEq)]
pub enum Cloud {
    Points(PointCloud2),
    Livox(CustomMsg),
}

impl Cloud {
    /// True if this is the schema of a point cloud in ROS 2.
    pub fn is_schema(schema: &str) -> bool {
        schema == PointCloud2::SCHEMA || livox::SCHEMAS.contains(&schema)
    }

    /// Decodes the bytes of a message with such a schema.
    pub fn decode(schema: &str, bytes: &[u8]) -> Result<Self, String> {
        match schema == PointCloud2::SCHEMA {
            true => cdr::decode(bytes).map(Cloud::Points),
            false => cdr::decode(bytes).map(Cloud::Livox),
        }
    }

    pub fn header(&self) -> &Header {
        match self {
            Cloud::Points(cloud) => &cloud.header,
            Cloud::Livox(cloud) => &cloud.header,
        }
    }

    /// Converts to the scan of the level laser [`CloudMount::planar`], in the frame of the cloud.
    pub fn scan(&self, mount: &CloudMount, heights: Heights) -> Result<LaserScan, ConversionError> {
        let header = self.header();
        Ok(match self {
            Cloud::Points(cloud) => scan(header, cloud.points()?, mount, heights),
            Cloud::Livox(cloud) => scan(header, cloud.points(), mount, heights),
        })
    }
}

/// Number of bearings: one every quarter of a degree. Lidars turn by 0.1 to 0.4 degrees from point
/// to point, and a wider beam would pull slanted walls nearer.
const BEAMS: usize = 1440;

/// Bearing of beam 0, radians; beam `i` is `i` steps further counter-clockwise.
const FIRST: f64 = -PI;

const STEP: f64 = TAU / BEAMS as f64;

/// Largest range, in metres: beyond every lidar's, which have applied their own limits.
const RANGE_MAX_M: f32 = 1000.0;

/// A reading is the mean of the nearest point and of those within this distance behind it, metres:
/// the nearest alone would be pulled nearer by noise where several rings see a wall.
const SURFACE_M: f64 = 0.1;

/// The nearest surface of a beam.
#[derive(Debug, Clone, Copy)]
struct Nearest {
    range_m: f64,
    /// Time of the nearest point after the stamp, in seconds.
    time_s: f64,
    /// Sum of the ranges that count, in metres, and their number.
    sum_m: f64,
    count: f64,
}

fn scan(
    header: &Header,
    points: impl Iterator<Item = CloudPoint>,
    mount: &CloudMount,
    heights: Heights,
) -> LaserScan {
    let mut beams = [Nearest {
        range_m: f64::NAN,
        time_s: f64::NAN,
        sum_m: 0.0,
        count: 0.0,
    }; BEAMS];
    let mut seen = Vec::new();
    for point in points {
        let place = mount.level(point.place);
        let range_m = place.x.hypot(place.y);
        let is_seen = place.z >= heights.min_m && place.z <= heights.max_m;
        // Drivers write a missing return as NaN or as the sensor's own place.
        if !(is_seen && range_m.is_finite()) || point.place == [0.0; 3] {
            continue;
        }
        let steps = (place.y.atan2(place.x) - FIRST) / STEP;
        let beam = steps.round() as usize % BEAMS;
        let nearest = &mut beams[beam];
        if nearest.range_m.is_nan() || range_m < nearest.range_m {
            nearest.range_m = range_m;
            nearest.time_s = point.time_s;
        }
        seen.push((beam, range_m));
    }
    for (beam, range_m) in seen {
        let nearest = &mut beams[beam];
        if range_m <= nearest.range_m + SURFACE_M {
            nearest.sum_m += range_m;
            nearest.count += 1.0;
        }
    }
    let timed = (0..)
        .zip(&beams)
        .filter(|(_, beam)| beam.time_s.is_finite());
    let timed: Vec<(f64, f64)> = timed
        .map(|(i, beam)| (beam.time_s, FIRST + f64::from(i) * STEP))
        .collect();
    ordered(header, &beams, Sweep::of(timed))
}

/// Scan with its beams in the order of the sweep.
fn ordered(header: &Header, beams: &[Nearest; BEAMS], sweep: Sweep) -> LaserScan {
    let steps = ((sweep.bearing - FIRST) / STEP).round() as i64;
    let first = steps.rem_euclid(BEAMS as i64) as usize;
    let index = |beam| match sweep.is_clockwise {
        true => (first + BEAMS - beam) % BEAMS,
        false => (first + beam) % BEAMS,
    };
    let increment = if sweep.is_clockwise { -STEP } else { STEP };
    let angle_min = FIRST + first as f64 * STEP;
    let stamp_ns = header.stamp.as_ns() + (sweep.start_s * 1e9).round() as i64;
    // NaN where nothing was counted.
    let range = |beam: &Nearest| (beam.sum_m / beam.count) as f32;
    LaserScan {
        header: Header {
            stamp: Time::from_ns(stamp_ns).unwrap_or(header.stamp),
            frame_id: header.frame_id.clone(),
        },
        angle_min: angle_min as f32,
        angle_max: (angle_min + (BEAMS - 1) as f64 * increment) as f32,
        angle_increment: increment as f32,
        time_increment: (STEP * sweep.s_per_rad) as f32,
        range_max: RANGE_MAX_M,
        ranges: (0..BEAMS).map(|beam| range(&beams[index(beam)])).collect(),
        ..LaserScan::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CustomPoint;

    fn cloud(places: &[[f32; 3]]) -> Cloud {
        let point = |&[x, y, z]: &[f32; 3]| CustomPoint {
            x,
            y,
            z,
            ..CustomPoint::default()
        };
        Cloud::Livox(CustomMsg {
            header: Header::new(Time { sec: 7, nanosec: 0 }, "lidar"),
            points: places.iter().map(point).collect(),
            ..CustomMsg::default()
        })
    }

    fn heights(text: &str) -> Heights {
        text.parse().unwrap()
    }

    /// Beams with a range.
    fn seen(scan: &LaserScan) -> Vec<(usize, f32)> {
        let ranges = scan.ranges.iter().copied().enumerate();
        ranges.filter(|(_, range)| !range.is_nan()).collect()
    }

    #[test]
    fn the_nearest_point_of_the_band_counts() {
        let cloud = cloud(&[
            [3.0, 0.0, -0.5],
            // One surface, seen by two rings.
            [2.0, 0.0, -0.6],
            [2.0625, 0.0, -0.7],
            // Above the band, below it, and no returns.
            [1.0, 0.0, 0.0],
            [1.0, 0.0, -0.95],
            [0.0, 0.0, 0.0],
            [f32::NAN, 0.0, -0.5],
            [-4.0, -0.0, -0.5],
        ]);
        let mount = "0,0,1,90".parse().unwrap();
        let scan = cloud.scan(&mount, heights("0.2,0.6")).unwrap();
        assert_eq!(seen(&scan), [(0, 4.0), (BEAMS / 2, 2.03125)]);
        assert_eq!(
            (scan.header.stamp.sec, &*scan.header.frame_id),
            (7, "lidar")
        );
        assert_eq!(scan.time_increment, 0.0);
        let origin = self::cloud(&[[0.0; 3]]);
        let around: CloudMount = "0,0,0,0".parse().unwrap();
        let scan = origin.scan(&around, heights("-1,1")).unwrap();
        assert!(seen(&scan).is_empty());
    }

    #[test]
    fn a_tilt_moves_points_into_the_band() {
        let cloud = cloud(&[[5.0, 0.0, 0.0]]);
        let range = |mount: &str| {
            let scan = cloud.scan(&mount.parse().unwrap(), heights("0.1,0.5"));
            scan.unwrap().ranges[BEAMS / 2]
        };
        assert!(range("0,0,1,0").is_nan());
        // Ten degrees nose down, the point is 0.87 m lower.
        let expected = 5.0 * 10f32.to_radians().cos();
        assert!((range("0,0,1,0,10,0") - expected).abs() < 1e-5);
    }

    #[test]
    fn a_lidar_that_turns_clockwise_is_put_in_the_order_of_time() {
        let mut cloud = cloud(&[]);
        let Cloud::Livox(message) = &mut cloud else {
            return;
        };
        for i in 0..720u32 {
            // From 90 degrees clockwise, a turn in 0.1 s.
            let bearing = (90.0 - 0.5 * f64::from(i)).to_radians();
            message.points.push(CustomPoint {
                offset_time: 1_000_000 + i * 138_889,
                x: 5.0 * bearing.cos() as f32,
                y: 5.0 * bearing.sin() as f32,
                ..CustomPoint::default()
            });
        }
        let scan = cloud.scan(&"0,0,0.4,0".parse().unwrap(), heights("0,1"));
        let scan = scan.unwrap();
        // A hundredth of a turn before the first point.
        assert!(
            (scan.angle_min - 93.6f32.to_radians()).abs() < 5e-3,
            "{}",
            scan.angle_min
        );
        assert!((scan.angle_increment + 0.25f32.to_radians()).abs() < 1e-6);
        assert!((scan.time_increment * 1440.0 - 0.1).abs() < 1e-4);
        assert_eq!(scan.header.stamp.as_ns(), 7_000_000_000);
        assert_eq!(seen(&scan).len(), 720);
    }

    #[test]
    fn a_band_is_two_heights_in_order() {
        assert_eq!(heights("-0.1, 2").to_string(), "-0.1,2");
        for wrong in ["", "1", "1,1", "2,1", "0,inf", "0,1,2"] {
            assert!(wrong.parse::<Heights>().is_err(), "{wrong}");
        }
    }
}
