//! Topics with a permanent subscription.

use dashboard::Robot;
use messages::topic;
use transport::{Graph, Health, Input, Subscriber, TransportError, monotonic_ns};

/// All topics but the field, which is subscribed to only while it is viewed.
pub(super) struct Inputs {
    maps: Subscriber<topic::Map>,
    hypotheses: Subscriber<topic::Hypotheses>,
    poses: Subscriber<topic::Tracked>,
    beams: Subscriber<topic::Beams>,
    scans: Subscriber<topic::Scan>,
    health: Subscriber<topic::Health>,
    log: Subscriber<topic::Log>,
}

impl Inputs {
    pub(super) fn open(graph: &Graph) -> Result<Self, TransportError> {
        Ok(Inputs {
            maps: graph.subscriber()?,
            hypotheses: graph.subscriber()?,
            poses: graph.subscriber()?,
            beams: graph.subscriber()?,
            scans: graph.subscriber()?,
            health: graph.subscriber()?,
            log: graph.subscriber()?,
        })
    }

    pub(super) fn all(&self) -> [&dyn Input; 6] {
        // A scan alone is no reason to wake up: its pose follows.
        let (maps, answers, poses) = (&self.maps, &self.hypotheses, &self.poses);
        [maps, answers, poses, &self.beams, &self.health, &self.log]
    }

    /// Processes everything that has arrived, the map before the results that refer to it.
    pub(super) fn take(&self, to: &Robot, health: &mut Health) -> Result<(), TransportError> {
        if let Some(map) = self.maps.newest()? {
            health.count_received(1);
            if !to.on_map(map.header(), map.items()) {
                refuse(health, "the map contradicts its header")?;
            }
        }
        // Before its pose, so that the page draws both together.
        while let Some(scan) = self.scans.receive()? {
            health.count_received(1);
            to.on_scan(scan.header(), scan.items(), monotonic_ns());
        }
        while let Some(answer) = self.hypotheses.receive()? {
            // Gaps are not counted as dropped: such scans may never have been answered.
            health.count_received(1);
            to.on_answer(answer.header(), answer.items(), monotonic_ns());
        }
        while let Some(pose) = self.poses.receive()? {
            health.count_received(1);
            to.on_pose(pose.header(), pose.items(), monotonic_ns());
        }
        if let Some(beams) = self.beams.newest()? {
            health.count_received(1);
            to.on_beams(beams.header(), beams.items());
        }
        while let Some(report) = self.health.receive()? {
            health.count_received(1);
            if !to.on_health(report.header(), report.items()) {
                refuse(health, "there are more nodes than are shown")?;
            }
        }
        while let Some(line) = self.log.receive()? {
            health.count_received(1);
            to.on_log(line.header(), line.items());
        }
        Ok(())
    }
}

/// Counts and reports a message that cannot be shown.
pub(super) fn refuse(health: &mut Health, problem: &str) -> Result<(), TransportError> {
    health.count_refused(1);
    health.error(problem)
}
