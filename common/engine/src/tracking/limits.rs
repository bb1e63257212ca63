//! Number of places kept, and smallest weights.

/// Largest number of places kept, and the largest numbers of old and new ones (older than one key
/// scan or not). Old places keep their slots, so that a search does not evict them and re-create
/// them as new.
pub(super) const MAX: usize = MAX_OLD + MAX_NEW;
pub(super) const MAX_OLD: usize = 20;
pub(super) const MAX_NEW: usize = 12;

/// Log odds against an event that can always happen between two key scans: the robot is carried
/// away, or a sensor fails.
pub(super) const SELDOM: f64 = 7.0;

/// Log odds against an operator who is wrong, or a robot that was moved while switched off.
pub(super) const EXPECTED: f64 = 3.5;

/// Log odds behind the best at which a place is dropped.
pub(super) const FARTHEST_BEHIND: f64 = 12.0;
