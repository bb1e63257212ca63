//! Short texts in messages: names of nodes, lasers, maps and frames.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

macro_rules! text {
    ($(#[$doc:meta])* $name:ident, $type_name:literal, $capacity:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
        #[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name($type_name))]
        #[repr(C)]
        pub struct $name([u8; $capacity]);

        impl $name {
            /// Largest length in bytes.
            pub const CAPACITY: usize = $capacity;

            /// Creates a name from the part of `text` that fits, cut at a character boundary.
            #[must_use]
            pub fn new(text: &str) -> Self {
                let mut bytes = [0; Self::CAPACITY];
                let end = text.floor_char_boundary(Self::CAPACITY);
                bytes[..end].copy_from_slice(&text.as_bytes()[..end]);
                $name(bytes)
            }

            /// Returns the text before the first zero; empty if it is not UTF-8.
            #[must_use]
            pub fn as_str(&self) -> &str {
                let zero = self.0.iter().position(|&b| b == 0);
                let end = zero.unwrap_or(Self::CAPACITY);
                std::str::from_utf8(&self.0[..end]).unwrap_or("")
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.as_str())
            }
        }

        impl<'de> Deserialize<'de> for $name {
            /// Rejects text that does not fit, instead of cutting it.
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let text = String::deserialize(deserializer)?;
                if text.len() > Self::CAPACITY {
                    let length = text.len();
                    let most = Self::CAPACITY;
                    let problem = format!("a name of {length} bytes: allowed are at most {most}");
                    return Err(D::Error::custom(problem));
                }
                Ok($name::new(&text))
            }
        }

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Debug::fmt(self.as_str(), f)
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.as_str())
            }
        }
    };
}

text! {
    /// UTF-8 text of at most 32 bytes, padded with zeros: name of a node or a laser.
    Name, "Name/v1", 32
}

text! {
    /// UTF-8 text of at most 64 bytes, padded with zeros: name of a map in a set.
    MapName, "MapName/v1", 64
}

text! {
    /// UTF-8 text of at most 256 bytes, padded with zeros: name of a frame. Simulators name frames
    /// by the path of the sensor (`vehicle/lidar_link/gpu_lidar`).
    FrameName, "FrameName/v1", 256
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
        let frame = "f".repeat(256);
        assert_eq!(FrameName::new(&frame).as_str(), frame);
    }

    #[test]
    fn foreign_bytes_do_not_panic() {
        assert_eq!(Name([0xff; 32]).as_str(), "");
    }
}
