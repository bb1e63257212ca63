//! Settings of the known heading.

use super::HeadingSource;

/// Source of a known heading. By default all headings are searched.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct HeadingConfig {
    /// The laser's heading in the map, degrees counter-clockwise from its x
    /// axis, -360..=360: only x and y are searched.
    #[cfg_attr(feature = "clap", arg(long, value_name = "DEGREES", value_parser = crate::config::within(-360.0..=360.0, "degrees"), allow_negative_numbers = true))]
    #[cfg_attr(feature = "clap", arg(conflicts_with = "heading_from"))]
    pub heading: Option<f64>,

    /// Source of each scan's heading: only x and y are searched.
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "SOURCE"))]
    pub heading_from: Option<HeadingFrom>,

    /// Added to the heading from odometry, degrees, -360..=360: the heading in the map
    /// where odometry reads 0. Odometry drifts, so this is useful at the start of a
    /// run. Default 0.
    #[cfg_attr(feature = "clap", arg(long, value_name = "DEGREES", value_parser = crate::config::within(-360.0..=360.0, "degrees"), allow_negative_numbers = true))]
    pub heading_offset: Option<f64>,

    /// Maximum age of odometry at its scan, seconds, 0..=60. Default 1.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SECONDS", value_parser = crate::config::within(0.0..=60.0, "seconds")))]
    pub heading_max_age_s: Option<f64>,
}

/// Source of headings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum HeadingFrom {
    /// The newest odometry that was measured before the scan.
    Odometry,
    /// The true pose of the scan, if a recording contains it; for tests.
    Truth,
}

impl std::fmt::Display for HeadingFrom {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            HeadingFrom::Odometry => "odometry",
            HeadingFrom::Truth => "truth",
        })
    }
}

impl HeadingConfig {
    /// Returns the source of headings, in radians and nanoseconds.
    pub fn source(&self) -> HeadingSource {
        match (self.heading, self.heading_from) {
            (Some(degrees), _) => HeadingSource::Fixed(degrees.to_radians()),
            (None, None) => HeadingSource::Searched,
            (None, Some(HeadingFrom::Truth)) => HeadingSource::Truth,
            (None, Some(HeadingFrom::Odometry)) => HeadingSource::Odometry {
                offset: self.heading_offset.unwrap_or(0.0).to_radians(),
                max_age_ns: (self.heading_max_age_s.unwrap_or(1.0) * 1e9) as i64,
            },
        }
    }

    /// Checks a rule that clap cannot: an option's requirement is waived if another option excludes
    /// it, as `--heading` does here.
    ///
    /// # Errors
    /// Names the option and what it needs.
    pub fn check(&self) -> Result<(), String> {
        if self.heading_from == Some(HeadingFrom::Odometry) {
            return Ok(());
        }
        let options = [
            ("--heading-offset", self.heading_offset),
            ("--heading-max-age-s", self.heading_max_age_s),
        ];
        match options.iter().find(|(_, value)| value.is_some()) {
            Some((option, _)) => Err(format!("{option} needs --heading-from odometry")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
#[cfg(feature = "clap")]
mod tests {
    use super::*;
    use crate::vote_search::Prior;

    const SECOND_NS: i64 = 1_000_000_000;

    #[derive(Debug, clap::Parser)]
    struct Line {
        #[command(flatten)]
        heading: HeadingConfig,
    }

    fn parse(arguments: &str) -> Result<HeadingConfig, String> {
        let words = ["x"].into_iter().chain(arguments.split_whitespace());
        let line =
            <Line as clap::Parser>::try_parse_from(words).map_err(|error| error.to_string())?;
        line.heading.check().map(|()| line.heading)
    }

    fn source(arguments: &str) -> HeadingSource {
        parse(arguments).unwrap().source()
    }

    #[test]
    fn headings_are_given_in_degrees() {
        assert_eq!(source("").prior(), Prior::None);
        assert_eq!(
            source("--heading -90"),
            HeadingSource::Fixed(-std::f64::consts::FRAC_PI_2)
        );
        assert_eq!(source("--heading 0").prior(), Prior::Heading);
        assert_eq!(source("--heading-from truth"), HeadingSource::Truth);
        let odometry = |offset, max_age_ns| HeadingSource::Odometry { offset, max_age_ns };
        assert_eq!(source("--heading-from odometry"), odometry(0.0, SECOND_NS));
        assert_eq!(
            source("--heading-from odometry --heading-offset -180 --heading-max-age-s 0.25"),
            odometry(-std::f64::consts::PI, SECOND_NS / 4)
        );
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let refuse = |arguments: &str, expected: &str| {
            let text = parse(arguments).unwrap_err();
            assert!(text.contains(expected), "{arguments}: {text}");
        };
        refuse("--heading 10 --heading-from truth", "cannot be used with");
        let needs_odometry = [
            "--heading-offset 10",
            "--heading-max-age-s 1",
            "--heading 1 --heading-offset 10",
            "--heading-from truth --heading-offset 0",
            "--heading-from truth --heading-max-age-s 1",
        ];
        for arguments in needs_odometry {
            refuse(arguments, "needs --heading-from odometry");
        }
        refuse("--heading NaN", "-360 to 360 degrees");
        refuse(
            "--heading-from odometry --heading-max-age-s 61",
            "0 to 60 seconds",
        );
        refuse("--heading-from gps", "odometry, truth");
    }
}
