//! Applies options of `run` to nodes as arguments, which replace those of the descriptor.

use std::path::{Path, PathBuf};

use anyhow::Context;
use command_line::wrong_use;
use dataflow::{Dataflow, Node};
use engine::heading::{HeadingConfig, HeadingFrom, HeadingSource};
use messages::{Topic, topic};
use ros::CloudOptions;
use ros::lasers::name_of;

use super::arguments::{
    ACCUMULATOR, MAP_SERVER, PLAYERS, find, leave_out_monitors, name_robot, set, unset, value,
};
use super::options::{MAX_RATE, Options};
use super::{lasers, replay};
use crate::descriptor::NO_FOLDER;

/// Option of `map_server`: recording whose own map is preferred.
const RECORDED_MAP: &str = "--recorded";
/// Option of `map_server`: recording that is played on another map than its own.
const PLAYED: &str = "--played";
const MAPS: &str = "--maps";
const ON: &str = "--on";
const MAX_AGE: &str = "--heading-max-age-s";

/// Puts the options into the arguments of their nodes. `file` is named in errors.
pub(crate) fn apply(options: &Options, dataflow: &mut Dataflow, file: &Path) -> anyhow::Result<()> {
    if !options.replay.is_empty() {
        forward_replay(options, dataflow)?;
    } else if let Some(topic) = &options.cloud.cloud_topic {
        return Err(wrong_use(format!(
            "--cloud-topic {topic} is of a recording: allowed with --replay"
        )));
    }
    if let Some(map) = &options.map {
        let map = std::path::absolute(map).context(NO_FOLDER)?;
        let node = find(dataflow, &[MAP_SERVER], "--map", file)?;
        for option in [MAPS, ON] {
            unset(node, option, true);
        }
        set(node, "--map", Some(&map.to_string_lossy()));
        if let Some(recording) = value(node, RECORDED_MAP).map(str::to_owned) {
            unset(node, RECORDED_MAP, true);
            set(node, PLAYED, Some(&recording));
        }
    }
    if let Some(maps) = &options.maps {
        let maps = std::path::absolute(maps).context(NO_FOLDER)?;
        let node = find(dataflow, &[MAP_SERVER], MAPS, file)?;
        // `--on` names maps and floors of the old set.
        for option in ["--map", RECORDED_MAP, PLAYED, ON] {
            unset(node, option, true);
        }
        set(node, MAPS, Some(&maps.to_string_lossy()));
    }
    if let Some(rate) = &options.rate {
        let node = find(dataflow, &PLAYERS, "--rate", file)?;
        set(node, "--rate", Some(rate));
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

fn forward_replay(options: &Options, dataflow: &mut Dataflow) -> anyhow::Result<()> {
    if let Some(topic) = &options.map_topic {
        return Err(wrong_use(format!(
            "--map-topic {topic}: a graph takes its map from the map_server, as the descriptor or --map says; \
             `locate`, `evaluate` and `plot` take the one in the recording"
        )));
    }
    // Nodes read a recording several times, and in processes of their own.
    let is_stream = |path: &&PathBuf| {
        **path == Path::new("-") || (path.exists() && !path.is_file() && !path.is_dir())
    };
    if let Some(stream) = options.replay.iter().find(is_stream) {
        return Err(wrong_use(format!(
            "--replay {} is no file: save the recording to one first",
            stream.display()
        )));
    }
    let absolute = options.replay.iter().map(std::path::absolute);
    let recordings: Vec<PathBuf> = absolute.collect::<Result<_, _>>().context(NO_FOLDER)?;
    let is_map_server = |node: &&mut Node| node.executable() == MAP_SERVER;
    if let (Some(node), [recording]) = (dataflow.nodes.iter_mut().find(is_map_server), &*recordings)
        // A set stays: the recording has only one map.
        && (value(node, MAPS).is_none() || options.map.is_some())
    {
        set(node, RECORDED_MAP, Some(&recording.to_string_lossy()));
    }
    let replayer = replay::play(dataflow, &recordings);
    if !options.scan_topic.is_empty() {
        for option in [
            "--scan-topic",
            "--cloud-topic",
            "--heights",
            "--cloud-mount",
        ] {
            unset(replayer, option, true);
        }
    }
    for topic in &options.scan_topic {
        replayer.args.push(format!("--scan-topic={topic}"));
    }
    if options.odom_topic.is_some() {
        set(replayer, "--odom-topic", options.odom_topic.as_deref());
    }
    if let CloudOptions {
        cloud_topic: Some(topic),
        heights,
        cloud_mount,
    } = &options.cloud
    {
        unset(replayer, "--scan-topic", true);
        set(replayer, "--cloud-topic", Some(topic));
        set(replayer, "--heights", Some(&heights.to_string()));
        if let Some(mount) = cloud_mount {
            set(replayer, "--cloud-mount", Some(&mount.to_string()));
        }
    }
    if options.scan_topic.len() > 1 {
        let names = options.scan_topic.iter().map(|topic| name_of(topic));
        lasers::join(dataflow, &names.collect::<Vec<_>>());
    }
    Ok(())
}

/// Applies the heading options; a new source replaces the descriptor's, but not the maximum age of
/// odometry if that is used.
fn forward_heading(
    heading: &HeadingConfig,
    dataflow: &mut Dataflow,
    file: &Path,
) -> anyhow::Result<()> {
    heading.check().map_err(wrong_use)?;
    let option = match heading.source() {
        HeadingSource::Searched => return Ok(()),
        HeadingSource::Fixed(_) => "--heading",
        HeadingSource::Odometry { .. } | HeadingSource::Truth => "--heading-from",
    };
    let node = find(dataflow, &[ACCUMULATOR], option, file)?;
    let number = |number: Option<f64>| number.map(|number| number.to_string());
    let source = heading.heading_from.map(|source| source.to_string());
    let values = [
        ("--heading", number(heading.heading)),
        ("--heading-from", source),
        ("--heading-offset", number(heading.heading_offset)),
        (MAX_AGE, number(heading.heading_max_age_s)),
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

/// True if the graph is played at `--rate max`, so that no data may be lost.
pub(crate) fn plays_at_max(dataflow: &Dataflow) -> bool {
    let mut nodes = dataflow.nodes.iter();
    nodes.any(|n| PLAYERS.contains(&n.executable()) && value(n, "--rate") == Some(MAX_RATE))
}

fn check_wired(node: &Node, source: HeadingFrom, file: &Path) -> anyhow::Result<()> {
    let topic = match source {
        HeadingFrom::Odometry => topic::OdometryTopic::NAME,
        HeadingFrom::Truth => topic::GroundTruthTopic::NAME,
    };
    if node.inputs.iter().any(|input| input.topic == topic) {
        return Ok(());
    }
    let (id, file) = (&node.id, file.display());
    Err(wrong_use(format!(
        "--heading-from needs the input `{topic}` at node {id}, but {file} wires none"
    )))
}

#[cfg(test)]
mod tests;
