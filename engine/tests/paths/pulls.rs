//! Slow pulls against the unloading, which is their limit.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::Case;
use pulloff_engine::preset;
use pulloff_engine::problem::{Control, Part};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::{PathSetting, PathState};
use pulloff_engine::rate::{EdgeLaw, MovingEdge, PullSettings, Puller};

/// Gaps with snaps, under displacement and behind a spring: a slow pull has the same snaps as the unloading, from and
/// to the same places.
#[test]
fn slow_pulls_show_the_events_of_the_unloading() {
    let gaps = [
        ("shape = \"wavy-sphere\"\nradius_of_curvature = 1.0\namplitude = 0.0025\nwavelength = 0.05", 0.41),
        ("shape = \"wavy-sphere\"\nradius_of_curvature = 1.0\namplitude = 0.0025\nwavelength = 0.05", 0.5),
        ("shape = \"wavy-sphere\"\nradius_of_curvature = 1.0\namplitude = 0.004\nwavelength = 0.11", 0.45),
        // The waves only speed up the edge here and there.
        ("shape = \"wavy-sphere\"\nradius_of_curvature = 1.0\namplitude = 0.0006\nwavelength = 0.07", 0.5),
        ("shape = \"power-law\"\ncoefficient = 1.0\nexponent = 3.0", 0.5),
        ("shape = \"formula\"\nformula = \"r^2/2 + 0.02*exp(-((r-0.3)/0.03)^2)\"", 0.5),
        ("shape = \"formula\"\nformula = \"r^2/2 + 0.05*abs(r-0.3)\"", 0.5),
        ("shape = \"formula\"\nformula = \"r^2/2 - 0.04*abs(r-0.25) + 0.002*cos(60*r)\"", 0.5),
        ("shape = \"formula\"\nformula = \"r^2/2 + 0.004*sin(90*r)*exp(-(r/0.3)^2)\"", 0.5),
    ];
    let mut seen = 0;
    for (gap, start) in gaps {
        for control in [Control::Displacement, Control::Stiffness(0.2)] {
            let text = format!(
                "format = 1\n[material]\neffective_modulus = 1.0\nwork_of_adhesion = 0.004\n[gap]\n{gap}\n[basis]\nkind = \"exact\"\n[path]\n\
                 control = \"displacement\"\nstart_contact_radius = {start}\nend_contact_radius = 0.001\ncontact = \"one-disc\"\n"
            );
            let preset = preset::read("gap", &text).unwrap();
            let case = Case::new(&preset).unwrap();
            let setting = PathSetting { control, ..case.setting_of_unloading() };
            let path = case.unload(&case.curve(&Unwatched).unwrap(), &setting, &Unwatched).unwrap();
            let begun = path.states[0].contact_radius;
            let radius = |state: &Option<PathState>| state.as_ref().map(|state| state.contact_radius);
            let jumps: Vec<[f64; 2]> = path
                .events
                .iter()
                .filter_map(|event| Some([radius(&event.before)?, radius(&event.after)?]))
                .collect();
            let gamma = case.reduced.work_of_adhesion;
            for (exponent, rate) in [(0.25, 1e-20), (0.5, 1e-13), (1.0, 1e-9)] {
                let edge = MovingEdge { law: EdgeLaw::symmetric(exponent), opening: gamma, closing: gamma };
                let wave = case.reduced.gap.feature_length();
                let settings = PullSettings::default();
                let puller =
                    Puller { table: &case.table, control, edge, start: begun, wave, rise: None, settings };
                let pull = puller.pull(&[Part::Apart { rate }], &Unwatched).unwrap();
                let snaps: Vec<[f64; 2]> = pull.snaps.iter().map(|snap| [snap.from, snap.to]).collect();
                let name = format!("{gap} {control} n {exponent} V {rate:e}: {snaps:?}, not {jumps:?}");
                assert_eq!(snaps.len(), jumps.len(), "{name}");
                for (snap, jump) in snaps.iter().zip(&jumps) {
                    let off = snap.iter().zip(jump).map(|(a, b)| (a - b).abs());
                    assert!(off.fold(0.0, f64::max) < 0.3 * (jump[0] - jump[1]), "{name}");
                }
                seen += snaps.len();
            }
        }
    }
    assert!(seen > 60, "{seen}");
}
