//! Network format of messages, and the checks on received messages before use.
//!
//! A payload is in [postcard](https://postcard.jamesmunns.com/wire-format) format: the fields of
//! [`Preamble`], those of the topic's header, the items as a sequence. Its Zenoh [`encoding`] names
//! the schema and its version, so that a reader need not look inside. Large topics are compressed
//! with zstd, which is part of the encoding.
//!
//! | encoding | payload |
//! |---|---|
//! | `application/postcard;backcast.Scan/v2` | as above |
//! | `application/postcard+zstd;backcast.Map/v1` | one zstd frame of it |
//!
//! Senders are not trusted: wrong schemas, excess bytes or items, invalid numbers and headers that
//! contradict their items are rejected, and no memory is reserved beyond the received bytes. The
//! crate opens no socket and reads no clock.

mod bytes;
mod checks;
mod error;
mod key;
mod payload;
mod sequence;
mod topics;

pub use error::WireError;
pub use key::{MAX_NAME_BYTES, alive, key, locate, name, robot, robot_of_host};
pub use payload::{Preamble, Received, decode, encode, encoding};
pub use sequence::{Arrival, Arrivals};
pub use topics::{Visit, Wire, by_name};
