//! What is fitted: the points and parameters of a preset's branches.

use super::options::{FitError, Options, target};
use super::prior::Prior;
use super::problem::{ADHESION, Datum, FitProblem, FreeParameter, START, Target};
use super::pulled::is_pulled;
use super::rates::{keep_retraction, set_rate};
use super::reach::Reach;
use super::track::begins;
use super::uncertain::{Uncertain, uncertain};
use crate::gap::Gap;
use crate::measured::branches::{MeasuredPoint, median};
use crate::measured::{Abscissa, Branches, Instrument, Segment};
use crate::preset::data::DataSpec;
use crate::preset::edge::{CLOSING_ADHESION, RATE};
use crate::preset::{BasisSpec, Preset, Value};
use crate::problem::Start;
use crate::units::Quantity;
use crate::units::number::said;

/// The fewest points in contact for each free parameter.
pub(super) const PER_PARAMETER: usize = 3;
/// The number of rows that show where a retraction begins.
const TURN: usize = 5;
/// The units of δ₀ and P₀ are their ranges, but at least this.
const LEAST_UNIT: f64 = f64::MIN_POSITIVE;

/// What is fitted to these branches.
///
/// # Errors
/// [`FitError`].
pub fn posed(
    preset: &Preset,
    branches: &Branches,
    options: &Options,
    notes: &mut Vec<String>,
) -> Result<FitProblem, FitError> {
    let mut bare = bare(preset, notes);
    let mut data = data(branches);
    let offset = preset.data.instrument(branches).offset;
    let closing = closing(preset, branches, options, notes)?;
    let has_waves = preset.gap.feature_length().is_some();
    let mut targets = targets(preset, branches, (options, closing))?;
    if let Some(start) =
        started(&mut bare, (branches, options, closing), (&mut data, offset), &targets, notes)?
    {
        let is_own = options.free.is_empty() && bare.edge.rate.is_some();
        let own = Some(preset.path.start).filter(|start| is_own && matches!(start, Start::ContactRadius(_)));
        bare.path.start = own.unwrap_or(start);
        targets.extend(own.is_none().then(|| Target::Key(START.to_owned())));
    }
    let loops = has_waves && data.iter().any(|datum| datum.segment == Segment::Approach);
    let known = known(preset, branches, (options, closing))?;
    let is_known = known.iter().any(|known| known.target == Target::Baseline);
    let instrument = instrument(preset, branches, options, (&mut targets, is_known), notes);
    let also = known.iter().map(|known| &known.target).filter(|target| !targets.contains(target));
    targets.extend(also.cloned().collect::<Vec<_>>());
    let parameters = targets.into_iter().map(|target| parameter(&bare, branches, &instrument, target));
    let parameters: Vec<FreeParameter> = parameters.collect();
    if !is_pulled(&bare) {
        // It is that of the approach now, and the values of a fit need not be in order with it.
        bare.edge.closing_work_of_adhesion = None;
    }
    are_enough(&data, parameters.len(), known.len())?;
    let abscissa = branches.abscissa;
    let mut priors = priors(&known, &parameters);
    if !is_known {
        priors.extend(of_baseline(&preset.data, branches, &parameters));
    }
    let reach = reach(branches, &data);
    let sigma = branches.noise.sigma;
    let space = sigma[2] > 0.0 && abscissa != Abscissa::Radius;
    Ok(FitProblem {
        preset: bare,
        abscissa,
        parameters,
        priors,
        instrument,
        turned: branches.turned,
        data,
        sigma,
        share: 0.0,
        step: branches.noise.step,
        space,
        reach,
        closing: if let Closing::Given(gamma) = closing { Some(gamma) } else { None },
        loops,
        counts: None,
    })
}

/// The preset without its points and the ends of its path, which belong to its own values.
fn bare(preset: &Preset, notes: &mut Vec<String>) -> Preset {
    let mut bare = preset.clone();
    // Its own points say nothing about other values.
    bare.data = DataSpec::default();
    // Values far off would be refused because of where its path starts.
    (bare.path.start, bare.path.end_contact_radius, bare.path.turn) = (Start::Force(0.0), None, None);
    if preset.basis != BasisSpec::Exact {
        notes.push("the fit is made in the exact basis, whatever basis.kind says".to_owned());
    }
    bare
}

/// Whether the curve of `preset` is a pull at a rate, whichever keys are free.
fn has_rate(preset: &Preset) -> bool {
    let edge = &preset.edge;
    edge.has_law() && edge.rate.is_some() && edge.steps.trim().is_empty() && preset.cohesion().is_none()
}

/// Where the path of a fit starts that follows a pull or has works of adhesion of its own on either branch; `None` for
/// any other, whose path depends on no start.
fn started(
    bare: &mut Preset,
    (branches, options, closing): (&Branches, &Options, Closing),
    (data, offset): (&mut Vec<Datum>, f64),
    targets: &[Target],
    notes: &mut Vec<String>,
) -> Result<Option<Start>, FitError> {
    let retraction = branches.list.iter().filter(|branch| branch.segment == Segment::Retraction);
    let attached: Vec<&MeasuredPoint> = retraction.flat_map(|branch| &branch.attached).collect();
    let of_edge = targets.iter().map(Target::key).find(|key| key.starts_with("edge."));
    let of_rate = has_rate(bare) && !attached.is_empty();
    if let Some(key) = of_edge.or_else(|| of_rate.then(|| RATE.to_owned())) {
        keep_retraction(data, branches.abscissa, notes);
        // Points beside a curve as it stands are pulled at its rate.
        if !options.free.is_empty() {
            set_rate(bare, branches, (&key, options.is_rate_said), notes)?;
        }
        return begun(bare, branches, &attached, offset).map(Some);
    }
    let is_unset = bare.edge.rate.take().is_none();
    let plays_no_part = match (options.is_rate_said, bare.edge.has_law(), attached.is_empty()) {
        (true, false, _) => Some("--rate plays no part, as the edge has no law of its speed"),
        (true, true, true) => Some("--rate plays no part, as there is no retraction"),
        (true, true, false) => {
            Some("--rate plays no part with path.steps, or with adhesion that has a range")
        }
        (false, true, false) if is_unset && !options.free.is_empty() => {
            Some("the law of the edge plays no part, as path.rate is not set: equilibria are fitted")
        }
        _ => None,
    };
    notes.extend(plays_no_part.map(str::to_owned));
    if closing == Closing::Same {
        return Ok(None);
    }
    begun(bare, branches, &attached, offset).map(Some)
}

/// What is known beforehand of the parameters.
fn priors(known: &[Uncertain], parameters: &[FreeParameter]) -> Vec<Prior> {
    let of = |known: &Uncertain| {
        let at = parameters.iter().position(|parameter| parameter.target == known.target)?;
        Some(known.prior(&parameters[at], at))
    };
    known.iter().filter_map(of).collect()
}

/// The contact radius at which the points of a retraction begin, according to the first guesses.
fn begun(
    preset: &Preset,
    branches: &Branches,
    attached: &[&MeasuredPoint],
    offset: f64,
) -> Result<Start, FitError> {
    let first = &attached[..TURN.min(attached.len())];
    let middle = |of: fn(&MeasuredPoint) -> f64| {
        median(first.iter().map(|point| of(point)).collect()).unwrap_or(f64::NAN)
    };
    let seen = middle(|point| point.radius);
    let start = if seen.is_finite() && branches.abscissa != Abscissa::Radius {
        Some(seen)
    } else {
        let x = middle(|point| point.x) - offset;
        begins(preset, branches.abscissa, x, branches.ranges[0])
    };
    start.filter(|start| *start > 0.0).map(Start::ContactRadius).ok_or(FitError::NoStart)
}

/// The points that are fitted.
fn data(branches: &Branches) -> Vec<Datum> {
    let mut data = Vec::new();
    for (number, branch) in branches.list.iter().enumerate() {
        for (free, points) in [(false, &branch.attached), (true, &branch.free)] {
            let datum = |&point: &MeasuredPoint| Datum {
                point,
                segment: branch.segment,
                branch: number,
                free,
                noise: [1.0; 2],
                bias: 0.0,
            };
            data.extend(points.iter().map(datum));
        }
    }
    data
}

/// Whether there are enough points in contact for the parameters, of which some are `known` before.
fn are_enough(data: &[Datum], parameters: usize, known: usize) -> Result<(), FitError> {
    let points = data.iter().filter(|datum| !datum.free).count();
    // What is known before takes the place of points.
    let needed = PER_PARAMETER * (parameters - known).max(2);
    if points < needed { Err(FitError::Few { points, parameters, needed }) } else { Ok(()) }
}

/// The work of adhesion that a closing edge gains.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Closing {
    /// That of an opening edge.
    Same,
    /// One that is given.
    Given(f64),
    /// One that is fitted.
    Free,
}

impl Closing {
    /// What the work of adhesion belongs to, if `target` is one.
    fn of(self, target: Target) -> Target {
        match target {
            Target::Key(key) if key == CLOSING_ADHESION => Target::Adhesion(Segment::Approach),
            Target::Key(key) if key == ADHESION && self != Self::Same => {
                Target::Adhesion(Segment::Retraction)
            }
            target => target,
        }
    }
}

/// Whether approach and retraction have works of adhesion of their own.
///
/// # Errors
/// [`FitError::Key`] where that of the approach is asked for and nothing shows it.
fn closing(
    preset: &Preset,
    branches: &Branches,
    options: &Options,
    notes: &mut Vec<String>,
) -> Result<Closing, FitError> {
    let has = |segment| branches.list.iter().any(|branch| branch.segment == segment);
    let retracts = has(Segment::Retraction);
    let is_loop = has(Segment::Approach) && retracts;
    let named = options.free.iter().map(|name| target(preset, branches.abscissa, name));
    let mut targets = named.collect::<Result<Vec<_>, _>>()?;
    if !options.free.is_empty() {
        let known = uncertain(preset, branches.abscissa, &preset.data.uncertain)?;
        targets.extend(known.into_iter().map(|known| known.target));
    }
    let has_law = has_rate(preset) || targets.iter().any(|target| target.key().starts_with("edge."));
    if !targets.contains(&Target::Key(CLOSING_ADHESION.to_owned())) {
        let given = preset.edge.closing_work_of_adhesion;
        if given.is_some() && !retracts {
            notes.push(format!(
                "{CLOSING_ADHESION} plays no part, as there is no retraction: the work of adhesion is that of the approach"
            ));
        }
        // A retraction alone may begin with a pinned edge too.
        return Ok(given.filter(|_| retracts && !has_law).map_or(Closing::Same, Closing::Given));
    }
    let refused = |why: &str| Err(FitError::Key { key: CLOSING_ADHESION.to_owned(), why: why.to_owned() });
    if has_law {
        return refused(
            "plays no part in a pull at a rate, which is fitted to the retraction alone: without path.rate and free keys of edge, \
             equilibria are fitted",
        );
    }
    if !is_loop {
        return refused("needs both an approach and a retraction");
    }
    Ok(Closing::Free)
}

/// What is free, according to what is asked for.
fn targets(
    preset: &Preset,
    branches: &Branches,
    (options, closing): (&Options, Closing),
) -> Result<Vec<Target>, FitError> {
    let mut targets: Vec<Target> = Vec::new();
    for name in &options.free {
        let target = closing.of(target(preset, branches.abscissa, name)?);
        if !targets.contains(&target) {
            targets.push(target);
        }
    }
    Ok(targets)
}

/// What is known of values before, where a fit is asked for.
fn known(
    preset: &Preset,
    branches: &Branches,
    (options, closing): (&Options, Closing),
) -> Result<Vec<Uncertain>, FitError> {
    if options.free.is_empty() {
        return Ok(Vec::new());
    }
    let known = uncertain(preset, branches.abscissa, &preset.data.uncertain)?;
    Ok(known.into_iter().map(|known| known.with_target(|target| closing.of(target))).collect())
}

/// Where the values between model and instrument start. A baseline that the points show is free too. So is one
/// that no rows show, within what a tare may be off, unless it `is_known` before with an error of its own.
fn instrument(
    preset: &Preset,
    branches: &Branches,
    options: &Options,
    (targets, is_known): (&mut Vec<Target>, bool),
    notes: &mut Vec<String>,
) -> Instrument {
    let given = &preset.data;
    let mut instrument = given.instrument(branches);
    let is_asked = !options.free.is_empty();
    let is_free = targets.contains(&Target::Baseline);
    let why = match branches.baseline {
        Some(found) if is_asked || given.baseline.is_none() => {
            // A baseline that an earlier fit has left says less than the points.
            instrument.baseline = found;
            let unless = if given.baseline.is_some() { ": the value given is not used" } else { "" };
            (!is_free).then(|| format!("since there is a free part{unless}"))
        }
        None if !is_known && (is_free || is_asked && given.baseline.is_none()) => {
            let off = said(&preset.units, Quantity::Force, branches.tare());
            Some(format!("known to within {off} beforehand, since there is no free part"))
        }
        _ => None,
    };
    if let Some(why) = why {
        notes.push(format!("data.baseline is fitted{}, {why}", if is_free { "" } else { " too" }));
        if !is_free {
            targets.push(Target::Baseline);
        }
    }
    instrument
}

/// What is known of a baseline that no rows show.
fn of_baseline(given: &DataSpec, branches: &Branches, parameters: &[FreeParameter]) -> Option<Prior> {
    let at = parameters.iter().position(|parameter| parameter.target == Target::Baseline);
    let unseen = branches.baseline.is_none().then_some(at).flatten();
    unseen.map(|parameter| {
        let inner = |value| parameters[parameter].inner(value);
        let mean = inner(given.baseline.unwrap_or(0.0));
        Prior { parameter, mean, sigma: inner(branches.tare()) }
    })
}

/// What the paths must reach.
fn reach(branches: &Branches, data: &[Datum]) -> Reach {
    let most = |of: fn(&Datum) -> f64| {
        data.iter().map(of).filter(|x| x.is_finite()).fold(f64::NEG_INFINITY, f64::max)
    };
    let of_radius = branches.abscissa == Abscissa::Radius;
    let radius = if of_radius { most(|datum| datum.point.x) } else { most(|datum| datum.point.radius) };
    let most = [most(|datum| datum.point.x), most(|datum| datum.point.force), radius];
    // The retraction, from its largest x down.
    let last = branches.list.iter().rfind(|branch| !branch.attached.is_empty());
    let first = last.map_or(&[][..], |branch| &branch.attached[..TURN.min(branch.attached.len())]);
    let middle = |of: fn(&MeasuredPoint) -> f64| median(first.iter().map(of).collect()).unwrap_or(f64::NAN);
    let turn = [middle(|point| point.x), middle(|point| point.force)];
    Reach { most, turn, radius: None, length: branches.ranges[0], noise: 0.0 }
}

/// A parameter at its start.
fn parameter(preset: &Preset, branches: &Branches, instrument: &Instrument, target: Target) -> FreeParameter {
    let value = |key: &str| match preset.get(key) {
        Some(Value::Number(value)) => value,
        _ => f64::NAN,
    };
    let [x, force, _] = branches.ranges.map(|range| range.max(LEAST_UNIT));
    let in_file = instrument.turned(branches.turned);
    let (start, scale) = match &target {
        Target::Key(key) => (value(key), None),
        Target::Adhesion(segment) => {
            let given = preset.edge.closing_work_of_adhesion.filter(|_| *segment == Segment::Approach);
            (given.unwrap_or_else(|| value(ADHESION)), None)
        }
        Target::Offset => (in_file.offset, Some(x)),
        Target::Baseline => (in_file.baseline, Some(force)),
        Target::Tilt => (in_file.tilt, Some(force / x)),
    };
    FreeParameter { target, start, scale }
}
