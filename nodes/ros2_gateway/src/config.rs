//! What a user can set.

use clap::{Parser, ValueEnum};
use geometry::Pose;
use messages::FrameName;

use crate::GatewayError;

/// Joins a graph to a ROS 2 robot that speaks rmw_zenoh (jazzy and later), with no ROS
/// installed.
///
/// Is the robot's Zenoh router unless told to connect to one. The robot's scan,
/// odometry and map enter the graph; when the verdict is Unique, the robot's particle
/// filter gets its initial pose.
#[derive(Debug, Clone, Parser)]
#[command(name = "ros2_gateway", version)]
pub struct Config {
    /// The robot's domain, 0 to 232 [default: ROS_DOMAIN_ID, else 0]
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u32).range(..=MAX_DOMAIN))]
    pub domain: Option<u32>,

    /// Where the names below are that begin with no slash
    #[arg(long, value_name = "NAMESPACE", default_value = "/")]
    pub namespace: String,

    /// What the gateway is called among the robot's nodes
    #[arg(long, value_name = "NAME", default_value = "backcast")]
    pub node: String,

    /// Which of the robot's topics enter the graph
    #[arg(long, value_name = "TOPIC,…", value_delimiter = ',', default_values = ["scan", "odometry", "map"])]
    pub bring: Vec<Brought>,

    /// When the particle filter is told where the robot is
    #[arg(long, value_name = "WHEN", default_value = "lost")]
    pub seed: Seed,

    /// How far the particle filter's pose may be from all hypotheses before it is
    /// taken for lost: metres and degrees
    #[arg(long, value_name = "M,DEG", default_value = "1,30", value_parser = reach)]
    pub lost_beyond: Reach,

    /// Standard deviation that an initial pose has at least, for the particles that are
    /// drawn of it: metres and degrees
    #[arg(long, value_name = "M,DEG", default_value = "0.1,3", value_parser = reach)]
    pub spread: Reach,

    /// Where the laser sits on the robot, metres and degrees, if the robot's /tf_static
    /// does not say it
    #[arg(long, value_name = "X,Y,YAW_DEG", value_parser = mount, allow_hyphen_values = true)]
    pub mount: Option<Pose>,

    /// The laser of --mount hangs upside down: rolled by half a turn about its x axis.
    #[arg(long, requires = "mount")]
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

    /// How far ahead of its scan that transform is dated, seconds, 0 to 10
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = ahead)]
    pub tf_ahead: f64,

    /// What the robot's topics and services are called.
    #[command(flatten)]
    pub names: Names,

    /// How it joins the network.
    #[command(flatten)]
    pub network: network::Options,
}

/// Names of topics and services.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Names")]
pub struct Names {
    /// sensor_msgs/LaserScan, in
    #[arg(long, value_name = "NAME", default_value = "scan")]
    pub scan: String,
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
    /// geometry_msgs/PoseWithCovarianceStamped: where the particle filter thinks it is, in
    #[arg(long, value_name = "NAME", default_value = "amcl_pose")]
    pub amcl_pose: String,
    /// geometry_msgs/PoseWithCovarianceStamped: where it is told to be, out
    #[arg(long, value_name = "NAME", default_value = "initialpose")]
    pub initial_pose: String,
    /// geometry_msgs/PoseArray, out
    #[arg(long, value_name = "NAME", default_value = "hypotheses")]
    pub hypotheses: String,
    /// diagnostic_msgs/DiagnosticArray, out
    #[arg(long, value_name = "NAME", default_value = "/diagnostics")]
    pub diagnostics: String,
    /// std_srvs/Empty: seeds again as soon as the verdict is Unique
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

/// When the particle filter is told where the robot is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Seed {
    /// Once it is there, and when the service is called
    Once,
    /// Also whenever its pose leaves the hypotheses
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

    /// Whether a topic of the robot enters the graph.
    #[must_use]
    pub fn brings(&self, topic: Brought) -> bool {
        self.bring.contains(&topic)
    }
}

/// So many finite numbers, as `1,2,3`.
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

fn mount(text: &str) -> Result<Pose, String> {
    match numbers(text) {
        Some([x, y, yaw_deg]) => Ok(Pose::new(x, y, yaw_deg.to_radians())),
        None => Err("expected are three finite numbers: X,Y,YAW_DEG".into()),
    }
}

fn frame(text: &str) -> Result<String, String> {
    if (1..=FrameName::CAPACITY).contains(&text.len()) {
        return Ok(text.to_owned());
    }
    let (found, most) = (text.len(), FrameName::CAPACITY);
    Err(format!("it has {found} bytes, allowed are 1 to {most}"))
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
        let config = parse(&["--mount", "-0.5,0,180"]).unwrap();
        assert_eq!(
            config.mount,
            Some(Pose::new(-0.5, 0.0, std::f64::consts::PI))
        );
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
        refuse(&["--map-frame", ""], "1 to 256");
        refuse(&["--tf-ahead", "11"], "0 to 10");
    }
}
