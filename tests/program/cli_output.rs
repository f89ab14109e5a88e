//! Where results go: files, standard output, closed readers.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use super::cli::short;
use crate::support::home::Home;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Stdio;

#[test]
fn a_result_goes_to_a_file_whole() {
    let home = Home::new();
    let expected = home.quiet(&short("trace", &[]));
    let file = home.path("curve.csv");
    fs::write(&file, "old").unwrap();
    home.refused(
        &short("trace", &["-o", "curve.csv"]),
        &["pulloff: -o curve.csv: already exists; --overwrite replaces it"],
    );
    assert_eq!(fs::read_to_string(&file).unwrap(), "old");
    assert_eq!(home.quiet(&short("trace", &["-o", "curve.csv", "--overwrite"])), "");
    assert_eq!(fs::read_to_string(&file).unwrap(), expected);
    // No temporary file stays behind.
    assert_eq!(names(home.folder()), ["curve.csv"]);
    // A failed run leaves the old file alone.
    let failed = ["-o", "curve.csv", "--overwrite", "--set", "basis.rings=1"];
    home.refused(&short("trace", &failed), &["basis.rings"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), expected);
}

#[test]
fn what_is_read_is_not_written_over() {
    let home = Home::new();
    let preset = "[material]\neffective_modulus = 1.0\nwork_of_adhesion = 0.01\n[gap]\nshape = \"profile\"\n\
                  file = \"scan.csv\"\n[path]\nstart_contact_radius = 0.5\n";
    home.file("mine.toml", preset);
    let rows: String = (0..100)
        .map(f64::from)
        .map(|i| format!("{},{}\n", i / 50.0, i * i / 5000.0))
        .collect::<Vec<_>>()
        .concat();
    home.file("scan.csv", &rows);
    std::os::unix::fs::symlink("mine.toml", home.path("mine.csv")).unwrap();
    for (command, file) in [("trace", "./mine.csv"), ("unload", "mine.csv"), ("trace", "scan.csv")] {
        home.refused(&[command, "mine.toml", "-o", file, "--overwrite"], &["is also read"]);
    }
    assert_eq!((home.text("mine.toml"), home.text("scan.csv")), (preset.to_owned(), rows));
}

fn names(folder: &Path) -> Vec<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_dash_is_standard_output() {
    let home = Home::new();
    assert_eq!(home.quiet(&short("unload", &["-o", "-"])), home.quiet(&short("unload", &[])));
    assert_eq!(names(home.folder()), [""; 0]);
}

#[test]
fn csv_of_an_si_preset_has_its_units_beside_it() {
    let home = Home::new();
    let note = |arguments: &[&str]| {
        let ended = home.run(arguments);
        assert_eq!(ended.status, 0, "{}", ended.err);
        let is_csv = ended.out.starts_with("step,") || ended.out.starts_with("kind,");
        assert!(!is_csv || !ended.out.contains('#'), "{}", ended.out);
        ended
            .err
            .lines()
            .filter(|line| line.contains("units of the columns"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let states = "contact_radius, approach, area_slope in m; force in N; energy in J; contact_stiffness, \
                  tangent_stiffness in N/m";
    assert_eq!(note(&["trace", "fig-9-si"]), [format!("pulloff: note: units of the columns: {states}")]);
    assert_eq!(note(&["trace", "fig-9-si", "-o", "x.csv"]).len(), 1);
    let theory = &note(&["trace", "fig-9-si", "--theory"])[0];
    assert!(theory.contains("force, exact_force in N"), "{theory}");
    let events = &note(&["unload", "fig-9-si", "--format", "csv", "--control", "force"])[0];
    assert!(
        events.ends_with(
            "control, before_force, after_force in N; radius, before_contact_radius, before_approach, \
        after_contact_radius, after_approach in m; before_area, after_area in m^2; before_energy, after_energy, \
        dissipated, dissipated_by_area in J"
        ),
        "{events}"
    );
    // JSON and tables contain the units, and reduced numbers have none.
    for arguments in [
        &["trace", "fig-9-si", "--format", "json"][..],
        &["unload", "fig-9-si"],
        &["trace", "fig-9"],
        &["unload", "fig-9", "--format", "csv"],
    ] {
        assert_eq!(note(arguments), [""; 0], "{arguments:?}");
    }
}

#[test]
fn an_output_in_no_folder_is_refused() {
    let home = Home::new();
    let ended = home.run(&short("unload", &["-o", "nowhere/events.csv"]));
    assert_eq!((ended.status, ended.out.as_str()), (2, ""));
    assert!(ended.err.contains("nowhere"), "{}", ended.err);
}

#[test]
fn a_closed_reader_is_a_quiet_end() {
    let home = Home::new();
    // Far more than a pipe holds, so the program does meet the closed end.
    for arguments in
        [["trace", "fig-9"].as_slice(), &["trace", "fig-9", "--format", "json"], &["presets", "list"]]
    {
        let mut command = home.command(arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let mut err = String::new();
        child.stderr.take().unwrap().read_to_string(&mut err).unwrap();
        assert_eq!((child.wait().unwrap().code(), err.as_str()), (Some(0), ""), "{arguments:?}");
    }
}
