//! Pose estimate of the particles: the mean of their heaviest cluster. The mean of all particles
//! would be between two possible places, and at neither.
//!
//! Particles belong to one cluster if their bins touch, including at corners (as in AMCL).

use geometry::Pose;

use super::Particle;
use super::kld::{Bin, Binning};
use engine::fit::GridPose;
use engine::grid::GridFrame;

/// Most likely pose of the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Mean pose of the heaviest cluster.
    pub map_from_target: Pose,
    /// Share of the cluster in the weight of all particles, 0..=1.
    pub share: f64,
}

/// Finds clusters; reused from scan to scan for its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Clusters {
    /// Bin and index of each particle with a weight, sorted.
    keys: Vec<(Bin, u32)>,
    bins: Vec<Occupied>,
    /// Bins with neighbours still to be visited.
    open: Vec<usize>,
}

/// A bin with particles.
#[derive(Debug, Clone, Copy)]
struct Occupied {
    bin: Bin,
    /// Index of its first particle in `keys`.
    first: usize,
    weight: f64,
    /// Number of its cluster, from 1; 0 before it is visited.
    cluster: u32,
}

impl Clusters {
    /// Allocates buffers for this many particles, each in a separate bin.
    pub(super) fn reserve(&mut self, particles: usize) {
        self.keys.clear();
        self.keys.reserve(particles);
        self.bins.clear();
        self.bins.reserve(particles);
        self.open.reserve(particles);
    }

    /// Returns the heaviest cluster; ties go to the first by heading, y and x. `None` without
    /// particles.
    pub(super) fn heaviest(
        &mut self,
        particles: &[Particle],
        binning: &Binning,
        frame: GridFrame,
    ) -> Option<Estimate> {
        self.sort(particles, binning);
        let (mut heaviest, mut all) = ((0, 0.0), 0.0);
        let mut cluster = 0;
        for i in 0..self.bins.len() {
            if self.bins[i].cluster == 0 {
                cluster += 1;
                let weight = self.visit(i, cluster, binning.headings);
                all += weight;
                if weight > heaviest.1 {
                    heaviest = (cluster, weight);
                }
            }
        }
        let (cluster, weight) = heaviest;
        if weight <= 0.0 {
            return None;
        }
        let pose = self.mean(particles, cluster);
        Some(Estimate {
            map_from_target: frame.map_from_cells(pose.x, pose.y, pose.heading),
            share: weight / all,
        })
    }

    fn sort(&mut self, particles: &[Particle], binning: &Binning) {
        let weighing = (0u32..).zip(particles).filter(|(_, p)| p.weight > 0.0);
        self.keys.clear();
        self.keys
            .extend(weighing.map(|(i, particle)| (binning.bin(particle.pose), i)));
        self.keys.sort_unstable();
        self.bins.clear();
        let mut first = 0;
        for keys in self.keys.chunk_by(|a, b| a.0 == b.0) {
            let weights = keys.iter().map(|&(_, i)| particles[i as usize].weight);
            self.bins.push(Occupied {
                bin: keys[0].0,
                first,
                weight: weights.sum(),
                cluster: 0,
            });
            first += keys.len();
        }
    }

    /// Numbers all bins connected to one, and returns their weight.
    fn visit(&mut self, start: usize, cluster: u32, headings: i32) -> f64 {
        let mut weight = 0.0;
        self.bins[start].cluster = cluster;
        self.open.push(start);
        while let Some(i) = self.open.pop() {
            weight += self.bins[i].weight;
            for neighbour in neighbours(self.bins[i].bin, headings) {
                let found = self
                    .bins
                    .binary_search_by_key(&neighbour, |other| other.bin);
                if let Ok(j) = found
                    && self.bins[j].cluster == 0
                {
                    self.bins[j].cluster = cluster;
                    self.open.push(j);
                }
            }
        }
        weight
    }

    fn members<'a>(
        &'a self,
        particles: &'a [Particle],
        cluster: u32,
    ) -> impl Iterator<Item = &'a Particle> {
        let ends = self.bins.iter().skip(1).map(|bin| bin.first);
        let ends = ends.chain([self.keys.len()]);
        let bins = self.bins.iter().zip(ends);
        let bins = bins.filter(move |(bin, _)| bin.cluster == cluster);
        let keys = bins.flat_map(|(bin, end)| &self.keys[bin.first..end]);
        keys.map(|&(_, i)| &particles[i as usize])
    }

    /// Weighted mean of a cluster, in cells and radians; headings are averaged as unit vectors.
    fn mean(&self, particles: &[Particle], cluster: u32) -> GridPose {
        let (mut weight, mut sum, mut sin, mut cos) = (0.0, (0.0, 0.0), 0.0, 0.0);
        for Particle { pose, weight: w } in self.members(particles, cluster) {
            weight += w;
            sum = (sum.0 + w * pose.x, sum.1 + w * pose.y);
            sin += w * pose.heading.sin();
            cos += w * pose.heading.cos();
        }
        GridPose {
            x: sum.0 / weight,
            y: sum.1 / weight,
            heading: sin.atan2(cos),
        }
    }
}

/// The 26 neighbours of a bin; headings wrap around.
fn neighbours(bin: Bin, headings: i32) -> impl Iterator<Item = Bin> {
    let around =
        (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |h| (x, y, h))));
    around
        .filter(|&step| step != (0, 0, 0))
        .map(move |(x, y, heading)| Bin {
            x: bin.x.saturating_add(x),
            y: bin.y.saturating_add(y),
            heading: (bin.heading + heading).rem_euclid(headings),
        })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::super::ParticlesConfig;
    use super::*;

    /// Returns the heaviest cluster, on cells of 0.5 m, so that a bin is a cell.
    fn heaviest(particles: &[(f64, f64, f64, f64)]) -> Option<Estimate> {
        let frame = GridFrame {
            resolution_m: 0.5,
            map_from_grid: Pose::new(10.0, 0.0, FRAC_PI_2),
        };
        let particle = |&(x, y, degrees, weight): &(f64, f64, f64, f64)| Particle {
            pose: GridPose {
                x,
                y,
                heading: degrees.to_radians(),
            },
            weight,
        };
        let particles: Vec<Particle> = particles.iter().map(particle).collect();
        let binning = Binning::new(&ParticlesConfig::default(), 0.5);
        Clusters::default().heaviest(&particles, &binning, frame)
    }

    #[test]
    fn the_heaviest_cluster_is_that_of_bins_that_touch() {
        let found = heaviest(&[
            // Three bins in a row that touch at corners, and across the wrap of a turn.
            (0.5, 0.5, 5.0, 1.0),
            (1.5, 1.5, -5.0, 2.0),
            (2.5, 0.5, -15.0, 1.0),
            // The heaviest bin, isolated, two bins away.
            (4.5, 0.5, 5.0, 3.0),
            (1.5, 1.5, 30.0, 1.0),
        ]);
        let found = found.unwrap();
        assert_eq!(found.share, 0.5);
        // The mean is (1.5, 1) in cells, -5°; the grid is turned by 90°.
        let expected = Pose::new(10.0 - 0.5, 0.75, 85f64.to_radians());
        assert!(found.map_from_target.is_within(expected, 1e-12, 1e-12));
    }

    #[test]
    fn particles_that_weigh_nothing_join_nothing() {
        let found = heaviest(&[
            (0.5, 0.5, 5.0, 1.0),
            (1.5, 0.5, 5.0, 0.0),
            (2.5, 0.5, 5.0, 2.0),
        ]);
        assert!((found.unwrap().share - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(heaviest(&[]), None);
        assert_eq!(heaviest(&[(0.0, 0.0, 0.0, 0.0)]), None);
    }
}
