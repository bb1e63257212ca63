//! CoLa A frames.
//!
//! | bytes | field |
//! |---|---|
//! | 1 | start: `02` |
//! | n | content: printable characters |
//! | 1 | end: `03` |
//!
//! There is no checksum, so a changed digit goes unnoticed. Only truncated telegrams and words that
//! cannot be parsed are detected.

use crate::SickError;
use crate::framer::{Judgement, Pending};

/// Longest content accepted: each byte of the longest CoLa B telegram may take three characters.
pub(crate) const MAX_CONTENT: usize = 3 * super::cola_b::MAX_CONTENT;

const START: u8 = 2;
const END: u8 = 3;

/// Appends a telegram; `write` appends its content.
pub(super) fn frame(out: &mut Vec<u8>, write: impl FnOnce(&mut Vec<u8>)) {
    out.push(START);
    write(out);
    out.push(END);
}

pub(super) fn judge(pending: Pending<'_>) -> Judgement {
    let offset = pending.offset;
    let (&found, rest) = match pending.bytes.split_first() {
        Some((&START, rest)) => match rest.first() {
            None => return Judgement::Incomplete,
            Some(found) => (found, rest),
        },
        Some((&found, _)) => {
            return Judgement::Rejected(SickError::NoTelegram {
                offset,
                found,
                expected: "a CoLa A telegram starts with 02",
            });
        }
        None => return Judgement::Incomplete,
    };
    if found != b's' {
        return Judgement::Rejected(SickError::NotACommand { offset, found });
    }
    match rest.iter().position(|&byte| byte == START || byte == END) {
        Some(length) if length > MAX_CONTENT => Judgement::Rejected(SickError::Endless { offset }),
        Some(length) if rest.get(length) == Some(&START) => {
            Judgement::Rejected(SickError::CutOff {
                offset,
                present: length + 1,
            })
        }
        Some(length) => Judgement::Frame {
            prefix: 1,
            length,
            suffix: 1,
        },
        None if rest.len() > MAX_CONTENT => Judgement::Rejected(SickError::Endless { offset }),
        None => Judgement::Incomplete,
    }
}

#[cfg(test)]
mod tests {
    use crate::cola::{Encoding, stream};

    fn read(pieces: &[&[u8]]) -> Vec<String> {
        stream::seen(Encoding::Text, pieces)
    }

    #[test]
    fn telegrams_come_back_to_back_and_between_garbage() {
        let seen = read(&[b"\x02sAN one\x03\x02sAN two\x03"]);
        assert_eq!(seen, ["sAN one@0", "sAN two@9"]);
        let seen = read(&[b"x\x02\x02sAN one\x03y\x02sAN two\x03"]);
        assert_eq!(seen.len(), 4, "{seen:?}");
        assert_eq!((&*seen[1], &*seen[3]), ("sAN one@2", "sAN two@12"));
    }

    #[test]
    fn binary_telegrams_are_refused() {
        let seen = read(&[b"\x02\x02\x02\x02\0\0\0\x07sAN one\x42"]);
        assert!(
            seen[0].contains("starts with 0x02, every command"),
            "{seen:?}"
        );
    }
}
