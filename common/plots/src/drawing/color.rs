/// An sRGB colour with an opacity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Color {
    pub red: u8,
    pub green: u8,
    pub blue: u8,
    /// From 0, transparent, to 1, opaque.
    pub opacity: f32,
}

impl Color {
    pub const WHITE: Color = Color::rgb(0xFF_FFFF);

    /// An opaque colour from `0xRRGGBB`.
    #[must_use]
    pub const fn rgb(hex: u32) -> Self {
        let [_, red, green, blue] = hex.to_be_bytes();
        Color {
            red,
            green,
            blue,
            opacity: 1.0,
        }
    }

    /// The colour with another opacity, clamped to 0..=1.
    #[must_use]
    pub const fn with_opacity(self, opacity: f32) -> Self {
        Color {
            opacity: opacity.clamp(0.0, 1.0),
            ..self
        }
    }

    /// Interpolates to another colour, including opacity; `share` is clamped to 0..=1.
    #[must_use]
    pub fn towards(self, other: Color, share: f64) -> Self {
        let share = share.clamp(0.0, 1.0);
        let part = |from: u8, to: u8| {
            (f64::from(from) + share * (f64::from(to) - f64::from(from))).round() as u8
        };
        Color {
            red: part(self.red, other.red),
            green: part(self.green, other.green),
            blue: part(self.blue, other.blue),
            opacity: self.opacity + share as f32 * (other.opacity - self.opacity),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_way_lies_in_the_middle() {
        let clear = Color::rgb(0x00_0000).with_opacity(0.0);
        let middle = clear.towards(Color::rgb(0xFF_0002), 0.5);
        assert_eq!((middle.red, middle.green, middle.blue), (128, 0, 1));
        assert_eq!(middle.opacity, 0.5);
        assert_eq!(clear.towards(Color::WHITE, 7.0), Color::WHITE);
    }
}
