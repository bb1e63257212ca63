//! Event loop: sleeps until there are inputs, ticks or signals.

use std::time::{Duration, Instant};

use iceoryx2::port::listener::{Listener, ListenerWaitError};
use iceoryx2::prelude::{
    CallbackProgression, SignalHandlingMode, WaitSet, WaitSetAttachmentId, WaitSetBuilder,
    WaitSetGuard, ipc,
};

use crate::signals::Signals;
use crate::{Graph, Input, TransportError};

/// Longest sleep; the system call takes milliseconds, which overflow after 24 days.
const LONGEST_SLEEP: Duration = Duration::from_secs(86_400);

/// Decision to continue or end an event loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Wait for the next input or tick.
    Continue,
    /// Return from [`Graph::run`].
    Stop,
}

/// Reason for a call of the event loop. Every call should look at all inputs: a sample without a
/// wake-up, because its publisher was killed between sending and waking, is found at the next tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wake {
    /// True if a tick has passed since the last call with this flag; true in the first call.
    pub tick: bool,
}

impl Graph {
    /// Calls `step` at once, and whenever an input has a sample, a [`crate::Waker`] wakes or a
    /// `tick` has passed, until it returns [`Flow::Stop`] or an error, or the stop flag is set.
    ///
    /// `step` should receive all samples; one left there waits for the next input or tick. Before
    /// each call, the publishers connect with late joiners; after each, log lines are published.
    pub fn run<E: From<TransportError>>(
        &self,
        inputs: &[&dyn Input],
        tick: Duration,
        mut step: impl FnMut(Wake) -> Result<Flow, E>,
    ) -> Result<(), E> {
        let waitset = WaitSetBuilder::new()
            .signal_handling_mode(SignalHandlingMode::Disabled)
            .create::<ipc::Service>()
            .map_err(|error| wait_failed(&error))?;
        let _attached = attach(&waitset, self.signals(), inputs)?;
        let mut ticks = Ticks::new(tick);
        // The first tick is due at once.
        let mut input = false;
        while !self.signals().stopped() {
            let wake = Wake {
                tick: ticks.passed(),
            };
            if input || wake.tick {
                self.publishers().serve_late_joiners()?;
                let flow = step(wake)?;
                self.send_log();
                if flow == Flow::Stop {
                    break;
                }
            }
            wait(&waitset, ticks.remaining())?;
            let woken = self.signals().drain();
            input = take_notifications(inputs)? || woken;
        }
        Ok(())
    }
}

/// Time of the next tick; `None` beyond the range of the clock. Missed ticks are dropped.
struct Ticks {
    period: Duration,
    due: Option<Instant>,
}

impl Ticks {
    fn new(period: Duration) -> Self {
        let due = Some(Instant::now());
        Ticks { period, due }
    }

    fn passed(&mut self) -> bool {
        let now = Instant::now();
        let passed = self.due.is_some_and(|due| now >= due);
        if passed {
            self.due = now.checked_add(self.period);
        }
        passed
    }

    fn remaining(&self) -> Duration {
        let Some(due) = self.due else {
            return LONGEST_SLEEP;
        };
        due.saturating_duration_since(Instant::now())
            .min(LONGEST_SLEEP)
    }
}

type Attached<'w, 'a> = Vec<WaitSetGuard<'w, 'a, ipc::Service>>;

fn attach<'w, 'a>(
    waitset: &'w WaitSet<ipc::Service>,
    signals: &'a Signals,
    inputs: &[&'a dyn Input],
) -> Result<Attached<'w, 'a>, TransportError> {
    let signals = waitset.attach_notification(signals);
    let inputs = inputs
        .iter()
        .map(|input| waitset.attach_notification(input.listener()));
    std::iter::once(signals)
        .chain(inputs)
        .collect::<Result<_, _>>()
        .map_err(|error| wait_failed(&error))
}

fn wait(waitset: &WaitSet<ipc::Service>, timeout: Duration) -> Result<(), TransportError> {
    // Any input may wake, as every call looks at all; a signal is no error either.
    let ignore = |_: WaitSetAttachmentId<ipc::Service>| CallbackProgression::Continue;
    waitset
        .wait_and_process_once_with_timeout(ignore, timeout)
        .map(drop)
        .map_err(|error| wait_failed(&error))
}

/// Clears the notifications before samples are received, so that a later one ends the sleep.
fn take_notifications(inputs: &[&dyn Input]) -> Result<bool, TransportError> {
    let mut any = false;
    for input in inputs {
        if take(input.listener())? {
            any = true;
            // A notification that arrives while iceoryx2 takes another one can be cleared while its
            // mark stays; then later ones would not end the sleep. A second, cheap call removes the
            // mark.
            take(input.listener())?;
        }
    }
    Ok(any)
}

fn take(listener: &Listener<ipc::Service>) -> Result<bool, TransportError> {
    match listener.try_wait(|_| {}) {
        Ok(taken) => Ok(taken > 0),
        Err(ListenerWaitError::InterruptSignal) => Ok(true),
        Err(error) => Err(wait_failed(&error)),
    }
}

fn wait_failed(error: &dyn std::fmt::Debug) -> TransportError {
    TransportError::Wait {
        reason: format!("{error:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_pass_at_once_and_then_each_period() {
        let mut ticks = Ticks::new(Duration::from_secs(3600));
        assert!(ticks.passed());
        assert!(!ticks.passed());
        assert!(ticks.remaining() > Duration::from_secs(3000));
        let mut always = Ticks::new(Duration::ZERO);
        assert!(always.passed() && always.passed());
        assert_eq!(always.remaining(), Duration::ZERO);
        let mut once = Ticks::new(Duration::MAX);
        assert!(once.passed() && !once.passed());
        assert_eq!(once.remaining(), LONGEST_SLEEP);
    }
}
