//! What every row must satisfy.

use super::*;
use crate::preset::rows::{parameter, tables};
use std::collections::BTreeSet;

#[test]
fn keys_and_labels_are_unique_ascii_and_grouped() {
    let keys: BTreeSet<_> = PARAMETERS.iter().map(|row| &row.key).collect();
    let labels: BTreeSet<_> = PARAMETERS.iter().map(|row| &row.label).collect();
    assert_eq!((keys.len(), labels.len()), (PARAMETERS.len(), PARAMETERS.len()));
    for row in PARAMETERS {
        assert!(row.label.is_ascii() && row.label.len() <= 11, "{}", row.label);
        assert!(!row.meaning.is_empty() && !row.allowed().is_empty() && !row.fallback_text().is_empty());
    }
    assert!(START_KEYS.iter().all(|key| parameter(key).is_some()));
    let said = |key, number: f64| parameter(key).unwrap().fallback_text().starts_with(&format!("{number} x"));
    assert!(said(START_KEYS[0], START_OVER_CURVATURE));
    assert_eq!(
        tables().collect::<Vec<_>>(),
        [
            "material",
            "gap",
            "basis",
            "edge",
            "path",
            "path.control",
            "data",
            "display",
            "gap.parameters",
            "gap.waves"
        ]
    );
}
