//! A city: streets between buildings, some of which are known inside.
//!
//! Returns the cells of a map, not a world with a given p/n: its purpose is its size, and that
//! robots can be in a small part of it only. Streets and the known inside of buildings are free,
//! walls are occupied, and all else is unknown.

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

use super::canvas::Rect;
use crate::RESOLUTION_M;

const FREE: u8 = 0;
const OCCUPIED: u8 = 100;

/// Ranges of street widths and building sides, metres.
const STREET_M: (f64, f64) = (4.0, 7.0);
const BUILDING_M: (f64, f64) = (50.0, 110.0);

/// Range of room sides, and width of doors, metres.
const ROOM_M: (f64, f64) = (3.0, 9.0);
const DOOR_M: f64 = 1.0;

/// Niches and porches of façades: ranges of spacing, width and depth, metres.
const NICHE_EVERY_M: (f64, f64) = (3.0, 14.0);
const NICHE_M: (f64, f64) = (0.8, 4.0);
const NICHE_DEPTH_M: (f64, f64) = (0.2, 1.5);

/// Share of the buildings that are known inside.
const KNOWN_SHARE: f64 = 0.05;

/// Objects in streets, such as cars and lamps, per square metre.
const THINGS_PER_M2: f64 = 0.01;

/// Thickness of a wall in cells.
const WALL: usize = 2;

struct City {
    width: usize,
    height: usize,
    cells: Vec<u8>,
    random: Xoshiro256PlusPlus,
}

/// Occupancies of a city, row by row.
pub fn city((width, height): (usize, usize), seed: u64) -> Vec<u8> {
    let mut city = City {
        width,
        height,
        cells: vec![FREE; width * height],
        random: Xoshiro256PlusPlus::seed_from_u64(seed),
    };
    let (columns, rows) = (city.spans(width), city.spans(height));
    city.put_things();
    for &(bottom, top) in &rows {
        for &(left, right) in &columns {
            city.build(Rect::new(left, bottom, right - left, top - bottom));
        }
    }
    city.cells
}

impl City {
    fn length(&mut self, (from, to): (f64, f64)) -> usize {
        (self.random.random_range(from..to) / RESOLUTION_M).round() as usize
    }

    /// Start and end of the buildings along an axis; streets are in between.
    fn spans(&mut self, cells: usize) -> Vec<(usize, usize)> {
        let (mut spans, mut at) = (Vec::new(), 0);
        loop {
            let start = at + self.length(STREET_M);
            let end = start + self.length(BUILDING_M);
            // The last building may continue beyond the map.
            if end >= cells {
                spans.extend((start + 2 * WALL < cells).then_some((start, cells)));
                return spans;
            }
            spans.push((start, end));
            at = end;
        }
    }

    fn fill(&mut self, rect: Rect, cell: u8) {
        for y in rect.y..(rect.y + rect.height).min(self.height) {
            let row = &mut self.cells[y * self.width..][..self.width];
            let end = (rect.x + rect.width).min(self.width);
            row[rect.x.min(end)..end].fill(cell);
        }
    }

    fn put_things(&mut self) {
        let area_m2 = self.cells.len() as f64 * RESOLUTION_M * RESOLUTION_M;
        for _ in 0..(area_m2 * THINGS_PER_M2) as usize {
            let (x, y) = (
                self.random.random_range(0..self.width),
                self.random.random_range(0..self.height),
            );
            let (width, height) = match self.random.random_range(0..4) {
                0 => (self.length((1.6, 2.0)), self.length((3.8, 5.0))),
                1 => (self.length((3.8, 5.0)), self.length((1.6, 2.0))),
                _ => (self.length((0.1, 0.4)), self.length((0.1, 0.4))),
            };
            self.fill(Rect::new(x, y, width, height), OCCUPIED);
        }
    }

    fn build(&mut self, building: Rect) {
        self.fill(building, OCCUPIED);
        let Rect {
            x,
            y,
            width,
            height,
        } = building;
        let inside = Rect::new(x + WALL, y + WALL, width - 2 * WALL, height - 2 * WALL);
        match self.random.random_bool(KNOWN_SHARE) {
            true => {
                self.fill(inside, FREE);
                self.divide(inside);
            }
            false => self.fill(inside, messages::UNKNOWN),
        }
        for (x_major, far) in [(true, false), (true, true), (false, false), (false, true)] {
            self.put_niches(building, x_major, far);
        }
    }

    /// Cuts niches with walls into one façade of a building.
    fn put_niches(&mut self, building: Rect, x_major: bool, far: bool) {
        let lying = building.turned(!x_major);
        let mut at = self.length(NICHE_EVERY_M);
        loop {
            let (wide, deep) = (self.length(NICHE_M), self.length(NICHE_DEPTH_M));
            if at + wide + WALL >= lying.width {
                return;
            }
            for (rim, cell) in [(WALL, OCCUPIED), (0, FREE)] {
                let deep = deep + rim;
                let start = if far { lying.height - deep } else { 0 };
                let (x, y) = (lying.x + at - rim, lying.y + start);
                let niche = Rect::new(x, y, wide + 2 * rim, deep);
                self.fill(niche.turned(!x_major), cell);
            }
            at += wide + self.length(NICHE_EVERY_M);
        }
    }

    /// Divides a floor into rooms with doors, recursively.
    fn divide(&mut self, floor: Rect) {
        let upright = floor.width > floor.height;
        let length = floor.width.max(floor.height);
        let largest = (ROOM_M.1 / RESOLUTION_M) as usize;
        if length < largest {
            return;
        }
        let least = (ROOM_M.0 / RESOLUTION_M) as usize;
        let at = self.random.random_range(least..length - least);
        let door = (DOOR_M / RESOLUTION_M) as usize;
        let lying = floor.turned(!upright);
        let across = lying.height;
        let free = across.saturating_sub(door).max(1);
        let gap = self.random.random_range(0..free);
        let (x, y) = (lying.x + at, lying.y);
        let parts = [
            Rect::new(x, y, WALL, across),
            Rect::new(x, y + gap, WALL, door),
            Rect::new(lying.x, y, at, across),
            Rect::new(x + WALL, y, length - at - WALL, across),
        ];
        let [wall, opening, first, second] = parts.map(|part| part.turned(!upright));
        self.fill(wall, OCCUPIED);
        self.fill(opening, FREE);
        self.divide(first);
        self.divide(second);
    }
}

impl Rect {
    /// Exchanges x and y if `is_turned`.
    fn turned(self, is_turned: bool) -> Self {
        match is_turned {
            true => Rect::new(self.y, self.x, self.height, self.width),
            false => self,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_part_of_a_city_is_free() {
        let sides = (6_000, 4_000);
        let cells = city(sides, 1);
        assert_eq!(cells.len(), sides.0 * sides.1);
        let share =
            |kind| cells.iter().filter(|&&cell| cell == kind).count() as f64 / cells.len() as f64;
        let (free, occupied) = (share(FREE), share(OCCUPIED));
        assert!((0.08..0.25).contains(&free), "{free}");
        assert!((0.005..0.05).contains(&occupied), "{occupied}");
        assert!((free + occupied + share(messages::UNKNOWN) - 1.0).abs() < 1e-9);
        assert_eq!(cells, city(sides, 1));
        assert!(cells != city(sides, 2));
    }
}
