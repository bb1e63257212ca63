//! Errors of both protocols.

use std::fmt::Display;

use anyhow::anyhow;

/// Message of a device that cannot be reached, or that closed the connection.
pub(crate) fn not_reached(address: &dyn Display) -> String {
    format!("{address}: no device can be reached; check its power, cable and address")
}

/// Error for a device that sent `received` bytes, but does not answer like a known laser.
pub(crate) fn not_understood(address: &dyn Display, received: usize, tried: &str) -> anyhow::Error {
    let came = match received {
        0 => "nothing came".to_owned(),
        n => format!("{n} bytes received that are not an answer: is it another device, or in use?"),
    };
    anyhow!("{address}: no laser answers; tried {tried}; {came}")
}
