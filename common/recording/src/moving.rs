//! Finds frames that `/tf` repeats without change: a state publisher also publishes fixed frames
//! there.
//!
//! `/tf` also holds transforms that move, above all `odom` to `base_link`. A transform that is the
//! same in all messages counts as a mount, any other does not.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use nalgebra::Isometry3;
use ros::TransformStamped;

use crate::mount::{TransformTree, isometry, plain};

/// Largest difference of a still transform from the first one, in metres and radians: allows for a
/// repeated calibration or rounding.
const STILL_M: f64 = 1e-3;
const STILL_RAD: f64 = 0.1 * std::f64::consts::PI / 180.0;

#[derive(Debug)]
struct Seen {
    first: TransformStamped,
    isometry: Isometry3<f64>,
    /// Largest difference from the first transform, in metres and radians.
    moved: (f64, f64),
    changed_parent: bool,
}

impl Seen {
    fn is_still(&self) -> bool {
        !self.changed_parent && self.moved.0 <= STILL_M && self.moved.1 <= STILL_RAD
    }
}

#[derive(Debug, Default)]
pub(crate) struct MovingFrames {
    seen: BTreeMap<String, Seen>,
}

impl MovingFrames {
    pub(crate) fn see(&mut self, stamped: &TransformStamped) {
        let Ok((isometry, _)) = isometry(&stamped.transform) else {
            return;
        };
        match self.seen.entry(plain(&stamped.child_frame_id).to_owned()) {
            Entry::Vacant(free) => {
                free.insert(Seen {
                    first: stamped.clone(),
                    isometry,
                    moved: (0.0, 0.0),
                    changed_parent: false,
                });
            }
            Entry::Occupied(mut known) => {
                let known = known.get_mut();
                let step = known.isometry.inv_mul(&isometry);
                known.moved.0 = known.moved.0.max(step.translation.vector.norm());
                known.moved.1 = known.moved.1.max(step.rotation.angle());
                let parents = [&known.first, stamped].map(|t| plain(&t.header.frame_id));
                known.changed_parent |= parents[0] != parents[1];
            }
        }
    }

    pub(crate) fn add_still(&self, tree: &mut TransformTree) {
        for (child, seen) in self.seen.iter().filter(|(_, seen)| seen.is_still()) {
            if !tree.knows(child) {
                tree.take(&seen.first);
            }
        }
    }

    /// Returns the moving frame that alone connects a laser to a base, and how far it moves, in
    /// metres and radians.
    pub(crate) fn moving_below(
        &self,
        tree: &TransformTree,
        laser: &str,
    ) -> Option<(&str, f64, f64)> {
        let mut tree = tree.sound();
        for (child, seen) in self.seen.iter().filter(|(_, seen)| !seen.is_still()) {
            if !tree.knows(child) {
                tree.take(&seen.first);
            }
            if tree.base_from(laser).is_some() {
                return Some((child, seen.moved.0, seen.moved.1));
            }
        }
        None
    }
}
