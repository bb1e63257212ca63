//! Requirements on the figures of a drive, by which a build fails. Pure.

use std::str::FromStr;

use super::follow::Followed;
use super::starts::{AFTER_M, After, Starts};

/// Requirements on each drive and each variant of it; none by default.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Requirements of sequences: exit code 1 if a drive misses one")]
pub(crate) struct SequenceLimits {
    /// Highest number of starts that are Unique and wrong at any time
    #[arg(long, value_name = "COUNT", requires = "sequence")]
    max_wrong_starts: Option<u64>,

    /// Highest number of scans that are Unique and wrong, after all starts and while followed
    #[arg(long, value_name = "COUNT", requires = "sequence")]
    max_wrong_scans: Option<u64>,

    /// Highest number of losses while the drive is followed
    #[arg(long, value_name = "COUNT", requires = "sequence")]
    max_losses: Option<u64>,

    /// Largest root mean square of the distance from the truth while the drive is
    /// followed, centimetres
    #[arg(long, value_name = "CM", requires = "sequence", value_parser = above_zero)]
    max_rms_cm: Option<f64>,

    /// Lowest share of the starts that are right after so many metres, as 10=95: 1, 2, 5, 10 or 20
    /// metres, and per cent; several with commas
    #[arg(
        long,
        value_name = "METRES=PERCENT",
        requires = "sequence",
        value_delimiter = ','
    )]
    min_right: Vec<MinRight>,
}

/// Share of the starts that have to be right at a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MinRight {
    after_m: f64,
    percent: f64,
}

impl FromStr for MinRight {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (after, percent) = text.split_once('=').unwrap_or_default();
        let after_m = after.parse().ok().filter(|m| AFTER_M.contains(m));
        let percent = percent.parse().ok().filter(|p| (0.0..=100.0).contains(p));
        let both = after_m.zip(percent);
        both.map(|(after_m, percent)| MinRight { after_m, percent })
            .ok_or_else(|| {
                "allowed are 1, 2, 5, 10 or 20 metres, = and 0 to 100 per cent, as 10=95".to_owned()
            })
    }
}

/// Figures of a drive that are compared with requirements.
pub(super) struct Reached {
    pub(super) wrong_starts: u64,
    pub(super) wrong_scans: u64,
    pub(super) losses: u64,
    pub(super) rms_m: Option<f64>,
    /// Share of the starts that are right, by metres.
    pub(super) right: After,
}

impl Reached {
    pub(super) fn of(starts: &Starts, followed: &Followed) -> Self {
        Reached {
            wrong_starts: starts.wrong.len() as u64,
            wrong_scans: starts.tally.wrong + followed.tally.wrong,
            losses: followed.losses.len() as u64,
            rms_m: followed.rms_m(),
            right: After::of(&starts.right, &starts.judged),
        }
    }
}

pub(crate) fn above_zero(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|n: &f64| n.is_finite() && *n > 0.0);
    number.ok_or_else(|| "allowed are numbers above 0".to_owned())
}

impl SequenceLimits {
    /// Requirements that the drive misses, one sentence each. An unknown figure misses its
    /// requirement. Without a `truth` at all, as on another building's map, no pose can be right.
    pub(super) fn missed(&self, found: &Reached, has_truth: bool) -> Vec<String> {
        let counts = [
            ("wrong-starts", found.wrong_starts, self.max_wrong_starts),
            ("wrong-scans", found.wrong_scans, self.max_wrong_scans),
            ("losses", found.losses, self.max_losses),
        ];
        let over = counts.into_iter().filter_map(|(name, count, most)| {
            let most = most.filter(|&most| count > most)?;
            Some(format!(
                "{} are {count}, --max-{name} {most}",
                name.replace('-', " ")
            ))
        });
        let mut missed: Vec<String> = over.collect();
        if let Some(most) = self.max_rms_cm
            && has_truth
            && found.rms_m.is_none_or(|m| 100.0 * m > most)
        {
            let found = found
                .rms_m
                .map_or("not known".to_owned(), |m| format!("{:.1} cm", 100.0 * m));
            missed.push(format!("the RMS is {found}, --max-rms-cm {most}"));
        }
        for &MinRight { after_m, percent } in self.min_right.iter().filter(|_| has_truth) {
            let mut shares = found.right.0.iter();
            let share = shares.find(|(metres, _)| *metres == after_m);
            let share = share.and_then(|&(_, share)| share.map(|share| 100.0 * share));
            if share.is_none_or(|share| share < percent) {
                let found = share.map_or("not known".to_owned(), |share| format!("{share:.1} %"));
                missed.push(format!(
                    "right after {after_m} m is {found}, --min-right {after_m}={percent}"
                ));
            }
        }
        missed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_limit_is_missed_by_more_than_it_allows() {
        let limits = SequenceLimits {
            max_wrong_starts: Some(1),
            max_wrong_scans: Some(10),
            max_losses: Some(0),
            max_rms_cm: Some(5.0),
            min_right: vec!["10=95".parse().unwrap(), "2=50".parse().unwrap()],
        };
        let mut found = Reached {
            wrong_starts: 1,
            wrong_scans: 10,
            losses: 0,
            rms_m: Some(0.05),
            right: After(vec![(2.0, Some(0.5)), (10.0, Some(0.96))]),
        };
        assert!(limits.missed(&found, true).is_empty());
        found = Reached {
            wrong_starts: 2,
            wrong_scans: 11,
            losses: 1,
            rms_m: None,
            right: After(vec![(2.0, Some(0.4)), (10.0, None)]),
        };
        let missed = limits.missed(&found, true).join(";");
        for option in [
            "wrong-starts 1",
            "wrong-scans 10",
            "losses 0",
            "rms-cm 5",
            "2=50",
            "10=95",
        ] {
            assert!(missed.contains(option), "{missed}");
        }
        assert_eq!(limits.missed(&found, false).len(), 3);
        for wrong in ["95", "3=95", "10=101", "10=", "10=NaN"] {
            assert!(wrong.parse::<MinRight>().is_err(), "{wrong}");
        }
        assert!(SequenceLimits::default().missed(&found, true).is_empty());
    }
}
