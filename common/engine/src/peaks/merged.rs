//! Merges places on several maps into one answer.

use super::{Judged, Margin, PeakConfig, Place, Places};
use crate::votes::{VoteShare, is_close};

/// Result on one map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// Distinct places, best first, each with the number of the map.
    pub places: Vec<Place>,
    /// Requirements for the first of them to be unique.
    pub margin: Margin,
    /// Share of the beams that end at an obstacle at the first place.
    pub inlier_share: f64,
    /// Number of the map.
    pub map: u32,
    /// Votes of the best pose.
    pub lead: VoteShare,
}

impl Found {
    /// Makes the result of a search on the map with this number from the votes of its best pose
    /// and the places.
    #[must_use]
    pub fn on(map: u32, lead: VoteShare, judged: &Judged<'_>) -> Self {
        let places = judged.places.places.iter();
        Found {
            places: places.map(|place| Place { map, ..*place }).collect(),
            margin: judged.margin,
            inlier_share: judged.places.inlier_share,
            map,
            lead,
        }
    }

    /// True if its vote share is larger, compared without rounding, or equal on a map with a
    /// smaller number.
    fn leads(&self, other: &Found) -> bool {
        let lead = self.lead.compare(other.lead);
        lead.then(other.map.cmp(&self.map)).is_gt()
    }
}

/// The merged answer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Merged {
    /// Places and verdict. The beam classes are empty; those of the map of the best place apply.
    pub places: Places,
    /// Index of the merged result that has the best place.
    pub best_of: usize,
}

/// Merges the results on several maps, in any order, as if one search had found them: places are
/// sorted by score, equal ones by the number of their map, and a place on another map is an
/// alternative like any other.
///
/// Places with less than half of the votes of the best pose count on that pose's map only. If this
/// removes the first place of a result and another place of it is the best of all, nothing is
/// `Unique`, because the margin of a result holds for its first place only.
#[must_use]
pub fn merge(all: &[Found], config: &PeakConfig) -> Merged {
    let first = all.iter().reduce(|a, b| if b.leads(a) { b } else { a });
    let Some(leading) = first else {
        return Merged::default();
    };
    let counts = |place: &&Place| {
        let best = leading.lead.on(place.possible);
        place.map == leading.map || is_close(place.intensity, best)
    };
    let numbered = all.iter().enumerate();
    let mut places: Vec<(usize, Place)> = numbered
        .flat_map(|(number, found)| {
            let places = found.places.iter().filter(counts);
            places.map(move |place| (number, *place))
        })
        .collect();
    // A stable sort keeps equal places of one map in their order.
    places.sort_by(|(_, a), (_, b)| b.score.total_cmp(&a.score).then(a.map.cmp(&b.map)));
    let best_of = places.first().map_or(0, |&(number, _)| number);
    // Another place of a result may be more doubtful than its first one, and its score may be a
    // bound.
    let is_first = |&(number, place): &(usize, Place)| all[number].places.first() == Some(&place);
    let may_lack =
        all.iter().any(|found| found.margin.may_lack) || !places.first().is_none_or(is_first);
    let margin = Margin {
        may_lack,
        ..all[best_of].margin
    };
    let mut merged = Places {
        places: places.into_iter().map(|(_, place)| place).collect(),
        inlier_share: all[best_of].inlier_share,
        ..Places::default()
    };
    if let Some(best) = merged.places.first().copied() {
        merged.judge((best.score, margin), &mut Vec::new(), config);
    }
    Merged {
        places: merged,
        best_of,
    }
}

#[cfg(test)]
mod tests {
    use messages::Verdict;
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::testing::place;

    /// Places on a map with 100 possible votes, from their scores and votes.
    fn found(map: u32, lead: u16, doubt: f64, places: &[(f64, u16)]) -> Found {
        let places = places.iter();
        Found {
            places: places
                .map(|&(score, intensity)| place(map, score, intensity))
                .collect(),
            margin: Margin {
                doubt,
                ..Margin::default()
            },
            inlier_share: 0.9,
            map,
            lead: VoteShare::new(lead, 100),
        }
    }

    #[test]
    fn a_place_behind_a_first_one_that_is_left_out_never_stands_alone() {
        let other = found(0, 60, 0.0, &[(0.57, 60)]);
        let verdict = |part: Found| {
            let merged = merge(&[other.clone(), part], &PeakConfig::default());
            assert_eq!((merged.best_of, merged.places.places[0].map), (1, 1));
            merged.places.verdict
        };
        // The first place of the result is less doubtful than the second.
        let second = verdict(found(1, 40, 0.0, &[(0.9, 20), (0.7, 40)]));
        assert_eq!(second, Verdict::Ambiguous);
        // So far behind the first, the score of the second place may be a bound.
        let bound = verdict(found(1, 40, 0.0, &[(0.99, 20), (0.85, 40)]));
        assert_eq!(bound, Verdict::Ambiguous);
        let first = verdict(found(1, 40, 0.0, &[(0.9, 40), (0.7, 20)]));
        assert_eq!(first, Verdict::Unique);
    }

    proptest! {
        #[test]
        fn what_stands_alone_is_the_first_place_of_its_part(
            parts in vec((0u16..=100, 0.0..0.3f64, vec((0.0..1.0f64, 0u16..=100), 0..4)), 1..4),
        ) {
            let parts: Vec<Found> = (0..).zip(parts).map(|(map, (lead, doubt, mut places))| {
                places.sort_by(|a, b| b.0.total_cmp(&a.0));
                found(map, lead, doubt, &places)
            }).collect();
            let merged = merge(&parts, &PeakConfig::default());
            if let Some(best) = merged.places.places.first() {
                let first = parts[merged.best_of].places.first().unwrap();
                let is_first = (first.map, first.map_from_laser) == (best.map, best.map_from_laser);
                prop_assert!(is_first || merged.places.verdict != Verdict::Unique);
            }
        }
    }
}
