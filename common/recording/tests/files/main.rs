//! Recordings as files: of others, of robots, damaged ones.

mod bags;
mod claims;
mod conformance;
mod real_recordings;
