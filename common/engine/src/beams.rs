//! Choice of the beams of a scan that vote, and their weights.

use std::f64::consts::TAU;

use crate::observation::{CarriedScan, Observation};
use crate::scan::Scan;
use crate::space::Space;

/// Added to every weight, so that near beams still count.
pub(crate) const MIN_WEIGHT: f64 = 0.05;

/// Choice and weights of the beams that vote.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct BeamConfig {
    /// Maximum number of beams that vote, 1..=65535; longer scans are thinned by arc.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 180, value_parser = clap::value_parser!(u32).range(1..=65_535)))]
    pub max_beams: u32,
    /// Arc covered at the reading from which a beam has full weight, metres, 0..=2;
    /// nearer readings weigh by the arc that they cover. 0 gives all beams the same
    /// weight.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.20, value_parser = crate::config::parse_length))]
    pub beam_arc_m: f64,
}

impl Default for BeamConfig {
    fn default() -> Self {
        BeamConfig {
            max_beams: 180,
            beam_arc_m: 0.20,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Beam {
    /// Bearing as an index on the heading grid.
    pub bearing: usize,
    /// Rounding remainder of the bearing, in radians.
    pub rounding: f64,
    /// Bearing in the target frame, in radians, not rounded.
    pub angle: f64,
    /// Reading, in metres.
    pub reading_m: f64,
    /// Weight; 1 is a full vote.
    pub weight: f64,
    /// Index in its scan.
    pub index: usize,
}

/// The beams that vote, by bearing, and the silent sectors; reused from scan to scan.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Chosen {
    pub beams: Vec<Beam>,
    /// Middles of the silent sectors, in radians.
    pub silent: Vec<f64>,
    sectors: Vec<Sector>,
}

/// Content of a sector of the turn.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
enum Sector {
    /// No beam points there.
    #[default]
    Unseen,
    /// Beams point there, but none returned.
    Silent,
    /// The beam with the nearest end.
    Nearest(Beam),
}

impl Chosen {
    /// Chooses the beams that vote, see [`Chosen::thin`] and [`Chosen::join`].
    pub(crate) fn choose(
        &mut self,
        observation: Observation<'_>,
        turn: f64,
        space: &Space,
        config: &BeamConfig,
    ) {
        match observation {
            Observation::Still(scan) => {
                let end = |i| Some((scan.bearing(i), scan.reading(i)?));
                self.thin(&scan, end, turn, space, config);
            }
            Observation::Carried([alone]) => {
                self.thin(&alone.scan, |i| alone.end(i), turn, space, config);
            }
            Observation::Carried(scans) => self.join(scans, turn, space, config),
        }
    }

    /// Divides the scan's arc evenly into at most `max_beams` sectors and takes from each the
    /// returned reading whose bearing is nearest to the heading grid; on a tie the one nearest to
    /// the sector's middle, then the first. A sector is silent if nothing returned, or only from
    /// farther than any map reaches, which no pose explains.
    ///
    /// `end_of` gives the end of a beam seen from the target frame: bearing (radians) and distance
    /// (metres).
    fn thin(
        &mut self,
        scan: &Scan<'_>,
        end_of: impl Fn(usize) -> Option<(f64, f64)>,
        turn: f64,
        space: &Space,
        config: &BeamConfig,
    ) {
        self.beams.clear();
        self.silent.clear();
        let readings = scan.beams();
        let (sectors, arc) = thinned(scan, config);
        for sector in 0..sectors {
            // Integer bounds put every reading in exactly one sector.
            let (start, end) = (
                sector * readings / sectors,
                (sector + 1) * readings / sectors,
            );
            let middle = (start + end - 1) as f64 / 2.0;
            let candidates = (start..end).filter_map(|i| {
                let seen = end_of(i).filter(|&(_, reading_m)| reading_m <= space.reach_m)?;
                let weight = weight(seen.1 * arc, config.beam_arc_m);
                let beam = Beam::new(i, seen, turn, weight, space);
                Some((beam, (i as f64 - middle).abs()))
            });
            let best = candidates.min_by(|(a, a_off), (b, b_off)| {
                grid_distance(a)
                    .cmp(&grid_distance(b))
                    .then(a_off.total_cmp(b_off))
            });
            match best {
                Some((beam, _)) => self.beams.push(beam),
                None => self.silent.push(scan.bearing_between(middle)),
            }
        }
    }

    /// Divides the turn, seen from the origin of the target frame, into `max_beams` sectors and
    /// takes from each the reading with the nearest end, on a tie the first. The weight of a
    /// reading follows from the arc that its own laser's beam covers.
    fn join(&mut self, scans: &[CarriedScan<'_>], turn: f64, space: &Space, config: &BeamConfig) {
        self.sectors.clear();
        let count = config.max_beams as usize;
        self.sectors.resize(count, Sector::Unseen);
        let sector_of = |angle: f64| {
            let share = angle.rem_euclid(TAU) / TAU;
            ((share * count as f64) as usize).min(count - 1)
        };
        for carried in scans {
            let (_, arc) = thinned(&carried.scan, config);
            for i in 0..carried.scan.beams() {
                let end = carried.end(i).filter(|&(_, m)| m <= space.reach_m);
                let Some((angle, distance_m)) = end else {
                    let direction = carried.laser(i).yaw + carried.scan.bearing(i);
                    let sector = &mut self.sectors[sector_of(direction)];
                    if *sector == Sector::Unseen {
                        *sector = Sector::Silent;
                    }
                    continue;
                };
                let sector = &mut self.sectors[sector_of(angle)];
                if matches!(sector, Sector::Nearest(other) if other.reading_m <= distance_m) {
                    continue;
                }
                let reading_m = carried.scan.reading(i).unwrap_or(distance_m);
                let weight = weight(reading_m * arc, config.beam_arc_m);
                *sector = Sector::Nearest(Beam::new(i, (angle, distance_m), turn, weight, space));
            }
        }
        self.beams.clear();
        self.silent.clear();
        for (i, sector) in self.sectors.iter().enumerate() {
            match sector {
                Sector::Unseen => {}
                Sector::Silent => self.silent.push((i as f64 + 0.5) * TAU / count as f64),
                Sector::Nearest(beam) => self.beams.push(*beam),
            }
        }
    }
}

impl Beam {
    /// Makes a beam that ends at `(angle, reading_m)` in the target frame.
    fn new(
        index: usize,
        (angle, reading_m): (f64, f64),
        turn: f64,
        weight: f64,
        space: &Space,
    ) -> Self {
        let (bearing, rounding) = space.directions.nearest(angle + turn);
        Beam {
            bearing,
            rounding,
            angle,
            reading_m,
            weight,
            index,
        }
    }
}

/// Returns the number of sectors into which a scan is thinned, and the arc of each in radians.
fn thinned(scan: &Scan<'_>, config: &BeamConfig) -> (usize, f64) {
    let sectors = scan.beams().min(config.max_beams as usize);
    let arc = (scan.beams() as f64 * scan.angle_increment.abs()).min(TAU) / sectors as f64;
    (sectors, arc)
}

/// `min(1, arc at the reading / full arc) + 0.05`, or 1 if all beams weigh the same.
fn weight(arc_m: f64, full_arc_m: f64) -> f64 {
    if full_arc_m > 0.0 {
        (arc_m / full_arc_m).min(1.0) + MIN_WEIGHT
    } else {
        1.0
    }
}

/// Distance of a bearing from the heading grid in microradians. Scans store angles in 32 bits,
/// whose last bits must not decide between two beams.
fn grid_distance(beam: &Beam) -> i64 {
    (beam.rounding.abs() * 1e6).round() as i64
}

#[cfg(test)]
mod tests;
