//! Serves clients and plays the recording.

mod pty;
mod tcp;

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use command_line::finished;
use messages::{NodeState, topic};
use ros_graph::replay::{Awaited, Poses};
use transport::{Graph, Health, Subscriber, TransportError, monotonic_ns, with_causes};

use crate::cola_device::Model;
use crate::drive::{Drive, Happening};
use crate::faults::Faults;
use crate::player::Player;
use crate::sweep::Sweep;
use crate::{Config, EmulatorError};

/// Longest time before the stop flag is noticed.
const SLICE: Duration = Duration::from_millis(20);

/// Longest time before an awaited answer is noticed, since an answer does not wake the wait for
/// clients.
const ANSWER_SLICE: Duration = Duration::from_millis(1);

/// Longest wait at the end for clients to read the last scans, nanoseconds.
const TIMEOUT_NS: i64 = 10_000_000_000;

/// Plays the recording until it ends or the stop flag is set.
pub fn run(graph: &Graph, config: &Config) -> Result<ExitCode, EmulatorError> {
    let common = Common::open(graph, config)?;
    match (&config.listen, &config.pty) {
        (Some(address), _) => {
            let model = Model::of(config.model);
            let address = graph.name().resolve(address);
            tcp::run(&address, &model, config.protocol, common)
        }
        (None, Some(link)) => pty::run(link, config.baud, common),
        // The command line excludes this case.
        (None, None) => Ok(ExitCode::SUCCESS),
    }
}

/// State that both kinds of devices need.
struct Common {
    sweep: Sweep,
    player: Player,
    faults: Faults,
    poses: Poses,
    answers: Subscriber<topic::Hypotheses>,
    awaited: Awaited,
    health: Health,
    stop: Arc<AtomicBool>,
    refused: u64,
}

impl Common {
    fn open(graph: &Graph, config: &Config) -> Result<Self, EmulatorError> {
        let mut health = graph.health()?;
        // Reading a long recording takes a while.
        health.state(NodeState::Busy)?;
        let Drive {
            sweep,
            happenings,
            refused,
        } = Drive::open(
            &config.recording,
            config.scan_topic.as_deref(),
            config.odom_topic.as_deref(),
        )?;
        health.state(NodeState::Waiting)?;
        for error in &refused {
            tracing::warn!("{}", with_causes(error));
            health.count_refused(1);
        }
        let (rate, patience_s) = (config.rate, config.patience);
        Ok(Common {
            player: Player::new(happenings, rate, config.looped, patience_s),
            faults: Faults::new(config.fault.clone(), config.seed, monotonic_ns()),
            poses: Poses::open(graph)?,
            answers: graph.subscriber()?,
            awaited: Awaited::new(graph, &config.wait_for)?,
            health,
            stop: graph.stop_flag(),
            refused: refused.len() as u64,
            sweep,
        })
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Returns the time for which the node may wait for clients.
    fn pause(&self) -> Duration {
        let most = match self.player.awaits_answer() {
            true => ANSWER_SLICE,
            false => SLICE,
        };
        let until_ns = self.player.wake_ns().unwrap_or(i64::MAX);
        let left_ns = until_ns.saturating_sub(monotonic_ns()).max(0);
        most.min(Duration::from_nanos(left_ns.unsigned_abs()))
    }

    /// Starts playback for a client that wants scans, once the graph is ready.
    fn start(&mut self) -> Result<(), EmulatorError> {
        if self.awaited.are_ready()? {
            self.player.start();
            self.health.state(NodeState::Ready)?;
        }
        Ok(())
    }

    /// Returns the index of the next scan due at `now_ns`; publishes the messages due before it.
    fn next_scan(&mut self, now_ns: i64) -> Result<Option<usize>, TransportError> {
        while let Some(answer) = self.answers.receive()? {
            self.player.answered(answer.header().stamp.entered_ns);
        }
        while let Some(due) = self.player.take(now_ns) {
            match due {
                &Happening::Scan(index) => return Ok(Some(index)),
                Happening::Odometry(odometry) => self.poses.send_odometry(**odometry)?,
                Happening::GroundTruth(truth) => self.poses.send_truth(**truth)?,
            }
        }
        Ok(None)
    }

    /// Logs the result; returns the exit code.
    fn conclude(&self, is_finished: bool) -> ExitCode {
        let (unanswered, refused) = (self.player.unanswered, self.refused);
        let how = match is_finished {
            true => "has been played",
            false => "was stopped",
        };
        tracing::info!(unanswered, refused, "the recording {how}");
        finished(is_finished && unanswered + refused > 0)
    }
}
