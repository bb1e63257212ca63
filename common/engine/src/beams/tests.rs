use geometry::Pose;

use super::*;
use crate::testing::scan_from;

fn choose(scan: &Scan<'_>, turn: f64, space: &Space, config: &BeamConfig) -> Chosen {
    let mut chosen = Chosen::default();
    chosen.choose(scan.into(), turn, space, config);
    chosen
}

fn by_default(scan: &Scan<'_>) -> Chosen {
    choose(scan, 0.0, &space(), &BeamConfig::default())
}

fn half_degrees(ranges: &[f32]) -> Scan<'_> {
    scan_from(-90f64.to_radians(), 0.5f64.to_radians(), ranges)
}

fn space() -> Space {
    Space::new(360, 0.05, 1000, 1000).unwrap()
}

#[test]
fn a_fine_scan_is_thinned_to_beams_on_the_heading_grid() {
    let ranges = [3.0; 361];
    let chosen = by_default(&half_degrees(&ranges));
    assert_eq!(chosen.beams.len(), 180);
    // A half degree is the worst rounding; all but the odd sector avoid it.
    let exact = chosen
        .beams
        .iter()
        .filter(|beam| beam.rounding.abs() < 1e-6)
        .count();
    assert!(exact >= 179, "{exact} of 180 beams lie on the grid");
    assert_eq!(chosen.beams[0].bearing, 270);
}

#[test]
fn a_sector_falls_back_on_the_reading_that_returned() {
    let mut ranges = [f32::INFINITY; 360];
    for i in (1..360).step_by(2) {
        ranges[i] = 4.0;
    }
    let chosen = by_default(&half_degrees(&ranges));
    assert_eq!((chosen.beams.len(), chosen.silent.len()), (180, 0));
}

#[test]
fn near_beams_count_by_the_arc_that_they_cover() {
    let mut ranges = [f32::INFINITY; 180];
    (ranges[0], ranges[1]) = (1.0, 30.0);
    let scan = Scan {
        angle_increment: 1f64.to_radians(),
        ..half_degrees(&ranges)
    };
    let chosen = by_default(&scan);
    let arc = 1f64.to_radians();
    let weights: Vec<f64> = chosen.beams.iter().map(|beam| beam.weight).collect();
    assert_eq!(weights, [arc / 0.20 + 0.05, 1.05]);
    assert_eq!(chosen.silent.len(), 178);
}

#[test]
fn readings_beyond_the_map_are_silent() {
    // The diagonal of 50 m x 50 m is 70.7 m.
    let ranges = [70.0, 71.0];
    let chosen = by_default(&half_degrees(&ranges));
    assert_eq!((chosen.beams.len(), chosen.silent.len()), (1, 1));
}

/// Beams of 90 degrees: to the right, ahead and to the left of the laser.
fn quarters(ranges: &[f32]) -> Scan<'_> {
    scan_from(-90f64.to_radians(), 90f64.to_radians(), ranges)
}

#[test]
fn carried_nowhere_a_scan_is_thinned_as_it_came() {
    let ranges: Vec<f32> = (0..361).map(|i| 2.0 + (i % 7) as f32).collect();
    let (still, config) = (half_degrees(&ranges), BeamConfig::default());
    let expected = choose(&still, 0.25, &space(), &config);
    let carried = [CarriedScan {
        scan: still,
        target_from_laser: &[Pose::IDENTITY; 361],
    }];
    let mut chosen = Chosen::default();
    chosen.choose(Observation::Carried(&carried), 0.25, &space(), &config);
    assert_eq!(chosen.beams.len(), expected.beams.len());
    for (found, expected) in chosen.beams.iter().zip(&expected.beams) {
        // Sine, cosine and arc tangent err by a few units in the last place.
        assert_eq!(
            (found.index, found.bearing),
            (expected.index, expected.bearing)
        );
        assert!((found.reading_m - expected.reading_m).abs() < 1e-12);
        assert!((found.weight - expected.weight).abs() < 1e-12);
    }
}

/// Bearings and readings, to a micrometre.
fn ends(chosen: &Chosen) -> Vec<(usize, f64)> {
    let beams = chosen.beams.iter();
    let end = |beam: &Beam| (beam.bearing, (beam.reading_m * 1e6).round() / 1e6);
    beams.map(end).collect()
}

#[test]
fn of_several_lasers_the_nearest_end_in_a_sector_votes() {
    // One laser is half a metre ahead; the other is half a metre behind and looks back. The rear
    // laser's left is on the same side as the front laser's right.
    let (front, rear) = ([3.0, 4.0, f32::NAN], [2.0, 1.0, 2.5]);
    let at = |x: f64, yaw: f64| [Pose::new(x, 0.0, yaw); 3];
    let (ahead, behind) = (at(0.0, 0.0), at(0.0, std::f64::consts::PI));
    let scans = [
        CarriedScan {
            scan: quarters(&front),
            target_from_laser: &ahead,
        },
        CarriedScan {
            scan: quarters(&rear),
            target_from_laser: &behind,
        },
    ];
    let mut chosen = Chosen::default();
    let config = BeamConfig {
        max_beams: 7,
        beam_arc_m: 2.0,
    };
    chosen.choose(Observation::Carried(&scans), 0.0, &space(), &config);
    assert_eq!(ends(&chosen), [(0, 4.0), (90, 2.0), (180, 1.0), (270, 2.5)]);
    assert!(
        chosen.silent.is_empty(),
        "the rear laser sees what the front misses"
    );
    let arc = 90f64.to_radians();
    assert_eq!(chosen.beams[2].weight, (1.0 * arc / 2.0).min(1.0) + 0.05);
    // A laser that is carried a metre to the left sees everything a metre further there.
    let left = [Pose::new(0.0, 1.0, 0.0); 3];
    let alone = [
        CarriedScan {
            target_from_laser: &left,
            ..scans[0]
        },
        CarriedScan {
            scan: quarters(&[f32::NAN; 3]),
            ..scans[1]
        },
    ];
    chosen.choose(Observation::Carried(&alone), 0.0, &space(), &config);
    let ahead = (4.0f64.hypot(1.0) * 1e6).round() / 1e6;
    assert_eq!(ends(&chosen), [(14, ahead), (270, 2.0)]);
    assert_eq!(chosen.silent.len(), 2);
}

#[test]
fn few_beams_are_all_taken() {
    let ranges = [1.0, 2.0, 3.0];
    let config = BeamConfig {
        beam_arc_m: 0.0,
        ..BeamConfig::default()
    };
    let chosen = choose(&half_degrees(&ranges), 0.0, &space(), &config);
    let readings: Vec<f64> = chosen.beams.iter().map(|beam| beam.reading_m).collect();
    assert_eq!(readings, [1.0, 2.0, 3.0]);
    assert!(chosen.beams.iter().all(|beam| beam.weight == 1.0));
}
