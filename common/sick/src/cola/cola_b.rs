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
    let checksum = content.iter().fold(0, |parity, byte| parity ^ byte);
    if let Some(claim) = out.get_mut(start + 4..start + PREFIX) {
        claim.copy_from_slice(&length.to_be_bytes());
    }
    out.push(checksum);
}

/// Running XOR up to and including each buffered byte, combined with an arbitrary constant that
/// cancels in every difference. It gives the checksum of any range in constant time, so that even a
/// stream full of false starts costs linear time.
#[derive(Debug, Default)]
pub(super) struct Parity(Vec<u8>);

impl Parity {
    /// Appends the running XOR of newly buffered bytes.
    pub(super) fn extend(&mut self, piece: &[u8]) {
        let mut parity = self.0.last().copied().unwrap_or(0);
        self.0.extend(piece.iter().map(|byte| {
            parity ^= byte;
            parity
        }));
    }

    pub(super) fn release(&mut self, count: usize) {
        self.0.drain(..count);
    }

    /// Returns the XOR of `length` buffered bytes from `start` on; at least one byte precedes them.
    fn of(&self, start: usize, length: usize) -> u8 {
        let upto = |end: usize| self.0.get(end - 1).copied().unwrap_or(0);
        upto(start + length) ^ upto(start)
    }
}

pub(super) fn judge(parity: &Parity, pending: Pending<'_>) -> Judgement {
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
            let computed = parity.of(pending.at + PREFIX, length);
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
    fn garbage_between_telegrams_costs_none_of_them() {
        // A stray 02 is the worst case: it looks like the beginning of the next start.
        let stream = [telegrams(&["sAN one"]), vec![9, 2], telegrams(&["sAN two"])].concat();
        let seen = read(&[&stream]);
        assert_eq!(seen.len(), 3, "{seen:?}");
        assert!(seen[1].contains("byte 16"), "{seen:?}");
        assert_eq!(seen[2], "sAN two@18");
    }

    #[test]
    fn a_length_that_swallows_the_next_telegrams_gives_them_back() {
        let mut stream = telegrams(&["sAN one", "sAN two", "sAN three"]);
        stream[7] += 16;
        let seen = read(&[&stream]);
        assert_eq!(seen[1..], ["sAN two@16", "sAN three@32"]);
        // The same when the claimed length exceeds the rest of the stream.
        stream[6] = 0x10;
        let seen = read(&[&stream]);
        assert!(seen[0].contains("ends 50 bytes into"), "{seen:?}");
        assert_eq!(seen[1..], ["sAN two@16", "sAN three@32"]);
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
