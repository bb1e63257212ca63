//! A recording and its map, and the engine on that map.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use engine::grid::{CellRules, Grid, GridFrame};
use engine::scan::Scan;
use engine::vote_search::{Prior, VoteSearch, VoteSearchConfig};
use messages::{FrameName, ScanHeader};
use recording::{GroundTruth, Kind, Message, Recording};
use ros::LaserScan;
use ros::measurements::scan_header;

/// One of the recordings in the repository.
pub struct World {
    pub folder: PathBuf,
}

impl World {
    pub fn of(name: &str) -> Self {
        World {
            folder: crate::root().join("recordings").join(name),
        }
    }

    pub fn recording(&self) -> PathBuf {
        self.folder.join("recording.mcap")
    }

    pub fn map(&self) -> PathBuf {
        self.folder.join("map.yaml")
    }

    /// Returns the engine with its default settings, on this map.
    pub fn vote_search(&self, prior: Prior) -> VoteSearch {
        let map = map::load(self.map()).unwrap();
        let frame = GridFrame::new(map.resolution_m, map.map_from_grid);
        let (width, height) = (map.width as usize, map.height as usize);
        let grid = Grid::new(width, height, &map.cells, CellRules::default()).unwrap();
        VoteSearch::new(frame, grid, VoteSearchConfig::default(), prior).unwrap()
    }

    pub fn scans(&self) -> Vec<LaserScan> {
        scans_of(&self.recording())
    }

    /// Returns the true pose of the laser at each scan, by the scan's stamp in nanoseconds.
    pub fn truths(&self) -> BTreeMap<i64, GroundTruth> {
        let recording = Recording::open(self.recording()).unwrap();
        recording.ground_truths().unwrap()
    }
}

pub fn scans_of(recording: &Path) -> Vec<LaserScan> {
    let recording = Recording::open(recording).unwrap();
    let messages = recording.records_of(&[Kind::Scan]);
    let scans = messages.map(|record| match record.unwrap().message {
        Message::Scan(scan) => scan,
        other => panic!("asked for scans, got {:?}", other.kind()),
    });
    scans.collect()
}

/// Returns the header of a recorded scan in the graph's form, sent now.
pub fn as_the_graph_has_it(scan: &LaserScan, counter: u64) -> ScanHeader {
    let mut header = scan_header(scan, FrameName::new("laser"), None);
    header.stamp.entered_ns = transport::monotonic_ns();
    header.stamp.counter = counter;
    header
}

/// Returns a recorded scan in the engine's form.
pub fn as_engine_takes_it(scan: &LaserScan) -> Scan<'_> {
    Scan {
        angle_min: f64::from(scan.angle_min),
        angle_increment: f64::from(scan.angle_increment),
        range_min_m: scan.range_min,
        range_max_m: scan.range_max,
        ranges: &scan.ranges,
    }
}
