//! Backcast's engine as a Python module: maps, the places of a scan, and the tracker.
//!
//! It converts and checks; all computation is in `common/engine`, and reading in
//! `common/recording`, which the command uses, too. Long
//! computations run without Python's lock. The module knows no graphs.

mod error;
mod joined;
mod kept;
mod localizer;
mod map;
mod numbers;
mod recording;
mod result;
mod scan;
mod search;
mod settings;
mod tracked;
mod tracker;

/// Where on a map was a laser scan taken? See `backcast`.
#[pyo3::pymodule]
mod _backcast {
    #[pymodule_export]
    use crate::localizer::Localizer;
    #[pymodule_export]
    use crate::map::Map;
    #[pymodule_export]
    use crate::recording::{LaserScans, Recording, read};
    #[pymodule_export]
    use crate::result::LocateResult;
    #[pymodule_export]
    use crate::scan::GivenScan;
    #[pymodule_export]
    use crate::tracked::TrackedPose;
    #[pymodule_export]
    use crate::tracker::Tracker;

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
