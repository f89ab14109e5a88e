//! A quantity of the sweep's list over the range of one value, computed in the background while it is being looked at.
//!
//! The value of the preset is one of those computed. Turning it within the range moves its mark and requests nothing.
//! If the surface is one of many, drawn with a seed, other surfaces are computed after it, one by one.

use super::Axes;
use super::map_axes::typed;
use pulloff_engine::case::critical_force;
use pulloff_engine::gap::shapes::split_mix::SplitMix64;
use pulloff_engine::preset::edge::RATE;
use pulloff_engine::preset::schema::{Kind, STIFFNESS};
use pulloff_engine::preset::{Key, Preset, Row, Value};
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Progress;
use pulloff_engine::report::slow::SlowPulls;
use pulloff_engine::stability::MapAxis;
use pulloff_engine::sweep::measure::measure;
use pulloff_engine::sweep::{Cell, Fault, QuantityColumn};
use pulloff_engine::units::Quantity;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// The number of values on either side of the preset's.
const BESIDE: i32 = 50;
/// The factor by which the range extends up, and down if the value is changed by factors.
const FACTOR: f64 = 2.0;
/// The same for the stiffness of the device, which matters over decades.
const STIFFNESS_FACTOR: f64 = 30.0;
/// The same for the rate of a pull, since the exponents of its law are small.
const RATE_FACTOR: f64 = 1e3;

/// The quantity whose law at low rates is known.
const PEAK_FORCE: &str = "peak_force";
/// The quantity by which other forces are divided.
const CRITICAL_FORCE: &str = "critical_force";
/// How often progress is reported.
const PACE: Duration = Duration::from_millis(100);

/// The key of the seed of a random surface.
const SEED: &str = "gap.seed";

/// Surfaces computed beside the preset's own: the median is then known to a fifth of their standard deviation.
const OTHERS: usize = 40;

/// The outcome for one value.
#[derive(Debug, Clone, PartialEq)]
pub enum StudyOutcome {
    /// Still to be computed.
    Waits,
    Found(Cell),
    /// There is none, for this reason.
    Missing(String),
}

/// A study that is wanted.
#[derive(Debug, Clone)]
pub struct StudyWish {
    pub preset: Preset,
    pub key: Key,
    pub column: QuantityColumn,
    /// The values, ascending.
    pub values: Vec<Value>,
    /// The range that was asked for; `None` for the usual one around the preset's value.
    pub over: Option<MapAxis>,
}

/// A study, or the part of it that is done.
#[derive(Debug, Clone)]
pub struct StudyData {
    /// The request.
    pub wish: StudyWish,
    /// The outcome for each value.
    pub outcomes: Vec<StudyOutcome>,
    /// What other surfaces give at each value, one after the other; NaN where there is no result.
    pub others: Vec<Vec<f64>>,
    /// What the largest pull tends to at low rates, if it is studied over the rate.
    pub slow: Option<SlowPulls>,
    /// `P_c` at each value; NaN where there is none.
    critical: Vec<f64>,
    /// At how many values the gap is too steep for the theory, and its largest slope; `None` if it is nowhere.
    pub steep: Option<(usize, f64)>,
}

/// The range of a study as typed, KEY=FROM..TO or KEY=log:FROM..TO.
/// Errors: In words.
pub fn typed_range(preset: &Preset, text: &str) -> Result<MapAxis, String> {
    let axis = typed(preset, text)?;
    for end in axis.range {
        let set = preset.clone().set(&axis.key, value_of(preset, &axis.key, end));
        set.map_err(|invalid| format!("no range of a study: {invalid}"))?;
    }
    Ok(axis)
}

/// A number as a value of `key`: the nearest whole one where it takes no others.
fn value_of(preset: &Preset, key: &str, x: f64) -> Value {
    match preset.row(key).map(|row| row.kind) {
        // Between the bounds of the row, which a float holds.
        #[expect(clippy::cast_possible_truncation)]
        Some(Kind::Integer { .. }) => (x.round() as i64).into(),
        _ => x.into(),
    }
}

/// Whether the values of `axis` are those of this row.
pub fn is_over(axis: &MapAxis, row: &Row) -> bool {
    *row.key == *axis.key || (row.kind == Kind::Control && axis.key == STIFFNESS)
}

/// The key of `axis` and its values in ascending order, with that of the preset where it lies between them.
pub fn values_of(axis: &MapAxis, preset: &Preset) -> (Key, Vec<Value>) {
    let spread = (0..=2 * BESIDE).map(|k| match f64::from(k) / f64::from(2 * BESIDE) {
        share if share > 0.0 && share < 1.0 => tidy(axis.value(share)),
        share => axis.value(share),
    });
    let own = preset.get(&axis.key).and_then(|own| number(&own));
    let [lo, hi] = axis.range;
    let mut all: Vec<f64> = spread.chain(own.filter(|x| (lo..=hi).contains(x))).collect();
    all.sort_by(f64::total_cmp);
    let mut all: Vec<Value> = all.into_iter().map(|x| value_of(preset, &axis.key, x)).collect();
    all.dedup();
    (axis.key.clone().into(), all)
}

/// The key that is varied and its values in ascending order, including that of the preset.
/// Errors: Why this value has no range, in words.
pub fn range(preset: &Preset, row: &Row) -> Result<(Key, Vec<Value>), String> {
    let label = &row.label;
    let (key, values) = match (row.kind, preset.get(&row.key)) {
        (Kind::Control, Some(Value::Control(Control::Stiffness(k)))) => {
            (Key::Borrowed(STIFFNESS), by_factors(k, STIFFNESS_FACTOR))
        }
        (Kind::Control, _) => return Err("no stiffness to vary: the device is not a spring".to_owned()),
        (_, None) => return Err(format!("{label} follows from other values: nothing to vary")),
        (Kind::Positive | Kind::Smoothing, Some(Value::Number(x))) if x > 0.0 => {
            let factor = match &*row.key {
                RATE => RATE_FACTOR,
                STIFFNESS => STIFFNESS_FACTOR,
                _ => FACTOR,
            };
            (row.key.clone(), by_factors(x, factor))
        }
        (Kind::NonNegative, Some(Value::Number(x))) if x > 0.0 => {
            (row.key.clone(), between(0.0, x, FACTOR * x))
        }
        (Kind::Finite, Some(Value::Number(x))) if x != 0.0 => {
            (row.key.clone(), between(x - x.abs(), x, x + x.abs()))
        }
        (Kind::Between { min, max }, Some(Value::Number(x))) if x != 0.0 => {
            (row.key.clone(), between((x - x.abs()).max(min), x, (x + x.abs()).min(max)))
        }
        (_, Some(Value::Number(_))) => return Err(format!("{label} is 0 and has no scale to vary it by")),
        (Kind::Integer { min, max }, Some(Value::Integer(n))) => (row.key.clone(), whole(n, min, max)),
        _ => return Err(format!("{label} is not a number: nothing to vary")),
    };
    Ok((key, values))
}

/// From the value over the factor to the value times the factor, in equal ratios.
fn by_factors(x: f64, factor: f64) -> Vec<Value> {
    let at = |k: i32| x * factor.powf(f64::from(k) / f64::from(BESIDE));
    (-BESIDE..=BESIDE).map(|k| if k == 0 { x } else { tidy(at(k)) }.into()).collect()
}

/// From `lo` through `x` to `hi`, in equal steps on either side of `x`.
fn between(lo: f64, x: f64, hi: f64) -> Vec<Value> {
    let at = |k: i32| {
        let end = if k < 0 { lo } else { hi };
        // The whole way is exactly the end.
        x + (end - x) * (f64::from(k.abs()) / f64::from(BESIDE))
    };
    let mut all: Vec<f64> = (-BESIDE..=BESIDE).map(|k| if k == 0 { x } else { tidy(at(k)) }).collect();
    all.dedup();
    all.into_iter().map(Value::from).collect()
}

/// Whole numbers from half of `n` to its double, as many as are allowed.
fn whole(n: i64, min: i64, max: i64) -> Vec<Value> {
    let (lo, hi) = ((n / 2).max(min), n.saturating_mul(2).min(max));
    let step = hi.saturating_sub(lo) / (2 * i64::from(BESIDE)) + 1;
    let at = |k: i32| n.saturating_add(i64::from(k).saturating_mul(step));
    let mut all: Vec<i64> = (-2 * BESIDE..=2 * BESIDE).map(at).filter(|m| (lo..=hi).contains(m)).collect();
    all.dedup();
    all.into_iter().map(Value::from).collect()
}

/// Six digits: a value adopted from here stays readable.
fn tidy(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// The position of a value on an axis.
pub fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Number(x) => Some(*x),
        // Exact for every count.
        #[expect(clippy::cast_precision_loss)]
        Value::Integer(n) => Some(*n as f64),
        _ => None,
    }
}

/// Threads for a study: one core is left for curve and screen.
pub fn threads() -> usize {
    thread::available_parallelism().map_or(1, |cores| cores.get().saturating_sub(1).max(1))
}

impl StudyWish {
    /// How many other surfaces are to be computed.
    pub fn others(&self) -> usize {
        let is_one_of_many = self.key != SEED && self.preset.get(SEED).is_some();
        if is_one_of_many { OTHERS } else { 0 }
    }

    /// The preset with the surface of this number; 0 is its own.
    fn with_surface(&self, number: usize) -> Preset {
        let mut preset = self.preset.clone();
        if let (1.., Some(Value::Integer(seed))) = (number, preset.get(SEED)) {
            let bits = SplitMix64::row(seed.unsigned_abs(), number as u64).bits();
            // 53 bits: a table of numbers in double precision keeps such a seed.
            let drawn = i64::try_from(bits >> 11).unwrap_or_default();
            // Any number is a valid seed.
            let _ = preset.set(SEED, drawn.into());
        }
        preset
    }

    /// What the preset with each value, on its own surface, says of itself; `None` where it does not take the value.
    fn at_each(&self, of: impl Fn(&Preset) -> Option<f64>) -> impl Iterator<Item = Option<f64>> {
        self.values.iter().map(move |value| {
            let mut preset = self.preset.clone();
            preset.set(&self.key, value.clone()).ok()?;
            of(&preset)
        })
    }

    /// Why there is no value although nothing failed: what the meaning of the quantity says of it.
    fn why_empty(&self) -> String {
        let meaning = self.column.quantity.meaning;
        match meaning.find("empty ") {
            Some(at) => format!("it is {}", &meaning[at..]),
            None => "it is not defined here".to_owned(),
        }
    }

    /// The outcome for the value at `index` on the surface of this number; `None` if `progress` asked to stop.
    fn outcome(&self, surface: usize, index: usize, progress: &dyn Progress) -> Option<StudyOutcome> {
        let missing = |fault: Fault| StudyOutcome::Missing(fault.to_string());
        let mut preset = self.with_surface(surface);
        let value = self.values.get(index).cloned()?;
        if let Err(invalid) = preset.set(&self.key, value) {
            return Some(missing(Fault::of_value(&invalid)));
        }
        let measured = match catch_unwind(AssertUnwindSafe(|| measure(&preset, &[self.column], progress))) {
            Ok(measured) => measured?,
            Err(payload) => return Some(missing(Fault::of_panic(payload.as_ref()))),
        };
        Some(match (measured.cells.first(), measured.fault) {
            (Some(Some(cell)), _) => StudyOutcome::Found(*cell),
            (_, Some(fault)) => missing(fault),
            _ => StudyOutcome::Missing(self.why_empty()),
        })
    }

    /// Computes it on this many threads, and reports from time to time what is done; `None` if `progress` asked to
    /// stop.
    pub fn run(
        &self,
        threads: usize,
        progress: &(dyn Progress + Sync),
        told: &mut dyn FnMut(StudyData),
    ) -> Option<StudyData> {
        let count = self.values.len();
        let outcomes = vec![StudyOutcome::Waits; count];
        let is_law = self.key == RATE && self.column.quantity.name == PEAK_FORCE;
        let slow = if is_law { SlowPulls::of(&self.preset, progress).ok().flatten() } else { None };
        let others = vec![Vec::new(); count];
        let critical = self.at_each(critical_force).map(|force| force.unwrap_or(f64::NAN)).collect();
        let steep = self.at_each(Preset::steep_slope).flatten().fold(None, |known, slope| {
            let (count, steepest) = known.unwrap_or((0, slope));
            Some((count + 1, slope.max(steepest)))
        });
        let mut data = StudyData { wish: self.clone(), outcomes, others, slow, critical, steep };
        let all = count * (1 + self.others());
        let next = AtomicUsize::new(0);
        let (send, done) = channel();
        thread::scope(|scope| {
            for _ in 0..threads.clamp(1, count.max(1)) {
                let (send, next) = (send.clone(), &next);
                scope.spawn(move || {
                    loop {
                        let next = next.fetch_add(1, Ordering::Relaxed);
                        if next >= all || progress.stop() {
                            break;
                        }
                        // All values of one surface before the next surface: they share its table.
                        let (surface, index) = (next / count, next % count);
                        let Some(outcome) = self.outcome(surface, index, progress) else { break };
                        // Fails only if nobody is waiting for it any more.
                        let _ = send.send((surface, index, outcome));
                    }
                });
            }
            drop(send);
            let mut due = Instant::now() + PACE;
            loop {
                match done.recv_timeout(due.saturating_duration_since(Instant::now())) {
                    Ok((0, index, outcome)) => data.outcomes[index] = outcome,
                    Ok((surface, index, outcome)) => data.came(surface, index, &outcome),
                    Err(RecvTimeoutError::Timeout) => {
                        told(data.clone());
                        due = Instant::now() + PACE;
                    }
                    Err(RecvTimeoutError::Disconnected) => break,
                }
            }
        });
        (!progress.stop()).then_some(data).filter(StudyData::is_whole)
    }
}

impl StudyData {
    /// Adds what another surface gives for the value at `index`.
    fn came(&mut self, surface: usize, index: usize, outcome: &StudyOutcome) {
        let found = &mut self.others[index];
        if found.len() < surface {
            found.resize(surface, f64::NAN);
        }
        found[surface - 1] = match outcome {
            StudyOutcome::Found(Cell::Number(x)) => *x,
            // Exact for every count.
            #[expect(clippy::cast_precision_loss)]
            StudyOutcome::Found(Cell::Count(n)) => *n as f64,
            StudyOutcome::Waits | StudyOutcome::Missing(_) => f64::NAN,
        };
    }

    /// What each force is divided by on these axes, `P_c` at its own value, NaN where there is none; `None` for another
    /// quantity, and if nothing adheres.
    pub fn divisors(&self, axes: Axes) -> Option<&[f64]> {
        // P_c itself would be 1 everywhere.
        let is_force = self.wish.column.quantity.unit == Quantity::Force
            && self.wish.column.quantity.name != CRITICAL_FORCE;
        let adheres = self.critical.iter().any(|critical| critical.is_finite());
        (is_force && axes == Axes::Reduced && adheres).then_some(&*self.critical)
    }

    /// How many other surfaces are computed at every value.
    pub fn surfaces(&self) -> usize {
        self.others.iter().map(Vec::len).min().unwrap_or(0)
    }

    /// Whether everything has been computed.
    pub fn is_whole(&self) -> bool {
        self.done() == self.outcomes.len() && self.surfaces() == self.wish.others()
    }

    /// How many values are done.
    pub fn done(&self) -> usize {
        self.outcomes.iter().filter(|outcome| **outcome != StudyOutcome::Waits).count()
    }

    /// The computed value nearest to `x`, and its index in the list.
    pub fn nearest(&self, x: f64) -> Option<(usize, f64)> {
        let places = self.wish.values.iter().enumerate().filter_map(|(i, value)| Some((i, number(value)?)));
        places.min_by(|a, b| (a.1 - x).abs().total_cmp(&(b.1 - x).abs()))
    }
}

impl StudyWish {
    /// Whether it is the one wanted, although the value may be another one within the range.
    pub(super) fn is_like(&self, wanted: &Self) -> bool {
        let (preset, key) = (&wanted.preset, &wanted.key);
        if self.key != *key || self.column != wanted.column || self.over != wanted.over {
            return false;
        }
        if self.preset == *preset {
            return true;
        }
        let ends = [self.values.first(), self.values.last()].map(|value| value.and_then(number));
        let (Some(value), [Some(lo), Some(hi)]) = (preset.get(key), ends) else { return false };
        let mut moved = self.preset.clone();
        number(&value).is_some_and(|x| self.over.is_some() || (lo..=hi).contains(&x))
            && moved.set(key, value).is_ok()
            && moved == *preset
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{read, shipped};
    use pulloff_engine::progress::Unwatched;

    fn preset(changes: &[(&str, &str)]) -> Preset {
        let mut preset = read("wavy-sphere", shipped::find("wavy-sphere").unwrap().text).unwrap();
        for (key, text) in changes {
            preset.assign(key, text).unwrap();
        }
        preset
    }

    fn row(preset: &Preset, key: &str) -> Row {
        preset.row(key).unwrap()
    }

    #[test]
    fn a_range_ascends_has_the_value_itself_and_only_values_that_are_taken() {
        let spring = preset(&[("path.control", "stiffness=0.3")]);
        let rings = preset(&[("basis.kind", "rings"), ("basis.rings", "40")]);
        for (preset, key, varied) in [
            (&preset(&[]), "gap.amplitude", "gap.amplitude"),
            (&preset(&[]), "gap.wavelength", "gap.wavelength"),
            (&preset(&[]), "groups.adhesion", "groups.adhesion"),
            (&preset(&[]), "groups.amplitude_over_wavelength", "groups.amplitude_over_wavelength"),
            (&preset(&[("path.start_approach", "-0.002")]), "path.start_approach", "path.start_approach"),
            (&spring, "path.control", "path.control.stiffness"),
            (&rings, "basis.rings", "basis.rings"),
        ] {
            let (found, values) = range(preset, &row(preset, key)).unwrap();
            assert_eq!(found, varied);
            let numbers: Vec<f64> = values.iter().filter_map(number).collect();
            assert_eq!(numbers.len(), values.len());
            assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]) && numbers.len() > 20, "{numbers:?}");
            assert!(numbers[0] == 0.0 || !key.contains("amplitude"), "{key}: {numbers:?}");
            let own = preset.get(&found).and_then(|value| number(&value)).unwrap();
            assert!(numbers.iter().any(|x| x.to_bits() == own.to_bits()), "{key}: {own} of {numbers:?}");
        }
        let flat = preset(&[("gap.amplitude", "0")]);
        for (preset, key, said) in [
            (&flat, "gap.amplitude", "A is 0 and has no scale"),
            (&flat, "gap.shape", "is not a number"),
            (&flat, "path.control", "is not a spring"),
        ] {
            assert!(range(preset, &row(preset, key)).unwrap_err().contains(said), "{key}");
        }
    }

    #[test]
    fn a_range_as_typed_has_its_ends_and_the_value_itself() {
        let flat = preset(&[("gap.amplitude", "0")]);
        let axis = typed_range(&flat, "A=log:0.001..0.02").unwrap();
        assert!(
            is_over(&axis, &row(&flat, "gap.amplitude")) && !is_over(&axis, &row(&flat, "gap.wavelength"))
        );
        let numbers = |(_, values): (Key, Vec<Value>)| values.iter().filter_map(number).collect::<Vec<f64>>();
        let without = numbers(values_of(&axis, &flat));
        assert_eq!((without[0], *without.last().unwrap(), without.len()), (0.001, 0.02, 101));
        let own = preset(&[("gap.amplitude", "0.0033")]);
        let with = numbers(values_of(&axis, &own));
        assert!(with.len() == 102 && with.contains(&0.0033) && with.is_sorted());
        let rings = preset(&[("basis.kind", "rings"), ("basis.rings", "50")]);
        let (_, whole) = values_of(&typed_range(&rings, "basis.rings=20..60").unwrap(), &rings);
        assert!(whole.len() == 41 && whole.contains(&Value::Integer(50)), "{whole:?}");
        // A device under fixed grips becomes a spring.
        let spring = typed_range(&flat, "path.control.stiffness=0.1..2").unwrap();
        assert!(is_over(&spring, &row(&flat, "path.control")));
        for (text, why) in [
            ("A=-1..1", "gap.amplitude"),
            ("A=log:0..1", "must begin above zero"),
            ("compliance=0..1", "compliance"),
            ("A=1", "KEY=FROM..TO"),
        ] {
            let said = typed_range(&flat, text).unwrap_err();
            assert!(said.contains(why), "{text}: {said}");
        }
    }

    #[test]
    fn a_study_is_a_row_each_whatever_the_threads_and_ends_when_told() {
        let preset = preset(&[]);
        let (key, values) = range(&preset, &row(&preset, "gap.amplitude")).unwrap();
        let column = QuantityColumn::named("largest_pull").unwrap();
        let wish = StudyWish { preset: preset.clone(), key: key.clone(), column, values, over: None };
        let [one, three] = [1, 3].map(|threads| wish.run(threads, &Unwatched, &mut |_| {}).unwrap());
        assert_eq!(one.outcomes, three.outcomes);
        assert_eq!(one.done(), one.outcomes.len());
        let own = measure(&preset, &[column], &Unwatched).unwrap();
        let (at, x) = one.nearest(0.0025).unwrap();
        assert_eq!(x.to_bits(), 0.0025_f64.to_bits());
        assert_eq!(one.outcomes[at], StudyOutcome::Found(own.cells[0].unwrap()));
        assert!(wish.run(2, &|| true, &mut |_| {}).is_none());
        assert_eq!((one.surfaces(), wish.others()), (0, 0));
        // Only its value may move within the range.
        let is_of = |preset: &Preset| one.wish.is_like(&StudyWish { preset: preset.clone(), ..wish.clone() });
        let mut moved = preset.clone();
        moved.set(&key, 0.003.into()).unwrap();
        assert!(is_of(&moved));
        moved.set("gap.wavelength", 0.06.into()).unwrap();
        assert!(!is_of(&moved));
        moved = preset;
        moved.set(&key, 0.0051.into()).unwrap();
        assert!(!is_of(&moved));
        // Of a range that was asked for, whatever the value.
        let over = MapAxis::new(&key, [0.001, 0.004], false, 1.0).ok();
        let asked = StudyWish { over, ..wish.clone() };
        assert!(!one.wish.is_like(&asked) && asked.is_like(&StudyWish { preset: moved, ..asked.clone() }));
    }

    #[test]
    fn a_force_over_the_adhesion_is_divided_by_the_critical_force_of_its_own_value() {
        use crate::figure::{Role, study};
        let preset = preset(&[]);
        let own = preset.material.work_of_adhesion;
        let of = |key: &'static str, x: f64| {
            let values = [0.0, 1.0, 1.5, 2.0].map(|factor| Value::from(factor * x)).to_vec();
            let column = QuantityColumn::named("largest_pull").unwrap();
            let wish =
                StudyWish { preset: preset.clone(), key: Key::Borrowed(key), column, values, over: None };
            wish.run(2, &Unwatched, &mut |_| {}).unwrap()
        };
        let data = of("material.work_of_adhesion", own);
        let figure = study::of(&data, &preset, Axes::Reduced);
        assert_eq!(figure.y.title(), "largest pull (P/Pc at each γ)");
        let line = figure.lines.iter().find(|line| line.role == Role::Body).unwrap();
        assert_eq!(line.points.len(), 3);
        assert!(study::reading(&data, &preset, Axes::Reduced, 0.0).unwrap().contains("none: "));
        for (x, y) in &line.points {
            let (at, _) = data.nearest(*x).unwrap();
            let mut there = preset.clone();
            there.set(&data.wish.key, (*x).into()).unwrap();
            let StudyOutcome::Found(Cell::Number(force)) = data.outcomes[at] else { panic!("{at}") };
            let ratio = force / critical_force(&there).unwrap();
            assert!((y - ratio).abs() < 1e-12, "{x}: {y} {ratio}");
            let said = study::reading(&data, &preset, Axes::Reduced, *x).unwrap();
            let number = pulloff_engine::report::number::significant(ratio, 5);
            assert!(said.ends_with(&format!("{number} Pc")), "{said}");
        }
        // Slopes of the waves, 2πA/λ, are told where they are not small.
        let told = |data: &StudyData| {
            let notes = study::of(data, &preset, Axes::Reduced).notes;
            notes.into_iter().find(|note| note.starts_with("steep at "))
        };
        assert_eq!(told(&data), None);
        let steep = told(&of("gap.amplitude", 0.003)).unwrap();
        assert!(steep.starts_with("steep at 1 of 4: slopes up to 1."), "{steep}");
        // One P_c for all values.
        let data = of("gap.amplitude", 0.0025);
        assert_eq!(study::of(&data, &preset, Axes::Reduced).y.title(), "largest pull (P/Pc)");
        assert_eq!(study::of(&data, &preset, Axes::Raw).y.title(), "largest pull");
    }

    #[test]
    fn a_random_surface_is_studied_beside_others() {
        let mut preset = read("random-waves", shipped::find("random-waves").unwrap().text).unwrap();
        for (key, text) in [("gap.count", "4"), ("path.start_contact_radius", "0.45")] {
            preset.assign(key, text).unwrap();
        }
        let values = [0.003, 0.004, 0.006].map(Value::from).to_vec();
        let column = QuantityColumn::named("enhancement").unwrap();
        let key = Key::Borrowed("material.work_of_adhesion");
        let wish = StudyWish { preset: preset.clone(), key, column, values, over: None };
        let [one, three] = [1, 3].map(|threads| wish.run(threads, &Unwatched, &mut |_| {}).unwrap());
        let bits =
            |data: &StudyData| -> Vec<u64> { data.others.iter().flatten().map(|x| x.to_bits()).collect() };
        assert!(bits(&one) == bits(&three) && one.outcomes == three.outcomes);
        assert!(one.is_whole() && one.surfaces() == OTHERS);
        assert!(one.others[1].windows(2).all(|pair| pair[0].to_bits() != pair[1].to_bits()));
        let figure = crate::figure::study::of(&one, &preset, Axes::Raw);
        assert_eq!(figure.areas.len(), 2);
        let median = figure.lines.iter().find(|line| line.name.starts_with("median")).unwrap();
        let mut sorted = one.others[1].clone();
        sorted.sort_by(f64::total_cmp);
        assert!((median.points[1].1 - 0.5 * (sorted[19] + sorted[20])).abs() < 1e-15);
        assert!(figure.areas.iter().all(|area| {
            area.outline.iter().all(|(_, y)| (figure.bounds.y[0]..=figure.bounds.y[1]).contains(y))
        }));
        // For its own seed there is one surface per value.
        let of_seed = StudyWish { key: Key::Borrowed(SEED), ..wish };
        assert_eq!(of_seed.others(), 0);
    }
}
