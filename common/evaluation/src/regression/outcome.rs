//! Outcome of a recording: as JSON, and as a report for a build server.

use std::collections::BTreeMap;
use std::time::Duration;

use schemars::JsonSchema;
use serde::Serialize;

use super::compare::Difference;
use crate::outcomes::Outcomes;
use crate::text;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Outcome {
    pub(super) name: String,
    /// Stamps of the scans with results, in order of arrival.
    pub(super) scans: Vec<i64>,
    pub(super) took: Duration,
    pub(super) result: Result<Vec<Difference>, String>,
}

impl Outcome {
    /// One line about the failure; `None` if all is as expected.
    pub(super) fn complaint(&self) -> Option<String> {
        match &self.result {
            Ok(differences) if differences.is_empty() => None,
            Ok(differences) => Some(format!("{} differences", differences.len())),
            Err(problem) => Some(problem.clone()),
        }
    }

    /// Adds a test case per scan, and one for the error; differences that are accepted are none.
    pub(super) fn add_to(&self, outcomes: &mut Outcomes, accepted: bool) {
        let mut by_scan: BTreeMap<i64, Vec<String>> = BTreeMap::new();
        for difference in self.result.iter().flatten().filter(|_| !accepted) {
            let (what, expected, found) =
                (difference.what, &difference.expected, &difference.found);
            let of_scan = by_scan.entry(difference.stamp_ns).or_default();
            of_scan.push(format!("{what}: expected {expected}, found {found}"));
        }
        let mut of = |&stamp_ns: &i64| (stamp_ns, by_scan.remove(&stamp_ns).unwrap_or_default());
        let found: Vec<_> = self.scans.iter().map(&mut of).collect();
        // Last, expected scans without a result.
        for (stamp_ns, differences) in found.into_iter().chain(by_scan) {
            let scan = format!("scan {}", text::seconds(stamp_ns));
            outcomes.judged(&self.name, Some(&scan), &differences, |_| ());
        }
        if let Err(problem) = &self.result {
            outcomes.broken(&self.name, "recording", problem.clone());
        }
        outcomes.took(self.took);
    }
}

/// Outcome of a recording, as JSON.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Object<'a> {
    /// Name of the recording among the others.
    case: &'a str,
    /// Number of scans with results.
    scans: usize,
    seconds: f64,
    /// True if the results were written as the new expectation.
    accepted: bool,
    /// Why the recording could not be played or compared to its end.
    error: Option<&'a str>,
    differences: &'a [Difference],
}

impl<'a> Object<'a> {
    /// `accepts` is true with `--accept`.
    pub(super) fn of(outcome: &'a Outcome, accepts: bool) -> Self {
        let result = outcome.result.as_ref();
        Object {
            case: &outcome.name,
            scans: outcome.scans.len(),
            seconds: outcome.took.as_secs_f64(),
            accepted: accepts && result.is_ok(),
            error: result.err().map(String::as_str),
            differences: result.map_or(&[], Vec::as_slice),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_names_each_scan_of_each_recording_and_what_is_wrong() {
        let outcome = |name: &str, scans: &[i64], result| Outcome {
            name: name.to_owned(),
            scans: scans.to_vec(),
            took: Duration::from_millis(1500),
            result,
        };
        let difference = |stamp_ns, what| Difference {
            stamp_ns,
            what,
            expected: "Unique".to_owned(),
            found: "<PoorFit>".to_owned(),
        };
        let differences = vec![
            difference(7_000_000_001, "verdict"),
            difference(7_000_000_001, "x_m"),
            difference(9, "scan"),
        ];
        let outcomes = [
            outcome("sound", &[1, 2], Ok(Vec::new())),
            outcome("changed", &[7_000_000_001, 8_000_000_000], Ok(differences)),
            outcome("broken", &[], Err("no map".to_owned())),
        ];
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("report.xml");
        let mut report = Outcomes::new("backcast regress", Some(&file), false).unwrap();
        for outcome in &outcomes {
            outcome.add_to(&mut report, false);
        }
        report.finish().unwrap();
        let text = std::fs::read_to_string(&file).unwrap();
        for part in [
            "tests=\"6\"",
            "failures=\"2\"",
            "errors=\"1\"",
            "<testsuite name=\"sound\" tests=\"2\"",
            "<testcase name=\"scan 7.000000001\" classname=\"changed\"",
            "message=\"verdict: expected Unique, found &lt;PoorFit&gt;; x_m: expected",
            "message=\"scan: expected",
            "message=\"no map\"",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let printed = |i: usize| serde_json::to_value(Object::of(&outcomes[i], true)).unwrap();
        let changed = printed(1);
        assert_eq!(changed["case"], "changed");
        assert_eq!(changed["scans"], 2);
        assert!(changed["accepted"] == true && changed["error"].is_null());
        assert_eq!(changed["differences"][2]["what"], "scan");
        let broken = printed(2);
        assert!(broken["accepted"] == false && broken["error"] == "no map");
    }
}
