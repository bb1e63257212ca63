//! Services by which a lifecycle manager starts and stops the node, and the topic of its
//! transitions.

use ros::lifecycle_msgs::{
    ChangeState, ChangeStateResponse, GetAvailableStates, GetAvailableStatesResponse,
    GetAvailableTransitions, GetAvailableTransitionsResponse, GetState, GetStateResponse,
    TransitionEvent,
};
use transport::{TransportError, wall_ns};
use zenoh_session::Report;

use super::lifecycle::{self, Change, Lifecycle};
use crate::GatewayError;
use crate::rmw::{Member, Publisher, Service};

pub(super) struct Life {
    pub(super) lifecycle: Lifecycle,
    change: Service<ChangeState>,
    state: Service<GetState>,
    states: Service<GetAvailableStates>,
    transitions: Service<GetAvailableTransitions>,
    graph: Service<GetAvailableTransitions>,
    events: Publisher<TransitionEvent>,
}

impl Life {
    pub(super) fn open(member: &Member, node: &str) -> Result<Self, GatewayError> {
        let name = |service: &str| format!("{node}/{service}");
        Ok(Life {
            lifecycle: Lifecycle::new(),
            change: Service::open(member, &name("change_state"))?,
            state: Service::open(member, &name("get_state"))?,
            states: Service::open(member, &name("get_available_states"))?,
            transitions: Service::open(member, &name("get_available_transitions"))?,
            graph: Service::open(member, &name("get_transition_graph"))?,
            events: Publisher::open_blocking(member, &name("transition_event"), 10)?,
        })
    }

    /// Answers requests; `act` carries out a transition and returns true if it succeeded.
    pub(super) fn serve(
        &mut self,
        mut act: impl FnMut(Change) -> bool,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        self.change.serve(report, |request| {
            let success = match self.lifecycle.asked(&request.transition) {
                Ok(change) => turn(&mut self.lifecycle, &mut self.events, change, &mut act),
                Err(reason) => {
                    tracing::warn!("change_state refused: {reason}");
                    false
                }
            };
            ChangeStateResponse { success }
        })?;
        self.state.serve(report, |_| GetStateResponse {
            current_state: self.lifecycle.state(),
        })?;
        self.states.serve(report, |_| GetAvailableStatesResponse {
            available_states: lifecycle::states(),
        })?;
        self.transitions
            .serve(report, |_| GetAvailableTransitionsResponse {
                available_transitions: self.lifecycle.available(),
            })?;
        self.graph
            .serve(report, |_| GetAvailableTransitionsResponse {
                available_transitions: lifecycle::graph(),
            })?;
        Ok(())
    }

    pub(super) fn start(&mut self, mut act: impl FnMut(Change) -> bool) {
        for change in [Change::Configure, Change::Activate] {
            turn(&mut self.lifecycle, &mut self.events, change, &mut act);
        }
    }
}

fn turn(
    lifecycle: &mut Lifecycle,
    events: &mut Publisher<TransitionEvent>,
    change: Change,
    act: &mut impl FnMut(Change) -> bool,
) -> bool {
    let is_done = act(change);
    let timestamp = u64::try_from(wall_ns()).unwrap_or(0);
    for event in lifecycle.take(change, is_done, timestamp) {
        if let Err(error) = events.send(&event) {
            tracing::warn!("the transition is not published: {error}");
        }
    }
    tracing::info!(is_done, state = lifecycle.state().label, "{change:?}");
    is_done
}
