//! A finding about a recording, with its severity.

use serde::Serialize;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Severity {
    /// Worth knowing; everything works.
    Note,
    /// Something will not work as one would expect.
    Problem,
    /// Something that was recorded is not there any more.
    Lost,
}

/// One finding.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Finding {
    pub severity: Severity,
    /// What was found, and what would be right.
    pub finding: String,
}

impl Finding {
    pub(crate) fn note(finding: impl Into<String>) -> Self {
        Finding::new(Severity::Note, finding)
    }

    pub(crate) fn problem(finding: impl Into<String>) -> Self {
        Finding::new(Severity::Problem, finding)
    }

    pub(crate) fn lost(finding: impl Into<String>) -> Self {
        Finding::new(Severity::Lost, finding)
    }

    fn new(severity: Severity, finding: impl Into<String>) -> Self {
        Finding {
            severity,
            finding: finding.into(),
        }
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let word = match self.severity {
            Severity::Note => "note",
            Severity::Problem => "problem",
            Severity::Lost => "lost",
        };
        write!(f, "  {word:<8} {}", self.finding)
    }
}
