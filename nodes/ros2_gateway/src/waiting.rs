//! Detection of silent inputs, and their description for the user. Pure.

/// Silence of an input after which it is reported, nanoseconds.
const PATIENCE_NS: i64 = 3_000_000_000;

/// Publisher of a topic, by how well it fits the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Publishing {
    Nobody,
    OtherType,
    OtherVersion,
    /// Best-effort or volatile publisher, while the input needs a reliable or transient local one.
    OtherQuality,
    /// Publisher whose messages are taken.
    Expected,
}

/// An input: its topic, its publisher, and the number of messages received.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Input<'a> {
    pub(crate) topic: &'a str,
    pub(crate) publishing: Publishing,
    pub(crate) received: u64,
    /// True if one message is enough.
    pub(crate) comes_once: bool,
    /// Frame whose transforms are counted, for /tf.
    pub(crate) from_frame: Option<&'a str>,
}

impl Input<'_> {
    fn why(&self) -> String {
        let why = match (self.publishing, self.received) {
            (Publishing::Expected, received) if let Some(frame) = self.from_frame => {
                let any_more = if received == 0 { "" } else { " any more" };
                return format!("no transform from {frame}{any_more}");
            }
            (Publishing::Nobody, 0) => "no publisher",
            (Publishing::OtherType, 0) => "a publisher of another type",
            (Publishing::OtherVersion, 0) => "a publisher with another version of the type",
            (Publishing::OtherQuality, 0) => "a publisher with another quality of service",
            (Publishing::Expected, 0) => "a publisher, and no message yet",
            (_, _) => "no message any more",
        };
        why.to_owned()
    }
}

#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Status<'a> {
    Flows,
    /// Some have not arrived yet, and it is too early to report them.
    Begins,
    /// Some are missing; the text describes them.
    Waits(&'a str),
}

#[derive(Debug, Default)]
pub(crate) struct Waiting {
    /// Message count of each input, and the time of its last change in nanoseconds.
    seen: Vec<(u64, i64)>,
    words: String,
}

impl Waiting {
    /// Checks all inputs, which must be the same ones at each call.
    pub(crate) fn look(&mut self, inputs: &[Input<'_>], now_ns: i64) -> Status<'_> {
        self.seen.resize(inputs.len(), (0, now_ns));
        let mut is_early = false;
        let mut words = Vec::new();
        for (input, (count, since_ns)) in inputs.iter().zip(&mut self.seen) {
            if *count != input.received {
                (*count, *since_ns) = (input.received, now_ns);
            }
            let is_silent = now_ns.saturating_sub(*since_ns) >= PATIENCE_NS;
            let has_come = input.received > 0;
            match (has_come, is_silent) {
                (true, _) if input.comes_once => {}
                (_, true) => words.push(format!("{}: {}", input.topic, input.why())),
                (true, false) => {}
                (false, false) => is_early = true,
            }
        }
        self.words = words.join(", ");
        match (self.words.is_empty(), is_early) {
            (false, _) => Status::Waits(&self.words),
            (true, true) => Status::Begins,
            (true, false) => Status::Flows,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: i64 = 1_000_000_000;

    fn input(topic: &str, publishing: Publishing, received: u64) -> Input<'_> {
        Input {
            topic,
            publishing,
            received,
            comes_once: topic == "/map",
            from_frame: (topic == "/tf").then_some("odom"),
        }
    }

    #[test]
    fn silence_is_said_and_so_is_its_end() {
        let mut waiting = Waiting::default();
        let (nobody, expected) = (Publishing::Nobody, Publishing::Expected);
        let mut look = |map: u64, laser: Publishing, scans: u64, at: i64| {
            let who = if map > 0 { expected } else { nobody };
            let inputs = [input("/map", who, map), input("/scan", laser, scans)];
            match waiting.look(&inputs, at * S) {
                Status::Flows => "flows".to_owned(),
                Status::Begins => String::new(),
                Status::Waits(words) => words.to_owned(),
            }
        };
        assert_eq!(look(0, nobody, 0, 10), "");
        assert_eq!(look(0, nobody, 0, 12), "", "nobody is late yet");
        let both = "/map: no publisher, /scan: no publisher";
        assert_eq!(look(0, nobody, 0, 13), both);
        let words = look(1, expected, 0, 15);
        assert_eq!(words, "/scan: a publisher, and no message yet");
        assert_eq!(look(1, expected, 1, 16), "flows");
        assert_eq!(look(1, expected, 2, 18), "flows");
        assert_eq!(look(1, expected, 2, 21), "/scan: no message any more");
    }

    #[test]
    fn what_is_wrong_with_an_input_is_named() {
        use Publishing::{Expected, OtherType, OtherVersion};
        for (topic, publishing, received, words) in [
            ("/scan", OtherType, 0, "another type"),
            ("/scan", OtherVersion, 0, "another version"),
            ("/tf", Publishing::Nobody, 0, "no publisher"),
            ("/tf", Expected, 0, "no transform from odom"),
            ("/tf", Expected, 7, "no transform from odom any more"),
        ] {
            let why = input(topic, publishing, received).why();
            assert!(why.contains(words), "{why}");
        }
    }

    #[test]
    fn who_needs_nothing_waits_for_nothing() {
        assert_eq!(Waiting::default().look(&[], 0), Status::Flows);
    }
}
