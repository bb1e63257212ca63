//! Formats the state of a graph as text. Pure.

use std::fmt::Write;

use crate::run::control::{NodeStatus, Status};

pub(super) fn status(status: &Status) -> String {
    let Status {
        graph,
        pid,
        descriptor,
        uptime_s,
        ..
    } = status;
    let mut text = format!(
        "graph {graph}: {descriptor}, launcher is process {pid}, up {}\n",
        duration(*uptime_s)
    );
    for node in &status.nodes {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", line(node));
    }
    if let Some(file) = &status.recording.file {
        let size_mb = status.recording.size_mb.unwrap_or_default();
        let _ = writeln!(text, "  recording to {file}, {size_mb:.1} MB");
    }
    let failing = status.nodes.iter().filter_map(|node| node.fails.as_ref());
    for sentence in status.given_up.iter().chain(failing) {
        let _ = writeln!(text, "  {sentence}");
    }
    text
}

fn line(node: &NodeStatus) -> String {
    let pid = node.pid.map_or("-".to_owned(), |pid| pid.to_string());
    let up = node.uptime_s.map_or("-".to_owned(), duration);
    let mut line = format!("  {:<20} {:<18} {pid:>8} {up:>10}", node.id, node.state);
    if let Some(age) = node.reported_s {
        let _ = write!(line, "  reported {} ago", duration(age));
    }
    if node.restarts > 0 {
        let _ = write!(line, "  restarts {}", node.restarts);
    }
    if let Some(end) = &node.last_end {
        let _ = write!(line, "  last ended with {end}");
    }
    line
}

/// Formats a duration with its two largest units, e.g. `3 d 4 h`.
fn duration(seconds: u64) -> String {
    let (minutes, hours, days) = (seconds / 60, seconds / 3600, seconds / 86_400);
    if days > 0 {
        format!("{days} d {} h", hours % 24)
    } else if hours > 0 {
        format!("{hours} h {} min", minutes % 60)
    } else if minutes > 0 {
        format!("{minutes} min {} s", seconds % 60)
    } else {
        format!("{seconds} s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_two_units() {
        let all = [5, 65, 3_700, 100_000].map(duration);
        assert_eq!(all, ["5 s", "1 min 5 s", "1 h 1 min", "1 d 3 h"]);
    }
}
