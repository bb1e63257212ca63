//! What the node subscribes to.

use engine::heading::{HeadingSource, History};
use messages::topic;
use transport::{Graph, Health, Input, Subscriber, TransportError};

use crate::Config;

/// The node's subscribers; odometry and truth only where they are looked at.
pub(super) struct Inputs {
    pub(super) scans: Subscriber<topic::Scan>,
    pub(super) maps: Subscriber<topic::Map>,
    pub(super) boundaries: Subscriber<topic::Boundary>,
    /// Wishes where to search.
    pub(super) regions: Subscriber<topic::Region>,
    odometry: Option<Subscriber<topic::OdometryTopic>>,
    truths: Option<Subscriber<topic::GroundTruthTopic>>,
}

impl Inputs {
    pub(super) fn open(graph: &Graph, config: &Config) -> Result<Self, TransportError> {
        let source = config.heading.source();
        let by_odometry =
            matches!(source, HeadingSource::Odometry { .. }) || config.sonar.sonar_way.is_some();
        let by_truth = source == HeadingSource::Truth;
        Ok(Inputs {
            scans: graph.subscriber()?,
            maps: graph.subscriber()?,
            boundaries: graph.subscriber()?,
            regions: graph.subscriber()?,
            odometry: by_odometry.then(|| graph.subscriber()).transpose()?,
            truths: by_truth.then(|| graph.subscriber()).transpose()?,
        })
    }

    pub(super) fn all(&self) -> Vec<&dyn Input> {
        let always: [&dyn Input; 4] = [&self.scans, &self.maps, &self.boundaries, &self.regions];
        let odometry = self.odometry.iter().map(|input| input as &dyn Input);
        let truths = self.truths.iter().map(|input| input as &dyn Input);
        always.into_iter().chain(odometry).chain(truths).collect()
    }

    /// Takes down all odometry and truths that have come.
    pub(super) fn hear_poses(
        &self,
        history: &mut History,
        health: &mut Health,
    ) -> Result<(), TransportError> {
        if let Some(subscriber) = &self.odometry {
            while let Some(odometry) = subscriber.receive()? {
                history.hear_odometry(odometry.header());
                health.count_received(1);
            }
        }
        if let Some(subscriber) = &self.truths {
            while let Some(truth) = subscriber.receive()? {
                history.hear_truth(truth.header());
                health.count_received(1);
            }
        }
        Ok(())
    }
}
