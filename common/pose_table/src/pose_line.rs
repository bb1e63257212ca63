//! Output for one scan in a graph with a tracker: its pose, followed by the answer to the scan
//! alone. Pure.

use geometry::{Covariance, ELLIPSE_95};
use messages::{Pose2, PoseHeader, TrackState};
use schemars::JsonSchema;
use serde::Serialize;

use super::frame::Frame;
use super::line::{Line, NS_PER_MS, number, seconds, with_words};

/// The tracker's pose at one scan. Fields of the pose are `None` without a pose.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PoseLine {
    /// Time of the measurement, in nanoseconds since 1970.
    pub stamp_ns: i64,
    /// State of the tracker, or `?` if this version does not know it.
    pub state: &'static str,
    /// Frame whose pose this is.
    pub of: Frame,
    /// Name of the map of the pose, if there are several maps.
    pub map: Option<String>,
    /// Position in the map along x, in metres.
    pub x: Option<f64>,
    /// Position in the map along y, in metres.
    pub y: Option<f64>,
    /// Heading in the map, in degrees counter-clockwise.
    pub heading_deg: Option<f64>,
    /// Pose of the laser in the map, in metres and radians.
    #[schemars(with = "Option<json::schema::Pose>")]
    pub map_from_laser: Option<Pose2>,
    /// Standard deviation of the position along the long axis of its ellipse, in metres.
    pub deviation_m: Option<f64>,
    /// Standard deviation of the heading in degrees.
    pub deviation_deg: Option<f64>,
    /// Probability of the pose, 0..=1.
    pub probability: Option<f64>,
    /// Number of places that are kept as possible.
    pub places: u32,
    /// Reason for the state in words, and what to do.
    pub says: String,
    /// Time from the scan's entry into the graph to the pose, in milliseconds.
    pub latency_ms: f64,
    /// Time at which the pose was sent, in nanoseconds of the machine's monotonic clock.
    pub sent_ns: i64,
}

/// The pose of a scan, and the answer to the scan alone; either may be missing.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Row {
    /// Time of the measurement, in nanoseconds since 1970.
    pub stamp_ns: i64,
    /// Answer to the scan alone; `None` if it was not searched.
    #[serde(flatten)]
    pub single: Option<Line>,
    /// Pose from the tracker; `None` if it did not answer the scan.
    pub pose: Option<PoseLine>,
}

impl PoseLine {
    /// Converts a message of topic `pose`.
    pub fn new(header: &PoseHeader, words: &[u8]) -> Self {
        let state = TrackState::from_code(header.state);
        let of = Frame::of(header.mount_known == 1);
        let (pose, rows) = match of {
            Frame::Base => (header.base(), header.base_covariance),
            Frame::Laser => (header.laser(), header.laser_covariance),
        };
        let is_finite = rows.iter().all(|c| c.is_finite());
        let rows = pose.map(|_| rows).filter(|_| is_finite);
        let latency_ns = header.sent_ns.saturating_sub(header.stamp.entered_ns);
        PoseLine {
            stamp_ns: header.stamp.measured_ns,
            state: state.map_or("?", TrackState::as_str),
            of,
            map: None,
            x: pose.map(|pose| pose.x),
            y: pose.map(|pose| pose.y),
            heading_deg: pose.map(|pose| pose.yaw.to_degrees()),
            map_from_laser: header.laser(),
            deviation_m: rows.map(|rows| Covariance::from_rows(rows).ellipse().major_m),
            deviation_deg: rows.map(|[.., yaw_variance]| yaw_variance.max(0.0).sqrt().to_degrees()),
            probability: pose.map(|_| header.probability),
            places: header.places,
            says: String::from_utf8_lossy(words).into_owned(),
            latency_ms: latency_ns as f64 / NS_PER_MS,
            sent_ns: header.sent_ns,
        }
    }
}

impl Row {
    /// Returns the frame of its pose; `None` if it has no pose.
    pub fn frame(&self) -> Option<Frame> {
        let pose = self.pose.as_ref();
        pose.filter(|pose| pose.x.is_some()).map(|pose| pose.of)
    }

    /// Returns the column names, for poses of this frame.
    pub fn header(frame: Frame) -> String {
        let [x, y] = frame.columns();
        row([
            "stamp s",
            x,
            y,
            "heading deg",
            "95 % m",
            "state",
            "prob %",
            "single scan",
            "ms",
        ])
    }

    /// Returns the row without a newline.
    pub fn text(&self) -> String {
        let single = self.single.as_ref();
        let single = single.map_or("-".to_owned(), |line| match line.alternatives {
            0 => line.verdict.to_owned(),
            others => format!("{} +{others}", line.verdict),
        });
        let Some(pose) = &self.pose else {
            return self.text_without_pose(&single);
        };
        let row = row([
            &seconds(pose.stamp_ns),
            &number(pose.x, 3),
            &number(pose.y, 3),
            &number(pose.heading_deg, 2),
            // Deviation to either side, as in the web page and the plots.
            &number(pose.deviation_m.map(|m| ELLIPSE_95 * m), 3),
            pose.state,
            &number(pose.probability.map(|share| 100.0 * share), 1),
            &single,
            &format!("{:.2}", pose.latency_ms),
        ]);
        // The normal state needs no words.
        let is_normal = pose.state == TrackState::Unique.as_str();
        let words = if is_normal { "" } else { &pose.says };
        with_words(&row, words, pose.map.as_deref())
    }

    /// Returns the row of a scan without an answer of the tracker. No pose is shown, as that of the
    /// scan alone may be at another place.
    fn text_without_pose(&self, single: &str) -> String {
        let Some(line) = &self.single else {
            return String::new();
        };
        let ms = format!("{:.2}", line.latency_ms);
        let none = "-";
        row([
            &seconds(line.stamp_ns),
            none,
            none,
            none,
            none,
            none,
            none,
            single,
            &ms,
        ])
    }
}

fn row([stamp, x, y, heading, within, state, probability, single, ms]: [&str; 9]) -> String {
    format!(
        "{stamp:>14}  {x:>9}  {y:>9}  {heading:>11}  {within:>6}  {state:<9}  {probability:>6}  {single:<12}  {ms:>8}"
    )
}

#[cfg(test)]
mod tests {
    use messages::Verdict;

    use super::*;
    use crate::testing::{message, pose};

    fn shown(state: TrackState, words: &str, with_single: bool) -> Row {
        let (header, found) = message(1_117_803_432_123_999_999, 0, Verdict::Ambiguous as u32);
        let pose = pose(1_117_803_432_123_999_999, 0, state);
        Row {
            stamp_ns: header.stamp.measured_ns,
            single: with_single.then(|| Line::new(&header, &found)),
            pose: Some(PoseLine::new(&pose, words.as_bytes())),
        }
    }

    #[test]
    fn columns_stand_under_their_names() {
        let expected = "
       stamp s  laser x m  laser y m  heading deg  95 % m  state      prob %  single scan         ms
1117803432.123      1.000     -2.000       180.00   0.049  Unique       97.5  Ambiguous +2     26.00
1117803432.123      1.000     -2.000       180.00   0.049  Doubtful     97.5  -                26.00  the scans do not fit
1117803432.123          -          -            -       -  Searching       -  Ambiguous +2     26.00  2 places fit, 25 m apart
1117803432.123          -          -            -       -  -               -  Ambiguous +2     25.00
";
        let mut without = shown(TrackState::Unique, "", true);
        without.pose = None;
        let text = format!(
            "\n{}\n{}\n{}\n{}\n{}\n",
            Row::header(Frame::Laser),
            shown(TrackState::Unique, "one place is left", true).text(),
            shown(TrackState::Doubtful, "the scans do not fit", false).text(),
            shown(TrackState::Searching, "2 places fit, 25 m apart", true).text(),
            without.text(),
        );
        assert_eq!(text, expected);
    }

    #[test]
    fn json_keeps_the_keys_of_the_single_answer_and_adds_the_pose() {
        let json = serde_json::to_value(shown(TrackState::Doubtful, "words", true)).unwrap();
        assert_eq!(json["verdict"], "Ambiguous");
        assert_eq!(json["pose"]["state"], "Doubtful");
        assert_eq!(json["pose"]["says"], "words");
        assert_eq!(json["pose"]["probability"], 0.975);
        assert!((json["pose"]["deviation_m"].as_f64().unwrap() - 0.02).abs() < 1e-12);
        let alone = serde_json::to_value(shown(TrackState::Doubtful, "", false)).unwrap();
        assert_eq!(alone["pose"]["stamp_ns"], 1_117_803_432_123_999_999_i64);
        assert_eq!(alone["stamp_ns"], 1_117_803_432_123_999_999_i64);
        assert!(alone.get("verdict").is_none());
    }

    #[test]
    fn the_pose_is_that_of_the_base_where_the_mount_is_known() {
        let mut header = pose(1, 0, TrackState::Unique);
        header.mount_known = 1;
        header.map_from_base.x = 1.5;
        header.base_covariance[0] = 0.09;
        let line = PoseLine::new(&header, b"");
        assert_eq!((line.of, line.x), (Frame::Base, Some(1.5)));
        assert_eq!(line.map_from_laser.map(|laser| laser.x), Some(1.0));
        // The tolerance covers the rounding of the root.
        assert!((line.deviation_m.unwrap() - 0.3).abs() < 1e-12);
    }

    #[test]
    fn foreign_values_do_not_panic() {
        let mut header = pose(i64::MIN, 0, TrackState::Unique);
        header.state = 99;
        header.map_from_laser.x = f64::NAN;
        header.laser_covariance[0] = f64::NAN;
        header.sent_ns = i64::MAX;
        header.stamp.entered_ns = i64::MIN;
        let line = PoseLine::new(&header, &[0xff; 3]);
        assert_eq!((line.state, line.x, line.deviation_m), ("?", None, None));
    }
}
