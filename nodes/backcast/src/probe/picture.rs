//! Draws a scan in Braille patterns of two by four dots, with the laser in the middle. Pure.

use std::f64::consts::{FRAC_PI_2, TAU};

/// Dots of a character: columns and rows.
const DOTS: (usize, usize) = (2, 4);
/// The bit of each dot, by row and column.
const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
/// Rows per column: a character is about twice as high as wide, so dots are square.
const ROWS_PER_COLUMN: f64 = 0.5;

/// A scan: bearings in radians counter-clockwise from ahead, and distances in metres.
#[derive(Default)]
pub(super) struct Seen {
    pub(super) points: Vec<(f64, f64)>,
    pub(super) up: String,
}

impl Seen {
    pub(super) fn draw(&self, columns: usize) -> String {
        let rows = ((columns as f64 * ROWS_PER_COLUMN) as usize).max(2);
        let reach_m = self.reach();
        let mut canvas = vec![0u8; columns * rows];
        let (width, height) = (columns * DOTS.0, rows * DOTS.1);
        let dots_per_m = (width.min(height) as f64 / 2.0 - 1.0) / reach_m;
        let mut set = |x_m: f64, y_m: f64| {
            let x = width as f64 / 2.0 + x_m * dots_per_m;
            let y = height as f64 / 2.0 - y_m * dots_per_m;
            if x < 0.0 || y < 0.0 {
                return;
            }
            let (x, y) = (x as usize, y as usize);
            let at = y / DOTS.1 * columns + x / DOTS.0;
            if x < width
                && let Some(character) = canvas.get_mut(at)
            {
                *character |= BITS[y % DOTS.1][x % DOTS.0];
            }
        };
        for (bearing, range) in &self.points {
            let angle = FRAC_PI_2 + bearing;
            set(range * angle.cos(), range * angle.sin());
        }
        // The laser is a ring one dot wide.
        for step in 0..16 {
            let angle = TAU * f64::from(step) / 16.0;
            set(
                1.5 / dots_per_m * angle.cos(),
                1.5 / dots_per_m * angle.sin(),
            );
        }
        let rows = canvas.chunks(columns).map(|row| {
            let row: String = row.iter().map(|&dots| braille(dots)).collect();
            row.trim_end_matches(braille(0)).to_owned() + "\n"
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

fn braille(dots: u8) -> char {
    char::from_u32(0x2800 + u32::from(dots)).unwrap_or(' ')
}

#[cfg(test)]
mod tests {
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
        let is_long = |line: &&str| line.trim_matches(braille(0)).chars().count() > 8;
        assert!(is_long(&lines[0]), "{picture}");
        let rows = lines[..lines.len() - 1].iter();
        assert_eq!(rows.filter(|line| is_long(line)).count(), 1);
        assert!(picture.contains("1.4 m"), "{picture}");
    }

    #[test]
    fn left_is_left() {
        let points = vec![(FRAC_PI_2, 1.0)];
        let picture = seen(points).draw(20);
        let middle = picture.lines().next().unwrap();
        let marks = middle.chars().enumerate().filter(|(_, c)| *c != braille(0));
        let marks: Vec<usize> = marks.map(|(i, _)| i).collect();
        assert!(marks[0] < 3 && *marks.last().unwrap() <= 11, "{picture}");
    }

    #[test]
    fn nothing_seen_is_drawn_too() {
        let picture = seen(vec![]).draw(1);
        assert!(picture.contains("1.0 m"), "{picture}");
    }
}
