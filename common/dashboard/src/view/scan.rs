//! End points of the newest scan.

use messages::{Pose2, ScanHeader};
use serde::Serialize;

use super::beams::rounded;

/// Maximum number of points sent: as many as a picture can show.
const MAX_POINTS: usize = 1440;

/// End points of one laser's newest scan, as columns.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Scan {
    pub(crate) counter: u64,
    /// Name of the laser; empty if the graph has only one.
    pub(crate) laser: String,
    /// Pose of the laser on the base; `None` if it is not known.
    pub(crate) mount: Option<Pose2>,
    /// Ahead of the laser in metres, rounded to a centimetre.
    pub(crate) x: Vec<f64>,
    /// Left of the laser in metres, rounded to a centimetre.
    pub(crate) y: Vec<f64>,
}

impl Scan {
    /// Converts a message of `scan`. Beams without a return are left out; of a scan with more beams
    /// than a picture can show, only every n-th is taken.
    pub(crate) fn new(header: &ScanHeader, ranges: &[f32]) -> Self {
        let scan = engine::scan::Scan::of(header, ranges);
        let mut points = Scan {
            counter: header.stamp.counter,
            laser: header.laser.as_str().to_owned(),
            mount: (header.mount_known == 1).then_some(header.base_from_laser),
            x: Vec::new(),
            y: Vec::new(),
        };
        let step = ranges.len().div_ceil(MAX_POINTS).max(1);
        let returns = scan.range_min_m.max(0.0)..scan.range_max_m;
        for (index, &range) in ranges.iter().enumerate().step_by(step) {
            let bearing = scan.angle_min + index as f64 * scan.angle_increment;
            if !returns.contains(&range) || range == 0.0 || !bearing.is_finite() {
                continue;
            }
            let (sin, cos) = bearing.sin_cos();
            for (column, share) in [(&mut points.x, cos), (&mut points.y, sin)] {
                column.push(rounded(f64::from(range) * share, 100.0));
            }
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    #[test]
    fn beams_without_a_return_have_no_point() {
        let header = ScanHeader {
            angle_increment: std::f64::consts::FRAC_PI_2,
            range_min_m: 0.5,
            range_max_m: 8.0,
            upside_down: 1,
            ..ScanHeader::zeroed()
        };
        let ranges = [2.0, 3.0, f32::NAN, f32::INFINITY, 0.2, 8.0];
        let scan = Scan::new(&header, &ranges);
        // The second beam of a laser that hangs upside down points to the right.
        assert_eq!((scan.x, scan.y), (vec![2.0, 0.0], vec![0.0, -3.0]));
        assert_eq!(scan.mount, None);
    }

    #[test]
    fn many_beams_are_thinned_out() {
        let header = ScanHeader {
            range_max_m: 8.0,
            ..ScanHeader::zeroed()
        };
        let scan = Scan::new(&header, &[1.0; 65_536]);
        assert!((MAX_POINTS / 2..=MAX_POINTS).contains(&scan.x.len()));
    }
}
