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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_the_telegrams_in_the_manual() {
        assert_eq!(crc(&[2, 0, 2, 0, 0x20, 0x24]), 0x0834);
        assert_eq!(crc(&[2, 0, 1, 0, 0x31]), 0x1215);
        assert_eq!(crc(&[]), 0);
    }

    #[test]
    fn every_flipped_bit_shows() {
        let mut bytes: Vec<u8> = (0..=255).collect();
        let whole = crc(&bytes);
        for bit in 0..bytes.len() * 8 {
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert_ne!(crc(&bytes), whole, "bit {bit}");
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
    }
}
