//! A region of the map: a polygon.

use std::str::FromStr;

/// Largest number of corners; regions are drawn by hand.
const MAX_CORNERS: usize = 1_000;

/// Largest distance of a corner from the map's origin along each axis, in metres.
const MAX_METRES: f64 = 1e8;

/// A polygon in the map frame. Two corners define an upright rectangle by its diagonal.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// At least three corners in order, in metres.
    corners: Vec<[f64; 2]>,
}

impl Region {
    /// Makes a region from its corners, in metres in the map frame.
    ///
    /// # Errors
    /// If there are fewer than two corners or more than a thousand, or one is not finite or too
    /// far.
    pub fn new(corners: &[[f64; 2]]) -> Result<Self, String> {
        if !(2..=MAX_CORNERS).contains(&corners.len()) {
            let found = corners.len();
            return Err(format!("{found} corners; allowed are 2 to {MAX_CORNERS}"));
        }
        let is_far = |corner: &&[f64; 2]| !corner.iter().all(|metres| metres.abs() <= MAX_METRES);
        if let Some([x, y]) = corners.iter().find(is_far) {
            return Err(format!(
                "a corner at {x},{y}; allowed are numbers up to {MAX_METRES} metres"
            ));
        }
        let corners = match *corners {
            [[x0, y0], [x1, y1]] => vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]],
            _ => corners.to_vec(),
        };
        Ok(Region { corners })
    }

    /// True if a point is inside: a line from it to the right crosses the border an odd number of
    /// times.
    #[must_use]
    pub fn holds(&self, x: f64, y: f64) -> bool {
        let next = self.corners.iter().cycle().skip(1);
        let edges = self.corners.iter().zip(next);
        let crossed = edges.filter(|&(&[x0, y0], &[x1, y1])| {
            (y0 > y) != (y1 > y) && x < x0 + (y - y0) / (y1 - y0) * (x1 - x0)
        });
        crossed.count() % 2 == 1
    }
}

impl FromStr for Region {
    type Err = String;

    /// Reads `X,Y X,Y …`.
    fn from_str(text: &str) -> Result<Self, String> {
        let corner = |word: &str| {
            let (x, y) = word.split_once(',')?;
            Some([x.parse().ok()?, y.parse().ok()?])
        };
        let corners: Result<Vec<_>, _> = text
            .split_whitespace()
            .map(|word| {
                let wrong = || format!("{word:?} is not a corner; needed are X,Y X,Y … in metres");
                corner(word).ok_or_else(wrong)
            })
            .collect();
        Region::new(&corners?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_corners_are_a_rectangle() {
        let region: Region = "3,1 -1,2".parse().unwrap();
        assert!(region.holds(0.0, 1.5) && region.holds(2.9, 1.1));
        assert!(!region.holds(0.0, 0.9) && !region.holds(3.1, 1.5) && !region.holds(-1.1, 1.5));
    }

    #[test]
    fn a_polygon_may_have_bays() {
        // A U that is open at the top.
        let region: Region = "0,0 3,0 3,3 2,3 2,1 1,1 1,3 0,3".parse().unwrap();
        assert!(region.holds(0.5, 2.0) && region.holds(2.5, 2.0) && region.holds(1.5, 0.5));
        assert!(!region.holds(1.5, 2.0));
    }

    #[test]
    fn what_is_no_region_is_refused() {
        for text in ["1,2 3;4", "1,2", "1,2 NaN,0", "1,2 1e9,0"] {
            assert!(text.parse::<Region>().is_err(), "{text}");
        }
    }
}
