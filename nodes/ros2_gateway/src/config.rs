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
    /// Middleware of the robot [default: from RMW_IMPLEMENTATION, else zenoh]
    #[arg(long, value_name = "MIDDLEWARE")]
    pub rmw: Option<Rmw>,

    /// Searches for this many seconds (0.1 to 60) on each middleware, or on that of --rmw, and
    /// prints the scan, map, odometry and transform topics that it finds, one JSON object per line
    #[arg(long, value_name = "SECONDS", value_parser = seconds(0.1, 60.0))]
    pub look: Option<f64>,

    /// Domain ID of the robot, 0 to 232 [default: ROS_DOMAIN_ID, else 0]
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u32).range(..=MAX_DOMAIN))]
    pub domain: Option<u32>,

    /// Namespace of the names below that do not begin with a slash
    #[arg(long, value_name = "NAMESPACE", default_value = "/")]
    pub namespace: String,

    /// Name of the gateway among the robot's nodes [default: backcast, or amcl with --as amcl]
    #[arg(long, value_name = "NAME")]
    pub node: Option<String>,

    /// Log level: debug, info, warn, error or fatal; of LOGGER:=LEVEL, only the level counts
    /// [default: from RUST_LOG, else info]
    #[arg(long, value_name = "LEVEL", value_parser = level)]
    pub log_level: Option<String>,

    #[command(flatten)]
    pub amcl: Options,

    /// Topics of the robot that enter the graph
    #[arg(long, value_name = "TOPIC,…", value_delimiter = ',', default_values = ["scan", "odometry", "map"])]
    pub bring: Vec<Brought>,

    /// When the particle filter gets an initial pose
    #[arg(long, value_name = "WHEN", default_value = "lost")]
    pub seed: Seed,

    /// Largest distance between the particle filter's pose and the nearest hypothesis before the
    /// filter counts as lost: metres and degrees
    #[arg(long, value_name = "M,DEG", default_value = "1,30", value_parser = reach)]
    pub lost_beyond: Reach,

    /// Minimum standard deviations of an initial pose, from which the filter draws its particles:
    /// metres and degrees
    #[arg(long, value_name = "M,DEG", default_value = "0.1,3", value_parser = reach)]
    pub spread: Reach,

    /// Pose of the laser on the robot, metres and degrees, for robots whose /tf_static does not
    /// have it; a fourth number of 180 is a laser that hangs upside down, rolled by half a turn
    /// about its x axis. For several lasers, repeat it for each, in the order of their --scan
    #[arg(
        long = "mount",
        value_name = "X,Y,YAW_DEG[,180]",
        conflicts_with = "cloud_topic",
        allow_hyphen_values = true
    )]
    pub mounts: Vec<Mount>,

    /// The laser of --mount, which must be the only one, hangs upside down
    #[arg(long, requires = "mounts")]
    pub upside_down: bool,

    /// Frame of the map [default: the frame of the robot's map, else map]
    #[arg(long, value_name = "FRAME", value_parser = frame)]
    pub map_frame: Option<String>,

    /// Odometry frame, whose transforms in /tf are used if no odometry topic is published
    /// [default: odom]
    #[arg(long, value_name = "FRAME", value_parser = frame)]
    pub odom_frame: Option<String>,

    /// Publishes the transform from map to odometry. Not for use along with a particle filter,
    /// which publishes it itself
    #[arg(long)]
    pub broadcast_tf: bool,

    /// Seconds by which that transform is stamped ahead of its scan, 0 to 10
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = seconds(0.0, 10.0))]
    pub tf_ahead: f64,

    /// Rules for reading the cells of the robot's map, shared by all nodes.
    #[command(flatten)]
    pub cells: messages::CellRules,

    #[command(flatten)]
    pub memory: map::MemoryOptions,

    #[command(flatten)]
    pub cloud: ros::CloudOptions,

    #[command(flatten)]
    pub names: Names,

    #[command(flatten)]
    pub network: zenoh_session::Options,
}

/// Names of the robot's topics and services.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Names")]
pub struct Names {
    /// sensor_msgs/LaserScan, in; for several lasers, repeat it for each. Hypotheses refer to the
    /// first one. The graph names lasers after their topics: front for front/scan, scan_front and
    /// front_scan [default: scan]
    #[arg(long = "scan", value_name = "NAME", conflicts_with = "cloud_topic")]
    pub scans: Vec<String>,
    /// nav_msgs/Odometry, in
    #[arg(long, value_name = "NAME", default_value = "odom")]
    pub odom: String,
    /// nav_msgs/OccupancyGrid, transient local, in [default: map]
    #[arg(long, value_name = "NAME")]
    pub map: Option<String>,
    /// tf2_msgs/TFMessage, in and out
    #[arg(long, value_name = "NAME", default_value = "tf")]
    pub tf: String,
    /// tf2_msgs/TFMessage, transient local, in
    #[arg(long, value_name = "NAME", default_value = "tf_static")]
    pub tf_static: String,
    /// geometry_msgs/PoseWithCovarianceStamped: the particle filter's pose, in; with --as amcl the
    /// gateway's own pose, out
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
    /// std_srvs/Empty: seeds again as soon as the verdict is Unique; with --as amcl it localizes
    /// from anywhere on the map
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
    /// Scans of the lasers
    Scan,
    /// Wheel odometry
    Odometry,
    /// The map
    Map,
}

/// When the particle filter gets an initial pose
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Seed {
    /// Once when the filter starts, and when the service is called
    Once,
    /// Also whenever the filter's pose is far from all hypotheses
    Lost,
    /// Only when the service is called
    Never,
}

/// A distance and an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    pub metres: f64,
    pub radians: f64,
}

/// The node's name in the graph.
pub const NODE: &str = "ros2_gateway";

/// Default frame of the map, if neither the user nor the robot names one.
pub(crate) const MAP_FRAME: &str = "map";

/// Highest domain ID of ROS 2.
const MAX_DOMAIN: i64 = 232;

impl Config {
    /// Returns the robot's domain ID: the option, else ROS_DOMAIN_ID, else 0.
    pub fn domain(&self) -> Result<u32, GatewayError> {
        let text = std::env::var_os("ROS_DOMAIN_ID").unwrap_or_default();
        if self.domain.is_some() || text.is_empty() {
            return Ok(self.domain.unwrap_or(0));
        }
        let text = text.to_string_lossy();
        let domain = text.parse().ok().filter(|id| i64::from(*id) <= MAX_DOMAIN);
        domain.ok_or_else(|| GatewayError::Option {
            option: "domain",
            reason: format!("ROS_DOMAIN_ID is {text:?}: allowed are 0 to {MAX_DOMAIN}"),
        })
    }

    /// Returns the namespace of relative names, with no slash behind it unless it is the root.
    pub(crate) fn namespace(&self) -> &str {
        match self.namespace.trim_end_matches('/') {
            "" => "/",
            namespace => namespace,
        }
    }

    /// Returns the gateway's name among the robot's nodes.
    pub fn node(&self) -> &str {
        match (&self.node, self.amcl.role) {
            (Some(node), _) => node,
            (None, Role::Seed) => "backcast",
            (None, Role::Amcl) => "amcl",
        }
    }

    /// Returns the names of the scans' topics, one for each laser, or that of the point clouds.
    pub fn scans(&self) -> Vec<String> {
        match (&self.cloud.cloud_topic, &*self.names.scans) {
            (Some(cloud), _) => vec![cloud.clone()],
            (None, []) => vec!["scan".to_owned()],
            (None, names) => names.to_vec(),
        }
    }

    pub fn map(&self) -> &str {
        self.names.map.as_deref().unwrap_or("map")
    }

    pub fn odom_frame(&self) -> &str {
        self.odom_frame.as_deref().unwrap_or("odom")
    }

    /// Returns the mounts that the user gave, in the order of the scans; empty if there are none.
    pub fn mounts(&self) -> Result<Vec<Mount>, GatewayError> {
        let (mounts, lasers) = (self.mounts.len(), self.scans().len());
        let refuse = |option, reason| Err(GatewayError::Option { option, reason });
        if mounts != 0 && mounts != lasers {
            let reason = format!("{mounts} mounts for {lasers} lasers: allowed is one for each");
            return refuse("mount", reason);
        }
        if self.upside_down && lasers > 1 {
            let reason = "which of the lasers is not clear: allowed is --mount X,Y,YAW_DEG,180";
            return refuse("upside-down", reason.to_owned());
        }
        if let Some(mount) = &self.cloud.cloud_mount {
            return Ok(vec![mount.planar()]);
        }
        let turned = |mount: &Mount| Mount {
            is_upside_down: mount.is_upside_down || self.upside_down,
            ..*mount
        };
        Ok(self.mounts.iter().map(turned).collect())
    }

    /// True if the topic enters the graph.
    pub fn brings(&self, topic: Brought) -> bool {
        self.bring.contains(&topic)
    }
}

/// Parses a log level of ROS; `fatal` becomes `error`.
fn level(text: &str) -> Result<String, String> {
    let level = text.rsplit(":=").next().unwrap_or(text).to_lowercase();
    match &*level {
        "fatal" => Ok("error".to_owned()),
        "debug" | "info" | "warn" | "error" => Ok(level),
        _ => Err("allowed are debug, info, warn, error and fatal".to_owned()),
    }
}

/// Parses `N` finite numbers, such as `1,2,3`.
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
    let (found, most) = (text.len(), FrameName::CAPACITY);
    match (1..=most).contains(&found) {
        true => Ok(text.to_owned()),
        false => Err(format!("it has {found} bytes, allowed are 1 to {most}")),
    }
}

/// Returns a parser of seconds in this range.
fn seconds(least: f64, most: f64) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| match numbers(text) {
        Some([seconds]) if (least..=most).contains(&seconds) => Ok(seconds),
        _ => Err(format!("expected are {least} to {most} seconds")),
    }
}

#[cfg(test)]
mod tests {
    use geometry::Pose;

    use super::*;

    fn parse(arguments: &[&str]) -> Result<Config, String> {
        let all = ["ros2_gateway"].iter().chain(arguments);
        Config::try_parse_from(all).map_err(|error| error.to_string())
    }

    #[test]
    fn everything_has_a_default() {
        let config = parse(&[]).unwrap();
        assert!(config.brings(Brought::Map) && config.brings(Brought::Scan));
        assert_eq!(config.lost_beyond.metres, 1.0);
        // 30 degrees; the conversion rounds once.
        assert!((config.lost_beyond.radians - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
        assert_eq!(config.seed, Seed::Lost);
        assert_eq!(parse(&["--domain", "7"]).unwrap().domain().unwrap(), 7);
        let config = parse(&["--bring", "scan,odometry"]).unwrap();
        assert!(!config.brings(Brought::Map) && config.brings(Brought::Odometry));
        assert_eq!(config.scans(), ["scan"]);
        assert_eq!((config.map(), config.odom_frame()), ("map", "odom"));
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
        refuse(&["--lost-beyond", "1"], "M,DEG");
        refuse(&["--spread", "NaN,1"], "M,DEG");
        refuse(&["--mount", "1,2"], "X,Y,YAW_DEG");
        refuse(&["--mount", "1,2,3,90"], "180 as the fourth");
        refuse(&["--map-frame", ""], "1 to 256");
        refuse(&["--tf-ahead", "11"], "0 to 10");
    }
}
