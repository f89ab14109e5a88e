//! A fit to a measured curve as a document, as text for a terminal and as CSV.

mod text;

use super::columns;
use super::number::{exact, significant};
use super::residuals::{ResidualRow, rows};
use super::table::aligned;
use crate::fit::fitted::{Fitted, quantity};
use crate::fit::least_squares::Ending;
use crate::fit::models::{AdhesionModel, Models, Pair};
use crate::fit::options::letter;
use crate::fit::outcome::Fit;
use crate::fit::problem::MODULUS;
use crate::fit::together::{Collapse, Together};
use crate::fit::uncertain::Given;
use crate::fit::{Reason, Rows, Verdict};
use crate::measured::asked::signs_text;
use crate::measured::points::Turned;
use crate::measured::{Abscissa, Origin};
use crate::preset::Preset;
use crate::units::{Quantity, UnitSystem};
use serde::Serialize;
use std::fmt::Write;

/// A fit, in base units: SI, or those of a reduced problem.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct FitReport {
    /// The version of all documents.
    pub schema: u32,
    /// Which document it is.
    pub document: &'static str,
    /// The file of the points.
    pub file: String,
    /// How the adhesion acts: the word of `material.adhesion`, or `rate` where its growth with the speed of the edge is fitted.
    pub model: &'static str,
    /// The outcome: whether the values and their errors may be believed.
    pub verdict: Verdict,
    /// What speaks against it; empty where the model describes the points.
    pub reasons: Vec<Reason>,
    /// The values.
    pub parameters: Vec<ParameterReport>,
    /// What was known about values before, with an error, and its share in them.
    pub priors: Vec<Given>,
    /// The correlations of the values, in their order; `None` where they are not determined.
    pub correlations: Option<Vec<Vec<f64>>>,
    /// Σr²/(n − p), r in σ.
    pub chi_squared: f64,
    /// The same without the rows that are outliers; `None` where there are none.
    pub chi_squared_without_outliers: Option<f64>,
    /// Σr²/n of the points in contact; `None` if there are none.
    pub chi_squared_in_contact: Option<f64>,
    /// The same for the points apart.
    pub chi_squared_apart: Option<f64>,
    /// The noise of neighbouring points in contact, in σ; `None` if there are too few.
    pub noise_of_neighbours: Option<f64>,
    /// How many rows of the noise count as one: 1 for white noise.
    pub rows_that_count_as_one: f64,
    /// The degrees of freedom of the error that is known least well.
    pub degrees_of_freedom: f64,
    /// The rows of the file by branch and part.
    pub rows: Rows,
    /// The rows that are fitted, with their distances from the curve.
    pub residuals: Vec<ResidualRow>,
    /// Points more than four times their scale away.
    pub outliers: usize,
    /// Whether the points determine the values.
    pub determined: bool,
    /// What they do not determine, in words.
    pub direction: Option<String>,
    /// The condition of the Jacobian, its columns of length 1; `None` where it is infinite.
    pub condition: Option<f64>,
    /// `converged`, `rounds` or `cancelled`.
    pub ended: &'static str,
    /// What x is.
    pub abscissa: &'static str,
    /// σ of x and of P, and of s where it is measured beside x.
    pub sigma: Vec<f64>,
    /// Where each comes from.
    pub sigma_from: Vec<Origin>,
    /// The share of P by which its σ grows with it: σ² = `sigma`² + (share · P)²; 0 where it does not.
    pub sigma_force_share: f64,
    /// The snaps of the fitted path.
    pub snaps: usize,
    /// The starts that were run, the nearest first.
    pub starts: Vec<StartReport>,
    /// E of one body if the other is rigid, where a Poisson's ratio is given; with its standard error.
    pub youngs_modulus: Option<[Option<f64>; 2]>,
    /// The number of bootstrap fits, and the rows of each block.
    pub bootstrap: Option<[usize; 2]>,
    /// What was found, assumed and held fixed, and which values are known only together.
    pub notes: Vec<String>,
    /// What should be doubted.
    pub warnings: Vec<String>,
    /// The sentences of the reasons, and the warnings.
    #[serde(skip)]
    pub doubts: Vec<String>,
    /// Whether the signs of x and P are reversed against the file.
    #[serde(skip)]
    turned: Turned,
    /// How numbers are shown.
    #[serde(skip)]
    shown: UnitSystem,
}

/// One fitted value.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ParameterReport {
    /// Its dotted key.
    pub key: String,
    /// The value.
    pub value: f64,
    /// Its standard error; `None` where it is not determined.
    pub standard_error: Option<f64>,
    /// The degrees of freedom of the square of the error; `None` where it is not determined.
    pub degrees_of_freedom: Option<f64>,
    /// Whether the error may be believed: only where the model describes the points and the bootstrap, if there is one,
    /// does not find it too small.
    pub error_holds: bool,
    /// The 95 % interval by Student's t.
    pub interval: Option<[f64; 2]>,
    /// Where the fit started.
    pub start: f64,
    /// Its unit; empty in a reduced problem.
    pub unit: &'static str,
    /// The 95 % interval by the profile of χ².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile_interval: Option<[f64; 2]>,
    /// The standard deviation of the bootstrap.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bootstrap_error: Option<f64>,
    /// Its 95 % interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bootstrap_interval: Option<[f64; 2]>,
    #[serde(skip)]
    letter: String,
    #[serde(skip)]
    quantity: Quantity,
}

impl ParameterReport {
    /// A value fitted to a problem like `preset`; `holds` says whether its error does.
    fn new(preset: &Preset, fitted: &Fitted, holds: bool) -> Self {
        let quantity = quantity(preset, &fitted.key);
        let is_si = matches!(preset.units, UnitSystem::Si(_));
        Self {
            key: fitted.key.clone(),
            value: fitted.value,
            standard_error: fitted.standard_error,
            degrees_of_freedom: fitted.degrees,
            error_holds: holds && fitted.has_error(),
            interval: fitted.interval,
            start: fitted.start,
            unit: quantity.si().filter(|_| is_si).unwrap_or(""),
            profile_interval: fitted.profile,
            bootstrap_error: fitted.bootstrap.map(|found| found.error),
            bootstrap_interval: fitted.bootstrap.map(|found| found.interval),
            letter: letter(preset, &fitted.key),
            quantity,
        }
    }

    /// The value, its error, in parentheses where it does not hold, and their unit.
    fn cells(&self, units: &UnitSystem) -> [String; 3] {
        let shown = |x: f64, digits| significant(units.shown(self.quantity, x).number, digits);
        let error = self.standard_error.map_or_else(
            || "-".to_owned(),
            |error| if self.error_holds { shown(error, 2) } else { format!("({})", shown(error, 2)) },
        );
        let unit = units.unit(self.quantity).map_or_else(String::new, crate::units::Unit::ascii);
        [shown(self.value, 6), error, unit]
    }
}

/// One law fitted to several curves.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TogetherReport {
    /// The version of all documents.
    pub schema: u32,
    /// Which document it is.
    pub document: &'static str,
    /// The outcome: whether the law and its errors may be believed.
    pub verdict: Verdict,
    /// The values of the law.
    pub law: Vec<ParameterReport>,
    /// What the curves do not determine, in words.
    pub direction: Option<String>,
    /// Whether they follow one law.
    pub collapse: Collapse,
    /// The curves.
    pub runs: Vec<CurveReport>,
    /// What should be doubted about each.
    #[serde(skip)]
    pub doubts: Vec<String>,
    #[serde(skip)]
    shown: UnitSystem,
}

/// One curve among several.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "RunReport"))]
pub struct CurveReport {
    /// The fit under the common law, with the errors of all curves.
    pub fit: FitReport,
    /// The outcome for this curve alone.
    pub alone_verdict: Verdict,
    /// The law that this curve alone would give.
    pub alone: Vec<ParameterReport>,
}

impl TogetherReport {
    /// The document of `together`, fitted to `files`.
    #[must_use]
    pub fn new(files: &[String], together: &Together) -> Self {
        let holds = together.verdict == Verdict::Describes;
        let runs = together.runs.iter().zip(files).map(|(run, file)| {
            let mut alone = FitReport::new(file, &run.alone, None);
            alone.parameters.retain(|of| together.law.iter().any(|law| law.key == of.key));
            let mut fit = FitReport::new(file, &run.fit, None);
            // The errors of each curve assume the law of all.
            fit.parameters.iter_mut().for_each(|of| of.error_holds &= holds);
            CurveReport { fit, alone_verdict: alone.verdict, alone: alone.parameters }
        });
        let runs: Vec<CurveReport> = runs.collect();
        let of_law = |fitted| ParameterReport::new(&together.preset, fitted, holds);
        let of_run = |run: &CurveReport| {
            run.fit.doubts.iter().map(|doubt| format!("{}: {doubt}", run.fit.file)).collect()
        };
        Self {
            schema: super::SCHEMA,
            document: "fit-together",
            verdict: together.verdict,
            law: together.law.iter().map(of_law).collect(),
            direction: together.direction.clone(),
            collapse: together.collapse.clone(),
            doubts: runs.iter().flat_map(|run| -> Vec<String> { of_run(run) }).collect(),
            runs,
            shown: together.preset.units.clone(),
        }
    }

    /// Each curve, and below them the law.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for run in &self.runs {
            let _ = writeln!(text, "{}", run.fit.text());
        }
        let _ = writeln!(text, "together: {}", self.verdict.sentence());
        let _ = writeln!(text, "{}", self.collapse.sentence);
        if let Some(direction) = &self.direction {
            let _ = writeln!(text, "not determined: {direction}");
        }
        let names = self.runs.iter().flat_map(|run| [run.fit.file.clone(), "error".to_owned()]);
        let first = ["key", "", "all", "error", ""].map(str::to_owned);
        let mut rows = vec![first.into_iter().chain(names).collect::<Vec<_>>()];
        for of_law in &self.law {
            let [value, error, unit] = of_law.cells(&self.shown);
            let mut row = vec![of_law.key.clone(), of_law.letter.clone(), value, error, unit];
            for run in &self.runs {
                let alone = run.alone.iter().find(|alone| alone.key == of_law.key);
                let cells = alone.map(|alone| alone.cells(&self.shown)).unwrap_or_default();
                row.extend(cells.into_iter().take(2));
            }
            rows.push(row);
        }
        let _ = write!(text, "\n{}", aligned(&rows, 2));
        text
    }
}

/// Several models fitted to the same points.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ModelsReport {
    /// The version of all documents.
    pub schema: u32,
    /// Which document it is.
    pub document: &'static str,
    /// The file of the points.
    pub file: String,
    /// The model that comes nearest to the points for its number of free values; null where none could be fitted.
    pub best: Option<AdhesionModel>,
    /// Each other model beside it, and whether the points tell the two apart.
    pub pairs: Vec<Pair>,
    /// The fits, in the order in which they were asked for.
    pub fits: Vec<FitReport>,
    /// The models that could not be fitted, and why.
    pub refused: Vec<Refused>,
}

/// A model that could not be fitted.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Refused {
    /// The model.
    pub model: AdhesionModel,
    /// Why, in words.
    pub why: String,
}

impl ModelsReport {
    /// The document of `models` fitted to the points of `file`, with E beside E* for Poisson's ratio ν.
    #[must_use]
    pub fn new(file: &str, models: &Models, poisson: Option<f64>) -> Self {
        let fitted = models.fits.iter().filter_map(|fitted| fitted.fit.as_ref().ok());
        let refused = models.fits.iter().filter_map(|fitted| {
            let why = fitted.fit.as_ref().err()?.to_string();
            Some(Refused { model: fitted.model?, why })
        });
        Self {
            schema: super::SCHEMA,
            document: "fit-models",
            file: file.to_owned(),
            best: models.best.and_then(|best| models.fits[best].model),
            pairs: models.pairs.clone(),
            fits: fitted.map(|fit| FitReport::new(file, fit, poisson)).collect(),
            refused: refused.collect(),
        }
    }

    /// The report of the best model.
    pub fn best(&self) -> Option<&FitReport> {
        let best = self.best?.name();
        self.fits.iter().find(|fit| fit.model == best)
    }

    /// The fits as lines of text, and below them which model the points speak for.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for fit in &self.fits {
            let _ = writeln!(text, "model: {}\n{}", fit.model, fit.text());
        }
        for Refused { model, why } in &self.refused {
            let _ = writeln!(text, "model: {} could not be fitted: {why}\n", model.name());
        }
        for pair in &self.pairs {
            let _ = writeln!(text, "{}", pair.sentence);
        }
        text
    }
}

/// A start that was run.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StartReport {
    /// The mean distance of the points at its end, in σ.
    pub distance: f64,
    /// The snaps of its path.
    pub snaps: usize,
}

impl FitReport {
    /// The document of `fit` to the points of `file`, with E beside E* for Poisson's ratio ν.
    #[must_use]
    pub fn new(file: &str, fit: &Fit, poisson: Option<f64>) -> Self {
        let units = &fit.preset.units;
        let holds = fit.verdict == Verdict::Describes;
        let parameters: Vec<ParameterReport> =
            fit.parameters.iter().map(|fitted| ParameterReport::new(&fit.preset, fitted, holds)).collect();
        let modulus = parameters.iter().find(|parameter| parameter.key == MODULUS);
        let youngs_modulus = poisson.map(|nu| {
            let factor = 1.0 - nu * nu;
            let value = modulus.map_or(fit.preset.material.effective_modulus, |parameter| parameter.value);
            [
                Some(factor * value),
                modulus.and_then(|parameter| parameter.standard_error).map(|error| factor * error),
            ]
        });
        let mut starts: Vec<StartReport> = fit
            .starts
            .iter()
            .map(|tried| StartReport { distance: tried.distance, snaps: tried.snaps })
            .collect();
        starts.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let measured = if fit.noise.sigma[2] > 0.0 && fit.abscissa != Abscissa::Radius { 3 } else { 2 };
        Self {
            schema: super::SCHEMA,
            document: "fit",
            file: file.to_owned(),
            model: if parameters.iter().any(|of| of.key.starts_with("edge.")) {
                AdhesionModel::Rate.name()
            } else {
                fit.preset.material.adhesion.name()
            },
            verdict: fit.verdict,
            reasons: fit.reasons.clone(),
            parameters,
            priors: fit.priors.clone(),
            correlations: fit.correlations.clone(),
            chi_squared: fit.chi_squared,
            chi_squared_without_outliers: fit.chi_squared_without_outliers,
            chi_squared_in_contact: fit.chi_squared_of[0],
            chi_squared_apart: fit.chi_squared_of[1],
            noise_of_neighbours: fit.scatter.contact,
            rows_that_count_as_one: fit.scatter.correlation.rows(),
            degrees_of_freedom: fit.degrees,
            rows: fit.rows,
            residuals: rows(fit),
            outliers: fit.outliers,
            determined: fit.direction.is_none(),
            direction: fit.direction.clone(),
            condition: Some(fit.condition).filter(|condition| condition.is_finite()),
            ended: match fit.ending {
                Ending::Converged => "converged",
                Ending::Rounds => "rounds",
                Ending::Cancelled => "cancelled",
            },
            abscissa: fit.abscissa.name(),
            sigma: fit.noise.sigma[..measured].to_vec(),
            sigma_force_share: fit.noise.share,
            sigma_from: fit.noise.from[..measured].to_vec(),
            snaps: fit.snaps,
            starts,
            youngs_modulus,
            bootstrap: fit.bootstrapped,
            notes: fit.notes.iter().cloned().chain(fit.known_together()).collect(),
            warnings: fit.warnings.clone(),
            doubts: fit.reasons.iter().map(|reason| &reason.sentence).chain(&fit.warnings).cloned().collect(),
            turned: fit.turned,
            shown: units.clone(),
        }
    }

    /// The values of these rows of a table with their units in one line; `None` if they have none.
    pub fn units<'a>(reports: impl IntoIterator<Item = &'a Self>) -> Option<String> {
        let values = reports.into_iter().flat_map(|report| &report.parameters);
        let named =
            values.filter(|value| !value.unit.is_empty()).map(|value| (value.key.as_str(), value.unit));
        columns::sentence(named).map(|units| format!("{units}; errors as their values"))
    }

    /// The units and the signs of x and P in the CSV of the residuals; `None` where they are those of the file.
    pub fn units_of_residuals(&self) -> Option<String> {
        let units = match &self.shown {
            UnitSystem::Si(_) => columns::sentence([("x", "m"), ("force", "N")]),
            UnitSystem::Reduced => None,
        };
        let is_turned = self.turned.contains(&true);
        let signs = is_turned.then(|| {
            format!(
                "the signs of x and force are those of the fit, turned against the file: {}",
                signs_text(self.turned)
            )
        });
        let told: Vec<String> = units.into_iter().chain(signs).collect();
        (!told.is_empty()).then(|| told.join("; "))
    }

    /// The header and the row of a table with one row for each file.
    pub fn row(&self) -> [Vec<String>; 2] {
        let mut header = ["file", "verdict", "model"].map(str::to_owned).to_vec();
        let mut row = [&self.file, self.verdict.word(), self.model].map(str::to_owned).to_vec();
        for parameter in &self.parameters {
            header.push(parameter.key.clone());
            header.push(format!("{} error", parameter.key));
            row.push(exact(parameter.value));
            // A mean over many files does not see their verdicts: an error that does not hold is left out.
            let error = parameter.standard_error.filter(|_| parameter.error_holds);
            row.push(error.map_or_else(String::new, exact));
        }
        for (name, value) in [
            ("chi_squared", exact(self.chi_squared)),
            ("points", self.rows.fitted().to_string()),
            ("outliers", self.outliers.to_string()),
            ("snaps", self.snaps.to_string()),
            ("reasons", self.reasons.iter().map(|reason| &*reason.sentence).collect::<Vec<_>>().join("; ")),
            ("warnings", self.warnings.join("; ")),
        ] {
            header.push(name.to_owned());
            row.push(value);
        }
        [header, row]
    }
}
