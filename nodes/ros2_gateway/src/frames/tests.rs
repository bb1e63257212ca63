use bytemuck::Zeroable;
use messages::{FrameName, Pose2};
use ros::{Quaternion, TransformStamped};

use super::*;

fn fixed(parent: &str, child: &str, x: f64, rotation: Quaternion) -> TfMessage {
    let mut transform = TransformStamped::default();
    transform.header.frame_id = parent.to_owned();
    transform.child_frame_id = child.to_owned();
    transform.transform.translation.x = x;
    transform.transform.rotation = rotation;
    TfMessage {
        transforms: vec![transform],
    }
}

fn at(x: f64) -> Pose2 {
    Pose::new(x, 0.0, 0.0).into()
}

fn odometry(child: &str, x: f64) -> Odometry {
    Odometry {
        odom_from_child: at(x),
        frame: FrameName::new("odom"),
        child_frame: FrameName::new(child),
        ..Odometry::zeroed()
    }
}

fn mounted(x: f64) -> Mount {
    Mount {
        base_from_laser: Pose::new(x, 0.0, 0.0),
        is_upside_down: false,
    }
}

fn check_mount(frames: &mut Frames, index: usize, laser: &str, expected: Option<Mount>) {
    assert_eq!(frames.base_from_laser(index, laser).unwrap(), expected);
}

#[test]
fn the_mount_comes_with_the_transforms_or_from_the_user() {
    let mut frames = Frames::default();
    check_mount(&mut frames, 0, "laser", None);
    let mount = fixed("base_link", "laser", 0.5, Quaternion::default());
    frames.on_static_transforms(&mount).unwrap();
    check_mount(&mut frames, 0, "laser", Some(mounted(0.5)));
    let mut frames = Frames::new(vec![mounted(9.0), mounted(8.0)], None);
    frames.on_static_transforms(&mount).unwrap();
    for (index, expected) in [9.0, 8.0].into_iter().enumerate() {
        check_mount(&mut frames, index, "laser", Some(mounted(expected)));
    }
}

/// Half a turn about x.
const OVER: Quaternion = Quaternion {
    x: 1.0,
    y: 0.0,
    z: 0.0,
    w: 0.0,
};

#[test]
fn the_base_that_is_named_counts_where_it_is_connected() {
    let mut frames = Frames::new(Vec::new(), Some("base_footprint".to_owned()));
    let laser = fixed("base_link", "laser", 0.5, Quaternion::default());
    frames.on_static_transforms(&laser).unwrap();
    check_mount(&mut frames, 0, "laser", Some(mounted(0.5)));
    let base = fixed("base_footprint", "base_link", 0.25, Quaternion::default());
    frames.on_static_transforms(&base).unwrap();
    check_mount(&mut frames, 0, "laser", Some(mounted(0.75)));
}

#[test]
fn odometry_names_the_base() {
    let mut frames = Frames::default();
    let laser = fixed("chassis", "laser", 0.5, Quaternion::default());
    frames.on_static_transforms(&laser).unwrap();
    check_mount(&mut frames, 0, "laser", None);
    frames.on_odometry(&odometry("chassis", 1.0));
    check_mount(&mut frames, 0, "laser", Some(mounted(0.5)));
}

#[test]
fn what_the_robot_moved_is_known_as_far_as_odometry_goes_back() {
    let mut frames = Frames::default();
    assert_eq!(frames.moved_since(5), None);
    for second in 1..4 {
        let mut odometry = odometry("base_link", f64::from(second));
        odometry.stamp.measured_ns = i64::from(second) * 1_000_000_000;
        frames.on_odometry(&odometry);
    }
    assert_eq!(frames.moved_since(5), None);
    let moved = frames.moved_since(1_500_000_000).unwrap();
    assert_eq!((moved.x, moved.y), (2.0, 0.0));
}

#[test]
fn each_laser_has_its_own_mount_also_upside_down() {
    let mut frames = Frames::default();
    let front = fixed("base_link", "front", 0.5, Quaternion::default());
    let rear = fixed("base_link", "rear", -0.4, OVER);
    let transforms = [front.transforms, rear.transforms].concat();
    frames
        .on_static_transforms(&TfMessage { transforms })
        .unwrap();
    let turned = Mount {
        is_upside_down: true,
        ..mounted(-0.4)
    };
    for _ in 0..2 {
        check_mount(&mut frames, 0, "front", Some(mounted(0.5)));
        check_mount(&mut frames, 1, "rear", Some(turned));
    }
    // The cache is bounded, and changes with the transforms.
    for i in 0..3 * MAX_MOUNTS {
        frames.base_from_laser(1, &format!("f{i}")).unwrap();
        assert!(frames.mounts.len() <= MAX_MOUNTS);
    }
    let moved = fixed("base_link", "rear", -0.6, Quaternion::default());
    frames.on_static_transforms(&moved).unwrap();
    check_mount(&mut frames, 1, "rear", Some(mounted(-0.6)));
}

#[test]
fn a_transform_that_is_none_does_not_stop_the_rest() {
    let mut frames = Frames::default();
    let scaled = |w: f64| Quaternion {
        w,
        ..Quaternion::default()
    };
    let transforms = [
        fixed("base_link", "camera", f64::NAN, Quaternion::default()),
        fixed("base_link", "front", 0.5, scaled(0.0)),
        fixed("base_link", "rear", -0.4, scaled(1.02)),
    ]
    .map(|message| message.transforms)
    .concat();
    let error = frames
        .on_static_transforms(&TfMessage { transforms })
        .unwrap_err();
    let text = transport::with_causes(&error);
    let expected = "the transform from base_link to camera is ignored: the position (NaN, 0)";
    assert!(text.starts_with(expected), "{text}");
    for (index, laser, x) in [(0, "front", 0.5), (1, "rear", -0.4)] {
        check_mount(&mut frames, index, laser, Some(mounted(x)));
    }
    let mended = ["front".to_owned(), "rear".to_owned()];
    assert!(frames.mended.iter().eq(&mended));
}

#[test]
fn a_frame_may_have_the_longest_name_of_a_message() {
    let mut frames = Frames::default();
    let long = "f".repeat(FrameName::CAPACITY);
    let mount = fixed("base_link", &long, 0.5, Quaternion::default());
    frames.on_static_transforms(&mount).unwrap();
    check_mount(&mut frames, 0, &long, Some(mounted(0.5)));
}

#[test]
fn a_tilted_laser_and_too_many_frames_are_refused() {
    let mut frames = Frames::default();
    let half = 0.5f64.sqrt();
    let tilted = Quaternion {
        x: half,
        y: 0.0,
        z: 0.0,
        w: half,
    };
    frames
        .on_static_transforms(&fixed("base_link", "laser", 0.5, tilted))
        .unwrap();
    let error = frames.base_from_laser(0, "laser").unwrap_err().to_string();
    assert!(error.contains("tilted by 90.0"), "{error}");
    let long = fixed("base_link", &"f".repeat(257), 0.5, Quaternion::default());
    let error = frames.on_static_transforms(&long).unwrap_err().to_string();
    assert!(error.contains("257 bytes"), "{error}");
    let mut refused = 0;
    for i in 0..2 * MAX_FRAMES {
        let child = fixed("base_link", &format!("f{i}"), 0.5, Quaternion::default());
        refused += usize::from(frames.on_static_transforms(&child).is_err());
    }
    assert_eq!(refused, MAX_FRAMES + 1);
}

#[test]
fn the_odometry_lies_where_the_hypothesis_says() {
    let header = HypothesesHeader {
        mount_known: 1,
        ..HypothesesHeader::zeroed()
    };
    let best = Hypothesis {
        map_from_laser: at(10.0),
        map_from_base: at(9.5),
        ..Hypothesis::zeroed()
    };
    let check = |child: &str, expected: Option<f64>, header: &HypothesesHeader| {
        let mut frames = Frames::default();
        for (index, laser, x) in [(0, "laser", 0.5), (1, "rear", -0.4)] {
            let mount = fixed("base_link", laser, x, Quaternion::default());
            frames.on_static_transforms(&mount).unwrap();
            frames.base_from_laser(index, laser).unwrap();
        }
        frames.on_odometry(&odometry(child, 4.0));
        let found = frames.map_from_odom(header, &best);
        assert_eq!(found.map(|(pose, _)| pose.x), expected, "{child}");
    };
    check("base_link", Some(5.5), &header);
    check("laser", Some(6.0), &header);
    // Hypotheses refer to the first laser, no matter which one sent the last scan.
    check("rear", Some(5.1), &header);
    check("base_footprint", Some(5.5), &header);
    check("base_footprint", None, &HypothesesHeader::zeroed());
    let nobody = Frames::default();
    assert_eq!(nobody.map_from_odom(&header, &best), None);
}

#[test]
fn a_lidar_may_be_tilted_and_must_have_a_mount() {
    let mut frames = Frames::default();
    let error = frames.cloud_mount(None, "lidar").unwrap_err();
    assert!(error.to_string().contains("--cloud-mount"), "{error}");
    // On its side, which no laser may be.
    let side = Quaternion {
        x: std::f64::consts::FRAC_1_SQRT_2,
        w: std::f64::consts::FRAC_1_SQRT_2,
        ..Quaternion::default()
    };
    let mount = fixed("base_link", "lidar", 0.5, side);
    frames.on_static_transforms(&mount).unwrap();
    assert!(frames.base_from_laser(0, "lidar").is_err());
    frames.cloud_mount(None, "lidar").unwrap();
    check_mount(&mut frames, 0, "lidar", Some(mounted(0.5)));
}
