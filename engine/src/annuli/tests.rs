use super::*;
use crate::disc::{Basis, ExactBasis};
use crate::gap::Gap;
use crate::gap::{shapes::Harmonic, shapes::Harmonics};
use crate::progress::Stopped;
use crate::ritz::fixtures::wavy;
use std::sync::Arc;

fn fig9() -> Ground {
    Ground::of(wavy(0.0).gap, 0.6).unwrap()
}

fn rings(disc: f64, rings: &[[f64; 2]]) -> Contacts {
    Contacts { disc, rings: rings.to_vec() }
}

fn slope_at_disc(ground: &Ground, contacts: &Contacts) -> f64 {
    ground.slope(contacts.disc)
}

#[test]
fn a_single_disc_is_the_closed_form() {
    let problem = wavy(0.004);
    let (ground, basis) = (fig9(), ExactBasis::of(&problem, 0.6).unwrap());
    for s in [0.03, 0.2, 0.47] {
        let state = ground.state(&Contacts::of_disc(s), Wanted::Rates).unwrap();
        for delta in [-0.03, 0.0, 0.1] {
            let exact = basis.evaluate(&problem, s, delta);
            assert!((state.force_at(delta) - exact.force).abs() < 2e-14 * exact.force_scale);
            let kappa = state.intensities(delta)[0];
            assert!((kappa - 0.004_f64.sqrt() - exact.residual).abs() < 2e-14, "{kappa} {}", exact.residual);
            assert!((state.energy(delta, 0.004) - exact.energy).abs() < 1e-14);
            let j = state.jacobian(delta, slope_at_disc(&ground, &state.contacts))[(0, 0)];
            assert!((j - exact.residual_gradient[1]).abs() < 1e-12, "{j} {}", exact.residual_gradient[1]);
        }
    }
}

#[test]
fn a_rigid_flat_annulus_carries_what_is_known() {
    let flat: Arc<dyn Gap> = Arc::new(
        Harmonics::new(1e12, vec![Harmonic { amplitude: 0.0, wavelength: 10.0, phase: 0.0 }]).unwrap(),
    );
    let ground = Ground::of(flat, 2.0).unwrap();
    for (ratio, exact) in [
        (0.1, 0.999_864_355_578),
        (0.2, 0.998_901_152_221),
        (0.5, 0.981_017_896_923),
        (0.8, 0.897_616_307_068),
        (0.9, 0.821_029_779_368),
        (0.99, 0.608_763_092_119),
    ] {
        let state = ground.state(&rings(0.0, &[[ratio, 1.0]]), Wanted::Values).unwrap();
        let found = 0.5 * state.force[1];
        assert!((found - exact).abs() < 1e-12, "{ratio}: {found} {exact}");
    }
    // A thin ring: π²(1+ε)/(4 ln(16(1+ε)/(1−ε))).
    let state = ground.state(&rings(0.0, &[[0.999, 1.0]]), Wanted::Values).unwrap();
    let thin = std::f64::consts::PI.powi(2) * 1.999 / (4.0 * (16.0 * 1999.0_f64).ln());
    assert!((0.5 * state.force[1] / thin - 1.0).abs() < 1e-6);
}

/// Sixth-order differences of a vector function at 0.
fn difference(step: f64, f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let at: Vec<Vec<f64>> = [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0].iter().map(|k| f(k * step)).collect();
    (0..at[0].len())
        .map(|i| {
            let odd = |k: usize| at[3 + k][i] - at[2 - k][i];
            (45.0 * odd(0) - 9.0 * odd(1) + odd(2)) / (60.0 * step)
        })
        .collect()
}

fn check_derivatives(ground: &Ground, contacts: &Contacts, delta: f64, gamma: f64, tolerance: f64) {
    let points = points(ground, contacts);
    let state = ground.state_with(contacts, &points, Wanted::Rates).unwrap();
    let jacobian = state.jacobian(delta, slope_at_disc(ground, contacts));
    let edges = contacts.edges();
    let radii: Vec<f64> = edges.iter().map(|edge| edge.radius).collect();
    let kappa = state.intensities(delta);
    for (j, edge) in edges.iter().enumerate() {
        let moved = |x: f64| {
            let mut radii = radii.clone();
            radii[j] += edge.sign * x;
            let state = ground.state_with(&contacts.with_edges(&radii), &points, Wanted::Values).unwrap();
            let mut out = state.intensities(delta);
            out.push(state.energy(delta, gamma));
            out.push(state.force_at(delta));
            out
        };
        let narrowest = contacts.widths().into_iter().fold(f64::INFINITY, f64::min);
        let found = difference(0.004 * narrowest.min(ground.wave), moved);
        let largest = jacobian.column(j).amax();
        for i in 0..edges.len() {
            let error = (found[i] - jacobian[(i, j)]).abs() / largest;
            assert!(error < tolerance, "{contacts:?} {i} {j}: {} {} {error:.1e}", found[i], jacobian[(i, j)]);
        }
        // ∂U/∂α = 2πe(G − γ), ∂P/∂α = 4πeκ ∂κ/∂δ.
        let energy = std::f64::consts::TAU * edge.radius * (kappa[j].powi(2) - gamma);
        assert!(
            (found[edges.len()] - energy).abs() < 1e-7 * energy.abs().max(1e-4),
            "{j} {} {energy}",
            found[edges.len()]
        );
        let force = 2.0 * std::f64::consts::TAU * edge.radius * kappa[j] * state.intensity[j][1];
        assert!((found[edges.len() + 1] - force).abs() < 1e-7 * force.abs().max(1e-3), "{j}");
    }
    // The Hessian is symmetric.
    for i in 0..edges.len() {
        for j in 0..i {
            let h = |i: usize, j: usize| edges[i].radius * kappa[i] * jacobian[(i, j)];
            let largest = jacobian.amax() * edges[i].radius * kappa[i].abs().max(kappa[j].abs());
            assert!(
                (h(i, j) - h(j, i)).abs() < 0.1 * tolerance * largest,
                "{i} {j}: {} {}",
                h(i, j),
                h(j, i)
            );
        }
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    let ground = fig9();
    for (contacts, delta) in [
        (rings(0.0185, &[[0.0327, 0.0625]]), 0.0063),
        (rings(0.0, &[[0.1, 0.13]]), 0.02),
        (rings(0.0, &[[0.01, 0.03], [0.04, 0.062]]), 0.002),
        (rings(0.219, &[[0.2315, 0.2645], [0.287, 0.307]]), 0.1),
        (rings(0.0102, &[[0.042, 0.0568], [0.09, 0.105], [0.14, 0.15]]), 0.016),
    ] {
        check_derivatives(&ground, &contacts, delta, 1e-4, 2e-8);
    }
}

#[test]
fn waves_with_phases_have_the_same_derivatives() {
    let waves = [(0.003, 0.07, 0.4), (-0.001, 0.2, 1.1)];
    let waves = waves.map(|(amplitude, wavelength, phase)| Harmonic { amplitude, wavelength, phase });
    let gap: Arc<dyn Gap> = Arc::new(Harmonics::new(0.8, waves.to_vec()).unwrap());
    let ground = Ground::of(gap, 0.6).unwrap();
    check_derivatives(&ground, &rings(0.1, &[[0.14, 0.2], [0.23, 0.27]]), 0.03, 1e-4, 2e-8);
    // The sums over the disc do not depend on how they are taken.
    let plain = Ground { entire: None, ..ground.clone() };
    let contacts = rings(0.1, &[[0.14, 0.2], [0.23, 0.27]]);
    let [a, b] = [&ground, &plain].map(|ground| ground.state(&contacts, Wanted::Values).unwrap());
    for (a, b) in a.intensity.iter().zip(&b.intensity) {
        assert!((a[0] - b[0]).abs() < 1e-13 && (a[1] - b[1]).abs() < 1e-11, "{a:?} {b:?}");
    }
}

#[test]
fn the_force_is_the_integral_of_the_pressure_and_gaps_vanish_in_contact() {
    let ground = fig9();
    let contacts = rings(0.0185, &[[0.0327, 0.0625]]);
    let state = ground.state(&contacts, Wanted::Values).unwrap();
    let around = Around::new(&ground, &state, 0.0063);
    let mut sum = 0.0;
    for [lo, hi] in contacts.intervals() {
        // r = c − d cos t removes the roots at the edges; at the axis nothing is lost.
        let n = 400;
        let (c, d) = if lo > 0.0 { (0.5 * (lo + hi), 0.5 * (hi - lo)) } else { (0.0, hi) };
        for k in 0..n {
            let span = if lo > 0.0 { std::f64::consts::PI } else { std::f64::consts::FRAC_PI_2 };
            let t = std::f64::consts::PI - span * (f64::from(k) + 0.5) / f64::from(n);
            let r = c - d * t.cos();
            sum += std::f64::consts::TAU * r * around.pressure(r) * d * t.sin() * span / f64::from(n);
        }
    }
    assert!((sum / state.force_at(0.0063) - 1.0).abs() < 1e-5, "{sum} {}", state.force_at(0.0063));
    // Between the contacts and outside them, the gap is the same with and without a g that is entire.
    for r in [0.025, 0.07, 0.1] {
        let gap = around.gap(r);
        let again = Around::new(&Ground { entire: None, ..ground.clone() }, &state, 0.0063).gap(r);
        assert!((gap - again).abs() < 1e-14, "{r} {gap} {again}");
    }
}

fn formula(text: &str) -> Ground {
    use crate::gap::Shape;
    use crate::gap::{formula::FormulaParameter, formula::TypedGap};
    let none: Vec<FormulaParameter> = Vec::new();
    let gap: Arc<dyn Gap> = Arc::new(Shape::Formula(Arc::new(TypedGap::new(text, none, Some(0.6)).unwrap())));
    Ground::of(gap, 0.5).unwrap()
}

#[test]
fn breaks_in_a_ring_have_the_same_derivatives() {
    // A corner under the disc, in a ring, between contacts; a kink in a ring; two corners in one ring.
    for (text, contacts, tolerance) in [
        ("r^2/2 + 0.1*max(r-0.05, 0)", rings(0.1, &[[0.13, 0.2]]), 1e-7),
        ("r^2/2 + 0.1*max(r-0.17, 0)", rings(0.1, &[[0.13, 0.2]]), 1e-6),
        ("r^2/2 + 0.1*max(r-0.115, 0)", rings(0.1, &[[0.13, 0.2]]), 1e-7),
        ("r^2/2 + 10*max(r-0.17, 0)^2", rings(0.1, &[[0.13, 0.2], [0.23, 0.25]]), 1e-6),
        ("r^2/2 + 0.1*max(r-0.15, 0) + 0.03*abs(r-0.18)", rings(0.0, &[[0.13, 0.2]]), 1e-6),
    ] {
        check_derivatives(&formula(text), &contacts, 0.02, 1e-4, tolerance);
    }
}

#[test]
fn a_graded_angle_converges() {
    let ground = formula("r^2/2 + 0.1*max(r-0.17, 0)");
    let contacts = rings(0.1, &[[0.13, 0.2]]);
    let at = |pieces: [usize; 2]| {
        let resolution = Resolution::of(vec![pieces.to_vec()]);
        let state = ground.state_with(&contacts, &resolution, Wanted::Values).unwrap();
        state.intensities(0.02)
    };
    let exact = at([160, 160]);
    let chosen = ground.state(&contacts, Wanted::Values).unwrap().intensities(0.02);
    for ((a, b), c) in exact.iter().zip(at([24, 24])).zip(chosen) {
        assert!((a - b).abs() < 1e-7 && (a - c).abs() < 1e-9, "{a} {b} {c}");
    }
    // Breaks close to an edge, with other contacts beside it.
    for (text, inner) in [
        ("r^2/2 + 0.03*max(r-0.125, 0) + 1.1*max(r-0.1753, 0)^2", 1e-4),
        ("r^2/2 + 0.03*max(r-0.125, 0) + 1.1*max(r-0.1753, 0)^2", 6e-3),
        ("r^2/2 + 0.03*max(r-0.125, 0) + 0.1*max(r-0.1753, 0)", 1e-4),
    ] {
        let ground = formula(text);
        let contacts = rings(0.033, &[[0.0673, 0.1208], [0.1753 - inner, 0.1941]]);
        let first = points(&ground, &Contacts { rings: contacts.rings[..1].to_vec(), ..contacts.clone() });
        let few = ground.state(&contacts, Wanted::Values).unwrap().intensities(0.02);
        let many = Resolution::of(vec![vec![2 * first.count()], vec![120, 120]]);
        let many = ground.state_with(&contacts, &many, Wanted::Values).unwrap().intensities(0.02);
        for (a, b) in few.iter().zip(&many) {
            assert!((a - b).abs() < 1e-8, "{text} {inner} {a} {b}");
        }
    }
    // A graded ring has a pressure on both of its sides.
    let state = ground.state(&contacts, Wanted::Values).unwrap();
    let around = Around::new(&ground, &state, 0.02);
    assert!(around.pressure(0.15).is_finite() && around.pressure(0.19).is_finite());
}

/// A search for crests asks at every radius, for on a wide fine gap it takes minutes.
#[test]
fn a_search_for_crests_can_be_stopped() {
    let ground = fig9();
    let contacts = rings(0.1, &[[0.15, 0.19]]);
    let state = ground.state(&contacts, Wanted::Values).unwrap();
    let around = Around::new(&ground, &state, 0.02);
    let asked = std::cell::Cell::new(0);
    let search = |most: usize| {
        asked.set(0);
        around.crests(0.5, &|| {
            asked.set(asked.get() + 1);
            asked.get() > most
        })
    };
    assert!(search(usize::MAX).is_ok_and(|crests| !crests.is_empty()));
    assert!(asked.get() > 20);
    assert_eq!(search(10), Err(Stopped));
    assert_eq!(asked.get(), 11);
}
