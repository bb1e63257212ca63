//! The search compared with the plain reference on a part of a real map, with a real scan. The
//! reference looks at every pose, which takes too long on a larger map.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use engine::accumulator::{Accumulator, Query};
use engine::grid::{Cell, CellRules, Grid};
use engine::program::{ScanProgram, VoteConfig};
use engine::reference;
use engine::search::SearchIndex;
use engine::space::Space;
use engine::sweep::FieldSweep;
use engine::votes::CollectConfig;
use tests::world::{World, as_engine_takes_it};

/// The part in cells: the corridor around the pose of the scan.
const LEFT: usize = 1120;
const BOTTOM: usize = 62;
const WIDTH: usize = 96;
const HEIGHT: usize = 72;

/// A heading for each 5°: a fifth of the poses of a search at 1°.
const HEADINGS: u32 = 72;

fn piece(grid: &Grid) -> Grid {
    let rows = (BOTTOM..BOTTOM + HEIGHT).map(|y| &grid.cells()[y * grid.width() + LEFT..][..WIDTH]);
    let occupancy: Vec<u8> = rows
        .flatten()
        .map(|&cell| if cell == Cell::Occupied { 100 } else { 0 })
        .collect();
    Grid::new(WIDTH, HEIGHT, &occupancy, CellRules::default()).unwrap()
}

#[test]
fn on_a_piece_of_a_real_map_all_methods_count_the_same_votes() {
    let world = World::of("malaga_corridor");
    let (whole, frame) = world.grid();
    let grid = piece(&whole);
    assert!(
        grid.occupied_cells() > 200,
        "the piece shows walls: {}",
        grid.occupied_cells()
    );
    let space = Space::new(HEADINGS, frame.resolution_m, WIDTH, HEIGHT).unwrap();
    let index = SearchIndex::new(&grid, &space);
    let sweeps = FieldSweep::new(&grid);
    let (mut sweep, mut swept) = (sweeps.accumulator(), Vec::new());
    let scan = &world.scans()[18];
    let program = ScanProgram::new(
        &as_engine_takes_it(scan),
        0.0,
        &space,
        &VoteConfig::default(),
    )
    .unwrap();
    let config = CollectConfig::default();
    let found = index
        .search(&grid, &program, &space, config, &|| false)
        .unwrap();
    assert!(found.best > 0);

    let mut above_floor = 0;
    for heading in 0..space.directions.count() {
        let plain = reference::field(&grid, &program, &space, heading);
        let query = Query {
            program: &program,
            space: &space,
            heading,
        };
        sweep.fill(query, &mut swept, &|| false).unwrap();
        assert_eq!(swept, plain, "heading {heading}");
        above_floor += plain
            .iter()
            .filter(|&&votes| votes >= found.certified_floor)
            .count();
        for vote in found
            .votes
            .iter()
            .filter(|vote| usize::from(vote.heading) == heading)
        {
            assert_eq!(
                plain[usize::from(vote.y) * WIDTH + usize::from(vote.x)],
                vote.intensity
            );
        }
    }
    let certified = found.votes.iter();
    let certified = certified.filter(|vote| vote.intensity >= found.certified_floor);
    assert_eq!(
        certified.count(),
        above_floor,
        "nothing is missing above the floor"
    );
}
