//! Settings for distinct places and for the verdict.

#[cfg(feature = "clap")]
use crate::config::{parse_degrees, parse_length, parse_share};
use crate::fit::FitConfig;
use crate::votes::{DISTINCT_DEG, DISTINCT_M};

/// Settings for distinct places and for the verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct PeakConfig {
    /// Poses within this distance and `--same-place-deg` are one place,
    /// metres, 0..=2.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.5, value_parser = parse_length))]
    pub same_place_m: f64,
    /// Poses within this angle and `--same-place-m` are one place, degrees,
    /// 0..=180.
    #[cfg_attr(feature = "clap", arg(long, value_name = "DEGREES", default_value_t = 10.0, value_parser = parse_degrees))]
    pub same_place_deg: f64,
    /// Maximum number of places that are reported, 1..=1000.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1000)))]
    pub max_hypotheses: u32,
    /// Number of candidates that are refined, 1..=1000: those with the most votes, and
    /// up to four times as many as long as they have half the best one's votes.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1000)))]
    pub max_candidates: u32,
    /// Votes within this distance and `--candidate-deg` are refined together,
    /// metres, 0..=2.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = DISTINCT_M, value_parser = parse_length))]
    pub candidate_m: f64,
    /// Votes within this angle and `--candidate-m` are refined together,
    /// degrees, 0..=180.
    #[cfg_attr(feature = "clap", arg(long, value_name = "DEGREES", default_value_t = DISTINCT_DEG, value_parser = parse_degrees))]
    pub candidate_deg: f64,
    /// Scores of the fit at the places.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub fit: FitConfig,
    /// Score from which nothing but the lead over other places decides, 0..=1; a best
    /// place with a lower score needs a larger lead: where the scan fits badly, the true
    /// place may not be on the map. This is for a scan that sees six pieces, see
    /// `--piece-doubt`.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.73, value_parser = parse_share))]
    pub sure_score: f64,
    /// Fall of the sure score with the natural logarithm of the number of pieces
    /// of the world that a scan sees, 0..=1, since many pieces rarely fit together by
    /// chance. A new piece begins where neighbouring readings jump.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.14, value_parser = parse_share))]
    pub piece_doubt: f64,
    /// Doubt because of beams that pass through obstacles or end behind unknown space at
    /// the best place: the score that is compared with the sure score is lowered by this
    /// times their share, 0..=1. It does not change which place is best, see
    /// `--through-penalty`: walls that are seen at a flat angle are passed through at the
    /// true place, too.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.7, value_parser = parse_share))]
    pub through_doubt: f64,
    /// Number of beams whose scores decide as they are, 1..=1000: with fewer, scores vary
    /// more by chance, and a lead counts for less by the square root of what is missing.
    /// A beam of little weight counts for less than one.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=1000)))]
    pub sure_beams: u32,
    /// Increase of the lead, less what the score lacks of the sure score, that makes it
    /// less likely by a factor of e that the best place is wrong, 0.001..=1. The lead is
    /// measured relative to what is missing of a perfect score:
    /// (best - other) / √(1.1 - best).
    #[cfg_attr(feature = "clap", arg(long, value_name = "LEAD", default_value_t = 0.09, value_parser = parse_scale))]
    pub doubt_scale: f64,
    /// Lead that makes another place less likely than the best by a factor of e,
    /// 0.001..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LEAD", default_value_t = 0.025, value_parser = parse_scale))]
    pub lead_scale: f64,
    /// Probability from which the best place is unique, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "PROBABILITY", default_value_t = 0.85, value_parser = parse_share))]
    pub unique_from: f64,
    /// Minimum score of the best place; below it the verdict is PoorFit: the scan may
    /// not be of this map, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.60, value_parser = parse_share))]
    pub least_score: f64,
}

/// Parses a scale of scores, which is a divisor.
#[cfg(feature = "clap")]
fn parse_scale(text: &str) -> Result<f64, String> {
    crate::config::parse(text, 0.001..=1.0, "as a share")
}

impl PeakConfig {
    /// Returns the settings for each single map of several searched together: places that one map
    /// would drop may be among the best of all.
    #[must_use]
    pub fn of_each_map(&self) -> Self {
        PeakConfig {
            max_hypotheses: u32::MAX,
            ..*self
        }
    }
}

impl Default for PeakConfig {
    fn default() -> Self {
        PeakConfig {
            same_place_m: 0.5,
            same_place_deg: 10.0,
            max_hypotheses: 64,
            max_candidates: 64,
            candidate_m: DISTINCT_M,
            candidate_deg: DISTINCT_DEG,
            fit: FitConfig::default(),
            sure_score: 0.73,
            piece_doubt: 0.14,
            through_doubt: 0.7,
            sure_beams: 100,
            doubt_scale: 0.09,
            lead_scale: 0.025,
            unique_from: 0.85,
            least_score: 0.60,
        }
    }
}
