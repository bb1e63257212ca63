//! A scan at its places, drawn over the map.

use drawing::{Anchor, Color, Path, Scene, Stroke, TextStyle};
use engine::fit::BeamClass;
use geometry::Pose;
use offline::{BeamEnd, ScanAt};

use super::marks;
use super::page::{Entry, Sample};
use super::subject::{Shown, Subject};
use super::theme;
use super::view::View;

/// Sizes of what is drawn, in the picture's units.
pub(super) const ROBOT: f64 = 10.0;
pub(super) const TRUTH: f64 = 12.0;
const DOT: f64 = 2.4;
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
            let placement = marks::placement(view, truth.pose);
            marks::truth(scene, placement, TRUTH * unit);
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
    let placement = marks::placement(view, pose);
    let size = if is_best { ROBOT } else { 0.8 * ROBOT };
    marks::robot(scene, placement, size * unit, color);
    if !is_best {
        let style = TextStyle::new(13.0 * unit, theme::INK)
            .anchored(Anchor::Start)
            .with_halo(Color::WHITE, 3.5 * unit);
        let at = (placement.0.0 + 11.0 * unit, placement.0.1 - 7.0 * unit);
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
        entries.push((Sample::Ellipse(theme::BEST), "95 %".to_owned()));
    }
    if subject.shown.len() > 1 {
        entries.push((Sample::Robot(theme::OTHER), "other places".to_owned()));
    }
    if subject.truth.is_some() {
        entries.push((Sample::Truth, "truth".to_owned()));
    }
    entries
}

#[cfg(test)]
mod tests {
    use drawing::Rect;
    use engine::peaks::{Place, Places};
    use geometry::Covariance;
    use messages::Verdict;

    use super::super::extent::Extent;
    use super::super::subject::Truth;
    use super::*;

    /// A robot at a pose, whose only beam hits something two metres ahead.
    fn subject(pose: Pose) -> Subject {
        let place = Place {
            map: 0,
            possible: 100,
            drawn_doubt: 0.0,
            map_from_laser: pose,
            covariance: Covariance::from_deviations(0.01, 0.01, 0.01),
            score: 1.0,
            probability: 1.0,
            intensity: 1,
            support: 1,
        };
        let scan = ScanAt {
            score: 1.0,
            ends: vec![BeamEnd {
                at: pose.transform(2.0, 0.0),
                class: BeamClass::Hit,
            }],
        };
        Subject {
            number: 1,
            stamp_ns: 0,
            places: Places {
                places: vec![place],
                verdict: Verdict::Unique,
                alternatives: 0,
                confidence: 1.0,
                inlier_share: 1.0,
                classes: vec![BeamClass::Hit],
            },
            shown: vec![Shown {
                place,
                rank: 1,
                scan: scan.clone(),
                opacity: 1.0,
            }],
            truth: Some(Truth {
                pose,
                scan,
                off: Some((0.0, 0.0)),
            }),
        }
    }

    /// The middle of all pixels of a colour.
    fn middle_of(scene: &Scene, color: Color) -> (f64, f64) {
        let png = drawing::to_png(scene).unwrap();
        let picture = image::load_from_memory(&png).unwrap().to_rgb8();
        let wanted = image::Rgb([color.red, color.green, color.blue]);
        let pixels = picture.enumerate_pixels();
        let found: Vec<_> = pixels.filter(|(_, _, pixel)| **pixel == wanted).collect();
        assert!(found.len() > 10, "{} pixels", found.len());
        let sum = |of: fn(u32, u32) -> u32| {
            let all = found.iter().map(|&(x, y, _)| f64::from(of(x, y)) + 0.5);
            all.sum::<f64>() / found.len() as f64
        };
        (sum(|x, _| x), sum(|_, y| y))
    }

    #[test]
    fn robot_and_hit_are_drawn_where_the_pose_says() {
        let extent = Extent::of([(0.0, 0.0), (10.0, 8.0)]);
        let view = View::fitting(extent, Rect::new(0.0, 0.0, 500.0, 400.0));
        for pose in [Pose::new(3.0, 2.0, 0.0), Pose::new(6.0, 5.0, 2.5)] {
            let mut scene = Scene::new(500, 400, "", Color::WHITE).unwrap();
            draw(&mut scene, &view, &subject(pose), 1.0);
            // 50 pixels a metre, y from the top.
            let (x, y) = (50.0 * pose.x, 400.0 - 50.0 * pose.y);
            let (robot_x, robot_y) = middle_of(&scene, theme::BEST);
            // The dart's middle lies a little off the laser, and its rim is
            // blended with the ellipse: a quarter of its length.
            let off = (robot_x - x).hypot(robot_y - y);
            assert!(off < ROBOT / 2.0, "{robot_x} {robot_y} for {pose:?}");
            let (hit_color, _) = theme::of_class(BeamClass::Hit);
            let (hit_x, hit_y) = middle_of(&scene, hit_color);
            let (sin, cos) = pose.yaw.sin_cos();
            let off = (hit_x - x - 100.0 * cos).hypot(hit_y - y + 100.0 * sin);
            // A dot is symmetric: its middle is met to a share of a pixel.
            assert!(off < 0.75, "{hit_x} {hit_y} for {pose:?}");
        }
    }

    #[test]
    fn the_legend_names_what_there_is_and_counts_beams() {
        let entries = legend(&subject(Pose::IDENTITY));
        let names: Vec<&str> = entries.iter().map(|(_, name)| name.as_str()).collect();
        assert_eq!(names, ["best place", "hit 1", "95 %", "truth"]);
    }
}
