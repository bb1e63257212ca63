//! The node with known headings: only x and y are searched, and the intensity image is published.

use std::f64::consts::FRAC_PI_2;

use bytemuck::Zeroable;
use engine::vote_search::Prior;
use messages::{FieldHeader, FieldKind, FrameName, Odometry, Pose2, SearchOutcome, Stamp, topic};
use transport::testing::{Isolated, wait_for_next};

use tests::drawn_room::{FRAME, MOUNT, ROOM, ranges, scan};

use crate::world::{World, id, vote_search};

/// Heading in the grid's frame, as in the drawn scans, degrees.
const HEADING: usize = 40;

/// Returns the same heading in the map frame, radians.
fn map_heading() -> f64 {
    (HEADING as f64).to_radians() + FRAME.map_from_grid.yaw
}

fn at(measured_ns: i64) -> Stamp {
    Stamp::measured_at(measured_ns)
}

fn turned(yaw: f64) -> Pose2 {
    Pose2::new(0.0, 0.0, yaw)
}

#[test]
fn a_fixed_heading_gives_the_votes_and_the_image_of_the_engine() {
    let isolated = Isolated::new("fixed");
    let world = World::new(&isolated);
    let degrees = map_heading().to_degrees().to_string();
    let node = world.start_on(&ROOM, &["--heading", &degrees, "--field-rate", "0.1"]);
    let fields = world.graph.subscriber::<topic::Field>().unwrap();
    let ranges = ranges(&ROOM, 3, 3, HEADING);
    let (votes, poses) = world.ask(&ranges);

    let heading = votes.known_heading;
    // The heading was printed in decimal degrees, which costs a rounding or two.
    assert!((heading - map_heading()).abs() < 1e-12, "{heading}");
    let (outcome, image) = vote_search(&ROOM, Prior::Heading)
        .search_at(&scan(&ranges), heading, &|| false)
        .unwrap()
        .unwrap();
    assert_eq!(poses, outcome.found.votes);
    assert_eq!(votes.heading_known, 1);
    assert_eq!(votes.outcome, SearchOutcome::Found as u32);
    assert_eq!(poses.first().map(|best| (best.x, best.y)), Some((3, 3)));

    let expected = FieldHeader {
        stamp: votes.stamp,
        map_id: id(&ROOM),
        width: 16,
        height: 9,
        block: 1,
        kind: FieldKind::Exact as u32,
        best: votes.best,
        highest_possible: votes.highest_possible,
        heading,
    };
    let (header, intensities) = wait_for_next(&world.graph, &fields);
    assert_eq!((header, intensities), (expected, image));

    world.assert_no_image_yet(&fields, &ranges);
    node.stop();
}

#[test]
fn headings_come_from_odometry_of_the_base() {
    let isolated = Isolated::new("odometry");
    let world = World::new(&isolated);
    let odometry = world.graph.publisher::<topic::OdometryTopic>().unwrap();
    let arguments = ["--heading-from", "odometry", "--heading-offset", "90"];
    let node = world.start_on(&ROOM, &arguments);
    let ranges = ranges(&ROOM, 3, 3, HEADING);

    let (votes, _) = world.ask(&ranges);
    assert_eq!(votes.outcome, SearchOutcome::Refused as u32);
    let error = world.wait_for_refused(1);
    let expected = "scan 0 rejected: the scan needs odometry";
    assert!(error.contains(expected), "{error}");

    let report = |measured_ns, yaw| {
        let header = Odometry {
            stamp: at(measured_ns),
            odom_from_child: turned(yaw),
            child_frame: FrameName::new("base_link"),
            ..Zeroable::zeroed()
        };
        odometry.send(header, &[]).unwrap();
    };
    // Scan 1 is measured at 1 s, between these two.
    let yaw = map_heading() - FRAC_PI_2 - MOUNT.yaw;
    report(900_000_000, yaw);
    report(1_100_000_000, 3.0);
    let (votes, poses) = world.ask(&ranges);
    assert_eq!(votes.outcome, SearchOutcome::Found as u32);
    let heading = votes.known_heading;
    assert!((heading - map_heading()).abs() < 1e-12, "{heading}");
    assert_eq!(poses.first().map(|best| (best.x, best.y)), Some((3, 3)));

    // Scan 3 is measured at 3 s: the odometry is then 1.9 s old.
    world.counter.set(3);
    let (votes, _) = world.ask(&ranges);
    assert_eq!(votes.outcome, SearchOutcome::Refused as u32);
    let error = world.wait_for_refused(2);
    assert!(error.contains("1900000000 ns before the scan"), "{error}");
    node.stop();
}
