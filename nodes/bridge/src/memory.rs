//! How large a map from outside may be, so that the graph can hold it.
//!
//! A map of a few kilobytes on the network can be one that no search index fits into
//! memory for. Nothing is measured here: the bytes a cell takes are known.

/// What the nodes of a graph take for each cell of a map together, at most: the search
/// index, the distances of two nodes, and two maps on their way.
const BYTES_A_CELL: u64 = 150;

/// How many cells fit into so many bytes.
pub(crate) fn most_cells(limit: u64) -> u64 {
    limit / BYTES_A_CELL
}

/// The bytes that the graph of a map takes.
pub(crate) fn bytes_of(cells: u64) -> u64 {
    cells.saturating_mul(BYTES_A_CELL)
}

/// What this process and its neighbours may use: the limit of the control group, where
/// there is one, else the memory of the machine.
pub(crate) fn available() -> u64 {
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
}
