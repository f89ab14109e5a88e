//! Points of an equilibrium curve with rings, and steps along it by arc length in all edges and the control.

use super::balance::{Balance, HeldEdges, keeps_widths, moved};
use crate::annuli::{Contacts, Resolution, points};
use crate::elementary::ln;
use crate::problem::Control;
use crate::root::RootBracket;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use std::f64::consts::{LN_10, PI};

/// The most Newton steps of one correction.
const ITERATIONS: usize = 10;

/// A step of Newton's method that ends a correction, in the units of the arc length, and one at which it may stall.
const CONVERGED: f64 = 1e-12;
const STALLED: f64 = 1e-9;

/// The same for a point that is passed on the way: no event depends on its last digits.
const PASSED: f64 = 1e-10;

/// The share of the previous Newton step to which the third and all later ones shrink at least: a correction that
/// converges does so quadratically.
const SHRINKS: f64 = 0.5;

/// How much longer than the previous step a step may be.
pub const GROWTH: f64 = 1.5;

/// Bounds of a step: the cosine of the turn of its tangent, the motion of an edge in waves, the share that widths keep.
const TURN: f64 = 0.970_3;
const LONGEST: f64 = 0.2;
const LEFT: f64 = 0.4;

/// A point of a curve.
#[derive(Debug, Clone)]
pub struct PathPoint {
    /// The edges, in equilibrium.
    pub held: HeldEdges,
    /// The unit tangent in (α/ℓ, c/c₀).
    pub tangent: DVector<f64>,
    /// ℓ of every edge, and c₀.
    pub scales: ArcScales,
    /// The number of Newton rounds that led to it.
    pub rounds: usize,
}

/// Units of the arc length.
#[derive(Debug, Clone, PartialEq)]
pub struct ArcScales {
    /// ℓ of every edge, a length.
    pub edges: DVector<f64>,
    /// c₀, of the control.
    pub control: f64,
}

impl ArcScales {
    /// A change of edges and control in these units, converted to other units.
    fn changed(&self, to: &Self, change: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(change.len(), |i, _| match (self.edges.get(i), to.edges.get(i)) {
            (Some(before), Some(after)) => change[i] * before / after,
            _ => change[i] * self.control / to.control,
        })
    }
}

impl PathPoint {
    /// The part of the tangent along the control.
    pub fn along_control(&self) -> f64 {
        self.tangent[self.tangent.len() - 1]
    }

    /// The part of the tangent along the edges.
    pub fn along_edges(&self) -> DVector<f64> {
        self.tangent.rows(0, self.held.excess.len()).into_owned()
    }

    /// The contacts.
    pub fn contacts(&self) -> &Contacts {
        &self.held.state.contacts
    }
}

/// The equations of a correction, factored.
type Factored = LU<f64, Dyn, Dyn>;

/// A step from a point, during which its points on the rings are held. Its length is measured along the tangent, or
/// along one edge.
pub struct PathStep<'a, 'b> {
    balance: &'a Balance<'b>,
    from: &'a PathPoint,
    points: Resolution,
    row: DVector<f64>,
    /// The curve up to the start, where points before it are known.
    past: Option<Interpolant>,
}

impl Balance<'_> {
    /// The units of the arc length at `contacts`: for every edge, the length over which the gap changes there; for the
    /// control, a share of the largest.
    pub fn scales(&self, contacts: &Contacts) -> ArcScales {
        const OF_APPROACH: f64 = 0.2;
        const OF_FORCE: f64 = 0.1;
        let edges: Vec<f64> =
            contacts.edges().iter().map(|edge| self.ground.length_at(edge.radius)).collect();
        let longest = edges.iter().copied().fold(self.ground.wave, f64::max);
        let share = if self.control == Control::Force { OF_FORCE } else { OF_APPROACH };
        ArcScales { edges: DVector::from_vec(edges), control: share * longest }
    }

    /// The point of edges in equilibrium, its tangent such that the control goes up (`sense` 1) or down (−1).
    pub fn point(&self, held: HeldEdges, sense: f64) -> Option<PathPoint> {
        let n = held.excess.len();
        self.point_along(held, &|_| DVector::from_fn(n + 1, |i, _| if i == n { sense } else { 0.0 }))
    }

    /// The same with its tangent on the side of `along`, which gives a direction in the units of the arc length.
    pub fn point_along(
        &self,
        held: HeldEdges,
        along: &dyn Fn(&ArcScales) -> DVector<f64>,
    ) -> Option<PathPoint> {
        let scales = self.scales(&held.state.contacts);
        let n = held.excess.len();
        let mut right = DVector::zeros(n + 1);
        right[n] = 1.0;
        let found = Self::bordered(&held, &along(&scales), &scales).lu().solve(&right)?;
        let norm = found.norm();
        let tangent = (norm.is_finite() && norm > 0.0).then(|| found / norm)?;
        Some(PathPoint { held, tangent, scales, rounds: 0 })
    }

    /// Whether the equations of a point, closed by its tangent, have a positive determinant: its sign stays the same
    /// along a curve.
    pub fn is_positive(point: &PathPoint) -> bool {
        Self::bordered(&point.held, &point.tangent, &point.scales).determinant() > 0.0
    }

    /// dδ and dP along the tangent of a point, in the units of the arc length.
    pub fn slopes(&self, point: &PathPoint) -> [f64; 2] {
        self.changes(&point.held, &point.tangent, &point.scales)
    }

    /// dδ and dP of edges and a control, in equilibrium or not, that change by `change` in the units of the arc length.
    fn changes(
        &self,
        HeldEdges { state, excess, .. }: &HeldEdges,
        change: &DVector<f64>,
        scales: &ArcScales,
    ) -> [f64; 2] {
        let root = self.work_of_adhesion.sqrt();
        let by_edges: f64 = (state.contacts.edges().iter().enumerate())
            .map(|(i, edge)| {
                let change = change[i] * scales.edges[i];
                4.0 * PI * edge.radius * (excess[i] + root) * state.intensity[i][1] * change
            })
            .sum();
        let held = state.force[1];
        let by_control = change[change.len() - 1] * scales.control;
        let approach = match self.control {
            Control::Displacement => by_control,
            Control::Force => (by_control - by_edges) / held,
            Control::Stiffness(k) => (k * by_control - by_edges) / (k + held),
        };
        [approach, by_edges + held * approach]
    }

    /// J and ∂κ/∂c in the units of the arc length over the row `along`.
    fn bordered(held: &HeldEdges, along: &DVector<f64>, scales: &ArcScales) -> DMatrix<f64> {
        let n = held.excess.len();
        DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
            (true, true) => held.jacobian[(i, j)] * scales.edges[j],
            (true, false) => held.by_control[i] * scales.control,
            (false, _) => along[j],
        })
    }
}

impl PathPoint {
    /// The same in the units of its own place, ready for a step from there.
    #[must_use]
    pub fn rescaled(self, balance: &Balance<'_>) -> Self {
        let scales = balance.scales(self.contacts());
        let mut tangent = self.scales.changed(&scales, &self.tangent);
        let norm = tangent.norm();
        tangent /= norm;
        Self { tangent, scales, ..self }
    }
}

impl<'a, 'b> PathStep<'a, 'b> {
    /// Steps from `from`.
    pub fn new(balance: &'a Balance<'b>, from: &'a PathPoint) -> Self {
        let row = from.tangent.clone();
        Self { balance, from, points: points(balance.ground, from.contacts()), row, past: None }
    }

    /// The same where the curve has come through the points `past`, which have the contacts of the start: it goes on
    /// as the polynomial through all of them and their tangents.
    #[must_use]
    pub fn after(self, past: &[PathPoint]) -> Self {
        let known = past.iter().map(|point| (self.offset(point).dot(&self.row), point));
        let known: Vec<_> = known.chain([(0.0, self.from)]).collect();
        let past = (known.len() > 1).then(|| self.through(&known));
        Self { past, ..self }
    }

    /// The polynomial through points at their distances, with their tangents.
    fn through(&self, points: &[(f64, &PathPoint)]) -> Interpolant {
        let mut way = Interpolant::default();
        for (length, point) in points {
            way.through(*length, self.offset(point));
            way.touching(*length, &self.rate_of(point));
        }
        way
    }

    /// Steps measured by the motion of one edge, in waves, in the direction in which the tangent moves it: close to a
    /// corner of the gap the tangent turns without bound, and only this motion is regular.
    pub fn of_edge(balance: &'a Balance<'b>, from: &'a PathPoint, edge: usize) -> Self {
        let mut row = DVector::zeros(from.tangent.len());
        row[edge] = if from.tangent[edge] < 0.0 { -1.0 } else { 1.0 };
        Self { balance, from, points: points(balance.ground, from.contacts()), row, past: None }
    }

    /// Where it starts.
    pub fn from(&self) -> &'a PathPoint {
        self.from
    }

    /// The balance that holds the contacts on it.
    pub fn balance(&self) -> &'a Balance<'b> {
        self.balance
    }

    /// The unit of the control in its length.
    pub fn unit(&self) -> f64 {
        self.from.scales.control
    }

    /// The offset at the distance `length` according to the tangent.
    pub fn line(&self, length: f64) -> DVector<f64> {
        let along = self.from.tangent.dot(&self.row);
        &self.from.tangent * (length / along.max(1e-6))
    }

    /// The tangent at a point with the contacts of the start, in the units of the start, scaled to 1 along the tangent
    /// of the start.
    pub fn rate_of(&self, point: &PathPoint) -> DVector<f64> {
        let tangent = point.scales.changed(&self.from.scales, &point.tangent);
        &tangent / tangent.dot(&self.row)
    }

    /// The point at the distance `length` along the tangent of the start, searched from the start plus `guess` in the
    /// units of the arc length. With it comes the tangent there, scaled to 1 along that of the start: the rate of
    /// change with the length.
    pub fn to(&self, length: f64, guess: &DVector<f64>) -> Option<(PathPoint, DVector<f64>)> {
        self.within(length, guess, CONVERGED)
    }

    /// The same, with a last Newton step of at most `converged`.
    pub fn within(
        &self,
        length: f64,
        guess: &DVector<f64>,
        converged: f64,
    ) -> Option<(PathPoint, DVector<f64>)> {
        let n = self.from.held.excess.len();
        let mut offset = guess.clone();
        let mut last = f64::INFINITY;
        for rounds in 1..=ITERATIONS {
            let (mut held, lu, right) = self.equations(&offset, length)?;
            let step = lu.solve(&right)?;
            let size = step.amax();
            if !size.is_finite() {
                return None;
            }
            let stalls = size > 0.3 * last;
            if size <= converged || stalls && (size <= STALLED || self.balance.is_rounding(&held)) {
                if size > STALLED {
                    held.state.digits = held.state.digits.min(-ln(size) / LN_10);
                }
                let mut unit = DVector::zeros(n + 1);
                unit[n] = 1.0;
                let rate = lu.solve(&unit)?;
                let tangent = &rate / rate.norm();
                return Some((PathPoint { held, tangent, scales: self.from.scales.clone(), rounds }, rate));
            }
            if size > 2.0 * last.max(1e-3) || (rounds > 2 && size > SHRINKS * last) {
                return None;
            }
            last = size;
            offset += step;
        }
        None
    }

    /// The point at the distance `length`, predicted from what is known of the curve; `None` where the step exceeds
    /// its bounds.
    pub fn taken(&self, length: f64) -> Option<PathPoint> {
        let to = |guess: &DVector<f64>| self.within(length, guess, PASSED);
        let going_on = self.past.as_ref().and_then(|past| to(&past.at(length).0));
        let (point, _) = going_on.or_else(|| to(&self.line(length)))?;
        self.allowed(&point).then_some(point)
    }

    /// The longest step up to `length` that keeps its bounds as far as the curve is known: the corrections of a step
    /// that breaks them are for nothing. It is not much shorter than the previous one, whatever the polynomial says.
    pub fn foreseen(&self, mut length: f64) -> f64 {
        const SHORTER: f64 = 0.9;
        let Some(past) = &self.past else { return length };
        let least = length / GROWTH;
        while length > least && !self.keeps_bounds(past, length) {
            length *= SHORTER;
        }
        length
    }

    /// Whether the curve as it is known keeps the bounds of a step up to this distance.
    fn keeps_bounds(&self, past: &Interpolant, length: f64) -> bool {
        let (offset, rate) = past.at(length);
        let n = self.from.held.excess.len();
        let edges = offset.rows(0, n);
        let turn = self.from.tangent.dot(&rate) / rate.norm();
        let contacts = moved(self.from.contacts(), &edges.component_mul(&self.from.scales.edges));
        turn > TURN && edges.amax() <= LONGEST && keeps_widths(self.from.contacts(), &contacts, LEFT)
    }

    /// The step up to `end`, at the distance `length`, as a polynomial in the length. States are added to it until one
    /// lies on it to `near`. Its values are the offsets in the units of the arc length, and dΠ/dc, which is P or, for
    /// `by_force`, −δ.
    pub fn way(&self, length: f64, end: &PathPoint, by_force: bool, near: f64) -> Option<Interpolant> {
        /// Where states are added, as shares of the step.
        const ADDED: [f64; 7] = [0.5, 0.2, 0.8, 0.35, 0.65, 0.1, 0.9];
        let balance = self.balance;
        let with = |x: DVector<f64>, last: f64| {
            let n = x.len();
            x.insert_row(n, last)
        };
        let slope = |[approach, force]: [f64; 2]| if by_force { -approach } else { force };
        let mut way = Interpolant::default();
        for (length, point) in [(0.0, self.from), (length, end)] {
            way.through(length, with(self.offset(point), slope([point.held.approach, point.held.force])));
            let rate = slope(balance.slopes(point)) / point.tangent.dot(&self.row);
            way.touching(length, &with(self.rate_of(point), rate));
        }
        for share in ADDED {
            let guess = way.at(length * share).0;
            let (x, value, off) = self.near(length * share, guess.rows(0, self.row.len()).into_owned())?;
            way.through(length * share, with(x, slope(value)));
            if off <= near {
                break;
            }
        }
        Some(way)
    }

    /// The offset of the point at the distance `length`, to second order in the error of `guess`; then its δ and P,
    /// and the size of that error.
    fn near(&self, length: f64, mut guess: DVector<f64>) -> Option<(DVector<f64>, [f64; 2], f64)> {
        /// The largest error of a guess for which one correction is enough.
        const ONCE: f64 = 3e-5;
        let scales = &self.from.scales;
        let mut off = None;
        for _ in 0..ITERATIONS {
            let (held, lu, right) = self.equations(&guess, length)?;
            let step = lu.solve(&right).filter(|step| step.iter().all(|x| x.is_finite()))?;
            let size = step.amax();
            let off = *off.get_or_insert(size);
            if size <= ONCE {
                let [approach, force] = self.balance.changes(&held, &step, scales);
                return Some((guess + step, [held.approach + approach, held.force + force], off));
            }
            guess += step;
        }
        None
    }

    /// The edges at an offset from the start, with the equations of a correction there: the point at the distance `length`.
    fn equations(&self, offset: &DVector<f64>, length: f64) -> Option<(HeldEdges, Factored, DVector<f64>)> {
        let (balance, from) = (self.balance, self.from);
        let (n, scales) = (from.held.excess.len(), &from.scales);
        let contacts = moved(from.contacts(), &offset.rows(0, n).component_mul(&scales.edges));
        if !keeps_widths(from.contacts(), &contacts, 0.5 * LEFT) {
            return None;
        }
        let value = from.held.control_value + scales.control * offset[n];
        let held = balance.held(&contacts, &self.points, value).ok()?;
        let mut right = DVector::zeros(n + 1);
        right.rows_mut(0, n).copy_from(&-&held.excess);
        right[n] = length - self.row.dot(offset);
        let lu = Balance::bordered(&held, &self.row, scales).lu();
        Some((held, lu, right))
    }

    fn allowed(&self, point: &PathPoint) -> bool {
        let (before, after) = (self.from.contacts(), point.contacts());
        let edges = before.edges().into_iter().zip(after.edges());
        let longest = edges
            .zip(&self.from.scales.edges)
            .fold(0.0, |most: f64, ((a, b), scale)| most.max((a.radius - b.radius).abs() / scale));
        self.from.tangent.dot(&point.tangent) > TURN
            && longest <= LONGEST
            && keeps_widths(before, after, LEFT)
    }

    /// The offset of a point from the start, in the units of the arc length.
    pub fn offset(&self, point: &PathPoint) -> DVector<f64> {
        let n = point.held.excess.len();
        let scales = &self.from.scales;
        let edges: Vec<_> = self.from.contacts().edges().into_iter().zip(point.contacts().edges()).collect();
        DVector::from_fn(n + 1, |i, _| match edges.get(i) {
            Some((a, b)) => a.sign * (b.radius - a.radius) / scales.edges[i],
            None => (point.held.control_value - self.from.held.control_value) / scales.control,
        })
    }

    /// The distance and the point between the start and `end` where `measure` vanishes; it is `at_start` at the start
    /// and has the other sign at the end.
    pub fn located(
        &self,
        end: (f64, &PathPoint),
        at_start: f64,
        measure: &mut dyn FnMut(&PathPoint) -> Option<f64>,
    ) -> Option<(f64, PathPoint)> {
        const ROUNDING: f64 = 1e-12;
        /// Places nearer to each other than this share of the step add nothing to the polynomial but their rounding.
        const APART: f64 = 1e-4;
        let near = ROUNDING * end.0.max(1e-3);
        let mut best = (end.0, end.1.clone());
        let Some(mut bracket) = RootBracket::new([0.0, at_start], [end.0, measure(end.1)?]) else {
            return Some(best);
        };
        let mut way = self.through(&[(0.0, self.from), end]);
        let curve = self.offset(end.1) - self.line(end.0);
        bracket.find(near, |length| {
            let share = length / end.0;
            let (point, _) = self
                .to(length, &way.at(length).0)
                .or_else(|| self.to(length, &(self.line(length) + &curve * (share * share))))?;
            if way.nodes.iter().all(|node| (node - length).abs() > APART * end.0) {
                way.through(length, self.offset(&point));
                way.touching(length, &self.rate_of(&point));
            }
            let value = measure(&point);
            best = (length, point);
            value
        })?;
        Some(best)
    }
}

/// A way as a polynomial in Newton's form, built from what is known at each node in turn.
#[derive(Default)]
pub struct Interpolant {
    nodes: Vec<f64>,
    coefficients: Vec<DVector<f64>>,
}

impl Interpolant {
    /// Adds the value at one more place.
    fn through(&mut self, x: f64, value: DVector<f64>) {
        let known = if self.nodes.is_empty() { value } else { value - self.at(x).0 };
        let left = self.nodes.iter().fold(known, |left, node| left / (x - node));
        self.nodes.push(x);
        self.coefficients.push(left);
    }

    /// Adds the derivative at the place that was added last.
    fn touching(&mut self, x: f64, rate: &DVector<f64>) {
        let known = rate - self.at(x).1;
        let others = self.nodes.len().saturating_sub(1);
        let left = self.nodes[..others].iter().fold(known, |left, node| left / (x - node));
        self.nodes.push(x);
        self.coefficients.push(left);
    }

    /// The value at a place, and the derivative.
    pub fn at(&self, x: f64) -> (DVector<f64>, DVector<f64>) {
        let zero = DVector::zeros(self.coefficients[0].len());
        let terms = self.coefficients.iter().zip(&self.nodes).rev();
        terms.fold((zero.clone(), zero), |(value, rate), (coefficient, node)| {
            (&value * (x - node) + coefficient, rate * (x - node) + value)
        })
    }

    /// The number of nodes with which a product of two of its components is integrated exactly.
    pub fn degree(&self) -> usize {
        self.nodes.len()
    }
}
