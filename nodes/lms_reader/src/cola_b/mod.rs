//! The CoLa B protocol of SICK devices: bytes in, typed telegrams or located
//! errors out.
//!
//! Pure: it opens nothing and knows no clock. It understands what a stream of
//! scans needs; commands that log in or change parameters are left alone.
//! Numbers are big-endian throughout.
//!
//! | bytes | what |
//! |---|---|
//! | 4 | start: `02 02 02 02` |
//! | 4 | length of the content, u32 |
//! | n | content: a command of three letters, a space, a name, parameters |
//! | 1 | XOR of the content |

mod channel;
mod cursor;
mod framer;
mod lmd_scan_data;
mod tail;
mod telegram;

pub use channel::{Channel, Channels};
pub use framer::{Frame, Framer, MAX_CONTENT, MIN_CONTENT};
pub use lmd_scan_data::{Encoder, Encoders, LmdScanData};
pub use tail::{DeviceTime, Event, Position};
pub use telegram::{START_SCAN_DATA, Telegram, frame};
