//! Limits the size of a map to the memory of the graph.
//!
//! A file or message of a few kilobytes can be a map whose search index does not fit into memory.
//! Nothing is measured: the memory is estimated from the number of cells and the area to be
//! searched.

use std::path::{Path, PathBuf};

use messages::FREE_TO;

use crate::{MapError, OccupancyGrid};

/// Memory of all nodes of a graph for each cell of any map, in bytes: the message, a copy in each
/// node, and two distance fields.
const BYTES_A_CELL: u64 = 25;

/// Additional memory for each cell of the searched blocks, in bytes: the search index and its
/// preparation.
const BYTES_A_SEARCHED_CELL: u64 = 125;

/// Memory independent of the map, in bytes.
const BYTES_OF_ALL: u64 = 64 << 20;

/// Cells along a side of a search block.
const BLOCK: usize = 4;

/// Default distance from free cells up to which poses are searched, in metres.
const REACH_M: f64 = 1.0;

/// Option for the memory limit.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct MemoryOptions {
    /// Memory limit of the graph, megabytes; a map that needs more is rejected, and the previous
    /// one stays [default: the limit of the control group, or all memory of the machine]
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..))]
    pub memory_limit: Option<u64>,
}

/// Memory limit of the graph, and the memory taken by other maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryLimit {
    bytes: u64,
    taken: u64,
}

impl MemoryOptions {
    /// Returns the given limit, or that of the control group or machine.
    pub fn limit(&self) -> MemoryLimit {
        let given = self.memory_limit.map(|megabytes| megabytes << 20);
        MemoryLimit::of(given.unwrap_or_else(available))
    }
}

impl MemoryLimit {
    /// No limit, for tools that hold a map without an index.
    pub const NONE: MemoryLimit = MemoryLimit::of(u64::MAX);

    const fn of(bytes: u64) -> Self {
        MemoryLimit { bytes, taken: 0 }
    }

    /// Returns the limit for further maps in addition to `grid`.
    #[must_use]
    pub fn without(self, grid: &OccupancyGrid) -> Self {
        let sides = (grid.width, grid.height);
        let searched = searched_cells(sides, grid.resolution_m, &grid.cells);
        let of_map = needed(sides, searched) - BYTES_OF_ALL;
        MemoryLimit {
            taken: self.taken.saturating_add(of_map),
            ..self
        }
    }

    /// Checks a map by its sides alone, as if no cell were searched: for use before the cells are
    /// known.
    pub fn check(self, sides: (u32, u32)) -> Result<(), MapError> {
        self.check_searched(sides, 0)
    }

    pub fn check_grid(self, grid: &OccupancyGrid) -> Result<(), MapError> {
        let sides = (grid.width, grid.height);
        self.check_cells(sides, grid.resolution_m, &grid.cells)
    }

    pub fn check_cells(
        self,
        (width, height): (u32, u32),
        resolution_m: f64,
        cells: &[u8],
    ) -> Result<(), MapError> {
        let sides = (width, height);
        self.check_searched(sides, searched_cells(sides, resolution_m, cells))
    }

    fn check_searched(self, (width, height): (u32, u32), searched: u64) -> Result<(), MapError> {
        let needed = needed((width, height), searched);
        if needed.saturating_add(self.taken) <= self.bytes {
            return Ok(());
        }
        Err(MapError::Memory {
            width,
            height,
            needed_mb: needed >> 20,
            others_mb: self.taken >> 20,
            limit_mb: self.bytes >> 20,
        })
    }
}

/// Returns the memory of a map with this number of searched cells, in bytes.
fn needed((width, height): (u32, u32), searched: u64) -> u64 {
    let cells = u64::from(width) * u64::from(height);
    let of_all = BYTES_OF_ALL + cells.saturating_mul(BYTES_A_CELL);
    of_all.saturating_add(searched.saturating_mul(BYTES_A_SEARCHED_CELL))
}

fn searched_cells((width, _): (u32, u32), resolution_m: f64, cells: &[u8]) -> u64 {
    let reach = (REACH_M / resolution_m / BLOCK as f64).ceil() as usize;
    let blocks = near_free(width.max(1) as usize, cells, reach);
    blocks.saturating_mul(BLOCK * BLOCK).min(cells.len()) as u64
}

/// Counts the blocks that have a free cell, or are at most `reach` rows and columns of blocks from
/// one.
fn near_free(width: usize, cells: &[u8], reach: usize) -> usize {
    let columns = width.div_ceil(BLOCK);
    let rows: Vec<Vec<bool>> = cells
        .chunks(BLOCK * width)
        .map(|rows| {
            let mut free = vec![false; columns];
            for row in rows.chunks(width) {
                for (block, cells) in free.iter_mut().zip(row.chunks(BLOCK)) {
                    *block |= cells.iter().any(|&cell| cell <= FREE_TO);
                }
            }
            spread(&free, reach)
        })
        .collect();
    (0..columns)
        .map(|column| {
            let free: Vec<bool> = rows.iter().map(|row| row[column]).collect();
            spread(&free, reach).into_iter().filter(|&is| is).count()
        })
        .sum()
}

/// Returns which places are at most `reach` from a set one.
fn spread(set: &[bool], reach: usize) -> Vec<bool> {
    let mut near = vec![false; set.len()];
    // Places before this index are done.
    let mut end = 0;
    for (at, _) in set.iter().enumerate().filter(|(_, is)| **is) {
        let next = at.saturating_add(reach).saturating_add(1).min(set.len());
        near[at.saturating_sub(reach).max(end)..next].fill(true);
        end = next;
    }
    near
}

/// Returns the memory that this process may use: the minimum of the limits of its control group and
/// its ancestors, and the memory of the machine.
fn available() -> u64 {
    let read = |path: &Path| std::fs::read_to_string(path).unwrap_or_default();
    let files = limit_files(&read(Path::new("/proc/self/cgroup")));
    let limits: Vec<String> = files.iter().map(|file| read(file)).collect();
    decide(&limits, &read(Path::new("/proc/meminfo")))
}

/// Returns the limit files of control groups, which are listed as in `/proc/self/cgroup`: in
/// version 2 a line `0::PATH`, in version 1 one whose controllers have `memory`. In a container,
/// the group is the root of its own file system.
fn limit_files(groups: &str) -> Vec<PathBuf> {
    let of_line = |line: &str| {
        let (_, rest) = line.split_once(':')?;
        let (controllers, path) = rest.split_once(':')?;
        let (root, file) = match controllers {
            "" => ("/sys/fs/cgroup", "memory.max"),
            _ if controllers.split(',').any(|name| name == "memory") => {
                ("/sys/fs/cgroup/memory", "memory.limit_in_bytes")
            }
            _ => return None,
        };
        let path = Path::new(path.trim_start_matches('/'));
        // The last ancestor is the empty path.
        let folders = path.ancestors().map(|folder| Path::new(root).join(folder));
        Some(folders.map(|folder| folder.join(file)).collect::<Vec<_>>())
    };
    groups.lines().filter_map(of_line).flatten().collect()
}

fn decide(limits: &[String], machine: &str) -> u64 {
    let limits = limits
        .iter()
        .filter_map(|limit| limit.trim().parse::<u64>().ok());
    let total = machine
        .lines()
        .find_map(|line| line.strip_prefix("MemTotal:"));
    let kilobytes = total.and_then(|rest| rest.trim().strip_suffix("kB")?.trim().parse().ok());
    let machine = kilobytes.map(|found: u64| found.saturating_mul(1024));
    limits.chain(machine).min().unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use geometry::Pose;

    use super::*;
    use crate::UNKNOWN;

    #[test]
    fn the_smaller_of_group_and_machine_counts() {
        let machine = "MemFree: 1 kB\nMemTotal:       2048 kB\n";
        let decide = |limits: &[&str], machine| {
            let limits: Vec<String> = limits.iter().map(ToString::to_string).collect();
            super::decide(&limits, machine)
        };
        assert_eq!(decide(&["1000000\n"], machine), 1_000_000);
        assert_eq!(decide(&["max\n", "3000\n", "5000\n"], machine), 3000);
        assert_eq!(decide(&["max\n", ""], machine), 2 << 20);
        assert_eq!(decide(&["9223372036854771712"], machine), 2 << 20);
        assert_eq!(decide(&[], ""), u64::MAX);
    }

    #[test]
    fn limits_are_those_of_the_own_group_and_of_all_around_it() {
        let files = |groups: &str| -> Vec<String> {
            let files = limit_files(groups).into_iter();
            files
                .map(|file| file.to_str().unwrap().to_owned())
                .collect()
        };
        let root = "/sys/fs/cgroup";
        let second = "0::/system.slice/backcast.service\n";
        assert_eq!(
            files(second),
            [
                format!("{root}/system.slice/backcast.service/memory.max"),
                format!("{root}/system.slice/memory.max"),
                format!("{root}/memory.max"),
            ]
        );
        assert_eq!(files("0::/\n"), [format!("{root}/memory.max")]);
        let first = "12:cpu,cpuacct:/a\n9:memory:/a\n1:name=systemd:/a\nnonsense\n";
        assert_eq!(
            files(first),
            [
                format!("{root}/memory/a/memory.limit_in_bytes"),
                format!("{root}/memory/memory.limit_in_bytes"),
            ]
        );
    }

    #[test]
    fn a_map_beside_others_is_refused_with_what_they_take() {
        let memory_limit = Some(100);
        let mut limit = MemoryOptions { memory_limit }.limit();
        let free = OccupancyGrid::from_parts(400, 400, 0.05, Pose::default(), vec![0; 160_000]);
        let free = free.unwrap();
        assert!(limit.check_grid(&free).is_ok());
        limit = limit.without(&free);
        let error = limit.check_grid(&free).unwrap_err().to_string();
        // 22.9 MB each, and 64 MB.
        let expected = "a map of 400 x 400 cells takes about 86 MB in the graph, and the maps \
                        before it 22 MB; allowed are 100 MB (--memory-limit)";
        assert_eq!(error, expected);
    }

    #[test]
    fn what_is_searched_decides() {
        let memory_limit = Some(100);
        let limit = MemoryOptions { memory_limit }.limit();
        let sides = (800, 800);
        let mut cells = vec![UNKNOWN; 800 * 800];
        assert!(limit.check_cells(sides, 0.05, &cells).is_ok());
        cells[..800 * 400].fill(0);
        let error = limit.check_cells(sides, 0.05, &cells).unwrap_err();
        // 15.3 MB, 40.1 MB of the free half and of a metre beyond it, and 64 MB.
        let expected = "a map of 800 x 800 cells takes about 119 MB in the graph; allowed are \
                        100 MB (--memory-limit)";
        assert_eq!(error.to_string(), expected);
        cells[..800 * 400].fill(100);
        assert!(limit.check_cells(sides, 0.05, &cells).is_ok());
    }

    #[test]
    fn blocks_near_free_cells_are_counted() {
        let mut cells = vec![UNKNOWN; 42 * 23];
        assert_eq!(near_free(42, &cells, 2), 0);
        // In block (5, 3) of 11 x 6.
        cells[13 * 42 + 22] = 0;
        assert_eq!(near_free(42, &cells, 0), 1);
        assert_eq!(near_free(42, &cells, 2), 5 * 5);
        assert_eq!(near_free(42, &cells, 9), 11 * 6);
        // The last block, which is cut.
        cells[42 * 23 - 1] = 0;
        assert_eq!(near_free(42, &cells, 1), 9 + 4);
    }
}
