//! Counters that many threads update and one reports.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use transport::{Health, TransportError, with_causes};
use zenoh::query::Query;
use zenoh::{Result as ZenohResult, Wait};

use crate::LocateError;

#[derive(Debug, Default)]
pub(crate) struct Counts {
    received: AtomicU64,
    sent: AtomicU64,
    busy: AtomicU64,
    refused: AtomicU64,
    problem: Mutex<Option<String>>,
}

impl Counts {
    pub(crate) fn received(&self) {
        self.received.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts an answer as sent, or as dropped if the client no longer waits.
    pub(crate) fn sent(&self, outcome: &ZenohResult<()>) {
        let counter = match outcome {
            Ok(()) => &self.sent,
            Err(_) => &self.busy,
        };
        counter.fetch_add(1, Ordering::Relaxed);
    }

    pub(crate) fn refuse(&self, query: &Query, error: &LocateError) {
        self.refuse_as(query, error, error.encoding());
    }

    /// Does the same with this encoding of the reply.
    pub(crate) fn refuse_as(&self, query: &Query, error: &LocateError, encoding: &str) {
        let says = with_causes(error);
        // The reply may fail: a client that no longer waits does not need it.
        let _ = query.reply_err(says.as_str()).encoding(encoding).wait();
        if matches!(error, LocateError::Busy { .. } | LocateError::Late { .. }) {
            self.busy.fetch_add(1, Ordering::Relaxed);
        } else {
            self.refused.fetch_add(1, Ordering::Relaxed);
        }
        self.note(says);
    }

    fn note(&self, says: String) {
        let problem = self.problem.lock();
        *problem.unwrap_or_else(PoisonError::into_inner) = Some(says);
    }

    /// Adds the counts to a health report; requests that found no worker in time count as dropped.
    pub(crate) fn report(&self, health: &mut Health) -> Result<(), TransportError> {
        let take = |counter: &AtomicU64| counter.swap(0, Ordering::Relaxed);
        health.count_received(take(&self.received));
        health.count_sent(take(&self.sent));
        health.count_dropped(take(&self.busy));
        health.count_refused(take(&self.refused));
        let problem = self.problem.lock();
        let problem = problem.unwrap_or_else(PoisonError::into_inner).take();
        if let Some(problem) = problem {
            tracing::warn!("{problem}");
            health.error(&problem)?;
        }
        health.tick()
    }
}
