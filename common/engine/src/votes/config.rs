//! Settings for collecting poses.

/// Settings for collecting poses in a search.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CollectConfig {
    /// Poses with at least this share of the best pose's votes are collected,
    /// 0..=1; lower shares show more alternatives and take longer. On a map with fewer
    /// blocks of 8 × 8 cells than candidates, at most 0.85.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = 1.0, value_parser = crate::config::parse_share))]
    pub floor_share: f64,
    /// Maximum number of poses that are collected, 1..=1000000; the floor rises until
    /// they fit.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 65_536, value_parser = clap::value_parser!(u32).range(1..=1_000_000)))]
    pub max_votes: u32,
    /// Number of distinct poses wanted, 0..=1000: if fewer are above the floor, those
    /// with the highest bounds below it are added. If half of them have half the best
    /// one's votes, up to four times as many are added.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 64, value_parser = clap::value_parser!(u32).range(0..=1000)))]
    pub candidates: u32,
    /// Work limit of a search of unknown headings, millions of steps, 0 to 10⁹: beyond
    /// it the search ends with the best pose found and reports what it may have missed;
    /// 0 is no limit. A step takes about a nanosecond of one 2 GHz processor, but steps
    /// are counted and not timed: on one thread the same scan always gives the same
    /// answer. [default: 5000 in the accumulator, none in the tools]
    #[cfg_attr(feature = "clap", arg(long, value_name = "MILLIONS", value_parser = crate::config::within(0.0..=1e9, "millions of steps")))]
    pub work_limit: Option<f64>,
}

impl CollectConfig {
    /// All poses above the floor, and no candidates below.
    #[cfg(test)]
    pub(crate) fn exact() -> Self {
        CollectConfig {
            candidates: 0,
            ..CollectConfig::default()
        }
    }

    /// Returns the smallest intensity that is collected, given the best one.
    pub(crate) fn floor(&self, best: u16) -> u16 {
        ((f64::from(best) * self.floor_share).ceil() as u16).max(1)
    }

    /// Number of steps after which a search ends; infinite without a limit.
    pub(crate) fn most_steps(&self) -> f64 {
        let limit = self.work_limit.filter(|&millions| millions > 0.0);
        limit.map_or(f64::INFINITY, |millions| millions * 1e6)
    }
}

impl Default for CollectConfig {
    fn default() -> Self {
        CollectConfig {
            floor_share: 1.0,
            max_votes: 65_536,
            candidates: 64,
            work_limit: None,
        }
    }
}
