//! Readings of wide beams, made fit to vote: regions of constant depth.
//!
//! A sonar says how far the nearest surface in its cone is, not in which
//! direction. The paper names two ways out (section II A): regions of constant
//! depth (Leonard and Durrant-Whyte, Directed Sonar Sensing for Mobile Robot
//! Navigation, 1992), which [`regions`] finds, and σ_θ of Eq. 1, which [`spread`]
//! stands for. A ring has too few transducers for regions within one scan, so
//! both take the echoes of several scans, moved by the odometry into the frame of
//! the last; [`Window`] keeps them. They make the ranges of one scan; nothing here
//! votes.

mod window;

use std::f64::consts::{PI, TAU};

use geometry::{Pose, angle_between};

use crate::EngineError;
use crate::scan::Scan;

pub use window::{SonarConfig, Window};

/// Bearings of a turn at which regions are searched, and of the scans that are
/// made here, which begin behind: one a degree.
pub const BEARINGS: usize = 360;

/// From one bearing to the next, radians.
const STEP: f64 = TAU / BEARINGS as f64;

/// The scan of ranges at these bearings, metres.
#[must_use]
pub fn scan_of(ranges: &[f32]) -> Scan<'_> {
    Scan {
        angle_min: -PI,
        angle_increment: STEP,
        range_min_m: 0.0,
        // They reach as far as an echo from the other end of the way.
        range_max_m: f32::MAX,
        ranges,
    }
}

/// One reading of a wide beam, and from where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Echo {
    /// Where the transducer was and looked, in the frame of the scan that is made.
    pub scan_from_transducer: Pose,
    /// Metres.
    pub range_m: f64,
}

impl Echo {
    /// The echoes of a scan whose transducers all sit where the laser would.
    /// `scan_from_laser` is where that was, in the frame of the scan that is made.
    ///
    /// # Errors
    /// If [`Scan::check`] refuses the scan.
    pub fn of<'s>(
        scan: &'s Scan<'_>,
        scan_from_laser: Pose,
    ) -> Result<impl Iterator<Item = Echo> + 's, EngineError> {
        scan.check()?;
        Ok((0..scan.ranges.len()).filter_map(move |i| {
            let looking = Pose::new(0.0, 0.0, scan.bearing(i));
            Some(Echo {
                scan_from_transducer: scan_from_laser.then(looking),
                range_m: scan.reading(i)?,
            })
        }))
    }

    /// Where the echo comes from if its surface lies in this direction, metres.
    fn point(&self, bearing: f64) -> (f64, f64) {
        let Pose { x, y, .. } = self.scan_from_transducer;
        let (sin, cos) = bearing.sin_cos();
        (x + self.range_m * cos, y + self.range_m * sin)
    }

    /// How far a wall whose normal has this bearing is from the frame's origin if
    /// it made the echo, metres.
    fn depth(&self, bearing: f64) -> f64 {
        let (x, y) = self.point(bearing);
        x * bearing.cos() + y * bearing.sin()
    }

    fn has_in_cone(&self, bearing: f64, half_width: f64) -> bool {
        // A billionth of a radian is a margin for rounding.
        angle_between(bearing, self.scan_from_transducer.yaw) <= half_width + 1e-9
    }
}

/// What a region of constant depth is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegionConfig {
    /// Half of a cone's width, radians.
    pub half_width: f64,
    /// Greatest difference between depths of a region, metres.
    pub depth_m: f64,
    /// Fewest echoes of a region.
    pub least_echoes: usize,
    /// The bearing must be known as well as this: the width of all bearings at
    /// which the depths agree, radians. Readings that a robot repeats from one
    /// place agree everywhere in the cone.
    pub known_within: f64,
}

impl Default for RegionConfig {
    fn default() -> Self {
        RegionConfig {
            half_width: 15f64.to_radians(),
            depth_m: 0.06,
            least_echoes: 4,
            known_within: 12f64.to_radians(),
        }
    }
}

/// Echoes of one wall.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Of the wall's normal, away from the robot, radians.
    pub bearing: f64,
    /// From the frame's origin to the wall along that bearing, metres: the mean
    /// of its echoes, and constant among them.
    pub depth_m: f64,
    /// Indices of the echoes.
    pub echoes: Vec<usize>,
}

/// Echoes whose depths agree at a bearing.
#[derive(Debug, Default)]
struct Group {
    /// Index among the bearings.
    bearing: usize,
    /// Indices of the echoes.
    echoes: Vec<usize>,
    /// Between the least depth and the greatest, metres.
    spread_m: f64,
}

/// The regions of constant depth among echoes, those with most echoes first; each
/// echo is in one at most.
///
/// Along the normal of a wall all of its echoes say the same depth, wherever the
/// robot was. Along other bearings they do not, once it has moved or turned.
#[must_use]
pub fn regions(echoes: &[Echo], config: &RegionConfig) -> Vec<Region> {
    let mut left: Vec<usize> = (0..echoes.len()).collect();
    let mut regions = Vec::new();
    loop {
        let group = largest(echoes, &left, config);
        if group.echoes.len() < config.least_echoes.max(1) {
            return regions;
        }
        left.retain(|i| !group.echoes.contains(i));
        regions.extend(region(echoes, group, config));
    }
}

/// The largest group; of equally large ones that whose depths agree best.
fn largest(echoes: &[Echo], left: &[usize], config: &RegionConfig) -> Group {
    let mut best = Group::default();
    for bearing in 0..BEARINGS {
        let angle = angle_of(bearing);
        let in_cone = left.iter().map(|&i| (i, &echoes[i]));
        let in_cone = in_cone.filter(|(_, echo)| echo.has_in_cone(angle, config.half_width));
        let mut depths: Vec<(f64, usize)> =
            in_cone.map(|(i, echo)| (echo.depth(angle), i)).collect();
        depths.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut first = 0;
        for last in 0..depths.len() {
            while depths[last].0 - depths[first].0 > config.depth_m {
                first += 1;
            }
            let (agreeing, spread_m) = (&depths[first..=last], depths[last].0 - depths[first].0);
            let (size, largest) = (agreeing.len(), best.echoes.len());
            if size > largest || (size == largest && spread_m < best.spread_m) {
                best = Group {
                    bearing,
                    echoes: agreeing.iter().map(|&(_, i)| i).collect(),
                    spread_m,
                };
            }
        }
    }
    best
}

/// What a group says of a wall, if it pins down the wall's bearing: in the middle
/// of those at which it agrees.
fn region(echoes: &[Echo], group: Group, config: &RegionConfig) -> Option<Region> {
    let agrees = |offset: i64| {
        let bearing = (group.bearing as i64 + offset).rem_euclid(BEARINGS as i64);
        let angle = angle_of(bearing as usize);
        let mut members = group.echoes.iter().map(|&i| &echoes[i]);
        let depths = members.clone().map(|echo| echo.depth(angle));
        let (least, most) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), m| {
            (least.min(m), most.max(m))
        });
        most - least <= config.depth_m
            && members.all(|echo| echo.has_in_cone(angle, config.half_width))
    };
    let most = (config.known_within / STEP) as i64;
    let up = (1..=most + 1).take_while(|&i| agrees(i)).count() as i64;
    let down = (1..=most + 1).take_while(|&i| agrees(-i)).count() as i64;
    if up + down > most {
        return None;
    }
    let bearing = angle_of(group.bearing) + (up - down) as f64 * STEP / 2.0;
    let depths = group.echoes.iter().map(|&i| echoes[i].depth(bearing));
    Some(Region {
        bearing,
        depth_m: depths.sum::<f64>() / group.echoes.len() as f64,
        echoes: group.echoes,
    })
}

/// A scan of the echoes that are in regions, each where its region says that it
/// met the wall. Metres, NaN at bearings without any.
#[must_use]
pub fn at_regions(echoes: &[Echo], regions: &[Region]) -> Vec<f32> {
    let mut ranges = Ranges::default();
    for region in regions {
        for echo in region.echoes.iter().filter_map(|&i| echoes.get(i)) {
            ranges.add(echo.point(region.bearing), 0);
        }
    }
    ranges.metres()
}

/// A scan of the echoes, each at all bearings within `half_width` radians of where
/// its transducer looked, so that a pose has its vote wherever in the cone the
/// surface is: Eq. 1 with a box in place of the Gaussian over φ. Where several
/// fall on a bearing, that nearest to its axis stands, and of equally near ones
/// the shortest. Without width, all echoes lie on their axes. Metres, NaN at
/// bearings without any.
#[must_use]
pub fn spread(echoes: &[Echo], half_width: f64) -> Vec<f32> {
    let reach = (half_width / STEP)
        .floor()
        .clamp(0.0, BEARINGS as f64 / 2.0) as i64;
    let mut ranges = Ranges::default();
    for echo in echoes {
        for offset in -reach..=reach {
            let angle = echo.scan_from_transducer.yaw + offset as f64 * STEP;
            ranges.add(echo.point(angle), offset.unsigned_abs());
        }
    }
    ranges.metres()
}

/// A bearing by its index, radians.
fn angle_of(bearing: usize) -> f64 {
    bearing as f64 * STEP - PI
}

/// By bearing, how far off its axis the point that stands there lies, in steps,
/// and its distance.
struct Ranges(Vec<Option<(u64, f64)>>);

impl Default for Ranges {
    fn default() -> Self {
        Ranges(vec![None; BEARINGS])
    }
}

impl Ranges {
    fn add(&mut self, (x, y): (f64, f64), off_axis: u64) {
        let bearing = ((y.atan2(x) + PI) / STEP).round() as usize % BEARINGS;
        let (new, held) = ((off_axis, x.hypot(y)), &mut self.0[bearing]);
        if held.is_none_or(|held| new < held) {
            *held = Some(new);
        }
    }

    fn metres(self) -> Vec<f32> {
        let metres = |held: Option<(u64, f64)>| held.map_or(f32::NAN, |(_, metres)| metres as f32);
        self.0.into_iter().map(metres).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// A transducer that looks this many degrees from ahead, and reads a wall whose
    /// normal is at `normal` degrees and `depth_m` from the frame's origin.
    fn echo(x: f64, y: f64, axis: f64, (normal, depth_m): (f64, f64)) -> Echo {
        let (sin, cos) = normal.to_radians().sin_cos();
        Echo {
            scan_from_transducer: Pose::new(x, y, axis.to_radians()),
            range_m: depth_m - x * cos - y * sin,
        }
    }

    fn found(echoes: &[Echo]) -> Vec<(i64, f64, Vec<usize>)> {
        let found = regions(echoes, &RegionConfig::default()).into_iter();
        let rounded = |region: Region| {
            let mut echoes = region.echoes;
            echoes.sort_unstable();
            let depth_cm = (region.depth_m * 100.0).round();
            (region.bearing.to_degrees().round() as i64, depth_cm, echoes)
        };
        found.map(rounded).collect()
    }

    /// What one transducer reads of a wall on a metre of way, at ten places.
    fn drive(axis: f64, wall: (f64, f64)) -> Vec<Echo> {
        let places = (0..10).map(|i| f64::from(i) / 9.0);
        places.map(|x| echo(x, 0.0, axis, wall)).collect()
    }

    #[test]
    fn a_wall_that_is_passed_has_its_true_bearing_not_that_of_the_axis() {
        let all: Vec<usize> = (0..10).collect();
        for normal in [80.0, 90.0, 100.0] {
            let found = found(&drive(90.0, (normal, 2.0)));
            let [(bearing, depth_cm, echoes)] = &found[..] else {
                panic!("{found:?}");
            };
            // A metre of way distinguishes bearings that differ by 6 cm / 1 m, 3 degrees, and
            // the depth at one of those is off by that share of half the way.
            assert!((bearing - normal as i64).abs() <= 2, "{found:?}");
            assert!((depth_cm - 200.0).abs() <= 3.0, "{found:?}");
            assert_eq!(*echoes, all);
        }
    }

    #[test]
    fn a_robot_that_turns_on_the_spot_sees_a_wall_over_the_width_of_its_cone() {
        // Every three degrees; the wall ahead answers within 15 degrees.
        let axes = (-5..=5).map(|i| f64::from(i) * 3.0);
        let echoes: Vec<Echo> = axes.map(|axis| echo(0.0, 0.0, axis, (0.0, 2.0))).collect();
        assert_eq!(found(&echoes), [(0, 200.0, (0..11).collect())]);
    }

    #[test]
    fn echoes_that_a_robot_repeats_from_one_place_are_no_region() {
        let still = vec![echo(0.0, 0.0, 90.0, (90.0, 2.0)); 20];
        assert_eq!(found(&still), []);
    }

    #[test]
    fn two_walls_are_two_regions_and_cross_talk_is_in_none() {
        let mut echoes = drive(90.0, (90.0, 2.0));
        echoes.extend(drive(-90.0, (-90.0, 1.0)).into_iter().take(8));
        // What cannot be: three that agree with nothing, in the left one's cone.
        for (i, range_m) in [(2, 0.7), (4, 4.1), (6, 3.0)] {
            echoes[i].range_m = range_m;
        }
        let left = [0, 1, 3, 5, 7, 8, 9].to_vec();
        let expected = [(-90, 100.0, (10..18).collect()), (90, 200.0, left)];
        assert_eq!(found(&echoes), expected);
    }

    #[test]
    fn regions_vote_where_their_walls_were_met() {
        // The axis is ten degrees off the wall's normal, at 100 degrees.
        let echoes = drive(90.0, (100.0, 2.0));
        let regions = regions(&echoes, &RegionConfig::default());
        let ranges = at_regions(&echoes, &regions);
        let points: Vec<_> = (0..BEARINGS)
            .filter(|&i| ranges[i].is_finite())
            .map(|i| (angle_of(i), f64::from(ranges[i])))
            .collect();
        assert!(points.len() >= 8, "{points:?}");
        let (sin, cos) = 100f64.to_radians().sin_cos();
        for (bearing, metres) in points {
            let depth_m = metres * (bearing.cos() * cos + bearing.sin() * sin);
            // Rounding a bearing by half a degree moves the foot of a wall that is
            // met at up to 25 degrees by 1 cm; the region's own bearing is as good.
            assert!((depth_m - 2.0).abs() < 0.04, "{bearing}: {depth_m}");
        }
    }

    #[test]
    fn an_echo_is_spread_over_its_cone_and_over_the_turn() {
        let at = |degrees: i64, ranges: &[f32]| ranges[(degrees + 180) as usize];
        let echo = |axis: f64, range_m| Echo {
            scan_from_transducer: Pose::new(0.0, 0.0, axis.to_radians()),
            range_m,
        };
        let ranges = spread(&[echo(0.0, 2.0), echo(10.0, 1.0), echo(179.0, 3.0)], 0.1);
        // Five whole degrees to each side; at five, both are equally far off.
        assert_eq!(at(4, &ranges), 2.0);
        assert_eq!(at(5, &ranges), 1.0);
        assert!(at(-6, &ranges).is_nan() && at(16, &ranges).is_nan());
        assert_eq!([at(174, &ranges), at(-176, &ranges)], [3.0, 3.0]);
        assert_eq!(ranges.iter().filter(|range| !range.is_nan()).count(), 32);
        let alone = spread(&[echo(10.0, 1.0)], 0.0);
        assert_eq!(alone.iter().filter(|range| !range.is_nan()).count(), 1);
    }

    #[test]
    fn echoes_of_a_scan_lie_where_it_was_taken() {
        let scan = Scan {
            angle_min: 0.0,
            angle_increment: FRAC_PI_2,
            range_min_m: 0.0,
            range_max_m: 10.0,
            ranges: &[f32::NAN, 2.0, f32::INFINITY],
        };
        let moved = Pose::new(1.0, 0.5, FRAC_PI_2);
        let echoes: Vec<Echo> = Echo::of(&scan, moved).unwrap().collect();
        assert_eq!(echoes.len(), 1);
        let (x, y) = echoes[0].point(echoes[0].scan_from_transducer.yaw);
        // It looks to the left of a robot that has turned to the left.
        assert!((x + 1.0).abs() < 1e-12 && (y - 0.5).abs() < 1e-12);
        let unsound = Scan {
            ranges: &[],
            ..scan
        };
        assert_eq!(
            Echo::of(&unsound, moved).err(),
            Some(EngineError::EmptyScan)
        );
    }
}
