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
    pub const fn with_opacity(self, opacity: f32) -> Self {
        Color {
            opacity: opacity.clamp(0.0, 1.0),
            ..self
        }
    }

    /// Interpolates to another colour, including opacity; `share` is clamped to 0..=1.
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
