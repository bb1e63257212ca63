//! What became of each beam of a scan.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{Pose2, Stamp};

/// Header of topic `beams`; the items are the beams that voted, by bearing, and
/// behind them those of which nothing returned.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("BeamsHeader/v1")
)]
#[repr(C)]
pub struct BeamsHeader {
    /// Of the scan.
    pub stamp: Stamp,
    /// The map that the beams were compared with; 0 where there was none.
    pub map_id: u64,
    /// The pose of the laser in the map at which they were: the best hypothesis.
    pub map_from_laser: Pose2,
}

/// One beam.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Beam/v1"))]
#[repr(C)]
pub struct Beam {
    /// In the laser's frame, counter-clockwise from ahead, radians.
    pub bearing: f32,
    /// Metres; infinity where nothing returned.
    pub range_m: f32,
    /// How much it counted, 0..=1.05; 0 where nothing returned.
    pub weight: f32,
    /// A [`BeamFate`].
    pub fate: u32,
}

/// What became of a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum BeamFate {
    /// It ends at an obstacle of the map.
    Hit = 0,
    /// It ends in the open: something stands there that the map does not have.
    Short = 1,
    /// It passes through an obstacle of the map.
    Through = 2,
    /// It ends behind unknown space, where the map says nothing.
    Unknown = 3,
    /// Nothing returned, or from farther than the map reaches.
    NoReturn = 4,
}

impl BeamFate {
    /// The fate with this number, if there is one.
    #[must_use]
    pub fn from_code(code: u32) -> Option<Self> {
        [
            Self::Hit,
            Self::Short,
            Self::Through,
            Self::Unknown,
            Self::NoReturn,
        ]
        .into_iter()
        .find(|fate| *fate as u32 == code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(BeamsHeader, size 56, align 8, { stamp: 0, map_id: 24, map_from_laser: 32 });

    mod beam {
        use super::*;
        crate::pin_layout!(Beam, size 16, align 4, { bearing: 0, range_m: 4, weight: 8, fate: 12 });
    }

    #[test]
    fn codes_name_their_fate() {
        assert_eq!(BeamFate::from_code(4), Some(BeamFate::NoReturn));
        assert_eq!(BeamFate::from_code(5), None);
    }
}
