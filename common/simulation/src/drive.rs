//! A drive: the true pose, the odometry and the readings, scan by scan.

use anyhow::{anyhow, bail};
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
use crate::{Bearings, DriveConfig, NamedMount, Path, laser};

/// Maximum number of scans: a day at 10 Hz.
const MAX_SCANS: u64 = 864_000;

/// One scan with its poses.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Odometry at the first beam.
    pub wheels: Wheels,
    /// True pose of the base at the first beam.
    pub map_from_base: Pose,
    /// True pose of the (first) sensor at the middle of the scan.
    pub map_from_laser: Pose,
    /// Readings of the (first) sensor by bearing, in metres; infinite without a return, NaN without
    /// a transducer.
    pub ranges: Vec<f32>,
    /// Readings of the other lasers, in their order, or of the other rings of a lidar.
    pub others: Vec<Vec<f32>>,
    /// Odometry at the last beam, if a scan takes time.
    pub after: Option<Wheels>,
}

/// A sample of the odometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheels {
    /// Time since the start of the drive, in nanoseconds.
    pub time_ns: i64,
    /// Pose of the base.
    pub odom_from_base: Pose,
    /// Velocity of the base since the previous sample, in the base's frame: m/s, m/s and rad/s;
    /// zero in the first sample.
    pub twist: Pose,
}

#[derive(Debug)]
enum Sensor {
    Laser(Bearings),
    Sonar(Ring),
}

/// Iterator over the scans of a drive.
#[derive(Debug)]
pub struct Drive {
    scene: Scene,
    timetable: Timetable,
    sensor: Sensor,
    /// Each sensor, the main one first.
    sensors: Vec<(Mount, Receiver)>,
    odometer: Odometer,
    /// Time between beams, in seconds.
    time_increment_s: f64,
    rate: f64,
    scans: u64,
    taken: u64,
    /// Time in seconds and true pose of the base at the last odometry sample.
    before: Option<(f64, Pose)>,
}

impl Drive {
    /// Prepares a drive along a path through a map.
    pub fn new(map: &OccupancyGrid, path: &Path, config: &DriveConfig) -> anyhow::Result<Self> {
        let obstacles = Obstacles::of(map);
        path.check(&obstacles)?;
        let timetable = Timetable::new(path, config.speed, config.turn_rate.to_radians());
        let scans = count(&timetable, config.rate)?;
        let mounts = config.mounts();
        check_names(&mounts)?;
        // A generator for each purpose, so that one setting does not change the random numbers of
        // another.
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
        // Each ring of a lidar is a sensor at the same place.
        let rings = config.rings.map_or(1, |rings| rings as usize);
        let mounts = mounts.into_iter().map(|named| named.mount);
        let mounts: Vec<Mount> = match mounts.len() {
            1 => mounts.cycle().take(rings).collect(),
            _ => mounts.collect(),
        };
        let others = mounts.iter().skip(1).map(|_| receiver(rng()));
        let receivers: Vec<Receiver> = std::iter::once(first).chain(others).collect();
        let beams = match &sensor {
            Sensor::Laser(bearings) => bearings.count,
            Sensor::Sonar(_) => Ring::BEARINGS.count,
        };
        let drive = Drive {
            scene: Scene { obstacles, people },
            timetable,
            sensor,
            sensors: mounts.into_iter().zip(receivers).collect(),
            odometer,
            time_increment_s: config.time_increment_s(beams).into(),
            rate: config.rate,
            scans,
            taken: 0,
            before: None,
        };
        if drive.duration_s() * config.rate >= 1.0 {
            bail!(
                "a scan takes {} s and the next begins after {} s; allowed are scans that end before",
                config.scan_duration,
                1.0 / config.rate
            );
        }
        drive.check_sensors()?;
        Ok(drive)
    }

    pub fn bearings(&self) -> Bearings {
        match &self.sensor {
            Sensor::Laser(bearings) => *bearings,
            Sensor::Sonar(_) => Ring::BEARINGS,
        }
    }

    /// Total number of scans.
    pub fn scans(&self) -> u64 {
        self.scans
    }

    /// Duration of a scan, in seconds.
    fn duration_s(&self) -> f64 {
        self.time_increment_s * self.bearings().count.saturating_sub(1) as f64
    }

    /// Checks that the sensors are free at the first and last beam of every scan.
    fn check_sensors(&self) -> anyhow::Result<()> {
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
                        let state = match on_map {
                            true => "into an obstacle",
                            false => "off the map",
                        };
                        bail!(
                            "the sensor comes {state} at {x:.2},{y:.2}, where its mount puts it {time_s:.2} s after the start"
                        );
                    }
                }
            }
        }
        Ok(())
    }

    fn snapshot(&mut self, start_s: f64, map_from_base: Pose) -> Snapshot {
        if self.before.is_some() {
            // People walk for the time between two scans.
            let people = &mut self.scene.people;
            people.walk(1.0 / self.rate, &self.scene.obstacles);
        }
        let wheels = self.wheels(start_s, map_from_base);
        // The pose of a scan is that at its middle, which weights all beams alike.
        let middle = self.timetable.at(start_s + 0.5 * self.duration_s());
        let base_from_laser = self.sensors[0].0.base_from_laser;
        let map_from_laser = middle.unwrap_or(map_from_base).then(base_from_laser);
        let mut scans = self.scan(start_s, map_from_base).into_iter();
        let ranges = scans.next().unwrap_or_default();
        let end_s = start_s + self.duration_s();
        let at_end = self.timetable.at(end_s).filter(|_| end_s > start_s);
        Snapshot {
            wheels,
            map_from_base,
            map_from_laser,
            ranges,
            others: scans.collect(),
            after: at_end.map(|map_from_base| self.wheels(end_s, map_from_base)),
        }
    }

    /// Takes the readings of each sensor. People stand still meanwhile.
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

fn check_names(mounts: &[NamedMount]) -> anyhow::Result<()> {
    for (index, NamedMount { name, .. }) in mounts.iter().enumerate() {
        if mounts[..index].iter().any(|other| other.name == *name) {
            bail!("two lasers are called {name}; allowed are lasers with names of their own");
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

/// Number of scans of a drive: one at the start, and then as long as it lasts.
fn count(timetable: &Timetable, rate: f64) -> anyhow::Result<u64> {
    let seconds = timetable.seconds();
    // A drive that ends with a scan includes it, up to rounding.
    let scans = (seconds * rate + 1e-9) as u64 + 1;
    match scans <= MAX_SCANS {
        true => Ok(scans),
        false => Err(anyhow!(
            "the drive takes {seconds:.0} s, which is {scans} scans; at most {MAX_SCANS} are simulated"
        )),
    }
}

#[cfg(test)]
mod tests;
