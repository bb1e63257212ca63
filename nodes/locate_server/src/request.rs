//! Requests and answers as bytes.
//!
//! A request is a scan as the bridge sends it, in postcard, or the same in JSON;
//! the answer comes in the form of the request. Postcard is for programs that have
//! these types; JSON is for everybody else: any language writes a scan with what it
//! brings along, and new fields of a message do not break it.

use messages::{HypothesesHeader, Hypothesis, ScanHeader, topic};
use network_payload::{Preamble, Wire};
use serde::{Deserialize, Serialize};

use crate::LocateError;
use crate::json;

/// The encoding of a request in JSON.
pub const JSON: &str = "application/json;backcast.Scan/v1";
/// That of its answer.
pub const JSON_ANSWER: &str = "application/json;backcast.Hypotheses/v2";
/// The encoding of a request to one shard of a set of maps, in postcard.
pub const PART: &str = "application/postcard;backcast.ScanForPart/v2";
/// That of its answer.
pub const PART_ANSWER: &str = "application/postcard;backcast.Part/v2";
/// What a request may say of itself.
pub(crate) const ENCODINGS: [&str; 3] = ["application/postcard;backcast.Scan/v2", JSON, PART];
/// Characters of a foreign encoding that an error shows.
const SHOWN: usize = 80;

/// In which form the request came, and the answer goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// As the bridge sends it; the preamble of the request is that of the answer.
    Postcard(Preamble),
    /// JSON.
    Json,
}

/// What the answer is to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// The places, in the form of the request.
    Hypotheses(Form),
    /// What one shard of a set of maps finds, which is merged with others'.
    Part {
        /// Which question it is, so that others can say what they found for it.
        question: QuestionId,
    },
}

/// The number of a question to all shards: of the one who asks, and among theirs.
pub(crate) type QuestionId = (u64, u64);

/// A question to one shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PartQuestion<'a> {
    /// Its number.
    pub id: QuestionId,
    /// The scan, as the bridge sends it.
    #[serde(borrow)]
    pub scan: &'a [u8],
}

/// A scan that somebody wants to be located.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// What is asked for.
    pub wanted: Wanted,
    /// As in topic `scan`.
    pub header: ScanHeader,
    /// Metres.
    pub ranges: Vec<f32>,
}

/// Reads a request that says of itself what it is, at `now_ns` of the monotonic
/// clock.
///
/// # Errors
/// If it is in no form that is known, too long, or not sound.
pub fn read(encoding: &str, payload: &[u8], now_ns: i64) -> Result<Request, LocateError> {
    let most = topic::Scan::MAX_BYTES;
    if payload.len() > most {
        let found = payload.len();
        return Err(LocateError::TooLong { found, most });
    }
    if encoding == JSON {
        let (header, ranges) = json::read(payload, now_ns)?;
        return Ok(Request {
            wanted: Wanted::Hypotheses(Form::Json),
            header,
            ranges,
        });
    }
    let as_scan = network_payload::encoding::<topic::Scan>();
    let of_part = match encoding {
        PART => Some(PartQuestion::read(payload)?),
        _ if encoding == as_scan => None,
        _ => {
            let found = encoding.chars().take(SHOWN).collect();
            return Err(LocateError::Encoding { found });
        }
    };
    let payload = of_part.as_ref().map_or(payload, |asked| asked.scan);
    let mut scan = network_payload::decode::<topic::Scan>(&as_scan, payload)?;
    scan.rebase(now_ns);
    let wanted = match of_part {
        None => Wanted::Hypotheses(Form::Postcard(scan.preamble)),
        Some(PartQuestion { id, .. }) => Wanted::Part { question: id },
    };
    Ok(Request {
        wanted,
        header: scan.header,
        ranges: scan.items,
    })
}

impl<'a> PartQuestion<'a> {
    fn read(payload: &'a [u8]) -> Result<Self, LocateError> {
        postcard::from_bytes(payload).map_err(|error| LocateError::Part {
            reason: error.to_string(),
        })
    }
}

/// An answer in this form, which is sent at `now_ns` of the monotonic clock: its
/// encoding and its bytes. Maps have names where several are searched.
///
/// # Errors
/// If the engine gave what cannot be sent.
pub fn write(
    form: Form,
    header: &HypothesesHeader,
    hypotheses: &[Hypothesis],
    name_of: &dyn Fn(u64) -> Option<String>,
    now_ns: i64,
) -> Result<(String, Vec<u8>), LocateError> {
    match form {
        Form::Json => Ok((
            JSON_ANSWER.into(),
            json::write(header, hypotheses, name_of)?,
        )),
        Form::Postcard(asked) => {
            let preamble = Preamble {
                clock_ns: now_ns,
                ..asked
            };
            let payload =
                network_payload::encode::<topic::Hypotheses>(&preamble, header, hypotheses)?;
            Ok((network_payload::encoding::<topic::Hypotheses>(), payload))
        }
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{FrameName, Stamp};

    use super::*;

    const PREAMBLE: Preamble = Preamble {
        sender: 7,
        sequence: 3,
        clock_ns: 1_000,
    };

    fn scan() -> ScanHeader {
        ScanHeader {
            stamp: Stamp {
                measured_ns: 5,
                entered_ns: 400,
                counter: 9,
            },
            angle_min: -1.5,
            angle_increment: 0.5,
            range_max_m: 30.0,
            frame: FrameName::new("laser"),
            ..Zeroable::zeroed()
        }
    }

    #[test]
    fn the_forms_are_those_of_the_wire() {
        assert_eq!(ENCODINGS[0], network_payload::encoding::<topic::Scan>());
        let answer = network_payload::encoding::<topic::Hypotheses>();
        assert!(answer.ends_with("backcast.Hypotheses/v4"), "{answer}");
        // Its keys are those of version 2.
        assert!(JSON_ANSWER.ends_with("backcast.Hypotheses/v2"));
    }

    #[test]
    fn a_request_in_postcard_is_answered_in_postcard() {
        let payload =
            network_payload::encode::<topic::Scan>(&PREAMBLE, &scan(), &[1.0, 2.0]).unwrap();
        let asked = read(ENCODINGS[0], &payload, 50_000).unwrap();
        let form = Form::Postcard(PREAMBLE);
        assert_eq!(asked.wanted, Wanted::Hypotheses(form));
        assert_eq!(asked.ranges, [1.0, 2.0]);
        assert_eq!(
            asked.header.stamp.entered_ns,
            50_000 - 600,
            "as old as there"
        );
        let header = HypothesesHeader::zeroed();
        let (encoding, payload) = write(form, &header, &[], &|_| None, 60_000).unwrap();
        let answer = network_payload::decode::<topic::Hypotheses>(&encoding, &payload).unwrap();
        assert_eq!((answer.preamble.sender, answer.preamble.sequence), (7, 3));
        assert_eq!(answer.preamble.clock_ns, 60_000);
    }

    #[test]
    fn a_question_to_a_shard_has_a_number() {
        let scan = network_payload::encode::<topic::Scan>(&PREAMBLE, &scan(), &[1.0, 2.0]).unwrap();
        let question = PartQuestion {
            id: (7, 9),
            scan: &scan,
        };
        let payload = postcard::to_allocvec(&question).unwrap();
        let asked = read(PART, &payload, 50_000).unwrap();
        assert_eq!(asked.wanted, Wanted::Part { question: (7, 9) });
        assert_eq!(asked.ranges, [1.0, 2.0]);
        assert!(matches!(
            read(PART, b"\xff", 0),
            Err(LocateError::Part { .. })
        ));
    }

    #[test]
    fn what_is_no_request_is_refused_with_what_would_be_one() {
        let check = |encoding: &str, payload: &[u8], expected: &str| {
            let error = read(encoding, payload, 0).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        check("zenoh/bytes", b"", "allowed are application/postcard");
        check("application/postcard;backcast.Scan/v9", b"", JSON);
        check(ENCODINGS[0], b"\xff", "does not match its postcard schema");
        check(JSON, b"{", "not a scan in JSON");
        check(JSON, &vec![b' '; (1 << 20) + 1], "at most 1048576");
    }
}
