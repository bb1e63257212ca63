//! Ids of the settings by which scans are read and compared with the map. Nodes that share these
//! settings send the ids, so that one with other settings is noticed.

use twox_hash::XxHash3_64;

use crate::beams::BeamConfig;
use crate::fit::FitConfig;
use crate::joined::JoinConfig;

/// Returns the id of the settings by which scans are joined, deskewed and thinned.
#[must_use]
pub fn reading_id(join: &JoinConfig, beams: &BeamConfig) -> u64 {
    // The debug format has each field with its exact value.
    XxHash3_64::oneshot(format!("{join:?} {beams:?}").as_bytes())
}

/// Returns the id of the settings with this [`reading_id`] and those by which beams are compared
/// with the map.
#[must_use]
pub fn fit_id(reading: u64, fit: &FitConfig) -> u64 {
    XxHash3_64::oneshot(format!("{reading} {fit:?}").as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_setting_changes_the_id() {
        let id = |change: &dyn Fn(&mut JoinConfig, &mut BeamConfig, &mut FitConfig)| {
            let (mut join, mut beams, mut fit) = Default::default();
            change(&mut join, &mut beams, &mut fit);
            fit_id(reading_id(&join, &beams), &fit)
        };
        let mut ids = [
            id(&|_, _, _| ()),
            id(&|join, _, _| join.scans.push("front".into())),
            id(&|join, _, _| join.motion.odometry_delay_s = 0.1),
            id(&|join, _, _| join.motion.deskew = false),
            id(&|_, beams, _| beams.max_beams = 90),
            id(&|_, beams, _| beams.beam_arc_m = 0.1),
            id(&|_, _, fit| fit.fit_sigma_m = 0.2),
            id(&|_, _, fit| fit.drawn_doubt = 0.0),
        ];
        assert_eq!(ids[0], id(&|_, _, _| ()));
        ids.sort_unstable();
        assert!(ids.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
