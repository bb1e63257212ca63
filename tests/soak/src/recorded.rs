//! Parts of a recording, read after the run.

use std::path::Path;

use command_line::output;
use recording::Recording;
use serde::Serialize;

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub(super) struct Recorded {
    pub(super) parts: u64,
    /// Number of parts whose recorder was killed, which are read up to their last whole chunk.
    pub(super) cut: u64,
    pub(super) messages: u64,
}

impl Recorded {
    /// Reads the parts of a name; adds a failure for each that cannot be read.
    pub(super) fn read(name: &Path, failures: &mut Vec<String>) -> Self {
        let mut recorded = Recorded::default();
        for part in output::numbered(name) {
            match Recording::open(&part) {
                Ok(recording) => {
                    recorded.parts += 1;
                    recorded.cut += u64::from(recording.damage().is_some());
                    recorded.messages += recording.messages();
                }
                Err(error) => failures.push(error.to_string()),
            }
        }
        if recorded.messages == 0 {
            failures.push(format!("nothing was recorded to {}", name.display()));
        }
        recorded
    }
}
