//! A decoded message.

use std::sync::Arc;

use ros::{LaserScan, OccupancyGridMsg, Odometry, PoseStamped, TfMessage, cdr};

use crate::Kind;

#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    pub topic: Arc<str>,
    /// Time of recording, in nanoseconds since 1970.
    pub log_time_ns: i64,
    pub message: Message,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Message {
    Scan(LaserScan),
    Map(OccupancyGridMsg),
    Odometry(Box<Odometry>),
    /// A pose: the ground truth, a goal, or anything else the topic may mean.
    PoseStamped(PoseStamped),
    StaticTransforms(TfMessage),
}

impl Message {
    pub fn kind(&self) -> Kind {
        match self {
            Message::Scan(_) => Kind::Scan,
            Message::Map(_) => Kind::Map,
            Message::Odometry(_) => Kind::Odometry,
            Message::PoseStamped(_) => Kind::PoseStamped,
            Message::StaticTransforms(_) => Kind::StaticTransforms,
        }
    }

    pub(crate) fn decode(kind: Kind, bytes: &[u8]) -> Result<Self, String> {
        Ok(match kind {
            Kind::Scan => Message::Scan(cdr::decode(bytes)?),
            Kind::Map => Message::Map(cdr::decode(bytes)?),
            Kind::Odometry => Message::Odometry(Box::new(cdr::decode(bytes)?)),
            Kind::PoseStamped => Message::PoseStamped(cdr::decode(bytes)?),
            Kind::StaticTransforms => Message::StaticTransforms(cdr::decode(bytes)?),
        })
    }

    pub(crate) fn encode(&self) -> Result<Vec<u8>, cdr_encoding::Error> {
        match self {
            Message::Scan(message) => cdr::encode(message),
            Message::Map(message) => cdr::encode(message),
            Message::Odometry(message) => cdr::encode(message),
            Message::PoseStamped(message) => cdr::encode(message),
            Message::StaticTransforms(message) => cdr::encode(message),
        }
    }
}
