//! Maps with cells of any size, and lasers with any field of view and number of beams.

use std::f64::consts::TAU;

use engine::grid::{CellRules, Grid, Pooled};
use engine::localizer::Localizer;
use engine::peaks::{Place, Places};
use engine::vote_search::{Prior, VoteSearch, VoteSearchConfig};
use geometry::{Pose, angle_between};
use messages::Verdict;
use tests::building::{Building, Laser, places};

/// An office: a corridor, rooms of different sizes with a door each, and
/// furniture.
fn office() -> Building {
    let rooms = [0.5, 4.2, 6.9, 11.3, 14.0];
    let mut office = Building::new(14.6, 9.2).room([0.3, 0.3, 14.3, 8.9]);
    for (i, walls) in rooms.windows(2).enumerate() {
        let (left, right) = (walls[0], walls[1]);
        let door = left + 0.6 + 0.35 * i as f64;
        office = office
            .with([left, 5.0, door, 5.1])
            .with([door + 0.9, 5.0, right, 5.1])
            .with([right - 0.1, 5.0, right, 8.9])
            .with([
                left + 1.0 + 0.2 * i as f64,
                7.0,
                left + 1.9,
                7.8 + 0.1 * i as f64,
            ]);
    }
    office
        .with([2.0, 0.4, 2.5, 1.0])
        .with([6.0, 2.4, 6.7, 3.1])
        .with([10.0, 0.4, 10.8, 0.9])
        .with([12.5, 3.2, 12.8, 4.4])
}

const POSES: [Pose; 6] = [
    Pose::new(1.2, 2.7, 0.3),
    Pose::new(3.6, 6.1, -1.9),
    Pose::new(5.0, 8.2, 2.6),
    Pose::new(8.3, 1.8, 1.1),
    Pose::new(9.9, 6.3, -0.7),
    Pose::new(13.2, 2.2, 3.0),
];

fn error(places: &Places, truth: Pose) -> (f64, f64) {
    let found = places.places[0].map_from_laser;
    let distance = (found.x - truth.x).hypot(found.y - truth.y);
    (distance, angle_between(found.yaw, truth.yaw).to_degrees())
}

fn locate(localizer: &Localizer, truth: Pose, laser: Laser) -> Places {
    let ranges = office().ranges(truth, laser);
    places(localizer, &laser.scan(&ranges))
}

#[test]
fn cells_of_any_size_find_the_robot() {
    for (resolution_m, pooling) in [(0.01, 5), (0.02, 2), (0.05, 1), (0.2, 1), (0.5, 1)] {
        let localizer = office()
            .map(resolution_m)
            .localizer(VoteSearchConfig::default());
        assert_eq!(localizer.maps()[0].vote_search().pooling(), pooling);
        for truth in POSES {
            let places = locate(&localizer, truth, Laser::AROUND);
            let (metres, degrees) = error(&places, truth);
            // Obstacles fill whole cells, so that a wall is off by up to half of one.
            assert!(
                metres <= resolution_m / 2.0 && degrees < 2.0,
                "{resolution_m}: {truth:?}"
            );
        }
    }
}

#[test]
fn a_fine_map_is_searched_exactly_as_its_pooled_one() {
    let fine = office().map(0.01);
    let config = VoteSearchConfig::default();
    let rules = CellRules::default();
    let pooled = Pooled::new(fine.frame, fine.sides, &fine.occupancy, rules, 5).unwrap();
    let (width, height) = pooled.sides;
    let grid = Grid::new(width, height, &pooled.occupancy, rules).unwrap();
    let plain = VoteSearch::new(pooled.frame, grid, config.clone(), Prior::None).unwrap();
    let localizer = fine.localizer(config);
    let ranges = office().ranges(POSES[0], Laser::AROUND);
    let scan = Laser::AROUND.scan(&ranges);
    let search = |vote_search: &VoteSearch| vote_search.search(&scan, &|| false);
    assert_eq!(search(localizer.maps()[0].vote_search()), search(&plain));
}

#[test]
fn any_field_of_view_and_number_of_beams_will_do() {
    let localizer = office().map(0.05).localizer(VoteSearchConfig::default());
    let mut unique = 0;
    for field_of_view in [90.0, 180.0, 270.0, 359.9f64] {
        for beams in [30, 181, 1081, 4000] {
            let laser = Laser {
                beams,
                field_of_view: field_of_view.to_radians(),
                reach_m: 20.0,
            };
            for truth in POSES {
                let places = locate(&localizer, truth, laser);
                let (metres, degrees) = error(&places, truth);
                let is_unique = places.verdict == Verdict::Unique;
                unique += u32::from(is_unique);
                let case = format!("{field_of_view} {beams}: {truth:?}");
                // A quarter or half of a turn does not always show enough to tell which room it is.
                if is_unique || field_of_view >= 270.0 {
                    assert!(metres < 0.1 && degrees < 3.0, "{case}");
                }
                let is_near = |place: &Place| place.map_from_laser.is_within(truth, 0.2, 0.1);
                assert!(places.places.iter().any(is_near), "{case}");
            }
        }
    }
    assert!(unique >= 72, "{unique} of 96 are unique");
}

#[test]
fn a_ring_of_eight_sonars_is_never_sure_of_a_wrong_place() {
    // Six ahead and two behind, in a scan of twelve bearings.
    let laser = Laser {
        beams: 12,
        field_of_view: 11.0 / 12.0 * TAU,
        reach_m: 5.0,
    };
    let localizer = office().map(0.05).localizer(VoteSearchConfig::default());
    let mut among = 0;
    for truth in POSES {
        let mut ranges = office().ranges(truth, laser);
        for beam in [1, 2, 9, 10] {
            ranges[beam] = f32::NAN;
        }
        let places = places(&localizer, &laser.scan(&ranges));
        let (metres, degrees) = error(&places, truth);
        let is_right = metres < 0.5 && degrees < 10.0;
        assert!(places.verdict != Verdict::Unique || is_right, "{truth:?}");
        let is_near = |place: &Place| {
            place
                .map_from_laser
                .is_within(truth, 0.5, 10f64.to_radians())
        };
        among += u32::from(places.places.iter().any(is_near));
    }
    assert!(among >= 5, "{among} of 6 truths are among the hypotheses");
}
