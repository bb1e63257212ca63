//! Publishers of the robot's messages in the graph.

use map::MemoryLimit;
use messages::topic::{self, Topic};
use messages::{CellRules, MapHeader, Name, Odometry, ScanHeader, Stamp};
use ros::{LaserScan, OccupancyGridMsg, measurements};
use transport::{Publisher, TransportError, monotonic_ns};
use zenoh_session::Report;

use crate::GatewayError;
use crate::checks::{check_scan, measured_ns};
use crate::config::Brought;
use crate::frames::Frames;
use crate::joined::Joined;
use crate::stamps::Forward;

#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Rules {
    /// Readings below this are no returns, metres; the laser's own limit counts if it is higher.
    pub(crate) range_min_m: Option<f32>,
    /// Readings beyond this are no returns, metres; the laser's own limit counts if it is lower.
    pub(crate) range_max_m: Option<f32>,
    /// True if maps after the first are left out.
    pub(crate) first_map_only: bool,
}

struct Laser {
    name: Name,
    sent: u64,
    /// Stamp of the last scan that was sent.
    last: Forward,
    /// True once the warning of repeated scans was logged.
    repeats: bool,
}

impl Laser {
    fn new(name: Name) -> Self {
        Laser {
            name,
            sent: 0,
            last: Forward::default(),
            repeats: false,
        }
    }

    /// True if this scan or a later one was sent before: bridges may send each scan twice.
    fn had(&self, stamp_ns: i64) -> bool {
        // Lasers without a clock always send 0.
        stamp_ns != 0 && !self.last.is_later(stamp_ns)
    }
}

/// Publishers to the graph; `None` for topics that `--bring` leaves out.
pub(crate) struct Outlet {
    scans: Option<Publisher<topic::Scan>>,
    odometry: Option<Publisher<topic::OdometryTopic>>,
    maps: Option<Publisher<topic::Map>>,
    /// Memory limit of the graph, which a map must fit into.
    memory_limit: MemoryLimit,
    cells: CellRules,
    lasers: Vec<Laser>,
    pub(crate) odometry_sent: u64,
    maps_sent: u64,
    map_id: Option<u64>,
    pub(crate) rules: Rules,
}

impl Outlet {
    pub(crate) fn open(joined: Joined<'_>) -> Result<Self, TransportError> {
        let (config, scans) = (joined.config, &joined.topics.scans);
        Ok(Outlet {
            scans: brought(joined, Brought::Scan)?,
            odometry: brought(joined, Brought::Odometry)?,
            maps: brought(joined, Brought::Map)?,
            memory_limit: config.memory.limit(),
            cells: config.cells,
            lasers: scans.iter().map(|scans| Laser::new(scans.laser)).collect(),
            odometry_sent: 0,
            maps_sent: 0,
            map_id: None,
            rules: Rules::default(),
        })
    }

    /// Returns the number of maps sent, and that of scans of each laser.
    pub(crate) fn sent(&self) -> (u64, impl Iterator<Item = u64>) {
        (self.maps_sent, self.lasers.iter().map(|laser| laser.sent))
    }

    /// Sends a scan of the laser with this index; a scan that was sent before is dropped.
    pub(crate) fn send_scan(
        &mut self,
        laser: usize,
        message: &LaserScan,
        frames: &mut Frames,
        report: &mut Report,
    ) -> Result<(), GatewayError> {
        let (Some(publisher), Some(of)) = (&self.scans, self.lasers.get_mut(laser)) else {
            return Ok(());
        };
        check_scan(message)?;
        let stamp_ns = message.header.stamp.as_ns();
        if of.had(stamp_ns) {
            report.dropped(1);
            if !of.repeats {
                tracing::warn!("scans come twice, or after later ones: these are dropped");
                of.repeats = true;
            }
            return Ok(());
        }
        let frame = measurements::frame(&message.header.frame_id)?;
        let mount = frames.base_from_laser(laser, &message.header.frame_id)?;
        let header = measurements::scan_header(message, frame, mount);
        let header = ScanHeader {
            stamp: entering(header.stamp, of.sent),
            laser: of.name,
            range_min_m: header
                .range_min_m
                .max(self.rules.range_min_m.unwrap_or(0.0)),
            range_max_m: self
                .rules
                .range_max_m
                .map_or(header.range_max_m, |most| header.range_max_m.min(most)),
            ..header
        };
        publisher.send(header, &message.ranges)?;
        of.sent += 1;
        of.last.note(stamp_ns);
        report.sent();
        Ok(())
    }

    pub(crate) fn send_odometry(
        &mut self,
        mut odometry: Odometry,
        report: &mut Report,
    ) -> Result<(), GatewayError> {
        let Some(publisher) = &self.odometry else {
            return Ok(());
        };
        odometry.stamp = entering(odometry.stamp, self.odometry_sent);
        publisher.send(odometry, &[])?;
        self.odometry_sent += 1;
        report.sent();
        Ok(())
    }

    /// Sends a map, unless the graph has the same one already.
    pub(crate) fn send_map(
        &mut self,
        message: &OccupancyGridMsg,
        report: &mut Report,
    ) -> Result<(), GatewayError> {
        let Some(publisher) = &self.maps else {
            return Ok(());
        };
        if self.rules.first_map_only && self.map_id.is_some() {
            return Ok(());
        }
        let info = &message.info;
        if let Err(error) = self.memory_limit.check((info.width, info.height)) {
            return Ok(report.map_refused(&error)?);
        }
        let measured_ns = measured_ns("the map", message.header.stamp)?;
        let grid = message.to_grid()?;
        let map_id = grid.id();
        if self.map_id == Some(map_id) {
            return Ok(());
        }
        if let Err(error) = self.memory_limit.check_grid(&grid) {
            return Ok(report.map_refused(&error)?);
        }
        let stamp = Stamp::measured_at(measured_ns);
        let header = self.cells.header(MapHeader {
            stamp: entering(stamp, self.maps_sent),
            map_id,
            width: grid.width,
            height: grid.height,
            resolution_m: grid.resolution_m,
            map_from_grid: grid.map_from_grid.into(),
            ..MapHeader::default()
        });
        publisher.send(header, &grid.cells)?;
        self.map_id = Some(map_id);
        self.maps_sent += 1;
        report.sent();
        report.map_taken()?;
        let (width, height, resolution_m) = (grid.width, grid.height, grid.resolution_m);
        let map_id = format!("{map_id:016x}");
        tracing::info!(width, height, resolution_m, map_id, "the robot's map");
        Ok(())
    }
}

fn brought<T: Topic>(
    joined: Joined<'_>,
    what: Brought,
) -> Result<Option<Publisher<T>>, TransportError> {
    let is_brought = joined.config.brings(what);
    is_brought.then(|| joined.graph.publisher()).transpose()
}

fn entering(stamp: Stamp, counter: u64) -> Stamp {
    Stamp {
        entered_ns: monotonic_ns(),
        counter,
        ..stamp
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scan_that_comes_again_is_known_and_a_clock_may_be_set_back() {
        let mut laser = Laser::new(Name::new("front"));
        let second = 1_000_000_000;
        assert!(!laser.had(0));
        laser.last.note(7 * second);
        assert!(laser.had(7 * second) && laser.had(7 * second - 1) && laser.had(5 * second));
        assert!(!laser.had(7 * second + 1) && !laser.had(5 * second - 1));
    }
}
