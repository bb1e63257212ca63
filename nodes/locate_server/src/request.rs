//! Binary form of requests and answers: a scan in postcard for Rust, in the format of the bridge,
//! or in JSON for all others; the answer has the form of the request.

use messages::{HypothesesHeader, Hypothesis, ScanHeader, topic};
use network_payload::{Preamble, Wire};

use crate::LocateError;
use crate::json;

pub const JSON: &str = "application/json;backcast.Scan/v1";
pub const JSON_ANSWER: &str = "application/json;backcast.Hypotheses/v3";
pub(crate) const ENCODINGS: [&str; 2] = ["application/postcard;backcast.Scan/v2", JSON];
/// Number of characters of an unknown encoding that an error shows.
const SHOWN: usize = 80;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Postcard in the format of the bridge; the answer repeats the request's preamble.
    Postcard(Preamble),
    Json,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Form of the request, which is also that of the answer.
    pub form: Form,
    pub header: ScanHeader,
    pub ranges: Vec<f32>,
}

/// Parses a request with this encoding; `now_ns` is the monotonic clock.
pub fn read(encoding: &str, payload: &[u8], now_ns: i64) -> Result<Request, LocateError> {
    let most = topic::Scan::MAX_BYTES;
    if payload.len() > most {
        let found = payload.len();
        return Err(LocateError::TooLong { found, most });
    }
    if encoding == JSON {
        let (header, ranges) = json::read(payload, now_ns)?;
        return Ok(Request {
            form: Form::Json,
            header,
            ranges,
        });
    }
    let as_scan = network_payload::encoding::<topic::Scan>();
    if encoding != as_scan {
        let found = encoding.chars().take(SHOWN).collect();
        return Err(LocateError::Encoding { found });
    }
    let mut scan = network_payload::decode::<topic::Scan>(&as_scan, payload)?;
    scan.rebase(now_ns);
    Ok(Request {
        form: Form::Postcard(scan.preamble),
        header: scan.header,
        ranges: scan.items,
    })
}

/// Returns encoding and bytes of an answer sent at `now_ns`, with names of several maps.
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
        assert!(answer.ends_with("backcast.Hypotheses/v5"), "{answer}");
        assert!(JSON_ANSWER.ends_with("backcast.Hypotheses/v3"));
    }

    #[test]
    fn a_request_in_postcard_is_answered_in_postcard() {
        let payload =
            network_payload::encode::<topic::Scan>(&PREAMBLE, &scan(), &[1.0, 2.0]).unwrap();
        let asked = read(ENCODINGS[0], &payload, 50_000).unwrap();
        let form = Form::Postcard(PREAMBLE);
        assert_eq!(asked.form, form);
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
