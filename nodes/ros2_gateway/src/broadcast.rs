//! The transform from map to odometry, and detection of other nodes that publish it.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use geometry::Pose;
use ros::{Header, TfMessage, Time, TransformStamped};

use crate::GatewayError;
use crate::rmw::{Keeping, Member, Publisher};
use crate::stamps::{Forward, stamp};

/// Number of sent transforms that are recognised when they come back: as many as slow subscribers
/// keep.
const MAX_KNOWN: usize = 100;

pub(crate) struct Broadcaster {
    transforms: Publisher<TfMessage>,
    forward: Forward,
    sent: Sent,
}

/// Stamps of the last transforms that were sent; clones share them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sent(Rc<RefCell<VecDeque<Time>>>);

impl Broadcaster {
    pub(crate) fn open(member: &Member, topic: &str, sent: Sent) -> Result<Self, GatewayError> {
        Ok(Broadcaster {
            transforms: Publisher::open(member, topic, Keeping::Reliable, MAX_KNOWN)?,
            forward: Forward::default(),
            sent,
        })
    }

    /// Sends the pose of the odometry's frame in the map, stamped `at_ns`. Returns false if it is
    /// left out because the stamp is not later than the last one.
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

    /// True if another node sent a transform to the odometry's frame while the gateway sends its
    /// own, which it receives as well.
    pub(crate) fn is_from_another(&self, received: &TransformStamped, odom_frame: &str) -> bool {
        let stamps = self.0.borrow();
        let is_its = received.child_frame_id.trim_start_matches('/') == odom_frame;
        is_its && !stamps.is_empty() && !stamps.contains(&received.header.stamp)
    }
}

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
        // Nothing was sent yet: the transform is that of a particle filter.
        assert!(!sent.is_from_another(&of(1), "odom"));
        for at_ns in 0..200 {
            sent.note(of(at_ns).header.stamp);
        }
        assert!(!sent.is_from_another(&of(150), "odom"));
        assert!(sent.is_from_another(&of(250), "odom"));
        assert!(!sent.is_from_another(&of(250), "base_link"));
    }
}
