//! What is asked of a recording as a whole: its map, the laser's mount, the true
//! poses. Each is taken from the part that is readable.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use map::OccupancyGrid;

use crate::ros::ConversionError;
use crate::{GroundTruth, Kind, Message, Mount, Record, Recording, RecordingError, Records, mount};

impl Recording {
    /// The first map, if the readable part holds one.
    ///
    /// # Errors
    /// If several topics could be meant, or the map is not sound.
    pub fn map(&self) -> Result<Option<OccupancyGrid>, RecordingError> {
        let Some(record) = self.on_topic(Kind::Map)?.next() else {
            return Ok(None);
        };
        let record = record?;
        let Message::Map(map) = &record.message else {
            return Ok(None);
        };
        let grid = map
            .to_grid()
            .map_err(|source| self.unusable(&record, source))?;
        Ok(Some(grid))
    }

    /// Where a laser sits on the robot, if the readable part says so on
    /// `/tf_static`.
    ///
    /// The base is `base_link`, else `base_footprint`, else `base`, with any
    /// prefix that ends in a slash; chains of transforms are followed, and of
    /// several for one frame the latest counts, as in tf2.
    ///
    /// # Errors
    /// If a transform is no rotation, or the laser is not level.
    pub fn base_from_laser(&self, laser: &str) -> Result<Option<Mount>, RecordingError> {
        let mut tree = mount::TransformTree::default();
        for record in self.readable(&[Kind::StaticTransforms]) {
            let record = record?;
            let Message::StaticTransforms(transforms) = &record.message else {
                continue;
            };
            for transform in &transforms.transforms {
                tree.add(transform)
                    .map_err(|source| self.unusable(&record, source))?;
            }
        }
        let Some(mount) = tree.base_from(laser) else {
            return Ok(None);
        };
        if mount.tilt_degrees > mount::MAX_TILT_DEGREES {
            return Err(RecordingError::TiltedLaser {
                path: self.path().to_owned(),
                laser: laser.to_owned(),
                base: mount.base_frame,
                tilt_degrees: mount.tilt_degrees,
            });
        }
        Ok(Some(mount))
    }

    /// The true poses of the readable part, by the stamp of their scan in
    /// nanoseconds; empty where there are none.
    ///
    /// # Errors
    /// If one is not a pose, or two contradict each other.
    pub fn ground_truths(&self) -> Result<BTreeMap<i64, GroundTruth>, RecordingError> {
        let mut truths = BTreeMap::new();
        for record in self.on_topic(Kind::PoseStamped)? {
            let record = record?;
            let Message::PoseStamped(pose) = &record.message else {
                continue;
            };
            let truth = GroundTruth::of(pose).map_err(|source| self.unusable(&record, source))?;
            let stamp_ns = pose.header.stamp.as_ns();
            match truths.entry(stamp_ns) {
                Entry::Vacant(free) => {
                    free.insert(truth);
                }
                Entry::Occupied(other) if *other.get() == truth => {}
                Entry::Occupied(_) => {
                    return Err(RecordingError::TwoTruths {
                        path: self.path().to_owned(),
                        stamp_ns,
                    });
                }
            }
        }
        Ok(truths)
    }

    /// What can be read, without the damage at its end.
    fn readable(&self, kinds: &[Kind]) -> Records<'_> {
        Records::new(self, kinds, None)
    }

    /// The messages of the channel that is meant by a kind.
    fn on_topic(
        &self,
        kind: Kind,
    ) -> Result<impl Iterator<Item = Result<Record, RecordingError>>, RecordingError> {
        let topic = self.topic(kind)?;
        let kinds: &[Kind] = match topic {
            Some(_) => &[kind],
            None => &[],
        };
        let is_meant = move |item: &Result<Record, RecordingError>| {
            let of = match item {
                Ok(record) => &*record.topic,
                Err(
                    RecordingError::Message { topic, .. } | RecordingError::NotCdr { topic, .. },
                ) => topic,
                Err(_) => return true,
            };
            topic.as_deref() == Some(of)
        };
        Ok(self.readable(kinds).filter(is_meant))
    }

    fn unusable(&self, record: &Record, source: ConversionError) -> RecordingError {
        RecordingError::Unusable {
            path: self.path().to_owned(),
            topic: record.topic.to_string(),
            log_time_ns: record.log_time_ns,
            source,
        }
    }
}

#[cfg(test)]
mod tests {
    use geometry::Pose;

    use super::*;
    use crate::ros::{self, PoseStamped};
    use crate::sample;
    use crate::write::{Packing, RecordingWriter};

    fn recording(messages: &[(&str, Message)]) -> Recording {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        for (time, (topic, message)) in messages.iter().enumerate() {
            writer.write(topic, time as i64, message).unwrap();
        }
        let bytes = writer.finish().unwrap().into_inner();
        Recording::from_bytes("r.mcap", bytes).unwrap()
    }

    fn pose(sec: i32, x: f64) -> Message {
        let mut stamped = PoseStamped {
            pose: ros::Pose::from_planar(Pose::new(x, 2.0, 0.5)),
            ..PoseStamped::default()
        };
        stamped.header.stamp.sec = sec;
        stamped.header.frame_id = "map".to_owned();
        Message::PoseStamped(stamped)
    }

    #[test]
    fn a_sample_gives_its_map_truths_and_mount() {
        let bytes = sample::bytes(Packing::Lz4);
        let recording = Recording::from_bytes("r.mcap", bytes).unwrap();
        assert_eq!(recording.damage(), None);
        assert_eq!(recording.map().unwrap().unwrap(), sample::grid());
        let truths = recording.ground_truths().unwrap();
        assert_eq!(truths.len(), sample::SCANS);
        let first = &truths[&sample::stamp_ns(0)];
        assert_eq!(first.frame, "map");
        // Through a quaternion and back: a few units in the last place.
        assert!(first.pose.is_within(sample::truth(0), 1e-12, 1e-12));
        let mount = recording.base_from_laser("laser").unwrap().unwrap();
        assert_eq!(mount.base_frame, "base_link");
        assert!(mount.base_from_laser.is_within(sample::MOUNT, 1e-12, 1e-12));
        assert_eq!(recording.base_from_laser("camera").unwrap(), None);
        let (first, last) = recording.time_range_ns().unwrap();
        assert_eq!(first, sample::stamp_ns(0));
        assert_eq!(last, sample::stamp_ns(sample::SCANS - 1));
    }

    #[test]
    fn what_is_missing_is_named_with_what_is_there() {
        let recording = recording(&[(GOAL, pose(1, 1.0))]);
        let error = recording.required_topic(Kind::Scan).unwrap_err();
        assert_eq!(
            error.to_string(),
            "r.mcap has no sensor_msgs/msg/LaserScan; it has \
             /goal_pose (geometry_msgs/msg/PoseStamped)"
        );
        assert!(recording.map().unwrap().is_none());
        assert!(
            recording.ground_truths().unwrap().is_empty(),
            "a goal is no truth"
        );
        assert_eq!(recording.base_from_laser("laser").unwrap(), None);
        let missing = Recording::open("no/such.mcap").unwrap_err().to_string();
        assert_eq!(missing, "cannot read the recording no/such.mcap");
    }

    const GOAL: &str = "/goal_pose";
    const TRUTH: &str = crate::GROUND_TRUTH;

    #[test]
    fn truths_that_contradict_each_other_are_refused() {
        let equal = recording(&[
            (TRUTH, pose(1, 1.0)),
            (TRUTH, pose(1, 1.0)),
            (GOAL, pose(1, 9.0)),
        ]);
        assert_eq!(equal.ground_truths().unwrap().len(), 1);
        let other = recording(&[(TRUTH, pose(1, 1.0)), (TRUTH, pose(1, 1.1))]);
        assert_eq!(
            other.ground_truths().unwrap_err().to_string(),
            "r.mcap: two ground truths are stamped 1000000000 ns, and differ"
        );
        let nowhere = recording(&[(TRUTH, pose(1, f64::NAN))]);
        let error = nowhere.ground_truths().unwrap_err();
        assert_eq!(
            error.to_string(),
            "r.mcap: the message of /ground_truth at log time 0 ns cannot be used"
        );
        let cause = std::error::Error::source(&error).unwrap();
        assert_eq!(cause.to_string(), "the position (NaN, 2) is not finite");
    }
}
