//! Small maps for the tests of this crate.

use engine::Map;
use engine::grid::{CellRules, GridFrame};
use engine::vote_search::{Preparation, Prior, VoteSearchConfig};
use geometry::Pose;

pub(crate) const SIDES: (usize, usize) = (61, 40);

pub(crate) const FRAME: GridFrame = GridFrame::new(0.05, Pose::new(1.0, 2.0, 0.5));

/// Returns a room with a pillar, a box placed by `seed`, and an unknown part.
pub(crate) fn occupancy(seed: usize) -> Vec<u8> {
    let (width, height) = SIDES;
    let cell = |i: usize| {
        let (x, y) = (i % width, i / width);
        let is_wall = x == 0 || y == 0 || x == width - 1 || y == height - 1;
        let is_pillar = (20..24).contains(&x) && (9..14).contains(&y);
        let is_box = x == 30 + seed && y == 30;
        let is_unknown = x > 50 && y > 20;
        match (is_wall || is_pillar || is_box, is_unknown) {
            (true, _) => 100,
            (false, true) => 255,
            (false, false) => 0,
        }
    };
    (0..width * height).map(cell).collect()
}

pub(crate) fn map(frame: GridFrame, occupancy: &[u8], rules: CellRules) -> Map<'_> {
    let sides = SIDES;
    Map {
        frame,
        sides,
        occupancy,
        rules,
    }
}

pub(crate) fn preparation_with(seed: usize, config: VoteSearchConfig) -> Preparation {
    let cells = occupancy(seed);
    let map = map(FRAME, &cells, CellRules::default());
    Preparation::of_map(map, config, Prior::None).unwrap()
}

pub(crate) fn preparation(seed: usize) -> Preparation {
    let config = VoteSearchConfig {
        headings: 48,
        ..VoteSearchConfig::default()
    };
    preparation_with(seed, config)
}
