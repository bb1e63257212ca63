//! Trajectories as text, in the formats TUM, CSV and KITTI. Pure.

use std::fmt::Write as _;

use geometry::Pose;

use crate::text::seconds;

/// Poses by stamp, in nanoseconds.
pub(super) type Poses = [(i64, Pose)];

pub(super) const ENDINGS: [&str; 6] = [
    ".tum",
    "_truth.tum",
    ".csv",
    "_truth.csv",
    ".kitti",
    "_truth.kitti",
];

/// Contents of [`ENDINGS`]. KITTI has no stamps, so its files hold the scans with both poses.
pub(super) fn files(tracked: &Poses, truths: &Poses, pairs: &[(Pose, Pose)]) -> [String; 6] {
    [
        tum(tracked),
        tum(truths),
        csv(tracked),
        csv(truths),
        kitti(pairs.iter().map(|pair| pair.0)),
        kitti(pairs.iter().map(|pair| pair.1)),
    ]
}

/// One line per pose: seconds, x, y, z and a quaternion, in the TUM RGB-D format that evo reads.
fn tum(poses: &Poses) -> String {
    let mut lines = String::new();
    for &(stamp_ns, Pose { x, y, yaw }) in poses {
        let seconds = seconds(stamp_ns);
        let (sin, cos) = (0.5 * yaw).sin_cos();
        // Writing to a string cannot fail.
        let _ = writeln!(lines, "{seconds} {x} {y} 0 0 0 {sin} {cos}");
    }
    lines
}

fn csv(poses: &Poses) -> String {
    let mut lines = "stamp_ns,x_m,y_m,yaw_rad\n".to_owned();
    for (stamp_ns, Pose { x, y, yaw }) in poses {
        let _ = writeln!(lines, "{stamp_ns},{x},{y},{yaw}");
    }
    lines
}

/// One line per pose: the upper three rows of its matrix, row by row, as evo reads them.
fn kitti(poses: impl Iterator<Item = Pose>) -> String {
    let mut lines = String::new();
    for Pose { x, y, yaw } in poses {
        let (sin, cos) = yaw.sin_cos();
        let _ = writeln!(lines, "{cos} {} 0 {x} {sin} {cos} 0 {y} 0 0 1 0", -sin);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trajectory_has_a_line_a_scan() {
        let quarter = Pose::new(1.5, -2.0, std::f64::consts::FRAC_PI_2);
        let numbers = |line: &str, between: char| -> Vec<f64> {
            let words = line.trim_end().split(between);
            words.map(|word| word.parse().unwrap()).collect()
        };
        let poses = [(1_500_000_000, quarter)];
        let [tum, _, csv, none, kitti, _] = files(&poses, &[], &[(quarter, quarter)]);
        let half = 0.5f64.sqrt();
        let found = numbers(&tum, ' ');
        assert_eq!(found[..6], [1.5, 1.5, -2.0, 0.0, 0.0, 0.0]);
        // The tolerance covers the rounding of sine and cosine.
        assert!(found[6..].iter().all(|part| (part - half).abs() < 1e-15));
        assert_eq!(none, "stamp_ns,x_m,y_m,yaw_rad\n");
        let found = numbers(csv.lines().nth(1).unwrap(), ',');
        assert_eq!(found, [1.5e9, 1.5, -2.0, std::f64::consts::FRAC_PI_2]);
        let expected = [0.0, -1.0, 0.0, 1.5, 1.0, 0.0, 0.0, -2.0, 0.0, 0.0, 1.0, 0.0];
        let found = numbers(&kitti, ' ');
        let mut both = found.iter().zip(expected);
        let near = both.all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near && found.len() == 12, "{found:?}");
    }
}
