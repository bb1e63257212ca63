//! True poses of a recording, by time: at the stamps that it holds, and interpolated between them.

use std::collections::BTreeMap;
use std::path::Path;

use command_line::number;
use geometry::Pose;
use offline::{Options, no_truths};
use recording::Recording;

/// Options about true poses.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct TruthOptions {
    /// Interpolate the true pose of a scan between two that are no more than this apart, seconds,
    /// 0..=10, for truths at a rate of their own; 0 takes those of the scan's own stamp alone
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = number(0.0..=10.0, "seconds"))]
    truth_gap_s: f64,

    /// Lowest number of scans with a true pose
    #[arg(
        long,
        value_name = "COUNT",
        conflicts_with = "stress",
        help_heading = "Requirements: exit code 1 if a file misses one"
    )]
    min_truths: Option<u64>,
}

impl TruthOptions {
    /// Sentence on a file that has fewer truths than are required.
    pub(crate) fn missed(&self, truths: u64) -> Option<String> {
        let least = self.min_truths.filter(|&least| truths < least)?;
        Some(format!("true poses are {truths}, --min-truths {least}"))
    }

    /// Opens an undamaged recording that has true poses.
    pub(crate) fn open(
        &self,
        bag: &Path,
        options: &Options,
    ) -> anyhow::Result<(Recording, Truths)> {
        let recording = options.open(&[bag.to_owned()])?;
        if let Some(damage) = recording.damage_error() {
            return Err(damage.into());
        }
        let known = recording.ground_truths()?.into_iter();
        let known: BTreeMap<i64, Pose> = known.map(|(ns, truth)| (ns, truth.pose)).collect();
        let gap_ns = (self.truth_gap_s * 1e9) as i64;
        match known.is_empty() {
            true => Err(no_truths(bag)),
            false => Ok((recording, Truths { known, gap_ns })),
        }
    }
}

pub(crate) struct Truths {
    /// By stamp, in nanoseconds; at least one.
    known: BTreeMap<i64, Pose>,
    gap_ns: i64,
}

impl Truths {
    pub(crate) fn recorded(&self) -> usize {
        self.known.len()
    }

    /// True pose at a time: one of that stamp, or between two with a gap that is allowed.
    pub(crate) fn at(&self, stamp_ns: i64) -> Option<Pose> {
        let [from, to] = self.around(stamp_ns);
        let gap_ns = to?.0.checked_sub(from?.0)?;
        (gap_ns <= self.gap_ns).then(|| self.guess(stamp_ns))
    }

    /// True pose at a time, across any gap; before the first and after the last it is theirs.
    pub(crate) fn guess(&self, stamp_ns: i64) -> Pose {
        match self.around(stamp_ns) {
            [Some((from_ns, from)), Some((to_ns, to))] if to_ns > from_ns => {
                let share = (stamp_ns - from_ns) as f64 / (to_ns - from_ns) as f64;
                from.towards(to, share)
            }
            [Some((_, truth)), _] | [None, Some((_, truth))] => truth,
            [None, None] => Pose::IDENTITY,
        }
    }

    /// The last truth up to a time, and the first from it on.
    fn around(&self, stamp_ns: i64) -> [Option<(i64, Pose)>; 2] {
        let before = self.known.range(..=stamp_ns).next_back();
        let after = self.known.range(stamp_ns..).next();
        [before, after].map(|truth| truth.map(|(&stamp_ns, &truth)| (stamp_ns, truth)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_truth_is_interpolated_within_the_gap_alone() {
        let truth = |(stamp_ns, x)| (stamp_ns, Pose::new(x, 0.0, 0.0));
        let known: BTreeMap<_, _> = [(100, 1.0), (200, 2.0), (400, 3.0)].map(truth).into();
        let x = |gap_ns, stamp_ns| {
            let known = known.clone();
            let pose = Truths { known, gap_ns }.at(stamp_ns);
            pose.map(|pose| pose.x)
        };
        assert_eq!((x(0, 200), x(0, 150)), (Some(2.0), None));
        assert_eq!((x(100, 150), x(99, 150)), (Some(1.5), None));
        assert_eq!((x(100, 300), x(200, 300)), (None, Some(2.5)));
        assert_eq!((x(200, 99), x(200, 401)), (None, None), "beyond the ends");
        let all = Truths { known, gap_ns: 0 };
        assert_eq!([0, 300, 500].map(|at| all.guess(at).x), [1.0, 2.5, 3.0]);
    }
}
