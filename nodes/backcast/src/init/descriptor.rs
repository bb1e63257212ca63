//! Generates the text of a descriptor.

use std::borrow::Cow;

use ros::lasers;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Source {
    Laser {
        /// Options of `lms_reader` with the address and protocol, one word each.
        options: Vec<String>,
        /// Mount as `X,Y,YAW_DEG`.
        mount: Option<String>,
    },
    Ros2 {
        options: Vec<String>,
        /// Topics of the scans of several lasers; empty with one laser.
        scans: Vec<String>,
        /// Address of its router; `None` if the gateway is the router.
        router: Option<String>,
        /// Mount as `X,Y,YAW_DEG`.
        mount: Option<String>,
        /// True if the robot publishes the map.
        brings_map: bool,
    },
    Recording {
        file: String,
        has_odometry: bool,
    },
}

const RESTARTS: &str = "    restart_policy: on-failure
    max_restarts: 15
    restart_window: 60
    restart_delay: 0.2
";

impl Source {
    pub(crate) fn title(&self) -> String {
        match self {
            Source::Laser { options, .. } => format!("a laser (lms_reader {})", words(options)),
            Source::Ros2 { router, .. } => match router {
                Some(router) => format!("a ROS 2 robot with the router {router}"),
                None => "a ROS 2 robot".to_owned(),
            },
            Source::Recording { file, .. } => format!("the recording {file}"),
        }
    }

    fn node(&self) -> &'static str {
        match self {
            Source::Laser { .. } => "lms_reader",
            Source::Ros2 { .. } => "ros2_gateway",
            Source::Recording { .. } => "replayer",
        }
    }

    fn map_node(&self) -> &'static str {
        match self {
            Source::Ros2 {
                brings_map: true, ..
            } => "ros2_gateway",
            _ => "map_server",
        }
    }

    fn scans(&self) -> Vec<String> {
        match self {
            Source::Ros2 { scans, .. } if !scans.is_empty() => {
                let name = |topic: &String| format!("scan_{}", lasers::name_of(topic));
                scans.iter().map(name).collect()
            }
            _ => vec!["scan".to_owned()],
        }
    }

    fn has_odometry(&self) -> bool {
        match self {
            Source::Laser { .. } => false,
            Source::Ros2 { .. } => true,
            Source::Recording { has_odometry, .. } => *has_odometry,
        }
    }

    fn yaml(&self) -> String {
        let mount = |mount: &Option<String>| {
            let mount = mount.as_ref();
            mount.map_or_else(String::new, |mount| format!(" --mount {mount}"))
        };
        match self {
            Source::Laser { options, mount: at } => format!(
                "  # Reads the laser. `--mount X,Y,YAW_DEG` says where it sits on the robot: metres
  # ahead, metres to the left, degrees counter-clockwise; without it, poses are the
  # laser's own. `lms_reader --help` lists all options.
  - id: lms_reader
    path: lms_reader
    args: {args}
    outputs: [scan]
{RESTARTS}",
                args = quoted(&format!("{}{}", words(options), mount(at)))
            ),
            Source::Ros2 {
                router,
                options,
                mount: at,
                brings_map,
                ..
            } => {
                let router = router.as_deref().map(|r| format!(" --connect {}", word(r)));
                let options = options.iter().map(|option| format!(" {}", word(option)));
                let (brought, output) = match brings_map {
                    true => (",map", ", map"),
                    false => ("", ""),
                };
                format!(
                    "  # Takes scans, odometry and transforms from the robot, and gives it the pose.
  # `ros2_gateway --help` lists topics and frames.
  - id: ros2_gateway
    path: ros2_gateway
    args: {args}
    inputs:
      hypotheses: peak_extractor/hypotheses
      pose: tracker/pose
    outputs: [{scans}, odometry{output}]
{RESTARTS}",
                    scans = self.scans().join(", "),
                    args = quoted(&format!(
                        "--bring scan,odometry{brought}{}{}{}",
                        options.collect::<String>(),
                        router.unwrap_or_default(),
                        mount(at)
                    )),
                )
            }
            Source::Recording { file, has_odometry } => format!(
                "  # Plays the recording, and the run ends with it.
  - id: replayer
    path: replayer
    args: {args}
    inputs:
      hypotheses: peak_extractor/hypotheses
    outputs: [scan{odometry}, ground_truth]
    restart_policy: never
",
                args = quoted(&format!(
                    "--recording {} --wait-for accumulator,peak_extractor,tracker",
                    word(file)
                )),
                odometry = if *has_odometry { ", odometry" } else { "" },
            ),
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
        let (comment, option, file, ports) = match self {
            Served::Recorded(file) => (
                "Serves the map that the recording holds.",
                "--recorded",
                file,
                "    outputs: [map]",
            ),
            Served::Map(file) => (
                "Serves the map, and serves it again when the file changes.",
                "--map",
                file,
                "    outputs: [map]",
            ),
            Served::Set(file) => (
                "Serves all maps, and as `map` the one on which the robot is.",
                "--maps",
                file,
                "    inputs:\n      pose: tracker/pose\n    outputs: [map, maps]",
            ),
        };
        format!(
            "
  # {comment}
  - id: map_server
    path: map_server
    args: {args}
{ports}
{RESTARTS}",
            args = quoted(&format!("{option} {}", word(file)))
        )
    }
}

/// Generates the whole descriptor; `map` is served by `map_server` if it is given.
pub(crate) fn descriptor_of(source: &Source, map: Option<&Served>) -> String {
    let from = source.node();
    let scans = source.scans().into_iter();
    let scans: Vec<String> = scans.map(|scan| format!("{scan}: {from}/{scan}")).collect();
    let scans = scans.join("\n      ");
    let odometry = match source.has_odometry() {
        true => format!("\n      odometry: {from}/odometry"),
        false => String::new(),
    };
    let map_server = map.map_or_else(String::new, Served::yaml);
    let map_from = source.map_node();
    // With several maps, the searching nodes compute the boundaries themselves.
    let (maps, boundaries, boundary, by_map) = match map {
        Some(Served::Set(_)) => (
            "maps: map_server/maps".to_owned(),
            String::new(),
            "",
            [
                "votes_by_map, ",
                "\n      votes_by_map: accumulator/votes_by_map",
            ],
        ),
        _ => (
            format!("map: {map_from}/map"),
            format!(
                "
  # Finds the obstacle cells that a laser can hit.
  - id: boundary_extractor
    path: boundary_extractor
    inputs:
      map: {map_from}/map
    outputs: [boundary]
{RESTARTS}"
            ),
            "\n      boundary: boundary_extractor/boundary",
            ["", ""],
        ),
    };
    let [votes_out, votes_in] = by_map;
    format!(
        "# A graph of Backcast: {title}. Written by `backcast init`.
#
# Each node is a process; an input is `topic: node/topic`. Nodes are looked for beside the
# command `backcast`, in its installation and on the PATH. `backcast check` says what is
# wrong with a changed file, `backcast run` starts it, `backcast status` looks at it.
nodes:
{source}{map_server}{boundaries}
  # Searches the whole map for each scan that the tracker asks about. `--threads N` uses
  # several processors, `--region` and `--headings-within` limit where it searches.
  - id: accumulator
    path: accumulator
    inputs:
      {scans}
      {maps}{boundary}{odometry}
      attention: tracker/attention
    outputs: [votes, {votes_out}readings, field]
{RESTARTS}
  # Refines what was found and judges it: one place, several, or none that fits.
  - id: peak_extractor
    path: peak_extractor
    inputs:
      votes: accumulator/votes{votes_in}
      readings: accumulator/readings
      {scans}
      {maps}
    outputs: [hypotheses, beams]
{RESTARTS}
  # Keeps the pose from scan to scan, and says how sure it is.
  - id: tracker
    path: tracker
    inputs:
      {scans}{odometry}
      {maps}
      hypotheses: peak_extractor/hypotheses
    outputs: [pose, attention]
{RESTARTS}
  # A page to watch all of it, on http://127.0.0.1:7440 or the next free port.
  - id: monitor
    path: monitor
{RESTARTS}",
        title = source.title().replace('\n', " "),
        source = source.yaml(),
    )
}

fn words(words: &[String]) -> String {
    let words: Vec<String> = words.iter().map(|text| word(text)).collect();
    words.join(" ")
}

/// Quotes a word for `args` if needed.
fn word(text: &str) -> String {
    // A zero byte cannot be quoted, but no path has one.
    shlex::try_quote(text).map_or_else(|_| text.to_owned(), Cow::into_owned)
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

    fn list<const N: usize>(words: [&str; N]) -> Vec<String> {
        words.map(str::to_owned).to_vec()
    }

    fn sources() -> Vec<Source> {
        let mount = Some("0.2,0,-90".to_owned());
        let router = Some("tcp/robot:7447".to_owned());
        let laser = |mount| Source::Laser {
            options: list(["--serial", "/dev/a laser"]),
            mount,
        };
        let robot = |router, brings_map| Source::Ros2 {
            options: list(["--rmw", "dds", "--scan", "/r2/scan"]),
            scans: Vec::new(),
            router,
            mount: mount.clone(),
            brings_map,
        };
        let lasers = Source::Ros2 {
            options: list(["--scan", "/front/scan", "--scan", "/rear/scan"]),
            scans: list(["/front/scan", "/rear/scan"]),
            router: None,
            mount: None,
            brings_map: true,
        };
        let recording = |has_odometry| Source::Recording {
            file: "/data/a \"good\" drive.mcap".to_owned(),
            has_odometry,
        };
        vec![
            laser(None),
            laser(mount.clone()),
            robot(None, true),
            robot(router, false),
            lasers,
            recording(true),
            recording(false),
        ]
    }

    #[test]
    fn what_is_written_is_a_sound_descriptor_with_the_arguments_as_given() {
        let folder = tempfile::tempdir().unwrap();
        let file = || "/maps/my house.yaml".to_owned();
        let served = [Served::Map, Served::Set, Served::Recorded].map(|of| of(file()));
        let sources = sources().into_iter();
        for (source, map) in
            sources.flat_map(|source| served.each_ref().map(|map| (source.clone(), map)))
        {
            let map = (source.map_node() == "map_server").then_some(map);
            let text = descriptor_of(&source, map);
            let file = folder.path().join("graph.yaml");
            std::fs::write(&file, &text).unwrap();
            for node in NODES.split(' ') {
                std::fs::copy("/bin/true", folder.path().join(node)).unwrap();
            }
            let descriptor = load(&file, Builds::Run).unwrap_or_else(|e| panic!("{e}\n{text}"));
            let args = |id: &str| {
                let node = descriptor.dataflow.nodes.iter().find(|n| n.id == id);
                node.unwrap().args.clone()
            };
            match map {
                Some(Served::Map(file)) => assert_eq!(args("map_server"), ["--map", file]),
                Some(Served::Set(file)) => assert_eq!(args("map_server"), ["--maps", file]),
                Some(Served::Recorded(file)) => {
                    assert_eq!(args("map_server"), ["--recorded", file]);
                }
                None => {}
            }
            let fed_by = args(source.node());
            match &source {
                Source::Recording { file, .. } => assert_eq!(fed_by[1], *file),
                Source::Laser { mount, .. } | Source::Ros2 { mount, .. } => {
                    if let Source::Laser { options, .. } = &source {
                        assert_eq!(fed_by[..2], options[..]);
                    }
                    let place = fed_by.iter().position(|word| word == "--mount");
                    let given = place.map(|place| fed_by[place + 1].clone());
                    assert_eq!(given, *mount);
                }
            }
        }
    }
}
