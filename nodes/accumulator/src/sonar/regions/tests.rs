use std::f64::consts::FRAC_PI_2;

use super::*;

/// Echo of a transducer with this axis from a wall with this normal (degrees) and depth.
fn echo(x: f64, y: f64, axis: f64, (normal, depth_m): (f64, f64)) -> Echo {
    let (sin, cos) = normal.to_radians().sin_cos();
    Echo {
        scan_from_transducer: Pose::new(x, y, axis.to_radians()),
        range_m: depth_m - x * cos - y * sin,
    }
}

fn found(echoes: &[Echo]) -> Vec<(i64, f64, Vec<usize>)> {
    let found = regions(echoes, &RegionConfig::default()).into_iter();
    let rounded = |region: Region| {
        let mut echoes = region.echoes;
        echoes.sort_unstable();
        let depth_cm = (region.depth_m * 100.0).round();
        (region.bearing.to_degrees().round() as i64, depth_cm, echoes)
    };
    found.map(rounded).collect()
}

/// Echoes of one wall by one transducer at ten positions along a metre.
fn drive(axis: f64, wall: (f64, f64)) -> Vec<Echo> {
    let places = (0..10).map(|i| f64::from(i) / 9.0);
    places.map(|x| echo(x, 0.0, axis, wall)).collect()
}

#[test]
fn a_wall_that_is_passed_has_its_true_bearing_not_that_of_the_axis() {
    let all: Vec<usize> = (0..10).collect();
    for normal in [80.0, 90.0, 100.0] {
        let found = found(&drive(90.0, (normal, 2.0)));
        let [(bearing, depth_cm, echoes)] = &found[..] else {
            panic!("{found:?}");
        };
        // A metre of path distinguishes bearings that differ by 6 cm / 1 m, 3 degrees, and the
        // depth at one of those is off by that share of half the path.
        assert!((bearing - normal as i64).abs() <= 2, "{found:?}");
        assert!((depth_cm - 200.0).abs() <= 3.0, "{found:?}");
        assert_eq!(*echoes, all);
    }
}

#[test]
fn a_robot_that_turns_on_the_spot_sees_a_wall_over_the_width_of_its_cone() {
    // One echo every three degrees; the wall ahead answers within 15 degrees.
    let axes = (-5..=5).map(|i| f64::from(i) * 3.0);
    let echoes: Vec<Echo> = axes.map(|axis| echo(0.0, 0.0, axis, (0.0, 2.0))).collect();
    assert_eq!(found(&echoes), [(0, 200.0, (0..11).collect())]);
}

#[test]
fn echoes_that_a_robot_repeats_from_one_place_are_no_region() {
    let still = vec![echo(0.0, 0.0, 90.0, (90.0, 2.0)); 20];
    assert_eq!(found(&still), []);
}

#[test]
fn two_walls_are_two_regions_and_cross_talk_is_in_none() {
    let mut echoes = drive(90.0, (90.0, 2.0));
    echoes.extend(drive(-90.0, (-90.0, 1.0)).into_iter().take(8));
    // Three impossible echoes in the left one's cone that agree with nothing.
    for (i, range_m) in [(2, 0.7), (4, 4.1), (6, 3.0)] {
        echoes[i].range_m = range_m;
    }
    let left = [0, 1, 3, 5, 7, 8, 9].to_vec();
    let expected = [(-90, 100.0, (10..18).collect()), (90, 200.0, left)];
    assert_eq!(found(&echoes), expected);
}

#[test]
fn regions_vote_where_their_walls_were_met() {
    // The axis is ten degrees off the wall's normal, at 100 degrees.
    let echoes = drive(90.0, (100.0, 2.0));
    let regions = regions(&echoes, &RegionConfig::default());
    let ranges = at_regions(&echoes, &regions);
    let points: Vec<_> = (0..BEARINGS)
        .filter(|&i| ranges[i].is_finite())
        .map(|i| (angle_of(i), f64::from(ranges[i])))
        .collect();
    assert!(points.len() >= 8, "{points:?}");
    let (sin, cos) = 100f64.to_radians().sin_cos();
    for (bearing, metres) in points {
        let depth_m = metres * (bearing.cos() * cos + bearing.sin() * sin);
        // Rounding a bearing by half a degree moves the foot of a wall seen at up to 25 degrees by
        // 1 cm; the region's own bearing is as accurate.
        assert!((depth_m - 2.0).abs() < 0.04, "{bearing}: {depth_m}");
    }
}

#[test]
fn an_echo_is_spread_over_its_cone_and_over_the_turn() {
    let at = |degrees: i64, ranges: &[f32]| ranges[(degrees + 180) as usize];
    let echo = |axis: f64, range_m| Echo {
        scan_from_transducer: Pose::new(0.0, 0.0, axis.to_radians()),
        range_m,
    };
    let ranges = spread(&[echo(0.0, 2.0), echo(10.0, 1.0), echo(179.0, 3.0)], 0.1);
    // Five whole degrees to each side; at five, both are equally far from their axes.
    assert_eq!(at(4, &ranges), 2.0);
    assert_eq!(at(5, &ranges), 1.0);
    assert!(at(-6, &ranges).is_nan() && at(16, &ranges).is_nan());
    assert_eq!([at(174, &ranges), at(-176, &ranges)], [3.0, 3.0]);
    assert_eq!(ranges.iter().filter(|range| !range.is_nan()).count(), 32);
    let alone = spread(&[echo(10.0, 1.0)], 0.0);
    assert_eq!(alone.iter().filter(|range| !range.is_nan()).count(), 1);
}

#[test]
fn echoes_of_a_scan_lie_where_it_was_taken() {
    let scan = Scan {
        angle_min: 0.0,
        angle_increment: FRAC_PI_2,
        range_min_m: 0.0,
        range_max_m: 10.0,
        ranges: &[f32::NAN, 2.0, f32::INFINITY],
    };
    let moved = Pose::new(1.0, 0.5, FRAC_PI_2);
    let echoes: Vec<Echo> = Echo::of(&scan, moved).unwrap().collect();
    assert_eq!(echoes.len(), 1);
    let (x, y) = echoes[0].point(echoes[0].scan_from_transducer.yaw);
    // The transducer looks to the left of a robot that has turned left.
    assert!((x + 1.0).abs() < 1e-12 && (y - 0.5).abs() < 1e-12);
    let unsound = Scan {
        ranges: &[],
        ..scan
    };
    assert_eq!(
        Echo::of(&unsound, moved).err(),
        Some(EngineError::EmptyScan)
    );
}
