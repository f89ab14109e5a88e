//! What sweeps measure: loops, enhancements, and what is said of their rows.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::sweep::Sweeps;
use pulloff::store::Store;
use pulloff::sweep::{Shard, spec};
use pulloff_engine::gap::Shape;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::sweep::Spec;
use pulloff_engine::theory::guduru::Guduru;
use pulloff_engine::theory::kesari_lew::KesariLew;
use pulloff_engine::{Extent, PathReport};

#[test]
fn the_loop_is_measured() {
    let home = Sweeps::new();
    home.file(
        "s.toml",
        r#"
preset = "fig-9-weak"
quantities = ["cycle_loss", "cycle_loss_force", "first_touch_force", "first_touch_radius", "touches", "rings_at_most",
    "contact_share", "touches_force"]
[[axis]]
key = "material.work_of_adhesion"
values = [0.0, 1e-5, 1e-4, 0.0039788735772973835]
"#,
    );
    home.sweep("s.toml", "r.csv", &[]);
    // Without adhesion nothing is lost, the first touch is a point, and rings touch last.
    let loss = home.numbers("r.csv", "cycle_loss");
    assert!(loss[0] == 0.0 && loss.is_sorted());
    assert!((loss[2] - 1.297_949_009_46e-4).abs() < 1e-12 && (loss[3] - 2.112_003_387_3e-3).abs() < 1e-12);
    let radius = home.numbers("r.csv", "first_touch_radius");
    assert!((radius[2] - 0.007_794_0).abs() < 1e-7 && (radius[3] - 0.261_057_6).abs() < 1e-7);
    assert!((home.numbers("r.csv", "first_touch_force")[3] + 0.012_934_170_6).abs() < 1e-10);
    assert_eq!(home.numbers("r.csv", "touches")[1..], [7.0, 7.0, 0.0]);
    assert_eq!(home.numbers("r.csv", "rings_at_most")[2..], [1.0, 0.0]);
    let share = home.numbers("r.csv", "contact_share");
    assert!(share[0] < 0.95 && (share[2] - 1.0).abs() < 1e-12 && (share[3] - 1.0).abs() < 1e-12, "{share:?}");
    // Under a dead load the pull-off has no bound.
    assert!(home.columns("r.csv", &["cycle_loss_force"])[0][1..].iter().all(String::is_empty));
}

#[test]
fn a_loop_with_a_dead_band_loses_its_work() {
    let home = Sweeps::new();
    let gains = [0.002, 0.004];
    home.file(
        "s.toml",
        "preset = \"fig-3-jkr\"\nset = [\"basis.kind=exact\"]\nquantities = [\"cycle_loss\"]\n[[axis]]\n\
         key = \"material.closing_work_of_adhesion\"\nvalues = [0.002, 0.004]\n",
    );
    home.sweep("s.toml", "r.csv", &[]);
    for (gain, loss) in gains.into_iter().zip(home.numbers("r.csv", "cycle_loss")) {
        let store = Store::at(std::path::Path::new("/nowhere"), &[]);
        let set = ["basis.kind=exact".to_owned(), format!("gamma_a={gain}")];
        let preset = store.load(&store.resolve("fig-3-jkr").unwrap(), &set).unwrap().preset;
        let whole = PathReport::cycle(&preset, None, Extent::default(), &Unwatched).unwrap().totals;
        let work = whole.work_of_loading.unwrap() + whole.work_of_unloading.unwrap();
        assert!((loss / work - 1.0).abs() < 1e-9 && loss > 2.0 * whole.dissipated.unwrap(), "{loss} {work}");
    }
}

/// Rows of many small waves; an assignment in `set` or an axis `start` determines where their curves begin.
fn small_waves(home: &Sweeps, set: &str, start: &str) -> Spec {
    let store = Store::at(home.path("presets"), &[]);
    let text = format!(
        r#"
preset = "wavy-sphere"
quantities = ["enhancement", "kesari_lew", "waves"]
set = [{set}"path.end_contact_radius=0.1"]
[random]
draws = 60
seed = 3
[[axis]]
key = "gap.wavelength"
distribution = {{ log-uniform = [0.01, 0.06] }}
[[axis]]
key = "groups.amplitude_over_wavelength"
distribution = {{ uniform = [0.005, 0.05] }}
[[axis]]
key = "groups.adhesion"
distribution = {{ log-uniform = [0.01, 0.05] }}
{start}"#
    );
    spec::read(&store, home.folder(), "s", &text).unwrap()
}

/// The rows of `spec` with an enhancement: row number, distance from the estimate, number of waves; and the rows without one.
fn enhanced(spec: &Spec) -> (Vec<(u64, f64, f64)>, Vec<u64>) {
    let (mut had, mut cut_off) = (Vec::new(), Vec::new());
    for index in 0..Shard::WHOLE.len(spec.rows) {
        let measured = spec.measure(index, &Unwatched).unwrap();
        let number =
            |column: usize| measured.cells[column].map(|cell| cell.to_string().parse::<f64>().unwrap());
        match (number(0), number(1), number(2)) {
            (Some(enhancement), Some(estimate), Some(waves)) => {
                assert_eq!(measured.fault, None);
                had.push((index, enhancement / estimate - 1.0, waves));
            }
            (None, Some(_), None) => {
                assert_eq!(measured.fault.unwrap().reason, "small start");
                cut_off.push(index);
            }
            other => panic!("{index}: {other:?}"),
        }
    }
    (had, cut_off)
}

#[test]
fn many_waves_are_enhanced_as_kesari_and_lew_estimate() {
    let home = Sweeps::new();
    let spec = small_waves(&home, "\"path.start_contact_radius=0.9\", ", "");
    let (had, cut_off) = enhanced(&spec);
    assert!(cut_off.is_empty(), "{cut_off:?}");
    let many: Vec<_> = had.iter().filter(|(_, _, waves)| *waves > 8.0).collect();
    assert!(many.len() > 20, "{}", many.len());
    for (row, off, waves) in many {
        assert!(off.abs() < 0.01, "{:?}: {off} with {waves} waves", spec.values(*row));
    }
}

#[test]
fn a_start_that_cuts_the_smallest_force_off_is_said() {
    let home = Sweeps::new();
    // The same problems with one more draw: starts on both sides of the smallest force.
    let start = "[[axis]]\nkey = \"path.start_contact_radius\"\ndistribution = { uniform = [0.12, 0.45] }\n";
    let spec = small_waves(&home, "", start);
    let (had, cut_off) = enhanced(&spec);
    assert!(had.len() > 10 && cut_off.len() > 10, "{} {}", had.len(), cut_off.len());
    for (row, off, waves) in had.iter().filter(|(_, _, waves)| *waves > 8.0) {
        assert!(off.abs() < 0.01, "{:?}: {off} with {waves} waves", spec.values(*row));
    }
    // The peak of the estimate gives the same verdict for all starts that are not within two waves of it.
    for row in 0..spec.rows {
        let preset = spec.problem(row).unwrap();
        let Shape::WavySphere { radius_of_curvature, amplitude, wavelength } = preset.gap else {
            panic!("{row}")
        };
        let sphere = Guduru {
            effective_modulus: preset.material.effective_modulus,
            work_of_adhesion: preset.material.work_of_adhesion,
            radius_of_curvature,
            amplitude,
            wavelength,
        };
        let beyond = preset.path.start.value() - KesariLew { sphere }.effective().pull_off_radius();
        if beyond.abs() > 2.0 * wavelength {
            assert_eq!(cut_off.contains(&row), beyond < 0.0, "{row}: {beyond}, {wavelength}");
        }
    }
}

/// The pull and the snaps of a loop that turns early are not those of the unloading from the start.
#[test]
fn a_sweep_of_a_loop_has_the_numbers_of_that_loop() {
    let home = Sweeps::new();
    home.file(
        "loop.toml",
        "preset='fig-9-cycle'\nquantities=['largest_pull','cycle_largest_pull','snaps','cycle_snaps']\n\
         set=['material.work_of_adhesion=0.0002']\n[[axis]]\nkey='path.turn_approach'\nvalues=[0.003, 0.03]",
    );
    let (_, _, err) = home.run(&["sweep", "loop.toml", "-o", "r.csv"]);
    assert!(err.contains("largest_pull, snaps: of the unloading from the start, not of the loop"));
    let [pull, of_loop] = ["largest_pull", "cycle_largest_pull"].map(|name| home.numbers("r.csv", name));
    assert!((of_loop[0] + 0.001_209_199).abs() < 1e-9 && (of_loop[1] / pull[1] - 1.0).abs() < 1e-9);
    assert!((pull[0] / pull[1] - 1.0).abs() < 1e-9);
    assert_eq!(home.numbers("r.csv", "cycle_snaps"), [0.0, 2.0]);
}

#[test]
fn a_deviation_may_be_a_share_of_the_mean() {
    let home = Sweeps::new();
    let spec = |deviation: &str| {
        format!(
            "preset='wavy-sphere'\nquantities=['critical_force']\n[random]\ndraws=5\nseed=1\n[[axis]]\n\
             key='material.work_of_adhesion'\ndistribution={{normal={{mean=0.004, deviation={deviation}}}}}\n"
        )
    };
    home.file("number.toml", &spec("0.0002"));
    home.file("share.toml", &spec("'5%'"));
    home.sweep("number.toml", "number.csv", &[]);
    home.sweep("share.toml", "share.csv", &[]);
    let [number, share] = ["number.csv", "share.csv"].map(|file| home.numbers(file, "critical_force"));
    assert!(number.len() == 5 && number.iter().zip(&share).all(|(a, b)| (a - b).abs() < 1e-12 * a));
    home.file("none.toml", &spec("'-5%'"));
    let (status, _, err) = home.run(&["sweep", "none.toml", "-o", "none.csv"]);
    assert!(
        status == 2 && err.contains("axis.distribution.normal.deviation = -0.0002 is out of range"),
        "{err}"
    );
}

#[test]
fn an_end_that_cuts_something_off_is_said() {
    let home = Sweeps::new();
    let store = Store::at(home.path("presets"), &[]);
    let text = "preset = \"wavy-sphere\"\nset = [\"gamma=1e-5\"]\n\
        quantities = [\"farthest_displacement\", \"least_approach\", \"snaps_displacement\"]\n\
        [[axis]]\nkey = \"path.end_contact_radius\"\nvalues = [0.08, 0.0001]\n";
    let spec = spec::read(&store, home.folder(), "s", text).unwrap();
    let [early, whole] = [0, 1].map(|row| spec.measure(row, &Unwatched).unwrap());
    // The path ends in a stable contact, and the approach is smaller at the last contact, far further in.
    assert_eq!(early.fault.as_ref().map(|fault| fault.reason), Some("early end"));
    assert!(early.cells[0].is_none() && early.cells[1].is_none() && early.cells[2].is_some(), "{early:?}");
    assert!(whole.fault.is_none() && whole.cells.iter().all(Option::is_some), "{whole:?}");
}
