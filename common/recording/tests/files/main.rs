//! Tests with recordings as files: of other writers, of robots, and damaged ones.

mod bags;
mod claims;
mod conformance;
mod real_recordings;
