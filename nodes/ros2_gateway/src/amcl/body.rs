//! The part of the node that a lifecycle manager starts and stops.

mod parts;

use messages::{InitialPose, InitialPoseKind};
use transport::TransportError;
use zenoh_session::Report;

use super::bond::Bond;
use super::hint;
use super::lifecycle::{Change, Primary};
use super::parameters::Parameters;
use super::saved_pose;
use crate::GatewayError;
use crate::config::MAP_FRAME;
use crate::inputs::Inputs;
use crate::joined::{Joined, Results};
use parts::Parts;

pub(super) struct Body<'a> {
    joined: Joined<'a>,
    map_frame: &'a str,
    inputs: Inputs,
    parts: Option<Parts>,
    bond: Option<Bond>,
    /// Initial pose from a message, a service or the parameters; kept until it can be handed on.
    pending: Option<InitialPose>,
    is_active: bool,
    was_active: bool,
}

impl<'a> Body<'a> {
    pub(super) fn new(joined: Joined<'a>) -> Self {
        Body {
            joined,
            map_frame: joined.config.map_frame.as_deref().unwrap_or(MAP_FRAME),
            inputs: Inputs::default(),
            parts: None,
            bond: None,
            pending: None,
            is_active: false,
            was_active: false,
        }
    }

    /// Carries out a transition; returns true if that succeeded, which a shutdown always does.
    pub(super) fn change(&mut self, change: Change, parameters: &Parameters) -> bool {
        let outcome = match change {
            Change::Configure => Parts::open(self.joined, parameters).map(|parts| {
                self.parts = Some(parts);
            }),
            Change::Activate => self.activate(parameters),
            Change::Deactivate => self.deactivate(parameters),
            Change::Cleanup => {
                self.parts = None;
                Ok(())
            }
            Change::Shutdown => {
                let ended = self.deactivate(parameters);
                self.parts = None;
                ended
            }
        };
        if let Err(error) = &outcome {
            tracing::error!("{change:?} failed: {}", transport::with_causes(error));
        }
        outcome.is_ok() || change == Change::Shutdown
    }

    fn activate(&mut self, parameters: &Parameters) -> Result<(), GatewayError> {
        let joined = self.joined;
        let period_s = parameters.number("bond_heartbeat_period");
        if period_s > 0.0 {
            self.bond = Some(Bond::open(
                joined.member,
                &joined.topics.bond,
                joined.config.node(),
                period_s,
            )?);
        }
        let is_first = !std::mem::replace(&mut self.was_active, true);
        if self.pending.is_none() {
            self.pending = self.said_by(parameters, is_first);
        }
        // After the first activation, the tracker has a pose of its own.
        let saved = match is_first && self.pending.is_none() {
            true => self.saved(parameters),
            false => None,
        };
        if let Some(parts) = &mut self.parts {
            parts.offered = saved;
        }
        self.is_active = true;
        Ok(())
    }

    /// Returns the initial pose of the parameters, if this activation uses it.
    fn said_by(&self, parameters: &Parameters, is_first: bool) -> Option<InitialPose> {
        let is_again = is_first || parameters.is_on("always_reset_initial_pose");
        let is_said = parameters.is_on("set_initial_pose") && is_again;
        is_said.then(|| {
            let kind = self.joined.config.amcl.kind();
            hint::of_parameters(kind, parameters.initial_pose())
        })
    }

    fn saved(&self, parameters: &Parameters) -> Option<InitialPose> {
        if !parameters.is_on("initialize_at_saved_pose") {
            return None;
        }
        let path = parameters.saved_pose_file()?;
        let file = path.display();
        match saved_pose::load(path, self.map_frame) {
            Ok(Some(pose)) => {
                tracing::info!(
                    %file,
                    "the saved pose is tried first, and a scan must confirm it"
                );
                Some(hint::of_parameters(InitialPoseKind::Hint, pose))
            }
            Ok(None) => {
                tracing::info!(%file, "there is no saved pose: the whole map is searched");
                None
            }
            Err(error) => {
                let error = transport::with_causes(&error);
                tracing::warn!("{error}; the whole map is searched");
                None
            }
        }
    }

    fn deactivate(&mut self, parameters: &Parameters) -> Result<(), GatewayError> {
        self.is_active = false;
        if let Some(parts) = &mut self.parts {
            parts.rest(parameters, self.map_frame);
        }
        self.bond.take().map_or(Ok(()), Bond::end)
    }

    /// Handles all queued messages, according to the lifecycle state.
    pub(super) fn step(
        &mut self,
        results: &Results,
        state: Primary,
        parameters: &Parameters,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let (map_frame, pending) = (self.map_frame, &mut self.pending);
        if let Some(parts) = &mut self.parts {
            parts.take(parameters, map_frame, pending, report)?;
        }
        match &mut self.parts {
            Some(parts) if self.is_active => {
                parts.send(results, map_frame, parameters, pending, report)?;
            }
            _ => drain(results)?,
        }
        let taken = self.parts.as_ref().map(Parts::taken);
        self.inputs
            .look(self.joined, taken, missing(state), report)?;
        if let Some(bond) = &mut self.bond
            && let Err(error) = bond.tick()
        {
            report.refused(&error)?;
        }
        Ok(())
    }
}

/// Returns the reason for which the node waits in this lifecycle state.
fn missing(state: Primary) -> Option<&'static str> {
    match state {
        Primary::Unconfigured => {
            Some("a lifecycle manager: the node is unconfigured (--autostart needs none)")
        }
        Primary::Inactive => Some("a lifecycle manager: the node is inactive"),
        Primary::Finalized => Some("nothing any more: the node was shut down"),
        Primary::Active => None,
    }
}

fn drain(results: &Results) -> Result<(), TransportError> {
    while results.hypotheses.receive()?.is_some() {}
    while results.poses.receive()?.is_some() {}
    while results.health.receive()?.is_some() {}
    Ok(())
}
