//! Reads and writes recordings: MCAP files with ROS 2 messages in CDR, or a folder of them as
//! rosbag2 writes it; with the feature `rosbag2` also the older SQLite bags of ROS 2.
//!
//! [`Recording::open`] checks all files from start to end, [`Recording::records`] returns the
//! messages in the order of their log times, and [`mod@write`] writes recordings. Damage is never
//! repaired or skipped: the messages before it are returned, then an error that says where it is.
//! The crate decodes the five message types of [`Kind`] with the crate `ros` and returns all others
//! as bytes. It knows nothing about graphs.

#[cfg(feature = "rosbag2")]
mod bag;
mod block;
mod chunk;
mod cloud;
mod content;
mod contents;
mod copy;
mod damage;
mod error;
mod extras;
mod feed;
mod file;
mod folder;
mod kind;
mod message;
mod mount;
mod moving;
mod parse;
mod recording;
mod registry;
#[cfg(test)]
mod sample;
#[cfg(test)]
mod soundness;
mod survey;
mod take_cloud;
mod topics;
mod truth;
mod unpack;
pub mod write;

pub use content::is_stream;
pub use contents::Mounted;
pub use copy::{is_bag, is_recording, write_bag};
pub use damage::{Damage, MAX_CHUNK_BYTES};
pub use error::RecordingError;
pub use extras::{AttachedFile, MetadataRecord};
pub use kind::{GROUND_TRUTH, Kind, MAP, ODOM, SCAN, TF_STATIC};
pub use message::{Message, Record};
pub use mount::{MAX_TILT_DEGREES, Mount, TransformTree};
pub use recording::{RawRecord, RawRecords, Recording, Records};
pub use registry::Channel;
pub use truth::GroundTruth;
