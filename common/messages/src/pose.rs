//! A pose in a message.

use geometry::Pose;

crate::message! {
    #[type_name("Pose2/v1")]
    /// A pose in metres and radians; the name of its field gives the frames.
    pub struct Pose2 {
        /// Position along x in metres.
        pub x: f64,
        /// Position along y in metres.
        pub y: f64,
        /// Heading in radians, counter-clockwise.
        pub yaw: f64,
    }
}

impl Pose2 {
    /// Makes a pose from metres and radians.
    #[must_use]
    pub const fn new(x: f64, y: f64, yaw: f64) -> Self {
        Pose2 { x, y, yaw }
    }
}

impl From<Pose> for Pose2 {
    fn from(Pose { x, y, yaw }: Pose) -> Self {
        Pose2 { x, y, yaw }
    }
}

impl From<Pose2> for Pose {
    fn from(Pose2 { x, y, yaw }: Pose2) -> Self {
        Pose::new(x, y, yaw)
    }
}
