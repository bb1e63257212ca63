//! Frames that are published on `/tf` again and again, as a state publisher does
//! also for those that never move.
//!
//! On `/tf` stands as well what does move, above all `odom` to `base_link`. A
//! transform that is the same in all messages is taken for a mount, any other is
//! not.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use nalgebra::Isometry3;
use ros::TransformStamped;

use crate::mount::{TransformTree, isometry, plain};

/// How far a transform that does not move may be from the first one, metres and
/// radians: a calibration that is published again, or a rounding.
const STILL_M: f64 = 1e-3;
const STILL_RAD: f64 = 0.1 * std::f64::consts::PI / 180.0;

/// What was seen of one frame.
#[derive(Debug)]
struct Seen {
    first: TransformStamped,
    isometry: Isometry3<f64>,
    /// How far it was from the first one, metres and radians.
    moved: (f64, f64),
    /// Whether another parent was named.
    changed_parent: bool,
}

impl Seen {
    fn is_still(&self) -> bool {
        !self.changed_parent && self.moved.0 <= STILL_M && self.moved.1 <= STILL_RAD
    }
}

/// Frames by their names.
#[derive(Debug, Default)]
pub(crate) struct MovingFrames {
    seen: BTreeMap<String, Seen>,
}

impl MovingFrames {
    /// Looks at a transform; an invalid one says nothing.
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

    /// Adds to a tree what does not move and the tree does not know.
    pub(crate) fn add_still(&self, tree: &mut TransformTree) {
        for (child, seen) in self.seen.iter().filter(|(_, seen)| seen.is_still()) {
            if !tree.knows(child) {
                tree.take(&seen.first);
            }
        }
    }

    /// Where a laser is connected to a base only by what moves: the frame that
    /// does, and how far, metres and radians.
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
