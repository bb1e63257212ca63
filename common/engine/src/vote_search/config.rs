//! Settings of the first stage.

use crate::limits::LimitsConfig;
use crate::program::VoteConfig;
use crate::votes::CollectConfig;

/// Settings for matching scans with the map.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct VoteSearchConfig {
    /// Headings per turn, a multiple of 8 from 8 to 3600.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "COUNT", default_value_t = 360)
    )]
    pub headings: u32,
    /// Threads of a search, 1..=64; the answer is the same with any number.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=64)))]
    pub threads: u8,
    /// Conversion of readings to votes.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub votes: VoteConfig,
    /// Poses that a search collects.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub collect: CollectConfig,
    /// Region and headings that are searched.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub limits: LimitsConfig,
    /// Cell size of the search, metres, 0..=1: finer maps are searched at this
    /// resolution, and the places found are refined on the full map. 0 searches each
    /// map at its own resolution.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.05, value_parser = crate::config::within(0.0..=1.0, "metres")))]
    pub search_cell: f64,
    /// Memory limit for preparing a map for searches of unknown headings, megabytes of
    /// 10⁶ bytes, 1..=1000000: a map that needs about more is rejected. No limit by
    /// default.
    #[cfg_attr(feature = "clap", arg(long, value_name = "MEGABYTES", value_parser = clap::value_parser!(u32).range(1..=1_000_000)))]
    pub memory_limit: Option<u32>,
}

impl Default for VoteSearchConfig {
    fn default() -> Self {
        VoteSearchConfig {
            headings: 360,
            threads: 1,
            votes: VoteConfig::default(),
            collect: CollectConfig::default(),
            limits: LimitsConfig::default(),
            search_cell: 0.05,
            memory_limit: None,
        }
    }
}
