//! Tests of `backcast plot` as a process.

use std::fs;
use std::path::Path;

use image::{Rgb, RgbImage};
use recording::Message;
use tempfile::TempDir;

use crate::drawn::{
    HERE, THERE, assert_names, assert_refused, folder, map_message, output, room, scan, scan_at,
    truth_at,
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
    let stdout = output(folder, &format!("plot {options} --force --out {file}"));
    assert!(stdout.starts_with(&format!("{file}: ")), "{stdout}");
    fs::read(folder.join(file)).unwrap()
}

fn decoded(png: &[u8]) -> RgbImage {
    image::load_from_memory(png).unwrap().to_rgb8()
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
        let is_whole = svg.starts_with("<svg ") && svg.ends_with("</svg>\n");
        assert!(is_whole, "{kind}");
        assert!(svg.contains(r#"width="640""#), "{kind}");
        let height = format!(r#"height="{}""#, picture.height());
        assert!(svg.contains(&height), "{kind}: as high as the PNG");
    }
}

#[test]
fn the_same_question_gives_the_same_picture() {
    let drive = drive();
    let options = "scan --bag r.mcap --width 400";
    let first = plot(drive.path(), options, "one.png");
    assert_eq!(first, plot(drive.path(), options, "two.png"));
    let second = format!("{options} --scan 2");
    assert_ne!(first, plot(drive.path(), &second, "p.png"));
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
    assert_refused(folder.path(), options, 2, "is the map itself");
    assert_eq!(fs::read(&image).unwrap(), before);
}

#[test]
fn a_scan_in_which_nothing_returned_is_drawn_without_a_robot() {
    let mut silent = scan(1, HERE);
    silent.ranges.fill(f32::INFINITY);
    let folder = folder(&[map_message(), ("/scan", Message::Scan(silent))]);
    let picture = decoded(&plot(folder.path(), "--bag r.mcap --width 600", "p.png"));
    assert!(picture.pixels().all(|pixel| *pixel != BEST));
    let field = "plot field --bag r.mcap --force --out p.png";
    let no_place = "r.mcap: scan 1 has no place on this map: no usable beams";
    assert_refused(folder.path(), field, 1, no_place);
}

#[test]
fn a_refused_scan_leaves_no_picture() {
    let mut empty = scan(1, HERE);
    empty.ranges.clear();
    let empty = ("/scan", Message::Scan(empty));
    let folder = folder(&[map_message(), empty, scan_at(2, HERE)]);
    let is_empty = "backcast: the scan is empty: it has no ranges\n";
    assert_names(folder.path(), "plot --bag r.mcap --out q.png", is_empty);
    assert!(!folder.path().join("q.png").exists());
}

#[test]
fn what_is_missing_or_broken_is_named() {
    let drive = drive();
    let no_truth = folder(&[map_message(), scan_at(1, HERE)]);
    let scan_3 = "r.mcap: there is no scan 3; the scans taken are 1 to 2";
    let no_folder = "cannot write r.mcap/p.png: not a directory";
    let no_truths = "r.mcap has no true poses on /ground_truth";
    for (folder, options, expected) in [
        (&drive, "--bag r.mcap --scan 3 --out p.png", scan_3),
        (&drive, "--bag r.mcap --out r.mcap/p.png", no_folder),
        (&no_truth, "errors --bag r.mcap --out p.png", no_truths),
    ] {
        assert_names(folder.path(), &format!("plot {options}"), expected);
    }
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
        let arguments = format!("plot {options}");
        assert_refused(folder.path(), &arguments, 2, expected);
    }
}
