//! The serial telegrams of the LMS200, 211, 220, 221 and 291.
//!
//! | bytes | field |
//! |---|---|
//! | 1 | start: `02` |
//! | 1 | address: `00` to the device, `80` or `81` from it |
//! | 2 | length of the payload, little-endian, 1 to 812 |
//! | n | payload: a code and its data; from the device also a status byte |
//! | 2 | CRC from the start through the payload, little-endian |
//!
//! The device acknowledges each telegram by a single byte: `06` if it is valid, `15` if not.
//! Numbers are little-endian throughout.
//!
//! | host | device | |
//! |---|---|---|
//! | `20` mode | `A0` result | operating mode, baud rate, installation |
//! | `30` kind | `B0` scan | one scan |
//! | `31` | `B1` status | settings and health |
//! | `3A` | `BA` text | type |
//! | `3B` width, resolution | `BB` result, width, resolution | field and step |
//! | `74` | `F4` configuration | |
//! | `77` configuration | `F7` result, configuration | only in installation mode |

mod answer;
mod command;
mod configuration;
mod framing;
mod partial;
mod range_mode;
mod scan;
mod status;
mod stream;

pub use answer::{Answer, Reply};
pub use command::{Baud, Command, DEFAULT_PASSWORD, Mode};
pub use configuration::Configuration;
pub use partial::PartialScans;
pub use range_mode::{RangeMode, Unit};
pub use scan::Scan;
pub use status::{DeviceStatus, Status};
pub use stream::{CommandFramer, FromDevice, FromHost, ReplyFramer};
