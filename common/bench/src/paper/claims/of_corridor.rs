//! Section V: three places in a corridor.

use statistics::SUCCESS;

use super::super::corridor::{Corridor, Localized};
use super::{Basis, Case, Claim, most};

/// The claims about the places.
pub(in super::super) fn of_corridor(corridor: &Corridor) -> Vec<Claim> {
    let off = |of: fn(&Localized) -> f64| corridor.places.iter().map(of).collect::<Vec<_>>();
    let claim = |id, claim, is, errors: Vec<f64>| Claim {
        id,
        section: "V",
        claim,
        paper: "at 3 of 3 places",
        basis: Basis::Error,
        ours: most(errors.iter().copied()),
        is,
        cases: errors
            .iter()
            .map(|&error| Case::at_most(error, SUCCESS.0))
            .collect(),
    };
    vec![
        claim(
            "V1",
            "a robot with a laser finds itself at three places of a corridor",
            "the largest error by the votes alone, m",
            off(Localized::votes_off_m),
        ),
        claim(
            "V2",
            "ours: the same after the second stage",
            "the largest error, m",
            off(Localized::fit_off_m),
        ),
    ]
}
