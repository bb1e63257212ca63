//! A chart over time, with a scale of decades upwards.

use drawing::{Anchor, Path, Rect, Scene, Stroke, TextStyle};

use super::scale::round_step;
use super::theme;

/// A part of the picture with its scales.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chart {
    area: Rect,
    seconds: (f64, f64),
    /// Powers of ten at the lower and at the upper end.
    decades: (f64, f64),
}

impl Chart {
    /// A chart of values from the least to the most of what is given, above 0,
    /// in whole decades, over the time from 0 to `seconds`. No value is above
    /// `bound`, so the scale ends there.
    pub(super) fn new(area: Rect, seconds: f64, values: (f64, f64), bound: f64) -> Self {
        let low = values.0.log10().floor();
        let high = values.1.log10().ceil().min(bound.log10());
        Chart {
            area,
            seconds: (0.0, seconds.max(f64::MIN_POSITIVE)),
            decades: (low, high.max(low + 1.0)),
        }
    }

    /// Where a value lies in the picture; what is off the scale lies on its end.
    pub(super) fn at(&self, seconds: f64, value: f64) -> (f64, f64) {
        let (first, last) = self.seconds;
        let (low, high) = self.decades;
        let share_x = (seconds - first) / (last - first);
        let share_y = (value.log10().clamp(low, high) - low) / (high - low);
        (
            self.area.x + share_x * self.area.width,
            self.area.bottom() - share_y * self.area.height,
        )
    }

    /// Draws the grating and the numbers at both axes; the values' unit stands
    /// behind theirs as it is given.
    pub(super) fn draw_axes(&self, scene: &mut Scene, unit: f64, unit_of_values: &str) {
        let thin = Stroke::new(theme::GRATING, unit);
        let style = TextStyle::new(13.0 * unit, theme::QUIET);
        let (low, high) = self.decades;
        for decade in low as i32..=high.floor() as i32 {
            let value = 10f64.powi(decade);
            let (_, y) = self.at(0.0, value);
            let line = Path::line((self.area.x, y), (self.area.right(), y));
            scene.stroke(line, thin);
            let at = (self.area.x - 8.0 * unit, y + 4.5 * unit);
            let text = format!("{}{unit_of_values}", plain(value, decade));
            scene.text(&text, at, &style.anchored(Anchor::End));
        }
        // A whole second at least: scans seldom differ by less.
        let step = round_step(self.seconds.1 / 9.0).max(1.0);
        let mut second = 0.0;
        while second <= self.seconds.1 {
            let (x, _) = self.at(second, 1.0);
            let line = Path::line((x, self.area.y), (x, self.area.bottom()));
            scene.stroke(line, thin);
            let at = (x, self.area.bottom() + 17.0 * unit);
            scene.text(&format!("{second} s"), at, &style.anchored(Anchor::Middle));
            second += step;
        }
        let stroke = Stroke::new(theme::FRAME, unit.max(1.0));
        scene.stroke(Path::rect(self.area), stroke);
    }

    /// Draws a dashed line at a value with a word above it.
    pub(super) fn draw_limit(&self, scene: &mut Scene, unit: f64, value: f64, word: &str) {
        let (_, y) = self.at(0.0, value);
        let stroke = Stroke {
            dash: 6.0 * unit,
            ..Stroke::new(theme::QUIET, 1.2 * unit)
        };
        let line = Path::line((self.area.x, y), (self.area.right(), y));
        scene.stroke(line, stroke);
        let style = TextStyle::new(13.0 * unit, theme::QUIET)
            .anchored(Anchor::End)
            .with_halo(drawing::Color::WHITE, 4.0 * unit);
        let at = (self.area.right() - 6.0 * unit, y - 5.0 * unit);
        scene.text(word, at, &style);
    }
}

/// A power of ten without an exponent.
fn plain(value: f64, decade: i32) -> String {
    let decimals = usize::try_from(-decade).unwrap_or(0);
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_lie_by_their_decades_and_time_from_left_to_right() {
        let area = Rect::new(10.0, 20.0, 100.0, 60.0);
        let chart = Chart::new(area, 50.0, (0.02, 4.0), f64::INFINITY);
        assert_eq!(chart.decades, (-2.0, 1.0));
        let near = |(x, y): (f64, f64), ex: f64, ey: f64| (x - ex).hypot(y - ey) < 1e-9;
        assert!(near(chart.at(0.0, 0.01), 10.0, 80.0));
        assert!(near(chart.at(25.0, 0.1), 60.0, 60.0));
        assert!(near(chart.at(50.0, 10.0), 110.0, 20.0));
        assert!(near(chart.at(50.0, 1e9), 110.0, 20.0), "on the end");
        let bounded = Chart::new(area, 50.0, (0.02, 4.0), 5.0);
        assert!(near(bounded.at(50.0, 5.0), 110.0, 20.0));
    }

    #[test]
    fn steps_and_numbers_are_round() {
        assert_eq!(round_step(0.3), 0.5);
        assert_eq!(round_step(11.0), 20.0);
        assert_eq!(round_step(5.0), 5.0);
        assert_eq!(round_step(60.0), 100.0);
        assert_eq!(plain(0.001, -3), "0.001");
        assert_eq!(plain(100.0, 2), "100");
    }
}
