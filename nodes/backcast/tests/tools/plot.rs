//! Tests of `backcast plot` as a process: pictures of a drawn room and of a real recording, and
//! messages for wrong use.

use std::fs;
use std::path::Path;

use image::{Rgb, RgbImage};
use recording::Message;
use tempfile::TempDir;

use crate::drawn::{
    HERE, THERE, folder, map_from_laser, map_message, room, run, scan, scan_at, truth_at,
};

/// Colour of the best place, which the legend uses as well.
const BEST: Rgb<u8> = Rgb([0x1B, 0x5F, 0xD0]);

fn drive() -> TempDir {
    folder(&[
        map_message(),
        scan_at(1, HERE),
        truth_at(1, HERE),
        scan_at(2, THERE),
        truth_at(2, THERE),
    ])
}

/// Draws with these options, asserts success, and returns the file.
fn plot(folder: &Path, options: &str, file: &str) -> Vec<u8> {
    let (code, stdout, stderr) = run(folder, &format!("plot {options} --force --out {file}"));
    assert_eq!((code, stderr.as_str()), (0, ""), "{options}: {stdout}");
    assert!(stdout.starts_with(&format!("{file}: ")), "{stdout}");
    fs::read(folder.join(file)).unwrap()
}

fn decoded(png: &[u8]) -> RgbImage {
    image::load_from_memory(png).unwrap().to_rgb8()
}

/// Returns the centre of the robot: the mean of the pixels of its colour below the heading and
/// above the axis name and the legend, which has two rows here.
fn robot(picture: &RgbImage) -> (f64, f64) {
    let pixels = picture.enumerate_pixels();
    let body = 80..picture.height() - 110;
    let found: Vec<(u32, u32)> = pixels
        .filter(|(_, y, pixel)| **pixel == BEST && body.contains(y))
        .map(|(x, y, _)| (x, y))
        .collect();
    assert!(found.len() > 20, "{} pixels", found.len());
    let mean = |of: fn(&(u32, u32)) -> u32| {
        let all = found.iter().map(|at| f64::from(of(at)));
        all.sum::<f64>() / found.len() as f64
    };
    (mean(|at| at.0), mean(|at| at.1))
}

#[test]
fn every_picture_of_a_recording_has_the_width_that_was_asked_for() {
    let drive = drive();
    for kind in ["map", "scan", "field", "surface", "errors"] {
        let options = format!("{kind} --bag r.mcap --width 640");
        let picture = decoded(&plot(drive.path(), &options, "p.png"));
        assert_eq!(picture.width(), 640, "{kind}");
        let first = picture.get_pixel(0, 0);
        assert_eq!(*first, Rgb([255; 3]), "{kind}: the margin is white");
        let drawn = picture.pixels().filter(|pixel| *pixel != first).count();
        assert!(drawn > 5000, "{kind}: {drawn} pixels are drawn");

        let svg = plot(drive.path(), &options, "p.svg");
        let svg = String::from_utf8(svg).unwrap();
        assert!(
            svg.starts_with("<svg ") && svg.ends_with("</svg>\n"),
            "{kind}"
        );
        assert!(svg.contains(r#"width="640""#), "{kind}");
        let height = format!(r#"height="{}""#, picture.height());
        assert!(svg.contains(&height), "{kind}: as high as the PNG");
    }
}

#[test]
fn the_robot_stands_where_the_pose_says() {
    let drive = drive();
    let at = |number: u32| {
        let options = format!("--bag r.mcap --whole --width 1200 --scan {number}");
        robot(&decoded(&plot(drive.path(), &options, "p.png")))
    };
    let ((x1, y1), (x2, y2)) = (at(1), at(2));
    let (from, to) = (map_from_laser(HERE), map_from_laser(THERE));
    let (along_x, along_y) = (to.x - from.x, to.y - from.y);
    let pixels_per_m = (x2 - x1).hypot(y2 - y1) / along_x.hypot(along_y);
    // x runs to the right and y up. The darts point in different directions, so their centres are
    // up to two pixels off the lasers.
    assert!((x2 - x1 - pixels_per_m * along_x).abs() < 4.0, "{x1} {x2}");
    assert!((y1 - y2 - pixels_per_m * along_y).abs() < 4.0, "{y1} {y2}");
    // The map, rotated by half a radian, is 5.8 m wide and 5.0 m high including its margin of 2 %;
    // the body of the picture is 1168 pixels wide, of which the axis numbers take about 85.
    assert!((pixels_per_m - 187.0).abs() < 15.0, "{pixels_per_m}");
}

#[test]
fn the_same_question_gives_the_same_picture() {
    let drive = drive();
    let options = "scan --bag r.mcap --width 400";
    let first = plot(drive.path(), options, "one.png");
    assert_eq!(first, plot(drive.path(), options, "two.png"));
    let other = plot(
        drive.path(),
        "scan --bag r.mcap --width 400 --scan 2",
        "p.png",
    );
    assert_ne!(first, other);
}

#[test]
fn a_map_needs_no_recording() {
    let folder = tempfile::tempdir().unwrap();
    map::save(&room(), folder.path().join("room.yaml")).unwrap();
    let picture = decoded(&plot(folder.path(), "map --map room.yaml", "p.png"));
    let boundary = Rgb([0xD5, 0x5E, 0x00]);
    let found = picture.pixels().filter(|pixel| **pixel == boundary).count();
    assert!(found > 1000, "{found} pixels of boundary cells");
    // The picture of a map never overwrites the map.
    let image = folder.path().join("room.png");
    let before = fs::read(&image).unwrap();
    let options = "plot map --map room.yaml --out ./room.png";
    let (code, _, stderr) = run(folder.path(), options);
    assert_eq!(code, 2, "{stderr}");
    assert!(stderr.contains("is the map itself"), "{stderr}");
    assert_eq!(fs::read(&image).unwrap(), before);
}

#[test]
fn a_scan_in_which_nothing_returned_is_drawn_without_a_robot() {
    let mut silent = scan(1, HERE);
    silent.ranges.fill(f32::INFINITY);
    let folder = folder(&[map_message(), ("/scan", Message::Scan(silent))]);
    let picture = decoded(&plot(folder.path(), "--bag r.mcap --width 600", "p.png"));
    assert!(picture.pixels().all(|pixel| *pixel != BEST));
    let (code, stdout, stderr) = run(folder.path(), "plot field --bag r.mcap --force --out p.png");
    assert_eq!((code, stdout.as_str()), (1, ""));
    let expected = "r.mcap: scan 1 has no place on this map: no usable beams";
    assert!(stderr.contains(expected), "{stderr}");
}

#[test]
fn a_refused_scan_leaves_no_picture() {
    let mut empty = scan(1, HERE);
    empty.ranges.clear();
    let messages = [
        map_message(),
        ("/scan", Message::Scan(empty)),
        scan_at(2, HERE),
    ];
    let folder = folder(&messages);
    let (code, stdout, stderr) = run(folder.path(), "plot --bag r.mcap --out q.png");
    assert_eq!((code, stdout.as_str()), (1, ""));
    assert_eq!(stderr, "backcast: the scan is empty: it has no ranges\n");
    assert!(!folder.path().join("q.png").exists());
}

#[test]
fn what_is_missing_or_broken_is_named() {
    let drive = drive();
    let fails = |folder: &TempDir, options: &str, expected: &str| {
        let (code, stdout, stderr) = run(folder.path(), &format!("plot {options}"));
        assert_eq!((code, stdout.as_str()), (1, ""), "{stderr}");
        assert!(stderr.starts_with("backcast: "), "{stderr}");
        assert!(stderr.contains(expected), "{stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
    };
    fails(
        &drive,
        "--bag r.mcap --scan 3 --out p.png",
        "r.mcap: there is no scan 3; the scans taken are 1 to 2",
    );
    fails(
        &drive,
        "--bag nowhere.mcap --out p.png",
        "cannot read the recording nowhere.mcap: No such file",
    );
    fails(
        &drive,
        "--bag r.mcap --out r.mcap/p.png",
        "cannot write r.mcap/p.png: not a directory",
    );
    fails(
        &drive,
        "map --map nowhere.yaml --out p.png",
        "cannot read the map description nowhere.yaml",
    );
    let no_map = folder(&[scan_at(1, HERE)]);
    for kind in ["map", "scan"] {
        fails(
            &no_map,
            &format!("{kind} --bag r.mcap --out p.png"),
            "r.mcap has no map on /map: name one with --map map.yaml",
        );
    }
    let no_truth = folder(&[map_message(), scan_at(1, HERE)]);
    fails(
        &no_truth,
        "errors --bag r.mcap --out p.png",
        "r.mcap has no true poses on /ground_truth",
    );
}

#[test]
fn a_picture_that_is_there_is_kept() {
    let drive = drive();
    fs::write(drive.path().join("p.png"), "kept").unwrap();
    let (code, _, stderr) = run(drive.path(), "plot --bag r.mcap --out p.png");
    assert_eq!(code, 2, "{stderr}");
    assert!(
        stderr.contains("p.png is there already; --force"),
        "{stderr}"
    );
    assert_eq!(fs::read(drive.path().join("p.png")).unwrap(), b"kept");
}

#[test]
fn wrong_use_is_reported_before_anything_is_opened() {
    let folder = tempfile::tempdir().unwrap();
    for (options, expected) in [
        ("--bag r.mcap", "--out <FILE>"),
        ("--out p.png", "--bag is missing"),
        ("map --out p.png", "--bag is missing"),
        ("errors --map m.yaml --out p.png", "--bag is missing"),
        ("--bag r.mcap --out p.jpg", "must end with .png or .svg"),
        ("--bag r.mcap --out picture", "must end with .png or .svg"),
        ("errors --bag r.mcap --out p.png --scan 2", "--scan is for"),
        ("map --bag r.mcap --out p.png --whole", "--whole is for"),
        (
            "errors --bag r.mcap --out p.png --no-truth",
            "--no-truth is for",
        ),
        ("--bag r.mcap --out p.png --scan 0", "0 is not in 1.."),
        ("--bag r.mcap --out p.png --width 9000", "not in 200..=8000"),
        ("--bag r.mcap --out p.png --headings 100", "a multiple of 8"),
        (
            "pie --bag r.mcap --out p.png",
            "[possible values: map, scan",
        ),
    ] {
        let (code, stdout, stderr) = run(folder.path(), &format!("plot {options}"));
        assert_eq!((code, stdout.as_str()), (2, ""), "{options}: {stderr}");
        assert!(stderr.contains(expected), "{options}: {stderr}");
    }
}
