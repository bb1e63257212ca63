//! A drive: scan by scan, what is true and what the robot gets of it.

use geometry::{Mount, Pose};
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
use crate::{Bearings, DriveConfig, NamedMount, Path, SimulationError, laser};

/// Most scans of a drive: a day at ten a second.
const MAX_SCANS: u64 = 864_000;

/// One scan and where it was taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Since the start of the drive, nanoseconds.
    pub time_ns: i64,
    /// Where the base truly is.
    pub map_from_base: Pose,
    /// Where the sensor truly is, of several the first one.
    pub map_from_laser: Pose,
    /// Where the wheels say that the base is.
    pub odom_from_base: Pose,
    /// How fast the wheels say that the base moves since what they said before,
    /// in its own frame: m/s, m/s and rad/s; zero in the first.
    pub twist: Pose,
    /// By bearing, metres; infinite where nothing returned, NaN where there is no
    /// transducer. Of several sensors the first one's.
    pub ranges: Vec<f32>,
    /// Those of the other lasers, in their order.
    pub others: Vec<Vec<f32>>,
    /// What the wheels say at the last beam, where a scan takes time.
    pub after: Option<Wheels>,
}

/// What the wheels say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheels {
    /// Since the start of the drive, nanoseconds.
    pub time_ns: i64,
    /// Where the base is.
    pub odom_from_base: Pose,
    /// As in [`Snapshot`].
    pub twist: Pose,
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
    /// Of each sensor, the first one first.
    sensors: Vec<(Mount, Receiver)>,
    odometer: Odometer,
    /// From one beam to the next, seconds.
    time_increment_s: f64,
    rate: f64,
    scans: u64,
    taken: u64,
    /// When the wheels were read last, seconds, and where the base truly was.
    before: Option<(f64, Pose)>,
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
        let mounts = config.mounts();
        check_names(&mounts)?;
        // One source for each purpose: a setting of one does not change the others.
        let mut seeds = Xoshiro256PlusPlus::seed_from_u64(config.seed);
        let mut rng = || Xoshiro256PlusPlus::seed_from_u64(seeds.random());
        let receiver = |rng| Receiver {
            noise: config.noise,
            outliers: config.outliers,
            range_max_m: config.range_max_m(),
            rng,
        };
        let first = receiver(rng());
        let odometer = Odometer::new(config.odometry, rng());
        let people = People::new(config.people, path, &obstacles, rng())?;
        let sensor = match config.sonar.sonar {
            true => Sensor::Sonar(Ring::new(config.sonar, rng())),
            false => Sensor::Laser(config.laser.bearings()),
        };
        let others = mounts.iter().skip(1).map(|_| receiver(rng()));
        let receivers: Vec<Receiver> = std::iter::once(first).chain(others).collect();
        let mounts = mounts.into_iter().map(|named| named.mount);
        let beams = match &sensor {
            Sensor::Laser(bearings) => bearings.count,
            Sensor::Sonar(_) => Ring::BEARINGS.count,
        };
        let drive = Drive {
            scene: Scene { obstacles, people },
            timetable,
            sensor,
            sensors: mounts.zip(receivers).collect(),
            odometer,
            time_increment_s: config.time_increment_s(beams).into(),
            rate: config.rate,
            scans,
            taken: 0,
            before: None,
        };
        if drive.duration_s() * config.rate >= 1.0 {
            return Err(SimulationError::LongScan {
                duration_s: config.scan_duration,
                period_s: 1.0 / config.rate,
            });
        }
        drive.check_sensors()?;
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

    /// How long a scan takes, seconds.
    fn duration_s(&self) -> f64 {
        self.time_increment_s * self.bearings().count.saturating_sub(1) as f64
    }

    /// Checks the places of the sensors at the first and last beam of every scan.
    fn check_sensors(&self) -> Result<(), SimulationError> {
        let obstacles = &self.scene.obstacles;
        for scan in 0..self.scans {
            let start_s = scan as f64 / self.rate;
            for time_s in [start_s, start_s + self.duration_s()] {
                let Some(map_from_base) = self.timetable.at(time_s) else {
                    return Ok(());
                };
                for (mount, _) in &self.sensors {
                    let Pose { x, y, .. } = map_from_base.then(mount.base_from_laser);
                    let on_map = obstacles.holds(x, y);
                    if !on_map || obstacles.range(x, y, 0.0, 0.0).is_some() {
                        return Err(SimulationError::SensorBlocked {
                            x,
                            y,
                            time_s,
                            on_map,
                        });
                    }
                }
            }
        }
        Ok(())
    }

    fn snapshot(&mut self, start_s: f64, map_from_base: Pose) -> Snapshot {
        if self.before.is_some() {
            // The world continues by the time between two scans.
            let people = &mut self.scene.people;
            people.walk(1.0 / self.rate, &self.scene.obstacles);
        }
        let wheels = self.wheels(start_s, map_from_base);
        // A scan is of its middle: there the beams before and after weigh the same.
        let middle = self.timetable.at(start_s + 0.5 * self.duration_s());
        let base_from_laser = self.sensors[0].0.base_from_laser;
        let map_from_laser = middle.unwrap_or(map_from_base).then(base_from_laser);
        let mut scans = self.scan(start_s, map_from_base).into_iter();
        let ranges = scans.next().unwrap_or_default();
        let end_s = start_s + self.duration_s();
        let at_end = self.timetable.at(end_s).filter(|_| end_s > start_s);
        Snapshot {
            time_ns: wheels.time_ns,
            map_from_base,
            map_from_laser,
            odom_from_base: wheels.odom_from_base,
            twist: wheels.twist,
            ranges,
            others: scans.collect(),
            after: at_end.map(|map_from_base| self.wheels(end_s, map_from_base)),
        }
    }

    /// The readings of each sensor. People stand still meanwhile.
    fn scan(&mut self, start_s: f64, map_from_base: Pose) -> Vec<Vec<f32>> {
        let (scene, timetable, increment_s) = (&self.scene, &self.timetable, self.time_increment_s);
        let at_beam = |beam: usize| {
            let time_s = start_s + beam as f64 * increment_s;
            timetable.at(time_s).unwrap_or(map_from_base)
        };
        let sensor = &mut self.sensor;
        let each = self
            .sensors
            .iter_mut()
            .map(|(mount, receiver)| match sensor {
                Sensor::Laser(bearings) => laser::scan(scene, at_beam, *mount, *bearings, receiver),
                Sensor::Sonar(ring) => {
                    ring.scan(scene, map_from_base.then(mount.base_from_laser), receiver)
                }
            });
        each.collect()
    }

    /// Reads the wheels.
    fn wheels(&mut self, time_s: f64, map_from_base: Pose) -> Wheels {
        let twist = match self.before.replace((time_s, map_from_base)) {
            Some((before_s, before)) => {
                let moved = self.odometer.advance(before, map_from_base);
                let per_s = match self.time_increment_s {
                    0.0 => self.rate,
                    _ => 1.0 / (time_s - before_s),
                };
                Pose::new(moved.x * per_s, moved.y * per_s, moved.yaw * per_s)
            }
            None => Pose::IDENTITY,
        };
        Wheels {
            time_ns: (time_s * 1e9).round() as i64,
            odom_from_base: self.odometer.odom_from_base(),
            twist,
        }
    }
}

fn check_names(mounts: &[NamedMount]) -> Result<(), SimulationError> {
    for (index, laser) in mounts.iter().enumerate() {
        if mounts[..index].iter().any(|other| other.name == laser.name) {
            return Err(SimulationError::SameLaser {
                name: laser.name.clone(),
            });
        }
    }
    Ok(())
}

impl Iterator for Drive {
    type Item = Snapshot;

    fn next(&mut self) -> Option<Snapshot> {
        if self.taken == self.scans {
            return None;
        }
        let start_s = self.taken as f64 / self.rate;
        let map_from_base = self.timetable.at(start_s)?;
        let snapshot = self.snapshot(start_s, map_from_base);
        self.taken += 1;
        Some(snapshot)
    }
}

/// Scans of a drive: one at the start, and then as long as it continues.
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
    fn each_laser_reads_from_its_own_place() {
        let options = "--noise 0 --field-of-view 180 --beams 3";
        let lasers = "--laser a=0.5,0,0 --laser b=-0.3,0,180 --laser c=0,0,0,180";
        let first = &drive(&format!("{options} {lasers}"))[0];
        assert_eq!(first.map_from_laser.x, 1.5);
        // From 1.5, 0.7 and 1 along x and 1 along y: walls of 0.1 m at 0 and 10
        // along x, at 0 and 8 along y. To the right of one that looks ahead is a
        // wall at 0.9 m, to its left one at 6.9 m; upside down it is the other way.
        let scans = [&first.ranges, &first.others[0], &first.others[1]];
        let expected = [[0.9, 8.4, 6.9], [6.9, 0.6, 0.9], [6.9, 8.9, 0.9]];
        for (scan, expected) in scans.into_iter().zip(expected) {
            for (reading, expected) in scan.iter().zip(expected) {
                // Millimetres.
                assert!((reading - expected).abs() < 0.0006, "{scan:?}");
            }
        }
    }

    #[test]
    fn more_lasers_change_nothing_of_the_first() {
        let options = "--people 3 --outliers 0.1";
        let alone = drive(&format!("{options} --mount 0.5,0,0"));
        let lasers = "--laser a=0.5,0,0 --laser b=-0.3,0,180";
        let joined = drive(&format!("{options} {lasers}"));
        assert_eq!(alone.len(), joined.len());
        for (alone, joined) in alone.into_iter().zip(joined) {
            assert_eq!(joined.others.len(), 1);
            let joined = Snapshot {
                others: Vec::new(),
                ..joined
            };
            assert_eq!(alone, joined);
        }
    }

    #[test]
    fn the_robot_drives_on_while_a_scan_is_measured() {
        let options = "--noise 0 --odometry-noise-per-metre 0 --field-of-view 1 --beams 3";
        let moving = drive(&format!("{options} --scan-duration 0.1 --rate 5"));
        let first = &moving[0];
        // At 0.5 m/s it comes 5 cm nearer to the wall at 9.9 m within 0.1 s; the outer
        // beams are half a degree askew, which is less than a millimetre.
        for (reading, expected) in first.ranges.iter().zip([8.9, 8.875, 8.85]) {
            assert!((reading - expected).abs() < 0.0011, "{:?}", first.ranges);
        }
        let after = first.after.unwrap();
        // In 32 bits, 0.1 s is right to some nanoseconds.
        assert!((after.time_ns - 100_000_000).abs() < 10, "{after:?}");
        let expected = Pose::new(0.05, 0.0, 0.0);
        assert!(
            after.odom_from_base.is_within(expected, 1e-7, 1e-9),
            "{after:?}"
        );
        assert!((after.twist.x - 0.5).abs() < 1e-9, "{after:?}");
        assert!(drive(options).iter().all(|instant| instant.after.is_none()));
    }

    #[test]
    fn lasers_and_scans_that_cannot_be_are_refused() {
        let path = PATH.parse().unwrap();
        let refused = |options: &str| {
            let refused = Drive::new(&room(), &path, &config(options));
            refused.unwrap_err().to_string()
        };
        assert_eq!(
            refused("--laser a=0,0,0 --laser b=0,0,0 --laser a=1,0,0"),
            "two lasers are called a; allowed are lasers with names of their own"
        );
        let error = refused("--scan-duration 0.2 --rate 5");
        assert!(
            error.starts_with("a scan takes 0.2 s and the next begins after 0.2 s"),
            "{error}"
        );
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
