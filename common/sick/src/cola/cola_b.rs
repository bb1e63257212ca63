//! CoLa B frames.
//!
//! | bytes | field |
//! |---|---|
//! | 4 | start: `02 02 02 02` |
//! | 4 | length of the content, u32 |
//! | n | content: a command of three letters, a space, a name, parameters |
//! | 1 | XOR of the content |
//!
//! The checksum alone is weak: a length that is too large by two includes the checksum and one byte
//! of the next start, and the XOR of these equals the byte that follows.

use crate::SickError;
use crate::framer::{Judgement, Pending};

const START: [u8; 4] = [2; 4];
/// Length of the shortest content: a command of three letters.
const MIN_CONTENT: usize = 3;
/// Longest content accepted. Five echoes with distance and remission at the finest resolution of
/// the LMS5xx take about 23 kB.
pub(super) const MAX_CONTENT: usize = 1 << 17;
const PREFIX: usize = 8;

/// Appends a telegram; `write` appends its content.
pub(super) fn frame(out: &mut Vec<u8>, write: impl FnOnce(&mut Vec<u8>)) {
    let start = out.len();
    out.extend_from_slice(&START);
    out.extend_from_slice(&[0; 4]);
    write(out);
    let content = out.get(start + PREFIX..).unwrap_or_default();
    let length = u32::try_from(content.len()).unwrap_or(u32::MAX);
    let checksum = checksum(content);
    if let Some(claim) = out.get_mut(start + 4..start + PREFIX) {
        claim.copy_from_slice(&length.to_be_bytes());
    }
    out.push(checksum);
}

fn checksum(content: &[u8]) -> u8 {
    content.iter().fold(0, |parity, byte| parity ^ byte)
}

pub(super) fn judge(pending: Pending<'_>) -> Judgement {
    let offset = pending.offset;
    let Some((&start, rest)) = pending.bytes.split_first_chunk::<4>() else {
        return Judgement::Incomplete;
    };
    if start != START {
        return Judgement::Rejected(SickError::NoStart {
            offset,
            found: start,
        });
    }
    let Some((&claim, rest)) = rest.split_first_chunk::<4>() else {
        return Judgement::Incomplete;
    };
    let found = u32::from_be_bytes(claim);
    let length = found as usize;
    let allowed = MIN_CONTENT..=MAX_CONTENT;
    if !allowed.contains(&length) {
        return Judgement::Rejected(SickError::Length {
            offset,
            found,
            part: "content",
            allowed,
        });
    }
    match (rest.first(), rest.get(length)) {
        (Some(&found), _) if found != b's' => {
            Judgement::Rejected(SickError::NotACommand { offset, found })
        }
        (_, Some(&found)) => {
            let computed = checksum(rest.get(..length).unwrap_or_default());
            if computed == found {
                return Judgement::Frame {
                    prefix: PREFIX,
                    length,
                    suffix: 1,
                };
            }
            Judgement::Rejected(SickError::Checksum {
                offset,
                length,
                found: found.into(),
                computed: computed.into(),
            })
        }
        _ => Judgement::Incomplete,
    }
}

#[cfg(test)]
mod tests {
    use super::START;
    use crate::cola::{Encoding, stream};

    fn frame(content: &[u8]) -> Vec<u8> {
        let mut out = Vec::new();
        super::frame(&mut out, |out| out.extend(content));
        out
    }

    fn read(pieces: &[&[u8]]) -> Vec<String> {
        stream::seen(Encoding::Binary, pieces)
    }

    fn telegrams(contents: &[&str]) -> Vec<u8> {
        contents.iter().flat_map(|c| frame(c.as_bytes())).collect()
    }

    #[test]
    fn a_length_too_large_by_two_fits_the_checksum_but_not_the_content() {
        let scan = b"sSN LMDscandata \0\x01";
        let stream = [frame(b"sEA LMDscandata \x01"), frame(b"sAN two")].concat();
        let mut damaged = stream.clone();
        damaged[7] += 2;
        let seen = read(&[&damaged]);
        assert!(seen[0].contains("cannot be read"), "{seen:?}");
        assert_eq!(seen[1..], [format!("sAN two@{}", stream.len() - 16)]);
        let seen = read(&[&frame(scan)]);
        assert!(
            seen[0].contains("`device number` takes 2 bytes"),
            "{seen:?}"
        );
    }

    #[test]
    fn a_start_inside_the_content_is_content() {
        let inner = String::from_utf8(telegrams(&["sAN in"])).unwrap();
        let stream = telegrams(&[&format!("sSN {inner}"), "sAN out"]);
        let seen = read(&[&stream]);
        assert_eq!(seen.len(), 2);
        assert!(seen[1].starts_with("sAN out"));
    }

    #[test]
    fn refusals_say_what_is_allowed() {
        let huge = [&START[..], &[0x40, 0, 0, 0, b's']].concat();
        assert!(read(&[&huge])[0].contains("1073741824 bytes of content, allowed are 3 to 131072"));
        let other = [&START[..], &[0, 0, 0, 3, b'x', 0, 0, 0]].concat();
        assert!(read(&[&other])[0].contains("starts with 0x78, every command with 's'"));
        assert!(read(&[b"\x02sSN LMDscandata"])[0].contains("set the device to CoLa binary"));
        assert!(read(&[&telegrams(&["sAN one"])[..9]])[0].contains("ends 9 bytes into"));
    }
}
