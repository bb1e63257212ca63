//! Publishers for the requests of users with the token.

use dashboard::Abilities;
use messages::{Corner, Pose2, RegionHeader, SaveHeader, Stamp, topic};
use transport::{Graph, Publisher, TransportError, stamp_now};

pub(super) struct Outputs {
    regions: Publisher<topic::Region>,
    saves: Publisher<topic::Save>,
    hints: Publisher<topic::InitialPoseTopic>,
    sent: u64,
}

impl Outputs {
    pub(super) fn open(graph: &Graph) -> Result<Self, TransportError> {
        Ok(Outputs {
            regions: graph.publisher()?,
            saves: graph.publisher()?,
            hints: graph.publisher()?,
            sent: 0,
        })
    }

    /// Returns which requests have a subscriber; `restart` says if restarts are possible.
    pub(super) fn abilities(&self, restart: bool) -> Abilities {
        Abilities {
            region: self.regions.has_subscribers(),
            save: self.saves.has_subscribers(),
            hint: self.hints.has_subscribers(),
            restart,
        }
    }

    /// Publishes a search region with these corners, metres in the map; none for everywhere.
    pub(super) fn region(&mut self, corners: &[[f64; 2]]) -> Result<(), TransportError> {
        let stamp = self.stamp();
        let corners: Vec<Corner> = corners.iter().map(|&[x, y]| Corner { x, y }).collect();
        self.regions.send(RegionHeader { stamp }, &corners)
    }

    pub(super) fn save(&mut self) -> Result<(), TransportError> {
        let stamp = self.stamp();
        self.saves.send(SaveHeader { stamp }, &[])
    }

    /// Publishes a pose of the robot's base at which the tracker looks first.
    pub(super) fn hint(&mut self, map_from_base: Pose2) -> Result<(), TransportError> {
        let stamp = self.stamp();
        self.hints.send(dashboard::hint(map_from_base, stamp), &[])
    }

    /// Returns a stamp of the current time, without a time of measurement.
    fn stamp(&mut self) -> Stamp {
        let counter = self.sent;
        self.sent += 1;
        stamp_now(0, counter)
    }
}
