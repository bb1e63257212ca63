//! Messages of one scan, for tests of their output.

use bytemuck::Zeroable;
use messages::{HypothesesHeader, Hypothesis, Pose2, PoseHeader, Stamp, TrackState};

use super::ScanAnswer;

const PLACE: Pose2 = Pose2 {
    x: 1.0,
    y: -2.0,
    yaw: std::f64::consts::PI,
};

fn stamp(measured_ns: i64, counter: u64) -> Stamp {
    Stamp {
        measured_ns,
        entered_ns: 5_000_000,
        counter,
    }
}

/// Creates an answer to the scan measured at `measured_ns`: at (1, -2), half a turn from the x
/// axis, after 25 ms, 24 ms of them computing.
pub fn message(
    measured_ns: i64,
    counter: u64,
    verdict: u32,
) -> (HypothesesHeader, [Hypothesis; 1]) {
    let header = HypothesesHeader {
        stamp: stamp(measured_ns, counter),
        sent_ns: 30_000_000,
        search_ns: 20_000_000,
        extract_ns: 4_000_000,
        verdict,
        alternatives: 2,
        ..HypothesesHeader::zeroed()
    };
    let hypothesis = Hypothesis {
        map_from_laser: PLACE,
        score: 0.875,
        ..Hypothesis::zeroed()
    };
    (header, [hypothesis])
}

pub fn answer(header: &HypothesesHeader, found: &[Hypothesis]) -> ScanAnswer {
    ScanAnswer::new(header, found, &|_| None)
}

/// Creates the pose of the scan measured at `measured_ns`: the laser at (1, -2), half a turn from
/// the x axis, 26 ms after the scan.
pub fn pose(measured_ns: i64, counter: u64, state: TrackState) -> PoseHeader {
    PoseHeader {
        stamp: stamp(measured_ns, counter),
        sent_ns: 31_000_000,
        map_from_laser: PLACE,
        laser_covariance: [4e-4, 0.0, 0.0, 0.0, 1e-4, 0.0, 0.0, 0.0, 1e-6],
        probability: 0.975,
        state: state as u32,
        places: 2,
        from_scan: 1,
        pose_known: (state != TrackState::Searching).into(),
        ..PoseHeader::zeroed()
    }
}
