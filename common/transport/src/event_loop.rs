//! Waiting for inputs, ticks and signals.
//!
//! The process sleeps until there is something to do; it never polls faster
//! than its tick. What it does then is the node's business.

use std::time::{Duration, Instant};

use iceoryx2::port::listener::{Listener, ListenerWaitError};
use iceoryx2::prelude::{
    CallbackProgression, SignalHandlingMode, WaitSet, WaitSetAttachmentId, WaitSetBuilder,
    WaitSetGuard, ipc,
};

use crate::signals::Signals;
use crate::{Graph, Input, TransportError};

/// The system counts a sleep in milliseconds that end after 24 days. Waking once
/// a day for nothing costs nothing.
const LONGEST_SLEEP: Duration = Duration::from_secs(86_400);

/// Whether an event loop continues.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Wait for the next input or tick.
    Continue,
    /// Return from [`Graph::run`].
    Stop,
}

/// What a call of the event loop is about. Every call is to look at all inputs:
/// an input that nobody announced, because its publisher was killed between
/// sending and waking, is found with the next tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wake {
    /// A tick has passed since the last call in which this was set; set in the
    /// first call.
    pub tick: bool,
}

impl Graph {
    /// Calls `step` at once, then whenever one of `inputs` has something, a
    /// [`crate::Waker`] wakes or a `tick` has passed, until it returns
    /// [`Flow::Stop`] or an error, or until the stop flag is set. In between it
    /// sleeps, unless `tick` is zero.
    ///
    /// `step` is to take all samples that its subscribers have; one left there
    /// waits for the next input or tick. A signal ends the sleep at once; a flag
    /// that the program sets itself is seen with the next input or tick. Before
    /// each call, the publishers of this graph connect with late joiners, who thus
    /// wait for a latched sample a tick at most, or as long as `step` takes. What
    /// the process logs is sent after each call.
    ///
    /// # Errors
    /// What `step` returns, and [`TransportError`] if waiting or serving fails.
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

/// When the next tick is due: never, if that is beyond what the clock can say.
/// A tick that comes late is not made up for.
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
    // Which one woke does not matter, since every call looks at all inputs. An
    // interrupt by a signal is no error either.
    let ignore = |_: WaitSetAttachmentId<ipc::Service>| CallbackProgression::Continue;
    waitset
        .wait_and_process_once_with_timeout(ignore, timeout)
        .map(drop)
        .map_err(|error| wait_failed(&error))
}

/// Takes the notifications, before the samples are looked at: one that comes
/// later stays, and ends the next sleep.
fn take_notifications(inputs: &[&dyn Input]) -> Result<bool, TransportError> {
    let mut any = false;
    for input in inputs {
        if take(input.listener())? {
            any = true;
            // A notification that arrives while iceoryx2 takes another one can
            // be taken along while its mark stays, and later ones would then
            // not end the sleep. Taking again, which is cheap, removes the mark.
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
