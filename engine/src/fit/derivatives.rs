//! The residuals of a fit and their derivatives.
//!
//! At a held contact radius s, with T = √(2πγs/E*):
//!
//! ```text
//! ∂δ/∂ln E* = T/2     ∂P/∂ln E* = P + E* s T     ∂δ/∂ln γ = −T/2     ∂P/∂ln γ = −E* s T     ∂Δ/∂ln k = −P/k
//! ```
//!
//! So neighbouring paths are needed only for values of the gap, and where a point lies on a jump or at an end of an
//! arc, which move with every value.

use super::distance::Nearest;
use super::least_squares::LeastSquares;
use super::path::{Foot, PathPlace};
use super::prior::Prior;
use super::problem::{ADHESION, Datum, FitProblem, FreeParameter, MODULUS, Paths, START, Target};
use super::track::Mover;
use crate::measured::{Instrument, Segment};
use crate::preset::edge;
use crate::preset::schema::RANGE_KEYS;
use nalgebra::{DMatrix, DVector};

/// The paths at some values, and the feet of the points on them.
pub struct FootedPaths {
    pub(super) paths: Paths,
    pub(super) feet: Vec<Option<Nearest>>,
}

/// How the scaled point moves relative to its foot, per unit of u.
fn shift(target: &Target) -> Option<fn(&Datum) -> PathPlace> {
    match target {
        Target::Offset => Some(|_| [-1.0, 0.0, 0.0]),
        Target::Baseline => Some(|_| [0.0, -1.0, 0.0]),
        Target::Tilt => Some(|datum| [0.0, -datum.point.x, 0.0]),
        _ => None,
    }
}

/// What a parameter moves on a path by a closed form, and the branch if it does so on one alone.
fn mover(target: &Target) -> Option<(Mover, Option<Segment>)> {
    match target {
        Target::Key(key) if key == MODULUS => Some((Mover::Modulus, None)),
        Target::Key(key) if key == ADHESION => Some((Mover::Adhesion, None)),
        Target::Key(key) if key == "path.control.stiffness" => Some((Mover::Stiffness, None)),
        Target::Key(key) if key == RANGE_KEYS[0] => Some((Mover::Strength, None)),
        Target::Key(key) if key == RANGE_KEYS[1] => Some((Mover::Extent, None)),
        Target::Key(key) if key == edge::REFERENCE_SPEED => Some((Mover::Speed, None)),
        Target::Key(key) if key == edge::EXPONENT => Some((Mover::Exponent, None)),
        Target::Key(key) if key == START => Some((Mover::Start, None)),
        Target::Adhesion(segment) => Some((Mover::Adhesion, Some(*segment))),
        _ => None,
    }
}

/// The derivative of the `k`th residual of a foot that moves by `by` for each unit of u.
fn moved(foot: &Nearest, by: PathPlace, weights: PathPlace, k: usize) -> f64 {
    let part = |axis: usize| foot.normals[k][axis] * by[axis] * weights[axis];
    -(0..3).filter(|axis| weights[*axis] > 0.0).map(part).sum::<f64>()
}

impl FitProblem {
    /// The column of a value between instrument and model.
    fn of_shift(
        &self,
        feet: &[Option<Nearest>],
        (shift, scale): (fn(&Datum) -> PathPlace, f64),
        mut put: impl FnMut(usize, f64),
    ) {
        let (per, weights) = (self.per_point(), self.weights());
        for (i, (datum, foot)) in self.data.iter().zip(feet).enumerate() {
            let moved = shift(datum);
            match foot {
                Some(foot) => (0..per).for_each(|k| {
                    let along: f64 =
                        (0..3).map(|axis| foot.normals[k][axis] * moved[axis] * weights[axis]).sum();
                    put(per * i + k, along * scale);
                }),
                None => put(per * i, moved[1] * weights[1] * scale),
            }
        }
    }

    /// The paths on either side of `u` in the parameter `j`, with the step between them; where one has other snaps,
    /// `paths` takes its place.
    fn either_side(&self, u: &[f64], j: usize, paths: &Paths) -> Option<([Option<Paths>; 2], f64)> {
        let step = paths.of(Segment::Retraction).step();
        let beside = |h: f64| {
            let mut u = u.to_vec();
            u[j] += h;
            let found = self.beside(&u, paths)?;
            let same = [Segment::Approach, Segment::Retraction]
                .iter()
                .all(|of| found.of(*of).pieces.len() == paths.of(*of).pieces.len());
            same.then_some(found)
        };
        match (beside(-step), beside(step)) {
            (None, None) => None,
            (below, above) => {
                let width = if below.is_some() && above.is_some() { 2.0 * step } else { step };
                Some(([below, above], width))
            }
        }
    }

    /// The column of a value of the model.
    fn of_model(
        &self,
        u: &[f64],
        j: usize,
        look: &FootedPaths,
        mut put: impl FnMut(usize, f64),
    ) -> Option<()> {
        let FootedPaths { paths, feet } = look;
        let (per, weights) = (self.per_point(), self.weights());
        let closed = mover(&self.parameters[j].target);
        let mut beside = None;
        for (i, (datum, foot)) in self.data.iter().zip(feet).enumerate() {
            let Some(foot) = foot else { continue };
            if matches!(closed, Some((_, Some(segment))) if segment != datum.segment) {
                continue;
            }
            let told = match (closed, foot.foot) {
                (Some((mover, _)), Foot::Radius(along)) => {
                    paths.of(datum.segment).moves(mover, along, foot.at)
                }
                _ => None,
            };
            let by = if let Some(by) = told {
                by
            } else {
                if beside.is_none() {
                    beside = Some(self.either_side(u, j, paths)?);
                }
                let ([below, above], width) = beside.as_ref()?;
                let place = |side: &Option<Paths>| {
                    side.as_ref().unwrap_or(paths).of(datum.segment).foot(foot.piece, foot.foot)
                };
                let (a, b) = (place(below)?, place(above)?);
                std::array::from_fn(|axis| (b[axis] - a[axis]) / width)
            };
            (0..per).for_each(|k| put(per * i + k, moved(foot, by, weights, k)));
        }
        Some(())
    }
}

impl FitProblem {
    /// How the residuals at `u` change with what `mover` moves, times `share` of each point by its number; points on jumps and at the ends
    /// of arcs stay.
    pub(super) fn changed(
        &self,
        u: &[f64],
        mover: Mover,
        share: impl Fn(usize) -> f64,
    ) -> Option<DVector<f64>> {
        let (_, FootedPaths { paths, feet }) = self.look(u)?;
        let (per, weights) = (self.per_point(), self.weights());
        let mut column = DVector::zeros(per * self.data.len());
        for (i, (datum, foot)) in self.data.iter().zip(&feet).enumerate() {
            if let Some(foot @ Nearest { foot: Foot::Radius(along), .. }) = foot {
                let by = paths.of(datum.segment).moves(mover, *along, foot.at)?;
                let share = share(i);
                (0..per).for_each(|k| column[per * i + k] = share * moved(foot, by, weights, k));
            }
        }
        column.iter().all(|x| x.is_finite()).then(|| self.in_own_noise(column))
    }

    /// How the residuals at `u` change with a slope of the force over x.
    pub(super) fn tilted(&self, u: &[f64]) -> Option<DVector<f64>> {
        let (_, FootedPaths { feet, .. }) = self.look(u)?;
        let mut column = DVector::zeros(self.per_point() * self.data.len());
        self.of_shift(&feet, (shift(&Target::Tilt)?, 1.0), |row, derivative| column[row] = derivative);
        column.iter().all(|x| x.is_finite()).then(|| self.in_own_noise(column))
    }
}

impl LeastSquares for FitProblem {
    type Look = FootedPaths;

    fn look(&self, u: &[f64]) -> Option<(DVector<f64>, FootedPaths)> {
        let (paths, at): (Paths, Instrument) = (self.paths(u)?, self.instrument_at(u));
        let feet = self.feet(&paths, &at)?;
        Some((self.told(&feet, &at), FootedPaths { paths, feet }))
    }

    fn derivatives(&self, u: &[f64], look: &FootedPaths) -> Option<DMatrix<f64>> {
        let mut jacobian = DMatrix::zeros(self.per_point() * self.data.len(), u.len());
        for (j, FreeParameter { target, scale, .. }) in self.parameters.iter().enumerate() {
            let mut column = jacobian.column_mut(j);
            let put = |row: usize, derivative: f64| column[row] = derivative;
            match (shift(target), scale) {
                (Some(shift), Some(scale)) => {
                    self.of_shift(&look.feet, (shift, target.sign(self.turned) * scale), put);
                }
                _ => self.of_model(u, j, look, put)?,
            }
        }
        jacobian.iter().all(|x| x.is_finite()).then(|| self.in_own_noise(jacobian))
    }

    fn counts(&self) -> Option<&[f64]> {
        self.counts.as_deref()
    }

    fn priors(&self) -> &[Prior] {
        &self.priors
    }
}
