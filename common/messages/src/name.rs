//! A short name inside a message.

use bytemuck::{Pod, Zeroable};
use iceoryx2_bb_derive_macros::ZeroCopySend;
use iceoryx2_bb_elementary_traits::zero_copy_send::ZeroCopySend;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// UTF-8 text of at most 32 bytes, filled up with zeros: a frame or a node.
#[derive(Clone, Copy, PartialEq, Eq, Pod, Zeroable, ZeroCopySend)]
#[type_name("Name/v1")]
#[repr(C)]
pub struct Name([u8; 32]);

impl Name {
    /// Bytes that fit.
    pub const CAPACITY: usize = 32;

    /// As much of `text` as fits, cut between characters.
    #[must_use]
    pub fn new(text: &str) -> Self {
        let mut bytes = [0; Self::CAPACITY];
        let end = text.floor_char_boundary(Self::CAPACITY);
        bytes[..end].copy_from_slice(&text.as_bytes()[..end]);
        Name(bytes)
    }

    /// The text before the first zero; empty if a foreign writer put in what
    /// is not UTF-8.
    #[must_use]
    pub fn as_str(&self) -> &str {
        let end = self
            .0
            .iter()
            .position(|&b| b == 0)
            .unwrap_or(Self::CAPACITY);
        std::str::from_utf8(&self.0[..end]).unwrap_or("")
    }
}

impl Serialize for Name {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl<'de> Deserialize<'de> for Name {
    /// Text that does not fit is refused, not cut.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        if text.len() > Self::CAPACITY {
            let length = text.len();
            let most = Self::CAPACITY;
            let problem = format!("a name of {length} bytes: allowed are at most {most}");
            return Err(D::Error::custom(problem));
        }
        Ok(Name::new(&text))
    }
}

impl std::fmt::Debug for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Debug::fmt(self.as_str(), f)
    }
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_short_text_and_cuts_long_text_between_characters() {
        assert_eq!(Name::new("laser").as_str(), "laser");
        let long = "ä".repeat(20);
        assert_eq!(Name::new(&long).as_str(), "ä".repeat(16));
        assert_eq!(Name::new(&format!("x{long}")).as_str().len(), 31);
    }

    #[test]
    fn foreign_bytes_do_not_panic() {
        assert_eq!(Name([0xff; 32]).as_str(), "");
    }
}
