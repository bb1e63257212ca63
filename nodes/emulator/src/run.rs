//! Serves clients and looks at the clock.

mod pty;
mod tcp;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use messages::NodeState;
use transport::{Graph, Health, monotonic_ns};

use crate::faults::Faults;
use crate::player::Player;
use crate::sweep::Sweep;
use crate::{Config, EmulatorError};

/// How long the stop flag may go unseen.
const SLICE: Duration = Duration::from_millis(20);

/// How long the end waits for clients to take the last scans, nanoseconds.
const PATIENCE_NS: i64 = 10_000_000_000;

/// Plays the recording until it ends or the stop flag is set.
///
/// # Errors
/// If the graph fails, the recording cannot be played as this device, or the
/// socket or pseudo-terminal cannot be had.
pub fn run(graph: &Graph, config: &Config) -> Result<(), EmulatorError> {
    let sweep = Sweep::open(&config.recording)?;
    let common = Common {
        player: Player::new(&sweep.times_ns, config.rate.0, config.looped),
        faults: Faults::new(config.fault.clone(), config.seed, monotonic_ns()),
        health: graph.health()?,
        stop: graph.stop_flag(),
        sweep,
    };
    match (&config.listen, &config.pty) {
        (Some(address), _) => tcp::run(address, config.protocol, common),
        (None, Some(link)) => pty::run(link, config.baud, common),
        // The command line allows nothing else.
        (None, None) => Ok(()),
    }
}

/// What both devices need.
struct Common {
    sweep: Sweep,
    player: Player,
    faults: Faults,
    health: Health,
    stop: Arc<AtomicBool>,
}

impl Common {
    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// How long there is nothing to do but to listen.
    fn pause(&self) -> Duration {
        let until_ns = self.player.due_ns().unwrap_or(i64::MAX);
        let left_ns = until_ns.saturating_sub(monotonic_ns()).max(0);
        SLICE.min(Duration::from_nanos(left_ns.unsigned_abs()))
    }

    /// Somebody wants scans: the recording begins.
    fn start(&mut self) -> Result<(), EmulatorError> {
        self.player.start(monotonic_ns());
        self.health.state(NodeState::Ready)?;
        Ok(())
    }
}
