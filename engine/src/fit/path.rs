//! The curve that measured points lie on, for one set of values: arcs of equilibria and the lines of jumps between them.
//!
//! Without snaps it is the whole equilibrium curve, its unstable part too, so that it passes smoothly through the pull-off as
//! values change. With snaps it is the path of a quasi-static unloading, jumps included, and behind the pull-off the unstable
//! stretch that begins there; or that of loading from the first touch.

use super::way::{Leg, Seen, Way, legs};
use crate::case;
use crate::disc::{self, Basis, Exact, Local};
use crate::elementary::hypot;
use crate::measured::Abscissa;
use crate::preset::Preset;
use crate::problem::{Control, Reduced, Units};
use crate::progress::Unwatched;
use crate::quasistatic::overlap::passed;
use crate::quasistatic::{Curve, Detail, Sample};
use std::f64::consts::TAU;
use std::sync::Arc;

/// x, P and s.
pub type Place = [f64; 3];

/// A point of the path: its piece and where on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Foot {
    /// On an arc, at this contact radius.
    Radius(f64),
    /// At the outer end of a piece.
    Outer,
    /// At its inner end.
    Inner,
    /// On a line, this share of the way from its inner to its outer end.
    Share(f64),
}

/// What moves a path at a held contact radius by a closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mover {
    /// E*.
    Modulus,
    /// γ.
    Adhesion,
    /// k.
    Stiffness,
    /// 1/σ₀², of an adhesion that is a tension σ₀ up to the separation γ/σ₀, where it is 0: not by its logarithm.
    Range,
}

/// A piece of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// Equilibria between two radii, the outer first.
    Arc([f64; 2]),
    /// A jump, by its ends, that before it first: x, P, s.
    Line([Place; 2]),
}

/// A corner of the polyline that stands for the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Where it is.
    pub at: Place,
    /// The derivatives by s; nothing at the ends of a line.
    pub slopes: Place,
    /// Its piece.
    pub piece: usize,
    /// s on an arc, the share on a line.
    pub along: f64,
}

/// A corner of the polyline before its piece is known.
struct Corner {
    at: Place,
    slopes: Place,
    along: f64,
    /// Which way the curve goes there, in units of its ranges.
    direction: Option<[f64; 2]>,
}

/// What a path must reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// The largest x, P and s of the points; minus infinity where there are none.
    pub most: Place,
    /// x and P where the retraction begins.
    pub turn: [f64; 2],
    /// Where it begins, whatever the points are: of two paths beside each other the pieces are then the same.
    pub radius: Option<f64>,
    /// The length by which a gap without one of its own is reduced.
    pub length: f64,
}

/// The path of one preset.
#[derive(Debug, Clone)]
pub struct Path {
    curve: Curve,
    units: Units,
    abscissa: Abscissa,
    /// 1/k; 0 where x is no way of a spring.
    compliance: f64,
    /// E* and γ.
    material: [f64; 2],
    /// Its pieces, running inward.
    pub pieces: Vec<Piece>,
    /// Its corners, running inward.
    pub vertices: Vec<Vertex>,
    /// The outermost radius.
    pub outermost: f64,
    /// The snaps on it, the first touch and the pull-off left out.
    pub snaps: usize,
    /// The smallest force.
    pub least_force: f64,
}

/// Contact radii begin at this share of the outermost.
const INNERMOST: f64 = 1e-3;
/// The cosine of the turn of the curve between two corners of the polyline, and how often a step is halved for it.
const STRAIGHT: f64 = 0.98;
const DEEPEST: usize = 7;
/// How far beyond the points the path goes.
const MARGIN: f64 = 1.15;

impl Path {
    /// The path of `preset` on this way; `None` where it has none that reaches so far.
    #[must_use]
    pub fn new(preset: &Preset, abscissa: Abscissa, reach: &Reach, way: Way) -> Option<Self> {
        let control = preset.path.control;
        let length = preset.gap.length().unwrap_or(reach.length);
        let reduced = preset.problem().reduced_by(length);
        let units = reduced.units;
        let compliance = match (abscissa, control) {
            (Abscissa::Position, Control::Stiffness(k)) => 1.0 / k,
            _ => 0.0,
        };
        let table = case::table(&preset.gap, &reduced, 1.0, &preset.units, &Unwatched).ok()?;
        let x_of = |delta: f64, force: f64, s: f64| {
            let (delta, force) = (delta * units.length, force * units.force);
            if abscissa == Abscissa::Radius { s * units.length } else { delta + compliance * force }
        };
        let outermost = match reach.radius {
            Some(radius) => (radius / units.length).min(reduced.largest_contact()),
            None => outermost(&reduced, &Exact::new(Arc::clone(&table), 1e-3), reach, &x_of)?,
        };
        let basis: Arc<dyn Basis> = Arc::new(Exact::new(Arc::clone(&table), outermost));
        let innermost = INNERMOST * outermost;
        let mut curve = Curve::new(reduced, basis, table, [outermost, innermost], Detail::Drawn, &Unwatched)?;
        let held = control.in_units(units.stiffness);
        curve.hold(held);
        // A rising stretch outside a falling one, or one of either: a curve without snaps.
        let inside = |s: f64| s > innermost && s < outermost;
        let limits = curve.monotone(held).limits.iter().filter(|limit| inside(limit.contact_radius)).count();
        let seen = Seen {
            x_of: &|at: &Local| x_of(at.approach, at.force, at.contact_radius),
            most: reach.most[0],
            turn: [reach.turn[0], reach.turn[1] / units.force],
        };
        let legs = if limits > 1 { legs(&mut curve, held, way, &seen) } else { Vec::new() };
        let mut path = Self {
            curve,
            units,
            abscissa,
            compliance,
            material: [preset.material.effective_modulus, preset.material.work_of_adhesion],
            pieces: Vec::new(),
            vertices: Vec::new(),
            outermost: outermost * units.length,
            snaps: 0,
            least_force: f64::INFINITY,
        };
        for leg in &legs {
            let ends = |places: &[disc::Place; 2]| places.map(|place| path.curve.solution.at(place));
            let piece = match leg {
                Leg::Along(places) => Piece::Arc(ends(places).map(|at| at.contact_radius * units.length)),
                Leg::Jump(places) => {
                    path.snaps += 1;
                    let place =
                        |at: Local| path.place(at.contact_radius * units.length, at.approach, at.force);
                    Piece::Line(ends(places).map(place))
                }
            };
            path.pieces.push(piece);
        }
        if legs.is_empty() {
            path.pieces.push(Piece::Arc([outermost, innermost].map(|s| s * units.length)));
        }
        path.draw();
        Some(path)
    }

    /// The smallest radius at which the disc would overlap a crest outside, on this path up to the radius `to`: rings of contact take
    /// another one then.
    #[must_use]
    pub fn overlap(&self, to: f64) -> Option<f64> {
        let reduced = |s: f64| s.min(to) / self.units.length;
        let arcs = self.pieces.iter().filter_map(|piece| match piece {
            Piece::Arc([outer, inner]) if *inner < to => Some([reduced(*outer), reduced(*inner)]),
            _ => None,
        });
        let found = passed(&self.curve, &arcs.collect::<Vec<_>>(), &Unwatched)?;
        found.iter().map(|overlap| overlap.to * self.units.length).reduce(f64::min)
    }

    /// The corners of the polyline.
    fn draw(&mut self) {
        let curve = &self.curve;
        let mut vertices = Vec::new();
        let ranges = [|at: &Sample| at.approach, |at: &Sample| at.force].map(|of| {
            let ends = curve
                .samples
                .iter()
                .map(of)
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)]);
            ends[1] - ends[0]
        });
        for (piece, what) in self.pieces.iter().enumerate() {
            let mut add = |corner: &Corner| {
                let Corner { at, slopes, along, .. } = *corner;
                vertices.push(Vertex { at, slopes, piece, along });
            };
            match what {
                Piece::Line(ends) => {
                    for (at, along) in ends.iter().zip([1.0, 0.0]) {
                        add(&Corner { at: *at, slopes: [0.0; 3], along, direction: None });
                    }
                }
                Piece::Arc([outer, inner]) => {
                    let within = |sample: &&Sample| {
                        let s = sample.contact_radius * self.units.length;
                        s < *outer && s > *inner
                    };
                    let drawn =
                        curve.samples.iter().filter(within).map(|sample| self.of_sample(sample, ranges));
                    let [outer, inner] = [outer, inner].map(|s| self.corner(*s, ranges));
                    let corners: Vec<Corner> = [outer].into_iter().chain(drawn).chain([inner]).collect();
                    for pair in corners.windows(2) {
                        add(&pair[0]);
                        self.bend([&pair[0], &pair[1]], ranges, DEEPEST, &mut add);
                    }
                    corners.last().into_iter().for_each(&mut add);
                }
            }
        }
        self.least_force = vertices.iter().map(|vertex: &Vertex| vertex.at[1]).fold(f64::INFINITY, f64::min);
        self.vertices = vertices;
    }

    /// The corner at the contact radius `s`; no number where there is no equilibrium.
    fn corner(&self, s: f64, ranges: [f64; 2]) -> Corner {
        let none = Corner { at: [f64::NAN; 3], slopes: [f64::NAN; 3], along: s, direction: None };
        self.local(s).map_or(none, |(local, by_radius)| {
            self.drawn(s, [local.approach, local.force], by_radius, ranges)
        })
    }

    /// The corner at a state of the curve, which is there already.
    fn of_sample(&self, sample: &Sample, ranges: [f64; 2]) -> Corner {
        let s = sample.contact_radius * self.units.length;
        let by_radius = [sample.slopes.approach, sample.slopes.force];
        // On the outer side of a corner of the gap there are none.
        if by_radius.iter().any(|slope| !slope.is_finite()) {
            return self.corner(s, ranges);
        }
        self.drawn(s, [sample.approach, sample.force], by_radius, ranges)
    }

    /// The corner of a reduced state with its derivatives by the radius.
    fn drawn(&self, s: f64, [delta, force]: [f64; 2], by_radius: [f64; 2], ranges: [f64; 2]) -> Corner {
        let [x, p] = [by_radius[0] / ranges[0], by_radius[1] / ranges[1]];
        let length = hypot(x, p);
        let direction = (length > 0.0).then_some([x / length, p / length]);
        Corner { at: self.place(s, delta, force), slopes: self.slopes(by_radius), along: s, direction }
    }

    /// Adds corners between two of them where the curve turns: at a limit point it may turn back within a step.
    fn bend(
        &self,
        [outer, inner]: [&Corner; 2],
        ranges: [f64; 2],
        depth: usize,
        add: &mut dyn FnMut(&Corner),
    ) {
        if depth == 0 {
            return;
        }
        if let (Some(a), Some(b)) = (outer.direction, inner.direction)
            && a[0] * b[0] + a[1] * b[1] < STRAIGHT
        {
            let middle = self.corner(0.5 * (outer.along + inner.along), ranges);
            self.bend([outer, &middle], ranges, depth - 1, add);
            if middle.at[0].is_finite() {
                add(&middle);
            }
            self.bend([&middle, inner], ranges, depth - 1, add);
        }
    }

    /// x, P and s of a reduced state.
    fn place(&self, s: f64, delta: f64, force: f64) -> Place {
        let (delta, force) = (delta * self.units.length, force * self.units.force);
        let x = if self.abscissa == Abscissa::Radius { s } else { delta + self.compliance * force };
        [x, force, s]
    }

    /// The reduced equilibrium of the contact radius `s`, with dδ/ds and dP/ds; `None` beyond what is known.
    fn local(&self, s: f64) -> Option<(Local, [f64; 2])> {
        // The outermost radius may be rounded beyond what is known.
        let reduced = (s / self.units.length).min(self.curve.solution.reach());
        let local = self.curve.solution.at(self.curve.solution.place(reduced)?);
        Some((local, local.slopes.map(|slope| slope / local.stretch)))
    }

    /// The derivatives of x, P and s by s, of those of the reduced δ and P.
    fn slopes(&self, [delta, force]: [f64; 2]) -> Place {
        let force = force * self.units.force / self.units.length;
        let x = if self.abscissa == Abscissa::Radius { 1.0 } else { delta + self.compliance * force };
        [x, force, 1.0]
    }

    /// The equilibrium of the contact radius `s`, with its derivatives by s; `None` beyond what is known.
    pub fn at(&self, s: f64) -> Option<(Place, Place)> {
        let (local, by_radius) = self.local(s)?;
        Some((self.place(s, local.approach, local.force), self.slopes(by_radius)))
    }

    /// How the equilibrium `at` moves for each unit of the logarithm of a value, its contact radius held.
    #[must_use]
    pub fn moves(&self, mover: Mover, [_, force, s]: Place) -> Place {
        let [e, gamma] = self.material;
        let root = (TAU * gamma * s / e).sqrt();
        let [delta, force] = match mover {
            Mover::Modulus => [0.5 * root, force + e * s * root],
            Mover::Adhesion => [-0.5 * root, -e * s * root],
            Mover::Stiffness => return [-self.compliance * force, 0.0, 0.0],
            Mover::Range => self.of_range(s, root),
        };
        let x = if self.abscissa == Abscissa::Radius { 0.0 } else { delta + self.compliance * force };
        [x, force, 0.0]
    }

    /// How δ and P move with 1/σ₀², where `root` is T = √(2πγs/E*). The zone of the tension ends at c = s/cos ψ, with ψ → q/σ₀:
    ///
    /// ```text
    /// q = √(πE*γ/2s)     ∂δ = T (E* g'(s) q/6 − 5q²/24)     ∂P = 2E* s ∂δ − 4s²q³/3
    /// ```
    ///
    /// These are the first terms of D. Maugis, J. Colloid Interface Sci. 150, 243 (1992), for any gap.
    fn of_range(&self, s: f64, root: f64) -> [f64; 2] {
        let [e, gamma] = self.material;
        // ∂P/∂s = 2E*(s g' − 3T/2)
        let Some((_, [_, slope, _])) = self.at(s) else { return [0.0; 2] };
        let transformed = (slope / (2.0 * e) + 1.5 * root) / s;
        let q = (0.25 * TAU * e * gamma / s).sqrt();
        let delta = root * q * (e * transformed / 6.0 - 5.0 * q / 24.0);
        [delta, 2.0 * e * s * delta - 4.0 / 3.0 * s * s * q.powi(3)]
    }

    /// δ at the contact radius `s`.
    #[must_use]
    pub fn approach(&self, s: f64) -> Option<f64> {
        let place = self.curve.solution.place(s / self.units.length)?;
        Some(self.curve.solution.at(place).approach * self.units.length)
    }

    /// Where a foot is on this path.
    pub fn foot(&self, piece: usize, foot: Foot) -> Option<Place> {
        match (self.pieces.get(piece)?, foot) {
            (Piece::Arc(_), Foot::Radius(s)) => self.at(s).map(|(at, _)| at),
            (Piece::Arc([s, _]), Foot::Outer) | (Piece::Arc([_, s]), Foot::Inner) => {
                self.at(*s).map(|(at, _)| at)
            }
            (Piece::Line([at, _]), Foot::Outer) | (Piece::Line([_, at]), Foot::Inner) => Some(*at),
            (Piece::Line([before, after]), Foot::Share(t)) => {
                Some(std::array::from_fn(|i| after[i] + t * (before[i] - after[i])))
            }
            _ => None,
        }
    }

    /// x at the force `p` on the outermost branch, by the polyline.
    pub fn x_at_force(&self, p: f64) -> Option<f64> {
        let pairs = self.vertices.windows(2).take_while(|pair| pair[1].at[1] <= pair[0].at[1]);
        let mut pairs = pairs.skip_while(|pair| pair[1].at[1] > p);
        let pair = pairs.next()?;
        let [a, b] = [pair[0].at, pair[1].at];
        (a[1] >= p && a[1] > b[1]).then(|| b[0] + (p - b[1]) / (a[1] - b[1]) * (a[0] - b[0]))
    }
}

/// The reduced radius from which the curve reaches beyond all points.
fn outermost(
    reduced: &Reduced,
    basis: &Exact,
    reach: &Reach,
    x_of: &dyn Fn(f64, f64, f64) -> f64,
) -> Option<f64> {
    const FIRST: f64 = 1e-7;
    const GROWTH: f64 = 1.5;
    let largest = reduced.largest_contact();
    let units = reduced.units;
    let mut s = FIRST;
    let mut before = [f64::INFINITY; 2];
    for _ in 0..120 {
        if s >= largest {
            return Some(largest);
        }
        let at = basis.equilibrium(reduced, s)?;
        let here = [x_of(at.approach, at.force, s), at.force * units.force];
        // Small contacts have an approach and a force near zero too: only beyond the pull-off both rise.
        let rises = here[0] > before[0] && here[1] > before[1];
        let enough = here[0] >= reach.most[0] && here[1] >= reach.most[1];
        if rises && enough && s * units.length >= reach.most[2] {
            return Some((MARGIN * s).min(largest));
        }
        before = here;
        s *= GROWTH;
    }
    None
}
