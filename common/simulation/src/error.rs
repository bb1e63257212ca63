//! Errors of setting up a drive.

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    #[error(
        "corner {corner} of the path, {x},{y}, is not on the map, which spans x {} to {} and y {} to {}",
        to_mm(x_m[0]), to_mm(x_m[1]), to_mm(y_m[0]), to_mm(y_m[1])
    )]
    CornerOffMap {
        /// Counted from 1.
        corner: usize,
        x: f64,
        y: f64,
        /// Minimum and maximum x of the map, in metres.
        x_m: [f64; 2],
        /// Minimum and maximum y of the map, in metres.
        y_m: [f64; 2],
    },
    #[error(
        "the path from corner {} to corner {} meets an obstacle at {x:.2},{y:.2}, {after_m:.2} m after corner {}",
        corner, corner + 1, corner
    )]
    Blocked {
        /// The corner before the obstacle, counted from 1.
        corner: usize,
        /// Position of the obstacle, in metres in the map.
        x: f64,
        y: f64,
        /// Distance from the corner, in metres.
        after_m: f64,
    },
    /// A corner that is equal to the previous one.
    #[error("corners {} and {corner} of the path are the same, {x},{y}", corner - 1)]
    SameCorner {
        /// The second of the two, counted from 1.
        corner: usize,
        x: f64,
        y: f64,
    },
    /// The sensor on its mount leaves the map or enters an obstacle.
    #[error(
        "the sensor comes {} at {x:.2},{y:.2}, where its mount puts it {time_s:.2} s after the start",
        if *on_map { "into an obstacle" } else { "off the map" }
    )]
    SensorBlocked {
        x: f64,
        y: f64,
        time_s: f64,
        /// True if the sensor is on the map, and inside an obstacle.
        on_map: bool,
    },
    #[error("two lasers are called {name}; allowed are lasers with names of their own")]
    SameLaser { name: String },
    /// A scan that is not finished when the next one begins.
    #[error(
        "a scan takes {duration_s} s and the next begins after {period_s} s; allowed are scans that end before"
    )]
    LongScan {
        /// Time from the first beam to the last, in seconds.
        duration_s: f64,
        /// Time between scans, in seconds.
        period_s: f64,
    },
    /// The drive has more scans than a recording should hold.
    #[error("the drive takes {seconds:.0} s, which is {scans} scans; at most {most} are simulated")]
    TooLong { seconds: f64, scans: u64, most: u64 },
    #[error("{people} people find no free place within {within_m} m of the path")]
    NoPlaceForPeople {
        /// Number of people requested.
        people: u32,
        /// Maximum distance from the path, in metres.
        within_m: f64,
    },
}

/// Rounds to millimetres, to hide the rounding of binary fractions.
fn to_mm(metres: f64) -> f64 {
    (metres * 1000.0).round() / 1000.0
}
