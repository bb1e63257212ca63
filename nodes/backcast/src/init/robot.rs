//! Lists the topics of a ROS 2 robot with `ros2_gateway --look`, and chooses those for the gateway.

use std::collections::{BTreeMap, BTreeSet};
use std::process::{Command, Stdio};

use anyhow::anyhow;
use ros::lasers;
use serde::Deserialize;
use transport::GRAPH_VARIABLE;

/// Search time on each middleware in seconds: nodes on DDS announce themselves every three seconds.
const LOOK_S: &str = "6";

/// A topic published by a node of the robot, as printed by `ros2_gateway --look`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub(crate) struct Published {
    rmw: String,
    domain: u32,
    kind: String,
    topic: String,
    node: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lasers {
    /// `/scan` or the first one.
    First,
    /// All, if none is `/scan`.
    All,
}

#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Robot {
    pub(crate) options: Vec<String>,
    /// Topics of the scans of several lasers; empty with one laser.
    pub(crate) scans: Vec<String>,
    /// True if its nodes publish scans but no map.
    pub(crate) lacks_map: bool,
    pub(crate) said: Vec<String>,
}

pub(crate) fn look(router: Option<&str>, lasers: Lasers) -> anyhow::Result<Robot> {
    let failed = |reason: String| {
        anyhow!("the robot cannot be looked at: {reason}; --no-probe writes the descriptor without")
    };
    let gateway = launcher::node("ros2_gateway").ok_or_else(|| {
        failed("ros2_gateway is not built; `cargo build --release -p ros2_gateway` does".into())
    })?;
    let mut command = Command::new(gateway);
    command.args(["--look", LOOK_S]);
    if let Some(router) = router {
        command.args(["--rmw", "zenoh", "--connect", router]);
    }
    // Its log is only shown if it fails.
    let output = command
        .env(GRAPH_VARIABLE, format!("look_{}", std::process::id()))
        .stderr(Stdio::piped())
        .output()
        .map_err(|error| failed(error.to_string()))?;
    if !output.status.success() {
        let words = String::from_utf8_lossy(&output.stderr);
        let last = words.lines().last().unwrap_or_default();
        return Err(failed(format!("ros2_gateway ended with an error: {last}")));
    }
    let lines = output.stdout.split(|&byte| byte == b'\n');
    let lines = lines.filter(|line| !line.is_empty());
    let published: Result<Vec<Published>, _> = lines.map(serde_json::from_slice).collect();
    let published = published.map_err(|error| failed(format!("ros2_gateway: {error}")))?;
    Ok(robot_of(&published, lasers))
}

pub(crate) const NO_MAP: &str = "no node publishes a map: --map FILE serves one";

fn robot_of(published: &[Published], lasers: Lasers) -> Robot {
    let mut robot = Robot {
        said: list(published),
        ..Robot::default()
    };
    // With several robots, the first one with scans is used.
    let Some(first) = published.iter().find(|one| one.kind == "scan") else {
        let none = "no node publishes laser scans on DDS or Zenoh: start the robot, and check \
                    ROS_DOMAIN_ID and the router";
        robot.said.push(none.to_owned());
        return robot;
    };
    let (rmw, domain) = (&first.rmw, first.domain);
    let of_kind = |kind: &str| {
        let is_its = |one: &&Published| one.rmw == *rmw && one.domain == domain;
        let all = published.iter().filter(is_its);
        let all = all.filter(|one| one.kind == kind);
        all.map(|one| one.topic.clone())
            .collect::<BTreeSet<String>>()
    };
    robot.options.extend(["--rmw".to_owned(), rmw.clone()]);
    if domain != 0 {
        let domain = ["--domain".to_owned(), domain.to_string()];
        robot.options.extend(domain);
    }
    let scans = of_kind("scan");
    let mut maps = of_kind("map");
    maps.retain(|topic| !topic.contains("costmap"));
    robot.lacks_map = maps.is_empty();
    let odometry = of_kind("odometry");
    if lasers == Lasers::All {
        robot.scans = of_lasers(&scans, &odometry);
    }
    for scan in &robot.scans {
        robot.options.extend(["--scan".to_owned(), scan.clone()]);
    }
    let scans = match robot.scans.is_empty() {
        true => scans,
        false => BTreeSet::new(),
    };
    for (option, default, topics) in [
        ("--scan", "/scan", &scans),
        ("--odom", "/odom", &odometry),
        ("--map", "/map", &maps),
    ] {
        let Some(chosen) = topics.get(default).or_else(|| topics.first()) else {
            continue;
        };
        if chosen != default {
            robot.options.extend([option.to_owned(), chosen.clone()]);
        }
        if topics.len() > 1 {
            let all: Vec<&str> = topics.iter().map(String::as_str).collect();
            let taken = format!("{option} {chosen} is taken of {}", all.join(", "));
            robot.said.push(taken);
        }
    }
    robot
}

fn list(published: &[Published]) -> Vec<String> {
    let mut nodes: BTreeMap<_, Vec<&str>> = BTreeMap::new();
    for one in published {
        let topics = nodes.entry((&one.rmw, one.domain, &one.node)).or_default();
        topics.push(&one.topic);
    }
    let sentence = |((rmw, domain, node), topics): ((&String, u32, &String), Vec<&str>)| {
        let topics = topics.join(", ");
        format!("on {rmw}, domain {domain}, {node} publishes {topics}")
    };
    nodes.into_iter().map(sentence).collect()
}

/// Returns the topics of several lasers of one robot with odometry; none if they are others'.
fn of_lasers(scans: &BTreeSet<String>, odometry: &BTreeSet<String>) -> Vec<String> {
    let space = |topic: &str| topic.split('/').nth(1).map(str::to_owned);
    let robots: BTreeSet<_> = odometry.iter().map(|topic| space(topic)).collect();
    let first = odometry.first().and_then(|topic| space(topic));
    let is_its = |topic: &&String| !robots.contains(&space(topic)) || space(topic) == first;
    let its: Vec<String> = scans.iter().filter(is_its).cloned().collect();
    let names: BTreeSet<String> = its.iter().map(|topic| lasers::name_of(topic)).collect();
    match its.len() > 1 && names.len() == its.len() && !scans.contains("/scan") {
        true => its,
        false => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn published(kinds: &[(&str, &str)], rmw: &str, domain: u32) -> Vec<Published> {
        let one = |&(kind, topic): &(&str, &str)| Published {
            rmw: rmw.to_owned(),
            domain,
            kind: kind.to_owned(),
            topic: topic.to_owned(),
            node: "/lidar".to_owned(),
        };
        kinds.iter().map(one).collect()
    }

    #[test]
    fn the_usual_names_need_no_option() {
        let seen = [
            ("scan", "/scan"),
            ("scan", "/scan_filtered"),
            ("odometry", "/odom"),
            ("map", "/global_costmap/costmap"),
            ("map", "/map"),
            ("transforms", "/tf"),
        ];
        let robot = robot_of(&published(&seen, "zenoh", 0), Lasers::All);
        assert_eq!(robot.options, ["--rmw", "zenoh"]);
        assert!(!robot.lacks_map);
        assert_eq!(
            robot.said,
            [
                "on zenoh, domain 0, /lidar publishes /scan, /scan_filtered, /odom, \
                 /global_costmap/costmap, /map, /tf",
                "--scan /scan is taken of /scan, /scan_filtered",
            ]
        );
    }

    #[test]
    fn other_names_are_options() {
        let seen = [
            ("scan", "/r2/front"),
            ("scan", "/r2/rear"),
            ("odometry", "/r2/odometry/filtered"),
        ];
        for (lasers, scans) in [
            (Lasers::First, "--scan /r2/front"),
            (Lasers::All, "--scan /r2/front --scan /r2/rear"),
        ] {
            let robot = robot_of(&published(&seen, "dds", 7), lasers);
            let expected = format!("--rmw dds --domain 7 {scans} --odom /r2/odometry/filtered");
            assert_eq!(robot.options.join(" "), expected);
            assert!(robot.lacks_map);
        }
    }

    #[test]
    fn lasers_of_another_robot_are_left_out() {
        let seen = [
            ("scan", "/r1/scan"),
            ("scan", "/r2/scan"),
            ("odometry", "/r1/odom"),
            ("odometry", "/r2/odom"),
        ];
        let robot = robot_of(&published(&seen, "dds", 0), Lasers::All);
        let expected = "--rmw dds --scan /r1/scan --odom /r1/odom";
        assert_eq!(robot.options.join(" "), expected);
    }

    #[test]
    fn a_robot_that_is_not_there_is_said() {
        let robot = robot_of(&[], Lasers::All);
        assert!(robot.options.is_empty());
        assert!(robot.said[0].starts_with("no node publishes laser scans"));
    }
}
