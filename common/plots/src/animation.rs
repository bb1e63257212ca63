//! A drive as an animation: each scan at its places, one picture after the other, as long
//! as the robot took from scan to scan.

use std::time::Duration;

use drawing::{Frame, Path, Scene, Stroke};
use geometry::Pose;
use messages::Verdict;

use super::extent::Extent;
use super::marks;
use super::page::{self, Entry, Heading, Page, Sample};
use super::places;
use super::scan::Size;
use super::subject::{Ground, Subject};
use super::theme;
use super::view::View;
use crate::PlotError;

/// The body's height as a share of its width.
const HEIGHTS: (f64, f64) = (0.25, 0.9);

/// How long a picture stands at least and at most, and how long the last one.
const SHOWN: (Duration, Duration) = (Duration::from_millis(40), Duration::from_secs(1));
const LAST_SHOWN: Duration = Duration::from_secs(2);

/// Where the robot was, in what it has found out, to the moment that is shown.
const WAY: f64 = 2.0;

/// What is the same in all pictures.
struct Film<'a> {
    ground: &'a Ground<'a>,
    subjects: &'a [Subject],
    bag: &'a str,
    width: u32,
    extent: Extent,
}

/// The pictures of a drive, each drawn when it is asked for.
///
/// # Errors
/// Of each: it would be too large.
pub(super) fn frames<'a>(
    ground: &'a Ground<'a>,
    subjects: &'a [Subject],
    bag: &'a str,
    size: Size,
) -> impl ExactSizeIterator<Item = Result<Frame, PlotError>> + 'a {
    let mut extent = Extent::EMPTY;
    for subject in subjects {
        extent.include_all(subject.extent(ground, size.whole));
    }
    let film = Film {
        ground,
        subjects,
        bag,
        width: size.width,
        extent,
    };
    (0..subjects.len()).map(move |i| Ok((film.draw(i)?, shown(subjects, i))))
}

/// From a scan to the next.
fn shown(subjects: &[Subject], i: usize) -> Duration {
    let pair = (subjects.get(i), subjects.get(i + 1));
    let (Some(this), Some(next)) = pair else {
        return LAST_SHOWN;
    };
    let gap_ns = next.stamp_ns.saturating_sub(this.stamp_ns);
    let gap = Duration::from_nanos(u64::try_from(gap_ns).unwrap_or_default());
    gap.clamp(SHOWN.0, SHOWN.1)
}

impl Film<'_> {
    fn draw(&self, i: usize) -> Result<Scene, PlotError> {
        let ratio = (self.extent.height() / self.extent.width()).clamp(HEIGHTS.0, HEIGHTS.1);
        let height = (page::body_width(self.width) * ratio).round();
        let mut page = Page::new(self.width, height, &self.heading(i), &self.legend())?;
        let view = View::fitting(self.extent, page.body);
        self.ground.draw(&mut page.scene, &view)?;
        let unit = page.unit;
        page.scene.clipped(view.area(), |scene| {
            let way = self.way(i).map(|pose| view.at((pose.x, pose.y)));
            let stroke = Stroke::new(theme::BEST.with_opacity(0.6), WAY * unit);
            scene.stroke(Path::polyline(way), stroke);
        });
        places::draw(&mut page.scene, &view, &self.subjects[i], unit);
        marks::scale_bar(&mut page.scene, &view, unit);
        page.frame(view.area());
        Ok(page.scene)
    }

    /// Where the robot was found without doubt, up to a scan.
    fn way(&self, i: usize) -> impl Iterator<Item = Pose> {
        let past = self.subjects.iter().take(i + 1);
        let sure = past.filter(|subject| subject.places.verdict == Verdict::Unique);
        let best = sure.filter_map(|subject| subject.shown.first());
        best.map(|shown| shown.place.map_from_laser)
    }

    fn heading(&self, i: usize) -> Heading {
        let subject = &self.subjects[i];
        let begin_ns = self.subjects[0].stamp_ns;
        let seconds = subject.stamp_ns.saturating_sub(begin_ns) as f64 / 1e9;
        let heading = subject.heading(self.bag);
        Heading {
            title: format!("{} · {seconds:.1} s", heading.title),
            ..heading
        }
    }

    /// The same for all, so that nothing jumps.
    fn legend(&self) -> Vec<Entry> {
        let mut entries = vec![(
            Sample::Robot(theme::BEST),
            "found by this scan alone".to_owned(),
        )];
        let classes = theme::CLASSES.map(theme::of_class);
        let dots = classes.map(|(color, name)| (Sample::Dot(color), name.to_owned()));
        entries.extend(dots);
        if self.subjects.iter().any(|subject| subject.shown.len() > 1) {
            entries.push((Sample::Robot(theme::OTHER), "other places".to_owned()));
        }
        if self.subjects.iter().any(|subject| subject.truth.is_some()) {
            entries.push((Sample::Truth, "truth".to_owned()));
        }
        entries
    }
}
