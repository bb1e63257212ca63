//! The scan program: a scan compiled for the grid with which it is matched.
//!
//! Beams are thinned by arc, weighted, rounded once to the heading grid and given integer tapers.
//! Every accumulator runs the same program, so all of them count the same votes.

use crate::EngineError;
use crate::beams::{Beam, BeamConfig, Chosen, MIN_WEIGHT};
use crate::observation::Observation;
use crate::simd::TABLE;
use crate::space::Space;
use crate::tables::VoteTable;
use crate::taper::TaperShape;

/// Range of a ray that meets no obstacle.
pub const NO_RANGE: u16 = u16::MAX;

/// Highest vote of a beam with weight 1.
const FULL_VOTE: u32 = 15;

/// Most votes of any beam: those of one with the highest weight, rounded.
pub(crate) const MOST_VOTES: usize = (FULL_VOTE as f64 * (1.0 + MIN_WEIGHT) + 0.5) as usize;

/// Widest taper, in cells: with it, no taper reaches [`NO_RANGE`] from a reading as long as the
/// largest grid's diagonal.
const MAX_SIGMA_CELLS: f64 = 6000.0;

/// Settings for the conversion of readings to votes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct VoteConfig {
    /// Choice and weights of the beams that vote.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub beams: BeamConfig,
    /// Shape of the decrease of votes in front of a reading and behind it.
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value_t = TaperShape::Trapezoid))]
    pub taper: TaperShape,
    /// Standard deviation of a reading at distance 0, metres, 0..=2; the taper is never
    /// narrower than one cell.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.10, value_parser = crate::config::parse_length))]
    pub sigma_m: f64,
    /// Increase of the standard deviation per metre of range, 0..=0.25.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = 0.01, value_parser = crate::config::within(0.0..=0.25, "as a share of the range")))]
    pub sigma_per_m: f64,
}

impl Default for VoteConfig {
    fn default() -> Self {
        VoteConfig {
            beams: BeamConfig::default(),
            taper: TaperShape::Trapezoid,
            sigma_m: 0.10,
            sigma_per_m: 0.01,
        }
    }
}

/// Votes of one beam along rays of one class of directions.
#[derive(Debug, Clone, Copy)]
pub struct Taper<'a> {
    /// Number of steps to the reading; no reading is longer than a grid's diagonal.
    pub centre: u16,
    /// Votes at 0, 1, 2, … steps from there; none beyond.
    pub profile: &'a [u8],
}

impl Taper<'_> {
    /// Returns the votes for a pose whose ray is `range` steps long; none for [`NO_RANGE`].
    #[must_use]
    pub fn votes(&self, range: u16) -> u8 {
        match self.profile.get(usize::from(range.abs_diff(self.centre))) {
            Some(&votes) if range != NO_RANGE => votes,
            _ => 0,
        }
    }

    /// Returns the smallest number of steps, beyond the reading, without votes.
    pub fn end(&self) -> u16 {
        self.centre.saturating_add(self.profile.len() as u16)
    }
}

/// A scan that is ready to vote on a grid; the default has no beams. The buffers are reused from
/// scan to scan.
#[derive(Debug, Clone, Default)]
pub struct ScanProgram {
    chosen: Chosen,
    bearings: Vec<usize>,
    /// Taper of beam `i` and class `c` at `i · classes + c`.
    tapers: Vec<TaperEntry>,
    /// Votes of all tapers, with a 0 after each, and [`TABLE`] bytes more that can be read.
    profiles: Vec<u8>,
    classes: usize,
    highest_possible: u32,
    bearing_rounding: f64,
}

#[derive(Debug, Clone, Copy)]
struct TaperEntry {
    start: u32,
    centre: u16,
    len: u16,
}

impl ScanProgram {
    /// Compiles a scan for a search space.
    ///
    /// `turn` is added to every bearing before it is rounded: the rest of a known heading after
    /// rounding to the heading grid, otherwise 0 (radians).
    ///
    /// # Errors
    /// If [`Observation::check`] rejects the scan.
    pub fn new<'a>(
        scan: impl Into<Observation<'a>>,
        turn: f64,
        space: &Space,
        config: &VoteConfig,
    ) -> Result<Self, EngineError> {
        let mut program = ScanProgram::default();
        program.compile(scan, turn, space, config)?;
        Ok(program)
    }

    /// Does the same in the buffers of the scan before, which is kept if the scan is rejected.
    ///
    /// # Errors
    /// See [`ScanProgram::new`].
    pub fn compile<'a>(
        &mut self,
        scan: impl Into<Observation<'a>>,
        turn: f64,
        space: &Space,
        config: &VoteConfig,
    ) -> Result<(), EngineError> {
        let scan = scan.into();
        scan.check()?;
        self.chosen.choose(scan, turn, space, &config.beams);
        let full_vote = fitting_full_vote(&self.chosen.beams);
        self.bearings.clear();
        self.tapers.clear();
        self.profiles.clear();
        self.classes = space.directions.classes();
        self.highest_possible = 0;
        self.bearing_rounding = 0.0;
        for i in 0..self.chosen.beams.len() {
            let beam = self.chosen.beams[i];
            let peak = f64::from(full_vote) * beam.weight;
            self.highest_possible += peak.round() as u32;
            // A longer beam ends on no ray of this map, only on other maps.
            if beam.reading_m <= space.longest_m {
                self.push(&beam, peak, space, config);
            }
        }
        self.profiles.resize(self.profiles.len() + TABLE, 0);
        Ok(())
    }

    fn push(&mut self, beam: &Beam, peak: f64, space: &Space, config: &VoteConfig) {
        let reading_cells = beam.reading_m / space.resolution_m;
        let sigma_m = config.sigma_m + config.sigma_per_m * beam.reading_m;
        let sigma_cells = (sigma_m / space.resolution_m).clamp(1.0, MAX_SIGMA_CELLS);
        for class in 0..self.classes {
            let steps_per_cell = space.directions.steps_per_cell(class);
            let start = self.profiles.len();
            let profile = config.taper.profile(peak, sigma_cells * steps_per_cell);
            self.profiles.extend(profile);
            self.tapers.push(TaperEntry {
                start: start as u32,
                centre: (reading_cells * steps_per_cell + 0.5).floor() as u16,
                len: (self.profiles.len() - start) as u16,
            });
            self.profiles.push(0);
        }
        self.bearings.push(beam.bearing);
        self.bearing_rounding = self.bearing_rounding.max(beam.rounding.abs());
    }

    /// Number of beams that vote and are no longer than the grid; the paper's m.
    pub fn beams(&self) -> usize {
        self.bearings.len()
    }

    /// Bearing of beam `i` as an index on the heading grid.
    #[must_use]
    pub fn bearing(&self, i: usize) -> usize {
        self.bearings[i]
    }

    /// Votes of beam `i` along rays of a class of directions.
    #[must_use]
    pub fn taper(&self, i: usize, class: usize) -> Taper<'_> {
        let VoteTable {
            centre,
            used,
            votes,
        } = self.table(i, class);
        let profile = &votes[..usize::from(used)];
        Taper { centre, profile }
    }

    /// Votes of beam `i` along rays of a class of directions, for lookups of several at once.
    #[inline(always)]
    pub(crate) fn table(&self, i: usize, class: usize) -> VoteTable<'_> {
        let TaperEntry { start, centre, len } = self.tapers[i * self.classes + class];
        VoteTable {
            centre,
            used: len,
            votes: &self.profiles[start as usize..],
        }
    }

    /// Largest number of votes of beam `i`.
    pub(crate) fn peak(&self, i: usize) -> u16 {
        let profile = self.taper(i, 0).profile;
        profile.first().map_or(0, |&peak| u16::from(peak))
    }

    /// Votes of a pose with which every beam agrees fully, including beams too long for the grid;
    /// at most 65535.
    pub fn highest_possible(&self) -> u32 {
        self.highest_possible
    }

    /// Number of beams of the thinned scan without a usable reading.
    pub fn silent(&self) -> usize {
        self.chosen.silent.len()
    }

    /// Largest rounding of a bearing to the heading grid, in radians.
    pub fn bearing_rounding(&self) -> f64 {
        self.bearing_rounding
    }
}

/// Returns the highest full vote, at most [`FULL_VOTE`], with which the votes of all beams together
/// fit in 16 bits.
fn fitting_full_vote(beams: &[Beam]) -> u32 {
    (1..=FULL_VOTE)
        .rev()
        .find(|&full| {
            let sum: f64 = beams
                .iter()
                .map(|beam| (f64::from(full) * beam.weight).round())
                .sum();
            sum <= f64::from(u16::MAX)
        })
        .unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::scan_from;

    fn program(ranges: &[f32], config: &VoteConfig) -> ScanProgram {
        let scan = scan_from(0.0, std::f64::consts::TAU / ranges.len() as f64, ranges);
        let space = Space::new(360, 0.05, 1000, 1000).unwrap();
        ScanProgram::new(&scan, 0.0, &space, config).unwrap()
    }

    #[test]
    fn a_reading_is_measured_in_steps_of_its_direction() {
        let program = program(&[10.0; 8], &VoteConfig::default());
        // 200 cells: as many steps along an axis, 200 / √2 = 141.4 on a diagonal.
        assert_eq!(program.taper(0, 0).centre, 200);
        assert_eq!(program.taper(0, 45).centre, 141);
        // σ = 0.2 m = 4 cells: flat to 4 steps, zero at 10.
        let taper = program.taper(0, 0);
        assert_eq!(
            (taper.votes(196), taper.votes(204), taper.votes(209)),
            (16, 16, 3)
        );
        assert_eq!(
            (taper.votes(190), taper.votes(210), taper.votes(0)),
            (0, 0, 0)
        );
    }

    #[test]
    fn votes_are_lowered_until_their_sum_fits() {
        let beams = BeamConfig {
            max_beams: 65_535,
            beam_arc_m: 0.0,
        };
        let config = VoteConfig {
            beams,
            ..VoteConfig::default()
        };
        let wide = program(&vec![5.0; 6000], &config);
        assert_eq!(
            wide.highest_possible(),
            60_000,
            "10 votes for each of 6000 beams"
        );
        let usual = program(&vec![5.0; 360], &config);
        assert_eq!(usual.highest_possible(), 15 * 360);
    }

    #[test]
    fn silent_beams_are_counted_and_do_not_vote() {
        let program = program(&[1.0, f32::INFINITY, 2.0, f32::NAN], &VoteConfig::default());
        assert_eq!((program.beams(), program.silent()), (2, 2));
        assert_eq!((program.bearing(0), program.bearing(1)), (0, 180));
    }
}
