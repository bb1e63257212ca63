//! Framing of CoLa telegrams in a stream, in either encoding.

use super::{Encoding, LmdScanData, Telegram, cola_a, cola_b};
use crate::SickError;
use crate::framer::{self, Judgement, Pending, Protocol};

impl Encoding {
    /// Appends a complete telegram. The reader would reject a content of more than 131072 bytes.
    pub fn frame(self, telegram: &Telegram<'_>, out: &mut Vec<u8>) {
        match self {
            Encoding::Text => cola_a::frame(out, |out| telegram.write(self, out)),
            Encoding::Binary => cola_b::frame(out, |out| telegram.write(self, out)),
        }
    }
}

/// Framer for CoLa telegrams of either direction.
pub type Framer = framer::Framer<Encoding>;

impl Framer {
    pub fn new(encoding: Encoding) -> Self {
        Framer::of(encoding)
    }
}

impl Protocol for Encoding {
    type Telegram<'a> = Telegram<'a>;

    fn judge(&self, pending: Pending<'_>) -> Judgement {
        match self {
            Encoding::Text => cola_a::judge(pending),
            Encoding::Binary => cola_b::judge(pending),
        }
    }

    fn stands_alone(&self, content: &[u8]) -> bool {
        *self == Encoding::Binary && LmdScanData::is_in(content)
    }

    fn read<'a>(&self, content: &'a [u8]) -> Result<Telegram<'a>, SickError> {
        Telegram::read(*self, content)
    }
}

/// Returns the items of a stream: `content@offset` for telegrams, `!` and the text for errors.
#[cfg(test)]
pub(super) fn seen(encoding: Encoding, pieces: &[&[u8]]) -> Vec<String> {
    let mut framer = Framer::new(encoding);
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
