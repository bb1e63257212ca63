//! Calibration: compares the probabilities of results with how often they were right. Pure.

use schemars::JsonSchema;
use serde::Serialize;

use crate::text::{percent, share};

/// Upper ends of the ranges of probability; narrower near 1, where users decide.
const ENDS: [f64; 8] = [0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.99, 1.0];

/// Results whose best place had a probability in one range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Said {
    /// The range: more than `from`, at most `to`.
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) answers: u64,
    /// Number of results that were right.
    pub(crate) right: u64,
    /// Mean probability of these results.
    pub(crate) mean: Option<f64>,
}

#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Trust {
    answers: [u64; ENDS.len()],
    right: [u64; ENDS.len()],
    /// Sums of the probabilities.
    said: [f64; ENDS.len()],
}

impl Trust {
    pub(crate) fn add(&mut self, probability: f64, is_right: bool) {
        // Rounding may make a probability slightly more than 1.
        let i = ENDS.iter().position(|&end| probability <= end);
        let i = i.unwrap_or(ENDS.len() - 1);
        self.answers[i] += 1;
        self.right[i] += u64::from(is_right);
        self.said[i] += probability;
    }

    pub(crate) fn merge(&mut self, other: &Trust) {
        for i in 0..ENDS.len() {
            self.answers[i] += other.answers[i];
            self.right[i] += other.right[i];
            self.said[i] += other.said[i];
        }
    }

    pub(crate) fn said(&self) -> [Said; ENDS.len()] {
        std::array::from_fn(|i| {
            let answers = self.answers[i];
            Said {
                from: if i == 0 { 0.0 } else { ENDS[i - 1] },
                to: ENDS[i],
                answers,
                right: self.right[i],
                mean: (answers > 0).then(|| self.said[i] / answers as f64),
            }
        })
    }
}

/// Formats a table of the ranges with results, highest probability first.
pub(crate) fn table(ranges: &[Said]) -> String {
    let mut lines = "probability  answers  mean %  right %\n".to_owned();
    for said in ranges.iter().rev().filter(|said| said.answers > 0) {
        let range = format!("{:.2}..{:.2}", said.from, said.to);
        let (mean, right) = (percent(said.mean), percent(share(said.right, said.answers)));
        let answers = said.answers;
        lines += &format!("{range:>11}  {answers:>7}  {mean:>6}  {right:>7}\n");
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_without_answers_have_no_line() {
        let mut trust = Trust::default();
        for (probability, is_right) in [(0.5, false), (1.0, true), (0.98, true), (0.97, false)] {
            trust.add(probability, is_right);
        }
        assert_eq!(
            format!("\n{}", table(&trust.said())),
            "
probability  answers  mean %  right %
 0.99..1.00        1   100.0    100.0
 0.95..0.99        2    97.5     50.0
 0.40..0.60        1    50.0      0.0
"
        );
    }
}
