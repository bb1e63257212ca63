//! Accepts, forwards or rejects requests. Zenoh calls it on its own threads, which never block
//! here; the cost of each request is bounded before it is parsed.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use crossbeam::channel::{Receiver, Sender, TrySendError, bounded, unbounded};
use messages::topic;
use network_payload::Wire;
use zenoh::bytes::Encoding;
use zenoh::query::{Query, Reply};
use zenoh::{Session, Wait};
use zenoh_session::{ENVELOPE_BYTES, message_bytes};

use crate::LocateError;
use crate::counts::Counts;
use crate::error::REFUSED;
use crate::team::Team;

const DEADLINE: &str = "deadline_ms";
const LONGEST_MS: u64 = 60_000;

pub(crate) struct Job {
    pub(crate) query: Query,
    pub(crate) key: Arc<str>,
    /// True if another server forwarded the request.
    pub(crate) is_handed_on: bool,
    pub(crate) deadline: Deadline,
}

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

pub(crate) struct Dispatcher {
    session: Session,
    /// `backcast/locate/<map>`.
    key: Arc<str>,
    jobs: Sender<Job>,
    returned: Sender<Job>,
    workers: usize,
    busy: Arc<AtomicUsize>,
    team: Mutex<Team>,
    handed_on: Mutex<Vec<Weak<Handed>>>,
    default_deadline: Duration,
    counts: Arc<Counts>,
}

/// Consumer end of the dispatcher, shared by the workers.
pub(crate) struct WorkQueue {
    jobs: Receiver<Job>,
    /// Forwarded requests that came back; bounded by the number forwarded.
    returned: Receiver<Job>,
    pub(crate) busy: Arc<AtomicUsize>,
}

impl WorkQueue {
    /// Waits for the next request, first those that came back; `None` when closed.
    pub(crate) fn next(&self) -> Option<Job> {
        let job = crossbeam::channel::select_biased! {
            recv(self.returned) -> job => job,
            recv(self.jobs) -> job => job,
        };
        job.ok()
    }
}

impl Dispatcher {
    pub(crate) fn new(
        session: &Session,
        key: &str,
        (workers, waiting): (usize, usize),
        default_deadline: Duration,
        counts: &Arc<Counts>,
    ) -> (Arc<Self>, WorkQueue) {
        // Each worker also holds one request that it has taken from the queue.
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

    pub(crate) fn team(&self) -> MutexGuard<'_, Team> {
        // A panic cannot leave it inconsistent: each change is a single number.
        self.team.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn handed_on(&self) -> MutexGuard<'_, Vec<Weak<Handed>>> {
        // A panic cannot leave it inconsistent: each change is a single call.
        let handed_on = self.handed_on.lock();
        handed_on.unwrap_or_else(PoisonError::into_inner)
    }

    /// Removes a gone server and takes back its requests, which Zenoh may never end.
    pub(crate) fn leave(&self, other: &str) {
        self.team().leave(other);
        let handed_on: Vec<_> = self.handed_on().iter().filter_map(Weak::upgrade).collect();
        for handed in handed_on.iter().filter(|handed| handed.other == other) {
            if let Some(job) = handed.take() {
                self.take_back(job);
            }
        }
    }

    /// Processes a request to all servers, which may be forwarded.
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

    /// Processes a request that another server forwarded to this server's own `key`.
    pub(crate) fn ask_me(&self, query: Query, key: &Arc<str>) {
        if let Some(job) = self.open(query, Arc::clone(key), true) {
            self.take_on(job);
        }
    }

    /// Reads the deadline of a request; refuses an invalid or too long one.
    fn open(&self, query: Query, key: Arc<str>, is_handed_on: bool) -> Option<Job> {
        self.counts.received();
        let said = query.parameters().get(DEADLINE).map(str::to_owned);
        let allowed =
            ensure_short(&query).and_then(|()| deadline(said.as_deref(), self.default_deadline));
        match allowed {
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
        // Counted first, so that a worker cannot count it down before.
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

    /// Queues a request again that another server did not answer. Must not send: when a server
    /// disappears, Zenoh drops its pending requests while holding a lock that sending needs.
    fn take_back(&self, job: Job) {
        self.busy.fetch_add(1, Ordering::Relaxed);
        // The channel is unbounded, and the workers live as long as the dispatcher.
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
        // The server may have left before this entry was added, which is reported only once.
        if !self.team().has(&handed.other) {
            return;
        }
        // If sending fails, `handed` is dropped here and the request comes back.
        let _ = asking.callback(move |reply| handed.on_reply(&reply)).wait();
    }
}

/// Request forwarded to another server; Zenoh drops it when no answer can come any more.
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
            // An invalid scan is invalid for every server.
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
        // Removes this entry, too: its strong count is zero.
        let is_open = |handed: &Weak<Handed>| handed.strong_count() > 0;
        self.dispatcher.handed_on().retain(is_open);
        if let Some(job) = self.take() {
            self.dispatcher.take_back(job);
        }
    }
}

fn is_about_the_request(encoding: &Encoding) -> bool {
    encoding.to_string() == REFUSED
}

fn ensure_short(query: &Query) -> Result<(), LocateError> {
    let parts = [query.payload(), query.attachment()];
    let found = message_bytes(query.encoding(), parts) + query.parameters().as_str().len();
    let most = topic::Scan::MAX_BYTES;
    if found <= most + ENVELOPE_BYTES {
        return Ok(());
    }
    Err(LocateError::TooLong { found, most })
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
