//! Simulates the faults of a bad line or a bad device.
//!
//! Pure: changes telegrams with a seeded random generator, so that a run can be repeated.

use std::str::FromStr;
use std::time::Duration;

use command_line::number;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

/// Average number of telegrams per stall, if stalls are enabled.
const STALL_EVERY: f64 = 100.0;
/// Longest garbage before a telegram, bytes.
const GARBAGE: usize = 64;

#[derive(Debug, Clone, Default, PartialEq)]
pub struct FaultPlan {
    /// Share of telegrams in which one bit is flipped, 0 to 1.
    pub crc: f64,
    /// Share of telegrams that are not sent, 0 to 1.
    pub drop: f64,
    /// Share of telegrams with garbage before them, 0 to 1.
    pub garbage: f64,
    pub stall: Option<Duration>,
    /// Interval between restarts of the device.
    pub reset: Option<Duration>,
    /// True if telegrams are sent in pieces.
    pub split: bool,
    /// True if several telegrams are sent at once.
    pub merge: bool,
}

impl FromStr for FaultPlan {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let probability = number(0.0..=1.0, "as a share");
        let mut plan = FaultPlan::default();
        for fault in text.split(',').filter(|fault| !fault.is_empty()) {
            match fault.split_once('=') {
                Some(("crc", value)) => plan.crc = probability(value)?,
                Some(("drop", value)) => plan.drop = probability(value)?,
                Some(("garbage", value)) => plan.garbage = probability(value)?,
                Some(("stall", value)) => plan.stall = Some(duration(value)?),
                Some(("reset", value)) => plan.reset = Some(duration(value)?),
                None if fault == "split" => plan.split = true,
                None if fault == "merge" => plan.merge = true,
                _ => {
                    return Err(format!(
                        "{fault:?} is not a fault: allowed are crc=, drop=, garbage=, stall=, \
                         reset=, split and merge"
                    ));
                }
            }
        }
        Ok(plan)
    }
}

fn duration(text: &str) -> Result<Duration, String> {
    let seconds = match text.strip_suffix("ms") {
        Some(ms) => ms.parse().map(|ms: f64| ms * 1e-3),
        None => text.strip_suffix('s').unwrap_or(text).parse(),
    };
    match seconds {
        Ok(seconds) if (0.001..=86_400.0).contains(&seconds) => {
            Ok(Duration::from_secs_f64(seconds))
        }
        _ => Err(format!("{text:?}: allowed are 1ms to 86400s")),
    }
}

#[derive(Debug)]
pub(crate) struct Faults {
    plan: FaultPlan,
    rng: Xoshiro256PlusPlus,
    silent_until_ns: i64,
    next_reset_ns: Option<i64>,
}

impl Faults {
    pub(crate) fn new(plan: FaultPlan, seed: u64, now_ns: i64) -> Self {
        let next_reset_ns = plan.reset.map(|every| now_ns + every.as_nanos() as i64);
        Faults {
            plan,
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
            silent_until_ns: i64::MIN,
            next_reset_ns,
        }
    }

    /// Damages or removes the telegram from `start` to the end of `out`. Returns true if the
    /// telegram is intact, possibly after garbage.
    pub(crate) fn damage(&mut self, out: &mut Vec<u8>, start: usize, now_ns: i64) -> bool {
        let stalls = self.plan.stall.is_some() && self.happens(1.0 / STALL_EVERY);
        if now_ns < self.silent_until_ns || self.happens(self.plan.drop) {
            out.truncate(start);
            return false;
        }
        if let (true, Some(stall)) = (stalls, self.plan.stall) {
            self.silent_until_ns = now_ns + stall.as_nanos() as i64;
        }
        let is_damaged = self.happens(self.plan.crc) && out.len() > start;
        if is_damaged {
            let at = self.rng.random_range(start..out.len());
            let bit = self.rng.random_range(0..8);
            if let Some(byte) = out.get_mut(at) {
                *byte ^= 1 << bit;
            }
        }
        if self.happens(self.plan.garbage) {
            let count = self.rng.random_range(1..=GARBAGE);
            let garbage = self.noise(count);
            out.splice(start..start, garbage);
        }
        !is_damaged
    }

    /// Returns true if the pending data should wait for more.
    pub(crate) fn holds_back(&mut self) -> bool {
        self.plan.merge && self.happens(0.5)
    }

    /// Returns the number of bytes to write at once, of this many pending.
    pub(crate) fn piece(&mut self, bytes: usize) -> usize {
        match self.plan.split && bytes > 1 {
            true => self.rng.random_range(1..=bytes),
            false => bytes,
        }
    }

    pub(crate) fn resets(&mut self, now_ns: i64) -> bool {
        let (Some(at_ns), Some(every)) = (self.next_reset_ns, self.plan.reset) else {
            return false;
        };
        if now_ns < at_ns {
            return false;
        }
        self.next_reset_ns = Some(now_ns + every.as_nanos() as i64);
        true
    }

    /// Returns random bytes, as received at a wrong baud rate.
    pub(crate) fn noise(&mut self, bytes: usize) -> Vec<u8> {
        (0..bytes).map(|_| self.rng.random()).collect()
    }

    fn happens(&mut self, share: f64) -> bool {
        share > 0.0 && self.rng.random_bool(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(plan: &str) -> Faults {
        Faults::new(plan.parse().unwrap(), 7, 0)
    }

    /// Applies the faults to a thousand telegrams of fifty zeros.
    fn play(plan: &str) -> Vec<Vec<u8>> {
        let mut faults = faults(plan);
        let mut all = Vec::new();
        for now_ns in 0..1000 {
            let mut out = vec![1; 3];
            out.extend([0; 50]);
            faults.damage(&mut out, 3, now_ns * 1_000_000);
            assert_eq!(out[..3], [1; 3], "what was there before stays");
            all.push(out[3..].to_vec());
        }
        all
    }

    #[test]
    fn a_plan_as_it_is_written() {
        let plan: FaultPlan = "crc=0.01,drop=0.02,garbage=0.001,stall=5s,reset=30s,split,merge"
            .parse()
            .unwrap();
        assert_eq!((plan.crc, plan.drop, plan.garbage), (0.01, 0.02, 0.001));
        assert_eq!(plan.stall, Some(Duration::from_secs(5)));
        assert_eq!(plan.reset, Some(Duration::from_secs(30)));
        assert!(plan.split && plan.merge);
        assert_eq!(
            "stall=20ms".parse::<FaultPlan>().unwrap().stall,
            Some(Duration::from_millis(20))
        );
        for wrong in ["crc", "crc=-1", "drop=x", "stall=0s", "split=1", "noise"] {
            assert!(wrong.parse::<FaultPlan>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn each_fault_comes_about_as_often_as_wanted() {
        let count = |plan: &str, is_hit: fn(&Vec<u8>) -> bool| {
            play(plan)
                .iter()
                .filter(|telegram| is_hit(telegram))
                .count()
        };
        // At a tenth, four standard deviations of a thousand draws are 38.
        let near = 62..=138;
        let one_bit = |t: &Vec<u8>| t.iter().map(|byte| byte.count_ones()).sum::<u32>() == 1;
        assert!(near.contains(&count("crc=0.1", one_bit)));
        assert!(near.contains(&count("drop=0.1", Vec::is_empty)));
        assert!(near.contains(&count("garbage=0.1", |t| t.len() > 50)));
    }

    #[test]
    fn a_stall_is_silence_for_its_time() {
        let sent: Vec<bool> = play("stall=20ms").iter().map(|t| !t.is_empty()).collect();
        let first = sent.iter().position(|sent| !sent).unwrap();
        // The telegram before it started the stall; those of 20 ms are missing.
        assert!(sent[first..first + 19].iter().all(|sent| !sent));
        assert!(sent[first + 19]);
    }

    #[test]
    fn the_device_starts_again_each_time() {
        let mut faults = faults("reset=1s");
        let times = [0, 999, 1000, 1001, 1999, 2000].map(|ms| ms * 1_000_000);
        let resets = times.map(|now_ns| faults.resets(now_ns));
        assert_eq!(resets, [false, false, true, false, false, true]);
    }
}
