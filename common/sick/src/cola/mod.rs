//! CoLa, the command language of SICK's newer devices, in both encodings.
//!
//! Commands, answers and scans are the same in both. Numbers are big-endian in CoLa B. In CoLa A
//! they are words of hexadecimal digits, or of decimal digits after a sign, each preceded by a
//! space.
//!
//! | host sends | device answers | |
//! |---|---|---|
//! | `sRN` name | `sRA` name value | reads a variable |
//! | `sWN` name value | `sWA` name | writes a variable |
//! | `sMN` name arguments | `sAN` name result | calls a method |
//! | `sEN` name 0 or 1 | `sEA` name 0 or 1, then `sSN` name value | subscribes to an event |
//! | anything | `sFA` code | the device rejects it |
//!
//! Only the telegrams for a stream of scans and its set-up are supported ([`Command`], [`Answer`]);
//! all others become [`Telegram::Other`]. [`KnownDevice`] lists how each device counts its angles,
//! [`DeviceAngles`] decides how a scan is read.

mod angle_convention;
mod answer;
mod channel;
pub(crate) mod cola_a;
mod cola_b;
mod command;
mod device_angles;
mod encoding;
mod fault;
mod known_device;
mod lmd_scan_data;
mod settings;
mod stream;
mod tail;
mod telegram;
mod values;
mod variable;
mod writer;

pub use angle_convention::{AngleConvention, Field, sweep_us};
pub use answer::Answer;
pub use channel::{Channel, Channels, FIRST_DISTANCE};
pub use command::{AUTHORIZED_CLIENT, Command, Method, PASSWORD_AUTHORIZED_CLIENT};
pub use device_angles::DeviceAngles;
pub use encoding::Encoding;
pub use fault::Fault;
pub use known_device::{KnownDevice, USUAL_REACH_M};
pub use lmd_scan_data::LmdScanData;
pub use settings::{OutputRange, ScanConfig, ScanDataConfig};
pub use stream::Framer;
pub use tail::DeviceTime;
pub use telegram::Telegram;
pub use values::Values;
pub use variable::{Value, Variable, state_word};
