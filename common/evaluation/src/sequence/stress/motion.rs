//! Changes of the robot's motion.

use ::map::UNKNOWN;
use geometry::Pose;
use ros::Time;

use super::super::drive::{Moment, connect};
use super::laser::noise;
use super::map::walls;
use super::material::{Change, Means};
use super::material::{Material, Step};

/// Number of scans of a robot that stands still, and their noise in metres.
const STANDS: usize = 1000;
const NOISE_M: f32 = 0.03;

/// Longest part of the drive off the map, in metres; at most a third of the drive.
const OFF_MAP_M: f64 = 15.0;

/// Distance between kidnappings, in metres, at most a quarter of the drive; and the number of scans
/// that a tracker has to notice.
const CARRIED_M: f64 = 15.0;
const TO_NOTICE: usize = 2;

/// Duration of each silence, and its period, in seconds.
const SILENT_S: (f64, f64) = (10.0, 40.0);

/// Repeats measurements at one place, with odometry that agrees.
pub(super) fn stand(it: &mut Material, means: &mut Means<'_>) -> Change<()> {
    let middle = it.steps.len() / 2;
    let mut later = it.steps.iter().skip(middle);
    let known = later.find(|step| step.truth.is_some());
    let Some(place) = known.cloned() else {
        return Err("no truth is known in its second half");
    };
    let period_ns = match &it.steps[..] {
        [first, .., last] => {
            (last.scan.stamp_ns - first.scan.stamp_ns) / (it.steps.len() as i64 - 1)
        }
        _ => return Err("the drive has one scan"),
    };
    let template = it.odometry.get(it.odometry.len() / 2).copied();
    it.odometry.clear();
    it.steps.clear();
    for i in 0..STANDS as i64 {
        let later_ns = i * period_ns;
        let mut step = Step {
            gone_m: 0.0,
            ..place.clone()
        };
        let scan = &mut step.scan;
        scan.others.clear();
        scan.stamp_ns += later_ns;
        scan.log_time_ns += later_ns;
        scan.message.header.stamp =
            Time::from_ns(scan.stamp_ns).ok_or("its stamps are out of range")?;
        noise(&mut scan.message, means, NOISE_M);
        it.odometry.extend(template.map(|mut one| {
            one.stamp.measured_ns = scan.stamp_ns;
            one
        }));
        it.steps.push(step);
    }
    Ok(())
}

/// Starts off the map: makes all cells unknown that are nearer to its first part than to the rest.
pub(super) fn start_off_map(it: &mut Material) -> Change<()> {
    let off_map_m = OFF_MAP_M.min(it.length_m() / 3.0);
    let until = it.steps.partition_point(|step| step.gone_m <= off_map_m);
    let way = |steps: &[Step]| {
        let mut at: Vec<Pose> = Vec::new();
        for step in steps {
            let here = step.map_from_laser;
            if at.last().is_none_or(|last| last.distance_to(here) >= 0.5) {
                at.push(here);
            }
        }
        at
    };
    let (off, on) = (way(&it.steps[..until]), way(&it.steps[until..]));
    let before = walls(&it.map).len();
    for row in 0..it.map.height {
        for column in 0..it.map.width {
            let (x, y) = it.map.cell_center(column, row);
            let to = |way: &[Pose]| {
                let squares = way.iter().map(|at| (at.x - x).powi(2) + (at.y - y).powi(2));
                squares.fold(f64::INFINITY, f64::min)
            };
            if to(&off) < to(&on) {
                it.map.cells[(row * it.map.width + column) as usize] = UNKNOWN;
            }
        }
    }
    it.starts_until_m = off_map_m;
    match walls(&it.map).len() {
        left if left < before => Ok(()),
        _ => Err("it drives everywhere twice"),
    }
}

/// Kidnaps the robot repeatedly while its odometry stands still: reorders pieces of the drive.
pub(super) fn carry_away(moments: &mut Vec<Moment>) -> Change<()> {
    let total = moments.last().map_or(0.0, |last| last.gone_m);
    let piece_m = CARRIED_M.min(total / 4.0);
    if piece_m <= 0.0 {
        return Err("the robot does not move");
    }
    let of = |moment: &Moment| (moment.gone_m / piece_m) as usize;
    let pieces: Vec<&[Moment]> = moments.chunk_by(|a, b| of(a) == of(b)).collect();
    let Some(period_ns) = moments.get(1).map(|it| it.stamp_ns - moments[0].stamp_ns) else {
        return Err("the drive has one scan");
    };
    let half = pieces.len() / 2;
    // Alternates between pieces of the first and second half, never neighbours.
    let order = (0..half).flat_map(|i| [pieces[half + i], pieces[i]]);
    let mut carried: Vec<Moment> = Vec::with_capacity(moments.len());
    for piece in order {
        let from = carried
            .last()
            .map(|last| (last.stamp_ns + period_ns, last.gone_m));
        let (begin_ns, begin_m) = from.unwrap_or((piece[0].stamp_ns, 0.0));
        for (i, moment) in piece.iter().enumerate() {
            let is_known = from.is_none() || i >= TO_NOTICE;
            carried.push(Moment {
                stamp_ns: begin_ns + moment.stamp_ns - piece[0].stamp_ns,
                gone_m: begin_m + moment.gone_m - piece[0].gone_m,
                truth: moment.truth.filter(|_| is_known),
                moved: match i {
                    0 => Some(Pose::IDENTITY),
                    _ => moment.moved,
                },
                ..moment.clone()
            });
        }
    }
    *moments = carried;
    Ok(())
}

/// Removes the scans of regular silent periods.
pub(super) fn silence(moments: &mut Vec<Moment>) -> Change<()> {
    let (all, first_ns) = (
        moments.len(),
        moments.first().map_or(0, |first| first.stamp_ns),
    );
    moments.retain(|moment| {
        let seconds = (moment.stamp_ns - first_ns) as f64 / 1e9;
        seconds % SILENT_S.1 < SILENT_S.1 - SILENT_S.0
    });
    connect(moments, (false, 1.0));
    match moments.len() {
        left if left < all => Ok(()),
        _ => Err("the drive is shorter than 30 s"),
    }
}
