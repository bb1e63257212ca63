//! Judges the poses that another program found in a recording, by the measures of the other
//! evaluations. The recording is not searched, and its map is not needed.

use std::path::{Path, PathBuf};

use answers::statistics::Spread;
use anyhow::{Context, anyhow};
use clap::Arg;
use command_line::number;
use offline::{Options, Scans, no_truth_taken};
use schemars::JsonSchema;
use serde::Serialize;

use super::given::{GivenPoses, seconds};
use super::judge::{Evaluation, Judged};
use crate::sequence::{Errors, Samples, WRONG};
use crate::text;
use crate::trust::{self, Said};
use crate::truths::TruthOptions;

/// Options of `backcast evaluate --answers`.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Answers of another program")]
pub(super) struct AnswerOptions {
    /// Judge the poses in this file in place of searching: a trajectory as TUM (`stamp_s x y z qx
    /// qy qz qw`), or lines of JSON with stamp_ns, x, y, yaw and optionally verdict and
    /// probability. Needs one recording, and not its map
    #[arg(long, value_name = "FILE")]
    pub(super) answers: Option<PathBuf>,

    /// Whose poses they are, in the map; those of the base where the laser's mount is not known
    /// are the laser's
    #[arg(long, value_enum, value_name = "FRAME", default_value_t = Frame::Base, requires = "answers")]
    answers_of: Frame,

    /// Interpolate the answer to a scan between two that are no more than this apart, seconds,
    /// 0..=10, for poses at a rate of their own; 0 takes those of the scan's own stamp alone
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, requires = "answers", value_parser = number(0.0..=10.0, "seconds"))]
    answer_gap_s: f64,
}

/// Arguments of `backcast evaluate` that have a meaning for the answers of another program.
const MEANT_FOR_ANSWERS: &str = "\
    bags json junit force total truth_gap_s min_truths min_success min_unique max_wrong \
    max_error_cm answers answers_of answer_gap_s scan_topic cloud_topic heights cloud_mount every";

/// Makes an argument an error beside `--answers`, unless it has a meaning there.
pub(super) fn refuse_beside_answers(argument: Arg) -> Arg {
    let mut meant = MEANT_FOR_ANSWERS.split(' ');
    match meant.any(|name| argument.get_id() == name) {
        true => argument,
        false => argument.conflicts_with("answers"),
    }
}

/// Frame whose poses are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Frame {
    /// The robot's base, as its other programs say.
    Base,
    /// The laser, as in the files of --trajectories.
    Laser,
}

/// Figures of another program's answers; shares are 0..=1 of `truths`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Figures {
    /// The recording, as given by the user.
    bag: String,
    /// Number of poses in the file.
    answers: u64,
    /// Number of scans read.
    scans: u64,
    /// Number of scans with a true pose.
    truths: u64,
    /// Number of scans with a true pose and an answer; the others count as not found.
    answered: u64,
    /// Share of scans whose answer is within 0.5 m and 10°.
    success_50cm_10deg: Option<f64>,
    /// Share of scans whose answer is within 0.2 m and 3°.
    success_20cm_3deg: Option<f64>,
    /// Number of answers that are Unique, as all are of which nothing else is said.
    unique: u64,
    /// Number of Unique answers beyond 0.5 m or 10°.
    unique_wrong: u64,
    /// Number of Unique answers beyond 1 m or 25°, which are wrong in sequences.
    wrong_scans: u64,
    /// Distance from the truth, in metres, over the answers within 0.5 m and 10°.
    error_m: Spread,
    /// Angle from the truth, in degrees, over the same answers.
    error_deg: Spread,
    /// Errors of all answers with a truth, as a trajectory.
    trajectory: Errors,
    /// Probabilities that the program gave, and how many of these answers were right.
    probabilities: Vec<Said>,
}

/// Judges the answers to the scans with a true pose; also returns the figures for requirements.
pub(super) fn evaluate(
    file: &Path,
    bag: &Path,
    (config, truths, options): (&AnswerOptions, &TruthOptions, &Options),
) -> anyhow::Result<(Figures, Evaluation)> {
    let shown = file.display();
    let text = std::fs::read_to_string(file).with_context(|| format!("cannot read {shown}"))?;
    let given = GivenPoses::parse(&text).map_err(|reason| anyhow!("{shown}:{reason}"))?;
    let (recording, truths) = truths.open(bag, options)?;
    let topics = options.topics.scans(&recording)?;
    let (mut judged, mut pairs) = (Vec::new(), Vec::new());
    let (mut scans, mut wrong_scans, mut first_ns) = (0, 0, None);
    for scan in Scans::of(&recording, topics, options.every) {
        let scan = scan?;
        scans += 1;
        let Some(truth) = truths.at(scan.stamp_ns) else {
            continue;
        };
        first_ns = first_ns.or(Some(scan.stamp_ns));
        let Some(answer) = given.at(scan.stamp_ns, (config.answer_gap_s * 1e9) as i64) else {
            judged.push(Judged::refusal(truth, "no answer".to_owned()));
            continue;
        };
        let mount = scan
            .base_from_laser
            .filter(|_| config.answers_of == Frame::Base);
        let pose = mount.map_or(answer.pose, |mount| answer.pose.then(mount));
        let is_far = !pose.is_within(truth, WRONG.0, WRONG.1.to_radians());
        wrong_scans += u64::from(answer.is_unique && is_far);
        judged.push(Judged::given(truth, pose, &answer));
        pairs.push((pose, truth));
    }
    let first_ns = first_ns.ok_or_else(|| no_truth_taken(bag, scans, truths.recorded()))?;
    let bag = bag.display().to_string();
    if pairs.is_empty() {
        let [from, to] = given.span_ns().map(seconds);
        let first = seconds(first_ns);
        return Err(anyhow!(
            "{shown}: no pose, from {from} to {to} s, has the stamp of a scan with a true pose, the first of {bag} at {first} s; --answer-gap-s interpolates"
        ));
    }
    let costs = Evaluation {
        scans,
        ..Evaluation::default()
    };
    let reached = costs.with(&[judged]);
    let figures = Figures {
        bag,
        answers: given.count(),
        scans,
        truths: reached.truths,
        answered: pairs.len() as u64,
        success_50cm_10deg: reached.success_50cm_10deg,
        success_20cm_3deg: reached.success_20cm_3deg,
        unique: reached.unique,
        unique_wrong: reached.unique_wrong,
        wrong_scans,
        error_m: reached.error_m,
        error_deg: reached.error_deg,
        trajectory: Samples::of(&pairs).figures(),
        probabilities: reached.probabilities.clone(),
    };
    Ok((figures, reached))
}

impl Figures {
    pub(super) fn text(&self) -> String {
        let is_given = self.probabilities.iter().any(|said| said.answers > 0);
        let trust = match is_given {
            true => format!("\n{}", trust::table(&self.probabilities)),
            false => String::new(),
        };
        let spread = |spread: Spread, decimals| {
            [spread.median, spread.p90]
                .map(|error| text::number(error, decimals))
                .join(" / ")
        };
        format!(
            "{}\n  truths {}, with an answer {} of the {} in the file\n  \
             within 0.5 m and 10° {} %, within 0.2 m and 3° {} %\n  \
             Unique {}, of them wrong {}, off by more than 1 m or 25° {}\n  \
             error of the right ones, median / p90: {} m, {}°\n  trajectory, {}\n{trust}",
            self.bag,
            self.truths,
            self.answered,
            self.answers,
            text::percent(self.success_50cm_10deg),
            text::percent(self.success_20cm_3deg),
            self.unique,
            self.unique_wrong,
            self.wrong_scans,
            spread(self.error_m, 3),
            spread(self.error_deg, 2),
            self.trajectory.text(),
        )
    }
}
