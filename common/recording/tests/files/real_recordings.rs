//! Compares the recordings of the repository with the output of another reader and with the map
//! files next to them.

use std::path::PathBuf;

use geometry::Pose;
use recording::{Kind, Message, Recording};

fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../recordings")
        .join(name)
}

fn open(name: &str) -> Recording {
    let path = folder(name).join("recording.mcap");
    let recording = Recording::open(path).expect("it is in the repository");
    assert_eq!(recording.damage(), None);
    recording
}

fn counts(recording: &Recording) -> Vec<(&str, u64)> {
    let mut counts: Vec<_> = recording
        .channels()
        .map(|channel| (&*channel.topic, channel.messages))
        .collect();
    counts.sort_unstable();
    counts
}

#[test]
fn channels_are_counted() {
    let corridor = [
        ("/ground_truth", 37),
        ("/map", 1),
        ("/odom", 37),
        ("/scan", 37),
        ("/tf_static", 1),
    ];
    assert_eq!(counts(&open("malaga_corridor")), corridor);
    let courtyard = [
        ("/ground_truth", 99),
        ("/map", 1),
        ("/odom", 225),
        ("/scan", 225),
        ("/tf_static", 1),
    ];
    assert_eq!(counts(&open("malaga_courtyard")), courtyard);
}

#[test]
fn the_map_of_a_recording_is_the_map_beside_it() {
    for (name, width, height) in [
        ("malaga_corridor", 1908, 377),
        ("malaga_courtyard", 1460, 1447),
    ] {
        let recorded = open(name).map().unwrap().unwrap();
        let file = map::load(folder(name).join("map.yaml")).unwrap();
        assert_eq!((file.width, file.height), (width, height));
        assert_eq!(recorded.cells, file.cells, "{name}");
        assert_eq!(recorded.resolution_m, 0.05);
        assert_eq!(recorded.id(), file.id(), "{name}");
    }
}

#[test]
fn the_first_scan_of_the_corridor_is_as_recorded() {
    let recording = open("malaga_corridor");
    let stamp_ns = 1_137_772_793_094_853_000;
    let first = recording.records_of(&[Kind::Scan]).next().unwrap().unwrap();
    assert_eq!((&*first.topic, first.log_time_ns), ("/scan", stamp_ns));
    let Message::Scan(scan) = first.message else {
        panic!("asked for scans");
    };
    assert_eq!(scan.header.stamp.as_ns(), stamp_ns);
    assert_eq!(scan.header.frame_id, "laser");
    assert_eq!(scan.ranges.len(), 361);
    assert_eq!(scan.ranges[..5], [2.47, 2.47, 2.47, 2.45, 2.45]);
    assert_eq!(scan.angle_increment, 0.008_726_646);
    assert_eq!(scan.range_max, 80.0);

    let truth = &recording.ground_truths().unwrap()[&stamp_ns];
    assert_eq!(truth.frame, "map");
    // The recorded quaternion is (0, 0, z, w); computing its half angle another way rounds
    // differently.
    let yaw = 2.0 * (-0.248_332_621_893_838_5f64).atan2(0.968_674_821_033_009);
    let expected = Pose::new(4.190_621_611_538_742, -10.590_667_857_545_004, yaw);
    assert!(truth.pose.is_within(expected, 0.0, 1e-12), "{truth:?}");
}

#[test]
fn odometry_is_of_the_base_and_the_laser_sits_ahead_of_it() {
    let recording = open("malaga_corridor");
    let mount = recording.base_from_laser("laser").unwrap().unwrap();
    assert_eq!(mount.base_frame, "base_link");
    assert_eq!(mount.base_from_laser, Pose::new(0.78, 0.0, 0.0));
    assert_eq!(mount.height_m, 0.3);
    let first = recording
        .records_of(&[Kind::Odometry])
        .next()
        .unwrap()
        .unwrap();
    let Message::Odometry(odometry) = first.message else {
        panic!("asked for odometry");
    };
    assert_eq!(odometry.header.frame_id, "odom");
    assert_eq!(odometry.child_frame_id, "base_link");
    let pose = odometry.pose.pose.planar().unwrap();
    assert_eq!((pose.x, pose.y), (0.247_794_271, 0.018_788_695));
}
