//! Checks documents against their schemas in `docs/schema`.

use serde_json::{Map, Value};
use std::fs;

/// Checks a document that names its schema; other texts pass.
pub fn check(text: &str) {
    let Ok(Value::Object(document)) = serde_json::from_str(text) else { return };
    let Some(name) = document.get("document").and_then(Value::as_str) else { return };
    if name == "fits" {
        return document["fits"].as_array().unwrap().iter().for_each(|fit| check(&fit.to_string()));
    }
    let file = format!("{}/docs/schema/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let schema: Value = serde_json::from_str(&fs::read_to_string(&file).expect(&file)).expect("JSON");
    let fault = fault(&schema, &schema, &Value::Object(document.clone()), name);
    assert_eq!(fault, None, "{file}");
}

/// What is wrong with a value, and where; `None` where nothing is. A keyword unknown here is a failure.
fn fault(root: &Value, schema: &Value, value: &Value, at: &str) -> Option<String> {
    let Value::Object(schema) = schema else { return (schema == false).then(|| format!("{at}: not wanted")) };
    let each = |choices: &Value| -> Vec<Option<String>> {
        choices.as_array().unwrap().iter().map(|choice| fault(root, choice, value, at)).collect()
    };
    schema.iter().find_map(|(keyword, rule)| match keyword.as_str() {
        "$schema" | "$defs" | "title" | "description" | "format" => None,
        "$ref" => {
            let place = rule.as_str().unwrap().trim_start_matches('#');
            fault(root, root.pointer(place).expect(place), value, at)
        }
        "type" => {
            let is = |name: &Value| match name.as_str().unwrap() {
                "null" => value.is_null(),
                "boolean" => value.is_boolean(),
                "integer" => value.is_i64() || value.is_u64(),
                "number" => value.is_number(),
                "string" => value.is_string(),
                "array" => value.is_array(),
                "object" => value.is_object(),
                other => panic!("no type is called {other}"),
            };
            let holds = rule.as_array().map_or_else(|| is(rule), |rules| rules.iter().any(is));
            (!holds).then(|| format!("{at}: {value} is no {rule}"))
        }
        "const" => (value != rule).then(|| format!("{at}: {value} is not {rule}")),
        "enum" => {
            (!rule.as_array().unwrap().contains(value)).then(|| format!("{at}: {value} is none of {rule}"))
        }
        "minimum" => value
            .as_f64()
            .filter(|x| *x < rule.as_f64().unwrap())
            .map(|x| format!("{at}: {x} is below {rule}")),
        "maximum" => value
            .as_f64()
            .filter(|x| *x > rule.as_f64().unwrap())
            .map(|x| format!("{at}: {x} is above {rule}")),
        "anyOf" => each(rule).into_iter().min_by_key(Option::is_some).flatten(),
        "oneOf" => {
            let faults = each(rule);
            let right = faults.iter().filter(|fault| fault.is_none()).count();
            (right != 1).then(|| format!("{at}: {right} choices hold: {faults:?}"))
        }
        "required" => {
            let missing = |name: &&Value| value.get(name.as_str().unwrap()).is_none();
            let rules = rule.as_array().filter(|_| value.is_object())?;
            rules.iter().find(missing).map(|name| format!("{at}: no {name}"))
        }
        "properties" => {
            let known = rule.as_object().unwrap();
            let parts = value.as_object()?.iter();
            parts
                .filter_map(|(key, part)| Some((key, part, known.get(key)?)))
                .find_map(|(key, part, rule)| fault(root, rule, part, &format!("{at}.{key}")))
        }
        "additionalProperties" => {
            let none = Map::new();
            let known = schema.get("properties").and_then(Value::as_object).unwrap_or(&none);
            let others = value.as_object()?.iter().filter(|(key, _)| !known.contains_key(*key));
            others.into_iter().find_map(|(key, part)| fault(root, rule, part, &format!("{at}.{key}")))
        }
        "items" => {
            let parts = value.as_array()?.iter().enumerate();
            parts.into_iter().find_map(|(k, part)| fault(root, rule, part, &format!("{at}[{k}]")))
        }
        "minItems" | "maxItems" => {
            let (count, bound) = (value.as_array()?.len() as u64, rule.as_u64().unwrap());
            let holds = if keyword == "minItems" { count >= bound } else { count <= bound };
            (!holds).then(|| format!("{at}: {count} items, {keyword} {bound}"))
        }
        other => panic!("the tests know no keyword {other}"),
    })
}
