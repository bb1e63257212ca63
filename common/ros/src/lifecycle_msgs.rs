//! `lifecycle_msgs`: states of a managed node, and the services that change them.

use super::Nothing;

declare! {
    part State = "lifecycle_msgs/State" [] {
        id: u8,
        label: String,
    }

    part Transition = "lifecycle_msgs/Transition" [] {
        id: u8,
        label: String,
    }

    call TransitionDescription {
        transition: Transition,
        start_state: State,
        goal_state: State,
    }

    /// `lifecycle_msgs/msg/TransitionEvent`: a completed transition.
    message TransitionEvent = "lifecycle_msgs/msg/TransitionEvent" [Transition, State] {
        /// Nanoseconds since 1970.
        timestamp: u64,
        transition: Transition,
        start_state: State,
        goal_state: State,
    }

    /// Requests a transition: by label, or if that is empty, by id.
    call ChangeStateRequest {
        transition: Transition,
    }

    /// Result of the transition.
    #[derive(Copy)]
    call ChangeStateResponse {
        /// True if the node is in the goal state.
        success: bool,
    }

    service ChangeState = "lifecycle_msgs/srv/ChangeState":
        ChangeStateRequest -> ChangeStateResponse;

    /// Current state.
    call GetStateResponse {
        current_state: State,
    }

    service GetState = "lifecycle_msgs/srv/GetState": Nothing -> GetStateResponse;

    call GetAvailableStatesResponse {
        available_states: Vec<State>,
    }

    service GetAvailableStates = "lifecycle_msgs/srv/GetAvailableStates":
        Nothing -> GetAvailableStatesResponse;

    /// Transitions from the current state, or all of them.
    call GetAvailableTransitionsResponse {
        available_transitions: Vec<TransitionDescription>,
    }

    service GetAvailableTransitions = "lifecycle_msgs/srv/GetAvailableTransitions":
        Nothing -> GetAvailableTransitionsResponse;
}
