//! What is known of the heading of a recording's scans.
//!
//! The rules are those of the node `accumulator`: odometry is the newest that
//! was measured before the scan, the truth has the time of the scan, and a
//! heading that is missing or too old is refused, never stretched.

use std::collections::BTreeMap;

use engine::localizer::Prior;
use geometry::wrap_angle;
use recording::{Kind, Message, Recording, RecordingError};

use super::TakenScan;
use crate::BackcastError;
use crate::run::{HeadingFrom, degrees};

/// The options about the heading. With none, all headings are searched.
#[derive(Debug, Clone, Default, clap::Args)]
pub(crate) struct HeadingOptions {
    /// The laser's heading in the map, degrees counter-clockwise from its x
    /// axis, -360..=360: only the position is searched
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = degrees)]
    #[arg(conflicts_with = "heading_from")]
    heading: Option<f64>,

    /// Take the heading from here, and search only the position
    #[arg(long, value_name = "SOURCE")]
    heading_from: Option<HeadingFrom>,

    /// From the yaw of the odometry to the heading in the map, degrees,
    /// -360..=360; it drifts, so this is for the start of a recording
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = degrees)]
    // A requirement alone is let go where something excludes it, as --heading
    // excludes --heading-from.
    #[arg(requires = "heading_from", conflicts_with = "heading")]
    heading_offset: Option<f64>,
}

impl HeadingOptions {
    /// Checks what clap cannot.
    pub(crate) fn check(&self) -> Result<(), BackcastError> {
        match (self.heading_offset, self.heading_from) {
            (Some(_), Some(HeadingFrom::Truth)) => Err(BackcastError::OffsetWithoutOdometry),
            _ => Ok(()),
        }
    }
}

/// Odometry that was measured longer before its scan is not used, nanoseconds;
/// the accumulator's default.
const MAX_AGE_NS: i64 = 1_000_000_000;

/// The headings of the scans of one recording, in the map, radians.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Headings {
    /// Nothing is known: all are searched.
    Searched,
    /// Always the same.
    Fixed(f64),
    /// By the time of measuring, with what is added to the yaw.
    Odometry {
        offset: f64,
        readings: BTreeMap<i64, OdometryYaw>,
    },
    /// By the time of the scan.
    Truth(BTreeMap<i64, f64>),
}

/// The yaw of one odometry message, radians, and the frame that it is of.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OdometryYaw {
    yaw: f64,
    child_frame: String,
}

impl Headings {
    /// Reads from the recording what the options ask for.
    ///
    /// # Errors
    /// It is not there, or one of its messages cannot be used.
    pub(crate) fn of(
        options: &HeadingOptions,
        recording: &Recording,
    ) -> Result<Self, RecordingError> {
        Ok(match (options.heading, options.heading_from) {
            (Some(degrees), _) => Headings::Fixed(degrees.to_radians()),
            (None, None) => Headings::Searched,
            (None, Some(HeadingFrom::Odometry)) => Headings::Odometry {
                offset: options.heading_offset.unwrap_or(0.0).to_radians(),
                readings: odometry(recording)?,
            },
            (None, Some(HeadingFrom::Truth)) => {
                recording.required_topic(Kind::PoseStamped)?;
                let truths = recording.ground_truths()?.into_iter();
                Headings::Truth(truths.map(|(ns, truth)| (ns, truth.pose.yaw)).collect())
            }
        })
    }

    /// What a localizer has to be prepared for.
    pub(crate) fn prior(&self) -> Prior {
        match self {
            Headings::Searched => Prior::None,
            _ => Prior::Heading,
        }
    }

    /// The laser's heading when it measured `scan`; `None` where it is to be
    /// searched.
    ///
    /// Odometry of another frame than the scan's is taken for that of the
    /// robot's base, and the mount's yaw is added where it is known; where it is
    /// not, the offset has to hold it.
    ///
    /// # Errors
    /// Nothing that is known belongs to the scan.
    pub(crate) fn of_scan(&self, scan: &TakenScan) -> Result<Option<f64>, BackcastError> {
        let scan_ns = scan.stamp_ns;
        match self {
            Headings::Searched => Ok(None),
            Headings::Fixed(heading) => Ok(Some(*heading)),
            Headings::Truth(headings) => match headings.get(&scan_ns) {
                Some(heading) => Ok(Some(*heading)),
                None => Err(BackcastError::NoTrueHeading),
            },
            Headings::Odometry { offset, readings } => {
                let reading = newest(readings, scan_ns)?;
                let mount = match scan.base_from_laser {
                    Some(mount) if reading.child_frame != scan.frame() => mount.yaw,
                    _ => 0.0,
                };
                Ok(Some(wrap_angle(reading.yaw + mount + offset)))
            }
        }
    }
}

fn newest(
    readings: &BTreeMap<i64, OdometryYaw>,
    scan_ns: i64,
) -> Result<&OdometryYaw, BackcastError> {
    let (measured_ns, reading) = readings
        .range(..=scan_ns)
        .next_back()
        .ok_or(BackcastError::NoOdometry)?;
    match scan_ns.saturating_sub(*measured_ns) {
        ..=MAX_AGE_NS => Ok(reading),
        age_ns => Err(BackcastError::OldOdometry {
            age_ns,
            allowed_ns: MAX_AGE_NS,
        }),
    }
}

fn odometry(recording: &Recording) -> Result<BTreeMap<i64, OdometryYaw>, RecordingError> {
    let topic = recording.required_topic(Kind::Odometry)?;
    let mut readings = BTreeMap::new();
    for record in recording.records_of(&[Kind::Odometry]) {
        let record = match record {
            Ok(record) => record,
            // It lies behind all that can be read, and the scans come to it too.
            Err(RecordingError::Damaged { .. }) => break,
            Err(error) if concerns_other(&error, &topic) => continue,
            Err(error) => return Err(error),
        };
        let Message::Odometry(message) = &record.message else {
            continue;
        };
        if record.topic != topic {
            continue;
        }
        let pose = message.pose.pose.planar();
        let pose = pose.map_err(|source| RecordingError::Unusable {
            path: recording.path().to_owned(),
            topic: topic.to_string(),
            log_time_ns: record.log_time_ns,
            source,
        })?;
        let reading = OdometryYaw {
            yaw: pose.yaw,
            child_frame: message.child_frame_id.clone(),
        };
        readings.insert(message.header.stamp.as_ns(), reading);
    }
    Ok(readings)
}

/// Whether an error is about a message of a channel other than `topic`.
pub(super) fn concerns_other(error: &RecordingError, topic: &str) -> bool {
    match error {
        RecordingError::Message { topic: of, .. } | RecordingError::NotCdr { topic: of, .. } => {
            of != topic
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use geometry::Pose;
    use recording::ros;

    use super::*;

    #[derive(Debug, clap::Parser)]
    struct Line {
        #[command(flatten)]
        heading: HeadingOptions,
    }

    fn options(line: &str) -> HeadingOptions {
        let words = ["x"].into_iter().chain(line.split_whitespace());
        Line::try_parse_from(words).unwrap().heading
    }

    fn scan(stamp_ns: i64, mount_yaw: Option<f64>) -> TakenScan {
        TakenScan {
            stamp_ns,
            base_from_laser: mount_yaw.map(|yaw| Pose::new(0.78, 0.0, yaw)),
            message: ros::LaserScan {
                header: ros::Header {
                    frame_id: "laser".into(),
                    ..ros::Header::default()
                },
                ..ros::LaserScan::default()
            },
        }
    }

    fn by_odometry(readings: &[(i64, f64)], child_frame: &str) -> Headings {
        let reading = |&(ns, yaw): &(i64, f64)| {
            let child_frame = child_frame.to_owned();
            (ns, OdometryYaw { yaw, child_frame })
        };
        Headings::Odometry {
            offset: 0.5,
            readings: readings.iter().map(reading).collect(),
        }
    }

    #[test]
    fn a_searched_heading_is_none_and_a_fixed_one_needs_nothing() {
        let scan = scan(5, None);
        assert_eq!(Headings::Searched.of_scan(&scan).unwrap(), None);
        assert_eq!(Headings::Searched.prior(), Prior::None);
        assert_eq!(Headings::Fixed(1.5).of_scan(&scan).unwrap(), Some(1.5));
        assert_eq!(Headings::Fixed(1.5).prior(), Prior::Heading);
    }

    #[test]
    fn odometry_is_the_newest_before_the_scan() {
        let headings = by_odometry(&[(10, 0.1), (20, 0.2), (30, 0.3)], "laser");
        let at = |ns| headings.of_scan(&scan(ns, Some(1.0))).unwrap().unwrap();
        assert_eq!(at(20), 0.2 + 0.5);
        assert_eq!(at(29), 0.2 + 0.5);
        assert_eq!(at(1000), 0.3 + 0.5);
    }

    #[test]
    fn odometry_of_the_base_is_turned_by_the_mount() {
        let headings = by_odometry(&[(10, 0.25)], "base_link");
        assert_eq!(headings.of_scan(&scan(10, None)).unwrap(), Some(0.75));
        assert_eq!(headings.of_scan(&scan(10, Some(1.0))).unwrap(), Some(1.75));
    }

    #[test]
    fn odometry_that_is_too_old_or_too_new_is_refused() {
        let headings = by_odometry(&[(10, 0.1)], "laser");
        let refusal = |ns| headings.of_scan(&scan(ns, None)).unwrap_err();
        assert!(matches!(refusal(9), BackcastError::NoOdometry));
        assert!(headings.of_scan(&scan(10 + MAX_AGE_NS, None)).is_ok());
        assert!(matches!(
            refusal(11 + MAX_AGE_NS),
            BackcastError::OldOdometry {
                age_ns: 1_000_000_001,
                allowed_ns: MAX_AGE_NS
            }
        ));
        // Times that a file may hold do not overflow.
        let ancient = by_odometry(&[(i64::MIN, 0.1)], "laser");
        assert!(ancient.of_scan(&scan(i64::MAX, None)).is_err());
    }

    #[test]
    fn the_truth_has_exactly_the_time_of_the_scan() {
        let headings = Headings::Truth([(10, 0.1)].into());
        assert_eq!(headings.of_scan(&scan(10, Some(1.0))).unwrap(), Some(0.1));
        let refusal = headings.of_scan(&scan(11, None)).unwrap_err();
        assert!(matches!(refusal, BackcastError::NoTrueHeading));
    }

    #[test]
    fn an_offset_is_for_odometry() {
        assert!(options("--heading 10").check().is_ok());
        assert!(
            options("--heading-from odometry --heading-offset -5")
                .check()
                .is_ok()
        );
        let truth = options("--heading-from truth --heading-offset 5").check();
        assert!(matches!(truth, Err(BackcastError::OffsetWithoutOdometry)));
        for line in ["x --heading 1 --heading-offset 2", "x --heading-offset 2"] {
            assert!(Line::try_parse_from(line.split(' ')).is_err(), "{line}");
        }
    }
}
