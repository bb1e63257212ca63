use super::*;

const GOOD: &str = "image: floor.pgm\nresolution: 0.05\norigin: [-1.5, 2, 0.1]\n\
                    negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

fn parse(text: &str) -> Result<Description, MapError> {
    Description::parse(text, Path::new("maps/floor.yaml"))
}

fn refusal(piece: &str, by: &str) -> String {
    assert!(GOOD.contains(piece));
    parse(&GOOD.replace(piece, by)).unwrap_err().to_string()
}

#[test]
fn reads_what_a_map_saver_writes() {
    let description = parse(GOOD).unwrap();
    assert_eq!(description.image, Path::new("maps/floor.pgm"));
    assert_eq!(description.image_named_at, (1, 8));
    assert_eq!(description.resolution_m, 0.05);
    assert_eq!(description.map_from_grid, Pose::new(-1.5, 2.0, 0.1));
    assert_eq!(description.rules.mode, Mode::Trinary);
    assert!(!description.rules.negate);
    assert_eq!(description.rules.thresholds.occupied, 0.65);
    assert_eq!(description.rules.thresholds.free, 0.196);
}

#[test]
fn modes_negation_and_absolute_names() {
    for (name, mode) in [
        ("trinary", Mode::Trinary),
        ("scale", Mode::Scale),
        ("raw", Mode::Raw),
        ("Scale", Mode::Scale),
        ("'RAW'", Mode::Raw),
        ("", Mode::Trinary),
    ] {
        let description = parse(&format!("{GOOD}mode: {name}\n")).unwrap();
        assert_eq!(description.rules.mode, mode);
    }
    for (word, negate) in [
        ("1", true),
        ("true", true),
        ("True", true),
        ("1.0", true),
        ("yes", true),
        ("\"1\"", true),
        ("'true'", true),
        ("false", false),
        ("0.0", false),
        ("\"0\"", false),
        ("off", false),
    ] {
        let text = GOOD.replace("negate: 0", &format!("negate: {word}"));
        assert_eq!(parse(&text).unwrap().rules.negate, negate);
    }
    let absolute = parse(&GOOD.replace("floor.pgm", "/srv/floor.pgm")).unwrap();
    assert_eq!(absolute.image, Path::new("/srv/floor.pgm"));
    let spaces = parse(&GOOD.replace("floor.pgm", "first floor/map 1.pgm  ")).unwrap();
    assert_eq!(spaces.image, Path::new("maps/first floor/map 1.pgm"));
}

#[test]
fn numbers_may_be_quoted_and_lines_end_as_on_other_systems() {
    let good = parse(GOOD).unwrap();
    let quoted = GOOD
        .replace("0.05", "\"0.05\"")
        .replace("[-1.5, 2, 0.1]", "[\"-1.5\", '2', \"0.1\"]")
        .replace("negate: 0", "negate: '0'")
        .replace("0.65", "\"0.65\"")
        .replace("0.196", "' 0.196 '");
    assert_eq!(parse(&quoted).unwrap(), good);
    let block = GOOD.replace(" [-1.5, 2, 0.1]", "\n- -1.5\n- 2\n- 1e-1");
    assert_eq!(parse(&block).unwrap().map_from_grid, good.map_from_grid);
    for text in [
        GOOD.replace('\n', "\r\n"),
        GOOD.replace('\n', " \t\n"),
        GOOD.replace(": ", ":\t"),
        format!("\u{feff}{GOOD}"),
        format!("---\n{GOOD}...\n"),
    ] {
        let mut read = parse(&text).unwrap();
        read.image_named_at = good.image_named_at;
        assert_eq!(read, good, "{text:?}");
    }
}

#[test]
fn unknown_keys_are_returned_with_their_place() {
    let text = format!("# by hand\nframe_id: map\n{GOOD}occupied_tresh: !x {{a: [1]}}\n2: ~\n");
    let unknown = parse(&text).unwrap().unknown;
    let found: Vec<_> = unknown
        .iter()
        .map(|key| (key.key.as_str(), key.line, key.column))
        .collect();
    assert_eq!(
        found,
        [("frame_id", 2, 1), ("occupied_tresh", 9, 1), ("2", 10, 1)]
    );
    assert_eq!(parse(GOOD).unwrap().unknown, []);
}

#[test]
fn refused_values_name_file_place_and_what_is_allowed() {
    // Key, values in the file, line and column, value in the error if it differs, what is allowed.
    let check = |key: &str, value: &str, at: &str, found: &str, allowed: &str| {
        let line = GOOD.lines().find(|line| line.starts_with(key)).unwrap();
        let expected = format!("maps/floor.yaml:{at}: {key} is {found}; allowed: {allowed}");
        assert_eq!(
            refusal(line, format!("{key}: {value}").trim_end()),
            expected
        );
    };
    let allowed = "0.001..=10 m a cell";
    for value in [".nan", "-0.05", ".inf", "0.0005", "50", "fine", "0"] {
        check("resolution", value, "2:13", value, allowed);
    }
    check("resolution", "'5 cm'", "2:13", "5 cm", allowed);
    check("resolution", "", "2:11", "nothing", allowed);
    let allowed = "[x, y, yaw], three numbers in metres and radians";
    for value in ["[-1.5, 2]", "[-1.5, 2, 0, 0]", "[-1.5, two, 0]"] {
        check("origin", value, "3:9", value, allowed);
    }
    check("origin", "[~, 2, 0]", "3:9", "[nothing, 2, 0]", allowed);
    let allowed = "x and y within 100000000 m, and a yaw within 6.283 rad (radians, not degrees)";
    check("origin", "[1, 2, 90]", "3:9", "[1, 2, 90]", allowed);
    for word in [
        ".nan", "nan", "-nan", "NaN", "'.NAN'", ".inf", "-.inf", "inf", "1e999",
    ] {
        let found = format!("[0, {}, 0]", word.trim_matches('\''));
        check("origin", &format!("[0, {word}, 0]"), "3:9", &found, allowed);
    }
    for value in ["2", "0.5", "-1", "nan", "perhaps"] {
        check("negate", value, "4:9", value, "0, 1, false or true");
    }
    check("occupied_thresh", "65", "5:18", "65", "0..=1");
    for value in [".nan", "inf", "-0.1", "most"] {
        check("free_thresh", value, "6:14", value, "0..=1");
    }
    let allowed = "below occupied_thresh, which is 0.65";
    check("free_thresh", "0.65", "6:14", "0.65", allowed);
    let allowed = "the name of a PGM, PNG or BMP file";
    check("image", "''", "1:8", "empty", allowed);
}

#[test]
fn refused_documents_name_file_and_place() {
    let mode = parse(&format!("{GOOD}mode: binary\n")).unwrap_err();
    assert_eq!(
        mode.to_string(),
        "maps/floor.yaml:7:7: mode is binary; allowed: trinary, scale or raw"
    );
    let missing = refusal("free_thresh: 0.196\n", "");
    assert!(missing.contains("free_thresh"), "{missing}");
    let twice = parse(&format!("{GOOD}negate: 1\n"))
        .unwrap_err()
        .to_string();
    assert!(twice.starts_with("maps/floor.yaml:7:1: "), "{twice}");
    let list = refusal("resolution: 0.05", "resolution: [0.05]");
    assert!(list.starts_with("maps/floor.yaml:2:13: "), "{list}");
    for nothing in ["", "[]", "just text", "image: [", "\u{0}"] {
        assert!(
            matches!(parse(nothing), Err(MapError::Yaml { .. })),
            "{nothing:?}"
        );
    }
}

proptest::proptest! {
    #[test]
    fn no_text_makes_it_panic(text in "\\PC{0,200}", cut in 0..GOOD.len(), byte in 0u8..128) {
        let _ = parse(&text);
        // One damaged character of a valid description.
        let mut bytes = GOOD.as_bytes().to_vec();
        bytes[cut] = byte;
        let _ = parse(std::str::from_utf8(&bytes).unwrap());
        let _ = parse(&GOOD[..cut]);
    }
}
