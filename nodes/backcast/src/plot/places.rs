//! A scan at its places, drawn over the map.

use drawing::{Anchor, Color, Path, Scene, Stroke, TextStyle};
use engine::fit::BeamClass;
use geometry::Pose;

use super::marks;
use super::page::{Entry, Sample};
use super::subject::{Shown, Subject};
use super::theme;
use super::view::View;
use crate::offline::{BeamEnd, ScanAt};

/// Sizes of what is drawn, in the picture's units.
const ROBOT: f64 = 10.0;
const TRUTH: f64 = 6.5;
const DOT: f64 = 2.3;
const FAINT_DOT: f64 = 1.7;

/// Draws all places, the best in front and with what became of its beams.
pub(super) fn draw(scene: &mut Scene, view: &View, subject: &Subject, unit: f64) {
    scene.clipped(view.area(), |scene| {
        if let Some(truth) = subject.missed_truth() {
            let color = theme::TRUTH.with_opacity(0.5);
            dots(scene, view, &truth.scan.ends, FAINT_DOT * unit, color);
        }
        for other in subject.shown.iter().skip(1).rev() {
            let color = theme::OTHER.with_opacity(other.opacity);
            dots(scene, view, &other.scan.ends, FAINT_DOT * unit, color);
        }
        if let Some(best) = subject.shown.first() {
            by_class(scene, view, (best.place.map_from_laser, &best.scan), unit);
        }
        for shown in subject.shown.iter().rev() {
            mark(scene, view, shown, unit);
        }
        if let Some(truth) = &subject.truth {
            let stand = marks::stand(view, truth.pose);
            marks::truth(scene, stand, TRUTH * unit);
        }
    });
}

/// Draws a scan at one pose, with what became of its beams there.
pub(super) fn by_class(scene: &mut Scene, view: &View, (pose, scan): (Pose, &ScanAt), unit: f64) {
    let from = view.at((pose.x, pose.y));
    for class in theme::CLASSES {
        let (color, _) = theme::of_class(class);
        let ends = scan.ends.iter().filter(|end| end.class == class);
        let mut rays = Path::new();
        for end in ends {
            rays.add_line(from, view.at(end.at));
        }
        scene.stroke(rays, Stroke::new(color.with_opacity(0.16), unit));
    }
    for class in theme::CLASSES {
        let ends: Vec<BeamEnd> = of_class(scan, class).copied().collect();
        dots(scene, view, &ends, DOT * unit, theme::of_class(class).0);
    }
}

/// The mark of a place, with its rank where it is not the best.
fn mark(scene: &mut Scene, view: &View, shown: &Shown, unit: f64) {
    let pose = shown.place.map_from_laser;
    let is_best = shown.rank == 1;
    let color = match is_best {
        true => theme::BEST,
        false => theme::OTHER,
    };
    let stroke = Stroke::new(color, 1.4 * unit);
    marks::ellipse(scene, view, (pose, shown.place.covariance), stroke);
    let stand = marks::stand(view, pose);
    let size = if is_best { ROBOT } else { 0.8 * ROBOT };
    marks::robot(scene, stand, size * unit, color);
    if !is_best {
        let style = TextStyle::new(13.0 * unit, theme::INK)
            .anchored(Anchor::Start)
            .with_halo(Color::WHITE, 3.5 * unit);
        let at = (stand.0.0 + 11.0 * unit, stand.0.1 - 7.0 * unit);
        scene.text(&shown.rank.to_string(), at, &style);
    }
}

fn dots(scene: &mut Scene, view: &View, ends: &[BeamEnd], radius: f64, color: Color) {
    let mut path = Path::new();
    for end in ends.iter().filter(|end| view.shows(end.at)) {
        path.add_circle(view.at(end.at), radius);
    }
    scene.fill(path, color);
}

fn of_class(scan: &ScanAt, class: BeamClass) -> impl Iterator<Item = &BeamEnd> {
    scan.ends.iter().filter(move |end| end.class == class)
}

/// What the colours and marks mean, with the numbers of beams.
pub(super) fn legend(subject: &Subject) -> Vec<Entry> {
    let mut entries = Vec::new();
    if let Some(best) = subject.shown.first() {
        entries.push((Sample::Robot(theme::BEST), "best place".to_owned()));
        for class in theme::CLASSES {
            let count = of_class(&best.scan, class).count();
            let (color, name) = theme::of_class(class);
            if count > 0 {
                entries.push((Sample::Dot(color), format!("{name} {count}")));
            }
        }
        let name = format!("{} σ", marks::SIGMAS);
        entries.push((Sample::Ellipse(theme::BEST), name));
    }
    if subject.shown.len() > 1 {
        entries.push((Sample::Robot(theme::OTHER), "other places".to_owned()));
    }
    if subject.truth.is_some() {
        entries.push((Sample::Truth, "truth".to_owned()));
    }
    entries
}
