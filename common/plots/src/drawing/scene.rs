//! Items of a picture, from back to front.

use std::mem;

use svg::node::element::{ClipPath, Group, Title};
use svg::{Document, Node};

use crate::drawing::encoding::check_size;
use crate::drawing::path::rounded;
use crate::drawing::vector::{filled, picture, rectangle, stroked};
use crate::drawing::{Color, Path, Rect, Stroke, TextStyle, text};

#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    pub text: String,
    /// From the top of capitals to the bottom of descenders.
    pub area: Rect,
}

/// A picture under construction, on white.
#[derive(Debug, Clone)]
pub struct Scene {
    width: u32,
    height: u32,
    title: String,
    items: Group,
    /// Number of clips, whose names are 1, 2, …
    clips: u32,
    labels: Vec<Label>,
}

impl Scene {
    /// An empty picture of `width · height` pixels; SVG viewers show the title.
    pub fn new(width: u32, height: u32, title: impl Into<String>) -> anyhow::Result<Self> {
        check_size(width, height)?;
        Ok(Scene {
            width,
            height,
            title: title.into(),
            items: Group::new(),
            clips: 0,
            labels: Vec::new(),
        })
    }

    pub fn width(&self) -> u32 {
        self.width
    }

    pub fn height(&self) -> u32 {
        self.height
    }

    pub fn area(&self) -> Rect {
        Rect::new(0.0, 0.0, self.width.into(), self.height.into())
    }

    pub fn labels(&self) -> &[Label] {
        &self.labels
    }

    /// Crops or extends the picture at the bottom.
    pub fn set_height(&mut self, height: u32) -> anyhow::Result<()> {
        check_size(self.width, height)?;
        self.height = height;
        Ok(())
    }

    pub fn fill(&mut self, path: Path, color: Color) {
        if !path.is_empty() {
            self.items.append(filled(path, color));
        }
    }

    pub fn stroke(&mut self, path: Path, stroke: Stroke) {
        if !path.is_empty() {
            self.items.append(stroked(path, stroke));
        }
    }

    /// Draws an image from the opaque colour of each of its pixels, given by column and row. It has as
    /// many pixels as the rectangle has whole ones, and is stretched over it without smoothing.
    pub fn image(
        &mut self,
        over: Rect,
        color: impl FnMut(u32, u32) -> Color,
    ) -> anyhow::Result<()> {
        self.items.append(picture(over, color)?);
        Ok(())
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
        let turn = format!("rotate(-90 {} {})", rounded(at.0), rounded(at.1));
        let turned = Group::new().set("transform", turn);
        self.grouped(turned, |scene| {
            scene.letters(text::outline(content, at, style), style);
        });
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

    pub fn clipped(&mut self, area: Rect, draw: impl FnOnce(&mut Scene)) {
        self.clips += 1;
        let name = format!("clip{}", self.clips);
        let inside = Group::new().set("clip-path", format!("url(#{name})"));
        let clip = ClipPath::new().set("id", name).add(rectangle(area));
        self.items.append(clip);
        self.grouped(inside, draw);
    }

    fn grouped(&mut self, group: Group, draw: impl FnOnce(&mut Scene)) {
        let outside = mem::replace(&mut self.items, group);
        draw(self);
        let inside = mem::replace(&mut self.items, outside);
        self.items.append(inside);
    }
}

/// Encodes an SVG file without external references.
pub fn to_svg(scene: &Scene) -> String {
    let (width, height) = (scene.width, scene.height);
    let document = Document::new()
        .set("width", width)
        .set("height", height)
        .set("viewBox", (0, 0, width, height))
        .add(Title::new(&*scene.title))
        .add(filled(Path::rect(scene.area()), Color::WHITE))
        .add(scene.items.clone());
    format!("{document}\n")
}

#[cfg(test)]
pub(crate) mod tests {
    use svg::node::element::tag::Type;
    use svg::parser::Event;

    use super::*;
    use crate::drawing::encoding::MAX_SIDE;

    pub(crate) const RED: Color = Color::rgb(0xFF_0000);
    pub(crate) const BLUE: Color = Color::rgb(0x00_00FF);

    /// A scene with one item of each kind.
    pub(crate) fn everything() -> Scene {
        let mut scene = Scene::new(40, 30, "a <title>").unwrap();
        scene.fill(Path::rect(Rect::new(0.0, 0.0, 10.0, 10.0)), RED);
        let line = Path::line((20.0, 0.0), (20.0, 30.0));
        scene.stroke(line, Stroke::new(BLUE, 2.0));
        let colors = |x: u32, _| if x < 4 { RED } else { BLUE };
        let image = Rect::new(24.0, 4.0, 8.0, 4.0);
        scene.image(image, colors).unwrap();
        scene.clipped(Rect::new(30.0, 20.0, 5.0, 5.0), |scene| {
            scene.fill(Path::circle((32.0, 22.0), 20.0), RED.with_opacity(0.5));
        });
        scene.text("E", (2.0, 28.0), &TextStyle::new(16.0, BLUE).bold());
        scene
    }

    #[test]
    fn sides_out_of_range_are_refused() {
        let error = |width, height| Scene::new(width, height, "").unwrap_err().to_string();
        let expected = "a picture of 0 x 9 pixels; allowed: 1 to 16384 along each side";
        assert_eq!(error(0, 9), expected);
        assert!(error(9, MAX_SIDE + 1).contains("9 x 16385"));
        let mut scene = Scene::new(9, 9, "").unwrap();
        scene.set_height(14).unwrap();
        assert_eq!((scene.width(), scene.height()), (9, 14));
        assert!(scene.set_height(0).is_err());
        let thin = scene.image(Rect::new(0.0, 0.0, 0.9, 9.0), |_, _| RED);
        assert!(thin.is_err());
    }

    #[test]
    fn the_file_holds_each_item_and_reads_back() {
        let text = to_svg(&everything());
        let mut names = Vec::new();
        for event in svg::read(&text).unwrap() {
            match event {
                Event::Tag(name, kind, _) if kind != Type::End => names.push(name),
                Event::Error(error) => panic!("{error}"),
                _ => {}
            }
        }
        let expected = [
            "svg", "title", "path", "g", "path", "path", "image", "clipPath", "rect", "g", "path",
            "path",
        ];
        assert_eq!(names, expected);
        assert!(text.contains("a &lt;title&gt;"), "{text}");
        assert!(
            text.contains(r##"fill="#ff0000" fill-opacity="0.5""##),
            "{text}"
        );
        assert_eq!(text, to_svg(&everything()));
    }
}
