//! Receives what flows in the graph and hands it to the thread that writes.

mod inputs;
mod writer;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use messages::NodeState;
use nix::time::{ClockId, clock_gettime};
use signal_hook::consts::SIGUSR1;
use transport::{Flow, Graph, Health, monotonic_ns, wall_ns, with_causes};

use crate::entries::Entries;
use crate::events::Lookout;
use crate::{Config, Event, RecorderError};
use inputs::Inputs;
use writer::{Status, Writer};

/// How long a signal to save and a report of health may be overdue.
const TICK: Duration = Duration::from_millis(100);

/// What a run did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Summary {
    /// Messages recorded, or looked at by a black box.
    pub recorded: u64,
    /// Samples and messages that were lost on the way.
    pub dropped: u64,
    /// Samples that could not be used.
    pub refused: u64,
    /// Files written.
    pub files: u64,
    /// Whether something could not be written in the end.
    pub failed: bool,
}

impl Summary {
    /// Whether something is missing in the recording.
    #[must_use]
    pub fn lost_data(&self) -> bool {
        self.failed || self.dropped + self.refused > 0
    }
}

/// Records until the stop flag is set.
///
/// # Errors
/// If the file cannot be created, or the graph fails. A disk that is full later
/// is reported in `health`.
pub fn run(graph: &Graph, config: &Config) -> Result<Summary, RecorderError> {
    let inputs = Inputs::open(graph, config.field, config.keep.is_some())?;
    let mut recorder = Recorder::new(graph, config)?;
    recorder.health.state(NodeState::Ready)?;
    graph.run(&inputs.all(), TICK, |_| {
        recorder.step(&inputs)?;
        Ok::<_, RecorderError>(Flow::Continue)
    })?;
    // What was sent before the node was asked to end.
    recorder.step(&inputs)?;
    recorder.conclude()
}

struct Recorder {
    entries: Entries,
    lookout: Lookout,
    save_on: Vec<Event>,
    save: Arc<AtomicBool>,
    writer: Writer,
    health: Health,
    summary: Summary,
    /// What the writer said last.
    status: Status,
    last_refusal: String,
}

impl Recorder {
    fn new(graph: &Graph, config: &Config) -> Result<Self, RecorderError> {
        let save = Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(SIGUSR1, Arc::clone(&save)).map_err(RecorderError::Signal)?;
        Ok(Recorder {
            entries: Entries::new(&config.map_frame, &config.base_frame),
            lookout: Lookout::default(),
            save_on: match config.keep {
                Some(_) => config.save_on.clone(),
                None => Vec::new(),
            },
            save,
            writer: Writer::start(graph.name().as_str(), config)?,
            health: graph.health()?,
            summary: Summary::default(),
            status: Status::default(),
            last_refusal: String::new(),
        })
    }

    fn step(&mut self, inputs: &Inputs) -> Result<(), RecorderError> {
        inputs.take(self)?;
        for entry in self.entries.take() {
            self.writer.put(entry)?;
        }
        if self.save.swap(false, Ordering::Relaxed) {
            self.writer.save("asked by SIGUSR1")?;
        }
        self.report()
    }

    /// Tells the graph how the writer fares.
    fn report(&mut self) -> Result<(), RecorderError> {
        let status = self.writer.status();
        let written = status.tally.recorded - self.status.tally.recorded;
        let dropped = status.tally.dropped - self.status.tally.dropped;
        self.health.count_sent(written);
        self.count_dropped(dropped);
        if status.problem != self.status.problem {
            match &status.problem {
                Some(problem) => {
                    tracing::error!("{problem}");
                    self.health.error(problem)?;
                    self.health.state(NodeState::Degraded)?;
                }
                None => {
                    tracing::info!(
                        "recording goes on; {} messages were lost",
                        status.tally.dropped
                    );
                    self.health.state(NodeState::Ready)?;
                }
            }
        }
        self.status = status;
        self.health.tick()?;
        Ok(())
    }

    fn count_dropped(&mut self, samples: u64) {
        self.summary.dropped += samples;
        self.health.count_dropped(samples);
    }

    /// A sample came, after others that were lost; it could be used, or not.
    fn taken(
        &mut self,
        lost: u64,
        outcome: Result<(), RecorderError>,
    ) -> Result<(), RecorderError> {
        self.health.count_received(1);
        if lost > 0 {
            tracing::warn!("{lost} samples were lost: the recorder was too slow");
            self.count_dropped(lost);
        }
        let Err(error) = outcome else {
            return Ok(());
        };
        self.summary.refused += 1;
        self.health.count_refused(1);
        let problem = with_causes(&error);
        if problem != self.last_refusal {
            tracing::warn!("{problem}");
            self.health.error(&problem)?;
            self.last_refusal = problem;
        }
        Ok(())
    }

    fn happened(&mut self, event: Option<Event>) -> Result<(), RecorderError> {
        match event.filter(|event| self.save_on.contains(event)) {
            Some(event) => self.save(&event.to_string()),
            None => Ok(()),
        }
    }

    /// Saves what is kept, and all that came before.
    fn save(&mut self, why: &str) -> Result<(), RecorderError> {
        for entry in self.entries.take() {
            self.writer.put(entry)?;
        }
        self.writer.save(why)
    }

    fn conclude(mut self) -> Result<Summary, RecorderError> {
        self.entries.finish(wall_ns())?;
        for entry in self.entries.take() {
            self.writer.put(entry)?;
        }
        let status = self.writer.finish()?;
        let dropped = status.tally.dropped - self.status.tally.dropped;
        self.health.count_dropped(dropped);
        let summary = Summary {
            recorded: status.tally.recorded,
            files: status.tally.files,
            dropped: self.summary.dropped + dropped,
            failed: status.problem.is_some(),
            ..self.summary
        };
        if let Some(problem) = &status.problem {
            tracing::error!("{problem}");
            self.health.error(problem)?;
        }
        let Summary {
            recorded,
            dropped,
            refused,
            files,
            ..
        } = summary;
        let cpu = format!("{:.2} s", cpu_s());
        tracing::info!(recorded, dropped, refused, files, cpu, "recorded");
        Ok(summary)
    }

    fn now_ns() -> i64 {
        monotonic_ns()
    }
}

/// Processor time of all threads until now, seconds.
fn cpu_s() -> f64 {
    // The clock exists on every Linux; where it did not, nothing would be said.
    let spent = clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID);
    spent.map_or(f64::NAN, |spent| Duration::from(spent).as_secs_f64())
}
