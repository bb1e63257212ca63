//! How the robot's frames lie to each other: the laser on the base, and the base in the
//! odometry's frame. Pure.
//!
//! Refuses lasers that do not look level, and more frames than a robot has.

use std::collections::VecDeque;

use geometry::{Mount, Pose};
use messages::{HypothesesHeader, Hypothesis, Odometry};
use recording::ros::TfMessage;
use recording::{MAX_TILT_DEGREES, TransformTree};

use crate::GatewayError;

/// Odometry that is kept until the hypotheses of its scan come.
const KEPT: usize = 256;

/// Most frames: a robot has some dozens.
const MAX_FRAMES: usize = 1000;

/// Most bytes of a frame's name.
const MAX_NAME: usize = 256;

/// What is known of the frames.
#[derive(Debug)]
pub(crate) struct Frames {
    fixed: TransformTree,
    /// What the user says.
    given: Option<Mount>,
    /// The laser that was asked for last, and its mount; none after a change.
    laser: Option<(String, Option<Mount>)>,
    odometry: VecDeque<Odometry>,
}

impl Frames {
    pub(crate) fn new(given: Option<Mount>) -> Self {
        Frames {
            fixed: TransformTree::default(),
            given,
            laser: None,
            odometry: VecDeque::with_capacity(KEPT),
        }
    }

    /// Takes transforms that never change.
    pub(crate) fn hear_fixed(&mut self, message: &TfMessage) -> Result<(), GatewayError> {
        for transform in &message.transforms {
            let names = [&transform.header.frame_id, &transform.child_frame_id];
            if let Some(frame) = names.into_iter().find(|name| name.len() > MAX_NAME) {
                return Err(GatewayError::FrameName {
                    found: frame.len(),
                    most: MAX_NAME,
                });
            }
            if self.fixed.children() >= MAX_FRAMES {
                return Err(GatewayError::Frames {
                    frame: transform.child_frame_id.clone(),
                    most: MAX_FRAMES,
                });
            }
            self.laser = None;
            self.fixed.add(transform)?;
        }
        Ok(())
    }

    pub(crate) fn hear_odometry(&mut self, odometry: &Odometry) {
        if self.odometry.len() == KEPT {
            self.odometry.pop_front();
        }
        self.odometry.push_back(*odometry);
    }

    /// Where the laser of this frame sits on the base, if that is known.
    pub(crate) fn base_from_laser(&mut self, laser: &str) -> Result<Option<Mount>, GatewayError> {
        if let Some((known, mount)) = &self.laser
            && known == laser
        {
            return Ok(*mount);
        }
        let mount = match (self.given, self.fixed.base_from(laser)) {
            (Some(given), _) => Some(given),
            (None, Some(mount)) if mount.tilt_degrees > MAX_TILT_DEGREES => {
                return Err(GatewayError::Tilted {
                    laser: laser.to_owned(),
                    base: mount.base_frame,
                    tilt_degrees: mount.tilt_degrees,
                });
            }
            (None, mount) => mount.map(|mount| Mount {
                base_from_laser: mount.base_from_laser,
                is_upside_down: mount.upside_down,
            }),
        };
        if let Some(mount) = mount {
            tracing::info!(
                laser,
                x = mount.base_from_laser.x,
                y = mount.base_from_laser.y,
                yaw = mount.base_from_laser.yaw,
                upside_down = mount.is_upside_down,
                "the mount"
            );
        }
        self.laser = Some((laser.to_owned(), mount));
        Ok(mount)
    }

    /// Where the odometry's frame lies in the map, and its name, by the best
    /// hypothesis of a scan; none where the odometry is of a frame that is not
    /// known to belong to the laser.
    pub(crate) fn map_from_odom(
        &self,
        header: &HypothesesHeader,
        best: &Hypothesis,
    ) -> Option<(Pose, String)> {
        let odometry = self.odometry_at(header.stamp.measured_ns)?;
        let child = odometry.child_frame.as_str();
        let map_from_laser = Pose::from(best.map_from_laser);
        let laser = self.laser.as_ref().map(|(laser, _)| laser.as_str());
        let laser_from_child = match laser {
            Some(laser) if laser == child => Some(Pose::IDENTITY),
            Some(laser) => self.fixed.laser_from(laser, child),
            None => None,
        };
        let map_from_child = match laser_from_child {
            Some(laser_from_child) => map_from_laser.then(laser_from_child),
            // What moves in the odometry's frame is the base, by whatever name.
            None if header.mount_known != 0 => best.map_from_base.into(),
            None => return None,
        };
        let odom_from_child = Pose::from(odometry.odom_from_child);
        let map_from_odom = map_from_child.then(odom_from_child.inverse());
        Some((map_from_odom, odometry.frame.as_str().to_owned()))
    }

    /// The newest odometry up to this time, else the first.
    fn odometry_at(&self, measured_ns: i64) -> Option<&Odometry> {
        let by_then = |odometry: &&Odometry| odometry.stamp.measured_ns <= measured_ns;
        let newest = self.odometry.iter().rev().find(by_then);
        newest.or(self.odometry.front())
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{FrameName, Pose2};
    use recording::ros::{Header, Quaternion, Transform, TransformStamped, Vector3};

    use super::*;

    fn fixed(parent: &str, child: &str, x: f64, rotation: Quaternion) -> TfMessage {
        let transform = TransformStamped {
            header: Header {
                frame_id: parent.to_owned(),
                ..Header::default()
            },
            child_frame_id: child.to_owned(),
            transform: Transform {
                translation: Vector3 { x, y: 0.0, z: 0.0 },
                rotation,
            },
        };
        TfMessage {
            transforms: vec![transform],
        }
    }

    fn at(x: f64) -> Pose2 {
        Pose2 {
            x,
            y: 0.0,
            yaw: 0.0,
        }
    }

    fn odometry(child: &str, x: f64) -> Odometry {
        Odometry {
            odom_from_child: at(x),
            frame: FrameName::new("odom"),
            child_frame: FrameName::new(child),
            ..Odometry::zeroed()
        }
    }

    fn mounted(x: f64) -> Mount {
        Mount {
            base_from_laser: Pose::new(x, 0.0, 0.0),
            is_upside_down: false,
        }
    }

    #[test]
    fn the_mount_comes_with_the_transforms_or_from_the_user() {
        let mut frames = Frames::new(None);
        assert_eq!(frames.base_from_laser("laser").unwrap(), None);
        let mount = fixed("base_link", "laser", 0.5, Quaternion::default());
        frames.hear_fixed(&mount).unwrap();
        let found = frames.base_from_laser("laser").unwrap();
        assert_eq!(found, Some(mounted(0.5)));
        let mut frames = Frames::new(Some(mounted(9.0)));
        frames.hear_fixed(&mount).unwrap();
        let found = frames.base_from_laser("laser").unwrap();
        assert_eq!(found, Some(mounted(9.0)));
    }

    #[test]
    fn a_tilted_laser_and_too_many_frames_are_refused() {
        let mut frames = Frames::new(None);
        let half = 0.5f64.sqrt();
        let tilted = Quaternion {
            x: half,
            y: 0.0,
            z: 0.0,
            w: half,
        };
        frames
            .hear_fixed(&fixed("base_link", "laser", 0.5, tilted))
            .unwrap();
        let error = frames.base_from_laser("laser").unwrap_err().to_string();
        assert!(error.contains("tilted by 90.0"), "{error}");
        let long = fixed("base_link", &"f".repeat(257), 0.5, Quaternion::default());
        let error = frames.hear_fixed(&long).unwrap_err().to_string();
        assert!(error.contains("257 bytes"), "{error}");
        let mut refused = 0;
        for i in 0..2 * MAX_FRAMES {
            let child = fixed("base_link", &format!("f{i}"), 0.5, Quaternion::default());
            refused += usize::from(frames.hear_fixed(&child).is_err());
        }
        assert_eq!(refused, MAX_FRAMES + 1);
    }

    #[test]
    fn the_odometry_lies_where_the_hypothesis_says() {
        let header = HypothesesHeader {
            mount_known: 1,
            ..HypothesesHeader::zeroed()
        };
        let best = Hypothesis {
            map_from_laser: at(10.0),
            map_from_base: at(9.5),
            ..Hypothesis::zeroed()
        };
        let check = |child: &str, expected: Option<f64>, header: &HypothesesHeader| {
            let mut frames = Frames::new(None);
            let mount = fixed("base_link", "laser", 0.5, Quaternion::default());
            frames.hear_fixed(&mount).unwrap();
            frames.base_from_laser("laser").unwrap();
            frames.hear_odometry(&odometry(child, 4.0));
            let found = frames.map_from_odom(header, &best);
            assert_eq!(found.map(|(pose, _)| pose.x), expected, "{child}");
        };
        check("base_link", Some(5.5), &header);
        check("laser", Some(6.0), &header);
        check("base_footprint", Some(5.5), &header);
        check("base_footprint", None, &HypothesesHeader::zeroed());
        let nobody = Frames::new(None);
        assert_eq!(nobody.map_from_odom(&header, &best), None);
    }
}
