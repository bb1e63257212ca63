//! Detection of the events on which the last minutes are saved.

use std::collections::BTreeSet;

use messages::{HealthHeader, NodeState, TrackState, Verdict};

/// Number of consecutive scans without a place after which the pose counts as lost.
const LOST_AFTER: u32 = 5;

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Event {
    /// The tracker lost the pose; without a tracker, five consecutive scans without a place after
    /// one was known
    LostPose,
    /// A node became degraded
    Degraded,
}

impl std::fmt::Display for Event {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Event::LostPose => "the pose was lost",
            Event::Degraded => "a node is degraded",
        })
    }
}

#[derive(Debug, Default)]
pub(crate) struct EventDetector {
    /// Number of scans since the last known place; `None` before a place is known and after its
    /// loss was reported.
    unknown_for: Option<u32>,
    tracked: Option<TrackState>,
    degraded: BTreeSet<String>,
}

impl EventDetector {
    pub(crate) fn verdict(&mut self, code: u32) -> Option<Event> {
        if self.tracked.is_some() {
            return None;
        }
        if Verdict::from_code(code) == Some(Verdict::Unique) {
            self.unknown_for = Some(0);
            return None;
        }
        let scans = self.unknown_for.as_mut()?;
        *scans += 1;
        if *scans < LOST_AFTER {
            return None;
        }
        self.unknown_for = None;
        Some(Event::LostPose)
    }

    pub(crate) fn state(&mut self, code: u32) -> Option<Event> {
        let state = TrackState::from_code(code)?;
        let before = self.tracked.replace(state);
        let is_lost = state == TrackState::Lost && before != Some(TrackState::Lost);
        is_lost.then_some(Event::LostPose)
    }

    pub(crate) fn health(&mut self, report: &HealthHeader) -> Option<Event> {
        let node = report.node.as_str();
        if report.state != NodeState::Degraded as u32 {
            self.degraded.remove(node);
            return None;
        }
        let is_new = self.degraded.insert(node.to_owned());
        is_new.then_some(Event::Degraded)
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::Name;

    use super::*;

    #[test]
    fn a_pose_is_lost_once_and_only_after_it_was_known() {
        let mut detector = EventDetector::default();
        let mut lost = |verdicts: &[Verdict]| -> Vec<usize> {
            let events = verdicts
                .iter()
                .map(|verdict| detector.verdict(*verdict as u32));
            let seen = events.enumerate().filter(|(_, event)| event.is_some());
            seen.map(|(at, _)| at).collect()
        };
        assert!(lost(&[Verdict::PoorFit; 9]).is_empty());
        assert!(lost(&[Verdict::Unique]).is_empty());
        assert!(lost(&[Verdict::Ambiguous; 4]).is_empty());
        assert!(lost(&[Verdict::Unique]).is_empty());
        assert_eq!(lost(&[Verdict::PoorFit; 20]), [4]);
    }

    #[test]
    fn where_there_is_a_tracker_it_says_when_the_pose_is_lost() {
        let mut detector = EventDetector::default();
        assert_eq!(detector.verdict(Verdict::Unique as u32), None);
        let states = [
            TrackState::Searching,
            TrackState::Unique,
            TrackState::Doubtful,
            TrackState::Lost,
            TrackState::Lost,
            TrackState::Unique,
            TrackState::Lost,
        ];
        let events = states.map(|state| detector.state(state as u32));
        let lost = Some(Event::LostPose);
        assert_eq!(events, [None, None, None, lost, None, None, lost]);
        let verdicts = [Verdict::Ambiguous; 20].map(|verdict| detector.verdict(verdict as u32));
        assert!(verdicts.iter().all(Option::is_none));
    }

    #[test]
    fn a_node_is_reported_when_it_becomes_degraded() {
        let mut detector = EventDetector::default();
        let mut receive = |node: &str, state: NodeState| {
            detector.health(&HealthHeader {
                node: Name::new(node),
                state: state as u32,
                ..HealthHeader::zeroed()
            })
        };
        assert_eq!(receive("a", NodeState::Ready), None);
        assert_eq!(receive("a", NodeState::Degraded), Some(Event::Degraded));
        assert_eq!(receive("a", NodeState::Degraded), None);
        assert_eq!(receive("b", NodeState::Degraded), Some(Event::Degraded));
        assert_eq!(receive("a", NodeState::Ready), None);
        assert_eq!(receive("a", NodeState::Degraded), Some(Event::Degraded));
    }
}
