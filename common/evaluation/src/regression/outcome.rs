//! Outcome of a recording: as JSON, and as a report for a build server.

use std::collections::BTreeMap;
use std::time::Duration;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use schemars::JsonSchema;
use serde::Serialize;

use super::compare::{Difference, table};
use crate::outcomes::not_passed;
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
    pub(super) fn is_as_expected(&self) -> bool {
        self.result.as_ref().is_ok_and(Vec::is_empty)
    }

    /// One line about the failure; `None` if all is as expected.
    pub(super) fn complaint(&self) -> Option<String> {
        match &self.result {
            Ok(differences) if differences.is_empty() => None,
            Ok(differences) => Some(format!("{} differences", differences.len())),
            Err(problem) => Some(problem.clone()),
        }
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

/// JUnit report: a suite per recording, and a test case per scan and per error.
pub(super) fn report(outcomes: &[Outcome]) -> Report {
    let mut report = Report::new("backcast regress");
    report.add_test_suites(outcomes.iter().map(suite));
    report
}

fn suite(outcome: &Outcome) -> TestSuite {
    let mut by_scan: BTreeMap<i64, Vec<Difference>> = BTreeMap::new();
    for difference in outcome.result.iter().flatten() {
        let of_scan = by_scan.entry(difference.stamp_ns).or_default();
        of_scan.push(difference.clone());
    }
    let mut suite = TestSuite::new(outcome.name.clone());
    suite.set_time(outcome.took);
    let scan = |stamp_ns: i64, differences: &[Difference]| {
        let status = match differences {
            [] => TestCaseStatus::success(),
            differences => failed(differences),
        };
        let mut case = TestCase::new(format!("scan {}", text::seconds(stamp_ns)), status);
        case.set_classname(outcome.name.clone());
        case
    };
    let mut of = |&stamp_ns: &i64| (stamp_ns, by_scan.remove(&stamp_ns).unwrap_or_default());
    let found: Vec<_> = outcome.scans.iter().map(&mut of).collect();
    // Last, expected scans without a result.
    for (stamp_ns, differences) in found.into_iter().chain(by_scan) {
        suite.add_test_case(scan(stamp_ns, &differences));
    }
    if let Err(problem) = &outcome.result {
        let status = not_passed(NonSuccessKind::Error, problem.clone());
        let mut case = TestCase::new("recording", status);
        case.set_classname(outcome.name.clone());
        suite.add_test_case(case);
    }
    suite
}

fn failed(differences: &[Difference]) -> TestCaseStatus {
    let names: Vec<&str> = differences.iter().map(|it| it.what).collect();
    let mut status = not_passed(NonSuccessKind::Failure, names.join(", "));
    status.set_description(table(differences));
    status
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
        let text = report(&outcomes).to_string().unwrap();
        for part in [
            "tests=\"6\"",
            "failures=\"2\"",
            "errors=\"1\"",
            "<testsuite name=\"sound\" tests=\"2\"",
            "<testcase name=\"scan 7.000000001\" classname=\"changed\"",
            "message=\"verdict, x_m\"",
            "message=\"scan\"",
            "&lt;PoorFit&gt;",
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
