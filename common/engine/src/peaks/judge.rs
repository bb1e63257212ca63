//! Judging by the fit of the scan: the candidates of the votes are refined, scored and sorted.

use std::cmp::Ordering;

use messages::Verdict;

use super::likelihood::{self, lead};
use super::summits::{self, Reach};
use super::{Margin, PeakConfig, PeakInput, Place, Places, Workspace, refined};
use crate::fit::{BeamClass, DistanceField, Ends, GridPose, lacks};
use crate::votes::most_candidates;

/// Difference between the readings of neighbouring beams at which a new piece begins, in standard
/// deviations of the fit.
const PIECE_SIGMAS: f64 = 4.0;

/// Gap behind the best place, in units of `lead_scale`, at which a place is practically impossible:
/// its probability is 1/22 000 of the best one's.
const NEGLIGIBLE: f64 = 10.0;

/// Factor on the lead that the best place needs over a place on another map: maps made by other
/// people, in other ways, are less comparable than places on one map.
const ELSEWHERE: f64 = 2.0;

impl Workspace {
    /// Fills in the places, from the votes of a scan and its beams.
    pub(super) fn find(
        &mut self,
        input: &PeakInput<'_>,
        (distance_field, ends): (&DistanceField, &Ends),
        config: &PeakConfig,
    ) {
        let reach = Reach::new(input, config.candidate_m, config.candidate_deg);
        let wanted = config.max_candidates as usize;
        let most = (wanted, most_candidates(wanted, input.frame.resolution_m));
        summits::find(input, reach, most, &mut self.summits);
        self.refined.clear();
        let places = self
            .summits
            .iter()
            .map(|summit| refined::place(input, (distance_field, ends), summit, config));
        self.refined.extend(places.enumerate());
        self.places.clear();
        self.margin = Margin {
            may_lack: input.may_lack(),
            ..Margin::default()
        };
        let grid_pose = |place: &Place| GridPose::of(distance_field.frame, place.map_from_laser);
        let score = |place: &Place| distance_field.score(ends, grid_pose(place), &config.fit);
        if let Some((best, scored)) = score_best(&mut self.refined, score) {
            let found = &mut self.places;
            distance_field.classify(ends, grid_pose(&best), &config.fit, &mut found.classes);
            found.inlier_share = ends.share(&found.classes, BeamClass::Hit);
            self.margin = Margin {
                may_lack: self.margin.may_lack,
                ..margin(best.score, &found.classes, (distance_field, ends), config)
            };
            // The best place of all may be on another map.
            let apart = if input.has_others { ELSEWHERE } else { 1.0 };
            let matters = self.margin.matters(apart, config);
            score_rivals(&mut self.refined, (&best, scored), matters, score, config);
            self.refined.sort_unstable_by(by_score);
            keep_distinct(&self.refined, &mut found.places, config);
            found.judge((best.score, self.margin), &mut self.leads, config);
        }
    }
}

/// Returns the requirements for the best place to be unique, from its score and the classes of its
/// beams.
fn margin(
    best: f64,
    classes: &[BeamClass],
    (distance_field, ends): (&DistanceField, &Ends),
    config: &PeakConfig,
) -> Margin {
    let unmatched = [BeamClass::Through, BeamClass::Unknown]
        .map(|class| ends.share(classes, class))
        .iter()
        .sum();
    let resolution = distance_field.frame.resolution_m;
    let apart = PIECE_SIGMAS * config.fit.sigma_cells(resolution) * resolution;
    let doubt = likelihood::doubt(best, unmatched, ends.effective_pieces(apart), config);
    let weight = likelihood::weight_of_leads(ends.effective_beams(), config);
    let left_out = lead(best, best - distance_field.left_out(best, &config.fit));
    let left_out = likelihood::discount(left_out, weight, config);
    Margin {
        // A map that leaves things out explains a low score, too.
        doubt: (doubt - weight * left_out).max(0.0),
        left_out,
        weight,
        may_lack: false,
    }
}

impl Margin {
    /// Returns the lead of the best place from which another place does not matter; leads over
    /// places that are `apart` times less comparable count for less.
    fn matters(&self, apart: f64, config: &PeakConfig) -> f64 {
        let needed = likelihood::needed_lead(self.doubt, config);
        let matters = needed.max(NEGLIGIBLE * config.lead_scale);
        self.left_out + apart * matters / self.weight
    }
}

impl Places {
    /// Derives verdict, alternatives and probabilities from the scores of the places, and keeps as
    /// many places as requested. `margin` is what the best place needs to be unique.
    pub(super) fn judge(
        &mut self,
        (best, margin): (f64, Margin),
        leads: &mut Vec<f64>,
        config: &PeakConfig,
    ) {
        let Margin {
            doubt,
            left_out,
            weight,
            may_lack,
        } = margin;
        let places = &mut self.places;
        let first = places[0];
        leads.clear();
        leads.extend(places.iter().map(|place| {
            let (left_out, apart) = match place.map == first.map {
                true => (left_out, 1.0),
                false => {
                    let drawn = [first.drawn_doubt, place.drawn_doubt];
                    let left_out = lead(best, best - doubt_between(first.score, drawn));
                    let weight = weight / ELSEWHERE;
                    (likelihood::discount(left_out, weight, config), ELSEWHERE)
                }
            };
            (lead(best, place.score) - left_out).max(0.0) * weight / apart
        }));
        let needed = likelihood::needed_lead(doubt, config);
        self.alternatives = leads[1..].iter().filter(|&&lead| lead < needed).count() as u32;
        likelihood::assign(places, leads, doubt, config);
        places.truncate(config.max_hypotheses as usize);
        self.confidence = places[0].probability;
        let is_sure = self.alternatives == 0 && self.confidence >= config.unique_from;
        self.verdict = match () {
            () if best < config.least_score => Verdict::PoorFit,
            () if may_lack || !is_sure => Verdict::Ambiguous,
            () => Verdict::Unique,
        };
    }
}

/// Error of the score difference between the best place and one on another map, because one of the
/// maps was drawn: a drawing has clean walls, which fit a piece of any building, and leaves out
/// what is next to them. The doubts are those of [`DistanceField::drawn_doubt`].
pub(crate) fn doubt_between(best: f64, [of_best, of_other]: [f64; 2]) -> f64 {
    of_best.max(of_other.min(lacks(best)))
}

/// Sorts the best score first; on a tie the place with more votes.
fn by_score((i, a): &(usize, Place), (j, b): &(usize, Place)) -> Ordering {
    b.score.total_cmp(&a.score).then(i.cmp(j))
}

/// Finds the best of places whose scores are upper bounds. Computes the scores of the places whose
/// bounds reach the best score; these come first afterwards, and their number is returned.
fn score_best(
    places: &mut [(usize, Place)],
    score: impl Fn(&Place) -> f64,
) -> Option<(Place, usize)> {
    places.sort_unstable_by(by_score);
    let (mut best, mut scored) = (f64::NEG_INFINITY, 0);
    for (_, place) in places.iter_mut() {
        if place.score < best {
            break;
        }
        place.score = score(place);
        (best, scored) = (best.max(place.score), scored + 1);
    }
    let best = places[..scored].iter().min_by(|a, b| by_score(a, b))?;
    Some((best.1, scored))
}

/// Computes the scores of the places behind the first `scored`, until no place can matter any more:
/// the best leads by `matters`, and by more than over the nearest place that is another.
fn score_rivals(
    places: &mut [(usize, Place)],
    (best, scored): (&Place, usize),
    matters: f64,
    score: impl Fn(&Place) -> f64,
    config: &PeakConfig,
) {
    let mut nearest = f64::INFINITY;
    for (rank, (_, place)) in places.iter_mut().enumerate() {
        if rank >= scored {
            if lead(best.score, place.score) >= matters.max(nearest) {
                break;
            }
            place.score = score(place);
        }
        if !is_same_place(best, place, config) {
            nearest = nearest.min(lead(best.score, place.score));
        }
    }
}

/// Keeps the best of all poses that converged to one place.
fn keep_distinct(places: &[(usize, Place)], kept: &mut Vec<Place>, config: &PeakConfig) {
    for (_, place) in places {
        let is_same = |other: &&mut Place| is_same_place(other, place, config);
        match kept.iter_mut().find(is_same) {
            Some(other) => {
                other.support += place.support;
                other.intensity = other.intensity.max(place.intensity);
            }
            None => kept.push(*place),
        }
    }
}

fn is_same_place(a: &Place, b: &Place, config: &PeakConfig) -> bool {
    let angle = config.same_place_deg.to_radians();
    a.map_from_laser
        .is_within(b.map_from_laser, config.same_place_m, angle)
}
