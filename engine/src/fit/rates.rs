//! The rate at which the points of a retraction are pulled.

use super::options::FitError;
use super::problem::Datum;
use crate::elementary::hypot;
use crate::measured::branches::MeasuredPoint;
use crate::measured::{Abscissa, Branches, Segment};
use crate::preset::Preset;
use crate::problem::Control;
use crate::units::Quantity;
use crate::units::number::{said, short, with_unit};

/// Halves of a record whose rates differ by less than this share have one.
const EVEN: f64 = 0.05;
/// Rates agree within so many of their errors, and a stated one within this share of that of the times.
const AGREE: f64 = 4.0;
const SAME: f64 = 0.01;

/// Keeps only the points of the retraction, which alone are those of a pull.
pub(super) fn keep_retraction(data: &mut Vec<Datum>, abscissa: Abscissa, notes: &mut Vec<String>) {
    let before = data.len();
    data.retain(|datum| datum.segment == Segment::Retraction);
    if data.len() < before {
        let closing = if abscissa == Abscissa::Radius {
            ", as if it rested at the turn. After a fast approach it still closes in the first rows, which are not found from \
             contact radii: leave them out with --range force=..TO"
        } else {
            ""
        };
        notes.push(format!(
            "the {} points of the approach are left out: an edge with a speed is fitted to the retraction alone{closing}",
            before - data.len()
        ));
    }
}

/// Makes `bare` a pull at the rate of the retraction; `key` is what asks for it, and `is_said` whether the rate that
/// `bare` has is that of this file.
pub(super) fn set_rate(
    bare: &mut Preset,
    branches: &Branches,
    (key, is_said): (&str, bool),
    notes: &mut Vec<String>,
) -> Result<(), FitError> {
    let refused = |why| FitError::NoRate(key.to_owned(), why);
    if !bare.edge.has_law() {
        return Err(refused("and first guesses of edge.exponent and edge.reference_speed"));
    }
    let retraction = branches.list.iter().filter(|branch| branch.segment == Segment::Retraction);
    let attached: Vec<&MeasuredPoint> = retraction.flat_map(|branch| &branch.attached).collect();
    // The times of a file are about that file, and what the preset says is about no file in particular.
    let is_way = branches.abscissa == Abscissa::Position
        || bare.path.control == Control::Displacement && branches.abscissa == Abscissa::Approach;
    let timed = if is_way { even_rate(&attached) } else { None };
    match (timed, bare.edge.rate) {
        (None, None) if is_way => return Err(refused("which advance at a constant rate")),
        (None, None) => return Err(refused("which this file does not have")),
        (None, Some(_)) if is_way && attached.iter().any(|point| point.time.is_finite()) => {
            notes.push("the times do not give one constant rate: path.rate is used as given".to_owned());
        }
        (None, Some(_)) => {}
        (Some(timed), stated) => bare.edge.rate = Some(of_times(bare, timed, stated, is_said, notes)?),
    }
    Ok(())
}

/// The rate of a file with times: the stated one where these agree with it.
fn of_times(
    preset: &Preset,
    [rate, error]: [f64; 2],
    stated: Option<f64>,
    is_said: bool,
    notes: &mut Vec<String>,
) -> Result<f64, FitError> {
    let text = |rate| said(&preset.units, Quantity::Speed, rate);
    let margin = with_unit(&preset.units, Quantity::Speed, error, true, |x| short(x, 2));
    let found = format!("{} ± {margin}", text(rate));
    let agrees = |stated: &f64| (stated - rate).abs() <= (AGREE * error).max(SAME * rate);
    match stated {
        None => notes.push(format!("the times give path.rate = {found}")),
        Some(stated) if agrees(&stated) => {
            notes.push(format!("path.rate = {} is used as given; the times give {found}", text(stated)));
            return Ok(stated);
        }
        Some(stated) if is_said => return Err(FitError::Rate { given: text(stated), found }),
        Some(stated) => notes.push(format!(
            "the times give path.rate = {found}, which is used, not {} of the preset",
            text(stated)
        )),
    }
    Ok(rate)
}

/// The rate of x over the times of a retraction and its standard error, by least squares; `None` where it is not even or
/// not known.
fn even_rate(points: &[&MeasuredPoint]) -> Option<[f64; 2]> {
    // By x, noise would decide which half a row belongs to.
    let mut in_order = points.to_vec();
    in_order.sort_by_key(|point| point.at);
    let (one, two) = in_order.split_at(in_order.len() / 2);
    let (whole, one, two) = (rate(&in_order)?, rate(one)?, rate(two)?);
    let margin = (EVEN * whole[0]).max(AGREE * hypot(one[1], two[1]));
    let is_even = whole[0] > 0.0 && (one[0] - two[0]).abs() < margin;
    // A rate that may as well be another says nothing.
    (is_even && AGREE * whole[1] < whole[0]).then_some(whole)
}

/// −dx/dt and its standard error.
pub(super) fn rate(points: &[&MeasuredPoint]) -> Option<[f64; 2]> {
    let n = points.len() as f64;
    let mean = |of: fn(&MeasuredPoint) -> f64| points.iter().map(|point| of(point)).sum::<f64>() / n;
    let [time, x] = [mean(|point| point.time), mean(|point| point.x)];
    let [tt, tx, xx] = points.iter().fold([0.0; 3], |[tt, tx, xx], point| {
        let [t, x] = [point.time - time, point.x - x];
        [tt + t * t, tx + t * x, xx + x * x]
    });
    let slope = tx / tt;
    let left = (xx - slope * tx).max(0.0) / (n - 2.0);
    (points.len() > 2 && slope.is_finite()).then(|| [-slope, (left / tt).sqrt()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::tests::{Normal, SPHERE, preset};

    /// A retraction of 100 rows at the rate 2, with noise of x.
    fn rows(noise: f64) -> Vec<MeasuredPoint> {
        let mut normal = Normal::new(9);
        let row = |i: usize| {
            let time = i as f64;
            let x = 50.0 - 2.0 * time + noise * normal.next();
            MeasuredPoint { x, force: 0.0, radius: f64::NAN, time, row: i + 1, at: i + 1 }
        };
        let mut rows: Vec<MeasuredPoint> = (0..100).map(row).collect();
        rows.sort_by(|a, b| b.x.total_cmp(&a.x));
        rows
    }

    #[test]
    fn a_rate_is_that_of_all_rows_and_yields_to_one_that_agrees() {
        for noise in [1e-3, 0.5, 20.0] {
            let rows = rows(noise);
            let [rate, error] = even_rate(&rows.iter().collect::<Vec<_>>()).unwrap();
            // The error of a slope over 100 even rows.
            let known = noise / (100.0_f64.powi(3) / 12.0).sqrt();
            assert!((0.8..1.25).contains(&(error / known)), "{error} {known}");
            assert!((rate - 2.0).abs() < 3.5 * known, "{rate} {known}");
        }
        let mut bent = rows(1e-3);
        for point in &mut bent {
            point.x -= 0.02 * point.time.powi(2);
        }
        assert_eq!(even_rate(&bent.iter().collect::<Vec<_>>()), None);
        let preset = preset(SPHERE, 1.0, 0.02, "");
        let taken = |stated, is_said| {
            let mut notes = Vec::new();
            let rate = of_times(&preset, [1.99, 0.01], stated, is_said, &mut notes);
            (rate, notes.join("; "))
        };
        assert_eq!(taken(None, false).0, Ok(1.99));
        assert_eq!(taken(Some(2.0), true).0, Ok(2.0));
        let (of_preset, said) = taken(Some(3.0), false);
        assert_eq!(of_preset, Ok(1.99));
        assert!(said.contains("1.99 ± 0.01, which is used, not 3 of the preset"), "{said}");
        let why = taken(Some(3.0), true).0.unwrap_err().to_string();
        assert!(why.contains("given as 3, but the times of the file give 1.99 ± 0.01"), "{why}");
    }
}
