//! Every mistake names its file, line and key.

use super::{WAVY, edited, messages};
use crate::preset::read;

#[test]
fn each_mistake_names_file_line_key_and_what_was_meant() {
    for (old, new, expected) in [
        ("amplitude =", "amplitud =", "w.toml:9: unknown key gap.amplitud; did you mean gap.amplitude?"),
        ("[material]", "[materials]", "w.toml:3: unknown key materials; did you mean material?"),
        ("rings = 200", "rings = 200\nrings = 300", "w.toml:14: duplicate key: rings"),
        (
            "rings = 200",
            "rings = 3",
            "w.toml:13: basis.rings = 3 is out of range: it must be a whole number from 4 to 2000",
        ),
        (
            "rings = 200",
            "rings = 2e2",
            "w.toml:13: basis.rings must be a whole number from 4 to 2000, not the number 200.0",
        ),
        (
            "amplitude = 0.0025",
            "amplitude = \"big\"",
            "w.toml:9: gap.amplitude must be 0 or a number from 1e-30 to 1e30, not the text \"big\"",
        ),
        (
            "amplitude = 0.0025",
            "amplitude = [1]",
            "w.toml:9: gap.amplitude must be 0 or a number from 1e-30 to 1e30, not an array",
        ),
        (
            "wavelength = 0.05",
            "wavelength = inf",
            "w.toml:10: gap.wavelength = inf is out of range: it must be a number from 1e-30 to 1e30",
        ),
        (
            "wavelength = 0.05",
            "",
            "w.toml:6: gap.wavelength is missing: it must be a number from 1e-30 to 1e30",
        ),
        (
            "\"wavy-sphere\"",
            "\"wavy sphere\"",
            "w.toml:7: gap.shape = \"wavy sphere\" is not known: it must be \"sphere\" or \"wavy-sphere\" or \"exact-sphere\" or \"cone\" or \"power-law\" or \"harmonics\" or \"random-waves\" or \"formula\" or \"profile\"; did you mean wavy-sphere?",
        ),
        ("format = 1", "format = 2", "w.toml:1: format = 2 is not known: this version reads format 1"),
        (
            "[path]",
            "[path]\nstart_force = 1",
            "w.toml:15: path.start_force and path.start_contact_radius both set where the path starts: give \
             exactly one",
        ),
        (
            "end_contact_radius = 0.002",
            "end_contact_radius = 0.6",
            "w.toml:17: path.end_contact_radius = 0.6 is not below path.start_contact_radius = 0.5",
        ),
        (
            "\"displacement\"",
            "{ stiffnes = 1 }",
            "w.toml:15: unknown key path.control.stiffnes; did you mean path.control.stiffness?",
        ),
        (
            "\"displacement\"",
            "{}",
            "w.toml:15: path.control must be \"displacement\", \"force\" or stiffness=k (in a file: { stiffness = k }) with k > 0, not an empty table",
        ),
        (
            "\"displacement\"",
            "{ stiffness = 0 }",
            "w.toml:15: path.control.stiffness = 0.0 is out of range: it must be a number from 1e-30 to 1e30",
        ),
        ("title = \"Wavy sphere, A/λ = 0.05\"", "\"gap.shape\" = 1", "w.toml:2: unknown key gap.shape"),
    ] {
        let message = edited(old, new);
        assert!(message.starts_with(expected), "{message}\n{expected}");
    }
    assert_eq!(
        messages("", &[]),
        [
            "w.toml: the table [gap] is missing: it needs shape",
            "w.toml: the table [material] is missing: it needs effective_modulus, work_of_adhesion"
        ]
    );
    assert!(
        messages("gap = 3", &[])[0]
            .starts_with("w.toml:1: gap is a table, not \"3\"; set one of its keys, such as gap.shape")
    );
    assert!(messages("[[gap]]", &[])[0].starts_with("w.toml:1: gap is a table, not an array"));
}

#[test]
fn stray_wave_keys_on_a_sphere_are_named() {
    let lines = messages(&WAVY.replace("wavy-sphere", "sphere"), &[]);
    assert_eq!(
        lines,
        [
            "w.toml:9: gap.amplitude belongs to gap.shape = wavy-sphere, and the gap is a sphere",
            "w.toml:10: gap.wavelength belongs to gap.shape = wavy-sphere, and the gap is a sphere"
        ]
    );
}

#[test]
fn all_mistakes_come_in_the_order_of_lines() {
    let text = WAVY.replace("= 200", "= 1").replace("= 0.0025", "= -1").replace("title", "titel");
    let lines = messages(&text, &["path.start=1"]);
    let starts = [
        "w.toml:2: unknown key titel; did you mean title?",
        "w.toml:9:",
        "w.toml:13:",
        "--set path.start=1:",
    ];
    assert_eq!(lines.len(), starts.len(), "{lines:?}");
    assert!(lines.iter().zip(starts).all(|(line, start)| line.starts_with(start)), "{lines:?}");
    let error = read("w.toml", &text).unwrap_err();
    let said = error.to_string();
    assert_eq!(said, lines[..3].join("\n"));
    let many = read("w.toml", "[gap]\na=1\nb=1\nc=1\nd=1\ne=1\nf=1\ng=1");
    let said = many.unwrap_err().to_string();
    assert!(said.lines().count() == 6 && said.ends_with(" more"), "{said}");
}
