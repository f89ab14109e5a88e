//! The law of stability against known numbers for the waves of Fig. 9, and against the traced curve.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::progress::Unwatched;
use pulloff_engine::stability::count::EXACTLY;
use pulloff_engine::stability::law::{adhesion_of, root_of};
use pulloff_engine::stability::{Cause, Family, MapAxis, Onset, even};
use pulloff_engine::theory::onset;
use pulloff_engine::{Adhesion, Control, Material, Preset, Shape, Start};
use serde_json::Value;
use std::f64::consts::TAU;

const AMPLITUDE: &str = "groups.amplitude_over_wavelength";
const ADHESION: &str = "groups.adhesion";

fn data() -> Value {
    serde_json::from_str(include_str!("../data/stability.json")).unwrap()
}

/// λ/R = 0.05, E* = R = 1.
fn waves(control: Control, start: f64, amplitude_over_wavelength: f64, adhesion: f64) -> Preset {
    let gap = Shape::WavySphere {
        radius_of_curvature: 1.0,
        amplitude: 0.05 * amplitude_over_wavelength,
        wavelength: 0.05,
    };
    let material = Material {
        effective_modulus: 1.0,
        work_of_adhesion: adhesion / TAU,
        range_of_action: None,
        adhesion: Adhesion::ShortRange,
    };
    let mut preset = Preset::new(material, gap, Start::ContactRadius(start));
    preset.path.control = control;
    preset
}

fn axis(key: &str, range: [f64; 2], logarithmic: bool) -> MapAxis {
    MapAxis::new(key, range, logarithmic, 1.0).unwrap()
}

fn control(name: &str) -> Control {
    name.parse().unwrap_or_else(|_| Control::Stiffness(name.parse().unwrap()))
}

/// Whether `ours` agrees with `given` in all of its digits.
fn same(ours: f64, given: f64, last: f64) -> bool {
    (ours - given).abs() <= 0.51 * last
}

fn rows(value: &Value) -> Vec<Vec<Value>> {
    value.as_array().unwrap().iter().map(|row| row.as_array().unwrap().clone()).collect()
}

#[test]
fn cusps_in_the_adhesion_are_those_known_and_a_ninth_under_force() {
    let known = &data()["cusps_in_adhesion"];
    let a = known["amplitude_over_wavelength"].as_f64().unwrap();
    let cusps = |control| {
        let family = Family::new(&waves(control, 0.41, a, 0.025), Vec::new()).unwrap();
        family.cusps(&[])
    };
    let (grips, dead) = (cusps(Control::Displacement), cusps(Control::Force));
    for (row, (ours, force)) in rows(&known["displacement"]).iter().zip(grips.iter().zip(&dead)) {
        let [s, adhesion] = [0, 1].map(|k| row[k].as_f64().unwrap());
        let found = TAU * adhesion_of(ours.value);
        assert!(
            same(ours.contact_radius, s, 1e-4) && same(found, adhesion, 1e-5),
            "{ours:?} {found} {row:?}"
        );
        assert!((ours.contact_radius - force.contact_radius).abs() < 1e-9);
        assert!((adhesion_of(ours.value) / adhesion_of(force.value) - 9.0).abs() < 1e-12);
    }
    assert!(grips.len() >= 9 && grips.len() == dead.len());
}

#[test]
fn cusps_in_the_amplitude_are_those_known_and_their_lines_pass_them() {
    let known = &data()["cusps_in_amplitude"];
    let adhesion = known["adhesion"].as_f64().unwrap();
    for name in ["displacement", "force"] {
        let preset = waves(control(name), 0.41, 0.05, adhesion);
        let along = axis(AMPLITUDE, [0.0, 0.0125], false);
        let births = Family::new(&preset, vec![along.clone()]).unwrap().births().unwrap();
        let axes = vec![along, axis(ADHESION, [1e-3, 1.0], true)];
        let level = axes[1].share(adhesion);
        let family = Family::new(&preset, axes).unwrap();
        let lines = family.explicit_cusps(&Unwatched).unwrap().unwrap();
        for row in rows(&known[name]) {
            let [s, amplitude] = [0, 1].map(|k| row[k].as_f64().unwrap());
            let hit =
                births.iter().find(|[at, share]| same(*at, s, 1e-4) && same(0.0125 * share, amplitude, 1e-6));
            let [s, share] = hit.unwrap_or_else(|| panic!("{name} {row:?}: {births:?}"));
            // The line, sampled at radii, comes as near to it as its steps are long.
            let near = lines.iter().any(|(points, _)| {
                points.windows(2).any(|pair| {
                    let [a, b] = [pair[0], pair[1]];
                    a.contact_radius <= *s
                        && *s <= b.contact_radius
                        && (a.at[0] - share).abs() < 0.02
                        && (a.at[1] - level).abs() < 0.02
                })
            });
            assert!(near, "{name} {row:?}");
        }
    }
}

#[test]
fn swallowtails_are_those_known() {
    let family = |control| {
        let axes = vec![axis(AMPLITUDE, [0.0, 0.002], false), axis(ADHESION, [1e-4, 1.0], true)];
        Family::new(&waves(control, 0.41, 0.05, 0.025), axes).unwrap()
    };
    for (control, ratio) in [(Control::Displacement, 1.0), (Control::Force, 9.0)] {
        let family = family(control);
        let lines = family.explicit_cusps(&Unwatched).unwrap().unwrap();
        let tips: Vec<_> = lines.iter().flat_map(|(_, tips)| tips).collect();
        for row in rows(&data()["swallowtails"]) {
            let [s, amplitude, adhesion] = [0, 1, 2].map(|k| row[k].as_f64().unwrap());
            let hit = tips.iter().any(|tip| {
                let [a, y] = [0, 1].map(|k| family.axes[k].value(tip.at[k]));
                // From Struve functions with thirty digits; the adhesion hardly changes along the line there.
                (tip.contact_radius / s - 1.0).abs() < 1e-6
                    && (a / amplitude - 1.0).abs() < 1e-7
                    && (ratio * y / adhesion - 1.0).abs() < 1e-7
            });
            assert!(hit, "{control} {row:?}: {tips:?}");
        }
    }
}

#[test]
fn every_change_of_the_count_is_a_cusp_or_a_landing_where_it_is_known() {
    let known = &data()["snaps"];
    let [start, adhesion] = ["start", "adhesion"].map(|key| known[key].as_f64().unwrap());
    for (name, most) in [("displacement", 0.0125), ("force", 0.05), ("0.15", 0.0105), ("0.6", 0.0063)] {
        let preset = waves(control(name), start, 0.05, adhesion);
        let family = Family::new(&preset, vec![axis(AMPLITUDE, [1e-5, most], false)]).unwrap();
        let found = family.changes(0, &[0.0], &even(150), EXACTLY, &Unwatched);
        let rows = rows(&known[name]);
        let words: Vec<_> = found.iter().map(|c| (c.snaps, family.axes[0].value(c.share), c.cause)).collect();
        assert!(found.len() >= rows.len(), "{name}: {words:?}");
        for (row, change) in rows.iter().zip(&found) {
            let amplitude = family.axes[0].value(change.share);
            let given = row[2].as_f64().unwrap();
            let last = if given > 0.02 { 1e-5 } else { 1e-6 };
            assert!(same(amplitude, given, last), "{name} {amplitude} {row:?}");
            assert_eq!(change.snaps.map(|n| n as u64), [0, 1].map(|k| row[k].as_u64().unwrap()), "{name}");
            let kind = match change.cause {
                Cause::Cusp(_) => "cusp",
                Cause::Landing(_) => "landing",
                Cause::Start => "start",
            };
            assert_eq!(kind, row[3].as_str().unwrap(), "{name} {row:?}");
        }
    }
}

#[test]
fn the_law_holds_at_every_limit_point_of_the_curve() {
    let traced = [Control::Displacement, Control::Force, Control::Stiffness(0.15)];
    for control in traced {
        let preset = waves(control, 0.5, 0.05, 0.025);
        let case = pulloff_engine::Case::new(&preset).unwrap();
        let curve = case.curve(&Unwatched).unwrap();
        let family = Family::new(&preset, Vec::new()).unwrap();
        let law = family.member(&[]).unwrap().law(&[]).unwrap();
        let radii: Vec<f64> = (1..=1000).map(|k| 0.0005 * f64::from(k)).collect();
        for (s, many) in radii.iter().zip(law.over(&radii)) {
            let one = law.critical(*s).unwrap();
            assert!((many - one).abs() <= 1e-13 * one.max(1e-6), "{s} {many} {one}");
        }
        let limits = curve.limit_points(control);
        assert_eq!(limits.len(), 19);
        for limit in limits {
            let critical = law.critical(limit.contact_radius).unwrap();
            assert!((critical / case.reduced.work_of_adhesion - 1.0).abs() < 1e-10, "{control} {limit:?}");
            assert!((law.edge(limit.contact_radius).unwrap().value / root_of(critical) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn the_smallest_amplitude_that_snaps_is_that_known_for_every_device() {
    let known = &data()["first_pair"];
    let adhesion = known["adhesion"].as_f64().unwrap();
    // The first pair of limit points, wherever it lies.
    for row in rows(&known["by_stiffness"]) {
        let (device, given) = (control(row[0].as_str().unwrap()), row[1].as_f64().unwrap());
        let preset = waves(device, 0.41, 0.05, adhesion);
        let family = Family::new(&preset, vec![axis(AMPLITUDE, [0.0, 0.0125], false)]).unwrap();
        let first = family.births().unwrap()[0][1] * 0.0125;
        assert!(same(first, given, 1e-6), "{device} {first} {given}");
    }
    // The first snap of the path from 0.41.
    for (device, given) in [("displacement", 1.215e-3), ("force", 2.43e-3), ("stiffness=0.15", 1.076e-3)] {
        let onset = Onset::of(&waves(control(device), 0.41, 0.05, adhesion), &Unwatched).unwrap().unwrap();
        assert!(same(onset.amplitude_over_wavelength, given, 1e-6), "{device} {onset:?}");
        assert!(matches!(onset.cause, Cause::Cusp(_)));
    }
    let mut sphere = waves(Control::Displacement, 0.41, 0.05, adhesion);
    sphere.set("gap.shape", "sphere".into()).unwrap();
    assert_eq!(Onset::of(&sphere, &Unwatched).unwrap(), None);
    // The law of limit points is that of adhesion without a range.
    let mut ranged = waves(Control::Displacement, 0.41, 0.05, adhesion);
    ranged.set("material.cohesive_range", 0.01.into()).unwrap();
    assert_eq!(Onset::of(&ranged, &Unwatched).unwrap(), None);
}

#[test]
fn fold_curves_pass_the_limit_points_of_the_curve() {
    let preset = waves(Control::Displacement, 0.41, 0.05, 0.025);
    for (key, range, device) in [
        (ADHESION, [0.005, 0.2], Control::Displacement),
        (AMPLITUDE, [0.0, 0.06], Control::Force),
        ("compliance", [0.0, f64::INFINITY], Control::Stiffness(0.3)),
        ("groups.wavelength_over_radius", [0.03, 0.07], Control::Displacement),
        ("material.effective_modulus", [0.5, 2.0], Control::Displacement),
    ] {
        let mut preset = preset.clone();
        preset.path.control = device;
        let along = axis(key, range, false);
        let share = match (key, device) {
            ("compliance", Control::Stiffness(k)) => along.share(1.0 / k),
            ("material.effective_modulus", _) => along.share(1.0),
            (ADHESION, _) => along.share(0.025),
            _ => along.share(0.05),
        };
        let folds = Family::new(&preset, vec![along]).unwrap().folds(&Unwatched).unwrap();
        let case = pulloff_engine::Case::new(&preset).unwrap();
        let limits = case.curve(&Unwatched).unwrap().limit_points(device);
        let mut hits = 0;
        for line in &folds.lines {
            for pair in line.points.windows(2) {
                let [a, b] = [pair[0], pair[1]];
                let part = (share - a.at[0]) / (b.at[0] - a.at[0]);
                if (0.0..1.0).contains(&part) || part >= 1.0 && share >= 1.0 {
                    let mix = |x: f64, y: f64| x + part * (y - x);
                    let s = mix(a.contact_radius, b.contact_radius);
                    let limit = limits
                        .iter()
                        .min_by(|x, y| (x.contact_radius - s).abs().total_cmp(&(y.contact_radius - s).abs()))
                        .unwrap();
                    assert!((limit.contact_radius - s).abs() < 1e-3, "{key} {s} {limit:?}");
                    assert!((limit.approach - mix(a.approach, b.approach)).abs() < 2e-4, "{key} {limit:?}");
                    let minimum = limit.turn == pulloff_engine::Extremum::Minimum;
                    assert_eq!(minimum, line.is_minimum, "{key} {s}");
                    hits += 1;
                }
            }
        }
        assert_eq!(hits, limits.len(), "{key}");
        // Pairs are born as the adhesion or the amplitude is varied.
        assert!(![ADHESION, AMPLITUDE].contains(&key) || !folds.cusps.is_empty(), "{key}");
    }
}

/// The next in a series of pseudo-random numbers between 0 and 1.
fn next(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn on_both_sides_of_a_cusp_the_limit_points_differ_by_two() {
    let mut seed = 20_261_122;
    let mut cusps = 0;
    for problem in 0..60 {
        let mut random = |lo: f64, hi: f64| lo + (hi - lo) * next(&mut seed);
        let gap = match problem % 3 {
            0 => Shape::WavySphere {
                radius_of_curvature: 1.0,
                amplitude: random(1e-4, 6e-3),
                wavelength: random(0.03, 0.2),
            },
            1 => Shape::Harmonics(std::sync::Arc::new(
                pulloff_engine::Harmonics::new(
                    1.0,
                    (0..3)
                        .map(|_| pulloff_engine::Harmonic {
                            amplitude: random(-2e-3, 2e-3),
                            wavelength: random(0.05, 0.2),
                            phase: random(0.0, 6.0),
                        })
                        .collect(),
                )
                .unwrap(),
            )),
            _ => {
                let text = format!(
                    "r^2/2 + {:.6}*exp(-((r-{:.4})/{:.4})^2)",
                    random(-2e-3, 2e-3),
                    random(0.1, 0.3),
                    random(0.01, 0.04)
                );
                Shape::Formula(std::sync::Arc::new(
                    pulloff_engine::TypedGap::new(&text, Vec::new(), None).unwrap(),
                ))
            }
        };
        let device = match problem % 4 {
            0 | 1 => Control::Displacement,
            2 => Control::Force,
            _ => Control::Stiffness(random(0.05, 3.0)),
        };
        let material = Material {
            effective_modulus: 1.0,
            work_of_adhesion: 1e-3,
            range_of_action: None,
            adhesion: Adhesion::ShortRange,
        };
        let mut preset = Preset::new(material, gap, Start::ContactRadius(0.4));
        preset.path.control = device;
        let count = |adhesion: f64| {
            let mut preset = preset.clone();
            preset.material.work_of_adhesion = adhesion;
            let family = Family::new(&preset, Vec::new()).unwrap();
            let law = family.member(&[]).unwrap().law(&[]).unwrap();
            let solution = pulloff_engine::disc::ExactSolution::new(law.panels, adhesion);
            pulloff_engine::quasistatic::Monotone::of(&solution, device).limits.len().cast_signed()
        };
        let family = Family::new(&preset, Vec::new()).unwrap();
        for cusp in family.cusps(&[]) {
            let adhesion = adhesion_of(cusp.value);
            let [below, above] = [-1e-6, 1e-6].map(|by| count(adhesion * (1.0 + by)));
            let born = if cusp.is_minimum { above - below } else { below - above };
            assert_eq!(born, 2, "problem {problem}: {cusp:?} {below} {above}");
            cusps += 1;
        }
    }
    assert!(cusps > 200, "{cusps}");
}

#[test]
fn far_from_the_axis_the_first_pairs_are_born_where_the_envelope_says() {
    let axes = vec![axis(AMPLITUDE, [0.0, 0.002], false), axis(ADHESION, [1e-3, 30.0], true)];
    let family = Family::new(&waves(Control::Displacement, 0.5, 0.05, 0.025), axes).unwrap();
    let lines = family.explicit_cusps(&Unwatched).unwrap().unwrap();
    let tips: Vec<_> = lines.iter().flat_map(|(_, tips)| tips).collect();
    for (s, [amplitude, adhesion]) in [(0.17, [3e-3, 1.1e-2]), (0.47, [5.5e-4, 1.5e-3])] {
        let tip = tips
            .iter()
            .min_by(|a, b| (a.contact_radius - s).abs().total_cmp(&(b.contact_radius - s).abs()))
            .unwrap();
        let s = tip.contact_radius;
        let [a, y] = [0, 1].map(|k| family.axes[k].value(tip.at[k]));
        let envelope = onset::amplitude_over_wavelength(0.05, 1.0, s);
        assert!((envelope / a - 1.0).abs() < amplitude, "{s} {a} {envelope}");
        assert!((onset::adhesion(1.0, s) / y - 1.0).abs() < adhesion, "{s} {y}");
    }
}
