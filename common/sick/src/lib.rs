//! Telegrams of SICK's laser scanners, in both directions.
//!
//! Pure: bytes in, typed telegrams or located errors out, and back. It opens nothing and uses no
//! clock. It does not interpret values, except that it knows which device angle points ahead if a
//! document states it.
//!
//! | module | devices and content | framing |
//! |---|---|---|
//! | [`cola`] | LMS1xx, LMS5xx, TiM and others: commands, answers, `LMDscandata` | CoLa A (text) and CoLa B (binary): one model, two encodings |
//! | [`lms2xx`] | LMS200, 211, 220, 221, 291: commands, answers, scans | serial telegrams with a CRC |
//! | [`framer`] | all of them | finds telegrams in a stream, also after garbage |
//!
//! Reading allocates nothing: telegrams borrow the framer's buffer, and output goes into a buffer
//! of the caller.

pub mod cola;
mod cursor;
mod error;
pub mod framer;
pub mod lms2xx;

pub use error::SickError;
pub use framer::{Frame, Framer};
