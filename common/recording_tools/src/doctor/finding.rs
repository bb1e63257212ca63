//! A finding about a recording, with its severity.

use schemars::JsonSchema;
use serde::Serialize;

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Severity {
    /// Worth knowing; everything works.
    Note,
    /// Something will not work as expected.
    Problem,
    /// Recorded data is lost.
    Lost,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub(crate) struct Finding {
    pub severity: Severity,
    /// Description of the fault, and of the remedy.
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
        let word = format!("{:?}", self.severity).to_lowercase();
        write!(f, "  {word:<8} {}", self.finding)
    }
}
