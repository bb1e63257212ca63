//! Items of a picture, from back to front.

use crate::size::check_size;
use crate::{Color, DrawingError, Image, Path, Rect, TextStyle, text};

/// Style of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    pub color: Color,
    /// In pixels.
    pub width: f64,
    /// Length of dashes and of gaps, in pixels; 0 draws a solid line.
    pub dash: f64,
}

impl Stroke {
    #[must_use]
    pub const fn new(color: Color, width: f64) -> Self {
        Stroke {
            color,
            width,
            dash: 0.0,
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Item {
    Fill(Path, Color),
    Stroke(Path, Stroke),
    /// Stretched over the rectangle.
    Image(Image, Rect),
    /// Items clipped to the rectangle.
    Clip(Rect, Vec<Item>),
}

/// A line of text in a picture, with its area.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    pub text: String,
    /// From the top of capitals to the bottom of descenders.
    pub area: Rect,
}

/// A picture under construction.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    width: u32,
    height: u32,
    title: String,
    /// The first item is the background.
    items: Vec<Item>,
    labels: Vec<Label>,
}

impl Scene {
    /// An empty picture of `width · height` pixels on a background. The title is shown by SVG
    /// viewers; it is not drawn.
    ///
    /// # Errors
    /// A side is 0 or above [`MAX_SIDE`](crate::MAX_SIDE).
    pub fn new(
        width: u32,
        height: u32,
        title: impl Into<String>,
        background: Color,
    ) -> Result<Self, DrawingError> {
        check_size(width, height)?;
        let mut scene = Scene {
            width,
            height,
            title: title.into(),
            items: Vec::new(),
            labels: Vec::new(),
        };
        scene.fill(Path::rect(scene.area()), background);
        Ok(scene)
    }

    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Area of the whole picture.
    #[must_use]
    pub fn area(&self) -> Rect {
        Rect::new(0.0, 0.0, self.width.into(), self.height.into())
    }

    /// All text of the picture, in drawing order.
    #[must_use]
    pub fn labels(&self) -> &[Label] {
        &self.labels
    }

    /// Crops or extends the picture at the bottom.
    ///
    /// # Errors
    /// The height is 0 or above [`MAX_SIDE`](crate::MAX_SIDE).
    pub fn set_height(&mut self, height: u32) -> Result<(), DrawingError> {
        check_size(self.width, height)?;
        self.height = height;
        let area = self.area();
        if let Some(Item::Fill(background, _)) = self.items.first_mut() {
            *background = Path::rect(area);
        }
        Ok(())
    }

    pub(crate) fn title(&self) -> &str {
        &self.title
    }

    pub(crate) fn items(&self) -> &[Item] {
        &self.items
    }

    pub fn fill(&mut self, path: Path, color: Color) {
        if !path.is_empty() {
            self.items.push(Item::Fill(path, color));
        }
    }

    pub fn stroke(&mut self, path: Path, stroke: Stroke) {
        if !path.is_empty() {
            self.items.push(Item::Stroke(path, stroke));
        }
    }

    /// Draws an image, stretched over a rectangle without smoothing.
    pub fn image(&mut self, image: Image, over: Rect) {
        self.items.push(Item::Image(image, over));
    }

    /// Writes a line of text at a point of its baseline.
    pub fn text(&mut self, content: &str, at: (f64, f64), style: &TextStyle) {
        self.label(content, style.area_of(content, at));
        self.letters(text::outline(content, at, style), style);
    }

    /// Writes a line of text upwards from a point of its baseline.
    pub fn text_upwards(&mut self, content: &str, at: (f64, f64), style: &TextStyle) {
        let flat = style.area_of(content, at);
        let (ahead, down) = (flat.right() - at.0, flat.y - at.1);
        let turned = Rect::new(at.0 + down, at.1 - ahead, flat.height, flat.width);
        self.label(content, turned);
        self.letters(text::outline(content, at, style).turned_up(at), style);
    }

    fn label(&mut self, text: &str, area: Rect) {
        let text = text.to_owned();
        self.labels.push(Label { text, area });
    }

    fn letters(&mut self, path: Path, style: &TextStyle) {
        if let Some((color, width)) = style.halo {
            self.stroke(path.clone(), Stroke::new(color, width));
        }
        self.fill(path, style.color);
    }

    /// Clips everything that `draw` adds to `area`.
    pub fn clipped(&mut self, area: Rect, draw: impl FnOnce(&mut Scene)) {
        let outside = std::mem::take(&mut self.items);
        draw(self);
        let inside = std::mem::replace(&mut self.items, outside);
        self.items.push(Item::Clip(area, inside));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Anchor, MAX_SIDE};

    #[test]
    fn sides_out_of_range_are_refused() {
        let error = |width, height| {
            let scene = Scene::new(width, height, "", Color::WHITE);
            scene.unwrap_err().to_string()
        };
        assert_eq!(
            error(0, 9),
            "a picture of 0 x 9 pixels; allowed: 1 to 16384 along each side"
        );
        assert!(error(9, MAX_SIDE + 1).contains("9 x 16385"));
    }

    #[test]
    fn the_background_fills_a_picture_of_another_height() {
        let mut scene = Scene::new(9, 9, "", Color::WHITE).unwrap();
        scene.set_height(14).unwrap();
        assert_eq!(scene, Scene::new(9, 14, "", Color::WHITE).unwrap());
        assert!(scene.set_height(0).is_err());
    }

    #[test]
    fn labels_are_where_their_letters_are() {
        let style = TextStyle::new(100.0, Color::rgb(0));
        let at = (200.0, 300.0);
        let mut scene = Scene::new(900, 900, "", Color::WHITE).unwrap();
        scene.text("Ep", at, &style.anchored(Anchor::End));
        scene.text_upwards("Ep", at, &style);
        let width = style.width_of("Ep");
        let [flat, turned] = scene.labels() else {
            panic!("{:?}", scene.labels());
        };
        assert_eq!(flat.area, Rect::new(200.0 - width, 226.0, width, 98.0));
        let expected = Rect::new(126.0, 300.0 - width, 98.0, width);
        // Tolerance for rounding.
        let off = (turned.area.y - expected.y).abs() + (turned.area.x - expected.x).abs();
        assert!(off < 1e-9, "{turned:?}");
        assert!((turned.area.height - width).abs() < 1e-9 && turned.area.width == 98.0);
    }

    #[test]
    fn what_is_clipped_is_one_item() {
        let mut scene = Scene::new(9, 9, "", Color::WHITE).unwrap();
        let area = Rect::new(1.0, 1.0, 2.0, 2.0);
        scene.clipped(area, |scene| {
            scene.fill(Path::circle((2.0, 2.0), 5.0), Color::rgb(0));
            scene.fill(Path::new(), Color::rgb(0));
        });
        assert_eq!(scene.items().len(), 2, "the background and the clip");
        let Some(Item::Clip(clip, inside)) = scene.items().last() else {
            panic!("no clip: {scene:?}");
        };
        assert_eq!((*clip, inside.len()), (area, 1), "an empty path is nothing");
    }
}
