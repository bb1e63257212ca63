//! Refinement of a pose: Gauss-Newton on the distances of end points from obstacles, with Tukey's
//! weights against ends that belong to no obstacle.

use nalgebra::{Matrix3, Vector3};

use super::distance_field::{Lanes, lanes};
use super::ends::Ends;
use super::pull::{Add, Pull, Pulls};
use super::{DistanceField, FitConfig, GridPose};

/// A refined pose and the quality of its fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refined {
    /// Pose nearby with the best fit.
    pub pose: GridPose,
    /// Curvature of half the squared distances there: Σ w ∇d ∇dᵀ over x, y (cells) and the heading
    /// (radians).
    pub curvature: Matrix3<f64>,
    /// Weighted variance of the distances of the beams that belong to obstacles, in squared cells.
    pub variance: f64,
    /// Total weight of these beams.
    pub weight: f64,
    /// Combined pull of all ends at walls of one direction when these walls are off by a cell:
    /// Σ (Σ w ∇d) (Σ w ∇d)ᵀ, where the outer sum is over the directions.
    pub walls: Matrix3<f64>,
}

/// Prior knowledge of a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Expected pose.
    pub pose: GridPose,
    /// Inverse of its covariance over x, y (cells) and the heading (radians).
    pub information: Matrix3<f64>,
}

/// Prior knowledge used in a refinement.
#[derive(Debug, Clone, Copy)]
struct Known<'a> {
    heading: bool,
    expected: Option<&'a Expected>,
}

/// Number of beams that are worth one with an independent error: neighbouring beams end on the same
/// piece of wall, and maps err by walls, not by points.
const BEAMS_TOGETHER: f64 = 8.0;

/// Smallest variance of an end point, in squared cells: that of a uniform position within the cell
/// to which it is compared.
const MIN_VARIANCE: f64 = 1.0 / 12.0;

/// Smallest error of walls, in cells: they can be anywhere between the middle of their cells and
/// the edges.
const MIN_WALL_ERROR: f64 = 0.5;

/// Largest distances of beams that count, in standard deviations: coarse first, then fine.
const REACHES: [f64; 2] = [4.0, 2.0];

/// Largest number of steps with each reach.
const MAX_STEPS: usize = 6;

/// Length below which a step is the last with each reach, in cells and in hundredths of a radian.
const LAST_STEPS: [f64; 2] = [0.1, 0.02];

/// Returns the variance with which a single beam counts, given the measured variance.
fn independent(variance: f64) -> f64 {
    BEAMS_TOGETHER * variance.max(MIN_VARIANCE)
}

impl Refined {
    /// Information of the scan about the pose: the inverse of its covariance over x, y (cells) and
    /// the heading (radians).
    pub fn information(&self) -> Matrix3<f64> {
        self.curvature / independent(self.variance)
    }

    /// Returns the covariance to add for the errors of walls to a covariance of the pose over x, y
    /// (cells) and the heading (radians). The walls of one direction are off together, by the
    /// distance of the scan's ends from them and by `drawn` cells in addition; different directions
    /// are independent.
    #[must_use]
    pub fn by_walls(&self, covariance: Matrix3<f64>, drawn: f64) -> Matrix3<f64> {
        let error = self.variance.max(MIN_WALL_ERROR.powi(2)) + drawn * drawn;
        let pulled = covariance / independent(self.variance);
        error * pulled * self.walls * pulled.transpose()
    }
}

/// Damping along directions that the scan does not constrain, as a share of the weight of all
/// beams.
const DAMPING: f64 = 1e-3;

impl DistanceField {
    /// Moves a pose to the best fit nearby; the heading only if it is not known. The pose does not
    /// move along directions that no beam constrains.
    #[must_use]
    pub fn refine(
        &self,
        ends: &Ends,
        start: GridPose,
        heading_is_known: bool,
        config: &FitConfig,
    ) -> Refined {
        let known = Known {
            heading: heading_is_known,
            expected: None,
        };
        self.descend(ends, start, (REACHES, known), config)
    }

    /// Moves a pose to the best agreement of scan and expectation, by their squared errors (maximum
    /// a posteriori). Beams count within the two reaches, in standard deviations of the fit, one
    /// after the other.
    #[must_use]
    pub fn refine_expected(
        &self,
        ends: &Ends,
        start: GridPose,
        (expected, reaches): (&Expected, [f64; 2]),
        config: &FitConfig,
    ) -> Refined {
        let known = Known {
            heading: false,
            expected: Some(expected),
        };
        self.descend(ends, start, (reaches, known), config)
    }

    fn descend(
        &self,
        ends: &Ends,
        start: GridPose,
        (reaches, known): ([f64; 2], Known<'_>),
        config: &FitConfig,
    ) -> Refined {
        let sigma = config.sigma_cells(self.frame.resolution_m);
        let mut pose = start;
        for (reach, last_step) in reaches.into_iter().zip(LAST_STEPS) {
            for _ in 0..MAX_STEPS {
                let sums = self.linearise::<LaneSums>(ends, pose, reach * sigma).sums();
                let Some(step) = sums.step(ends.weight, pose, known) else {
                    break;
                };
                pose = GridPose {
                    x: pose.x + step.x,
                    y: pose.y + step.y,
                    heading: pose.heading + step.z,
                };
                if step.x.abs().max(step.y.abs()).max(100.0 * step.z.abs()) < last_step {
                    break;
                }
            }
        }
        let (sums, walls): (LaneSums, Walls) = self.linearise(ends, pose, reaches[1] * sigma);
        let sums = sums.sums();
        Refined {
            pose,
            curvature: sums.curvature(),
            variance: sums.variance(),
            weight: sums.weight,
            walls: walls.products(),
        }
    }

    /// Sums the pulls of the ends at a pose.
    fn linearise<A: Add + Default>(&self, ends: &Ends, pose: GridPose, reach: f64) -> A {
        self.simd.run(Pull {
            field: self,
            ends: &ends.lanes,
            pose,
            reach,
            sums: A::default(),
        })
    }
}

/// Pulls of the ends at the walls of each of eight directions, by the direction in which the
/// distance to them grows.
#[derive(Debug, Default)]
struct Walls([Vector3<f64>; 8]);

/// Tangent of 22.5°: directions along the axes extend over half of 45° to either side.
const HALF_DIRECTION: f64 = std::f64::consts::SQRT_2 - 1.0;

impl Add for Walls {
    #[inline(always)]
    fn add(&mut self, pulls: &Pulls) {
        for (i, &weight) in pulls.weight.iter().enumerate() {
            let [x, y, h] = pulls.slope.map(|slope| f64::from(slope[i]));
            let (right, up) = (usize::from(x > 0.0), usize::from(y > 0.0));
            let direction = match () {
                () if y.abs() < HALF_DIRECTION * x.abs() => right,
                () if x.abs() < HALF_DIRECTION * y.abs() => 2 + up,
                () => 4 + right + 2 * up,
            };
            self.0[direction] += f64::from(weight) * Vector3::new(x, y, h);
        }
    }
}

impl Walls {
    fn products(&self) -> Matrix3<f64> {
        self.0.iter().map(|pull| pull * pull.transpose()).sum()
    }
}

/// Normal equations of a step.
#[derive(Debug)]
struct Sums {
    /// Upper half of the symmetric matrix Σ w ∇d ∇dᵀ: xx, xy, xh, yy, yh, hh.
    products: [f64; 6],
    slope: [f64; 3],
    squares: f64,
    weight: f64,
}

/// Normal equations of a step, lane by lane.
#[derive(Debug, Default)]
struct LaneSums {
    products: [Lanes; 6],
    slope: [Lanes; 3],
    squares: Lanes,
    weight: Lanes,
}

impl Add for LaneSums {
    #[inline(always)]
    fn add(&mut self, pulls: &Pulls) {
        let Pulls {
            weight: w,
            distance: d,
            slope: [x, y, h],
        } = pulls;
        let times = |a: &Lanes, b: &Lanes| lanes(|i| a[i] * b[i]);
        let (wx, wy, wh, wd) = (times(w, x), times(w, y), times(w, h), times(w, d));
        let add = |sum: &mut Lanes, a: &Lanes, b: &Lanes| *sum = lanes(|i| sum[i] + a[i] * b[i]);
        let products = [(&wx, x), (&wx, y), (&wx, h), (&wy, y), (&wy, h), (&wh, h)];
        for (sum, (a, b)) in self.products.iter_mut().zip(products) {
            add(sum, a, b);
        }
        for (sum, slope) in self.slope.iter_mut().zip([x, y, h]) {
            add(sum, &wd, slope);
        }
        add(&mut self.squares, &wd, d);
        self.weight = lanes(|i| self.weight[i] + w[i]);
    }
}

impl LaneSums {
    fn sums(&self) -> Sums {
        let sum = |lanes: &Lanes| lanes.iter().copied().map(f64::from).sum();
        Sums {
            products: self.products.each_ref().map(sum),
            slope: self.slope.each_ref().map(sum),
            squares: sum(&self.squares),
            weight: sum(&self.weight),
        }
    }
}

impl Add for (LaneSums, Walls) {
    #[inline(always)]
    fn add(&mut self, pulls: &Pulls) {
        self.0.add(pulls);
        self.1.add(pulls);
    }
}

impl Sums {
    fn curvature(&self) -> Matrix3<f64> {
        let [xx, xy, xh, yy, yh, hh] = self.products;
        Matrix3::new(xx, xy, xh, xy, yy, yh, xh, yh, hh)
    }

    fn variance(&self) -> f64 {
        self.squares / self.weight.max(f64::MIN_POSITIVE)
    }

    /// Returns the step from a pose to the minimum; `None` without beams that count.
    fn step(&self, all: f64, pose: GridPose, known: Known<'_>) -> Option<Vector3<f64>> {
        let curvature = self.curvature();
        let turning = curvature[(2, 2)].max(1.0);
        let damping = Vector3::new(DAMPING * all, DAMPING * all, DAMPING * turning);
        let mut damped = curvature + Matrix3::from_diagonal(&damping);
        let mut slope = Vector3::from(self.slope);
        if let Some(expected) = known.expected {
            // Both terms are in the units of the beams' squared distances.
            let information = expected.information * independent(self.variance());
            damped += information;
            slope += information * pose.minus(expected.pose);
        }
        if known.heading {
            damped.fill_row(2, 0.0);
            damped.fill_column(2, 0.0);
            (damped[(2, 2)], slope[2]) = (1.0, 0.0);
        }
        damped.cholesky().map(|factor| -factor.solve(&slope))
    }
}

#[cfg(test)]
mod tests;
