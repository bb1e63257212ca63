//! Plays a recording through a separate graph and collects the results.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use geometry::Pose;
use launcher::descriptor::Descriptor;
use launcher::run::arguments::{MAP_SERVER, add_to_list, find, leave_out_monitors, set, unset};
use launcher::run::crew::Crew;
use launcher::run::{replay, tracker};
use messages::{HypothesesHeader, Hypothesis, PoseHeader, VotesHeader, topic};
use recording::{Kind, Recording};
use transport::{
    Flow, Graph, GraphName, Subscriber, TransportError, remove_leftovers, shared_memory_has_room,
};

use super::answer::Answer;
use super::case::Case;

const NAME: &str = "regress";
/// Interval between checks of the processes.
const TICK: Duration = Duration::from_millis(20);
/// Longest wait for the last results after the source has ended.
const TIMEOUT: Duration = Duration::from_secs(20);

/// Configures the graph to replay this recording on its map, as fast as it can process it.
pub(super) fn direct(descriptor: &mut Descriptor, case: &Case) -> anyhow::Result<()> {
    let Descriptor { dataflow, file, .. } = descriptor;
    leave_out_monitors(dataflow);
    let replayer = replay::play(dataflow, &[case.recording()]);
    set(replayer, "--rate", Some("max"));
    add_to_list(replayer, "--in-step", NAME);
    unset(replayer, "--loop", false);
    let server = find(dataflow, &[MAP_SERVER], "the map", file)?;
    for option in ["--map", "--maps", "--on", "--recorded", "--played"] {
        unset(server, option, true);
    }
    let (option, file) = match case.map()? {
        Some(map) => ("--map", map),
        None => ("--recorded", case.recording()),
    };
    set(server, option, Some(&file.to_string_lossy()));
    tracker::settle(dataflow);
    for node in &mut dataflow.nodes {
        // Logs problems only; results are in the table.
        node.env
            .insert(0, ("RUST_LOG".to_owned(), "warn".to_owned()));
    }
    Ok(())
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Played {
    /// Results of all scans, in order of arrival.
    pub(super) answers: Vec<Answer>,
    /// True if the graph has a tracker.
    pub(super) is_tracked: bool,
    /// True poses of the laser, by the stamps of their scans.
    pub(super) truths: BTreeMap<i64, Pose>,
    /// Damage that ended the replay early.
    pub(super) damage: Option<String>,
}

pub(super) fn play(
    descriptor: Descriptor,
    name: &GraphName,
    recording: &Path,
) -> anyhow::Result<Played> {
    let (scans, truths, damage) = look_at(recording)?;
    let is_tracked = tracker::has_tracker(&descriptor.dataflow);
    remove_leftovers(name)?;
    let outcome = collect(descriptor, name, (scans, is_tracked));
    let cleared = remove_leftovers(name);
    let answers = outcome?;
    cleared?;
    match answers.len() == scans {
        true => Ok(Played {
            answers,
            is_tracked,
            truths,
            damage,
        }),
        false => Err(anyhow!(
            "{}: {} of {scans} scans were answered; see the graph's log",
            recording.display(),
            answers.len()
        )),
    }
}

/// Returns the number of scans, the true poses, and the damage if any.
fn look_at(path: &Path) -> anyhow::Result<(usize, BTreeMap<i64, Pose>, Option<String>)> {
    let recording = Recording::open(path)?;
    let topic = recording.required_topic(Kind::Scan)?;
    let of_topic = recording.channels().filter(|it| it.topic == topic);
    let scans = of_topic.map(|channel| channel.messages as usize).sum();
    let truths = recording.ground_truths()?.into_iter();
    let truths = truths.map(|(stamp_ns, truth)| (stamp_ns, truth.pose));
    let damage = recording.damage_error().map(|error| error.to_string());
    Ok((scans, truths.collect(), damage))
}

fn collect(
    descriptor: Descriptor,
    name: &GraphName,
    (scans, is_tracked): (usize, bool),
) -> anyhow::Result<Vec<Answer>> {
    let graph = Graph::join_named(NAME, name)?;
    let votes = graph.subscriber::<topic::Votes>()?;
    let hypotheses = graph.subscriber::<topic::Hypotheses>()?;
    let poses = graph.subscriber::<topic::Tracked>()?;
    let reports = graph.subscriber::<topic::Health>()?;
    // The player waits for the scans that this process has counted.
    let mut health = graph.health()?;
    let mut received = Received {
        is_tracked,
        ..Received::default()
    };
    let mut crew = Crew::new(descriptor.dataflow.nodes, &descriptor.folder, name)?;
    let mut last_progress = Instant::now();
    let outcome = graph.run(&[&votes, &hypotheses, &poses], TICK, |_| {
        let now = Instant::now();
        let over = crew.is_over();
        if received.take(&votes, &hypotheses, &poses)? || !over {
            last_progress = now;
        }
        if received.is_complete(scans) || over && now - last_progress >= TIMEOUT {
            return Ok(Flow::Stop);
        }
        health.count_received_to(received.taken())?;
        health.tick()?;
        while let Some(report) = reports.receive()? {
            crew.received(report.header(), now);
        }
        crew.tick(now, shared_memory_has_room())?;
        Ok::<_, anyhow::Error>(Flow::Continue)
    });
    let stopped = crew.stop();
    outcome?;
    stopped?;
    Ok(received.answers())
}

#[derive(Default)]
struct Received {
    is_tracked: bool,
    /// Poses of the tracker that are from scans.
    poses: Vec<PoseHeader>,
    votes: Vec<VotesHeader>,
    hypotheses: Vec<(HypothesesHeader, Vec<Hypothesis>)>,
}

impl Received {
    /// Receives all waiting messages; true if there were any.
    fn take(
        &mut self,
        votes: &Subscriber<topic::Votes>,
        hypotheses: &Subscriber<topic::Hypotheses>,
        poses: &Subscriber<topic::Tracked>,
    ) -> Result<bool, TransportError> {
        let before = self.messages();
        while let Some(sample) = votes.receive()? {
            self.votes.push(*sample.header());
        }
        while let Some(sample) = hypotheses.receive()? {
            let answer = (*sample.header(), sample.items().to_vec());
            self.hypotheses.push(answer);
        }
        while let Some(sample) = poses.receive()? {
            if sample.header().from_scan == 1 {
                self.poses.push(*sample.header());
            }
        }
        Ok(self.messages() > before)
    }

    /// Number of scans with results, as the player counts them.
    fn taken(&self) -> u64 {
        let last = self.hypotheses.last();
        last.map_or(0, |(header, _)| header.stamp.counter + 1)
    }

    fn messages(&self) -> usize {
        self.votes.len() + self.hypotheses.len() + self.poses.len()
    }

    fn is_complete(&self, scans: usize) -> bool {
        let is_tracked = !self.is_tracked || self.poses.len() >= scans;
        self.votes.len() >= scans && self.hypotheses.len() >= scans && is_tracked
    }

    /// Joins votes, hypotheses and the tracker's pose of each scan.
    fn answers(&self) -> Vec<Answer> {
        let of = |(header, items): &(HypothesesHeader, Vec<Hypothesis>)| {
            let mut votes = self.votes.iter();
            let votes = votes.find(|votes| votes.stamp.is_of(header.stamp))?;
            let mut poses = self.poses.iter();
            let pose = poses.find(|pose| pose.stamp.is_of(header.stamp));
            Some(Answer::of(votes, header, items, pose))
        };
        self.hypotheses.iter().filter_map(of).collect()
    }
}
