//! Which way the device looks: as it is stated, or by the name that it says, or by the
//! middle of its field.
//!
//! Pure but for the log, which says once what the answer is based on.

use sick::cola::{AngleConvention, ConventionError, DeviceAngles, Field};

/// What is known of the device that sends now.
#[derive(Debug, Default)]
pub(crate) struct Angles {
    /// By the configuration; what the device says does not count beside it.
    stated: Option<DeviceAngles>,
    read: DeviceAngles,
    /// What has been logged.
    logged: Option<AngleConvention>,
}

impl Angles {
    pub(crate) fn new(stated: Option<DeviceAngles>) -> Self {
        Angles {
            stated,
            ..Angles::default()
        }
    }

    /// The device says its name.
    pub(crate) fn on_name(&mut self, name: &[u8]) {
        let read = DeviceAngles::of_name(name);
        if read != self.read {
            self.read = read;
            self.logged = None;
        }
    }

    /// Another device may come.
    pub(crate) fn forget_name(&mut self) {
        self.read = DeviceAngles::Unnamed;
        self.logged = None;
    }

    /// How the angles of a scan over `field` are to be read, and how far the device
    /// measures, metres.
    ///
    /// # Errors
    /// [`ConventionError`] where that is not known.
    pub(crate) fn of(&mut self, field: Field) -> Result<(AngleConvention, f32), ConventionError> {
        let angles = self.stated.as_ref().unwrap_or(&self.read);
        let convention = angles.convention(field)?;
        let reach_m = angles.reach_m();
        if self.logged != Some(convention) {
            self.log(convention);
        }
        Ok((convention, reach_m))
    }

    fn log(&mut self, convention: AngleConvention) {
        match self.stated.as_ref().unwrap_or(&self.read) {
            DeviceAngles::Known(row) => {
                let stated = self.stated.is_some();
                tracing::info!(
                    device = row.name,
                    stated,
                    source = row.source,
                    "{convention}"
                );
            }
            DeviceAngles::Stated(_) => tracing::info!("{convention}, as stated"),
            DeviceAngles::Unknown(name) => {
                tracing::info!(%name, "{convention}: the device is not in the table, and its field is centred there");
            }
            DeviceAngles::Unnamed => {
                tracing::info!(
                    "{convention}: the device did not say its name, and its field is centred there"
                );
            }
        }
        self.logged = Some(convention);
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
        assert_eq!(angles.of(USUAL), Ok((AngleConvention::USUAL, 80.0)));
        angles.on_name(b"NAV310");
        let (nav, reach_m) = angles.of(USUAL).unwrap();
        assert_eq!(
            (nav.ahead_deg, nav.clockwise, reach_m),
            (180.0, true, 250.0)
        );
        angles.forget_name();
        assert_eq!(angles.of(USUAL), Ok((AngleConvention::USUAL, 80.0)));
        let mut angles = Angles::new(Some(DeviceAngles::of_name(b"TiM240")));
        angles.on_name(b"NAV310");
        assert_eq!(angles.of(USUAL).unwrap().0.ahead_deg, 0.0);
    }
}
