//! Closed forms of bodies in contact, from which measured curves are made.
//!
//! Nothing of the engine is used. Symbols: s is the contact radius, R the radius of curvature, E the effective modulus,
//! w the work of adhesion, g(a) = a∫₀^{π/2} h'(a sin t) dt the transform of the gap h. For a body whose adhesion acts
//! only within its contact,
//! ```text
//! δ = g(s) − √(2πws/E)        P = 2E (δs − ∫₀^s g)
//! ```
//!
//! K. L. Johnson, K. Kendall and A. D. Roberts, Proc. R. Soc. A 324, 301 (1971); P. R. Guduru, J. Mech. Phys. Solids
//! 55, 445 (2007) for the wavy sphere; D. Maugis, J. Colloid Interface Sci. 150, 243 (1992) for adhesion with a range.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// One equilibrium, in SI.
#[derive(Debug, Clone, Copy)]
pub struct State {
    /// δ, which grows as the bodies are pressed together.
    pub approach: f64,
    /// P, positive in compression.
    pub force: f64,
    /// s.
    pub radius: f64,
}

/// The equilibria of a body, from the first touch at 0 outward to 1.
pub struct Body(Box<dyn Fn(f64) -> State + Send + Sync>);

/// The shape of the gap between the bodies.
#[derive(Debug, Clone, Copy)]
pub enum Gap {
    /// h = r²/2R.
    Sphere { radius: f64 },
    /// h = c r⁴.
    Quartic { coefficient: f64 },
    /// h = c r.
    Cone { slope: f64 },
    /// h = r²/2R + A (1 − cos 2πr/λ).
    Wavy { radius: f64, amplitude: f64, wavelength: f64 },
}

/// Simpson's rule on [0, π/2].
fn quarter(of: impl Fn(f64) -> f64, intervals: usize) -> f64 {
    let h = FRAC_PI_2 / intervals as f64;
    let inside = |i: usize| if i % 2 == 1 { 4.0 } else { 2.0 } * of(i as f64 * h);
    (of(0.0) + of(FRAC_PI_2) + (1..intervals).map(inside).sum::<f64>()) * h / 3.0
}

/// H₀ and H₁, the Struve functions, by their integrals (NIST Handbook of Mathematical Functions, 11.5.1).
fn struve(z: f64) -> [f64; 2] {
    // An even number, and fine enough for the waves of the integrand.
    let intervals = 40 + 4 * (z.abs().ceil().min(1e6) as usize);
    let zeroth = quarter(|t| (z * t.cos()).sin(), intervals) * 2.0 / PI;
    let first = quarter(|t| (z * t.cos()).sin() * t.sin().powi(2), intervals) * 2.0 * z / PI;
    [zeroth, first]
}

impl Gap {
    /// g(s) and ∫₀^s g.
    pub fn transform(self, s: f64) -> [f64; 2] {
        match self {
            Self::Sphere { radius } => [s * s / radius, s.powi(3) / (3.0 * radius)],
            Self::Quartic { coefficient: c } => [8.0 / 3.0 * c * s.powi(4), 8.0 / 15.0 * c * s.powi(5)],
            Self::Cone { slope } => [FRAC_PI_2 * slope * s, 0.25 * PI * slope * s * s],
            Self::Wavy { radius, amplitude: a, wavelength } => {
                let q = TAU * s / wavelength;
                let [zeroth, first] = struve(q);
                let over_q = if q > 0.0 { first / q } else { 0.0 };
                let wave = PI * PI * a * s / wavelength;
                let g = s * s / radius + wave * zeroth;
                // g s − ∫g is half of Guduru's force without adhesion, divided by E.
                let pressed = 2.0 * s.powi(3) / (3.0 * radius) + wave * s * (zeroth - over_q);
                [g, g * s - pressed]
            }
        }
    }
}

impl Body {
    /// The equilibrium at the share `at` of the way from the first touch outward.
    pub fn at(&self, at: f64) -> State {
        (self.0)(at)
    }

    /// Adhesion without a range, with the work of adhesion `w`, up to the contact radius `most`; no adhesion if `w` is
    /// 0.
    pub fn adhesive(gap: Gap, e: f64, w: f64, most: f64) -> Self {
        Self(Box::new(move |at| {
            let radius = at * most;
            let [g, area] = gap.transform(radius);
            let approach = g - (TAU * w * radius / e).sqrt();
            State { approach, force: 2.0 * e * (approach * radius - area), radius }
        }))
    }

    /// A flat punch of the radius `radius` whose edge lets go when it offers the energy `w`, pressed to the approach
    /// `most`.
    pub fn punch(radius: f64, e: f64, w: f64, most: f64) -> Self {
        let least = -(TAU * w * radius / e).sqrt();
        Self(Box::new(move |at| {
            let approach = least + at * (most - least);
            State { approach, force: 2.0 * e * radius * approach, radius }
        }))
    }

    /// A sphere without adhesion on an incompressible layer of the thickness `thickness` that is bonded to a rigid
    /// base: E. K. Dimitriadis et al., Biophys. J. 82, 2798 (2002), equation 12.
    pub fn layer(radius: f64, e: f64, thickness: f64, most: f64) -> Self {
        Self(Box::new(move |at| {
            let s = at * most;
            let approach = s * s / radius;
            let x = s / thickness;
            let stiffer = 1.0 + 1.133 * x + 1.283 * x * x + 0.769 * x.powi(3) + 0.0975 * x.powi(4);
            State { approach, force: 4.0 / 3.0 * e * radius.sqrt() * approach.powf(1.5) * stiffer, radius: s }
        }))
    }

    /// A sphere whose adhesion is a tension `w/h_c` up to the separation `h_c`, with Tabor's number `mu` by the usual
    /// match with Maugis' λ = 1.157 μ. The zone of the tension ends at c = s / cos ψ; once s is 0, only the zone is
    /// left.
    pub fn of_range(radius: f64, e: f64, w: f64, mu: f64, most: f64) -> Self {
        /// The share of the way on which the bodies are apart.
        const APART: f64 = 0.1;
        let tension = 1.157 * mu * (TAU * w * e * e / (9.0 * radius)).cbrt();
        let range = w / tension;
        let edge = move |psi: f64| {
            let (sin, cos) = psi.sin_cos();
            let square = (psi + sin * cos - 2.0 * psi * cos * cos) / (PI * radius);
            let linear = 4.0 * tension / (PI * e) * (psi * sin - 2.0 * (0.5 * psi).sin().powi(2));
            let root = (linear * linear + 4.0 * square * range).sqrt();
            2.0 * range / (linear + root)
        };
        let touched = move |psi: f64| {
            let c = edge(psi);
            let (sin, cos) = psi.sin_cos();
            let s = c * cos;
            let approach = s * s / radius - 2.0 * tension / e * c * sin;
            let pressed = 2.0 * e * (approach * s - s.powi(3) / (3.0 * radius));
            State { approach, force: pressed - 2.0 * tension * c * c * (psi - sin * cos), radius: s }
        };
        // Finds the angle at which s is `most`.
        let (mut lo, mut hi) = (1e-6, FRAC_PI_2);
        for _ in 0..100 {
            let middle = 0.5 * (lo + hi);
            if touched(middle).radius > most { lo = middle } else { hi = middle }
        }
        let (last, widest) = (lo, edge(FRAC_PI_2));
        Self(Box::new(move |at| {
            if at < APART {
                let c = widest * at / APART;
                let approach = c * c / (2.0 * radius) - 4.0 * tension * c / (PI * e) - range;
                return State { approach, force: -PI * tension * c * c, radius: 0.0 };
            }
            // The angles run over their logarithm, because they fall by decades as the contact grows.
            let share = (at - APART) / (1.0 - APART);
            touched(FRAC_PI_2 * (last / FRAC_PI_2).powf(share))
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms_have_their_known_pull_off() {
        let (e, w, r) = (1.6e6, 0.06, 1e-3);
        let least = |body: &Body| {
            (0..=20_000).map(|i| body.at(f64::from(i) / 20_000.0).force).fold(f64::INFINITY, f64::min)
        };
        let sphere = Body::adhesive(Gap::Sphere { radius: r }, e, w, 2e-4);
        assert!((least(&sphere) / (-1.5 * PI * w * r) - 1.0).abs() < 1e-6);
        // Waves of zero amplitude make a sphere.
        let flat = Gap::Wavy { radius: r, amplitude: 0.0, wavelength: 1e-5 };
        assert!((least(&Body::adhesive(flat, e, w, 2e-4)) / least(&sphere) - 1.0).abs() < 1e-9);
        // Maugis' pull-off under force at λ = 1, divided by πwR.
        let ranged = Body::of_range(r, e, w, 1.0 / 1.157, 2e-4);
        assert!((least(&ranged) / (PI * w * r) + 1.60073).abs() < 1e-4, "{}", least(&ranged) / (PI * w * r));
        // The derivative of the energy: dP/ds = 2Es dδ/ds − √(8πwEs) … of the transform's integral.
        for gap in [
            Gap::Quartic { coefficient: 3e5 },
            Gap::Cone { slope: 0.1 },
            Gap::Wavy { radius: r, amplitude: 1e-7, wavelength: 2e-5 },
        ] {
            let (s, h) = (1.1e-4, 1e-9);
            let slope = (gap.transform(s + h)[1] - gap.transform(s - h)[1]) / (2.0 * h);
            assert!((slope / gap.transform(s)[0] - 1.0).abs() < 1e-5, "{gap:?} {slope}");
        }
    }
}
