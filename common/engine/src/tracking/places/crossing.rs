//! Places on the other side of a transition.

use messages::Transition;

use super::{Best, Place, Places, SAME_M, SAME_RADIANS};
use crate::tracking::seen::Seen;
use crate::tracking::transition::other_side;
use crate::tracking::verdict::Belief;

impl Places {
    /// Where the place that is believed, or else leads, lies in a transition, the robot may be
    /// on its other side just as well: what scans said before says nothing of that, and what
    /// this one says counts alone.
    pub(super) fn add_across(
        &mut self,
        (seen, transitions): (&[Seen<'_>], &[Transition]),
        best: Best,
        belief: &Belief,
    ) {
        let leading = self
            .kept
            .iter()
            .reduce(|a, b| match b.log_weight > a.log_weight {
                true => b,
                false => a,
            });
        let believed = belief.place().and_then(|id| self.get(id));
        let Some(here) = believed.or(leading).copied() else {
            return;
        };
        let sides = transitions.iter().filter_map(|transition| {
            other_side(transition, (here.map, here.pose), here.covariance)
        });
        for (map, predicted) in sides {
            let fitted = seen[map as usize].settle(predicted);
            let log_weight = here.log_weight - self.against(best, fitted.score);
            let at = (map, fitted.pose);
            let mut kept = self.kept.iter_mut();
            match kept.find(|place| place.is_within(at, SAME_M, SAME_RADIANS)) {
                Some(place) => {
                    place.crossed = true;
                    place.log_weight = place.log_weight.max(log_weight);
                }
                None => {
                    let id = self.new_id();
                    self.kept.push(Place {
                        crossed: true,
                        ..Place::born(id, (map, &fitted), log_weight)
                    });
                }
            }
        }
    }
}
