//! One made curve through the engine, as its file, and a judgement of the answer.

use super::kinds::{Kind, Made};
use super::record::Random;
use pulloff_engine::fit::{Fit, Options, fit_own};
use pulloff_engine::measured::PointsFile;
use pulloff_engine::preset::{Preset, Value, data, read};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::report::fit::FitReport;
use std::sync::Arc;

/// The value and the error of one key, beside its true value.
#[derive(Debug, Clone)]
pub struct Found {
    #[allow(dead_code, reason = "shown where a value is wrong")]
    pub key: &'static str,
    pub value: f64,
    pub truth: f64,
    /// Whether its 95 % interval holds the truth; `None` without one.
    pub inside: Option<bool>,
    /// How far off it is, in its errors; `None` without one.
    pub off: Option<f64>,
}

/// What became of a curve.
#[derive(Debug, Clone)]
pub struct Outcome {
    pub number: u64,
    /// `describes` and the like, or `refused`.
    pub verdict: String,
    /// The kinds of the reasons, or the cause of the refusal.
    pub reasons: Vec<String>,
    /// What the fit says about itself: the sentences of the reasons, its notes, and the rows in contact and apart.
    #[allow(dead_code, reason = "shown where a value is wrong")]
    pub said: Vec<String>,
    /// Doubts, whatever the verdict is.
    pub warnings: Vec<String>,
    pub found: Vec<Found>,
}

impl Outcome {
    /// Whether the values are presented as those of the body.
    pub fn is_trusted(&self) -> bool {
        self.verdict == "describes"
    }

    /// How far the worst value is off, in its errors; without an error, relative to the truth, as if the error were one
    /// per cent.
    pub fn off(&self) -> f64 {
        let share = |found: &Found| 100.0 * (found.value - found.truth).abs() / found.truth.abs().max(1e-300);
        self.found.iter().map(|found| found.off.unwrap_or_else(|| share(found))).fold(0.0, f64::max)
    }
}

/// The preset of a made curve, with its file.
pub fn preset(made: &Made) -> Preset {
    let mut preset = read("made", &made.preset).unwrap();
    let source = PointsFile::new("made.csv".to_owned(), None, made.text.as_bytes().into());
    preset.set(data::FILE, Value::Points(Arc::new(source))).unwrap();
    preset
}

pub fn options(free: &[&str]) -> Options {
    /// The bootstrap with few rows is not judged here: these are the fewest fits it allows.
    const FEWEST: (usize, u64) = (10, 1);
    let free = free.iter().map(|key| (*key).to_owned()).collect();
    Options { free, bootstrap: Some(FEWEST), ..Options::default() }
}

/// The fit of a made curve.
pub fn fitted(made: &Made, options: &Options) -> Result<Fit, String> {
    fit_own(&preset(made), options, &Unwatched).map_err(|error| error.to_string())
}

/// The judgement of a fit whose truth is known.
pub fn outcome(number: u64, made: &Made, fit: &Result<Fit, String>) -> Outcome {
    let fit = match fit {
        Ok(fit) => fit,
        Err(error) => {
            return Outcome {
                number,
                verdict: "refused".to_owned(),
                reasons: vec![error.clone()],
                said: Vec::new(),
                warnings: Vec::new(),
                found: Vec::new(),
            };
        }
    };
    let document = serde_json::to_value(FitReport::new("made.csv", fit, None)).unwrap();
    let reasons = document["reasons"].as_array().cloned().unwrap_or_default();
    let parameters = document["parameters"].as_array().unwrap();
    let found = made.truth.iter().map(|&(key, truth)| {
        let parameter = parameters.iter().find(|parameter| parameter["key"] == key).unwrap();
        let number = |name: &str| parameter[name].as_f64();
        let (value, error) = (number("value").unwrap(), number("standard_error"));
        let interval = &parameter["interval"];
        let interval = interval[0].as_f64().zip(interval[1].as_f64());
        let interval = interval.or(error.map(|error| (value - 1.96 * error, value + 1.96 * error)));
        Found {
            key,
            value,
            truth,
            inside: interval.map(|(lo, hi)| (lo..=hi).contains(&truth)),
            off: error.map(|error| (value - truth).abs() / error),
        }
    });
    let sentences = fit.reasons.iter().map(|reason| reason.sentence.clone());
    let points = format!("{:?} {:?} {:?}", fit.rows, fit.noise, fit.scatter);
    Outcome {
        number,
        said: sentences.chain(fit.notes.iter().cloned()).chain([points]).collect(),
        warnings: fit.warnings.clone(),
        verdict: document["verdict"].as_str().unwrap_or("none").to_owned(),
        reasons: reasons.iter().map(|reason| reason["kind"].as_str().unwrap_or("").to_owned()).collect(),
        found: found.collect(),
    }
}

/// The curve of this kind and number.
pub fn made(kind: &Kind, number: u64) -> Made {
    let name =
        kind.name.bytes().fold(0_u64, |hash, byte| hash.wrapping_mul(131).wrapping_add(u64::from(byte)));
    (kind.make)(&mut Random::new(name ^ (number << 32)))
}

/// The outcome of this kind and number.
pub fn tried(kind: &Kind, number: u64) -> Outcome {
    let made = made(kind, number);
    outcome(number, &made, &fitted(&made, &options(&made.free)))
}

/// Writes the curve, its preset and the command that fits it to the folder that `PULLOFF_FINDINGS` names.
pub fn kept(kind: &Kind, outcome: &Outcome) {
    let Ok(folder) = std::env::var("PULLOFF_FINDINGS") else { return };
    let made = made(kind, outcome.number);
    let name: String = kind.name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let path = format!("{folder}/{name}-{}", outcome.number);
    std::fs::write(format!("{path}.csv"), &made.text).unwrap();
    std::fs::write(format!("{path}.toml"), &made.preset).unwrap();
    println!("    pulloff fit {path}.csv {path}.toml --free '{}'", made.free.join(","));
}
