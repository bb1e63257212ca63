//! Pose estimate of the particles: the mean of their heaviest cluster of bins that touch, also at
//! corners (as in AMCL). The mean of all particles would be between two possible places.

use std::collections::BTreeMap;

use engine::fit::GridPose;

use super::Particle;
use super::kld::{Bin, HEADINGS};

/// Returns the mean of the heaviest cluster, and its share in the weight of all particles; ties go
/// to the first by heading, y and x. `None` without particles.
pub(in super::super) fn heaviest(particles: &[Particle]) -> Option<(GridPose, f64)> {
    let mut bins: BTreeMap<Bin, Vec<&Particle>> = BTreeMap::new();
    for particle in particles.iter().filter(|particle| particle.weight > 0.0) {
        bins.entry(Bin::of(particle.pose))
            .or_default()
            .push(particle);
    }
    let (mut heaviest, mut most, mut all) = (Vec::new(), 0.0, 0.0);
    let mut left = bins.clone();
    while let Some((first, _)) = left.pop_first() {
        let (mut cluster, mut open, mut weight) = (vec![first], vec![first], 0.0);
        while let Some(bin) = open.pop() {
            weight += bins[&bin].iter().map(|it| it.weight).sum::<f64>();
            for neighbour in neighbours(bin) {
                if left.remove(&neighbour).is_some() {
                    cluster.push(neighbour);
                    open.push(neighbour);
                }
            }
        }
        all += weight;
        if weight > most {
            (heaviest, most) = (cluster, weight);
        }
    }
    heaviest.sort_unstable();
    let members = heaviest.iter().flat_map(|bin| &bins[bin]).copied();
    (most > 0.0).then(|| (mean(members), most / all))
}

fn mean<'a>(particles: impl Iterator<Item = &'a Particle>) -> GridPose {
    let (mut weight, mut sum, mut sin, mut cos) = (0.0, (0.0, 0.0), 0.0, 0.0);
    for Particle { pose, weight: w } in particles {
        weight += w;
        sum = (sum.0 + w * pose.x, sum.1 + w * pose.y);
        sin += w * pose.heading.sin();
        cos += w * pose.heading.cos();
    }
    GridPose::new(sum.0 / weight, sum.1 / weight, sin.atan2(cos))
}

/// The 26 neighbours of a bin; headings wrap around.
fn neighbours(bin: Bin) -> impl Iterator<Item = Bin> {
    let around =
        (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |h| (x, y, h))));
    let others = around.filter(|&step| step != (0, 0, 0));
    others.map(move |(x, y, heading)| Bin {
        x: bin.x.saturating_add(x),
        y: bin.y.saturating_add(y),
        heading: (bin.heading + heading).rem_euclid(HEADINGS),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the heaviest cluster of particles, given by bins and weights.
    fn heaviest(particles: &[(f64, f64, f64, f64)]) -> Option<(GridPose, f64)> {
        let particle = |&(x, y, headings, weight): &(f64, f64, f64, f64)| {
            let (x, y, heading) = (5.0 * x, 5.0 * y, (3.0 * headings).to_radians());
            let pose = GridPose { x, y, heading };
            Particle { pose, weight }
        };
        super::heaviest(&particles.iter().map(particle).collect::<Vec<_>>())
    }

    #[test]
    fn the_heaviest_cluster_is_that_of_bins_that_touch() {
        let found = heaviest(&[
            // Three bins in a row that touch at corners, and across the wrap of a turn.
            (0.5, 0.5, 0.5, 1.0),
            (1.5, 1.5, -0.5, 2.0),
            (2.5, 0.5, -1.5, 1.0),
            // The heaviest bin, isolated, two bins away.
            (4.5, 0.5, 0.5, 3.0),
            (1.5, 1.5, 3.0, 1.0),
        ]);
        let (GridPose { x, y, heading }, share) = found.unwrap();
        assert_eq!(share, 0.5);
        let off = (x - 7.5).abs() + (y - 5.0).abs() + (heading.to_degrees() + 1.5).abs();
        assert!(off < 1e-12, "{x} {y} {heading}");
    }

    #[test]
    fn particles_that_weigh_nothing_join_nothing() {
        let found = heaviest(&[
            (0.5, 0.5, 0.5, 1.0),
            (1.5, 0.5, 0.5, 0.0),
            (2.5, 0.5, 0.5, 2.0),
        ]);
        assert!((found.unwrap().1 - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(heaviest(&[]), None);
        assert_eq!(heaviest(&[(0.0, 0.0, 0.0, 0.0)]), None);
    }
}
