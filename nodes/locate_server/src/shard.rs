//! A part of a set of maps, so that several servers hold it together.
//!
//! Shard 2 of 4 holds every fourth map of the set, from the second on, and is asked at
//! `backcast/locate/<name>.2-of-4`. Its servers are replicas of each other as those of one map
//! are. What it answers is a [`Part`], which the caller merges with the others'.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use engine::map_set::Located;
use engine::peaks::{Found, Margin, Place, Score};
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
    /// The votes of the best pose that was known when the search ended, be it another shard's,
    /// and how many are possible on its map: what has too few beside that was not searched.
    pub beside: (u16, u16),
    /// Whether places are judged by how well the scan fits, and not by votes alone.
    by_fit: bool,
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
    /// What is sent of what a shard found, with this score and beside a best pose like this; its
    /// maps have these numbers in the set.
    pub(crate) fn new(
        (shard, maps): (Shard, Vec<String>),
        held: &[(u32, u64)],
        found: &Located<'_>,
        (score, beside): (Score, VoteShare),
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
            beside: (beside.votes, beside.possible),
            by_fit: score == Score::Fit,
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

    /// The best pose that was known when the search ended.
    pub(crate) fn beside(&self) -> VoteShare {
        VoteShare::new(self.beside.0, self.beside.1)
    }

    /// What a shard sent that was asked, as it is merged by who judges with this score.
    ///
    /// # Errors
    /// It is not sound: of another shard, by another score, with numbers that are none or that
    /// no place has, or of a map that the set does not have.
    pub(crate) fn found(&self, asked: Shard, score: Score) -> Result<Found, LocateError> {
        let unsound = |reason: String| LocateError::Part { reason };
        if self.shard != asked {
            let found = self.shard;
            return Err(unsound(format!(
                "it is of shard {found}: asked was {asked}"
            )));
        }
        if self.by_fit != (score == Score::Fit) {
            let reason = "servers judge by another --score than the caller";
            return Err(unsound(reason.to_owned()));
        }
        if self.places.len() > MAX_PLACES || !self.is_map(self.leading_map) {
            let reason = "its maps or its places are not those of the shard";
            return Err(unsound(reason.to_owned()));
        }
        let is_sound = [self.lead, self.beside].into_iter().all(are_votes)
            && [self.needed, self.left_out].into_iter().all(is_lead)
            && [self.inlier_share, self.unseen].into_iter().all(is_share);
        if !is_sound {
            return Err(unsound("it has numbers that none has".to_owned()));
        }
        if !self
            .places
            .iter()
            .all(|place| self.is_map(place.map) && place.is_sound())
        {
            let reason = "a place has no pose on a map of the shard, or no score";
            return Err(unsound(reason.to_owned()));
        }
        Ok(Found {
            places: self.places.iter().map(SentPlace::place).collect(),
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

    /// Whether the shard holds a map of this number.
    fn is_map(&self, map: u32) -> bool {
        (map as usize) < self.maps.len() && self.shard.holds(map as usize)
    }
}

impl SentPlace {
    fn is_sound(&self) -> bool {
        let pose = self.pose.iter().chain(&self.covariance);
        // Where beams pass through obstacles a score is below 0.
        pose.chain([&self.score]).all(|number| number.is_finite())
            && self.score <= 1.0
            && is_share(self.drawn_doubt)
            && are_votes((self.intensity, self.possible))
    }

    fn place(&self) -> Place {
        let [x, y, yaw] = self.pose;
        Place {
            map: self.map,
            map_from_laser: Pose::new(x, y, yaw),
            covariance: Covariance::from_rows(self.covariance),
            score: self.score,
            probability: 0.0,
            intensity: self.intensity,
            possible: self.possible,
            drawn_doubt: self.drawn_doubt,
            support: self.support,
        }
    }
}

/// Whether a pose can have so many votes of those that are possible.
pub(crate) fn are_votes((votes, possible): (u16, u16)) -> bool {
    votes <= possible && possible > 0
}

fn is_share(number: f64) -> bool {
    (0.0..=1.0).contains(&number)
}

fn is_lead(number: f64) -> bool {
    number.is_finite() && number >= 0.0
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// What a shard of a set with three maps may say, which has a pose with so many votes, of so
    /// many that are possible, on its last map.
    pub(crate) fn part_of(shard: Shard, (votes, possible): (u16, u16)) -> Part {
        let maps = vec!["a".into(), "b".into(), "c".into()];
        let last = (0..3).rfind(|map| shard.holds(*map)).unwrap() as u32;
        let place = SentPlace {
            map: last,
            pose: [1.0, 2.0, 0.5],
            covariance: [0.0; 9],
            score: f64::from(votes) / f64::from(possible),
            intensity: votes,
            possible,
            drawn_doubt: 0.0,
            support: 1,
        };
        Part {
            shard,
            maps,
            ids: vec![7, 8],
            search_ns: 1,
            beside: (votes, possible),
            by_fit: true,
            places: vec![place],
            needed: 0.1,
            left_out: 0.0,
            may_lack: false,
            inlier_share: 0.9,
            leading_map: last,
            lead: (votes, possible),
            unseen: 0.3,
        }
    }

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
        let asked = Shard { number: 1, of: 2 };
        let part = part_of(asked, (5, 9));
        assert_eq!(part.found(asked, Score::Fit).unwrap().places[0].map, 2);
        let error = part.found(asked, Score::Votes).unwrap_err().to_string();
        assert!(error.contains("another --score"), "{error}");
        let other = Shard { number: 2, of: 2 };
        let error = part.found(other, Score::Fit).unwrap_err().to_string();
        assert!(error.contains("of shard 1/2: asked was 2/2"), "{error}");
        let refuse = |change: &dyn Fn(&mut Part)| {
            let mut wrong = part.clone();
            change(&mut wrong);
            assert!(wrong.found(asked, Score::Fit).is_err(), "{wrong:?}");
        };
        refuse(&|part| part.shard.of = 3);
        refuse(&|part| part.places[0].map = 1);
        refuse(&|part| part.places[0].map = 3);
        refuse(&|part| part.places[0].pose[1] = f64::NAN);
        refuse(&|part| part.places[0].covariance[4] = f64::INFINITY);
        refuse(&|part| part.places[0].score = 2.0);
        refuse(&|part| part.places[0].score = f64::NEG_INFINITY);
        refuse(&|part| part.places[0].possible = 0);
        refuse(&|part| part.places[0].intensity = 10);
        refuse(&|part| part.places[0].drawn_doubt = -0.1);
        refuse(&|part| part.places[0].drawn_doubt = f64::NAN);
        refuse(&|part| part.leading_map = 1);
        refuse(&|part| part.lead = (0, 0));
        refuse(&|part| part.lead = (65_535, 1));
        refuse(&|part| part.beside = (0, 0));
        refuse(&|part| part.beside = (2, 1));
        refuse(&|part| part.needed = f64::INFINITY);
        refuse(&|part| part.needed = -0.1);
        refuse(&|part| part.left_out = -0.1);
        refuse(&|part| part.inlier_share = 1.1);
        refuse(&|part| part.unseen = -0.1);
        refuse(&|part| part.unseen = f64::NAN);
    }
}
