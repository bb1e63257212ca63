//! The taper: the decrease of a reading's votes in front of it and behind it.
//!
//! The paper's Eq. 1 is a Gaussian, and the paper adds that any shape works that is highest at the
//! reading and tapers off. All shapes here have a peak of 1 and never rise with the distance.

/// Shape of a taper over the distance from the reading, in units of σ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum TaperShape {
    /// exp(-d²/2), Eq. 1 of the paper.
    Gaussian,
    /// Linear to zero at 2σ.
    Linear,
    /// Flat to σ, then linear to zero at 2.5σ.
    Trapezoid,
    /// Flat to 2σ, then zero.
    Box,
}

impl TaperShape {
    /// Returns the height at `distance` σ, in 0..=1.
    #[must_use]
    pub fn height(self, distance: f64) -> f64 {
        match self {
            TaperShape::Gaussian => (-0.5 * distance * distance).exp(),
            TaperShape::Linear => (1.0 - distance / 2.0).max(0.0),
            TaperShape::Trapezoid => ((2.5 - distance) / 1.5).clamp(0.0, 1.0),
            TaperShape::Box => f64::from(u8::from(distance <= 2.0)),
        }
    }

    /// Returns the votes at 0, 1, 2, … steps from the reading, `round(peak · height)`, up to but
    /// excluding the first zero. Empty if the peak itself rounds to zero.
    pub fn profile(self, peak: f64, sigma_steps: f64) -> impl Iterator<Item = u8> {
        (0..)
            .map(move |steps| (peak * self.height(f64::from(steps) / sigma_steps)).round() as u8)
            .take_while(|&votes| votes > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [TaperShape; 4] = [
        TaperShape::Gaussian,
        TaperShape::Linear,
        TaperShape::Trapezoid,
        TaperShape::Box,
    ];

    fn profile(shape: TaperShape, peak: f64, sigma_steps: f64) -> Vec<u8> {
        shape.profile(peak, sigma_steps).collect()
    }

    #[test]
    fn shapes_have_their_widths() {
        assert_eq!(profile(TaperShape::Box, 15.0, 2.0), [15; 5]);
        assert_eq!(profile(TaperShape::Linear, 15.0, 2.0), [15, 11, 8, 4]);
        assert_eq!(
            profile(TaperShape::Trapezoid, 15.0, 2.0),
            [15, 15, 15, 10, 5]
        );
        // exp(-2) · 15 = 2.03 at two σ, exp(-4.5) · 15 = 0.17 at three.
        assert_eq!(profile(TaperShape::Gaussian, 15.0, 1.0), [15, 9, 2]);
    }

    #[test]
    fn no_shape_rises_with_distance() {
        for shape in ALL {
            for sigma in [0.71, 1.0, 2.3, 18.0] {
                let profile = profile(shape, 15.75, sigma);
                assert_eq!(profile.first(), Some(&16), "{shape:?} peaks at the reading");
                assert!(profile.is_sorted_by(|a, b| a >= b), "{shape:?} {sigma}");
            }
        }
    }

    #[test]
    fn a_peak_that_rounds_to_nothing_has_no_votes() {
        assert_eq!(profile(TaperShape::Trapezoid, 0.4, 2.0), []);
    }
}
