//! The transform from the map to the odometry, and others who publish it too.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use geometry::Pose;
use ros::{Header, TfMessage, Time, TransformStamped};

use crate::GatewayError;
use crate::rmw::{Member, Publisher};
use crate::stamps::{Forward, stamp};

/// Sent transforms that are known again when they come back: as many as slow subscribers keep.
const MAX_KNOWN: usize = 100;

/// Publishes the transform.
pub(crate) struct Broadcaster {
    transforms: Publisher<TfMessage>,
    forward: Forward,
    sent: Sent,
}

/// Stamps of the transforms that were sent last; its clones share them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sent(Rc<RefCell<VecDeque<Time>>>);

impl Broadcaster {
    pub(crate) fn open(member: &Member, topic: &str, sent: Sent) -> Result<Self, GatewayError> {
        Ok(Broadcaster {
            transforms: Publisher::open(member, topic, MAX_KNOWN)?,
            forward: Forward::default(),
            sent,
        })
    }

    /// Sends where the odometry's frame lies in the map, dated `at_ns`; whether it was sent:
    /// a date before the last one is left out.
    pub(crate) fn send(
        &mut self,
        at_ns: i64,
        (map_frame, odom_frame): (&str, &str),
        map_from_odom: Pose,
    ) -> Result<bool, GatewayError> {
        if !self.forward.admits(at_ns) {
            return Ok(false);
        }
        let message = transform(at_ns, map_frame, odom_frame, map_from_odom)?;
        self.sent.note(message.transforms[0].header.stamp);
        self.transforms.send(&message)?;
        Ok(true)
    }
}

impl Sent {
    fn note(&self, stamp: Time) {
        let mut stamps = self.0.borrow_mut();
        if stamps.len() == MAX_KNOWN {
            stamps.pop_front();
        }
        stamps.push_back(stamp);
    }

    /// Whether another node sent a transform to the odometry's frame while the gateway sends
    /// its own, which it receives as well.
    pub(crate) fn is_from_another(&self, received: &TransformStamped, odom_frame: &str) -> bool {
        let stamps = self.0.borrow();
        let is_its = received.child_frame_id.trim_start_matches('/') == odom_frame;
        is_its && !stamps.is_empty() && !stamps.contains(&received.header.stamp)
    }
}

/// The transform from the map to the odometry, `at_ns`.
fn transform(
    at_ns: i64,
    map_frame: &str,
    odom: &str,
    map_from_odom: Pose,
) -> Result<TfMessage, GatewayError> {
    let transform = TransformStamped {
        header: Header::new(stamp(at_ns)?, map_frame),
        child_frame_id: odom.to_owned(),
        transform: ros::planar::transform(map_from_odom),
    };
    Ok(TfMessage {
        transforms: vec![transform],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_ones_transform_is_told_from_ours() {
        let sent = Sent::default();
        let of = |at_ns| {
            let message = transform(at_ns, "map", "odom", Pose::IDENTITY).unwrap();
            message.transforms[0].clone()
        };
        // We send nothing yet: it is a particle filter's.
        assert!(!sent.is_from_another(&of(1), "odom"));
        for at_ns in 0..200 {
            sent.note(of(at_ns).header.stamp);
        }
        assert!(!sent.is_from_another(&of(150), "odom"));
        assert!(sent.is_from_another(&of(250), "odom"));
        assert!(!sent.is_from_another(&of(250), "base_link"));
    }
}
