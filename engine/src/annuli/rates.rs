//! How the edges change the state: exact derivatives at points that move with the edges.
//!
//! With B y = F the equations of the rings and e an edge,
//!
//! ```text
//! B y_e = F' v − (∂B/∂e) y,      B y_s = −X_s/√(r² − s²)
//! J_ij = ∂κ_i/∂α_j,  α = ±e, + where the contact grows with e;      ∂P/∂α_j = 4πe_j κ_j ∂κ_j/∂δ
//! ```

use super::kernel::MovedBlock;
use super::state::{AnnuliState, RateTerms, dot, edge_unit};
use nalgebra::DMatrix;
use std::f64::consts::FRAC_2_PI;
use wide::f64x4;

/// out += A x for a matrix by rows, or its transpose.
fn add_product(out: &mut [f64], a: &[f64], x: &[f64], transposed: bool) {
    if transposed {
        for (row, x) in a.chunks_exact(out.len()).zip(x) {
            for (out, a) in out.iter_mut().zip(row) {
                *out += a * x;
            }
        }
    } else {
        for (out, row) in out.iter_mut().zip(a.chunks_exact(x.len())) {
            let (fours, _) = row.as_chunks::<4>();
            let (xs, _) = x.as_chunks::<4>();
            let sum =
                fours.iter().zip(xs).fold(f64x4::ZERO, |sum, (a, x)| sum + f64x4::new(*a) * f64x4::new(*x));
            *out += sum.reduce_add();
        }
    }
}

/// What holds for all edges of a state at one approach.
struct Rates<'a> {
    state: &'a AnnuliState,
    kept: &'a RateTerms,
    n: usize,
    y: Vec<f64>,
    /// √(r² − s²).
    root: Vec<f64>,
    starts: Vec<usize>,
    /// Σ X y for every node of N.
    sums: Vec<f64>,
}

impl AnnuliState {
    /// J, the derivatives of κ with respect to α at an approach, rows and columns in the order of
    /// [`Contacts::edges`](super::Contacts::edges). α is e or −e, so that a contact grows with it. NaN where the state
    /// was not made with [`Rates`](super::Wanted::Rates).
    pub fn jacobian(&self, delta: f64, slope_at_disc: f64) -> DMatrix<f64> {
        let edges = self.contacts.edge_count();
        let Some(kept) = &self.kept else { return DMatrix::from_element(edges, edges, f64::NAN) };
        let y: Vec<f64> = self.y[0].iter().zip(&self.y[1]).map(|(a, b)| a + delta * b).collect();
        let s = self.contacts.disc;
        let first = self.contacts.rings.first().map_or(0.0, |ring| ring[0]);
        let mut root = Vec::with_capacity(y.len());
        let mut starts = Vec::with_capacity(self.nodes.len());
        for (j, nodes) in self.nodes.iter().enumerate() {
            starts.push(root.len());
            for (r, inward) in nodes.radii.iter().zip(&nodes.from_inner) {
                let from_disc = if j == 0 { (first - s) + inward } else { r - s };
                root.push((from_disc * (r + s)).sqrt());
            }
        }
        let n = y.len();
        let sums =
            if n > 0 { kept.inverse.chunks_exact(n).map(|x| dot(x, &y)).collect() } else { Vec::new() };
        Rates { state: self, kept, n, y, root, starts, sums }.jacobian(delta, slope_at_disc)
    }
}

impl Rates<'_> {
    /// The points of one ring.
    fn range(&self, ring: usize) -> std::ops::Range<usize> {
        let from = self.starts[ring];
        from..from + self.state.nodes[ring].radii.len()
    }

    /// The block between two rings, the nearer to the axis first.
    fn between(&self, inner: usize, outer: usize) -> &MovedBlock {
        let rings = self.state.nodes.len();
        // The blocks of the preceding rings come first: rings − 1, rings − 2, … of them.
        &self.kept.between[inner * (2 * rings - inner - 1) / 2 + outer - inner - 1]
    }

    /// F' less what other rings and the disc add to the slope, at the points of a ring.
    fn pull(&self, ring: usize, delta: f64) -> Vec<f64> {
        let range = self.range(ring);
        let [at_zero, slope] = &self.kept.slopes;
        let mut out = vec![0.0; range.len()];
        for other in 0..self.state.nodes.len() {
            let y = &self.y[self.range(other)];
            match other.cmp(&ring) {
                std::cmp::Ordering::Less => {
                    add_product(&mut out, &self.between(other, ring).second, y, true);
                }
                std::cmp::Ordering::Greater => {
                    add_product(&mut out, &self.between(ring, other).first, y, false);
                }
                std::cmp::Ordering::Equal => {}
            }
        }
        for (k, out) in out.iter_mut().enumerate() {
            let i = range.start + k;
            *out = at_zero[i] + delta * slope[i] - *out;
        }
        let r = &self.state.nodes[ring].radii;
        for ((x, weight), sum) in
            self.kept.inverse.chunks_exact(self.n).zip(&self.kept.weights).zip(&self.sums)
        {
            let factor = weight * sum;
            for ((out, x), r) in out.iter_mut().zip(&x[range.clone()]).zip(r) {
                *out -= factor * r * (x * x * x);
            }
        }
        out
    }

    /// The right-hand sides of the two edges of a ring.
    fn sides(&self, ring: usize, delta: f64) -> [Vec<f64>; 2] {
        let nodes = &self.state.nodes[ring];
        let (range, size) = (self.range(ring), nodes.radii.len());
        let pull = self.pull(ring, delta);
        let y = &self.y[range.clone()];
        let MovedBlock { first, second } = &self.kept.own[ring];
        let mut sides = [vec![0.0; self.n], vec![0.0; self.n]];
        // The ring's own block: Σ (first Λ − second (v + v')/σ) y.
        for i in 0..size {
            let rows = [first, second].map(|of| &of[i * size..(i + 1) * size]);
            let (r, v) = (nodes.radii[i], [nodes.speeds[0][i], nodes.speeds[1][i]]);
            let mut sums = [f64x4::ZERO; 2];
            for k in (0..size).step_by(4) {
                let four = |of: &[f64]| of[k..].first_chunk::<4>().map_or(f64x4::ZERO, |x| f64x4::new(*x));
                let [turning, block] = rows.map(four);
                let (y, there) = (four(y), four(&nodes.radii));
                let per_sigma = y / (there + f64x4::splat(r));
                let both = (turning + block) * per_sigma;
                for edge in 0..2 {
                    let slope = match &nodes.graded {
                        None => f64x4::splat(nodes.slopes[edge][0]),
                        Some(graded) => four(&graded.speeds[edge][i * size..]),
                    };
                    let mean = f64x4::splat(v[edge]) + four(&nodes.speeds[edge]);
                    sums[edge] += turning * slope * y - both * mean;
                }
            }
            for edge in 0..2 {
                sides[edge][range.start + i] = v[edge] * pull[i] - sums[edge].reduce_add();
            }
        }
        for (edge, side) in sides.iter_mut().enumerate() {
            let moving: Vec<f64> = nodes.speeds[edge].iter().zip(y).map(|(v, y)| v * y).collect();
            let negative: Vec<f64> = moving.iter().map(|x| -x).collect();
            for other in 0..self.state.nodes.len() {
                let out = &mut side[self.range(other)];
                match other.cmp(&ring) {
                    std::cmp::Ordering::Less => {
                        add_product(out, &self.between(other, ring).second, &negative, false);
                    }
                    std::cmp::Ordering::Greater => {
                        add_product(out, &self.between(ring, other).first, &negative, true);
                    }
                    std::cmp::Ordering::Equal => {}
                }
            }
            for (x, weight) in self.kept.inverse.chunks_exact(self.n).zip(&self.kept.weights) {
                let terms = x[range.clone()].iter().zip(&moving).zip(&nodes.radii);
                let factor = weight * terms.map(|((x, m), r)| m * r * (x * x * x)).sum::<f64>();
                for (out, x) in side.iter_mut().zip(x) {
                    *out -= factor * x;
                }
            }
        }
        sides
    }

    fn jacobian(&self, delta: f64, slope_at_disc: f64) -> DMatrix<f64> {
        let state = self.state;
        let s = state.contacts.disc;
        let edges = state.contacts.edges();
        let kappa = state.intensities(delta);
        let at_disc = state.at_disc[0] + delta * state.at_disc[1];
        let mut sides: Vec<Vec<f64>> = Vec::with_capacity(edges.len());
        if s > 0.0 {
            sides.push(self.root.iter().map(|root| -at_disc / root).collect());
        }
        for ring in 0..state.nodes.len() {
            sides.extend(self.sides(ring, delta));
        }
        let offset = usize::from(s > 0.0);
        let mut jacobian = DMatrix::zeros(edges.len(), edges.len());
        for (group, columns) in sides.chunks(4).enumerate() {
            let mut x: Vec<f64x4> = (0..self.n)
                .map(|i| f64x4::new(std::array::from_fn(|k| columns.get(k).map_or(0.0, |c| c[i]))))
                .collect();
            if let Some(factor) = &self.kept.factor {
                factor.solve(&mut x);
            }
            for lane in 0..columns.len() {
                let column = 4 * group + lane;
                let solved: Vec<f64> = x.iter().map(|x| x.as_array()[lane]).collect();
                self.column(&mut jacobian, column, offset, &solved, &kappa, slope_at_disc);
                if edges[column].sign < 0.0 {
                    jacobian.column_mut(column).neg_mut();
                }
            }
        }
        jacobian
    }

    /// What moving one edge changes.
    fn column(
        &self,
        jacobian: &mut DMatrix<f64>,
        column: usize,
        offset: usize,
        solved: &[f64],
        kappa: &[f64],
        slope_at_disc: f64,
    ) {
        let state = self.state;
        let s = state.contacts.disc;
        let moved = column.checked_sub(offset).map(|at| (at / 2, at % 2));
        if s > 0.0 {
            let mut x: f64 = -solved.iter().zip(&self.root).map(|(y, root)| y / root).sum::<f64>();
            if let Some((ring, edge)) = moved {
                let nodes = &state.nodes[ring];
                for (k, i) in self.range(ring).enumerate() {
                    x += self.y[i] * nodes.radii[k] * nodes.speeds[edge][k] / self.root[i].powi(3);
                }
            } else {
                x -= 0.5 * slope_at_disc;
                x -= s * self.y.iter().zip(&self.root).map(|(y, root)| y / root.powi(3)).sum::<f64>();
            }
            let own = if moved.is_none() { kappa[0] / (2.0 * s) } else { 0.0 };
            jacobian[(0, column)] = -(FRAC_2_PI / s).sqrt() * x - own;
        }
        for (ring, nodes) in state.nodes.iter().enumerate() {
            let y = &solved[self.range(ring)];
            for at in 0..2 {
                let row = offset + 2 * ring + at;
                let mut value = edge_unit(nodes, at) * dot(&nodes.rule.ends[at], y);
                if let Some((_, edge)) = moved.filter(|(of, _)| *of == ring) {
                    value -= 0.5 * kappa[row] * nodes.slopes[edge][at];
                    if edge == at {
                        value -= kappa[row] / nodes.ends[at];
                    }
                }
                jacobian[(row, column)] = value;
            }
        }
    }
}
