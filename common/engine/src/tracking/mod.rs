//! A pose that stays: scans and odometry over time, where one scan alone is ambiguous,
//! or wrong.
//!
//! The tracker keeps a few places where the robot may be. Every scan moves the place
//! that is believed; at *key scans*, some decimetres apart, all places are predicted by
//! odometry, fitted to the scan and weighed against each other, and places that a
//! search found are added:
//!
//! ```text
//! odometry ─ way ─► predict ─┐
//! scan ─ ends ───────────────┴─► seen: fit from the prediction ─► places ─► weigh ─► verdict
//! search ─ candidates ─────────────────────────────────────────────┘
//! ```
//!
//! What one key scan says is capped, for the errors of a map repeat from scan to scan:
//! one place is the only one when several key scans agree on it. It decides by stamps
//! and the order of calls alone, so that the same calls give the same poses.
//!
//! Several maps are tracked on together: a place is on one of them, and the robot goes from one
//! to another where a transition is, or where a search finds it there.
//!
//! docs/tracking.md explains the method and what each setting is for. The recursive
//! weighing of hypotheses is that of multi-hypothesis localization (Jensfelt and
//! Kristensen, "Active global localization for a mobile robot using multiple
//! hypothesis tracking", IEEE Trans. Robotics and Automation 17(5), 2001), with
//! evidence that is capped.

mod belief;
mod config;
mod driven_path;
mod limits;
mod matching;
mod method;
mod nowhere;
mod particles;
mod place;
mod places;
mod report;
mod seen;
mod transition;
mod verdict;

pub use config::TrackingConfig;
pub use matching::ScanMatcher;
pub use method::{FollowConfig, Follower};
pub use particles::ParticleTracker;
pub use place::Candidate;
pub use report::Report;
pub use seen::Seen;

use belief::Belief;
use driven_path::DrivenPath;
use geometry::{Covariance, Pose};
use messages::Transition;
use nowhere::is_blind;
use place::Place;
use places::Places;
use transition::other_side;

/// What is needed of a search before a scan is done with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// Nothing.
    Nothing,
    /// What a search for this scan finds.
    ThisScan,
    /// What the search finds that was asked for by [`Tracker::asks_ahead`].
    EarlierScan,
}

/// A pose that is believed is checked by a search every this many key scans.
const CHECKED_EVERY: u32 = 10;

/// What such a search finds counts this many scans later: nobody waits for it.
const COUNTS_AFTER: u32 = 2;

/// Scans of fewer beams say nothing.
pub const MIN_BEAMS: usize = 10;

/// Finds the robot, and keeps its pose.
#[derive(Debug, Clone)]
pub struct Tracker {
    config: TrackingConfig,
    /// Between the maps.
    transitions: Vec<Transition>,
    places: Places,
    belief: Belief,
    /// Where odometry is missing.
    matcher: ScanMatcher,
    /// Since the last key scan.
    since_key: DrivenPath,
    /// Since the last scan that was looked at.
    since_scan: DrivenPath,
    /// Since the scan that was asked for ahead, and how many scans are left.
    ahead: Option<(DrivenPath, u32)>,
    asks_ahead: bool,
    keys_since_search: u32,
    is_key: bool,
    is_blank: bool,
    /// Whether the place that is believed lies in a transition.
    is_in_transition: bool,
    needs_search: bool,
    /// Whether odometry said how the robot moved to the last scan.
    has_odometry: bool,
    /// Where the robot should be at the next scan, and by how much that leads.
    expected: Option<((u32, Pose), Covariance, f64)>,
}

impl Tracker {
    /// Nothing is known yet.
    #[must_use]
    pub fn new(config: TrackingConfig) -> Self {
        Tracker {
            config,
            transitions: Vec::new(),
            places: Places::new(config),
            belief: Belief::new(config),
            matcher: ScanMatcher::default(),
            since_key: DrivenPath::default(),
            since_scan: DrivenPath::default(),
            ahead: None,
            asks_ahead: false,
            keys_since_search: 0,
            is_key: false,
            is_blank: false,
            is_in_transition: false,
            needs_search: false,
            has_odometry: false,
            expected: None,
        }
    }

    /// The same on several maps, between which the robot may go where these transitions are.
    #[must_use]
    pub fn with_transitions(mut self, transitions: Vec<Transition>) -> Self {
        self.transitions = transitions;
        self
    }

    /// Forgets all but the settings and the transitions.
    fn start_over(&mut self) {
        let transitions = std::mem::take(&mut self.transitions);
        *self = Tracker::new(self.config).with_transitions(transitions);
    }

    /// Forgets all but where the robot should be at the next scan, on the map of a number:
    /// that place is tried first and leads by this much, natural logarithm of odds, over what
    /// a search finds. It is not believed before scans confirm it.
    pub fn expect(&mut self, at: (u32, Pose), covariance: Covariance, lead: f64) {
        self.start_over();
        self.expected = Some((at, covariance, lead));
    }

    /// Starts from a pose that is believed, on the map of a number, with its covariance.
    pub fn start_at(
        &mut self,
        seen: &[Seen<'_>],
        (map, pose): (u32, Pose),
        covariance: Covariance,
    ) {
        self.start_over();
        let id = self.places.start_at(seen, (map, (pose, covariance.0)));
        self.belief.believe(id);
    }

    /// Takes the next scan, as it is seen on each of the maps, by their numbers, and how the
    /// target frame moved since the one before, if odometry measures; otherwise scans are
    /// matched. The scan is done with at [`Tracker::finish`].
    ///
    /// # Panics
    /// If there is no map.
    pub fn begin(&mut self, seen: &[Seen<'_>], stamp_ns: i64, moved: Option<Pose>) -> Need {
        let need = self.take_up(seen, stamp_ns, moved);
        self.needs_search = need == Need::ThisScan;
        need
    }

    fn take_up(&mut self, seen: &[Seen<'_>], stamp_ns: i64, moved: Option<Pose>) -> Need {
        self.is_blank = seen[0].ends.beams() < MIN_BEAMS;
        let by_odometry = moved;
        let moved = match self.is_blank {
            true => by_odometry,
            false => self.matcher.moved(&seen[0], by_odometry, &self.config),
        };
        let later_s = self.belief.go_on(stamp_ns, moved);
        // To a first scan, or that of a start, odometry has nothing to say.
        let has_odometry = by_odometry.is_some() && later_s.is_some();
        let had_odometry = std::mem::replace(&mut self.has_odometry, has_odometry);
        let is_interrupted = had_odometry && by_odometry.is_none();
        let seconds = later_s.filter(|_| is_interrupted).unwrap_or(0.0);
        if is_interrupted {
            self.belief.interrupt();
        }
        self.asks_ahead = false;
        for path in [&mut self.since_key, &mut self.since_scan] {
            path.add(moved, seconds);
        }
        let mut is_due = false;
        if let Some((path, left)) = &mut self.ahead {
            path.add(moved, seconds);
            *left = left.saturating_sub(1);
            is_due = *left == 0;
        }
        if self.is_blank {
            return Need::Nothing;
        }
        if let Some(((map, pose), covariance, lead)) = self.expected.take() {
            self.places.expect(seen, (map, (pose, covariance.0)), lead);
            self.since_key = DrivenPath::default();
            self.is_key = true;
            return Need::ThisScan;
        }
        let path = std::mem::take(&mut self.since_scan);
        let was_doubtful = self.belief.is_doubtful();
        let is_lost_sight = self.has_lost_sight(&path);
        if is_interrupted || is_lost_sight {
            self.places.forget();
        }
        if is_lost_sight {
            self.belief.interrupt();
        }
        if let Some(id) = self.belief.place() {
            self.places.follow(id, seen, (&path, &self.since_key));
        }
        self.belief.look_at(&self.places);
        let is_suspicious = self.belief.is_doubtful();
        let has_entered = self.has_entered();
        let is_new =
            (is_suspicious && !was_doubtful) || is_interrupted || is_lost_sight || has_entered;
        self.is_key = self.is_far() || is_new || is_due;
        match () {
            () if !self.is_key => Need::Nothing,
            () if is_suspicious || !self.belief.is_checked() => {
                self.ahead = None;
                Need::ThisScan
            }
            () if is_due => Need::EarlierScan,
            () => Need::Nothing,
        }
    }

    fn believed(&self) -> Option<&Place> {
        self.belief.place().and_then(|id| self.places.get(id))
    }

    /// Whether the place that is believed has come to lie in a transition with this scan. The
    /// robot may stop there, and be on the other map before it drives on.
    fn has_entered(&mut self) -> bool {
        let is_in = self.believed().is_some_and(|place| {
            let at = (place.map, place.pose);
            let mut transitions = self.transitions.iter();
            transitions.any(|transition| other_side(transition, at, place.covariance).is_some())
        });
        !std::mem::replace(&mut self.is_in_transition, is_in) && is_in
    }

    /// Whether the robot is far enough from the last key scan, by odometry or by where the
    /// scans fit.
    fn is_far(&self) -> bool {
        self.places.is_empty()
            || self.since_key.is_far(&self.config)
            || self.believed().is_some_and(|place| place.novelty >= 1.0)
    }

    /// Whether odometry carried the believed place so far that it may be several.
    fn has_lost_sight(&self, path: &DrivenPath) -> bool {
        let by_odometry = self.believed().filter(|_| path.unknown_s.is_none());
        by_odometry.is_some_and(|place| {
            let noise = self.config.odometry_error;
            is_blind(&path.predict((place.pose, place.covariance), noise))
        })
    }

    /// Is done with the scan, with what the search found that was needed; `None` where none
    /// was, or where it had no answer: then no place is the only one before a later search
    /// has one, for the robot may be where nobody looked.
    pub fn finish(&mut self, seen: &[Seen<'_>], found: Option<&[Candidate]>) {
        if self.is_blank {
            self.belief.see_nothing(&self.since_scan);
            return;
        }
        if self.is_key {
            let path = std::mem::take(&mut self.since_key);
            let due = self.ahead.take_if(|(_, left)| *left == 0);
            match (due, found) {
                (_, None) => {}
                (Some((since, _)), Some(found)) => self.places.take_ahead(seen, &since, found),
                (None, Some(found)) => self.places.take(seen, found),
            }
            if found.is_some() {
                self.keys_since_search = 0;
            }
            self.belief.search_ended(self.needs_search, found.is_some());
            let seen = (seen, &self.transitions[..]);
            self.places.weigh(seen, &path, &mut self.belief);
            self.keys_since_search += 1;
        }
        self.belief.conclude(&self.places, self.is_key);
        self.asks_ahead = self.is_key
            && self.ahead.is_none()
            && self.belief.is_sound()
            && self.keys_since_search >= CHECKED_EVERY;
        if self.asks_ahead {
            self.ahead = Some((DrivenPath::default(), COUNTS_AFTER));
        }
    }

    /// Whether a search for the scan that was done with last is needed a few scans
    /// later, see [`Need::EarlierScan`].
    #[must_use]
    pub fn asks_ahead(&self) -> bool {
        self.asks_ahead
    }

    /// Where the robot is, and how sure that is.
    #[must_use]
    pub fn report(&self) -> Report {
        let unseen = self.is_blank.then_some(&self.since_scan);
        self.belief.report(&self.places, &self.since_key, unseen)
    }
}

#[cfg(test)]
mod tests;
