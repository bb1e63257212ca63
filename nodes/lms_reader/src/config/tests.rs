use super::*;

fn parse(arguments: &str) -> Result<Config, String> {
    let words = ["lms_reader"]
        .into_iter()
        .chain(arguments.split_whitespace());
    let config = Config::try_parse_from(words).map_err(|error| error.to_string())?;
    config.check().map(|()| config)
}

#[test]
fn a_device_whose_zero_is_elsewhere() {
    let angles = |arguments: &str| parse(arguments).unwrap().stated_angles();
    assert_eq!(angles("--capture a"), None);
    let tim = angles("--capture a --device tim240").unwrap();
    assert_eq!(
        tim.certain().map(|c| (c.ahead_deg, c.clockwise)),
        Some((0.0, false))
    );
    let nav = angles("--tcp a:1 --zero-deg -180 --clockwise").unwrap();
    assert_eq!(
        nav.certain().map(|c| (c.ahead_deg, c.clockwise)),
        Some((-180.0, true))
    );
}

#[test]
fn a_serial_device() {
    let config = parse("--serial /dev/ttyUSB0 --baud 500000 --range 80 --field 100").unwrap();
    let range = config.range.unwrap();
    assert_eq!(config.baud, Some(Baud::B500000));
    assert_eq!((range.mode.mask(), range.unit), (0x1fff, Unit::Centimetre));
    assert!(parse("--serial a --resolution 0.25 --field 100 --mount -0.1,0.2,180").is_ok());
}

#[test]
fn what_is_refused_says_what_is_allowed() {
    let refuse = |arguments: &str, expected: &str| {
        let text = parse(arguments).unwrap_err();
        assert!(text.contains(expected), "{arguments}: {text}");
    };
    refuse("", "--tcp");
    refuse("--tcp 192.168.0.1", "HOST:PORT with a port from 1 to 65535");
    refuse("--tcp a:0", "1 to 65535");
    refuse("--serial a --baud 57600", "38400 and 500000");
    refuse("--serial a --field 90", "100 or 180 at 0.5 or 1");
    refuse("--serial a --field 180 --resolution 0.25", "100 at 0.25");
    refuse("--serial a --range 10", "8, 16, 32 and 80");
    refuse("--serial a --start-stream false", "must be asked");
    refuse("--tcp a:1 --field 0", "1 to 360 degrees");
    refuse("--tcp a:1 --resolution 9", "0.01 to 5 degrees");
    refuse("--tcp a:1 --mount 1,2", "X,Y,YAW_DEG");
    refuse("--tcp a:1 --silence 0", "0.2 to 3600");
    refuse("--tcp a:1 --device XY7", "known are LMS1xx, LMS5xx");
    refuse("--tcp a:1 --device NAV245", "the sources differ");
    refuse("--tcp a:1 --zero-deg 361", "-360 to 360 degrees");
    refuse("--tcp a:1 --clockwise", "--zero-deg");
    refuse("--tcp a:1 --range-min-m 90", "the maximum must be larger");
    refuse("--tcp a:1 --range-min-m nan", "finite");
    refuse("--tcp a:1 --range-max-m 0.01", "the maximum must be larger");
    refuse(
        &format!("--tcp a:1 --frame {}", "f".repeat(257)),
        "257 bytes, allowed are 1 to 256",
    );
}
