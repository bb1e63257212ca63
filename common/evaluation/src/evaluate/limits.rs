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
        let text = |found: Option<f64>, unit: &str| match found {
            Some(found) => format!("{found:.1} {unit}"),
            None => "not known, as no answer is right".to_owned(),
        };
        let at_least = |what: &str, found: Option<f64>, option: &str, least: Option<f64>| {
            let found = found.map(|share| 100.0 * share);
            let least = least.filter(|&least| found.is_none_or(|found| found < least))?;
            Some(format!("{what} {}, --{option} {least}", text(found, "%")))
        };
        let at_most =
            |what: &str, found: Option<f64>, unit: &str, option: &str, most: Option<f64>| {
                let most = most.filter(|&most| found.is_none_or(|found| found > most))?;
                Some(format!(
                    "{what} is {}, --{option} {most}",
                    text(found, unit)
                ))
            };
        let (success, wrong) = (found.success_50cm_10deg, found.unique_wrong);
        let unique = share(found.unique, found.truths);
        let too_many = self.max_wrong.filter(|&most| wrong > most);
        let p90 = found.cpu_ms.p90;
        let error_cm = found.error_m.median.map(|metres| 100.0 * metres);
        let missed = [
            at_least("success is", success, "min-success", self.min_success),
            at_least("Unique are", unique, "min-unique", self.min_unique),
            too_many.map(|most| format!("Unique and wrong are {wrong}, --max-wrong {most}")),
            at_most(
                "the 90th percentile",
                p90,
                "ms",
                "max-p90-ms",
                self.max_p90_ms,
            ),
            at_most(
                "the median error",
                error_cm,
                "cm",
                "max-error-cm",
                self.max_error_cm,
            ),
        ];
        missed.into_iter().flatten().collect()
    }
}
