//! Last pose, stored on disk between runs.

use std::io::Write;
use std::path::Path;

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

/// Loads the saved pose; `None` if there is no file yet.
pub(crate) fn load(file: &Path) -> Result<Option<Remembered>, TrackerError> {
    let text = trusted_files::read(file, MAX_BYTES);
    let Some(text) = text.map_err(|error| refused(file, &with_causes(&error)))? else {
        return Ok(None);
    };
    let found: Remembered = serde_json::from_str(&text).map_err(|error| refused(file, &error))?;
    let is_sound = found.map_from_base.is_finite()
        && found.covariance.iter().all(|value| value.is_finite())
        && Covariance::from_rows(found.covariance).is_positive_definite();
    match is_sound {
        true => Ok(Some(found)),
        false => Err(refused(file, &"its pose or covariance is not valid")),
    }
}

/// Saves a pose. The file is replaced atomically, so that it stays intact if the power fails.
pub(crate) fn save(file: &Path, pose: &Remembered) -> Result<(), TrackerError> {
    let text = serde_json::to_string(pose).map_err(|error| refused(file, &error))?;
    let write = || -> std::io::Result<()> {
        let mut written = tempfile::NamedTempFile::new_in(folder_of(file))?;
        written.write_all(text.as_bytes())?;
        written.as_file().sync_data()?;
        written.persist(file)?;
        Ok(())
    };
    write().map_err(|error| refused(file, &error))
}

fn refused(file: &Path, reason: &dyn std::fmt::Display) -> TrackerError {
    TrackerError::Memory {
        file: file.display().to_string(),
        reason: reason.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_is_remembered_and_what_is_none_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pose.json");
        assert_eq!(load(&file).unwrap(), None);
        let pose = Remembered {
            map_id: "00ff".into(),
            stamp_ns: 7,
            map_from_base: Pose::new(1.0, 2.0, 0.5),
            covariance: Covariance::from_deviations(0.1, 0.1, 0.01).to_rows(),
        };
        save(&file, &pose).unwrap();
        let later = Remembered {
            stamp_ns: 8,
            ..pose.clone()
        };
        save(&file, &later).unwrap();
        assert_eq!(load(&file).unwrap(), Some(later));
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
            std::fs::write(&file, wrong).unwrap();
            let error = load(&file).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
            assert!(error.contains("pose.json"), "{error}");
        }
        assert!(save(Path::new("/nowhere/pose.json"), &pose).is_err());
    }
}
