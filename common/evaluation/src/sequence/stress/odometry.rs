//! Changes of the odometry.

use std::f64::consts::FRAC_PI_2;

use geometry::Pose;
use messages::Odometry;

/// Delay of late stamps, in nanoseconds.
const LATE_NS: i64 = 300_000_000;

/// Index of the first sample in the second half of the drive.
fn middle(odometry: &[Odometry]) -> usize {
    let stamp = |one: Option<&Odometry>| one.map_or(0, |one| one.stamp.measured_ns);
    let (first, last) = (stamp(odometry.first()), stamp(odometry.last()));
    odometry.partition_point(|one| one.stamp.measured_ns < first + (last - first) / 2)
}

pub(super) fn end(odometry: &mut Vec<Odometry>) {
    odometry.truncate(middle(odometry));
}

/// Repeats the same pose from mid-drive on.
pub(super) fn freeze(odometry: &mut [Odometry]) {
    let from = middle(odometry);
    let Some(last) = odometry.get(from).copied() else {
        return;
    };
    for one in &mut odometry[from..] {
        one.odom_from_child = last.odom_from_child;
    }
}

/// Reports the initial pose throughout.
pub(super) fn zero(odometry: &mut Vec<Odometry>) {
    for one in odometry {
        one.odom_from_child = Pose::IDENTITY.into();
    }
}

/// Turns 10 % too much.
pub(super) fn turn_more(odometry: &mut [Odometry]) {
    each_step(odometry, |step| Pose::new(step.x, step.y, 1.1 * step.yaw));
}

pub(super) fn reverse(odometry: &mut [Odometry]) {
    each_step(odometry, |step| Pose::new(-step.x, step.y, step.yaw));
}

pub(super) fn delay(odometry: &mut Vec<Odometry>) {
    for one in odometry {
        one.stamp.measured_ns += LATE_NS;
    }
}

/// Reports a frame that is turned by 90° on the robot.
pub(super) fn turn_frame(odometry: &mut Vec<Odometry>) {
    for one in odometry {
        let turned = Pose::from(one.odom_from_child).then(Pose::new(0.0, 0.0, FRAC_PI_2));
        one.odom_from_child = turned.into();
    }
}

/// Applies a change to the motion between consecutive samples.
fn each_step(odometry: &mut [Odometry], change: impl Fn(Pose) -> Pose) {
    let poses: Vec<Pose> = odometry.iter().map(|o| o.odom_from_child.into()).collect();
    let Some(&first) = poses.first() else { return };
    let mut at = first;
    for (one, pair) in odometry.iter_mut().skip(1).zip(poses.windows(2)) {
        at = at.then(change(pair[0].inverse().then(pair[1])));
        one.odom_from_child = at.into();
    }
}
