use std::f64::consts::{FRAC_PI_2, PI};

use super::*;

fn transform(parent: &str, child: &str, (x, y, z): (f64, f64, f64), yaw: f64) -> TransformStamped {
    TransformStamped {
        header: ros::Header {
            frame_id: parent.to_owned(),
            ..ros::Header::default()
        },
        child_frame_id: child.to_owned(),
        transform: Transform {
            translation: ros::Vector3 { x, y, z },
            rotation: ros::Quaternion::from_yaw(yaw),
        },
    }
}

fn tree(transforms: &[TransformStamped]) -> TransformTree {
    let mut tree = TransformTree::default();
    for transform in transforms {
        tree.add(transform).unwrap();
    }
    tree
}

fn assert_near(found: Pose, expected: Pose) {
    // Tolerance: a few rotations of numbers near 1 cost a few units in the last place.
    assert!(
        found.is_within(expected, 1e-12, 1e-12),
        "{found:?} {expected:?}"
    );
}

#[test]
fn a_laser_ahead_of_the_base() {
    let tree = tree(&[transform("base_link", "laser", (0.78, 0.0, 0.3), 0.0)]);
    let mount = tree.base_from("/laser").unwrap();
    assert_eq!(mount.base_frame, "base_link");
    assert_near(mount.base_from_laser, Pose::new(0.78, 0.0, 0.0));
    assert_eq!((mount.height_m, mount.tilt_degrees), (0.3, 0.0));
    assert_eq!(tree.base_from("camera"), None);
    let behind = tree.laser_from("laser", "/base_link").unwrap();
    assert_near(behind, Pose::new(-0.78, 0.0, 0.0));
    assert_eq!(tree.laser_from("laser", "camera"), None);
}

#[test]
fn chains_are_followed_and_base_link_is_preferred() {
    let mut transforms = vec![
        transform("base_footprint", "base_link", (1.0, 0.0, 0.1), 0.0),
        transform("base_link", "tower", (0.5, 0.0, 1.0), FRAC_PI_2),
        transform("tower", "laser", (0.2, 0.0, 0.0), FRAC_PI_2),
    ];
    let mount = tree(&transforms).base_from("laser").unwrap();
    assert_eq!(mount.base_frame, "base_link");
    assert_near(mount.base_from_laser, Pose::new(0.5, 0.2, PI));
    transforms.remove(0);
    transforms[0].header.frame_id = "base_footprint".to_owned();
    let mount = tree(&transforms).base_from("laser").unwrap();
    assert_eq!(mount.base_frame, "base_footprint");
}

#[test]
fn a_base_beside_or_below_the_laser_is_found() {
    let beside = tree(&[
        transform("chassis", "r1/base_link", (0.0, 0.0, 0.0), FRAC_PI_2),
        transform("chassis", "r1/laser", (1.0, 0.0, 0.0), 0.0),
    ]);
    let mount = beside.base_from("r1/laser").unwrap();
    assert_eq!(mount.base_frame, "r1/base_link");
    assert_near(mount.base_from_laser, Pose::new(0.0, -1.0, -FRAC_PI_2));
}

#[test]
fn the_base_is_what_odometry_moves_if_that_bears_the_laser() {
    let mut named = tree(&[
        transform("chassis", "base_link", (0.0, 0.0, 0.0), PI),
        transform("base_link", "laser", (1.0, 0.0, 0.0), 0.0),
        transform("base_link", "rear", (-1.0, 0.0, 0.0), 0.0),
    ]);
    let base = |tree: &TransformTree| tree.base_from("laser").unwrap();
    assert_eq!(base(&named).base_frame, "base_link");
    assert!(named.on_odometry("/chassis") && !named.on_odometry("chassis"));
    assert_eq!(base(&named).base_frame, "chassis");
    assert_near(base(&named).base_from_laser, Pose::new(-1.0, 0.0, PI));
    // A laser is not a base, and neither is a frame that the transforms do not have.
    for other in ["laser", "rear", "robot", ""] {
        named.on_odometry(other);
        assert_eq!(base(&named).base_frame, "base_link", "{other}");
    }
    let mut alone = tree(&[transform("plate", "chassis", (0.0, 0.0, 0.0), 0.0)]);
    alone
        .add(&transform("plate", "laser", (2.0, 0.0, 0.0), 0.0))
        .unwrap();
    assert_eq!(alone.base_from("laser"), None);
    alone.on_odometry("chassis");
    assert_near(base(&alone).base_from_laser, Pose::new(2.0, 0.0, 0.0));
    let round =
        [("a", "laser"), ("laser", "a")].map(|(a, b)| transform(a, b, (0.0, 0.0, 0.0), 0.0));
    let mut round = tree(&round);
    round.on_odometry("chassis");
    assert_eq!(round.base_from("laser"), None);
}

#[test]
fn the_latest_transform_counts_and_a_circle_ends() {
    let mut tree = tree(&[
        transform("base_link", "laser", (1.0, 0.0, 0.0), 0.0),
        transform("base_link", "laser", (2.0, 0.0, 0.0), 0.0),
    ]);
    let mount = tree.base_from("laser").unwrap();
    assert_near(mount.base_from_laser, Pose::new(2.0, 0.0, 0.0));
    tree.add(&transform("laser", "base_link", (0.0, 0.0, 0.0), 0.0))
        .unwrap();
    assert!(tree.base_from("laser").is_some());
    let itself = tree.base_from("base_link").unwrap();
    assert_near(itself.base_from_laser, Pose::IDENTITY);
}

/// Rotation by angles about x, then y, then z, in radians.
fn turned(roll: f64, pitch: f64, yaw: f64) -> ros::Quaternion {
    let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    ros::Quaternion {
        x: turn.i,
        y: turn.j,
        z: turn.k,
        w: turn.w,
    }
}

fn with_rotation(mut of: TransformStamped, turn: ros::Quaternion) -> TransformStamped {
    of.transform.rotation = turn;
    of
}

#[test]
fn a_laser_upside_down_keeps_the_heading_of_its_x_axis() {
    let degree = PI / 180.0;
    for (turn, yaw, upside_down, tilt) in [
        ((0.0, 0.0, 0.5), 0.5, false, 0.0),
        ((PI, 0.0, 0.0), 0.0, true, 0.0),
        ((-PI, 0.0, 0.5), 0.5, true, 0.0),
        ((0.0, PI, 0.0), PI, true, 0.0),
        ((PI - 3.0 * degree, 0.0, -0.5), -0.5, true, 3.0),
        ((3.0 * degree, 0.0, 0.0), 0.0, false, 3.0),
        ((0.0, FRAC_PI_2, 0.0), 0.0, false, 90.0),
    ] {
        let (roll, pitch, about_z) = turn;
        let laser = transform("tower", "laser", (0.2, 0.0, 0.0), 0.0);
        let tree = tree(&[
            transform("base_link", "tower", (0.5, 0.0, 1.0), FRAC_PI_2),
            with_rotation(laser, turned(roll, pitch, about_z)),
        ]);
        let mount = tree.base_from("laser").unwrap();
        // 1e-9 is far above the rounding of a few rotations, and far below a degree.
        assert!((mount.tilt_degrees - tilt).abs() < 1e-9, "{mount:?}");
        if tilt < MAX_TILT_DEGREES {
            assert_eq!(mount.upside_down, upside_down, "{mount:?}");
            let expected = Pose::new(0.5, 0.2, FRAC_PI_2 + yaw);
            assert!(
                mount.base_from_laser.is_within(expected, 1e-9, 1e-9),
                "{mount:?}"
            );
            let inverse = tree.laser_from("laser", "base_link").unwrap();
            assert!(
                inverse.is_within(expected.inverse(), 1e-9, 1e-9),
                "{inverse:?}"
            );
        }
    }
}

#[test]
fn two_half_turns_make_a_level_laser() {
    let over = |parent, child| {
        let still = transform(parent, child, (0.0, 0.0, 0.0), 0.0);
        with_rotation(still, turned(PI, 0.0, 0.0))
    };
    let mount = tree(&[over("base_link", "plate"), over("plate", "laser")]);
    let mount = mount.base_from("laser").unwrap();
    assert!(!mount.upside_down && mount.tilt_degrees < 1e-9, "{mount:?}");
}

#[test]
fn quaternions_are_mended_where_it_is_clear_what_is_meant() {
    let laser = || transform("base_link", "laser", (1.0, 0.0, 0.0), 0.0);
    let quaternion = |z: f64, w: f64| ros::Quaternion {
        x: 0.0,
        y: 0.0,
        z,
        w,
    };
    for (turn, expected) in [
        (
            quaternion(0.0, 0.0),
            "the transform from base_link to laser: the quaternion is all zeros: taken for no \
             turn",
        ),
        (
            quaternion(0.0, 1.04),
            "the transform from base_link to laser: the quaternion has a length of 1.040: taken \
             as if it were 1",
        ),
    ] {
        let mut tree = tree(&[with_rotation(laser(), turn)]);
        let mount = tree.base_from("laser").unwrap();
        assert_near(mount.base_from_laser, Pose::new(1.0, 0.0, 0.0));
        assert_eq!(tree.notes().collect::<Vec<_>>(), [expected]);
        tree.take(&laser());
        assert_eq!(tree.notes().count(), 0, "the latest counts");
    }
    for turn in [
        quaternion(0.0, 1.06),
        quaternion(0.5, 0.5),
        quaternion(f64::NAN, 1.0),
        quaternion(0.0, f64::INFINITY),
    ] {
        let mut tree = TransformTree::default();
        assert!(tree.add(&with_rotation(laser(), turn)).is_err(), "{turn:?}");
    }
}
