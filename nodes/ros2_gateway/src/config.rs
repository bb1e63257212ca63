//! Command-line options.

use clap::{Parser, ValueEnum};
use geometry::Mount;
use messages::FrameName;

use crate::GatewayError;
use crate::middleware::Rmw;
use crate::role::{Options, Role};

/// Connects a graph to a ROS 2 robot that uses Fast DDS, Cyclone DDS or rmw_zenoh (jazzy and
/// later), without ROS installed.
///
/// With rmw_zenoh it is the robot's Zenoh router by default, unless it connects to another. The
/// robot's scan, odometry and map enter the graph; when the verdict is Unique, the
/// robot's particle filter gets its initial pose.
#[derive(Debug, Clone, Parser)]
#[command(name = "ros2_gateway", version)]
pub struct Config {
    /// The robot's middleware [default: as RMW_IMPLEMENTATION says, else zenoh]
    #[arg(long, value_name = "MIDDLEWARE")]
    pub rmw: Option<Rmw>,

    /// Prints the scans, maps, odometry and transforms that nodes publish, found within so many
    /// seconds on each middleware or on that of --rmw: objects of JSON, a line each; 0.1 to 60
    #[arg(long, value_name = "SECONDS", value_parser = looking)]
    pub look: Option<f64>,

    /// The robot's domain, 0 to 232 [default: ROS_DOMAIN_ID, else 0]
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u32).range(..=MAX_DOMAIN))]
    pub domain: Option<u32>,

    /// Namespace of the names below that begin with no slash
    #[arg(long, value_name = "NAMESPACE", default_value = "/")]
    pub namespace: String,

    /// The gateway's name among the robot's nodes [default: backcast, with --as amcl amcl]
    #[arg(long, value_name = "NAME")]
    pub node: Option<String>,

    /// What is logged: debug, info, warn, error or fatal, or LOGGER:=LEVEL, of which the level
    /// counts [default: as RUST_LOG says, else info]
    #[arg(long, value_name = "LEVEL", value_parser = level)]
    pub log_level: Option<String>,

    /// In AMCL's place.
    #[command(flatten)]
    pub amcl: Options,

    /// Which of the robot's topics enter the graph
    #[arg(long, value_name = "TOPIC,…", value_delimiter = ',', default_values = ["scan", "odometry", "map"])]
    pub bring: Vec<Brought>,

    /// When the particle filter gets an initial pose
    #[arg(long, value_name = "WHEN", default_value = "lost")]
    pub seed: Seed,

    /// How far the particle filter's pose may be from all hypotheses before it counts
    /// as lost: metres and degrees
    #[arg(long, value_name = "M,DEG", default_value = "1,30", value_parser = reach)]
    pub lost_beyond: Reach,

    /// Minimum standard deviation of an initial pose, for the particles that are drawn
    /// from it: metres and degrees
    #[arg(long, value_name = "M,DEG", default_value = "0.1,3", value_parser = reach)]
    pub spread: Reach,

    /// Where the laser sits on the robot, metres and degrees, if the robot's /tf_static
    /// does not say it; a fourth number of 180 is a laser that hangs upside down, rolled
    /// by half a turn about its x axis. For several lasers once each, in the order of
    /// their --scan
    #[arg(
        long = "mount",
        value_name = "X,Y,YAW_DEG[,180]",
        allow_hyphen_values = true
    )]
    pub mounts: Vec<Mount>,

    /// The only laser, that of --mount, hangs upside down
    #[arg(long, requires = "mounts")]
    pub upside_down: bool,

    /// The map's frame [default: that of the robot's map, else map]
    #[arg(long, value_name = "FRAME", value_parser = frame)]
    pub map_frame: Option<String>,

    /// The odometry's frame, by which it is found in /tf where nobody publishes odometry
    #[arg(long, value_name = "FRAME", default_value = "odom", value_parser = frame)]
    pub odom_frame: String,

    /// Publishes the transform from the map to the odometry. Not beside a particle filter,
    /// which does so itself
    #[arg(long)]
    pub broadcast_tf: bool,

    /// How far that transform is stamped ahead of its scan, seconds, 0 to 10
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = ahead)]
    pub tf_ahead: f64,

    /// How cells of the robot's map are read, by all nodes.
    #[command(flatten)]
    pub cells: messages::CellRules,

    /// What the graph may use.
    #[command(flatten)]
    pub memory: map::MemoryOptions,

    /// Names of the robot's topics and services.
    #[command(flatten)]
    pub names: Names,

    /// How it joins the network.
    #[command(flatten)]
    pub network: zenoh_session::Options,
}

/// Names of topics and services.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Names")]
pub struct Names {
    /// sensor_msgs/LaserScan, in; of several lasers once each, the first one first: the
    /// graph calls them by their topics, front for front/scan, scan_front and front_scan
    #[arg(long = "scan", value_name = "NAME", default_value = "scan")]
    pub scans: Vec<String>,
    /// nav_msgs/Odometry, in
    #[arg(long, value_name = "NAME", default_value = "odom")]
    pub odom: String,
    /// nav_msgs/OccupancyGrid, transient local, in
    #[arg(long, value_name = "NAME", default_value = "map")]
    pub map: String,
    /// tf2_msgs/TFMessage, in and out
    #[arg(long, value_name = "NAME", default_value = "tf")]
    pub tf: String,
    /// tf2_msgs/TFMessage, transient local, in
    #[arg(long, value_name = "NAME", default_value = "tf_static")]
    pub tf_static: String,
    /// geometry_msgs/PoseWithCovarianceStamped: the particle filter's pose, in; with
    /// --as amcl ours, out
    #[arg(long, value_name = "NAME", default_value = "amcl_pose")]
    pub amcl_pose: String,
    /// geometry_msgs/PoseWithCovarianceStamped: the initial pose, out; with --as amcl in
    #[arg(long, value_name = "NAME", default_value = "initialpose")]
    pub initial_pose: String,
    /// geometry_msgs/PoseArray, out
    #[arg(long, value_name = "NAME", default_value = "hypotheses")]
    pub hypotheses: String,
    /// backcast_msgs/Localization, transient local, out: the tracker's verdict
    #[arg(long, value_name = "NAME", default_value = "localization")]
    pub localization: String,
    /// diagnostic_msgs/DiagnosticArray, out
    #[arg(long, value_name = "NAME", default_value = "/diagnostics")]
    pub diagnostics: String,
    /// std_srvs/Empty: seeds again as soon as the verdict is Unique; with --as amcl the
    /// request to localize from anywhere
    #[arg(
        long,
        value_name = "NAME",
        default_value = "reinitialize_global_localization"
    )]
    pub reinitialize: String,
}

/// A topic of the robot that can enter the graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Brought {
    /// The laser's scans.
    Scan,
    /// What the wheels report.
    Odometry,
    /// The map.
    Map,
}

/// When the particle filter gets an initial pose
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Seed {
    /// Once when it starts, and when the service is called
    Once,
    /// Also whenever its pose is far from all hypotheses
    Lost,
    /// When the service is called
    Never,
}

/// A distance and an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Metres.
    pub metres: f64,
    /// Radians.
    pub radians: f64,
}

/// The node's name in the graph.
pub const NODE: &str = "ros2_gateway";

/// The map's frame where neither the user nor the robot names it.
pub(crate) const MAP_FRAME: &str = "map";

/// The highest domain of ROS 2.
const MAX_DOMAIN: i64 = 232;

impl Config {
    /// The robot's domain.
    ///
    /// # Errors
    /// If ROS_DOMAIN_ID counts and is none.
    pub fn domain(&self) -> Result<u32, GatewayError> {
        match (self.domain, std::env::var_os("ROS_DOMAIN_ID")) {
            (Some(domain), _) => Ok(domain),
            (None, None) => Ok(0),
            (None, Some(text)) if text.is_empty() => Ok(0),
            (None, Some(text)) => {
                let text = text.to_string_lossy();
                let domain = text.parse().ok().filter(|id| i64::from(*id) <= MAX_DOMAIN);
                domain.ok_or_else(|| GatewayError::Option {
                    option: "domain",
                    reason: format!("ROS_DOMAIN_ID is {text:?}: allowed are 0 to {MAX_DOMAIN}"),
                })
            }
        }
    }

    /// The gateway's name among the robot's nodes.
    #[must_use]
    pub fn node(&self) -> &str {
        match (&self.node, self.amcl.role) {
            (Some(node), _) => node,
            (None, Role::Seed) => "backcast",
            (None, Role::Amcl) => "amcl",
        }
    }

    /// Where the lasers sit, in the order of their scans, if the user says so.
    ///
    /// # Errors
    /// If it is not clear which mount is of which laser.
    pub fn mounts(&self) -> Result<Vec<Mount>, GatewayError> {
        let (mounts, lasers) = (self.mounts.len(), self.names.scans.len());
        let refuse = |option, reason| Err(GatewayError::Option { option, reason });
        if mounts != 0 && mounts != lasers {
            let reason = format!("{mounts} mounts for {lasers} lasers: allowed is one for each");
            return refuse("mount", reason);
        }
        if self.upside_down && lasers > 1 {
            let reason = "which of the lasers is not clear: allowed is --mount X,Y,YAW_DEG,180";
            return refuse("upside-down", reason.to_owned());
        }
        let turned = |mount: &Mount| Mount {
            is_upside_down: mount.is_upside_down || self.upside_down,
            ..*mount
        };
        Ok(self.mounts.iter().map(turned).collect())
    }

    /// Whether a topic of the robot enters the graph.
    #[must_use]
    pub fn brings(&self, topic: Brought) -> bool {
        self.bring.contains(&topic)
    }
}

/// A level of ROS, as the log knows it.
fn level(text: &str) -> Result<String, String> {
    let level = text.rsplit(":=").next().unwrap_or(text).to_lowercase();
    match &*level {
        "fatal" => Ok("error".to_owned()),
        "debug" | "info" | "warn" | "error" => Ok(level),
        _ => Err("allowed are debug, info, warn, error and fatal".to_owned()),
    }
}

/// This many finite numbers, as `1,2,3`.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|number| number.trim().parse().ok().filter(|n: &f64| n.is_finite()))
        .collect();
    numbers?.try_into().ok()
}

fn reach(text: &str) -> Result<Reach, String> {
    match numbers(text) {
        Some([metres, degrees]) if metres >= 0.0 && (0.0..=180.0).contains(&degrees) => Ok(Reach {
            metres,
            radians: degrees.to_radians(),
        }),
        _ => Err("expected are metres from 0 and degrees from 0 to 180: M,DEG".into()),
    }
}

fn frame(text: &str) -> Result<String, String> {
    if (1..=FrameName::CAPACITY).contains(&text.len()) {
        return Ok(text.to_owned());
    }
    let (found, most) = (text.len(), FrameName::CAPACITY);
    Err(format!("it has {found} bytes, allowed are 1 to {most}"))
}

fn looking(text: &str) -> Result<f64, String> {
    match numbers(text) {
        Some([seconds]) if (0.1..=60.0).contains(&seconds) => Ok(seconds),
        _ => Err("expected are 0.1 to 60 seconds".into()),
    }
}

fn ahead(text: &str) -> Result<f64, String> {
    match numbers(text) {
        Some([seconds]) if (0.0..=10.0).contains(&seconds) => Ok(seconds),
        _ => Err("expected are 0 to 10 seconds".into()),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use geometry::Pose;

    use super::*;

    fn parse(arguments: &[&str]) -> Result<Config, String> {
        let all = ["ros2_gateway"].iter().chain(arguments);
        Config::try_parse_from(all).map_err(|error| error.to_string())
    }

    #[test]
    fn the_command_line_is_well_formed() {
        Config::command().debug_assert();
    }

    #[test]
    fn everything_has_a_default() {
        let config = parse(&[]).unwrap();
        assert!(config.brings(Brought::Map) && config.brings(Brought::Scan));
        assert_eq!(config.lost_beyond.metres, 1.0);
        // 30 degrees, by one multiplication.
        assert!((config.lost_beyond.radians - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
        assert_eq!(config.seed, Seed::Lost);
        assert_eq!(parse(&["--domain", "7"]).unwrap().domain().unwrap(), 7);
        let config = parse(&["--bring", "scan,odometry"]).unwrap();
        assert!(!config.brings(Brought::Map) && config.brings(Brought::Odometry));
        assert_eq!(config.names.scans, ["scan"]);
        assert_eq!(config.mounts().unwrap(), []);
    }

    #[test]
    fn each_laser_has_a_mount_of_its_own() {
        let behind = |is_upside_down| Mount {
            base_from_laser: Pose::new(-0.5, 0.0, std::f64::consts::PI),
            is_upside_down,
        };
        let mounts = |line: &str| {
            let words: Vec<&str> = line.split(' ').collect();
            parse(&words).unwrap().mounts()
        };
        assert_eq!(mounts("--mount -0.5,0,180").unwrap(), [behind(false)]);
        let turned = mounts("--mount -0.5,0,180 --upside-down").unwrap();
        assert_eq!(turned, [behind(true)]);
        let two = "--scan front/scan --scan rear/scan";
        let mounted = format!("{two} --mount 0.5,0,0 --mount -0.5,0,180,180");
        let ahead = Mount {
            base_from_laser: Pose::new(0.5, 0.0, 0.0),
            is_upside_down: false,
        };
        assert_eq!(mounts(&mounted).unwrap(), [ahead, behind(true)]);
        let refused = |line: &str| mounts(line).unwrap_err().to_string();
        assert_eq!(
            refused(&format!("{two} --mount 0.5,0,0")),
            "--mount: 1 mounts for 2 lasers: allowed is one for each"
        );
        let error = refused(&format!("{mounted} --upside-down"));
        assert!(error.starts_with("--upside-down: which"), "{error}");
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let refuse = |arguments: &[&str], expected: &str| {
            let error = parse(arguments).unwrap_err();
            assert!(error.contains(expected), "{error}");
        };
        refuse(&["--domain", "233"], "0..=232");
        refuse(&["--bring", "votes"], "scan, odometry, map");
        refuse(&["--lost-beyond", "1"], "M,DEG");
        refuse(&["--spread", "NaN,1"], "M,DEG");
        refuse(&["--mount", "1,2"], "X,Y,YAW_DEG");
        refuse(&["--mount", "1,2,3,90"], "180 as the fourth");
        refuse(&["--map-frame", ""], "1 to 256");
        refuse(&["--tf-ahead", "11"], "0 to 10");
    }
}
