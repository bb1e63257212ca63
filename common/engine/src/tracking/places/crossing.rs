//! Places on the other side of a transition.

use messages::Transition;

use super::{Best, Place, Places, SAME_M, SAME_RADIANS};
use crate::tracking::transition::other_side;

impl Places {
    /// Adds the other side of a transition as a place, if the believed or else the leading place is
    /// in one: the robot may be on either side. Earlier scans say nothing about this, so only the
    /// current scan counts, and the place stays however badly earlier scans fitted there.
    pub(super) fn add_across(&mut self, transitions: &[Transition], best: Best<'_>) {
        let Some(here) = self.believed().or(self.leading()).copied() else {
            return;
        };
        let sides = transitions.iter().filter_map(|transition| {
            other_side(transition, (here.map, here.pose), here.covariance)
        });
        let cap = self.config.scan_cap;
        for (map, predicted) in sides {
            let fitted = best.seen[map as usize].settle(predicted);
            let log_weight = here.log_weight - best.against((map, fitted.score), cap);
            let at = (map, fitted.pose);
            let mut kept = self.kept.iter_mut();
            let place = match kept.find(|place| place.is_within(at, SAME_M, SAME_RADIANS)) {
                Some(place) => place,
                None => self.add((map, &fitted), log_weight),
            };
            place.crossed_from = Some(here.map);
            place.log_weight = place.log_weight.max(log_weight);
        }
    }

    /// Ends the crossing once the best place leads over all places on other maps: then no place is
    /// the other side of another any more. The places must be sorted.
    pub(super) fn decide_crossing(&mut self) {
        let Some(best) = self.kept.first().copied() else {
            return;
        };
        let near = best.log_weight + (1.0 - self.config.sure).ln();
        let is_open = |place: &Place| place.map != best.map && place.log_weight > near;
        if !self.kept.iter().any(is_open) {
            for place in &mut self.kept {
                place.crossed_from = None;
            }
        }
    }
}
