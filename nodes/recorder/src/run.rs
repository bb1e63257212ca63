//! Receives the messages of the graph and passes them to the writer thread.

mod writer;

use std::process::ExitCode;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use command_line::finished;
use messages::{HealthHeader, NodeState, topic};
use nix::time::{ClockId, clock_gettime};
use ros_graph::export::{Inputs, Listener, Transcript};
use signal_hook::consts::SIGUSR1;
use transport::{Flow, Graph, Input, Subscriber, wall_ns};
use writer::{Status, Writer};

use crate::events::EventDetector;
use crate::writing::Tally;
use crate::{Config, Event, RecorderError};

/// Longest delay of a save signal or a health report.
const TICK: Duration = Duration::from_millis(100);

/// Records until the stop flag is set.
///
/// A disk that fills up later is reported in `health`.
pub fn run(graph: &Graph, config: &Config) -> Result<ExitCode, RecorderError> {
    let inputs = Inputs::open(graph, config.field)?;
    let mut recorder = Recorder::new(graph, config)?;
    recorder.transcript.health.state(NodeState::Ready)?;
    let saves = recorder.saves.clone();
    let saves = saves.as_deref().map(|saves| -> &dyn Input { saves });
    let awaited: Vec<_> = inputs.all().into_iter().chain(saves).collect();
    graph.run(&awaited, TICK, |_| {
        recorder.step(&inputs)?;
        Ok::<_, RecorderError>(Flow::Continue)
    })?;
    // Takes the messages sent before the node was asked to stop.
    recorder.step(&inputs)?;
    recorder.conclude()
}

struct Recorder {
    transcript: Transcript,
    detector: EventDetector,
    save_on: Vec<Event>,
    save: Arc<AtomicBool>,
    /// Requests to save from the graph, with `--keep`.
    saves: Option<Rc<Subscriber<topic::Save>>>,
    writer: Writer,
    status: Status,
}

impl Recorder {
    fn new(graph: &Graph, config: &Config) -> Result<Self, RecorderError> {
        let save = Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(SIGUSR1, Arc::clone(&save)).map_err(RecorderError::Signal)?;
        Ok(Recorder {
            transcript: Transcript::new(graph, &config.transcript)?,
            detector: EventDetector::default(),
            save_on: match config.keep {
                Some(_) => config.save_on.clone(),
                None => Vec::new(),
            },
            save,
            saves: config
                .keep
                .map(|_| graph.subscriber())
                .transpose()?
                .map(Rc::new),
            writer: Writer::start(graph.name().as_str(), config)?,
            status: Status::default(),
        })
    }

    fn step(&mut self, inputs: &Inputs) -> Result<(), RecorderError> {
        inputs.take(self)?;
        // The messages that the request is about have arrived before it.
        self.hand_over()?;
        if let Some(saves) = &self.saves
            && saves.newest()?.is_some()
        {
            self.writer.save("asked by the graph")?;
        }
        if self.save.swap(false, Ordering::Relaxed) {
            self.writer.save("asked by SIGUSR1")?;
        }
        self.report()
    }

    fn report(&mut self) -> Result<(), RecorderError> {
        let status = self.writer.status();
        let written = status.tally.recorded - self.status.tally.recorded;
        let dropped = status.tally.dropped - self.status.tally.dropped;
        let Transcript { health, .. } = &mut self.transcript;
        health.count_sent(written);
        if status.problem != self.status.problem {
            match &status.problem {
                Some(problem) => {
                    tracing::error!("{problem}");
                    health.error(problem)?;
                    health.state(NodeState::Degraded)?;
                }
                None => {
                    tracing::info!(
                        "recording continues; {} messages were lost",
                        status.tally.dropped
                    );
                    health.state(NodeState::Ready)?;
                }
            }
        }
        self.status = status;
        self.transcript.count_dropped(dropped);
        Ok(self.transcript.health.tick()?)
    }

    fn happened(&mut self, event: Option<Event>) -> Result<(), RecorderError> {
        match event.filter(|event| self.save_on.contains(event)) {
            Some(event) => {
                self.hand_over()?;
                self.writer.happened(event)
            }
            None => Ok(()),
        }
    }

    fn hand_over(&mut self) -> Result<(), RecorderError> {
        for entry in self.transcript.entries.take() {
            self.writer.put(entry)?;
        }
        Ok(())
    }

    fn conclude(mut self) -> Result<ExitCode, RecorderError> {
        self.transcript.entries.finish(wall_ns())?;
        self.hand_over()?;
        let status = self.writer.finish()?;
        let Transcript { health, .. } = &mut self.transcript;
        if let Some(problem) = &status.problem {
            tracing::error!("{problem}");
            health.error(problem)?;
        }
        self.transcript
            .count_dropped(status.tally.dropped - self.status.tally.dropped);
        let Tally {
            recorded, files, ..
        } = status.tally;
        let (dropped, refused) = (self.transcript.dropped(), self.transcript.refused());
        let cpu = format!("{:.2} s", cpu_s());
        tracing::info!(recorded, dropped, refused, files, cpu, "recorded");
        Ok(finished(status.problem.is_some() || dropped + refused > 0))
    }
}

impl Listener for Recorder {
    type Error = RecorderError;

    fn transcript(&mut self) -> &mut Transcript {
        &mut self.transcript
    }

    fn reported(&mut self, report: &HealthHeader) -> Result<(), RecorderError> {
        let event = self.detector.health(report);
        self.happened(event)
    }

    fn judged(&mut self, verdict: u32) -> Result<(), RecorderError> {
        let event = self.detector.verdict(verdict);
        self.happened(event)
    }

    fn tracked(&mut self, state: u32) -> Result<(), RecorderError> {
        let event = self.detector.state(state);
        self.happened(event)
    }
}

/// Returns the processor time of all threads so far, seconds.
fn cpu_s() -> f64 {
    // The clock exists on every Linux; without it the time would be NaN.
    let spent = clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID);
    spent.map_or(f64::NAN, |spent| Duration::from(spent).as_secs_f64())
}
