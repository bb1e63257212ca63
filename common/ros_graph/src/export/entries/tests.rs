use bytemuck::Zeroable;
use messages::{FrameName, TrackState, Verdict};

use super::*;

fn entries() -> Entries {
    Entries::new(&Options {
        map_frame: "map".into(),
        base_frame: "base_link".into(),
    })
}

fn stamp(measured_ns: i64, entered_ns: i64) -> Stamp {
    Stamp {
        measured_ns,
        entered_ns,
        counter: 0,
    }
}

fn scan(at: Stamp) -> ScanHeader {
    ScanHeader {
        stamp: at,
        frame: FrameName::new("laser"),
        ..ScanHeader::zeroed()
    }
}

fn map(cells: &[u8]) -> MapHeader {
    let mut header = MapHeader {
        width: 2,
        height: 1,
        resolution_m: 0.05,
        ..MapHeader::default()
    };
    header.map_id = header.id_of(cells);
    header
}

/// Topics and times of the entries; metadata by name, at time 0.
fn made(entries: &mut Entries) -> Vec<(&'static str, i64)> {
    let show = |entry| match entry {
        Entry::Message(message) => match message.topic {
            Cow::Borrowed(topic) => (topic, message.log_time_ns),
            Cow::Owned(topic) => panic!("{topic}: there is one laser"),
        },
        Entry::Metadata(name, _) => (name, 0),
    };
    entries.take().into_iter().map(show).collect()
}

#[test]
fn what_has_no_measurement_waits_for_the_first_one() {
    let mut entries = entries();
    entries.map(&map(&[0, 100]), &[0, 100], 5).unwrap();
    entries.health(&HealthHeader::zeroed(), b"", 6).unwrap();
    entries.log(&LogHeader::zeroed(), b"hello").unwrap();
    assert_eq!(made(&mut entries), []);
    entries.scan(&scan(stamp(1000, 10)), &[1.0]).unwrap();
    let expected = [
        ("backcast/map", 0),
        ("/map", 1000),
        ("/diagnostics", 1000),
        ("/rosout", 1000),
        ("/scan", 1000),
    ];
    assert_eq!(made(&mut entries), expected);
    // From then on the host's clock gives the time since the measurement.
    entries.health(&HealthHeader::zeroed(), b"", 40).unwrap();
    entries.map(&map(&[0, 100]), &[0, 100], 50).unwrap();
    entries.map(&map(&[0, 0]), &[0, 0], 60).unwrap();
    let expected = [("/diagnostics", 1030), ("backcast/map", 0), ("/map", 1050)];
    assert_eq!(made(&mut entries), expected);
    let line = LogHeader {
        written_ns: 70,
        ..LogHeader::zeroed()
    };
    entries.log(&line, b"hello").unwrap();
    assert_eq!(made(&mut entries), [("/rosout", 1060)]);
}

#[test]
fn without_any_measurement_the_wall_clock_counts() {
    let mut entries = entries();
    entries.map(&map(&[0, 100]), &[0, 100], 5).unwrap();
    entries.finish(77).unwrap();
    assert_eq!(made(&mut entries), [("backcast/map", 0), ("/map", 77)]);
}

#[test]
fn times_that_ros_cannot_say_are_refused() {
    let mut entries = entries();
    for ns in [-1, i64::MAX] {
        let error = entries.scan(&scan(stamp(ns, 0)), &[]).unwrap_err();
        assert!(
            error.to_string().starts_with("topic scan: a stamp of"),
            "{error}"
        );
    }
    assert_eq!(made(&mut entries), []);
    let error = entries.map(&map(&[0]), &[0], 5).unwrap_err().to_string();
    assert_eq!(error, "topic map: 2 x 1 cells are claimed, 1 are there");
}

#[test]
fn particles_have_the_time_of_their_scan() {
    let mut entries = entries();
    let header = ParticlesHeader {
        stamp: stamp(1000, 10),
        ..ParticlesHeader::zeroed()
    };
    entries.scan(&scan(stamp(1000, 10)), &[1.0]).unwrap();
    made(&mut entries);
    entries.particles(&header, &[Particle::zeroed()]).unwrap();
    assert_eq!(made(&mut entries), [("/particles", 1000)]);
}

#[test]
fn the_tracker_stands_in_three_forms_and_its_state_in_one_where_it_has_no_pose() {
    let mut entries = entries();
    entries.scan(&scan(stamp(1000, 10)), &[1.0]).unwrap();
    made(&mut entries);
    let searching = PoseHeader {
        stamp: stamp(1000, 10),
        from_scan: 1,
        ..PoseHeader::zeroed()
    };
    entries.tracked(&searching, b"drive a few metres").unwrap();
    assert_eq!(made(&mut entries), [("/backcast/pose", 1000)]);
    let unique = PoseHeader {
        state: TrackState::Unique as u32,
        pose_known: 1,
        ..searching
    };
    entries.tracked(&unique, b"").unwrap();
    let all = [("/backcast/pose", 1000), ("/pose", 1000), ("/tf", 1000)];
    assert_eq!(made(&mut entries), all);
    let between = PoseHeader {
        from_scan: 0,
        ..unique
    };
    entries.tracked(&between, b"").unwrap();
    assert_eq!(made(&mut entries), []);
}

#[test]
fn hypotheses_stand_in_several_forms_and_no_hypothesis_has_no_pose() {
    let mut entries = entries();
    let header = HypothesesHeader {
        stamp: stamp(1000, 10),
        verdict: Verdict::Unique as u32,
        ..HypothesesHeader::zeroed()
    };
    entries.scan(&scan(stamp(1000, 10)), &[1.0]).unwrap();
    made(&mut entries);
    entries.hypotheses(&header, &[]).unwrap();
    let empty = [("/backcast/hypotheses", 1000), ("/hypotheses", 1000)];
    assert_eq!(made(&mut entries), empty);
    entries
        .hypotheses(&header, &[Hypothesis::zeroed()])
        .unwrap();
    let one = [&empty[..], &[("/pose", 1000), ("/tf", 1000)]].concat();
    assert_eq!(made(&mut entries), one);
    // Once there is a tracker, hypotheses give no pose.
    entries.expect_tracker();
    entries
        .hypotheses(&header, &[Hypothesis::zeroed()])
        .unwrap();
    assert_eq!(made(&mut entries), empty);
}
