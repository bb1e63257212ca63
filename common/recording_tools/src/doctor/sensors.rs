//! Whether laser and odometry agree on how the robot moves, and whether each is alive.
//! Neither a map nor a search is needed.

use super::drive::{Drive, Look};
use super::finding::Finding;

/// A check needs so many scans, and so many beams of each.
const MIN_SCANS: usize = 5;
const MIN_BEAMS: usize = 30;

/// A covered laser reads one distance, metres give or take, in this share of its beams.
const COVER_M: f32 = 0.03;
const COVER_SHARE: f64 = 0.95;

/// A robot has moved by odometry from here on, metres and radians.
const MOVED: (f64, f64) = (0.2, 0.17);

/// A beam reads something else from here on, metres; half of them do where a robot moves.
const CHANGED_M: f32 = 0.2;
const CHANGED_SHARE: f64 = 0.5;

/// Odometry that is silent so long, seconds, and so many of its periods, has ended.
const SILENT_S: f64 = 0.5;
const SILENT_PERIODS: f64 = 4.0;

/// Turns between scans that are compared, radians: smaller ones are lost in noise, and
/// after larger ones little is seen again.
const TURNS: std::ops::RangeInclusive<f64> = 0.08..=0.6;

/// One sense of turning fits by so much better than the other, metres.
const CLEAR_M: f32 = 0.02;

/// Share of the turns that must have the opposite sign.
const MIRRORED_SHARE: f64 = 0.8;

/// Everything that is found.
pub(super) fn all(drive: &Drive) -> Vec<Finding> {
    if drive.looks.len() < MIN_SCANS {
        return Vec::new();
    }
    let found = match clocks(drive) {
        Some(apart) => vec![Some(apart)],
        None => vec![
            ended(drive),
            never_moves(drive),
            frozen(drive),
            mirrored(drive),
        ],
    };
    found
        .into_iter()
        .chain([covered(drive)])
        .flatten()
        .collect()
}

/// Whether scans and odometry are of different times.
fn clocks(drive: &Drive) -> Option<Finding> {
    let stamps = || drive.looks.iter().map(|look| look.stamp_ns);
    let (first, last) = (stamps().min()?, stamps().max()?);
    let (begin, end) = (drive.odometry.iter().min()?, drive.odometry.iter().max()?);
    let apart_ns = begin.saturating_sub(last).max(first.saturating_sub(*end));
    (apart_ns > 1_000_000_000).then(|| {
        Finding::problem(format!(
            "scans and odometry are {:.0} s apart by their stamps: set the clock of the laser or \
             of the odometry",
            apart_ns as f64 / 1e9
        ))
    })
}

/// Whether odometry ends long before the scans do.
fn ended(drive: &Drive) -> Option<Finding> {
    let end = *drive.odometry.iter().max()?;
    let after = drive
        .looks
        .iter()
        .filter(|look| look.stamp_ns > end)
        .count();
    let last = drive.looks.iter().map(|look| look.stamp_ns).max()?;
    let silent_s = last.saturating_sub(end) as f64 / 1e9;
    let mut periods: Vec<i64> = drive
        .odometry
        .windows(2)
        .map(|pair| pair[1].saturating_sub(pair[0]))
        .collect();
    periods.sort_unstable();
    let period_s = periods
        .get(periods.len() / 2)
        .map_or(0.0, |&ns| ns as f64 / 1e9);
    let is_over = after >= MIN_SCANS && silent_s > SILENT_S.max(SILENT_PERIODS * period_s);
    is_over.then(|| {
        Finding::problem(format!(
            "odometry ends {silent_s:.1} s before the scans: look for why its driver stopped; \
             scans are matched to each other from there on"
        ))
    })
}

/// Whether odometry never changes while scans do.
fn never_moves(drive: &Drive) -> Option<Finding> {
    if drive.odometry.is_empty() || drive.motion.has_moved(i64::MAX) {
        return None;
    }
    let first = drive.looks.first()?;
    let moving = drive
        .looks
        .iter()
        .filter(|look| changed_share(first, look) > CHANGED_SHARE);
    (moving.count() >= MIN_SCANS).then(|| {
        Finding::problem(
            "odometry never moves, but scans do: does its driver get the wheels' turns? Until it \
             does, scans are matched to each other",
        )
    })
}

/// The share of beams that read something else in another scan.
fn changed_share(one: &Look, other: &Look) -> f64 {
    let pairs = one.ranges.iter().zip(&other.ranges);
    let read = pairs.filter(|(a, b)| a.is_finite() && b.is_finite());
    let (mut all, mut changed) = (0, 0);
    for (a, b) in read {
        all += 1;
        changed += usize::from((a - b).abs() > CHANGED_M);
    }
    if all < MIN_BEAMS {
        0.0
    } else {
        changed as f64 / all as f64
    }
}

/// Whether the same scan comes again and again while the robot moves.
fn frozen(drive: &Drive) -> Option<Finding> {
    let is_same = |a: &Look, b: &Look| {
        let bits = |look: &Look| {
            look.ranges
                .iter()
                .map(|range| range.to_bits())
                .collect::<Vec<_>>()
        };
        a.stamp_ns != b.stamp_ns && bits(a) == bits(b)
    };
    let mut runs = drive.looks.chunk_by(is_same);
    let run = runs.find(|run| {
        let ends = run.first().zip(run.last());
        let moved = ends.and_then(|(first, last)| drive.moved(first, last));
        let has_moved = moved.is_some_and(|m| m.x.hypot(m.y) > MOVED.0 || m.yaw.abs() > MOVED.1);
        run.len() >= MIN_SCANS && has_moved
    })?;
    Some(Finding::problem(format!(
        "{} scans in a row are the same to the last bit while odometry moves: the laser is \
         frozen; restart it or its driver",
        run.len()
    )))
}

/// Whether the laser reads one distance in all directions.
fn covered(drive: &Drive) -> Option<Finding> {
    let is_covered = |look: &&Look| {
        let mut read: Vec<f32> = look
            .ranges
            .iter()
            .copied()
            .filter(|r| r.is_finite())
            .collect();
        read.sort_unstable_by(f32::total_cmp);
        let Some(&middle) = read.get(read.len() / 2) else {
            return false;
        };
        let near = read
            .iter()
            .filter(|&&range| (range - middle).abs() <= COVER_M)
            .count();
        read.len() >= MIN_BEAMS && near as f64 >= COVER_SHARE * read.len() as f64
    };
    let count = drive.looks.iter().filter(is_covered).count();
    (count >= MIN_SCANS).then(|| {
        Finding::problem(format!(
            "{count} scans read one distance in all directions: is the laser covered? Uncover it, \
             or clean its window"
        ))
    })
}

/// Whether scans turn the other way than odometry does.
fn mirrored(drive: &Drive) -> Option<Finding> {
    let (mut same, mut opposite) = (0, 0);
    for pair in drive.looks.windows(2) {
        let Some(moved) = drive.moved(&pair[0], &pair[1]) else {
            continue;
        };
        if !TURNS.contains(&moved.yaw.abs()) || moved.x.hypot(moved.y) > 2.0 * MOVED.0 {
            continue;
        }
        let error = |turn: f64| turned_error(&pair[0], &pair[1], turn);
        let (Some(with), Some(against)) = (error(moved.yaw), error(-moved.yaw)) else {
            continue;
        };
        let is_clear = |better: f32, worse: f32| worse > (2.0 * better).max(better + CLEAR_M);
        same += usize::from(is_clear(with, against));
        opposite += usize::from(is_clear(against, with));
    }
    let share = opposite as f64 / (same + opposite).max(1) as f64;
    (opposite >= MIN_SCANS && share > MIRRORED_SHARE).then(|| {
        Finding::problem(format!(
            "scans turn the other way than odometry in {opposite} of {} turns: the laser is \
             mirrored; if it hangs upside down, /tf_static must say so by a roll of 180 degrees",
            same + opposite
        ))
    })
}

/// The median difference of the readings of two scans, metres, between which the robot
/// turned so, radians.
fn turned_error(before: &Look, now: &Look, turn: f64) -> Option<f32> {
    let shift = (turn / now.increment).round();
    let same = before.ranges.len() == now.ranges.len() && before.increment == now.increment;
    if !same || !shift.is_finite() {
        return None;
    }
    let then = |beam: usize| {
        before
            .ranges
            .get(usize::try_from(beam as i64 + shift as i64).ok()?)
    };
    let pairs = now
        .ranges
        .iter()
        .enumerate()
        .filter_map(|(beam, range)| Some((range, then(beam)?)));
    let mut off: Vec<f32> = pairs
        .map(|(now, then)| (now - then).abs())
        .filter(|off| off.is_finite())
        .collect();
    off.sort_unstable_by(f32::total_cmp);
    (off.len() >= MIN_BEAMS).then(|| off[off.len() / 2])
}

#[cfg(test)]
mod tests {
    use engine::motion::Motion;
    use geometry::Pose;

    use super::*;

    const SECOND: i64 = 1_000_000_000;

    /// A laser at the centre of a room of 6 × 4 m that turns by a tenth a second, as
    /// odometry says.
    fn turning() -> Drive {
        let mut drive = Drive {
            looks: Vec::new(),
            odometry: Vec::new(),
            motion: Motion::keeping(64),
        };
        for second in 0..30 {
            let yaw = 0.1 * second as f64;
            let range = |beam: usize| {
                let angle = yaw + (beam as f64).to_radians();
                (3.0 / angle.cos().abs()).min(2.0 / angle.sin().abs()) as f32
            };
            drive.looks.push(Look {
                stamp_ns: second * SECOND,
                ranges: (0..360).map(range).collect(),
                increment: 1f64.to_radians(),
            });
            drive.add(second * SECOND, Pose::new(0.0, 0.0, yaw));
        }
        drive
    }

    fn check(key_word: Option<&str>, spoil: impl FnOnce(&mut Drive)) {
        let mut drive = turning();
        spoil(&mut drive);
        let found = all(&drive);
        let words: Vec<&str> = found
            .iter()
            .map(|finding| finding.finding.as_str())
            .collect();
        match key_word {
            None => assert!(words.is_empty(), "{words:?}"),
            Some(word) => assert!(words.len() == 1 && words[0].contains(word), "{words:?}"),
        }
    }

    fn odometry(drive: &mut Drive, samples: i64, pose: fn(f64) -> Pose) {
        (drive.odometry, drive.motion) = (Vec::new(), Motion::keeping(64));
        for second in 0..samples {
            drive.add(second * SECOND, pose(second as f64));
        }
    }

    #[test]
    fn a_sound_drive_has_no_finding_and_a_robot_may_stand() {
        check(None, |_| ());
        check(None, |drive| {
            drive.looks = vec![drive.looks[0].clone(); 30];
            for (second, look) in (0..).zip(&mut drive.looks) {
                look.stamp_ns = second * SECOND;
            }
            odometry(drive, 30, |_| Pose::IDENTITY);
        });
    }

    #[test]
    fn each_fault_is_named() {
        check(Some("mirrored"), |drive| {
            drive
                .looks
                .iter_mut()
                .for_each(|look| look.ranges.reverse())
        });
        check(Some("frozen"), |drive| {
            let last = drive.looks[15].ranges.clone();
            drive.looks[15..]
                .iter_mut()
                .for_each(|look| look.ranges.clone_from(&last));
        });
        check(Some("covered"), |drive| {
            let ranges = |second: i64| {
                (0..360)
                    .map(|i| 1.0 + 0.0001 * ((i + second) % 7) as f32)
                    .collect()
            };
            drive
                .looks
                .iter_mut()
                .for_each(|look| look.ranges = ranges(look.stamp_ns / SECOND));
        });
        check(Some("ends"), |drive| {
            odometry(drive, 15, |second| Pose::new(0.0, 0.0, 0.1 * second))
        });
        check(Some("never moves"), |drive| {
            odometry(drive, 30, |_| Pose::IDENTITY)
        });
        check(Some("apart"), |drive| {
            drive
                .looks
                .iter_mut()
                .for_each(|look| look.stamp_ns += 9000 * SECOND)
        });
    }
}
