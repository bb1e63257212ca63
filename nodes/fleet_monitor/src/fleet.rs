//! Robots that were discovered.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use dashboard::{Abilities, Request, Robot, Robots};
use messages::{Topic, topic};
use network_payload::{Arrival, Arrivals, Preamble, Wire};
use transport::{Graph, monotonic_ns};
use zenoh::Session;

use crate::FleetError;
use crate::feed::{Feed, FleetMessage};
use crate::requests::Requests;

pub(crate) struct Fleet {
    robots: Robots,
    session: Session,
    /// Session id by which robots recognize this process.
    sender: u64,
    members: BTreeMap<String, Member>,
}

struct Member {
    robot: Arc<Robot>,
    requested: Receiver<Request>,
    requests: Requests,
    /// Sequence numbers received, by topic name.
    arrivals: BTreeMap<&'static str, Arrivals>,
    /// Subscription to the image, which is computed only while it is viewed.
    field: Option<Feed<topic::Field>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Taken {
    Shown {
        /// Number of messages of this sender lost before it.
        lost: u64,
    },
    Repeated,
}

/// Passes a message to its robot, or returns what is wrong with it.
pub(crate) type Show<T> =
    fn(&Robot, &<T as Topic>::Header, &[<T as Topic>::Item]) -> Result<(), &'static str>;

/// The result of showing a message that is only shown if it is sound.
pub(crate) fn sound(is_sound: bool, problem: &'static str) -> Result<(), &'static str> {
    is_sound.then_some(()).ok_or(problem)
}

const SHOW_FIELD: Show<topic::Field> = |robot, header, pixels| {
    sound(
        robot.on_field(header, pixels),
        "the image contradicts its header",
    )
};

impl Fleet {
    pub(crate) fn new(robots: Robots, session: Session, sender: u64) -> Self {
        Fleet {
            robots,
            session,
            sender,
            members: BTreeMap::new(),
        }
    }

    /// Shows a message, and adds its robot if it is new.
    pub(crate) fn take<T: Wire>(
        &mut self,
        received: &FleetMessage<T>,
        show: Show<T>,
    ) -> Result<Taken, FleetError> {
        if !self.members.contains_key(&received.robot) {
            self.welcome(&received.robot)?;
        }
        let member = self.members.get_mut(&received.robot);
        let member = member.ok_or_else(|| FleetError::TooMany {
            robot: received.robot.clone(),
        })?;
        member.take(received, show)
    }

    fn welcome(&mut self, name: &str) -> Result<(), FleetError> {
        let (robot, requested) = Robot::new(name.to_owned(), None);
        if !self.robots.add(Arc::clone(&robot)) {
            let robot = name.to_owned();
            return Err(FleetError::TooMany { robot });
        }
        tracing::info!(robot = name, "robot discovered");
        let member = Member {
            robot,
            requested,
            requests: Requests::open(&self.session, name, self.sender)?,
            arrivals: BTreeMap::new(),
            field: None,
        };
        self.members.insert(name.to_owned(), member);
        Ok(())
    }

    /// Detects silent nodes, opens and closes images, and forwards requests; returns the result of
    /// each request.
    pub(crate) fn tick(
        &mut self,
        graph: &Graph,
    ) -> Result<Vec<Result<(), FleetError>>, FleetError> {
        let mut granted = Vec::new();
        for (name, member) in &mut self.members {
            member.robot.look_for_silence(monotonic_ns());
            member.robot.on_abilities(member.requests.abilities());
            match (member.robot.is_field_viewed(), &member.field) {
                (true, None) => {
                    member.field = Some(Feed::open(&self.session, name, graph.waker()?)?);
                }
                (false, Some(_)) => member.field = None,
                _ => {}
            }
            while let Ok(request) = member.requested.try_recv() {
                granted.push(member.grant(request));
            }
        }
        Ok(granted)
    }

    /// Shows the images that are viewed, of any robot; returns the result of each.
    pub(crate) fn take_fields(&mut self) -> Vec<Result<Taken, FleetError>> {
        let mut outcomes = Vec::new();
        for member in self.members.values_mut() {
            let Some(field) = member.field.take() else {
                continue;
            };
            // A slow reader wants the newest image, so skipped ones are no loss.
            for received in field.waiting() {
                let received = received.map_err(FleetError::from);
                outcomes.push(received.and_then(|received| member.take(&received, SHOW_FIELD)));
            }
            member.field = Some(field);
        }
        outcomes
    }
}

impl Member {
    fn take<T: Wire>(
        &mut self,
        received: &FleetMessage<T>,
        show: Show<T>,
    ) -> Result<Taken, FleetError> {
        let message = &received.message;
        let Preamble {
            sender, sequence, ..
        } = message.preamble;
        let arrivals = self.arrivals.entry(T::NAME).or_default();
        let lost = match arrivals.note(sender, sequence) {
            Arrival::Repeated => return Ok(Taken::Repeated),
            // A kept message is complete in itself; missing earlier ones are no loss.
            Arrival::New { .. } if T::KEPT => 0,
            Arrival::New { lost } => lost,
        };
        let shown = show(&self.robot, &message.header, &message.items);
        shown.map_err(|problem| FleetError::Unusable {
            problem,
            robot: received.robot.clone(),
        })?;
        Ok(Taken::Shown { lost })
    }

    fn grant(&mut self, request: Request) -> Result<(), FleetError> {
        let robot = self.robot.name();
        match request {
            Request::Region(corners) => {
                tracing::info!(robot, corners = corners.len(), "search region set");
                self.requests.region(&corners)?;
                self.robot.on_region(corners);
                Ok(())
            }
            Request::Save => {
                tracing::info!(robot, "asking the recorder to save the last minutes");
                self.requests.save()
            }
            // They are refused before, as the launcher takes no request from other machines.
            Request::Restart(_) | Request::Record(_) => Ok(()),
            Request::Hint(pose) => {
                tracing::info!(
                    robot,
                    x = pose.x,
                    y = pose.y,
                    yaw = pose.yaw,
                    "hint for the tracker"
                );
                self.requests.hint(pose)
            }
        }
    }
}

impl Requests {
    fn abilities(&self) -> Abilities {
        let [region, save, hint] = self.subscribed();
        Abilities {
            region,
            save,
            hint,
            restart: false,
        }
    }
}
