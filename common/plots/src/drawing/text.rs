//! Text as outlines of the embedded DejaVu Sans, from left to right without kerning; characters
//! missing in the font are an empty box.

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

use crate::drawing::{Color, Path, Rect};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextStyle {
    /// The em of the font, in pixels; capitals are 0.73 of it.
    pub size: f64,
    pub is_bold: bool,
    pub anchor: Anchor,
    pub color: Color,
    /// Colour and width of a rim behind the letters, for legibility on any background.
    pub halo: Option<(Color, f64)>,
}

impl TextStyle {
    /// Regular text that starts at its reference point, without a rim.
    pub const fn new(size: f64, color: Color) -> Self {
        TextStyle {
            size,
            is_bold: false,
            anchor: Anchor::Start,
            color,
            halo: None,
        }
    }

    pub const fn bold(self) -> Self {
        TextStyle {
            is_bold: true,
            ..self
        }
    }

    pub const fn anchored(self, anchor: Anchor) -> Self {
        TextStyle { anchor, ..self }
    }

    pub const fn with_halo(self, color: Color, width: f64) -> Self {
        let halo = Some((color, width));
        TextStyle { halo, ..self }
    }

    pub fn width_of(&self, content: &str) -> f64 {
        let face = face(self.is_bold);
        let advances = content.chars().map(|letter| advance(face, letter).1);
        advances.sum::<f64>() * self.scale(face)
    }

    /// Area of a line at a point of its baseline, from capitals to descenders.
    pub fn area_of(&self, content: &str, (x, y): (f64, f64)) -> Rect {
        let width = self.width_of(content);
        let (above, below) = (0.74 * self.size, 0.24 * self.size);
        Rect::new(x - self.before(width), y - above, width, above + below)
    }

    /// Part of the width to the left of the reference point.
    fn before(&self, width: f64) -> f64 {
        match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        }
    }

    fn scale(&self, face: &Face<'_>) -> f64 {
        self.size / f64::from(face.units_per_em())
    }
}

/// Outlines of a line of text at a point of its baseline.
pub(crate) fn outline(content: &str, (x, y): (f64, f64), style: &TextStyle) -> Path {
    let face = face(style.is_bold);
    let mut pen = Pen {
        path: Path::default(),
        at: (x - style.before(style.width_of(content)), y),
        scale: style.scale(face),
    };
    for letter in content.chars() {
        let (glyph, advance) = advance(face, letter);
        // A glyph without an outline, such as a space, only advances.
        face.outline_glyph(glyph, &mut pen);
        pen.at.0 += advance * pen.scale;
    }
    pen.path
}

fn face(is_bold: bool) -> &'static Face<'static> {
    static REGULAR: LazyLock<Face<'static>> = LazyLock::new(|| parse(dejavu::sans::regular()));
    static BOLD: LazyLock<Face<'static>> = LazyLock::new(|| parse(dejavu::sans::bold()));
    if is_bold { &BOLD } else { &REGULAR }
}

fn parse(font: &'static [u8]) -> Face<'static> {
    Face::parse(font, 0).expect("the font that is linked in is sound")
}

/// Glyph of a character, and its advance in the font's units.
fn advance(face: &Face<'_>, letter: char) -> (GlyphId, f64) {
    let glyph = face.glyph_index(letter).unwrap_or(GlyphId(0));
    let advance = face.glyph_hor_advance(glyph).unwrap_or_default();
    (glyph, advance.into())
}

/// Converts a glyph's outline from the font's units, y upwards, to the picture.
struct Pen {
    path: Path,
    at: (f64, f64),
    scale: f64,
}

impl Pen {
    fn push(&mut self, command: char, points: &[(f32, f32)]) {
        let (left, base) = self.at;
        let numbers = points.iter().flat_map(|&(x, y)| {
            let (right, up) = (self.scale * f64::from(x), self.scale * f64::from(y));
            [left + right, base - up]
        });
        self.path.push(command, &numbers.collect::<Vec<f64>>());
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.push('M', &[(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.push('L', &[(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.push('Q', &[(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.push('C', &[(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.push('Z', &[]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STYLE: TextStyle = TextStyle::new(100.0, Color::rgb(0));

    #[test]
    fn both_weights_have_what_is_written() {
        for is_bold in [false, true] {
            let face = face(is_bold);
            for letter in "Az09 .,:%°±²·–−…≥σθ√#×".chars() {
                assert!(face.glyph_index(letter).is_some(), "{is_bold} {letter}");
            }
        }
        assert!(STYLE.bold().width_of("word") > STYLE.width_of("word"));
        let unknown = outline("\u{10FFFF}", (0.0, 0.0), &STYLE);
        assert!(!unknown.is_empty(), "a box");
    }
}
