//! What is fitted: parameters, data, the paths of values and the feet of points on them.

use super::distance::{Nearest, ScaledPath};
use super::path::{FitPath, PathPlace};
use super::prior::Prior;
use super::reach::Reach;
use super::way::Way;
use crate::elementary::{exp, ln};
use crate::measured::branches::MeasuredPoint;
use crate::measured::points::Turned;
use crate::measured::{Abscissa, Instrument, Segment};
use crate::preset::data::{BASELINE, OFFSET, TILT};
use crate::preset::schema::RANGE_KEYS;
use crate::preset::{Preset, Value, edge};
use crate::problem::{Adhesion, Start, StatedCohesion};
use nalgebra::allocator::Allocator;
use nalgebra::{DVector, DefaultAllocator, Dim, Dyn, OMatrix};
use std::num::NonZero;
use std::panic::resume_unwind;
use std::thread::available_parallelism;

/// What a parameter is.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// A key of the preset.
    Key(String),
    /// The work of adhesion of one branch: what a closing edge gains, or an opening one costs.
    Adhesion(Segment),
    /// δ₀: x = model + δ₀.
    Offset,
    /// P₀: P = model + P₀ + tilt x.
    Baseline,
    /// Its slope.
    Tilt,
}

impl Target {
    /// The factor by which its value, which is a number of the file, becomes one of the points.
    pub fn sign(&self, turned: Turned) -> f64 {
        let [offset, baseline, tilt] = Instrument::signs(turned);
        match self {
            Self::Offset => offset,
            Self::Baseline => baseline,
            Self::Tilt => tilt,
            Self::Key(_) | Self::Adhesion(_) => 1.0,
        }
    }

    /// Its dotted key.
    pub fn key(&self) -> String {
        match self {
            Self::Key(key) => key.clone(),
            Self::Adhesion(Segment::Approach) => edge::CLOSING_ADHESION.to_owned(),
            Self::Adhesion(_) => ADHESION.to_owned(),
            Self::Offset => OFFSET.to_owned(),
            Self::Baseline => BASELINE.to_owned(),
            Self::Tilt => TILT.to_owned(),
        }
    }
}

/// The key of the work of adhesion.
pub const ADHESION: &str = "material.work_of_adhesion";

/// The key of E*.
pub const MODULUS: &str = "material.effective_modulus";

/// The key of the contact radius at which a pull begins.
pub const START: &str = "path.start_contact_radius";

/// A parameter that is free.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeParameter {
    /// What it is.
    pub target: Target,
    /// Where it starts, in base units.
    pub start: f64,
    /// Its unit in u, unless u is its logarithm.
    pub scale: Option<f64>,
}

impl FreeParameter {
    /// u of a value.
    pub fn inner(&self, value: f64) -> f64 {
        self.scale.map_or_else(|| ln(value), |scale| value / scale)
    }

    /// The value of u.
    pub fn value(&self, u: f64) -> f64 {
        self.scale.map_or_else(|| exp(u), |scale| u * scale)
    }

    /// dv/du at a value.
    pub fn slope(&self, value: f64) -> f64 {
        self.scale.unwrap_or(value)
    }

    /// The value that is known before, and its standard deviation.
    pub(super) fn given(&self, prior: &Prior) -> [f64; 2] {
        let value = self.value(prior.mean);
        [value, prior.sigma * self.slope(value).abs()]
    }

    /// Its dotted key.
    pub fn key(&self) -> String {
        self.target.key()
    }
}

/// One point that is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// The point.
    pub point: MeasuredPoint,
    /// Its branch.
    pub segment: Segment,
    /// Its number among the branches, of which a file of several loops has more than two.
    pub branch: usize,
    /// Whether the bodies are apart there.
    pub free: bool,
    /// The noise of each of its residuals in σ: above 1 where that of the force grows with the force.
    pub noise: [f64; 2],
    /// The bias of its distance where the curve bends within the noise, in σ.
    pub bias: f64,
}

/// What is fitted.
#[derive(Debug, Clone)]
pub struct FitProblem {
    /// The preset that the free keys are laid over, with the device.
    pub preset: Preset,
    /// What x is.
    pub abscissa: Abscissa,
    /// The free parameters.
    pub parameters: Vec<FreeParameter>,
    /// What is known of them before.
    pub priors: Vec<Prior>,
    /// The values of the instrument that are held, in the signs of the points.
    pub instrument: Instrument,
    /// Whether the signs of x and P are reversed: the parameters are numbers of the file.
    pub turned: Turned,
    /// The points.
    pub data: Vec<Datum>,
    /// σ of x, P and s.
    pub sigma: PathPlace,
    /// The share of P by which its σ grows with it, beside σ of P.
    pub share: f64,
    /// The step of the converter of the force; 0 where none is seen.
    pub step: f64,
    /// Whether s is measured beside x.
    pub space: bool,
    /// What the paths must reach.
    pub reach: Reach,
    /// The work of adhesion of the approach where it is given and not that of the retraction.
    pub closing: Option<f64>,
    /// Whether approach and retraction go different ways: there are waves, and points of an approach.
    pub loops: bool,
    /// How often each residual counts; without counts, each counts once.
    pub counts: Option<Vec<f64>>,
}

/// The paths of the two branches, which are the same unless their adhesions or their ways differ.
pub struct Paths {
    retraction: FitPath,
    approach: Option<FitPath>,
}

impl Paths {
    /// The path of a branch.
    pub fn of(&self, segment: Segment) -> &FitPath {
        match (&self.approach, segment) {
            (Some(path), Segment::Approach) => path,
            _ => &self.retraction,
        }
    }

    /// Those of the approach and of the retraction, in units of noise.
    pub(super) fn scaled(&self, weights: PathPlace) -> [ScaledPath<'_>; 2] {
        [Segment::Approach, Segment::Retraction].map(|of| ScaledPath::new(self.of(of), weights))
    }
}

impl FitProblem {
    /// How many of the residuals the parameters take up: what is known before costs none.
    pub fn taken(&self) -> usize {
        self.parameters.len() - self.priors.len()
    }

    /// The number of the tension or the range of adhesion, where that is free.
    pub(super) fn free_range(&self) -> Option<usize> {
        self.parameters.iter().position(|parameter| RANGE_KEYS.contains(&&*parameter.key()))
    }

    /// Residuals of one attached point.
    pub fn per_point(&self) -> usize {
        if self.space { 2 } else { 1 }
    }

    /// The contact radius of a point; not a number where it is not measured.
    pub fn radius(&self, i: usize) -> f64 {
        let point = &self.data[i].point;
        if self.abscissa == Abscissa::Radius { point.x } else { point.radius }
    }

    /// 1/σ, 0 for what is not measured.
    pub fn weights(&self) -> PathPlace {
        [1.0 / self.sigma[0], 1.0 / self.sigma[1], if self.space { 1.0 / self.sigma[2] } else { 0.0 }]
    }

    /// The preset at `u`, of one branch.
    pub fn preset_at(&self, u: &[f64], segment: Segment) -> Option<Preset> {
        let mut preset = self.preset.clone();
        if let Some(closing) = self.closing.filter(|_| segment == Segment::Approach) {
            preset.material.work_of_adhesion = closing;
        }
        for (parameter, u) in self.parameters.iter().zip(u) {
            let key = match &parameter.target {
                Target::Key(key) => key.as_str(),
                Target::Adhesion(of) if *of == segment => ADHESION,
                _ => continue,
            };
            let value = parameter.value(*u);
            // Those that need no check across keys.
            match key {
                MODULUS if value.is_normal() => {
                    preset.material.effective_modulus = value;
                }
                ADHESION if value.is_finite() => preset.material.work_of_adhesion = value,
                edge::REFERENCE_SPEED if value.is_normal() => preset.edge.reference_speed = Some(value),
                START if value.is_normal() => preset.path.start = Start::ContactRadius(value),
                key if key == RANGE_KEYS[0] && value.is_normal() => {
                    preset.material.adhesion = Adhesion::Dugdale(StatedCohesion::Strength(value));
                }
                key => preset.set(key, Value::Number(value)).ok()?,
            }
        }
        Some(preset)
    }

    /// The instrument at `u`, in the signs of the points.
    pub fn instrument_at(&self, u: &[f64]) -> Instrument {
        let mut instrument = self.instrument;
        for (parameter, u) in self.parameters.iter().zip(u) {
            let value = parameter.target.sign(self.turned) * parameter.value(*u);
            match parameter.target {
                Target::Offset => instrument.offset = value,
                Target::Baseline => instrument.baseline = value,
                Target::Tilt => instrument.tilt = value,
                _ => {}
            }
        }
        instrument
    }

    /// How far the points reach in one of their numbers.
    pub(super) fn extent(&self, of: fn(&MeasuredPoint) -> f64) -> f64 {
        let values = self.data.iter().map(|datum| of(&datum.point));
        let [lo, hi] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)]);
        (hi - lo).max(0.0)
    }

    /// The noise of the points as a share of their ranges.
    fn noise(&self) -> f64 {
        let share = |sigma: f64, extent: f64| if extent > 0.0 { sigma / extent } else { 0.0 };
        let extents: [f64; 2] = [self.extent(|point| point.x), self.extent(|point| point.force)];
        share(self.sigma[0], extents[0]).min(share(self.sigma[1], extents[1]))
    }

    /// The contact radius that the way up reaches at x, less the instrument's offset, at `u`; `None` where the approach
    /// has no way of its own.
    pub(super) fn reached(&self, u: &[f64], x: f64) -> Option<f64> {
        let is_pinned = false;
        self.loops.then(|| self.path(u, Segment::Approach, None, is_pinned))??.outermost_at(x)
    }

    /// The path of a branch at `u`, beginning at the radius `radius` where that is given.
    fn path(&self, u: &[f64], segment: Segment, radius: Option<f64>, is_pinned: bool) -> Option<FitPath> {
        let instrument = self.instrument_at(u);
        let [x, force, s] = self.reach.most;
        let shift = if self.abscissa == Abscissa::Radius { 0.0 } else { instrument.offset };
        let apart = |x: f64| instrument.baseline + instrument.tilt * x;
        let turn = self.reach.turn;
        let reach = Reach {
            most: [x - shift, force - apart(x), s],
            turn: [turn[0] - shift, turn[1] - apart(turn[0])],
            radius: radius.or(self.reach.radius),
            noise: self.noise(),
            ..self.reach
        };
        let goes_up = self.loops && segment == Segment::Approach;
        let preset = self.preset_at(u, segment)?;
        // A pinned edge stays where the approach has left it.
        let (reach, way) = match preset.path.start {
            Start::ContactRadius(radius) if is_pinned => {
                let way = if goes_up { Way::UpToPinned } else { Way::DownFromPinned };
                (Reach { radius: Some(radius), ..reach }, way)
            }
            _ => (reach, if goes_up { Way::Up } else { Way::Down }),
        };
        FitPath::new(&preset, self.abscissa, &reach, way)
    }

    /// Whether the branches have works of adhesion of their own, and the edge is pinned between them.
    pub(super) fn pins(&self) -> bool {
        self.splits() && self.parameters.iter().any(|p| p.target == Target::Key(START.to_owned()))
    }

    /// Whether they have works of adhesion of their own.
    pub(super) fn splits(&self) -> bool {
        self.closing.is_some() || self.parameters.iter().any(|p| matches!(p.target, Target::Adhesion(_)))
    }

    /// The paths at `u`.
    pub fn paths(&self, u: &[f64]) -> Option<Paths> {
        self.paths_from(u, &|_| None)
    }

    /// The paths at `u`, each beginning where that of `paths` does.
    pub(super) fn beside(&self, u: &[f64], paths: &Paths) -> Option<Paths> {
        self.paths_from(u, &|segment| Some(paths.of(segment).outermost))
    }

    fn paths_from(&self, u: &[f64], radius: &dyn Fn(Segment) -> Option<f64>) -> Option<Paths> {
        let of = |segment| self.path(u, segment, radius(segment), self.pins());
        let approach = if self.splits() || self.loops { Some(of(Segment::Approach)?) } else { None };
        let mut retraction = of(Segment::Retraction)?;
        if let Some(approach) = approach.as_ref().filter(|_| self.pins()) {
            retraction.pinned_after(approach);
        }
        Some(Paths { retraction, approach })
    }

    /// A point as the model has it, in units of noise.
    fn corrected(&self, datum: &Datum, at: &Instrument) -> PathPlace {
        let MeasuredPoint { x, force, radius, .. } = datum.point;
        let weights = self.weights();
        let shift = if self.abscissa == Abscissa::Radius { 0.0 } else { at.offset };
        [
            (x - shift) * weights[0],
            (force - at.baseline - at.tilt * x) * weights[1],
            if self.space { radius * weights[2] } else { 0.0 },
        ]
    }

    /// The feet of all attached points, and no foot for free ones; `None` where an attached point has none.
    pub(super) fn feet(&self, paths: &Paths, at: &Instrument) -> Option<Vec<Option<Nearest>>> {
        /// The number of rows from which starting threads is worthwhile.
        const MANY: usize = 20_000;
        let scaled = paths.scaled(self.weights());
        let part = &|part: &[Datum]| -> Option<Vec<Option<Nearest>>> {
            let mut boxes = [0; 2];
            let foot = |datum: &Datum| {
                if datum.free {
                    return Some(None);
                }
                let of = usize::from(datum.segment == Segment::Retraction);
                scaled[of].nearest(self.corrected(datum, at), &mut boxes[of]).map(Some)
            };
            part.iter().map(foot).collect()
        };
        if self.data.len() < MANY {
            return part(&self.data);
        }
        let threads = available_parallelism().map_or(1, NonZero::get);
        // Each foot is found independently: the number of threads changes nothing.
        std::thread::scope(|scope| {
            let parts = self.data.chunks(self.data.len().div_ceil(threads));
            let parts: Vec<_> = parts.map(|rows| scope.spawn(move || part(rows))).collect();
            let mut feet = Vec::with_capacity(self.data.len());
            for part in parts {
                feet.extend(part.join().unwrap_or_else(|panic| resume_unwind(panic))?);
            }
            Some(feet)
        })
    }

    /// The residuals of given feet: one for each point, or two in space, where the second one of free points is zero.
    pub(super) fn told(&self, feet: &[Option<Nearest>], at: &Instrument) -> DVector<f64> {
        let per = self.per_point();
        let mut residuals = DVector::zeros(per * self.data.len());
        for (i, (datum, foot)) in self.data.iter().zip(feet).enumerate() {
            match foot {
                Some(foot) => {
                    (0..per).for_each(|k| residuals[per * i + k] = foot.residuals[k]);
                    residuals[per * i] -= datum.bias;
                }
                None => residuals[per * i] = self.corrected(datum, at)[1],
            }
        }
        self.in_own_noise(residuals)
    }

    /// Residuals in σ, or their derivatives, in the noise of each row.
    pub(super) fn in_own_noise<C: Dim>(&self, mut of_rows: OMatrix<f64, Dyn, C>) -> OMatrix<f64, Dyn, C>
    where
        DefaultAllocator: Allocator<Dyn, C>,
    {
        let per = self.per_point();
        if self.share > 0.0 {
            for (i, mut row) in of_rows.row_iter_mut().enumerate() {
                row /= self.data[i / per].noise[i % per];
            }
        }
        of_rows
    }
}
