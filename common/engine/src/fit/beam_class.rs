//! Classes of beams by their agreement with the map.

/// Class of a beam at a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BeamClass {
    /// The beam ends at an obstacle.
    Hit,
    /// The beam ends in the open, at something that is not on the map.
    Short,
    /// The beam passes through an obstacle of the map.
    Through,
    /// The beam ends behind unknown space, where the map has no information.
    Unknown,
}
