//! The intensity image as a binary message.

use messages::{FieldHeader, FieldKind};
use serde::Serialize;

/// Maximum number of pixels; a larger image is reduced by a whole factor.
const MAX_PIXELS: usize = 1 << 18;

#[derive(Debug, PartialEq, Serialize)]
struct Head {
    schema: u32,
    #[serde(rename = "type")]
    kind_of_message: &'static str,
    counter: u64,
    map_id: String,
    /// `exact` for one heading, or `upper_bound` for all headings.
    kind: &'static str,
    heading: f64,
    width: usize,
    height: usize,
    /// Map cells per pixel and axis.
    block: usize,
    best: u32,
    highest_possible: u32,
}

/// Returns a binary message: the length of the head in four bytes, little-endian, the head as JSON,
/// then one byte per pixel, row by row from the lowest y; 255 is the best value. A pixel of a
/// reduced image has the maximum of its cells.
///
/// `None` if header and items contradict each other.
pub(crate) fn frame(header: &FieldHeader, items: &[u16]) -> Option<Vec<u8>> {
    let (width, height) = (header.width as usize, header.height as usize);
    if width == 0 || height == 0 || width.checked_mul(height) != Some(items.len()) {
        return None;
    }
    let factor = (1..).find(|f| width.div_ceil(*f) * height.div_ceil(*f) <= MAX_PIXELS)?;
    let head = Head {
        schema: command_line::json::SCHEMA,
        kind_of_message: "field",
        counter: header.stamp.counter,
        map_id: format!("{:016x}", header.map_id),
        kind: match FieldKind::from_code(header.kind)? {
            FieldKind::Exact => "exact",
            FieldKind::UpperBound => "upper_bound",
        },
        heading: header.heading,
        width: width.div_ceil(factor),
        height: height.div_ceil(factor),
        block: (header.block as usize).checked_mul(factor)?,
        best: header.best,
        highest_possible: header.highest_possible,
    };
    let json = serde_json::to_vec(&head).ok()?;
    let mut bytes = (json.len() as u32).to_le_bytes().to_vec();
    bytes.extend(json);
    bytes.extend(pixels(items, width, factor, header.best));
    Some(bytes)
}

fn pixels(items: &[u16], width: usize, factor: usize, best: u32) -> Vec<u8> {
    let byte = |value: u16| (u32::from(value) * 255 / best.max(1)).min(255) as u8;
    let rows = items.chunks(width * factor);
    let mut pixels = Vec::new();
    for rows in rows {
        let mut highest = vec![0_u16; width.div_ceil(factor)];
        for row in rows.chunks(width) {
            for (highest, values) in highest.iter_mut().zip(row.chunks(factor)) {
                *highest = values.iter().copied().fold(*highest, u16::max);
            }
        }
        pixels.extend(highest.into_iter().map(byte));
    }
    pixels
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    fn header(width: u32, height: u32) -> FieldHeader {
        FieldHeader {
            width,
            height,
            block: 16,
            best: 200,
            ..FieldHeader::zeroed()
        }
    }

    fn split(bytes: &[u8]) -> (serde_json::Value, &[u8]) {
        let (length, rest) = bytes.split_at(4);
        let length = u32::from_le_bytes(length.try_into().unwrap()) as usize;
        let (head, pixels) = rest.split_at(length);
        (serde_json::from_slice(head).unwrap(), pixels)
    }

    #[test]
    fn a_small_image_keeps_its_pixels() {
        let bytes = frame(&header(3, 2), &[0, 100, 200, 300, 50, 25]).unwrap();
        let (head, pixels) = split(&bytes);
        assert_eq!(pixels, [0, 127, 255, 255, 63, 31]);
        assert_eq!((&head["width"], &head["block"]), (&3.into(), &16.into()));
        assert_eq!(head["type"], "field");
    }

    #[test]
    fn a_large_image_keeps_its_peaks() {
        let (width, height) = (1001, 1000);
        let mut items = vec![0; width * height];
        items[1000] = 200;
        let bytes = frame(&header(width as u32, height as u32), &items).unwrap();
        let (head, pixels) = split(&bytes);
        let columns = head["width"].as_u64().unwrap() as usize;
        assert_eq!(columns, 501);
        let expected = columns * head["height"].as_u64().unwrap() as usize;
        assert_eq!(pixels.len(), expected);
        assert!(pixels.len() <= MAX_PIXELS);
        assert_eq!(pixels[columns - 1], 255);
        assert_eq!(head["block"], 32);
    }

    #[test]
    fn contradictions_are_refused() {
        assert!(frame(&header(3, 2), &[0; 5]).is_none());
        assert!(frame(&header(0, 0), &[]).is_none());
        assert!(frame(&header(u32::MAX, u32::MAX), &[0; 5]).is_none());
        let unknown = FieldHeader {
            kind: 7,
            ..header(1, 1)
        };
        assert!(frame(&unknown, &[1]).is_none());
    }
}
