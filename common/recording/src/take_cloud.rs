//! Choice of a point cloud as the laser of a recording.

use std::sync::Arc;

use ros::{Cloud, CloudOptions};

use crate::cloud::CloudLaser;
use crate::{Channel, Kind, RawRecords, Recording, RecordingError, unpack};

impl Recording {
    /// Takes the point clouds of a topic as the only scans, if the options name one: each is
    /// converted when it is read, by the mount that the options or the transforms of the recording
    /// state.
    pub fn take_cloud(&mut self, options: &CloudOptions) -> Result<(), RecordingError> {
        let Some(topic) = &options.cloud_topic else {
            return Ok(());
        };
        let Some(frame) = self.cloud_frame(topic)? else {
            let found = self.described_channels();
            return Err(RecordingError::lacks(
                self.path(),
                "point cloud",
                topic,
                &found,
            ));
        };
        let (base_frame, mount, notes) = match options.cloud_mount {
            Some(given) => ("base_link".to_owned(), given, Vec::new()),
            None => {
                let (tree, notes) = self.transforms_of(&frame)?;
                let Some((base, mount)) = tree.cloud_mount(None, &frame) else {
                    return Err(RecordingError::Unfit(format!(
                        "{}: no transform says where {frame:?}, the frame of {topic}, sits on the \
                         robot: give its pose by --cloud-mount X,Y,Z,YAW_DEG",
                        self.path().display()
                    )));
                };
                (base, mount, notes)
            }
        };
        let cloud = CloudLaser {
            frame,
            base_frame,
            mount,
            heights: options.heights,
            notes,
        };
        self.set_cloud(Arc::from(topic.as_str()), cloud);
        Ok(())
    }

    fn cloud_frame(&self, topic: &str) -> Result<Option<String>, RecordingError> {
        let is_meant = |channel: &Channel| channel.is_cloud(topic) && channel.encoding == "cdr";
        let Some(first) = RawRecords::new(self, is_meant, None).next().transpose()? else {
            return Ok(None);
        };
        let schema = &first.channel.schema;
        let body = unpack::message(&first.body);
        match body.and_then(|body| Cloud::decode(schema, &body)) {
            Ok(cloud) => Ok(Some(cloud.header().frame_id.clone())),
            Err(reason) => Err(RecordingError::Message {
                path: self.path().to_owned(),
                topic: topic.to_owned(),
                log_time_ns: first.log_time_ns,
                kind: Kind::Scan,
                reason,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use ros::{CustomMsg, CustomPoint, Header, TfMessage, TransformStamped};

    use crate::write::{Packing, RecordingWriter};
    use crate::{Message, Record};

    use super::*;

    const TOPIC: &str = "/livox/lidar";

    /// A recording of one cloud, whose sensor is 0.5 m over `base_link` and 0.75 m over the floor.
    fn recording(has_mount: bool) -> Recording {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        let transform = |parent: &str, child: &str, z: f64| {
            let mut transform = TransformStamped {
                header: Header::new(ros::Time::default(), parent),
                child_frame_id: child.to_owned(),
                ..TransformStamped::default()
            };
            transform.transform.translation.z = z;
            transform
        };
        let transforms = vec![
            transform("base_footprint", "base_link", 0.25),
            transform("base_link", "livox_frame", 0.5),
        ];
        let message = Message::StaticTransforms(TfMessage { transforms });
        if has_mount {
            writer.write("/tf_static", 1, &message).unwrap();
        }
        let point = |x: f32, z: f32| CustomPoint {
            x,
            z,
            ..CustomPoint::default()
        };
        let cloud = CustomMsg {
            header: Header::new(ros::Time::default(), "livox_frame"),
            // 0.65 m and 0.55 m over the floor.
            points: vec![point(1.0, -0.1), point(2.0, -0.2)],
            ..CustomMsg::default()
        };
        let (schema, body) = (
            "livox_ros_driver2/msg/CustomMsg",
            ros::cdr::encode(&cloud).unwrap(),
        );
        writer
            .write_bytes(TOPIC, schema, "", "cdr", 2, &body)
            .unwrap();
        crate::sample::opened(writer)
    }

    fn options(topic: &str, mount: Option<&str>) -> CloudOptions {
        CloudOptions {
            cloud_topic: Some(topic.to_owned()),
            cloud_mount: mount.map(|text| text.parse().unwrap()),
            ..CloudOptions::default()
        }
    }

    fn nearest(recording: &Recording) -> f32 {
        let mut scans = recording.records_of(&[Kind::Scan]);
        let Some(Ok(Record {
            message: Message::Scan(scan),
            ..
        })) = scans.next()
        else {
            panic!("no scan");
        };
        scan.ranges.iter().copied().fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn clouds_are_read_as_scans_by_their_height_over_the_floor() {
        let mut recording = recording(true);
        assert_eq!(recording.topic(Kind::Scan).unwrap(), None);
        recording.take_cloud(&options(TOPIC, None)).unwrap();
        let topic = recording.required_topic(Kind::Scan).unwrap();
        assert_eq!(&*topic, TOPIC);
        assert_eq!(nearest(&recording), 2.0);
        let mount = recording.base_from_laser("livox_frame").unwrap().unwrap();
        assert_eq!((&*mount.base_frame, mount.height_m), ("base_link", 0.75));
    }

    #[test]
    fn a_mount_may_be_given_and_must_be_known() {
        let mut without = recording(false);
        let error = without.take_cloud(&options(TOPIC, None)).unwrap_err();
        assert!(error.to_string().contains("--cloud-mount"), "{error}");
        let given = options(TOPIC, Some("0.3,0,0.6,180"));
        without.take_cloud(&given).unwrap();
        assert_eq!(nearest(&without), 1.0);
        let error = without.take_cloud(&options("/other", None)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "r.mcap has no point cloud on /other; it has /livox/lidar (livox_ros_driver2/msg/CustomMsg)"
        );
    }
}
