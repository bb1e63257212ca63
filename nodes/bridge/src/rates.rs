//! Rate limits of the topics sent.
//!
//! Messages beyond the limit are dropped, not delayed: a reader on a slow link needs current data.
//! Topics kept for late joiners have no limit: each message is valid until the next one, so none
//! may be dropped.

use std::str::FromStr;

use messages::{Topic, topic};
use network_payload::{Visit, Wire};

#[derive(Debug, Clone, PartialEq)]
pub struct Rate {
    pub topic: String,
    /// Messages per second, 0.001 to 10,000.
    pub hz: f64,
}

impl FromStr for Rate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, hz) = text.split_once('=').ok_or("allowed is TOPIC=HZ")?;
        if network_payload::by_name(name, IsKept) != Some(false) {
            let live = topic::NAMES.iter().copied();
            let live = live.filter(|name| network_payload::by_name(name, IsKept) == Some(false));
            let allowed = live.collect::<Vec<_>>().join(", ");
            return Err(format!(
                "{name:?} is not a live topic: allowed are {allowed}"
            ));
        }
        let hz: f64 = hz
            .parse()
            .ok()
            .filter(|hz| (0.001..=10_000.0).contains(hz))
            .ok_or_else(|| format!("{hz:?} messages a second: allowed are 0.001 to 10000"))?;
        let topic = name.to_owned();
        Ok(Rate { topic, hz })
    }
}

struct IsKept;

impl Visit for IsKept {
    type Output = bool;

    fn visit<T: Wire>(self) -> bool {
        T::KEPT
    }
}

/// Rate limiter of one topic. Pure: the time is an argument.
#[derive(Debug)]
pub(crate) struct Limit {
    period_ns: i64,
    due_ns: i64,
}

impl Limit {
    /// Creates the limiter of topic `T` from the configured rates; the last matching one counts.
    pub(crate) fn of<T: Topic>(rates: &[Rate]) -> Self {
        let default = (T::NAME == topic::Field::NAME).then_some(2.0);
        let given = rates.iter().rfind(|rate| rate.topic == T::NAME);
        let hz = given.map(|rate| rate.hz).or(default);
        Limit {
            period_ns: hz.map_or(0, |hz| (1e9 / hz) as i64),
            due_ns: i64::MIN,
        }
    }

    /// Returns true if a message may be sent at `now_ns`, and counts it.
    ///
    /// A message that is less than a period late does not delay the next ones, so that the average
    /// rate is reached; after a longer pause there is no catching up.
    pub(crate) fn admits(&mut self, now_ns: i64) -> bool {
        if now_ns < self.due_ns {
            return false;
        }
        let late_ns = now_ns.saturating_sub(self.due_ns);
        let start_ns = if late_ns < self.period_ns {
            self.due_ns
        } else {
            now_ns
        };
        self.due_ns = start_ns.saturating_add(self.period_ns);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    fn admitted(rates: &[&str], every_ms: i64, during_ms: i64) -> usize {
        let rates: Vec<Rate> = rates.iter().map(|rate| rate.parse().unwrap()).collect();
        let mut limit = Limit::of::<topic::Scan>(&rates);
        let times = (0..during_ms / every_ms).map(|i| 5_000 * MS + i * every_ms * MS);
        times.filter(|&now| limit.admits(now)).count()
    }

    #[test]
    fn as_many_go_as_are_allowed() {
        assert_eq!(admitted(&[], 10, 1_000), 100);
        assert_eq!(
            admitted(&["scan=50", "scan=5", "odometry=1"], 10, 10_000),
            50
        );
        // 30 of 40 per second cannot be reached by dropping every other one.
        assert_eq!(admitted(&["scan=30"], 25, 10_000), 300);
        assert_eq!(admitted(&["scan=100"], 25, 1_000), 40);
    }

    #[test]
    fn the_image_is_slow_by_default() {
        assert_eq!(Limit::of::<topic::Field>(&[]).period_ns, 500 * MS);
        let fast = ["field=10".parse().unwrap()];
        assert_eq!(Limit::of::<topic::Field>(&fast).period_ns, 100 * MS);
    }

    #[test]
    fn what_is_no_rate_is_refused() {
        for text in [
            "scan", "scan=0", "scan=NaN", "scan=1e9", "scan=-1", "=1", "map=1",
        ] {
            assert!(text.parse::<Rate>().is_err(), "{text}");
        }
    }
}
