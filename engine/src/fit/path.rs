//! The curve that measured points lie on, for one set of values: arcs of equilibria and the lines of jumps between them.
//!
//! Without snaps it is the whole equilibrium curve, with its unstable part, so that it passes smoothly through the
//! pull-off as values change. With snaps it is the path of a quasi-static unloading, jumps included, followed beyond
//! the pull-off by the unstable stretch that begins there; or the path of loading from the first touch.

use super::pulled::TrackState;
use super::reach::{Eye, Reach};
use super::track::{Mover, Track};
use super::way::{Leg, Way, WayEvidence, legs};
use crate::disc::{self, Local};
use crate::elementary::hypot;
use crate::measured::Abscissa;
use crate::preset::Preset;
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::quasistatic::overlap::passed;
use crate::quasistatic::path::PathError;
use crate::zone::FaultKind;
use std::f64::consts::TAU;

/// x, P and s.
pub type PathPlace = [f64; 3];

/// A point of the path: its piece and where on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Foot {
    /// On an arc, at this contact radius, or edge of a zone.
    Radius(f64),
    /// At the outer end of a piece.
    Outer,
    /// At its inner end.
    Inner,
    /// On a line, this share of the way from its inner to its outer end.
    Share(f64),
}

/// A piece of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathPiece {
    /// Equilibria between two radii, or edges of a zone, the outer first.
    Arc([f64; 2]),
    /// A jump, by its ends, the one before the jump first: x, P, s.
    Line([PathPlace; 2]),
}

/// A corner of the polyline that stands for the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Where it is.
    pub at: PathPlace,
    /// The derivatives with respect to s; zero at the ends of a line.
    pub slopes: PathPlace,
    /// Its piece.
    pub piece: usize,
    /// The radius or edge on an arc, the share on a line.
    pub along: f64,
}

/// A corner of the polyline before its piece is known.
struct Corner {
    at: PathPlace,
    slopes: PathPlace,
    along: f64,
    /// Which way the curve goes there, in units of its ranges.
    direction: Option<[f64; 2]>,
}

/// The path of one preset.
#[derive(Debug, Clone)]
pub struct FitPath {
    track: Track,
    eye: Eye,
    /// E* and γ.
    material: [f64; 2],
    /// Its pieces, running inward.
    pub pieces: Vec<PathPiece>,
    /// Its corners, running inward.
    pub vertices: Vec<Vertex>,
    /// The outermost radius.
    pub outermost: f64,
    /// The snaps on it, the first touch and the pull-off left out.
    pub snaps: usize,
    /// The smallest force.
    pub least_force: f64,
}

/// The cosine of the turn of the curve between two corners of the polyline, and how often a step is halved to reach it.
const STRAIGHT: f64 = 0.98;
const DEEPEST: usize = 7;

impl FitPath {
    /// The path of `preset` on this way; `None` where no path reaches far enough.
    pub fn new(preset: &Preset, abscissa: Abscissa, reach: &Reach, way: Way) -> Option<Self> {
        let control = preset.path.control;
        let length = preset.gap.length().unwrap_or(reach.length);
        let reduced = preset.problem().reduced_by(length);
        let compliance = match (abscissa, control) {
            (Abscissa::Position, Control::Stiffness(k)) => 1.0 / k,
            _ => 0.0,
        };
        let units = reduced.units;
        let eye = Eye { units, abscissa, compliance };
        let held = control.in_units(units.stiffness);
        let mut track = Track::new(preset, reduced, &eye, reach, held)?;
        let [outermost, innermost] = track.ends();
        // A rising stretch outside a falling one, or only one of the two, is a curve without snaps.
        let inside = |s: f64| s > innermost && s < outermost;
        let limits = track.monotone(held).map_or(0, |monotone| {
            monotone.limits.iter().filter(|limit| inside(limit.contact_radius)).count()
        });
        let seen = WayEvidence {
            x_of: &|at: &Local| eye.x([at.contact_radius, at.approach, at.force]),
            most: reach.most[0],
            turn: [reach.turn[0], reach.turn[1] / units.force],
        };
        let legs = if limits > 1 { legs(&mut track, held, way, &seen) } else { Vec::new() };
        // What runs along a pull is not a radius.
        let outermost_radius =
            if let Track::Pull(trail) = &track { trail.state(outermost).at[0] } else { outermost };
        let mut path = Self {
            track,
            eye,
            material: [preset.material.effective_modulus, preset.material.work_of_adhesion],
            pieces: Vec::new(),
            vertices: Vec::new(),
            outermost: outermost_radius * units.length,
            snaps: 0,
            least_force: f64::INFINITY,
        };
        for leg in &legs {
            let ends = |places: &[disc::Place; 2]| {
                let along = |place| path.track.solution().map_or(f64::NAN, |of| of.radius(place));
                places.map(along)
            };
            let piece = match leg {
                Leg::Along(places) => PathPiece::Arc(ends(places).map(|along| along * units.length)),
                Leg::Jump(places) => {
                    path.snaps += 1;
                    let states = ends(places).map(|along| path.track.state(along));
                    PathPiece::Line(
                        states.map(|state| state.map_or([f64::NAN; 3], |state| path.place(state.at))),
                    )
                }
            };
            path.pieces.push(piece);
        }
        if legs.is_empty() {
            path.pieces.push(PathPiece::Arc([outermost, innermost].map(|s| s * units.length)));
        }
        path.draw();
        Some(path)
    }

    /// Makes the path begin with a pinned edge: from where `before` ends to where this path begins, at the same contact
    /// radius. At a held radius P and x move along a straight line.
    pub(super) fn pinned_after(&mut self, before: &Self) {
        let ends = [before, &*self].map(|path| path.corner(path.outermost, [1.0; 2]).at);
        self.pieces.insert(0, PathPiece::Line(ends));
        self.draw();
    }

    /// The radius at x on its outermost piece; `None` where that does not hold x.
    pub(super) fn outermost_at(&self, x: f64) -> Option<f64> {
        const HALVINGS: usize = 50;
        let PathPiece::Arc([mut hi, mut lo]) = *self.pieces.first()? else { return None };
        let at = |s: f64| self.corner(s, [1.0; 2]).at[0];
        if !(at(lo)..=at(hi)).contains(&x) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (lo + hi);
            if at(middle) > x { hi = middle } else { lo = middle }
        }
        Some(hi)
    }

    /// The smallest radius at which the disc would overlap a crest outside, on this path up to the radius `to`: with
    /// rings of contact the path is then another one.
    pub fn overlap(&self, to: f64) -> Option<f64> {
        let Track::Edge(curve) = &self.track else { return None };
        let length = self.eye.units.length;
        let reduced = |s: f64| s.min(to) / length;
        let arcs = self.pieces.iter().filter_map(|piece| match piece {
            PathPiece::Arc([outer, inner]) if *inner < to => Some([reduced(*outer), reduced(*inner)]),
            _ => None,
        });
        let found = passed(curve, &arcs.collect::<Vec<_>>(), &Unwatched).ok()?;
        found.iter().map(|overlap| overlap.to * length).reduce(f64::min)
    }

    /// Where the state `along` an arc is not just one disc in one zone, and what else there is; `None` where it is, or
    /// where adhesion has no range.
    pub(super) fn fault(&self, along: f64) -> Option<(f64, Option<FaultKind>)> {
        let length = self.eye.units.length;
        match self.track.fault(along / length)? {
            PathError::BeyondZone { kind, radius, .. } => Some((radius * length, kind)),
            _ => Some((along, None)),
        }
    }

    /// The corners of the polyline.
    fn draw(&mut self) {
        let states = self.track.drawn();
        let mut vertices = Vec::new();
        let ranges = [1, 2].map(|k| {
            let values = states.iter().map(|state| state.at[k]);
            let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)]);
            ends[1] - ends[0]
        });
        for (piece, what) in self.pieces.iter().enumerate() {
            let mut add = |corner: &Corner| {
                let Corner { at, slopes, along, .. } = *corner;
                vertices.push(Vertex { at, slopes, piece, along });
            };
            match what {
                PathPiece::Line(ends) => {
                    for (at, along) in ends.iter().zip([1.0, 0.0]) {
                        add(&Corner { at: *at, slopes: [0.0; 3], along, direction: None });
                    }
                }
                PathPiece::Arc([outer, inner]) => {
                    let within = |state: &&TrackState| {
                        let along = state.along * self.eye.units.length;
                        along < *outer && along > *inner
                    };
                    let drawn = states.iter().filter(within).map(|state| self.drawn(state, ranges));
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

    /// The corner at a place `along` an arc; not a number where there is none.
    fn corner(&self, along: f64, ranges: [f64; 2]) -> Corner {
        let none = Corner { at: [f64::NAN; 3], slopes: [f64::NAN; 3], along, direction: None };
        let state = self.track.state(along / self.eye.units.length);
        state.map_or(none, |state| Corner { along, ..self.drawn(&state, ranges) })
    }

    /// The corner at a state.
    fn drawn(&self, state: &TrackState, ranges: [f64; 2]) -> Corner {
        let [x, p] = [state.slopes[1] / ranges[0], state.slopes[2] / ranges[1]];
        let length = hypot(x, p);
        let direction = (length > 0.0).then_some([x / length, p / length]);
        let along = state.along * self.eye.units.length;
        Corner { at: self.place(state.at), slopes: self.slopes(state.slopes), along, direction }
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
    fn place(&self, state: [f64; 3]) -> PathPlace {
        [self.eye.x(state), state[2] * self.eye.units.force, state[0] * self.eye.units.length]
    }

    /// The derivatives of x, P and s with respect to what runs along, from those of the reduced state.
    fn slopes(&self, slopes: [f64; 3]) -> PathPlace {
        self.place(slopes).map(|slope| slope / self.eye.units.length)
    }

    /// The place `along` an arc, with its derivatives with respect to that; `None` beyond the known part.
    pub fn at(&self, along: f64) -> Option<(PathPlace, PathPlace)> {
        let state = self.track.state(along / self.eye.units.length)?;
        Some((self.place(state.at), self.slopes(state.slopes)))
    }

    /// How the place `at`, `along` an arc, moves per unit of the logarithm of a value, with what runs along held;
    /// `None` where there is no closed form.
    pub fn moves(&self, mover: Mover, along: f64, at: PathPlace) -> Option<PathPlace> {
        let [_, force, s] = at;
        let compliance = self.eye.compliance;
        // x is δ + P/k.
        let own = if mover == Mover::Stiffness { -compliance * force } else { 0.0 };
        if mover == Mover::Stiffness && !matches!(self.track, Track::Pull(_)) {
            return Some([own, 0.0, 0.0]);
        }
        if !matches!(self.track, Track::Edge(_)) {
            let [x, force, s] = self.place(self.track.moves(mover, along / self.eye.units.length)?);
            return Some([x + own, force, s]);
        }
        let [e, gamma] = self.material;
        let root = (TAU * gamma * s / e).sqrt();
        let [delta, force] = match mover {
            Mover::Modulus => [0.5 * root, force + e * s * root],
            Mover::Adhesion => [-0.5 * root, -e * s * root],
            Mover::Range => self.of_range(s, root),
            Mover::Stiffness
            | Mover::Strength
            | Mover::Extent
            | Mover::Speed
            | Mover::Exponent
            | Mover::Start => {
                return None;
            }
        };
        let x = if self.eye.abscissa == Abscissa::Radius { 0.0 } else { delta + compliance * force };
        Some([x, force, 0.0])
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

    /// δ at a place `along` an arc.
    pub fn approach(&self, along: f64) -> Option<f64> {
        let length = self.eye.units.length;
        self.track.state(along / length).map(|state| state.at[1] * length)
    }

    /// s at a place `along` an arc.
    pub fn radius(&self, along: f64) -> Option<f64> {
        self.at(along).map(|([_, _, s], _)| s)
    }

    /// The step of the logarithm of a value over which its derivatives are taken.
    pub(super) fn step(&self) -> f64 {
        self.track.step()
    }

    /// Where a foot is on this path.
    pub fn foot(&self, piece: usize, foot: Foot) -> Option<PathPlace> {
        match (self.pieces.get(piece)?, foot) {
            (PathPiece::Arc(_), Foot::Radius(s)) => self.at(s).map(|(at, _)| at),
            (PathPiece::Arc([s, _]), Foot::Outer) | (PathPiece::Arc([_, s]), Foot::Inner) => {
                self.at(*s).map(|(at, _)| at)
            }
            (PathPiece::Line([at, _]), Foot::Outer) | (PathPiece::Line([_, at]), Foot::Inner) => Some(*at),
            (PathPiece::Line([before, after]), Foot::Share(t)) => {
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
