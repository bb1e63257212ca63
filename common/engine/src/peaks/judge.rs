//! Judging by the fit of the scan: the candidates of the votes are refined, scored and sorted.

use std::cmp::Ordering;

use geometry::{Covariance, wrap_angle};
use messages::Verdict;
use nalgebra::{Matrix3, Vector3};

use super::likelihood::{self, lead};
use super::summits::{self, Reach, Summit};
use super::{Margin, PeakConfig, PeakInput, Place, Places, Workspace, in_map};
use crate::fit::{BeamClass, DistanceField, Ends, GridPose, Refined, lacks};
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
            .map(|summit| place(input, (distance_field, ends), summit, config));
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
            let unmatched = [BeamClass::Through, BeamClass::Unknown]
                .map(|class| ends.share(&found.classes, class))
                .iter()
                .sum();
            let resolution = distance_field.frame.resolution_m;
            let apart = PIECE_SIGMAS * config.fit.sigma_cells(resolution) * resolution;
            let pieces = ends.effective_pieces(apart);
            let doubt = likelihood::doubt(best.score, unmatched, pieces, config);
            let left_out = lead(
                best.score,
                best.score - distance_field.left_out(best.score, &config.fit),
            );
            let weight = likelihood::weight_of_leads(ends.effective_beams(), config);
            let left_out = likelihood::discount(left_out, weight, config);
            // A map that leaves things out explains a low score, too.
            let doubt = (doubt - weight * left_out).max(0.0);
            self.margin = Margin {
                doubt,
                left_out,
                weight,
                ..self.margin
            };
            // The best place of all may be on another map.
            let apart = if input.has_others { ELSEWHERE } else { 1.0 };
            let needed = likelihood::needed_lead(doubt, config);
            let matters = needed.max(NEGLIGIBLE * config.lead_scale);
            let matters = left_out + apart * matters / weight;
            let mut nearest = f64::INFINITY;
            for (rank, (_, place)) in self.refined.iter_mut().enumerate() {
                if rank >= scored {
                    if lead(best.score, place.score) >= matters.max(nearest) {
                        break;
                    }
                    place.score = score(place);
                }
                if !is_same_place(&best, place, config) {
                    nearest = nearest.min(lead(best.score, place.score));
                }
            }
            self.refined.sort_unstable_by(by_score);
            keep_distinct(&self.refined, &mut found.places, config);
            found.judge((best.score, self.margin), &mut self.leads, config);
        }
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

/// Refines a candidate to a place; its score is an upper bound.
fn place(
    input: &PeakInput<'_>,
    (distance_field, ends): (&DistanceField, &Ends),
    summit: &Summit,
    config: &PeakConfig,
) -> Place {
    let vote = &summit.vote;
    let side = input.frame.resolution_m / distance_field.frame.resolution_m;
    let start = GridPose {
        x: side * (f64::from(vote.x) + 0.5),
        y: side * (f64::from(vote.y) + 0.5),
        heading: input
            .known_heading_in_grid()
            .unwrap_or(input.heading_of(vote)),
    };
    let is_known = input.known_heading.is_some();
    let refined = distance_field.refine(ends, start, is_known, &config.fit);
    let pose = refined.pose;
    let mut map_from_laser = distance_field
        .frame
        .map_from_cells(pose.x, pose.y, pose.heading);
    if let Some(heading) = input.known_heading {
        map_from_laser.yaw = wrap_angle(heading);
    }
    Place {
        map: 0,
        map_from_laser,
        covariance: covariance(distance_field, is_known, &refined),
        score: distance_field.score_at_most(ends, pose, &config.fit),
        probability: 0.0,
        intensity: vote.intensity,
        possible: input.highest_possible as u16,
        drawn_doubt: distance_field.drawn_doubt(&config.fit),
        support: summit.support,
    }
}

/// Standard deviations of a place along directions that no beam constrains, in metres and radians.
const LOOSE_M: f64 = 2.0;
const LOOSE_RADIANS: f64 = 0.35;

/// Covariance of a refined pose in the map frame, from the curvature of the fit and the errors of
/// walls.
fn covariance(
    distance_field: &DistanceField,
    heading_is_known: bool,
    refined: &Refined,
) -> Covariance {
    let loose = LOOSE_M / distance_field.frame.resolution_m;
    let prior = Vector3::new(loose.powi(-2), loose.powi(-2), LOOSE_RADIANS.powi(-2));
    let mut information = refined.information() + Matrix3::from_diagonal(&prior);
    if heading_is_known {
        // The heading has no error, and x and y have none from it.
        information.fill_row(2, 0.0);
        information.fill_column(2, 0.0);
        information[(2, 2)] = 1.0;
    }
    // The prior makes it positive definite.
    let mut in_cells = information.try_inverse().unwrap_or_else(Matrix3::zeros);
    if heading_is_known {
        in_cells[(2, 2)] = 0.0;
    }
    let drawn = distance_field.drawn_error_m() / distance_field.frame.resolution_m;
    in_cells += refined.by_walls(in_cells, drawn);
    in_map(distance_field.frame, in_cells)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::drawn::distance_field;

    fn deviations(heading_is_known: bool, curvature: Matrix3<f64>) -> [f64; 3] {
        let measured = distance_field(&["....", ".##.", "#..#"]);
        let refined = Refined {
            pose: GridPose::new(0.0, 0.0, 0.0),
            curvature,
            variance: 0.5,
            weight: 100.0,
            walls: Matrix3::zeros(),
        };
        let covariance = covariance(&measured, heading_is_known, &refined).to_rows();
        [0, 4, 8].map(|i| covariance[i].sqrt())
    }

    #[test]
    fn a_known_heading_does_not_err_nor_the_position_with_it() {
        // Turning moves all ends like a motion of 20 cells along y.
        let turned = Matrix3::new(50.0, 0.0, 0.0, 0.0, 50.0, 900.0, 0.0, 900.0, 20_000.0);
        let [x, y, yaw] = deviations(false, turned);
        let [known_x, known_y, known_yaw] = deviations(true, turned);
        assert!(
            (x - known_x).abs() < 1e-9 && known_y < 0.7 * y,
            "{y} {known_y}"
        );
        assert!(yaw > 0.0 && known_yaw == 0.0);
        // Eight beams are worth one: 0.5 · 8 / 50 squared cells.
        assert!((known_x - 0.1 * 0.08f64.sqrt()).abs() < 1e-4, "{known_x}");
    }

    #[test]
    fn along_what_no_beam_shows_a_place_is_two_metres_long() {
        let corridor = Matrix3::from_diagonal(&Vector3::new(0.0, 90.0, 5_000.0));
        let [x, y, _] = deviations(false, corridor);
        assert!((x - LOOSE_M).abs() < 1e-9 && y < 0.03, "{x} {y}");
    }
}
