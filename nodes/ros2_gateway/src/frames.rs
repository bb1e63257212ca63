//! The transforms between the robot's frames: the laser on the base, and the base in the
//! odometry's frame. Pure.
//!
//! Refuses lasers that look neither level nor upside down, and more frames than a robot
//! has.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use geometry::{Mount, Pose};
use messages::{HypothesesHeader, Hypothesis, Odometry};
use recording::{MAX_TILT_DEGREES, TransformTree};
use ros::{TfMessage, TransformStamped};

use crate::GatewayError;

/// Odometry that is kept until the hypotheses of its scan come.
const KEPT: usize = 256;

/// Most frames: a robot has some dozens.
const MAX_FRAMES: usize = 1000;

/// Most bytes of a frame's name.
const MAX_NAME: usize = 256;

/// Most mounts that are kept: a robot has some lasers, each with one frame.
const MAX_MOUNTS: usize = 64;

/// What is known of the frames.
#[derive(Debug)]
pub(crate) struct Frames {
    fixed: TransformTree,
    /// Children whose transform was mended, which is said once.
    mended: BTreeSet<String>,
    /// What the user says of each laser; empty where the transforms say it.
    given: Vec<Mount>,
    /// By laser and its frame, those that were asked for since the last change.
    mounts: BTreeMap<(usize, String), Option<Mount>>,
    /// The frame of the first laser, the one that hypotheses are about.
    first: Option<String>,
    odometry: VecDeque<Odometry>,
}

impl Frames {
    pub(crate) fn new(given: Vec<Mount>) -> Self {
        Frames {
            fixed: TransformTree::default(),
            mended: BTreeSet::new(),
            given,
            mounts: BTreeMap::new(),
            first: None,
            odometry: VecDeque::with_capacity(KEPT),
        }
    }

    /// Takes transforms that never change. One that cannot be used does not keep the
    /// others from being taken.
    ///
    /// # Errors
    /// What is wrong with the first that cannot be used.
    pub(crate) fn on_static_transforms(&mut self, message: &TfMessage) -> Result<(), GatewayError> {
        let outcomes: Vec<_> = message.transforms.iter().map(|t| self.add(t)).collect();
        outcomes.into_iter().collect()
    }

    fn add(&mut self, transform: &TransformStamped) -> Result<(), GatewayError> {
        let (parent, child) = (&transform.header.frame_id, &transform.child_frame_id);
        if let Some(frame) = [parent, child].into_iter().find(|f| f.len() > MAX_NAME) {
            return Err(GatewayError::FrameName {
                found: frame.len(),
                most: MAX_NAME,
            });
        }
        if self.fixed.children() >= MAX_FRAMES {
            return Err(GatewayError::Frames {
                frame: child.clone(),
                most: MAX_FRAMES,
            });
        }
        self.fixed
            .add(transform)
            .map_err(|source| GatewayError::Transform {
                parent: parent.clone(),
                child: child.clone(),
                source,
            })?;
        self.mounts.clear();
        if let Ok((_, Some(mend))) = transform.transform.rotation.mended()
            && self.mended.insert(child.clone())
        {
            tracing::warn!("the transform from {parent} to {child}: {mend}");
        }
        Ok(())
    }

    pub(crate) fn on_odometry(&mut self, odometry: &Odometry) {
        if self.odometry.len() == KEPT {
            self.odometry.pop_front();
        }
        self.odometry.push_back(*odometry);
    }

    /// Where a laser with this frame sits on the base, if that is known.
    pub(crate) fn base_from_laser(
        &mut self,
        index: usize,
        laser: &str,
    ) -> Result<Option<Mount>, GatewayError> {
        if index == 0 && self.first.as_deref() != Some(laser) {
            self.first = Some(laser.to_owned());
        }
        let key = (index, laser.to_owned());
        if let Some(mount) = self.mounts.get(&key) {
            return Ok(*mount);
        }
        let mount = match (self.given.get(index), self.fixed.base_from(laser)) {
            (Some(given), _) => Some(*given),
            (None, Some(mount)) if mount.tilt_degrees > MAX_TILT_DEGREES => {
                return Err(GatewayError::Tilted {
                    laser: laser.to_owned(),
                    base: mount.base_frame,
                    tilt_degrees: mount.tilt_degrees,
                });
            }
            (None, mount) => mount.as_ref().map(Mount::from),
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
        if self.mounts.len() >= MAX_MOUNTS {
            self.mounts.clear();
        }
        self.mounts.insert(key, mount);
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
        let laser_from_child = match self.first.as_deref() {
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
    use ros::{Header, Quaternion, Transform, TransformStamped, Vector3};

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
        let mut frames = Frames::new(Vec::new());
        assert_eq!(frames.base_from_laser(0, "laser").unwrap(), None);
        let mount = fixed("base_link", "laser", 0.5, Quaternion::default());
        frames.on_static_transforms(&mount).unwrap();
        let found = frames.base_from_laser(0, "laser").unwrap();
        assert_eq!(found, Some(mounted(0.5)));
        let mut frames = Frames::new(vec![mounted(9.0), mounted(8.0)]);
        frames.on_static_transforms(&mount).unwrap();
        for (index, expected) in [9.0, 8.0].into_iter().enumerate() {
            let found = frames.base_from_laser(index, "laser").unwrap();
            assert_eq!(found, Some(mounted(expected)));
        }
    }

    /// A turn about x by half a turn.
    const OVER: Quaternion = Quaternion {
        x: 1.0,
        y: 0.0,
        z: 0.0,
        w: 0.0,
    };

    #[test]
    fn each_laser_has_its_own_mount_also_upside_down() {
        let mut frames = Frames::new(Vec::new());
        let front = fixed("base_link", "front", 0.5, Quaternion::default());
        let rear = fixed("base_link", "rear", -0.4, OVER);
        let transforms = [front.transforms, rear.transforms].concat();
        frames
            .on_static_transforms(&TfMessage { transforms })
            .unwrap();
        let turned = Mount {
            is_upside_down: true,
            ..mounted(-0.4)
        };
        for _ in 0..2 {
            let found = frames.base_from_laser(0, "front").unwrap();
            assert_eq!(found, Some(mounted(0.5)));
            let found = frames.base_from_laser(1, "rear").unwrap();
            assert_eq!(found, Some(turned));
        }
        // What is kept is bounded, and changes with the transforms.
        for i in 0..3 * MAX_MOUNTS {
            frames.base_from_laser(1, &format!("f{i}")).unwrap();
            assert!(frames.mounts.len() <= MAX_MOUNTS);
        }
        let moved = fixed("base_link", "rear", -0.6, Quaternion::default());
        frames.on_static_transforms(&moved).unwrap();
        let found = frames.base_from_laser(1, "rear").unwrap();
        assert_eq!(found, Some(mounted(-0.6)));
    }

    #[test]
    fn a_transform_that_is_none_does_not_stop_the_rest() {
        let mut frames = Frames::new(Vec::new());
        let scaled = |w: f64| Quaternion {
            w,
            ..Quaternion::default()
        };
        let transforms = [
            fixed("base_link", "camera", f64::NAN, Quaternion::default()),
            fixed("base_link", "front", 0.5, scaled(0.0)),
            fixed("base_link", "rear", -0.4, scaled(1.02)),
        ]
        .map(|message| message.transforms)
        .concat();
        let error = frames
            .on_static_transforms(&TfMessage { transforms })
            .unwrap_err();
        let text = transport::with_causes(&error);
        let expected = "the transform from base_link to camera is ignored: the position (NaN, 0)";
        assert!(text.starts_with(expected), "{text}");
        for (index, laser, x) in [(0, "front", 0.5), (1, "rear", -0.4)] {
            let found = frames.base_from_laser(index, laser).unwrap();
            assert_eq!(found, Some(mounted(x)));
        }
        let mended = ["front".to_owned(), "rear".to_owned()];
        assert!(frames.mended.iter().eq(&mended));
    }

    #[test]
    fn a_frame_may_have_the_longest_name_of_a_message() {
        let mut frames = Frames::new(Vec::new());
        let long = "f".repeat(FrameName::CAPACITY);
        let mount = fixed("base_link", &long, 0.5, Quaternion::default());
        frames.on_static_transforms(&mount).unwrap();
        let found = frames.base_from_laser(0, &long).unwrap();
        assert_eq!(found, Some(mounted(0.5)));
    }

    #[test]
    fn a_tilted_laser_and_too_many_frames_are_refused() {
        let mut frames = Frames::new(Vec::new());
        let half = 0.5f64.sqrt();
        let tilted = Quaternion {
            x: half,
            y: 0.0,
            z: 0.0,
            w: half,
        };
        frames
            .on_static_transforms(&fixed("base_link", "laser", 0.5, tilted))
            .unwrap();
        let error = frames.base_from_laser(0, "laser").unwrap_err().to_string();
        assert!(error.contains("tilted by 90.0"), "{error}");
        let long = fixed("base_link", &"f".repeat(257), 0.5, Quaternion::default());
        let error = frames.on_static_transforms(&long).unwrap_err().to_string();
        assert!(error.contains("257 bytes"), "{error}");
        let mut refused = 0;
        for i in 0..2 * MAX_FRAMES {
            let child = fixed("base_link", &format!("f{i}"), 0.5, Quaternion::default());
            refused += usize::from(frames.on_static_transforms(&child).is_err());
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
            let mut frames = Frames::new(Vec::new());
            for (index, laser, x) in [(0, "laser", 0.5), (1, "rear", -0.4)] {
                let mount = fixed("base_link", laser, x, Quaternion::default());
                frames.on_static_transforms(&mount).unwrap();
                frames.base_from_laser(index, laser).unwrap();
            }
            frames.on_odometry(&odometry(child, 4.0));
            let found = frames.map_from_odom(header, &best);
            assert_eq!(found.map(|(pose, _)| pose.x), expected, "{child}");
        };
        check("base_link", Some(5.5), &header);
        check("laser", Some(6.0), &header);
        // Hypotheses are about the first laser, whichever sent a scan last.
        check("rear", Some(5.1), &header);
        check("base_footprint", Some(5.5), &header);
        check("base_footprint", None, &HypothesesHeader::zeroed());
        let nobody = Frames::new(Vec::new());
        assert_eq!(nobody.map_from_odom(&header, &best), None);
    }
}
