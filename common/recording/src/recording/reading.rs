//! Decoded messages of a recording, in the order of their log times.

use ros::Cloud;

use super::Recording;
use super::raw::{RawRecord, RawRecords};
use crate::{Channel, Kind, Message, Record, RecordingError, unpack};

/// Iterator over a recording's decoded messages by log time; messages with equal times come in the
/// order of the file.
///
/// A message that does not decode is an error in its place, and the next one
/// follows. Damage of the file is the last item.
pub struct Records<'a> {
    raw: RawRecords<'a>,
}

impl<'a> Records<'a> {
    /// Iterates over the messages of some kinds; `damage` is the last item.
    pub(crate) fn new(
        recording: &'a Recording,
        kinds: &[Kind],
        damage: Option<RecordingError>,
    ) -> Self {
        let kinds = kinds.to_owned();
        let is_wanted = move |channel: &Channel| channel.kind.is_some_and(|k| kinds.contains(&k));
        Records {
            raw: RawRecords::new(recording, is_wanted, damage),
        }
    }

    fn decode(&self, kind: Kind, raw: &RawRecord) -> Result<Record, RecordingError> {
        let channel = raw.channel;
        let path = self.raw.recording().path();
        if channel.encoding != "cdr" {
            return Err(RecordingError::NotCdr {
                path: path.to_owned(),
                topic: channel.topic.to_string(),
                schema: channel.schema.clone(),
                encoding: channel.encoding.clone(),
            });
        }
        let log_time_ns = raw.log_time_ns;
        let unpacked = unpack::message(&raw.body);
        let decode = |body: &[u8]| match self.raw.recording().cloud() {
            Some(cloud) if kind == Kind::Scan && Cloud::is_schema(&channel.schema) => {
                cloud.scan(&channel.schema, body).map(Message::Scan)
            }
            _ => Message::decode(kind, body),
        };
        match unpacked.and_then(|body| decode(&body)) {
            Ok(message) => Ok(Record {
                topic: channel.topic.clone(),
                log_time_ns,
                message,
            }),
            Err(reason) => Err(RecordingError::Message {
                path: path.to_owned(),
                topic: channel.topic.to_string(),
                log_time_ns,
                kind,
                reason,
            }),
        }
    }
}

impl Iterator for Records<'_> {
    type Item = Result<Record, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        match self.raw.next()? {
            Ok(raw) => Some(self.decode(raw.channel.kind?, &raw)),
            Err(error) => Some(Err(error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use crate::write::{Packing, RecordingWriter};

    const PACKINGS: [Packing; 4] = [Packing::Loose, Packing::Plain, Packing::Zstd, Packing::Lz4];

    fn open(bytes: Vec<u8>) -> Recording {
        Recording::from_bytes("r.mcap", bytes).unwrap()
    }

    #[test]
    fn messages_come_by_time_out_of_every_packing() {
        for packing in PACKINGS {
            let recording = open(sample::bytes(packing));
            let records: Vec<Record> = recording.records().map(Result::unwrap).collect();
            assert_eq!(records.len(), sample::records().len(), "{packing:?}");
            let times = records.iter().map(|record| record.log_time_ns);
            assert!(times.is_sorted(), "{packing:?}");
            for record in sample::records() {
                assert!(records.contains(&record), "{packing:?}: {record:?}");
            }
        }
    }

    #[test]
    fn equal_times_keep_the_order_of_the_file() {
        for packing in PACKINGS {
            let mut writer = RecordingWriter::in_memory(packing).unwrap();
            // Two chunks that overlap in time; the topics show the order in the file.
            let pose = &sample::records().pop().unwrap().message;
            for (topic, time) in [("/a", 5), ("/b", 3), ("/c", 5)] {
                writer.write(topic, time, pose).unwrap();
            }
            writer.flush().unwrap();
            for (topic, time) in [("/d", 5), ("/e", 3), ("/f", 1)] {
                writer.write(topic, time, pose).unwrap();
            }
            let recording = sample::opened(writer);
            let topics: Vec<String> = recording
                .records()
                .map(|record| record.unwrap().topic.to_string())
                .collect();
            assert_eq!(topics, ["/f", "/b", "/e", "/a", "/c", "/d"], "{packing:?}");
        }
    }

    #[test]
    fn only_the_kinds_that_are_wanted_come() {
        let recording = open(sample::bytes(Packing::Zstd));
        let records = recording.records_of(&[Kind::Scan, Kind::Map]);
        let kinds = records.map(|record| record.unwrap().message.kind());
        let mut expected = vec![Kind::Scan; sample::SCANS];
        expected.insert(0, Kind::Map);
        assert_eq!(kinds.collect::<Vec<_>>(), expected);
        assert_eq!(recording.records_of(&[]).count(), 0);
    }

    #[test]
    fn a_message_that_does_not_decode_does_not_end_the_recording() {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        let pose = &sample::records().pop().unwrap().message;
        let schema = Kind::Scan.schema();
        writer.write("/pose", 1, pose).unwrap();
        writer
            .write_bytes("/scan", schema, "", "cdr", 2, &[0, 1, 0, 0, 7])
            .unwrap();
        writer.write("/pose", 3, pose).unwrap();
        let recording = sample::opened(writer);
        let items: Vec<_> = recording.records().collect();
        assert!(items[0].is_ok() && items[2].is_ok());
        assert_eq!(
            items[1].as_ref().unwrap_err().to_string(),
            "r.mcap: the message of /scan at log time 2 ns is not a sensor_msgs/msg/LaserScan: \
             unexpected end of input"
        );
    }

    #[test]
    fn a_ros_1_channel_is_refused_with_the_reason() {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        writer
            .write_bytes("/scan", "sensor_msgs/LaserScan", "", "ros1", 1, b"...")
            .unwrap();
        let recording = sample::opened(writer);
        let error = recording.records().next().unwrap().unwrap_err();
        assert_eq!(
            error.to_string(),
            "r.mcap: /scan has sensor_msgs/LaserScan encoded as \"ros1\"; \
             allowed: \"cdr\", as ROS 2 writes it"
        );
    }
}
