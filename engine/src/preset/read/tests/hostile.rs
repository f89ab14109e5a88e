//! Foreign and damaged text.

use super::families::{FORMULA, WAVES};
use super::{WAVY, messages};
use crate::preset::read::MISTAKES;
use crate::preset::{read, read_with};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

#[test]
fn foreign_text_is_short_and_harmless_in_messages() {
    let long = "x".repeat(5000);
    for text in [
        format!("\"\\u001b]0;owned\\u0007{long}\" = 1"),
        format!("[gap]\nshape = \"\\u001b[2J\\u202e{long}\""),
        format!("title = \"\u{202e}\"\n{long} = \u{1b}"),
        format!("{long} {long}"),
    ] {
        for mistake in read(&format!("a\nb\u{1b}{long}.toml"), &text).unwrap_err().mistakes {
            let message = mistake.to_string();
            assert!(message.len() < 500, "{message}");
            assert!(!message.chars().any(crate::text::is_unsafe), "{message:?}");
        }
    }
}

#[test]
fn many_mistakes_end_quickly() {
    let text: String = (0..50_000).map(|i| format!("k{i} = 1")).collect::<Vec<_>>().join("\n");
    assert_eq!(messages(&text, &[]).len(), MISTAKES);
}

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 256,
        rng_seed: RngSeed::Fixed(9),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn no_text_brings_the_reader_down(text in "\\PC*|[\\x00-\\x7f]{0,200}", assignment in "\\PC{0,60}") {
        let _ = read_with("p.toml", &text, &[assignment]);
    }

    #[test]
    fn no_damage_to_a_preset_brings_the_reader_down(which in 0usize..3, at in 0..WAVY.len(), cut in 0usize..20, new in "[-a-z0-9.=\\[\\]{}\"' \n]{0,12}") {
        let chars: Vec<char> = [WAVY, FORMULA, WAVES][which].chars().collect();
        let at = at.min(chars.len());
        let end = (at + cut).min(chars.len());
        let text: String = chars[..at].iter().copied().chain(new.chars()).chain(chars[end..].iter().copied()).collect();
        match read("p.toml", &text) {
            Ok(preset) => prop_assert!(preset.check().is_ok()),
            Err(error) => prop_assert!(!error.mistakes.is_empty()),
        }
    }

    #[test]
    fn no_assignment_brings_the_reader_down(key in 0..crate::preset::PARAMETERS.len(), value in "[-a-z0-9.=\\[\\]{}\"' ]{0,12}") {
        let assignment = format!("{}={value}", crate::preset::PARAMETERS[key].key);
        if let Ok(preset) = read_with("p.toml", WAVY, &[assignment]) {
            prop_assert!(preset.check().is_ok());
        }
    }

    /// Lines duplicated, dropped, swapped, cut, or with a value that nobody means.
    #[test]
    fn no_damaged_lines_bring_the_reader_down(
        which in 0..5usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..6u8), 1..6),
    ) {
        let si = &crate::fixtures::text("fig-9-si");
        let text = [WAVY, FORMULA, WAVES, PROFILE, si][which];
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for (place, other, kind) in damage {
            let [at, to] = [place, other].map(|index| index.index(lines.len()));
            let line = lines[at].clone();
            match kind {
                0 => lines.insert(to, line),
                1 if lines.len() > 1 => drop(lines.remove(at)),
                2 => lines.swap(at, to),
                3 => lines[at] = line.chars().take(other.index(line.chars().count() + 1)).collect(),
                _ => {
                    let value = VALUES[other.index(VALUES.len())];
                    lines[at] = line.split_once('=').map_or(line.clone(), |(key, _)| format!("{key}={value}"));
                }
            }
        }
        sound_or_refused(&lines.join("\n"));
    }
}

const PROFILE: &str = r#"[material]
effective_modulus = 1
work_of_adhesion = 0.004
[gap]
shape = "profile"
file = "shipped:rough-sphere.csv"
smoothing = "auto"
"#;

/// Values that nobody means.
const VALUES: &[&str] = &[
    "1e999",
    "-1e999",
    "1e308",
    "1e-320",
    "nan",
    "-inf",
    "9223372036854775807",
    "-9223372036854775808",
    "0x7f",
    "true",
    "1979-05-27",
    "\"\"",
    "\"0/0\"",
    "\"1/0 um\"",
    "\"1e400 um\"",
    "\"3 um^99\"",
    "\"µµ\"",
    "\"1 µm⁻¹\"",
    "\"𝟙 um\"",
    "\"\\u202e1 um\"",
    "\"\\u0000\"",
    "\"e\u{301}\"",
    "\"🦀\"",
    "\"shipped:none\"",
    "\"/dev/zero\"",
    "\"((((((((1\"",
    "[[[[[1]]]]]",
    "{ value = { value = 1 } }",
    "{ a.b.c.d = 1 }",
    "\"auto\"",
    "\"SI\"",
    "\"r^2/0\"",
    "\"log(-r)\"",
    "\"1e308*1e308*r\"",
    "\"tan(1e300*r)\"",
    "\"r^-1\"",
];

/// A sound preset, or mistakes with a place, in words that a terminal can show.
fn sound_or_refused(text: &str) {
    match crate::fixtures::read("p.toml", text) {
        Ok(preset) => {
            assert_eq!(preset.check(), Ok(()), "{text}");
            let written = crate::preset::write(&preset);
            assert_eq!(read("p.toml", &written).as_ref(), Ok(&preset), "{text}\n{written}");
        }
        Err(error) => {
            assert!(!error.mistakes.is_empty());
            for mistake in error.mistakes {
                let message = mistake.to_string();
                assert!(message.starts_with("p.toml") && message.len() < 2000, "{message}");
                assert!(!message.chars().any(crate::text::is_unsafe), "{message:?}");
            }
        }
    }
}

#[test]
fn nested_and_long_values_end_quickly() {
    for text in [
        format!("gap = {}1{}", "[".repeat(50_000), "]".repeat(50_000)),
        format!("gap = {}", "{ a = ".repeat(50_000)),
        format!("{}.x = 1", vec!["gap"; 50_000].join(".")),
        FORMULA.replace("r^2/(2*R)", &"(".repeat(4000)),
        FORMULA.replace("r^2/(2*R)", &format!("{}r", "-".repeat(4097))),
        FORMULA.replace("r^2/(2*R)", &"r+".repeat(2000)),
        WAVY.replace("0.0025", &format!("\"{}1\"", "(".repeat(50_000))),
        WAVY.replace("0.0025", &format!("\"1 {}\"", "m".repeat(50_000))),
        WAVY.replace("0.0025", &"9".repeat(50_000)),
    ] {
        let error = read("p.toml", &text).unwrap_err();
        assert!(error.mistakes.iter().all(|mistake| mistake.to_string().len() < 2000));
    }
}
