//! Finds telegrams in a stream that arrives in arbitrary pieces.
//!
//! What a telegram looks like is the business of a [`Protocol`]. After anything
//! that is no telegram the framer looks on from the very next byte, so that
//! damage to one never costs another. Checksums of one byte are weak, and CoLa A
//! has none: a telegram counts only if its content can be read as well, to the
//! last byte.

use crate::SickError;

/// How telegrams of one kind are distinguished from other bytes.
pub trait Protocol {
    /// What a content says.
    type Telegram<'a>;

    /// Looks at each new piece of the stream, once.
    fn extend(&mut self, _piece: &[u8]) {}

    /// Bytes at the front of the buffer are let go of.
    fn release(&mut self, _count: usize) {}

    /// What stands at the first pending byte.
    fn judge(&self, pending: Pending<'_>) -> Judgement;

    /// Whether a telegram with this content stands in no other one: where a longer
    /// one that is not complete would hold it, that one's length is wrong. Without
    /// this, damage to a length would cost as much as the length claims.
    fn stands_alone(&self, _content: &[u8]) -> bool {
        false
    }

    /// Reads a content that was judged to be a telegram's.
    ///
    /// # Errors
    /// Where it cannot be read.
    fn read<'a>(&self, content: &'a [u8]) -> Result<Self::Telegram<'a>, SickError>;

    /// Reads a content that has been read just before, without an error.
    ///
    /// # Errors
    /// None in that case.
    fn read_again<'a>(&self, content: &'a [u8]) -> Result<Self::Telegram<'a>, SickError> {
        self.read(content)
    }
}

/// The part of the stream that has not been judged.
#[derive(Debug, Clone, Copy)]
pub struct Pending<'a> {
    /// All bytes from here on that have come.
    pub bytes: &'a [u8],
    /// Of the first of them in the buffer.
    pub at: usize,
    /// Of the first of them in the stream.
    pub offset: u64,
    /// Whether the byte before ended a telegram.
    pub in_step: bool,
}

/// What stands at the current byte.
#[derive(Debug)]
pub enum Judgement {
    /// A telegram with this many bytes before, of and after its content.
    Frame {
        /// Bytes before the content.
        prefix: usize,
        /// Bytes of content.
        length: usize,
        /// Bytes after the content.
        suffix: usize,
    },
    /// More bytes have to come.
    Incomplete,
    /// No telegram.
    Rejected(SickError),
}

/// A telegram with the right checksum and a content that makes sense.
#[derive(Debug, Clone)]
pub struct Frame<'a, T> {
    /// Of its first byte in the stream.
    pub offset: u64,
    /// Without what frames it.
    pub content: &'a [u8],
    /// What the content says.
    pub telegram: T,
    /// Bytes between the telegram before and this one that belong to none.
    pub skipped: u64,
}

/// A push parser: [`Framer::push`] takes bytes, [`Framer::next_frame`] hands
/// out what they hold.
#[derive(Debug)]
pub struct Framer<P> {
    protocol: P,
    bytes: Vec<u8>,
    /// The first byte that has not been judged.
    at: usize,
    /// Bytes of the stream before `bytes`.
    released: u64,
    /// Bytes rejected since the last telegram.
    skipped: u64,
    /// The first byte after `at` where a telegram may begin that stands alone.
    looked: usize,
    ended: bool,
}

impl<P: Protocol> Framer<P> {
    /// A framer at the start of a stream.
    #[must_use]
    pub fn of(protocol: P) -> Self {
        Framer {
            protocol,
            bytes: Vec::new(),
            at: 0,
            released: 0,
            skipped: 0,
            looked: 0,
            ended: false,
        }
    }

    /// Takes the next piece of the stream.
    pub fn push(&mut self, piece: &[u8]) {
        self.release();
        self.bytes.extend_from_slice(piece);
        self.protocol.extend(piece);
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
    pub fn next_frame(&mut self) -> Option<Result<Frame<'_, P::Telegram<'_>>, SickError>> {
        loop {
            match self.judge(self.at) {
                Judgement::Incomplete => return Some(Err(self.look_ahead()?)),
                Judgement::Frame {
                    prefix,
                    length,
                    suffix,
                } => return Some(self.hand_out(prefix, length, suffix)),
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

    /// What is pending may claim more bytes than it has: looks for a telegram
    /// behind its first byte that refutes it, and goes there.
    fn look_ahead(&mut self) -> Option<SickError> {
        let mut first_open = None;
        for at in self.looked.max(self.at + 1)..self.bytes.len() {
            match self.judge(at) {
                Judgement::Frame { prefix, length, .. } => {
                    let start = at + prefix;
                    let content = self.bytes.get(start..start + length);
                    if self.protocol.stands_alone(content.unwrap_or_default()) {
                        let offset = self.released + self.at as u64;
                        let present = at - self.at;
                        self.at = at;
                        self.skipped += present as u64;
                        return Some(SickError::CutOff { offset, present });
                    }
                }
                Judgement::Incomplete => _ = first_open.get_or_insert(at),
                Judgement::Rejected(_) => {}
            }
        }
        self.looked = first_open.unwrap_or(self.bytes.len());
        None
    }

    fn judge(&self, at: usize) -> Judgement {
        let bytes = self.bytes.get(at..).unwrap_or_default();
        let offset = self.released + at as u64;
        if bytes.is_empty() {
            return Judgement::Incomplete;
        }
        let judgement = self.protocol.judge(Pending {
            bytes,
            at,
            offset,
            in_step: self.skipped == 0 && at == self.at,
        });
        match judgement {
            Judgement::Incomplete if self.ended => Judgement::Rejected(SickError::Truncated {
                offset,
                present: bytes.len(),
            }),
            Judgement::Frame { prefix, length, .. } => {
                let content = bytes.get(prefix..prefix + length).unwrap_or_default();
                match self.protocol.read(content) {
                    Ok(_) => judgement,
                    Err(reason) => Judgement::Rejected(SickError::Unreadable {
                        offset,
                        reason: Box::new(reason),
                    }),
                }
            }
            other => other,
        }
    }

    fn hand_out(
        &mut self,
        prefix: usize,
        length: usize,
        suffix: usize,
    ) -> Result<Frame<'_, P::Telegram<'_>>, SickError> {
        let start = self.at + prefix;
        let offset = self.released + self.at as u64;
        self.at = start + length + suffix;
        let content = self.bytes.get(start..start + length).unwrap_or_default();
        Ok(Frame {
            offset,
            content,
            telegram: self.protocol.read_again(content)?,
            skipped: std::mem::take(&mut self.skipped),
        })
    }

    /// Drops judged bytes, only once they outweigh what has to move.
    fn release(&mut self) {
        if self.at > self.bytes.len() / 2 {
            self.bytes.drain(..self.at);
            self.protocol.release(self.at);
            self.released += self.at as u64;
            self.looked = self.looked.saturating_sub(self.at);
            self.at = 0;
        }
    }

    /// Bytes that the buffer has room for.
    #[cfg(test)]
    pub(crate) fn capacity(&self) -> usize {
        self.bytes.capacity()
    }
}

impl<P: Protocol + Default> Default for Framer<P> {
    fn default() -> Self {
        Framer::of(P::default())
    }
}

/// Whether a telegram was most likely sent here, though it cannot be used.
fn is_a_lost_telegram(error: &SickError) -> bool {
    matches!(
        error,
        SickError::Checksum { .. } | SickError::Unreadable { .. } | SickError::CutOff { .. }
    )
}
