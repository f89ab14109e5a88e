//! The state of a disc and rings: pressures, force, energy and edge intensities, as polynomials in the approach.

use super::cholesky::Factorization;
use super::contacts::Contacts;
use super::contacts::ContactsError;
use super::graded;
use super::ground::{DiscNodes, Ground};
use super::kernel::{self, MovedBlock};
use super::nodes::Nodes;
use super::rule::MOST_POINTS;
use crate::elementary::{atan2, cbrt, ln, log10};
use crate::gap::Gap;
use crate::problem::Printer;
use crate::progress::Unwatched;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_4, LN_10, PI};
use std::sync::Arc;
use wide::f64x4;

/// The most points on all rings together.
pub const MOST_POINTS_IN_ALL: usize = 2000;

/// The fewest points on a ring.
const FEWEST_POINTS: f64 = 12.0;

/// Digits that the points of a ring give to a state in equilibrium, and to one on the way there: enough to tell where
/// its edges go.
const DIGITS: f64 = 12.0;
const DIGITS_ON_THE_WAY: f64 = 9.0;

/// Points on a piece of a ring between breaks, on top of those of an unbroken ring; and the fewest on a ring with many
/// breaks.
const ON_A_PIECE: f64 = 36.0;
const AMONG_BREAKS: f64 = 96.0;

/// Why there is no state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}", self.words(&Printer::reduced()))]
pub enum AnnuliError {
    /// The contacts are none.
    Contacts(#[from] ContactsError),
    /// More points than there may be.
    TooManyPoints {
        /// How many points the rings take.
        points: usize,
        /// How many there may be.
        most: usize,
    },
    /// An edge beyond what is known of the gap.
    BeyondGap {
        /// The edge, a length.
        radius: f64,
        /// How far the gap is known or tabulated, a length.
        known: f64,
    },
    /// The equations of the rings lost their digits.
    Singular {
        /// The narrowest ring or gap, a length.
        narrowest: f64,
    },
}

impl AnnuliError {
    /// What is wrong, in words.
    pub fn words(&self, printer: &Printer) -> String {
        match *self {
            Self::Contacts(ContactsError::NotAscending { before, .. }) => format!(
                "at r = {} the edges of a contact are too close to be told apart in floating point: the gap is too \
                 high or too steep there",
                printer.length(before)
            ),
            Self::Contacts(ref error) => error.to_string(),
            Self::TooManyPoints { points, most } => {
                format!("the rings need {points} points, more than the limit of {most}")
            }
            Self::BeyondGap { radius, known } => {
                let (radius, known) = (printer.length(radius), printer.length(known));
                format!("an edge at r = {radius} lies beyond the gap, which is known only up to r = {known}")
            }
            Self::Singular { narrowest } => {
                let narrowest = printer.length(narrowest);
                format!("the ring equations are singular to rounding: the narrowest ring is {narrowest} wide")
            }
        }
    }
}

/// How much is wanted of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Pressures, force, energy, intensities.
    Values,
    /// Also what the derivatives with respect to the edges need.
    Rates,
}

/// What the derivatives with respect to the edges need.
#[derive(Debug, Clone, Default)]
pub(super) struct RateTerms {
    /// The equations.
    pub factor: Option<Factorization>,
    /// The blocks on rings, and between them in the order (0, 1), (0, 2), …, (1, 2), …
    pub own: Vec<MovedBlock>,
    pub between: Vec<MovedBlock>,
    /// dF/dr for δ⁰ and δ¹ at the points.
    pub slopes: [Vec<f64>; 2],
    /// The weights of N, and 1/√(r² − a²) at its nodes by rows.
    pub weights: Vec<f64>,
    pub inverse: Vec<f64>,
}

/// A disc and rings at any approach δ (E* = 1): the equations are linear in δ, so every result is a polynomial in δ.
#[derive(Debug, Clone)]
pub struct AnnuliState {
    /// Where the bodies touch.
    pub contacts: Contacts,
    /// κ of every edge in the order of [`Contacts::edges`]: [κ⁰, κ¹], κ = κ⁰ + κ¹δ; the square root of a stress times a length.
    pub intensity: Vec<[f64; 2]>,
    /// P = P⁰ + P¹δ.
    pub force: [f64; 2],
    /// The elastic energy at δ = 0; P is its derivative with respect to δ.
    pub elastic: f64,
    /// Decimal digits of the intensities that the points give.
    pub digits: f64,
    /// X at the edge of the disc, for δ⁰ and δ¹.
    pub(super) at_disc: [f64; 2],
    pub(super) nodes: Vec<Nodes>,
    /// ∫ p r' f dr' = Σ y f over a ring's points, for δ⁰ and δ¹.
    pub(super) y: [Vec<f64>; 2],
    pub(super) kept: Option<RateTerms>,
}

/// The number of points on every ring, one for each piece between breaks of the gap inside it. It is held while
/// Newton's method runs, so that the equations stay smooth.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Resolution {
    rings: Vec<Vec<usize>>,
}

impl Resolution {
    #[cfg(test)]
    pub(super) fn of(rings: Vec<Vec<usize>>) -> Self {
        Self { rings }
    }

    /// The points on all rings.
    pub fn count(&self) -> usize {
        self.rings.iter().flatten().sum()
    }
}

/// The ratio of the ellipse about a ring on which its pressure is analytic.
fn ellipse(contacts: &Contacts, ring: usize) -> f64 {
    let [a, b] = contacts.rings[ring];
    let inner = if ring > 0 { contacts.rings[ring - 1][1] } else { contacts.disc };
    let outward = contacts.rings.get(ring + 1).map_or(f64::INFINITY, |next| next[0] - b);
    let z = (a - inner).min(outward) / (0.5 * (b - a));
    1.0 + z + (z * (2.0 + z)).sqrt()
}

/// Points for every ring of `contacts`: enough for 1e-12, 400 at most. The same contacts always take the same points.
pub fn points(ground: &Ground, contacts: &Contacts) -> Resolution {
    points_for(ground, contacts, DIGITS)
}

/// The same for contacts passed on the way to others, where 1e-9 is enough.
pub fn points_on_the_way(ground: &Ground, contacts: &Contacts) -> Resolution {
    points_for(ground, contacts, DIGITS_ON_THE_WAY)
}

fn points_for(ground: &Ground, contacts: &Contacts, digits: f64) -> Resolution {
    let most = MOST_POINTS as f64;
    let tolerance = digits * LN_10;
    let wants = |j: usize| {
        let [a, b] = contacts.rings[j];
        let phase = PI * (b - a) / ground.shortest_between([a, b]);
        let waves = phase + 8.0 * cbrt(phase) + 8.0;
        FEWEST_POINTS.max(waves).max(tolerance / ln(ellipse(contacts, j))).min(most)
    };
    let up = |n: f64, step: usize| {
        // Positive, and a few hundred at most.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let n = n.ceil() as usize;
        n.next_multiple_of(step)
    };
    let pieces = |j: usize| {
        let ends = contacts.rings[j];
        let (n, breaks) = (wants(j), ground.inside(ends));
        if breaks.is_empty() || !ground.grades(breaks) {
            let least = if breaks.is_empty() { 0.0 } else { AMONG_BREAKS };
            return vec![up(n.max(least), 4)];
        }
        let angles = breaks.iter().map(|r| graded::angle_of(ends, *r));
        let borders: Vec<f64> = std::iter::once(0.0).chain(angles).chain([PI]).collect();
        let share = most - 2.0 * (breaks.len() + 2) as f64;
        let wanted = ON_A_PIECE * (breaks.len() + 1) as f64 + n;
        let fewer = (share / wanted).min(1.0);
        let widths = borders.windows(2).map(|pair| pair[1] - pair[0]);
        let mut pieces: Vec<usize> =
            widths.map(|width| up(fewer * (ON_A_PIECE + n * width / PI), 2)).collect();
        if !pieces.iter().sum::<usize>().is_multiple_of(4) {
            pieces[0] += 2;
        }
        pieces
    };
    Resolution { rings: (0..contacts.rings.len()).map(pieces).collect() }
}

/// The digits that the points give.
fn digits(ground: &Ground, contacts: &Contacts, nodes: &[Nodes]) -> f64 {
    let of = |j: usize| {
        let breaks = ground.inside(contacts.rings[j]);
        let count = nodes[j].radii.len() as f64;
        let analytic = count * log10(ellipse(contacts, j));
        // As found on rings with as many breaks: with one break, 98 points give ten digits; with two, 136 give eight;
        // with knots of a spline, 96 give five.
        let broken = match breaks.len() {
            0 => return analytic,
            1 => 10.0,
            2 => 8.0,
            n if ground.grades(breaks) => 6.0 + (count / ((n + 1) as f64 * ON_A_PIECE)).min(1.0),
            _ => 5.0,
        };
        analytic.min(broken)
    };
    (0..nodes.len()).map(of).fold(12.0, f64::min)
}

/// The points of all rings of a state, with what sums over the disc need of them.
struct RingPoints {
    r: Vec<f64>,
    /// √(r² − s²).
    root: Vec<f64>,
    /// (r − a₁)(r + a₁).
    base: Vec<f64>,
}

impl RingPoints {
    fn new(contacts: &Contacts, nodes: &[Nodes]) -> Self {
        let count = nodes.iter().map(|nodes| nodes.radii.len()).sum();
        let [mut r, mut root, mut base] = [0; 3].map(|_| Vec::with_capacity(count));
        let (s, edge) = (contacts.disc, contacts.rings.first().map_or(0.0, |ring| ring[0]));
        for (j, nodes) in nodes.iter().enumerate() {
            for (radius, inward) in nodes.radii.iter().zip(&nodes.from_inner) {
                let from_edge = if j == 0 { *inward } else { radius - edge };
                r.push(*radius);
                root.push((((edge - s) + from_edge) * (radius + s)).sqrt());
                base.push(from_edge * (radius + edge));
            }
        }
        Self { r, root, base }
    }

    /// 1/√(r² − a²) at all points for every node, by rows.
    fn inverse(&self, under: &DiscNodes) -> Vec<f64> {
        let mut out = Vec::with_capacity(under.below.len() * self.r.len());
        for below in &under.below {
            out.extend(self.base.iter().map(|base| (base + below).sqrt().recip()));
        }
        out
    }
}

impl Ground {
    /// The state of `contacts`, with points chosen for them.
    ///
    /// # Errors
    /// [`AnnuliError`].
    pub fn state(&self, contacts: &Contacts, wanted: Wanted) -> Result<AnnuliState, AnnuliError> {
        self.state_with(contacts, &points(self, contacts), wanted)
    }

    /// The state of `contacts` with this many points on every ring, held while Newton's method runs so that the
    /// equations stay smooth.
    ///
    /// # Errors
    /// [`AnnuliError`].
    pub fn state_with(
        &self,
        contacts: &Contacts,
        points: &Resolution,
        wanted: Wanted,
    ) -> Result<AnnuliState, AnnuliError> {
        contacts.check()?;
        let (radius, known) = (contacts.outermost(), self.reach());
        if radius > known {
            return Err(AnnuliError::BeyondGap { radius, known });
        }
        let count = points.count();
        if count > MOST_POINTS_IN_ALL {
            return Err(AnnuliError::TooManyPoints { points: count, most: MOST_POINTS_IN_ALL });
        }
        let mut nodes = Vec::with_capacity(contacts.rings.len());
        for (j, ring) in contacts.rings.iter().enumerate() {
            let breaks = self.inside(*ring);
            let pieces = points.rings.get(j).map_or(&[][..], |pieces| &pieces[..]);
            nodes.push(if pieces.len() > 1 && pieces.len() == breaks.len() + 1 {
                Nodes::graded(*ring, breaks, pieces)
            } else if breaks.is_empty() || !self.grades(breaks) {
                Nodes::plain(*ring, pieces.iter().sum())
            } else {
                // An edge has passed a break since the points were chosen.
                let fresh = self::points(self, contacts);
                Nodes::graded(*ring, breaks, &fresh.rings[j])
            });
        }
        self.solved(contacts.clone(), nodes, wanted)
    }

    fn solved(
        &self,
        contacts: Contacts,
        nodes: Vec<Nodes>,
        wanted: Wanted,
    ) -> Result<AnnuliState, AnnuliError> {
        let s = contacts.disc;
        let mut state = AnnuliState {
            contacts,
            intensity: Vec::new(),
            force: [0.0; 2],
            elastic: 0.0,
            digits: 12.0,
            at_disc: [0.0; 2],
            nodes,
            y: [Vec::new(), Vec::new()],
            kept: None,
        };
        if s > 0.0 {
            let values = self.panels.values(self.panels.place(s));
            state.force = [-2.0 * values.area, 2.0 * s];
            state.elastic = values.square;
            state.at_disc = [-0.5 * values.value, 0.5];
        }
        if !state.nodes.is_empty() {
            self.solve_rings(&mut state, wanted)?;
        } else if wanted == Wanted::Rates {
            state.kept = Some(RateTerms::default());
        }
        if s > 0.0 {
            let unit = -(FRAC_2_PI / s).sqrt();
            state.intensity.push(state.at_disc.map(|x| unit * x));
        }
        let mut from = 0;
        for nodes in &state.nodes {
            let to = from + nodes.radii.len();
            for edge in 0..2 {
                let unit = edge_unit(nodes, edge);
                let end = |y: &[f64]| unit * dot(&nodes.rule.ends[edge], &y[from..to]);
                state.intensity.push([end(&state.y[0]), end(&state.y[1])]);
            }
            from = to;
        }
        Ok(state)
    }

    /// The pressures of the rings.
    fn solve_rings(&self, state: &mut AnnuliState, wanted: Wanted) -> Result<(), AnnuliError> {
        let (contacts, nodes) = (&state.contacts, &state.nodes);
        let s = contacts.disc;
        let points = RingPoints::new(contacts, nodes);
        let n = points.r.len();
        let rates = wanted == Wanted::Rates;
        let mut kept = RateTerms::default();
        let mut matrix = vec![0.0; n * n];
        let mut from = 0;
        for (i, ring) in nodes.iter().enumerate() {
            let size = ring.radii.len();
            kept.own.push(MovedBlock::default());
            let moved = kept.own.last_mut().filter(|_| rates);
            kernel::own(ring, &mut matrix[from * n + from..], n, moved);
            let mut column = from + size;
            for other in &nodes[i + 1..] {
                kept.between.push(MovedBlock::default());
                let moved = kept.between.last_mut().filter(|_| rates);
                kernel::between(ring, other, &mut matrix[from * n + column..], n, moved);
                column += other.radii.len();
            }
            from += size;
        }
        if s > 0.0 {
            let under = DiscNodes::even(s, contacts.rings[0][0]);
            kept.inverse = points.inverse(&under);
            kept.weights = under.weight;
            subtract(&mut matrix, n, &kept);
        }
        let loads = self.loads(contacts, &points, rates);
        let mut x: Vec<f64x4> = loads.values[0]
            .iter()
            .zip(&loads.values[1])
            .map(|(a, b)| f64x4::new([*a, *b, 0.0, 0.0]))
            .collect();
        let definite = nodes.iter().all(|nodes| nodes.graded.is_none());
        let Some(factor) = Factorization::of(matrix, n, definite) else {
            let narrowest = contacts.widths().into_iter().fold(f64::INFINITY, f64::min);
            return Err(AnnuliError::Singular { narrowest });
        };
        factor.solve(&mut x);
        let y = [0, 1].map(|k| x.iter().map(|x| x.as_array()[k]).collect::<Vec<f64>>());
        for k in 0..2 {
            let shades = y[k].iter().zip(&loads.shade).map(|(y, shade)| y * shade);
            state.force[k] += 8.0 * shades.sum::<f64>();
            if s > 0.0 {
                state.at_disc[k] -= y[k].iter().zip(&points.root).map(|(y, root)| y / root).sum::<f64>();
            }
        }
        state.elastic += 4.0 * dot(&y[0], &loads.values[0]);
        state.digits = digits(self, contacts, nodes);
        state.y = y;
        if rates {
            kept.factor = Some(factor);
            kept.slopes = loads.slopes;
            state.kept = Some(kept);
        }
        Ok(())
    }

    /// F and F' at the points.
    fn loads(&self, contacts: &Contacts, points: &RingPoints, rates: bool) -> Loads {
        let s = contacts.disc;
        let n = points.r.len();
        let shade: Vec<f64> = if s > 0.0 {
            points.root.iter().map(|root| 0.5 * atan2(*root, s)).collect()
        } else {
            vec![FRAC_PI_4; n]
        };
        let (mut values, mut slopes) = (vec![0.0; n], Vec::new());
        self.gap.values(1.0, &points.r, &mut values);
        for value in &mut values {
            *value *= -FRAC_PI_4;
        }
        if rates {
            slopes = vec![0.0; n];
            let [mut second, mut third] = [vec![0.0; n], vec![0.0; n]];
            self.gap.derivatives(1.0, &points.r, [&mut slopes, &mut second, &mut third]);
            for slope in &mut slopes {
                *slope *= -FRAC_PI_4;
            }
        }
        let under = if s > 0.0 { self.sum_below(s, contacts.rings[0][0]) } else { Vec::new() };
        for [below, weight] in under {
            let factor = 0.5 * weight;
            let add = |(value, base): (&mut f64, &f64)| *value += factor / (base + below).sqrt();
            values.iter_mut().zip(&points.base).for_each(add);
            let add = |(slope, (base, r)): (&mut f64, (&f64, &f64))| {
                let square = base + below;
                *slope -= factor * r / (square * square.sqrt());
            };
            slopes.iter_mut().zip(points.base.iter().zip(&points.r)).for_each(add);
        }
        let shade_slopes: Vec<f64> = points
            .r
            .iter()
            .zip(&points.root)
            .map(|(r, root)| if s > 0.0 { 0.5 * s / (r * root) } else { 0.0 })
            .collect();
        Loads { values: [values, shade.clone()], slopes: [slopes, shade_slopes], shade }
    }
}

/// F = F⁰ + F¹δ and its slope at the points, and ½ arccos(s/r).
struct Loads {
    values: [Vec<f64>; 2],
    slopes: [Vec<f64>; 2],
    shade: Vec<f64>,
}

/// The sum of products.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// κ of an edge divided by the sum of its rule.
pub(super) fn edge_unit(nodes: &Nodes, edge: usize) -> f64 {
    -(PI / (2.0 * nodes.half())).sqrt() / (nodes.ends[edge] * nodes.stretch[edge])
}

/// Subtracts N from the upper triangle.
fn subtract(matrix: &mut [f64], n: usize, kept: &RateTerms) {
    let rows: Vec<&[f64]> = kept.inverse.chunks_exact(n).collect();
    for (i, row) in matrix.chunks_exact_mut(n).enumerate() {
        for (four, weights) in rows.chunks_exact(4).zip(kept.weights.chunks_exact(4)) {
            let [a, b, c, d] = std::array::from_fn(|k| weights[k] * four[k][i]);
            let terms = four[0][i..].iter().zip(&four[1][i..]).zip(&four[2][i..]).zip(&four[3][i..]);
            for (x, (((p, q), u), v)) in row[i..].iter_mut().zip(terms) {
                *x -= (a * p + b * q) + (c * u + d * v);
            }
        }
    }
}

impl AnnuliState {
    /// κ at an approach, in the order of [`Contacts::edges`].
    pub fn intensities(&self, delta: f64) -> Vec<f64> {
        self.intensity.iter().map(|[at_zero, slope]| at_zero + slope * delta).collect()
    }

    /// P at an approach.
    pub fn force_at(&self, delta: f64) -> f64 {
        self.force[0] + self.force[1] * delta
    }

    /// U at an approach: the elastic energy less `gamma` times the area.
    pub fn energy(&self, delta: f64, gamma: f64) -> f64 {
        self.elastic + delta * (self.force[0] + 0.5 * self.force[1] * delta) - gamma * self.contacts.area()
    }
}

/// A ground from its gap alone, for tests and for callers that need no table of their own.
impl Ground {
    /// The gap `gap` with a table up to `reach`.
    ///
    /// # Errors
    /// [`TableError`](crate::disc::TableError).
    pub fn of(gap: Arc<dyn Gap>, reach: f64) -> Result<Self, crate::disc::TableError> {
        let table = Arc::new(crate::disc::Table::new(gap, reach, &Unwatched)?);
        Self::new(table, reach, &Unwatched)
    }
}
