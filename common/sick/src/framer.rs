//! Finds telegrams in a stream that arrives in arbitrary pieces.
//!
//! A [`Protocol`] defines the format of a telegram. After bytes that are no telegram, the framer
//! continues at the very next byte, so that a damaged telegram never costs another one. One-byte
//! checksums are weak, and CoLa A has none, so a telegram counts only if its content can be parsed
//! to the last byte.

use crate::SickError;

/// Rules that distinguish telegrams of one kind from other bytes.
pub trait Protocol {
    type Telegram<'a>;

    /// Classifies the bytes from the first pending one on.
    fn judge(&self, pending: Pending<'_>) -> Judgement;

    /// Returns true if a telegram with this content never occurs inside another one. If a longer,
    /// incomplete telegram seems to contain it, the length of the longer one is wrong. Without
    /// this, a damaged length would cost as many bytes as it claims.
    fn stands_alone(&self, _content: &[u8]) -> bool {
        false
    }

    /// Parses the content of a telegram that was judged valid.
    fn read<'a>(&self, content: &'a [u8]) -> Result<Self::Telegram<'a>, SickError>;
}

/// Part of the stream that has not been judged.
#[derive(Debug, Clone, Copy)]
pub struct Pending<'a> {
    /// All received bytes from here on.
    pub bytes: &'a [u8],
    /// Offset of the first one in the stream.
    pub offset: u64,
    /// True if the previous byte ended a telegram.
    pub in_step: bool,
}

/// Classification of the bytes at the current position.
#[derive(Debug)]
pub enum Judgement {
    /// A telegram; its bytes before, of and after the content.
    Frame {
        prefix: usize,
        length: usize,
        suffix: usize,
    },
    Incomplete,
    Rejected(SickError),
}

/// Telegram with a valid checksum and a content that can be parsed.
#[derive(Debug, Clone)]
pub struct Frame<'a, T> {
    /// Offset of its first byte in the stream.
    pub offset: u64,
    pub content: &'a [u8],
    pub telegram: T,
    /// Number of bytes since the previous telegram that belong to no telegram.
    pub skipped: u64,
}

/// Push parser: [`Framer::push`] takes bytes, [`Framer::next_frame`] returns the telegrams in them.
#[derive(Debug)]
pub struct Framer<P> {
    protocol: P,
    bytes: Vec<u8>,
    /// Index of the first byte that has not been judged.
    at: usize,
    /// Number of bytes of the stream before `bytes`.
    released: u64,
    /// Number of bytes rejected since the last telegram.
    skipped: u64,
    /// Index of the first byte after `at` where a standalone telegram may begin.
    looked: usize,
    ended: bool,
}

impl<P: Protocol> Framer<P> {
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

    pub fn push(&mut self, piece: &[u8]) {
        self.release();
        self.bytes.extend_from_slice(piece);
    }

    /// Marks the end of the stream: incomplete telegrams are now errors.
    pub fn finish(&mut self) {
        self.ended = true;
    }

    /// Returns the next telegram or the next error; `None` until more bytes arrive.
    ///
    /// Errors are the first reason for losing synchronization, and each wrong checksum or unreadable
    /// content. After that, bytes are skipped silently up to the next telegram, which reports their
    /// number.
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

    /// Looks for a standalone telegram inside the pending one, whose claimed length may be wrong.
    /// If there is one, continues there and returns the error.
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
            telegram: self.protocol.read(content)?,
            skipped: std::mem::take(&mut self.skipped),
        })
    }

    /// Drops judged bytes once they are more than the bytes that have to be moved.
    fn release(&mut self) {
        if self.at > self.bytes.len() / 2 {
            self.bytes.drain(..self.at);
            self.released += self.at as u64;
            self.looked = self.looked.saturating_sub(self.at);
            self.at = 0;
        }
    }
}

impl<P: Protocol + Default> Default for Framer<P> {
    fn default() -> Self {
        Framer::of(P::default())
    }
}

/// Returns true if a telegram was most likely sent here but cannot be used.
fn is_a_lost_telegram(error: &SickError) -> bool {
    matches!(
        error,
        SickError::Checksum { .. } | SickError::Unreadable { .. } | SickError::CutOff { .. }
    )
}
