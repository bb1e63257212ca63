//! Blocks that wait to be searched, the highest bound first.

/// A block in the queue. The one with the highest bound comes first, of equal ones the
/// smallest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::parts::search) struct Block {
    /// Votes that none of its poses exceeds.
    pub bound: u16,
    pub level: Level,
    pub index: u32,
}

/// Size of a block, and the places of the headings known for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::parts::search) enum Level {
    /// 16 × 16 cells.
    Coarse,
    /// 8 × 8 cells, at the headings of these windows.
    Fine { start: u32, end: u32 },
    /// 4 × 4 cells, at headings from this one on: those of the bits.
    Leaf { first: u16, among: u64 },
}
