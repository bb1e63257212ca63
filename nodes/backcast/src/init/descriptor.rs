//! Generates the text of a descriptor.

use std::borrow::Cow;

use ros::lasers;

use super::robot::Robot;

const READER: &str = "lms_reader";
const GATEWAY: &str = "ros2_gateway";
const REPLAYER: &str = "replayer";
const MAP_SERVER: &str = "map_server";

const RESTARTS: &str = "    restart_policy: on-failure
    max_restarts: 15
    restart_window: 60
    restart_delay: 0.2
";

/// The node that scans come from, and its text.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub(crate) title: String,
    id: &'static str,
    yaml: String,
    scans: Vec<String>,
    has_odometry: bool,
    brings_map: bool,
}

impl Source {
    /// A laser for `lms_reader` with these options; a mount is `X,Y,YAW_DEG`.
    pub(crate) fn laser(options: &[String], mount: Option<&str>) -> Self {
        let options = words(options);
        let comment =
            "Reads the laser. `--mount X,Y,YAW_DEG` says where it sits on the robot: metres
ahead, metres to the left, degrees counter-clockwise; without it, poses are the
laser's own. `lms_reader --help` lists all options.";
        let args = format!("{options}{}", option("mount", mount));
        Source {
            title: format!("a laser (lms_reader {options})"),
            id: READER,
            yaml: node(READER, comment, &args, &[], "scan"),
            scans: vec!["scan".to_owned()],
            has_odometry: false,
            brings_map: false,
        }
    }

    /// A ROS 2 robot; without a router's address, the gateway is the router.
    pub(crate) fn robot(
        robot: &Robot,
        router: Option<&str>,
        mount: Option<&str>,
        brings_map: bool,
    ) -> Self {
        let scan = |topic: &String| format!("scan_{}", lasers::name_of(topic));
        let scans: Vec<String> = match robot.scans.is_empty() {
            true => vec!["scan".to_owned()],
            false => robot.scans.iter().map(scan).collect(),
        };
        let comment = "Takes scans, odometry and transforms from the robot, and gives it the pose.
`ros2_gateway --help` lists topics and frames.";
        let (brought, output) = match brings_map {
            true => (",map", ", map"),
            false => ("", ""),
        };
        let options = robot
            .options
            .iter()
            .map(|option| format!(" {}", word(option)));
        let router_word = router.map(word);
        let args = format!(
            "--bring scan,odometry{brought}{}{}{}",
            options.collect::<String>(),
            option("connect", router_word.as_deref()),
            option("mount", mount)
        );
        let inputs = [
            "hypotheses: peak_extractor/hypotheses",
            "pose: tracker/pose",
        ];
        let outputs = format!("{}, odometry{output}", scans.join(", "));
        Source {
            title: match router {
                Some(router) => format!("a ROS 2 robot with the router {router}"),
                None => "a ROS 2 robot".to_owned(),
            },
            id: GATEWAY,
            yaml: node(GATEWAY, comment, &args, &inputs, &outputs),
            scans,
            has_odometry: true,
            brings_map,
        }
    }

    pub(crate) fn recording(file: &str, has_odometry: bool) -> Self {
        let args = format!(
            "--recording {} --wait-for accumulator,peak_extractor,tracker",
            word(file)
        );
        let outputs = match has_odometry {
            true => "scan, odometry, ground_truth",
            false => "scan, ground_truth",
        };
        let inputs = ["hypotheses: peak_extractor/hypotheses"];
        let comment = "Plays the recording, and the run ends with it.";
        Source {
            title: format!("the recording {file}"),
            id: REPLAYER,
            yaml: node(REPLAYER, comment, &args, &inputs, outputs),
            scans: vec!["scan".to_owned()],
            has_odometry,
            brings_map: false,
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Served {
    Map(String),
    /// Maps of this folder, or of a file that lists them.
    Set(String),
    Recorded(String),
}

impl Served {
    fn yaml(&self) -> String {
        let (comment, option, file) = match self {
            Served::Recorded(file) => (
                "Serves the map that the recording holds.",
                "--recorded",
                file,
            ),
            Served::Map(file) => (
                "Serves the map, and serves it again when the file changes.",
                "--map",
                file,
            ),
            Served::Set(file) => (
                "Serves all maps, and as `map` the one on which the robot is.",
                "--maps",
                file,
            ),
        };
        let (inputs, outputs) = match self {
            Served::Set(_) => (&["pose: tracker/pose"][..], "map, maps"),
            _ => (&[][..], "map"),
        };
        let args = format!("{option} {}", word(file));
        node(MAP_SERVER, comment, &args, inputs, outputs)
    }
}

/// Generates the whole descriptor; `map` is served by `map_server` if it is given.
pub(crate) fn descriptor_of(source: &Source, map: Option<&Served>) -> String {
    let from = source.id;
    let map_from = match source.brings_map {
        true => from,
        false => MAP_SERVER,
    };
    let map_wire = format!("map: {map_from}/map");
    let mut nodes = vec![source.yaml.clone()];
    nodes.extend(map.map(Served::yaml));
    // With several maps, the searching nodes compute the boundaries themselves.
    let is_set = matches!(map, Some(Served::Set(_)));
    let maps = match is_set {
        true => "maps: map_server/maps",
        false => &map_wire,
    };
    let scans = source
        .scans
        .iter()
        .map(|scan| format!("{scan}: {from}/{scan}"));
    let scans: Vec<String> = scans.collect();
    let scans: Vec<&str> = scans.iter().map(String::as_str).collect();
    let odometry = format!("odometry: {from}/odometry");
    let odometry = source.has_odometry.then_some(&*odometry);
    if !is_set {
        nodes.push(node(
            "boundary_extractor",
            "Finds the obstacle cells that a laser can hit.",
            "",
            &[&map_wire],
            "boundary",
        ));
    }
    let mut inputs = [&scans[..], &[maps]].concat();
    inputs.extend((!is_set).then_some("boundary: boundary_extractor/boundary"));
    inputs.extend(odometry);
    inputs.push("attention: tracker/attention");
    let votes = match is_set {
        true => "votes, votes_by_map, readings, field",
        false => "votes, readings, field",
    };
    nodes.push(node(
        "accumulator",
        "Searches the whole map for each scan that the tracker asks about. `--threads N` uses
several processors, `--region` and `--headings-within` limit where it searches.",
        "",
        &inputs,
        votes,
    ));
    let mut inputs = vec!["votes: accumulator/votes"];
    inputs.extend(is_set.then_some("votes_by_map: accumulator/votes_by_map"));
    inputs.push("readings: accumulator/readings");
    inputs.extend(&scans);
    inputs.push(maps);
    nodes.push(node(
        "peak_extractor",
        "Refines what was found and judges it: one place, several, or none that fits.",
        "",
        &inputs,
        "hypotheses, beams",
    ));
    let mut inputs = scans.clone();
    inputs.extend(odometry);
    inputs.extend([maps, "hypotheses: peak_extractor/hypotheses"]);
    nodes.push(node(
        "tracker",
        "Keeps the pose from scan to scan, and says how sure it is.",
        "",
        &inputs,
        "pose, attention",
    ));
    let page = "A page to watch all of it, on http://127.0.0.1:7440 or the next free port.";
    nodes.push(node("monitor", page, "", &[], ""));
    format!(
        "# A graph of Backcast: {title}. Written by `backcast init`.
#
# Each node is a process; an input is `topic: node/topic`. Nodes are looked for beside the
# command `backcast`, in its installation and on the PATH. `backcast check` says what is
# wrong with a changed file, `backcast run` starts it, `backcast status` looks at it.
nodes:
{nodes}",
        title = source.title.replace('\n', " "),
        nodes = nodes.join("\n"),
    )
}

/// Returns the text of a node below the lines of its comment; what is empty is left out.
fn node(id: &str, comment: &str, args: &str, inputs: &[&str], outputs: &str) -> String {
    let mut lines: Vec<String> = comment.lines().map(|line| format!("  # {line}")).collect();
    lines.extend([format!("  - id: {id}"), format!("    path: {id}")]);
    if !args.is_empty() {
        lines.push(format!("    args: {}", quoted(args)));
    }
    if !inputs.is_empty() {
        lines.push("    inputs:".to_owned());
        lines.extend(inputs.iter().map(|input| format!("      {input}")));
    }
    if !outputs.is_empty() {
        lines.push(format!("    outputs: [{outputs}]"));
    }
    let restarts = match id {
        REPLAYER => "    restart_policy: never\n",
        _ => RESTARTS,
    };
    lines.join("\n") + "\n" + restarts
}

fn option(name: &str, value: Option<&str>) -> String {
    value.map_or_else(String::new, |value| format!(" --{name} {value}"))
}

fn words(words: &[String]) -> String {
    let words: Vec<_> = words.iter().map(|text| word(text)).collect();
    words.join(" ")
}

/// Quotes a word for `args` if needed.
fn word(text: &str) -> Cow<'_, str> {
    // A zero byte cannot be quoted, but no path has one.
    shlex::try_quote(text).unwrap_or(Cow::Borrowed(text))
}

/// Quotes a text for YAML, on one line.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

#[cfg(test)]
mod tests {
    use launcher::descriptor::{Builds, load};

    use super::*;

    const NODES: &str = "lms_reader ros2_gateway replayer map_server boundary_extractor \
                         accumulator peak_extractor tracker monitor";
    const FILE: &str = "/data/a \"good\" drive.mcap";

    /// Returns each kind of source with the words that its node has to be given.
    fn sources() -> Vec<(Source, Vec<&'static str>)> {
        let list = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
        let mount = Some("0.2,0,-90");
        let router = Some("tcp/robot:7447");
        let serial: Vec<String> = list(&["--serial", "/dev/a laser"]);
        let one = Robot {
            options: list(&["--rmw", "dds", "--scan", "/r2/scan"]),
            ..Robot::default()
        };
        let two = Robot {
            options: list(&["--scan", "/front/scan", "--scan", "/rear/scan"]),
            scans: list(&["/front/scan", "/rear/scan"]),
            ..Robot::default()
        };
        let at = "--mount 0.2,0,-90";
        let reader = vec!["--serial", "/dev/a laser"];
        let words = |text: &'static str| text.split(' ').collect::<Vec<_>>();
        let played = [
            vec!["--recording", FILE],
            words("--wait-for accumulator,peak_extractor,tracker"),
        ];
        vec![
            (Source::laser(&serial, None), reader.clone()),
            (Source::laser(&serial, mount), [reader, words(at)].concat()),
            (
                Source::robot(&one, None, mount, true),
                words("--bring scan,odometry,map --rmw dds --scan /r2/scan --mount 0.2,0,-90"),
            ),
            (
                Source::robot(&one, router, None, false),
                words("--bring scan,odometry --rmw dds --scan /r2/scan --connect tcp/robot:7447"),
            ),
            (
                Source::robot(&two, None, None, true),
                words("--bring scan,odometry,map --scan /front/scan --scan /rear/scan"),
            ),
            (Source::recording(FILE, true), played.concat()),
            (Source::recording(FILE, false), played.concat()),
        ]
    }

    #[test]
    fn what_is_written_is_a_sound_descriptor_with_the_arguments_as_given() {
        let folder = tempfile::tempdir().unwrap();
        for node in NODES.split(' ') {
            std::fs::copy("/bin/true", folder.path().join(node)).unwrap();
        }
        let map = "/maps/my house.yaml";
        let served = [Served::Map, Served::Set, Served::Recorded].map(|of| of(map.to_owned()));
        let options = ["--map", "--maps", "--recorded"];
        for (source, words) in sources() {
            for (served, option) in served.iter().zip(options) {
                let served = (!source.brings_map).then_some(served);
                let text = descriptor_of(&source, served);
                let file = folder.path().join("graph.yaml");
                std::fs::write(&file, &text).unwrap();
                let descriptor = load(&file, Builds::Run).unwrap_or_else(|e| panic!("{e}\n{text}"));
                let node = |id: &str| descriptor.dataflow.nodes.iter().find(|n| n.id == id);
                assert_eq!(node(source.id).unwrap().args, words);
                let server = node("map_server").map(|server| &server.args[..]);
                assert_eq!(server.is_some(), served.is_some());
                assert!(server.is_none_or(|args| args == [option, map]), "{text}");
            }
        }
    }
}
