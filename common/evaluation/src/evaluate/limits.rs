//! Requirements on the figures of a file, by which a build can fail. Pure.

use command_line::number;

use super::judge::Evaluation;
use crate::sequence::above_zero;
use crate::text::share;

/// Requirements on each file; none by default, and not for sequences.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Requirements: exit code 1 if a file misses one")]
pub(super) struct Limits {
    /// Lowest share of the truths that are found within 0.5 m and 10 degrees, per cent
    #[arg(long, value_name = "PERCENT", conflicts_with = "sequence", value_parser = number(0.0..=100.0, "per cent"))]
    min_success: Option<f64>,

    /// Lowest share of the truths with a result that is Unique, per cent
    #[arg(long, value_name = "PERCENT", conflicts_with = "sequence", value_parser = number(0.0..=100.0, "per cent"))]
    min_unique: Option<f64>,

    /// Highest number of results that are Unique and wrong
    #[arg(long, value_name = "COUNT", conflicts_with = "sequence")]
    max_wrong: Option<u64>,

    /// Longest time per scan at the 90th percentile, milliseconds of one thread
    #[arg(long, value_name = "MS", conflicts_with = "sequence", value_parser = above_zero)]
    max_p90_ms: Option<f64>,

    /// Largest median distance of the right answers from the truth, centimetres
    #[arg(long, value_name = "CM", conflicts_with = "sequence", value_parser = above_zero)]
    max_error_cm: Option<f64>,
}

impl Limits {
    /// Requirements that the file misses, one sentence each; an unknown figure misses its own.
    pub(super) fn missed(&self, found: &Evaluation) -> Vec<String> {
        let percent = |share: Option<f64>| share.map(|share| 100.0 * share);
        let text = |found: Option<f64>, unit: &str| match found {
            Some(found) => format!("{found:.1} {unit}"),
            None => "not known, as no answer is right".to_owned(),
        };
        let mut missed = Vec::new();
        let unique = share(found.unique, found.truths);
        for (what, found, option, least) in [
            (
                "success is",
                found.success_50cm_10deg,
                "min-success",
                self.min_success,
            ),
            ("Unique are", unique, "min-unique", self.min_unique),
        ] {
            let found = percent(found);
            if let Some(least) = least.filter(|&least| found.is_none_or(|found| found < least)) {
                let found = text(found, "%");
                missed.push(format!("{what} {found}, --{option} {least}"));
            }
        }
        if let Some(most) = self.max_wrong.filter(|&most| found.unique_wrong > most) {
            let found = found.unique_wrong;
            missed.push(format!("Unique and wrong are {found}, --max-wrong {most}"));
        }
        let error_cm = found.error_m.median.map(|metres| 100.0 * metres);
        for (what, found, unit, option, most) in [
            (
                "the 90th percentile",
                found.cpu_ms.p90,
                "ms",
                "max-p90-ms",
                self.max_p90_ms,
            ),
            (
                "the median error",
                error_cm,
                "cm",
                "max-error-cm",
                self.max_error_cm,
            ),
        ] {
            if let Some(most) = most.filter(|&most| found.is_none_or(|found| found > most)) {
                let found = text(found, unit);
                missed.push(format!("{what} is {found}, --{option} {most}"));
            }
        }
        missed
    }
}
