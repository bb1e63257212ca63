//! The beams by which particles are weighed: some of a scan's, evenly taken.

use super::ParticlesConfig;
use crate::fit::Ends;

/// A beam in cells of the target frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beam {
    /// Where it ends.
    pub(super) end: (f64, f64),
    /// Where the laser was.
    pub(super) from: (f64, f64),
    /// The unit vector along it.
    pub(super) towards: (f64, f64),
    /// From the laser to the end.
    pub(super) cells: f64,
    /// The power to which its likelihood is raised.
    pub(super) weight: f64,
}

/// Those of one scan; found again for each, in the buffers of the one before.
#[derive(Debug, Clone, Default)]
pub(super) struct Beams {
    pub(super) beams: Vec<Beam>,
    /// Of all together: as many beams as they count for.
    pub(super) weight: f64,
}

impl Beams {
    pub(super) fn choose(&mut self, ends: &Ends, config: &ParticlesConfig) {
        let ends = &ends.ends;
        let count = ends.len().min(config.particles_beams.max(1) as usize);
        self.beams.clear();
        self.beams.extend((0..count).map(|i| {
            let end = &ends[i * ends.len() / count];
            let ahead = end.from.0 + end.reading * end.towards.0;
            let left = end.from.1 + end.reading * end.towards.1;
            Beam {
                end: (ahead, left),
                from: end.from,
                towards: end.towards,
                cells: end.reading,
                weight: end.weight,
            }
        }));
        let sum: f64 = self.beams.iter().map(|beam| beam.weight).sum();
        let independent = f64::from(config.particles_independent);
        let power = (independent / sum.max(f64::MIN_POSITIVE)).min(1.0);
        for beam in &mut self.beams {
            beam.weight *= power;
        }
        self.weight = sum * power;
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::beams::BeamConfig;
    use crate::scan::Scan;
    use crate::space::Space;

    fn chosen(ranges: &[f32], config: &ParticlesConfig) -> Beams {
        let scan = Scan {
            angle_min: -FRAC_PI_2,
            angle_increment: 0.1,
            range_min_m: 0.0,
            range_max_m: 100.0,
            ranges,
        };
        let space = Space::new(360, 0.1, 500, 500).unwrap();
        let every = BeamConfig {
            beam_arc_m: 0.0,
            ..BeamConfig::default()
        };
        let mut beams = Beams::default();
        beams.choose(&Ends::new(&scan, &space, &every).unwrap(), config);
        beams
    }

    #[test]
    fn beams_are_taken_evenly_and_count_as_a_few() {
        let ranges: Vec<f32> = (10..40).map(|m| m as f32).collect();
        let config = ParticlesConfig {
            particles_beams: 6,
            particles_independent: 3,
            ..ParticlesConfig::default()
        };
        let beams = chosen(&ranges, &config);
        let cells: Vec<f64> = beams.beams.iter().map(|beam| beam.cells.round()).collect();
        assert_eq!(cells, [100.0, 150.0, 200.0, 250.0, 300.0, 350.0]);
        assert!((beams.weight - 3.0).abs() < 1e-12);
        assert!(beams.beams.iter().all(|beam| beam.weight == 0.5));
        let (x, y) = beams.beams[0].end;
        assert!(x.abs() < 1e-9 && (y + 100.0).abs() < 1e-9, "{x} {y}");
    }

    #[test]
    fn fewer_beams_than_are_independent_count_in_full() {
        let beams = chosen(&[1.0, 2.0], &ParticlesConfig::default());
        assert_eq!(beams.weight, 2.0);
        assert_eq!(
            chosen(&[f32::INFINITY], &ParticlesConfig::default()).beams,
            []
        );
    }
}
