//! Options of `run` that are meant for a node: they become arguments of the
//! node with that executable, in place of what the descriptor gives there.

use std::path::{Path, PathBuf};

use dataflow::{Dataflow, Node};
use engine::heading::{HeadingConfig, HeadingFrom, HeadingSource};
use messages::{Topic, topic};
use ros::lasers::name_of;

use super::arguments::{
    ACCUMULATOR, MAP_SERVER, PLAYERS, find, leave_out_monitors, name_robot, set, unset, value,
};
use super::options::{Options, Rate};
use super::{lasers, replay};
use crate::LauncherError;

/// The recording whose own map `map_server` prefers.
const RECORDED_MAP: &str = "--recorded";
/// The recording that is played on another map than its own.
const PLAYED: &str = "--played";
const MAX_AGE: &str = "--heading-max-age-s";

/// Puts the options into the arguments of their nodes. `file` is named in
/// errors.
///
/// # Errors
/// An option is for a node, or needs an input, that the graph does not have.
pub(crate) fn apply(
    options: &Options,
    dataflow: &mut Dataflow,
    file: &Path,
) -> Result<(), LauncherError> {
    if !options.replay.is_empty() {
        forward_replay(options, dataflow)?;
    }
    if let Some(map) = &options.map {
        let map = std::path::absolute(map).map_err(LauncherError::Folder)?;
        let node = find(dataflow, &[MAP_SERVER], "--map", file)?;
        set(node, "--map", Some(&map.to_string_lossy()));
        if let Some(recording) = value(node, RECORDED_MAP).map(str::to_owned) {
            unset(node, RECORDED_MAP, true);
            set(node, PLAYED, Some(&recording));
        }
    }
    if let Some(maps) = &options.maps {
        let maps = std::path::absolute(maps).map_err(LauncherError::Folder)?;
        let node = find(dataflow, &[MAP_SERVER], "--maps", file)?;
        for option in ["--map", RECORDED_MAP, PLAYED] {
            unset(node, option, true);
        }
        set(node, "--maps", Some(&maps.to_string_lossy()));
    }
    if let Some(rate) = options.rate {
        let node = find(dataflow, &PLAYERS, "--rate", file)?;
        set(node, "--rate", Some(&rate.to_string()));
    }
    if options.repeat {
        let node = find(dataflow, &PLAYERS, "--loop", file)?;
        set(node, "--loop", None);
    }
    if options.no_monitor {
        leave_out_monitors(dataflow);
    }
    if let Some(graph) = &options.graph {
        name_robot(dataflow, graph.as_str());
    }
    forward_heading(&options.heading, dataflow, file)
}

/// The recordings, and which of their topics are meant.
fn forward_replay(options: &Options, dataflow: &mut Dataflow) -> Result<(), LauncherError> {
    if let Some(topic) = &options.map_topic {
        return Err(LauncherError::Usage(format!(
            "--map-topic {topic}: a graph takes its map from the map_server, as the descriptor or --map says; \
             `locate`, `evaluate` and `plot` take the one in the recording"
        )));
    }
    let absolute = options.replay.iter().map(std::path::absolute);
    let recordings: Vec<PathBuf> = absolute
        .collect::<Result<_, _>>()
        .map_err(LauncherError::Folder)?;
    let is_map_server = |node: &&mut Node| node.executable() == MAP_SERVER;
    if let (Some(node), [recording]) = (dataflow.nodes.iter_mut().find(is_map_server), &*recordings)
    {
        set(node, RECORDED_MAP, Some(&recording.to_string_lossy()));
    }
    let replayer = replay::play(dataflow, &recordings);
    if !options.scan_topic.is_empty() {
        unset(replayer, "--scan-topic", true);
    }
    for topic in &options.scan_topic {
        replayer.args.push(format!("--scan-topic={topic}"));
    }
    if options.odom_topic.is_some() {
        set(replayer, "--odom-topic", options.odom_topic.as_deref());
    }
    if options.scan_topic.len() > 1 {
        let names = options.scan_topic.iter().map(|topic| name_of(topic));
        lasers::join(dataflow, &names.collect::<Vec<_>>());
    }
    Ok(())
}

/// The options exclude or complete each other: a new source replaces all that
/// was said about the one before. How old odometry may be stays if it is used.
fn forward_heading(
    heading: &HeadingConfig,
    dataflow: &mut Dataflow,
    file: &Path,
) -> Result<(), LauncherError> {
    heading.check().map_err(LauncherError::Usage)?;
    let option = match heading.source() {
        HeadingSource::Searched => return Ok(()),
        HeadingSource::Fixed(_) => "--heading",
        HeadingSource::Odometry { .. } | HeadingSource::Truth => "--heading-from",
    };
    let node = find(dataflow, &[ACCUMULATOR], option, file)?;
    let values = [
        (
            "--heading",
            heading.heading.map(|degrees| degrees.to_string()),
        ),
        (
            "--heading-from",
            heading.heading_from.map(|source| source.to_string()),
        ),
        (
            "--heading-offset",
            heading.heading_offset.map(|degrees| degrees.to_string()),
        ),
        (
            MAX_AGE,
            heading.heading_max_age_s.map(|seconds| seconds.to_string()),
        ),
    ];
    if let Some(source) = heading.heading_from {
        check_wired(node, source, file)?;
    }
    let odometry = heading.heading_from == Some(HeadingFrom::Odometry);
    for (option, value) in values {
        match value {
            Some(value) => set(node, option, Some(&value)),
            None if option == MAX_AGE && odometry => {}
            None => unset(node, option, true),
        }
    }
    Ok(())
}

/// Whether the graph is played as fast as it answers, so that nothing may be
/// lost: the option says so, or the descriptor does.
pub(crate) fn plays_at_max(dataflow: &Dataflow) -> bool {
    let max = Rate::Max.to_string();
    let mut nodes = dataflow.nodes.iter();
    nodes.any(|n| PLAYERS.contains(&n.executable()) && value(n, "--rate") == Some(&max))
}

fn check_wired(node: &Node, source: HeadingFrom, file: &Path) -> Result<(), LauncherError> {
    let topic = match source {
        HeadingFrom::Odometry => topic::OdometryTopic::NAME,
        HeadingFrom::Truth => topic::GroundTruthTopic::NAME,
    };
    if node.inputs.iter().any(|input| input.topic == topic) {
        return Ok(());
    }
    Err(LauncherError::NotWired {
        option: "--heading-from",
        topic,
        node: node.id.clone(),
        file: file.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use command_line::CommandError;

    use super::*;
    use crate::LauncherError;

    fn graph(replayer_args: &str, inputs: &str) -> Dataflow {
        let text = format!(
            "nodes:
  - {{id: r, path: bin/replayer, outputs: [scan, odometry, ground_truth], args: \"{replayer_args}\"}}
  - {{id: a, path: bin/accumulator, args: --beams 9, inputs: {{{inputs}}}}}
"
        );
        let topics = dataflow::Topics {
            names: messages::topic::NAMES,
            shared: &[],
            several: &[],
        };
        dataflow::parse(&text, &topics).unwrap()
    }

    fn applied(
        options: &Options,
        mut dataflow: Dataflow,
    ) -> Result<Vec<Vec<String>>, LauncherError> {
        apply(options, &mut dataflow, Path::new("g.yaml"))?;
        Ok(dataflow.nodes.into_iter().map(|n| n.args).collect())
    }

    #[test]
    fn options_replace_what_the_descriptor_gives() {
        let options = Options {
            rate: Some(Rate::Times(2.0)),
            repeat: true,
            ..Options::default()
        };
        for before in ["x --rate max y", "x --rate=0.5 y --loop", "x y"] {
            let args = applied(&options, graph(before, "")).unwrap();
            assert_eq!(args[0], ["x", "y", "--rate=2", "--loop"], "{before}");
            assert_eq!(args[1], ["--beams", "9"]);
        }
    }

    #[test]
    fn a_recording_is_played_on_its_own_map_unless_another_is_given() {
        let map_args = |options: &Options| {
            let mut dataflow = graph("", "");
            dataflow.nodes[1].path = "bin/map_server".to_owned();
            applied(options, dataflow).unwrap().swap_remove(1)
        };
        let mut options = Options {
            replay: vec!["/drive.mcap".into()],
            ..Options::default()
        };
        assert_eq!(
            map_args(&options),
            ["--beams", "9", "--recorded=/drive.mcap"]
        );
        options.map = Some("/other.yaml".into());
        let expected = ["--beams", "9", "--map=/other.yaml", "--played=/drive.mcap"];
        assert_eq!(map_args(&options), expected);
        // Which of several recordings has the map of all is not known.
        options.map = None;
        options.replay.push("/rest.mcap".into());
        assert_eq!(map_args(&options), ["--beams", "9"]);
    }

    fn with(heading: HeadingConfig) -> Options {
        Options {
            heading,
            ..Options::default()
        }
    }

    #[test]
    fn headings_reach_the_accumulator() {
        let fixed = with(HeadingConfig {
            heading: Some(-90.0),
            ..HeadingConfig::default()
        });
        let args = applied(&fixed, graph("", "")).unwrap();
        assert_eq!(args[1], ["--beams", "9", "--heading=-90"]);
        let mut aged = graph("", "");
        aged.nodes[1].args = ["--heading-from=odometry", "--heading-max-age-s", "3"]
            .map(Into::into)
            .into();
        assert_eq!(applied(&fixed, aged).unwrap()[1], ["--heading=-90"]);

        let odometry = with(HeadingConfig {
            heading_from: Some(HeadingFrom::Odometry),
            heading_offset: Some(-1.5),
            ..HeadingConfig::default()
        });
        let mut wired = graph("", "odometry: r/odometry");
        wired.nodes[1].args = ["--heading", "7", "--heading-max-age-s=3"]
            .map(Into::into)
            .into();
        let args = applied(&odometry, wired).unwrap();
        assert_eq!(
            args[1],
            [
                "--heading-max-age-s=3",
                "--heading-from=odometry",
                "--heading-offset=-1.5"
            ]
        );
        let error = applied(&odometry, graph("", "")).unwrap_err();
        assert!(
            matches!(
                &error,
                LauncherError::NotWired {
                    topic: "odometry",
                    ..
                }
            ),
            "{error}"
        );
    }

    #[test]
    fn the_true_heading_has_no_offset() {
        let mut options = with(HeadingConfig {
            heading_from: Some(HeadingFrom::Truth),
            ..HeadingConfig::default()
        });
        let wired = || graph("", "odometry: r/odometry, ground_truth: r/ground_truth");
        let args = applied(&options, wired()).unwrap();
        assert_eq!(args[1], ["--beams", "9", "--heading-from=truth"]);
        options.heading.heading_offset = Some(1.0);
        let error = applied(&options, wired()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "--heading-offset needs --heading-from odometry"
        );
    }

    #[test]
    fn an_option_without_its_node_is_refused() {
        let mut no_replayer = graph("", "");
        no_replayer.nodes.remove(0);
        let options = Options {
            repeat: true,
            ..Options::default()
        };
        let error = applied(&options, no_replayer).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let said = error.to_string();
        assert!(said.contains("--loop is for the replayer"), "{said}");
        assert!(said.contains("its executables are accumulator"), "{said}");
    }

    fn parsed(text: &str) -> Dataflow {
        let topics = dataflow::Topics {
            names: messages::topic::NAMES,
            shared: &[],
            several: &[],
        };
        dataflow::parse(text, &topics).unwrap()
    }

    #[test]
    fn a_map_goes_to_its_server() {
        let text = "nodes: [{id: m, path: bin/map_server, args: --map a.yaml}]";
        let options = Options {
            map: Some("/maps/b.yaml".into()),
            ..Options::default()
        };
        let args = applied(&options, parsed(text)).unwrap();
        assert_eq!(args, [["--map=/maps/b.yaml"]]);
        let several = Options {
            maps: Some("/maps".into()),
            ..Options::default()
        };
        assert_eq!(applied(&several, parsed(text)).unwrap(), [["--maps=/maps"]]);
        let error = applied(&options, graph("", "")).unwrap_err().to_string();
        assert!(error.contains("--map is for the map_server"), "{error}");
    }

    #[test]
    fn monitors_stay_unless_they_are_left_out() {
        let text = "nodes: [{id: a, path: bin/accumulator}, {id: page, path: bin/monitor}]";
        let nodes = |no_monitor| {
            let options = Options {
                no_monitor,
                ..Options::default()
            };
            applied(&options, parsed(text)).unwrap().len()
        };
        assert_eq!((nodes(false), nodes(true)), (2, 1));
    }

    #[test]
    fn playing_at_max_is_seen_in_the_arguments() {
        assert!(plays_at_max(&graph("--rate max", "")));
        assert!(plays_at_max(&graph("--rate=max", "")));
        assert!(!plays_at_max(&graph("--rate 2", "")));
        assert!(!plays_at_max(&graph("max", "")));
    }

    #[test]
    fn recordings_and_their_topics_go_to_the_replayer() {
        let options = Options {
            replay: vec!["/a.mcap".into(), "/b".into()],
            scan_topic: vec!["/front/scan".to_owned()],
            odom_topic: Some("/wheels".to_owned()),
            ..Options::default()
        };
        let before = "--recording x.mcap --rate=max --scan-topic /scan";
        let args = applied(&options, graph(before, "")).unwrap();
        let expected = [
            "--rate=max",
            "--recording=/a.mcap",
            "--recording=/b",
            "--scan-topic=/front/scan",
            "--odom-topic=/wheels",
        ];
        assert_eq!(args[0], expected);
        let options = Options {
            map_topic: Some("/map".to_owned()),
            ..options
        };
        let refusal = applied(&options, graph("", "")).unwrap_err().to_string();
        assert!(refusal.contains("from the map_server"), "{refusal}");
    }
}
