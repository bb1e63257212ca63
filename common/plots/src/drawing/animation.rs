//! Encodes scenes as an animated PNG.

use std::io::Cursor;
use std::time::Duration;

use anyhow::{Context, bail};
use png::{BlendOp, ColorType};
use resvg::tiny_skia::Pixmap;

use crate::drawing::Scene;
use crate::drawing::encoding::{NOT_ENCODED, encoder};
use crate::drawing::raster::pixels;

/// A scene and its duration, which is rounded down to milliseconds and limited to 65 s.
pub type Frame = (Scene, Duration);

/// Encodes an animated PNG file that repeats forever. Programs without support for animations show
/// the first frame. Further frames store only changed pixels.
/// Fails if there is no frame, one has another size than the first, or an item of `frames` is an
/// error.
pub fn to_animated_png(
    mut frames: impl ExactSizeIterator<Item = anyhow::Result<Frame>>,
) -> anyhow::Result<Vec<u8>> {
    let count = frames.len();
    let (scene, shown) = frames
        .next()
        .context("an animation needs at least one picture")??;
    let mut before = pixels(&scene)?;
    let mut bytes = Vec::new();
    let sides = (scene.width(), scene.height());
    let mut encoder = encoder(Cursor::new(&mut bytes), sides, ColorType::Rgba);
    let endless = 0;
    let count = u32::try_from(count).unwrap_or(u32::MAX);
    encoder.set_animated(count, endless).context(NOT_ENCODED)?;
    encoder.set_blend_op(BlendOp::Over).context(NOT_ENCODED)?;
    let mut writer = encoder.write_header().context(NOT_ENCODED)?;
    let milliseconds = |shown: Duration| u16::try_from(shown.as_millis()).unwrap_or(u16::MAX);
    let delay = milliseconds(shown);
    writer.set_frame_delay(delay, 1000).context(NOT_ENCODED)?;
    writer
        .write_image_data(before.data())
        .context(NOT_ENCODED)?;
    for frame in frames {
        let (scene, shown) = frame?;
        let now = pixels(&scene)?;
        let part = Part::changed(&before, &now)?;
        let delay = milliseconds(shown);
        writer.set_frame_delay(delay, 1000).context(NOT_ENCODED)?;
        // The encoder checks each position against the previous size.
        writer.reset_frame_position().context(NOT_ENCODED)?;
        let (width, height) = part.sides;
        writer
            .set_frame_dimension(width, height)
            .context(NOT_ENCODED)?;
        let (x, y) = part.corner;
        writer.set_frame_position(x, y).context(NOT_ENCODED)?;
        writer.write_image_data(&part.rgba).context(NOT_ENCODED)?;
        before = now;
    }
    writer.finish().context(NOT_ENCODED)?;
    Ok(bytes)
}

/// Smallest rectangle around all changes of an image, with unchanged pixels transparent.
struct Part {
    corner: (u32, u32),
    sides: (u32, u32),
    rgba: Vec<u8>,
}

impl Part {
    fn changed(before: &Pixmap, now: &Pixmap) -> anyhow::Result<Self> {
        let (width, height) = (now.width(), now.height());
        if (width, height) != (before.width(), before.height()) {
            bail!("a picture of {width} x {height} pixels in an animation of another size");
        }
        let differs = |x: u32, y: u32| before.pixel(x, y) != now.pixel(x, y);
        let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        // A frame without changes still needs one pixel.
        let mut corner = (width - 1, height - 1);
        let mut end = (1, 1);
        for (x, y) in all.filter(|&(x, y)| differs(x, y)) {
            corner = (corner.0.min(x), corner.1.min(y));
            end = (end.0.max(x + 1), end.1.max(y + 1));
        }
        let end = (end.0.max(corner.0 + 1), end.1.max(corner.1 + 1));
        let inside = (corner.1..end.1).flat_map(|y| (corner.0..end.0).map(move |x| (x, y)));
        let rgba = inside.flat_map(|(x, y)| {
            let changed = now.pixel(x, y).filter(|_| differs(x, y));
            changed.map_or([0; 4], |p| [p.red(), p.green(), p.blue(), p.alpha()])
        });
        Ok(Part {
            corner,
            sides: (end.0 - corner.0, end.1 - corner.1),
            rgba: rgba.collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Color, Path, Rect};

    const RED: Color = Color::rgb(0xFF_0000);

    /// A scene of 9 x 7 with these pixels red.
    fn scene(red: &[(f64, f64)]) -> Scene {
        let mut scene = Scene::new(9, 7, "").unwrap();
        for &(x, y) in red {
            scene.fill(Path::rect(Rect::new(x, y, 1.0, 1.0)), RED);
        }
        scene
    }

    fn animated(scenes: &[Scene]) -> anyhow::Result<Vec<u8>> {
        let frames = scenes
            .iter()
            .cloned()
            .zip((1..).map(|i| Duration::from_millis(100 * i)));
        let frames: Vec<_> = frames.map(Ok).collect();
        to_animated_png(frames.into_iter())
    }

    #[test]
    fn frames_come_back_one_over_the_other() {
        let scenes = [
            scene(&[(2.0, 2.0)]),
            scene(&[(4.0, 5.0)]),
            scene(&[(4.0, 5.0)]),
            scene(&[(8.0, 6.0), (0.0, 0.0), (4.0, 5.0)]),
        ];
        let bytes = animated(&scenes).unwrap();
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
        assert_eq!(reader.info().animation_control().unwrap().num_frames, 4);
        let mut shown = vec![0; 9 * 7 * 4];
        let mut places = Vec::new();
        for (scene, delay) in scenes.iter().zip([100, 200, 300, 400]) {
            let mut part = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut part).unwrap();
            let frame = *reader.info().frame_control().unwrap();
            assert_eq!((frame.delay_num, frame.delay_den), (delay, 1000));
            for (i, pixel) in part
                .chunks(4)
                .take((frame.width * frame.height) as usize)
                .enumerate()
            {
                let x = frame.x_offset as usize + i % frame.width as usize;
                let y = frame.y_offset as usize + i / frame.width as usize;
                if pixel[3] > 0 {
                    shown[4 * (9 * y + x)..][..4].copy_from_slice(pixel);
                }
            }
            assert_eq!(shown, pixels(scene).unwrap().data(), "{places:?}");
            places.push((frame.x_offset, frame.y_offset, frame.width, frame.height));
        }
        let expected = [(0, 0, 9, 7), (2, 2, 3, 4), (8, 6, 1, 1), (0, 0, 9, 7)];
        assert_eq!(places, expected);
    }

    #[test]
    fn frames_of_one_size_are_needed() {
        let other = Scene::new(9, 8, "").unwrap();
        let error = animated(&[scene(&[]), other]).unwrap_err().to_string();
        assert!(error.contains("9 x 8"), "{error}");
        let error = animated(&[]).unwrap_err().to_string();
        assert_eq!(error, "an animation needs at least one picture");
    }
}
