//! Subscribers of the node.

use messages::topic;
use transport::{Graph, Input, Subscriber, TransportError};

pub(super) struct Inputs {
    pub(super) scans: Subscriber<topic::Scan>,
    pub(super) odometry: Subscriber<topic::OdometryTopic>,
    pub(super) maps: Subscriber<topic::Map>,
    pub(super) sets: Subscriber<topic::Maps>,
    pub(super) hypotheses: Subscriber<topic::Hypotheses>,
    pub(super) initial_poses: Subscriber<topic::InitialPoseTopic>,
}

impl Inputs {
    pub(super) fn open(graph: &Graph) -> Result<Self, TransportError> {
        Ok(Inputs {
            scans: graph.subscriber()?,
            odometry: graph.subscriber()?,
            maps: graph.subscriber()?,
            sets: graph.subscriber()?,
            hypotheses: graph.subscriber()?,
            initial_poses: graph.subscriber()?,
        })
    }

    pub(super) fn all(&self) -> [&dyn Input; 6] {
        [
            &self.scans,
            &self.odometry,
            &self.maps,
            &self.sets,
            &self.hypotheses,
            &self.initial_poses,
        ]
    }
}
