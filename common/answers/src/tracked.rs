//! Pose of the tracker at one scan, followed by the answer to the scan alone. Pure.

use geometry::ELLIPSE_95;
use messages::{PoseHeader, TrackState};
use schemars::JsonSchema;
use serde::Serialize;

use super::answer::{NS_PER_MS, ScanAnswer, number, numbers, seconds, with_words};
use super::place::{Frame, Place};

/// The tracker's pose, with its state.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TrackedPose {
    /// Time of the measurement, in nanoseconds since 1970.
    pub stamp_ns: i64,
    /// State of the tracker, or `?` if this version does not know it.
    pub state: &'static str,
    /// Reason for the state in words, and what to do.
    pub says: String,
    #[serde(flatten)]
    pub place: Place,
    /// Number of places that are kept as possible.
    pub places: u32,
    /// True if the pose is that of a scan; false if odometry has moved it on since.
    pub from_scan: bool,
    /// Computing time without the search, in milliseconds.
    pub cpu_ms: f64,
    /// Time from the measurement's entry into the graph to the pose, in milliseconds.
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
    pub single: Option<ScanAnswer>,
    /// Pose from the tracker; `None` if it did not answer the scan.
    pub pose: Option<TrackedPose>,
}

impl TrackedPose {
    pub fn new(header: &PoseHeader, words: &[u8]) -> Self {
        let state = TrackState::from_code(header.state);
        let words = words.get(..PoseHeader::WORDS_CAPACITY).unwrap_or(words);
        let latency_ns = header.sent_ns.saturating_sub(header.stamp.entered_ns);
        TrackedPose {
            stamp_ns: header.stamp.measured_ns,
            state: state.map_or("?", TrackState::as_str),
            says: String::from_utf8_lossy(words).into_owned(),
            place: Place::of_pose(header),
            places: header.places,
            from_scan: header.from_scan == 1,
            cpu_ms: header.tracking_ns as f64 / NS_PER_MS,
            latency_ms: latency_ns as f64 / NS_PER_MS,
            sent_ns: header.sent_ns,
        }
    }
}

impl Row {
    /// Returns the frame of its pose; `None` if it has no pose.
    pub fn frame(&self) -> Option<Frame> {
        let place = &self.pose.as_ref()?.place;
        place.pose().map(|_| place.frame)
    }

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

    pub fn text(&self) -> String {
        let single = self.single.as_ref();
        let single = single.map_or("-".to_owned(), |line| match line.alternatives {
            0 => line.verdict.to_owned(),
            others => format!("{} +{others}", line.verdict),
        });
        let Some(pose) = &self.pose else {
            return self.text_without_pose(&single);
        };
        let [x, y, heading] = numbers(&pose.place);
        // Deviation to either side, as in the web page and the plots.
        let within = pose
            .place
            .covariance()
            .map(|c| ELLIPSE_95 * c.ellipse().major_m);
        let row = row([
            &seconds(pose.stamp_ns),
            &x,
            &y,
            &heading,
            &number(within, 3),
            pose.state,
            &number(pose.place.probability.map(|share| 100.0 * share), 1),
            &single,
            &format!("{:.2}", pose.latency_ms),
        ]);
        // The normal state needs no words.
        let is_normal = pose.state == TrackState::Unique.as_str();
        let words = if is_normal { "" } else { &pose.says };
        with_words(&row, words, pose.place.map.as_deref())
    }

    /// Returns the row of a scan without an answer of the tracker. No pose is shown, as that of the
    /// scan alone may be at another place.
    fn text_without_pose(&self, single: &str) -> String {
        let Some(line) = &self.single else {
            return String::new();
        };
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
            &line.milliseconds(),
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
    use crate::testing::{answer, message, pose};

    fn shown(state: TrackState, words: &str, with_single: bool) -> Row {
        let (header, found) = message(1_117_803_432_123_999_999, 0, Verdict::Ambiguous as u32);
        let pose = pose(1_117_803_432_123_999_999, 0, state);
        Row {
            stamp_ns: header.stamp.measured_ns,
            single: with_single.then(|| answer(&header, &found)),
            pose: Some(TrackedPose::new(&pose, words.as_bytes())),
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
        assert_eq!(json["pose"]["laser_covariance"][0], 4e-4);
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
        let line = TrackedPose::new(&header, b"");
        let place = line.place;
        assert_eq!((place.frame, place.pose()), (Frame::Base, place.base));
        assert_eq!(place.base.map(|base| base.x), Some(1.5));
        assert_eq!(place.laser.map(|laser| laser.x), Some(1.0));
        assert_eq!(place.base_covariance.unwrap()[0], 0.09);
    }

    #[test]
    fn foreign_values_do_not_panic() {
        let mut header = pose(i64::MIN, 0, TrackState::Unique);
        header.state = 99;
        header.map_from_laser.x = f64::NAN;
        header.laser_covariance[0] = f64::NAN;
        header.sent_ns = i64::MAX;
        header.stamp.entered_ns = i64::MIN;
        let line = TrackedPose::new(&header, &[0xff; 999]);
        assert_eq!((line.state, line.place.laser), ("?", None));
        assert_eq!(line.place.laser_covariance, None);
        assert_eq!(line.says.chars().count(), PoseHeader::WORDS_CAPACITY);
    }
}
