//! The outcome for a build server.

use std::time::Duration;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::compare::{Difference, table};

/// How a recording came out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Outcome {
    pub(super) name: String,
    pub(super) scans: usize,
    pub(super) took: Duration,
    pub(super) result: Result<Vec<Difference>, String>,
}

impl Outcome {
    pub(super) fn is_as_expected(&self) -> bool {
        self.result.as_ref().is_ok_and(Vec::is_empty)
    }

    /// What is wrong, in one line; `None` if nothing is.
    pub(super) fn complaint(&self) -> Option<String> {
        match &self.result {
            Ok(differences) if differences.is_empty() => None,
            Ok(differences) => Some(format!("{} differences", differences.len())),
            Err(problem) => Some(problem.clone()),
        }
    }
}

/// A report in the form of JUnit: a test case a recording. One that was not
/// replayed to its end is an error, differences are a failure.
///
/// # Errors
/// A text holds what XML cannot say.
pub(super) fn report(outcomes: &[Outcome]) -> Result<String, quick_junit::SerializeError> {
    let mut suite = TestSuite::new("backcast regress");
    suite.add_test_cases(outcomes.iter().map(case));
    let mut report = Report::new("backcast");
    report.add_test_suite(suite);
    report.to_string()
}

fn case(outcome: &Outcome) -> TestCase {
    let kind = match &outcome.result {
        Ok(_) => NonSuccessKind::Failure,
        Err(_) => NonSuccessKind::Error,
    };
    let status = match outcome.complaint() {
        None => TestCaseStatus::success(),
        Some(complaint) => {
            let mut status = TestCaseStatus::non_success(kind);
            status.set_message(complaint);
            if let Ok(differences) = &outcome.result {
                status.set_description(table(differences));
            }
            status
        }
    };
    let mut case = TestCase::new(outcome.name.clone(), status);
    case.set_classname("recordings").set_time(outcome.took);
    case
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_names_each_recording_and_what_is_wrong() {
        let outcome = |name: &str, result| Outcome {
            name: name.to_owned(),
            scans: 1,
            took: Duration::from_millis(1500),
            result,
        };
        let difference = Difference {
            stamp_ns: 7,
            what: "verdict",
            expected: "Unique".to_owned(),
            found: "<PoorFit>".to_owned(),
        };
        let text = report(&[
            outcome("sound", Ok(Vec::new())),
            outcome("changed", Ok(vec![difference])),
            outcome("broken", Err("no map".to_owned())),
        ])
        .unwrap();
        for part in [
            "tests=\"3\"",
            "failures=\"1\"",
            "errors=\"1\"",
            "<testcase name=\"sound\"",
            "message=\"1 differences\"",
            "&lt;PoorFit&gt;",
            "message=\"no map\"",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
