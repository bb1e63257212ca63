//! Last pose, stored on disk between runs.

use std::io::Write;
use std::path::{Path, PathBuf};

use command_line::output::folder_of;
use geometry::{Covariance, Pose};
use serde::{Deserialize, Serialize};
use transport::with_causes;

use crate::TrackerError;

/// Largest size of a file in bytes; a pose takes a few hundred.
const MAX_BYTES: u64 = 64 * 1024;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Remembered {
    /// Id of the map as in messages, in hexadecimal.
    pub(crate) map_id: String,
    /// Time of the scan, nanoseconds since 1970.
    pub(crate) stamp_ns: i64,
    /// Pose of the base, metres and radians.
    pub(crate) map_from_base: Pose,
    /// Covariance of x, y and yaw, row by row: m², m·rad, rad².
    pub(crate) covariance: [f64; 9],
}

#[derive(Debug)]
pub(crate) struct Memory {
    file: PathBuf,
}

impl Memory {
    pub(crate) fn new(file: &Path) -> Self {
        Memory { file: file.into() }
    }

    /// Loads the saved pose; `None` if there is no file yet.
    pub(crate) fn load(&self) -> Result<Option<Remembered>, TrackerError> {
        let text = trusted_files::read(&self.file, MAX_BYTES);
        let Some(text) = text.map_err(|error| self.refuse(&with_causes(&error)))? else {
            return Ok(None);
        };
        let found: Remembered = serde_json::from_str(&text).map_err(|error| self.refuse(&error))?;
        let is_sound = found.map_from_base.is_finite()
            && found.covariance.iter().all(|value| value.is_finite())
            && Covariance::from_rows(found.covariance).is_positive_definite();
        match is_sound {
            true => Ok(Some(found)),
            false => Err(self.refuse(&"its pose or covariance is not valid")),
        }
    }

    /// Saves a pose. The file is replaced atomically, so that it stays intact if the power fails.
    pub(crate) fn save(&self, pose: &Remembered) -> Result<(), TrackerError> {
        let text = serde_json::to_string(pose).map_err(|error| self.refuse(&error))?;
        let write = || -> std::io::Result<()> {
            let mut file = tempfile::NamedTempFile::new_in(folder_of(&self.file))?;
            file.write_all(text.as_bytes())?;
            file.as_file().sync_data()?;
            file.persist(&self.file)?;
            Ok(())
        };
        write().map_err(|error| self.refuse(&error))
    }

    fn refuse(&self, reason: &dyn std::fmt::Display) -> TrackerError {
        TrackerError::Memory {
            file: self.file.display().to_string(),
            reason: reason.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_is_remembered_and_what_is_none_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let memory = Memory::new(&folder.path().join("pose.json"));
        assert_eq!(memory.load().unwrap(), None);
        let pose = Remembered {
            map_id: "00ff".into(),
            stamp_ns: 7,
            map_from_base: Pose::new(1.0, 2.0, 0.5),
            covariance: Covariance::from_deviations(0.1, 0.1, 0.01).to_rows(),
        };
        memory.save(&pose).unwrap();
        let later = Remembered {
            stamp_ns: 8,
            ..pose.clone()
        };
        memory.save(&later).unwrap();
        assert_eq!(memory.load().unwrap(), Some(later));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let unsound = Remembered {
            covariance: [0.0; 9],
            ..pose.clone()
        };
        let unsound = serde_json::to_string(&unsound).unwrap();
        for (wrong, reason) in [
            ("{", "EOF"),
            ("{}", "missing field"),
            (&unsound, "is not valid"),
        ] {
            std::fs::write(&memory.file, wrong).unwrap();
            let error = memory.load().unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
            assert!(error.contains("pose.json"), "{error}");
        }
        let nowhere = Memory::new(Path::new("/nowhere/pose.json"));
        assert!(nowhere.save(&pose).is_err());
    }
}
