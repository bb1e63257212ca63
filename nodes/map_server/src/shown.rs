//! Selection of the displayed map of a set: the one on which the robot is.

use std::time::{Duration, Instant};

/// Time for which a map must lead before it is displayed while no pose is believed, since the
/// leading place may then change between maps from scan to scan.
const LEADS_FOR: Duration = Duration::from_secs(2);

#[derive(Debug)]
pub(crate) struct Shown {
    map: usize,
    /// Map named last by a pose, and the time since which it is named.
    named: (usize, Instant),
}

impl Shown {
    pub(crate) fn at(map: usize) -> Self {
        Shown {
            map,
            named: (map, Instant::now()),
        }
    }

    pub(crate) fn map(&self) -> usize {
        self.map
    }

    /// Processes the map of a pose and whether the pose is believed; returns true if that map
    /// should now be displayed instead of the current one.
    pub(crate) fn is_due(&mut self, (map, is_believed): (usize, bool), now: Instant) -> bool {
        if self.named.0 != map {
            self.named = (map, now);
        }
        let is_due = is_believed || now.duration_since(self.named.1) >= LEADS_FOR;
        map != self.map && is_due
    }

    pub(crate) fn change_to(&mut self, map: usize) {
        self.map = map;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_on_which_the_robot_is_is_shown_at_once() {
        let now = Instant::now();
        let mut shown = Shown::at(0);
        assert!(!shown.is_due((0, true), now));
        assert!(shown.is_due((2, true), now));
        assert!(shown.is_due((2, true), now), "it is not shown yet");
        shown.change_to(2);
        assert!(!shown.is_due((2, true), now));
        assert_eq!(shown.map(), 2);
    }

    #[test]
    fn while_no_pose_is_believed_one_has_to_lead_for_a_while() {
        let start = Instant::now();
        let at = |seconds| start + Duration::from_secs(seconds);
        let mut shown = Shown::at(0);
        assert!(!shown.is_due((1, false), at(1)));
        assert!(!shown.is_due((0, false), at(2)));
        assert!(!shown.is_due((1, false), at(3)));
        assert!(!shown.is_due((1, false), at(4)));
        assert!(shown.is_due((1, false), at(5)));
    }
}
