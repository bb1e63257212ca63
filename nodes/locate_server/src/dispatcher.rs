//! Where requests arrive: accepts them, passes them on, or rejects them.
//!
//! Zenoh calls on threads of its own, which wait for nothing here: a request that
//! is taken on lies in a queue with an end, for the workers. What each of them
//! costs is bounded before it is looked at.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use crossbeam::channel::{Receiver, Sender, TrySendError, bounded, unbounded};
use zenoh::bytes::Encoding;
use zenoh::query::{Query, Reply};
use zenoh::{Session, Wait};

use crate::LocateError;
use crate::counts::Counts;
use crate::error::REFUSED;
use crate::team::Team;

/// The name of the request's own deadline.
const DEADLINE: &str = "deadline_ms";
/// Longest deadline that a request may name, milliseconds.
const LONGEST_MS: u64 = 60_000;

/// A request that is taken on.
pub(crate) struct Job {
    pub(crate) query: Query,
    /// Under which the answer goes.
    pub(crate) key: Arc<str>,
    /// Whether another server handed it on.
    pub(crate) is_handed_on: bool,
    pub(crate) deadline: Deadline,
}

/// Until when an answer is of use.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Deadline {
    due: Instant,
    allowed: Duration,
}

impl Deadline {
    fn after(allowed: Duration) -> Self {
        let due = Instant::now() + allowed;
        Deadline { due, allowed }
    }

    pub(crate) fn has_passed(&self) -> bool {
        Instant::now() >= self.due
    }

    fn remaining(&self) -> Duration {
        self.due.saturating_duration_since(Instant::now())
    }

    pub(crate) fn late(&self) -> LocateError {
        let deadline_ms = self.allowed.as_millis();
        LocateError::Late { deadline_ms }
    }
}

/// Takes requests, from whichever thread.
pub(crate) struct Dispatcher {
    session: Session,
    /// `backcast/locate/<map>`.
    key: Arc<str>,
    jobs: Sender<Job>,
    returned: Sender<Job>,
    workers: usize,
    /// Requests that wait or are being searched.
    busy: Arc<AtomicUsize>,
    team: Mutex<Team>,
    /// What others have.
    handed_on: Mutex<Vec<Weak<Handed>>>,
    default_deadline: Duration,
    counts: Arc<Counts>,
}

/// What workers need of it.
pub(crate) struct WorkQueue {
    jobs: Receiver<Job>,
    /// What was handed on and came back: as much as was handed on, and no more.
    returned: Receiver<Job>,
    pub(crate) busy: Arc<AtomicUsize>,
}

impl WorkQueue {
    /// The next request, once there is one: first those that have waited elsewhere.
    /// None when the dispatcher is closed.
    pub(crate) fn next(&self) -> Option<Job> {
        let job = crossbeam::channel::select_biased! {
            recv(self.returned) -> job => job,
            recv(self.jobs) -> job => job,
        };
        job.ok()
    }
}

impl Dispatcher {
    /// A dispatcher with `workers`, for each of which `waiting` requests may wait.
    pub(crate) fn new(
        session: &Session,
        key: &str,
        (workers, waiting): (usize, usize),
        default_deadline: Duration,
        counts: &Arc<Counts>,
    ) -> (Arc<Self>, WorkQueue) {
        // Each worker holds one more, which it has taken out.
        let (jobs, taken) = bounded(workers * (waiting + 1));
        let (returned, again) = unbounded();
        let busy = Arc::new(AtomicUsize::new(0));
        let dispatcher = Dispatcher {
            session: session.clone(),
            key: key.into(),
            jobs,
            returned,
            workers,
            busy: Arc::clone(&busy),
            team: Mutex::default(),
            handed_on: Mutex::default(),
            default_deadline,
            counts: Arc::clone(counts),
        };
        let work_queue = WorkQueue {
            jobs: taken,
            returned: again,
            busy,
        };
        (Arc::new(dispatcher), work_queue)
    }

    /// The others, and what they were given.
    pub(crate) fn team(&self) -> MutexGuard<'_, Team> {
        // Whoever held it changes one number at a time, so it is sound.
        self.team.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn handed_on(&self) -> MutexGuard<'_, Vec<Weak<Handed>>> {
        // It is changed by one call at a time, so it is sound.
        let handed_on = self.handed_on.lock();
        handed_on.unwrap_or_else(PoisonError::into_inner)
    }

    /// Another server is gone, and what it has comes back: a request that is sent while
    /// Zenoh forgets that server would be answered, or ended, by nobody.
    pub(crate) fn leave(&self, other: &str) {
        self.team().leave(other);
        let handed_on: Vec<_> = self.handed_on().iter().filter_map(Weak::upgrade).collect();
        for handed in handed_on.iter().filter(|handed| handed.other == other) {
            if let Some(job) = handed.take() {
                self.take_back(job);
            }
        }
    }

    /// A request to all servers: it may be handed on.
    pub(crate) fn ask(self: &Arc<Self>, query: Query) {
        let key = Arc::clone(&self.key);
        if let Some(job) = self.open(query, key, false) {
            let busy = self.busy.load(Ordering::Relaxed);
            let other = self.team().hand_on(busy, self.workers);
            match other {
                Some(other) => self.hand_on(job, other),
                None => self.take_on(job),
            }
        }
    }

    /// A request that another server hands on, under this one's own `key`.
    pub(crate) fn ask_me(&self, query: Query, key: &Arc<str>) {
        if let Some(job) = self.open(query, Arc::clone(key), true) {
            self.take_on(job);
        }
    }

    /// Reads what the request says of its time; refuses it if that is nothing.
    fn open(&self, query: Query, key: Arc<str>, is_handed_on: bool) -> Option<Job> {
        self.counts.received();
        let said = query.parameters().get(DEADLINE).map(str::to_owned);
        match deadline(said.as_deref(), self.default_deadline) {
            Ok(allowed) => Some(Job {
                query,
                key,
                is_handed_on,
                deadline: Deadline::after(allowed),
            }),
            Err(error) => {
                self.counts.refuse(&query, &error);
                None
            }
        }
    }

    fn take_on(&self, job: Job) {
        // Counted before a worker can count it off.
        let busy = self.busy.fetch_add(1, Ordering::Relaxed);
        let (Err(TrySendError::Full(job)) | Err(TrySendError::Disconnected(job))) =
            self.jobs.try_send(job)
        else {
            return;
        };
        self.busy.fetch_sub(1, Ordering::Relaxed);
        let error = LocateError::Busy { waiting: busy };
        self.counts.refuse(&job.query, &error);
    }

    /// Takes back what another server had and did not answer. Sends nothing: where a
    /// server goes, Zenoh drops what waits for it with a lock held that sending takes.
    fn take_back(&self, job: Job) {
        self.busy.fetch_add(1, Ordering::Relaxed);
        // It has room, and workers are there as long as the dispatcher is.
        let _ = self.returned.send(job);
    }

    fn hand_on(self: &Arc<Self>, job: Job, other: String) {
        let remaining = job.deadline.remaining();
        let selector = format!(
            "{}/{other}?{DEADLINE}={}",
            self.key,
            remaining.as_millis().max(1)
        );
        let asking = self
            .session
            .get(selector)
            .encoding(job.query.encoding().cloned().unwrap_or_default())
            .payload(job.query.payload().cloned().unwrap_or_default())
            .timeout(remaining);
        let handed = Arc::new(Handed {
            dispatcher: Arc::clone(self),
            other,
            job: Mutex::new(Some(job)),
        });
        self.handed_on().push(Arc::downgrade(&handed));
        // It may have left before that, and who leaves does so once.
        if !self.team().has(&handed.other) {
            return;
        }
        // Where asking fails, what was handed on is dropped here, and so comes back.
        let _ = asking.callback(move |reply| handed.on_reply(&reply)).wait();
    }
}

/// A request that another server has. Zenoh drops it when no answer can come any
/// more: it was answered, the other is gone, or the time is over.
struct Handed {
    dispatcher: Arc<Dispatcher>,
    other: String,
    job: Mutex<Option<Job>>,
}

impl Handed {
    fn on_reply(&self, reply: &Reply) {
        match reply.result() {
            Ok(sample) => {
                let Some(job) = self.take() else { return };
                let answer = (sample.encoding().clone(), sample.payload().clone());
                let reply = job.query.reply(&*job.key, answer.1).encoding(answer.0);
                self.dispatcher.counts.sent(&reply.wait());
            }
            // What is wrong with a scan is wrong everywhere.
            Err(error) if is_about_the_request(error.encoding()) => {
                let Some(job) = self.take() else { return };
                let answer = (error.encoding().clone(), error.payload().clone());
                let reply = job.query.reply_err(answer.1).encoding(answer.0);
                self.dispatcher.counts.sent(&reply.wait());
            }
            Err(_) => {}
        }
    }

    fn take(&self) -> Option<Job> {
        let job = self.job.lock();
        job.unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl Drop for Handed {
    fn drop(&mut self) {
        self.dispatcher.team().done(&self.other);
        // Among them this one: nobody can reach it any more.
        let is_open = |handed: &Weak<Handed>| handed.strong_count() > 0;
        self.dispatcher.handed_on().retain(is_open);
        if let Some(job) = self.take() {
            self.dispatcher.take_back(job);
        }
    }
}

/// Unlike that the server is busy, or what Zenoh itself says.
fn is_about_the_request(encoding: &Encoding) -> bool {
    encoding.to_string() == REFUSED
}

fn deadline(said: Option<&str>, default: Duration) -> Result<Duration, LocateError> {
    let Some(text) = said else {
        return Ok(default);
    };
    let milliseconds = text.parse().ok();
    let allowed = milliseconds.filter(|ms| (1..=LONGEST_MS).contains(ms));
    allowed
        .map(Duration::from_millis)
        .ok_or_else(|| LocateError::Deadline {
            found: text.chars().take(20).collect(),
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_may_say_until_when() {
        let default = Duration::from_secs(2);
        let check = |said, expected: u64| {
            let found = deadline(said, default).unwrap();
            assert_eq!(found, Duration::from_millis(expected));
        };
        check(None, 2_000);
        check(Some("1"), 1);
        check(Some("60000"), 60_000);
        for text in ["", "0", "-1", "60001", "1.5", "soon"] {
            let error = deadline(Some(text), default).unwrap_err().to_string();
            assert!(error.ends_with("allowed are 1 to 60000"), "{error}");
        }
    }
}
