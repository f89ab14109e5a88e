//! Pulls of the wavy sphere, against numbers from two programs that share nothing with this one.

use super::law::EdgeLaw;
use super::pull::{Pull, Puller};
use super::record::Moment;
use super::variation::{START, STIFFNESS, VALUES};
use super::{MovingEdge, PullSettings};
use crate::disc::Table;
use crate::gap::Shape;
use crate::problem::{Control, Part, Problem};
use crate::progress::Unwatched;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

const GAMMA: f64 = 0.025 / TAU;

fn table(shape: Shape) -> Table {
    let problem = Problem { effective_modulus: 1.0, work_of_adhesion: GAMMA, shape }.reduced();
    Table::new(Arc::clone(&problem.gap), 0.5, &Unwatched).unwrap()
}

fn wavy() -> Table {
    table(Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 })
}

fn puller(table: &Table, exponent: f64, control: Control) -> Puller<'_> {
    let edge = MovingEdge { law: EdgeLaw::symmetric(exponent), opening: GAMMA, closing: GAMMA };
    let rise = 0.01 * 1.5 * PI * GAMMA;
    Puller {
        table,
        control,
        edge,
        start: 0.5,
        wave: table.gap().feature_length(),
        rise: Some(rise),
        settings: PullSettings::default(),
    }
}

fn pulled(table: &Table, exponent: f64, rate: f64) -> Pull {
    puller(table, exponent, Control::Displacement).pull(&[Part::Apart { rate }], &Unwatched).unwrap()
}

#[test]
fn the_peak_of_the_wavy_sphere_at_a_rate() {
    let table = wavy();
    for (exponent, ratios, counts) in [
        (0.25, [1.63458, 1.91279, 2.69884, 5.04156], [8, 7, 6, 5]),
        (0.5, [1.50139, 1.64877, 2.72997, 10.0747], [8, 7, 6, 2]),
        (1.0, [1.48012, 1.51014, 2.95867, 24.1854], [8, 8, 3, 1]),
    ] {
        for (k, rate) in [1e-4, 1e-2, 1.0, 100.0].into_iter().enumerate() {
            let pull = pulled(&table, exponent, rate);
            let ratio = -pull.peak.force / (1.5 * PI * GAMMA);
            assert!((ratio / ratios[k] - 1.0).abs() < 5e-6, "{exponent} {rate}: {ratio}");
            assert_eq!(pull.tension_peaks.len(), counts[k], "{exponent} {rate}");
            assert!(pull.balance < 1e-9);
        }
    }
}

/// The sum of the losses of the quasi-static unloading of the wavy sphere from s = 0.5, and the exponent with which a
/// pull approaches it.
#[test]
fn what_a_slow_pull_dissipates_is_what_the_jumps_lose() {
    const LOSSES: f64 = 1.052_852_894_6e-3;
    let table = wavy();
    for exponent in [0.5, 1.0] {
        let lost = |rate| pulled(&table, exponent, rate).dissipated.unwrap() - LOSSES;
        let (slow, slower) = (lost(1e-6), lost(1e-7));
        assert!(slower > 0.0 && slower < slow);
        let slope = (slow / slower).log10();
        let law = 2.0 * exponent / (2.0 + exponent);
        assert!((slope / law - 1.0).abs() < 0.04, "{exponent}: {slope} {law}");
    }
}

/// The control at the last contact is late by `K_n` d, with d from the law of a limit point; `K_1` is the first zero
/// of Airy's function.
#[test]
fn the_last_contact_of_a_slow_pull_is_late_by_the_law() {
    let table = wavy();
    for (exponent, factor) in [(1.0, 2.33811), (0.5, 1.63416), (0.25, 1.36916)] {
        let rate = 1e-8;
        let puller = puller(&table, exponent, Control::Displacement);
        let panels = table.up_to(0.5).unwrap();
        let folds = super::caps::MotionFolds::new(
            &panels,
            &puller.edge,
            super::law::Motion::Opening,
            Control::Displacement,
        );
        let last = folds.list.iter().min_by(|a, b| a.limit.approach.total_cmp(&b.limit.approach)).unwrap();
        let pull = pulled(&table, exponent, rate);
        let late = last.limit.approach - pull.last_contact.unwrap().control;
        let law = factor * last.delay(rate, exponent);
        assert!((late / law - 1.0).abs() < 0.02, "{exponent}: {late} {law}");
    }
}

/// A running edge forgets how it was loaded: what is left is the error of the integration, as small as is asked for.
#[test]
fn the_start_is_forgotten() {
    let table = wavy();
    for (tolerance, same) in [(1e-9, 1e-9), (1e-12, 1e-12)] {
        let from = |start, rate| {
            let settings = PullSettings { tolerance, ..PullSettings::default() };
            let puller = Puller { start, settings, ..puller(&table, 0.5, Control::Displacement) };
            let pull = puller.pull(&[Part::Apart { rate }], &Unwatched).unwrap();
            [pull.peak.force, pull.last_contact.unwrap().control]
        };
        for rate in [1e-2, 1e-4] {
            let (a, b) = (from(0.5, rate), from(0.4905, rate));
            println!("{tolerance:e} {rate:e} {:e} {:e}", a[0] / b[0] - 1.0, a[1] / b[1] - 1.0);
            let off = a.iter().zip(&b).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
            assert!(off < same, "{tolerance} {rate}: {a:?} {b:?}");
        }
    }
}

/// Springs from soft to stiff, holds, reloading and a dead band: the balance of work and energy closes, and the parts are kept.
#[test]
fn programmes_close_their_balance() {
    let table = wavy();
    for control in
        [Control::Displacement, Control::Stiffness(1e-3), Control::Stiffness(0.15), Control::Stiffness(1e3)]
    {
        for closing in [1.0, 0.5] {
            let edge = MovingEdge { law: EdgeLaw::symmetric(0.5), opening: GAMMA, closing: closing * GAMMA };
            let puller = Puller { edge, start: 0.3, ..puller(&table, 0.5, control) };
            let panels = table.up_to(0.5).unwrap();
            let to = super::equation::HeldDisc::equilibrium(&panels, control, edge.closing, 0.37);
            let parts = [Part::Ramp { to, rate: 0.01 }, Part::Hold { time: 3.0 }, Part::Apart { rate: 0.02 }];
            let pull = puller.pull(&parts, &Unwatched).unwrap();
            assert!(pull.balance < 1e-9, "{control:?} {closing}: {}", pull.balance);
            assert!(pull.last_contact.is_some() && pull.holds.len() == 1);
            assert!(pull.closed_to.unwrap()[0] > 0.3);
        }
    }
}

/// Barquins' time to failure: near the largest load that is borne it grows as the law of a limit point says.
#[test]
fn a_dead_load_is_borne_as_long_as_the_law_says() {
    let table = table(Shape::Sphere { radius_of_curvature: 1.0 });
    let start = 0.45;
    let panels = table.up_to(start).unwrap();
    let critical = 1.5 * PI * GAMMA;
    let s = (9.0 * PI * GAMMA / 8.0).cbrt();
    for (exponent, beta, near, ratios) in
        [(0.5, 0.5 * PI, [1e-4, 0.1], [1.0000, 0.962]), (1.0, PI, [1e-4, 0.1], [0.993, 0.79])]
    {
        let edge = MovingEdge { law: EdgeLaw::symmetric(exponent), opening: GAMMA, closing: GAMMA };
        let borne = super::failure::time_to_failure(&panels, &edge, start, -0.999 * critical).unwrap();
        assert_eq!(borne, None);
        let exactly = super::failure::time_to_failure(&panels, &edge, start, -critical * (1.0 + 2e-15));
        assert_eq!(exactly, Ok(None), "the largest load that is borne, but for rounding");
        for (over, ratio) in near.into_iter().zip(ratios) {
            let force = -critical * (1.0 + over);
            let time = super::failure::time_to_failure(&panels, &edge, start, force).unwrap().unwrap();
            // P'' of the sphere at its least force, and T_c = 2sT.
            let bend = 8.0 * s - 0.75 * (8.0 * PI * GAMMA / s).sqrt();
            let unit = 2.0 * s * (TAU * GAMMA * s).sqrt();
            let scale = (2.0 / bend).sqrt() * (unit / 2.0).powf(1.0 / exponent);
            let law = beta * scale * (over * critical).powf(0.5 - 1.0 / exponent);
            assert!((time / law / ratio - 1.0).abs() < 0.01, "{exponent} {over}: {} {ratio}", time / law);
        }
    }
}

/// s, c, δ and P where one of them, given by its number, has the value `at`, from the polynomial through the six
/// moments around it.
fn polynomial(moments: &[Moment], number: usize, at: f64) -> Option<[f64; 4]> {
    let of = |moment: &Moment| [moment.contact_radius, moment.control, moment.approach, moment.force];
    let next = moments.iter().position(|moment| of(moment)[number] < at)?;
    let around = moments.get(next.checked_sub(3)?..next + 3)?;
    let mut sum = [0.0; 4];
    for (i, here) in around.iter().enumerate() {
        let others = around.iter().enumerate().filter(|(j, _)| *j != i);
        let share = |other: &Moment| (at - of(other)[number]) / (of(here)[number] - of(other)[number]);
        let weight: f64 = others.map(|(_, other)| share(other)).product();
        sum.iter_mut().zip(of(here)).for_each(|(sum, x)| *sum += weight * x);
    }
    Some(sum)
}

/// How the states of a pull change with one of its values as its derivatives say, and by differences of the pulls
/// `beside` it, at −2, −1, 1 and 2 steps: the largest error and the largest difference, as shares, and how many states.
fn compared(here: &Pull, beside: &[Pull; 4], device: Control, value: usize, step: f64) -> [f64; 3] {
    let begin = here.moments.iter().position(|moment| moment.speed > 0.0).unwrap();
    let [mut worst, mut most, mut count] = [0.0_f64; 3];
    for (moment, moved) in here.moments.iter().zip(&here.moved).skip(begin) {
        let s = moment.contact_radius;
        // The rest of a dead load falls for ever.
        if s < 0.02 {
            break;
        }
        let number = usize::from(s > 0.37);
        let held = [s, moment.control][number];
        let at = |pull: &Pull, by: f64| {
            let moving = pull.moments.iter().position(|moment| moment.speed > 0.0)?;
            polynomial(&pull.moments[moving..], number, held + by)
        };
        let [Some(a), Some(b), Some(c), Some(d)] = beside.each_ref().map(|pull| at(pull, 0.0)) else {
            continue;
        };
        let way = 1e-5 * held.abs();
        let (Some(less), Some(more)) = (at(here, -way), at(here, way)) else { continue };
        let [by_s, by_delta, by_force] = moved[value];
        let spring = match device {
            Control::Stiffness(k) if value == STIFFNESS => moment.force / k,
            _ => 0.0,
        };
        let along = [by_s, device.value(by_delta, by_force) - spring][number];
        for (k, told, unit) in [(0, by_s, 0.4), (2, by_delta, 0.05), (3, by_force, 0.02)] {
            let difference = (8.0 * (c[k] - b[k]) - (d[k] - a[k])) / (12.0 * step);
            let way = (more[k] - less[k]) / (2.0 * way) * along;
            // Most of a way along the pull is taken away again.
            let size = unit + told.abs() + way.abs();
            worst = worst.max((told - way - difference).abs() / size);
            most = most.max(difference.abs() / size);
        }
        count += 1.0;
    }
    [worst, most, count]
}

/// The variational equation says how neighbouring pulls differ: at held control while the edge is slow, at held radius
/// afterwards.
#[test]
fn pulls_beside_each_other_differ_as_their_derivatives_say() {
    const STEP: f64 = 1e-3;
    let mut wrong = Vec::new();
    let settings = PullSettings {
        tolerance: 1e-12,
        derivatives: true,
        of_panel: 0.1,
        of_wave: 0.02,
        ..PullSettings::default()
    };
    let sphere = table(Shape::Sphere { radius_of_curvature: 1.0 });
    let waves = wavy();
    for (table, device, closing, exponent, rate) in [
        (&sphere, Control::Displacement, 1.0, 0.5, 1e-3),
        (&sphere, Control::Stiffness(0.3), 0.6, 0.5, 0.3),
        (&sphere, Control::Force, 1.0, 0.3, 1e-2),
        (&waves, Control::Stiffness(2.0), 1.0, 0.8, 0.1),
    ] {
        let control = |by: f64| match device {
            Control::Stiffness(k) => Control::Stiffness(k * by.exp()),
            other => other,
        };
        let pulled = |by: [f64; VALUES]| {
            let [gamma, n, v, k, s] = by;
            let law = EdgeLaw::symmetric(exponent * n.exp());
            let edge = MovingEdge { law, opening: GAMMA * gamma.exp(), closing: closing * GAMMA };
            let (control, start, wave) = (control(k), 0.4 * s.exp(), table.gap().feature_length());
            let puller = Puller { table, control, edge, start, wave, rise: None, settings };
            puller.pull(&[Part::Apart { rate: rate * v.exp() }], &Unwatched).unwrap()
        };
        let here = pulled([0.0; VALUES]);
        for value in 0..VALUES {
            // Of fourth order in the step; where a slow pull begins its start is soon forgotten.
            let step = if value == START { 0.25 * STEP } else { STEP };
            let beside = [-2.0, -1.0, 1.0, 2.0].map(|share| {
                let mut values = [0.0; VALUES];
                values[value] = share * step;
                pulled(values)
            });
            let [worst, most, count] = compared(&here, &beside, device, value, step);
            println!("{device:?} {value}: {worst:e} of {most:e}, {count}");
            // The polynomials are known to 1e-8, which is divided by the step.
            if count < 30.0 || worst > 1e-4 {
                wrong.push(format!("{device:?} {value}: {worst:e} of {most:e}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Towards a pull without speed the snaps converge: where they begin and end, and how fast they are. Below about 1e-9 the
/// speed along the equilibria is less than the tolerance of the integrator.
#[test]
fn the_snaps_of_ever_slower_pulls_converge() {
    let table = wavy();
    for exponent in [0.5, 1.0] {
        let [slow, slower, slowest] = [1e-8, 1e-10, 1e-12].map(|rate| pulled(&table, exponent, rate).snaps);
        for snaps in [&slower, &slowest] {
            assert_eq!(snaps.len(), slow.len(), "{exponent}");
            for (snap, like) in snaps.iter().zip(&slow) {
                assert!((snap.from - like.from).abs() < 0.003, "{exponent}: {snap:?} {like:?}");
                assert!((snap.to - like.to).abs() < 1e-4, "{exponent}: {snap:?} {like:?}");
                assert!(
                    (snap.top_speed / like.top_speed - 1.0).abs() < 0.02,
                    "{exponent}: {snap:?} {like:?}"
                );
            }
        }
    }
}

/// A pull that is interrupted by a border between two parts, and nothing else, has the same snaps.
#[test]
fn a_snap_goes_on_across_the_border_of_two_parts() {
    let table = wavy();
    let parts = |programme: &[Part]| {
        puller(&table, 0.5, Control::Displacement).pull(programme, &Unwatched).unwrap().snaps
    };
    let rate = 0.01;
    let whole = parts(&[Part::Apart { rate }]);
    // Borders before, in and after the first snaps.
    for k in 0..40 {
        let to = 0.06 - 0.0025 * f64::from(k);
        let cut = parts(&[Part::Ramp { to, rate }, Part::Apart { rate }]);
        assert_eq!(cut.len(), whole.len(), "{to}: {cut:?} {whole:?}");
        for (a, b) in cut.iter().zip(&whole) {
            assert!((a.from - b.from).abs() < 1e-3 && (a.to - b.to).abs() < 1e-3, "{to}: {a:?} {b:?}");
            assert!((a.top_speed / b.top_speed - 1.0).abs() < 1e-3, "{to}: {a:?} {b:?}");
        }
    }
    // A hold in which the edge comes to rest begins anew: the faster part after it has its own snaps.
    let faster = parts(&[
        Part::Ramp { to: -0.01, rate: 0.1 },
        Part::Hold { time: 1000.0 },
        Part::Apart { rate: 10.0 },
    ]);
    let last = faster.last().unwrap();
    assert!(faster.len() == 5 && last.top_speed > 50.0, "{faster:?}");
}

/// Turns on stable equilibria change nothing but the time: the edge snaps where it would have snapped without them.
#[test]
fn snaps_after_turns_begin_where_those_of_a_whole_pull_do() {
    let table = wavy();
    let parts = |programme: &[Part]| {
        puller(&table, 0.6, Control::Displacement).pull(programme, &Unwatched).unwrap().snaps
    };
    for rate in [1e-6, 1e-4] {
        let whole = parts(&[Part::Apart { rate }]);
        for turns in [[0.0355, 0.0365], [0.03, 0.05], [0.06, 0.07]] {
            let ramps = turns.map(|to| Part::Ramp { to, rate });
            let turned = parts(&[ramps.as_slice(), &[Part::Apart { rate }]].concat());
            let after = turned.iter().filter(|snap| snap.from > snap.to);
            for (a, b) in after.rev().zip(whole.iter().rev()).take(4) {
                assert!((a.from - b.from).abs() < 1e-3, "{rate} {turns:?}: {a:?} {b:?}");
                assert!((a.dissipated / b.dissipated - 1.0).abs() < 0.01, "{rate} {turns:?}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn what_dips_while_the_edge_closes_is_no_tension() {
    let table = wavy();
    let from = |start: f64| Puller { start, ..puller(&table, 0.5, Control::Displacement) };
    let away = Part::Apart { rate: 0.002 };
    let programme = [Part::Ramp { to: 0.2, rate: 0.02 }, Part::Hold { time: 100.0 }, away];
    let pressed = from(0.3).pull(&programme, &Unwatched).unwrap();
    // The same as of a pull from rest at the radius that it was pressed to.
    let [radius, _] = pressed.closed_to.unwrap();
    let rested = from(radius).pull(&[away], &Unwatched).unwrap();
    let forces = |pull: &Pull| pull.tension_peaks.iter().map(|peak| peak.force).collect::<Vec<f64>>();
    let [pressed, rested] = [forces(&pressed), forces(&rested)];
    assert!(pressed.len() == rested.len() && rested.len() > 8, "{pressed:?} {rested:?}");
    for (a, b) in pressed.iter().zip(&rested) {
        assert!((a - b).abs() < 1e-6, "{pressed:?} {rested:?}");
    }
}
