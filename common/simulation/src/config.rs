//! Settings of a simulated drive.

use command_line::{number, within};
use geometry::{Mount, MountError, Pose};

use crate::{LaserConfig, Noise, OdometryConfig, SonarConfig};

/// Motion, sensors and errors of the robot.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct DriveConfig {
    /// Speed along the path, metres per second, 0.01..=10.
    #[arg(long, value_name = "M_PER_S", default_value_t = 0.5, value_parser = number(0.01..=10.0, "metres a second"))]
    pub speed: f64,
    /// Turn rate on the spot at corners, degrees per second, 1..=360.
    #[arg(long, value_name = "DEG_PER_S", default_value_t = 45.0, value_parser = number(1.0..=360.0, "degrees a second"))]
    pub turn_rate: f64,
    /// Scan rate, hertz, 0.01..=1000.
    #[arg(long, value_name = "HZ", default_value_t = 5.0, value_parser = number(0.01..=1000.0, "scans a second"))]
    pub rate: f64,
    /// Mount of the sensor on the robot: metres ahead and left of the base, and degrees
    /// counter-clockwise. A fourth number of 180 is a laser upside down, rolled by half a turn
    /// about its x axis.
    #[arg(
        long,
        value_name = "X,Y,YAW_DEG[,180]",
        default_value = "0,0,0",
        value_parser = parse_mount,
        allow_hyphen_values = true
    )]
    pub mount: Mount,
    /// A laser with its name and mount, such as front=0.4,0,0; repeat it for several lasers, the
    /// main one first.
    #[arg(
        long = "laser",
        value_name = "NAME=X,Y,YAW_DEG[,180]",
        value_parser = parse_laser,
        conflicts_with_all = ["mount", "sonar"]
    )]
    pub lasers: Vec<NamedMount>,
    /// Rings of a lidar in place of the laser, 2..=128, from 15 degrees below level to 15 above,
    /// 0.4 m over the floor: it sees the map's obstacles as walls, and the floor. Its points are
    /// recorded on /points, and on /scan the ring in the middle as a level laser.
    #[arg(
        long,
        value_name = "COUNT",
        value_parser = clap::value_parser!(u32).range(2..=128),
        conflicts_with_all = ["lasers", "sonar"]
    )]
    pub rings: Option<u32>,
    /// Time from the first beam of a scan to the last, seconds, 0..=1; the robot keeps moving. 0
    /// measures all beams at once.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = number(0.0..=1.0, "seconds"), conflicts_with = "sonar")]
    pub scan_duration: f64,
    /// Standard deviation of a reading: metres, and optionally an increase per metre of range.
    #[arg(long, value_name = "METRES[,SHARE]", default_value = "0.01,0.002")]
    pub noise: Noise,
    /// Share of random readings, uniform from 0 to the maximum range, 0..=1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = number(0.0..=1.0, "as a share"))]
    pub outliers: f64,
    /// People who walk near the path, discs of 0.2 m radius, 0..=1000.
    #[arg(long, value_name = "COUNT", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub people: u32,
    /// Maximum range, metres, 0.1..=1000 [default: 30, or 5 with --sonar].
    #[arg(long, value_name = "METRES", value_parser = number(0.1..=1000.0, "metres"))]
    pub range_max: Option<f64>,
    /// Seed of all random numbers.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    pub odometry: OdometryConfig,
    #[command(flatten)]
    pub laser: LaserConfig,
    #[command(flatten)]
    pub sonar: SonarConfig,
}

impl DriveConfig {
    /// Maximum range, in metres.
    pub fn range_max_m(&self) -> f64 {
        self.range_max
            .unwrap_or(if self.sonar.sonar { 5.0 } else { 30.0 })
    }

    /// Sensors on the robot, the main one first; a single sensor has no name.
    pub fn mounts(&self) -> Vec<NamedMount> {
        match &self.lasers[..] {
            [] => vec![NamedMount {
                name: String::new(),
                mount: self.mount,
            }],
            lasers => lasers.to_vec(),
        }
    }

    /// Time between beams of a scan, in seconds, in the 32-bit precision of a `LaserScan`.
    pub fn time_increment_s(&self, beams: usize) -> f32 {
        (self.scan_duration / beams.saturating_sub(1).max(1) as f64) as f32
    }
}

/// A sensor with its mount on the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedMount {
    /// Empty for a single sensor.
    pub name: String,
    pub mount: Mount,
}

/// Maximum length of a laser's name in bytes, the same as in the messages of the graph.
const MAX_NAME: usize = 32;

fn parse_mount(text: &str) -> Result<Mount, String> {
    let mount: Mount = text
        .parse()
        .map_err(|error: MountError| error.to_string())?;
    let Pose { x, y, .. } = mount.base_from_laser;
    for metres in [x, y] {
        within(metres, &(-5.0..=5.0), "metres")?;
    }
    Ok(mount)
}

fn parse_laser(text: &str) -> Result<NamedMount, String> {
    let (name, mount) = text
        .split_once('=')
        .ok_or_else(|| format!("{text:?} is not a laser; needed are NAME=X,Y,YAW_DEG"))?;
    let is_word = name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    let begins = name.bytes().next().is_some_and(|b| b.is_ascii_alphabetic());
    if !is_word || !begins || name.len() > MAX_NAME {
        return Err(format!(
            "{name:?} is not a name of a laser; allowed are 1 to {MAX_NAME} letters, digits and _, \
             a letter first"
        ));
    }
    Ok(NamedMount {
        name: name.to_owned(),
        mount: parse_mount(mount)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mount_is_on_the_robot() {
        let mount = parse_mount("0.78,0,-90,180").unwrap();
        assert!(mount.is_upside_down);
        let refused = |text: &str| parse_mount(text).unwrap_err();
        assert!(refused("1,2").contains("X,Y,YAW_DEG"));
        assert_eq!(refused("9,0,0"), "9 is not within -5 to 5 metres");
    }

    #[test]
    fn a_laser_has_a_name_and_a_mount() {
        let laser = parse_laser("front_2=0.5,0,0").unwrap();
        assert_eq!(laser.name, "front_2");
        assert_eq!(laser.mount.base_from_laser, Pose::new(0.5, 0.0, 0.0));
        let refused = |text: &str| parse_laser(text).unwrap_err();
        assert_eq!(
            refused("0,0,0"),
            "\"0,0,0\" is not a laser; needed are NAME=X,Y,YAW_DEG"
        );
        for name in ["", "a b", "2", "a/b"] {
            let error = refused(&format!("{name}=0,0,0"));
            assert!(error.contains("is not a name of a laser"), "{error}");
        }
        assert!(refused("a=0,0").contains("X,Y,YAW_DEG"));
    }
}
