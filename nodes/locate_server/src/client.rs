//! Asking, for programs in Rust.

use std::time::{Duration, Instant};

use crossbeam::channel::{Sender, unbounded};
use messages::{ScanHeader, topic};
use network_payload::{Preamble, Received};
use transport::monotonic_ns;
use zenoh::bytes::Encoding;
use zenoh::query::ReplyError;
use zenoh::sample::Sample;
use zenoh::{Session, Wait};
use zenoh_session::KeyError;

use crate::LocateError;
use crate::error::REFUSED;

/// Between two attempts, where nobody answers or all are busy.
const PAUSE: Duration = Duration::from_millis(20);

/// How long an attempt may say nothing before another one is made beside it; each that
/// is under way doubles it, so that slow servers are not asked again and again.
///
/// Zenoh ends what a server has been asked when that server goes, all but what is sent
/// while it is being forgotten: nobody ends that. So it must not take the whole deadline.
const SILENCE: Duration = Duration::from_secs(1);

/// Asks whoever answers for the map of this name where a scan was taken, again and
/// again until the deadline: a server that dies meanwhile costs no answer.
///
/// # Errors
/// [`LocateError::Late`] if there was no answer in time, [`LocateError::Refused`]
/// if a server says that there never will be one, or if the scan or an answer is
/// not sound.
pub fn ask(
    session: &Session,
    map: &str,
    (header, ranges): (&ScanHeader, &[f32]),
    deadline: Duration,
) -> Result<Received<topic::Hypotheses>, LocateError> {
    let encoding = network_payload::encoding::<topic::Scan>();
    let question = Question::new(session, (header, ranges), &encoding)?;
    let (encoding, payload) = ask_bytes(session, map, &question, deadline)?;
    let mut answer = network_payload::decode::<topic::Hypotheses>(&encoding, &payload)?;
    answer.rebase(monotonic_ns());
    Ok(answer)
}

/// A scan as bytes, and what they say of themselves.
struct Question {
    encoding: String,
    payload: Vec<u8>,
}

impl Question {
    fn new(
        session: &Session,
        (header, ranges): (&ScanHeader, &[f32]),
        encoding: &str,
    ) -> Result<Self, LocateError> {
        let preamble = Preamble {
            sender: u64::from_le_bytes(first_bytes(&session.zid().to_le_bytes())),
            sequence: header.stamp.counter,
            clock_ns: monotonic_ns(),
        };
        Ok(Question {
            encoding: encoding.to_owned(),
            payload: network_payload::encode::<topic::Scan>(&preamble, header, ranges)?,
        })
    }
}

/// The answer to a question as bytes, and what they say of themselves.
fn ask_bytes(
    session: &Session,
    map: &str,
    question: &Question,
    deadline: Duration,
) -> Result<(String, Vec<u8>), LocateError> {
    let due = Instant::now() + deadline;
    let (events, received) = unbounded();
    // How many attempts are under way, and when to make the next one.
    let (mut open, mut next) = (0, Instant::now());
    loop {
        let now = Instant::now();
        if now >= due {
            let deadline_ms = deadline.as_millis();
            return Err(LocateError::Late { deadline_ms });
        }
        if now >= next {
            attempt(session, map, question, due - now, events.clone())?;
            // No deadline is so far that this overflows.
            (open, next) = (open + 1, now + SILENCE * 2_u32.pow(open));
        }
        let Ok(event) = received.recv_deadline(next.min(due)) else {
            continue;
        };
        match event {
            Some(Ok(sample)) => {
                let payload = sample.payload().to_bytes().into_owned();
                return Ok((sample.encoding().to_string(), payload));
            }
            Some(Err(error)) => refusal(&error).map_or(Ok(()), Err)?,
            None => {
                open -= 1;
                next = next.min(Instant::now() + PAUSE);
            }
        }
    }
}

/// What an attempt receives; None, at last, when nobody will answer any more.
type Event = Option<Result<Sample, ReplyError>>;

/// An attempt under way, until Zenoh drops it.
struct Attempt(Sender<Event>);

impl Attempt {
    fn deliver(&self, event: Event) {
        // Where nobody listens, the request has its answer.
        let _ = self.0.send(event);
    }
}

impl Drop for Attempt {
    fn drop(&mut self) {
        self.deliver(None);
    }
}

/// Asks once; what comes of it goes to `events`.
fn attempt(
    session: &Session,
    map: &str,
    question: &Question,
    remaining: Duration,
    events: Sender<Event>,
) -> Result<(), LocateError> {
    let key = network_payload::locate(map);
    let milliseconds = remaining.as_millis().clamp(1, 60_000);
    let attempt = Attempt(events);
    session
        .get(format!("{key}?deadline_ms={milliseconds}"))
        .payload(question.payload.as_slice())
        .encoding(Encoding::from(question.encoding.as_str()))
        .timeout(remaining)
        .callback(move |reply| attempt.deliver(Some(reply.into_result())))
        .wait()
        .map_err(KeyError::when("ask", &key))?;
    Ok(())
}

/// Why asking again does not help, if it does not.
fn refusal(error: &ReplyError) -> Option<LocateError> {
    (error.encoding().to_string() == REFUSED).then(|| LocateError::Refused {
        says: String::from_utf8_lossy(&error.payload().to_bytes()).into_owned(),
    })
}

fn first_bytes(bytes: &[u8]) -> [u8; 8] {
    let mut first = [0; 8];
    for (to, from) in first.iter_mut().zip(bytes) {
        *to = *from;
    }
    first
}
