//! Draws a scan in Braille patterns of two by four dots, with the laser in the middle. Pure.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Circle, Points};

/// A scan: bearings in radians counter-clockwise from ahead, and distances in metres.
#[derive(Default)]
pub(super) struct Seen {
    pub(super) points: Vec<(f64, f64)>,
    pub(super) up: String,
}

impl Seen {
    pub(super) fn draw(&self, columns: usize) -> String {
        // A character is about twice as high as wide, so dots are square.
        let area = Rect::new(0, 0, columns as u16, (columns / 2).max(2) as u16);
        let reach_m = self.reach();
        let high_m = reach_m * 2.0 * f64::from(area.height) / f64::from(area.width);
        let points = self.points.iter();
        let points: Vec<(f64, f64)> = points
            .map(|(bearing, range)| (-range * bearing.sin(), range * bearing.cos()))
            .collect();
        let color = Color::Reset;
        let canvas = Canvas::default()
            .marker(Marker::Braille)
            .x_bounds([-reach_m, reach_m])
            .y_bounds([-high_m, high_m])
            .paint(|context| {
                let coords = &points;
                context.draw(&Points { coords, color });
                // The laser is a ring with a radius of one dot and a half.
                let radius = 1.5 * reach_m / f64::from(area.width);
                context.draw(&Circle::new(0.0, 0.0, radius, color));
            });
        let mut buffer = Buffer::empty(area);
        canvas.render(area, &mut buffer);
        let rows = buffer.content.chunks(columns).map(|row| {
            let row: String = row.iter().map(Cell::symbol).collect();
            row.trim_end().to_owned() + "\n"
        });
        let text: String = rows.collect();
        let text = text.trim_matches('\n');
        format!(
            "{text}\n{}; from the laser (the ring) to the farthest side {reach_m:.1} m\n",
            self.up
        )
    }

    /// Returns the distance from the centre to the nearest side in metres, for nine in ten points.
    fn reach(&self) -> f64 {
        let mut ranges: Vec<f64> = self.points.iter().map(|(_, range)| *range).collect();
        ranges.sort_unstable_by(f64::total_cmp);
        let most = ranges.get(ranges.len().saturating_sub(1) * 9 / 10);
        most.map_or(1.0, |range| range * 1.1).max(0.1)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn seen(points: Vec<(f64, f64)>) -> Seen {
        Seen {
            points,
            up: "ahead is up".to_owned(),
        }
    }

    #[test]
    fn a_wall_ahead_is_a_line_above_the_laser() {
        let wall = (-40..=40).map(|deg| f64::from(deg).to_radians());
        let points = wall.map(|bearing| (bearing, 1.0 / bearing.cos())).collect();
        let picture = seen(points).draw(20);
        let lines: Vec<&str> = picture.lines().collect();
        // The wall is one row of characters above the laser; the area behind is empty.
        let is_long = |line: &&str| line.trim_matches(' ').chars().count() > 8;
        assert!(is_long(&lines[0]), "{picture}");
        let rows = lines[..lines.len() - 1].iter();
        assert_eq!(rows.filter(|line| is_long(line)).count(), 1);
        assert!(picture.contains("1.4 m"), "{picture}");
    }

    #[test]
    fn left_is_left() {
        let points = vec![(FRAC_PI_2, 1.0)];
        let picture = seen(points).draw(20);
        let (dots, _) = picture.split_once("\nahead").unwrap();
        let marks = dots.lines().flat_map(|line| line.chars().enumerate());
        let marks = marks.filter(|(_, c)| *c != ' ').map(|(column, _)| column);
        let (least, most) = (marks.clone().min().unwrap(), marks.max().unwrap());
        assert!(least < 3 && most <= 11, "{picture}");
    }

    #[test]
    fn nothing_seen_is_drawn_too() {
        let picture = seen(vec![]).draw(1);
        assert!(picture.contains("1.0 m"), "{picture}");
    }
}
