use std::f64::consts::FRAC_PI_2;

use super::*;

fn vote(x: u16, y: u16, heading: u16, intensity: u16) -> Vote {
    Vote {
        x,
        y,
        heading,
        intensity,
    }
}

fn by_votes(input: &PeakInput<'_>, config: &PeakConfig) -> Places {
    Workspace::default().by_votes(input, config).clone()
}

fn input(votes: &[Vote]) -> PeakInput<'_> {
    PeakInput {
        votes,
        certified_floor: 85,
        cut: false,
        highest_possible: 200,
        lead: votes.first().map_or(0, |vote| vote.intensity.into()),
        has_others: false,
        headings: 360,
        known_heading: None,
        frame: GridFrame {
            resolution_m: 0.1,
            map_from_grid: Pose::new(0.0, 0.0, FRAC_PI_2),
        },
    }
}

#[test]
fn no_votes_are_no_scan() {
    let places = by_votes(&input(&[]), &PeakConfig::default());
    assert_eq!((places.verdict, places.places.len()), (Verdict::NoScan, 0));
}

#[test]
fn votes_close_by_are_one_place_refined_to_its_centre() {
    let votes = [
        vote(10, 20, 359, 100),
        vote(11, 20, 1, 100),
        vote(10, 20, 1, 99),
        vote(11, 20, 359, 99),
    ];
    let places = by_votes(&input(&votes), &PeakConfig::default());
    assert_eq!(
        (places.verdict, places.places.len(), places.alternatives),
        (Verdict::Unique, 1, 0)
    );
    let best = places.places[0];
    // Cells (11, 20.5) of a grid that is turned by a quarter: x is -y, y is x.
    let centre = Pose::new(-2.05, 1.1, FRAC_PI_2);
    assert!(
        best.map_from_laser.is_within(centre, 1e-9, 1e-9),
        "{:?}",
        best.map_from_laser
    );
    assert_eq!((best.score, best.support), (0.5, 4));
    // Nothing else was found down to 85: the lead is at least 16 of 100.
    assert!((places.confidence - 0.16).abs() < 1e-12);
}

#[test]
fn the_covariance_lies_as_the_peak_does() {
    let votes: Vec<Vote> = (8..=12).map(|x| vote(x, 20, 0, 100)).collect();
    let places = by_votes(&input(&votes), &PeakConfig::default());
    let ellipse = places.places[0].covariance.ellipse();
    // Five cells in a row have variance 2, and rounding adds 1/12.
    assert!((ellipse.major_m - 0.1 * (2.0f64 + 1.0 / 12.0).sqrt()).abs() < 1e-9);
    assert!((ellipse.minor_m - 0.1 * (1.0f64 / 12.0).sqrt()).abs() < 1e-9);
    assert!(
        (ellipse.angle.sin().abs() - 1.0).abs() < 1e-9,
        "the grid's x is the map's y"
    );
}

#[test]
fn equal_places_are_ambiguous_and_weak_ones_fit_poorly() {
    let votes = [
        vote(10, 20, 0, 100),
        vote(40, 20, 0, 95),
        vote(10, 20, 180, 93),
        vote(70, 70, 0, 86),
    ];
    let places = by_votes(&input(&votes), &PeakConfig::default());
    assert_eq!(
        (places.verdict, places.alternatives, places.places.len()),
        (Verdict::Ambiguous, 2, 4)
    );
    assert!((places.confidence - 0.05).abs() < 1e-12);
    let weak = PeakInput {
        highest_possible: 1000,
        ..input(&votes)
    };
    assert_eq!(
        by_votes(&weak, &PeakConfig::default()).verdict,
        Verdict::PoorFit
    );
}

#[test]
fn a_cut_search_is_unique_only_where_no_rival_can_have_been_missed() {
    let votes = [vote(10, 20, 0, 100), vote(40, 20, 0, 60)];
    let verdict = |cut, certified_floor| {
        let input = PeakInput {
            cut,
            certified_floor,
            ..input(&votes)
        };
        by_votes(&input, &PeakConfig::default()).verdict
    };
    // Rivals have at least 92 votes, and poses with one less than the floor may be missing.
    assert_eq!(verdict(true, 92), Verdict::Unique);
    assert_eq!(verdict(true, 93), Verdict::Ambiguous);
    assert_eq!(verdict(true, 180), Verdict::Ambiguous);
    assert_eq!(verdict(false, 93), Verdict::Unique);
}

#[test]
fn a_known_heading_is_kept_as_given() {
    let votes = [vote(10, 20, 30, 100)];
    let known = PeakInput {
        known_heading: Some(0.123),
        ..input(&votes)
    };
    let best = by_votes(&known, &PeakConfig::default()).places[0];
    assert_eq!(best.map_from_laser.yaw, 0.123);
    assert_eq!(best.covariance.0[(2, 2)], 0.0);
}
