//! Decides which way the device looks: as stated in the configuration, by the name that the device
//! reports, or by the middle of its field.
//!
//! Pure except for the log, which reports once what the decision is based on.

use sick::cola::{AngleConvention, DeviceAngles, Field};

use crate::LmsError;

#[derive(Debug, Default)]
pub(crate) struct Angles {
    /// Statement of the configuration, which takes precedence over the reported name.
    stated: Option<DeviceAngles>,
    read: DeviceAngles,
    logged: Option<AngleConvention>,
}

impl Angles {
    pub(crate) fn new(stated: Option<DeviceAngles>) -> Self {
        Angles {
            stated,
            ..Angles::default()
        }
    }

    pub(crate) fn on_name(&mut self, name: &[u8]) {
        let read = DeviceAngles::of_name(name);
        if read != self.read {
            self.read = read;
            self.logged = None;
        }
    }

    /// Forgets the name, because the next connection may reach another device.
    pub(crate) fn forget_name(&mut self) {
        self.read = DeviceAngles::Unnamed;
        self.logged = None;
    }

    /// Returns the angle convention for a scan over `field`, and the longest range of the device,
    /// metres.
    pub(crate) fn of(&mut self, field: Field) -> Result<(AngleConvention, f32), LmsError> {
        let angles = self.stated.as_ref().unwrap_or(&self.read);
        let convention = angles.convention(field).map_err(LmsError::Other)?;
        if self.logged != Some(convention) {
            self.logged = Some(convention);
            tracing::info!(
                stated = self.stated.is_some(),
                "{convention} ({})",
                angles.reason()
            );
        }
        Ok((convention, angles.reach_m()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const USUAL: Field = Field {
        first_deg: -45.0,
        last_deg: 225.0,
    };

    #[test]
    fn a_statement_counts_more_than_the_name_and_that_more_than_the_field() {
        let mut angles = Angles::default();
        assert_eq!(angles.of(USUAL).unwrap(), (AngleConvention::USUAL, 80.0));
        angles.on_name(b"NAV310");
        let (nav, reach_m) = angles.of(USUAL).unwrap();
        assert_eq!(
            (nav.ahead_deg, nav.clockwise, reach_m),
            (180.0, true, 250.0)
        );
        angles.forget_name();
        assert_eq!(angles.of(USUAL).unwrap(), (AngleConvention::USUAL, 80.0));
        let mut angles = Angles::new(Some(DeviceAngles::of_name(b"TiM240")));
        angles.on_name(b"NAV310");
        assert_eq!(angles.of(USUAL).unwrap().0.ahead_deg, 0.0);
    }
}
