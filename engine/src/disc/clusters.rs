//! Sums over many panels, seen from far away.
//!
//! ```text
//! f(a) = Σ w/√(a² − r²)  over sources r < a
//! ```
//!
//! Neighbouring panels are grouped by two, four, eight and so on. Seen from at least as far away as a group is wide,
//! its sources are as good as [`NODES`] at Chebyshev nodes, where the weight at a node is that of its cardinal
//! polynomial,
//!
//! ```text
//! W_m = Σ w ℓ_m(r),   ℓ_m = 1 at node m and 0 at the others,
//! ```
//!
//! because the kernel equals its own polynomial there to (3 + √8)⁻²⁴. A sum over N panels takes about log N groups.
//!
//! L. Greengard and V. Rokhlin, J. Comput. Phys. 73, 325 (1987), doi:10.1016/0021-9991(87)90140-9, for the tree.

use super::chebyshev::ChebyshevRule;
use wide::f64x4;

/// Samples of h' on a panel.
pub const NODES: usize = 24;

/// Clusters are used from this distance on, in units of their width.
const FAR: f64 = 1.0;

/// Sources between two radii, with K weights each.
#[derive(Debug, Clone)]
pub struct Cluster<const K: usize> {
    /// The two radii.
    pub ends: [f64; 2],
    /// The sources.
    pub radii: [f64; NODES],
    /// Their weights.
    pub weights: [[f64; NODES]; K],
}

impl<const K: usize> Cluster<K> {
    /// The neighbours as seen from far away.
    fn of(parts: &[Self]) -> Self {
        let ends = [0, 1].map(|end| parts[end * (parts.len() - 1)].ends[end]);
        let (centre, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        let rule = ChebyshevRule::of(NODES);
        let mut moments = [[0.0; NODES]; K];
        for part in parts {
            for (i, r) in part.radii.iter().enumerate() {
                let x = (r - centre) / half;
                let (mut here, mut next) = (1.0, x);
                for k in 0..NODES {
                    for (moments, weights) in moments.iter_mut().zip(&part.weights) {
                        moments[k] += weights[i] * here;
                    }
                    (here, next) = (next, 2.0 * x * next - here);
                }
            }
        }
        Self {
            ends,
            radii: std::array::from_fn(|j| centre + half * rule.nodes[j]),
            weights: moments.map(|moments| std::array::from_fn(|j| rule.weight(j, &moments))),
        }
    }

    /// Σ w/√(a² − r²) for each of the weights.
    pub fn sums(&self, a: f64) -> [f64; K] {
        let a = f64x4::splat(a);
        let mut sums = [f64x4::ZERO; K];
        for i in (0..NODES).step_by(4) {
            let four =
                |values: &[f64; NODES]| f64x4::new([values[i], values[i + 1], values[i + 2], values[i + 3]]);
            let r = four(&self.radii);
            let kernel = f64x4::ONE / ((a - r) * (a + r)).sqrt();
            for (sum, weights) in sums.iter_mut().zip(&self.weights) {
                *sum += kernel * four(weights);
            }
        }
        sums.map(f64x4::reduce_add)
    }
}

/// What a sum is made of.
#[derive(Debug)]
pub enum SumPart<'a, const K: usize> {
    /// Panels that are far away, together.
    Far(&'a Cluster<K>),
    /// The number of a panel that is summed by itself.
    Panel(usize),
}

/// Panels, grouped by two, by four, and so on.
#[derive(Debug, Clone)]
pub struct Clusters<const K: usize> {
    levels: Vec<Vec<Cluster<K>>>,
}

impl<const K: usize> Clusters<K> {
    /// The clusters of ascending panels; fewer than `few` are not grouped.
    pub fn new(panels: Vec<Cluster<K>>, few: usize) -> Self {
        let mut levels = vec![panels];
        while let Some(last) = levels.last().filter(|last| last.len() >= 2 && levels[0].len() >= few) {
            let next = last.chunks(2).map(Cluster::of).collect();
            levels.push(next);
        }
        Self { levels }
    }

    /// A panel.
    pub fn panel(&self, index: usize) -> &Cluster<K> {
        &self.levels[0][index]
    }

    /// Calls `add` for the parts that make up the first `count` panels, seen from the place from which `distance`
    /// measures.
    pub fn visit(&self, count: usize, distance: &dyn Fn(f64) -> f64, add: &mut dyn FnMut(SumPart<'_, K>)) {
        let top = self.levels.len() - 1;
        for index in 0..self.levels[top].len() {
            self.visit_one([top, index], count, distance, add);
        }
    }

    fn visit_one(
        &self,
        [level, index]: [usize; 2],
        count: usize,
        distance: &dyn Fn(f64) -> f64,
        add: &mut dyn FnMut(SumPart<'_, K>),
    ) {
        let [first, past] = [index, index + 1].map(|at| at << level);
        if first >= count {
            return;
        }
        if level == 0 {
            return add(SumPart::Panel(index));
        }
        let cluster = &self.levels[level][index];
        let [lo, hi] = cluster.ends;
        if past.min(self.levels[0].len()) <= count && distance(hi) >= FAR * (hi - lo) {
            return add(SumPart::Far(cluster));
        }
        for child in [2 * index, 2 * index + 1] {
            if child < self.levels[level - 1].len() {
                self.visit_one([level - 1, child], count, distance, add);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_over_clusters_is_that_over_their_sources() {
        // Narrow panels beside wide ones, with sources of both signs.
        let mut random = fastrand::Rng::with_seed(3);
        let mut lo = 0.0;
        let panels: Vec<Cluster<1>> = (0..77)
            .map(|_| {
                let hi = lo + 10.0_f64.powf(-1.0 - 3.0 * random.f64());
                let radii = std::array::from_fn(|i| lo + (hi - lo) * (i as f64 + 0.5) / NODES as f64);
                let weights = [std::array::from_fn(|_| (hi - lo) * (random.f64() - 0.3))];
                let panel = Cluster { ends: [lo, hi], radii, weights };
                lo = hi;
                panel
            })
            .collect();
        let clusters = Clusters::new(panels.clone(), 0);
        for count in [1, 2, 3, 40, 76, 77] {
            for beyond in [1e-6, 1e-3, 0.1, 10.0] {
                let a = panels[count - 1].ends[1] + beyond;
                let (mut sum, mut calls) = (0.0, 0);
                clusters.visit(count, &|hi| a - hi, &mut |part| {
                    calls += 1;
                    sum += match part {
                        SumPart::Far(cluster) => cluster.sums(a)[0],
                        SumPart::Panel(index) => clusters.panel(index).sums(a)[0],
                    };
                });
                let exact: f64 = panels[..count].iter().map(|panel| panel.sums(a)[0]).sum();
                let size: f64 = panels[..count]
                    .iter()
                    .flat_map(|panel| panel.radii.iter().zip(&panel.weights[0]))
                    .map(|(r, w)| w.abs() / (a * a - r * r).sqrt())
                    .sum();
                assert!((sum - exact).abs() <= 1e-14 * size, "{count} {beyond}: {sum} {exact}");
                assert!(calls <= count.min(40), "{count} {beyond}: {calls}");
            }
        }
    }
}
