//! Messages from the robot into the graph.

use std::collections::BTreeSet;

use ros::{
    Cloud, CloudOptions, LaserScan, OccupancyGridMsg, Odometry, PointCloud2,
    PoseWithCovarianceStamped, Quaternion, RosMessage, TfMessage,
};
use serde::de::DeserializeOwned;
use transport::{TransportError, monotonic_ns};
use zenoh_session::Report;

use crate::broadcast::Sent;
use crate::checks::{measured_ns, odometry_of, sound_odometry};
use crate::config::Brought;
use crate::frames::Frames;
use crate::joined::Joined;
use crate::outlet::Outlet;
use crate::rmw::{Keeping, Member, Subscription, Watch, take};
use crate::role::Role;
use crate::seeding::Belief;
use crate::{GatewayError, Seed};

/// Largest size of a scan, odometry, a pose or transforms, bytes.
pub(crate) const MAX_BYTES: usize = 1 << 20;

/// Largest size of a point cloud, bytes: 128 rings of 2048 points of 48 bytes, and more.
const MAX_CLOUD_BYTES: usize = 16 << 20;

/// Largest size of a map, bytes: 64 million cells, and the fields before them.
const MAX_MAP_BYTES: usize = (64 << 20) + 4096;

/// Time after a message on the odometry topic for which odometry in /tf is ignored, nanoseconds.
const ODOMETRY_NS: i64 = 1_000_000_000;

pub(crate) struct Incoming {
    fixed: Subscription<TfMessage>,
    moving: Option<Subscription<TfMessage>>,
    odometry: Option<Subscription<Odometry>>,
    /// One per laser, in the order of `--scan`; empty if scans are not wanted.
    scans: Vec<Subscription<LaserScan>>,
    /// Point clouds that are taken as the scans of the only laser.
    clouds: Option<Subscription<PointCloud2>>,
    cloud: CloudOptions,
    maps: Option<Subscription<OccupancyGridMsg>>,
    beliefs: Option<Subscription<PoseWithCovarianceStamped>>,
    pub(crate) outlet: Outlet,
    odom_frame: String,
    /// Time of the last message on the odometry topic, nanoseconds.
    odometry_ns: Option<i64>,
    /// Frame of the robot's map.
    pub(crate) map_frame: Option<String>,
    /// Sources whose rotation was repaired; each is logged once.
    mended: BTreeSet<&'static str>,
    /// Stamps of the transforms to the odometry that the gateway sent.
    sent: Sent,
    tf: String,
}

impl Incoming {
    pub(crate) fn open(
        joined: Joined<'_>,
        watch: &mut Watch,
        sent: Sent,
    ) -> Result<Self, GatewayError> {
        let (member, config, topics) = (joined.member, joined.config, joined.topics);
        let mut open = Opening { member, watch };
        let brings = |topic| config.brings(topic);
        let odometry = brings(Brought::Odometry);
        // In AMCL's place from /tf alone, like AMCL: wheel odometry may differ from the output of
        // the robot's own filter, and the transform from the map refers to that output.
        let by_topic = odometry && config.amcl.role == Role::Seed;
        let is_lost = config.seed == Seed::Lost;
        let (fresh, reliable, kept) = (Keeping::Fresh, Keeping::Reliable, Keeping::Kept);
        let mut scans = Vec::with_capacity(topics.scans.len());
        let mut clouds = None;
        for of_laser in topics.scans.iter().filter(|_| brings(Brought::Scan)) {
            let topic = &of_laser.topic;
            match config.cloud.cloud_topic {
                Some(_) => clouds = Some(open.subscribe(topic, fresh, 5, MAX_CLOUD_BYTES)?),
                None => scans.push(open.subscribe(topic, fresh, 5, MAX_BYTES)?),
            }
        }
        Ok(Incoming {
            scans,
            clouds,
            cloud: config.cloud.clone(),
            fixed: open.subscribe(&topics.tf_static, kept, 100, MAX_BYTES)?,
            moving: open.wanted(odometry, &topics.tf, reliable, 100, MAX_BYTES)?,
            // `Fresh` also accepts robots whose odometry is best effort.
            odometry: open.wanted(by_topic, &topics.odom, fresh, 16, MAX_BYTES)?,
            maps: open.wanted(brings(Brought::Map), &topics.map, kept, 1, MAX_MAP_BYTES)?,
            beliefs: open.wanted(is_lost, &topics.amcl_pose, reliable, 10, MAX_BYTES)?,
            outlet: Outlet::open(joined)?,
            odom_frame: config.odom_frame().to_owned(),
            odometry_ns: None,
            map_frame: None,
            mended: BTreeSet::new(),
            sent,
            tf: topics.tf.clone(),
        })
    }

    /// Handles the messages since the last call: those that others need come first. Poses of the
    /// particle filter go to `on_belief`.
    pub(crate) fn step(
        &mut self,
        frames: &mut Frames,
        mut on_belief: impl FnMut(Belief),
        report: &mut Report,
    ) -> Result<(), TransportError> {
        take(Some(&mut self.fixed), report, |message, _| {
            frames.on_static_transforms(&message)
        })?;
        take(self.odometry.as_mut(), report, |message, report| {
            let odometry = sound_odometry(&message)?;
            note(
                "the odometry",
                message.pose.pose.orientation,
                &mut self.mended,
            );
            self.odometry_ns = Some(monotonic_ns());
            frames.on_odometry(&odometry);
            self.outlet.send_odometry(odometry, report)
        })?;
        let alone = self
            .odometry_ns
            .is_some_and(|ns| monotonic_ns() - ns < ODOMETRY_NS);
        take(self.moving.as_mut(), report, |message, report| {
            // The other transforms of the message are used.
            let mut second = None;
            for transform in message.transforms {
                if self.sent.is_from_another(&transform, &self.odom_frame) {
                    second = Some(GatewayError::Refused(format!(
                        "another node publishes the transform from {} to {} on {}, as this one \
                         does, and poses jump between the two: stop the other one, as AMCL or a SLAM",
                        transform.header.frame_id, transform.child_frame_id, self.tf
                    )));
                    continue;
                }
                if !alone && transform.header.frame_id.trim_start_matches('/') == self.odom_frame {
                    let turn = transform.transform.rotation;
                    let odometry = odometry_of(transform)?;
                    note("the odometry on /tf", turn, &mut self.mended);
                    frames.on_odometry(&odometry);
                    self.outlet.send_odometry(odometry, report)?;
                }
            }
            second.map_or(Ok(()), Err)
        })?;
        take(self.maps.as_mut(), report, |message, report| {
            let frame = message.header.frame_id.clone();
            self.outlet.send_map(&message, report)?;
            self.map_frame = Some(frame).filter(|frame| !frame.is_empty());
            Ok(())
        })?;
        for (laser, scans) in self.scans.iter_mut().enumerate() {
            take(Some(scans), report, |message, report| {
                self.outlet.send_scan(laser, &message, frames, report)
            })?;
        }
        take(self.clouds.as_mut(), report, |message, report| {
            let mount = frames.cloud_mount(self.cloud.cloud_mount, &message.header.frame_id)?;
            let scan = Cloud::Points(message).scan(&mount, self.cloud.heights)?;
            self.outlet.send_scan(0, &scan, frames, report)
        })?;
        take(self.beliefs.as_mut(), report, |message, _| {
            let turn = message.pose.pose.orientation;
            on_belief(Belief {
                measured_ns: measured_ns("the particle filter's pose", message.header.stamp)?,
                map_from_base: message.pose.pose.planar()?,
            });
            note("the particle filter's pose", turn, &mut self.mended);
            Ok(())
        })
    }
}

/// Warns, once for each source, that a rotation had to be repaired.
fn note(whose: &'static str, turn: Quaternion, mended: &mut BTreeSet<&'static str>) {
    if let Ok((_, Some(mend))) = turn.mended()
        && mended.insert(whose)
    {
        tracing::warn!("{whose}: {mend}");
    }
}

struct Opening<'a> {
    member: &'a Member,
    watch: &'a mut Watch,
}

impl Opening<'_> {
    fn subscribe<M: RosMessage + DeserializeOwned>(
        &mut self,
        topic: &str,
        keeping: Keeping,
        depth: usize,
        max_bytes: usize,
    ) -> Result<Subscription<M>, GatewayError> {
        self.watch.expected.expect::<M>(topic)?;
        Subscription::open(self.member, topic, keeping, depth, max_bytes)
    }

    fn wanted<M: RosMessage + DeserializeOwned>(
        &mut self,
        is_wanted: bool,
        topic: &str,
        keeping: Keeping,
        depth: usize,
        max_bytes: usize,
    ) -> Result<Option<Subscription<M>>, GatewayError> {
        is_wanted
            .then(|| self.subscribe(topic, keeping, depth, max_bytes))
            .transpose()
    }
}
