//! Messages of a Backcast graph: one header and one slice of items for each topic.
//!
//! Every type is `repr(C)`, plain data without padding, `usize` or pointers, so that a process can
//! read it where another one wrote it. The version is part of the type name that the transport
//! compares; a released layout never changes, a new one is added with the next version. Headers and
//! items also implement serde field by field, for data that leaves the machine. The crate has no
//! behaviour beyond conversions, and does no I/O.

#![warn(missing_docs)]

/// Declares plain data of messages, with the versioned names that the transport compares.
macro_rules! message {
    ($(
        #[type_name($type_name:literal)]
        $(#[$attribute:meta])*
        pub struct $name:ident { $($fields:tt)* }
    )+) => {
        #[cfg(feature = "iceoryx2")]
        use crate::zero_copy::ZeroCopySend;

        $(
            $(#[$attribute])*
            #[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
            #[derive(serde::Serialize, serde::Deserialize)]
            #[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name($type_name))]
            #[repr(C)]
            pub struct $name { $($fields)* }
        )+
    };
}
pub(crate) use message;

/// Declares an enum that messages hold as its code, and optionally the names of its values.
macro_rules! codes {
    (
        $(#[$attribute:meta])*
        pub enum $name:ident: $code:ident {
            $($(#[$comment:meta])* $value:ident = $number:literal $(=> $text:literal)?,)+
        }
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[repr($code)]
        pub enum $name {
            $($(#[$comment])* $value = $number,)+
        }

        impl $name {
            /// Returns the value with this code, if there is one.
            #[must_use]
            pub fn from_code(code: $code) -> Option<Self> {
                match code {
                    $($number => Some(Self::$value),)+
                    _ => None,
                }
            }
        }

        crate::codes!(@names $name, $($value $($text)?),+);
    };
    (@names $name:ident, $($value:ident $text:literal),+) => {
        impl $name {
            /// Returns the name for logs and tables.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self {
                    $(Self::$value => $text,)+
                }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.as_str())
            }
        }
    };
    (@names $($without:tt)+) => {};
}
pub(crate) use codes;

mod attention;
mod beams;
mod boundary;
mod field;
mod ground_truth;
mod health;
mod hypotheses;
mod initial_pose;
#[cfg(test)]
mod layouts;
pub mod limits;
mod log;
mod map;
mod maps;
mod name;
mod odometry;
mod particles;
mod pose;
mod readings;
mod region;
mod rules;
mod save;
mod scan;
mod stamp;
pub mod topic;
mod tracked_pose;
mod votes;
#[cfg(feature = "iceoryx2")]
mod zero_copy;

pub use attention::AttentionHeader;
pub use beams::{Beam, BeamFate, BeamsHeader};
pub use boundary::{BoundaryCell, BoundaryHeader};
pub use field::{FieldHeader, FieldKind};
pub use ground_truth::GroundTruth;
pub use health::{HealthHeader, NodeState};
pub use hypotheses::{HypothesesHeader, Hypothesis, Verdict};
pub use initial_pose::{InitialPose, InitialPoseKind};
pub use log::{LogHeader, LogLevel};
pub use map::{FREE_TO, MapHeader, OCCUPIED_FROM, UNKNOWN, WrongMapId, map_id};
pub use maps::{InvalidMapSet, MapSet, MapsHeader, Transition, searched_id};
pub use name::{FrameName, MapName, Name};
pub use odometry::Odometry;
pub use particles::{Particle, ParticlesHeader};
pub use pose::Pose2;
pub use readings::{Reading, ReadingsHeader};
pub use region::{Corner, RegionHeader};
pub use rules::{CellRules, InvalidRule};
pub use save::SaveHeader;
pub use scan::ScanHeader;
pub use stamp::Stamp;
pub use topic::{Message, Topic};
pub use tracked_pose::{PoseHeader, TrackReason, TrackState};
pub use votes::{SearchOutcome, Vote, VotesByMapHeader, VotesHeader};
