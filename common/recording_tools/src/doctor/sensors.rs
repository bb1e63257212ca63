//! Checks that laser and odometry agree on the motion of the robot, and that both work, without a
//! map or a search.

use geometry::{Pose, wrap_angle};

use super::drive::{Drive, Look, Stretch};
use super::finding::Finding;

/// Smallest number of scans or straight sections that distinguish a fault from chance.
const MIN_COUNT: usize = 5;

/// Smallest number of turns that distinguish a fault from chance, and their smallest total angle in
/// radians: one turn in a thousand is matched the wrong way.
const MIN_TURNS: usize = 2;
const MIN_TURNED: f64 = 0.25;

/// Share of the turns or sections that must show the same fault.
const MIN_SHARE: f64 = 0.8;

/// Length of the sections to compare, in metres and radians: shorter ones are lost in noise, and on
/// longer ones odometry drifts.
const STRETCH: (f64, f64) = (0.3, 0.25);

/// Angle from which a section is a turn, in radians; it is straight below.
const TURN: f64 = 0.08;

/// Motion that shows that a robot has moved, in metres and radians: matching scans of a standing
/// robot has a smaller error.
const MOVED: (f64, f64) = (1.0, 0.5);

/// Angle between the directions of motion by scans and by odometry that shows a wrong mount, in
/// radians: it is smaller for a robot that skids.
const TURNED_MOUNT: f64 = 0.5;

/// Returns all findings, without the consequences of a fault that is found.
pub(super) fn all(drive: &Drive) -> Vec<Finding> {
    if drive.looks.len() < MIN_COUNT || drive.odometry_ns.is_empty() {
        return Vec::new();
    }
    let dead = [clocks, never_moves, frozen, covered]
        .into_iter()
        .find_map(|check| check(drive));
    let apart = || mirrored(drive).or_else(|| mount(drive));
    ended(drive)
        .into_iter()
        .chain(dead.or_else(apart))
        .collect()
}

fn clocks(drive: &Drive) -> Option<Finding> {
    let stamps = || drive.looks.iter().map(|look| look.stamp_ns);
    let (first, last) = (stamps().min()?, stamps().max()?);
    let begin = *drive.odometry_ns.iter().min()?;
    let end = *drive.odometry_ns.iter().max()?;
    let (apart_ns, way) = match first > end {
        true => (first.saturating_sub(end), "after"),
        false => (begin.saturating_sub(last), "before"),
    };
    (apart_ns > 1_000_000_000).then(|| {
        Finding::problem(format!(
            "all scans are {:.0} s {way} the odometry by their stamps, so that no pose of it \
             belongs to a scan: the clocks differ; set laser and robot by the same clock (NTP or \
             PTP), or stamp scans as they arrive",
            apart_ns as f64 / 1e9
        ))
    })
}

fn ended(drive: &Drive) -> Option<Finding> {
    let end = *drive.odometry_ns.iter().max()?;
    let last = drive.looks.iter().map(|look| look.stamp_ns).max()?;
    let first = drive.looks.iter().map(|look| look.stamp_ns).min()?;
    let after = drive.looks.iter().filter(|look| look.stamp_ns > end);
    let silent_s = last.saturating_sub(end) as f64 / 1e9;
    let is_over = after.count() >= MIN_COUNT && drive.motion.until(last).is_none();
    // Otherwise the clocks differ.
    (is_over && end >= first).then(|| {
        let messages = drive.odometry_ns.len();
        Finding::problem(format!(
            "odometry ends after {messages} messages, {silent_s:.1} s before the scans do: find \
             out why its driver stopped; from there on the robot is followed by scans alone"
        ))
    })
}

fn never_moves(drive: &Drive) -> Option<Finding> {
    let end = *drive.odometry_ns.iter().max()?;
    let during = drive.looks.iter().filter(|look| look.stamp_ns <= end);
    let steps: Vec<Pose> = during.filter_map(|look| look.step).collect();
    let mut at = Pose::IDENTITY;
    let is_away = |step: &&Pose| {
        at = at.then(**step);
        !at.is_within(Pose::IDENTITY, MOVED.0, MOVED.1)
    };
    let has_moved = steps.iter().filter(is_away).count() >= MIN_COUNT;
    let metres: f64 = steps.iter().map(|step| step.x.hypot(step.y)).sum();
    (has_moved && !drive.motion.has_moved(i64::MAX)).then(|| {
        Finding::problem(format!(
            "odometry never moves while the laser, by its scans, drives {metres:.1} m: check that \
             its driver gets the counts of the wheels; until then the robot is followed by scans \
             alone"
        ))
    })
}

fn frozen(drive: &Drive) -> Option<Finding> {
    let (scans, moved) = moved_while(drive, |_, now| now.is_repeated)?;
    Some(Finding::problem(format!(
        "{scans} scans in a row are the same to the last bit while odometry moves by {moved}: the \
         laser is frozen; restart it or its driver"
    )))
}

fn covered(drive: &Drive) -> Option<Finding> {
    let (scans, moved) = moved_while(drive, |before, now| {
        before.only_range_m.is_some() && now.only_range_m.is_some()
    })?;
    let range_m = drive.looks.iter().find_map(|look| look.only_range_m)?;
    Some(Finding::problem(format!(
        "{scans} scans in a row read {range_m:.2} m in all directions while odometry moves by \
         {moved}: the laser is covered; uncover it, or clean its window"
    )))
}

/// Returns the first long run of scans, all linked by `goes_on`, during which odometry moves: the
/// number of scans, and the motion in words.
fn moved_while(drive: &Drive, goes_on: fn(&Look, &Look) -> bool) -> Option<(usize, String)> {
    let mut runs = drive.looks.chunk_by(goes_on);
    runs.find_map(|run| {
        let from = run.first()?;
        let mut poses = run.iter().filter_map(|look| drive.moved(from, look));
        let last = poses.rfind(|pose| !pose.is_within(Pose::IDENTITY, STRETCH.0, STRETCH.1))?;
        let metres = last.distance_to(Pose::IDENTITY);
        let degrees = last.yaw.to_degrees().abs();
        let moved = format!("{metres:.1} m and {degrees:.0} degrees");
        (run.len() >= MIN_COUNT).then_some((run.len(), moved))
    })
}

fn mirrored(drive: &Drive) -> Option<Finding> {
    let stretches = drive.stretches(STRETCH).into_iter();
    let is_turn = |stretch: &Stretch| stretch.by_odometry.yaw.abs() >= TURN;
    let turns: Vec<Stretch> = stretches.filter(is_turn).collect();
    let is_opposite = |turn: &&Stretch| {
        let ratio = turn.by_scans.yaw / turn.by_odometry.yaw;
        (-1.5..=-0.5).contains(&ratio)
    };
    let opposite: Vec<f64> = turns
        .iter()
        .filter(is_opposite)
        .map(|turn| turn.by_odometry.yaw.abs())
        .collect();
    let share = opposite.len() as f64 / turns.len() as f64;
    let turned: f64 = opposite.iter().sum();
    (opposite.len() >= MIN_TURNS && turned > MIN_TURNED && share >= MIN_SHARE).then(|| {
        Finding::problem(format!(
            "by the scans the robot turns the other way than by odometry, in {} of {} turns of \
             {:.0} degrees in all: the laser's view is mirrored; if it hangs upside down, \
             /tf_static must say so by a roll of 180 degrees, else angle_increment has the wrong \
             sign or odometry confuses left and right",
            opposite.len(),
            turns.len(),
            turned.to_degrees()
        ))
    })
}

fn mount(drive: &Drive) -> Option<Finding> {
    if drive.has_far_mount() {
        return None;
    }
    let is_straight = |stretch: &Stretch| stretch.by_odometry.yaw.abs() < TURN;
    let stretches = drive.stretches(STRETCH).into_iter().filter(is_straight);
    let direction = |moved: Pose| moved.y.atan2(moved.x);
    let turned: Vec<f64> = stretches
        .map(|stretch| direction(stretch.by_odometry) - direction(stretch.by_scans))
        .collect();
    let sum = |component: fn(f64) -> f64| turned.iter().copied().map(component).sum::<f64>();
    let mean = sum(f64::sin).atan2(sum(f64::cos));
    let is_near = |angle: &&f64| wrap_angle(**angle - mean).abs() < TURNED_MOUNT;
    let near = turned.iter().filter(is_near).count();
    let share = near as f64 / turned.len() as f64;
    let is_turned = near >= MIN_COUNT && share >= MIN_SHARE && mean.abs() > TURNED_MOUNT;
    is_turned.then(|| {
        let side = if mean > 0.0 { "left" } else { "right" };
        Finding::problem(format!(
            "by odometry and scans the laser looks {:.0} degrees to the {side} of where its mount \
             says, on {near} of {} straight stretches: correct its yaw in /tf_static, or the frame \
             that odometry moves",
            mean.to_degrees().abs(),
            turned.len()
        ))
    })
}

#[cfg(test)]
mod tests {
    use engine::scan::Scan;

    use super::*;

    const SECOND: i64 = 1_000_000_000;

    /// Ranges of a laser in a room of 7 × 5 m.
    fn ranges(laser: Pose) -> Vec<f32> {
        let range = |beam: u32| {
            let (sin, cos) = (laser.yaw + f64::from(beam).to_radians()).sin_cos();
            let to_wall = |at: f64, side: f64, along: f64| {
                (if along > 0.0 { side - at } else { at }) / along.abs()
            };
            to_wall(laser.x, 7.0, cos).min(to_wall(laser.y, 5.0, sin)) as f32
        };
        (0..360).map(range).collect()
    }

    /// Poses of a robot that drives along a square of 2 m.
    fn poses() -> Vec<Pose> {
        let mut at = Pose::new(2.0, 1.0, 0.0);
        let side = [
            [Pose::new(0.1, 0.0, 0.0); 20],
            [Pose::new(0.0, 0.0, 4.5f64.to_radians()); 20],
        ];
        let steps = [side; 4].into_iter().flatten().flatten();
        steps
            .map(|step| {
                at = at.then(step);
                at
            })
            .collect()
    }

    fn scans(mount: Pose) -> Vec<Vec<f32>> {
        poses()
            .iter()
            .map(|pose| ranges(pose.then(mount)))
            .collect()
    }

    fn drive(odometry: &[Pose], scans: &[Vec<f32>], first_scan_s: i64) -> Drive {
        let mut drive = Drive::new(Pose::IDENTITY).unwrap();
        for (second, pose) in (0..).zip(odometry) {
            drive.add_odometry(second * SECOND, *pose);
        }
        for (second, ranges) in (first_scan_s..).zip(scans) {
            let scan = Scan {
                angle_min: 0.0,
                angle_increment: 1f64.to_radians(),
                range_min_m: 0.1,
                range_max_m: 30.0,
                ranges,
            };
            drive.add_scan(second * SECOND, scan);
        }
        drive
    }

    #[track_caller]
    fn check(drive: &Drive, expected: &[&str]) {
        let found = all(drive);
        let is_said = |(finding, words): (&Finding, &&str)| finding.finding.contains(words);
        let all_said = found.iter().zip(expected).all(is_said);
        assert!(found.len() == expected.len() && all_said, "{found:#?}");
    }

    #[test]
    fn a_sound_drive_has_no_finding_and_a_robot_may_stand() {
        let (poses, scans) = (poses(), scans(Pose::IDENTITY));
        check(&drive(&poses, &scans, 0), &[]);
        check(
            &drive(&vec![poses[0]; 160], &vec![scans[0].clone(); 160], 0),
            &[],
        );
    }

    #[test]
    fn a_mirrored_laser_turns_the_other_way() {
        let mut mirrored = scans(Pose::IDENTITY);
        mirrored.iter_mut().for_each(|ranges| ranges.reverse());
        check(&drive(&poses(), &mirrored, 0), &["turns the other way"]);
    }

    #[test]
    fn a_turned_mount_is_measured() {
        for (degrees, words) in [
            (90.0f64, "looks 90 degrees to the left"),
            (-90.0, "looks 89 degrees to the right"),
            (180.0, "looks 179 degrees to the right"),
        ] {
            let scans = scans(Pose::new(0.0, 0.0, degrees.to_radians()));
            check(&drive(&poses(), &scans, 0), &[words]);
        }
    }

    #[test]
    fn a_laser_that_is_frozen_or_covered_is_named() {
        let mut frozen = scans(Pose::IDENTITY);
        let last = frozen[60].clone();
        frozen[60..].fill(last);
        check(
            &drive(&poses(), &frozen, 0),
            &["100 scans in a row are the same"],
        );
        let reading = |scan: u32, beam: u32| 1.0 + 0.001 * ((scan + beam) % 7) as f32;
        let covered: Vec<Vec<f32>> = (0..160)
            .map(|scan| (0..360).map(|beam| reading(scan, beam)).collect())
            .collect();
        check(
            &drive(&poses(), &covered, 0),
            &["160 scans in a row read 1.00 m"],
        );
    }

    #[test]
    fn odometry_that_ends_or_never_moves_is_named() {
        let (poses, scans) = (poses(), scans(Pose::IDENTITY));
        check(
            &drive(&poses[..90], &scans, 0),
            &["ends after 90 messages, 70.0 s before"],
        );
        check(
            &drive(&vec![Pose::IDENTITY; 160], &scans, 0),
            &["odometry never moves"],
        );
    }

    #[test]
    fn clocks_that_are_apart_are_named() {
        let (poses, scans) = (poses(), scans(Pose::IDENTITY));
        check(
            &drive(&poses, &scans, 9159),
            &["all scans are 9000 s after the odometry"],
        );
        check(
            &drive(&poses, &scans, -9159),
            &["all scans are 9000 s before the odometry"],
        );
    }
}
