//! Poses that another program found, read from a text as TUM or lines of JSON. Pure.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use geometry::Pose;
use ros::Quaternion;
use serde::Deserialize;

/// Stamps this close are the same: a decimal number of seconds since 1970 is rounded.
const SAME_NS: i64 = 1_000_000;

/// Latest stamp in seconds, shortly before the nanoseconds overflow.
const MAX_S: f64 = 9e9;

const TUM: &str = "lines of 8 numbers, stamp_s x y z qx qy qz qw";
const JSON: &str =
    "lines of JSON with whole stamp_ns, x, y, yaw, and optionally verdict, probability";

/// Pose in the map, and how sure the program is of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GivenPose {
    pub(super) pose: Pose,
    pub(super) is_unique: bool,
    pub(super) probability: Option<f64>,
}

/// Poses by stamp, in nanoseconds; at least one.
#[derive(Debug, PartialEq)]
pub(super) struct GivenPoses(BTreeMap<i64, GivenPose>);

/// Line of JSON, with the names of `backcast locate --json`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    stamp_ns: i64,
    x: f64,
    y: f64,
    yaw: f64,
    #[serde(default)]
    verdict: Verdict,
    probability: Option<f64>,
}

#[derive(Deserialize, Default, PartialEq)]
enum Verdict {
    #[default]
    Unique,
    Ambiguous,
    PoorFit,
}

impl GivenPoses {
    /// Parses lines of JSON if the first line starts with `{`, else TUM. Blank lines and those
    /// that start with `#` are skipped.
    /// Fails if there is no pose, or one cannot be used; names its line and what is allowed.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let lines = (1..).zip(text.lines().map(str::trim));
        let lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let mut lines = lines.peekable();
        let Some((_, first)) = lines.peek() else {
            return Err(format!(" there is no pose; allowed are {TUM}, and {JSON}"));
        };
        let is_json = first.starts_with('{');
        let mut poses = BTreeMap::new();
        for (number, line) in lines {
            let given = if is_json { json(line) } else { tum(line) };
            let (stamp_ns, pose) = given.map_err(|reason| format!("{number}: {reason}"))?;
            let last = poses.last_key_value().map(|(&last_ns, _)| last_ns);
            if let Some(last_ns) = last.filter(|&last_ns| stamp_ns <= last_ns) {
                let [stamp, last] = [stamp_ns, last_ns].map(seconds);
                return Err(format!(
                    "{number}: the stamp {stamp} s is not after {last} s before; allowed are increasing stamps"
                ));
            }
            poses.insert(stamp_ns, pose);
        }
        Ok(GivenPoses(poses))
    }

    pub(super) fn count(&self) -> u64 {
        self.0.len() as u64
    }

    pub(super) fn span_ns(&self) -> [i64; 2] {
        let mut stamps = self.0.keys();
        let first = stamps.next().copied().unwrap_or_default();
        [first, stamps.next_back().copied().unwrap_or(first)]
    }

    /// Pose of a stamp, else between two up to `gap_ns` apart, as sure as the less sure one.
    pub(super) fn at(&self, stamp_ns: i64, gap_ns: i64) -> Option<GivenPose> {
        let same = self.0.range(stamp_ns - SAME_NS..=stamp_ns + SAME_NS);
        if let Some((_, pose)) = same.min_by_key(|(other_ns, _)| other_ns.abs_diff(stamp_ns)) {
            return Some(*pose);
        }
        let (from_ns, from) = self.0.range(..stamp_ns).next_back()?;
        let (to_ns, to) = self.0.range(stamp_ns..).next()?;
        let share = (stamp_ns - from_ns) as f64 / (to_ns - from_ns) as f64;
        (to_ns - from_ns <= gap_ns).then(|| GivenPose {
            pose: from.pose.towards(to.pose, share),
            is_unique: from.is_unique && to.is_unique,
            probability: from.probability.zip(to.probability).map(|(a, b)| a.min(b)),
        })
    }
}

pub(super) fn seconds(stamp_ns: i64) -> String {
    format!("{:.3}", stamp_ns as f64 / 1e9)
}

fn json(line: &str) -> Result<(i64, GivenPose), String> {
    let line: Line = serde_json::from_str(line).map_err(|error| {
        let error = error.to_string().replace(" at line 1 column", " at column");
        format!("{error}; allowed are {JSON}")
    })?;
    check_stamp(line.stamp_ns as f64 / 1e9)?;
    if line.yaw.abs() > TAU {
        let yaw = line.yaw;
        return Err(format!("yaw is {yaw}; allowed are radians, -2π to 2π"));
    }
    if let Some(p) = line.probability.filter(|p| !(0.0..=1.0).contains(p)) {
        return Err(format!("probability is {p}; allowed is 0 to 1"));
    }
    let given = GivenPose {
        pose: Pose::new(line.x, line.y, line.yaw),
        is_unique: line.verdict == Verdict::Unique,
        probability: line.probability,
    };
    Ok((line.stamp_ns, given))
}

fn tum(line: &str) -> Result<(i64, GivenPose), String> {
    let number = |word: &str| {
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| format!("{word:?} is not a finite number; allowed are {TUM}"))
    };
    let words = line.split_whitespace();
    let numbers: Vec<f64> = words.map(number).collect::<Result<_, _>>()?;
    let [stamp_s, px, py, _, x, y, z, w] = numbers[..] else {
        return Err(format!(
            "there are {} numbers; allowed are {TUM}",
            numbers.len()
        ));
    };
    check_stamp(stamp_s)?;
    if [x, y, z, w] == [0.0; 4] {
        return Err("the quaternion is all zeros; allowed: a length of 1".to_owned());
    }
    let yaw = Quaternion { x, y, z, w }.yaw();
    let given = GivenPose {
        pose: Pose::new(px, py, yaw.map_err(|error| error.to_string())?),
        is_unique: true,
        probability: None,
    };
    Ok(((stamp_s * 1e9).round() as i64, given))
}

fn check_stamp(stamp_s: f64) -> Result<(), String> {
    let wrong =
        format!("the stamp is {stamp_s} s; allowed are seconds since 1970, at most {MAX_S}");
    (stamp_s.abs() <= MAX_S).then_some(()).ok_or(wrong)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn both_formats_give_the_pose_of_a_stamp() {
        let tum = "# by another program\n\n1137772793.5 1 2 0.3 0 0 0.7071068 0.7071068\n\
                   1137772794.5 3 2 0 0 0 0 1";
        let json = "{\"stamp_ns\": 1137772793500000000, \"x\": 1, \"y\": 2, \"yaw\": 1.5707963}\n\
                    # Unique unless it is said\n\
                    {\"stamp_ns\": 1137772794500000000, \"x\": 3, \"y\": 2, \"yaw\": 0, \
                    \"verdict\": \"Ambiguous\", \"probability\": 0.5}";
        let at =
            |text: &str, stamp_ns, gap_ns| GivenPoses::parse(text).unwrap().at(stamp_ns, gap_ns);
        for text in [tum, json] {
            // Off by the rounding of a decimal stamp.
            let found = at(text, 1_137_772_793_500_000_200, 0).unwrap();
            assert_eq!((found.pose.x, found.pose.y), (1.0, 2.0));
            // The text has seven digits.
            assert!((found.pose.yaw - FRAC_PI_2).abs() < 1e-6, "{found:?}");
            assert!(found.is_unique);
            let middle_ns = 1_137_772_794_000_000_000;
            assert_eq!(at(text, middle_ns, 999_999_999), None);
            let between = at(text, middle_ns, 1_000_000_000).unwrap();
            assert_eq!(between.is_unique, text == tum);
            assert!((between.pose.yaw - 0.5 * FRAC_PI_2).abs() < 1e-6);
            let later_ns = 1_137_772_795_000_000_000;
            assert_eq!(at(text, later_ns, i64::MAX), None, "the last");
        }
        let second = at(json, 1_137_772_794_500_000_000, 0).unwrap();
        assert_eq!((second.is_unique, second.probability), (false, Some(0.5)));
    }

    #[test]
    fn a_bad_line_is_named_with_what_is_allowed() {
        let json = |rest: &str| format!("{{\"stamp_ns\": 1, \"x\": 1, \"y\": 2, {rest}}}");
        let twice = "2 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1";
        let quaternion = "1: the quaternion (0, 0, 0, 0.9) is not a rotation";
        let cases = [
            ("# nothing\n", " there is no pose; allowed are"),
            ("1 0 0 0 0 0 0 1\n2 0 0", "2: there are 3 numbers; allowed"),
            ("1 0 nan 0 0 0 0 1", "1: \"nan\" is not a finite number"),
            ("#\n1 0 0 0 0 0 0 0", "2: the quaternion is all zeros"),
            ("1 0 0 0 0 0 0 0.9", quaternion),
            (twice, "2: the stamp 2.000 s is not after 2.000 s"),
            (
                "1137772793095 0 0 0 0 0 0 1",
                "1: the stamp is 1137772793095 s; allowed",
            ),
            (
                &json("\"heading_deg\": 3"),
                "1: unknown field `heading_deg`, expected",
            ),
            (&json("\"yaw\": 90"), "1: yaw is 90; allowed are radians"),
            (
                &json("\"yaw\": 0, \"probability\": 50"),
                "1: probability is 50; allowed",
            ),
            (
                &json("\"yaw\": 0, \"verdict\": \"unique\""),
                "1: unknown variant `unique`",
            ),
            (&json("\"yaw\": NaN"), "1: expected value at column"),
            ("{\"x\": 1}", "1: missing field `stamp_ns`"),
        ];
        for (text, expected) in cases {
            let error = GivenPoses::parse(text).unwrap_err();
            assert!(error.starts_with(expected), "{text}: {error}");
        }
    }
}
