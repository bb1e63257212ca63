//! Other methods of global localization for comparison: those of the paper's tables and their
//! faster variants, each optimized.
//!
//! | method | idea | sees through walls |
//! |---|---|---|
//! | [`RayCasting`] | Markov localization: rays cast from each pose | no |
//! | [`RangeTable`] | the same, with all ranges in a table | no |
//! | [`PatchCorrelation`] | the scan drawn as a patch, correlated with the map | yes |
//! | [`PlainCorrelation`] | the same pose by pose | yes |
//! | [`FieldCorrelation`] | end points looked up in a likelihood field | yes |
//! | [`MonteCarlo`] | particles in the engine's distance field, uniform at the start | yes |
//!
//! All but the last compute the score of every free cell at every requested heading. None
//! normalizes its posterior: the best pose does not depend on it, and omitting it only makes them
//! faster.

mod best;
mod clearance;
mod correlation;
mod field_correlation;
mod monte_carlo;
mod padded;
mod particles;
mod patch_correlation;
mod range_table;
mod ray_casting;
mod reading;
mod row_sums;

pub use best::Estimate;
pub use field_correlation::FieldCorrelation;
pub use monte_carlo::MonteCarlo;
pub use patch_correlation::{PatchCorrelation, PlainCorrelation};
pub use range_table::RangeTable;
pub use ray_casting::RayCasting;
pub use reading::{Reading, Readings};

pub trait Baseline {
    /// Returns the best pose at these headings, given in ascending order; ties go to the first by
    /// (heading, y, x). `None` if no cell is free.
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate>;

    fn bytes(&self) -> usize;
}

impl<B: Baseline + ?Sized> Baseline for &mut B {
    fn locate(&mut self, readings: &Readings, headings: &[usize]) -> Option<Estimate> {
        (**self).locate(readings, headings)
    }

    fn bytes(&self) -> usize {
        (**self).bytes()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use engine::space::Space;
    use engine::taper::TaperShape;

    use super::best::Best;
    use super::*;
    use crate::scans::{ScanConfig, simulate};
    use crate::worlds::{Kind, World};

    /// A world of 90 by 70 cells, its space, and three scans with errors of 10 %.
    pub(super) fn noisy(headings: u32, beams: usize) -> (World, Space, Vec<Readings>) {
        let world = World::generate(Kind::Rooms, (90, 70), 0.15, 4).unwrap();
        let space = world.space(headings).unwrap();
        let config = ScanConfig::new(beams, 10.0);
        let votes = config.votes(TaperShape::Trapezoid);
        let scans = simulate(&world, &space, &config, 3, 6).unwrap();
        let readings = scans
            .iter()
            .map(|scan| Readings::new(&scan.scan(), &space, &votes).unwrap());
        let readings = readings.collect();
        (world, space, readings)
    }

    /// The best of all poses by their plain scores.
    pub(super) fn best_of<S: Fn(i64, i64) -> u16>(
        world: &World,
        score_at: impl Fn(usize) -> S,
    ) -> Option<Estimate> {
        let mut plain = Best::default();
        for heading in 0..24 {
            let score_at = score_at(heading);
            for (x, y) in (0..70).flat_map(|y| (0..90).map(move |x| (x, y))) {
                if world.grid.is_open(x, y) {
                    let score = f32::from(score_at(x, y));
                    plain.take(Estimate::new(x as usize, y as usize, heading, score));
                }
            }
        }
        plain.get()
    }

    const EXACT: ScanConfig = ScanConfig::new(24, 0.0);

    /// Checks four scans in each kind of world, with and without their heading: all but `missed` of
    /// 24 are found within this many cells and one heading.
    #[track_caller]
    fn check<B: Baseline>(cells: usize, missed: usize, make: impl Fn(&World, &Space) -> B) {
        let mut far_off = Vec::new();
        for kind in [Kind::Rooms, Kind::Corridors, Kind::Boxes] {
            let world = World::generate(kind, (72, 60), 0.2, 5).unwrap();
            let space = world.space(48).unwrap();
            let votes = EXACT.votes(TaperShape::Trapezoid);
            let mut baseline = make(&world, &space);
            for scan in simulate(&world, &space, &EXACT, 4, 3).unwrap() {
                let readings = Readings::new(&scan.scan(), &space, &votes).unwrap();
                for headings in [vec![scan.heading], (0..48).collect()] {
                    let found = baseline.locate(&readings, &headings).unwrap();
                    let off = found.x.abs_diff(scan.x).max(found.y.abs_diff(scan.y));
                    let turned = (found.heading + 48 - scan.heading) % 48;
                    if off > cells || turned.min(48 - turned) > 1 {
                        far_off.push((kind, headings.len(), found));
                    }
                }
            }
        }
        assert!(far_off.len() <= missed, "{far_off:?}");
    }

    #[test]
    fn markov_localization_finds_the_true_pose() {
        check(0, 0, RayCasting::new);
        check(0, 0, RangeTable::new);
    }

    // These methods ignore obstacles along the beams, which misleads them now and then; and their
    // end points are rounded to cells.
    #[test]
    fn methods_that_see_through_walls_mostly_find_the_true_pose() {
        check(1, 4, PatchCorrelation::new);
        let field = |world: &World, space: &Space| FieldCorrelation::new(world, space, 1.0);
        check(1, 2, field);
        check(3, 6, |world, space| MonteCarlo::new(world, space, 1.0));
    }

    #[test]
    fn a_map_without_free_cells_has_no_pose() {
        use engine::grid::{CellRules, Grid};
        let grid = Grid::new(20, 16, &[100; 320], CellRules::default()).unwrap();
        let world = World {
            grid,
            boundary: Vec::new(),
        };
        let space = world.space(48).unwrap();
        let readings = Readings {
            beams: vec![Reading {
                bearing: 0,
                cells: 3.0,
                sigma_cells: 1.0,
            }],
        };
        let baselines: [Box<dyn Baseline>; 5] = [
            Box::new(RayCasting::new(&world, &space)),
            Box::new(RangeTable::new(&world, &space)),
            Box::new(PatchCorrelation::new(&world, &space)),
            Box::new(FieldCorrelation::new(&world, &space, 1.0)),
            Box::new(MonteCarlo::new(&world, &space, 1.0)),
        ];
        for mut baseline in baselines {
            assert_eq!(baseline.locate(&readings, &[0, 1]), None);
        }
    }
}
