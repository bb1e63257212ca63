//! JSON form of requests and answers, for programs without the message types.

use answers::{Candidate, ScanAnswer};
use bytemuck::Zeroable;
use geometry::Pose;
use messages::{FrameName, HypothesesHeader, Hypothesis, Pose2, ScanHeader, Stamp};
use serde::{Deserialize, Serialize};

/// Scan with defaults for optional fields.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Scan {
    /// Time of measurement, nanoseconds since 1970; repeated in the answer.
    #[serde(default)]
    stamp_ns: i64,
    /// Bearing of the first beam, radians counter-clockwise from ahead.
    angle_min: f64,
    /// Angle between consecutive beams, radians, above zero.
    angle_increment: f64,
    /// Shortest valid range, metres; shorter readings are no returns.
    #[serde(default)]
    range_min: f32,
    /// Longest valid range, metres; longer readings are no returns.
    range_max: f32,
    /// Ranges in metres; null for no return.
    ranges: Vec<Option<f32>>,
    /// Pose of the laser on the robot, metres and radians.
    #[serde(default)]
    base_from_laser: Option<Placed>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct Placed {
    x: f64,
    y: f64,
    yaw: f64,
}

#[derive(Debug, Serialize)]
struct Answer {
    stamp_ns: i64,
    #[serde(flatten)]
    answer: ScanAnswer,
    /// Share of the beams that agree with the best place.
    inlier_share: f32,
    /// Places, best first.
    hypotheses: Vec<Candidate>,
}

pub(crate) fn read(
    payload: &[u8],
    now_ns: i64,
) -> Result<(ScanHeader, Vec<f32>), serde_json::Error> {
    let scan: Scan = serde_json::from_slice(payload)?;
    let mount = scan.base_from_laser;
    let header = ScanHeader {
        stamp: Stamp {
            measured_ns: scan.stamp_ns,
            entered_ns: now_ns,
            counter: 0,
        },
        angle_min: scan.angle_min,
        angle_increment: scan.angle_increment,
        range_min_m: scan.range_min,
        range_max_m: scan.range_max,
        base_from_laser: mount.map_or(Pose::IDENTITY.into(), Pose2::from),
        mount_known: mount.is_some().into(),
        frame: FrameName::new("laser"),
        ..ScanHeader::zeroed()
    };
    let ranges = scan.ranges.into_iter();
    Ok((header, ranges.map(|r| r.unwrap_or(f32::INFINITY)).collect()))
}

pub(crate) fn write(
    header: &HypothesesHeader,
    hypotheses: &[Hypothesis],
    name_of: &dyn Fn(u64) -> Option<String>,
) -> Result<Vec<u8>, serde_json::Error> {
    serde_json::to_vec(&Answer {
        stamp_ns: header.stamp.measured_ns,
        answer: ScanAnswer::new(header, hypotheses, name_of),
        inlier_share: header.inlier_share,
        hypotheses: Candidate::all(header, hypotheses, name_of).collect(),
    })
}

impl From<Placed> for Pose2 {
    fn from(Placed { x, y, yaw }: Placed) -> Self {
        Pose2 { x, y, yaw }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scan_needs_little() {
        let text = br#"{"angle_min": -1.5, "angle_increment": 0.01, "range_max": 30,
                        "ranges": [1.5, null, 2]}"#;
        let (header, ranges) = read(text, 77).unwrap();
        assert_eq!(ranges, [1.5, f32::INFINITY, 2.0]);
        assert_eq!((header.angle_min, header.range_max_m), (-1.5, 30.0));
        assert_eq!((header.mount_known, header.stamp.entered_ns), (0, 77));
    }

    #[test]
    fn a_key_too_many_or_a_number_that_is_none_is_refused() {
        for text in [
            r#"{"angle_min": 0, "angle_increment": 1, "range_max": 3}"#,
            r#"{"angle_min": 0, "angle_increment": 1, "range_max": 3, "ranges": [], "x": 1}"#,
            r#"{"angle_min": NaN, "angle_increment": 1, "range_max": 3, "ranges": []}"#,
            r#"{"angle_min": 0, "angle_increment": 1, "range_max": 3, "ranges": ["1"]}"#,
            "[]",
        ] {
            assert!(read(text.as_bytes(), 0).is_err(), "{text}");
        }
    }
}
