use geometry::Pose;
use recording::write::{Packing, RecordingWriter};
use ros::{LaserScan, PoseStamped, Time};

use super::*;

const SECOND: i64 = 1_000_000_000;

fn header(second: i32, frame: &str) -> ros::Header {
    let ns = i64::from(second) * SECOND + 5;
    ros::Header::new(Time::from_ns(ns).unwrap(), frame)
}

fn scan(second: i32, frame: &str) -> Message {
    Message::Scan(LaserScan {
        header: header(second, frame),
        angle_min: -1.5,
        angle_increment: 0.25,
        range_max: 80.0,
        ranges: vec![1.0, f32::NAN, f32::INFINITY, -1.0],
        ..LaserScan::default()
    })
}

fn truth(second: i32) -> Message {
    Message::PoseStamped(PoseStamped {
        header: header(second, "map"),
        pose: ros::Pose::from_planar(Pose::new(1.0, 2.0, 0.5)),
    })
}

fn recording(messages: &[(&str, Message)]) -> Recording {
    let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
    for (second, (topic, message)) in (0..).zip(messages) {
        writer.write(topic, second * SECOND, message).unwrap();
    }
    let bytes = writer.finish().unwrap().into_inner();
    Recording::from_bytes("world.mcap", bytes).unwrap()
}

fn play(recording: &Recording) -> Vec<Result<Timed, PlaybackError>> {
    let all = Selection::all();
    Source::new(recording, Channels::of(recording, &all).unwrap(), all).collect()
}

fn scan_in(played: &Result<Timed, PlaybackError>) -> (&ScanHeader, &[f32]) {
    match &played.as_ref().unwrap().content {
        Content::Scan(header, ranges) => (header, ranges),
        other => panic!("{other:?}"),
    }
}

#[test]
fn readings_pass_as_they_are_and_the_mount_comes_with_them() {
    let mut transform = ros::TransformStamped {
        header: header(0, "base_link"),
        child_frame_id: "laser".into(),
        ..ros::TransformStamped::default()
    };
    transform.transform.translation.x = 0.78;
    let transforms = ros::TfMessage {
        transforms: vec![transform],
    };
    let recording = recording(&[
        ("/scan", scan(7, "laser")),
        ("/tf_static", Message::StaticTransforms(transforms)),
        ("/scan", scan(8, "elsewhere")),
    ]);
    let played = play(&recording);
    let (header, ranges) = scan_in(&played[0]);
    assert_eq!(played[0].as_ref().unwrap().log_time_ns, 0);
    assert_eq!(header.stamp.measured_ns, 7 * SECOND + 5);
    assert_eq!((header.angle_min, header.angle_increment), (-1.5, 0.25));
    assert_eq!((header.range_max_m, header.frame.as_str()), (80.0, "laser"));
    assert_eq!((header.base_from_laser.x, header.mount_known), (0.78, 1));
    assert_eq!(
        (ranges[0], ranges[2], ranges[3]),
        (1.0, f32::INFINITY, -1.0)
    );
    assert!(ranges[1].is_nan());
    assert_eq!(scan_in(&played[1]).0.mount_known, 0);
    assert_eq!(played.len(), 2);
}

#[test]
fn only_the_channels_that_are_meant_are_played() {
    let recording = recording(&[
        ("/scan", scan(0, "laser")),
        ("/other_scan", scan(1, "laser")),
        ("/goal_pose", truth(2)),
        ("/ground_truth", truth(3)),
    ]);
    let played = play(&recording);
    let stamps = played.into_iter().map(|timed| timed.unwrap().stamp_ns());
    assert_eq!(Vec::from_iter(stamps), [5, 3 * SECOND + 5]);
}

#[test]
fn what_cannot_be_said_in_a_message_is_refused_one_by_one() {
    let mut turned = ros::Odometry::default();
    turned.pose.pose.orientation.w = f64::NAN;
    let recording = recording(&[
        ("/scan", scan(0, &"f".repeat(257))),
        ("/odom", Message::Odometry(Box::new(turned))),
        ("/scan", scan(2, "laser")),
    ]);
    let played = play(&recording);
    assert!(played[2].is_ok());
    let expected = ["/scan at log time 0 ns cannot be used: the frame", "/odom"];
    for (refused, expected) in played.iter().zip(expected) {
        let error = refused.as_ref().unwrap_err();
        assert!(error.is_about_one_message());
        assert!(error.to_string().contains(expected), "{error}");
    }
}
