//! `backcast_msgs/msg/Localization`.

use serde::{Deserialize, Serialize};

use crate::definition::definition;
use crate::{Header, PoseWithCovariance, RosMessage, Time};

/// Where the robot is, and how sure that is, for programs of a robot: what of the tracker's
/// verdict on a scan they decide by.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Localization {
    /// When the scan was measured, and the frame of the map.
    pub header: Header,
    /// What the tracker knows: a `messages::TrackState`.
    pub state: u8,
    /// How likely the robot is at `pose`, 0..=1.
    pub probability: f64,
    /// When the state began.
    pub since: Time,
    /// Other places that are possible.
    pub alternatives: u32,
    /// The map, 16 hexadecimal digits; empty where there is none.
    pub map_id: String,
    /// Whether there is a pose.
    pub pose_known: bool,
    /// Of the robot's base in the map: of the place that is believed, else of the one that
    /// leads.
    pub pose: PoseWithCovariance,
    /// Why it is in that state, and what to do, in words.
    pub reason: String,
}

impl RosMessage for Localization {
    const SCHEMA: &'static str = "backcast_msgs/msg/Localization";
    const DEFINITION: &'static str = definition!(
        "\
# Where the robot is, and how sure that is: the tracker's verdict on a scan.
uint8 SEARCHING=0
uint8 UNIQUE=1
uint8 DOUBTFUL=2
uint8 LOST=3
# When the scan was measured, and the frame of the map.
std_msgs/Header header
# What is known: one of the constants above.
uint8 state
# How likely the robot is at the pose, 0 to 1.
float64 probability
# When the state began.
builtin_interfaces/Time since
# Other places that are possible.
uint32 alternatives
# The map, 16 hexadecimal digits; empty where there is none.
string map_id
# Whether there is a pose.
bool pose_known
# Of the robot's base in the map, metres: where the robot is believed to be while UNIQUE or
# DOUBTFUL, else the place that leads.
geometry_msgs/PoseWithCovariance pose
# Why, and what to do, in words.
string reason
",
        Header,
        PoseWithCovariance,
    );
}
