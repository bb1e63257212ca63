//! What the node waits for, in words. Pure.

/// So long an input may be silent before that is said, nanoseconds.
const PATIENCE_NS: i64 = 3_000_000_000;

/// An input: its topic, whether anybody publishes it, and how many messages have come.
pub(super) struct Input<'a> {
    pub(super) topic: &'a str,
    pub(super) has_publisher: bool,
    pub(super) received: u64,
}

/// Notices inputs that are silent.
#[derive(Debug, Default)]
pub(super) struct Waiting {
    /// Of each input, how many messages there were, and since when.
    seen: Vec<(u64, i64)>,
    said: String,
}

impl Waiting {
    /// What is to be said, if it is something new; maps come once, scans all the time.
    pub(super) fn look(
        &mut self,
        map: &Input<'_>,
        scans: &[Input<'_>],
        now_ns: i64,
    ) -> Option<&str> {
        self.seen.resize(scans.len() + 1, (0, now_ns));
        let mut words = Vec::new();
        let inputs = std::iter::once(map).chain(scans);
        for ((index, input), (count, since_ns)) in inputs.enumerate().zip(&mut self.seen) {
            if *count != input.received {
                (*count, *since_ns) = (input.received, now_ns);
            }
            let is_silent = now_ns.saturating_sub(*since_ns) >= PATIENCE_NS;
            let is_enough = index == 0 && input.received > 0;
            if is_silent && !is_enough {
                let why = match (input.has_publisher, input.received) {
                    (false, _) => "no publisher",
                    (true, 0) => "a publisher, and no message yet",
                    (true, _) => "no message any more",
                };
                words.push(format!("{}: {why}", input.topic));
            }
        }
        let words = words.join(", ");
        if words == self.said {
            return None;
        }
        self.said = words;
        Some(&self.said)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: i64 = 1_000_000_000;

    fn input(topic: &str, has_publisher: bool, received: u64) -> Input<'_> {
        Input {
            topic,
            has_publisher,
            received,
        }
    }

    #[test]
    fn silence_is_said_once_and_so_is_its_end() {
        let mut waiting = Waiting::default();
        let mut look = |map: u64, has_laser: bool, scans: u64, at: i64| {
            let map = input("/map", map > 0, map);
            let scans = [input("/scan", has_laser, scans)];
            waiting.look(&map, &scans, at * S).map(str::to_owned)
        };
        assert_eq!(look(0, false, 0, 10), None);
        assert_eq!(look(0, false, 0, 12), None, "nobody is late yet");
        let words = look(0, false, 0, 13).unwrap();
        assert_eq!(words, "/map: no publisher, /scan: no publisher");
        assert_eq!(look(0, false, 0, 14), None);
        assert_eq!(
            look(1, true, 0, 15).unwrap(),
            "/scan: a publisher, and no message yet"
        );
        assert_eq!(look(1, true, 1, 16).unwrap(), "");
        assert_eq!(look(1, true, 2, 18), None);
        assert_eq!(look(1, true, 2, 21).unwrap(), "/scan: no message any more");
    }
}
