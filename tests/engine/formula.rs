//! Gap formulas and values from hostile text: an answer or a refusal, never a panic, a hang or a stack overflow.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use pulloff::store::read_with;
use pulloff_engine::expression::error::{DEPTH, LENGTH};
use pulloff_engine::gap::Gap;
use pulloff_engine::gap::formula::Formula;
use pulloff_engine::units::{DisplayUnits, Quantity, UnitSystem, parse_quantity};

/// The words of the language, and some that are not.
const TOKENS: &[&str] = &[
    "r",
    "R",
    "lambda",
    "pi",
    "e",
    "2",
    "0",
    "1e-3",
    "1e308",
    ".5",
    "5.",
    "0/0",
    "+",
    "-",
    "*",
    "/",
    "^",
    "(",
    ")",
    ",",
    " ",
    "sin(",
    "cos(",
    "tan(",
    "exp(",
    "log(",
    "sqrt(",
    "abs(",
    "min(",
    "max(",
    "pow(",
    "hypot(",
    "asin(",
    "step(",
    "sign",
    "²",
    "µ",
    "−",
    "\u{202e}",
    "\u{0}",
    "_",
    "1.2.3",
    "e5",
    "(r)",
    "^2",
    "^-1",
    "^0.5",
    "1/0",
    "-1/0",
    "NaN",
    "nan",
    "inf",
    "1e999",
    "5e-324",
    "∞",
    "π",
    "λ",
    "٣",
    "½",
    "𝟙",
    "e\u{301}",
    "\u{feff}",
    "\u{2028}",
    "🦀",
    "log(0)",
    "log(-r)",
    "r^r",
    "0^0",
    "0^-1",
    "1e308*1e308",
    "sqrt(-1)",
    "asin(2)",
    "\n",
    "\"",
];

/// Pieces of units, and some that are not.
const UNIT_WORDS: &[&str] = &[
    "m", "um", "µm", "Å", "°", "J", "mJ", "N", "kPa", "/", "*", "·", " ", "^", "^2", "^-1", "²", "⁻¹", "⁻",
    "^99", "1/", "1", "⁹", "^-9", "x", "eV", "kg", "s", "(", "\u{202e}", "\u{7}",
];

/// Does everything that the program does with a formula, for any text.
fn exercise(text: &str) {
    if let Err(error) = parse_quantity(text) {
        shown_safely(&error.to_string());
    }
    let formula = match Formula::parse(text) {
        Ok(formula) => formula,
        Err(error) => {
            let place = error.place;
            assert!(text.is_char_boundary(place.byte) && place.column <= text.chars().count() + 1, "{error}");
            shown_safely(&error.to_string());
            return;
        }
    };
    let values: Vec<(&str, f64)> = formula.parameters().iter().map(|name| (name.as_str(), 0.7)).collect();
    let bound = formula.bind(&values).unwrap();
    let radii = [0.0, 1e-300, 0.3, 0.9, 1e300, f64::INFINITY, f64::NAN];
    let mut values = [0.0; 7];
    bound.values(1.0, &radii, &mut values);
    for (&r, value) in radii.iter().zip(values) {
        let alone = bound.jet(r).value;
        assert!(value.to_bits() == alone.to_bits() || value.is_nan() && alone.is_nan(), "{text} at {r}");
    }
    if let Ok(gap) = bound.over(1.0) {
        assert!(gap.jet(0.5).second.is_finite(), "{text}");
        assert!(gap.feature_length().is_none_or(|length| length > 0.0 && length <= 2.0), "{text}");
    }
}

/// A message fits on a few lines and contains nothing that acts on a terminal.
fn shown_safely(message: &str) {
    assert!(message.chars().count() < 200, "{message}");
    let acts = |c: char| c.is_control() || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}');
    assert!(!message.chars().any(acts), "{message:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400, rng_seed: RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn token_soup(tokens in prop::collection::vec(prop::sample::select(TOKENS), 0..40)) {
        exercise(&tokens.concat());
    }

    #[test]
    fn any_text(text in "\\PC{0,60}") {
        exercise(&text);
    }

    #[test]
    fn any_bytes_as_text(bytes in prop::collection::vec(any::<u8>(), 0..60)) {
        exercise(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn well_formed_formulas_have_an_answer(text in well_formed()) {
        prop_assert!(Formula::parse(&text).is_ok(), "{}", text);
        exercise(&text);
    }

    #[test]
    fn a_value_shown_is_read_back(
        sign in prop::sample::select(&[-1.0, 1.0][..]),
        exponent in -60.0..60.0f64,
        quantity in prop::sample::select(&Quantity::ALL[..]),
        custom in any::<bool>(),
        ascii in any::<bool>(),
    ) {
        let value = sign * 10f64.powf(exponent);
        let mut units = DisplayUnits::default();
        if custom {
            for (quantity, name) in [
                (Quantity::Length, "Å"),
                (Quantity::Force, "dyn"),
                (Quantity::Stress, "keV/nm^3"),
                (Quantity::EnergyPerArea, "erg/cm²"),
                (Quantity::Energy, "eV"),
                (Quantity::ForcePerLength, "nN nm⁻¹"),
            ] {
                units = units.with(quantity, name).unwrap();
            }
        }
        for system in [UnitSystem::Reduced, UnitSystem::Si(units)] {
            let shown = system.shown(quantity, value);
            let text = shown.text(&format!("{:?}", shown.number), ascii);
            let read = parse_quantity(&text).unwrap();
            let back = match &system {
                UnitSystem::Reduced => read.pure(),
                UnitSystem::Si(_) => read.in_si(quantity, system.unit(quantity)),
            };
            let back = back.unwrap();
            prop_assert!((back - value).abs() <= 1e-15 * value.abs(), "{text}: {back:?} for {value:?}");
        }
    }

    #[test]
    fn unit_soup(number in 0.0..9.0f64, words in prop::collection::vec(prop::sample::select(UNIT_WORDS), 0..14)) {
        exercise(&format!("{number} {}", words.concat()));
    }

    #[test]
    fn long_and_deep_text(token in prop::sample::select(TOKENS), times in 0usize..5000) {
        exercise(&token.repeat(times));
        exercise(&format!("r+{}", token.repeat(times)));
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300, rng_seed: RngSeed::Fixed(6), failure_persistence: None, ..ProptestConfig::default()
    })]

    /// In a preset: a gap that is finite where the path may go, or an error that names a key of the gap.
    #[test]
    fn hostile_formulas_in_a_preset(
        tokens in prop::collection::vec(prop::sample::select(TOKENS), 0..8),
        values in prop::collection::vec(prop::sample::select(VALUES), 2),
        alone in any::<bool>(),
        si in any::<bool>(),
    ) {
        let soup = tokens.concat();
        let formula = if alone { soup } else { format!("r^2/(2*R) + A*({soup})") };
        let text = format!(
            "units = \"{}\"\n[material]\neffective_modulus = 1\nwork_of_adhesion = 0.01\n[gap]\n\
             shape = \"formula\"\n[path]\nstart_contact_radius = 0.5\n",
            if si { "SI" } else { "reduced" }
        );
        let sets = [
            format!("gap.formula={formula}"),
            format!("gap.parameters.R={}", values[0]),
            format!("gap.parameters.A={}", values[1]),
        ];
        match read_with("p.toml", &text, &sets) {
            Ok(preset) => {
                prop_assert!(preset.check().is_ok(), "{formula}");
                for radius in [1e-9, 0.1, 0.5] {
                    let jet = preset.gap.jet(radius);
                    prop_assert!(jet.value.is_finite() && jet.first.is_finite(), "{formula} at {radius}: {jet:?}");
                }
            }
            Err(error) => {
                for mistake in error.mistakes {
                    let message = mistake.to_string();
                    prop_assert!(message.contains("gap."), "{message}");
                    prop_assert!(!message.chars().any(|c| c.is_control() || c == '\u{202e}'), "{message:?}");
                }
            }
        }
    }
}

/// Values of parameters, and some that are not.
const VALUES: &[&str] = &[
    "1",
    "0",
    "-1",
    "1e-30",
    "1e30",
    "1e999",
    "nan",
    "1/0",
    "0/0",
    "3 um",
    "1 µm⁻¹",
    "3 furlong",
    "1e400 m",
    "𝟙",
    "\u{202e}",
    "",
    "((1",
    "true",
    "[1]",
    "{value=2}",
    "{ value = 1, max = 0 }",
];

/// A formula built by the grammar.
fn well_formed() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        Just("r".to_owned()),
        Just("A".to_owned()),
        Just("pi".to_owned()),
        (0.0..1e6f64).prop_map(|x| x.to_string()),
    ];
    leaf.prop_recursive(6, 40, 2, |inner| {
        prop_oneof![
            (inner.clone(), prop::sample::select(&["+", " - ", "*", "/", "^"][..]), inner.clone())
                .prop_map(|(a, operator, b)| format!("({a}){operator}({b})")),
            (prop::sample::select(&["sin", "tan", "exp", "log", "sqrt", "abs", "-"][..]), inner.clone())
                .prop_map(|(function, a)| format!("{function}({a})")),
            (prop::sample::select(&["min", "max", "hypot", "pow"][..]), inner.clone(), inner)
                .prop_map(|(function, a, b)| format!("{function}({a}, {b})")),
        ]
    })
}

#[test]
fn the_largest_formulas_are_done_on_a_small_stack() {
    let nested = format!("{}r{}", "sin(".repeat(DEPTH), ")".repeat(DEPTH));
    let powers = format!("{}r", "r^".repeat(DEPTH));
    let sums = format!("{}r", "r+".repeat(1000));
    let signs = format!("{}r", "-".repeat(LENGTH - 1));
    let mixed = format!("{}r{}", "r+2*r^(".repeat(DEPTH / 2), ")".repeat(DEPTH / 2));
    let small = std::thread::Builder::new().stack_size(512 * 1024);
    let done = small.spawn(move || {
        for text in [nested, powers, sums, signs, mixed] {
            assert!(Formula::parse(&text).is_ok(), "{text}");
            exercise(&text);
        }
    });
    done.unwrap().join().unwrap();
}
