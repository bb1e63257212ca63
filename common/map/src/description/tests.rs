use super::*;

const GOOD: &str = "image: floor.pgm\nresolution: 0.05\norigin: [-1.5, 2, 0.1]\n\
                    negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

fn parse(text: &str) -> Result<Description, MapError> {
    Description::parse(text, Path::new("maps/floor.yaml"))
}

/// Returns the error for `GOOD` with one piece replaced.
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
    assert_eq!(
        refusal("resolution: 0.05", "resolution: 0"),
        "maps/floor.yaml:2:13: resolution is 0; allowed: 0.001..=10 m a cell"
    );
    for resolution in [
        ".nan", "nan", "-0.05", ".inf", "0.0005", "50", "fine", "'5 cm'",
    ] {
        let message = refusal("resolution: 0.05", &format!("resolution: {resolution}"));
        assert!(
            message.starts_with("maps/floor.yaml:2:13: resolution is "),
            "{message}"
        );
    }
    assert_eq!(
        refusal("resolution: 0.05", "resolution:"),
        "maps/floor.yaml:2:11: resolution is nothing; allowed: 0.001..=10 m a cell"
    );
    for (found, shown) in [
        ("[-1.5, 2]", "[-1.5, 2]"),
        ("[-1.5, 2, 0, 0]", "[-1.5, 2, 0, 0]"),
        ("[-1.5, two, 0]", "[-1.5, two, 0]"),
        ("[~, 2, 0]", "[nothing, 2, 0]"),
    ] {
        assert_eq!(
            refusal("[-1.5, 2, 0.1]", found),
            format!(
                "maps/floor.yaml:3:9: origin is {shown}; allowed: [x, y, yaw], three numbers in \
                 metres and radians"
            )
        );
    }
    let degrees = refusal("[-1.5, 2, 0.1]", "[-1.5, 2, 90]");
    assert!(degrees.contains("radians, not degrees"), "{degrees}");
    for word in [
        ".nan", "nan", "-nan", "NaN", "'.NAN'", ".inf", "-.inf", "inf", "1e999",
    ] {
        let message = refusal("[-1.5, 2, 0.1]", &format!("[0, {word}, 0]"));
        assert_eq!(
            message,
            format!(
                "maps/floor.yaml:3:9: origin is [0, {}, 0]; allowed: x and y within 100000000 m, and \
                 a yaw within 6.283 rad (radians, not degrees)",
                word.trim_matches('\'')
            )
        );
    }
    assert_eq!(
        refusal("free_thresh: 0.196", "free_thresh: 0.65"),
        "maps/floor.yaml:6:14: free_thresh is 0.65; allowed: below occupied_thresh, which is 0.65"
    );
    assert_eq!(
        refusal("occupied_thresh: 0.65", "occupied_thresh: 65"),
        "maps/floor.yaml:5:18: occupied_thresh is 65; allowed: 0..=1"
    );
    for threshold in [".nan", "inf", "-0.1", "most"] {
        assert_eq!(
            refusal("free_thresh: 0.196", &format!("free_thresh: {threshold}")),
            format!("maps/floor.yaml:6:14: free_thresh is {threshold}; allowed: 0..=1")
        );
    }
    for negate in ["2", "0.5", "-1", "nan", "perhaps"] {
        assert_eq!(
            refusal("negate: 0", &format!("negate: {negate}")),
            format!("maps/floor.yaml:4:9: negate is {negate}; allowed: 0, 1, false or true")
        );
    }
    assert_eq!(
        refusal("image: floor.pgm", "image: ''"),
        "maps/floor.yaml:1:8: image is empty; allowed: the name of a PGM, PNG or BMP file"
    );
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
