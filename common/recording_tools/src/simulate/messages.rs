//! Converts snapshots of a drive to ROS 2 messages with the usual frames of robots: `map`, `odom`,
//! `base_link` and `laser`, or `front_laser` for a laser named front.

use map::OccupancyGrid;
use recording::Message;
use ros::{Header, LaserScan, OccupancyGridMsg, PointCloud2, Time, Transform, lasers, planar};
use simulation::{Bearings, DriveConfig, NamedMount, Snapshot};

use super::lidar;
use crate::messages;

pub(super) struct Messages<'a> {
    pub(super) config: &'a DriveConfig,
    pub(super) bearings: Bearings,
    pub(super) lasers: Vec<NamedMount>,
}

impl Messages<'_> {
    fn has_rings(&self) -> bool {
        self.config.rings.is_some()
    }

    fn time_increment_s(&self) -> f32 {
        self.config.time_increment_s(self.bearings.count)
    }

    pub(super) fn map(&self, map: &OccupancyGrid, stamp: Time) -> Message {
        let mut message = OccupancyGridMsg::from_grid(map);
        message.header = Header::new(stamp, "map");
        message.info.map_load_time = stamp;
        Message::Map(message)
    }

    pub(super) fn mounts(&self, stamp: Time) -> Message {
        let transform = |laser: &NamedMount| {
            let mut level = Transform::from_planar(laser.mount.base_from_laser);
            if self.has_rings() {
                level.translation.z = lidar::HEIGHT_M;
            }
            let transform = match laser.mount.is_upside_down {
                false => level,
                true => planar::upside_down(level),
            };
            (frame(&laser.name), transform)
        };
        messages::mounts(stamp, self.lasers.iter().map(transform))
    }

    pub(super) fn cloud(&self, snapshot: &Snapshot, stamp: Time) -> Option<PointCloud2> {
        let rings = || std::iter::once(&snapshot.ranges).chain(&snapshot.others);
        let header = Header::new(stamp, &frame(""));
        let times = self.time_increment_s();
        let is_upside_down = self.lasers.first()?.mount.is_upside_down;
        self.has_rings()
            .then(|| lidar::cloud(header, self.bearings, times, is_upside_down, rings()))
    }

    /// Scans of all lasers, with their topics; of a lidar, the ring in the middle.
    pub(super) fn scans(
        &self,
        snapshot: Snapshot,
        stamp: Time,
    ) -> impl Iterator<Item = (String, Message)> {
        let rings = snapshot.others.len() + 1;
        let first = if self.has_rings() { rings / 2 } else { 0 };
        let scans = std::iter::once(snapshot.ranges).chain(snapshot.others);
        let scans = scans.skip(first);
        self.lasers.iter().zip(scans).map(move |(laser, ranges)| {
            let scan = self.scan(Header::new(stamp, &frame(&laser.name)), ranges);
            (lasers::topic_of(&laser.name), scan)
        })
    }

    fn scan(&self, header: Header, ranges: Vec<f32>) -> Message {
        Message::Scan(LaserScan {
            header,
            angle_min: self.bearings.angle_min,
            angle_max: self.bearings.angle_max(),
            angle_increment: self.bearings.angle_increment,
            time_increment: self.time_increment_s(),
            scan_time: (1.0 / self.config.rate) as f32,
            range_min: 0.0,
            range_max: self.config.range_max_m() as f32,
            ranges,
            intensities: Vec::new(),
        })
    }
}

fn frame(laser: &str) -> String {
    match laser {
        "" => "laser".to_owned(),
        name => format!("{name}_laser"),
    }
}
