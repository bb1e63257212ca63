//! Which scan is due when.
//!
//! Pure: the caller passes the clock in. Each scan is due at its original
//! distance from the first one, so that no error adds up.

/// Plays times that ascend.
#[derive(Debug)]
pub(crate) struct Player {
    /// Of each scan, after the first one, nanoseconds.
    times_ns: Vec<i64>,
    /// From the last scan to the first of the next round.
    gap_ns: i64,
    rate: f64,
    looped: bool,
    started_ns: Option<i64>,
    /// Scans that were due so far, of all rounds.
    counter: u64,
}

impl Player {
    /// `times_ns` are at least one.
    pub(crate) fn new(times_ns: &[i64], rate: f64, looped: bool) -> Self {
        let first = times_ns.first().copied().unwrap_or(0);
        let times_ns: Vec<i64> = times_ns
            .iter()
            .map(|time| time.saturating_sub(first))
            .collect();
        let gaps = times_ns.len().saturating_sub(1).max(1) as i64;
        let gap_ns = (times_ns.last().copied().unwrap_or(0) / gaps).max(1_000_000);
        Player {
            times_ns,
            gap_ns,
            rate,
            looped,
            started_ns: None,
            counter: 0,
        }
    }

    /// Begins, unless it has begun.
    pub(crate) fn start(&mut self, now_ns: i64) {
        self.started_ns.get_or_insert(now_ns);
    }

    /// When the next scan is due; `None` before the start and after the end.
    pub(crate) fn due_ns(&self) -> Option<i64> {
        let started_ns = self.started_ns?;
        if self.is_over() {
            return None;
        }
        let scans = self.times_ns.len() as u64;
        let round_ns = self.times_ns.last()? + self.gap_ns;
        let recorded_ns = self.times_ns.get((self.counter % scans) as usize)?;
        let since_ns = round_ns * (self.counter / scans) as i64 + recorded_ns;
        Some(started_ns + (since_ns as f64 / self.rate) as i64)
    }

    /// The scan that is due at `now_ns`: its index and how many were before it.
    pub(crate) fn take(&mut self, now_ns: i64) -> Option<(usize, u64)> {
        if self.due_ns()? > now_ns {
            return None;
        }
        let counter = self.counter;
        self.counter += 1;
        Some(((counter % self.times_ns.len() as u64) as usize, counter))
    }

    /// Whether nothing comes any more.
    pub(crate) fn is_over(&self) -> bool {
        !self.looped && self.counter >= self.times_ns.len() as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    #[test]
    fn the_original_distances_from_the_start_on() {
        let mut player = Player::new(&[700 * MS, 800 * MS, 950 * MS], 0.5, false);
        assert_eq!(player.take(i64::MAX), None, "nobody wants scans yet");
        player.start(5 * MS);
        player.start(77 * MS);
        assert_eq!(player.take(5 * MS), Some((0, 0)));
        assert_eq!(player.take(204 * MS), None);
        assert_eq!(player.take(205 * MS), Some((1, 1)));
        // A late look does not shift what comes after.
        assert_eq!(player.due_ns(), Some(505 * MS));
        assert_eq!(player.take(600 * MS), Some((2, 2)));
        assert!(player.is_over() && player.due_ns().is_none());
    }

    #[test]
    fn a_new_round_keeps_the_usual_distance() {
        let mut player = Player::new(&[0, 100 * MS, 200 * MS], 1.0, true);
        player.start(0);
        for step in 0..10 {
            assert_eq!(player.due_ns(), Some(step * 100 * MS));
            let expected = Some(((step % 3) as usize, step as u64));
            assert_eq!(player.take(step * 100 * MS), expected);
        }
        assert!(!player.is_over());
    }
}
