//! The exact solutions against one another, against the reference tables, and against their own derivatives and integrals.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use crate::support::presets::reference;
use pulloff_engine::gap::{Breaks, Gap, Jet, Shape};
use pulloff_engine::gap::{shapes::ExactSphere, shapes::PowerLaw, shapes::ProfileGap, shapes::Smoothing};
use pulloff_engine::problem::{Control, Problem};
use pulloff_engine::theory::guduru::Guduru;
use pulloff_engine::theory::jkr::Jkr;
use pulloff_engine::theory::quadrature::integrate;
use pulloff_engine::theory::{Disc, Exact};
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

fn by_quadrature(problem: &Problem) -> Exact {
    Exact::by_quadrature(problem.effective_modulus, problem.work_of_adhesion, Arc::new(problem.shape.clone()))
}

fn problems() -> Vec<Problem> {
    let problem = |shape, work_of_adhesion| Problem { effective_modulus: 0.7, work_of_adhesion, shape };
    let wavy = |amplitude, wavelength, gamma| {
        problem(Shape::WavySphere { radius_of_curvature: 1.3, amplitude, wavelength }, gamma)
    };
    vec![
        problem(Shape::Sphere { radius_of_curvature: 1.3 }, 0.0),
        problem(Shape::Sphere { radius_of_curvature: 1.3 }, 0.004),
        wavy(0.0025, 0.05, 0.004),
        wavy(0.001, 0.3, 0.01),
        wavy(0.0004, 0.01, 1e-4),
        wavy(0.0, 0.05, 0.004),
    ]
}

/// From well inside the first wave to far outside.
fn radii() -> Vec<f64> {
    (0..30).map(|i| 0.002 * 1.21f64.powi(i)).collect()
}

#[test]
fn closed_forms_agree_with_quadrature() {
    let mut worst = [0.0_f64; 4];
    for problem in problems() {
        let (closed, numerical) = (Exact::of(&problem), by_quadrature(&problem));
        let radii = radii();
        for (a, b) in closed.curve(&radii).iter().zip(&numerical.curve(&radii)) {
            let s = a.contact_radius;
            // The wave's part of g' is an integral of terms of this size, which may nearly cancel.
            let steepest = 2.0 * s / 1.3 + problem.shape.wave().map_or(0.0, |(a, l)| 60.0 * a * s / (l * l));
            let (g, h) = (closed.transform(s), numerical.transform(s));
            for (worst, error) in worst.iter_mut().zip([
                (g.value - h.value) / g.value,
                (g.slope - h.slope) / steepest,
                (a.force - b.force) / a.force_scale,
                (a.energy - b.energy) / (a.energy.abs() + PI * problem.work_of_adhesion * s * s),
            ]) {
                *worst = worst.max(error.abs());
            }
        }
    }
    println!("g, g', P, U: {worst:?}");
    assert!(worst.iter().all(|error| *error <= 1e-11), "{worst:?}");
}

#[test]
fn the_energy_is_the_integral_of_its_definition() {
    // U = E*∫(δ − g)² da − πγs², without the rearrangement that avoids cancellation.
    for problem in problems() {
        let exact = Exact::of(&problem);
        for s in [0.03, 0.11, 0.37] {
            let delta = exact.approach(s);
            let wave = exact.wave().map(|wave| 0.5 * wave);
            let [square] = integrate(0.0, s, wave, |a| [(delta - exact.transform(a).value).powi(2)]).values;
            let contact = PI * problem.work_of_adhesion * s * s;
            let elastic = problem.effective_modulus * square;
            assert!(
                (elastic - contact - exact.energy(s)).abs() <= 1e-12 * (elastic + contact),
                "{problem:?} {s}"
            );
        }
    }
}

#[test]
fn the_force_is_the_slope_of_the_energy() {
    for problem in problems() {
        let exact = Exact::of(&problem);
        for s in [0.013, 0.06, 0.21, 0.4] {
            let wave = exact.wave().unwrap_or(s).min(s);
            let e = 1e-5 * wave;
            let [before, here, after] = exact.curve(&[s - e, s, s + e])[..] else { unreachable!() };
            let (delta, force) = exact.slopes(s);
            let (size, load) = ((here.approach.abs() + exact.edge(s)) / wave, here.force_scale);
            let close = |a: f64, b: f64, slope: f64, size: f64| {
                assert!(((b - a) / (2.0 * e) - slope).abs() <= 1e-6 * size, "{problem:?} {s}");
            };
            close(before.approach, after.approach, delta, size);
            close(before.force, after.force, force, load / wave);
            close(before.energy, after.energy, here.force * delta, load * size);
        }
    }
}

#[test]
fn the_pressure_carries_the_force() {
    for problem in problems() {
        let (exact, s) = (Exact::of(&problem), 0.17_f64);
        let modulus = problem.effective_modulus;
        // Without the edge, in t = √(s² − r²), in which this part of the pressure is smooth.
        let pressed = Exact::of(&Problem { work_of_adhesion: 0.0, ..problem.clone() });
        let wave = exact.wave().map(|wave| 0.1 * wave);
        let [force] = integrate(0.0, s, wave, |t| {
            let r = ((s - t) * (s + t)).sqrt();
            [TAU * t * pressed.pressure(s, r)]
        })
        .values;
        let scale = exact.equilibrium(s, 0.0).force_scale;
        assert!((force - pressed.force(s)).abs() <= 1e-9 * scale, "{problem:?}: {force}");
        // The edge: a flat punch under the tension 2E*sT.
        let pull = exact.force(s) - pressed.force(s);
        for r in [0.0, 0.08, 0.169] {
            let punch = pull / (TAU * s * (s * s - r * r).sqrt());
            let ours = exact.pressure(s, r) - pressed.pressure(s, r);
            assert!(
                (ours - punch).abs() <= 1e-10 * (ours.abs() + modulus),
                "{problem:?} {r}: {ours} {punch}"
            );
        }
    }
}

#[test]
fn without_waves_it_is_jkr() {
    let jkr = Jkr { effective_modulus: 0.7, work_of_adhesion: 0.004, radius_of_curvature: 1.3 };
    let guduru = |amplitude| Guduru {
        effective_modulus: 0.7,
        work_of_adhesion: 0.004,
        radius_of_curvature: 1.3,
        amplitude,
        wavelength: 0.05,
    };
    for s in radii() {
        let scale = jkr.equilibrium(s, 0.0).force_scale;
        assert!((guduru(0.0).force(s) - jkr.force(s)).abs() <= 1e-14 * scale);
        assert!((guduru(0.0).approach(s) - jkr.approach(s)).abs() <= 1e-14);
        assert!((guduru(1e-12).force(s) - jkr.force(s)).abs() <= 1e-6 * scale);
    }
}

#[test]
fn the_reference_curves_of_figures_8_and_9() {
    let mut worst = [0.0_f64; 3];
    for text in [include_str!("../data/fig8.json"), include_str!("../data/fig9.json")] {
        let (data, problem) = reference(text);
        let number = |value: &Value| value.as_f64().unwrap();
        let rows: Vec<Vec<f64>> = serde_json::from_value(data["curve"].clone()).unwrap();
        let radii: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        let energies = rows.iter().fold(0.0_f64, |most, row| most.max(row[3].abs()));
        for exact in [Exact::of(&problem), by_quadrature(&problem)] {
            for (row, ours) in rows.iter().zip(exact.curve(&radii)) {
                worst[0] = worst[0].max((ours.approach - row[1]).abs() / number(&data["range"]["approach"]));
                worst[1] = worst[1].max((ours.force - row[2]).abs() / number(&data["range"]["force"]));
                worst[2] = worst[2].max((ours.energy - row[3]).abs() / energies);
            }
        }
    }
    println!("approach, force, energy: {worst:?}");
    assert!(worst.iter().all(|error| *error <= 1e-12), "{worst:?}");
}

#[test]
fn power_laws_and_the_exact_sphere_by_quadrature() {
    // g, g', M₁ and M₂ in closed form at one radius.
    let check = |gap: Arc<dyn Gap>, a: f64, [g, slope, moment, square]: [f64; 4]| {
        let (modulus, gamma) = (0.7, 0.004);
        let exact = Exact::by_quadrature(modulus, gamma, Arc::clone(&gap));
        let transform = exact.transform(a);
        assert!(transform.resolved, "{gap:?}");
        let edge = (TAU * gamma * a / modulus).sqrt();
        let state = exact.curve(&[a])[0];
        assert!(state.resolved, "{gap:?}");
        let energy = modulus * (square - 2.0 * edge * moment) + PI * gamma * a * a;
        for (ours, theory, size) in [
            (transform.value, g, g),
            (transform.slope, slope, slope),
            (transform.moment, moment, moment),
            (state.approach, g - edge, g + edge),
            (state.force, 2.0 * modulus * (moment - a * edge), state.force_scale),
            (state.energy, energy, modulus * square + PI * gamma * a * a),
        ] {
            assert!((ours - theory).abs() <= 1e-12 * size, "{gap:?} at {a}: {ours} {theory}");
        }
    };
    // h = c rⁿ: g = G aⁿ, G = c n (√π/2) Γ(n/2)/Γ((n+1)/2), from ∫₀^{π/2} sinⁿ⁻¹θ dθ; n = 1 is the cone.
    for n in [1.0_f64, 1.5, 2.0, 3.0, 6.0] {
        for a in [1e-3_f64, 0.2, 3.0] {
            let c = 0.3;
            let unit = c * n * 0.5 * PI.sqrt() * libm::tgamma(0.5 * n) / libm::tgamma(0.5 * (n + 1.0));
            let g = unit * a.powf(n);
            let moment = n / (n + 1.0) * g * a;
            let square = 2.0 * n * n / ((n + 1.0) * (2.0 * n + 1.0)) * g * g * a;
            check(Arc::new(PowerLaw { factor: c, exponent: n }), a, [g, n * g / a, moment, square]);
            if n <= 1.0 {
                assert!((g - 0.5 * PI * c * a).abs() <= 1e-15 * g, "the cone");
            }
        }
    }
    // h = R − √(R² − r²): g = a artanh(a/R) = (a/2) ln((R+a)/(R−a)).
    let radius = 1.3_f64;
    for a in [0.01_f64, 0.4, 1.2] {
        let angle = (a / radius).atanh();
        let g = a * angle;
        let slope = angle + a * radius / ((radius - a) * (radius + a));
        let moment = 0.5 * ((a * a + radius * radius) * angle - a * radius);
        // M₂ = a g² − 2∫g (a g)' … by parts: ∫(g(a) − g)² = a g² − 2g∫g + ∫g², the last by quadrature.
        let [first, second] = integrate(0.0, a, None, |b| {
            let g = b * (b / radius).atanh();
            [g, g * g]
        })
        .values;
        // For small discs the closed form of M₁ loses digits; the quadrature does not.
        if a > 0.1 {
            check(
                Arc::new(ExactSphere { radius }),
                a,
                [g, slope, moment, a * g * g - 2.0 * g * first + second],
            );
        } else {
            let exact = Exact::by_quadrature(1.0, 0.0, Arc::new(ExactSphere { radius }));
            assert!((exact.transform(a).value / g - 1.0).abs() < 1e-13);
            assert!((exact.transform(a).slope / slope - 1.0).abs() < 1e-13);
        }
    }
}

#[test]
fn the_pressure_under_a_cone() {
    // p = (E* c/2) arcosh(s/r), infinite on the axis.
    let (modulus, c, s) = (0.7, 0.3, 0.2_f64);
    let cone = Exact::by_quadrature(modulus, 0.0, Arc::new(PowerLaw::cone(c)));
    for r in [1e-4, 0.05, 0.19] {
        let p = 0.5 * modulus * c * (s / r).acosh();
        assert!((cone.pressure(s, r) / p - 1.0).abs() < 1e-12, "{r}");
    }
}

#[test]
fn structure_too_fine_for_the_panels_is_said() {
    // Waves a hundred million times shorter than the disc, which the gap does not declare.
    #[derive(Debug)]
    struct Hidden;
    impl Gap for Hidden {
        fn jet(&self, r: f64) -> Jet {
            Jet { first: r + (1e9 * r).sin(), ..Jet::default() }
        }
        fn feature_length(&self) -> Option<f64> {
            None
        }
        fn reference_length(&self) -> f64 {
            1.0
        }
    }
    let exact = Exact::by_quadrature(1.0, 0.01, Arc::new(Hidden));
    assert!(!exact.transform(0.5).resolved);
    assert!(!exact.equilibrium(0.5, 0.0).resolved);
}

#[test]
fn the_slopes_vanish_at_the_limit_points_of_the_reference() {
    for text in [include_str!("../data/fig8.json"), include_str!("../data/fig9.json")] {
        let (data, problem) = reference(text);
        for exact in [Exact::of(&problem), by_quadrature(&problem)] {
            for (name, control) in data["control"].as_object().unwrap() {
                let control_of: Control = name.parse().unwrap();
                for limit in control["limit_points"].as_array().unwrap() {
                    let s = limit["s"].as_f64().unwrap();
                    let (approach, force) = exact.slopes(s);
                    let edge = exact.edge(s);
                    // The size of the terms that cancel in the slope: the share of the edge.
                    let size = control_of.value(0.5 * edge / s, 3.0 * problem.effective_modulus * edge);
                    let slope = control_of.value(approach, force);
                    assert!(slope.abs() <= 1e-9 * size, "{name} at {s}: {slope}");
                }
            }
        }
    }
}

/// A gap that does not declare itself a cubic, so that every integral between its knots is refined until it is resolved.
#[derive(Debug)]
struct AnyPieces(ProfileGap);

impl Gap for AnyPieces {
    fn jet(&self, r: f64) -> Jet {
        self.0.jet(r)
    }
    fn feature_length(&self) -> Option<f64> {
        self.0.feature_length()
    }
    fn breaks(&self) -> Breaks<'_> {
        Breaks { cubic: false, ..self.0.breaks() }
    }
    fn reference_length(&self) -> f64 {
        self.0.reference_length()
    }
}

fn rough_profile(rows: u16) -> ProfileGap {
    let radii: Vec<f64> = (0..rows).map(|i| f64::from(i) / f64::from(rows - 1)).collect();
    let gaps: Vec<f64> = radii.iter().map(|r| 0.5 * r * r + 0.01 * (17.0 * r * r + 3.0 * r).sin()).collect();
    ProfileGap::new(&radii, &gaps, Smoothing::None).unwrap()
}

#[test]
fn a_profile_between_its_rows_is_what_refining_finds() {
    let (modulus, gamma) = (0.7, 0.004);
    for rows in [8, 16, 60] {
        let cubics = Exact::by_quadrature(modulus, gamma, Arc::new(rough_profile(rows)));
        let pieces = Exact::by_quadrature(modulus, gamma, Arc::new(AnyPieces(rough_profile(rows))));
        let radii = [0.004, 0.11, 4.0 / 7.0, 0.83, 1.0];
        for (a, b) in cubics.curve(&radii).iter().zip(&pieces.curve(&radii)) {
            let s = a.contact_radius;
            let (g, h) = (cubics.transform(s), pieces.transform(s));
            assert!(a.resolved && h.resolved, "{rows} {s}");
            for (ours, theirs, size) in [
                (g.value, h.value, h.value.abs() + s * s),
                (g.slope, h.slope, h.slope.abs() + s),
                (a.force, b.force, b.force_scale),
                (a.energy, b.energy, b.force_scale * s),
            ] {
                assert!((ours - theirs).abs() <= 1e-12 * size, "{rows} {s}: {ours} {theirs} of {size}");
            }
        }
    }
}

#[test]
fn the_pressures_under_a_profile_carry_its_force() {
    let (s, points) = (0.8_f64, 4000);
    let exact = Exact::by_quadrature(0.7, 0.0, Arc::new(rough_profile(20)));
    // r dr = −t dt, and the pressure is smooth in t except at the knots: midpoints.
    let step = s / f64::from(points);
    let depths: Vec<f64> = (0..points).map(|i| step * (f64::from(i) + 0.5)).collect();
    let radii: Vec<f64> = depths.iter().map(|t| ((s - t) * (s + t)).sqrt()).collect();
    let pressures = exact.pressures(s, &radii);
    let force: f64 = pressures.iter().zip(&depths).map(|(p, t)| TAU * t * p * step).sum();
    let scale = exact.equilibrium(s, 0.0).force_scale;
    assert!((force - exact.force(s)).abs() <= 1e-6 * scale, "{force} {}", exact.force(s));
    assert_eq!(exact.pressure(s, radii[7]).to_bits(), pressures[7].to_bits());
}

#[test]
fn a_corner_of_a_formula_is_met() {
    // h = max(r − c, 0)²/2: h' = r − c beyond c, g = a (cos θ a − c (π/2 − θ)) with sin θ = c/a.
    let formula = pulloff_engine::gap::formula::Formula::parse("max(r - 0.3, 0)^2/2").unwrap();
    let gap = formula.bind(&[]).unwrap().over(1.0).unwrap();
    assert!((gap.breaks().knots[0] - 0.3).abs() < 1e-15);
    let exact = Exact::by_quadrature(1.0, 0.0, Arc::new(gap));
    for a in [0.300_001_f64, 0.31, 0.5, 1.0] {
        let theta = (0.3 / a).asin();
        let g = a * (a * theta.cos() - 0.3 * (0.5 * PI - theta));
        let ours = exact.transform(a);
        assert!(ours.resolved && (ours.value - g).abs() <= 1e-14 * a * a, "{a}: {} {g}", ours.value);
    }
    assert_eq!(exact.transform(0.3).value.to_bits(), 0f64.to_bits());
}
