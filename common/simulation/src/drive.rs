//! A drive: scan by scan, what is true and what the robot gets of it.

use geometry::Pose;
use map::OccupancyGrid;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

use crate::noise::Receiver;
use crate::obstacles::Obstacles;
use crate::odometry::Odometer;
use crate::path::Timetable;
use crate::people::People;
use crate::scene::Scene;
use crate::sonar::Ring;
use crate::{Bearings, DriveConfig, Path, SimulationError, laser};

/// Most scans of a drive: a day at ten a second.
const MAX_SCANS: u64 = 864_000;

/// One scan and where it was taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Since the start of the drive, nanoseconds.
    pub time_ns: i64,
    /// Where the base truly is.
    pub map_from_base: Pose,
    /// Where the sensor truly is.
    pub map_from_laser: Pose,
    /// Where the wheels say that the base is.
    pub odom_from_base: Pose,
    /// How fast the wheels say that the base moves since the snapshot before,
    /// in its own frame: m/s, m/s and rad/s; zero in the first.
    pub twist: Pose,
    /// By bearing, metres; infinite where nothing returned, NaN where there is no
    /// transducer.
    pub ranges: Vec<f32>,
}

/// What is on the robot.
#[derive(Debug)]
enum Sensor {
    Laser(Bearings),
    Sonar(Ring),
}

/// Iterates over the scans of a drive.
#[derive(Debug)]
pub struct Drive {
    scene: Scene,
    timetable: Timetable,
    sensor: Sensor,
    receiver: Receiver,
    odometer: Odometer,
    base_from_laser: Pose,
    rate: f64,
    scans: u64,
    taken: u64,
    before: Option<Pose>,
}

impl Drive {
    /// A drive along a path through a map.
    ///
    /// # Errors
    /// The path or the sensor on its mount is blocked or leaves the map, the drive
    /// is too long, or people find no place.
    pub fn new(
        map: &OccupancyGrid,
        path: &Path,
        config: &DriveConfig,
    ) -> Result<Self, SimulationError> {
        let obstacles = Obstacles::of(map);
        path.check(&obstacles)?;
        let timetable = Timetable::new(path, config.speed, config.turn_rate.to_radians());
        let scans = count(&timetable, config.rate)?;
        // One source for each purpose: a setting of one does not change the others.
        let mut seeds = Xoshiro256PlusPlus::seed_from_u64(config.seed);
        let mut rng = || Xoshiro256PlusPlus::seed_from_u64(seeds.random());
        let receiver = Receiver {
            noise: config.noise,
            outliers: config.outliers,
            range_max_m: config.range_max_m(),
            rng: rng(),
        };
        let odometer = Odometer::new(config.odometry, rng());
        let people = People::new(config.people, path, &obstacles, rng())?;
        let sensor = match config.sonar.sonar {
            true => Sensor::Sonar(Ring::new(config.sonar, rng())),
            false => Sensor::Laser(config.laser.bearings()),
        };
        let drive = Drive {
            scene: Scene { obstacles, people },
            timetable,
            sensor,
            receiver,
            odometer,
            base_from_laser: config.mount.0,
            rate: config.rate,
            scans,
            taken: 0,
            before: None,
        };
        drive.check_sensor()?;
        Ok(drive)
    }

    /// The bearings of every scan.
    #[must_use]
    pub fn bearings(&self) -> Bearings {
        match &self.sensor {
            Sensor::Laser(bearings) => *bearings,
            Sensor::Sonar(_) => Ring::BEARINGS,
        }
    }

    /// Scans from start to end.
    #[must_use]
    pub fn scans(&self) -> u64 {
        self.scans
    }

    /// Where the base is in a scan.
    fn map_from_base(&self, scan: u64) -> Option<Pose> {
        self.timetable.at(scan as f64 / self.rate)
    }

    /// Checks the place of the sensor in every scan.
    fn check_sensor(&self) -> Result<(), SimulationError> {
        let obstacles = &self.scene.obstacles;
        for scan in 0..self.scans {
            let Some(map_from_base) = self.map_from_base(scan) else {
                return Ok(());
            };
            let Pose { x, y, .. } = map_from_base.then(self.base_from_laser);
            let on_map = obstacles.holds(x, y);
            if !on_map || obstacles.range(x, y, 0.0, 0.0).is_some() {
                let time_s = scan as f64 / self.rate;
                return Err(SimulationError::SensorBlocked {
                    x,
                    y,
                    time_s,
                    on_map,
                });
            }
        }
        Ok(())
    }

    fn snapshot(&mut self, map_from_base: Pose) -> Snapshot {
        let map_from_laser = map_from_base.then(self.base_from_laser);
        let twist = match self.before.replace(map_from_base) {
            Some(before) => self.advance(before, map_from_base),
            None => Pose::IDENTITY,
        };
        let ranges = match &mut self.sensor {
            Sensor::Laser(bearings) => {
                laser::scan(&self.scene, map_from_laser, *bearings, &mut self.receiver)
            }
            Sensor::Sonar(ring) => ring.scan(&self.scene, map_from_laser, &mut self.receiver),
        };
        Snapshot {
            time_ns: (self.taken as f64 / self.rate * 1e9).round() as i64,
            map_from_base,
            map_from_laser,
            odom_from_base: self.odometer.odom_from_base(),
            twist,
            ranges,
        }
    }

    /// The world goes on by the time between two scans.
    fn advance(&mut self, before: Pose, after: Pose) -> Pose {
        self.scene
            .people
            .walk(1.0 / self.rate, &self.scene.obstacles);
        let Pose { x, y, yaw } = self.odometer.advance(before, after);
        Pose::new(x * self.rate, y * self.rate, yaw * self.rate)
    }
}

impl Iterator for Drive {
    type Item = Snapshot;

    fn next(&mut self) -> Option<Snapshot> {
        if self.taken == self.scans {
            return None;
        }
        let map_from_base = self.map_from_base(self.taken)?;
        let snapshot = self.snapshot(map_from_base);
        self.taken += 1;
        Some(snapshot)
    }
}

/// Scans of a drive: one at the start, and then as long as it goes on.
fn count(timetable: &Timetable, rate: f64) -> Result<u64, SimulationError> {
    let seconds = timetable.seconds();
    // Up to rounding, a drive that ends with a scan has it.
    let scans = (seconds * rate + 1e-9) as u64 + 1;
    match scans <= MAX_SCANS {
        true => Ok(scans),
        false => Err(SimulationError::TooLong {
            seconds,
            scans,
            most: MAX_SCANS,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{config, room};

    const PATH: &str = "1,1 9,1 9,7";

    fn drive(options: &str) -> Vec<Snapshot> {
        let drive = Drive::new(&room(), &PATH.parse().unwrap(), &config(options)).unwrap();
        drive.collect()
    }

    #[test]
    fn the_same_seed_gives_the_same_drive_and_another_does_not() {
        for sensor in ["", "--sonar --cross-talk 0.1"] {
            let options = |seed| format!("{sensor} --people 3 --outliers 0.1 --seed {seed}");
            let same = |a: &[Snapshot], b: &[Snapshot]| format!("{a:?}") == format!("{b:?}");
            let first = drive(&options(4));
            assert!(same(&first, &drive(&options(4))));
            let other = drive(&options(5));
            assert!(!same(&first, &other));
            let poses = |drive: &[Snapshot]| -> Vec<Pose> {
                drive
                    .iter()
                    .map(|snapshot| snapshot.map_from_base)
                    .collect()
            };
            assert_eq!(poses(&first), poses(&other), "the path is not random");
        }
    }

    #[test]
    fn a_scan_is_taken_at_each_tick_from_start_to_end() {
        // 14 m at 0.5 m/s and a quarter turn in two seconds, twice a second.
        let drive = drive("--rate 2");
        assert_eq!(drive.len(), 61);
        assert_eq!(drive[3].time_ns, 1_500_000_000);
        let end = Pose::new(9.0, 7.0, std::f64::consts::FRAC_PI_2);
        assert!(drive[60].map_from_base.is_within(end, 1e-9, 1e-9));
    }

    #[test]
    fn readings_without_noise_are_those_of_the_room() {
        let first = &drive("--noise 0 --field-of-view 360 --beams 8 --mount 0.5,0,90")[0];
        assert_eq!(first.map_from_laser.x, 1.5);
        // From 1.5, 1 with the first beam to the rear, seen from a laser that looks
        // along y: walls of 0.1 m at 0 and 10 along x, at 0 and 8 along y.
        for (beam, expected) in [(0, 0.9), (2, 8.4), (4, 6.9), (6, 1.4)] {
            let reading = first.ranges[beam];
            // Millimetres.
            assert!((reading - expected).abs() < 0.0006, "{beam}: {reading}");
        }
    }

    #[test]
    fn people_are_seen_and_change_nothing_else() {
        let (alone, crowd) = (drive("--noise 0"), drive("--noise 0 --people 10"));
        let mut nearer = 0;
        for (alone, crowd) in alone.iter().zip(&crowd) {
            assert_eq!(alone.odom_from_base, crowd.odom_from_base);
            for (alone, crowd) in alone.ranges.iter().zip(&crowd.ranges) {
                assert!(crowd <= alone);
                nearer += u32::from(crowd < alone);
            }
        }
        assert!(nearer > 1000, "{nearer}");
    }

    #[test]
    fn a_mount_that_cannot_be_is_refused_where() {
        let path = PATH.parse().unwrap();
        let refused = |mount: &str| {
            let options = config(&format!("--mount {mount}"));
            Drive::new(&room(), &path, &options)
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            refused("-0.95,0,0"),
            "the sensor comes into an obstacle at 0.05,1.00, where its mount puts it 0.00 s after the start"
        );
        assert_eq!(
            refused("-2,0,0"),
            "the sensor comes off the map at -1.00,1.00, where its mount puts it 0.00 s after the start"
        );
    }

    #[test]
    fn a_drive_of_more_than_a_day_is_refused() {
        let error = Drive::new(
            &room(),
            &PATH.parse().unwrap(),
            &config("--rate 1000 --speed 0.01"),
        );
        let error = error.unwrap_err().to_string();
        assert_eq!(
            error,
            "the drive takes 1402 s, which is 1402001 scans; at most 864000 are simulated"
        );
    }
}
