//! The methods that meet, and how the paper counts their operations.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    RayStepping,
    RayCasting,
    RangeTable,
    PlainPatch,
    Patch,
    Field,
    MonteCarlo,
    Scatter,
    Sweep,
    Exhaustive,
    Search,
    TopSixteen,
    Candidates,
}

/// The sizes that the paper's counts are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sizes {
    /// Free cells.
    pub(super) n: f64,
    /// Boundary cells.
    pub(super) p: f64,
    /// Beams.
    pub(super) m: f64,
    /// Cells that a reading's votes reach, on average.
    pub(super) k: f64,
    pub(super) headings: f64,
}

impl Method {
    /// Names of the method in reports, and in tables.
    pub(super) fn names(self) -> (&'static str, &'static str) {
        match self {
            Method::RayStepping => ("markov_ray_stepping", "Markov, rays cell by cell"),
            Method::RayCasting => ("markov_ray_casting", "Markov, ray casting"),
            Method::RangeTable => ("markov_range_table", "Markov, range table"),
            Method::PlainPatch => (
                "correlation_patch_plain",
                "Correlation, patch, pose by pose",
            ),
            Method::Patch => ("correlation_patch", "Correlation, patch"),
            Method::Field => (
                "correlation_likelihood_field",
                "Correlation, likelihood field",
            ),
            Method::MonteCarlo => ("monte_carlo", "Monte Carlo"),
            Method::Scatter => ("reverse_projection_scatter", "Reverse projection, scatter"),
            Method::Sweep => ("reverse_projection_sweep", "Reverse projection, sweep"),
            Method::Exhaustive => (
                "reverse_projection_exhaustive",
                "Reverse projection, exhaustive",
            ),
            Method::Search => ("reverse_projection_search", "Reverse projection, search"),
            Method::TopSixteen => ("reverse_projection_top16", "  the same, top 16"),
            Method::Candidates => ("reverse_projection_candidates", "  the same, candidates"),
        }
    }

    pub(super) fn name(self) -> &'static str {
        self.names().0
    }

    /// Headings from which the time may be scaled up; `None` where it is not proportional to them.
    pub(super) fn least_headings(self) -> Option<usize> {
        match self {
            Method::MonteCarlo | Method::Search | Method::TopSixteen | Method::Candidates => None,
            // It reads its table once for all headings, which one alone would pay for.
            Method::RangeTable => Some(24),
            _ => Some(1),
        }
    }

    /// Operations and additions as the paper counts them (section II B); `None` where it has none: a
    /// search by bounds and particles that gather do what the case asks of them.
    pub(super) fn counts(self, sizes: &Sizes) -> Option<(f64, f64)> {
        let &Sizes { n, p, m, k, .. } = sizes;
        let (operations, additions) = match self {
            Method::RayStepping | Method::RayCasting | Method::RangeTable => {
                (n * (2.0 * m + 1.0), 2.0 * m * n)
            }
            // A product and a sum for each cell; a look-up and a sum for each end point.
            Method::PlainPatch | Method::Patch => (2.0 * k * m * n, k * m * n),
            Method::Field => (2.0 * m * n, m * n),
            Method::Scatter | Method::Sweep | Method::Exhaustive => (2.0 * m * p, k * m * p),
            _ => return None,
        };
        Some((operations * sizes.headings, additions * sizes.headings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_the_papers() {
        let sizes = Sizes {
            n: 100.0,
            p: 10.0,
            m: 8.0,
            k: 5.0,
            headings: 2.0,
        };
        let counts = |method: Method| method.counts(&sizes);
        let expected = Some((2.0 * 1700.0, 2.0 * 1600.0));
        assert_eq!(counts(Method::RayCasting), expected);
        assert_eq!(counts(Method::Scatter), Some((2.0 * 160.0, 2.0 * 400.0)));
        assert_eq!(counts(Method::Search), None);
    }
}
