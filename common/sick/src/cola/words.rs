//! Hexadecimal words, parsed eight characters at a time.
//!
//! Most of a scan in CoLa A is short words of unpredictable length, on which a loop over characters
//! suffers from branch mispredictions; a step over eight bytes at once is about twice as fast
//! (`cargo bench -p sick`).

const ONES: u64 = 0x0101_0101_0101_0101;
const HIGHS: u64 = 0x80 * ONES;
const LOWS: u64 = 0x7f * ONES;
const SPACES: u64 = b' ' as u64 * ONES;

/// Returns value and length of the word of 1 to 8 hexadecimal digits at the start of `text`, which
/// must be followed by a space or the end.
pub(super) fn leading_hex(text: &[u8]) -> Option<(u32, usize)> {
    if let Some(chunk) = text.first_chunk::<8>() {
        let chunk = u64::from_le_bytes(*chunk);
        let length = spaces(chunk).trailing_zeros() / 8;
        if (1..8).contains(&length) {
            // Zeros before the word replace the characters after it.
            let free = 64 - 8 * length;
            let digits = chunk << free | (u64::from(b'0') * ONES) & ((1 << free) - 1);
            return value(digits).map(|value| (value, length as usize));
        }
    }
    leading_hex_by_characters(text)
}

fn leading_hex_by_characters(text: &[u8]) -> Option<(u32, usize)> {
    let length = text.iter().position(|&byte| byte == b' ');
    let word = text.get(..length.unwrap_or(text.len()))?;
    let mut value = 0;
    for &byte in word {
        value = value << 4 | char::from(byte).to_digit(16)?;
    }
    (1..=8).contains(&word.len()).then_some((value, word.len()))
}

/// Returns the number of bytes that the first `count` words of `text` take, including the space
/// after each. The words are separated by one space, with none before the first.
pub(super) fn length_of_words(text: &[u8], count: usize) -> usize {
    let (mut left, mut at) = (count, 0);
    while let Some(chunk) = text.get(at..).and_then(<[u8]>::first_chunk::<8>) {
        let found = spaces(u64::from_le_bytes(*chunk)).count_ones() as usize;
        if found >= left {
            break;
        }
        left -= found;
        at += 8;
    }
    for (index, &byte) in text.iter().enumerate().skip(at) {
        if left == 0 {
            return index;
        }
        left -= usize::from(byte == b' ');
    }
    if count == 0 { 0 } else { text.len() }
}

/// Sets the high bit of each byte that is a space.
fn spaces(chunk: u64) -> u64 {
    let differs = chunk ^ SPACES;
    !(((differs & LOWS) + LOWS) | differs | LOWS)
}

/// Returns the value of eight hexadecimal digits, the first one in the low byte.
fn value(digits: u64) -> Option<u32> {
    if !are_hex(digits) {
        return None;
    }
    let nibbles = (digits & (0x0f * ONES)) + 9 * (digits >> 6 & ONES);
    let bytes = (nibbles << 4 | nibbles >> 8) & 0x00ff_00ff_00ff_00ff;
    let halves = (bytes << 8 | bytes >> 16) & 0x0000_ffff_0000_ffff;
    Some((halves << 16 | halves >> 32) as u32)
}

fn are_hex(digits: u64) -> bool {
    if digits & HIGHS != 0 {
        return false;
    }
    // No byte carries into the next one: each is below 0x80.
    let from = |bytes: u64, least: u8| bytes + u64::from(0x80 - least) * ONES;
    let lower = digits | SPACES;
    let decimal = from(digits, b'0') & !from(digits, b'9' + 1);
    let letter = from(lower, b'a') & !from(lower, b'f' + 1);
    (decimal | letter) & HIGHS == HIGHS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_in_every_place_as_one_by_one() {
        let words = [
            "0",
            "7",
            "FF",
            "a0",
            "1388",
            "FFF92230",
            "89A27F",
            "1234567",
            "123456789",
        ];
        for word in words {
            for rest in ["", " ", " 1", " DIST1 3F800000"] {
                let mut text = [word, rest].concat().into_bytes();
                for at in 0..text.len() {
                    let kept = text[at];
                    for byte in 0..=255 {
                        text[at] = byte;
                        let expected = leading_hex_by_characters(&text);
                        assert_eq!(leading_hex(&text), expected, "{}", text.escape_ascii());
                    }
                    text[at] = kept;
                }
            }
        }
        assert_eq!(leading_hex(b"FFF92230 225510"), Some((0xfff9_2230, 8)));
        assert_eq!(leading_hex(b""), None);
    }

    #[test]
    fn words_are_counted() {
        let text = b"1 22 333 4444 5 6 7 8 9 AAAAAAAAAA B";
        assert_eq!(length_of_words(text, 0), 0);
        assert_eq!(length_of_words(text, 1), 2);
        assert_eq!(length_of_words(text, 4), 14);
        assert_eq!(length_of_words(text, 9), 24);
        assert_eq!(length_of_words(text, 10), 35);
        assert_eq!(length_of_words(text, 11), text.len());
        assert_eq!(length_of_words(b"", 0), 0);
    }
}
