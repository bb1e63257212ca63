//! Data of a recording as a whole, taken from its readable part: map, mount of the laser, true
//! poses.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use map::OccupancyGrid;
use ros::{ConversionError, OccupancyGridMsg, RosMessage, TfMessage, TransformStamped};

use crate::moving::MovingFrames;
use crate::{
    Channel, GroundTruth, Kind, MAX_TILT_DEGREES, Message, Mount, RawRecords, Record, Recording,
    RecordingError, Records, TF_STATIC, TransformTree, unpack,
};

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mounted {
    pub mount: Option<Mount>,
    /// Notes on its source, and on invalid transforms.
    pub notes: Vec<String>,
}

impl Recording {
    /// Returns the newest map of the readable part, if there is one.
    pub fn map(&self) -> Result<Option<OccupancyGrid>, RecordingError> {
        let mut newest = None;
        for map in self.maps()? {
            newest = Some(map?);
        }
        let Some((log_time_ns, map)) = newest else {
            return Ok(None);
        };
        let topic = self.topic(Kind::Map)?.unwrap_or_default();
        let unusable = |source| self.unusable(&topic, log_time_ns, source);
        map.to_grid().map(Some).map_err(unusable)
    }

    /// Iterates over all maps of the readable part by log time, with that time in nanoseconds. A
    /// map that does not decode is an error in its place.
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

    pub fn base_from_laser(&self, laser: &str) -> Result<Option<Mount>, RecordingError> {
        Ok(self.mounted(laser)?.mount)
    }

    /// Returns the mount of a laser, if the readable part has it on `/tf_static`, or on `/tf` by
    /// transforms that never change.
    ///
    /// The base is the child frame of the odometry, or of `odom` on `/tf`; if the laser is not
    /// below that in the tree, it is `base_link`, else `base_footprint`, else `base`, with any
    /// prefix that ends in a slash. Chains of transforms are followed; if one frame has several
    /// transforms, the latest counts, as in tf2. An invalid transform is a note, unless the laser's
    /// mount depends on it.
    pub fn mounted(&self, laser: &str) -> Result<Mounted, RecordingError> {
        if let Some(cloud) = self.cloud().filter(|cloud| cloud.frame == laser) {
            return Ok(Mounted {
                mount: Some(cloud.mount()),
                notes: cloud.notes.clone(),
            });
        }
        let (tree, notes) = self.transforms_of(laser)?;
        let mount = tree.base_from(laser);
        match mount {
            Some(mount) if mount.tilt_degrees > MAX_TILT_DEGREES => {
                Err(RecordingError::Unfit(format!(
                    "{}: {laser} is tilted by {:.0} degrees against {}; allowed: 10, also upside \
                     down, for what it sees is not the plane of the map",
                    self.path().display(),
                    mount.tilt_degrees,
                    mount.base_frame
                )))
            }
            mount => Ok(Mounted { mount, notes }),
        }
    }

    /// Returns the transforms that the mount of a laser depends on, and notes about them.
    pub(crate) fn transforms_of(
        &self,
        laser: &str,
    ) -> Result<(TransformTree, Vec<String>), RecordingError> {
        let (mut tree, mut notes) = self.fixed_transforms()?;
        notes.extend(tree.notes());
        if let Some(child) = self.moved_frame() {
            tree.on_odometry(&child);
        }
        if tree.base_from(laser).is_none() {
            if let Some((parent, child, error)) = tree.broken_below(laser) {
                return Err(RecordingError::Unfit(format!(
                    "{}: the mount of {laser} is not known, for the transform from {parent} to \
                     {child} is invalid: {error}",
                    self.path().display()
                )));
            }
            notes.extend(self.add_still(&mut tree, laser)?);
        }
        Ok((tree, notes))
    }

    /// Returns the child frame of odometry: that of the first odometry message, or if there is no
    /// odometry, the first child of `odom` on `/tf`.
    fn moved_frame(&self) -> Option<String> {
        match self.topic(Kind::Odometry) {
            Ok(None) => self.moving_transforms().find_map(|message| {
                let of_odom =
                    |t: &&TransformStamped| t.header.frame_id.rsplit('/').next() == Some("odom");
                let found = message.ok()?;
                let found = found.transforms.iter().find(of_odom)?;
                Some(found.child_frame_id.clone())
            }),
            Ok(Some(_)) => self
                .on_topic(Kind::Odometry)
                .ok()?
                .find_map(|record| match record {
                    Ok(Record {
                        message: Message::Odometry(odometry),
                        ..
                    }) => Some(odometry.child_frame_id),
                    _ => None,
                }),
            // The choice between several topics is left to other callers.
            Err(_) => None,
        }
    }

    /// Messages on `/tf`; those that do not decode are left out.
    fn moving_transforms(&self) -> impl Iterator<Item = Result<TfMessage, RecordingError>> + '_ {
        let is_meant = |channel: &Channel| {
            let schema = channel.schema == TfMessage::SCHEMA && channel.encoding == "cdr";
            schema && channel.topic.ends_with("/tf")
        };
        RawRecords::new(self, is_meant, None).filter_map(|record| {
            let record = match record {
                Ok(record) => record,
                Err(error) => return Some(Err(error)),
            };
            let body = unpack::message(&record.body).ok()?;
            ros::cdr::decode::<TfMessage>(&body).ok().map(Ok)
        })
    }

    /// Transforms on `/tf_static`, and errors of messages there that do not decode.
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

    /// Adds the transforms on `/tf` that do not move; returns a note about the result.
    fn add_still(
        &self,
        tree: &mut TransformTree,
        laser: &str,
    ) -> Result<Option<String>, RecordingError> {
        let mut frames = MovingFrames::default();
        for message in self.moving_transforms() {
            message?.transforms.iter().for_each(|t| frames.see(t));
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

    /// Returns the true poses of the readable part, by the stamp of their scan in nanoseconds;
    /// empty if there are none.
    pub fn ground_truths(&self) -> Result<BTreeMap<i64, GroundTruth>, RecordingError> {
        let mut truths = BTreeMap::new();
        for record in self.on_topic(Kind::PoseStamped)? {
            let record = record?;
            let Message::PoseStamped(pose) = &record.message else {
                continue;
            };
            let truth = GroundTruth::of(pose)
                .map_err(|source| self.unusable(&record.topic, record.log_time_ns, source))?;
            let stamp_ns = pose.header.stamp.as_ns();
            match truths.entry(stamp_ns) {
                Entry::Vacant(free) => {
                    free.insert(truth);
                }
                Entry::Occupied(other) if *other.get() == truth => {}
                Entry::Occupied(_) => {
                    return Err(RecordingError::Unfit(format!(
                        "{}: two ground truths are stamped {stamp_ns} ns, and differ",
                        self.path().display()
                    )));
                }
            }
        }
        Ok(truths)
    }

    /// Iterates over the readable messages, without the damage at the end.
    fn readable(&self, kinds: &[Kind]) -> Records<'_> {
        Records::new(self, kinds, None)
    }

    /// Iterates over the messages of the selected channel of a kind.
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
                Ok(record) => Some(&*record.topic),
                Err(error) => error.topic(),
            };
            of.is_none_or(|of| topic.as_deref() == Some(of))
        };
        Ok(self.readable(kinds).filter(is_meant))
    }

    /// Error of a message whose values cannot be used.
    pub fn unusable(
        &self,
        topic: &str,
        log_time_ns: i64,
        source: ConversionError,
    ) -> RecordingError {
        RecordingError::Unusable {
            path: self.path().to_owned(),
            topic: topic.to_owned(),
            log_time_ns,
            source,
        }
    }
}

#[cfg(test)]
mod tests;
