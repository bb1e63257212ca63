//! How many places are kept, and how far they lie apart.

/// Most places that are kept, and how many of them may be older than one key scan, and
/// new: those that a place was distinguished from do not give way to what each search finds again.
pub(super) const MAX: usize = MAX_OLD + MAX_NEW;
pub(super) const MAX_OLD: usize = 20;
pub(super) const MAX_NEW: usize = 12;

/// Natural logarithm of the odds against what can always happen between two key scans: the
/// robot is carried away, or a sensor fails.
pub(super) const SELDOM: f64 = 7.0;

/// Natural logarithm of the odds against an operator who is wrong, or a robot that was moved
/// while it was switched off.
pub(super) const EXPECTED: f64 = 3.5;

/// A place so far behind the best is dropped, natural logarithm of odds.
pub(super) const FARTHEST_BEHIND: f64 = 12.0;
