//! Decides what follows when a process ends, and when the run is over. Pure: no clock, no process.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use command_line::wrong_use;
use dataflow::{Node, Restart, RestartPolicy};
use messages::{NodeState, Topic, topic};

/// Variable in a node's `env` that says if the graph ends when the node fails.
const ESSENTIAL: &str = "BACKCAST_ESSENTIAL";
/// Executables that are not needed for localization.
const ONLY_SHOW: [&str; 3] = ["foxglove_server", "monitor", "recorder"];

/// True if the graph ends with this node: by `BACKCAST_ESSENTIAL`, or else its executable.
pub fn is_essential(node: &Node) -> anyhow::Result<bool> {
    match node.env.iter().find(|(name, _)| name == ESSENTIAL) {
        None => Ok(!ONLY_SHOW.contains(&node.executable())),
        Some((_, value)) => value.parse().map_err(|_| {
            let id = &node.id;
            let allowed = "allowed are true (the graph ends with it) and false";
            wrong_use(format!("node {id}: {ESSENTIAL} is `{value}`; {allowed}"))
        }),
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    Well,
    /// It failed; a restart may help.
    Badly,
    /// It failed while shared memory was full, which is not its fault.
    Starved,
    /// It was started with wrong arguments; a restart does not help.
    Misused,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AfterEnd {
    Restart(Duration),
    Done,
    Failed,
}

#[derive(Debug, Clone)]
pub struct Restarts {
    rules: Restart,
    recent: VecDeque<Instant>,
    /// Number of restarts since it last worked for a while.
    in_a_row: u32,
}

impl Restarts {
    /// A process that worked for this long has recovered: the next failure starts a new row.
    pub const RECOVERED_AFTER: Duration = Duration::from_secs(2);
    /// Largest exponent of the delay's backoff, which keeps the shift in range.
    const MAX_DOUBLINGS: u32 = 16;

    pub fn new(rules: Restart) -> Self {
        Restarts {
            rules,
            recent: VecDeque::new(),
            in_a_row: 0,
        }
    }

    pub fn recent(&self) -> u32 {
        u32::try_from(self.recent.len()).unwrap_or(u32::MAX)
    }

    pub fn in_a_row(&self) -> u32 {
        self.in_a_row
    }

    /// Number of restarts that count: within the window or since it last worked, the larger.
    pub fn used(&self) -> u32 {
        self.recent().max(self.in_a_row)
    }

    /// Decides after the end of a process that was at work for `worked`; counts the restart.
    pub fn after_end(&mut self, ended: Ended, worked: Duration, now: Instant) -> AfterEnd {
        let wanted = match (self.rules.policy, ended) {
            (RestartPolicy::Never, _) | (_, Ended::Misused) => false,
            (RestartPolicy::OnFailure, ended) => ended != Ended::Well,
            (RestartPolicy::Always, _) => true,
        };
        if wanted && ended == Ended::Starved {
            return AfterEnd::Restart(self.rules.max_delay);
        }
        let old = |at: &Instant| now.saturating_duration_since(*at) > self.rules.window;
        while self.recent.front().is_some_and(old) {
            self.recent.pop_front();
        }
        if worked >= Self::RECOVERED_AFTER {
            self.in_a_row = 0;
        }
        let limit = self.rules.max_restarts;
        let used = match ended {
            Ended::Badly => self.used(),
            _ => self.recent(),
        };
        if wanted && (limit == 0 || used < limit) {
            let doublings = self.in_a_row.min(Self::MAX_DOUBLINGS);
            self.in_a_row = self.in_a_row.saturating_add(1);
            // Without a limit, the number is not needed.
            if limit > 0 {
                self.recent.push_back(now);
            }
            let delay = self.rules.delay.saturating_mul(1 << doublings);
            return AfterEnd::Restart(delay.min(self.rules.max_delay));
        }
        match ended {
            Ended::Well => AfterEnd::Done,
            Ended::Badly | Ended::Starved | Ended::Misused => AfterEnd::Failed,
        }
    }
}

/// Tracks a node's health messages and detects when they are overdue.
#[derive(Debug, Clone, Copy)]
pub struct Pulse {
    timeout: Duration,
    /// True if the node has to report: it is one of ours, or has reported before.
    is_expected: bool,
    reported: Option<Instant>,
    /// Start of the current silence: the last report, or an event that excuses a missing one.
    silent_since: Option<Instant>,
    /// Time at which its process first reported `Ready` or `Degraded`.
    at_work_since: Option<Instant>,
    is_busy: bool,
}

impl Pulse {
    /// Factor on the timeout for a busy node: five minutes instead of 15 s.
    const BUSY: u32 = 20;

    pub fn new(timeout: Duration, is_expected: bool) -> Self {
        Pulse {
            timeout,
            is_expected,
            reported: None,
            silent_since: None,
            at_work_since: None,
            is_busy: false,
        }
    }

    pub fn started(&mut self, now: Instant) {
        *self = Pulse {
            silent_since: self.is_expected.then_some(now),
            ..Pulse::new(self.timeout, self.is_expected)
        };
    }

    pub fn received(&mut self, state: Option<NodeState>, now: Instant) {
        self.is_expected = true;
        (self.reported, self.silent_since) = (Some(now), Some(now));
        self.is_busy = state == Some(NodeState::Busy);
        if matches!(state, Some(NodeState::Ready | NodeState::Degraded)) {
            self.at_work_since.get_or_insert(now);
        }
    }

    /// Restarts the timeout, as the node could not have reported until now.
    pub fn restart_timeout(&mut self, now: Instant) {
        if self.silent_since.is_some() {
            self.silent_since = Some(now);
        }
    }

    /// Returns the length of the silence if it exceeds the timeout.
    pub fn missed_for(&self, now: Instant) -> Option<Duration> {
        let silent = now.saturating_duration_since(self.silent_since?);
        let most = match self.is_busy {
            true => self.timeout.saturating_mul(Self::BUSY),
            false => self.timeout,
        };
        (silent > most).then_some(silent)
    }

    pub fn age(&self, now: Instant) -> Option<Duration> {
        Some(now.saturating_duration_since(self.reported?))
    }

    /// Returns how long the process has been at work; `None` if the node does not report.
    pub fn at_work_for(&self, now: Instant) -> Option<Duration> {
        let since = |at: Instant| now.saturating_duration_since(at);
        self.is_expected
            .then(|| self.at_work_since.map_or(Duration::ZERO, since))
    }
}

pub const MEASUREMENTS: [&str; 3] = [
    topic::Scan::NAME,
    topic::OdometryTopic::NAME,
    topic::GroundTruthTopic::NAME,
];

pub fn is_source(node: &Node) -> bool {
    let mut outputs = node.outputs.iter();
    outputs.any(|output| MEASUREMENTS.contains(&output.as_str()))
}

/// True if every source is done, or every node. Takes a pair for each node: is a source, is done.
pub fn is_over(nodes: impl Iterator<Item = (bool, bool)>) -> bool {
    let (mut sources, mut sources_done, mut all_done) = (0, 0, true);
    for (source, done) in nodes {
        sources += u32::from(source);
        sources_done += u32::from(source && done);
        all_done &= done;
    }
    all_done || (sources > 0 && sources == sources_done)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing::parsed;

    struct Course {
        restarts: Restarts,
        now: Instant,
    }

    impl Course {
        fn new(policy: RestartPolicy, max_restarts: u32, delay_ms: u64) -> Self {
            let rules = Restart {
                policy,
                max_restarts,
                delay: Duration::from_millis(delay_ms),
                ..Restart::DEFAULT
            };
            Course {
                restarts: Restarts::new(rules),
                now: Instant::now(),
            }
        }

        /// Ends the process after this many seconds of work.
        fn end_after(&mut self, seconds: u64, ended: Ended) -> AfterEnd {
            let worked = Duration::from_secs(seconds);
            self.now += worked;
            self.restarts.after_end(ended, worked, self.now)
        }

        fn end(&mut self, ended: Ended) -> AfterEnd {
            self.end_after(0, ended)
        }
    }

    const AT_ONCE: AfterEnd = AfterEnd::Restart(Duration::ZERO);

    #[test]
    fn policies_look_at_how_it_ended() {
        use RestartPolicy::{Always, Never, OnFailure};
        for (policy, well, badly) in [
            (Never, AfterEnd::Done, AfterEnd::Failed),
            (OnFailure, AfterEnd::Done, AT_ONCE),
            (Always, AT_ONCE, AT_ONCE),
        ] {
            let end = |ended| Course::new(policy, 0, 0).end(ended);
            assert_eq!(end(Ended::Well), well);
            assert_eq!(end(Ended::Badly), badly);
            assert_eq!(end(Ended::Misused), AfterEnd::Failed);
        }
    }

    #[test]
    fn restarts_run_out_within_the_window() {
        let mut two = Course::new(RestartPolicy::Always, 2, 0);
        let ends = [Ended::Badly, Ended::Well, Ended::Badly].map(|ended| two.end(ended));
        assert_eq!(ends, [AT_ONCE, AT_ONCE, AfterEnd::Failed]);
        assert_eq!(two.restarts.recent(), 2);
        assert_eq!(two.end(Ended::Well), AfterEnd::Done);
    }

    #[test]
    fn restarts_of_long_ago_do_not_count() {
        let mut rare = Course::new(RestartPolicy::OnFailure, 2, 0);
        for _ in 0..100 {
            assert_eq!(rare.end_after(31, Ended::Badly), AT_ONCE);
        }
        assert_eq!(rare.restarts.recent(), 2);
        assert_eq!(rare.end_after(1, Ended::Badly), AfterEnd::Failed);
    }

    #[test]
    fn without_a_limit_they_do_not_run_out() {
        let mut endless = Course::new(RestartPolicy::OnFailure, 0, 0);
        assert!((0..1000).all(|_| endless.end(Ended::Badly) == AT_ONCE));
        assert_eq!(endless.restarts.recent(), 0, "nothing is kept of them");
    }

    #[test]
    fn the_delay_doubles_up_to_the_longest_and_begins_again_after_good_work() {
        let mut delayed = Course::new(RestartPolicy::OnFailure, 0, 200);
        let mut delays = |seconds, times| -> Vec<u64> {
            let delay = |_| match delayed.end_after(seconds, Ended::Badly) {
                AfterEnd::Restart(delay) => u64::try_from(delay.as_millis()).unwrap(),
                other => panic!("{other:?}"),
            };
            (0..times).map(delay).collect()
        };
        assert_eq!(delays(0, 7), [200, 400, 800, 1600, 3200, 5000, 5000]);
        assert_eq!(delays(1, 20), [5000; 20]);
        assert_eq!(delays(2, 3), [200, 200, 200]);
    }

    #[test]
    fn failures_are_counted_since_it_last_worked_however_long_they_take() {
        let mut loops = Course::new(RestartPolicy::OnFailure, 15, 3000);
        for _ in 0..15 {
            // 0.3 s of life and 3 s to 5 s of waiting: never fifteen within the window.
            loops.now += Duration::from_secs(5);
            assert!(matches!(loops.end(Ended::Badly), AfterEnd::Restart(_)));
        }
        assert_eq!(loops.restarts.in_a_row(), 15);
        assert_eq!(loops.end(Ended::Badly), AfterEnd::Failed);
    }

    #[test]
    fn what_fails_for_want_of_memory_waits_and_is_not_counted() {
        let mut starved = Course::new(RestartPolicy::OnFailure, 1, 0);
        let longest = AfterEnd::Restart(Restart::DEFAULT.max_delay);
        assert!((0..100).all(|_| starved.end(Ended::Starved) == longest));
        assert_eq!(starved.restarts.recent(), 0);
        let never = Course::new(RestartPolicy::Never, 1, 0).end(Ended::Starved);
        assert_eq!(never, AfterEnd::Failed);
    }

    #[test]
    fn a_node_is_missed_when_it_stops_reporting_also_at_its_start_and_while_it_is_busy() {
        let start = Instant::now();
        let at = |seconds| start + Duration::from_secs(seconds);
        let timeout = Duration::from_secs(15);
        let mut foreign = Pulse::new(timeout, false);
        foreign.started(at(0));
        assert_eq!(foreign.missed_for(at(100)), None, "it need not report");
        assert_eq!(foreign.at_work_for(at(100)), None);
        let mut pulse = Pulse::new(timeout, true);
        pulse.started(at(0));
        assert_eq!(pulse.missed_for(at(15)), None);
        assert_eq!(pulse.missed_for(at(16)), Some(Duration::from_secs(16)));
        pulse.received(Some(NodeState::Ready), at(100));
        assert_eq!(pulse.missed_for(at(115)), None);
        assert_eq!(pulse.age(at(115)), Some(timeout));
        assert_eq!(pulse.missed_for(at(116)), Some(Duration::from_secs(16)));
        pulse.received(Some(NodeState::Busy), at(116));
        assert_eq!(pulse.at_work_for(at(117)), Some(Duration::from_secs(17)));
        assert_eq!(pulse.missed_for(at(416)), None, "it is busy");
        assert!(pulse.missed_for(at(417)).is_some(), "for too long");
        pulse.started(at(1000));
        assert_eq!(pulse.at_work_for(at(1014)), Some(Duration::ZERO));
        assert_eq!(pulse.missed_for(at(1014)), None);
        assert!(pulse.missed_for(at(1016)).is_some(), "anew, and silent");
        pulse.restart_timeout(at(1016));
        assert_eq!(pulse.missed_for(at(1020)), None);
    }

    #[test]
    fn what_only_shows_is_not_essential_unless_the_descriptor_says_so() {
        let essential = |node: &str| {
            let text = format!("nodes: [{{id: n, {node}}}]");
            let nodes = parsed(&text).nodes;
            is_essential(&nodes[0]).map_err(|error| error.to_string())
        };
        assert_eq!(essential("path: bin/accumulator"), Ok(true));
        assert_eq!(essential("path: bin/monitor"), Ok(false));
        let said = |value| format!("path: bin/monitor, env: {{BACKCAST_ESSENTIAL: {value}}}");
        assert_eq!(essential(&said("true")), Ok(true));
        assert_eq!(essential(&said("false")), Ok(false));
        let error = essential(&said("maybe")).unwrap_err();
        let expected = "node n: BACKCAST_ESSENTIAL is `maybe`";
        assert!(error.contains(expected), "{error}");
    }

    #[test]
    fn a_run_is_over_when_its_sources_are() {
        let over = |nodes: &[(bool, bool)]| is_over(nodes.iter().copied());
        assert!(over(&[(true, true), (false, false)]));
        assert!(!over(&[(true, true), (true, false), (false, true)]));
        assert!(!over(&[(false, true), (false, false)]));
        assert!(over(&[(false, true), (false, true)]));
    }
}
