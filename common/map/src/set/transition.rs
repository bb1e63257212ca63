//! Transitions of a robot between maps of a set.

use std::collections::BTreeMap;

use geometry::Pose;
use serde::Deserialize;

use super::{MapFile, all_names};
use crate::keys::Scalar;

const MAX_TRANSITION_M: f64 = 100.0;

/// A rectangle that is on two maps, such as a lift, stairs, or a door between two buildings. A
/// robot in it has the same pose relative to the rectangle on both maps.
#[derive(Debug, Clone, PartialEq)]
pub struct Transition {
    pub name: String,
    /// Indices of the two maps in their set, from 0.
    pub maps: [usize; 2],
    /// Centre and x axis of the rectangle on each map.
    pub map_from_region: [Pose; 2],
    /// Sides of the rectangle along its x and y, in metres.
    pub size_m: [f64; 2],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TransitionEntry {
    name: Scalar,
    size: [Scalar; 2],
    at: BTreeMap<String, [Scalar; 3]>,
}

impl TransitionEntry {
    pub(super) fn name(&self) -> &str {
        self.name.text()
    }

    /// Returns a transition for each pair of its maps.
    pub(super) fn transitions(&self, maps: &[MapFile]) -> Result<Vec<Transition>, String> {
        let number = |scalar: &Scalar| scalar.number().filter(|number| number.is_finite());
        let side = |scalar: &Scalar| number(scalar).filter(|m| *m > 0.0 && *m <= MAX_TRANSITION_M);
        let [Some(along_x), Some(along_y)] = self.size.each_ref().map(side) else {
            return Err(format!(
                "its size is {:?} x {:?}: allowed are two sides above 0 and up to \
                 {MAX_TRANSITION_M} m",
                self.size[0].text(),
                self.size[1].text()
            ));
        };
        let mut sides = Vec::new();
        for (name, pose) in &self.at {
            let Some(map) = maps.iter().position(|map| map.name == *name) else {
                let all = all_names(maps);
                return Err(format!("there is no map {name:?}: allowed are {all}"));
            };
            let [Some(x), Some(y), Some(degrees)] = pose.each_ref().map(number) else {
                return Err(format!(
                    "its place on {name:?} is not x and y in metres and an angle in degrees"
                ));
            };
            sides.push((map, Pose::new(x, y, degrees.to_radians())));
        }
        if sides.len() < 2 {
            return Err("it is on one map: needed are two at least".to_owned());
        }
        let pairs = sides.iter().enumerate();
        let pairs = pairs.flat_map(|(i, a)| sides[i + 1..].iter().map(move |b| (a, b)));
        let transition = |(a, b): (&(usize, Pose), &(usize, Pose))| Transition {
            name: self.name.text().to_owned(),
            maps: [a.0, b.0],
            map_from_region: [a.1, b.1],
            size_m: [along_x, along_y],
        };
        Ok(pairs.map(transition).collect())
    }
}
