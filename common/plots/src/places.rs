//! A scan at its places, drawn over the map.

use crate::drawing::{Color, Path, Scene, Stroke, TextStyle};
use engine::fit::BeamClass;
use geometry::Pose;
use offline::{BeamEnd, ScanAt};

use super::legend::{Legend, Sample};
use super::marks;
use super::numbers::Numbers;
use super::shapes::Shape;
use super::subject::{Shown, Subject};
use super::theme;
use super::view::View;

/// Sizes of what is drawn, in the picture's units.
pub(super) const ROBOT: f64 = 10.0;
pub(super) const TRUTH: f64 = 12.0;
const DOT: f64 = 2.6;
const FAINT_DOT: f64 = 1.7;
const RANK: f64 = 16.0;

/// Draws and names all places, the best in front and with the classes of its beams.
pub(super) fn draw(
    (scene, legend): (&mut Scene, &mut Legend),
    view: &View,
    subject: &Subject,
    unit: f64,
) {
    name(legend, subject);
    scene.clipped(view.area, |scene| {
        if let Some(truth) = subject.missed_truth() {
            dots(scene, view, &truth.scan, (FAINT_DOT * unit, AT_TRUTH));
        }
        for other in subject.shown.iter().skip(1).rev() {
            let color = theme::OTHER.with_opacity(other.opacity);
            dots(scene, view, &other.scan, (FAINT_DOT * unit, color));
        }
        if let Some(best) = subject.shown.first() {
            let at_best = (best.place.map_from_laser, &best.scan);
            by_class((scene, legend), view, at_best, unit);
        }
        for shown in subject.shown.iter().rev() {
            mark(scene, view, shown, unit);
        }
        if let Some(truth) = &subject.truth {
            let placement = marks::placement(view, truth.pose);
            marks::truth(scene, placement, TRUTH * unit);
        }
        number(scene, view, subject, unit);
    });
}

/// The colour of a scan at the truth, where that is another place.
const AT_TRUTH: Color = theme::TRUTH.with_opacity(0.5);

/// Names all but the beams.
fn name(legend: &mut Legend, subject: &Subject) {
    if subject.truth.is_some() {
        legend.add(Sample::Truth, "truth");
    }
    if subject.missed_truth().is_some() {
        let sample = Sample::Mark(Shape::Circle, AT_TRUTH);
        legend.add(sample, "scan at the truth");
    }
    if !subject.shown.is_empty() {
        legend.add(Sample::Robot(theme::BEST), "best place");
        legend.add(Sample::Ellipse(theme::BEST), "position, 95 %");
    }
    if subject.shown.len() > 1 {
        legend.add(Sample::Robot(theme::OTHER), "other places by rank");
        let sample = Sample::Mark(Shape::Circle, theme::OTHER.with_opacity(0.6));
        legend.add(sample, "scan at other places");
    }
}

/// Draws a scan at one pose, with what became of its beams there, and names that.
pub(super) fn by_class(
    (scene, legend): (&mut Scene, &mut Legend),
    view: &View,
    (pose, scan): (Pose, &ScanAt),
    unit: f64,
) {
    let from = view.at((pose.x, pose.y));
    for class in theme::CLASSES {
        let (color, shape, name) = theme::of_class(class);
        let mut rays = Path::default();
        for end in of_class(scan, class) {
            rays.add_line(from, view.at(end.at));
        }
        if !rays.is_empty() {
            legend.add(Sample::Beam(shape, color), name);
        }
        scene.stroke(rays, Stroke::new(color.with_opacity(0.16), unit));
    }
    for class in theme::CLASSES {
        let (color, shape, _) = theme::of_class(class);
        let ends = of_class(scan, class).map(|end| end.at);
        marks::ends(scene, view, ends, (shape, DOT * unit, color));
    }
}

/// Says in the legend how many beams of the best place there are of each class.
pub(super) fn count(legend: &mut Legend, subject: &Subject) {
    let Some(best) = subject.shown.first() else {
        return;
    };
    for class in theme::CLASSES {
        let count = of_class(&best.scan, class).count();
        legend.amend(theme::of_class(class).2, &format!(" ({count})"));
    }
}

fn mark(scene: &mut Scene, view: &View, shown: &Shown, unit: f64) {
    let pose = shown.place.map_from_laser;
    let (color, size) = match shown.rank {
        1 => (theme::BEST, ROBOT),
        _ => (theme::OTHER, 0.8 * ROBOT),
    };
    let stroke = Stroke::new(color, 1.4 * unit);
    marks::ellipse(scene, view, (pose, shown.place.covariance), stroke);
    marks::robot(scene, marks::placement(view, pose), size * unit, color);
}

/// Writes the ranks of all places but the best beside their marks.
fn number(scene: &mut Scene, view: &View, subject: &Subject, unit: f64) {
    let place = |shown: &Shown| (shown.place.map_from_laser.x, shown.place.map_from_laser.y);
    let mut numbers = Numbers::new(view.area);
    for shown in &subject.shown {
        numbers.keep_free(view.at(place(shown)), ROBOT * unit);
    }
    if let Some(truth) = &subject.truth {
        let at = view.at((truth.pose.x, truth.pose.y));
        numbers.keep_free(at, 1.2 * TRUTH * unit);
    }
    let style = TextStyle::new(RANK * unit, theme::INK).with_halo(Color::WHITE, 4.0 * unit);
    let others = subject.shown.iter().skip(1);
    for shown in others.filter(|shown| view.shows(place(shown))) {
        let at = view.at(place(shown));
        numbers.write(scene, &shown.rank.to_string(), at, &style);
    }
}

fn dots(scene: &mut Scene, view: &View, scan: &ScanAt, (size, color): (f64, Color)) {
    let ends = scan.ends.iter().map(|end| end.at);
    marks::ends(scene, view, ends, (Shape::Circle, size, color));
}

fn of_class(scan: &ScanAt, class: BeamClass) -> impl Iterator<Item = &BeamEnd> {
    scan.ends.iter().filter(move |end| end.class == class)
}

#[cfg(test)]
pub(super) mod tests {
    use crate::drawing::Rect;
    use engine::peaks::{Place, Places};
    use geometry::Covariance;
    use messages::Verdict;

    use super::super::extent::Extent;
    use super::super::subject::Truth;
    use super::*;

    /// A robot at a pose, whose only beam hits something two metres ahead.
    pub(in super::super) fn subject(pose: Pose) -> Subject {
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
        let png = crate::drawing::to_png(scene).unwrap();
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
            let mut scene = Scene::new(500, 400, "").unwrap();
            let names = (&mut scene, &mut Legend::default());
            draw(names, &view, &subject(pose), 1.0);
            // 50 pixels a metre, y from the top.
            let (x, y) = (50.0 * pose.x, 400.0 - 50.0 * pose.y);
            let (robot_x, robot_y) = middle_of(&scene, theme::BEST);
            // The dart's middle lies a little off the laser, by up to a quarter of its length.
            let off = (robot_x - x).hypot(robot_y - y);
            assert!(off < ROBOT / 2.0, "{robot_x} {robot_y} for {pose:?}");
            let (hit_color, ..) = theme::of_class(BeamClass::Hit);
            let (hit_x, hit_y) = middle_of(&scene, hit_color);
            let (sin, cos) = pose.yaw.sin_cos();
            let off = (hit_x - x - 100.0 * cos).hypot(hit_y - y + 100.0 * sin);
            // A dot is symmetric: its middle is met to a share of a pixel.
            assert!(off < 0.75, "{hit_x} {hit_y} for {pose:?}");
        }
    }

    #[test]
    fn the_legend_names_what_there_is_and_counts_beams() {
        let extent = Extent::of([(-5.0, -5.0), (5.0, 5.0)]);
        let view = View::fitting(extent, Rect::new(0.0, 0.0, 500.0, 500.0));
        let names = |subject: &Subject| {
            let mut scene = Scene::new(500, 500, "").unwrap();
            let mut legend = Legend::default();
            draw((&mut scene, &mut legend), &view, subject, 1.0);
            count(&mut legend, subject);
            let names: Vec<String> = legend.names().into_iter().map(str::to_owned).collect();
            let ranks: Vec<_> = scene.labels().iter().map(|l| l.text.clone()).collect();
            (names, ranks)
        };
        let one = subject(Pose::IDENTITY);
        let (known, ranks) = names(&one);
        assert_eq!(known, ["truth", "best place", "position, 95 %", "hit (1)"]);
        assert!(ranks.is_empty());
        let mut two = one.clone();
        two.shown.push(Shown {
            rank: 2,
            ..one.shown[0].clone()
        });
        two.truth = None;
        let (known, ranks) = names(&two);
        let expected = ["best place", "position, 95 %", "other places by rank"];
        assert_eq!(known[..3], expected);
        assert_eq!(known[3..], ["scan at other places", "hit (1)"]);
        assert_eq!(ranks, ["2"]);
    }
}
