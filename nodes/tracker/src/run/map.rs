//! The map, and where the robot is expected on it.

use engine::peaks::Target;
use engine::tracking::Follower;
use geometry::{Covariance, Pose};
use messages::{MapHeader, NodeState, TrackState};
use transport::{TransportError, with_causes};

use super::{Node, REMEMBERED_LEAD};
use crate::TrackerError;
use crate::memory::Remembered;
use crate::world::World;

impl Node {
    pub(super) fn take_map(
        &mut self,
        header: &MapHeader,
        occupancy: &[u8],
    ) -> Result<(), TransportError> {
        let known = self.world.as_ref();
        if known.is_some_and(|known| known.map_id == header.map_id) {
            return self.health.state(NodeState::Ready);
        }
        self.health.state(NodeState::Busy)?;
        let checked = header.check_id(occupancy).map_err(TrackerError::from);
        match checked.and_then(|()| Ok(World::new(header, occupancy)?)) {
            Ok(world) => {
                self.start_on(&world);
                self.world = Some(world);
                self.health.state(NodeState::Ready)
            }
            Err(error) => {
                self.refuse(&format!(
                    "map {:016x} rejected: {}",
                    header.map_id,
                    with_causes(&error)
                ))?;
                self.health.state(NodeState::Degraded)
            }
        }
    }

    /// Forgets what was known on another map, but for where the robot was: most new maps
    /// are of the same building.
    fn start_on(&mut self, world: &World) {
        let on_map = |last: &Remembered| last.map_id == format!("{:016x}", world.map_id);
        let believed = self
            .last
            .filter(|last| last.report.state == TrackState::Unique);
        self.tracker = Follower::new(&self.config.follow);
        self.asked = None;
        if let Some(last) = believed
            && let Some(pose) = last.report.pose
        {
            let covariance = Covariance(last.report.covariance);
            self.tracker.expect(pose, covariance, REMEMBERED_LEAD);
        } else if let Some(last) = self.remembered.take().filter(on_map)
            && self.initial.is_none()
        {
            let covariance = Covariance::from_rows(last.covariance);
            self.expect_base((last.map_from_base, covariance), REMEMBERED_LEAD);
        }
    }

    pub(super) fn expect_base(&mut self, (base, covariance): (Pose, Covariance), lead: f64) {
        let target = self.target().from_base(base);
        self.tracker
            .expect(target, covariance.carried(base, target), lead);
    }

    pub(super) fn target(&self) -> Target {
        let mount = self.joiner.base_from_laser();
        Target::of(mount, self.joiner.targets_base())
    }
}
