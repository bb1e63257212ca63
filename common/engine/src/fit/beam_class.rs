//! How single beams agree with the map.

/// What became of a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BeamClass {
    /// It ends at an obstacle.
    Hit,
    /// It ends in the open: something stands there that the map does not have.
    Short,
    /// It passes through an obstacle of the map.
    Through,
    /// It ends behind unknown space, where the map says nothing.
    Unknown,
}
