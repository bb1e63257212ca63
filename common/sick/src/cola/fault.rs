//! Error codes by which a device rejects a command.

use std::fmt;

/// SICK error code; it displays with its meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fault(pub u16);

/// Meanings by error code (SICK, "Telegram listing", error codes).
const MEANINGS: [&str; 27] = [
    "no error",
    "the user level does not allow this method",
    "unknown method",
    "unknown variable",
    "a condition is violated, such as a value out of its range",
    "invalid data",
    "unknown error",
    "too many bytes",
    "too few bytes",
    "unknown type",
    "the user level does not allow writing this variable",
    "unknown command for the name server",
    "unknown CoLa command",
    "the method is still busy",
    "an array is longer than allowed",
    "unknown event",
    "a number of CoLa A is too large",
    "an invalid character in CoLa A",
    "no message from the operating system",
    "no answer from the operating system",
    "internal error",
    "the hub address is corrupted",
    "the hub address cannot be decoded",
    "the hub address is too long",
    "a blank is missing in the hub address",
    "asynchronous methods are suppressed",
    "complex arrays are not supported",
];

impl Fault {
    pub const METHOD_DENIED: Fault = Fault(1);
    pub const UNKNOWN_METHOD: Fault = Fault(2);
    pub const UNKNOWN_VARIABLE: Fault = Fault(3);
    pub const OUT_OF_RANGE: Fault = Fault(4);
    pub const INVALID_DATA: Fault = Fault(5);
    pub const WRITE_DENIED: Fault = Fault(0xa);
    pub const UNKNOWN_COMMAND: Fault = Fault(0xc);
    pub const UNKNOWN_EVENT: Fault = Fault(0xf);
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let meaning = MEANINGS.get(usize::from(self.0));
        let meaning = meaning.copied().unwrap_or("not in SICK's listing");
        write!(f, "{:#x}: {meaning}", self.0)
    }
}
