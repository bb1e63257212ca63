//! Selects the part of a recording to replay: channels, their names, and times.

use std::fmt;
use std::str::FromStr;

use recording::Recording;

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remap {
    from: String,
    to: String,
}

impl FromStr for Remap {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(":=") {
            Some((from, to)) if !from.is_empty() && !to.is_empty() => Ok(Remap {
                from: from.to_owned(),
                to: to.to_owned(),
            }),
            _ => Err("allowed is FROM:=TO, as /front/scan:=/scan".to_owned()),
        }
    }
}

impl fmt::Display for Remap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:={}", self.from, self.to)
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selection {
    topics: Vec<String>,
    remap: Vec<Remap>,
    /// First and last log time, in nanoseconds.
    from_ns: i64,
    to_ns: i64,
}

impl Selection {
    pub fn all() -> Self {
        Selection {
            topics: Vec::new(),
            remap: Vec::new(),
            from_ns: i64::MIN,
            to_ns: i64::MAX,
        }
    }

    /// Selects only these topics, or all if there are none, and renames some of them.
    pub fn of(topics: &[String], remap: &[Remap]) -> Self {
        Selection {
            topics: topics.to_owned(),
            remap: remap.to_owned(),
            ..Selection::all()
        }
    }

    /// Limits the selection to a period, given in seconds after the recording's first message, at
    /// most 1e9.
    #[must_use]
    pub fn within(self, recording: &Recording, start: Option<f64>, end: Option<f64>) -> Self {
        let first_ns = recording.time_range_ns().map_or(0, |(first, _)| first);
        // At most 1e18, which fits.
        let after = |seconds: f64| first_ns.saturating_add((seconds * 1e9) as i64);
        Selection {
            from_ns: start.map_or(i64::MIN, after),
            to_ns: end.map_or(i64::MAX, after),
            ..self
        }
    }

    /// Name of a channel after renaming; `None` if it is left out.
    pub fn name_of(&self, topic: &str) -> Option<String> {
        if !self.topics.is_empty() && !self.topics.iter().any(|meant| meant == topic) {
            return None;
        }
        let remap = self.remap.iter().find(|remap| remap.from == topic);
        // A channel is left out if another one takes its name.
        let is_taken = || self.remap.iter().any(|remap| remap.to == topic);
        match remap {
            Some(remap) => Some(remap.to.clone()),
            None if is_taken() => None,
            None => Some(topic.to_owned()),
        }
    }

    pub fn covers(&self, log_time_ns: i64) -> bool {
        (self.from_ns..=self.to_ns).contains(&log_time_ns)
    }

    /// Selected topics that the recording does not have.
    pub fn unknown(&self, recording: &Recording) -> Vec<String> {
        let named = self
            .topics
            .iter()
            .chain(self.remap.iter().map(|remap| &remap.from));
        let is_unknown = |name: &&String| !recording.channels().any(|c| *c.topic == ***name);
        named.filter(is_unknown).cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_left_out_and_renamed() {
        let all = Selection::all();
        assert_eq!(all.name_of("/scan").as_deref(), Some("/scan"));
        let some = Selection {
            topics: vec!["/front".to_owned(), "/scan".to_owned()],
            remap: vec!["/front:=/scan".parse().unwrap()],
            ..Selection::all()
        };
        assert_eq!(some.name_of("/front").as_deref(), Some("/scan"));
        assert_eq!(some.name_of("/scan"), None, "its name is taken");
        assert_eq!(some.name_of("/odom"), None);
        assert!(":=/scan".parse::<Remap>().is_err());
    }
}
