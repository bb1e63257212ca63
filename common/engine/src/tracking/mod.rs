//! Tracking of a pose by scans and odometry over time, for when a single scan is ambiguous or
//! wrong.
//!
//! The tracker keeps a few places where the robot may be. Every scan moves the believed place. At
//! *key scans*, some decimetres apart, all places are predicted by odometry, fitted to the scan and
//! weighed against each other, and places found by a search are added:
//!
//! ```text
//! odometry ─ path ► predict ─┐
//! scan ─ ends ───────────────┴─► seen: fit from the prediction ─► places ─► weigh ─► verdict
//! search ─ candidates ─────────────────────────────────────────────┘
//! ```
//!
//! "Nowhere" is one more hypothesis. The evidence of one key scan is capped, because the errors of
//! a map repeat from scan to scan: a place is unique when its share of all weight reaches `--sure`,
//! which takes several key scans that agree. The tracker decides by stamps and the order of calls
//! alone, so the same calls give the same poses.
//!
//! Several maps can be tracked at once: a place is on one of them, and the robot changes to another
//! map at a transition, or when a search finds it there.
//!
//! docs/tracking.md explains the method and the purpose of each setting. The recursive weighing of
//! hypotheses is that of multi-hypothesis localization (Jensfelt and Kristensen, "Active global
//! localization for a mobile robot using multiple hypothesis tracking", IEEE Trans. Robotics and
//! Automation 17(5), 2001), with capped evidence.

mod belief;
mod config;
mod driven_path;
mod matching;
mod nowhere;
mod place;
mod places;
mod posterior;
mod report;
mod seen;
mod transition;

pub use config::{Start, TrackingConfig};
pub use matching::ScanMatcher;
pub use place::Candidate;
pub use report::Report;
pub use seen::Seen;

use belief::Belief;
use driven_path::DrivenPath;
use geometry::{Covariance, Pose};
use messages::Transition;
use place::Place;
use places::{Hint, Places};
use transition::other_side;

/// Search that is needed to finish a scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// No search.
    Nothing,
    /// A search for this scan.
    ThisScan,
    /// The search that [`PlaceTracker::asks_ahead`] requested earlier.
    EarlierScan,
}

/// A believed pose is checked by a search every this many key scans.
const CHECKED_EVERY: u32 = 10;

/// Scans from a request for such a search to the use of its result, so that nothing waits for it.
const COUNTS_AFTER: u32 = 2;

/// Smallest number of beams of a usable scan.
pub const MIN_BEAMS: usize = 10;

/// State machine that keeps the places where the robot may be. Its caller searches the maps.
#[derive(Debug, Clone)]
pub struct PlaceTracker {
    config: TrackingConfig,
    /// Transitions between the maps.
    transitions: Vec<Transition>,
    places: Places,
    belief: Belief,
    /// Measures motion by scans if odometry is missing.
    matcher: ScanMatcher,
    /// Path since the last key scan.
    since_key: DrivenPath,
    /// Path since the last usable scan.
    since_scan: DrivenPath,
    /// Path since the scan whose search was requested ahead, and the scans left until its result
    /// counts.
    ahead: Option<(DrivenPath, u32)>,
    asks_ahead: bool,
    keys_since_search: u32,
    is_key: bool,
    is_blank: bool,
    /// True if the believed place is in a transition.
    is_in_transition: bool,
    needs_search: bool,
    /// Hint for the next scan.
    expected: Option<Hint>,
    /// A hint that competes with the believed place; the next search decides.
    tried: Option<Hint>,
}

impl PlaceTracker {
    /// Creates a tracker that knows no place yet.
    #[must_use]
    pub fn new(config: TrackingConfig) -> Self {
        PlaceTracker {
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
            expected: None,
            tried: None,
        }
    }

    /// Adds the transitions through which the robot may change maps.
    #[must_use]
    pub fn with_transitions(mut self, transitions: Vec<Transition>) -> Self {
        self.transitions = transitions;
        self
    }

    /// Forgets everything except the settings and the transitions.
    fn start_over(&mut self) {
        let transitions = std::mem::take(&mut self.transitions);
        *self = PlaceTracker::new(self.config).with_transitions(transitions);
    }

    /// Gives a hint: a pose, on the map with this number, at which to expect the robot at the next
    /// scan. It is believed as soon as a scan fits there and no other place within that covariance
    /// fits as well. A believed pose is kept until then; if there is none, everything else is
    /// forgotten. A hint near the believed pose, or near a hint under test, changes nothing.
    pub fn expect(&mut self, at: (u32, Pose), covariance: Covariance) {
        let hint = Hint::new(at, covariance);
        let is_near = |place: &Place| hint.is_near((place.map, place.pose));
        if self.places.believed().is_some_and(is_near) {
            (self.expected, self.tried) = (None, None);
            return;
        }
        let leads = self.places.all().first();
        let is_leading = leads.is_some_and(|place| place.is_expected && is_near(place));
        let mut under_way = self.expected.into_iter().chain(self.tried);
        if !is_leading && !under_way.any(|other| hint.is_near((other.map, other.at.0))) {
            self.expected = Some(hint);
        }
    }

    /// Starts from a trusted pose, on the map with this number, with its covariance.
    pub fn start_at(
        &mut self,
        seen: &[Seen<'_>],
        (map, pose): (u32, Pose),
        covariance: Covariance,
    ) {
        self.start_over();
        let at = (map, (pose, covariance.into()));
        self.places.start_at(seen, at);
        self.belief.trust();
    }

    /// Takes the next scan, as seen on each of the maps, by map number, and the motion of the
    /// target frame since the scan before. If odometry does not measure the motion, scans are
    /// matched instead. [`PlaceTracker::finish`] ends the work on the scan.
    ///
    /// # Panics
    /// If there is no map.
    pub fn begin(&mut self, seen: &[Seen<'_>], stamp_ns: i64, moved: Option<Pose>) -> Need {
        if self.expected.is_some() && self.places.believed.is_none() {
            let expected = self.expected;
            self.start_over();
            self.expected = expected;
        }
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
        let is_first = self.belief.go_on(stamp_ns, moved);
        // There is no motion before the first scan.
        let step = moved.or(is_first.then_some(Pose::IDENTITY));
        self.asks_ahead = false;
        let is_due = self.go_on(step);
        if self.is_blank {
            return Need::Nothing;
        }
        if self.places.believed.is_none()
            && let Some(hint) = self.expected.take()
        {
            self.places.expect(seen, hint);
            self.since_key = DrivenPath::default();
            self.is_key = true;
            return Need::ThisScan;
        }
        let path = std::mem::take(&mut self.since_scan);
        let was_doubtful = self.places.doubt().is_some();
        let is_lost_sight = self.has_lost_sight(&path);
        if is_lost_sight {
            self.places.forget();
        }
        self.places.follow(seen, (&path, &self.since_key));
        let hint = self.expected.take();
        if let Some(hint) = hint.filter(|hint| self.places.may_be_at(hint, seen)) {
            self.tried = Some(hint);
        }
        let is_suspicious = self.places.doubt().is_some();
        let has_entered = self.has_entered();
        let is_new = (is_suspicious && !was_doubtful) || is_lost_sight || has_entered;
        let is_open = self.tried.is_some() && !self.belief.is_unique();
        self.is_key = self.is_far() || is_new || is_due || is_open;
        match () {
            () if !self.is_key => Need::Nothing,
            () if is_suspicious || is_lost_sight || !self.belief.is_unique() => {
                self.ahead = None;
                Need::ThisScan
            }
            () if is_due => Need::EarlierScan,
            () => Need::Nothing,
        }
    }

    /// Appends a step to all paths; returns true if the search that was requested ahead counts now.
    fn go_on(&mut self, step: Option<Pose>) -> bool {
        self.since_key.add(step);
        self.since_scan.add(step);
        if let Some(hint) = &mut self.tried {
            hint.since.add(step);
        }
        self.ahead.as_mut().is_some_and(|(path, left)| {
            path.add(step);
            *left = left.saturating_sub(1);
            *left == 0
        })
    }

    /// True if the believed place has entered a transition with this scan. The robot may stop
    /// there, and be on the other map before it drives on.
    fn has_entered(&mut self) -> bool {
        let is_in = self.places.believed().is_some_and(|place| {
            let at = (place.map, place.pose);
            let mut transitions = self.transitions.iter();
            transitions.any(|transition| other_side(transition, at, place.covariance).is_some())
        });
        !std::mem::replace(&mut self.is_in_transition, is_in) && is_in
    }

    /// True if the robot is far enough from the last key scan, by odometry or by the fits of the
    /// scans.
    fn is_far(&self) -> bool {
        let believed = self.places.believed();
        self.places.all().is_empty()
            || self.since_key.is_far(&self.config)
            || believed.is_some_and(|place| place.novelty >= 1.0)
    }

    /// True if the best place moved so far, or in an unknown way, that more than one place is
    /// possible.
    fn has_lost_sight(&self, path: &DrivenPath) -> bool {
        let best = self.places.believed().or(self.places.all().first());
        best.is_some_and(|place| place.is_blind_after(path, self.config.odometry_error))
    }

    /// Finishes the scan with the places found by the search that was needed. `None` if none was
    /// needed or it had no answer; in the latter case no place is unique until a later search has
    /// an answer, since the robot may be at a place that was not searched.
    pub fn finish(&mut self, seen: &[Seen<'_>], found: Option<&[Candidate]>) {
        if self.is_blank {
            self.belief.see_nothing(&self.places, &self.since_scan);
            return;
        }
        if self.is_key {
            let path = std::mem::take(&mut self.since_key);
            let due = self.ahead.take_if(|(_, left)| *left == 0);
            let was_searched = self.needs_search || due.is_some();
            let tried = self.tried.take_if(|_| was_searched);
            if let Some(found) = found {
                let since = due.map(|(since, _)| since);
                self.places.take(seen, found, since.as_ref());
                self.keys_since_search = 0;
                if let Some(hint) = tried {
                    let hint = hint.moved(self.config.odometry_error);
                    self.places.expect_beside(hint, seen);
                }
            }
            self.belief.search_ended(self.needs_search, found.is_some());
            self.places.weigh(seen, &self.transitions, &path);
            self.keys_since_search += 1;
            if let Some(only) = found.and_then(|found| self.start(found)) {
                self.places.start_at(seen, (only.map, only.at()));
                self.belief.trust();
            }
        }
        self.belief.conclude(&mut self.places, self.is_key);
        let is_due = self.is_key && self.keys_since_search >= CHECKED_EVERY;
        self.asks_ahead =
            self.ahead.is_none() && self.belief.is_unique() && (is_due || self.tried.is_some());
        if self.asks_ahead {
            self.ahead = Some((DrivenPath::default(), COUNTS_AFTER));
        }
    }

    /// Place at which a tracker without knowledge starts by a single scan.
    fn start<'a>(&self, found: &'a [Candidate]) -> Option<&'a Candidate> {
        let may = self.config.start == Start::Believe && !self.belief.was_unique;
        found.iter().find(|candidate| may && candidate.is_only)
    }

    /// True if a search for the scan just finished is needed a few scans later, see
    /// [`Need::EarlierScan`].
    pub fn asks_ahead(&self) -> bool {
        self.asks_ahead
    }

    /// Returns the pose of the robot and its certainty.
    pub fn report(&self) -> Report {
        let unseen = self.is_blank.then_some(&self.since_scan);
        self.belief.report(&self.places, &self.since_key, unseen)
    }
}

#[cfg(test)]
mod tests;
