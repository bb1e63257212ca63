//! CRC of the LMS2xx.
//!
//! Polynomial x¹⁶ + x¹⁵ + x² + 1, initial value 0; each step combines the current byte and, in the
//! high half, the previous one.

const POLYNOMIAL: u16 = 0x8005;

/// Returns the checksum of these bytes.
#[must_use]
pub fn crc(bytes: &[u8]) -> u16 {
    let mut crc = 0u16;
    let mut before = 0u16;
    for &byte in bytes {
        let overflow = (crc >> 15) * POLYNOMIAL;
        let byte = u16::from(byte);
        crc = crc << 1 ^ overflow ^ before << 8 ^ byte;
        before = byte;
    }
    crc
}
