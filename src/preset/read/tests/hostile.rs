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
            assert!(!message.chars().any(crate::preset::text::is_unsafe), "{message:?}");
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
}
