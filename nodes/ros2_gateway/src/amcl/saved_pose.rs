//! The last pose on disk, in AMCL's file and format.

use std::io::Write;
use std::path::Path;

use command_line::output::folder_of;
use geometry::Pose;
use messages::PoseHeader;
use ros::Time;
use serde::Deserialize;

use crate::GatewayError;

/// Largest size of the file, bytes: it has six lines.
const MAX_BYTES: u64 = 4096;

/// Content of the file; AMCL writes `z`, too, and older versions no frame.
#[derive(Debug, Deserialize)]
struct Kept {
    frame_id: Option<String>,
    x: f64,
    y: f64,
    yaw: f64,
}

/// Pose to be saved, and the time of the last saving.
#[derive(Debug, Default)]
pub(super) struct SavedPose {
    /// Last unique pose and the time of its scan in nanoseconds, if it is not saved yet.
    last: Option<(Pose, i64)>,
    saved_ns: Option<i64>,
}

impl SavedPose {
    /// Takes the tracker's pose at a scan; a doubtful one is not kept.
    pub(super) fn take(&mut self, header: &PoseHeader) {
        if header.is_unique() && header.mount_known == 1 {
            self.last = Some((header.map_from_base.into(), header.stamp.measured_ns));
        }
    }

    pub(super) fn forget(&mut self) {
        self.last = None;
    }

    /// Returns the pose to save now, at most `rate` times a second; never if that is 0 or below.
    pub(super) fn due(&mut self, rate: f64, now_ns: i64) -> Option<(Pose, i64)> {
        let since_ns = self
            .saved_ns
            .map(|saved_ns| now_ns.saturating_sub(saved_ns));
        let is_due = since_ns.is_none_or(|since_ns| since_ns as f64 * rate >= 1e9);
        if rate <= 0.0 || !is_due {
            return None;
        }
        let due = self.last.take()?;
        self.saved_ns = Some(now_ns);
        Some(due)
    }

    pub(super) fn left(&mut self, rate: f64) -> Option<(Pose, i64)> {
        self.last.take().filter(|_| rate > 0.0)
    }
}

/// Checks that the parameter alone decides which file is written, and not another user who puts a
/// link in its place.
pub(super) fn check(file: &Path) -> Result<(), GatewayError> {
    trusted_files::check_place(file).map_err(|error| refused(file, &transport::with_causes(&error)))
}

/// Replaces the file atomically, so that it is always complete; only its owner can read it. A link
/// in its place is replaced and not followed.
pub(super) fn save(
    file: &Path,
    map_frame: &str,
    (pose, measured_ns): (Pose, i64),
) -> Result<(), GatewayError> {
    check(file)?;
    let Pose { x, y, yaw } = pose;
    let Time { sec, nanosec } = Time::from_ns(measured_ns).unwrap_or_default();
    let frame = serde_json::Value::from(map_frame);
    let text = format!(
        "timestamp: {sec}.{nanosec:09}\nframe_id: {frame}\nx: {x:?}\ny: {y:?}\nz: 0.0\n\
         yaw: {yaw:?}\n"
    );
    let write = || -> std::io::Result<()> {
        let mut written = tempfile::NamedTempFile::new_in(folder_of(file))?;
        written.write_all(text.as_bytes())?;
        written.persist(file)?;
        Ok(())
    };
    write().map_err(|error| refused(file, &error))
}

/// Reads the pose of the file; `None` if there is no file.
pub(super) fn load(file: &Path, map_frame: &str) -> Result<Option<Pose>, GatewayError> {
    let refuse = |reason: &dyn std::fmt::Display| Err(refused(file, reason));
    let text = match trusted_files::read(file, MAX_BYTES) {
        Ok(Some(text)) => text,
        Ok(None) => return Ok(None),
        Err(error) => return refuse(&transport::with_causes(&error)),
    };
    let kept: Kept = match serde_saphyr::from_str(&text) {
        Ok(kept) => kept,
        Err(error) => return refuse(&error),
    };
    let pose = Pose::new(kept.x, kept.y, kept.yaw);
    let bare = |frame: &str| frame.trim_start_matches('/').to_owned();
    match kept.frame_id {
        Some(frame) if bare(&frame) != bare(map_frame) => {
            refuse(&format!("its frame is {frame:?}: allowed is {map_frame:?}"))
        }
        _ if !pose.is_finite() => refuse(&format!("its pose is {pose:?}: allowed are numbers")),
        _ => Ok(Some(pose)),
    }
}

fn refused(file: &Path, reason: &dyn std::fmt::Display) -> GatewayError {
    GatewayError::Refused(format!(
        "the saved pose in {} cannot be used: {reason}",
        file.display()
    ))
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{Stamp, TrackState};

    use super::*;

    const S: i64 = 1_000_000_000;

    fn header(state: TrackState, x: f64) -> PoseHeader {
        PoseHeader {
            stamp: Stamp::measured_at(7 * S),
            state: state as u32,
            pose_known: 1,
            mount_known: 1,
            map_from_base: Pose::new(x, 0.0, 0.0).into(),
            ..PoseHeader::zeroed()
        }
    }

    #[test]
    fn the_last_sure_pose_is_saved_at_most_at_the_rate() {
        let mut saved = SavedPose::default();
        saved.take(&header(TrackState::Unique, 1.0));
        saved.take(&header(TrackState::Doubtful, 2.0));
        assert_eq!(saved.due(0.0, 0), None, "never");
        let x = |due: Option<(Pose, i64)>| due.map(|(pose, at)| (pose.x, at));
        assert_eq!(x(saved.due(0.5, 10 * S)), Some((1.0, 7 * S)));
        assert_eq!(saved.due(0.5, 20 * S), None, "it is saved already");
        saved.take(&header(TrackState::Unique, 3.0));
        assert_eq!(saved.due(0.5, 11 * S), None, "too early");
        assert_eq!(x(saved.due(0.5, 12 * S)), Some((3.0, 7 * S)));
        saved.take(&header(TrackState::Unique, 4.0));
        assert_eq!(x(saved.left(0.5)), Some((4.0, 7 * S)));
        saved.take(&header(TrackState::Unique, 5.0));
        saved.forget();
        assert_eq!(saved.left(0.5), None);
    }

    #[test]
    fn a_pose_comes_back_from_its_file_and_so_do_those_of_amcl() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pose");
        let file = &*path;
        assert_eq!(load(file, "map").unwrap(), None, "there is no file");
        let pose = Pose::new(1.25, -2.5, 0.1 + 0.2);
        for _ in 0..2 {
            save(file, "map", (pose, 1_738_678_400_123_456_789)).unwrap();
        }
        let text = std::fs::read_to_string(file).unwrap();
        assert!(
            text.starts_with("timestamp: 1738678400.123456789\nframe_id: \"map\"\n"),
            "{text}"
        );
        assert_eq!(load(file, "map").unwrap(), Some(pose));
        // Nothing else is left in the folder.
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let older = "# AMCL Saved Pose\nx: 3.0\ny: 4.0\nz: 0.0\nyaw: 0.785\n";
        std::fs::write(file, older).unwrap();
        assert_eq!(load(file, "map").unwrap(), Some(Pose::new(3.0, 4.0, 0.785)));
        for (wrong, reason) in [
            ("", "x"),
            ("x: 1.0\ny: 2.0\n", "yaw"),
            ("x: .nan\ny: 2.0\nyaw: 0.0\n", "allowed are numbers"),
            (
                "frame_id: odom\nx: 1.0\ny: 2.0\nyaw: 0.0\n",
                "\"odom\": allowed is \"map\"",
            ),
        ] {
            std::fs::write(file, wrong).unwrap();
            let error = load(file, "map").unwrap_err().to_string();
            assert!(error.contains(reason) && error.contains("pose"), "{error}");
        }
        assert!(save(Path::new("/nowhere/pose"), "map", (pose, 0)).is_err());
    }

    #[test]
    fn what_stands_in_the_place_of_the_file_is_neither_read_nor_written() {
        let folder = tempfile::tempdir().unwrap();
        let (path, private) = (folder.path().join("pose"), folder.path().join("private"));
        std::fs::write(&private, "x: 3.0\ny: 4.0\nyaw: 0.785\n").unwrap();
        std::os::unix::fs::symlink(&private, &path).unwrap();
        let pose = Pose::new(1.25, -2.5, 0.5);
        assert!(save(&path, "map", (pose, 0)).is_err());
        assert!(load(&path, "map").is_err());
        assert!(std::fs::read_to_string(&private).unwrap().starts_with("x"));
        std::fs::remove_file(&path).unwrap();
        save(&path, "map", (pose, 0)).unwrap();
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(&path).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
    }
}
