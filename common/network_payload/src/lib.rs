//! Messages as they cross a network: bytes that anybody can read, and the checks
//! that whoever receives them makes before anything is used.
//!
//! A payload is [postcard](https://postcard.jamesmunns.com/wire-format): the
//! fields of [`Preamble`], those of the topic's header, the items as a sequence.
//! Its encoding names the schema and its version, [`encoding`], so that a reader
//! knows without looking inside; what is worth it is compressed with zstd, and
//! the encoding says so.
//!
//! | encoding | payload |
//! |---|---|
//! | `application/postcard;backcast.Scan/v2` | as above |
//! | `application/postcard+zstd;backcast.Map/v1` | one zstd frame of it |
//!
//! What is sent is not trusted: another schema, a payload or an item too many, a
//! invalid number and a header that contradicts its items are refused, and
//! nothing is reserved that the bytes do not bring along. The crate opens no
//! socket and reads no clock.

mod bytes;
mod checks;
mod error;
mod key;
mod payload;
mod sequence;
mod topics;

pub use error::WireError;
pub use key::{MAX_NAME_BYTES, alive, key, locate, name, robot, robot_or_host};
pub use payload::{Preamble, Received, decode, encode, encoding};
pub use sequence::{Arrival, Arrivals};
pub use topics::{Visit, Wire, by_name};
