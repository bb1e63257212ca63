//! Telegrams of SICK's laser scanners, in both directions.
//!
//! Pure: bytes in, typed telegrams or located errors out, and back. It opens
//! nothing and knows no clock; what the values mean for a robot is not decided
//! here, but for which of a device's angles points ahead, where its documents say so.
//!
//! | module | of | framing |
//! |---|---|---|
//! | [`cola`] | LMS1xx, LMS5xx, TiM and others: commands, answers, `LMDscandata` | CoLa A (text) and CoLa B (binary): one model, two encodings |
//! | [`lms2xx`] | LMS200, 211, 220, 221, 291: commands, answers, scans | serial telegrams with a CRC |
//! | [`framer`] | all of them | finds telegrams in a stream, and finds them again after garbage |
//!
//! Reading allocates nothing: telegrams borrow the framer's buffer, and what is
//! written goes into a buffer that the caller keeps.

pub mod cola;
mod error;
pub mod framer;
pub mod lms2xx;

pub use error::SickError;
pub use framer::{Frame, Framer};
