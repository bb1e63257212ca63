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
    sample::opened(writer)
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
            // The valid one before it counts.
            broken("laser"),
        ]),
    )]);
    let mounted = recording.mounted("laser").unwrap();
    assert_eq!(mounted.mount.unwrap().base_from_laser.x, 0.5);
    let note = |child: &str| {
        format!(
            "the transform from base_link to {child} is ignored: the position (NaN, 0) is not finite"
        )
    };
    assert_eq!(mounted.notes, ["camera", "laser"].map(note));
    assert_eq!(
        recording.mounted("camera").unwrap_err().to_string(),
        "r.mcap: the mount of camera is not known, for the transform from base_link to camera is \
         invalid: the position (NaN, 0) is not finite"
    );
}

#[test]
fn odometry_names_the_base_on_its_topic_and_on_tf() {
    let laser = transform("chassis", "laser", 0.5, LEVEL);
    let odometry = ros::Odometry {
        child_frame_id: "chassis".to_owned(),
        ..ros::Odometry::default()
    };
    let fixed = (crate::TF_STATIC, fixed(vec![laser.clone()]));
    let with = recording(&[
        fixed.clone(),
        ("/odom", Message::Odometry(Box::new(odometry))),
    ]);
    let without = recording(&[fixed]);
    let on_tf = on_tf("chassis", &[laser.clone(), laser]);
    let base = |of: &Recording| of.mounted("laser").unwrap().mount.map(|m| m.base_frame);
    let chassis = Some("chassis".to_owned());
    assert_eq!(
        [base(&with), base(&on_tf), base(&without)],
        [chassis.clone(), chassis, None]
    );
}

/// A recording with these transforms on `/tf`, each next to that of odometry.
fn on_tf(base: &str, lasers: &[TransformStamped]) -> Recording {
    let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
    for (time, laser) in (0..).zip(lasers) {
        let odometry = transform("odom", base, time as f64, LEVEL);
        let message = TfMessage {
            transforms: vec![odometry, laser.clone()],
        };
        let body = ros::cdr::encode(&message).unwrap();
        writer
            .write_bytes("/tf", TfMessage::SCHEMA, "", "cdr", time, &body)
            .unwrap();
    }
    sample::opened(writer)
}

#[test]
fn a_mount_on_tf_is_taken_where_it_does_not_move() {
    let laser = |x: f64| transform("base_link", "laser", x, LEVEL);
    let still = on_tf("base_link", &[laser(0.5), laser(0.5004), laser(0.5)]);
    let mounted = still.mounted("laser").unwrap();
    assert_eq!(mounted.mount.unwrap().base_from_laser.x, 0.5);
    assert_eq!(
        mounted.notes,
        ["the mount of laser is taken from /tf, where it does not move"]
    );
    let moving = on_tf("base_link", &[laser(0.5), laser(0.52)])
        .mounted("laser")
        .unwrap();
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
