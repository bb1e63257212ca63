//! A laser: one ray per beam, all at the same time or one after the other.

use std::f64::consts::{PI, TAU};

use clap::builder::TypedValueParser;
use command_line::number;
use geometry::{Mount, Pose};

use crate::Bearings;
use crate::noise::Receiver;
use crate::scene::Scene;

/// Beams of the laser. The default is that of the recordings: 180 degrees, two beams per degree.
#[derive(Debug, Clone, Copy, PartialEq, clap::Args)]
pub struct LaserConfig {
    /// Angle from the first beam to the last, degrees, 1..=360, centred ahead [default: 180].
    #[arg(long, value_name = "DEGREES", value_parser = number(1.0..=360.0, "degrees").map(|degrees| degrees.to_radians().min(TAU)), conflicts_with = "sonar")]
    pub field_of_view: Option<f64>,
    /// Number of beams per scan, 2..=65536 [default: 361].
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(2..=65_536), conflicts_with = "sonar")]
    pub beams: Option<u32>,
}

impl LaserConfig {
    pub fn bearings(&self) -> Bearings {
        let beams = self.beams.map_or(361, |beams| beams as usize);
        Bearings::over(self.field_of_view.unwrap_or(PI), beams)
    }
}

/// Readings of all beams, in metres; `map_from_base` returns the pose of the robot at a beam.
pub(crate) fn scan(
    scene: &Scene,
    map_from_base: impl Fn(usize) -> Pose,
    mount: Mount,
    bearings: Bearings,
    receiver: &mut Receiver,
) -> Vec<f32> {
    let range_max_m = receiver.range_max_m;
    let turn = if mount.is_upside_down { -1.0 } else { 1.0 };
    let reading = |beam| {
        let Pose { x, y, yaw } = map_from_base(beam).then(mount.base_from_laser);
        let angle = yaw + turn * bearings.get(beam);
        receiver.reading(scene.range(x, y, angle, range_max_m))
    };
    (0..bearings.count).map(reading).collect()
}
