//! Encodes scenes as an animated PNG.

use std::io::Cursor;
use std::iter;
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
/// the first frame. Unchanged pixels of further frames are transparent, which takes little room.
/// Fails if there is no frame, one has another size than the first, or an item of `frames` is an
/// error.
pub fn to_animated_png(
    mut frames: impl ExactSizeIterator<Item = anyhow::Result<Frame>>,
) -> anyhow::Result<Vec<u8>> {
    let count = frames.len();
    let first = frames
        .next()
        .context("an animation needs at least one picture")??;
    let sides = (first.0.width(), first.0.height());
    let mut before: Option<Pixmap> = None;
    let mut bytes = Vec::new();
    let mut encoder = encoder(Cursor::new(&mut bytes), sides, ColorType::Rgba);
    let endless = 0;
    let count = u32::try_from(count).unwrap_or(u32::MAX);
    encoder.set_animated(count, endless).context(NOT_ENCODED)?;
    encoder.set_blend_op(BlendOp::Over).context(NOT_ENCODED)?;
    let mut writer = encoder.write_header().context(NOT_ENCODED)?;
    for frame in iter::once(Ok(first)).chain(frames) {
        let (scene, shown) = frame?;
        let now = pixels(&scene)?;
        let (width, height) = (now.width(), now.height());
        if (width, height) != sides {
            bail!("a picture of {width} x {height} pixels in an animation of another size");
        }
        let milliseconds = u16::try_from(shown.as_millis()).unwrap_or(u16::MAX);
        writer
            .set_frame_delay(milliseconds, 1000)
            .context(NOT_ENCODED)?;
        let changed = changed(before.as_ref(), &now);
        writer.write_image_data(&changed).context(NOT_ENCODED)?;
        before = Some(now);
    }
    writer.finish().context(NOT_ENCODED)?;
    Ok(bytes)
}

/// The image, with unchanged pixels transparent.
fn changed(before: Option<&Pixmap>, now: &Pixmap) -> Vec<u8> {
    let mut rgba = now.data().to_vec();
    let before = before
        .into_iter()
        .flat_map(|before| before.data().chunks(4));
    for (before, now) in before.zip(rgba.chunks_mut(4)) {
        if before == now {
            now.fill(0);
        }
    }
    rgba
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
        for (i, scene) in scenes.iter().enumerate() {
            let mut frame = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut frame).unwrap();
            let control = *reader.info().frame_control().unwrap();
            assert_eq!(
                (control.delay_num, control.delay_den),
                (100 * (i as u16 + 1), 1000)
            );
            let changes = frame.chunks(4).filter(|pixel| pixel[3] > 0).count();
            assert_eq!(changes, [63, 2, 0, 2][i]);
            for (pixel, shown) in frame.chunks(4).zip(shown.chunks_mut(4)) {
                if pixel[3] > 0 {
                    shown.copy_from_slice(pixel);
                }
            }
            assert_eq!(shown, pixels(scene).unwrap().data(), "{i}");
        }
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
