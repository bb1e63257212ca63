//! `lifecycle_msgs`: states of a managed node, and the services that change them.

use serde::{Deserialize, Serialize};

use super::definition::{definition, part};
use super::service::Nothing;
use super::{RosMessage, RosService};

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

#[derive(Debug)]
pub enum ChangeState {}

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

impl RosService for ChangeState {
    const NAME: &'static str = "lifecycle_msgs/srv/ChangeState";
    const REQUEST: &'static str = definition!("lifecycle_msgs/Transition transition\n", Transition);
    const RESPONSE: &'static str = "bool success\n";
    type Request = ChangeStateRequest;
    type Response = ChangeStateResponse;
}

#[derive(Debug)]
pub enum GetState {}

/// Current state.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetStateResponse {
    pub current_state: State,
}

impl RosService for GetState {
    const NAME: &'static str = "lifecycle_msgs/srv/GetState";
    const REQUEST: &'static str = "";
    const RESPONSE: &'static str = definition!("lifecycle_msgs/State current_state\n", State);
    type Request = Nothing;
    type Response = GetStateResponse;
}

#[derive(Debug)]
pub enum GetAvailableStates {}

#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetAvailableStatesResponse {
    pub available_states: Vec<State>,
}

impl RosService for GetAvailableStates {
    const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableStates";
    const REQUEST: &'static str = "";
    const RESPONSE: &'static str = definition!("lifecycle_msgs/State[] available_states\n", State);
    type Request = Nothing;
    type Response = GetAvailableStatesResponse;
}

#[derive(Debug)]
pub enum GetAvailableTransitions {}

/// Transitions from the current state, or all of them.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetAvailableTransitionsResponse {
    pub available_transitions: Vec<TransitionDescription>,
}

impl RosService for GetAvailableTransitions {
    const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableTransitions";
    const REQUEST: &'static str = "";
    const RESPONSE: &'static str = concat!(
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
    );
    type Request = Nothing;
    type Response = GetAvailableTransitionsResponse;
}
