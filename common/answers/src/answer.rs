//! Answer to one scan, as a row of the table or as JSON. Pure.

use engine::peaks::sentence::{PlaceSummary, sentence};
use geometry::{Covariance, Pose};
use messages::{HypothesesHeader, Hypothesis, Verdict};
use schemars::JsonSchema;
use serde::Serialize;

use super::place::{Candidate, Frame, Place, map_id};

pub(super) const NS_PER_MS: f64 = 1e6;

/// Verdict on one scan, and its best place.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ScanAnswer {
    /// Time of the measurement, in nanoseconds since 1970; in JSON it is that of the object that
    /// has this one.
    #[serde(skip)]
    pub stamp_ns: i64,
    /// Verdict, or `?` if this version does not know it.
    pub verdict: &'static str,
    /// Number of other places that fit about as well.
    pub alternatives: u32,
    /// Verdict in words.
    pub says: String,
    #[serde(flatten)]
    pub best: Place,
    /// Computing time, in milliseconds.
    pub cpu_ms: f64,
    /// Time from the scan's entry into the graph to the answer, in milliseconds; `None` without a
    /// graph.
    pub latency_ms: Option<f64>,
}

impl ScanAnswer {
    /// Converts a message of topic `hypotheses`; `name_of` returns the name of one of several maps.
    pub fn new(
        header: &HypothesesHeader,
        hypotheses: &[Hypothesis],
        name_of: &dyn Fn(u64) -> Option<String>,
    ) -> Self {
        let verdict = Verdict::from_code(header.verdict);
        let best = Candidate::all(header, hypotheses, name_of).next();
        let none = || Place {
            map_id: map_id(header.map_id),
            frame: Frame::of(header.mount_known == 1),
            ..Place::default()
        };
        let cpu_ns = header.search_ns.saturating_add(header.extract_ns);
        let latency_ns = header.sent_ns.saturating_sub(header.stamp.entered_ns);
        ScanAnswer {
            stamp_ns: header.stamp.measured_ns,
            verdict: verdict.map_or("?", Verdict::as_str),
            alternatives: header.alternatives,
            says: verdict.map_or_else(String::new, |verdict| {
                sentence(verdict, &summaries(header, hypotheses))
            }),
            best: best.map_or_else(none, |best| best.place),
            cpu_ms: cpu_ns as f64 / NS_PER_MS,
            latency_ms: Some(latency_ns as f64 / NS_PER_MS),
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
        let [x, y, heading] = numbers(&self.best);
        let row = row([
            &seconds(self.stamp_ns),
            &x,
            &y,
            &heading,
            &number(self.best.score, 2),
            self.verdict,
            &self.alternatives.to_string(),
            &self.milliseconds(),
        ]);
        // The normal verdict needs no words.
        let is_normal = self.verdict == Verdict::Unique.as_str();
        let words = if is_normal { "" } else { &self.says };
        with_words(&row, words, self.best.map.as_deref())
    }

    /// Formats the latency or, without a graph, the computing time.
    pub(super) fn milliseconds(&self) -> String {
        format!("{:.2}", self.latency_ms.unwrap_or(self.cpu_ms))
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

/// Formats x, y and heading in degrees of the pose that is shown, or dashes.
pub(super) fn numbers(place: &Place) -> [String; 3] {
    let pose = place.pose();
    [
        number(pose.map(|pose| pose.x), 3),
        number(pose.map(|pose| pose.y), 3),
        number(pose.map(|pose| pose.yaw.to_degrees()), 2),
    ]
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
    use crate::testing::{answer, message};

    #[test]
    fn columns_stand_under_their_names() {
        let (header, found) = message(1_117_803_432_123_999_999, 0, Verdict::Ambiguous as u32);
        let expected = "
       stamp s  laser x m  laser y m  heading deg  score  verdict    alternatives        ms
1117803432.123      1.000     -2.000       180.00   0.88  Ambiguous             2     25.00  no place stands out enough to be sure
             -          -          -            -      -  NoScan                2     25.00  no usable beams: is the laser covered?
";
        let mut none = answer(
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
            ScanAnswer::header(Frame::Laser),
            answer(&header, &found).text(),
            none.text().replace("        -1.500", "             -"),
        );
        assert_eq!(text, expected);
    }

    #[test]
    fn the_pose_is_that_of_the_base_where_the_mount_is_known() {
        let (mut header, mut found) = message(1, 0, Verdict::Unique as u32);
        header.mount_known = 1;
        found[0].map_from_base.x = 1.5;
        let line = ScanAnswer::new(&header, &found, &|_| Some("ground".to_owned()));
        assert!(ScanAnswer::header(line.best.frame).contains("   base x m   base y m  "));
        assert!(
            line.text().contains("  1.500      0.000  "),
            "{}",
            line.text()
        );
        assert!(line.text().ends_with("  on ground"), "{}", line.text());
        let json = serde_json::to_value(&line).unwrap();
        assert_eq!(
            (&json["base"]["x"], &json["laser"]["y"]),
            (&1.5.into(), &(-2.0).into())
        );
    }

    #[test]
    fn foreign_values_do_not_panic() {
        let (mut header, found) = message(i64::MIN, 0, 99);
        header.sent_ns = i64::MAX;
        header.stamp.entered_ns = i64::MIN;
        header.search_ns = u64::MAX;
        let line = answer(&header, &found);
        assert_eq!(line.verdict, "?");
        assert!(
            line.text().starts_with("-9223372036.854"),
            "{}",
            line.text()
        );
    }
}
