//! Report for a build server.

use std::collections::BTreeMap;
use std::time::Duration;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::compare::{Difference, table};

/// Outcome of one recording.
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

/// Formats a JUnit report: a suite per recording, and a test case per scan, which fails if a result
/// differs. A recording that was not replayed to its end has an additional test case with an error.
///
/// # Errors
/// A text contains characters that XML does not allow.
pub(super) fn report(outcomes: &[Outcome]) -> Result<String, quick_junit::SerializeError> {
    let mut report = Report::new("backcast regress");
    report.add_test_suites(outcomes.iter().map(suite));
    report.to_string()
}

fn suite(outcome: &Outcome) -> TestSuite {
    let mut by_scan: BTreeMap<i64, Vec<Difference>> = BTreeMap::new();
    let differences = outcome.result.as_ref().map_or(&[][..], Vec::as_slice);
    for difference in differences {
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
        let (seconds, ns) = (
            stamp_ns.div_euclid(1_000_000_000),
            stamp_ns.rem_euclid(1_000_000_000),
        );
        let mut case = TestCase::new(format!("scan {seconds}.{ns:09}"), status);
        case.set_classname(outcome.name.clone());
        case
    };
    for &stamp_ns in &outcome.scans {
        let differences = by_scan.remove(&stamp_ns).unwrap_or_default();
        suite.add_test_case(scan(stamp_ns, &differences));
    }
    // Expected scans without a result.
    for (stamp_ns, differences) in by_scan {
        suite.add_test_case(scan(stamp_ns, &differences));
    }
    if let Err(problem) = &outcome.result {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_message(problem.clone());
        let mut case = TestCase::new("recording", status);
        case.set_classname(outcome.name.clone());
        suite.add_test_case(case);
    }
    suite
}

fn failed(differences: &[Difference]) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    let names: Vec<&str> = differences
        .iter()
        .map(|difference| difference.what)
        .collect();
    status.set_message(names.join(", "));
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
        let text = report(&[
            outcome("sound", &[1, 2], Ok(Vec::new())),
            outcome("changed", &[7_000_000_001, 8_000_000_000], Ok(differences)),
            outcome("broken", &[], Err("no map".to_owned())),
        ])
        .unwrap();
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
    }
}
