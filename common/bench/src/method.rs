//! The methods that meet, and how the paper counts their operations.

/// A method of global localization.
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
    /// Headings that are searched.
    pub(super) headings: f64,
}

/// Operations and additions, as the paper counts them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Counts {
    pub(super) operations: f64,
    pub(super) additions: f64,
}

impl Method {
    /// As reports name it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Method::RayStepping => "markov_ray_stepping",
            Method::RayCasting => "markov_ray_casting",
            Method::RangeTable => "markov_range_table",
            Method::PlainPatch => "correlation_patch_plain",
            Method::Patch => "correlation_patch",
            Method::Field => "correlation_likelihood_field",
            Method::MonteCarlo => "monte_carlo",
            Method::Scatter => "reverse_projection_scatter",
            Method::Sweep => "reverse_projection_sweep",
            Method::Exhaustive => "reverse_projection_exhaustive",
            Method::Search => "reverse_projection_search",
            Method::TopSixteen => "reverse_projection_top16",
            Method::Candidates => "reverse_projection_candidates",
        }
    }

    /// As tables name it.
    pub(super) fn label(self) -> &'static str {
        match self {
            Method::RayStepping => "Markov, rays cell by cell",
            Method::RayCasting => "Markov, ray casting",
            Method::RangeTable => "Markov, range table",
            Method::PlainPatch => "Correlation, patch, pose by pose",
            Method::Patch => "Correlation, patch",
            Method::Field => "Correlation, likelihood field",
            Method::MonteCarlo => "Monte Carlo",
            Method::Scatter => "Reverse projection, scatter",
            Method::Sweep => "Reverse projection, sweep",
            Method::Exhaustive => "Reverse projection, exhaustive",
            Method::Search => "Reverse projection, search",
            Method::TopSixteen => "  the same, top 16",
            Method::Candidates => "  the same, candidates",
        }
    }

    /// Headings from which the time may be scaled up; `None` where twice the
    /// headings do not take twice the time.
    pub(super) fn least_headings(self) -> Option<usize> {
        match self {
            Method::MonteCarlo | Method::Search | Method::TopSixteen | Method::Candidates => None,
            // It reads its table once for all headings, which one alone would
            // have to pay for.
            Method::RangeTable => Some(24),
            _ => Some(1),
        }
    }

    /// The paper's counts (section II B); `None` where it has none: a search
    /// by bounds and particles that gather do what the case asks of them.
    pub(super) fn counts(self, sizes: &Sizes) -> Option<Counts> {
        let Sizes {
            n,
            p,
            m,
            k,
            headings,
        } = *sizes;
        let (operations, additions) = match self {
            Method::RayStepping | Method::RayCasting | Method::RangeTable => {
                (n * (2.0 * m + 1.0), 2.0 * m * n)
            }
            // A product and a sum for each cell of the patch; a look-up and a
            // sum for each end point.
            Method::PlainPatch | Method::Patch => (2.0 * k * m * n, k * m * n),
            Method::Field => (2.0 * m * n, m * n),
            Method::Scatter | Method::Sweep | Method::Exhaustive => (2.0 * m * p, k * m * p),
            _ => return None,
        };
        Some(Counts {
            operations: operations * headings,
            additions: additions * headings,
        })
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
        let counts = |method: Method| {
            let counts = method.counts(&sizes)?;
            Some((counts.operations, counts.additions))
        };
        assert_eq!(
            counts(Method::RayCasting),
            Some((2.0 * 1700.0, 2.0 * 1600.0))
        );
        assert_eq!(counts(Method::Scatter), Some((2.0 * 160.0, 2.0 * 400.0)));
        assert_eq!(counts(Method::Search), None);
    }
}
