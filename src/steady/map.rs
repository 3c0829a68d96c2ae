//! The stability map: for which pairs of noises two filters are stable together.
//!
//! The map covers the tracking indices of the two filters. Every point is a pair of short rational damping roots, so every verdict except
//! "undecided" is a theorem about exact numbers.

use super::gains;
use super::pair::{frozen_matrix, mixing};
use super::search::spectral_radius;
use super::verdict::{Depth, Filters, StabilityVerdict};
use crate::number::{Rational, Real};
use nalgebra::SMatrix;
use rayon::prelude::*;

/// A point of the map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPoint {
    /// The damping roots θ_v and θ_a.
    pub roots: [Rational; 2],
    /// Their tracking indices Λ_v and Λ_a.
    pub indices: [Rational; 2],
    /// What is known there.
    pub verdict: StabilityVerdict,
    /// The greatest spectral radius of the frozen criterion over the mode probabilities that were tried, in doubles.
    pub frozen_radius: f64,
}

/// The map: rows of equal Λ_v, from the least up, in each the points with Λ_a from the least up.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// The points, `[velocity][acceleration]`.
    pub points: Vec<Vec<MapPoint>>,
}

impl Map {
    /// The map over a number of points along each side, from 10^`decades[0]` to 10^`decades[1]`, evenly in the logarithm.
    /// `progress` is called after every point; all cores take part, and the map is the same for any number of them.
    pub fn new(side: usize, decades: [f64; 2], depth: Depth, progress: &(dyn Fn() + Sync)) -> Self {
        let axis = |root: fn(&f64) -> f64| {
            let step = (decades[1] - decades[0]) / (side.max(2) - 1) as f64;
            let index = |k: usize| power_of_ten(decades[0] + step * k as f64);
            (0..side).map(|k| short(root(&index(k)))).collect::<Vec<_>>()
        };
        let (velocity, acceleration) = (axis(gains::alpha_beta_root), axis(gains::alpha_beta_gamma_root));
        let points = velocity.par_iter().map(|v| {
            let row = acceleration.par_iter().map(|a| {
                let point = MapPoint::new([v.clone(), a.clone()], depth);
                progress();
                point
            });
            row.collect()
        });
        Self {
            points: points.collect(),
        }
    }

    /// How many points are stable, unstable, undecided.
    pub fn counts(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        for point in self.points.iter().flatten() {
            let kind = match point.verdict {
                StabilityVerdict::Stable(_) => 0,
                StabilityVerdict::Unstable(_) => 1,
                StabilityVerdict::Undecided { .. } => 2,
            };
            counts[kind] += 1;
        }
        counts
    }

    /// The greatest spectral radius of the frozen criterion on the map.
    pub fn greatest_frozen_radius(&self) -> f64 {
        let radii = self.points.iter().flatten().map(|point| point.frozen_radius);
        radii.fold(0.0, f64::max)
    }
}

impl MapPoint {
    fn new(roots: [Rational; 2], depth: Depth) -> Self {
        let filters = Filters::Roots(roots.clone());
        Self {
            indices: [
                gains::alpha_beta_index(&roots[0]),
                gains::alpha_beta_gamma_index(&roots[1]),
            ],
            verdict: filters.decide(depth),
            frozen_radius: greatest_frozen_radius(&filters),
            roots,
        }
    }
}

/// The paper's chain: p_aa = p_vv = 0.95.
pub const CHAIN: [[f64; 2]; 2] = [[0.95, 0.05], [0.05, 0.95]];

/// The logits of the mode probability at which the frozen criterion is evaluated: from one in ten thousand to its opposite.
const LOGITS: std::ops::RangeInclusive<i32> = -9..=9;

/// The greatest spectral radius of the frozen criterion over mode probabilities, under the paper's chain.
pub fn greatest_frozen_radius(filters: &Filters) -> f64 {
    let matrices = filters.in_doubles();
    let transition = CHAIN.map(|row| row.to_vec()).to_vec();
    let radius = |logit: i32| {
        let first = 1.0 / (1.0 + Real::exp(&-f64::from(logit)));
        let before = [first, 1.0 - first];
        let (mixing, _) = mixing(&transition, &before);
        let rows = frozen_matrix(&mixing, &matrices);
        spectral_radius(&SMatrix::<f64, 6, 6>::from_fn(|i, j| rows[i][j]))
    };
    LOGITS.map(radius).fold(0.0, f64::max)
}

/// 10ˣ.
fn power_of_ten(exponent: f64) -> f64 {
    Real::exp(&(exponent * Real::ln(&10.0)))
}

/// A rational with three significant digits of the lesser of its distances from zero and from one; with fewer, or none, where these would
/// be beyond the 22nd decimal, as far as a power of ten is a double.
fn short(root: f64) -> Rational {
    let distance = root.min(1.0 - root);
    let mut scale = 100.0;
    while distance * scale < 100.0 && scale < 1e22 {
        scale *= 10.0;
    }
    Rational::from_f64((root * scale).round()) / Rational::from_f64(scale)
}
