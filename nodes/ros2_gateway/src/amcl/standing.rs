//! Decides when the transform from map to odometry is sent: with each scan at which a pose is
//! believed, and at a steady rate until the next. Pure.
//!
//! It stops when several scans are missing: a controller would take an old transform for a new one.

use geometry::Pose;
use messages::Stamp;

/// Shortest time from one sending to the next, nanoseconds: half of the gateway's tick, so that
/// every tick without a scan sends.
const AGAIN_NS: i64 = 25_000_000;

/// Number of scan periods for which the last scan counts.
const SCANS: i64 = 4;

/// Limits of that time, nanoseconds: one lost scan of a slow laser is tolerated, and a robot moves
/// less than a metre in a second.
const LEAST_NS: i64 = 300_000_000;
const MOST_NS: i64 = 1_000_000_000;

#[derive(Debug, Default)]
pub(super) struct Standing {
    last: Option<Last>,
    /// Time at which the last scan entered the graph, nanoseconds.
    before_ns: Option<i64>,
    limit_ns: i64,
}

#[derive(Debug)]
struct Last {
    stamp: Stamp,
    map_from_odom: Pose,
    odom: String,
    sent_ns: i64,
}

/// Transform to be sent, with its time on the clock of the scans.
#[derive(Debug, PartialEq)]
pub(super) struct Due<'a> {
    pub(super) at_ns: i64,
    pub(super) map_from_odom: Pose,
    pub(super) odom: &'a str,
}

impl Standing {
    /// Takes the transform of a scan, if a pose is believed; it is due at once.
    pub(super) fn on_scan(&mut self, stamp: Stamp, found: Option<(Pose, String)>) {
        let before = self.before_ns.replace(stamp.entered_ns);
        let between = before.map_or(MOST_NS, |before| stamp.entered_ns.saturating_sub(before));
        self.limit_ns = between.saturating_mul(SCANS).clamp(LEAST_NS, MOST_NS);
        self.last = found.map(|(map_from_odom, odom)| Last {
            stamp,
            map_from_odom,
            odom,
            sent_ns: i64::MIN,
        });
    }

    /// Returns the transform to send at `now_ns`, a time of the clock by which scans enter the
    /// graph.
    pub(super) fn due(&mut self, now_ns: i64) -> Option<Due<'_>> {
        let age_ns = |last: &Last| now_ns.saturating_sub(last.stamp.entered_ns).max(0);
        let limit_ns = self.limit_ns;
        // The result of a scan may be late; it is sent at least once.
        self.last
            .take_if(|last| last.sent_ns != i64::MIN && age_ns(last) > limit_ns);
        let last = self.last.as_mut()?;
        let (age_ns, is_first) = (age_ns(last), last.sent_ns == i64::MIN);
        if !is_first && now_ns.saturating_sub(last.sent_ns) < AGAIN_NS {
            return None;
        }
        last.sent_ns = now_ns;
        // The first one has the stamp of the scan itself.
        let since_ns = if is_first { 0 } else { age_ns };
        Some(Due {
            at_ns: last.stamp.measured_ns.saturating_add(since_ns),
            map_from_odom: last.map_from_odom,
            odom: &last.odom,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn stamp(ms: i64) -> Stamp {
        Stamp {
            // The robot's clock differs from this machine's.
            measured_ns: (ms + 5000) * MS,
            entered_ns: ms * MS,
            counter: 0,
        }
    }

    fn found() -> Option<(Pose, String)> {
        Some((Pose::new(1.0, 0.0, 0.0), "odom".to_owned()))
    }

    fn at(standing: &mut Standing, ms: i64) -> Option<i64> {
        standing.due(ms * MS).map(|due| due.at_ns / MS - 5000)
    }

    #[test]
    fn it_is_sent_with_each_scan_and_between_them_at_a_steady_rate() {
        let mut standing = Standing::default();
        assert_eq!(at(&mut standing, 0), None, "no pose is known");
        standing.on_scan(stamp(0), found());
        assert_eq!(at(&mut standing, 10), Some(0));
        assert_eq!(at(&mut standing, 20), None);
        assert_eq!(at(&mut standing, 60), Some(60));
        assert_eq!(at(&mut standing, 80), None, "half of a tick has not passed");
        standing.on_scan(stamp(100), found());
        assert_eq!(at(&mut standing, 101), Some(100));
    }

    #[test]
    fn what_is_old_is_not_sent_for_new() {
        let mut standing = Standing::default();
        for scan in 0..3 {
            standing.on_scan(stamp(100 * scan), found());
            assert!(at(&mut standing, 100 * scan + 5).is_some());
        }
        assert_eq!(at(&mut standing, 590), Some(590), "four scans");
        assert_eq!(at(&mut standing, 650), None);
        assert_eq!(at(&mut standing, 651), None);
        standing.on_scan(stamp(700), None);
        assert_eq!(at(&mut standing, 701), None, "it is lost");
        standing.on_scan(stamp(800), found());
        // The result is late: it has the stamp of its scan, and is not sent again.
        assert_eq!(at(&mut standing, 5000), Some(800));
        assert_eq!(at(&mut standing, 5100), None);
    }

    #[test]
    fn a_slow_laser_has_a_second() {
        let mut standing = Standing::default();
        standing.on_scan(stamp(0), found());
        standing.on_scan(stamp(5000), found());
        assert!(at(&mut standing, 5001).is_some());
        assert_eq!(at(&mut standing, 5999), Some(5999));
        assert_eq!(at(&mut standing, 6050), None);
    }
}
