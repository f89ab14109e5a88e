//! The JSON schemas of all documents, made from the types that are written; they are in `docs/schema`.
//!
//! `UPDATE_DOCS=1 cargo test -p pulloff-engine --lib schema` rewrites them.

use super::walk::WalkReport;
use super::{
    FitReport, MapReport, ModelsReport, PathReport, PullReport, SCHEMA, SpeedsReport, StabilityReport,
    TogetherReport, TraceReport, VerifyReport,
};
use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{JsonSchema, Schema};
use serde_json::json;

/// Every object has the keys of its type and no others; what is not a number is written as null.
fn strict(schema: &mut Schema) {
    let closes = schema.get("properties").is_some() && schema.get("additionalProperties").is_none();
    if closes {
        schema.insert("additionalProperties".to_owned(), false.into());
    }
}

/// The schema of one document as text.
fn text<T: JsonSchema>(document: &str) -> String {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    let mut schema = generator.into_root_schema_for::<T>();
    RecursiveTransform(strict).transform(&mut schema);
    schema.insert("title".to_owned(), format!("pulloff: {document}").into());
    if let Some(head) = schema.get_mut("properties").and_then(|all| all.as_object_mut()) {
        head.insert(
            "schema".to_owned(),
            json!({ "description": "The version of all documents.", "const": SCHEMA }),
        );
        head.insert(
            "document".to_owned(),
            json!({ "description": "Which document it is.", "const": document }),
        );
    }
    serde_json::to_string_pretty(&schema).unwrap() + "\n"
}

#[test]
fn schemas_are_those_of_the_documents() {
    let schemas = [
        ("trace", text::<TraceReport>("trace")),
        ("path", text::<PathReport>("path")),
        ("pull", text::<PullReport>("pull")),
        ("speeds", text::<SpeedsReport>("speeds")),
        ("map", text::<MapReport>("map")),
        ("stability", text::<StabilityReport>("stability")),
        ("walk", text::<WalkReport>("walk")),
        ("fit", text::<FitReport>("fit")),
        ("fit-models", text::<ModelsReport>("fit-models")),
        ("fit-together", text::<TogetherReport>("fit-together")),
        ("verify", text::<VerifyReport>("verify")),
    ];
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/schema");
    let mut old = Vec::new();
    for (name, text) in schemas {
        let file = format!("{folder}/{name}.json");
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::create_dir_all(folder).unwrap();
            std::fs::write(&file, &text).unwrap();
        }
        if std::fs::read_to_string(&file).ok().as_deref() != Some(&text) {
            old.push(name);
        }
    }
    assert!(
        old.is_empty(),
        "out of date: {old:?}; UPDATE_DOCS=1 cargo test -p pulloff-engine --lib schema writes them"
    );
}
