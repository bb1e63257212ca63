//! Outcomes of the evaluated files: which requirements are missed, as lines, as exit code, and as a
//! JUnit report for a build server.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::Context;
use command_line::output;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use schemars::JsonSchema;
use serde::Serialize;

/// Options about what is printed and written of the outcomes.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct ReportOptions {
    /// Print JSON, one object per file
    #[arg(long)]
    pub(crate) json: bool,

    /// Write a JUnit report for a build server: a suite per file, a test case for its requirements
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,

    /// Overwrite the files of --junit, --trajectories and --pictures
    #[arg(long)]
    pub(crate) force: bool,

    /// Compare the requirements with the total of all files, not with each file
    #[arg(
        long,
        conflicts_with = "stress",
        help_heading = "Requirements: exit code 1 if a file misses one"
    )]
    pub(crate) total: bool,
}

/// Line of JSON for the figures of all files.
#[derive(Serialize, JsonSchema)]
pub(crate) struct TotalLine<'a, T> {
    total: &'a T,
}

impl ReportOptions {
    pub(crate) fn outcomes(&self) -> anyhow::Result<Outcomes> {
        Outcomes::new("backcast evaluate", self.junit.as_ref(), self.force)
    }
}

pub(crate) fn total_line(total: &impl Serialize) -> String {
    command_line::json::object(&TotalLine { total }) + "\n"
}

pub(crate) struct Outcomes {
    command: &'static str,
    suites: Vec<TestSuite>,
    junit: Option<PathBuf>,
}

impl Outcomes {
    /// Checks that the report of a command can be written, if a file is named.
    pub(crate) fn new(
        command: &'static str,
        junit: Option<&PathBuf>,
        overwrites: bool,
    ) -> anyhow::Result<Self> {
        if let Some(file) = junit {
            output::prepare(file, overwrites)?;
        }
        Ok(Outcomes {
            command,
            suites: Vec::new(),
            junit: junit.cloned(),
        })
    }

    /// Adds a file, or a variant of it; says a sentence for each requirement that it misses.
    pub(crate) fn judged(
        &mut self,
        file: &str,
        variant: Option<&str>,
        missed: &[String],
        say: impl Fn(&str),
    ) {
        let name = variant.map_or(file.to_owned(), |variant| format!("{file}: {variant}"));
        for sentence in missed {
            say(&format!("{name}: {sentence}"));
        }
        let status = match missed {
            [] => TestCaseStatus::success(),
            missed => not_passed(NonSuccessKind::Failure, missed.join("; ")),
        };
        self.add(file, variant.unwrap_or("requirements"), status);
    }

    /// Adds a file that cannot be evaluated, and passes the reason to `say`.
    pub(crate) fn failed(&mut self, file: &str, error: &anyhow::Error, say: impl Fn(&str)) {
        let reason = format!("{error:#}");
        say(&reason);
        self.broken(file, "evaluation", reason);
    }

    pub(crate) fn broken(&mut self, file: &str, case: &str, reason: String) {
        self.add(file, case, not_passed(NonSuccessKind::Error, reason));
    }

    /// Sets the time that the last file took.
    pub(crate) fn took(&mut self, time: Duration) {
        if let Some(suite) = self.suites.last_mut() {
            suite.set_time(time);
        }
    }

    /// Writes the report, if it is wanted, and returns the exit code.
    pub(crate) fn finish(self) -> anyhow::Result<ExitCode> {
        let mut report = Report::new(self.command);
        report.add_test_suites(self.suites);
        if let Some(file) = &self.junit {
            let text = report.to_string().map_err(std::io::Error::other);
            text.and_then(|text| std::fs::write(file, text))
                .with_context(|| format!("cannot write {}", file.display()))?;
        }
        match report.failures + report.errors {
            0 => Ok(ExitCode::SUCCESS),
            _ => Ok(ExitCode::FAILURE),
        }
    }

    fn add(&mut self, file: &str, case: &str, status: TestCaseStatus) {
        let mut case = TestCase::new(case, status);
        case.set_classname(file);
        let last = self.suites.pop_if(|suite| suite.name.as_str() == file);
        let mut suite = last.unwrap_or_else(|| TestSuite::new(file));
        suite.add_test_case(case);
        self.suites.push(suite);
    }
}

fn not_passed(kind: NonSuccessKind, message: String) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(kind);
    status.set_message(message);
    status
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_report_has_a_suite_a_file_and_says_what_is_missed() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("new/report.xml");
        let new = |overwrites| Outcomes::new("backcast evaluate", Some(&file), overwrites);
        let mut outcomes = new(false).unwrap();
        let said = std::cell::RefCell::new(String::new());
        let say = |line: &str| *said.borrow_mut() += &format!("{line}\n");
        outcomes.judged("a.mcap", None, &[], say);
        let missed = ["losses are 2".to_owned(), "the RMS is <9>".to_owned()];
        outcomes.judged("b.mcap", Some("frozen"), &missed, say);
        outcomes.judged("b.mcap", Some("covered"), &[], say);
        outcomes.failed("c.mcap", &anyhow::anyhow!("c.mcap has no map"), say);
        assert_eq!(outcomes.finish().unwrap(), ExitCode::FAILURE);
        let lines =
            "b.mcap: frozen: losses are 2\nb.mcap: frozen: the RMS is <9>\nc.mcap has no map\n";
        assert_eq!(*said.borrow(), lines);
        let text = std::fs::read_to_string(&file).unwrap();
        for part in [
            "tests=\"4\" skipped=\"0\" failures=\"1\" errors=\"1\"",
            "<testsuite name=\"b.mcap\" tests=\"2\"",
            "<testcase name=\"frozen\" classname=\"b.mcap\"",
            "message=\"losses are 2; the RMS is &lt;9&gt;\"",
            "message=\"c.mcap has no map\"",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(new(false).is_err(), "it is there already");
        assert_eq!(new(true).unwrap().finish().unwrap(), ExitCode::SUCCESS);
    }
}
