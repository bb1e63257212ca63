//! `backcast doctor` on drives with faults, if these are available.

use tests::{broken_recordings, executables};

/// File, expected words and exit code.
const CASES: [(&str, &str, i32); 13] = [
    ("sure/upside_down_undeclared", "turns the other way", 1),
    ("sure/upside_down_declared_control", "sound", 0),
    ("sure/frozen_laser", "the laser is frozen", 1),
    ("sure/covered_1.0", "read 1.00 m in all directions", 1),
    ("sure/covered_0.5", "read 0.50 m in all directions", 1),
    (
        "sure/courtyard_odometry_stops",
        "29.6 s before the scans",
        1,
    ),
    ("life/odometry_dies_at_start", "ends after 3 messages", 1),
    ("life/odometry_never_moves", "odometry never moves", 1),
    ("life/lidar_clock_2017", "s after the odometry", 1),
    ("life/scans_300ms_late", "odometry leads the laser", 0),
    ("life/time_increment_1s", "time_increment of 1.0 s", 1),
    ("life/millimetres", "they are in millimetres", 1),
    ("life/stands_from_the_start", "poses are of the laser", 0),
];

#[test]
fn what_is_wrong_with_laser_or_odometry_is_named() {
    let test = "what_is_wrong_with_laser_or_odometry_is_named";
    let Some(cases) = broken_recordings(test) else {
        return;
    };
    for (name, words, exit_code) in CASES {
        let file = cases.join(format!("{name}.mcap"));
        let output = executables::backcast()
            .arg("doctor")
            .arg(file)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        let problems = said.matches("  problem").count();
        assert!(said.contains(words), "{name}: {said}");
        assert_eq!(output.status.code(), Some(exit_code), "{name}: {said}");
        assert_eq!(problems, exit_code as usize, "{name}: {said}");
    }
}
