//! The stages of a run: check, build, start, watch, stop, sum up.

use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};
use std::{io, thread};

use anyhow::Context;
use command_line::{LOST_DATA, wrong_use};
use messages::{LogLevel, NodeState};
use nix::sys::signal::Signal;
use sd_notify::NotifyState;
use signal_hook::consts::SIGUSR1;
use transport::{
    Claim, Flow, Graph, GraphName, Health, TransportError, control_socket, log_in_graph,
    remove_dead_graphs, remove_leftovers, shared_memory_has_room,
};

use super::console::{LAUNCHER, note, say, warn};
use super::control::{self, Answer, Asked, Question, Status};
use super::crew::Crew;
use super::journal::Journal;
use super::log_files::LogFiles;
use super::options::Config;
use super::output::Output;
use super::record::{self, RECORDER};
use super::recording::Recorder;
use super::watch::Watch;
use super::{build, forward, foxglove, lasers, replay, shared, tracker};
use crate::descriptor::{self, Builds, Descriptor};

const TICK: Duration = Duration::from_millis(20);
const CLEANUP_PERIOD: Duration = Duration::from_secs(1);
/// Longest wait for the last answers: on a large map and a busy machine, each takes seconds.
const LAST_ANSWERS: Duration = Duration::from_secs(20);
/// Longest wait for nodes of an earlier launcher to end.
const LAST_OF_BEFORE: Duration = Duration::from_secs(3);
/// Longest wait for a slow reader of our output, unless the run ended by itself.
const LAST_OUTPUT: Duration = Duration::from_millis(100);

#[derive(Debug)]
struct Course {
    end: End,
    nodes_with_data_loss: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// The sources are done and all scans are answered.
    Finished,
    /// By a signal or request, or because the poses are no longer read.
    Interrupted,
}

/// Runs the graph until its end or a signal. The exit code is 3 if a node says that it lost data,
/// or if anything was lost at `--rate max`.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    transport::node::start_logging().map_err(wrong_use)?;
    let graph = config.options.graph_name()?;
    let builds = match config.options.no_build {
        true => Builds::LeaveOut,
        false => Builds::Run,
    };
    let options = &config.options;
    let mut descriptor = descriptor::load(&config.dataflow, builds)?;
    if descriptor.file != config.dataflow {
        let file = descriptor.file.display();
        note(&format!("no graph is named: {file} is run"));
    }
    let Descriptor {
        dataflow,
        file,
        folder,
    } = &mut descriptor;
    forward::apply(options, dataflow, file)?;
    lasers::name(dataflow, folder)?;
    shared::check(dataflow, folder)?;
    tracker::settle(dataflow);
    record::add(&options.record, dataflow, file, folder)?;
    if options.foxglove {
        foxglove::add(dataflow)?;
    }
    build::build_all(dataflow, folder)?;
    let _claim = Claim::take(&graph)?;
    remove_dead_graphs();
    make_way(&graph)?;

    let lossless = forward::plays_at_max(dataflow);
    if lossless {
        replay::keep_in_step(dataflow, LAUNCHER);
    }
    let output = Output::start(io::stdout())?;
    let is_tracked = tracker::has_tracker(dataflow);
    let log_folder = options.log_folder.as_deref();
    let logs = log_folder.map(LogFiles::create).transpose()?;
    let mut journal = Journal::new(output, options.json, is_tracked, logs);
    let outcome = loop {
        let outcome = launch(&descriptor, &graph, &mut journal);
        let error = outcome.as_ref().err().and_then(|e| e.downcast_ref());
        if !matches!(error, Some(TransportError::Vanished { .. })) {
            break outcome;
        }
        // No process of the graph is running any more, so it can start from the beginning.
        if let Err(error) = clear(&graph) {
            break Err(error.into());
        }
        say(LAUNCHER, "the whole graph is restarted");
    };
    let cleared = clear(&graph);
    let course = outcome.as_ref();
    let finished = course.is_ok_and(|course| course.end == End::Finished);
    let summary_wanted = outcome.is_ok() || journal.report.any_answer();
    let summary = journal.finish(summary_wanted, (!finished).then_some(LAST_OUTPUT));
    // The first error says most.
    let nodes_with_data_loss = outcome?.nodes_with_data_loss;
    cleared?;
    let summary = summary?;
    if !nodes_with_data_loss.is_empty() {
        let nodes = nodes_with_data_loss.join(", ");
        say(LAUNCHER, &format!("{nodes} lost data"));
        return Ok(ExitCode::from(LOST_DATA));
    }
    if finished && lossless && summary.lost_data() {
        say(LAUNCHER, "data was lost, which `--rate max` does not allow");
        return Ok(ExitCode::from(LOST_DATA));
    }
    Ok(ExitCode::SUCCESS)
}

fn launch(
    descriptor: &Descriptor,
    name: &GraphName,
    journal: &mut Journal,
) -> anyhow::Result<Course> {
    let graph = Graph::join_named(LAUNCHER, name)?;
    let first_laser = lasers::first(&descriptor.dataflow, &descriptor.folder)?;
    let watch = Watch::new(&graph, first_laser, journal.has_logs())?;
    note(&format!("graph {name} is starting; Ctrl-C stops it"));
    let nodes = descriptor.dataflow.nodes.clone();
    let mut crew = Crew::new(nodes, &descriptor.folder, name)?;
    let mut health = graph.health()?;
    health.state(NodeState::Ready)?;
    let save = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(SIGUSR1, Arc::clone(&save)).context("cannot catch signals")?;
    let control_port = ControlPort {
        questions: control::listen(&control_socket(name), graph.waker()?)?,
        graph: name.clone(),
        descriptor: descriptor.file.clone(),
        recorder: Recorder::of(descriptor),
        started: Instant::now(),
    };
    let asked = (&watch, &*save, &control_port);
    let end = stay(&graph, asked, &mut crew, &mut health, journal);
    if let Err(error) = &end {
        // The console prints the error after all nodes have ended; a recorder needs it before.
        log_in_graph(LogLevel::Error, &format!("{error:#}"));
        graph.send_log();
    }
    // A failed notification is ignored: the service manager sees the process end.
    let _ = sd_notify::notify(&[NotifyState::Stopping]);
    let stopped = crew.stop();
    // Nodes send a last health message when they are stopped.
    let received = watch.take(journal, |_| {});
    let end = end?;
    stopped?;
    received?;
    let nodes_with_data_loss = crew.nodes_with_data_loss();
    Ok(Course {
        end,
        nodes_with_data_loss,
    })
}

/// Supervises the crew until the end; if `save` is set, recorders are asked to save.
fn stay(
    graph: &Graph,
    (watch, save, control_port): (&Watch, &AtomicBool, &ControlPort),
    crew: &mut Crew,
    health: &mut Health,
    journal: &mut Journal,
) -> anyhow::Result<End> {
    let mut end = End::Interrupted;
    let mut last_progress = Instant::now();
    let mut last_cleanup = last_progress;
    let mut reported = Vec::new();
    graph.run(&watch.inputs(), TICK, |_| {
        let now = Instant::now();
        // Checked before receiving: messages of a source may arrive after its end was seen.
        let over = crew.is_over();
        let received = watch.take(journal, |health| crew.received(health, now))?;
        if !journal.output.is_read {
            return Ok(Flow::Stop);
        }
        if received.answers || !over {
            last_progress = now;
        }
        // Lets a player continue that waits for us.
        health.count_received_to(received.taken)?;
        let may_wait = now - last_progress < LAST_ANSWERS;
        if over && (journal.report.all_answered() || !may_wait) {
            end = End::Finished;
            return Ok(Flow::Stop);
        }
        if control_port.answer(crew, now)? == Flow::Stop {
            return Ok(Flow::Stop);
        }
        if save.swap(false, Ordering::Relaxed) && crew.signal(RECORDER, Signal::SIGUSR1)? == 0 {
            warn("SIGUSR1 is for a recorder with --keep, but none is running");
        }
        if crew.tick(now, shared_memory_has_room())? || now - last_cleanup >= CLEANUP_PERIOD {
            graph.ensure_intact()?;
            graph.cleanup_dead_nodes();
            last_cleanup = now;
            // Tells the service manager, if there is one, that we run.
            let at_work = [NotifyState::Ready, NotifyState::Watchdog];
            sd_notify::notify(&at_work).context(
                "cannot notify the service manager: NOTIFY_SOCKET is not one of its sockets",
            )?;
        }
        let problems = crew.problems(now);
        if problems != reported {
            let state = match problems.is_empty() {
                true => {
                    health.forget_error();
                    NodeState::Ready
                }
                false => {
                    health.error(&problems.join("; "))?;
                    NodeState::Degraded
                }
            };
            health.state(state)?;
            reported = problems;
        }
        health.tick()?;
        Ok::<_, anyhow::Error>(Flow::Continue)
    })?;
    Ok(end)
}

struct ControlPort {
    questions: Receiver<Asked>,
    graph: GraphName,
    descriptor: PathBuf,
    recorder: Recorder,
    started: Instant,
}

impl ControlPort {
    /// Answers pending requests; returns `Flow::Stop` if one asked to stop.
    fn answer(&self, crew: &mut Crew, now: Instant) -> anyhow::Result<Flow> {
        let mut flow = Flow::Continue;
        while let Ok(asked) = self.questions.try_recv() {
            let answer = match asked.question {
                Question::Status => Answer::Status(Status {
                    graph: self.graph.to_string(),
                    pid: std::process::id(),
                    descriptor: std::path::absolute(&self.descriptor)
                        .unwrap_or_else(|_| self.descriptor.clone())
                        .display()
                        .to_string(),
                    uptime_s: (now - self.started).as_secs(),
                    given_up: crew.given_up().collect(),
                    recording: self.recorder.status(crew),
                    nodes: crew.status(now),
                }),
                Question::Stop => {
                    note("stopped from another terminal");
                    flow = Flow::Stop;
                    Answer::Done
                }
                Question::Restart { node } => {
                    if crew.restart(&node, now)? {
                        note(&format!("{node} is restarted from another terminal"));
                        Answer::Done
                    } else {
                        Answer::Refused(control::no_node(&node, &crew.status(now)))
                    }
                }
                Question::Record { on } => {
                    let (file, what) = match on {
                        true => (self.recorder.start(crew, now)?, "starts"),
                        false => (self.recorder.stop(crew)?, "stops"),
                    };
                    file.map_or_else(Answer::Refused, |file| {
                        note(&format!("the recording to {file} {what}"));
                        Answer::Record(file)
                    })
                }
            };
            // The client may have hung up.
            let _ = asked.answer.send(answer);
        }
        Ok(flow)
    }
}

/// Removes leftovers of a graph of this name, once nodes of a killed launcher have ended.
fn make_way(graph: &GraphName) -> Result<(), TransportError> {
    let begin = Instant::now();
    loop {
        match remove_leftovers(graph) {
            Err(TransportError::StillRunning { .. }) if begin.elapsed() < LAST_OF_BEFORE => {
                thread::sleep(TICK);
            }
            Err(TransportError::File { path, source, .. })
                if source.kind() == io::ErrorKind::PermissionDenied =>
            {
                return Err(foreign(path, source));
            }
            other => return other,
        }
    }
}

/// Turns an error into one that names the owner of the file, if that is another user.
fn foreign(path: PathBuf, source: io::Error) -> TransportError {
    let user = nix::unistd::geteuid().as_raw();
    match path.symlink_metadata() {
        Ok(found) if found.uid() != user => TransportError::ForeignFile {
            owner: found.uid(),
            path,
            user,
        },
        _ => TransportError::File {
            action: "remove",
            path,
            source,
        },
    }
}

/// Removes the graph from shared memory, unless tools that joined it are still running.
fn clear(graph: &GraphName) -> Result<(), TransportError> {
    match remove_leftovers(graph) {
        Err(error @ TransportError::StillRunning { .. }) => {
            say(LAUNCHER, &format!("cannot remove shared memory: {error}"));
            Ok(())
        }
        other => other,
    }
}
