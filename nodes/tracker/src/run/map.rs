//! Maps, and the expected pose of the robot on them.

use engine::peaks::Target;
use engine::tracking::PlaceTracker;
use geometry::{Covariance, Pose};
use messages::{MapHeader, MapSet, MapsHeader, NodeState, TrackState};
use transport::{TransportError, with_causes};

use super::Node;
use crate::TrackerError;
use crate::message::Tracked;
use crate::world::Worlds;

impl Node {
    pub(super) fn take_map(
        &mut self,
        header: &MapHeader,
        occupancy: &[u8],
    ) -> Result<(), TransportError> {
        self.start_on(Served::Map(header.map_id), || {
            let checked = header.check_id(occupancy).map_err(TrackerError::from);
            let worlds = checked.and_then(|()| Ok(Worlds::of_map(header, occupancy)?));
            worlds.map_err(|error| (header.map_id, error))
        })
    }

    pub(super) fn take_set(
        &mut self,
        header: &MapsHeader,
        items: &[u8],
    ) -> Result<(), TransportError> {
        self.start_on(Served::Set(header.set_id), || {
            let set = MapSet::read(header, items).map_err(|error| (0, error.into()))?;
            Worlds::of_set(&set).map_err(|(map_id, error)| (map_id, error.into()))
        })
    }

    /// Changes to other maps, unless these are tracked on already.
    fn start_on(
        &mut self,
        served: Served,
        prepare: impl FnOnce() -> Result<Worlds, (u64, TrackerError)>,
    ) -> Result<(), TransportError> {
        if self.served == Some(served) {
            return self.health.state(NodeState::Ready);
        }
        self.health.state(NodeState::Busy)?;
        match prepare() {
            Ok(worlds) => {
                self.worlds = worlds;
                self.served = Some(served);
                self.start_anew();
                self.health.state(NodeState::Ready)
            }
            Err((map_id, error)) => {
                let reason = with_causes(&error);
                self.refuse(&format!("map {map_id:016x} rejected: {reason}"))?;
                self.health.state(NodeState::Degraded)
            }
        }
    }

    /// Resets the tracker for new maps; the pose is expected, as most show the same building.
    fn start_anew(&mut self) {
        let believed = self
            .last
            .filter(|last| last.report.state == TrackState::Unique);
        self.tracker = self.nothing_known();
        self.asked = None;
        // A map that is served alone replaces the previous one; in a set, the same map or its new
        // version is looked up.
        let number = |last: &Tracked| match self.served {
            Some(Served::Map(_)) => Some(0),
            _ => {
                let same = self.worlds.number(last.map_id);
                same.or_else(|| self.worlds.number_of_name(last.map_name))
            }
        };
        let believed = believed
            .and_then(|last| Some(((number(&last)?, last.report.pose?), last.report.covariance)));
        if let Some((at, covariance)) = believed {
            self.tracker.expect(at, covariance);
            return;
        }
        let Some(remembered) = self.remembered.take() else {
            return;
        };
        let map_id = u64::from_str_radix(&remembered.map_id, 16).ok();
        if let Some(number) = map_id.and_then(|map_id| self.worlds.number(map_id))
            && self.initial.is_none()
        {
            let covariance = Covariance::from_rows(remembered.covariance);
            self.expect_base((number, remembered.map_from_base), covariance);
        }
    }

    pub(super) fn nothing_known(&self) -> PlaceTracker {
        PlaceTracker::new(self.config.tracking).with_transitions(self.worlds.transitions.to_vec())
    }

    /// Returns the number of the map on which the robot was last, or 0 before that.
    pub(super) fn current_map(&self) -> u32 {
        let last = self.last.and_then(|last| self.worlds.number(last.map_id));
        last.unwrap_or(0)
    }

    pub(super) fn shown_map(&self) -> u32 {
        let shown = self.shown.and_then(|map_id| self.worlds.number(map_id));
        shown.unwrap_or_else(|| self.current_map())
    }

    pub(super) fn expect_base(&mut self, (map, base): (u32, Pose), covariance: Covariance) {
        let target = self.target().from_base(base);
        let covariance = covariance.carried(base, target);
        self.tracker.expect((map, target), covariance);
    }

    pub(super) fn target(&self) -> Target {
        let mount = self.joiner.base_from_laser();
        Target::of(mount, self.joiner.targets_base())
    }
}

/// Map or set that is tracked on, by its id.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Served {
    Map(u64),
    Set(u64),
}
