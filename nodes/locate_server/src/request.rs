//! Requests and answers as bytes.
//!
//! A request is a scan as the bridge sends it, in postcard, or the same in JSON;
//! the answer comes in the form of the request. Postcard is for programs that have
//! these types; JSON is for everybody else: any language writes a scan with what it
//! brings along, and new fields of a message do not break it.

use engine::votes::VoteShare;
use messages::{HypothesesHeader, Hypothesis, ScanHeader, topic};
use network_payload::{Preamble, Wire};
use serde::{Deserialize, Serialize};

use crate::LocateError;
use crate::json;

/// The encoding of a request in JSON.
pub const JSON: &str = "application/json;backcast.Scan/v1";
/// That of its answer.
pub const JSON_ANSWER: &str = "application/json;backcast.Hypotheses/v2";
/// The encoding of a request to one shard of a set of maps: a [`PartQuestion`] in postcard.
pub const PART: &str = "application/postcard;backcast.ScanForPart/v2";
/// That of its answer.
pub const PART_ANSWER: &str = "application/postcard;backcast.Part/v1";
/// That of the answer to a question for a glance: a [`Glance`] in postcard.
pub(crate) const GLANCE_ANSWER: &str = "application/postcard;backcast.Glance/v1";
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
    /// What one shard of a set of maps finds, which is merged with others', beside a pose of
    /// such a share of the votes on a map of another one.
    Part {
        /// No votes where none is known.
        lead: VoteShare,
    },
    /// What a short search of one shard finds.
    Glance,
}

/// A question to one shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PartQuestion<'a> {
    /// Whether a short search is to say what the best pose has that it finds.
    pub glance: bool,
    /// Votes of a pose on a map of another shard, and how many are possible there; 0 of 1 where
    /// none is known.
    pub lead: (u16, u16),
    /// The scan, as the bridge sends it.
    #[serde(borrow)]
    pub scan: &'a [u8],
}

/// What a short search of one shard finds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Glance {
    /// Votes of the best pose, and how many are possible.
    pub lead: (u16, u16),
    /// How long it took, nanoseconds.
    pub search_ns: u64,
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
        Some(PartQuestion { glance: true, .. }) => Wanted::Glance,
        Some(PartQuestion { lead, .. }) => Wanted::Part {
            lead: VoteShare::new(lead.0, lead.1),
        },
    };
    Ok(Request {
        wanted,
        header: scan.header,
        ranges: scan.items,
    })
}

impl<'a> PartQuestion<'a> {
    fn read(payload: &'a [u8]) -> Result<Self, LocateError> {
        let unsound = |reason: String| LocateError::Part { reason };
        let asked: PartQuestion<'_> =
            postcard::from_bytes(payload).map_err(|error| unsound(error.to_string()))?;
        let (votes, possible) = asked.lead;
        match votes <= possible && possible > 0 {
            true => Ok(asked),
            false => Err(unsound(format!(
                "a pose has {votes} of {possible} votes: allowed are at most all, of 1 at least"
            ))),
        }
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
        assert!(answer.ends_with("backcast.Hypotheses/v3"), "{answer}");
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
    fn a_shard_is_asked_beside_what_another_one_knows() {
        let scan = network_payload::encode::<topic::Scan>(&PREAMBLE, &scan(), &[1.0, 2.0]).unwrap();
        let asked = |glance, lead| {
            let scan = &scan[..];
            let question = PartQuestion { glance, lead, scan };
            let payload = postcard::to_allocvec(&question).unwrap();
            read(PART, &payload, 50_000).map(|request| (request.wanted, request.ranges))
        };
        let (wanted, ranges) = asked(false, (7, 9)).unwrap();
        let lead = VoteShare::new(7, 9);
        assert_eq!(
            (wanted, &ranges[..]),
            (Wanted::Part { lead }, &[1.0, 2.0][..])
        );
        assert_eq!(asked(true, (0, 1)).unwrap().0, Wanted::Glance);
        for wrong in [(1, 0), (8, 7)] {
            let error = asked(false, wrong).unwrap_err().to_string();
            assert!(error.contains("allowed are at most all"), "{error}");
        }
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
