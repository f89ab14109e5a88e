//! The gallery of the book: every preset that comes with the program, with a sentence, a command and a picture, all
//! made by the program. `UPDATE_DOCS=1 cargo test --test program gallery::` writes the page and the pictures.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::{Ended, Home};
use pulloff_engine::preset::shipped::SHIPPED;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const FOLDER: &str = "docs/src/gallery";

/// The views drawn for these presets; for all others, force over approach.
const VIEWS: [(&str, &str); 4] =
    [("fig-9-cycle", "cycle"), ("fig-9-weak", "contact-map"), ("crater", "contact-map"), ("profile", "gap")];

fn view(name: &str) -> &'static str {
    VIEWS.iter().find(|(known, _)| *known == name).map_or("force-approach", |(_, view)| view)
}

/// The first paragraph of a preset's text.
fn sentence(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("# "));
    lines.collect::<Vec<_>>().join(" ")
}

fn page() -> String {
    let mut page = String::from(
        "# Gallery\n\nEvery preset that comes with the program. `pulloff NAME` opens one in the explorer; the command below a\n\
         picture draws it. Solid lines are stable, broken ones are not.\n",
    );
    for preset in SHIPPED {
        let (name, view) = (preset.name, view(preset.name));
        let sentence = sentence(preset.text);
        assert!(sentence.ends_with(['.', 't', 'e', 's', ')']) && sentence.len() > 20, "{name}: {sentence}");
        let command = match view {
            "force-approach" => format!("pulloff plot {name} -o {name}.svg"),
            view => format!("pulloff plot {name} --view {view} -o {name}.svg"),
        };
        write!(
            page,
            "\n## {name}\n\n{sentence}\n\n```sh\n{command}\n```\n\n![{name}, {view}](gallery/{name}.svg)\n"
        )
        .unwrap();
    }
    page
}

#[test]
fn every_shipped_preset_is_in_the_gallery_as_it_is_drawn() {
    let home = Home::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join(FOLDER);
    let mut all: Vec<(PathBuf, String)> = vec![(root.join("docs/src/gallery.md"), page())];
    for preset in SHIPPED {
        let file = format!("{}.svg", preset.name);
        let Ended { status, err, .. } =
            home.run(&["plot", preset.name, "--view", view(preset.name), "-o", &file]);
        assert_eq!(status, 0, "{}: {err}", preset.name);
        all.push((folder.join(&file), home.text(&file)));
    }
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::create_dir_all(&folder).unwrap();
        for (path, text) in &all {
            fs::write(path, text).unwrap();
        }
    }
    for (path, text) in &all {
        let there = fs::read_to_string(path).unwrap_or_default();
        assert!(
            there == *text,
            "{} is out of date: UPDATE_DOCS=1 cargo test --test program gallery::",
            path.display()
        );
    }
    let names = |path: PathBuf| path.file_name().unwrap().to_str().unwrap().to_owned();
    let there: BTreeSet<String> =
        fs::read_dir(&folder).unwrap().map(|entry| names(entry.unwrap().path())).collect();
    let wanted: BTreeSet<String> = all.into_iter().skip(1).map(|(path, _)| names(path)).collect();
    assert_eq!(there, wanted, "a picture of no preset");
}
