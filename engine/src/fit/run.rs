//! A whole fit, in order: branches, start, minimum, errors, doubts.

use super::approached::Approached;
use super::bias::of_bias;
use super::determined::{Determined, determined};
use super::fitted::{Fitted, too_small, unmoved, values};
use super::intervals::intervals;
use super::judge::{
    Evidence, doubts, extent, of_drift, of_first_pull, of_hidden, of_sparse, of_spring, of_unclear, reasons,
    unseen, untried,
};
use super::laid::laid;
use super::least_squares::Ending;
use super::options::{FitError, Options, letter};
use super::outcome::Fit;
use super::pose::posed;
use super::prior::Prior;
use super::problem::{ADHESION, FitProblem, FreeParameter, Paths, Target};
use super::pulled::is_pulled;
use super::residuals::{beside, of_part, without_outliers};
use super::rows::Rows;
use super::scatter::Scatter;
use super::settled::{
    self, beyond_snaps, last, nearest, of_correlated, of_tare, pinned_again, unpinned, unseen_start,
    within_range,
};
use super::shown::{KnownNoise, of_shown_noise};
use super::solve::{SolvedFit, solve};
use super::start::{REACHED, Tried, start};
use super::uncertain::given;
use super::verdict::{Reason, Verdict};
use crate::elementary::{ln, pow};
use crate::gap::Gap;
use crate::measured::branches::FLOOR;
use crate::measured::{Abscissa, Branches, FreePart, Noise, Origin, Segment};
use crate::preset::{Preset, edge};
use crate::problem::Start;
use crate::progress::{Progress, ProgressPart};
use crate::units::number::{said, short, significant};
use crate::units::{Quantity, UnitSystem};
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// Fits the free keys of `preset` to `branches`.
pub(super) fn fit_branches(
    preset: &Preset,
    branches: &Branches,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Fit, FitError> {
    let mut posed = Posed::new(preset, branches, options, progress)?;
    let Posed { problem, solved, .. } = &posed;
    let scatter = problem.scatter(solved);
    let what = determined(problem, solved, &scatter, options.robust);
    if what.errors.is_some() {
        let progress = ProgressPart::new(progress, [0.95, 1.0]);
        let is_of_deflection = preset.is_of_deflection();
        let of_spring = of_spring(problem, solved, is_of_deflection, (options.robust, &progress));
        posed.notes.extend(of_spring);
    }
    posed.fit(what, scatter, true, progress)
}

/// What is fitted to the branches of one file, where its starts ended, and its minimum.
#[derive(Clone)]
pub(super) struct Posed<'a> {
    preset: &'a Preset,
    branches: Cow<'a, Branches>,
    options: &'a Options,
    pub(super) problem: FitProblem,
    starts: Vec<Tried>,
    pub(super) solved: SolvedFit,
    /// Other values, as far as the rows do not tell them from these.
    alike: Vec<Vec<f64>>,
    notes: Vec<String>,
    /// The approach before a pull of which all rows are used.
    approached: Option<Approached>,
}

impl<'a> Posed<'a> {
    /// Poses and solves the fit of the free keys of `preset` to `branches`, without a last row or two behind a jump if the curve
    /// through the others leads nowhere near them, or only with a zero of the force that they lift.
    pub(super) fn new(
        preset: &'a Preset,
        branches: &'a Branches,
        options: &'a Options,
        progress: &dyn Progress,
    ) -> Result<Self, FitError> {
        /// Rows cost more than this, in squares of the scale of the residuals, where the curve misses them.
        const MISSED: f64 = 8.0;
        let fewer = branches.without_last().filter(|_| options.asked.free == FreePart::Found);
        let Some(fewer) = fewer else { return Self::of(preset, Cow::Borrowed(branches), options, progress) };
        let [all, fewer] = [(Cow::Borrowed(branches), [0.0, 0.4]), (Cow::Owned(fewer), [0.4, 0.8])]
            .map(|(branches, part)| Self::of(preset, branches, options, &ProgressPart::new(progress, part)));
        // σ of the force differs from fit to fit.
        let cost = |posed: &Self, cost: f64| cost * posed.problem.sigma[1].powi(2);
        let is_missed = |all: &Self, fewer: &Self| {
            let most = fewer.solved.minimum.cost + MISSED * fewer.solved.scale.powi(2);
            cost(all, all.solved.minimum.cost) > cost(fewer, most) || all.is_lifted() && !fewer.is_lifted()
        };
        match (all, fewer) {
            (Ok(all), Ok(fewer)) if !is_missed(&all, &fewer) => Ok(all),
            (_, Ok(fewer)) => Ok(fewer),
            (all, Err(_)) => all,
        }
    }

    /// Whether the zero of the force lies high above zero, where no rows show it. Rows apart that count as contact lift it by a
    /// third of the largest pull: the jump under fixed grips then looks like the last rise of a contact.
    fn is_lifted(&self) -> bool {
        /// As a share of the largest pull. A tare is no measure: it is a share of the largest force, which may be a preload.
        const LIFTED: f64 = 0.25;
        let baseline = self.problem.instrument_at(&self.solved.minimum.parameters).baseline;
        let forces = self.branches.list.iter().flat_map(|branch| &branch.attached).map(|point| point.force);
        baseline > LIFTED * (baseline - forces.fold(f64::INFINITY, f64::min))
    }

    /// The same, with all rows that `branches` have.
    fn of(
        preset: &'a Preset,
        branches: Cow<'a, Branches>,
        options: &'a Options,
        progress: &dyn Progress,
    ) -> Result<Self, FitError> {
        let mut notes = branches.notes.clone();
        let mut problem = posed(preset, &branches, options, &mut notes)?;
        // Without rows apart, neighbours tell how well the force is known, never the residuals themselves.
        let of_neighbours = branches.noise.from[1] == Origin::Neighbours;
        // For radii, only the slope of the curve tells the noise of x and of P apart.
        let of_both = branches.abscissa == Abscissa::Radius && branches.noise.from[0] == Origin::Assumed;
        let least = of_neighbours
            .then_some([if of_both { problem.sigma[0] } else { f64::INFINITY }, FLOOR * branches.ranges[1]]);
        // A fit that begins without noise of the radius ends far off, where the path is steep in it.
        if let (true, Some([of_radius, of_force])) = (of_both && of_neighbours, branches.noise_in_order()) {
            problem.sigma[0] = of_radius.max(problem.sigma[0]);
            problem.sigma[1] = of_force.max(FLOOR * branches.ranges[1]);
        }
        let part = ProgressPart::new(progress, [0.8, 0.85]);
        let solve = |problem: &mut FitProblem, u: &[f64]| last(problem, u, options.robust, least, &part);
        let found = |problem: &mut FitProblem| -> Result<_, FitError> {
            let ends = start(problem, options.scan, options.robust, &ProgressPart::new(progress, [0.0, 0.8]))
                .ok_or_else(|| FitError::no_start(&problem.preset))?;
            let solved = solve(problem, &ends.best)?;
            let (solved, alike) = nearest(problem, solved, &ends.others, options.robust, &part);
            Ok((ends.tried, within_range(problem, solved, options.robust, &part), alike))
        };
        let (mut starts, mut solved, mut alike) = found(&mut problem)?;
        if let Some(why) = problem.overlapping(&solved.minimum.parameters) {
            problem = problem.without_loading(why, &mut notes)?;
            (starts, solved, alike) = found(&mut problem)?;
        }
        let approached;
        (problem, solved, approached) = of_start(problem, solved, (&branches, options), &mut notes, &solve)?;
        let has_snaps =
            |paths: &Paths| [Segment::Approach, Segment::Retraction].iter().any(|of| paths.of(*of).snaps > 0);
        // A row that changes its side of a line on which the edge is pinned has a minimum of its own, too.
        if problem.pins() || problem.paths(&solved.minimum.parameters).is_some_and(|paths| has_snaps(&paths))
        {
            solved = beyond_snaps(&problem, solved, options.robust, progress);
        }
        let [of_way, of_force, _] = branches.noise.from;
        let known = KnownNoise {
            share: options.asked.share,
            from: [of_way, of_force],
            range: branches.ranges[1],
            abscissa: branches.abscissa,
        };
        solved = of_shown_noise(&mut problem, solved, options.robust, known, (&mut notes, progress));
        solved = of_bias(&mut problem, solved, options.robust, (&mut notes, progress));
        if branches.noise.from[1] == Origin::Apart {
            solved = of_correlated(&mut problem, solved, options.robust, progress);
        }
        if preset.data.uncertain.is_empty() {
            solved = of_tare(&mut problem, solved, options.robust, (&mut notes, progress));
        }
        // Other minima were told from the first one before the noise had settled.
        alike.retain(|u| u.len() == solved.minimum.parameters.len());
        if !alike.is_empty() {
            (solved, alike) = nearest(&problem, solved, &alike, options.robust, progress);
        }
        notes.extend(of_no_free_part(&problem, &branches));
        Ok(Self { preset, branches, options, problem, starts, solved, alike, notes, approached })
    }

    /// Leaves out the rows in which the edge still closes after a fast approach, if under a law that other curves determine, too,
    /// where its values are `under`, they contradict an edge that rests. Says whether it did.
    pub(super) fn leaves_out_closing(&mut self, under: &SolvedFit, progress: &dyn Progress) -> bool {
        let u = &under.minimum.parameters;
        let seen = |approached: &Approached| approached.seen(&self.problem, u, under.scale);
        let left = self.approached.as_ref().and_then(seen);
        let solve =
            |left: FitProblem| Some((solve(&left, u, self.options.robust, settled::ROUNDS, progress)?, left));
        let Some((solved, left)) = left.and_then(solve) else { return false };
        let rows = self.problem.data.len() - left.data.len();
        self.notes.extend(self.approached.take().map(|approached| approached.note(&left, rows)));
        (self.problem, self.solved) = (left, solved);
        true
    }

    /// The fit, where `what` is determined by its points `alone` or by others too.
    pub(super) fn fit(
        self,
        mut what: Determined,
        scatter: Scatter,
        alone: bool,
        progress: &dyn Progress,
    ) -> Result<Fit, FitError> {
        let Self { preset, branches, options, problem, starts, solved, alike, mut notes, approached } = self;
        let branches = &*branches;
        let u = &solved.minimum.parameters;
        let is_unseen;
        (what, is_unseen) = with_range(&problem, &solved, (what, &scatter), options.robust, progress);
        if let Some(direction) = of_alike(&problem, u, &alike, &what).filter(|_| alone) {
            what = what.without_errors(direction);
        }
        let priors = given(&problem, &what.shares, &mut notes);
        let real = problem.real(&solved.minimum.at.residuals);
        let rows = real.len() as f64 / scatter.correlation.rows();
        let degrees = match &what.degrees {
            Some(degrees) => degrees.min(),
            None => (rows - problem.taken() as f64).max(1.0),
        };
        let mut fitted = values(&problem, u, what.errors.as_ref().zip(what.degrees.as_ref()));
        let bootstrapped = match &what.errors {
            Some(errors) if alone => {
                let progress = ProgressPart::new(progress, [0.85, 0.95]);
                intervals(&problem, &solved, options, (errors, degrees), &mut fitted, &progress)
            }
            _ => None,
        };
        let found = problem.preset_at(u, Segment::Retraction).ok_or(FitError::NoStart)?;
        let ending = ended(solved.minimum.ending, is_unseen, progress);
        let evidence =
            Evidence { problem: &problem, solved: &solved, scatter: &scatter, inner: what.inner.as_ref() };
        let mut reasons = reasons(evidence, &found, branches.clipped);
        reasons.extend(of_sparse(branches, preset));
        let verdict = verdict(ending, what.errors.is_some(), &reasons);
        notes.extend(growth(&problem, u, &what, verdict));
        notes.extend(of_starts(&starts, verdict));
        let of_drift = || of_drift(&problem, &solved, options.robust, progress);
        notes.extend((alone && verdict == Verdict::Describes).then(of_drift).flatten());
        notes.extend((verdict == Verdict::DoesNotDescribe).then(|| untried(&problem, &reasons)).flatten());
        let residuals = beside(&problem, &solved.minimum.at.residuals, solved.scale);
        let doubt = approached.and_then(|approached| approached.doubt);
        let warnings = warned(evidence, (preset, branches), &reasons, &mut fitted).into_iter().chain(doubt);
        let closing = problem.preset_at(u, Segment::Approach).map(|preset| preset.material.work_of_adhesion);
        let instrument = problem.instrument_at(u).turned(problem.turned);
        let widest = problem.paths(u).map_or(0.0, |paths| extent(&problem, u, &paths)[0]);
        let fitted_preset = laid(preset, &problem, (&found, closing, &instrument), widest, &mut notes);
        let left = real.len().saturating_sub(problem.taken()).max(1) as f64;
        Ok(Fit {
            verdict,
            reasons,
            abscissa: branches.abscissa,
            correlations: what.correlations.as_ref().map(rows_of),
            chi_squared: real.iter().map(|r| r * r).sum::<f64>() / left,
            chi_squared_without_outliers: without_outliers(&problem, &solved, &residuals),
            chi_squared_of: [false, true].map(|free| of_part(&problem, &solved, free)),
            degrees,
            priors,
            rows: Rows::of(&problem, branches),
            outliers: residuals.iter().filter(|residual| residual.outlier).count(),
            condition: what.condition,
            direction: what.direction,
            ending,
            starts,
            snaps: problem.paths(u).map_or(0, |paths| paths.of(Segment::Retraction).snaps),
            noise: noise_of(&problem, branches),
            bootstrapped,
            turned: branches.turned,
            notes,
            warnings: warnings.collect(),
            scatter,
            preset: fitted_preset,
            instrument,
            residuals,
            parameters: fitted,
        })
    }
}

/// What the points determine, once it is known whether they show a range of adhesion that is free; and whether they do not.
fn with_range(
    problem: &FitProblem,
    solved: &SolvedFit,
    (mut what, scatter): (Determined, &Scatter),
    robust: bool,
    progress: &dyn Progress,
) -> (Determined, bool) {
    if let Some(direction) = unseen(problem, solved, (&what, scatter), robust, progress) {
        return (what.without_errors(direction), true);
    }
    if let Some(direction) = &mut what.direction {
        direction.extend(of_first_pull(problem, solved).map(|said| format!("; {said}")));
    }
    (what, false)
}

/// Values far beyond the errors that the points do not tell from those at `u`.
fn of_alike(problem: &FitProblem, u: &[f64], alike: &[Vec<f64>], what: &Determined) -> Option<String> {
    /// How far, in standard errors.
    const FAR: f64 = 3.0;
    let errors = what.errors.as_ref()?;
    let is_far = |other: &&Vec<f64>| {
        other.len() == u.len() && (0..u.len()).any(|j| (u[j] - other[j]).abs() > FAR * errors[j])
    };
    let other = alike.iter().find(is_far)?;
    let shown = problem.parameters.iter().zip(other).map(|(parameter, at)| {
        let key = parameter.key();
        let value = significant(parameter.value(*at), 4);
        format!("{} = {value}", letter(&problem.preset, &key))
    });
    Some(format!("{} describe the points as well, in base units", shown.collect::<Vec<_>>().join(", ")))
}

/// That no start came near the points, where a fit that has come to its end does not describe them or is not determined.
fn of_starts(starts: &[Tried], verdict: Verdict) -> Option<String> {
    let nearest = starts.iter().map(|start| start.distance).reduce(f64::min)?;
    let is_in_doubt = matches!(verdict, Verdict::DoesNotDescribe | Verdict::NotDetermined);
    (is_in_doubt && nearest > REACHED).then(|| {
        format!(
            "the nearest start ends {} sigma from the points on average: if the model is right, other first guesses may lead nearer \
             (give them with --set)",
            short(nearest, 2)
        )
    })
}

/// How a fit ends whose minimization ended so, and of which one direction may be `unseen`.
fn ended(ending: Ending, unseen: bool, progress: &dyn Progress) -> Ending {
    match ending {
        _ if progress.stop() => Ending::Cancelled,
        // A range that shrinks without end has no minimum.
        Ending::Rounds if unseen => Ending::Converged,
        ending => ending,
    }
}

/// The rows of a matrix.
fn rows_of(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

/// Solves again what depends on where the edge is pinned, or where a pull starts; with the approach before it if all rows of that
/// are used.
fn of_start(
    mut problem: FitProblem,
    mut solved: SolvedFit,
    (branches, options): (&Branches, &Options),
    notes: &mut Vec<String>,
    solve: &impl Fn(&mut FitProblem, &[f64]) -> Result<SolvedFit, FitError>,
) -> Result<(FitProblem, SolvedFit, Option<Approached>), FitError> {
    if problem.pins() {
        (problem, solved) = pinned_again(problem, solved, solve);
    }
    if let Some(j) = unpinned(&problem, &solved) {
        let mut u = solved.minimum.parameters;
        problem = problem.holding(j, u.remove(j)).ok_or(FitError::NoStart)?;
        solved = solve(&mut problem, &u)?;
        notes.push("no rows show that the edge is pinned before it recedes".to_owned());
    }
    let mut approached = Approached::of(&problem, branches, options.asked.x);
    if let Some(before) = approached {
        (problem, solved, approached) = before.settled(problem, solved, notes, solve);
    }
    if let Some(j) = unseen_start(&problem, &solved) {
        (problem, solved) = held_start(&problem, solved, j, solve)?;
        if let Start::ContactRadius(radius) = problem.preset.path.start {
            let at = said(&problem.preset.units, Quantity::Length, radius);
            notes.push(format!(
                "the points do not show at which contact radius the edge started: it is held at {at}"
            ));
        }
    }
    Ok((problem, solved, approached))
}

/// The problem with the contact radius `j`, at which a pull starts, held, and its minimum as `solve` finds it. The edge starts
/// just before the first points, or, where it moves already at the first of them, as far out as it was found.
fn held_start(
    problem: &FitProblem,
    solved: SolvedFit,
    j: usize,
    solve: impl Fn(&mut FitProblem, &[f64]) -> Result<SolvedFit, FitError>,
) -> Result<(FitProblem, SolvedFit), FitError> {
    /// How far before them, as a share of the radius.
    const BEFORE: f64 = 0.05;
    /// A larger cost than this, in squares of the scale of the residuals, shows that the edge moves already.
    const MOVES: f64 = 5.0;
    // σ of the force may change from fit to fit.
    let cost = |problem: &FitProblem, cost: f64| cost * problem.sigma[1].powi(2);
    let mut u = solved.minimum.parameters;
    let free = u[j];
    problem.begun(&mut u);
    let near = u.remove(j) + BEFORE;
    let held = |at: f64| {
        let mut held = problem.holding(j, at).ok_or(FitError::NoStart)?;
        let solved = solve(&mut held, &u)?;
        Ok((held, solved))
    };
    let most = cost(problem, solved.minimum.cost + MOVES * solved.scale.powi(2));
    match held(near) {
        Ok((held, solved)) if cost(&held, solved.minimum.cost) <= most => Ok((held, solved)),
        _ => held(free),
    }
}

/// What is doubtful about a fit, whatever its verdict; values that have not moved are marked among `fitted`.
fn warned(
    evidence: Evidence<'_>,
    (preset, branches): (&Preset, &Branches),
    reasons: &[Reason],
    fitted: &mut [Fitted],
) -> Vec<String> {
    let is_known = [Origin::Given, Origin::Apart].contains(&branches.noise.from[1]);
    let mut warnings = doubts(evidence, fitted, (reasons, is_known));
    warnings.extend(too_small(fitted));
    warnings.extend(unmoved(fitted));
    warnings.extend(of_unclear(branches, fitted));
    warnings.extend(of_hidden(branches, preset));
    warnings.extend(of_wide_tare(evidence.problem, branches));
    warnings.extend(branches.swapped().into_iter().chain(branches.unread()));
    warnings
}

/// That a tare of the force larger than it is assumed to be may come of another minimum, which is so on waves.
fn of_wide_tare(problem: &FitProblem, branches: &Branches) -> Option<String> {
    /// The factor from which it is larger, and not rounded.
    const WIDER: f64 = 1.01;
    let is_of = |prior: &&Prior| problem.parameters[prior.parameter].target == Target::Baseline;
    let has_waves = problem.preset.gap.feature_length().is_some();
    let prior = problem.priors.iter().find(is_of).filter(|_| has_waves && branches.baseline.is_none())?;
    let [_, sigma] = problem.parameters[prior.parameter].given(prior);
    (problem.preset.data.baseline.is_none() && sigma > WIDER * branches.tare()).then(|| {
        "the values hold only if the zero of the force is as far off as data.baseline says: on waves another minimum may be the \
         right one. Give data.baseline if it is known"
            .to_owned()
    })
}

/// What is known of the force where no rows are apart.
fn of_no_free_part(problem: &FitProblem, branches: &Branches) -> Option<String> {
    if branches.baseline.is_some() {
        return None;
    }
    let is_free = problem.parameters.iter().any(|parameter| parameter.target == Target::Baseline);
    let held = if is_free {
        ""
    } else {
        "the baseline is held as given, and its error is not in those of the values; "
    };
    // Too few rows may not show the noise of x, and the baseline then takes up what it does.
    let is_assumed = !problem.space && noise_of(problem, branches).from[0] == Origin::Assumed;
    let unless = if is_assumed && branches.abscissa != Abscissa::Radius {
        "; sigma of x is assumed to be small: if it is not, the errors are larger (`pulloff fit --sigma-x` takes it)"
    } else {
        ""
    };
    let taken = match branches.noise.from[1] {
        Origin::Given => "as given",
        Origin::Assumed => "assumed to be small, as neighbouring rows show none",
        Origin::Apart | Origin::Neighbours => "taken from neighbouring rows",
    };
    Some(format!("there is no free part: {held}sigma of the force is {taken}{unless}"))
}

/// What a fit comes to.
fn verdict(ending: Ending, is_determined: bool, reasons: &[Reason]) -> Verdict {
    match (ending, is_determined) {
        (Ending::Converged, true) if reasons.is_empty() => Verdict::Describes,
        (Ending::Converged, true) => Verdict::DoesNotDescribe,
        (Ending::Converged, false) => Verdict::NotDetermined,
        _ => Verdict::NotConverged,
    }
}

/// How much G of a fast edge grows, G − γ = K vⁿ with K = γ/v₀ⁿ, where its law is fitted. K is known better than γ and
/// v₀, about which a fast pull alone tells nothing more.
fn growth(problem: &FitProblem, u: &[f64], what: &Determined, verdict: Verdict) -> Option<String> {
    if !is_pulled(&problem.preset) {
        return None;
    }
    let preset = problem.preset_at(u, Segment::Retraction)?;
    let (n, speed) = (preset.edge.exponent?, preset.edge.reference_speed?);
    let value = preset.material.work_of_adhesion / pow(speed, n);
    // d ln K with respect to the logarithms of the values.
    let slope = |parameter: &FreeParameter| match &*parameter.key() {
        ADHESION => 1.0,
        edge::REFERENCE_SPEED => -n,
        edge::EXPONENT => -n * ln(speed),
        _ => 0.0,
    };
    let slopes: Vec<f64> = problem.parameters.iter().map(slope).collect();
    let error = what.errors.as_ref().zip(what.correlations.as_ref()).map(|(errors, correlations)| {
        let along = DVector::from_fn(slopes.len(), |j, _| slopes[j] * errors[j]);
        (correlations * &along).dot(&along).max(0.0).sqrt() * value
    });
    let holds = match (&error, verdict) {
        (None, _) => "; its error is not known, as the points do not determine all values",
        (_, Verdict::Describes) => "",
        _ => "; this error does not hold, as the model does not describe the points",
    };
    let error = error.map_or_else(String::new, |error| format!(" +- {}", significant(error, 2)));
    let unit = if preset.units == UnitSystem::Reduced { "" } else { " J/m^2 (s/m)^n" };
    Some(format!(
        "a fast edge costs K v^n more than gamma, with K = gamma/v0^n = {}{error}{unit}{holds}",
        significant(value, 4)
    ))
}

/// The noise with which a fit weighs its points, and where that is from.
fn noise_of(problem: &FitProblem, branches: &Branches) -> Noise {
    let Noise { sigma: [before, ..], mut from, .. } = branches.noise;
    let [way, ..] = problem.sigma;
    let is_found = branches.abscissa != Abscissa::Radius || from[0] == Origin::Assumed;
    if is_found && way.total_cmp(&before).is_ne() {
        from[0] = Origin::Neighbours;
    }
    Noise { sigma: problem.sigma, share: problem.share, from, ..branches.noise }
}
