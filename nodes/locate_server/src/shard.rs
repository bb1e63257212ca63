//! A part of a set of maps, so that several servers hold it together.
//!
//! Shard 2 of 4 holds every fourth map of the set, from the second on, and is asked at
//! `backcast/locate/<name>.2-of-4`. Its servers are replicas of each other as those of one map
//! are. What it answers is a [`Part`], which the caller merges with the others'.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use engine::map_set::Located;
use engine::peaks::{Found, Margin, Place};
use engine::votes::VoteShare;
use geometry::{Covariance, Pose};
use map::MapFile;
use serde::{Deserialize, Serialize};

use crate::LocateError;

/// Most shards of a set: each has a map.
const MAX_SHARDS: u16 = 1000;

/// Most places of a part: candidates of all its maps that are near the best.
const MAX_PLACES: usize = 100_000;

/// Which part of a set it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// From 1 on.
    pub number: u16,
    /// Of so many.
    pub of: u16,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let shard = numbers.and_then(|(number, of)| Shard::new(number, of));
        shard.ok_or_else(|| format!("allowed is NUMBER/OF, as 2/4, up to {MAX_SHARDS}"))
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl Shard {
    /// All maps of a set.
    pub const WHOLE: Shard = Shard { number: 1, of: 1 };

    fn new(number: &str, of: &str) -> Option<Self> {
        let (number, of) = (number.parse().ok()?, of.parse().ok()?);
        (1..=of)
            .contains(&number)
            .then_some(Shard { number, of })
            .filter(|shard| shard.of <= MAX_SHARDS)
    }

    /// The name under which it is asked, in a set of that name.
    #[must_use]
    pub fn name(self, set: &str) -> String {
        format!("{set}.{}-of-{}", self.number, self.of)
    }

    /// The shard that has this name, in a set of that name.
    pub(crate) fn of_name(name: &str, set: &str) -> Option<Self> {
        let numbers = name.strip_prefix(set)?.strip_prefix('.')?;
        let (number, of) = numbers.split_once("-of-")?;
        Shard::new(number, of)
    }

    /// Whether it holds the map with this number of the set, from 0.
    #[must_use]
    pub fn holds(self, map: usize) -> bool {
        map % usize::from(self.of) + 1 == usize::from(self.number)
    }

    /// Its maps, with their numbers.
    ///
    /// # Errors
    /// There is none.
    pub(crate) fn take(self, files: &[MapFile]) -> Result<Vec<(u32, MapFile)>, LocateError> {
        let numbered = (0..).zip(files.iter().cloned());
        let held = numbered.filter(|(number, _)| self.holds(*number as usize));
        let held: Vec<_> = held.collect();
        match held.is_empty() {
            true => Err(LocateError::EmptyShard {
                shard: self.to_string(),
                maps: files.len(),
            }),
            false => Ok(held),
        }
    }

    /// The descriptions of the maps that other shards hold.
    pub(crate) fn others(self, files: &[MapFile]) -> impl Iterator<Item = &Path> {
        let others = files.iter().enumerate();
        let others = others.filter(move |(number, _)| !self.holds(*number));
        others.map(|(_, file)| file.yaml.as_path())
    }
}

/// What a shard found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Which one it is.
    pub shard: Shard,
    /// The names of all maps of the set, in order.
    pub maps: Vec<String>,
    /// The ids of those that it holds.
    pub ids: Vec<u64>,
    /// How long it took, nanoseconds.
    pub search_ns: u64,
    places: Vec<SentPlace>,
    needed: f64,
    left_out: f64,
    may_lack: bool,
    inlier_share: f64,
    leading_map: u32,
    lead: (u16, u16),
    unseen: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct SentPlace {
    map: u32,
    /// x and y in metres, yaw in radians, of the laser.
    pose: [f64; 3],
    covariance: [f64; 9],
    score: f64,
    intensity: u16,
    possible: u16,
    drawn_doubt: f64,
    support: u64,
}

impl Part {
    /// What is sent of what a shard found; its maps have these numbers in the set.
    pub(crate) fn new(
        (shard, maps): (Shard, Vec<String>),
        held: &[(u32, u64)],
        found: &Located<'_>,
    ) -> Self {
        let found = found.found;
        let number = |map: u32| held[map as usize].0;
        let place = |place: &Place| SentPlace {
            map: number(place.map),
            pose: [
                place.map_from_laser.x,
                place.map_from_laser.y,
                place.map_from_laser.yaw,
            ],
            covariance: place.covariance.to_rows(),
            score: place.score,
            intensity: place.intensity,
            possible: place.possible,
            drawn_doubt: place.drawn_doubt,
            support: place.support,
        };
        Part {
            shard,
            maps,
            ids: held.iter().map(|&(_, id)| id).collect(),
            search_ns: 0,
            places: found.places.iter().map(place).collect(),
            needed: found.margin.needed,
            left_out: found.margin.left_out,
            may_lack: found.margin.may_lack,
            inlier_share: found.inlier_share,
            leading_map: number(found.leading_map),
            lead: (found.lead.votes, found.lead.possible),
            unseen: found.unseen,
        }
    }

    /// What a shard sent, as it is merged.
    ///
    /// # Errors
    /// It is not sound: numbers that are none, or a map that the set does not have.
    pub(crate) fn found(&self) -> Result<Found, LocateError> {
        let unsound = |reason: &str| LocateError::Part {
            reason: reason.to_owned(),
        };
        let Part { maps, places, .. } = self;
        let is_map = |map: u32| (map as usize) < maps.len() && self.shard.holds(map as usize);
        let numbers = [self.needed, self.left_out, self.inlier_share, self.unseen];
        if places.len() > MAX_PLACES || self.lead.1 == 0 || !is_map(self.leading_map) {
            return Err(unsound("its maps or its places are not those of the shard"));
        }
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(unsound("it has numbers that are none"));
        }
        let place = |sent: &SentPlace| {
            let [x, y, yaw] = sent.pose;
            let numbers = sent.pose.iter().chain(&sent.covariance);
            let is_sound = numbers
                .chain([&sent.score, &sent.drawn_doubt])
                .all(|number| number.is_finite())
                && sent.possible > 0
                && is_map(sent.map);
            is_sound
                .then(|| Place {
                    map: sent.map,
                    map_from_laser: Pose::new(x, y, yaw),
                    covariance: Covariance::from_rows(sent.covariance),
                    score: sent.score,
                    probability: 0.0,
                    intensity: sent.intensity,
                    possible: sent.possible,
                    drawn_doubt: sent.drawn_doubt,
                    support: sent.support,
                })
                .ok_or_else(|| unsound("a place has no pose on a map of the shard"))
        };
        Ok(Found {
            places: places.iter().map(place).collect::<Result<_, _>>()?,
            margin: Margin {
                needed: self.needed,
                left_out: self.left_out,
                may_lack: self.may_lack,
            },
            inlier_share: self.inlier_share,
            leading_map: self.leading_map,
            lead: VoteShare::new(self.lead.0, self.lead.1),
            unseen: self.unseen,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_have_every_so_many_th_map_and_a_name() {
        let shard: Shard = "2/3".parse().unwrap();
        let held: Vec<usize> = (0..8).filter(|&map| shard.holds(map)).collect();
        assert_eq!(held, [1, 4, 7]);
        assert_eq!(shard.name("tower"), "tower.2-of-3");
        assert_eq!(Shard::of_name("tower.2-of-3", "tower"), Some(shard));
        for name in [
            "tower",
            "tower.4-of-3",
            "tower.0-of-3",
            "towers.1-of-2",
            "tower.1-of-x",
        ] {
            assert_eq!(Shard::of_name(name, "tower"), None, "{name}");
        }
        for text in ["", "2", "0/3", "4/3", "1/1001", "-1/2", "a/b"] {
            let error = text.parse::<Shard>().unwrap_err();
            assert!(error.contains("NUMBER/OF"), "{error}");
        }
    }

    #[test]
    fn what_no_shard_sends_is_refused() {
        let place = SentPlace {
            map: 2,
            pose: [1.0, 2.0, 0.5],
            covariance: [0.0; 9],
            score: 0.9,
            intensity: 5,
            possible: 9,
            drawn_doubt: 0.0,
            support: 1,
        };
        let part = Part {
            shard: Shard { number: 1, of: 2 },
            maps: vec!["a".into(), "b".into(), "c".into()],
            ids: vec![7, 8],
            search_ns: 1,
            places: vec![place],
            needed: 0.1,
            left_out: 0.0,
            may_lack: false,
            inlier_share: 0.9,
            leading_map: 2,
            lead: (5, 9),
            unseen: 0.3,
        };
        assert_eq!(part.found().unwrap().places[0].map, 2);
        let refuse = |change: &dyn Fn(&mut Part)| {
            let mut wrong = part.clone();
            change(&mut wrong);
            assert!(wrong.found().is_err(), "{wrong:?}");
        };
        refuse(&|part| part.places[0].map = 1);
        refuse(&|part| part.places[0].map = 3);
        refuse(&|part| part.places[0].pose[1] = f64::NAN);
        refuse(&|part| part.places[0].possible = 0);
        refuse(&|part| part.leading_map = 1);
        refuse(&|part| part.lead.1 = 0);
        refuse(&|part| part.needed = f64::INFINITY);
    }
}
