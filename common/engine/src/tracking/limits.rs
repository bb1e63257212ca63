//! How many places are kept, and how far they lie apart.

/// Most places that are kept, and how many of them may be older than one key scan, and
/// new: those that a place was distinguished from do not give way to what each search finds again.
pub(super) const MAX: usize = MAX_OLD + MAX_NEW;
pub(super) const MAX_OLD: usize = 20;
pub(super) const MAX_NEW: usize = 12;

/// A place so far behind the best is dropped, natural logarithm of odds.
pub(super) const FARTHEST_BEHIND: f64 = 20.0;
