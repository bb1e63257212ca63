//! Readings of wide beams, converted to scans that can vote: regions of constant depth.
//!
//! A sonar measures the distance of the nearest surface in its cone, not its direction. The paper
//! names two solutions (section II A): regions of constant depth (Leonard and Durrant-Whyte,
//! Directed Sonar Sensing for Mobile Robot Navigation, 1992), which [`regions`] finds, and σ_θ of
//! Eq. 1, which [`spread`] stands for. A ring has too few transducers for regions within one scan,
//! so both take the echoes of several scans, moved by odometry into the frame of the last;
//! [`Window`] keeps them. The results are the ranges of one scan; nothing here votes.

mod window;

use std::f64::consts::{PI, TAU};

use engine::EngineError;
use engine::scan::Scan;
use geometry::{Pose, angle_between};

pub use window::{SonarConfig, Window};

/// Number of bearings per turn of the search and of the scans made, from behind the robot.
pub const BEARINGS: usize = 360;

/// Angle from one bearing to the next, in radians.
const STEP: f64 = TAU / BEARINGS as f64;

/// Makes the scan with ranges at these bearings, in metres.
pub fn scan_of(ranges: &[f32]) -> Scan<'_> {
    Scan {
        angle_min: -PI,
        angle_increment: STEP,
        range_min_m: 0.0,
        // Ranges extend to echoes from the other end of the path.
        range_max_m: f32::MAX,
        ranges,
    }
}

/// One reading of a wide beam, with the pose of its transducer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Echo {
    /// Pose of the transducer, looking along x, in the frame of the scan that is made.
    pub scan_from_transducer: Pose,
    pub range_m: f64,
}

impl Echo {
    /// Returns the echoes of a scan, with the laser's pose in the frame of the scan that is made.
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

    /// Position of the surface if it is in this direction, in metres.
    fn point(&self, bearing: f64) -> (f64, f64) {
        let Pose { x, y, .. } = self.scan_from_transducer;
        let (sin, cos) = bearing.sin_cos();
        (x + self.range_m * cos, y + self.range_m * sin)
    }

    /// Distance in metres to a wall with a normal of this bearing, if that wall made the echo.
    fn depth(&self, bearing: f64) -> f64 {
        let (x, y) = self.point(bearing);
        x * bearing.cos() + y * bearing.sin()
    }

    fn has_in_cone(&self, bearing: f64, half_width: f64) -> bool {
        // The margin for rounding is a billionth of a radian.
        angle_between(bearing, self.scan_from_transducer.yaw) <= half_width + 1e-9
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegionConfig {
    /// Half of the width of a cone, in radians.
    pub half_width: f64,
    /// Largest difference between the depths of a region, in metres.
    pub depth_m: f64,
    /// Smallest number of echoes of a region.
    pub least_echoes: usize,
    /// Width of all bearings at which the depths agree in radians, at most.
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

#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Bearing of the wall's normal, away from the robot, in radians.
    pub bearing: f64,
    /// Mean distance in metres from the frame's origin to the wall along that bearing.
    pub depth_m: f64,
    pub echoes: Vec<usize>,
}

#[derive(Debug, Default)]
struct Group {
    bearing: usize,
    echoes: Vec<usize>,
    /// Difference between smallest and largest depth, in metres.
    spread_m: f64,
}

/// Finds the regions of constant depth, those with most echoes first. Along the normal of a wall,
/// its echoes have the same depth from any pose; along other bearings, they differ.
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

/// Finds the largest group; on a tie the one whose depths agree best.
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

/// Makes the region of a group at the middle of its bearings, if these are few enough.
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

/// Makes a scan of the echoes where their regions met the wall: metres, else NaN.
pub fn at_regions(echoes: &[Echo], regions: &[Region]) -> Vec<f32> {
    let mut ranges = Ranges::default();
    for region in regions {
        for echo in region.echoes.iter().filter_map(|&i| echoes.get(i)) {
            ranges.add(echo.point(region.bearing), 0);
        }
    }
    ranges.metres()
}

/// Makes a scan of the echoes, each at all bearings within `half_width` radians of its axis: Eq. 1
/// with a box instead of the Gaussian over φ. At a bearing, the echo nearest to its axis counts, on
/// a tie the shortest. Ranges in metres, NaN at bearings without any.
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

fn angle_of(bearing: usize) -> f64 {
    bearing as f64 * STEP - PI
}

/// For each bearing, the distance of its point from the axis, in steps, and the range in metres.
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
mod tests;
