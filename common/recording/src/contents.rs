//! What is asked of a recording as a whole: its map, the laser's mount, the true
//! poses. Each is taken from the part that is readable.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use map::OccupancyGrid;
use ros::{ConversionError, OccupancyGridMsg, RosMessage, TfMessage};

use crate::moving::MovingFrames;
use crate::{
    Channel, GroundTruth, Kind, MAX_TILT_DEGREES, Message, Mount, RawRecords, Record, Recording,
    RecordingError, Records, TF_STATIC, TransformTree, unpack,
};

/// Where a laser sits, as far as a recording says it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mounted {
    /// The mount, if it is known.
    pub mount: Option<Mount>,
    /// What is worth knowing about it, and about transforms that are not sound.
    pub notes: Vec<String>,
}

impl Recording {
    /// The newest map, if the readable part holds one.
    ///
    /// # Errors
    /// If several topics could be meant, or the map is not sound.
    pub fn map(&self) -> Result<Option<OccupancyGrid>, RecordingError> {
        let mut newest = None;
        for record in self.on_topic(Kind::Map)? {
            newest = Some(record?);
        }
        let Some(record) = newest else {
            return Ok(None);
        };
        let Message::Map(map) = &record.message else {
            return Ok(None);
        };
        let grid = map
            .to_grid()
            .map_err(|source| self.unusable(&record, source))?;
        Ok(Some(grid))
    }

    /// All maps of the readable part with their log times in nanoseconds, by these.
    /// One that does not decode is an error in its place.
    ///
    /// # Errors
    /// If several topics could be meant.
    pub fn maps(
        &self,
    ) -> Result<
        impl Iterator<Item = Result<(i64, OccupancyGridMsg), RecordingError>> + use<'_>,
        RecordingError,
    > {
        let maps = self.on_topic(Kind::Map)?;
        Ok(maps.filter_map(|record| match record {
            Ok(Record {
                log_time_ns,
                message: Message::Map(map),
                ..
            }) => Some(Ok((log_time_ns, map))),
            Ok(_) => None,
            Err(error) => Some(Err(error)),
        }))
    }

    /// Where a laser sits on the robot, if the readable part says so.
    ///
    /// # Errors
    /// As [`Recording::mounted`].
    pub fn base_from_laser(&self, laser: &str) -> Result<Option<Mount>, RecordingError> {
        Ok(self.mounted(laser)?.mount)
    }

    /// Where a laser sits on the robot, if the readable part says so on
    /// `/tf_static`, or on `/tf` by transforms that are always the same.
    ///
    /// The base is `base_link`, else `base_footprint`, else `base`, with any
    /// prefix that ends in a slash; chains of transforms are followed, and of
    /// several for one frame the latest counts, as in tf2. A transform that is not
    /// sound is a note, unless the laser's place depends on it.
    ///
    /// # Errors
    /// If the laser's place depends on a transform that is invalid, or the laser is
    /// neither level nor upside down.
    pub fn mounted(&self, laser: &str) -> Result<Mounted, RecordingError> {
        let (mut tree, mut notes) = self.fixed_transforms()?;
        notes.extend(tree.notes());
        if tree.base_from(laser).is_none() {
            if let Some((parent, child, error)) = tree.broken_below(laser) {
                return Err(RecordingError::BrokenMount {
                    path: self.path().to_owned(),
                    laser: laser.to_owned(),
                    transform: format!("from {parent} to {child}"),
                    reason: error.to_string(),
                });
            }
            notes.extend(self.add_still(&mut tree, laser)?);
        }
        let mount = tree.base_from(laser);
        match mount {
            Some(mount) if mount.tilt_degrees > MAX_TILT_DEGREES => {
                Err(RecordingError::TiltedLaser {
                    path: self.path().to_owned(),
                    laser: laser.to_owned(),
                    base: mount.base_frame,
                    tilt_degrees: mount.tilt_degrees,
                })
            }
            mount => Ok(Mounted { mount, notes }),
        }
    }

    /// What stands on `/tf_static`, and which messages there do not decode.
    fn fixed_transforms(&self) -> Result<(TransformTree, Vec<String>), RecordingError> {
        let (mut tree, mut notes) = (TransformTree::default(), Vec::new());
        for record in self.readable(&[Kind::StaticTransforms]) {
            match record {
                Ok(Record {
                    message: Message::StaticTransforms(message),
                    ..
                }) => message.transforms.iter().for_each(|t| tree.take(t)),
                Ok(_) => {}
                Err(error @ RecordingError::Message { .. }) => notes.push(error.to_string()),
                Err(error) => return Err(error),
            }
        }
        Ok((tree, notes))
    }

    /// Adds to a tree what stands on `/tf` and does not move; says what came of it.
    fn add_still(
        &self,
        tree: &mut TransformTree,
        laser: &str,
    ) -> Result<Option<String>, RecordingError> {
        let is_meant = |channel: &Channel| {
            let schema = channel.schema == TfMessage::SCHEMA && channel.encoding == "cdr";
            schema && channel.topic.ends_with("/tf")
        };
        let mut frames = MovingFrames::default();
        for record in RawRecords::new(self, is_meant, None) {
            let record = record?;
            let body = unpack::message(&record.body);
            // Others than the laser's are in nobody's way.
            if let Ok(message) = body.and_then(|body| ros::cdr::decode::<TfMessage>(&body)) {
                message.transforms.iter().for_each(|t| frames.see(t));
            }
        }
        frames.add_still(tree);
        if tree.base_from(laser).is_some() {
            return Ok(Some(format!(
                "the mount of {laser} is taken from /tf, where it does not move"
            )));
        }
        let moves = frames.moving_below(tree, laser);
        Ok(moves.map(|(frame, metres, angle)| {
            let degrees = angle.to_degrees();
            format!(
                "{TF_STATIC} does not say where {laser} sits, and on /tf {frame} moves by \
                 {metres:.3} m and {degrees:.1} degrees: poses are of the laser"
            )
        }))
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
    ) -> Result<impl Iterator<Item = Result<Record, RecordingError>> + use<'_>, RecordingError>
    {
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
    use crate::sample;
    use crate::write::{Packing, RecordingWriter};
    use ros::{PoseStamped, TfMessage, TransformStamped};

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

    fn transform(parent: &str, child: &str, x: f64, turn: ros::Quaternion) -> TransformStamped {
        let mut transform = TransformStamped::default();
        transform.header.frame_id = parent.to_owned();
        transform.child_frame_id = child.to_owned();
        transform.transform.translation.x = x;
        transform.transform.rotation = turn;
        transform
    }

    fn fixed(transforms: Vec<TransformStamped>) -> Message {
        Message::StaticTransforms(TfMessage { transforms })
    }

    const LEVEL: ros::Quaternion = ros::Quaternion {
        x: 0.0,
        y: 0.0,
        z: 0.0,
        w: 1.0,
    };

    #[test]
    fn a_laser_upside_down_is_taken_and_one_on_its_side_is_not() {
        let (half, quarter) = ((1.0, 0.0), (0.5_f64.sqrt(), 0.5_f64.sqrt()));
        let mounted = |(x, w): (f64, f64)| {
            let turn = ros::Quaternion { x, w, ..LEVEL };
            let laser = transform("base_link", "laser", 0.5, turn);
            recording(&[(crate::TF_STATIC, fixed(vec![laser]))]).base_from_laser("laser")
        };
        let mount = mounted(half).unwrap().unwrap();
        assert!(
            mount.upside_down && mount.base_from_laser.x == 0.5,
            "{mount:?}"
        );
        let error = mounted(quarter).unwrap_err().to_string();
        assert!(
            error.contains("laser is tilted by 90 degrees against base_link"),
            "{error}"
        );
    }

    #[test]
    fn the_newest_map_is_the_map_and_all_are_given_out() {
        let map = |cells: [i8; 2]| {
            let mut map = OccupancyGridMsg {
                data: cells.to_vec(),
                ..OccupancyGridMsg::default()
            };
            (map.info.width, map.info.height, map.info.resolution) = (2, 1, 0.5);
            Message::Map(map)
        };
        let recording = recording(&[(crate::MAP, map([0, 0])), (crate::MAP, map([0, 100]))]);
        assert_eq!(recording.map().unwrap().unwrap().cells, [0, 100]);
        let maps = recording.maps().unwrap().map(Result::unwrap);
        let maps: Vec<_> = maps.map(|(time, map)| (time, map.data)).collect();
        assert_eq!(maps, [(0, vec![0, 0]), (1, vec![0, 100])]);
    }

    #[test]
    fn a_transform_that_is_none_is_a_note_unless_the_laser_needs_it() {
        let broken = |child: &str| transform("base_link", child, f64::NAN, LEVEL);
        let recording = recording(&[(
            crate::TF_STATIC,
            fixed(vec![
                transform("base_link", "laser", 0.5, LEVEL),
                broken("camera"),
            ]),
        )]);
        let mounted = recording.mounted("laser").unwrap();
        assert_eq!(mounted.mount.unwrap().base_from_laser.x, 0.5);
        assert_eq!(
            mounted.notes,
            [
                "the transform from base_link to camera is ignored: the position (NaN, 0) is not finite"
            ]
        );
        assert_eq!(
            recording.mounted("camera").unwrap_err().to_string(),
            "r.mcap: the mount of camera is not known, for the transform from base_link to camera is \
             invalid: the position (NaN, 0) is not finite"
        );
    }

    /// A recording with these transforms on /tf, each with odometry's own.
    fn on_tf(lasers: &[TransformStamped]) -> Recording {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        for (time, laser) in (0..).zip(lasers) {
            let odometry = transform("odom", "base_link", time as f64, LEVEL);
            let message = TfMessage {
                transforms: vec![odometry, laser.clone()],
            };
            let body = ros::cdr::encode(&message).unwrap();
            writer
                .write_bytes("/tf", TfMessage::SCHEMA, "", "cdr", time, &body)
                .unwrap();
        }
        let bytes = writer.finish().unwrap().into_inner();
        Recording::from_bytes("r.mcap", bytes).unwrap()
    }

    #[test]
    fn a_mount_on_tf_is_taken_where_it_does_not_move() {
        let laser = |x: f64| transform("base_link", "laser", x, LEVEL);
        let still = on_tf(&[laser(0.5), laser(0.5004), laser(0.5)]);
        let mounted = still.mounted("laser").unwrap();
        assert_eq!(mounted.mount.unwrap().base_from_laser.x, 0.5);
        assert_eq!(
            mounted.notes,
            ["the mount of laser is taken from /tf, where it does not move"]
        );
        let moving = on_tf(&[laser(0.5), laser(0.52)]).mounted("laser").unwrap();
        assert_eq!(moving.mount, None);
        assert_eq!(
            moving.notes,
            [
                "/tf_static does not say where laser sits, and on /tf laser moves by 0.020 m and 0.0 \
              degrees: poses are of the laser"
            ]
        );
        let unknown = still.mounted("camera").unwrap();
        assert_eq!(unknown, Mounted::default());
    }

    #[test]
    fn the_channel_that_the_user_names_is_meant() {
        let mut recording = recording(&[(TRUTH, pose(1, 1.0)), (GOAL, pose(1, 9.0))]);
        let of_goal = "geometry_msgs/msg/PoseStamped";
        recording.prefer(Kind::PoseStamped, GOAL).unwrap();
        let truths = recording.ground_truths().unwrap();
        assert_eq!(truths.values().next().unwrap().pose.x, 9.0);
        let refusal = recording.prefer(Kind::PoseStamped, "/scan").unwrap_err();
        assert_eq!(
            refusal.to_string(),
            format!("r.mcap has no {of_goal} on /scan; it has /ground_truth, /goal_pose")
        );
    }
}
