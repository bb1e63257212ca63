//! Converts the shade of a pixel to the occupancy of a cell.
//!
//! The rules are those of `map_server` in ROS 1 and of `nav2_map_server` up to Jazzy: `occ = 1 -
//! shade`, or the shade itself with `negate`; strictly above `occupied_thresh` a cell is occupied,
//! strictly below `free_thresh` free. Later nav2 includes a shade equal to a threshold, weights the
//! colours by luminance and reads any transparency as unknown; for opaque grey images without
//! shades equal to a threshold both agree.

use crate::UNKNOWN;

/// Full brightness or opacity of a channel.
const FULL: u16 = u16::MAX;

/// A pixel in 16-bit steps regardless of the file, like in the image library of `map_server`, so
/// that every threshold separates the same values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pixel {
    /// Red, green and blue; equal for grey.
    pub(crate) colour: [u16; 3],
    /// Opacity, if the image has an alpha channel.
    pub(crate) alpha: Option<u16>,
}

impl Pixel {
    pub(crate) fn grey(shade: u8) -> Self {
        Pixel {
            colour: [u16::from(shade) * 257; 3],
            alpha: None,
        }
    }
}

const FREE: u8 = 0;
const OCCUPIED: u8 = 100;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Mode {
    /// Occupied, free or unknown by the thresholds.
    #[default]
    Trinary,
    /// Like trinary, but 0..=100 between the thresholds; transparent pixels are unknown.
    Scale,
    /// The shade itself, 0..=100; brighter pixels are unknown.
    Raw,
}

/// Thresholds of occupancy, 0..=1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Thresholds {
    /// Cells above it are occupied.
    pub(crate) occupied: f64,
    /// Cells below it are free.
    pub(crate) free: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rules {
    pub(crate) mode: Mode,
    /// True if bright pixels are occupied.
    pub(crate) negate: bool,
    pub(crate) thresholds: Thresholds,
}

impl Rules {
    pub(crate) fn occupancy(self, pixel: Pixel) -> u8 {
        match self.mode {
            Mode::Trinary => {
                // The alpha channel counts as another colour: transparent pixels are darker.
                let occ = self.occupied_share(shade(&pixel.colour, pixel.alpha));
                self.beyond_thresholds(occ).unwrap_or(UNKNOWN)
            }
            Mode::Scale if pixel.alpha.is_some_and(|alpha| alpha != FULL) => UNKNOWN,
            Mode::Scale => {
                let occ = self.occupied_share(shade(&pixel.colour, None));
                self.beyond_thresholds(occ)
                    .unwrap_or_else(|| self.between_thresholds(occ))
            }
            Mode::Raw => match (shade(&pixel.colour, None) * 255.0).round() {
                percent if percent <= f64::from(OCCUPIED) => percent as u8,
                _ => UNKNOWN,
            },
        }
    }

    fn occupied_share(self, shade: f64) -> f64 {
        if self.negate { shade } else { 1.0 - shade }
    }

    fn beyond_thresholds(self, occ: f64) -> Option<u8> {
        if occ > self.thresholds.occupied {
            Some(OCCUPIED)
        } else if occ < self.thresholds.free {
            Some(FREE)
        } else {
            None
        }
    }

    fn between_thresholds(self, occ: f64) -> u8 {
        let Thresholds { occupied, free } = self.thresholds;
        ((occ - free) / (occupied - free) * 100.0).round_ties_even() as u8
    }
}

/// Returns the brightness of a pixel, 0..=1: the mean of its channels.
fn shade(colour: &[u16; 3], alpha: Option<u16>) -> f64 {
    let channels = colour.iter().copied().chain(alpha);
    let (count, sum) = channels.fold((0.0, 0.0), |(count, sum), channel| {
        (count + 1.0, sum + f64::from(channel))
    });
    sum / count / f64::from(FULL)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules(mode: Mode, negate: bool, occupied: f64, free: f64) -> Rules {
        let thresholds = Thresholds { occupied, free };
        Rules {
            mode,
            negate,
            thresholds,
        }
    }

    fn cells(rules: Rules, shades: &[u8]) -> Vec<u8> {
        shades
            .iter()
            .map(|&s| rules.occupancy(Pixel::grey(s)))
            .collect()
    }

    #[test]
    fn trinary_knows_three_values() {
        let mut rules = rules(Mode::Trinary, false, 0.65, 0.196);
        // 205 is the shade of unknown in map_saver: 50/255 is just above 0.196.
        assert_eq!(
            cells(rules, &[0, 89, 90, 205, 206, 254, 255]),
            [100, 100, 255, 255, 0, 0, 0]
        );
        rules.negate = true;
        assert_eq!(
            cells(rules, &[0, 49, 50, 165, 166, 255]),
            [0, 0, 255, 255, 100, 100]
        );
    }

    #[test]
    fn a_shade_exactly_at_a_threshold_is_not_beyond_it() {
        let rules = rules(Mode::Trinary, true, 204.0 / 255.0, 51.0 / 255.0);
        assert_eq!(
            cells(rules, &[50, 51, 52, 203, 204, 205]),
            [0, 255, 255, 255, 255, 100]
        );
    }

    #[test]
    fn scale_interpolates_and_transparent_is_unknown() {
        let rules = rules(Mode::Scale, true, 1.0, 0.0);
        // 255 is not above 1.0, so it is interpolated to 100; 127/255 is 49.8 %.
        assert_eq!(cells(rules, &[0, 51, 127, 128, 255]), [0, 20, 50, 50, 100]);
        let faint = Pixel {
            alpha: Some(FULL - 1),
            ..Pixel::grey(255)
        };
        assert_eq!(rules.occupancy(faint), UNKNOWN);
        let opaque = Pixel {
            alpha: Some(FULL),
            ..Pixel::grey(255)
        };
        assert_eq!(rules.occupancy(opaque), 100);
    }

    #[test]
    fn scale_rounds_halves_to_even() {
        let rules = rules(Mode::Scale, true, 1.0, 0.0);
        // 0.125 * 100 and 0.375 * 100 are exact halves: 12.5 and 37.5.
        assert_eq!(rules.between_thresholds(0.125), 12);
        assert_eq!(rules.between_thresholds(0.375), 38);
    }

    #[test]
    fn raw_takes_values_up_to_a_hundred_and_ignores_negate_and_alpha() {
        for negate in [false, true] {
            let rules = rules(Mode::Raw, negate, 0.65, 0.196);
            assert_eq!(
                cells(rules, &[0, 1, 99, 100, 101, 255]),
                [0, 1, 99, 100, 255, 255]
            );
            let clear = Pixel {
                alpha: Some(0),
                ..Pixel::grey(42)
            };
            assert_eq!(rules.occupancy(clear), 42);
        }
    }

    #[test]
    fn colours_are_averaged_and_alpha_with_them_in_trinary_only() {
        let pixel = Pixel {
            colour: [FULL, FULL, 0],
            alpha: Some(0),
        };
        let rules = |mode| rules(mode, false, 0.45, 0.4);
        // (1 + 1 + 0 + 0) / 4 is half occupied; without alpha it is a third.
        assert_eq!(rules(Mode::Trinary).occupancy(pixel), 100);
        let opaque = Pixel {
            alpha: None,
            ..pixel
        };
        assert_eq!(rules(Mode::Trinary).occupancy(opaque), 0);
        assert_eq!(rules(Mode::Scale).occupancy(opaque), 0);
        assert_eq!(rules(Mode::Raw).occupancy(pixel), UNKNOWN, "170 of 255");
    }
}
