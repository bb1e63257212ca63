//! Compares expected and found results. Pure.

use std::collections::BTreeMap;

use answers::statistics::SUCCESS;
use geometry::Pose;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

use super::answer::{Answer, Expected};

/// Differences to report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub(super) enum Tolerance {
    /// All figures: for changes that should change no result
    #[default]
    Exact,
    /// Verdicts, states and the poses of results that are Unique: for another version of the engine
    Pose,
}

impl Tolerance {
    /// Tolerance in metres and degrees. `Exact`: far below the resolution of lasers, far above
    /// rounding. `Pose`: a usual cell of a map; one degree moves a point 3 m away by a cell of 5 cm.
    fn limits(self) -> (f64, f64) {
        match self {
            Tolerance::Exact => (0.001, 0.01),
            Tolerance::Pose => (0.05, 1.0),
        }
    }
}

/// Tolerance of scores and probabilities, which are shares of 1 in 32 bits: less than what changes
/// a verdict, more than the rounding of exponential functions.
const SHARE: f64 = 0.001;

/// Name of the verdict and the state that stand for one place.
const UNIQUE: &str = "Unique";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rule {
    /// Always, and exactly: the verdict or the state.
    State,
    /// Only with [`Tolerance::Exact`], and exactly.
    Exact,
    /// Only with [`Tolerance::Exact`], within [`SHARE`].
    Share,
    /// With [`Tolerance::Pose`] if both states are [`UNIQUE`].
    Position,
    Heading,
}

/// Values of the answer to a scan, the verdict first.
const SINGLE: [(&str, Rule); 14] = [
    ("verdict", Rule::State),
    ("x_m", Rule::Position),
    ("y_m", Rule::Position),
    ("heading_deg", Rule::Heading),
    ("best", Rule::Exact),
    ("floor", Rule::Exact),
    ("certified_floor", Rule::Exact),
    ("highest_possible", Rule::Exact),
    ("votes", Rule::Exact),
    ("beams_used", Rule::Exact),
    ("alternatives", Rule::Exact),
    ("hypotheses", Rule::Exact),
    ("score", Rule::Share),
    ("confidence", Rule::Share),
];

/// Values of the tracker's pose, the state first.
const TRACKED: [(&str, Rule); 7] = [
    ("pose.state", Rule::State),
    ("pose.x_m", Rule::Position),
    ("pose.y_m", Rule::Position),
    ("pose.heading_deg", Rule::Heading),
    ("pose.reason", Rule::Exact),
    ("pose.places", Rule::Exact),
    ("pose.probability", Rule::Share),
];

#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub(super) struct Difference {
    pub(super) stamp_ns: i64,
    /// Name of the value, or "scan" if results are missing or added.
    pub(super) what: &'static str,
    pub(super) expected: String,
    pub(super) found: String,
}

/// Returns all differences, sorted by the stamps of the scans. With [`Tolerance::Pose`], a result
/// that has become [`UNIQUE`] and is right by `truths` is none.
pub(super) fn differences(
    expected: &[Expected],
    found: &[Answer],
    tolerance: Tolerance,
    truths: &BTreeMap<i64, Pose>,
) -> Vec<Difference> {
    let mut pairs: BTreeMap<i64, (Vec<&Expected>, Vec<&Answer>)> = BTreeMap::new();
    for answer in expected {
        pairs.entry(answer.stamp_ns).or_default().0.push(answer);
    }
    for answer in found {
        pairs.entry(answer.stamp_ns).or_default().1.push(answer);
    }
    let mut all = Vec::new();
    for (stamp_ns, (expected, found)) in pairs {
        let mut scan = Scan {
            stamp_ns,
            tolerance,
            truth: truths.get(&stamp_ns).copied(),
            all: &mut all,
        };
        let (before, now) = (expected.len(), found.len());
        scan.note("scan", before == now, &before, &now);
        for (expected, found) in expected.iter().zip(&found) {
            scan.compare(&expected.values, found);
        }
    }
    all
}

struct Scan<'a> {
    stamp_ns: i64,
    tolerance: Tolerance,
    /// True pose of the laser in the map, if known.
    truth: Option<Pose>,
    all: &'a mut Vec<Difference>,
}

impl Scan<'_> {
    fn compare(&mut self, expected: &Map<String, Value>, found: &Answer) {
        // Numbers and texts always serialize.
        let found = serde_json::to_value(found).unwrap_or_default();
        self.compare_values(&SINGLE, expected, &found);
        let found = &found["pose"];
        match expected.get("pose") {
            Some(Value::Object(expected)) if found.is_object() => {
                self.compare_values(&TRACKED, expected, found);
            }
            Some(expected) => {
                let state = |pose: &Value| pose["state"].as_str().unwrap_or("none").to_owned();
                self.note("pose", expected == found, &state(expected), &state(found));
            }
            None => {}
        }
    }

    fn compare_values(
        &mut self,
        values: &[(&'static str, Rule)],
        all_expected: &Map<String, Value>,
        all_found: &Value,
    ) {
        let is_exact = self.tolerance == Tolerance::Exact;
        let mut is_unique = false;
        for &(what, rule) in values {
            let key = what.trim_start_matches("pose.");
            let Some(expected) = all_expected.get(key) else {
                continue;
            };
            let found = &all_found[key];
            let (number, now) = (expected.as_f64(), found.as_f64());
            match rule {
                Rule::State => {
                    is_unique = expected == UNIQUE && found == UNIQUE;
                    let is_better = !is_exact && found == UNIQUE && self.is_right(all_found);
                    let is_as_expected = expected == found || is_better;
                    self.note(what, is_as_expected, &shown(expected), &shown(found));
                }
                Rule::Exact if is_exact => {
                    self.note(what, expected == found, &shown(expected), &shown(found));
                }
                Rule::Share if is_exact => self.near(what, number, now, SHARE),
                Rule::Position if is_exact || is_unique => {
                    self.near(what, number, now, self.tolerance.limits().0);
                }
                Rule::Heading if is_exact || is_unique => self.near_heading(what, (number, now)),
                _ => {}
            }
        }
    }

    /// True if the pose found is near the true one.
    fn is_right(&self, found: &Value) -> bool {
        let [x, y, heading] = ["x_m", "y_m", "heading_deg"].map(|key| found[key].as_f64());
        let pose = x.zip(y).zip(heading);
        let pose = pose.map(|((x, y), heading)| Pose::new(x, y, heading.to_radians()));
        let (metres, degrees) = SUCCESS;
        let both = pose.zip(self.truth);
        both.is_some_and(|(pose, truth)| pose.is_within(truth, metres, degrees.to_radians()))
    }

    fn near_heading(&mut self, what: &'static str, (expected, found): (Option<f64>, Option<f64>)) {
        let turned = expected.zip(found).map(|(expected, found)| {
            expected + (found - expected + 180.0).rem_euclid(360.0) - 180.0
        });
        self.near(what, expected, turned.or(found), self.tolerance.limits().1);
    }

    fn near(&mut self, what: &'static str, expected: Option<f64>, found: Option<f64>, by: f64) {
        let is_near = match (expected, found) {
            (Some(expected), Some(found)) => (expected - found).abs() <= by,
            (expected, found) => expected.is_none() && found.is_none(),
        };
        let shown = |value: Option<f64>| value.map_or("none".to_owned(), |v| format!("{v:.4}"));
        self.note(what, is_near, &shown(expected), &shown(found));
    }

    fn note(
        &mut self,
        what: &'static str,
        is_as_expected: bool,
        expected: &impl ToString,
        found: &impl ToString,
    ) {
        if !is_as_expected {
            self.all.push(Difference {
                stamp_ns: self.stamp_ns,
                what,
                expected: expected.to_string(),
                found: found.to_string(),
            });
        }
    }
}

fn shown(value: &Value) -> String {
    value.as_str().map_or(value.to_string(), str::to_owned)
}

pub(super) fn table(differences: &[Difference]) -> String {
    let mut text = format!(
        "  {:>20} {:<16} {:>14} {:>14}\n",
        "stamp ns", "what", "expected", "found"
    );
    for of in differences {
        let (what, expected, found) = (of.what, &of.expected, &of.found);
        text += &format!(
            "  {:>20} {what:<16} {expected:>14} {found:>14}\n",
            of.stamp_ns
        );
    }
    text
}

/// Formats a line per kind: number of scans, largest difference of numbers, and the first scan.
pub(super) fn summary(differences: &[Difference]) -> String {
    let mut kinds: BTreeMap<&str, Vec<&Difference>> = BTreeMap::new();
    for difference in differences {
        kinds.entry(difference.what).or_default().push(difference);
    }
    let line = |(what, of): (&str, Vec<&Difference>)| {
        let first = of[0];
        let by = |difference: &&Difference| {
            let number = |text: &str| text.parse::<f64>().ok();
            Some((number(&difference.expected)? - number(&difference.found)?).abs())
        };
        let most = of.iter().filter_map(by).reduce(f64::max);
        let most = most.map_or_else(String::new, |most| format!(", by at most {most:.4}"));
        format!(
            "  {what}: {} scans{most}; first {} -> {} at {} ns\n",
            of.len(),
            first.expected,
            first.found,
            first.stamp_ns
        )
    };
    kinds.into_iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::super::answer::TrackedPose;
    use super::*;

    fn answer(stamp_ns: i64) -> Answer {
        Answer {
            stamp_ns,
            best: 800,
            verdict: "Unique".to_owned(),
            x_m: Some(1.0),
            y_m: Some(2.0),
            heading_deg: Some(179.999),
            score: Some(0.9),
            pose: Some(TrackedPose {
                state: "Unique".to_owned(),
                x_m: Some(1.0),
                heading_deg: Some(-180.0),
                ..TrackedPose::default()
            }),
            ..Answer::default()
        }
    }

    fn expected(answers: &[Answer]) -> Vec<Expected> {
        serde_json::from_value(serde_json::to_value(answers).unwrap()).unwrap()
    }

    /// Returns the differences of results whose true poses are not known.
    fn differences(all: &[Answer], found: &[Answer], tolerance: Tolerance) -> Vec<Difference> {
        super::differences(&expected(all), found, tolerance, &BTreeMap::new())
    }

    /// Names of the values that differ after `spoil` has changed a result.
    fn spoilt(spoil: fn(&mut Answer), tolerance: Tolerance) -> Vec<&'static str> {
        let mut found = answer(1);
        spoil(&mut found);
        names(&differences(&[answer(1)], &[found], tolerance))
    }

    fn names(differences: &[Difference]) -> Vec<&'static str> {
        differences.iter().map(|it| it.what).collect()
    }

    #[test]
    fn integers_are_compared_exactly_and_poses_within_a_millimetre() {
        fn pose(answer: &mut Answer) -> &mut TrackedPose {
            answer.pose.as_mut().unwrap()
        }
        type Spoils = fn(&mut Answer);
        let cases: [(Spoils, Option<&str>); 16] = [
            (|_| {}, None),
            (|a| a.best += 1, Some("best")),
            (|a| a.verdict = "PoorFit".to_owned(), Some("verdict")),
            (|a| a.x_m = Some(1.0009), None),
            (|a| a.x_m = Some(1.0011), Some("x_m")),
            // Past the half turn.
            (|a| a.heading_deg = Some(-179.999), None),
            (|a| a.heading_deg = Some(-179.9), Some("heading_deg")),
            (|a| a.score = None, Some("score")),
            (|a| a.confidence = f32::NAN, Some("confidence")),
            (|a| a.pose = None, Some("pose")),
            (|a| pose(a).state = "Lost".to_owned(), Some("pose.state")),
            (|a| pose(a).places = 2, Some("pose.places")),
            (|a| pose(a).x_m = None, Some("pose.x_m")),
            (|a| pose(a).heading_deg = Some(179.995), None),
            (
                |a| pose(a).heading_deg = Some(179.9),
                Some("pose.heading_deg"),
            ),
            (|a| pose(a).probability = 0.5, Some("pose.probability")),
        ];
        for (spoil, expected) in cases {
            assert_eq!(spoilt(spoil, Tolerance::Exact), Vec::from_iter(expected));
        }
    }

    #[test]
    fn scans_that_are_missing_or_more_are_reported() {
        let (one, two) = (answer(1), answer(2));
        let both = [one.clone(), two.clone()];
        let missing = differences(&both, std::slice::from_ref(&one), Tolerance::Pose);
        assert_eq!(missing.len(), 1);
        assert_eq!((missing[0].stamp_ns, missing[0].what), (2, "scan"));
        assert_eq!((&*missing[0].expected, &*missing[0].found), ("1", "0"));
        let more = differences(&[one], &both, Tolerance::Exact);
        assert!(table(&more).contains("2 scan"), "{}", table(&more));
    }

    #[test]
    fn another_version_may_count_otherwise_but_not_place_the_robot_elsewhere() {
        let spoilt = |spoil| spoilt(spoil, Tolerance::Pose);
        let counted_otherwise = |a: &mut Answer| {
            (a.best, a.floor, a.votes, a.hypotheses) = (1, 2, 3, 4);
            (a.score, a.confidence) = (None, 0.5);
            a.pose.as_mut().unwrap().places = 7;
        };
        assert!(spoilt(counted_otherwise).is_empty());
        assert!(spoilt(|a| a.x_m = Some(1.049)).is_empty());
        assert_eq!(spoilt(|a| a.x_m = Some(1.051)), ["x_m"]);
        assert_eq!(spoilt(|a| a.heading_deg = Some(178.9)), ["heading_deg"]);
        let elsewhere = |a: &mut Answer| a.pose.as_mut().unwrap().x_m = Some(5.0);
        assert_eq!(spoilt(elsewhere), ["pose.x_m"]);
        // Several places fit equally well, so either may come first.
        let unsure = |x_m| Answer {
            verdict: "Ambiguous".to_owned(),
            x_m: Some(x_m),
            ..answer(1)
        };
        let of = |tolerance| names(&differences(&[unsure(1.0)], &[unsure(9.0)], tolerance));
        assert!(of(Tolerance::Pose).is_empty());
        assert_eq!(of(Tolerance::Exact), ["x_m"]);
    }

    #[test]
    fn what_the_expectation_does_not_know_is_no_difference() {
        let mut older = expected(&[answer(1)]);
        let values = &mut older[0].values;
        values.insert("later".to_owned(), Value::from(1));
        values.remove("score");
        values["pose"].as_object_mut().unwrap().remove("reason");
        let mut found = answer(1);
        found.pose.as_mut().unwrap().reason = "SeveralPlaces".to_owned();
        let of = |older| super::differences(older, &[found], Tolerance::Exact, &BTreeMap::new());
        assert_eq!(names(&of(&older)), [""; 0]);
    }

    #[test]
    fn an_answer_that_has_become_unique_and_right_is_better() {
        let mut before = answer(1);
        before.verdict = "Ambiguous".to_owned();
        before.pose.as_mut().unwrap().state = "Searching".to_owned();
        let of = |tolerance, truth| {
            let mut found = answer(1);
            found.pose.as_mut().unwrap().y_m = Some(2.0);
            let truths = BTreeMap::from([(1, truth)]);
            let before = expected(std::slice::from_ref(&before));
            names(&super::differences(&before, &[found], tolerance, &truths))
        };
        let right = Pose::new(1.1, 2.1, std::f64::consts::PI);
        assert_eq!(of(Tolerance::Pose, right), [""; 0]);
        let wrong = of(Tolerance::Pose, Pose::new(5.0, 2.1, std::f64::consts::PI));
        assert_eq!(wrong, ["verdict", "pose.state"]);
        assert!(of(Tolerance::Exact, right).contains(&"verdict"));
    }

    #[test]
    fn what_changed_is_summed_up_by_its_kind() {
        let found = |x_m, verdict: &str| Answer {
            x_m: Some(x_m),
            verdict: verdict.to_owned(),
            ..answer(1)
        };
        let found = [found(1.25, "Unique"), found(1.5, "PoorFit")];
        let expected = [answer(1), answer(1)];
        let text = summary(&differences(&expected, &found, Tolerance::Exact));
        let expected = "  verdict: 1 scans; first Unique -> PoorFit at 1 ns\n  \
                        x_m: 2 scans, by at most 0.5000; first 1.0000 -> 1.2500 at 1 ns\n";
        assert_eq!(text, expected);
    }
}
