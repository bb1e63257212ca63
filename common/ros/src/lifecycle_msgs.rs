//! `lifecycle_msgs`: states of a managed node, and the services that change them.

use serde::{Deserialize, Serialize};

use super::definition::{definition, part};
use super::service::Nothing;
use super::{RosMessage, RosService};

/// `lifecycle_msgs/msg/State`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct State {
    /// Its number.
    pub id: u8,
    /// Its name.
    pub label: String,
}

/// `lifecycle_msgs/msg/Transition`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Transition {
    /// Its number.
    pub id: u8,
    /// Its name.
    pub label: String,
}

/// `lifecycle_msgs/msg/TransitionDescription`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TransitionDescription {
    /// The transition.
    pub transition: Transition,
    /// Where it begins.
    pub start_state: State,
    /// Where it leads.
    pub goal_state: State,
}

/// A transition that took place.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TransitionEvent {
    /// Nanoseconds since 1970.
    pub timestamp: u64,
    /// The transition.
    pub transition: Transition,
    /// Where it began.
    pub start_state: State,
    /// Where it led.
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

/// `lifecycle_msgs/srv/ChangeState`.
#[derive(Debug)]
pub enum ChangeState {}

/// Asks for a transition: by name where there is one, else by number.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ChangeStateRequest {
    /// The transition.
    pub transition: Transition,
}

/// Whether the transition took place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ChangeStateResponse {
    /// Whether the node is in the goal state.
    pub success: bool,
}

impl RosService for ChangeState {
    const NAME: &'static str = "lifecycle_msgs/srv/ChangeState";
    const REQUEST: &'static str = definition!("lifecycle_msgs/Transition transition\n", Transition);
    const RESPONSE: &'static str = "bool success\n";
    type Request = ChangeStateRequest;
    type Response = ChangeStateResponse;
}

/// `lifecycle_msgs/srv/GetState`.
#[derive(Debug)]
pub enum GetState {}

/// The state now.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetStateResponse {
    /// The state.
    pub current_state: State,
}

impl RosService for GetState {
    const NAME: &'static str = "lifecycle_msgs/srv/GetState";
    const REQUEST: &'static str = "";
    const RESPONSE: &'static str = definition!("lifecycle_msgs/State current_state\n", State);
    type Request = Nothing;
    type Response = GetStateResponse;
}

/// `lifecycle_msgs/srv/GetAvailableStates`.
#[derive(Debug)]
pub enum GetAvailableStates {}

/// All states.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetAvailableStatesResponse {
    /// The states.
    pub available_states: Vec<State>,
}

impl RosService for GetAvailableStates {
    const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableStates";
    const REQUEST: &'static str = "";
    const RESPONSE: &'static str = definition!("lifecycle_msgs/State[] available_states\n", State);
    type Request = Nothing;
    type Response = GetAvailableStatesResponse;
}

/// `lifecycle_msgs/srv/GetAvailableTransitions`.
#[derive(Debug)]
pub enum GetAvailableTransitions {}

/// Transitions: of the state now, or all of them.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct GetAvailableTransitionsResponse {
    /// The transitions.
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
