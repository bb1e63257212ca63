//! Section V: a robot with a laser in a corridor localizes at three places: the corridor
//! of the University of Málaga in place of the paper's, whose recording is not public.

use std::path::Path;

use crate::distinct;
use clap::Parser;
use command_line::wrong_use;
use engine::grid::CellRules;
use engine::vote_search::Prior;
use geometry::Pose;
use offline::{Field, Options, Session, TakenScan, World, no_truths};
use plots::Votes;
use plots::drawing::Scene;

use super::folder::{Csv, digits};

/// Where in the recording the places lie, as shares of its scans.
const PLACES: [f64; 3] = [0.1, 0.5, 0.9];

/// The settings of `locate` without any option.
#[derive(Debug, Parser)]
struct Defaults {
    #[command(flatten)]
    options: Options,
}

#[derive(Debug)]
pub(super) struct Localized {
    /// Which scan of the recording, from 1.
    pub(super) scan: usize,
    truth: Pose,
    /// The pose with the most votes, as the paper does it, and that after the second stage.
    by_votes: Pose,
    by_fit: Pose,
    field: Field,
}

#[derive(Debug)]
pub(super) struct Corridor {
    map: map::OccupancyGrid,
    rules: CellRules,
    path: Vec<Pose>,
    pub(super) places: Vec<Localized>,
}

impl Localized {
    /// Metres from the truth by the votes alone.
    pub(super) fn votes_off_m(&self) -> f64 {
        self.by_votes.distance_to(self.truth)
    }

    /// The same after the second stage.
    pub(super) fn fit_off_m(&self) -> f64 {
        self.by_fit.distance_to(self.truth)
    }
}

/// Localizes at the three places of a recording with `/map` and `/ground_truth`.
pub(super) fn localize(file: &Path) -> anyhow::Result<Corridor> {
    let defaults = Defaults::try_parse_from(["paper"]);
    let options = defaults.map_err(|error| wrong_use(error.to_string()))?;
    let options = options.options;
    let recording = options.open(&[file.to_owned()])?;
    let truths = recording.ground_truths()?;
    if truths.is_empty() {
        return Err(no_truths(file));
    }
    let mut taken = Vec::new();
    let mut session = Session::open(&recording, &options, None)?;
    for scan in session.scans.by_ref() {
        let scan = scan?;
        if let Some(truth) = truths.get(&scan.stamp_ns) {
            taken.push((scan, truth.pose));
        }
    }
    let mut places = Vec::new();
    for share in PLACES {
        let index = (share * taken.len() as f64) as usize;
        if let Some((scan, truth)) = taken.get(index) {
            let scan = (index + 1, scan);
            places.push(locate(&mut session, (file, &options), scan, *truth)?);
        }
    }
    Ok(Corridor {
        map: session.map()?.clone(),
        rules: options.engine.cells,
        path: taken.into_iter().map(|(_, truth)| truth).collect(),
        places,
    })
}

fn locate(
    session: &mut Session<'_>,
    (file, options): (&Path, &Options),
    (number, scan): (usize, &TakenScan),
    truth: Pose,
) -> anyhow::Result<Localized> {
    let answer = session.ask(scan)?.answer?;
    let most = distinct(answer.outcome, answer.frame, 1);
    let (Some(&by_votes), Some(best)) = (most.first(), answer.places.places.first()) else {
        return Err(plots::no_place(file, number as u64, answer.places));
    };
    let by_fit = best.map_from_laser;
    let world = World::prepare(session.map()?, &options.engine, Prior::Heading);
    let field = world.and_then(|world| world.field_at(&scan.borrowed(), by_votes.yaw))?;
    Ok(Localized {
        scan: number,
        truth,
        by_votes,
        by_fit,
        field,
    })
}

pub(super) fn csv(corridor: &Corridor) -> Csv {
    let mut csv = Csv::new(
        "place,scan,truth_x_m,truth_y_m,truth_heading_deg,votes_error_m,votes_error_deg,\
         fit_error_m,fit_error_deg",
    );
    for (number, place) in (1..).zip(&corridor.places) {
        let truth = place.truth;
        let degrees = |pose: Pose| pose.angle_to(truth).to_degrees();
        let figures = [
            truth.x,
            truth.y,
            truth.yaw.to_degrees(),
            place.votes_off_m(),
            degrees(place.by_votes),
            place.fit_off_m(),
            degrees(place.by_fit),
        ];
        let first = [i32::to_string(&number), place.scan.to_string()];
        csv.push(first.into_iter().chain(figures.map(digits)));
    }
    csv
}

/// The map with path and places, as figure 6a.
pub(super) fn draw_places(corridor: &Corridor) -> anyhow::Result<Scene> {
    let places: Vec<(Pose, Pose)> = corridor
        .places
        .iter()
        .map(|place| (place.by_votes, place.truth))
        .collect();
    let text = (
        "Section V: a corridor, and three places where the robot localizes".to_owned(),
        "each from one scan alone, at any heading, by the votes".to_owned(),
    );
    let map = (&corridor.map, corridor.rules);
    plots::draw_places(map, &corridor.path, &places, text)
}

/// The intensity field at a place, as figures 6e to 6g.
pub(super) fn draw_field(
    corridor: &Corridor,
    number: usize,
    place: &Localized,
) -> anyhow::Result<Scene> {
    let text = (
        format!("Place {number}: intensity at the heading that was found"),
        format!(
            "scan {} of the recording; the votes are {:.1} cm from the truth, after the second stage {:.1} cm",
            place.scan,
            100.0 * place.votes_off_m(),
            100.0 * place.fit_off_m()
        ),
    );
    let map = (&corridor.map, corridor.rules);
    plots::draw_votes(&Votes::whole(map, &place.field, Some(place.truth), text))
}
