//! Client of the service, for Rust programs.

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

/// Pause between two attempts, if no server answers or all are busy.
const PAUSE: Duration = Duration::from_millis(20);

/// Time without a reply after which a parallel attempt is made; it doubles with each. Zenoh never
/// ends requests sent while a server is being forgotten.
const SILENCE: Duration = Duration::from_secs(1);

/// Asks the servers of this map where a scan was taken, and repeats that until the deadline.
pub fn ask(
    session: &Session,
    map: &str,
    (header, ranges): (&ScanHeader, &[f32]),
    deadline: Duration,
) -> Result<Received<topic::Hypotheses>, LocateError> {
    let preamble = Preamble {
        sender: u128::from_le_bytes(session.zid().to_le_bytes()) as u64,
        sequence: header.stamp.counter,
        clock_ns: monotonic_ns(),
    };
    let payload = network_payload::encode::<topic::Scan>(&preamble, header, ranges)?;
    let due = Instant::now() + deadline;
    let (events, received) = unbounded();
    // Number of open attempts, and time of the next one.
    let (mut open, mut next) = (0, Instant::now());
    loop {
        let now = Instant::now();
        if now >= due {
            let deadline_ms = deadline.as_millis();
            return Err(LocateError::Late { deadline_ms });
        }
        if now >= next {
            attempt(session, map, &payload, due - now, events.clone())?;
            // Deadlines are too short for this to overflow.
            (open, next) = (open + 1, now + SILENCE * 2_u32.pow(open));
        }
        let Ok(event) = received.recv_deadline(next.min(due)) else {
            continue;
        };
        match event {
            Some(Ok(sample)) => {
                let (encoding, payload) =
                    (sample.encoding().to_string(), sample.payload().to_bytes());
                let mut answer = network_payload::decode::<topic::Hypotheses>(&encoding, &payload)?;
                answer.rebase(monotonic_ns());
                return Ok(answer);
            }
            Some(Err(error)) => refusal(&error).map_or(Ok(()), Err)?,
            None => {
                open -= 1;
                next = next.min(Instant::now() + PAUSE);
            }
        }
    }
}

/// Result of an attempt; `None` at the end, when no further reply can arrive.
type Event = Option<Result<Sample, ReplyError>>;

struct Attempt(Sender<Event>);

impl Attempt {
    fn deliver(&self, event: Event) {
        // Without a receiver, the request has already been answered.
        let _ = self.0.send(event);
    }
}

impl Drop for Attempt {
    fn drop(&mut self) {
        self.deliver(None);
    }
}

/// Sends the request once; results go to `events`.
fn attempt(
    session: &Session,
    map: &str,
    payload: &[u8],
    remaining: Duration,
    events: Sender<Event>,
) -> Result<(), LocateError> {
    let key = network_payload::locate(map);
    let milliseconds = remaining.as_millis().clamp(1, 60_000);
    let attempt = Attempt(events);
    session
        .get(format!("{key}?deadline_ms={milliseconds}"))
        .payload(payload)
        .encoding(Encoding::from(network_payload::encoding::<topic::Scan>()))
        .timeout(remaining)
        .callback(move |reply| attempt.deliver(Some(reply.into_result())))
        .wait()
        .map_err(KeyError::when("ask", &key))?;
    Ok(())
}

/// Returns the error if repeating the request does not help.
fn refusal(error: &ReplyError) -> Option<LocateError> {
    (error.encoding().to_string() == REFUSED).then(|| LocateError::Refused {
        says: String::from_utf8_lossy(&error.payload().to_bytes()).into_owned(),
    })
}
