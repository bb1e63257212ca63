//! The figures that the paper prints: tables 1 and 2, seconds.

/// Boundary cells over free cells of the rows of both tables, per cent.
pub(super) const P_OVER_N: [u32; 5] = [10, 25, 50, 100, 120];

/// Noise of the columns of table 1, per cent.
pub(super) const NOISE: [u32; 5] = [5, 10, 15, 20, 25];

/// A row of the tables for one p/n.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Printed {
    pub(super) markov: f64,
    pub(super) correlation: f64,
    pub(super) current: f64,
}

/// Table 1: Markov localization by p/n, the others by p/n and noise.
const MARKOV: [f64; 5] = [15.770, 12.369, 9.367, 3.692, 2.554];
const CORRELATION: [[f64; 5]; 5] = [
    [1.754, 3.543, 4.678, 5.452, 6.116],
    [1.543, 2.848, 3.763, 4.128, 4.442],
    [1.324, 1.876, 2.321, 2.456, 2.522],
    [1.110, 1.385, 1.448, 1.523, 1.602],
    [0.960, 0.963, 0.963, 0.964, 0.964],
];
const CURRENT: [[f64; 5]; 5] = [
    [0.542, 0.563, 0.580, 0.591, 0.599],
    [0.585, 0.594, 0.608, 0.634, 0.653],
    [0.712, 0.766, 0.796, 0.823, 0.876],
    [1.011, 1.112, 1.184, 1.241, 1.332],
    [0.947, 0.953, 0.961, 0.965, 0.968],
];

/// Table 2, by p/n: the three methods.
const TABLE_2: [[f64; 3]; 5] = [
    [14.770, 13.540, 3.578],
    [12.369, 11.263, 4.277],
    [9.367, 8.873, 4.856],
    [6.692, 6.213, 5.139],
    [5.128, 4.731, 4.539],
];

/// What table 1 says at a p/n and a noise, per cent; `None` where it has no such case.
pub(super) fn table_1(p_over_n: u32, noise: u32) -> Option<Printed> {
    let row = P_OVER_N.iter().position(|&ratio| ratio == p_over_n)?;
    let column = NOISE.iter().position(|&percent| percent == noise)?;
    Some(Printed {
        markov: MARKOV[row],
        correlation: CORRELATION[row][column],
        current: CURRENT[row][column],
    })
}

/// What table 2 says at a p/n, per cent.
pub(super) fn table_2(p_over_n: u32) -> Option<Printed> {
    let row = P_OVER_N.iter().position(|&ratio| ratio == p_over_n)?;
    let [markov, correlation, current] = TABLE_2[row];
    Some(Printed {
        markov,
        correlation,
        current,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_are_found_by_their_figures() {
        let printed = table_1(100, 25).unwrap();
        assert_eq!((printed.correlation, printed.current), (1.602, 1.332));
        assert_eq!(table_2(120).unwrap().markov, 5.128);
        assert_eq!(table_1(5, 10), None);
    }
}
