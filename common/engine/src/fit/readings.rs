//! Beams of carried scans for the second stage, each seen from its own laser's pose.

use messages::Reading;

use crate::EngineError;
use crate::beams::{BeamConfig, Chosen};
use crate::observation::{CarriedScan, Observation};
use crate::scan::Scan;
use crate::space::Space;

/// The beams of an observation in the target frame; the buffers are reused from scan to scan.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Readings {
    chosen: Chosen,
    /// Beams with an end, laser by laser, followed by the silent ones.
    pub found: Vec<Reading>,
}

impl Readings {
    /// Finds the beams of each laser, thinned as for voting; none for an [`Observation::Still`].
    ///
    /// # Errors
    /// If [`Observation::check`] rejects the scan; the beams of the scan before stay.
    pub fn find(
        &mut self,
        observation: Observation<'_>,
        space: &Space,
        config: &BeamConfig,
    ) -> Result<(), EngineError> {
        observation.check()?;
        match observation {
            Observation::Still(_) => self.found.clear(),
            Observation::Carried(scans) => self.collect(scans, space, config),
        }
        Ok(())
    }

    /// Takes the beams of scans that were checked.
    pub(super) fn collect(
        &mut self,
        scans: &[CarriedScan<'_>],
        space: &Space,
        config: &BeamConfig,
    ) {
        self.found.clear();
        for carried in scans {
            self.add(carried, space, config);
        }
        if scans.len() > 1 {
            // Stable sort: beams with an end first, otherwise in the same order.
            let is_silent = |reading: &Reading| reading.range_m == f64::INFINITY;
            self.found.sort_by_key(is_silent);
        }
    }

    fn add(&mut self, carried: &CarriedScan<'_>, space: &Space, config: &BeamConfig) {
        self.chosen
            .choose((&carried.scan).into(), 0.0, space, config);
        self.found.extend(self.chosen.beams.iter().map(|beam| {
            let laser = carried.laser(beam.index);
            Reading {
                from_x: laser.x,
                from_y: laser.y,
                bearing: laser.yaw + beam.angle,
                range_m: beam.reading_m,
                weight: beam.weight,
            }
        }));
        let turn = carried.laser(carried.scan.beams() / 2).yaw;
        self.found
            .extend(self.chosen.silent.iter().map(|bearing| Reading {
                bearing: turn + bearing,
                range_m: f64::INFINITY,
                ..Reading::default()
            }));
    }
}

/// Returns a scan as carried nowhere: where a pose is missing, the laser is at the origin.
pub(super) fn still(scan: Scan<'_>) -> CarriedScan<'_> {
    CarriedScan {
        scan,
        target_from_laser: &[],
    }
}

/// True if a reading from another process is valid.
pub(super) fn is_sound(reading: &Reading) -> bool {
    let Reading {
        from_x,
        from_y,
        bearing,
        range_m,
        weight,
    } = *reading;
    let numbers = [from_x, from_y, bearing, weight];
    numbers.iter().all(|number| number.is_finite())
        && range_m > 0.0
        && (0.0..=2.0).contains(&weight)
}

#[cfg(test)]
mod tests {
    use geometry::Pose;

    use super::*;
    use crate::fit::Ends;
    use crate::testing::scan_from;

    fn space() -> Space {
        Space::new(360, 0.1, 500, 500).unwrap()
    }

    fn scan(ranges: &[f32]) -> Scan<'_> {
        scan_from(-1.0, 0.25, ranges)
    }

    #[test]
    fn a_scan_carried_nowhere_is_the_scan_as_it_came() {
        let ranges = [1.0, f32::INFINITY, 3.0, 4.5, 30.0, 2.0];
        let (still, config) = (scan(&ranges), BeamConfig::default());
        let carried = [CarriedScan {
            scan: still,
            target_from_laser: &[Pose::IDENTITY; 6],
        }];
        let expected = Ends::new(&still, &space(), &config).unwrap();
        let found = Ends::new(Observation::Carried(&carried), &space(), &config).unwrap();
        assert_eq!(found.ends, expected.ends);
        assert_eq!(found.silent(), expected.silent());
        assert_eq!(found.weight, expected.weight);
    }

    #[test]
    fn each_beam_is_seen_from_its_own_lasers_place() {
        let ranges = [2.0; 2];
        let at = |x| Pose::new(x, 0.0, 0.5);
        let scans = [
            CarriedScan {
                scan: scan(&ranges),
                target_from_laser: &[at(1.0), at(2.0)],
            },
            CarriedScan {
                scan: scan(&[f32::NAN]),
                target_from_laser: &[at(3.0)],
            },
        ];
        let mut readings = Readings::default();
        let observation = Observation::Carried(&scans);
        readings
            .find(observation, &space(), &BeamConfig::default())
            .unwrap();
        let found = readings.found.iter();
        let found: Vec<_> = found.map(|r| (r.from_x, r.bearing, r.range_m)).collect();
        let silent = (0.0, -0.5, f64::INFINITY);
        assert_eq!(found, [(1.0, -0.5, 2.0), (2.0, -0.25, 2.0), silent]);
    }

    #[test]
    fn readings_from_elsewhere_are_checked() {
        let sound = Reading {
            range_m: 1.0,
            weight: 1.0,
            ..Reading::default()
        };
        let mut ends = Ends::default();
        ends.take(&[sound], 0.1).unwrap();
        let breaks: [fn(&mut Reading); 3] = [
            |reading| reading.range_m = -1.0,
            |reading| reading.bearing = f64::NAN,
            |reading| reading.weight = 3.0,
        ];
        for to_break in breaks {
            let mut broken = sound;
            to_break(&mut broken);
            let refused = ends.take(&[sound, broken], 0.1);
            assert_eq!(refused, Err(EngineError::Reading { beam: 1 }));
            assert_eq!(ends.silent().len() + ends.ends.len(), 0);
        }
    }
}
