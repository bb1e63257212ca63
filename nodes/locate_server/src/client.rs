//! Asking, for programs in Rust.

use std::time::{Duration, Instant};

use messages::{ScanHeader, topic};
use network::KeyError;
use transport::monotonic_ns;
use wire::{Preamble, Received};
use zenoh::bytes::Encoding;
use zenoh::query::{Reply, ReplyError};
use zenoh::{Session, Wait};

use crate::LocateError;
use crate::error::REFUSED;

/// Between two attempts, where nobody answers or all are busy.
const PAUSE: Duration = Duration::from_millis(20);

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
    let preamble = Preamble {
        sender: u64::from_le_bytes(first_bytes(&session.zid().to_le_bytes())),
        sequence: header.stamp.counter,
        clock_ns: monotonic_ns(),
    };
    let question = wire::encode::<topic::Scan>(&preamble, header, ranges)?;
    let due = Instant::now() + deadline;
    loop {
        let remaining = due.saturating_duration_since(Instant::now());
        if remaining.is_zero() {
            let deadline_ms = deadline.as_millis();
            return Err(LocateError::Late { deadline_ms });
        }
        match attempt(session, map, &question, remaining)? {
            Some(answer) => return Ok(answer),
            None => std::thread::sleep(PAUSE.min(remaining)),
        }
    }
}

/// None if nobody answers, or nobody has the time.
fn attempt(
    session: &Session,
    map: &str,
    question: &[u8],
    remaining: Duration,
) -> Result<Option<Received<topic::Hypotheses>>, LocateError> {
    let key = wire::locate(map);
    let milliseconds = remaining.as_millis().clamp(1, 60_000);
    let replies = session
        .get(format!("{key}?deadline_ms={milliseconds}"))
        .payload(question)
        .encoding(Encoding::from(wire::encoding::<topic::Scan>()))
        .timeout(remaining)
        .wait()
        .map_err(KeyError::when("ask", &key))?;
    let mut replies = replies.into_iter();
    match replies.next().map(Reply::into_result) {
        None => Ok(None),
        Some(Ok(sample)) => {
            let encoding = sample.encoding().to_string();
            let payload = sample.payload().to_bytes();
            let mut answer = wire::decode::<topic::Hypotheses>(&encoding, &payload)?;
            answer.rebase(monotonic_ns());
            Ok(Some(answer))
        }
        Some(Err(error)) => refusal(&error).map_or(Ok(None), Err),
    }
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
