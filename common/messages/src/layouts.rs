//! Size, alignment and the offset of every field of all messages: a change needs a new version.

use crate::*;

macro_rules! pin {
    ($($type:ty, size $size:literal, align $align:literal { $($field:ident: $offset:literal),+ })+) => {
        #[test]
        fn layouts_are_pinned() {
            $(
                let of = stringify!($type);
                assert_eq!((size_of::<$type>(), align_of::<$type>()), ($size, $align), "{of}");
                $(
                    let found = std::mem::offset_of!($type, $field);
                    assert_eq!(found, $offset, "{of}::{}", stringify!($field));
                )+
            )+
        }
    };
}

pin! {
    AttentionHeader, size 24, align 8 { stamp: 0 }
    BeamsHeader, size 56, align 8 { stamp: 0, map_id: 24, map_from_laser: 32 }
    Beam, size 16, align 4 { bearing: 0, range_m: 4, weight: 8, fate: 12 }
    BoundaryHeader, size 56, align 8 {
        stamp: 0, map_id: 24, free_cells: 32, boundary_cells: 40, occupied_cells: 48
    }
    BoundaryCell, size 4, align 2 { x: 0, y: 2 }
    FieldHeader, size 64, align 8 {
        stamp: 0, map_id: 24, width: 32, height: 36, block: 40, kind: 44, best: 48,
        highest_possible: 52, heading: 56
    }
    GroundTruth, size 304, align 8 { stamp: 0, map_from_laser: 24, frame: 48 }
    HealthHeader, size 80, align 8 {
        node: 0, sent_ns: 32, received: 40, sent: 48, dropped: 56, refused: 64, pid: 72, state: 76
    }
    HypothesesHeader, size 104, align 8 {
        stamp: 0, map_id: 24, sent_ns: 32, search_ns: 40, extract_ns: 48, verdict: 56,
        alternatives: 60, confidence: 64, inlier_share: 68, best: 72, highest_possible: 76,
        mount_known: 80, searched: 88, settings: 96
    }
    Hypothesis, size 152, align 8 {
        map_from_laser: 0, map_from_base: 24, covariance: 48, score: 120, probability: 124,
        intensity: 128, support: 136, map_id: 144
    }
    InitialPose, size 128, align 8 { stamp: 0, kind: 24, map_from_base: 32, covariance: 56 }
    LogHeader, size 72, align 8 {
        node: 0, written_ns: 32, wall_ns: 40, counter: 48, dropped: 56, level: 64, pid: 68
    }
    MapHeader, size 152, align 8 {
        stamp: 0, map_id: 24, width: 32, height: 36, resolution_m: 40, map_from_grid: 48,
        occupied_from: 72, free_to: 76, unknown_blocks: 80, name: 88
    }
    MapsHeader, size 40, align 8 { stamp: 0, set_id: 24, maps: 32, transitions: 36 }
    Odometry, size 656, align 8 {
        stamp: 0, odom_from_child: 24, twist: 48, covariance: 72, frame: 144, child_frame: 400
    }
    ParticlesHeader, size 40, align 8 { stamp: 0, map_id: 24, mount_known: 32 }
    Particle, size 24, align 8 { map_from_base: 0 }
    Pose2, size 24, align 8 { x: 0, y: 8, yaw: 16 }
    ReadingsHeader, size 24, align 8 { stamp: 0 }
    Reading, size 40, align 8 { from_x: 0, from_y: 8, bearing: 16, range_m: 24, weight: 32 }
    RegionHeader, size 24, align 8 { stamp: 0 }
    Corner, size 16, align 8 { x: 0, y: 8 }
    SaveHeader, size 24, align 8 { stamp: 0 }
    ScanHeader, size 392, align 8 {
        stamp: 0, angle_min: 24, angle_increment: 32, time_increment_s: 40, scan_time_s: 48,
        range_min_m: 56, range_max_m: 60, base_from_laser: 64, mount_known: 88, upside_down: 96,
        laser: 104, frame: 136
    }
    Stamp, size 24, align 8 { measured_ns: 0, entered_ns: 8, counter: 16 }
    PoseHeader, size 592, align 8 {
        stamp: 0, map_id: 24, sent_ns: 32, tracking_ns: 40, since_ns: 48, since_m: 56,
        map_from_laser: 64, map_from_base: 88, map_from_odom: 112, laser_covariance: 136,
        base_covariance: 208, probability: 280, lead: 288, score: 296, state: 304, reason: 308,
        places: 312, from_scan: 316, pose_known: 320, mount_known: 324, odom_known: 328,
        odom_frame: 336
    }
    VotesHeader, size 192, align 8 {
        stamp: 0, map_id: 24, total: 32, engine_ns: 40, poses_evaluated: 48, outcome: 56,
        headings: 60, floor: 64, certified_floor: 68, best: 72, highest_possible: 76, truncated: 80,
        beams_used: 84, heading_known: 88, beams_silent: 92, known_heading: 96,
        bearing_rounding: 104, base_from_laser: 112, mount_known: 136, max_beams: 144, pooling: 148,
        beam_arc_m: 152, has_readings: 160, lasers_used: 164, maps: 168, searched: 176,
        settings: 184
    }
    VotesByMapHeader, size 24, align 8 { stamp: 0 }
    Vote, size 8, align 2 { x: 0, y: 2, heading: 4, intensity: 6 }
}
