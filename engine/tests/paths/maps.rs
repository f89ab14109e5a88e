//! Between two neighbouring cells of a map with different numbers of snaps there is always a line: on three maps that
//! once lost lines, and on random ones, with snaps counted without the law.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::EventKind;
use pulloff_engine::quasistatic::path::PathSetting;
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::Ordinate;
use pulloff_engine::stability::{COMPLIANCE, MapAxis};
use pulloff_engine::{Case, Control, Preset, preset};
use std::fmt::Write;

/// A line that ends this near to the border of the map, in shares, reaches it.
const SLACK: f64 = 1e-6;

fn axis(key: &str, range: [f64; 2], logarithmic: bool) -> MapAxis {
    MapAxis::new(key, range, logarithmic, 1.0).unwrap()
}

/// The snaps of the preset with these values, by its own unloading; `None` if it has no path.
fn snaps(preset: &Preset, values: [(&MapAxis, f64); 2]) -> Option<usize> {
    let mut preset = preset.clone();
    let keys = values.iter().filter(|(axis, _)| axis.key != COMPLIANCE);
    preset.set_all(keys.map(|(axis, value)| (axis.key.as_str(), (*value).into()))).unwrap();
    if let Some((_, compliance)) = values.iter().find(|(axis, _)| axis.key == COMPLIANCE) {
        preset.path.control = if *compliance == 0.0 {
            Control::Displacement
        } else if compliance.is_finite() {
            Control::Stiffness(1.0 / compliance)
        } else {
            Control::Force
        };
    }
    let case = Case::new(&preset).ok()?;
    let path =
        case.unload(&case.curve(&Unwatched).ok()?, &PathSetting::one_disc(case.control), &Unwatched).ok()?;
    Some(path.events.iter().filter(|event| event.kind == EventKind::Snap).count())
}

/// The number of pairs of neighbouring cells with different snaps, and what is wrong with the map.
fn judged(preset: &Preset, [x, y]: [MapAxis; 2], cells: [u32; 2]) -> (usize, String) {
    let name = format!("{x} {y}");
    let report = MapReport::compute(preset, x.clone(), &Ordinate::Key(y.clone()), cells, &Unwatched).unwrap();
    let share = |axis: &MapAxis, value: Option<f64>| axis.share(value.unwrap_or(f64::INFINITY));
    let lines = report.rows.iter().filter(|row| row.kind != "swallowtail");
    let points: Vec<(usize, [f64; 2])> =
        lines.map(|row| (row.line.unwrap(), [share(&x, row.x), share(&y, row.y)])).collect();
    let counts = report.counts.unwrap();
    let mut wrong = String::new();
    let values =
        |all: &[Option<f64>]| -> Vec<f64> { all.iter().map(|x| x.unwrap_or(f64::INFINITY)).collect() };
    let (columns, rows) = (values(&counts.x), values(&counts.y));
    let mut own = vec![vec![None; columns.len()]; rows.len()];
    for (i, u) in columns.iter().enumerate() {
        for (j, v) in rows.iter().enumerate() {
            own[j][i] = snaps(preset, [(&x, *u), (&y, *v)]);
            if own[j][i] != counts.snaps[j][i] {
                writeln!(wrong, "{name} at {u} {v}: {:?}, not {:?}", counts.snaps[j][i], own[j][i]).unwrap();
            }
        }
    }
    let is_crossed = |along: usize, held: f64, [lo, hi]: [f64; 2]| {
        points.windows(2).filter(|pair| pair[0].0 == pair[1].0).any(|pair| {
            let (a, b) = (pair[0].1, pair[1].1);
            let [off, other] = [a, b].map(|at| at[1 - along] - held);
            let within = |share: f64| lo - SLACK <= share && share <= hi + SLACK;
            off.abs() <= SLACK && within(a[along])
                || other.abs() <= SLACK && within(b[along])
                || off * other < 0.0 && within(a[along] + off / (off - other) * (b[along] - a[along]))
        })
    };
    let shares = [
        columns.iter().map(|value| x.share(*value)).collect::<Vec<_>>(),
        rows.iter().map(|value| y.share(*value)).collect(),
    ];
    let mut differ = 0;
    for i in 0..columns.len() {
        for j in 0..rows.len() {
            for along in [0, 1] {
                let [u, v] = if along == 0 { [i + 1, j] } else { [i, j + 1] };
                if u >= columns.len() || v >= rows.len() || own[j][i] == own[v][u] {
                    continue;
                }
                differ += 1;
                let [from, held] = if along == 0 { [i, j] } else { [j, i] };
                let ends = [shares[along][from], shares[along][from + 1]];
                if !is_crossed(along, shares[1 - along][held], ends) {
                    writeln!(
                        wrong,
                        "{name}: no line between {:?} and {:?} along {along} from cell {i} {j}",
                        own[j][i], own[v][u]
                    )
                    .unwrap();
                }
            }
        }
    }
    (differ, wrong)
}

fn loaded(name: &str) -> Preset {
    let path = format!("{}/../tests/data/loops/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    preset::read(name, &std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn maps_that_lost_lines_have_them() {
    let cases = [
        (
            "map-AB",
            axis("gap.parameters.A", [0.0, 0.01057], false),
            axis("gap.parameters.B", [0.0, 3.0], false),
        ),
        (
            "map-landing",
            axis("groups.wavelength_over_radius", [0.04, 0.15], false),
            axis("groups.amplitude_over_wavelength", [0.0056, 0.0126], false),
        ),
        (
            "map-start",
            axis(COMPLIANCE, [0.0, f64::INFINITY], false),
            axis("groups.adhesion", [0.001, 1.0], true),
        ),
    ];
    for (name, x, y) in cases {
        let (differ, wrong) = judged(&loaded(name), [x, y], [24, 18]);
        assert!(wrong.is_empty(), "{name}\n{wrong}");
        assert!(differ > 50, "{name}: {differ}");
    }
}

/// Pseudo-random numbers between 0 and 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn from(&mut self, [lo, hi]: [f64; 2]) -> f64 {
        lo + (hi - lo) * self.next()
    }

    /// Uniform in the logarithm.
    fn over(&mut self, range: [f64; 2]) -> f64 {
        axis("any", range, true).value(self.next())
    }

    /// One of this many.
    fn one_of(&mut self, count: usize) -> usize {
        (0..count).find(|k| self.next() * (count - k) as f64 <= 1.0).unwrap_or(0)
    }
}

/// A random problem and the numbers that a map of it may have, each with its range.
fn problem(random: &mut Random, number: usize) -> (Preset, Vec<MapAxis>) {
    let wave = random.over([0.04, 0.12]);
    let amplitude = random.over([1e-4, 5e-3]);
    let adhesion = random.over([1e-4, 5e-3]);
    let start = random.from([0.15, 0.4]);
    let around = |key: &str, value: f64| axis(key, [0.5 * value, 1.8 * value], false);
    let (gap, mut axes) = match number % 4 {
        0 => (
            format!(
                "shape = \"wavy-sphere\"\nradius_of_curvature = 1.0\namplitude = {amplitude:?}\nwavelength = {wave:?}"
            ),
            vec![axis("gap.amplitude", [0.0, 2.0 * amplitude], false), around("gap.wavelength", wave)],
        ),
        1 => (
            format!(
                "shape = \"formula\"\nformula = \"r^2/2 + A*(1-cos(2*pi*r/l)) + B*r^4\"\n[gap.parameters]\nA = {amplitude:?}\n\
                 l = {wave:?}\nB = 0.5"
            ),
            vec![
                axis("gap.parameters.A", [0.0, 2.0 * amplitude], false),
                axis("gap.parameters.B", [0.0, 2.0], false),
                around("gap.parameters.l", wave),
            ],
        ),
        2 => {
            let (at, width) = (random.from([0.05, 0.3]), random.from([0.01, 0.04]));
            (
                format!(
                    "shape = \"formula\"\nformula = \"r^2/2 + a*exp(-((r-c)/w)^2)\"\n[gap.parameters]\na = {:?}\nc = {at:?}\n\
                     w = {width:?}",
                    0.3 * amplitude * (random.next() - 0.5).signum()
                ),
                vec![around("gap.parameters.c", at), around("gap.parameters.w", width)],
            )
        }
        _ => {
            let at = random.from([0.05, 0.25]);
            (
                format!(
                    "shape = \"formula\"\nformula = \"r^2/2 + a*abs(r-c) + b*(1-cos(2*pi*r/{wave:?}))\"\n[gap.parameters]\n\
                     a = {:?}\nc = {at:?}\nb = {:?}",
                    random.from([-0.05, 0.05]),
                    0.3 * amplitude
                ),
                vec![around("gap.parameters.c", at), axis("gap.parameters.a", [-0.05, 0.05], false)],
            )
        }
    };
    let control = match random.one_of(4) {
        0 | 1 => "\"displacement\"".to_owned(),
        2 => "\"force\"".to_owned(),
        _ => format!("{{ stiffness = {:?} }}", random.over([0.05, 3.0])),
    };
    let text = format!(
        "[material]\neffective_modulus = 1.0\nwork_of_adhesion = {adhesion:?}\n[path]\ncontrol = {control}\n\
         start_contact_radius = {start:?}\nend_contact_radius = 0.002\n[gap]\n{gap}\n"
    );
    axes.push(axis("material.work_of_adhesion", [0.1 * adhesion, 10.0 * adhesion], true));
    axes.push(axis(COMPLIANCE, [0.0, f64::INFINITY], false));
    axes.push(axis("path.start_contact_radius", [0.6 * start, 1.2 * start], false));
    (preset::read("random", &text).unwrap(), axes)
}

fn random_maps(numbers: impl Iterator<Item = usize>) {
    let (mut differ, mut wrong) = (0, String::new());
    for number in numbers {
        let mut random = Random(20_261_123 + 977 * number as u64);
        random.next();
        let (preset, mut axes) = problem(&mut random, number);
        let pair = [0, 0].map(|_| {
            let at = random.one_of(axes.len());
            axes.remove(at)
        });
        let (more, found) = judged(&preset, pair, [12, 9]);
        differ += more;
        if !found.is_empty() {
            writeln!(wrong, "map {number}:\n{found}").unwrap();
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(differ > 100, "{differ}");
}

#[test]
fn ten_random_maps_have_a_line_wherever_the_snaps_differ() {
    random_maps((0..100).step_by(11));
}

#[test]
#[ignore = "a hundred maps"]
fn a_hundred_random_maps_have_a_line_wherever_the_snaps_differ() {
    random_maps(0..100);
}
