//! "Did you mean": the known word closest to a mistyped one.

/// How similar a word must be to be offered, from 0 to 1.
const ALIKE: f64 = 0.6;
/// The least similarity of a word to a known one that begins with it.
const BEGUN: f64 = 0.75;
/// The longest word worth comparing, in bytes: the time for a comparison grows with it.
const LONGEST: usize = 80;

/// The most similar of `known`, if one is similar enough.
pub fn closest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > LONGEST {
        return None;
    }
    let word = word.to_lowercase();
    best(known.into_iter().map(|k| (likeness(&word, k), k)))
}

/// What other texts call the last part of a key.
const SYNONYMS: [(&str, &str); 4] = [
    ("surface_energy", "work_of_adhesion"),
    ("adhesion_energy", "work_of_adhesion"),
    ("tip_radius", "radius_of_curvature"),
    ("sphere_radius", "radius_of_curvature"),
];

/// The dotted key most similar to `key`, as a whole or in its last part; `labels` gives other names of a key.
pub fn closest_key<'a>(key: &str, known: impl IntoIterator<Item = (&'a str, &'a str)>) -> Option<&'a str> {
    if key.len() > LONGEST {
        return None;
    }
    let lower = key.to_lowercase().replace('-', "_");
    let synonym = SYNONYMS.iter().find(|(name, _)| *name == last(&lower));
    let lower = synonym.map_or(lower, |(_, of)| (*of).to_owned());
    best(known.into_iter().map(|(k, label)| {
        let whole = likeness(&lower, k);
        let part = likeness(last(&lower), last(k));
        // A known part in the wrong table, the symbol, or most of it, count for a little less than the key itself.
        let asked = last(key);
        let symbol = if asked == label {
            0.96
        } else if label
            .strip_prefix(asked)
            .is_some_and(|rest| rest == "*" || asked.len() > 1 && rest.len() <= asked.len())
        {
            0.94
        } else {
            0.9 * likeness(last(&lower), label)
        };
        (whole.max(0.97 * part).max(symbol), k)
    }))
}

fn last(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

fn likeness(word: &str, known: &str) -> f64 {
    let begun = if !word.is_empty() && known.starts_with(word) { BEGUN } else { 0.0 };
    strsim::normalized_damerau_levenshtein(word, known).max(begun)
}

fn best<'a>(scored: impl Iterator<Item = (f64, &'a str)>) -> Option<&'a str> {
    scored.filter(|(score, _)| *score >= ALIKE).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, word)| word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::schema::PARAMETERS;

    #[test]
    fn offers_what_was_meant() {
        let key = |k| closest_key(k, PARAMETERS.iter().map(|row| (&*row.key, &*row.label)));
        assert_eq!(key("gap.wavelenght"), Some("gap.wavelength"));
        assert_eq!(key("rings"), Some("basis.rings"));
        assert_eq!(key("material.amplitude"), Some("gap.amplitude"));
        assert_eq!(key("material.gamma"), Some("material.work_of_adhesion"));
        assert_eq!(key("gap.Amplitude"), Some("gap.amplitude"));
        assert_eq!(key("E"), Some("material.effective_modulus"));
        assert_eq!(key("gama"), Some("material.work_of_adhesion"));
        assert_eq!(key("gap.amp"), Some("gap.amplitude"));
        assert_eq!(key("material.surface_energy"), Some("material.work_of_adhesion"));
        assert_eq!(key("colour"), None);
        assert_eq!(key(&"x".repeat(1000)), None);
        assert_eq!(closest("wavy_sphere", ["sphere", "wavy-sphere"]), Some("wavy-sphere"));
    }
}
