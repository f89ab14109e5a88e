//! Fits in the direction in which the columns run. Where the points leave two directions in doubt, both are fitted and
//! the better one is taken.

use super::judge::BRANCHES;
use super::options::{FitError, Options};
use super::outcome::Fit;
use super::problem::START;
use super::pulled::is_pulled;
use super::run::fit_branches;
use super::verdict::{Reason, Verdict};
use crate::gap::Gap;
use crate::measured::asked::FreePart;
use crate::measured::asked::signs_text;
use crate::measured::points::Turned;
use crate::measured::{Asked, Branches, Points};
use crate::preset::data::{COLUMNS, FREE_PART, SIGNS};
use crate::preset::edge::CLOSING_ADHESION;
use crate::preset::{OtherReading, Preset};
use crate::progress::{Progress, ProgressPart};
use crate::text::counted;
use crate::units::Quantity;
use crate::units::number::{said, short};

/// A direction is the better one if its χ² is smaller by this much.
const CLEAR: f64 = 20.0;

/// More rows than this are apart: on no wave does the force stay the same for so long.
const FEW_APART: usize = 20;

/// Rows whose force is off the zero of the instrument by no more than this share of the largest pull are at that zero.
const AT_ZERO: f64 = 0.02;

/// Fits the free keys of `preset` to its own measured curve, as [`fit`] does.
///
/// ```
/// use pulloff_engine::fit::{Options, Verdict, fit_own};
/// use pulloff_engine::{Unwatched, preset};
///
/// let lens = preset::read_shipped("lens").ok_or("no such preset")?;
/// let free = lens.data.free().map(str::to_owned).collect();
/// let fit = fit_own(&lens, &Options { free, ..Options::default() }, &Unwatched)?;
/// assert_eq!(fit.verdict, Verdict::Describes);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`FitError`].
pub fn fit_own(preset: &Preset, options: &Options, progress: &dyn Progress) -> Result<Fit, FitError> {
    /// χ² per degree of freedom.
    const FAR: f64 = 100.0;
    let (points, asked) = seen(preset, options)?;
    let other = preset.other_reading().map_err(FitError::Data)?;
    let share = if other.is_some() { 0.5 } else { 1.0 };
    let own = ProgressPart::new(progress, [0.0, share]);
    let mut found = fit(preset, &points, &Options { asked, ..options.clone() }, &own)?;
    // Of a heading that says what x is, the other reading is tried only far from the points.
    let is_far = found.chi_squared > FAR && !found.reasons.is_empty();
    let is_tried = |other: &OtherReading| match found.verdict {
        Verdict::Describes => false,
        Verdict::DoesNotDescribe => other.is_doubtful || is_far,
        Verdict::NotDetermined | Verdict::NotConverged => is_far,
    };
    if let Some(other) = other.filter(is_tried) {
        let progress = ProgressPart::new(progress, [share, 1.0]);
        let reason = of_reading(preset, &other, (options, &found), &progress);
        let at = if other.is_doubtful { 0 } else { found.reasons.len() };
        found.reasons.splice(at..at, reason);
    }
    found.notes.splice(0..0, preset.notes_of_reading().map_err(FitError::Data)?);
    Ok(found)
}

/// That x of a fit that does not describe the points may be a position, and whether it is described if it is; of a heading that
/// leaves nothing open only if it is, or nearly.
fn of_reading(
    preset: &Preset,
    OtherReading { x, is_doubtful, meanings: [read_as, other], columns }: &OtherReading,
    (options, own): (&Options, &Fit),
    progress: &dyn Progress,
) -> Option<Reason> {
    /// By how much chi squared is smaller where a heading that leaves nothing open may still be wrong.
    const NEARER: f64 = 0.01;
    let mut preset = preset.clone();
    let options = options.without_intervals();
    let set = preset.set(COLUMNS, columns.as_str().into());
    let found = set.ok().and_then(|()| fit_own(&preset, &options, progress).ok());
    let is_described = found.as_ref().is_some_and(|found| found.verdict == Verdict::Describes);
    let is_nearer = found.as_ref().is_some_and(|found| found.chi_squared < NEARER * own.chi_squared);
    if !is_doubtful && !is_described && !is_nearer {
        return None;
    }
    let chi = |fit: &Fit| short(fit.chi_squared, 4);
    let outcome = match &found {
        _ if is_described => "As that, the model describes it".to_owned(),
        Some(found) => format!(
            "As that, the model does not describe it either: chi squared per degree of freedom is {} instead of {}",
            chi(found),
            chi(own)
        ),
        None => "As that, there is no fit".to_owned(),
    };
    let sentence = format!(
        "{x} is read as the {read_as} and may be the {other}: --columns or data.columns {columns}. {outcome}"
    );
    Some(Reason { kind: "columns", sentence, value: found.map(|found| found.chi_squared) })
}

/// The points of a preset's own measured curve, and which of them are used.
fn seen(preset: &Preset, options: &Options) -> Result<(Points, Asked), FitError> {
    let (source, reading) = (preset.data.source.as_ref().ok_or(FitError::NoData)?, preset.reading());
    let points = source.points(&reading).map_err(FitError::Data)?;
    let said = source.asked(&reading).map_err(FitError::Data)?;
    let asked = Asked {
        segment: said.segment,
        skip: said.skip,
        free: said.free,
        turned: said.turned,
        ..options.asked
    };
    Ok((points, asked))
}

/// Its branches.
pub(super) fn branches_of(preset: &Preset, options: &Options) -> Result<Branches, FitError> {
    let (points, asked) = seen(preset, options)?;
    let mut branches = points.branches(&asked)?;
    branches.notes.extend(branches.doubt());
    branches.notes.splice(0..0, preset.notes_of_reading().map_err(FitError::Data)?);
    Ok(branches)
}

/// Fits the free keys of `preset` to `points`; they may include its device and what lies between it and the instrument.
/// Where `progress` says stop, the best fit so far is returned.
///
/// # Errors
/// [`FitError`].
pub fn fit(
    preset: &Preset,
    points: &Points,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Fit, FitError> {
    let may_be_twice = preset.gap.feature_length().is_some() && options.asked.free == FreePart::Found;
    let share = if may_be_twice { 0.5 } else { 1.0 };
    let mut found = directed(preset, points, options, &ProgressPart::new(progress, [0.0, share]));
    let rest = ProgressPart::new(progress, [share, 1.0]);
    let mut found = match of_all_in_contact(preset, points, (options, &mut found), &rest) {
        Some(found) => found,
        None => found?,
    };
    found.warnings.extend(options.asked.idle_ranges(points, &preset.units));
    let Some(at) = found.reasons.iter().position(|reason| reason.kind == BRANCHES) else {
        found.reasons.splice(0..0, of_pinned_edge(preset, points, (options, &found), progress));
        return Ok(found);
    };
    // Whatever the model lacks, two works of adhesion describe it a little better: only a fit shows that they are it.
    let mut apart = options.without_intervals();
    apart.free.push(CLOSING_ADHESION.to_owned());
    if let Ok(apart) = directed(preset, points, &apart, &ProgressPart::new(progress, [1.0, 1.0])) {
        let mut reason = found.reasons.remove(at);
        let is_described = apart.verdict == Verdict::Describes;
        reason.sentence += if is_described {
            ". With that, the model describes them"
        } else {
            ". Even with that, the model does not describe them"
        };
        found.reasons.insert(if is_described { 0 } else { at }, reason);
    }
    Ok(found)
}

/// How many rows of `branches` look apart, where they may as well be in contact on the last wave.
fn may_be_on_a_wave(preset: &Preset, branches: &Branches) -> Option<usize> {
    let is_open = preset.gap.feature_length().is_some() && preset.data.free_part.is_empty();
    let apart: usize = branches.list.iter().map(|branch| branch.free.len()).sum();
    (is_open && (1..=FEW_APART).contains(&apart)).then_some(apart)
}

/// A sentence on rows of the curve of `preset` that look apart, where they may as well be in contact on the last wave.
pub fn doubt_of_wave(preset: &Preset, branches: &Branches) -> Option<String> {
    let apart = may_be_on_a_wave(preset, branches)?;
    let level = branches.baseline?;
    let zero = preset.data.baseline.unwrap_or(0.0) * if branches.turned[1] { -1.0 } else { 1.0 };
    let is_at_zero = (level - zero).abs() < AT_ZERO * (level - least_force(branches));
    // Radii show it, too.
    let is_seen = branches.list.iter().flat_map(|branch| &branch.free).any(|point| point.radius == 0.0);
    (!is_at_zero && !is_seen).then(|| {
        format!(
            "{} taken to be apart, at zero force, may be in contact on the last wave: a fit tries both, and \
             data.free_part = none says that they are",
            counted(apart, "row")
        )
    })
}

/// The least force of the rows in contact.
fn least_force(branches: &Branches) -> f64 {
    let attached = branches.list.iter().flat_map(|branch| &branch.attached);
    attached.map(|point| point.force).fold(f64::INFINITY, f64::min)
}

/// `preset` with all rows of its curve in contact, where few look apart on waves and its own fit finds that they are not.
pub(super) fn with_contact(preset: &Preset, options: &Options, progress: &dyn Progress) -> Preset {
    let alone = || {
        may_be_on_a_wave(preset, &branches_of(preset, options).ok()?)?;
        let found = fit_own(preset, &options.without_intervals(), progress).ok()?;
        let free_part = &found.preset.data.free_part;
        if found.verdict != Verdict::Describes || *free_part == preset.data.free_part {
            return None;
        }
        let mut with = preset.clone();
        with.set(SIGNS, signs_text(found.turned).as_str().into()).ok()?;
        with.set(FREE_PART, free_part.as_str().into()).ok()?;
        Some(with)
    };
    alone().unwrap_or_else(|| preset.clone())
}

/// The fit with all rows in contact, where only that describes them, or better: on waves a record that ends in contact may look as
/// if it ended apart. Where both describe the points as well, with other values, those of `own` are not determined.
fn of_all_in_contact(
    preset: &Preset,
    points: &Points,
    (options, own): (&Options, &mut Result<Fit, FitError>),
    progress: &dyn Progress,
) -> Option<Fit> {
    /// By how much χ² is smaller where that tells one from the other.
    const TELLS: f64 = 6.0;
    /// A fit that describes its points with a larger χ² per degree of freedom leaves much of them to outliers.
    const LARGE: f64 = 2.0;
    let turned = match own {
        Ok(own) => Some(own.turned),
        Err(FitError::NoStart) => None,
        Err(_) => return None,
    };
    let own = own.as_mut().ok().filter(|own| own.verdict == Verdict::Describes);
    let is_found = options.asked.free == FreePart::Found && preset.gap.feature_length().is_some();
    if !is_found || progress.stop() {
        return None;
    }
    let branches = points.branches(&options.asked).ok()?;
    let apart: usize = branches.list.iter().map(|branch| branch.free.len()).sum();
    // More rows than a wave has, or rows at the zero of the force, are apart. A tare is no measure: it is a share of the largest
    // force, which may be a preload.
    let least = least_force(&branches);
    let is_apart = |own: &Fit| {
        let off = own.instrument.baseline - preset.data.baseline.unwrap_or(0.0);
        // The points have the signs of the model.
        let pull = own.instrument.turned(own.turned).baseline - least;
        let is_at_zero = off.abs() < AT_ZERO * pull;
        own.chi_squared < LARGE && (apart > FEW_APART || is_at_zero)
    };
    if apart == 0 || own.as_ref().is_some_and(|own| is_apart(own)) {
        return None;
    }
    // σ of the force differs from fit to fit.
    let misfit = |fit: &Fit| chi_squared(fit) * fit.noise.sigma[1].powi(2);
    let least = own.as_ref().map(|own| (misfit(own), own.noise.sigma[1].powi(2)));
    let mut alike: Option<Fit> = None;
    let mut is_better = |quick: &Fit| {
        let is_better = least.is_none_or(|(own, unit)| misfit(quick) < own - TELLS * unit);
        let is_alike = least.is_some_and(|(own, unit)| misfit(quick) < own + TELLS * unit);
        let is_described = quick.verdict == Verdict::Describes;
        if is_described && is_alike && !is_better {
            alike = Some(quick.clone());
        }
        is_described && is_better
    };
    // The jump that told which way the columns run is one between waves now.
    let given = options.asked.turned;
    let again = (given.is_none() && turned.is_some()).then_some(None);
    let found = [given.or(turned)].into_iter().chain(again).find_map(|turned| {
        let asked = Asked { free: FreePart::None, turned, ..options.asked };
        let options = Options { asked, ..options.clone() };
        let quick = directed(preset, points, &options.without_intervals(), progress);
        let quick = quick.ok().filter(&mut is_better);
        quick.and_then(|_| directed(preset, points, &options, progress).ok())
    });
    let (rows, are) = (counted(apart, "row"), if apart == 1 { "is" } else { "are" });
    if let (None, Some(alike), Some(own)) = (&found, alike, own) {
        own.is_told_from(
            &alike,
            &format!("the {rows} that {are} taken to be apart may be in contact (--free-part none)"),
        );
    }
    let mut found = found?;
    found.preset.set(FREE_PART, "none".into()).ok()?;
    found.notes.push(format!(
        "{rows} that may look apart {are} in contact, since the model describes the points only then, or better then: data.free_part \
         is none"
    ));
    Some(found)
}

/// That a retraction alone, which the model does not describe, begins within a dead band, if it is described then.
fn of_pinned_edge(
    preset: &Preset,
    points: &Points,
    (options, own): (&Options, &Fit),
    progress: &dyn Progress,
) -> Option<Reason> {
    /// What the closing edge is taken to gain, over γ: the less, the longer the line on which the first rows may lie.
    const LEAST: f64 = 1e-6;
    let has_closing = preset.edge.closing_work_of_adhesion.is_some();
    let alone = own.rows.approach.contact == 0;
    if own.verdict != Verdict::DoesNotDescribe || is_pulled(&own.preset) || has_closing || !alone {
        return None;
    }
    let mut pinned = preset.clone();
    pinned.set(CLOSING_ADHESION, (LEAST * pinned.material.work_of_adhesion).into()).ok()?;
    let options = options.without_intervals();
    let found = directed(&pinned, points, &options, &ProgressPart::new(progress, [1.0, 1.0])).ok()?;
    let start = found.parameters.iter().find(|parameter| parameter.key == START)?.value;
    (found.verdict == Verdict::Describes).then(|| {
        let sentence = format!(
            "the first rows lie on the straight line of an edge that rests at s = {}: set {CLOSING_ADHESION}, to a very small \
             value if it is not known. With that, the model describes the points",
            said(&preset.units, Quantity::Length, start)
        );
        Reason { kind: "dead-band", sentence, value: Some(found.chi_squared) }
    })
}

/// The fit in the direction in which the columns run.
fn directed(
    preset: &Preset,
    points: &Points,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Fit, FitError> {
    if options.free.is_empty() {
        return Err(FitError::NothingFree);
    }
    let branches = points.branches(&options.asked)?;
    let Some(other) = branches.or else { return fit_branches(preset, &branches, options, progress) };
    let first = fit_branches(preset, &branches, options, &ProgressPart::new(progress, [0.0, 0.3]));
    let turned = |options: Options, progress: &ProgressPart| {
        let asked = Asked { turned: Some(other), ..options.asked };
        let branches = Branches { looks_swapped: branches.looks_swapped, ..points.branches(&asked)? };
        fit_branches(preset, &branches, &Options { asked, ..options }, progress)
    };
    let whole = || turned(options.clone(), &ProgressPart::new(progress, [0.6, 1.0]));
    // The second is judged by the noise of the first.
    let mut quick = options.without_intervals();
    if let Ok(Fit { noise, .. }) = &first {
        quick.asked.sigma = noise.sigma.map(|sigma| Some(sigma).filter(|sigma| *sigma > 0.0));
        quick.asked.share = Some(noise.share);
    }
    let second = turned(quick, &ProgressPart::new(progress, [0.3, 0.6]));
    let alone = |mut fit: Fit, why: &FitError, [taken, left]: [Turned; 2]| {
        fit.notes.push(format!(
            "the points leave it open which way their columns run: {} is taken, as there is no fit with {} ({why}). \
             Set --signs or data.signs",
            signs_text(taken),
            signs_text(left),
        ));
        fit
    };
    let (mut first, second) = match (first, second) {
        (Ok(first), Ok(second)) => (first, second),
        (Ok(first), Err(why)) => return Ok(alone(first, &why, [branches.turned, other])),
        (Err(error), Err(_)) => return Err(error),
        (Err(why), Ok(_)) => return Ok(alone(whole()?, &why, [other, branches.turned])),
    };
    // Signs as in the file stay where they lead to a fit.
    if branches.is_as_in_file && first.verdict == Verdict::Describes {
        if second.verdict == Verdict::Describes {
            first.warnings.push(format!(
                "the points are described with {} and with {} as well: the values hold for the first, which is that of the \
                 file. Set --signs or data.signs",
                signs_text(branches.turned),
                signs_text(other),
            ));
        }
        return Ok(first);
    }
    let [here, there] = [&first, &second].map(chi_squared);
    let [taken, left] = if here <= there { [branches.turned, other] } else { [other, branches.turned] };
    if branches.is_as_in_file && here <= there + CLEAR {
        return Ok(first);
    }
    if (here - there).abs() <= CLEAR {
        return Err(FitError::Direction { one: signs_text(taken), other: signs_text(left) });
    }
    let mut found = if here < there { first } else { whole()? };
    found.notes.push(format!(
        "which way the columns run shows only in the fit: with {} chi squared is {}, with {} it is {}. \
         --signs or data.signs sets it",
        signs_text(taken),
        short(here.min(there), 4),
        signs_text(left),
        short(here.max(there), 4)
    ));
    Ok(found)
}

/// Σr² of the rows that are fitted.
fn chi_squared(fit: &Fit) -> f64 {
    let [contact, all] = [fit.rows.contact(), fit.rows.fitted()];
    let of = |part: usize, rows: usize| fit.chi_squared_of[part].unwrap_or(0.0) * rows as f64;
    of(0, contact) + of(1, all - contact)
}
