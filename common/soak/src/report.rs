//! Report of a run, as text and as JSON. Pure.

use std::fmt::Write;

use schemars::JsonSchema;
use serde::Serialize;

use super::launched::Losses;
use super::recorded::Recorded;
use super::tally::{FaultFigures, Gap, PoseFigures};
use super::usage::{Span, Usage};

/// All figures of a run.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(super) struct Report {
    /// Duration of the run.
    pub(super) seconds: f64,
    /// Seed of the random numbers.
    pub(super) seed: u64,
    #[serde(flatten)]
    pub(super) poses: PoseFigures,
    /// From the summaries of launchers that ended regularly; a killed one prints none.
    #[serde(flatten)]
    pub(super) losses: Losses,
    pub(super) faults: Vec<FaultFigures>,
    /// Time from the end of a killed launcher to that of its last node, in seconds.
    pub(super) nodes_ended_s: Gap,
    /// Number of restarts of nodes.
    pub(super) restarts: u64,
    pub(super) usage: Usage,
    /// Figures of the recording; `None` without `--record`.
    pub(super) recorded: Option<Recorded>,
    /// Files that were left after the end.
    pub(super) leftovers: Vec<String>,
    /// Failures in addition to wrong poses and leftovers.
    pub(super) failures: Vec<String>,
}

impl Report {
    /// True if the graph met its guarantees.
    pub(super) fn is_good(&self) -> bool {
        self.poses.wrong == 0 && self.leftovers.is_empty() && self.failures.is_empty()
    }

    pub(super) fn json(&self) -> String {
        json::object(self) + "\n"
    }

    /// Formats the figures for the terminal.
    pub(super) fn text(&self) -> String {
        let Report { poses, losses, .. } = self;
        let mut text = format!(
            "{:.0} s, seed {}\n\
             poses      {}, judged {}, Unique {}, of them wrong {}\n\
             scans      {}, answered {}, dropped samples {}, refused {}\n\
             restarts   {}\n\n",
            self.seconds,
            self.seed,
            poses.poses,
            poses.judged,
            poses.unique,
            poses.wrong,
            losses.scans,
            losses.answered,
            losses.dropped,
            losses.refused,
            self.restarts,
        );
        faults(&mut text, &self.faults);
        if let Some(max) = self.nodes_ended_s.max {
            let _ = writeln!(
                text,
                "nodes of a killed launcher ended after {max:.2} s at most"
            );
        }
        latencies(&mut text, poses);
        usage(&mut text, &self.usage);
        if let Some(Recorded {
            parts,
            cut,
            messages,
        }) = self.recorded
        {
            let _ = writeln!(
                text,
                "recorded: {messages} messages in {parts} parts, {cut} of them cut off"
            );
        }
        for wrong in &poses.first_wrong {
            let _ = writeln!(
                text,
                "wrong: {:.1} s after the start, scan {}: {:.2} m and {:.1} deg off",
                wrong.after_s, wrong.stamp_ns, wrong.off_m, wrong.off_deg
            );
        }
        for file in &self.leftovers {
            let _ = writeln!(text, "left behind: {file}");
        }
        for failure in &self.failures {
            let _ = writeln!(text, "failed: {failure}");
        }
        let verdict = match self.is_good() {
            true => "no pose was wrong, all recovered, nothing was left behind",
            false => "the graph did not meet its guarantees",
        };
        text.push_str(verdict);
        text.push('\n');
        text
    }
}

// Writing to a string cannot fail.

fn faults(text: &mut String, faults: &[FaultFigures]) {
    if faults.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "{:<10} {:>6} {:>7} {:>24} {:>24}",
        "fault", "times", "killed", "next pose s median  max", "Unique pose s median  max"
    );
    for effect in faults {
        let _ = writeln!(
            text,
            "{:<10} {:>6} {:>7} {:>17} {:>6} {:>17} {:>6}",
            effect.fault.name(),
            effect.times,
            effect.killed,
            number(effect.to_pose_s.median),
            number(effect.to_pose_s.max),
            number(effect.to_unique_s.median),
            number(effect.to_unique_s.max),
        );
    }
    text.push('\n');
}

fn latencies(text: &mut String, poses: &PoseFigures) {
    let mut line = |name: &str, values: Vec<Option<f64>>| {
        let values = values.into_iter().map(|ms| format!(" {:>7}", number(ms)));
        let _ = writeln!(text, "{name}{}", values.collect::<String>());
    };
    let parts = &poses.latency_ms;
    line(
        "latency ms by tenths, p50",
        parts.iter().map(|part| part.p50).collect(),
    );
    line(
        "                      p99",
        parts.iter().map(|part| part.p99).collect(),
    );
    text.push('\n');
}

fn usage(text: &mut String, usage: &Usage) {
    let _ = writeln!(
        text,
        "{:<20} {:>8} {:>8} {:>8}   {:>6} {:>6} {:>6}",
        "memory MB", "start", "end", "peak", "files", "end", "peak"
    );
    for (node, taken) in &usage.nodes {
        let memory = columns(taken.memory_mb, 8, 1);
        let files = columns(taken.descriptors, 6, 0);
        let _ = writeln!(text, "{node:<20}{memory}  {files}");
    }
    let shared = columns(usage.shared_memory_mb, 8, 1);
    let _ = writeln!(text, "{:<20}{shared}\n", "/dev/shm");
}

fn columns(span: Option<Span>, width: usize, decimals: usize) -> String {
    let values = span.map_or([None; 3], |span| {
        [span.start, span.end, span.peak].map(Some)
    });
    let column = |value: Option<f64>| match value {
        Some(value) => format!(" {value:>width$.decimals$}"),
        None => format!(" {:>width$}", "-"),
    };
    values.map(column).concat()
}

fn number(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.2}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::Fault;
    use statistics::Tail;

    fn report() -> Report {
        let gap = |median, max| Gap {
            median: Some(median),
            max: Some(max),
        };
        Report {
            seconds: 120.4,
            seed: 7,
            poses: PoseFigures {
                poses: 350,
                judged: 340,
                unique: 300,
                wrong: 0,
                first_wrong: Vec::new(),
                latency_ms: vec![
                    Tail {
                        p50: Some(2.5),
                        p99: None,
                    };
                    2
                ],
            },
            losses: Losses {
                scans: 360,
                answered: 350,
                dropped: 3,
                refused: 0,
            },
            faults: vec![FaultFigures {
                fault: Fault::Kill,
                times: 20,
                killed: 20,
                to_pose_s: gap(0.25, 0.75),
                to_unique_s: gap(1.0, 2.0),
            }],
            nodes_ended_s: Gap {
                median: None,
                max: None,
            },
            restarts: 20,
            usage: Usage::default(),
            recorded: Some(Recorded {
                parts: 3,
                cut: 1,
                messages: 400,
            }),
            leftovers: Vec::new(),
            failures: Vec::new(),
        }
    }

    #[test]
    fn the_table_is_aligned_and_ends_with_the_verdict() {
        let expected = "\
120 s, seed 7
poses      350, judged 340, Unique 300, of them wrong 0
scans      360, answered 350, dropped samples 3, refused 0
restarts   20

fault       times  killed  next pose s median  max Unique pose s median  max
kill           20      20              0.25   0.75              1.00   2.00

latency ms by tenths, p50    2.50    2.50
                      p99       -       -

memory MB               start      end     peak    files    end   peak
/dev/shm                    -        -        -

recorded: 400 messages in 3 parts, 1 of them cut off
no pose was wrong, all recovered, nothing was left behind
";
        assert_eq!(report().text(), expected);
    }

    #[test]
    fn wrong_poses_leftovers_and_failures_are_no_success() {
        assert!(report().is_good());
        let mut wrong = report();
        wrong.poses.wrong = 1;
        let mut left = report();
        left.leftovers.push("/dev/shm/x".into());
        let mut failed = report();
        failed.failures.push("no pose".into());
        for report in [wrong, left, failed] {
            assert!(!report.is_good());
            assert!(
                report
                    .text()
                    .ends_with("the graph did not meet its guarantees\n")
            );
        }
    }
}
