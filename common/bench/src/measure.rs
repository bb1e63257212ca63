//! Takes the time of a method on the scans of a case.

use crate::baselines::{Estimate, Readings};
use crate::scans::SimulatedScan;
use crate::timing::{cpu_ms, median};
use engine::program::VoteConfig;
use engine::space::Space;

use super::row::Row;

/// One scan of a case, and what all methods read from it.
#[derive(Debug)]
pub(super) struct Task<'a> {
    pub(super) scan: &'a SimulatedScan,
    pub(super) votes: VoteConfig,
    pub(super) space: &'a Space,
    pub(super) readings: Readings,
    pub(super) headings: Vec<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Answer {
    /// The best pose, if any has a vote.
    Best(Option<Estimate>),
    /// It took too long, or too much memory.
    GaveUp,
}

/// A method that is ready for a case; takes a scan and the headings to search.
pub(super) type Locate<'a> = Box<dyn FnMut(&Task<'_>, &[usize]) -> anyhow::Result<Answer> + 'a>;

/// Locates scans until they are through or the budget is spent, one at least.
/// A method that would spend it on one scan alone is measured on as many
/// headings as fit, but not on fewer than `least_headings`, evenly spread, and
/// its time scaled up. Returns the row with these figures; `None` if the method gave up.
pub(super) fn measure(
    locate: &mut Locate<'_>,
    tasks: &[Task<'_>],
    (budget_ms, least_headings): (f64, Option<usize>),
    row: Row,
) -> anyhow::Result<Option<Row>> {
    let all = tasks.first().map_or(0, |task| task.headings.len());
    let mut count = all;
    if let Some(least) = least_headings.filter(|&least| least < all) {
        let task = &tasks[0];
        let (outcome, one_ms) = cpu_ms(|| locate(task, &task.headings[..1]));
        outcome?;
        count = ((budget_ms / one_ms) as usize).clamp(least, all);
    }
    let (mut costs, mut found) = (Vec::new(), 0u32);
    for task in tasks {
        let some: Vec<usize> = (0..count).map(|i| task.headings[i * all / count]).collect();
        let (answer, cost) = cpu_ms(|| locate(task, &some));
        let Answer::Best(pose) = answer? else {
            return Ok(None);
        };
        found += u32::from(pose.is_some_and(|pose| task.scan.is_found_at(&pose, task.space)));
        costs.push(cost * all as f64 / count as f64);
        if costs.iter().sum::<f64>() * count as f64 / all as f64 >= budget_ms {
            break;
        }
    }
    Ok(Some(Row {
        scans: costs.len(),
        found: (count == all).then(|| f64::from(found) / costs.len() as f64),
        scaled_from_headings: (count < all).then_some(count),
        cpu_ms: Some(median(costs)),
        ..row
    }))
}

#[cfg(test)]
mod tests {
    use crate::scans::{ScanConfig, simulate};
    use crate::worlds::{Kind, World};
    use engine::taper::TaperShape;

    use super::*;

    fn on_tasks<T>(headings: usize, work: impl FnOnce(&[Task<'_>]) -> T) -> T {
        let world = World::generate(Kind::Boxes, (60, 60), 0.2, 1).unwrap();
        let space = world.space(72).unwrap();
        let config = ScanConfig::new(8, 0.0);
        let scans = simulate(&world, &space, &config, 3, 1).unwrap();
        let votes = config.votes(TaperShape::Box);
        let task = |scan| Task {
            scan,
            votes,
            space: &space,
            readings: Readings::new(&scan.scan(), &space, &votes).unwrap(),
            headings: (0..headings).collect(),
        };
        let tasks: Vec<Task<'_>> = scans.iter().map(task).collect();
        work(&tasks)
    }

    /// Measures a method that only spins, so long for each heading.
    fn measured(headings: usize, ms_a_heading: f64, budget_ms: f64) -> Row {
        let mut locate: Locate<'_> = Box::new(|task, headings| {
            let spin = || (0..200).map(|i| f64::from(i).sqrt()).sum::<f64>();
            let mut spent = 0.0;
            while spent < ms_a_heading * headings.len() as f64 {
                spent += cpu_ms(|| std::hint::black_box(spin())).1;
            }
            let SimulatedScan { x, y, heading, .. } = *task.scan;
            Ok(Answer::Best(Some(Estimate::new(x, y, heading, 1.0))))
        });
        let measured = on_tasks(headings, |tasks| {
            measure(&mut locate, tasks, (budget_ms, Some(1)), Row::default())
        });
        measured.unwrap().unwrap()
    }

    #[test]
    fn what_fits_is_measured_in_full() {
        let measured = measured(4, 0.01, 1000.0);
        assert_eq!((measured.scans, measured.found), (3, Some(1.0)));
        assert_eq!(measured.scaled_from_headings, None);
    }

    #[test]
    fn what_takes_too_long_has_no_figure() {
        let mut locate: Locate<'_> = Box::new(|_, _| Ok(Answer::GaveUp));
        on_tasks(1, |tasks| {
            let measured = measure(&mut locate, tasks, (1.0, None), Row::default());
            assert_eq!(measured.unwrap(), None);
        });
    }

    #[test]
    fn what_does_not_fit_is_scaled_up() {
        let measured = measured(72, 1.0, 8.0);
        let some = measured.scaled_from_headings.unwrap();
        assert!((1..=8).contains(&some), "{some}");
        assert_eq!(measured.found, None);
        assert!(measured.cpu_ms >= Some(72.0), "{:?}", measured.cpu_ms);
    }
}
