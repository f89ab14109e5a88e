//! What the numerics need from a gap.

use super::breaks::Breaks;
use crate::elementary::pow;
use std::fmt::Debug;

/// The gap and its exact derivatives at one radius.
///
/// Units: `value` a length, `first` 1, `second` 1/length, `third` 1/length².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jet {
    /// h(r).
    pub value: f64,
    /// h'(r).
    pub first: f64,
    /// h''(r).
    pub second: f64,
    /// h'''(r); used to locate limit points, not to solve.
    pub third: f64,
}

impl Jet {
    /// The jet a gap returns where it is not known.
    pub const UNKNOWN: Self = Self { value: f64::NAN, first: f64::NAN, second: f64::NAN, third: f64::NAN };
}

/// One wave of a gap's slope: h' has the term `amplitude`·`wavenumber`·sin(`wavenumber` r + phase).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// A, a length.
    pub amplitude: f64,
    /// q = 2π/λ, positive, 1/length.
    pub wavenumber: f64,
    /// The sine and the cosine of the phase.
    pub phase: [f64; 2],
}

/// One piece of a gap that is a cubic between its knots: h' = c₀ + c₁t + c₂t², t = r − `lo`, on [`lo`, `hi`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The smaller end.
    pub lo: f64,
    /// The larger end.
    pub hi: f64,
    /// c₀, c₁, c₂.
    pub slope: [f64; 3],
}

/// What is known about a gap as a function, beyond its values. Transforms of some forms are found faster, or in closed
/// form.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// Nothing.
    Any,
    /// h = c rⁿ.
    Power {
        /// c, a length to the power 1 − n.
        factor: f64,
        /// n.
        exponent: f64,
    },
    /// A paraboloid, h'' = `curvature`, with waves.
    Waves {
        /// 1/R.
        curvature: f64,
        /// The waves.
        waves: Vec<Wave>,
    },
    /// A cubic between knots, from the axis to the last row.
    Cubic(Vec<Piece>),
}

/// A disc of the complex plane over which a gap's slope is bounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComplexDisc {
    /// Its centre c, a real radius.
    pub centre: f64,
    /// Its radius R.
    pub radius: f64,
    /// A real radius r. It selects the branch of abs, min, max, sign and step: the one that holds at r, continued over
    /// the disc.
    pub branch: f64,
}

/// The largest number of breaks of one gap.
pub const MOST_BREAKS: usize = 100_000;

/// An axisymmetric initial gap h(r) between the undeformed bodies, with h(0) = 0.
pub trait Gap: Debug + Send + Sync {
    /// The gap and its derivatives at the radius `r ≥ 0`.
    fn jet(&self, r: f64) -> Jet;

    /// h at the radii s·x for every x of `nodes`, into a slice of the same length.
    ///
    /// Sums over the gap need many radii at once. A gap that can compute them together overrides this.
    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        for (value, x) in values.iter_mut().zip(nodes) {
            *value = self.jet(s * x).value;
        }
    }

    /// h', h'' and h''' at the radii s·x for every x of `nodes`, each into a slice of the same length.
    fn derivatives(&self, s: f64, nodes: &[f64], [first, second, third]: [&mut [f64]; 3]) {
        for (((first, second), third), x) in first.iter_mut().zip(second).zip(third).zip(nodes) {
            let jet = self.jet(s * x);
            (*first, *second, *third) = (jet.first, jet.second, jet.third);
        }
    }

    /// The shortest wave of the gap, or `None` when it has none.
    ///
    /// Step lengths and mesh warnings are based on it.
    fn feature_length(&self) -> Option<f64>;

    /// λ of a gap with a single wave, whose crests are at r = mλ. `None` for every other gap, where s divided by the
    /// shortest wave counts no crests.
    fn wavelength(&self) -> Option<f64> {
        None
    }

    /// Where the gap is not smooth.
    ///
    /// Sums over it, in a disc or along the curve, are split there.
    fn breaks(&self) -> Breaks<'_> {
        Breaks::default()
    }

    /// An upper bound of |h'| on `disc` for the analytic continuation of the smooth piece that holds at its `branch`;
    /// infinite where there is no bound: a pole or a branch point.
    ///
    /// `None` means that the gap promises nothing about complex radii. How finely it must be divided is then judged
    /// from samples.
    fn slope_bound(&self, disc: ComplexDisc) -> Option<f64> {
        let _ = disc;
        None
    }

    /// All radii above 0 and below `to` where h or a derivative may jump, ascending, to the last bit.
    ///
    /// Some may be superfluous, but none is missing unless the gap has more than [`MOST_BREAKS`].
    fn breaks_up_to(&self, to: f64) -> Vec<f64> {
        self.breaks().between(0.0, to).to_vec()
    }

    /// What is known about it as a function.
    fn form(&self) -> Form {
        Form::Any
    }

    /// The name of the first function in the gap that has no rule for its slope over complex discs. The gap is then not
    /// certified.
    fn uncertified(&self) -> Option<&'static str> {
        None
    }

    /// The length by which the problem is reduced (the radius of curvature, where there is one).
    fn reference_length(&self) -> f64;

    /// The radius beyond which the gap is not known, or `None` when it is known everywhere.
    ///
    /// Jets beyond it are NaN throughout, so nothing computed from them can be mistaken for a result.
    fn largest_radius(&self) -> Option<f64> {
        None
    }
}

/// A gap measured in another length: h̃(r̃) = h(L r̃)/L.
#[derive(Debug)]
pub struct Scaled<G> {
    gap: G,
    length: f64,
    knots: Vec<f64>,
}

impl<G: Gap> Scaled<G> {
    /// The gap `gap` with lengths divided by `length`.
    pub fn new(gap: G, length: f64) -> Self {
        let knots = gap.breaks().knots.iter().map(|knot| knot / length).collect();
        Self { gap, length, knots }
    }
}

impl<G: Gap> Gap for Scaled<G> {
    fn jet(&self, r: f64) -> Jet {
        let l = self.length;
        let jet = self.gap.jet(l * r);
        Jet { value: jet.value / l, first: jet.first, second: jet.second * l, third: jet.third * l * l }
    }

    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        self.gap.values(self.length * s, nodes, values);
        for value in values {
            *value /= self.length;
        }
    }

    fn derivatives(&self, s: f64, nodes: &[f64], [first, second, third]: [&mut [f64]; 3]) {
        let l = self.length;
        self.gap.derivatives(l * s, nodes, [first, &mut *second, &mut *third]);
        for (second, third) in second.iter_mut().zip(third) {
            *second *= l;
            *third *= l * l;
        }
    }

    fn feature_length(&self) -> Option<f64> {
        self.gap.feature_length().map(|f| f / self.length)
    }

    fn wavelength(&self) -> Option<f64> {
        self.gap.wavelength().map(|wavelength| wavelength / self.length)
    }

    fn breaks(&self) -> Breaks<'_> {
        Breaks { knots: &self.knots, ..self.gap.breaks() }
    }

    fn form(&self) -> Form {
        let l = self.length;
        match self.gap.form() {
            Form::Any => Form::Any,
            Form::Power { factor, exponent } => {
                Form::Power { factor: factor * pow(l, exponent - 1.0), exponent }
            }
            Form::Waves { curvature, waves } => {
                let scaled = |wave: Wave| Wave {
                    amplitude: wave.amplitude / l,
                    wavenumber: wave.wavenumber * l,
                    phase: wave.phase,
                };
                Form::Waves { curvature: curvature * l, waves: waves.into_iter().map(scaled).collect() }
            }
            Form::Cubic(pieces) => {
                let scaled = |Piece { lo, hi, slope: [a, b, c] }| Piece {
                    lo: lo / l,
                    hi: hi / l,
                    slope: [a, b * l, c * l * l],
                };
                Form::Cubic(pieces.into_iter().map(scaled).collect())
            }
        }
    }

    fn slope_bound(&self, ComplexDisc { centre, radius, branch }: ComplexDisc) -> Option<f64> {
        let l = self.length;
        self.gap.slope_bound(ComplexDisc { centre: l * centre, radius: l * radius, branch: l * branch })
    }

    fn breaks_up_to(&self, to: f64) -> Vec<f64> {
        let l = self.length;
        let mut breaks: Vec<f64> =
            self.gap.breaks_up_to(l * to).into_iter().map(|b| first_beyond(b, l)).collect();
        breaks.retain(|b| *b < to);
        breaks
    }

    fn uncertified(&self) -> Option<&'static str> {
        self.gap.uncertified()
    }

    fn reference_length(&self) -> f64 {
        self.gap.reference_length() / self.length
    }

    fn largest_radius(&self) -> Option<f64> {
        self.gap.largest_radius().map(|r| r / self.length)
    }
}

/// The smallest r̃ whose rounded L r̃ is ≥ r: a break stays on the same side of what lies beside it.
fn first_beyond(r: f64, length: f64) -> f64 {
    let mut scaled = r / length;
    while length * scaled < r {
        scaled = scaled.next_up();
    }
    while length * scaled.next_down() >= r {
        scaled = scaled.next_down();
    }
    scaled
}

/// The index of the crest at which an edge of radius `s` sits: floor(s/λ + ½). Crests are at r = mλ.
pub fn wave_index(s: f64, wavelength: Option<f64>) -> Option<u64> {
    // s/λ is positive and far below 2^53.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    wavelength.map(|wave| (s / wave + 0.5).floor() as u64)
}
