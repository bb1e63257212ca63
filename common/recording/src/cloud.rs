//! Point clouds as scans of a level laser. Pure.

use ros::{Cloud, CloudMount, Heights, LaserScan};

use crate::Mount;

#[derive(Debug)]
pub(crate) struct CloudLaser {
    pub(crate) frame: String,
    pub(crate) base_frame: String,
    pub(crate) mount: CloudMount,
    pub(crate) heights: Heights,
    pub(crate) notes: Vec<String>,
}

impl CloudLaser {
    pub(crate) fn scan(&self, schema: &str, body: &[u8]) -> Result<LaserScan, String> {
        let cloud = Cloud::decode(schema, body)?;
        let frame = &cloud.header().frame_id;
        if *frame != self.frame {
            return Err(format!(
                "its frame is {frame}, and that of the first one is {}; allowed: one frame",
                self.frame
            ));
        }
        let scan = cloud.scan(&self.mount, self.heights);
        scan.map_err(|error| error.to_string())
    }

    /// Mount of the level laser that the clouds are converted to.
    pub(crate) fn mount(&self) -> Mount {
        let planar = self.mount.planar();
        Mount {
            base_frame: self.base_frame.clone(),
            base_from_laser: planar.base_from_laser,
            upside_down: planar.is_upside_down,
            height_m: self.mount.height_m(),
            tilt_degrees: 0.0,
        }
    }
}
