//! Beams of a scan, each with its fate.

use messages::{Beam, BeamFate, BeamsHeader, Pose2};
use serde::Serialize;

/// Maximum number of beams sent: as many as a picture can show.
const MAX_BEAMS: usize = 1440;

/// Beams of one scan with a return, as columns.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Beams {
    pub(crate) counter: u64,
    /// Pose of the laser at which the beams were compared with the map.
    pub(crate) laser: Pose2,
    /// In the laser's frame, rounded to 0.1 mrad.
    pub(crate) bearing: Vec<f64>,
    /// Rounded to a millimetre.
    pub(crate) range_m: Vec<f64>,
    /// First letters of `hit`, `short`, `through` or `unknown`, one per beam.
    pub(crate) fate: String,
    /// Number of beams left out, most of them without a return.
    pub(crate) silent: usize,
}

impl Beams {
    /// Converts a message of `beams`. Beams that are NaN or infinite are left out.
    pub(crate) fn new(header: &BeamsHeader, items: &[Beam]) -> Self {
        let is_number = |beam: &&Beam| beam.bearing.is_finite() && beam.range_m.is_finite();
        let shown = items
            .iter()
            .filter(is_number)
            .filter_map(|beam| letter(beam).map(|letter| (beam, letter)))
            .take(MAX_BEAMS);
        let mut beams = Beams {
            counter: header.stamp.counter,
            laser: header.map_from_laser,
            bearing: Vec::new(),
            range_m: Vec::new(),
            fate: String::new(),
            silent: items.len(),
        };
        for (beam, letter) in shown {
            beams.bearing.push(rounded(beam.bearing, 1e4));
            beams.range_m.push(rounded(beam.range_m, 1e3));
            beams.fate.push(letter);
            beams.silent -= 1;
        }
        beams
    }
}

/// Rounds to 1/`steps`; more digits would not be visible.
pub(super) fn rounded(number: impl Into<f64>, steps: f64) -> f64 {
    (number.into() * steps).round() / steps
}

fn letter(beam: &Beam) -> Option<char> {
    match BeamFate::from_code(beam.fate)? {
        BeamFate::Hit => Some('h'),
        BeamFate::Short => Some('s'),
        BeamFate::Through => Some('t'),
        BeamFate::Unknown => Some('u'),
        BeamFate::NoReturn => None,
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    #[test]
    fn beams_are_columns_and_what_did_not_return_is_counted() {
        let beam = |bearing, range_m, fate: BeamFate| Beam {
            bearing,
            range_m,
            weight: 1.0,
            fate: fate as u32,
        };
        let unknown_code = Beam {
            fate: 9,
            ..Beam::zeroed()
        };
        let items = [
            beam(0.5, 2.0004, BeamFate::Hit),
            beam(0.6, f32::INFINITY, BeamFate::NoReturn),
            beam(f32::NAN, 1.0, BeamFate::Hit),
            unknown_code,
            beam(0.75, 4.0, BeamFate::Through),
        ];
        let beams = Beams::new(&BeamsHeader::zeroed(), &items);
        assert_eq!(beams.bearing, [0.5, 0.75]);
        assert_eq!(beams.range_m, [2.0, 4.0]);
        assert_eq!((beams.fate.as_str(), beams.silent), ("ht", 3));
        let many = vec![beam(0.0, 1.0, BeamFate::Short); 1_000_000];
        let found = Beams::new(&BeamsHeader::zeroed(), &many).fate.len();
        assert_eq!(found, MAX_BEAMS);
    }
}
