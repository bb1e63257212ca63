//! Finds telegrams in a stream that arrives in arbitrary pieces.
//!
//! After anything that is no telegram it looks on from the very next byte, so
//! that damage to one never costs another. Every byte is looked at a bounded
//! number of times: running parities give the checksum of any stretch at once,
//! so even a stream of nothing but false starts costs linear time.
//!
//! The checksum alone is weak: a length that is too large by two takes in the
//! checksum and a byte of the next start, whose XOR equals the byte after. So a
//! telegram counts only if its content can be read as well, to the last byte.

use super::telegram::Telegram;
use crate::LmsError;

/// Bytes that start every telegram.
pub(crate) const START: [u8; 4] = [2; 4];
/// The shortest content: a command of three letters.
pub const MIN_CONTENT: usize = 3;
/// The longest content that is believed. Five echoes with distance and
/// remission at the finest resolution of the LMS5xx take about 23 kB.
pub const MAX_CONTENT: usize = 1 << 17;
/// Bytes before the content: start and length.
const PREFIX: usize = 8;

/// A telegram with the right checksum and a content that makes sense.
#[derive(Debug, Clone)]
pub struct Frame<'a> {
    /// Of its first byte in the stream.
    pub offset: u64,
    /// Without start, length and checksum.
    pub content: &'a [u8],
    /// What the content says.
    pub telegram: Telegram<'a>,
    /// Bytes between the telegram before and this one that belong to none.
    pub skipped: u64,
}

/// A push parser: [`Framer::push`] takes bytes, [`Framer::next_frame`] hands
/// out what they hold.
#[derive(Debug, Default)]
pub struct Framer {
    bytes: Vec<u8>,
    /// XOR of `bytes` up to and including the same index, and of an arbitrary
    /// constant that drops out of every difference.
    parity: Vec<u8>,
    /// The first byte that has not been judged.
    at: usize,
    /// Bytes of the stream before `bytes`.
    released: u64,
    /// Bytes rejected since the last telegram.
    skipped: u64,
    ended: bool,
}

/// What stands at the current byte.
enum Judgement {
    Frame { length: usize },
    Incomplete,
    Rejected(LmsError),
}

impl Framer {
    /// Takes the next piece of the stream.
    pub fn push(&mut self, piece: &[u8]) {
        self.release();
        let mut parity = self.parity.last().copied().unwrap_or(0);
        self.bytes.extend_from_slice(piece);
        self.parity.extend(piece.iter().map(|byte| {
            parity ^= byte;
            parity
        }));
    }

    /// Says that the stream has ended: what is incomplete now stays so.
    pub fn finish(&mut self) {
        self.ended = true;
    }

    /// The next telegram, or the next place where there should have been one;
    /// `None` until more bytes come.
    ///
    /// # Errors
    /// The first reason for losing step, and each wrong checksum or unreadable
    /// content. Then bytes are skipped in silence up to the next telegram, which
    /// says how many.
    pub fn next_frame(&mut self) -> Option<Result<Frame<'_>, LmsError>> {
        loop {
            match self.judge() {
                Judgement::Incomplete => return None,
                Judgement::Frame { length } => return Some(self.hand_out(length)),
                Judgement::Rejected(error) => {
                    let in_step = self.skipped == 0;
                    self.at += 1;
                    self.skipped += 1;
                    if in_step || is_a_lost_telegram(&error) {
                        return Some(Err(error));
                    }
                }
            }
        }
    }

    fn judge(&self) -> Judgement {
        let pending = self.bytes.get(self.at..).unwrap_or_default();
        let offset = self.released + self.at as u64;
        let Some((&start, rest)) = pending.split_first_chunk::<4>() else {
            return self.incomplete(offset, pending.len());
        };
        if start != START {
            return Judgement::Rejected(LmsError::NoStart {
                offset,
                found: start,
            });
        }
        let Some((&claim, rest)) = rest.split_first_chunk::<4>() else {
            return self.incomplete(offset, pending.len());
        };
        let found = u32::from_be_bytes(claim);
        let length = found as usize;
        if !(MIN_CONTENT..=MAX_CONTENT).contains(&length) {
            return Judgement::Rejected(LmsError::Length { offset, found });
        }
        match (rest.first(), rest.split_at_checked(length)) {
            (Some(&found), _) if found != b's' => {
                Judgement::Rejected(LmsError::NotACommand { offset, found })
            }
            (Some(_), Some((content, [found, ..]))) => match self.check(offset, content, *found) {
                Ok(()) => Judgement::Frame { length },
                Err(error) => Judgement::Rejected(error),
            },
            _ => self.incomplete(offset, pending.len()),
        }
    }

    /// Checks a whole telegram: the checksum first, for it is cheap.
    fn check(&self, offset: u64, content: &[u8], found: u8) -> Result<(), LmsError> {
        let length = content.len();
        let computed = self.content_parity(length);
        if computed != found {
            return Err(LmsError::Checksum {
                offset,
                length,
                found,
                computed,
            });
        }
        match Telegram::read(content) {
            Ok(_) => Ok(()),
            Err(reason) => Err(LmsError::Unreadable {
                offset,
                reason: Box::new(reason),
            }),
        }
    }

    fn incomplete(&self, offset: u64, present: usize) -> Judgement {
        if self.ended && present > 0 {
            Judgement::Rejected(LmsError::Truncated { offset, present })
        } else {
            Judgement::Incomplete
        }
    }

    /// XOR of the `length` bytes of content at the current byte.
    fn content_parity(&self, length: usize) -> u8 {
        let upto = |end: usize| self.parity.get(end - 1).copied().unwrap_or(0);
        let content = self.at + PREFIX;
        upto(content + length) ^ upto(content)
    }

    fn hand_out(&mut self, length: usize) -> Result<Frame<'_>, LmsError> {
        let content = self.at + PREFIX;
        let offset = self.released + self.at as u64;
        self.at = content + length + 1;
        let bytes = self.bytes.get(content..content + length);
        let content = bytes.unwrap_or_default();
        Ok(Frame {
            offset,
            content,
            telegram: Telegram::read(content)?,
            skipped: std::mem::take(&mut self.skipped),
        })
    }

    /// Lets go of judged bytes, only once they outweigh what has to move.
    fn release(&mut self) {
        if self.at > self.bytes.len() / 2 {
            self.bytes.drain(..self.at);
            self.parity.drain(..self.at);
            self.released += self.at as u64;
            self.at = 0;
        }
    }
}

/// Whether a telegram was most likely sent here, though it cannot be used.
fn is_a_lost_telegram(error: &LmsError) -> bool {
    matches!(
        error,
        LmsError::Checksum { .. } | LmsError::Unreadable { .. }
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cola_b::frame;

    /// What a stream holds: `content@offset` of telegrams, `!` and an error's text.
    fn read(pieces: &[&[u8]]) -> Vec<String> {
        let mut framer = Framer::default();
        let mut seen = Vec::new();
        let mut drain = |framer: &mut Framer| {
            while let Some(next) = framer.next_frame() {
                seen.push(match next {
                    Ok(f) => format!("{}@{}", String::from_utf8_lossy(f.content), f.offset),
                    Err(error) => format!("!{error}"),
                });
            }
        };
        for piece in pieces {
            framer.push(piece);
            drain(&mut framer);
        }
        framer.finish();
        drain(&mut framer);
        seen
    }

    fn telegrams(contents: &[&str]) -> Vec<u8> {
        contents.iter().flat_map(|c| frame(c.as_bytes())).collect()
    }

    #[test]
    fn telegrams_come_back_to_back() {
        let stream = telegrams(&["sAN one", "sSN two"]);
        assert_eq!(read(&[&stream]), ["sAN one@0", "sSN two@16"]);
    }

    #[test]
    fn garbage_between_telegrams_costs_none_of_them() {
        // The stray 02 is the nastiest: it looks like the start of the next start.
        let stream = [telegrams(&["sAN one"]), vec![9, 2], telegrams(&["sAN two"])].concat();
        let seen = read(&[&stream]);
        assert_eq!(seen.len(), 3, "{seen:?}");
        assert!(seen[1].contains("byte 16"), "{seen:?}");
        assert_eq!(seen[2], "sAN two@18");
    }

    #[test]
    fn a_wrong_checksum_is_reported_and_the_next_telegram_read() {
        let mut stream = telegrams(&["sAN one", "sAN two"]);
        stream[10] ^= 0x40;
        let seen = read(&[&stream]);
        assert!(seen[0].starts_with("!byte 0 of the stream: the checksum of 7"));
        assert_eq!(seen[1..], ["sAN two@16"]);
    }

    #[test]
    fn a_length_that_swallows_the_next_telegrams_gives_them_back() {
        let mut stream = telegrams(&["sAN one", "sAN two", "sAN three"]);
        stream[7] += 16;
        let seen = read(&[&stream]);
        assert_eq!(seen[1..], ["sAN two@16", "sAN three@32"]);
        // The same where the claim reaches beyond the end of the stream.
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

    #[test]
    fn memory_is_bounded_by_the_longest_telegram() {
        let mut framer = Framer::default();
        let telegram = frame(b"sAN a telegram of the usual kind");
        for _ in 0..10_000 {
            framer.push(&telegram);
            assert!(matches!(framer.next_frame(), Some(Ok(_))));
        }
        assert!(
            framer.bytes.capacity() < 1024,
            "{}",
            framer.bytes.capacity()
        );
    }

    proptest::proptest! {
        #[test]
        fn any_split_gives_the_same(
            contents in proptest::collection::vec("s[a-z \u{2}]{2,20}", 0..6),
            garbage in proptest::collection::vec(0u8..4, 0..12),
            cuts in proptest::collection::vec(1usize..9, 1..20),
        ) {
            let mut stream = garbage.clone();
            for content in &contents {
                stream.extend(frame(content.as_bytes()));
                stream.extend(&garbage);
            }
            let mut pieces = Vec::new();
            let mut rest = &stream[..];
            for cut in cuts.iter().cycle() {
                let (piece, tail) = rest.split_at((*cut).min(rest.len()));
                pieces.push(piece);
                rest = tail;
                if rest.is_empty() { break; }
            }
            proptest::prop_assert_eq!(read(&pieces), read(&[&stream]));
        }

        #[test]
        fn no_bytes_panic(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..400)) {
            let _ = read(&[&bytes]);
            // Mostly starts, so that the rules behind them are reached as well.
            let starts: Vec<u8> = bytes.iter().map(|b| if *b < 200 { 2 } else { b & 3 }).collect();
            let _ = read(&[&starts]);
        }
    }
}
