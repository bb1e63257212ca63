//! Beams that weight the particles: an even selection of a scan's beams.

use messages::Reading;

use super::ParticlesConfig;

/// Selected beams of one scan; the buffers are reused.
#[derive(Debug, Clone, Default)]
pub(super) struct Beams {
    /// End points in cells of the target frame.
    pub(super) ends: Vec<(f64, f64)>,
    /// Exponent of each beam's likelihood.
    pub(super) weight: f64,
}

impl Beams {
    pub(super) fn choose(
        &mut self,
        readings: &[Reading],
        resolution_m: f64,
        config: &ParticlesConfig,
    ) {
        let count = readings.len().min(config.particles_beams.max(1) as usize);
        let end = |reading: &Reading| {
            let (sin, cos) = reading.bearing.sin_cos();
            let cells = reading.range_m / resolution_m;
            (cells * cos, cells * sin)
        };
        self.ends.clear();
        let evenly = (0..count).map(|i| &readings[i * readings.len() / count]);
        self.ends.extend(evenly.map(end));
        let independent = f64::from(config.particles_independent);
        self.weight = (independent / count.max(1) as f64).min(1.0);
    }

    /// Number of independent beams that all beams count for.
    pub(super) fn together(&self) -> f64 {
        self.weight * self.ends.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(ranges_m: &[f64], config: &ParticlesConfig) -> Beams {
        let reading = |&range_m: &f64| Reading {
            range_m,
            ..Reading::default()
        };
        let readings: Vec<Reading> = ranges_m.iter().map(reading).collect();
        let mut beams = Beams::default();
        beams.choose(&readings, 0.1, config);
        beams
    }

    #[test]
    fn beams_are_taken_evenly_and_count_as_a_few() {
        let ranges: Vec<f64> = (10..40).map(f64::from).collect();
        let config = ParticlesConfig {
            particles_beams: 6,
            particles_independent: 3,
            ..ParticlesConfig::default()
        };
        let beams = chosen(&ranges, &config);
        let ahead: Vec<f64> = beams.ends.iter().map(|end| end.0.round()).collect();
        assert_eq!(ahead, [100.0, 150.0, 200.0, 250.0, 300.0, 350.0]);
        assert_eq!((beams.weight, beams.together()), (0.5, 3.0));
    }

    #[test]
    fn fewer_beams_than_are_independent_count_in_full() {
        let beams = chosen(&[1.0, 2.0], &ParticlesConfig::default());
        assert_eq!((beams.weight, beams.together()), (1.0, 2.0));
        assert!(chosen(&[], &ParticlesConfig::default()).ends.is_empty());
    }
}
