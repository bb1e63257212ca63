//! `lifecycle_msgs`: states of a managed node, and the services that change them.

use serde::{Deserialize, Serialize};

use super::RosMessage;
use super::definition::{definition, part};
use super::service::{Nothing, service};

/// `lifecycle_msgs/msg/State`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct State {
    pub id: u8,
    pub label: String,
}

/// `lifecycle_msgs/msg/Transition`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Transition {
    pub id: u8,
    pub label: String,
}

/// `lifecycle_msgs/msg/TransitionDescription`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TransitionDescription {
    pub transition: Transition,
    pub start_state: State,
    pub goal_state: State,
}

/// `lifecycle_msgs/msg/TransitionEvent`: a completed transition.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TransitionEvent {
    /// Nanoseconds since 1970.
    pub timestamp: u64,
    pub transition: Transition,
    pub start_state: State,
    pub goal_state: State,
}

impl RosMessage for TransitionEvent {
    const SCHEMA: &'static str = "lifecycle_msgs/msg/TransitionEvent";
    const DEFINITION: &'static str = definition!(
        "\
uint64 timestamp
lifecycle_msgs/Transition transition
lifecycle_msgs/State start_state
lifecycle_msgs/State goal_state
",
        Transition,
        State,
    );
}

/// Requests a transition: by label, or if that is empty, by id.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ChangeStateRequest {
    pub transition: Transition,
}

/// Result of the transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ChangeStateResponse {
    /// True if the node is in the goal state.
    pub success: bool,
}

service!(
    ChangeState,
    "lifecycle_msgs/srv/ChangeState",
    ChangeStateRequest: definition!("lifecycle_msgs/Transition transition\n", Transition),
    ChangeStateResponse: "bool success\n",
);

/// Current state.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetStateResponse {
    pub current_state: State,
}

service!(
    GetState,
    "lifecycle_msgs/srv/GetState",
    Nothing: "",
    GetStateResponse: definition!("lifecycle_msgs/State current_state\n", State),
);

#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetAvailableStatesResponse {
    pub available_states: Vec<State>,
}

service!(
    GetAvailableStates,
    "lifecycle_msgs/srv/GetAvailableStates",
    Nothing: "",
    GetAvailableStatesResponse: definition!("lifecycle_msgs/State[] available_states\n", State),
);

/// Transitions from the current state, or all of them.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetAvailableTransitionsResponse {
    pub available_transitions: Vec<TransitionDescription>,
}

service!(
    GetAvailableTransitions,
    "lifecycle_msgs/srv/GetAvailableTransitions",
    Nothing: "",
    GetAvailableTransitionsResponse: concat!(
        "lifecycle_msgs/TransitionDescription[] available_transitions\n",
        part!(
            "\
lifecycle_msgs/TransitionDescription
lifecycle_msgs/Transition transition
lifecycle_msgs/State start_state
lifecycle_msgs/State goal_state
"
        ),
        part!(Transition),
        part!(State),
    ),
);
