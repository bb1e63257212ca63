//! Figures of one drive.

use answers::statistics::{Distribution, Spread};
use schemars::JsonSchema;
use serde::Serialize;

use super::errors::{Errors, Samples};
use super::follow::Followed;
use super::interruption::Interruptions;
use super::starts::{After, Starts};
use crate::text::{number, percent, share};

#[derive(Debug, Default)]
pub(super) struct Judged {
    /// Number of scans with a true pose.
    pub(super) truths: u64,
    pub(super) starts: Starts,
    pub(super) followed: Followed,
    pub(super) jumps: Interruptions,
    pub(super) outages: Interruptions,
    pub(super) from_first_scan: Samples,
    pub(super) searching_ms: Vec<f64>,
}

impl Judged {
    pub(super) fn merge(&mut self, other: &Self) {
        self.truths += other.truths;
        self.starts.merge(&other.starts);
        self.followed.merge(&other.followed);
        self.jumps.merge(&other.jumps);
        self.outages.merge(&other.outages);
        self.from_first_scan.merge(&other.from_first_scan);
        self.searching_ms.extend(&other.searching_ms);
    }
}

/// Figures of one drive, or of several. Shares are 0..=1; docs/tracking.md explains each.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Figures {
    pub(super) bag: String,
    /// Number of scans with a true pose.
    pub(super) truths: u64,
    pub(super) starts: u64,
    pub(super) right: After,
    pub(super) not_yet: After,
    pub(super) wrong_starts: u64,
    /// Scans that were Unique and wrong, after all starts and while followed.
    pub(super) wrong_scans: u64,
    pub(super) losses: usize,
    pub(super) rms_m: Option<f64>,
    pub(super) rms_deg: Option<f64>,
    pub(super) max_m: Option<f64>,
    pub(super) in_ellipse: Option<f64>,
    pub(super) unique_share: Option<f64>,
    pub(super) false_alarms_per_hour: Option<f64>,
    pub(super) kidnaps: u64,
    pub(super) kidnaps_noticed_within_2: Option<f64>,
    pub(super) kidnaps_right_after_5_m: Option<f64>,
    pub(super) kidnaps_wrong: u64,
    /// Number of simulated outages: no data for a while, then new odometry.
    pub(super) outages: u64,
    pub(super) outages_right_after_5_m: Option<f64>,
    pub(super) outages_wrong: u64,
    /// Errors of the drive from its first scan, without an initial pose.
    pub(super) from_first_scan: Errors,
    pub(super) searched_share: Option<f64>,
    /// CPU time per scan, in milliseconds of one thread.
    pub(super) cpu_ms_tracking: Spread,
    pub(super) cpu_ms_searching: Spread,
}

impl Figures {
    pub(super) fn of(bag: String, judged: &Judged) -> Self {
        let (starts, followed) = (&judged.starts, &judged.followed);
        let (jumps, outages) = (&judged.jumps, &judged.outages);
        let spread = |times_ms: &[f64]| Distribution::from_iter(times_ms.iter().copied()).spread();
        let hourly = |count: u64| count as f64 / followed.hours;
        Figures {
            bag,
            truths: judged.truths,
            starts: starts.starts,
            right: After::of(&starts.right, &starts.judged),
            not_yet: After::of(&starts.not_yet, &starts.judged),
            wrong_starts: starts.wrong.len() as u64,
            wrong_scans: starts.tally.with(&followed.tally).wrong,
            losses: followed.losses.len(),
            rms_m: followed.rms_m(),
            rms_deg: followed.rms_deg(),
            max_m: followed.max_m(),
            in_ellipse: followed.in_ellipse(),
            unique_share: followed.unique_share(),
            false_alarms_per_hour: (followed.hours > 0.0).then(|| hourly(followed.false_alarms)),
            kidnaps: jumps.count,
            kidnaps_noticed_within_2: share(jumps.noticed, jumps.count),
            kidnaps_right_after_5_m: share(jumps.right, jumps.count),
            kidnaps_wrong: jumps.wrong.len() as u64,
            outages: outages.count,
            outages_right_after_5_m: share(outages.right, outages.count),
            outages_wrong: outages.wrong.len() as u64,
            from_first_scan: judged.from_first_scan.figures(),
            searched_share: share(starts.searches, starts.scans),
            cpu_ms_tracking: spread(&followed.tracking_ms),
            cpu_ms_searching: spread(&judged.searching_ms),
        }
    }

    pub(super) fn text(&self) -> String {
        let row = |after: &After| {
            let shares = after.0.iter().map(|&(_, share)| percent(share));
            shares.map(|p| format!("{p:>6}")).collect::<String>()
        };
        format!(
            "{}\n  starts {:>4}   after     1     2     5    10    20 m\n    right, %       {}\n    not yet, %     {}\n    wrong at any time  {}\n  \
             followed: losses {}, RMS {} m {}°, farthest {} m; in the ellipse {} %; Unique {} %; false alarms {} an hour\n  \
             put elsewhere {} times: noticed within 2 scans {} %, right after 5 m {} %, wrong {}\n  \
             no data for 0.5 to 4 s {} times: right after 5 m {} %, wrong {}\n  \
             from the first scan, {}\n  \
             CPU a scan, median / p90: tracking {} / {} ms, searching {} / {} ms; searched {} % of the scans after a start\n",
            self.bag,
            self.starts,
            row(&self.right),
            row(&self.not_yet),
            self.wrong_starts,
            self.losses,
            number(self.rms_m, 3),
            number(self.rms_deg, 2),
            number(self.max_m, 2),
            percent(self.in_ellipse),
            percent(self.unique_share),
            number(self.false_alarms_per_hour, 1),
            self.kidnaps,
            percent(self.kidnaps_noticed_within_2),
            percent(self.kidnaps_right_after_5_m),
            self.kidnaps_wrong,
            self.outages,
            percent(self.outages_right_after_5_m),
            self.outages_wrong,
            self.from_first_scan.text(),
            number(self.cpu_ms_tracking.median, 2),
            number(self.cpu_ms_tracking.p90, 2),
            number(self.cpu_ms_searching.median, 1),
            number(self.cpu_ms_searching.p90, 1),
            percent(self.searched_share),
        )
    }
}
