//! Covariance of a pose.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use crate::Pose;

/// Radius in standard deviations of the ellipse that contains 95 % of positions: √(-2 ln 0.05), as
/// χ² with two degrees of freedom is exponential.
pub const ELLIPSE_95: f64 = 2.447_746_830_680_816;

/// Deviation on either side, in standard deviations, that contains 95 % of angles.
pub const ANGLE_95: f64 = 1.959_963_984_540_054;

/// Covariance of a pose: rows and columns are x, y (metres) and yaw (radians),
/// in the frame in which the pose is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Covariance(Matrix3<f64>);

/// The one-sigma ellipse of a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Half the longer axis in metres.
    pub major_m: f64,
    /// Half the shorter axis in metres.
    pub minor_m: f64,
    /// Direction of the longer axis, in radians from the frame's x axis.
    pub angle: f64,
}

impl Covariance {
    /// Creates a covariance from independent standard deviations in metres, metres and radians.
    #[must_use]
    pub fn from_deviations(x_m: f64, y_m: f64, yaw: f64) -> Self {
        Covariance(Matrix3::from_diagonal(
            &[x_m * x_m, y_m * y_m, yaw * yaw].into(),
        ))
    }

    /// Returns the covariance of pose `of`, if this is the covariance of pose `known` and the two
    /// are rigidly connected: the uncertain heading of one adds to the position of the other.
    #[must_use]
    pub fn carried(self, known: Pose, of: Pose) -> Self {
        if known == of {
            return self;
        }
        let (dx, dy) = (of.x - known.x, of.y - known.y);
        let jacobian = Matrix3::new(1.0, 0.0, -dy, 0.0, 1.0, dx, 0.0, 0.0, 1.0);
        Covariance(jacobian * self.0 * jacobian.transpose())
    }

    /// Returns the second moment about pose `other` of a distribution with this covariance and mean
    /// `mean`.
    #[must_use]
    pub fn about(self, mean: Pose, other: Pose) -> Self {
        let yaw = crate::wrap_angle(mean.yaw - other.yaw);
        let off = Vector3::new(mean.x - other.x, mean.y - other.y, yaw);
        Covariance(self.0 + off * off.transpose())
    }

    /// Returns the elements row by row, as in messages.
    #[must_use]
    pub fn to_rows(self) -> [f64; 9] {
        std::array::from_fn(|i| self.0[(i / 3, i % 3)])
    }

    /// Creates a covariance from [`Covariance::to_rows`].
    #[must_use]
    pub fn from_rows(rows: [f64; 9]) -> Self {
        Covariance(Matrix3::from_row_slice(&rows))
    }

    /// True if the covariance is positive definite, and symmetric up to the rounding of 32 bits.
    #[must_use]
    pub fn is_positive_definite(self) -> bool {
        let asymmetry = (self.0 - self.0.transpose()).amax();
        asymmetry <= 1e-6 * self.0.amax() && self.0.cholesky().is_some()
    }

    /// Returns the one-sigma ellipse of the position, with the heading marginalised.
    #[must_use]
    pub fn ellipse(self) -> Ellipse {
        let eigen = self.of_position().symmetric_eigen();
        let major = if eigen.eigenvalues[0] >= eigen.eigenvalues[1] {
            0
        } else {
            1
        };
        let axis = eigen.eigenvectors.column(major);
        Ellipse {
            major_m: eigen.eigenvalues[major].max(0.0).sqrt(),
            minor_m: eigen.eigenvalues[1 - major].max(0.0).sqrt(),
            angle: axis[1].atan2(axis[0]),
        }
    }

    /// Returns the squared Mahalanobis distance of a position offset (x and y in metres), with the
    /// heading marginalised. Infinite if the covariance of the position is singular.
    #[must_use]
    pub fn squared_deviations(self, (x, y): (f64, f64)) -> f64 {
        let off = Vector2::new(x, y);
        self.of_position()
            .try_inverse()
            .map_or(f64::INFINITY, |information| off.dot(&(information * off)))
    }

    fn of_position(self) -> Matrix2<f64> {
        self.0.fixed_view::<2, 2>(0, 0).into_owned()
    }
}

impl From<Matrix3<f64>> for Covariance {
    fn from(matrix: Matrix3<f64>) -> Self {
        Covariance(matrix)
    }
}

impl From<Covariance> for Matrix3<f64> {
    fn from(covariance: Covariance) -> Self {
        covariance.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_base_is_less_sure_to_the_side_than_the_laser_ahead_of_it() {
        let known = Pose::new(5.0, 5.0, 0.0);
        let base = Pose::new(4.0, 5.0, 0.0);
        let covariance = Covariance::from_rows([0.01, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.04]);
        let expected = [0.01, 0.0, 0.0, 0.0, 0.05, -0.04, 0.0, -0.04, 0.04];
        let carried = covariance.carried(known, base).to_rows();
        for (found, expected) in carried.iter().zip(expected) {
            // The tolerance covers a few products and sums.
            assert!(
                (found - expected).abs() < 1e-15,
                "{found} is not {expected}"
            );
        }
        assert_eq!(covariance.carried(known, known), covariance);
    }

    #[test]
    fn the_ellipse_lies_along_the_longer_axis() {
        let ellipse = Covariance::from_deviations(0.1, 2.0, 0.01).ellipse();
        assert!((ellipse.major_m - 2.0).abs() < 1e-12);
        assert!((ellipse.minor_m - 0.1).abs() < 1e-12);
        assert!((ellipse.angle.sin().abs() - 1.0).abs() < 1e-12, "along y");
    }

    #[test]
    fn ellipses_of_95_percent_hold_that_much() {
        // A normal distribution in the plane has a share of exp(-r²/2) beyond r deviations.
        assert!(((-ELLIPSE_95 * ELLIPSE_95 / 2.0).exp() - 0.05).abs() < 1e-15);
    }

    #[test]
    fn offsets_are_measured_in_deviations() {
        let along_y = Covariance::from_deviations(0.1, 2.0, 0.01);
        assert!((along_y.squared_deviations((0.3, 0.0)) - 9.0).abs() < 1e-9);
        assert!((along_y.squared_deviations((0.1, 2.0)) - 2.0).abs() < 1e-9);
        // Correlated errors: an offset along the diagonal is more likely than one across.
        let rows = [1.0, 0.8, 0.0, 0.8, 1.0, 0.0, 0.0, 0.0, 1.0];
        let diagonal = Covariance::from_rows(rows);
        assert!((diagonal.squared_deviations((0.9, 0.9)) - 0.9).abs() < 1e-12);
        assert!((diagonal.squared_deviations((0.1, -0.1)) - 0.1).abs() < 1e-12);
        let none = Covariance::from_deviations(0.0, 1.0, 1.0);
        assert_eq!(none.squared_deviations((0.0, 0.1)), f64::INFINITY);
    }
}
