//! Recordings that the figures are of: the shipped ones, and those of the evaluation data.

use std::path::{Path, PathBuf};

use command_line::wrong_use;

/// Start of the rows of a recording, and its file.
pub(super) type Named = (&'static str, &'static str);

pub(super) const SHIPPED: [Named; 3] = [
    ("malaga_corridor", "malaga_corridor/recording.mcap"),
    ("malaga_courtyard", "malaga_courtyard/recording.mcap"),
    ("malaga_campus", "malaga_campus/recording.mcap"),
];

/// Single scans.
pub(super) const QUERIES: [Named; 6] = [
    ("Intel Lab", "intel_queries.mcap"),
    ("Freiburg 079", "fr079_queries.mcap"),
    ("MIT CSAIL", "csail_queries.mcap"),
    ("ACES", "aces_queries.mcap"),
    ("Seattle", "seattle_queries.mcap"),
    ("Wean Hall", "wean_queries.mcap"),
];

pub(super) const DRIVES: [Named; 8] = [
    ("guardian, two", "guardian_two_lasers.mcap"),
    ("fr079", "fr079_sequence.mcap"),
    ("csail", "csail_sequence.mcap"),
    ("guardian, drawn", "guardian_drawn_map.mcap"),
    ("jarvis", "jarvis_circular_nav350.mcap"),
    ("intel", "intel_sequence.mcap"),
    ("wean", "wean_sequence1.mcap"),
    ("seattle", "seattle_sequence.mcap"),
];

/// Folders of the recordings.
#[derive(Debug, Clone)]
pub(super) struct Folders {
    pub(super) shipped: PathBuf,
    /// The evaluation data, if they are given.
    pub(super) data: Option<PathBuf>,
}

impl Folders {
    /// The recordings of a checkout, and `evaluation` in the folder of data.
    pub(super) fn new(root: &Path, data: Option<&Path>) -> anyhow::Result<Self> {
        let evaluation = data.map(|data| data.join("evaluation"));
        for (_, file) in QUERIES.iter().chain(&DRIVES) {
            if let Some(missing) = evaluation
                .iter()
                .map(|e| e.join(file))
                .find(|f| !f.is_file())
            {
                return Err(wrong_use(format!(
                    "there is no {}: --data needs the folder that has evaluation/ with this and \
                     all other recordings that are not in the repository",
                    missing.display()
                )));
            }
        }
        Ok(Folders {
            shipped: root.join("recordings"),
            data: evaluation,
        })
    }

    pub(super) fn shipped(&self) -> [PathBuf; 3] {
        SHIPPED.map(|(_, file)| self.shipped.join(file))
    }
}
