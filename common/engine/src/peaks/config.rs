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
    /// Minimum lead of the best place: another place closer behind makes the answer
    /// ambiguous, 0..=1. The lead is measured relative to what is missing of a perfect
    /// score: (best - other) / √(1.1 - best).
    #[cfg_attr(feature = "clap", arg(long, value_name = "LEAD", default_value_t = 0.09, value_parser = parse_share))]
    pub least_lead: f64,
    /// Score that needs no more than the minimum lead, 0..=1; a best place with a lower
    /// score needs a larger lead: where the scan fits badly, the true place may not be
    /// on the map. This is for a scan that sees six pieces, see `--piece-doubt`.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.74, value_parser = parse_share))]
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
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.6, value_parser = parse_share))]
    pub through_doubt: f64,
    /// Number of beams that need no more than the minimum lead, 1..=1000: with fewer,
    /// scores vary more by chance, and the lead must be larger by the square root of
    /// what is missing. A beam of little weight counts for less than one.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=1000)))]
    pub sure_beams: u32,
    /// Minimum score of the best place; below it the verdict is PoorFit: the scan may
    /// not be of this map, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.60, value_parser = parse_share))]
    pub least_score: f64,
    /// Lead that makes another place less likely by a factor of e, 0.001..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "LEAD", default_value_t = 0.025, value_parser = parse_scale))]
    pub lead_scale: f64,
    /// Score at which a single place is as likely as that the robot is at none of the
    /// places found, 0..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.55, value_parser = parse_share))]
    pub even_score: f64,
    /// Increase of the score above `--even-score` that makes "none of them" less likely by
    /// a factor of e, 0.001..=1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SCORE", default_value_t = 0.06, value_parser = parse_scale))]
    pub score_scale: f64,
}

/// Parses a scale of scores, which is a divisor.
#[cfg(feature = "clap")]
fn parse_scale(text: &str) -> Result<f64, String> {
    crate::config::parse(text, 0.001..=1.0, "as a share")
}

/// Number of pieces that a scan sees for which the sure score is defined.
const SURE_PIECES: f64 = 6.0;

impl PeakConfig {
    /// Returns the lead that the best place needs to be unique, given its score, the share of beams
    /// that pass through obstacles or end behind unknown space, and the numbers of beams and
    /// pieces.
    pub(super) fn needed_lead(
        &self,
        (score, unmatched): (f64, f64),
        (beams, pieces): (f64, f64),
    ) -> f64 {
        let trusted = score - self.through_doubt * unmatched;
        let sure = self.sure_score - self.piece_doubt * (pieces.max(1.0) / SURE_PIECES).ln();
        let lead = self.least_lead + (sure - trusted).max(0.0);
        // Scores are means over the beams.
        lead * (f64::from(self.sure_beams) / beams.max(1.0))
            .max(1.0)
            .sqrt()
    }

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
            least_lead: 0.09,
            sure_score: 0.74,
            piece_doubt: 0.14,
            through_doubt: 0.6,
            sure_beams: 100,
            least_score: 0.60,
            lead_scale: 0.025,
            even_score: 0.55,
            score_scale: 0.06,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_scan_lacks_is_made_up_for_by_the_lead() {
        let config = PeakConfig::default();
        let check = |best, scan, expected: f64| {
            let needed = config.needed_lead(best, scan);
            assert!(
                (needed - expected).abs() < 1e-12,
                "{best:?} {scan:?}: {needed}"
            );
        };
        check((0.95, 0.0), (180.0, 6.0), 0.09);
        check((0.74, 0.0), (100.0, 6.0), 0.09);
        check((0.64, 0.0), (100.0, 6.0), 0.19);
        check((0.74, 0.0), (25.0, 6.0), 0.18);
        // A share of 0.1 of unmatched beams is offset by a good score.
        check((0.80, 0.1), (100.0, 6.0), 0.09);
        check((0.74, 0.5), (100.0, 6.0), 0.39);
        // A scan of one piece is weaker evidence, one of many pieces is stronger.
        let pieces = |pieces: f64| 0.14 * (pieces / 6.0).ln();
        check((0.74, 0.0), (100.0, 1.0), 0.09 - pieces(1.0));
        check((0.64, 0.0), (100.0, 9.0), 0.19 - pieces(9.0));
        check((0.64, 0.0), (100.0, 60.0), 0.09);
    }
}
