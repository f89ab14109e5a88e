//! One adhesive disc by quadrature, for tests only: it shares no code with the program, neither its tables nor its theory.
//!
//! A gap is a sum of terms with h' and h'' in closed form. Every integral is split at the corners of the terms and, in
//! steps that grow with the distance, around each of their features, so that Gauss's rule resolves each piece by
//! construction. With E* = 1, T = √(2πγs) and the jumps `J_q` of h' at corners q
//!
//! ```text
//! g(s) = ∫ h' dφ·s      g' = ∫ (h' + r h'') dφ + Σ J_q q/√(s² − q²)      ∫₀ˢ g = s² ∫ h' sin²φ dφ        r = s cos φ
//! δ = g − T,  P = 2(δs − ∫g),  dδ/ds = g' − T/2s,  dP/ds = 2(s g' − 3T/2)
//! ```
//!
//! Limit points are sign changes of the slope on a grid that is refined with the pieces, then located by bisection; so
//! are landings. The loss in a jump from state 1 to state 2 follows from the energy ∫(δ − g)² − πγs² without
//! differences of large numbers, for every stiffness:
//!
//! ```text
//! snap       ∫_{s₂}^{s₁} [(δ₁ − g)² − T²] da + ½(δ₁ − δ₂)(P(s₂, δ₁) − P₁)
//! pull-off   ∫₀^{s₁} [(δ₁ − g)² − T²] da + P₁²/2k
//! ```

use pulloff_engine::problem::Control;
use std::f64::consts::{PI, TAU};

/// Gauss nodes on a piece.
const NODES: usize = 16;

/// The number of slope values examined on a piece. Between two of them the sign may change unseen only by a pair of limit points.
const GRID: usize = 12;

/// The number of parts of a piece for the integral of a loss: between two corners g bends more than h does.
const PARTS: u32 = 4;

/// A feature is resolved out to this many of its widths; beyond, in steps that double.
const STEPS: [f64; 12] = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];

/// The form of a bump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bump {
    /// exp(−x²).
    Gauss,
    /// tanh x, a step.
    Tanh,
    /// 1/(1 + x²).
    Lorentz,
}

/// A term of h, r ≥ 0.
#[derive(Debug, Clone, PartialEq)]
pub enum Term {
    /// c rⁿ.
    Power { c: f64, n: f64 },
    /// 1 − √(1 − r²).
    Sphere,
    /// A [cos φ − cos(q r + φ)].
    Wave { amplitude: f64, wavenumber: f64, phase: f64 },
    /// A times a bump of (r − c)/w.
    Bump { bump: Bump, amplitude: f64, centre: f64, width: f64 },
    /// c |r − b|.
    Abs { c: f64, b: f64 },
    /// c max(r − b, 0).
    Max { c: f64, b: f64 },
    /// c min(r, b).
    Min { c: f64, b: f64 },
    /// c |sin(πr/p)|.
    AbsSine { c: f64, period: f64 },
    /// c max(w − |r − b|, 0).
    Triangle { c: f64, b: f64, w: f64 },
    /// c max(|r − b| − w, 0).
    Valley { c: f64, b: f64, w: f64 },
    /// c |r² − b²|.
    AbsSquares { c: f64, b: f64 },
    /// c max(r − b, 0)².
    MaxSquare { c: f64, b: f64 },
    /// h' = c₀ + c₁t + c₂t², t = r − knot, from each knot to the next.
    Spline { knots: Vec<f64>, slopes: Vec<[f64; 3]> },
}

impl Term {
    /// h' and h'' at r, on the piece that holds the radius `within`.
    fn slopes(&self, r: f64, within: f64) -> [f64; 2] {
        let sign = |b: f64| if within > b { 1.0 } else { -1.0 };
        let beyond = |b: f64| if within > b { 1.0 } else { 0.0 };
        match *self {
            Self::Power { c, n } => {
                if n == 2.0 {
                    return [2.0 * c * r, 2.0 * c];
                }
                let first = c * n * r.powf(n - 1.0);
                [first, if n == 1.0 || r == 0.0 { 0.0 } else { (n - 1.0) * first / r }]
            }
            Self::Sphere => {
                let square = (1.0 - r) * (1.0 + r);
                [r / square.sqrt(), 1.0 / (square * square.sqrt())]
            }
            Self::Wave { amplitude, wavenumber, phase } => {
                let (sin, cos) = (wavenumber * r + phase).sin_cos();
                [amplitude * wavenumber * sin, amplitude * wavenumber * wavenumber * cos]
            }
            Self::Bump { bump, amplitude, centre, width } => {
                let x = (r - centre) / width;
                let [first, second] = match bump {
                    Bump::Gauss => {
                        let e = (-x * x).exp();
                        [-2.0 * x * e, (4.0 * x * x - 2.0) * e]
                    }
                    Bump::Tanh => {
                        let e = (-2.0 * x.abs()).exp();
                        let square = 4.0 * e / ((1.0 + e) * (1.0 + e));
                        let tanh = x.signum() * (1.0 - e) / (1.0 + e);
                        [square, -2.0 * tanh * square]
                    }
                    Bump::Lorentz => {
                        let l = (1.0 + x * x).recip();
                        [-2.0 * x * l * l, (8.0 * x * x * l - 2.0) * l * l]
                    }
                };
                [amplitude / width * first, amplitude / (width * width) * second]
            }
            Self::Abs { c, b } => [c * sign(b), 0.0],
            Self::Max { c, b } => [c * beyond(b), 0.0],
            Self::Min { c, b } => [c * (1.0 - beyond(b)), 0.0],
            Self::AbsSine { c, period } => {
                let q = PI / period;
                let (sin, cos) = (q * (r - period * (within / period).floor())).sin_cos();
                [c * q * cos, -c * q * q * sin]
            }
            Self::Triangle { c, b, w } => [c * (beyond(b - w) - 2.0 * beyond(b) + beyond(b + w)), 0.0],
            Self::Valley { c, b, w } => [c * (beyond(b - w) + beyond(b + w) - 1.0), 0.0],
            Self::AbsSquares { c, b } => [2.0 * c * r * sign(b), 2.0 * c * sign(b)],
            Self::MaxSquare { c, b } => [2.0 * c * (r - b) * beyond(b), 2.0 * c * beyond(b)],
            Self::Spline { ref knots, ref slopes } => {
                let i = knots.partition_point(|k| *k <= within).clamp(1, slopes.len()) - 1;
                let (t, [c0, c1, c2]) = (r - knots[i], slopes[i]);
                [c0 + t * (c1 + t * c2), c1 + 2.0 * t * c2]
            }
        }
    }

    /// The corners up to `to`, each with the jump of h'.
    fn corners(&self, to: f64) -> Vec<[f64; 2]> {
        match *self {
            Self::Abs { c, b } => vec![[b, 2.0 * c]],
            Self::Max { c, b } => vec![[b, c]],
            Self::Min { c, b } => vec![[b, -c]],
            Self::AbsSine { c, period } => {
                let jump = 2.0 * c * PI / period;
                (1..).map(|m| f64::from(m) * period).take_while(|b| *b < to).map(|b| [b, jump]).collect()
            }
            Self::Triangle { c, b, w } => vec![[b - w, c], [b, -2.0 * c], [b + w, c]],
            Self::Valley { c, b, w } => vec![[b - w, c], [b + w, c]],
            Self::AbsSquares { c, b } => vec![[b, 4.0 * c * b]],
            _ => Vec::new(),
        }
    }

    /// Radii at which integrals are split.
    fn marks(&self, to: f64) -> Vec<f64> {
        let even = |step: f64| (1..).map(move |m| f64::from(m) * step).take_while(move |r| *r < to).collect();
        match *self {
            Self::Power { n, .. } if n.fract() != 0.0 => (0..32).map(|k| to * 0.25f64.powi(k)).collect(),
            // The equator is a branch point.
            Self::Sphere => (1..50).map(|k| 1.0 - 0.5f64.powi(k)).collect(),
            Self::Wave { wavenumber, .. } => even(PI / wavenumber),
            Self::AbsSine { period, .. } => even(period),
            Self::Bump { centre, width, .. } => {
                let mut marks: Vec<f64> =
                    STEPS.iter().flat_map(|x| [centre - width * x, centre + width * x]).collect();
                let mut far = 16.0 * width;
                while far < to {
                    marks.extend([centre - far, centre + far]);
                    far *= 2.0;
                }
                marks
            }
            Self::MaxSquare { b, .. } => vec![b],
            Self::Spline { ref knots, .. } => knots.clone(),
            _ => Vec::new(),
        }
    }
}

/// A state of the disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// s.
    pub radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
}

/// A jump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// The limit point.
    pub before: State,
    /// The landing; `None` after a pull-off.
    pub after: Option<State>,
    /// The loss, where it is bounded.
    pub loss: Option<f64>,
    /// How near, in the controlled quantity, the jump was to another landing.
    pub margin: f64,
}

/// A path.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Where it starts.
    pub start: State,
    /// Its jumps.
    pub jumps: Vec<Jump>,
}

/// A limit point: its radius, and whether the control is smallest there.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Turn {
    /// s.
    radius: f64,
    /// Whether it is a minimum; otherwise a maximum.
    minimum: bool,
}

/// g, g' (that of the inner side at a corner) and ∫g at one radius.
#[derive(Debug, Clone, Copy)]
pub struct Transform {
    pub value: f64,
    pub slope: f64,
    pub area: f64,
}

/// A piece of the radii, over 0 ≤ u ≤ 1: a = lo + (hi − lo)u; to the right of a corner, u² replaces u.
#[derive(Debug, Clone, Copy)]
struct Piece {
    lo: f64,
    hi: f64,
    root: bool,
}

impl Piece {
    fn at(&self, u: f64) -> f64 {
        self.lo + (self.hi - self.lo) * if self.root { u * u } else { u }
    }
}

/// One gap under one adhesion, up to a radius.
#[derive(Debug, Clone)]
pub struct Disc {
    terms: Vec<Term>,
    gamma: f64,
    reach: f64,
    marks: Vec<f64>,
    corners: Vec<[f64; 2]>,
    rule: Vec<[f64; 2]>,
    /// On each piece, r, h' and h' + r h'' at the nodes, the last two multiplied by the weights in r.
    samples: Vec<Vec<[f64; 3]>>,
}

impl Disc {
    /// The gap of `terms` under the adhesion γ, up to the radius `reach`.
    pub fn new(terms: &[Term], gamma: f64, reach: f64) -> Self {
        let mut corners: Vec<[f64; 2]> = terms.iter().flat_map(|term| term.corners(reach)).collect();
        corners.retain(|[b, _]| *b > 0.0 && *b < reach);
        corners.sort_by(|a, b| a[0].total_cmp(&b[0]));
        // Corners at one place are joined.
        corners.dedup_by(|next, kept| {
            let same = next[0] == kept[0];
            if same {
                kept[1] += next[1];
            }
            same
        });
        let mut marks: Vec<f64> = terms.iter().flat_map(|term| term.marks(reach)).collect();
        marks.extend(corners.iter().map(|c| c[0]));
        marks.extend((0..=18).map(|k| reach * 0.25f64.powi(k)));
        marks.retain(|r| *r > 0.0 && *r <= reach);
        // Even steps as well, so that no piece is long.
        marks.extend((1..8).map(|i| reach * f64::from(i) / 8.0));
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        Self { terms: terms.to_vec(), gamma, reach, marks, corners, rule: Vec::new(), samples: Vec::new() }
            .with_nodes(NODES)
    }

    /// The same with another number of nodes on each piece; the change in the result is the error.
    pub fn with_nodes(mut self, nodes: usize) -> Self {
        self.rule = gauss(nodes);
        let inner = [0.0].into_iter().chain(self.marks.iter().copied());
        let sample = |(lo, hi): (f64, &f64)| {
            let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
            let at = |[x, weight]: &[f64; 2]| {
                let r = middle + half * x;
                let [first, second] = self.slopes(r, middle);
                [r, weight * half * first, weight * half * (first + r * second)]
            };
            self.rule.iter().map(at).collect()
        };
        self.samples = inner.zip(&self.marks).map(sample).collect();
        self
    }

    /// h' and h'' at r on the piece that holds `within`.
    fn slopes(&self, r: f64, within: f64) -> [f64; 2] {
        let of_terms = self.terms.iter().map(|term| term.slopes(r, within));
        of_terms.fold([0.0; 2], |[first, second], [f, s]| [first + f, second + s])
    }

    /// The radius up to which it is known.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The radii at which integrals are split.
    pub fn marks(&self) -> &[f64] {
        &self.marks
    }

    /// The corners, each with the jump of h'.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// The transform at one radius.
    pub fn transform(&self, a: f64) -> Transform {
        let mut sums = [0.0; 3];
        let mut lo = 0.0;
        let inner = self.marks.partition_point(|mark| *mark < a);
        let angle = |r: f64| ((a - r) * (a + r)).sqrt().atan2(r);
        for (i, hi) in self.marks[..inner].iter().copied().chain([a]).enumerate() {
            if a - hi >= hi - lo {
                // So far away the root does not matter.
                for [r, first, both] in &self.samples[i] {
                    let square = (a - r) * (a + r);
                    let root = square.sqrt();
                    sums[0] += first / root;
                    sums[1] += both / root;
                    sums[2] += first * root;
                }
            } else {
                let (from, to) = (angle(lo), angle(hi));
                let (middle, half) = (0.5 * (from + to), 0.5 * (from - to));
                for [x, weight] in &self.rule {
                    let r = (a * (middle + half * x).cos()).clamp(lo, hi);
                    let [first, second] = self.slopes(r, 0.5 * (lo + hi));
                    let weight = weight * half;
                    sums[0] += weight * first;
                    sums[1] += weight * (first + r * second);
                    sums[2] += weight * first * (a - r) * (a + r);
                }
            }
            lo = hi;
        }
        let jumps = self.corners.iter().take_while(|[b, _]| *b < a);
        let jumps: f64 = jumps.map(|[b, jump]| jump * b / ((a - b) * (a + b)).sqrt()).sum();
        Transform { value: a * sums[0], slope: sums[1] + jumps, area: sums[2] }
    }

    /// g.
    pub fn value(&self, a: f64) -> f64 {
        self.transform(a).value
    }

    fn edge(&self, s: f64) -> f64 {
        (TAU * self.gamma * s).sqrt()
    }

    /// The state of radius s.
    pub fn state(&self, s: f64) -> State {
        let at = self.transform(s);
        let approach = at.value - self.edge(s);
        State { radius: s, approach, force: 2.0 * (approach * s - at.area) }
    }

    /// The size of the terms of δ and P at s.
    pub fn sizes(&self, s: f64) -> [f64; 2] {
        let at = self.transform(s);
        let approach = at.value.abs() + self.edge(s);
        [approach, 2.0 * (approach * s + at.area.abs())]
    }

    /// A positive multiple of the slope of the controlled quantity.
    pub fn tendency(&self, s: f64, control: Control) -> f64 {
        let (slope, edge) = (self.transform(s).slope, self.edge(s));
        let (by_approach, by_force) = (slope - 0.5 * edge / s, 2.0 * (s * slope - 1.5 * edge));
        match control {
            Control::Displacement => by_approach,
            Control::Force => by_force / (2.0 * s),
            Control::Stiffness(k) => (k * by_approach + by_force) / (k + 2.0 * s),
        }
    }

    /// A positive multiple of the controlled quantity, a combination of δ and P.
    pub fn held(control: Control, state: &State) -> f64 {
        match control {
            Control::Displacement => state.approach,
            Control::Force => state.force,
            Control::Stiffness(k) => (k * state.approach + state.force) / (k + 1.0),
        }
    }

    fn pieces(&self) -> Vec<Piece> {
        let mut lo = 0.0;
        let mut pieces = Vec::new();
        for &hi in &self.marks {
            pieces.push(Piece { lo, hi, root: self.jump(lo) != 0.0 });
            lo = hi;
        }
        pieces
    }

    /// The jump of h' at b.
    fn jump(&self, b: f64) -> f64 {
        self.corners.iter().find(|corner| corner[0] == b).map_or(0.0, |corner| corner[1])
    }

    /// The limit points, ascending; `finer` multiplies the number of radii examined.
    fn turns(&self, control: Control, finer: usize) -> Vec<Turn> {
        let tendency = |a: f64| self.tendency(a, control);
        let mut turns = Vec::new();
        let pieces = self.pieces();
        // On the innermost piece adhesion alone dominates.
        let mut last = [pieces[0].hi, tendency(pieces[0].hi)];
        assert!(last[1] < 0.0 || self.gamma == 0.0, "the radii begin too far out");
        let mut before: Option<[f64; 2]> = None;
        for piece in &pieces[1..] {
            let jump = self.jump(piece.lo);
            if jump != 0.0 {
                if (last[1] > 0.0) != (jump > 0.0) {
                    turns.push(Turn { radius: piece.lo, minimum: jump > 0.0 });
                }
                last[1] = jump * f64::INFINITY;
                before = None;
            }
            let count = GRID * finer;
            let mut u = 0.0;
            for j in 1..=count {
                let next_u = j as f64 / count as f64;
                let a = if j == count { piece.hi } else { piece.at(next_u) };
                let next = [a, tendency(a)];
                if (next[1] > 0.0) == (last[1] > 0.0) {
                    // A pair hides between three values of one sign, the middle one nearest to zero.
                    if let Some(before) = before {
                        self.pair(control, [before, last, next], &mut turns);
                    }
                } else {
                    let radius = bisect(u, next_u, |u| (tendency(piece.at(u)) > 0.0) == (next[1] > 0.0));
                    turns.push(Turn { radius: piece.at(radius), minimum: next[1] > 0.0 });
                }
                before = last[1].is_finite().then_some(last);
                (last, u) = (next, next_u);
            }
        }
        turns.sort_by(|a, b| a.radius.total_cmp(&b.radius));
        turns
    }

    /// The two limit points that may lie between three radii.
    fn pair(&self, control: Control, [a, b, c]: [[f64; 2]; 3], turns: &mut Vec<Turn>) {
        let positive = b[1] > 0.0;
        let sizes = [a, b, c].map(|at| at[1].abs());
        if (a[1] > 0.0) != positive || sizes[1] > sizes[0] || sizes[1] > sizes[2] {
            return;
        }
        if sizes[1] > 4.0 * (sizes[0].max(sizes[2]) - sizes[1]) {
            return;
        }
        let size = |s: f64| if positive { self.tendency(s, control) } else { -self.tendency(s, control) };
        let (mut lo, mut hi) = (a[0], c[0]);
        const GOLDEN: f64 = 0.381_966_011_250_105;
        let (mut x, mut y) = (lo + GOLDEN * (hi - lo), hi - GOLDEN * (hi - lo));
        let (mut at_x, mut at_y) = (size(x), size(y));
        for _ in 0..60 {
            if at_x < 0.0 || at_y < 0.0 {
                let inside = if at_x < 0.0 { x } else { y };
                let inner = bisect(a[0], inside, |s| size(s) < 0.0);
                let outer = bisect(inside, c[0], |s| size(s) > 0.0);
                turns.push(Turn { radius: inner, minimum: !positive });
                turns.push(Turn { radius: outer, minimum: positive });
                return;
            }
            if at_x < at_y {
                (hi, y, at_y) = (y, x, at_x);
                x = lo + GOLDEN * (hi - lo);
                at_x = size(x);
            } else {
                (lo, x, at_x) = (x, y, at_y);
                y = hi - GOLDEN * (hi - lo);
                at_y = size(y);
            }
            if hi - lo < 1e-12 * hi {
                return;
            }
        }
    }

    /// The stretches on which the control rises with s, ascending, as inner and outer ends; `finer` multiplies the
    /// number of radii examined.
    pub fn rising(&self, control: Control, finer: usize) -> Vec<[f64; 2]> {
        let mut stretches = Vec::new();
        let mut inner = (self.gamma == 0.0).then_some(0.0);
        for turn in self.turns(control, finer) {
            if turn.minimum {
                inner = Some(turn.radius);
            } else if let Some(from) = inner.take() {
                stretches.push([from, turn.radius]);
            }
        }
        stretches.extend(inner.map(|from| [from, self.reach]));
        stretches
    }

    fn held_at(&self, control: Control, s: f64) -> f64 {
        if s == 0.0 { 0.0 } else { Self::held(control, &self.state(s)) }
    }

    /// Where the control takes `value` on a rising stretch.
    fn crossing(&self, control: Control, [lo, hi]: [f64; 2], value: f64) -> f64 {
        bisect(lo, hi, |s| self.held_at(control, s) > value)
    }

    /// The outermost radius that takes the value and is stable under `control`.
    pub fn outermost(&self, control: Control, value: f64) -> Option<f64> {
        let takes =
            |&&[lo, hi]: &&[f64; 2]| self.held_at(control, lo) <= value && value <= self.held_at(control, hi);
        let stretches = self.rising(control, 1);
        stretches.iter().rev().find(takes).map(|stretch| self.crossing(control, *stretch, value))
    }

    /// The stable state at which a path from the radius `from` begins, and its index among the rising stretches; `None`
    /// where nothing outward within reach is stable.
    pub fn start(&self, control: Control, stretches: &[[f64; 2]], from: f64) -> Option<(usize, f64)> {
        if let Some(at) = stretches.iter().position(|[lo, hi]| *lo <= from && from <= *hi) {
            return Some((at, from));
        }
        let value = self.held_at(control, from);
        let outward = |[lo, hi]: &[f64; 2]| *lo > from && self.held_at(control, *hi) >= value;
        let at = stretches.iter().position(outward)?;
        Some((at, self.crossing(control, stretches[at], value)))
    }

    /// The unloading over these rising stretches from the radius `from` down to `to`.
    pub fn unload(&self, control: Control, stretches: &[[f64; 2]], from: f64, to: f64) -> Option<Path> {
        let (mut at, here) = self.start(control, stretches, from)?;
        let start = self.state(here);
        let mut jumps = Vec::new();
        loop {
            let [limit, _] = stretches[at];
            if limit < to || limit == 0.0 {
                break;
            }
            let before = self.state(limit);
            let value = Self::held(control, &before);
            let mut margin = f64::INFINITY;
            let mut landing = None;
            for (i, stretch) in stretches[..at].iter().enumerate().rev() {
                let lowest = self.held_at(control, stretch[0]);
                margin = margin.min((lowest - value).abs());
                if lowest <= value {
                    landing = Some((i, self.crossing(control, *stretch, value)));
                    break;
                }
            }
            let after = landing.map(|(_, s)| self.state(s));
            let loss = self.loss(control, &before, after.as_ref());
            jumps.push(Jump { before, after, loss, margin });
            match landing {
                Some((next, s)) if s >= to => at = next,
                _ => break,
            }
        }
        Some(Path { start, jumps })
    }

    /// The loss in a jump.
    pub fn loss(&self, control: Control, before: &State, after: Option<&State>) -> Option<f64> {
        let inner = after.map_or(0.0, |after| after.radius);
        let work = |a: f64| {
            let (away, edge) = (before.approach - self.value(a), self.edge(a));
            (away - edge) * (away + edge)
        };
        let area = self.integral(inner, before.radius, work);
        match (after, control) {
            (None, Control::Force) => None,
            (None, Control::Displacement) => Some(area),
            (None, Control::Stiffness(k)) => Some(area + 0.5 * before.force * before.force / k),
            (Some(after), _) => {
                let away = before.approach - after.approach;
                let held = after.force + 2.0 * after.radius * away;
                Some(area + 0.5 * away * (held - before.force))
            }
        }
    }

    /// ∫ f da between two radii.
    fn integral(&self, from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let mut sum = 0.0;
        for piece in self.pieces() {
            let (lo, hi) = (piece.lo.max(from), piece.hi.min(to));
            if lo >= hi {
                continue;
            }
            let base = if piece.root { piece.lo } else { 0.0 };
            let ends = [lo, hi].map(|a| if piece.root { (a - base).sqrt() } else { a });
            let half = 0.5 * (ends[1] - ends[0]) / f64::from(PARTS);
            for part in 0..PARTS {
                let middle = ends[0] + (2.0 * f64::from(part) + 1.0) * half;
                for [x, weight] in &self.rule {
                    let v = middle + half * x;
                    let (a, stretch) = if piece.root { (base + v * v, 2.0 * v) } else { (v, 1.0) };
                    sum += weight * half * stretch * f(a);
                }
            }
        }
        sum
    }
}

/// The first place between `lo` and `hi` at which `beyond` holds, to the last bit; it holds at `hi`.
fn bisect(mut lo: f64, mut hi: f64, beyond: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (lo + hi);
        if middle <= lo || middle >= hi || hi - lo <= 1e-15 * hi {
            return hi;
        }
        if beyond(middle) { hi = middle } else { lo = middle }
    }
}

/// Gauss's rule on [−1, 1]: nodes and weights, by Newton's method on Legendre polynomials.
pub fn gauss(n: usize) -> Vec<[f64; 2]> {
    let order = n as f64;
    (0..n)
        .map(|i| {
            let mut x = -(PI * (i as f64 + 0.75) / (order + 0.5)).cos();
            let mut slope = 0.0;
            for _ in 0..100 {
                let (mut p, mut before) = (1.0, 0.0);
                for k in 0..n {
                    let k = k as f64;
                    (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
                }
                slope = order * (before - x * p) / (1.0 - x * x);
                let step = p / slope;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            [x, 2.0 / ((1.0 - x * x) * slope * slope)]
        })
        .collect()
}
