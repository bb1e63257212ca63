//! Subscribers of the node.

use engine::heading::{HeadingSource, History};
use engine::joined::Joiner;
use messages::topic;
use transport::{Graph, Health, Input, Subscriber, TransportError};

use crate::Config;
use crate::config::Searched;

/// Subscribers of the node; the ground truth only if headings come from it.
pub(super) struct Inputs {
    pub(super) scans: Subscriber<topic::Scan>,
    pub(super) maps: Subscriber<topic::Map>,
    pub(super) sets: Subscriber<topic::Maps>,
    pub(super) boundaries: Subscriber<topic::Boundary>,
    pub(super) regions: Subscriber<topic::Region>,
    pub(super) attention: Option<Subscriber<topic::Attention>>,
    odometry: Subscriber<topic::OdometryTopic>,
    truths: Option<Subscriber<topic::GroundTruthTopic>>,
}

impl Inputs {
    pub(super) fn open(graph: &Graph, config: &Config) -> Result<Self, TransportError> {
        let source = config.heading.source();
        let by_truth = source == HeadingSource::Truth;
        Ok(Inputs {
            scans: graph.subscriber()?,
            maps: graph.subscriber()?,
            sets: graph.subscriber()?,
            boundaries: graph.subscriber()?,
            regions: graph.subscriber()?,
            attention: (config.search == Searched::Asked)
                .then(|| graph.subscriber())
                .transpose()?,
            odometry: graph.subscriber()?,
            truths: by_truth.then(|| graph.subscriber()).transpose()?,
        })
    }

    pub(super) fn all(&self) -> Vec<&dyn Input> {
        let always: [&dyn Input; 6] = [
            &self.scans,
            &self.maps,
            &self.sets,
            &self.boundaries,
            &self.regions,
            &self.odometry,
        ];
        let truths = self.truths.iter().map(|input| input as &dyn Input);
        let attention = self.attention.iter().map(|input| input as &dyn Input);
        always.into_iter().chain(truths).chain(attention).collect()
    }

    pub(super) fn take_poses(
        &self,
        joiner: &mut Joiner,
        history: &mut History,
        health: &mut Health,
    ) -> Result<(), TransportError> {
        while let Some(odometry) = self.odometry.receive()? {
            joiner.on_odometry(odometry.header());
            history.on_odometry(odometry.header());
            health.count_received(1);
        }
        if let Some(subscriber) = &self.truths {
            while let Some(truth) = subscriber.receive()? {
                history.on_truth(truth.header());
                health.count_received(1);
            }
        }
        Ok(())
    }
}
