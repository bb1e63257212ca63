//! JSON form of requests and answers, for programs without the message types.

use bytemuck::Zeroable;
use geometry::Pose;
use messages::{FrameName, HypothesesHeader, Hypothesis, Pose2, ScanHeader, Stamp, Verdict};
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

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Placed {
    x: f64,
    y: f64,
    yaw: f64,
}

/// Result of a search.
#[derive(Debug, Serialize)]
struct Answer {
    stamp_ns: i64,
    /// Map id in hexadecimal, because JSON numbers do not hold 64 bits safely.
    map_id: String,
    /// Name of the map if several are searched, else null.
    map: Option<String>,
    verdict: String,
    /// Number of other places that fit about as well.
    alternatives: u32,
    /// Probability of the best place, 0..=1.
    confidence: f32,
    /// Share of the beams that agree with the best place.
    inlier_share: f32,
    /// Time of the search, milliseconds.
    search_ms: f64,
    /// Places, best first.
    hypotheses: Vec<Place>,
}

#[derive(Debug, Serialize)]
struct Place {
    /// Name of the map if several are searched, else null.
    map: Option<String>,
    /// Pose `map_from_laser`, metres and radians.
    #[serde(flatten)]
    laser: Placed,
    /// Covariance of x, y and yaw, row by row.
    covariance: [f64; 9],
    score: f32,
    probability: f32,
    /// Pose of the base, if the request gave the laser's mount.
    map_from_base: Option<Placed>,
}

/// Parses the scan in `payload`.
///
/// # Errors
/// If it is not JSON, lacks a key or has an unknown one.
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

/// Returns the answer as a JSON object.
///
/// # Errors
/// Not expected for plain numbers.
pub(crate) fn write(
    header: &HypothesesHeader,
    hypotheses: &[Hypothesis],
    name_of: &dyn Fn(u64) -> Option<String>,
) -> Result<Vec<u8>, serde_json::Error> {
    let verdict = Verdict::from_code(header.verdict).unwrap_or(Verdict::NoScan);
    let place = |place: &Hypothesis| Place {
        map: name_of(place.map_id),
        laser: place.map_from_laser.into(),
        covariance: place.covariance,
        score: place.score,
        probability: place.probability,
        map_from_base: (header.mount_known == 1).then(|| place.map_from_base.into()),
    };
    serde_json::to_vec(&Answer {
        stamp_ns: header.stamp.measured_ns,
        map_id: format!("{:016x}", header.map_id),
        map: name_of(header.map_id),
        verdict: verdict.to_string(),
        alternatives: header.alternatives,
        confidence: header.confidence,
        inlier_share: header.inlier_share,
        search_ms: header.search_ns as f64 / 1e6,
        hypotheses: hypotheses.iter().map(place).collect(),
    })
}

impl From<Placed> for Pose2 {
    fn from(Placed { x, y, yaw }: Placed) -> Self {
        Pose2 { x, y, yaw }
    }
}

impl From<Pose2> for Placed {
    fn from(Pose2 { x, y, yaw }: Pose2) -> Self {
        Placed { x, y, yaw }
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

    #[test]
    fn an_answer_is_one_object() {
        let header = HypothesesHeader {
            map_id: 0xab,
            verdict: Verdict::Unique as u32,
            mount_known: 1,
            ..Zeroable::zeroed()
        };
        let place = Hypothesis {
            map_id: 0xab,
            map_from_laser: Pose2 {
                x: 1.0,
                y: 2.0,
                yaw: 0.5,
            },
            ..Zeroable::zeroed()
        };
        let text = write(&header, &[place], &|id| {
            (id == 0xab).then(|| "attic".into())
        })
        .unwrap();
        let value: serde_json::Value = serde_json::from_slice(&text).unwrap();
        assert_eq!(value["map_id"], "00000000000000ab");
        assert_eq!(
            (&value["map"], &value["hypotheses"][0]["map"]),
            (&"attic".into(), &"attic".into())
        );
        assert_eq!(value["verdict"], "Unique");
        assert_eq!(value["hypotheses"][0]["yaw"], 0.5);
        assert_eq!(value["hypotheses"][0]["map_from_base"]["x"], 0.0);
    }
}
