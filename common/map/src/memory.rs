//! How large a map may be, so that the graph can hold it.
//!
//! A file or a message of a few kilobytes can be a map that no search index fits into
//! memory for. Nothing is measured here: the bytes that a cell takes are known.

use crate::MapError;

/// What the nodes of a graph take for each cell of a map together, at most: the search
/// index, the distances of two nodes, and two maps on their way.
const BYTES_A_CELL: u64 = 150;

/// The option by which a user says what a graph may use.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct MemoryOptions {
    /// Memory limit of the graph, megabytes; a map that needs more is rejected, and the
    /// previous one stays [default: the limit of the control group, or all memory of
    /// the machine]
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..))]
    pub memory_limit: Option<u64>,
}

/// What the graph may use, bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryLimit(u64);

impl MemoryOptions {
    /// As the option says, or else what there is.
    #[must_use]
    pub fn limit(&self) -> MemoryLimit {
        let given = self.memory_limit.map(|megabytes| megabytes << 20);
        MemoryLimit(given.unwrap_or_else(available))
    }
}

impl MemoryLimit {
    /// For tools that hold a map and no index of it.
    pub const NONE: MemoryLimit = MemoryLimit(u64::MAX);

    /// Whether the graph can hold a map with these sides.
    ///
    /// # Errors
    /// It cannot.
    pub fn check(self, (width, height): (u32, u32)) -> Result<(), MapError> {
        let cells = u64::from(width) * u64::from(height);
        let needed = cells.saturating_mul(BYTES_A_CELL);
        if needed <= self.0 {
            return Ok(());
        }
        Err(MapError::Memory {
            width,
            height,
            needed_mb: needed >> 20,
            limit_mb: self.0 >> 20,
        })
    }
}

/// What this process and its neighbours may use: the limit of the control group, where
/// there is one, else the memory of the machine.
fn available() -> u64 {
    let group = std::fs::read_to_string("/sys/fs/cgroup/memory.max");
    let machine = std::fs::read_to_string("/proc/meminfo");
    decide(&group.unwrap_or_default(), &machine.unwrap_or_default())
}

fn decide(group: &str, machine: &str) -> u64 {
    let group: Option<u64> = group.trim().parse().ok();
    let total = machine
        .lines()
        .find_map(|line| line.strip_prefix("MemTotal:"));
    let kilobytes = total.and_then(|rest| rest.trim().strip_suffix("kB")?.trim().parse().ok());
    let machine = kilobytes.map(|found: u64| found.saturating_mul(1024));
    group.into_iter().chain(machine).min().unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smaller_of_group_and_machine_counts() {
        let machine = "MemFree: 1 kB\nMemTotal:       2048 kB\n";
        assert_eq!(decide("1000000\n", machine), 1_000_000);
        assert_eq!(decide("max\n", machine), 2 << 20);
        assert_eq!(decide("9000000000", machine), 2 << 20);
        assert_eq!(decide("", ""), u64::MAX);
    }

    #[test]
    fn a_map_that_takes_more_is_refused_with_the_figures() {
        let memory_limit = Some(100);
        let limit = MemoryOptions { memory_limit }.limit();
        assert!(limit.check((800, 800)).is_ok());
        let error = limit.check((8000, 8000)).unwrap_err().to_string();
        let expected = "a map of 8000 x 8000 cells takes about 9155 MB in the graph; allowed are \
                        100 MB (--memory-limit)";
        assert_eq!(error, expected);
        assert!(MemoryLimit::NONE.check((32_767, 32_767)).is_ok());
    }
}
