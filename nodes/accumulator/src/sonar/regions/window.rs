//! A window over the scans with odometry of the last metres driven, read as one scan.

use std::collections::VecDeque;
use std::f64::consts::PI;

use command_line::number;
use engine::EngineError;
use engine::scan::Scan;
use geometry::Pose;

use super::{Echo, RegionConfig, at_regions, regions};
use crate::AccumulatorError;

/// Largest number of scans in a window, for the longest path and for turns on the spot.
const MAX_SCANS: usize = 128;

/// Largest number of readings of a scan: rings of sonars have fewer, lasers more.
const MAX_ECHOES: usize = 64;

/// Distances, in metres and radians, within which the last of several scans replaces the others.
const APART: (f64, f64) = (0.05, PI / 60.0);

/// Settings for the wide beams of sonars.
#[derive(Debug, Clone, Copy, PartialEq, clap::Args)]
pub struct SonarConfig {
    /// For a ring of sonars: each scan is read as the regions of constant depth among
    /// the echoes of this distance driven, metres, 0.1..=5, measured by odometry (at
    /// least five times a second). Until it is driven, nothing votes; 2 is a good
    /// value.
    #[arg(long, value_name = "METRES", value_parser = number(0.1..=5.0, "metres"))]
    pub sonar_way: Option<f64>,

    /// Full width of a sonar's cone, degrees, 1..=90.
    #[arg(long, value_name = "DEGREES", default_value_t = 30.0, value_parser = number(1.0..=90.0, "degrees"))]
    #[arg(requires = "sonar_way")]
    pub sonar_cone: f64,
}

impl SonarConfig {
    pub fn window(&self) -> Option<Window> {
        let config = RegionConfig {
            half_width: self.sonar_cone.to_radians() / 2.0,
            ..RegionConfig::default()
        };
        self.sonar_way.map(|way_m| Window::new(way_m, config))
    }
}

#[derive(Debug, Clone)]
pub struct Window {
    way_m: f64,
    config: RegionConfig,
    /// Oldest first.
    taken: VecDeque<Taken>,
}

#[derive(Debug, Clone)]
struct Taken {
    measured_ns: i64,
    odom_from_laser: Pose,
    /// Distance driven to here since the window began, in metres.
    way_m: f64,
    /// Echoes in the frame of this scan.
    echoes: Vec<Echo>,
}

impl Window {
    pub fn new(way_m: f64, config: RegionConfig) -> Self {
        Window {
            way_m,
            config,
            taken: VecDeque::new(),
        }
    }

    /// Adds a scan, and drops scans that are then behind the window; on error it stays as it was. A
    /// scan older than the last one empties the window, as the recording is played again.
    pub fn add(
        &mut self,
        scan: &Scan<'_>,
        measured_ns: i64,
        odom_from_laser: Pose,
    ) -> Result<(), AccumulatorError> {
        if !odom_from_laser.is_finite() {
            return Err(EngineError::Odometry(odom_from_laser).into());
        }
        let echoes: Vec<Echo> = Echo::of(scan, Pose::IDENTITY)?.collect();
        if echoes.len() > MAX_ECHOES {
            return Err(AccumulatorError::TooManyEchoes {
                found: echoes.len(),
                allowed: MAX_ECHOES,
            });
        }
        if self.newest_ns().is_some_and(|newest| newest > measured_ns) {
            self.taken.clear();
        }
        self.leave_out_if_near(odom_from_laser);
        let way_m = self.taken.back().map_or(0.0, |last| {
            last.way_m + last.odom_from_laser.distance_to(odom_from_laser)
        });
        self.taken.push_back(Taken {
            measured_ns,
            odom_from_laser,
            way_m,
            echoes,
        });
        self.leave_behind(way_m);
        Ok(())
    }

    /// Returns the range in metres at each whole degree from behind; NaN without an echo.
    pub fn ranges(&self) -> Vec<f32> {
        let echoes = if self.is_driven() {
            self.echoes()
        } else {
            Vec::new()
        };
        at_regions(&echoes, &regions(&echoes, &self.config))
    }

    fn newest_ns(&self) -> Option<i64> {
        self.taken.back().map(|newest| newest.measured_ns)
    }

    /// Drops the newest scan if both it and this pose are near the scan before.
    fn leave_out_if_near(&mut self, odom_from_laser: Pose) {
        let mut newest_first = self.taken.iter().rev().map(|taken| taken.odom_from_laser);
        let (Some(newest), Some(before)) = (newest_first.next(), newest_first.next()) else {
            return;
        };
        let is_near = |pose: Pose| pose.is_within(before, APART.0, APART.1);
        if is_near(newest) && is_near(odom_from_laser) {
            self.taken.pop_back();
        }
    }

    fn leave_behind(&mut self, newest_m: f64) {
        let is_behind = |taken: &Taken| newest_m - taken.way_m > self.way_m;
        while self.taken.len() > MAX_SCANS || self.taken.front().is_some_and(is_behind) {
            self.taken.pop_front();
        }
    }

    fn is_driven(&self) -> bool {
        (self.taken.back()).is_some_and(|newest| newest.way_m >= self.way_m)
    }

    fn echoes(&self) -> Vec<Echo> {
        let newest = self.taken.back().map(|newest| newest.odom_from_laser);
        let newest_from_odom = newest.unwrap_or(Pose::IDENTITY).inverse();
        let echoes = self.taken.iter().flat_map(|taken| {
            let newest_from_taken = newest_from_odom.then(taken.odom_from_laser);
            taken.echoes.iter().map(move |echo| Echo {
                scan_from_transducer: newest_from_taken.then(echo.scan_from_transducer),
                ..*echo
            })
        });
        echoes.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::scan_of;
    use super::*;

    /// Scan of a sonar that looks left at a wall two metres from the robot's line along x.
    fn read(window: &mut Window, measured_ns: i64, x: f64) -> Vec<f32> {
        let scan = Scan {
            angle_min: PI / 2.0,
            angle_increment: 1.0,
            range_min_m: 0.0,
            range_max_m: 5.0,
            ranges: &[2.0],
        };
        window
            .add(&scan, measured_ns, Pose::new(x, 0.0, 0.0))
            .unwrap();
        window.ranges()
    }

    fn window() -> Window {
        Window::new(1.0, RegionConfig::default())
    }

    fn readings(ranges: &[f32]) -> usize {
        scan_of(ranges).check().unwrap();
        ranges.iter().filter(|range| range.is_finite()).count()
    }

    fn driven(window: &mut Window) -> Vec<usize> {
        let steps = (0..=11i32).map(|i| read(window, i.into(), f64::from(i) / 10.0));
        steps.map(|ranges| readings(&ranges)).collect()
    }

    #[test]
    fn what_was_passed_on_the_way_votes_once_it_is_driven() {
        let mut window = window();
        let readings = driven(&mut window);
        assert_eq!(readings[..10], [0; 10]);
        // Rounding decides if ten tenths are a metre; far echoes share degrees.
        assert!(readings[11] >= 8, "{readings:?}");
        let ranges = window.ranges();
        // The wall is found to the left and, from earlier echoes, behind; nothing is ahead.
        let at = |degrees: i64| ranges[(degrees + 180) as usize];
        assert!((at(90) - 2.0).abs() < 0.05, "{}", at(90));
        assert!((1..80).all(|degrees| at(degrees).is_nan()));
        assert!((95..115).any(|degrees| at(degrees).is_finite()));
        assert!(window.taken.len() <= 12);
    }

    #[test]
    fn a_robot_that_stands_forgets_nothing_and_fills_no_memory() {
        let mut window = window();
        let before = driven(&mut window)[11];
        for i in 0..1000 {
            let ranges = read(&mut window, 100 + i, 1.1 + 0.001 * (i % 3) as f64);
            assert!(readings(&ranges) >= before - 1, "{i}");
        }
        assert!(window.taken.len() <= 14, "{}", window.taken.len());
        for i in 0..1000 {
            let turned = Pose::new(1.1, 0.0, i as f64);
            let scan = Scan {
                range_max_m: 5.0,
                ..scan_of(&[2.0])
            };
            window.add(&scan, 2000 + i, turned).unwrap();
        }
        assert_eq!(window.taken.len(), MAX_SCANS);
    }

    #[test]
    fn a_recording_that_starts_again_has_its_way_before_it() {
        let mut window = window();
        driven(&mut window);
        assert_eq!(readings(&read(&mut window, 3, 0.0)), 0);
        assert_eq!(window.taken.len(), 1);
    }

    #[test]
    fn what_is_no_ring_of_sonars_is_refused() {
        let mut window = window();
        let many = [1.0; MAX_ECHOES + 1];
        let laser = Scan {
            angle_increment: 0.01,
            ..scan_of(&many)
        };
        let refused = window.add(&laser, 0, Pose::IDENTITY);
        assert!(matches!(
            refused,
            Err(AccumulatorError::TooManyEchoes { found: 65, .. })
        ));
        let lost = Pose::new(f64::NAN, 0.0, 0.0);
        let refused = window.add(&scan_of(&[1.0]), 0, lost);
        assert!(matches!(
            refused,
            Err(AccumulatorError::Engine(EngineError::Odometry(_)))
        ));
        assert_eq!(window.taken.len(), 0);
    }
}
