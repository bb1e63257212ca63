//! Decides when to repeat an unanswered command. Pure: the caller passes the time.

/// Number of times that a command is sent before it counts as unanswered.
pub(crate) const TRIES: u32 = 3;

#[derive(Debug, Default)]
pub(crate) struct Attempts {
    sent_ns: Option<i64>,
    count: u32,
}

#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Attempt {
    Send,
    Wait,
    GiveUp,
}

impl Attempts {
    /// Returns the next step at `now_ns` for a command whose answer takes up to `patience_ns`.
    pub(crate) fn next(&mut self, now_ns: i64, patience_ns: i64) -> Attempt {
        match self.sent_ns {
            Some(sent_ns) if now_ns - sent_ns < patience_ns => Attempt::Wait,
            Some(_) if self.count >= TRIES => Attempt::GiveUp,
            _ => {
                self.sent_ns = Some(now_ns);
                self.count += 1;
                Attempt::Send
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_times_with_a_pause_then_no_more() {
        let mut attempts = Attempts::default();
        let times = [0, 9, 10, 19, 20, 29, 30];
        let seen = times.map(|now| attempts.next(now, 10));
        use Attempt::{GiveUp, Send, Wait};
        assert_eq!(seen, [Send, Wait, Send, Wait, Send, Wait, GiveUp]);
    }
}
