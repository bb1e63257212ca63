//! Decides which way a device looks, or which option the user must give if that is unknown: a
//! rotated or mirrored scan yields a pose that is wrong but looks right.

use super::known_device::USUAL_REACH_M;
use super::{AngleConvention, Field, KnownDevice};

/// Largest distance of the middle of a field from the usual 90°, degrees. A device may leave out
/// the last beam of a centred field, which is half of the coarsest step of 1°; its step is rounded
/// to 1/10000°, which adds up to 0.02° in 811 beams at a third of a degree.
const TOLERANCE_DEG: f64 = 1.0;

/// Knowledge about how a device counts its angles.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum DeviceAngles {
    /// The device has not reported its name.
    #[default]
    Unnamed,
    /// The reported name is not in the table.
    Unknown(String),
    /// The reported name is in the table.
    Known(&'static KnownDevice),
    Stated(AngleConvention),
}

impl DeviceAngles {
    /// Looks up the name that a device reports (`DeviceIdent`).
    pub fn of_name(name: &[u8]) -> Self {
        let name = name.escape_ascii().to_string();
        match KnownDevice::named(&name) {
            Some(row) => DeviceAngles::Known(row),
            None => DeviceAngles::Unknown(name),
        }
    }

    /// Returns the angle convention for a scan over `field`, or the reason why it is unknown.
    pub fn convention(&self, field: Field) -> Result<AngleConvention, String> {
        if let DeviceAngles::Known(row) = self
            && row.convention.is_none()
        {
            return Err(format!(
                "which way a {} looks is not known: the sources differ ({}); no scan is published \
                 until lms_reader is given {OPTIONS}",
                row.name, row.source
            ));
        }
        let usual = AngleConvention::USUAL;
        let is_centred = (field.middle_deg() - usual.ahead_deg).abs() <= TOLERANCE_DEG;
        let certain = self.certain().or(is_centred.then_some(usual));
        certain.ok_or_else(|| {
            let name = self.name_in_words();
            format!(
                "which way the laser looks is not known: {name}, and its field, {field}, is not \
                 centred on 90°, which is ahead on most SICK lasers; no scan is published until \
                 lms_reader is given --device NAME (such as TiM240, NAV310 or LMS111), or {OPTIONS}"
            )
        })
    }

    /// Returns the reason for a convention that was found, in words.
    pub fn reason(&self) -> String {
        match self {
            DeviceAngles::Stated(_) => "as stated".to_owned(),
            DeviceAngles::Known(row) => format!("as a {}: {}", row.name, row.source),
            _ => format!("{}, and its field is centred there", self.name_in_words()),
        }
    }

    fn name_in_words(&self) -> String {
        match self {
            DeviceAngles::Unknown(name) => format!("{name} is not in the table"),
            _ => "its name was not read".to_owned(),
        }
    }

    /// Returns the convention if it does not depend on the field.
    pub fn certain(&self) -> Option<AngleConvention> {
        match self {
            DeviceAngles::Stated(convention) => Some(*convention),
            DeviceAngles::Known(row) => row.convention,
            DeviceAngles::Unnamed | DeviceAngles::Unknown(_) => None,
        }
    }

    /// Longest range that the device is known to measure, metres.
    pub fn reach_m(&self) -> f32 {
        match self {
            DeviceAngles::Known(row) => row.reach_m(),
            _ => USUAL_REACH_M,
        }
    }
}

const OPTIONS: &str = "--zero-deg DEGREES, the device's own angle that points ahead, with \
                       --clockwise if its angles grow clockwise";

#[cfg(test)]
mod tests {
    use super::*;

    fn field(first_deg: f64, last_deg: f64) -> Field {
        Field {
            first_deg,
            last_deg,
        }
    }

    #[test]
    fn a_known_name_needs_no_field_and_a_statement_no_name() {
        let part = field(0.0, 90.0);
        let lms = DeviceAngles::of_name(b"LMS111");
        assert_eq!(lms.convention(part), Ok(AngleConvention::USUAL));
        let tim = DeviceAngles::of_name(b"TiM240").certain().unwrap();
        assert_eq!((tim.ahead_deg, tim.clockwise), (0.0, false));
        let nav = DeviceAngles::of_name(b"NAV310").certain().unwrap();
        assert_eq!((nav.ahead_deg, nav.clockwise), (180.0, true));
        assert_eq!(DeviceAngles::Stated(nav).convention(part), Ok(nav));
    }

    #[test]
    fn without_a_name_the_middle_decides() {
        for angles in [DeviceAngles::Unnamed, DeviceAngles::of_name(b"XY-7")] {
            for (first_deg, last_deg) in [(-45.0, 224.973), (-5.0, 185.0), (0.0, 179.0)] {
                let found = angles.convention(field(first_deg, last_deg));
                assert_eq!(found, Ok(AngleConvention::USUAL), "{first_deg}");
            }
            for (first_deg, last_deg) in [(-120.0, 120.0), (0.0, 359.75), (0.0, 90.0), (0.0, 177.9)]
            {
                let text = angles.convention(field(first_deg, last_deg)).unwrap_err();
                for part in ["--device NAME", "TiM240", "--zero-deg", "--clockwise"] {
                    assert!(text.contains(part), "{text}");
                }
                assert!(
                    text.contains(&format!("{first_deg}° to {last_deg}°")),
                    "{text}"
                );
            }
        }
        let unknown = DeviceAngles::of_name(b"XY-7\xff");
        let text = unknown.convention(field(0.0, 1.0)).unwrap_err();
        assert!(text.contains(r"XY-7\xff is not in the table"), "{text}");
    }

    #[test]
    fn where_sources_differ_it_must_be_stated() {
        let nav = DeviceAngles::of_name(b"NAV245");
        let error = nav.convention(field(-45.0, 225.0)).unwrap_err();
        assert!(error.contains("--zero-deg"), "{error}");
        assert!(!error.contains("--device"), "{error}");
        assert_eq!(nav.certain(), None);
    }
}
