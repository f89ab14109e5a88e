//! What the numerics ask of a gap.

use super::breaks::Breaks;
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
    /// What a gap answers where it is not known.
    pub const UNKNOWN: Self = Self { value: f64::NAN, first: f64::NAN, second: f64::NAN, third: f64::NAN };
}

/// An axisymmetric initial gap h(r) between the undeformed bodies, with h(0) = 0.
pub trait Gap: Debug + Send + Sync {
    /// The gap and its derivatives at the radius `r ≥ 0`.
    fn jet(&self, r: f64) -> Jet;

    /// h at the radii s·x for every x of `nodes`, into a slice as long as they are.
    ///
    /// Sums over the gap ask for many radii at once: a gap that answers them together says so here.
    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        for (value, x) in values.iter_mut().zip(nodes) {
            *value = self.jet(s * x).value;
        }
    }

    /// h', h'' and h''' at the radii s·x for every x of `nodes`, each into a slice as long as they are.
    fn derivatives(&self, s: f64, nodes: &[f64], [first, second, third]: [&mut [f64]; 3]) {
        for (((first, second), third), x) in first.iter_mut().zip(second).zip(third).zip(nodes) {
            let jet = self.jet(s * x);
            (*first, *second, *third) = (jet.first, jet.second, jet.third);
        }
    }

    /// The shortest wave of the gap, or `None` when it has none.
    ///
    /// Step lengths and mesh warnings are measured by it.
    fn feature_length(&self) -> Option<f64>;

    /// λ of a gap with one wave alone, whose crests are at r = mλ; `None` for every other, where s over the shortest
    /// wave counts no crests.
    fn wavelength(&self) -> Option<f64> {
        None
    }

    /// The shortest wave of a gap that is smooth in r apart from its waves, or `None` where nothing is promised.
    ///
    /// Sums over such a gap take no more nodes than its waves need.
    fn band_limit(&self) -> Option<f64> {
        None
    }

    /// Where the gap is not smooth.
    ///
    /// Sums over it, in a disc or along the curve, are broken there.
    fn breaks(&self) -> Breaks<'_> {
        Breaks::default()
    }

    /// The length by which the problem is reduced (the radius of curvature, where there is one).
    fn reference_length(&self) -> f64;

    /// The radius beyond which the gap is not known, or `None` when it is known everywhere.
    ///
    /// Jets beyond it are NaN throughout, so that nothing computed from them can pass for a result.
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
    /// The gap `gap`, lengths divided by `length`.
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

    fn band_limit(&self) -> Option<f64> {
        self.gap.band_limit().map(|f| f / self.length)
    }

    fn breaks(&self) -> Breaks<'_> {
        Breaks { knots: &self.knots, ..self.gap.breaks() }
    }

    fn reference_length(&self) -> f64 {
        self.gap.reference_length() / self.length
    }

    fn largest_radius(&self) -> Option<f64> {
        self.gap.largest_radius().map(|r| r / self.length)
    }
}

impl<G: Gap + ?Sized> Gap for std::sync::Arc<G> {
    fn jet(&self, r: f64) -> Jet {
        (**self).jet(r)
    }

    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        (**self).values(s, nodes, values);
    }

    fn derivatives(&self, s: f64, nodes: &[f64], derivatives: [&mut [f64]; 3]) {
        (**self).derivatives(s, nodes, derivatives);
    }

    fn feature_length(&self) -> Option<f64> {
        (**self).feature_length()
    }

    fn wavelength(&self) -> Option<f64> {
        (**self).wavelength()
    }

    fn band_limit(&self) -> Option<f64> {
        (**self).band_limit()
    }

    fn breaks(&self) -> Breaks<'_> {
        (**self).breaks()
    }

    fn reference_length(&self) -> f64 {
        (**self).reference_length()
    }

    fn largest_radius(&self) -> Option<f64> {
        (**self).largest_radius()
    }
}
