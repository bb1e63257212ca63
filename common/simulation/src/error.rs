//! What a drive can be refused for.

/// A drive that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// A corner of the path is off the map.
    #[error(
        "corner {corner} of the path, {x},{y}, is not on the map, which spans x {} to {} and y {} to {}",
        to_mm(x_m[0]), to_mm(x_m[1]), to_mm(y_m[0]), to_mm(y_m[1])
    )]
    CornerOffMap {
        /// Counted from 1.
        corner: usize,
        /// Metres in the map.
        x: f64,
        /// Metres in the map.
        y: f64,
        /// Least and greatest x of the map, metres.
        x_m: [f64; 2],
        /// Least and greatest y of the map, metres.
        y_m: [f64; 2],
    },
    /// The path crosses an obstacle.
    #[error(
        "the path from corner {} to corner {} meets an obstacle at {x:.2},{y:.2}, {after_m:.2} m after corner {}",
        corner, corner + 1, corner
    )]
    Blocked {
        /// The corner before the obstacle, counted from 1.
        corner: usize,
        /// Where it is met, metres in the map.
        x: f64,
        /// Where it is met, metres in the map.
        y: f64,
        /// How far from the corner, metres.
        after_m: f64,
    },
    /// A corner that is equal to the one before.
    #[error("corners {} and {corner} of the path are the same, {x},{y}", corner - 1)]
    SameCorner {
        /// The second of the two, counted from 1.
        corner: usize,
        /// Metres in the map.
        x: f64,
        /// Metres in the map.
        y: f64,
    },
    /// The sensor, which is not where the base is, comes off the map or into an
    /// obstacle.
    #[error(
        "the sensor comes {} at {x:.2},{y:.2}, where its mount puts it {time_s:.2} s after the start",
        if *on_map { "into an obstacle" } else { "off the map" }
    )]
    SensorBlocked {
        /// Metres in the map.
        x: f64,
        /// Metres in the map.
        y: f64,
        /// Seconds since the start.
        time_s: f64,
        /// Whether it is still on the map.
        on_map: bool,
    },
    /// Two lasers of one name.
    #[error("two lasers are called {name}; allowed are lasers with names of their own")]
    SameLaser {
        /// The name.
        name: String,
    },
    /// A scan that is not over when the next begins.
    #[error(
        "a scan takes {duration_s} s and the next begins after {period_s} s; allowed are scans that end before"
    )]
    LongScan {
        /// From its first beam to its last, seconds.
        duration_s: f64,
        /// From scan to scan, seconds.
        period_s: f64,
    },
    /// More scans than a recording should hold.
    #[error("the drive takes {seconds:.0} s, which is {scans} scans; at most {most} are simulated")]
    TooLong {
        /// Seconds from start to end.
        seconds: f64,
        /// Scans in that time.
        scans: u64,
        /// Most that are allowed.
        most: u64,
    },
    /// People who find no place.
    #[error("{people} people find no free place within {within_m} m of the path")]
    NoPlaceForPeople {
        /// How many were asked for.
        people: u32,
        /// How far from the path they were put, metres.
        within_m: f64,
    },
}

/// What a map spans, without what sums of binary fractions add.
fn to_mm(metres: f64) -> f64 {
    (metres * 1000.0).round() / 1000.0
}
