//! The checks of a recording, one function each.

use std::collections::BTreeSet;

use engine::grid::CellRules;
use geometry::Pose;
use map::OccupancyGrid;
use offline::searchable;
use recording::{GROUND_TRUTH, Kind, Mount, Mounted, Recording};
use transport::with_causes;

use super::delay::odometry_delay;
use super::drive::{Drive, is_far};
use super::finding::Finding;
use super::located::Located;
use super::map_fit;
use super::sensors;
use super::survey::{Farthest, Seen, Survey};

/// A gap is worth a note if it is at least this many usual steps long.
const GAP_FACTOR: i64 = 5;

/// Share of ranges with exactly the same value from which that value stands for "no return".
const PILED_UP: f64 = 0.02;

/// Share of silent readings from which a laser seems to see nothing.
const MOSTLY_SILENT: f64 = 0.9;

/// Largest duration of a scan, in steps to the next scan.
const MAX_STEPS: f64 = 2.0;

/// Returns the findings of all checks, the worst first.
pub(super) fn all(
    recording: &Recording,
    survey: &Survey,
    given: Option<&OccupancyGrid>,
) -> Vec<Finding> {
    let mut all = Vec::from_iter(damage(recording));
    all.extend(survey.channels.iter().filter_map(undecodable));
    all.extend(topics(recording, survey, given.is_some()));
    all.extend(map(recording));
    all.extend(mount(recording, survey));
    all.extend(frames(survey));
    all.extend(stamps(survey));
    all.extend(survey.of_kind(Kind::Scan).filter_map(gaps));
    all.extend(scans(survey));
    all.extend(survey.of_kind(Kind::Scan).filter_map(durations));
    all.extend(survey.of_kind(Kind::Scan).filter_map(units));
    all.extend(survey.channels.iter().filter_map(mended));
    all.extend(truths(recording, survey));
    all.extend(order(recording));
    all.extend(Drive::of(recording).iter().flat_map(sensors::all));
    if let Ok(located) = Located::of(recording, given) {
        all.extend(odometry_delay(recording, survey, &located));
        all.extend(map_fit::first(&located));
    }
    all.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    all
}

fn damage(recording: &Recording) -> Option<Finding> {
    let damage = recording.damage()?;
    let messages = recording.messages();
    Some(Finding::lost(match recording.file_count() {
        1 => format!("{damage}; {messages} messages before that are readable"),
        // If there are several files, the error names the damaged one.
        _ => recording.damage_error()?.to_string(),
    }))
}

fn undecodable((topic, seen): (&String, &Seen)) -> Option<Finding> {
    let reason = seen.first_reason.as_ref()?;
    let count = seen.undecodable;
    Some(Finding::lost(format!(
        "{topic}: {count} messages do not decode; the first: {reason}"
    )))
}

fn topics(recording: &Recording, survey: &Survey, has_map: bool) -> Vec<Finding> {
    let kinds = [Kind::Scan, Kind::Map, Kind::Odometry];
    let unclear = kinds
        .into_iter()
        .filter_map(|kind| recording.topic(kind).err());
    let mut found: Vec<Finding> = unclear.map(|e| Finding::problem(with_causes(&e))).collect();
    if survey.of_kind(Kind::Scan).next().is_none() {
        found.push(Finding::problem(
            "no laser scans: there is nothing to localize",
        ));
    }
    if !has_map && survey.of_kind(Kind::Map).next().is_none() {
        found.push(Finding::note(
            "no map: commands need --map, and doctor compares scans with it",
        ));
    }
    found
}

fn map(recording: &Recording) -> Vec<Finding> {
    let Ok(maps) = recording.maps() else {
        // The check of topics reports it.
        return Vec::new();
    };
    let (mut seen, mut refused, mut newest) = (0, Vec::new(), None);
    // Maps that do not decode are reported with the other messages.
    for (_, map) in maps.flatten() {
        seen += 1;
        match searchable(&map, CellRules::default()) {
            Ok(grid) => newest = Some(grid),
            Err(refusal) => refused.push(refusal),
        }
    }
    let mut found = Vec::new();
    if let Some(first) = refused.first() {
        let count = refused.len();
        found.push(match newest {
            Some(_) => Finding::note(format!(
                "{count} of {seen} maps cannot be searched and are ignored; of the first: {first}"
            )),
            None => Finding::problem(format!("no map can be searched: {first}")),
        });
    }
    found.extend(newest.and_then(|grid| misnamed(recording, &grid, seen)));
    found
}

fn misnamed(recording: &Recording, grid: &OccupancyGrid, maps: u64) -> Option<Finding> {
    let found = format!("{:016x}", grid.id());
    let mut named = recording.metadata().iter().filter_map(|record| {
        let is_map = record.name == "backcast/map";
        is_map.then(|| record.entries.get("map_id")).flatten()
    });
    // If the map has changed during the recording, the metadata names both.
    let other = named.find(|id| **id != found)?;
    (maps == 1)
        .then(|| Finding::problem(format!("the map is {found}, but the metadata says {other}")))
}

fn mount(recording: &Recording, survey: &Survey) -> Vec<Finding> {
    let lasers: BTreeSet<&String> = survey.frames(Kind::Scan).collect();
    let (mut found, mut said) = (Vec::new(), BTreeSet::new());
    for laser in lasers {
        match recording.mounted(laser) {
            Ok(Mounted { mount, notes }) => {
                found.extend(mount.as_ref().and_then(|mount| far_mount(laser, mount)));
                let is_explained = notes.iter().any(|note| note.contains(laser.as_str()));
                if mount.is_none() && !is_explained {
                    found.push(Finding::note(format!(
                        "/tf_static does not say where {laser:?} sits on the robot: poses are of \
                         the laser"
                    )));
                }
                said.extend(notes);
            }
            Err(error) => found.push(Finding::problem(with_causes(&error))),
        }
    }
    found.extend(said.into_iter().map(Finding::note));
    found
}

fn far_mount(laser: &str, mount: &Mount) -> Option<Finding> {
    let metres = mount.base_from_laser.distance_to(Pose::IDENTITY);
    is_far(mount.base_from_laser).then(|| {
        let base = &mount.base_frame;
        Finding::problem(format!(
            "/tf_static puts {laser:?} {metres:.0} m from {base:?}: correct its translation, \
             which is in metres"
        ))
    })
}

/// Checks that messages have frames, the same for a whole channel, and that true poses are in the
/// frame of the map.
fn frames(survey: &Survey) -> Vec<Finding> {
    let mut found = Vec::new();
    for (topic, seen) in &survey.channels {
        let mut named = seen.frames.iter().chain(&seen.children);
        if named.any(String::is_empty) {
            let text = format!("{topic}: a message names no frame");
            found.push(Finding::problem(text));
        }
        if seen.frames.len() > 1 && seen.kind != Some(Kind::StaticTransforms) {
            let frames = Vec::from_iter(seen.frames.iter().cloned()).join(", ");
            let text = format!("{topic}: several frames, {frames}");
            found.push(Finding::problem(text));
        }
    }
    let maps = survey.frames(Kind::Map);
    let maps: BTreeSet<&String> = maps.filter(|frame| !frame.is_empty()).collect();
    if let Some(truths) = survey.channels.get(GROUND_TRUTH)
        && let Some(other) = truths.frames.iter().find(|frame| !maps.contains(frame))
        && let Some(map) = maps.first()
    {
        found.push(Finding::problem(format!(
            "{GROUND_TRUTH} is in frame {other:?}, the map in {map:?}"
        )));
    }
    let fixed = survey.of_kind(Kind::StaticTransforms);
    let mut known: BTreeSet<&String> = fixed.flat_map(|(_, seen)| &seen.children).collect();
    known.extend(survey.frames(Kind::StaticTransforms));
    known.extend(survey.frames(Kind::Scan));
    for (topic, seen) in survey.of_kind(Kind::Odometry) {
        if let Some(child) = seen.children.iter().find(|child| !known.contains(child)) {
            found.push(Finding::note(format!(
                "{topic} moves {child:?}, which neither a scan nor /tf_static names"
            )));
        }
    }
    found
}

fn stamps(survey: &Survey) -> Vec<Finding> {
    let mut found = Vec::new();
    for (topic, seen) in &survey.channels {
        let count = |is: fn(i64, i64) -> bool| {
            let pairs = seen.stamps_ns.windows(2);
            pairs.filter(|pair| is(pair[0], pair[1])).count()
        };
        let back = count(|before, after| after < before);
        if back > 0 {
            let text = format!("{topic}: stamps go back {back} times");
            found.push(Finding::problem(text));
        }
        let same = count(|before, after| after == before);
        if same > 0 && seen.kind == Some(Kind::Scan) {
            let text = format!("{topic}: {same} scans have the stamp before");
            found.push(Finding::problem(text));
        }
    }
    found
}

fn gaps((topic, seen): (&String, &Seen)) -> Option<Finding> {
    let steps = seen.steps_ns();
    let (usual, longest) = (*steps.get(steps.len() / 2)?, *steps.last()?);
    let gaps = steps
        .iter()
        .filter(|step| **step > GAP_FACTOR.saturating_mul(usual))
        .count();
    let (usual, longest) = (usual as f64 * 1e-9, longest as f64 * 1e-9);
    (gaps > 0).then(|| {
        Finding::note(format!(
            "{topic}: {gaps} gaps, the longest of {longest:.2} s where {usual:.2} s is usual"
        ))
    })
}

fn scans(survey: &Survey) -> Vec<Finding> {
    let mut found = Vec::new();
    for (topic, seen) in survey.of_kind(Kind::Scan) {
        if let Some(oddity) = &seen.first_oddity {
            let odd = seen.odd_scans;
            found.push(Finding::problem(format!(
                "{topic}: {odd} odd scans; of the first {oddity}"
            )));
        }
        found.extend(pile(topic, seen));
        let share = seen.silent as f64 / seen.readings.max(1) as f64;
        if share > MOSTLY_SILENT {
            let percent = 100.0 * share;
            found.push(Finding::note(format!(
                "{topic}: {percent:.0} % of the readings say nothing"
            )));
        }
    }
    found
}

fn durations((topic, seen): (&String, &Seen)) -> Option<Finding> {
    let (longest, step_s) = (seen.longest?, seen.usual_step_s()?);
    let time_increment = longest.time_increment_s;
    (longest.scan_s > MAX_STEPS * step_s).then(|| {
        Finding::problem(format!(
            "{topic}: with a time_increment of {time_increment:?} s a scan takes longer than \
             the {step_s:.2} s to the next: the driver must set it to the seconds from one \
             beam to the next, or to 0"
        ))
    })
}

fn units((topic, seen): (&String, &Seen)) -> Option<Finding> {
    let middle_m = seen.first_middle_m?;
    (2 * seen.unreachable > seen.stamps_ns.len() as u64).then(|| {
        Finding::problem(format!(
            "{topic}: half of the readings are beyond {middle_m:.0} m: they are in \
             millimetres; the driver must divide ranges, range_min and range_max by 1000, for \
             those of a LaserScan are in metres"
        ))
    })
}

/// Checks for many ranges with exactly the largest value, by which some drivers report that nothing
/// returned.
fn pile(topic: &str, seen: &Seen) -> Option<Finding> {
    let Farthest {
        range_m,
        count,
        range_max_m,
    } = seen.farthest?;
    let share = count as f64 / seen.readings.max(1) as f64;
    let percent = 100.0 * share;
    let what = format!("{topic}: {percent:.0} % of the readings are exactly {range_m} m");
    let reason = match range_m >= range_max_m {
        true => "which is range_max: readings at or above range_max are no returns".to_owned(),
        false => format!(
            "and none is farther: if that is how the laser says that nothing came back, its \
             range_max of {range_max_m} m is too large, for only readings at or above range_max \
             are no returns"
        ),
    };
    (share >= PILED_UP).then(|| Finding::note(format!("{what}, {reason}")))
}

fn mended((topic, seen): (&String, &Seen)) -> Option<Finding> {
    let first = seen.first_mend?;
    let count = seen.mended;
    Some(Finding::note(format!(
        "{topic}: {count} orientations are mended; of the first, {first}"
    )))
}

fn truths(recording: &Recording, survey: &Survey) -> Option<Finding> {
    let truths = match recording.ground_truths() {
        Ok(truths) => truths,
        Err(error) => return Some(Finding::problem(with_causes(&error))),
    };
    let scans = survey
        .of_kind(Kind::Scan)
        .flat_map(|(_, seen)| &seen.stamps_ns);
    let scans: BTreeSet<&i64> = scans.collect();
    let orphans = truths.keys().filter(|stamp| !scans.contains(stamp)).count();
    (orphans > 0).then(|| {
        let all = truths.len();
        Finding::note(format!(
            "{orphans} of {all} true poses have the stamp of no scan"
        ))
    })
}

fn order(recording: &Recording) -> Option<Finding> {
    let unsorted = recording.unsorted();
    (unsorted > 0).then(|| {
        Finding::note(format!(
            "{unsorted} messages stand in the file behind later ones; readers sort them"
        ))
    })
}
