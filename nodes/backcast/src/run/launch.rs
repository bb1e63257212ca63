//! The course of a run: check, build, start, watch, stop, sum up.

use std::{
    io,
    process::ExitCode,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use dataflow::Dataflow;
use messages::{LogLevel, Topic, topic};
use nix::sys::signal::Signal;
use signal_hook::consts::SIGUSR1;
use transport::{
    Flow, Graph, GraphName, TransportError, log_in_graph, remove_leftovers, with_causes,
};

use super::{
    build,
    console::{LAUNCHER, note, say, warn},
    crew::Crew,
    forward, foxglove,
    journal::Journal,
    lasers,
    options::Config,
    output::{Output, Reader},
    record::{self, RECORDER},
    tracker,
    watch::Watch,
};
use crate::{
    BackcastError,
    cli::LOST_DATA,
    descriptor::{self, Descriptor},
};

/// Between two looks at the processes.
const TICK: Duration = Duration::from_millis(20);
/// Between two looks for what dead processes have left.
const CLEANUP_PERIOD: Duration = Duration::from_secs(1);
/// How long the last scans may go without an answer once the sources are done.
/// A scan takes seconds on a large map and a busy machine.
const LAST_ANSWERS: Duration = Duration::from_secs(20);
/// What a slow reader of our output has left, unless the run ended by itself.
const LAST_OUTPUT: Duration = Duration::from_millis(100);

/// How a run ended in order.
#[derive(Debug)]
struct Course {
    end: End,
    /// Nodes that lost data, by their own account.
    losers: Vec<String>,
}

/// Why a run has ended in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// The sources are done, and so are the answers.
    Finished,
    /// A signal came, or nobody reads the poses any more.
    Interrupted,
}

/// Runs the graph until it ends, or is ended by a signal.
///
/// The exit code is 0, or 3 where the graph played as fast as it answers and
/// something was lost all the same, or a node said so when it was ended. At the
/// pace of the recording a slow machine may drop scans; the summary counts them.
///
/// # Errors
/// Anything that keeps the graph from running as described. Every process has
/// ended then.
pub(crate) fn run(config: &Config) -> Result<ExitCode, BackcastError> {
    transport::node::start_logging().map_err(BackcastError::Logging)?;
    let graph = config.options.graph_name()?;
    let mut descriptor = descriptor::load(&config.dataflow)?;
    forward::apply(&config.options, &mut descriptor.dataflow, &descriptor.file)?;
    lasers::name(&mut descriptor.dataflow);
    tracker::settle(&mut descriptor.dataflow);
    record::add(
        &config.options.record,
        &mut descriptor.dataflow,
        &descriptor.file,
        &descriptor.folder,
    )?;
    if config.options.foxglove {
        foxglove::add(&mut descriptor.dataflow)?;
    }
    build::build_all(&descriptor.dataflow, &descriptor.folder)?;
    remove_leftovers(&graph)?;

    let lossless = forward::plays_at_max(&descriptor.dataflow);
    let output = Output::start(io::stdout())?;
    let is_tracked = has_tracker(&descriptor.dataflow);
    let mut journal = Journal::new(output, config.options.json, is_tracked);
    let outcome = launch(descriptor, &graph, &mut journal);
    let cleared = clear(&graph);
    let finished = outcome
        .as_ref()
        .is_ok_and(|course| course.end == End::Finished);
    let summary_wanted = outcome.is_ok() || journal.report.any_answer();
    let summary = journal.finish(summary_wanted, (!finished).then_some(LAST_OUTPUT));
    // What came first says most.
    let losers = outcome?.losers;
    cleared?;
    let summary = summary?;
    if !losers.is_empty() {
        say(LAUNCHER, &format!("{} lost data", losers.join(", ")));
        return Ok(ExitCode::from(LOST_DATA));
    }
    if finished && lossless && summary.lost_data() {
        say(
            LAUNCHER,
            "data was lost, though nothing may be at `--rate max`",
        );
        return Ok(ExitCode::from(LOST_DATA));
    }
    Ok(ExitCode::SUCCESS)
}

/// Whether anybody sends where the robot is, from scan to scan.
fn has_tracker(dataflow: &Dataflow) -> bool {
    let mut outputs = dataflow.nodes.iter().flat_map(|node| &node.outputs);
    outputs.any(|output| output == topic::Tracked::NAME)
}

/// Joins the graph, starts its processes and stays until the end; all of them
/// have ended when it returns.
fn launch(
    descriptor: Descriptor,
    name: &GraphName,
    journal: &mut Journal,
) -> Result<Course, BackcastError> {
    let graph = Graph::join_named(LAUNCHER, name)?;
    let first_laser = lasers::first(&descriptor.dataflow);
    let watch = Watch::new(&graph, first_laser)?;
    note(&format!("graph {name} is starting; Ctrl-C stops it"));
    journal.begin();
    let mut crew = Crew::new(descriptor.dataflow.nodes, &descriptor.folder, name);
    let save = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(SIGUSR1, Arc::clone(&save)).map_err(BackcastError::Signal)?;
    let end = stay(&graph, (&watch, &save), &mut crew, journal);
    if let Err(error) = &end {
        // The console hears of it when all have ended, a recorder has to before.
        log_in_graph(LogLevel::Error, &with_causes(error));
        graph.send_log();
    }
    let stopped = crew.stop();
    // Nodes that are stopped send a last report on their health.
    let heard = watch.take(journal);
    let end = end?;
    stopped?;
    heard?;
    let losers = crew.losers();
    Ok(Course { end, losers })
}

/// Supervises the crew and enters what is heard, until the end. Recorders are asked
/// to save where `save` is set.
fn stay(
    graph: &Graph,
    (watch, save): (&Watch, &AtomicBool),
    crew: &mut Crew,
    journal: &mut Journal,
) -> Result<End, BackcastError> {
    let mut end = End::Interrupted;
    let mut last_progress = Instant::now();
    let mut last_cleanup = last_progress;
    graph.run(&watch.inputs(), TICK, |_| {
        let now = Instant::now();
        // What a source has sent is heard after its end has been seen.
        let over = crew.is_over();
        let heard = watch.take(journal)?;
        if heard.reader == Reader::Gone {
            return Ok(Flow::Stop);
        }
        if heard.answers || !over {
            last_progress = now;
        }
        let patient = now - last_progress < LAST_ANSWERS;
        if over && (journal.report.all_answered() || !patient) {
            end = End::Finished;
            return Ok(Flow::Stop);
        }
        if save.swap(false, Ordering::Relaxed) && crew.signal(RECORDER, Signal::SIGUSR1)? == 0 {
            warn("SIGUSR1 saves what a recorder keeps, but none runs");
        }
        if crew.tick(now)? || now - last_cleanup >= CLEANUP_PERIOD {
            graph.cleanup_dead_nodes();
            last_cleanup = now;
        }
        Ok::<_, BackcastError>(Flow::Continue)
    })?;
    Ok(end)
}

/// Removes what the graph has left in shared memory. Tools that joined it by
/// its name may still be there; it is theirs then.
fn clear(graph: &GraphName) -> Result<(), TransportError> {
    match remove_leftovers(graph) {
        Err(error @ TransportError::StillRunning { .. }) => {
            say(LAUNCHER, &format!("shared memory is kept: {error}"));
            Ok(())
        }
        other => other,
    }
}
