//! Errors of the engine as exceptions of the package: the classes are in `pulloff.errors`, the sentences come from the
//! engine.

use pulloff_engine::CaseError;
use pulloff_engine::preset::{Invalid, Mistake, ReadError, ValueOrigin};
use pulloff_engine::progress::Stopped;
use pulloff_engine::quasistatic::path::PathError;
use pulloff_engine::report::map::MapError;
use pulloff_engine::report::pull::PullError;
use pulloff_engine::sweep::SpecError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::any::Any;
use std::borrow::Cow;

/// An exception of the class `name` in `pulloff.errors`, with the given sentence and attributes.
pub fn raise(py: Python<'_>, name: &str, sentence: &str, attributes: &Bound<'_, PyDict>) -> PyErr {
    let made = py
        .import("pulloff.errors")
        .and_then(|module| module.getattr(name))
        .and_then(|class| class.call((in_python(sentence),), Some(attributes)));
    match made {
        Ok(value) => PyErr::from_value(value),
        Err(error) => error,
    }
}

/// The engine's words with Python's argument names in place of command-line options: `sigma_x` for `--sigma-x`.
pub fn in_python(sentence: &str) -> Cow<'_, str> {
    if !sentence.contains("--") {
        return Cow::Borrowed(sentence);
    }
    let mut parts = sentence.split("--");
    let mut said = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !(c.is_ascii_lowercase() || c == '-')).unwrap_or(part.len());
        let (option, rest) = part.split_at(end);
        said.push_str(&match option {
            "" => "--".to_owned(),
            "set" => "replace".to_owned(),
            "overwrite" => "overwrite=True".to_owned(),
            "no-scan" => "scan=False".to_owned(),
            option => option.trim_end_matches('-').replace('-', "_"),
        });
        said.push_str(rest);
    }
    Cow::Owned(said)
}

fn plain(py: Python<'_>, name: &str, sentence: &str) -> PyErr {
    raise(py, name, sentence, &PyDict::new(py))
}

/// A refused preset, with the key and the line of the first mistake.
fn preset(py: Python<'_>, sentence: &str, mistakes: &[(Option<usize>, Option<&str>, String)]) -> PyErr {
    let attributes = PyDict::new(py);
    let filled = || {
        let first = mistakes.first();
        attributes.set_item("key", first.and_then(|(_, key, _)| *key))?;
        attributes.set_item("line", first.and_then(|(line, ..)| *line))?;
        let all: Vec<_> = mistakes.iter().map(|(line, key, text)| (*line, *key, text.as_str())).collect();
        attributes.set_item("mistakes", all)
    };
    match filled() {
        Ok(()) => raise(py, "PresetError", sentence, &attributes),
        Err(error) => error,
    }
}

/// A preset that cannot be read.
pub fn of_reading(py: Python<'_>, error: &ReadError) -> PyErr {
    let line = |mistake: &Mistake| match &mistake.origin {
        ValueOrigin::File { line, .. } => *line,
        ValueOrigin::Assignment(_) => None,
    };
    let mistakes: Vec<_> = error
        .mistakes
        .iter()
        .map(|mistake| (line(mistake), mistake.invalid.key(), mistake.to_string()))
        .collect();
    preset(py, &error.to_string(), &mistakes)
}

/// A value that a problem does not accept.
pub fn of_value(py: Python<'_>, error: &Invalid) -> PyErr {
    preset(py, &error.to_string(), &[(None, error.key(), error.to_string())])
}

/// A value of a type that no key accepts.
pub fn of_type(py: Python<'_>, key: &str, sentence: &str) -> PyErr {
    preset(py, sentence, &[(None, Some(key), sentence.to_owned())])
}

/// A name or a file that does not give a preset.
pub fn of_source(py: Python<'_>, sentence: &str) -> PyErr {
    preset(py, sentence, &[(None, None, sentence.to_owned())])
}

/// A refused spec of a sweep.
pub fn of_spec(py: Python<'_>, error: &SpecError) -> PyErr {
    let attributes = PyDict::new(py);
    let line = match &error.origin {
        ValueOrigin::File { line, .. } => *line,
        ValueOrigin::Assignment(_) => None,
    };
    match attributes.set_item("line", line) {
        Ok(()) => raise(py, "SpecError", &error.to_string(), &attributes),
        Err(error) => error,
    }
}

/// An invalid argument of a sweep other than its spec.
pub fn of_shard(py: Python<'_>, sentence: &str) -> PyErr {
    plain(py, "SpecError", sentence)
}

/// Results that cannot be begun, continued or written.
pub fn of_output(py: Python<'_>, sentence: &str) -> PyErr {
    plain(py, "OutputError", sentence)
}

/// A problem that cannot be computed.
pub fn of_case(py: Python<'_>, error: &CaseError) -> PyErr {
    let name = match error {
        CaseError::Basis(_) | CaseError::Table { .. } => "GapError",
        CaseError::Start { .. } | CaseError::EndOutsideStart { .. } => "StartError",
        CaseError::Path { error, .. } if matches!(**error, PathError::UnstableStart { .. }) => {
            "UnstableStart"
        }
        CaseError::Path { .. } | CaseError::HasRange { .. } => "NoPath",
        CaseError::Stopped(Stopped) => "Cancelled",
    };
    plain(py, name, &error.to_string())
}

/// A map that cannot be made.
pub fn of_map(py: Python<'_>, error: &MapError) -> PyErr {
    match error {
        MapError::Case(error) => of_case(py, error),
        MapError::Stopped(Stopped) => plain(py, "Cancelled", &error.to_string()),
        MapError::Family(_) => plain(py, "MapError", &error.to_string()),
    }
}

/// A pull that cannot be made.
pub fn of_pull(py: Python<'_>, error: &PullError) -> PyErr {
    match error {
        PullError::Case(error) => of_case(py, error),
        PullError::NoLaw { .. } | PullError::NoRate | PullError::Rate { .. } => {
            plain(py, "PullError", &error.to_string())
        }
    }
}

/// An invalid axis of a map.
pub fn of_axis(py: Python<'_>, sentence: &str) -> PyErr {
    plain(py, "MapError", sentence)
}

/// Measured points, or requests about them, that are refused.
pub fn of_data(py: Python<'_>, sentence: &str) -> PyErr {
    plain(py, "DataError", sentence)
}

/// A fit without a result.
pub fn of_fit(py: Python<'_>, sentence: &str) -> PyErr {
    plain(py, "FitError", sentence)
}

/// A state that was asked for and does not exist.
pub fn of_state(py: Python<'_>, sentence: &str) -> PyErr {
    plain(py, "NoState", sentence)
}

/// A panic, which is a fault of the engine itself.
pub fn of_panic(py: Python<'_>, payload: &(dyn Any + Send)) -> PyErr {
    let words = payload.downcast_ref::<String>().map(String::as_str);
    let words = words.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("no message");
    plain(py, "InternalError", &format!("a fault of the engine itself, please report it: {words}"))
}
