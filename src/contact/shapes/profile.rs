//! A measured profile: a smooth even curve through its rows, or near them.
//!
//! Radii and gaps are lengths in one unit, the radii from the axis. With κ and c from the weighted least squares of
//! h ≈ c + κr²/2 over all rows,
//!
//! ```text
//! h(r) = κr²/2 + f(r) − f(0)
//! ```
//!
//! f is the even spline of the module [`spline`](super::spline) through what the paraboloid leaves, so that smoothing does
//! not flatten the body and a measured paraboloid stays one to its last row. h and two derivatives are continuous,
//! h'(0) = 0, and h''' jumps from row to row: where limit points are located with it, bracketing stands in.
//!
//! Rows that do not begin at 0 are continued to the axis by the even parabola that the spline has there; h(0) = 0 then
//! holds by subtraction, whatever height the rows were measured from. Beyond the last row nothing is known and nothing is
//! extrapolated: [`Gap::largest_radius`] says where, and jets beyond are NaN.
//!
//! The reference length is R = 1/κ, or the largest radius where κ is not positive. The feature length is the mean
//! distance of the crests of f as a random profile would have it, 2π √(∫f'²/∫f''²) (λ itself for a single wave), and
//! none where f is rounding, or bends over more than the profile is wide. M. S. Longuet-Higgins, Phil. Trans. R. Soc. A
//! 249, 321 (1957), doi:10.1098/rsta.1957.0002.

use super::spline::{Fit, Rows};
use crate::contact::{Axis, Breaks, Gap, Jet};
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::f64::consts::TAU;

/// The fewest rows of a profile.
pub const FEWEST_ROWS: usize = 8;

/// The largest cutoff in mean distances of the rows: the equations lose a digit for each factor of 1.8 in it, and at this
/// one six digits of the curve are left.
pub const MOST_SPACINGS: f64 = 1000.0;

/// Neighbours closer than this share of the largest radius are one row measured twice.
pub const CLOSEST: f64 = 1e-9;

/// Beyond the last row by rounding: what a change of units there and back may cost.
const ROUNDING: f64 = 1e-15;

/// What the paraboloid leaves is rounding below this share of the largest gap.
const NO_WAVES: f64 = 1e-12;

/// How near the curve keeps to the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// Through every row.
    None,
    /// Waves of this length, in the unit of the radii, pass by half; shorter ones less, longer ones more.
    Cutoff(f64),
    /// The cutoff that generalized cross-validation finds: noise that differs from row to row at random goes.
    Auto,
}

/// The gap of a measured profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// 0, and the radii of the rows.
    knots: Vec<f64>,
    /// The jet at each knot but the last: the cubic from there on.
    pieces: Vec<Jet>,
    curvature: f64,
    feature: Option<f64>,
    cutoff: Option<f64>,
    removed: f64,
}

/// Why rows are no profile. Rows are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum InvalidProfile {
    /// The columns are not equally long.
    #[error("{radii} radii and {gaps} gaps: every row needs both")]
    Columns {
        /// Radii.
        radii: usize,
        /// Gaps.
        gaps: usize,
    },
    /// Too few rows.
    #[error("{0} rows are too few for a profile: at least {FEWEST_ROWS} are needed")]
    TooFew(usize),
    /// A number is infinite or no number.
    #[error("row {0} of the profile is not finite")]
    NotFinite(usize),
    /// A radius is negative.
    #[error("row {row} of the profile has the radius {radius:e}: radii count from the axis")]
    Negative {
        /// The row.
        row: usize,
        /// Its radius.
        radius: f64,
    },
    /// The radii do not ascend.
    #[error("{}", not_ascending(&UnitSystem::Reduced, *.row, [*.radius, *.before]))]
    NotAscending {
        /// The row.
        row: usize,
        /// Its radius.
        radius: f64,
        /// The radius before it.
        before: f64,
    },
    /// The cutoff is out of range.
    #[error("{}", far_cutoff(&UnitSystem::Reduced, [*.cutoff, *.most]))]
    Cutoff {
        /// The cutoff.
        cutoff: f64,
        /// The largest.
        most: f64,
    },
    /// The equations of the spline cannot be solved.
    #[error("{}", unsolved(&UnitSystem::Reduced, *.0))]
    Unsolved(f64),
}

/// A length in a message.
fn length(units: &UnitSystem, x: f64) -> String {
    said(units, Quantity::Length, x)
}

fn not_ascending(units: &UnitSystem, row: usize, radii: [f64; 2]) -> String {
    let [radius, before] = radii.map(|r| length(units, r));
    format!(
        "row {row} of the profile has the radius {radius}, which is not above the one before, {before}, by {CLOSEST:e} of \
         the largest"
    )
}

fn far_cutoff(units: &UnitSystem, lengths: [f64; 2]) -> String {
    let [cutoff, most] = lengths.map(|x| length(units, x));
    format!(
        "the cutoff {cutoff} is out of range: it must be positive and at most {most}, {MOST_SPACINGS} mean distances of \
         the rows"
    )
}

fn unsolved(units: &UnitSystem, cutoff: f64) -> String {
    let cutoff = length(units, cutoff);
    format!("no smooth curve was found for the profile: its radii are too uneven for the cutoff {cutoff}")
}

impl InvalidProfile {
    /// What is wrong, with lengths as `units` show them.
    pub fn words(&self, units: &UnitSystem) -> String {
        match *self {
            Self::NotAscending { row, radius, before } => not_ascending(units, row, [radius, before]),
            Self::Cutoff { cutoff, most } => far_cutoff(units, [cutoff, most]),
            Self::Unsolved(cutoff) => unsolved(units, cutoff),
            other => other.to_string(),
        }
    }
}

impl Profile {
    /// The profile of `gaps` at `radii ≥ 0`, ascending, both in one unit of length.
    ///
    /// # Errors
    /// [`InvalidProfile`] with the row or the number.
    pub fn new(radii: &[f64], gaps: &[f64], smoothing: Smoothing) -> Result<Self, InvalidProfile> {
        check(radii, gaps)?;
        let last = radii[radii.len() - 1];
        let spacing = (last - radii[0]) / (radii.len() - 1) as f64;
        let most = MOST_SPACINGS * spacing;
        if let Smoothing::Cutoff(cutoff) = smoothing
            && !(cutoff > 0.0 && cutoff <= most)
        {
            return Err(InvalidProfile::Cutoff { cutoff, most });
        }
        // Of the order of one, by powers of two: fourth powers of lengths keep their range, numbers their digits.
        let (length, height) = (power_of_two(last), power_of_two(largest(gaps)));
        let x: Vec<f64> = radii.iter().map(|r| r / length).collect();
        let y: Vec<f64> = gaps.iter().map(|h| h / height).collect();
        let weights = Rows::new(&x, &y).weights().to_vec();
        let curvature = paraboloid(&x, &y, &weights);
        let left: Vec<f64> = x.iter().zip(&y).map(|(x, y)| y - 0.5 * curvature * x * x).collect();
        let rows = Rows::new(&x, &left);
        let cutoff = match smoothing {
            Smoothing::None => None,
            Smoothing::Cutoff(cutoff) => Some(cutoff / length),
            Smoothing::Auto => Some(rows.cutoff(2.0 * spacing / length, last.min(most) / length)),
        };
        let unsolved = || InvalidProfile::Unsolved(cutoff.unwrap_or(0.0) * length);
        let fit = rows.fit(cutoff.unwrap_or(0.0)).ok_or_else(unsolved)?;
        let removed = rms(left.iter().zip(&fit.values).map(|(y, g)| y - g), &weights);
        let feature = feature(&rows, &fit, largest(&y), x[x.len() - 1]);
        let (knots, pieces) = pieces(&rows, &fit, &x, curvature);
        let in_units = |jet: Jet| Jet {
            value: jet.value * height,
            first: jet.first * (height / length),
            second: jet.second * (height / (length * length)),
            third: jet.third * (height / (length * length * length)),
        };
        Ok(Self {
            knots: knots.into_iter().map(|x| x * length).collect(),
            pieces: pieces.into_iter().map(in_units).collect(),
            curvature: curvature * (height / (length * length)),
            feature: feature.map(|wave| wave * length),
            cutoff: cutoff.map(|cutoff| cutoff * length),
            removed: removed * height,
        })
    }

    /// R of the paraboloid nearest to the rows, where they rise.
    pub fn radius_of_curvature(&self) -> Option<f64> {
        (self.curvature > 0.0).then_some(self.curvature.recip())
    }

    /// The cutoff of the smoothing, given or found.
    pub fn cutoff(&self) -> Option<f64> {
        self.cutoff
    }

    /// Root mean square of what the smoothing took away: the noise, where it was found automatically.
    pub fn removed(&self) -> f64 {
        self.removed
    }

    /// The radii where h''' jumps: 0 and the radii of the rows.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }
}

impl Profile {
    /// The jet at `r`; `at` is the piece it is looked for in first, and then that of `r`.
    fn jet_near(&self, r: f64, at: &mut usize) -> Jet {
        let last = self.knots[self.knots.len() - 1];
        if r.is_nan() || r > last * (1.0 + ROUNDING) {
            return Jet::UNKNOWN;
        }
        // Sums ask in order: most radii lie in the piece of the one before.
        if r < self.knots[*at] || r >= self.knots[*at + 1] {
            let above = self.knots.partition_point(|knot| *knot <= r);
            *at = above.saturating_sub(1).min(self.pieces.len() - 1);
        }
        let i = *at;
        let (x, Jet { value, first, second, third }) = (r - self.knots[i], self.pieces[i]);
        Jet {
            value: value + x * (first + x * (0.5 * second + x * third / 6.0)),
            first: first + x * (second + 0.5 * x * third),
            second: second + x * third,
            third,
        }
    }
}

impl Gap for Profile {
    fn jet(&self, r: f64) -> Jet {
        self.jet_near(r, &mut 0)
    }

    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        let mut at = 0;
        for (value, x) in values.iter_mut().zip(nodes) {
            *value = self.jet_near(s * x, &mut at).value;
        }
    }

    fn derivatives(&self, s: f64, nodes: &[f64], [first, second, third]: [&mut [f64]; 3]) {
        let mut at = 0;
        for (((first, second), third), x) in first.iter_mut().zip(second).zip(third).zip(nodes) {
            let jet = self.jet_near(s * x, &mut at);
            (*first, *second, *third) = (jet.first, jet.second, jet.third);
        }
    }

    /// The knots without the axis, where the cubic of the first piece is not even.
    fn breaks(&self) -> Breaks<'_> {
        Breaks { knots: &self.knots[1..], axis: Axis::Odd, cubic: true }
    }

    fn feature_length(&self) -> Option<f64> {
        self.feature
    }

    fn reference_length(&self) -> f64 {
        self.radius_of_curvature().unwrap_or(self.knots[self.knots.len() - 1])
    }

    fn largest_radius(&self) -> Option<f64> {
        self.knots.last().copied()
    }
}

fn check(radii: &[f64], gaps: &[f64]) -> Result<(), InvalidProfile> {
    if radii.len() != gaps.len() {
        return Err(InvalidProfile::Columns { radii: radii.len(), gaps: gaps.len() });
    }
    if radii.len() < FEWEST_ROWS {
        return Err(InvalidProfile::TooFew(radii.len()));
    }
    if let Some(row) = radii.iter().zip(gaps).position(|(r, h)| !(r.is_finite() && h.is_finite())) {
        return Err(InvalidProfile::NotFinite(row));
    }
    if radii[0] < 0.0 {
        return Err(InvalidProfile::Negative { row: 0, radius: radii[0] });
    }
    let closest = CLOSEST * largest(radii);
    for (row, pair) in radii.windows(2).enumerate() {
        if pair[1] - pair[0] <= closest {
            return Err(InvalidProfile::NotAscending { row: row + 1, radius: pair[1], before: pair[0] });
        }
    }
    Ok(())
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// A power of two of the size of `x ≥ 0`; 1 for 0.
fn power_of_two(x: f64) -> f64 {
    if x > 0.0 { x.log2().round().exp2() } else { 1.0 }
}

fn rms(values: impl Iterator<Item = f64>, weights: &[f64]) -> f64 {
    let square: f64 = values.zip(weights).map(|(x, w)| w * x * x).sum();
    (square / weights.iter().sum::<f64>()).sqrt()
}

/// κ of the paraboloid c + κx²/2 nearest to the rows.
fn paraboloid(x: &[f64], y: &[f64], weights: &[f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let mean =
        |values: &mut dyn Iterator<Item = f64>| values.zip(weights).map(|(v, w)| v * w).sum::<f64>() / total;
    let halves: Vec<f64> = x.iter().map(|x| 0.5 * x * x).collect();
    let (half, height) = (mean(&mut halves.iter().copied()), mean(&mut y.iter().copied()));
    let product = mean(&mut halves.iter().zip(y).map(|(x, y)| (x - half) * (y - height)));
    product / mean(&mut halves.iter().map(|x| (x - half) * (x - half)))
}

/// The mean distance of the crests of f; none where f is rounding or wider than the profile.
fn feature(rows: &Rows, fit: &Fit, height: f64, widest: f64) -> Option<f64> {
    let weights = rows.weights();
    let mean = fit.values.iter().zip(weights).map(|(g, w)| g * w).sum::<f64>() / weights.iter().sum::<f64>();
    if rms(fit.values.iter().map(|g| g - mean), weights) <= NO_WAVES * height {
        return None;
    }
    let slope = rms(rows.pieces(fit).iter().map(|piece| piece.first), weights);
    let bend = rms(fit.second.iter().copied(), weights);
    Some(TAU * slope / bend).filter(|wave| *wave < widest)
}

/// The knots from the axis on, and the jets of h there.
fn pieces(rows: &Rows, fit: &Fit, x: &[f64], curvature: f64) -> (Vec<f64>, Vec<Jet>) {
    let mut jets = rows.pieces(fit);
    let mut knots = x.to_vec();
    // An even cubic is a parabola: to the axis the second derivative stays and the third vanishes.
    let axis = fit.values[0] - 0.5 * fit.second[0] * x[0] * x[0];
    for (jet, &x) in jets.iter_mut().zip(x) {
        jet.value += 0.5 * curvature * x * x - axis;
        jet.first += curvature * x;
        jet.second += curvature;
    }
    let second = fit.second[0] + curvature;
    if x[0] > 0.0 {
        knots.insert(0, 0.0);
        jets.insert(0, Jet { second, ..Jet::default() });
    } else {
        // Zero but for rounding.
        jets[0] = Jet { value: 0.0, first: 0.0, ..jets[0] };
    }
    (knots, jets)
}

#[cfg(test)]
mod tests {
    use super::super::examples::check_two_derivatives;
    use super::*;
    use crate::contact::shapes::split_mix::SplitMix64;
    use crate::contact::shapes::{Harmonic, Harmonics};

    fn even(n: usize, last: f64) -> Vec<f64> {
        (0..=n).map(|i| last * i as f64 / n as f64).collect()
    }

    fn sampled(gap: &dyn Gap, radii: &[f64]) -> Vec<f64> {
        radii.iter().map(|&r| gap.jet(r).value).collect()
    }

    fn wavy() -> Harmonics {
        let wave = Harmonic { amplitude: 0.0025, wavelength: 0.1, phase: 0.0 };
        Harmonics::new(1.0, vec![wave]).unwrap()
    }

    #[test]
    fn derivatives_agree_with_central_differences_between_the_rows() {
        let radii = even(300, 0.5);
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        for i in 1..299 {
            // In the middle of a piece, over less than its width: there h is one cubic and h''' its own.
            let r = 0.5 * (radii[i] + radii[i + 1]);
            check_two_derivatives(&profile, r, 0.1);
            let (e, at) = (1e-4, profile.jet(r));
            let third = (profile.jet(r + e).second - profile.jet(r - e).second) / (2.0 * e);
            assert!((third - at.third).abs() <= 1e-9 * at.second.abs() / e);
        }
    }

    #[test]
    fn it_passes_the_rows_and_nears_the_gap_in_the_fourth_order() {
        let error = |n: usize| {
            let radii = even(n, 0.5);
            let rows = sampled(&wavy(), &radii);
            let profile = Profile::new(&radii, &rows, Smoothing::None).unwrap();
            for (&r, h) in radii.iter().zip(&rows) {
                assert!((profile.jet(r).value - h).abs() <= 1e-15, "{r}");
            }
            (0..1000)
                .map(|i| 4e-4 * f64::from(i))
                .map(|r| (profile.jet(r).value - wavy().jet(r).value).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(100) / error(200)).log2();
        assert!((3.7..4.3).contains(&order), "{order}");
    }

    #[test]
    fn a_measured_paraboloid_stays_one() {
        // In odd units, with the heights counted from elsewhere, and not from the axis.
        let radii: Vec<f64> = even(50, 3e-4).into_iter().skip(3).collect();
        let gaps: Vec<f64> = radii.iter().map(|r| 5e-6 + r * r / (2.0 * 2e-2)).collect();
        for smoothing in [Smoothing::None, Smoothing::Cutoff(1e-4), Smoothing::Auto] {
            let profile = Profile::new(&radii, &gaps, smoothing).unwrap();
            assert!((profile.radius_of_curvature().unwrap() / 2e-2 - 1.0).abs() < 1e-8);
            assert_eq!((profile.knots()[0], profile.largest_radius()), (0.0, Some(3e-4)));
            for r in [0.0, 1e-6, 1.1e-4, 3e-4] {
                let jet = profile.jet(r);
                assert!((jet.value - r * r / 4e-2).abs() < 1e-8 * 2.25e-6, "{smoothing:?} {r}");
                assert!((jet.first - r / 2e-2).abs() < 1e-7 * 1.5e-2, "{smoothing:?} {r}");
            }
            let axis = profile.jet(0.0);
            assert_eq!(axis, Jet { second: axis.second, ..Jet::default() });
        }
    }

    #[test]
    fn the_wave_and_the_sphere_are_told_apart() {
        let radii = even(500, 0.5);
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        assert!(
            (profile.feature_length().unwrap() / 0.1 - 1.0).abs() < 0.03,
            "{:?}",
            profile.feature_length()
        );
        assert!((profile.reference_length() - 1.0).abs() < 0.01);
        assert_eq!((profile.cutoff(), profile.removed()), (None, 0.0));
        let sphere = crate::contact::Shape::Sphere { radius_of_curvature: 0.7 };
        let smooth = Profile::new(&radii, &sampled(&sphere, &radii), Smoothing::None).unwrap();
        assert_eq!(smooth.feature_length(), None);
    }

    #[test]
    fn noise_is_measured_and_removed() {
        let radii = even(2000, 0.5);
        let mut random = SplitMix64::new(5);
        let noise = 1e-4;
        let gaps: Vec<f64> = sampled(&wavy(), &radii)
            .into_iter()
            .map(|h| h + noise * 6.0_f64.sqrt() * (random.unit() + random.unit() - 1.0))
            .collect();
        let profile = Profile::new(&radii, &gaps, Smoothing::Auto).unwrap();
        assert!((profile.removed() / noise - 1.0).abs() < 0.1, "{}", profile.removed());
        let cutoff = profile.cutoff().unwrap();
        assert!((0.01..0.1).contains(&cutoff), "{cutoff}");
        assert!(
            (profile.feature_length().unwrap() / 0.1 - 1.0).abs() < 0.2,
            "{:?}",
            profile.feature_length()
        );
    }

    #[test]
    fn nothing_is_known_beyond_the_last_row() {
        let radii = even(20, 0.3);
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        assert!(profile.jet(0.3).value.is_finite() && profile.jet(0.3_f64.next_up()).value.is_finite());
        for r in [0.300_000_1, 1e9, f64::NAN] {
            assert!(profile.jet(r).value.is_nan() && profile.jet(r).third.is_nan(), "{r}");
        }
    }

    #[test]
    fn a_dimple_is_reduced_by_its_width() {
        let radii = even(20, 0.3);
        let gaps: Vec<f64> = radii.iter().map(|r| -r * r).collect();
        let profile = Profile::new(&radii, &gaps, Smoothing::None).unwrap();
        assert_eq!((profile.radius_of_curvature(), profile.reference_length()), (None, 0.3));
        let flat = Profile::new(&radii, &[0.0; 21], Smoothing::Auto).unwrap();
        assert_eq!(flat.jet(0.1), Jet::default());
    }

    #[test]
    fn rows_that_are_no_profile_are_refused_with_their_number() {
        let good = even(9, 1.0);
        let refused = |change: &dyn Fn(&mut Vec<f64>, &mut Vec<f64>), smoothing| {
            let (mut radii, mut gaps) = (good.clone(), vec![0.5; 10]);
            change(&mut radii, &mut gaps);
            Profile::new(&radii, &gaps, smoothing).unwrap_err()
        };
        let plain = |change: &dyn Fn(&mut Vec<f64>, &mut Vec<f64>)| refused(change, Smoothing::None);
        assert_eq!(plain(&|r, _| r.truncate(9)), InvalidProfile::Columns { radii: 9, gaps: 10 });
        let few = |r: &mut Vec<f64>, h: &mut Vec<f64>| (r.truncate(7), h.truncate(7)).0;
        assert_eq!(plain(&few), InvalidProfile::TooFew(7));
        assert_eq!(plain(&|_, h| h[4] = f64::INFINITY), InvalidProfile::NotFinite(4));
        assert_eq!(plain(&|r, _| r[0] = -0.1), InvalidProfile::Negative { row: 0, radius: -0.1 });
        let same = InvalidProfile::NotAscending { row: 3, radius: good[2], before: good[2] };
        assert_eq!(plain(&|r, _| r[3] = r[2]), same);
        for cutoff in [0.0, -1.0, f64::NAN, 112.0] {
            let error = refused(&|_, _| (), Smoothing::Cutoff(cutoff)).to_string();
            assert!(error.contains("out of range"), "{error}");
        }
    }
}
