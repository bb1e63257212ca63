//! Numbers beside marks: each where it covers neither a mark nor another number, with a
//! line to its mark where it stands away from it.

use crate::drawing::{Anchor, Path, Rect, Scene, Stroke, TextStyle};

use super::theme;

/// Directions and distances tried around a mark, each farther by a share of the letters' size.
const DIRECTIONS: u32 = 16;
const DISTANCES: u32 = 12;
const STEP: f64 = 0.5;

/// Where something stands already.
#[derive(Debug, Clone)]
pub(super) struct Numbers {
    area: Rect,
    /// What is kept free by a mark: its middle and its radius.
    marks: Vec<((f64, f64), f64)>,
    written: Vec<Rect>,
}

impl Numbers {
    pub(super) fn new(area: Rect) -> Self {
        Numbers {
            area,
            marks: Vec::new(),
            written: Vec::new(),
        }
    }

    pub(super) fn keep_free(&mut self, at: (f64, f64), radius: f64) {
        self.marks.push((at, radius));
    }

    /// Writes a number beside the mark at a point, if there is room anywhere near.
    pub(super) fn write(
        &mut self,
        scene: &mut Scene,
        text: &str,
        mark: (f64, f64),
        style: &TextStyle,
    ) {
        let style = style.anchored(Anchor::Middle);
        let all = (0..DISTANCES * DIRECTIONS).map(|i| {
            let size = 0.9 * style.size;
            let distance = size * (1.0 + STEP * f64::from(i / DIRECTIONS));
            // The first is up to the right.
            let turn = f64::from(i % DIRECTIONS) / f64::from(DIRECTIONS) - 0.125;
            let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
            let base = (
                mark.0 + distance * cos,
                mark.1 + distance * sin + 0.25 * style.size,
            );
            (base, style.area_of(text, base))
        });
        let Some((base, area)) = all.into_iter().find(|(_, area)| self.is_free(area)) else {
            return;
        };
        let (x, y) = area.center();
        if (x - mark.0).hypot(y - mark.1) > 1.5 * style.size {
            let line = Path::line(mark, (x, y));
            scene.stroke(line, Stroke::new(theme::QUIET, 0.06 * style.size));
        }
        scene.text(text, base, &style);
        self.written.push(area);
    }

    fn is_free(&self, area: &Rect) -> bool {
        let (x, y) = area.center();
        let half = area.width.max(area.height) / 2.0;
        let is_clear =
            |&(mark, radius): &((f64, f64), f64)| (x - mark.0).hypot(y - mark.1) > half + radius;
        self.area.holds(area)
            && self.marks.iter().all(is_clear)
            && self.written.iter().all(|other| !other.overlaps(area))
    }
}
