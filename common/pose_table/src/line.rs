//! Output for the answer to one scan, as a row of the table or as JSON. Pure.

use engine::peaks::sentence::{PlaceSummary, sentence};
use geometry::{Covariance, Pose};
use messages::{HypothesesHeader, Hypothesis, Pose2, Verdict};
use schemars::JsonSchema;
use serde::Serialize;

use super::frame::Frame;

pub(super) const NS_PER_MS: f64 = 1e6;

/// One scan and its answer. Fields of the pose are `None` without a pose.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Line {
    /// Time of the measurement, in nanoseconds since 1970; in JSON it is that of the [`Row`].
    ///
    /// [`Row`]: crate::Row
    #[serde(skip)]
    pub stamp_ns: i64,
    /// Frame whose pose this is.
    pub of: Frame,
    /// Name of the map of the pose, if several maps are searched.
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
    /// Fit of the scan to the map at the pose, at most 1.
    pub score: Option<f32>,
    /// Verdict, or `?` if this version does not know it.
    pub verdict: &'static str,
    /// Number of other places that fit about as well.
    pub alternatives: u32,
    /// Verdict in words.
    pub says: String,
    /// Time from the scan's entry into the graph to the pose, in milliseconds.
    pub latency_ms: f64,
    /// Part of the latency that is computing, in milliseconds.
    pub engine_ms: f64,
}

impl Line {
    /// Converts a message of topic `hypotheses`.
    pub fn new(header: &HypothesesHeader, hypotheses: &[Hypothesis]) -> Self {
        let verdict = Verdict::from_code(header.verdict);
        let best = hypotheses
            .first()
            .filter(|_| verdict != Some(Verdict::NoScan));
        let of = Frame::of(header.mount_known == 1);
        let pose = best.map(|h| of.pose(h.map_from_base, h.map_from_laser));
        let engine_ns = header.search_ns.saturating_add(header.extract_ns);
        let latency_ns = header.sent_ns.saturating_sub(header.stamp.entered_ns);
        Line {
            stamp_ns: header.stamp.measured_ns,
            of,
            map: None,
            x: pose.map(|p| p.x),
            y: pose.map(|p| p.y),
            heading_deg: pose.map(|p| p.yaw.to_degrees()),
            map_from_laser: best.map(|h| h.map_from_laser),
            score: best.map(|h| h.score),
            verdict: verdict.map_or("?", Verdict::as_str),
            alternatives: header.alternatives,
            says: verdict.map_or_else(String::new, |verdict| {
                sentence(verdict, &summaries(header, hypotheses))
            }),
            latency_ms: latency_ns as f64 / NS_PER_MS,
            engine_ms: engine_ns as f64 / NS_PER_MS,
        }
    }

    /// Returns the column names, for poses of this frame.
    pub fn header(frame: Frame) -> String {
        let [x, y] = frame.columns();
        row([
            "stamp s",
            x,
            y,
            "heading deg",
            "score",
            "verdict",
            "alternatives",
            "ms",
        ])
    }

    /// Returns the row without a newline.
    pub fn text(&self) -> String {
        let row = row([
            &seconds(self.stamp_ns),
            &number(self.x, 3),
            &number(self.y, 3),
            &number(self.heading_deg, 2),
            &number(self.score.map(f64::from), 2),
            self.verdict,
            &self.alternatives.to_string(),
            &format!("{:.2}", self.latency_ms),
        ]);
        // The normal verdict needs no words.
        let is_normal = self.verdict == Verdict::Unique.as_str();
        let words = if is_normal { "" } else { &self.says };
        with_words(&row, words, self.map.as_deref())
    }
}

/// Returns the best place and those that fit about as well, without non-finite values, which
/// another process may have sent.
fn summaries(header: &HypothesesHeader, hypotheses: &[Hypothesis]) -> Vec<PlaceSummary> {
    let is_finite = |h: &&Hypothesis| {
        Pose::from(h.map_from_laser).is_finite() && h.covariance.iter().all(|c| c.is_finite())
    };
    let reported = hypotheses.iter().take(1 + header.alternatives as usize);
    reported
        .filter(is_finite)
        .map(|h| PlaceSummary {
            map: h.map_id,
            map_from_laser: h.map_from_laser.into(),
            covariance: Covariance::from_rows(h.covariance),
            score: h.score.into(),
        })
        .collect()
}

fn row([stamp, x, y, heading, score, verdict, alternatives, ms]: [&str; 8]) -> String {
    format!(
        "{stamp:>14}  {x:>9}  {y:>9}  {heading:>11}  {score:>5}  {verdict:<9}  {alternatives:>12}  {ms:>8}"
    )
}

/// Formats a number, or a dash for `None`.
pub fn number(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |v| format!("{v:.decimals$}"))
}

/// Formats nanoseconds as seconds with three decimals, truncated; exact where a float would round.
pub(super) fn seconds(ns: i64) -> String {
    let (sign, ns) = (if ns < 0 { "-" } else { "" }, ns.unsigned_abs());
    format!("{sign}{}.{:03}", ns / 1_000_000_000, ns / 1_000_000 % 1000)
}

/// Appends words and the name of the map to a row.
pub(super) fn with_words(row: &str, words: &str, map: Option<&str>) -> String {
    let mut row = row.to_owned();
    if !words.is_empty() {
        row += &format!("  {words}");
    }
    if let Some(map) = map {
        row += &format!("  on {map}");
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::message;

    #[test]
    fn columns_stand_under_their_names() {
        let (header, found) = message(1_117_803_432_123_999_999, 0, Verdict::Ambiguous as u32);
        let expected = "
       stamp s  laser x m  laser y m  heading deg  score  verdict    alternatives        ms
1117803432.123      1.000     -2.000       180.00   0.88  Ambiguous             2     25.00  several places fit about as well
             -          -          -            -      -  NoScan                2     25.00  no usable beams: is the laser covered?
";
        let mut none = Line::new(
            &HypothesesHeader {
                verdict: 0,
                ..header
            },
            &found,
        );
        assert_eq!(none.stamp_ns, header.stamp.measured_ns);
        none.stamp_ns = -1_500_000_000;
        let text = format!(
            "\n{}\n{}\n{}\n",
            Line::header(Frame::Laser),
            Line::new(&header, &found).text(),
            none.text().replace("        -1.500", "             -"),
        );
        assert_eq!(text, expected);
    }

    #[test]
    fn the_pose_is_that_of_the_base_where_the_mount_is_known() {
        let (mut header, mut found) = message(1, 0, Verdict::Unique as u32);
        header.mount_known = 1;
        found[0].map_from_base.x = 1.5;
        let mut line = Line::new(&header, &found);
        line.map = Some("ground".to_owned());
        assert!(Line::header(line.of).contains("   base x m   base y m  "));
        assert!(
            line.text().contains("  1.500      0.000  "),
            "{}",
            line.text()
        );
        assert!(line.text().ends_with("  on ground"), "{}", line.text());
        let json = serde_json::to_value(&line).unwrap();
        assert_eq!((&json["of"], &json["x"]), (&"base".into(), &1.5.into()));
        assert_eq!(json["map_from_laser"]["y"], -2.0);
    }

    #[test]
    fn foreign_values_do_not_panic() {
        let (mut header, found) = message(i64::MIN, 0, 99);
        header.sent_ns = i64::MAX;
        header.stamp.entered_ns = i64::MIN;
        header.search_ns = u64::MAX;
        let line = Line::new(&header, &found);
        assert_eq!(line.verdict, "?");
        assert!(
            line.text().starts_with("-9223372036.854"),
            "{}",
            line.text()
        );
    }
}
