//! Lifecycle of a managed node: states and transitions, with the numbers and names of
//! `lifecycle_msgs`. Pure.
//!
//! Rejects transitions that do not begin in the state that the node is in.

use ros::lifecycle_msgs::{State, Transition, TransitionDescription, TransitionEvent};

/// A state in which a node stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Primary {
    Unconfigured = 1,
    Inactive = 2,
    Active = 3,
    Finalized = 4,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    Configure,
    Cleanup,
    Activate,
    Deactivate,
    Shutdown,
}

/// All states by number, including those in the course of a transition.
const STATES: [(u8, &str); 11] = [
    (0, "unknown"),
    (1, "unconfigured"),
    (2, "inactive"),
    (3, "active"),
    (4, "finalized"),
    (10, "configuring"),
    (11, "cleaningup"),
    (12, "shuttingdown"),
    (13, "activating"),
    (14, "deactivating"),
    (15, "errorprocessing"),
];

struct Asked {
    id: u8,
    label: &'static str,
    start: Primary,
    /// State in between.
    way: u8,
    change: Change,
    goal: Primary,
}

const ASKED: [Asked; 7] = {
    use {Change as C, Primary as P};
    const fn row(id: u8, label: &'static str, way: u8, ends: (P, P), change: C) -> Asked {
        let (start, goal) = ends;
        Asked {
            id,
            label,
            start,
            way,
            change,
            goal,
        }
    }
    let (unconfigured, inactive, active) = (P::Unconfigured, P::Inactive, P::Active);
    [
        row(1, "configure", 10, (unconfigured, inactive), C::Configure),
        row(2, "cleanup", 11, (inactive, unconfigured), C::Cleanup),
        row(3, "activate", 13, (inactive, active), C::Activate),
        row(4, "deactivate", 14, (active, inactive), C::Deactivate),
        row(5, "shutdown", 12, (unconfigured, P::Finalized), C::Shutdown),
        row(6, "shutdown", 12, (inactive, P::Finalized), C::Shutdown),
        row(7, "shutdown", 12, (active, P::Finalized), C::Shutdown),
    ]
};

/// Transitions that end a state in between: number, name, start and goal.
const ENDS: [(u8, &str, u8, u8); 18] = [
    (10, SUCCESS, 10, 2),
    (11, FAILURE, 10, 1),
    (12, ERROR, 10, 15),
    (20, SUCCESS, 11, 1),
    (21, FAILURE, 11, 2),
    (22, ERROR, 11, 15),
    (30, SUCCESS, 13, 3),
    (31, FAILURE, 13, 2),
    (32, ERROR, 13, 15),
    (40, SUCCESS, 14, 2),
    (41, FAILURE, 14, 3),
    (42, ERROR, 14, 15),
    (50, SUCCESS, 12, 4),
    (51, FAILURE, 12, 4),
    (52, ERROR, 12, 15),
    (60, SUCCESS, 15, 1),
    (61, FAILURE, 15, 4),
    (62, ERROR, 15, 4),
];
const SUCCESS: &str = "transition_success";
const FAILURE: &str = "transition_failure";
const ERROR: &str = "transition_error";

#[derive(Debug)]
pub(crate) struct Lifecycle {
    pub(super) state: Primary,
}

impl Lifecycle {
    pub(crate) fn new() -> Self {
        Lifecycle {
            state: Primary::Unconfigured,
        }
    }

    pub(crate) fn state(&self) -> State {
        state(self.state as u8)
    }

    /// Finds the requested transition: by name if there is one, else by number.
    pub(crate) fn asked(&self, wanted: &Transition) -> Result<Change, String> {
        let from_here = ASKED.iter().filter(|row| row.start == self.state);
        let is_wanted = |row: &&Asked| match &*wanted.label {
            "" => row.id == wanted.id,
            label => row.label == label,
        };
        let found = from_here.clone().find(is_wanted);
        found.map(|row| row.change).ok_or_else(|| {
            let allowed: Vec<String> = from_here
                .map(|r| format!("{} ({})", r.label, r.id))
                .collect();
            let (id, label) = (wanted.id, &wanted.label);
            let (here, allowed) = (self.state().label, allowed.join(", "));
            format!("transition {id} {label:?} in state {here}: allowed are {allowed}")
        })
    }

    /// Goes to the next state, or stays if the change failed; returns the events to publish.
    pub(crate) fn take(
        &mut self,
        change: Change,
        is_done: bool,
        timestamp: u64,
    ) -> Vec<TransitionEvent> {
        let is_this = |r: &&Asked| r.start == self.state && r.change == change;
        let Some(row) = ASKED.iter().find(is_this) else {
            return Vec::new();
        };
        let word = if is_done { SUCCESS } else { FAILURE };
        let end = ENDS.iter().find(|end| end.2 == row.way && end.1 == word);
        // A shutdown always succeeds.
        let goal = if is_done { row.goal } else { row.start };
        let first = (row.id, row.label, row.start as u8, row.way);
        let last = end.map(|end| (end.0, end.1, end.2, goal as u8));
        self.state = goal;
        [Some(first), last]
            .into_iter()
            .flatten()
            .map(|row| {
                let described = described(row);
                TransitionEvent {
                    timestamp,
                    transition: described.transition,
                    start_state: described.start_state,
                    goal_state: described.goal_state,
                }
            })
            .collect()
    }

    pub(crate) fn available(&self) -> Vec<TransitionDescription> {
        let here = self.state as u8;
        let all = graph().into_iter();
        all.filter(|t| t.start_state.id == here).collect()
    }
}

pub(crate) fn states() -> Vec<State> {
    STATES.iter().map(|(id, _)| state(*id)).collect()
}

pub(crate) fn graph() -> Vec<TransitionDescription> {
    let asked = ASKED.iter().map(|r| (r.id, r.label, r.start as u8, r.way));
    asked.chain(ENDS).map(described).collect()
}

fn described((id, label, start, goal): (u8, &str, u8, u8)) -> TransitionDescription {
    TransitionDescription {
        transition: Transition {
            id,
            label: label.to_owned(),
        },
        start_state: state(start),
        goal_state: state(goal),
    }
}

fn state(id: u8) -> State {
    let label = STATES.iter().find(|(other, _)| *other == id);
    State {
        id,
        label: label.map_or("unknown", |(_, label)| label).to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(life: &Lifecycle, id: u8, label: &str) -> Result<Change, String> {
        let label = label.to_owned();
        life.asked(&Transition { id, label })
    }

    #[test]
    fn a_node_goes_through_its_life_by_numbers_and_by_names() {
        let mut life = Lifecycle::new();
        assert_eq!(life.state().label, "unconfigured");
        let way = [
            (1, "", "inactive"),
            (3, "", "active"),
            (0, "deactivate", "inactive"),
            (0, "cleanup", "unconfigured"),
            (1, "configure", "inactive"),
            (6, "", "finalized"),
        ];
        for (id, label, state) in way {
            let change = ask(&life, id, label).unwrap();
            let events = life.take(change, true, 5);
            assert_eq!(life.state().label, state);
            assert_eq!(events.len(), 2);
            assert_eq!(events[1].transition.label, SUCCESS);
            assert_eq!(events[1].goal_state.label, state);
        }
        assert!(life.available().is_empty());
    }

    #[test]
    fn what_does_not_begin_here_is_refused_and_names_what_does() {
        let mut life = Lifecycle::new();
        for id in [0, 2, 3, 4, 6, 7, 8, 10, 255] {
            let reason = ask(&life, id, "").unwrap_err();
            assert!(
                reason.contains("unconfigured: allowed are configure (1), shutdown (5)"),
                "{reason}"
            );
        }
        assert!(ask(&life, 1, "activate").is_err(), "the name counts");
        let events = life.take(Change::Configure, false, 5);
        assert_eq!(events[1].transition.id, 11);
        assert_eq!(life.state().label, "unconfigured");
        assert!(life.take(Change::Activate, true, 5).is_empty());
    }
}
