//! Table of devices and how they count their angles.
//!
//! Each row gives its source. A device is listed only if a document or SICK's own driver states its
//! convention; for all others the owner has to state it.

use super::AngleConvention;

/// Row of the table: devices with the same convention.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownDevice {
    /// Common name, such as `TiM5xx`.
    pub name: &'static str,
    /// Letters in upper case and digits; `#` stands for any digit and for the X of a name such as
    /// `TIM2xx`.
    model: &'static str,
    /// Angle convention; `None` if the sources contradict each other.
    pub convention: Option<AngleConvention>,
    /// Longest range in metres, if it exceeds [`USUAL_REACH_M`].
    reach_m: Option<f32>,
    pub source: &'static str,
}

/// Longest range of most devices, metres.
pub const USUAL_REACH_M: f32 = 80.0;

/// SICK's driver <https://github.com/SICKAG/sick_scan_xd>: angle shift of each device.
const DRIVER: &str = "sick_scan_xd, driver/src/sick_generic_parser.cpp";
/// Layout of scans in the same driver.
const LAYOUT: &str =
    "sick_scan_xd, configureAngleParameters in driver/src/sick_lmd_scandata_parser.cpp";

impl KnownDevice {
    pub const ALL: [KnownDevice; 17] = [
        usual("LMS1xx", "LMS1##", DRIVER),
        usual("LMS5xx", "LMS5##", DRIVER),
        usual("LMS1000", "LMS1###", DRIVER),
        usual(
            "LMS4000",
            "LMS4###",
            "SICK, operating instructions LMS4000 (8023198): 55° to 125°",
        ),
        usual(
            "TiM5xx",
            "TIM5##",
            "SICK, technical information TiM55x/56x/57x (8015883): -45° to 225°",
        ),
        usual(
            "TiM7xx",
            "TIM7##",
            "SICK, operating instructions TiM781 (8024231): -45° to 225°",
        ),
        usual("TiM4xx", "TIM4##", DRIVER),
        usual("MRS1000", "MRS1###", DRIVER),
        usual("MRS1000", "MRS1####", DRIVER),
        usual("MRS6000", "MRS6###", DRIVER),
        row(
            "TiM2xx",
            "TIM2##",
            counter_clockwise(0.0),
            None,
            "sick_scan_xd, issue 478: on the TiM240 the x axis points ahead",
        ),
        row(
            "LRS4000",
            "LRS4###",
            counter_clockwise(0.0),
            Some(130.0),
            "sick_scan_xd, driver/src/sick_generic_parser.cpp, issue 28, REQUIREMENTS.md",
        ),
        row(
            "NAV310",
            "NAV31#",
            clockwise(180.0),
            Some(250.0),
            "sick_scan_xd, launch/sick_nav_31x.launch and issue 59: it turns clockwise, 0° is behind",
        ),
        row("LD-OEM15xx", "OEM15##", clockwise(180.0), None, LAYOUT),
        row("LD-LRS36x0", "LRS36#0", clockwise(180.0), None, LAYOUT),
        row(
            "LD-LRS36x1",
            "LRS36#1",
            counter_clockwise(180.0),
            None,
            "sick_scan_xd, driver/src/sick_generic_parser.cpp and launch/sick_lrs_36x1.launch",
        ),
        row(
            "NAV2xx",
            "NAV2##",
            None,
            Some(100.0),
            "sick_scan_xd: 90° is ahead in angle_compensator.cpp, 0° in sick_generic_parser.cpp",
        ),
    ];

    /// Finds the row of a name as the device reports it (`DeviceIdent`) or as people write it:
    /// `LMS10x_FieldEval`, `TIM2xx V1.0`, `NAV310-3211`, `tim-240`.
    pub fn named(name: &str) -> Option<&'static KnownDevice> {
        let found = model(name)?;
        Self::ALL.iter().find(|row| {
            let mut pairs = row.model.chars().zip(found.chars());
            row.model.len() == found.len() && pairs.all(|(a, b)| a == b || a == '#')
        })
    }

    /// Longest range that the device measures, metres.
    pub fn reach_m(&self) -> f32 {
        self.reach_m.unwrap_or(USUAL_REACH_M)
    }

    /// Returns a list of the devices with a known convention, for messages.
    pub fn names() -> String {
        let rows = Self::ALL.iter().filter(|row| row.convention.is_some());
        let mut names: Vec<&str> = rows.map(|row| row.name).collect();
        names.dedup();
        names.join(", ")
    }
}

/// Returns letters and number of a name in upper case: `TIM2XX`.
fn model(name: &str) -> Option<String> {
    let name = name.trim_start().to_ascii_uppercase();
    let is_gap = |c: char| matches!(c, ' ' | '-' | '_');
    let mut rest = name.as_str();
    for prefix in ["SICK", "LD"] {
        if let Some(after) = rest.strip_prefix(prefix)
            && after.starts_with(is_gap)
        {
            rest = after.trim_start_matches(is_gap);
        }
    }
    let end = rest.find(|c: char| !c.is_ascii_uppercase())?;
    let (family, rest) = rest.split_at_checked(end)?;
    let rest = rest.trim_start_matches(is_gap);
    let end = rest.find(|c: char| !(c.is_ascii_digit() || c == 'X'));
    let number = rest.get(..end.unwrap_or(rest.len()))?;
    number
        .starts_with(|c: char| c.is_ascii_digit())
        .then(|| [family, number].concat())
}

const fn usual(name: &'static str, model: &'static str, source: &'static str) -> KnownDevice {
    row(name, model, Some(AngleConvention::USUAL), None, source)
}

const fn row(
    name: &'static str,
    model: &'static str,
    convention: Option<AngleConvention>,
    reach_m: Option<f32>,
    source: &'static str,
) -> KnownDevice {
    KnownDevice {
        name,
        model,
        convention,
        reach_m,
        source,
    }
}

const fn counter_clockwise(ahead_deg: f64) -> Option<AngleConvention> {
    Some(AngleConvention {
        ahead_deg,
        clockwise: false,
    })
}

const fn clockwise(ahead_deg: f64) -> Option<AngleConvention> {
    Some(AngleConvention {
        ahead_deg,
        clockwise: true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_as_devices_and_people_say_them() {
        for (name, row) in [
            ("LMS10x_FieldEval", "LMS1xx"),
            ("LMS111 emulated", "LMS1xx"),
            ("LMS1xxx", "LMS1000"),
            ("LMS1104C", "LMS1000"),
            ("LMS511-10100 PRO", "LMS5xx"),
            ("LMS4111R", "LMS4000"),
            ("TiM561", "TiM5xx"),
            ("TiM781S", "TiM7xx"),
            ("TiM240", "TiM2xx"),
            ("TIM2xx V1.0", "TiM2xx"),
            (" tim-240", "TiM2xx"),
            ("SICK TiM 240", "TiM2xx"),
            ("MRS1xxxx", "MRS1000"),
            ("MRS1104", "MRS1000"),
            ("NAV310-3211", "NAV310"),
            ("NAV31X", "NAV310"),
            ("NAV245", "NAV2xx"),
            ("LRS4581R", "LRS4000"),
            ("LD-LRS3600", "LD-LRS36x0"),
            ("LRS36x1", "LD-LRS36x1"),
            ("LD_OEM1501", "LD-OEM15xx"),
        ] {
            assert_eq!(
                KnownDevice::named(name).map(|r| r.name),
                Some(row),
                "{name}"
            );
        }
    }

    #[test]
    fn every_row_is_found_by_its_own_name() {
        for row in &KnownDevice::ALL {
            let found = KnownDevice::named(row.name).unwrap();
            assert_eq!((found.name, found.convention), (row.name, row.convention));
        }
    }

    #[test]
    fn other_names_are_not_known() {
        // A NAV350 does not send this kind of scan, and an LRS36xx may be either.
        for name in [
            "",
            "TiM",
            "240",
            "TIMxx",
            "TiM24",
            "TiM2400",
            "NAV350",
            "NAV3xx",
            "LRS36xx",
            "S300",
            "LMS",
            "LDLRS",
            "picoScan150",
            "überLMS111",
        ] {
            assert_eq!(KnownDevice::named(name), None, "{name}");
        }
    }

    proptest::proptest! {
        #[test]
        fn no_name_panics(name in "\\PC{0,20}") {
            let _ = KnownDevice::named(&name);
        }
    }
}
