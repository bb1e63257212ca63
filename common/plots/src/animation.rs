//! A drive as an animation: each scan at its places, as long as from scan to scan.

use std::time::Duration;

use crate::drawing::{Frame, Path, Scene, Stroke};
use geometry::Pose;
use messages::Verdict;

use super::extent::Extent;
use super::ground::Ground;
use super::legend::{Legend, Sample};
use super::page::{self, Heading, Page};
use super::scan::Size;
use super::subject::Subject;
use super::view::View;
use super::{axes, places, theme};

/// The body's height as a share of its width.
const HEIGHTS: (f64, f64) = (0.25, 0.9);

/// How long a picture stands at least and at most, and how long the last one.
const SHOWN: (Duration, Duration) = (Duration::from_millis(40), Duration::from_secs(1));
const LAST_SHOWN: Duration = Duration::from_secs(2);

/// Where the robot was, in what it has found out, to the moment that is shown.
const WAY: f64 = 2.0;

struct Film<'a> {
    ground: &'a Ground<'a>,
    subjects: &'a [Subject],
    bag: &'a str,
    width: u32,
    extent: Extent,
    /// The same for all, so that nothing jumps.
    legend: Legend,
}

pub(super) fn frames<'a>(
    ground: &'a Ground<'a>,
    subjects: &'a [Subject],
    bag: &'a str,
    size: Size,
) -> impl ExactSizeIterator<Item = anyhow::Result<Frame>> + 'a {
    let mut extent = Extent::EMPTY;
    for subject in subjects {
        extent.include_all(subject.extent(ground, size.whole));
    }
    let mut film = Film {
        ground,
        subjects,
        bag,
        width: size.width,
        extent,
        legend: Legend::default(),
    };
    film.legend = film.names();
    (0..subjects.len()).map(move |i| Ok((film.draw(i)?, shown(subjects, i))))
}

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
    fn draw(&self, i: usize) -> anyhow::Result<Scene> {
        let (mut page, view) = self.page(i)?;
        page.legend = self.legend.clone();
        self.ground.draw(&mut page, &view)?;
        self.draw_places((&mut page.scene, &mut page.legend), &view, i);
        axes::draw_metres(&mut page.scene, &view, page.unit);
        page.finish()
    }

    fn page(&self, i: usize) -> anyhow::Result<(Page, View)> {
        Page::of_map(self.width, self.extent, HEIGHTS, &self.heading(i))
    }

    fn draw_places(&self, (scene, legend): (&mut Scene, &mut Legend), view: &View, i: usize) {
        let unit = page::unit(self.width);
        let way: Vec<_> = self.way(i).map(|pose| view.at((pose.x, pose.y))).collect();
        if way.len() > 1 {
            let stroke = Stroke::new(theme::BEST.with_opacity(0.6), WAY * unit);
            legend.add(Sample::Line(stroke), "path of unique places");
            scene.clipped(view.area, |scene| {
                scene.stroke(Path::polyline(way), stroke);
            });
        }
        places::draw((scene, legend), view, &self.subjects[i], unit);
    }

    /// What any of the pictures shows beside the map.
    fn names(&self) -> Legend {
        let mut legend = Legend::default();
        for i in 0..self.subjects.len() {
            // A picture without a map, for its names alone.
            let Ok((mut page, view)) = self.page(i) else {
                continue;
            };
            self.draw_places((&mut page.scene, &mut legend), &view, i);
        }
        legend
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
}
