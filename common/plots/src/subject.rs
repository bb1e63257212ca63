//! Subject of a picture: a scan, its possible places, and the truth.

use answers::statistics::SUCCESS;
use engine::EngineError;
use engine::peaks::{Place, Places};
use geometry::Pose;
use offline::{BeamEnd, ScanAt, TakenScan, World};

use super::extent::Extent;
use super::ground::Ground;
use super::page::Heading;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shown {
    pub(super) place: Place,
    pub(super) rank: usize,
    pub(super) scan: ScanAt,
    /// How clearly it is drawn, 0..=1.
    pub(super) opacity: f32,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Subject {
    /// From 1.
    pub(super) number: u64,
    pub(super) stamp_ns: i64,
    pub(super) places: Places,
    /// The places that are worth drawing, best first.
    pub(super) shown: Vec<Shown>,
    pub(super) truth: Option<Truth>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Truth {
    pub(super) pose: Pose,
    pub(super) scan: ScanAt,
    /// From the best place, metres and radians; `None` without one.
    pub(super) off: Option<(f64, f64)>,
}

impl Truth {
    /// Whether the best place counts as found.
    pub(super) fn is_met(&self) -> bool {
        let (most_m, most_deg) = SUCCESS;
        self.off
            .is_some_and(|(metres, angle)| metres <= most_m && angle <= most_deg.to_radians())
    }

    /// How far off the best place is, in words.
    pub(super) fn says(&self) -> String {
        match self.off {
            None => "the truth is known".into(),
            Some((metres, angle)) if metres >= 1.0 || !self.is_met() => format!(
                "{metres:.1} m and {:.1}° from the truth",
                angle.to_degrees()
            ),
            Some((metres, angle)) => format!(
                "{:.1} cm and {:.2}° from the truth",
                100.0 * metres,
                angle.to_degrees()
            ),
        }
    }
}

/// Places that lie behind the best by this score are not drawn.
const FADES_OVER: f64 = 0.3;
/// Most places that are drawn; more cannot be distinguished.
const MAX_SHOWN: usize = 9;
/// How clearly a place is drawn that fits as well as the best.
const CLEAREST: f64 = 0.75;
/// A few beams through a gap, far away, must not make all else small.
const MAX_OF_SCAN: f64 = 0.96;
/// What is fainter is left out.
const FAINTEST: f64 = 0.08;

impl Subject {
    pub(super) fn new(
        (number, scan): (u64, &TakenScan),
        places: Places,
        truth: Option<Pose>,
        world: &World,
    ) -> Result<Self, EngineError> {
        let borrowed = scan.borrowed();
        let best = places.places.first().copied();
        let mut shown = Vec::new();
        for (rank, place) in (1..).zip(places.places.iter().take(MAX_SHOWN)) {
            let behind = best.map_or(0.0, |best| best.score - place.score);
            let opacity = CLEAREST * (1.0 - behind / FADES_OVER);
            if rank > 1 && opacity < FAINTEST {
                break;
            }
            shown.push(Shown {
                place: *place,
                rank,
                scan: world.scan_at(&borrowed, place.map_from_laser)?,
                opacity: opacity as f32,
            });
        }
        let truth = match truth {
            Some(pose) => Some(Truth {
                pose,
                scan: world.scan_at(&borrowed, pose)?,
                off: best.map(|best| {
                    let best = best.map_from_laser;
                    (best.distance_to(pose), best.angle_to(pose))
                }),
            }),
            None => None,
        };
        Ok(Subject {
            number,
            stamp_ns: scan.stamp_ns,
            places,
            shown,
            truth,
        })
    }

    /// The truth, where the best place is another.
    pub(super) fn missed_truth(&self) -> Option<&Truth> {
        self.truth.as_ref().filter(|truth| !truth.is_met())
    }

    /// The whole map, or the places that fit and the truth, as far as the scan reaches.
    pub(super) fn extent(&self, ground: &Ground<'_>, whole: bool) -> Extent {
        let mut extent = Extent::EMPTY;
        let rivals = self.places.alternatives as usize;
        for shown in self.shown.iter().take(1 + rivals) {
            extent.include(reached(shown.place.map_from_laser, &shown.scan));
        }
        if let Some(truth) = self.missed_truth() {
            extent.include(reached(truth.pose, &truth.scan));
        }
        extent = extent.with_rim(0.04, 6.0).within(ground.whole());
        if self.shown.is_empty() && self.truth.is_none() {
            return ground.known();
        }
        if whole {
            extent.include_all(ground.known());
        }
        extent
    }

    pub(super) fn heading(&self, bag: &str) -> Heading {
        let mut says = self.places.sentence();
        if let Some(truth) = &self.truth {
            says = format!("{says} · {}", truth.says());
        }
        Heading {
            title: format!("{bag} · scan {}", self.number),
            verdict: Some(self.places.verdict),
            says,
        }
    }
}

/// A place and the ends of a scan there, the farthest left out.
fn reached(pose: Pose, scan: &ScanAt) -> Vec<(f64, f64)> {
    let here = (pose.x, pose.y);
    let far = scan.reach_m(pose, MAX_OF_SCAN);
    let near = |end: &&BeamEnd| end.distance_to(pose) <= far;
    let ends = scan.ends.iter().filter(near).map(|end| end.at);
    ends.chain([here]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(off: Option<(f64, f64)>) -> Truth {
        Truth {
            pose: Pose::IDENTITY,
            scan: ScanAt {
                score: 0.5,
                ends: Vec::new(),
            },
            off,
        }
    }

    #[test]
    fn small_errors_are_reported_in_centimetres() {
        let near = truth(Some((0.0123, 0.5f64.to_radians())));
        assert!(near.is_met());
        assert_eq!(near.says(), "1.2 cm and 0.50° from the truth");
        let far = truth(Some((25.43, 0.0)));
        assert!(!far.is_met());
        assert_eq!(far.says(), "25.4 m and 0.0° from the truth");
        let turned = truth(Some((0.1, 3.0)));
        assert!(!turned.is_met());
        assert_eq!(turned.says(), "0.1 m and 171.9° from the truth");
        assert!(!truth(None).is_met());
    }
}
