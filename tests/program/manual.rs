//! The documentation agrees with the program: its generated parts are current, its links lead somewhere, and the paths
//! and names in ARCHITECTURE.md are those of the code.
//!
//! A generated part is between the marks `<!-- NAME -->` and `<!-- /NAME -->`, each on a line of its own, in README.md
//! or in a chapter of the book; [`generated`] makes its text from its name.
//! `UPDATE_DOCS=1 cargo test --test program manual::` writes these parts.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::preset::manual::key_table;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The largest number of lines in README.md; longer text belongs in the book.
const README_LINES: usize = 150;
/// The chapters of the book.
const BOOK: &str = "docs/src";
/// The other files with links.
const PAGES: [&str; 6] = [
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "engine/README.md",
    "examples/cluster/README.md",
];
/// The generated parts; each occurs in some file.
const PARTS: [&str; 15] = [
    "options",
    "charts",
    "screen",
    "keys",
    "exit statuses",
    "preset keys",
    "output: -h",
    "output: cycle fig-9-weak",
    "output: fit lens",
    "output: presets list",
    "output: sweep quantities",
    "output: trace wavy-sphere | head -1",
    "output: unload wavy-sphere",
    "output: verify --only uniform",
    "code: engine/examples/fig_9.rs",
];

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn text(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// The chapters of the book and its table of contents, as paths from the root.
fn chapters() -> Vec<String> {
    let mut chapters = Vec::new();
    let mut folders = vec![PathBuf::from(BOOK)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).unwrap().map(Result::unwrap) {
            let path = folder.join(entry.file_name());
            if entry.file_type().unwrap().is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                chapters.push(path.to_str().unwrap().to_owned());
            }
        }
    }
    chapters.sort();
    chapters
}

/// Standard output of the program in an empty home.
fn output(arguments: &[&str]) -> String {
    let home = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pulloff"));
    command.env_clear().env("HOME", home.path()).env("XDG_CONFIG_HOME", home.path());
    let output = command.args(arguments).stdin(Stdio::null()).output().unwrap();
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The output of a command, or its first N lines if ` | head -N` follows.
fn shown(command: &str) -> String {
    let (command, lines) = match command.split_once(" | head -") {
        Some((command, lines)) => (command, lines.parse().unwrap()),
        None => (command, usize::MAX),
    };
    let all = output(&command.split(' ').collect::<Vec<_>>());
    all.lines().take(lines).fold(String::new(), |text, line| text + line + "\n")
}

/// The explorer at its second limit point, as text.
fn screen() -> String {
    use pulloff::explorer::{Id, Inline, update};
    use pulloff::tui::app::App;
    use pulloff::tui::theme::Theme;
    use pulloff::tui::view;
    use ratatui::{Terminal, backend::TestBackend};

    let folder = tempfile::tempdir().unwrap();
    let store = pulloff::store::Store::at(folder.path(), &[]);
    let loaded = store.load(&store.resolve("wavy-sphere").unwrap(), &[] as &[&str]).unwrap();
    let (mut app, effects) = App::new(loaded, Theme::default());
    let driver = Inline::new(store);
    driver.settle(&mut app.model, effects);
    for id in [Id::NextEvent, Id::Jump, Id::NextEvent] {
        let effects = update(&mut app.model, id.into());
        driver.settle(&mut app.model, effects);
    }
    // Both charts of the curve, as the terminal has room for them.
    app.model.views = 2;
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    terminal
        .draw(|frame| {
            view::draw(frame, &app);
        })
        .unwrap();
    let buffer = terminal.backend().buffer();
    (0..24).fold(String::new(), |mut text, y| {
        let row: String = (0..80).map(|x| buffer[(x, y)].symbol()).collect();
        writeln!(text, "{}", row.trim_end()).unwrap();
        text
    })
}

/// The charts, each with its one place.
fn charts() -> String {
    use pulloff::explorer::Home;
    let rows = Home::ALL.into_iter().flat_map(|home| {
        let letter = home.name().chars().next().unwrap();
        home.views().iter().map(move |view| {
            format!("| {}, `g {letter}` | `{}` | {} |\n", home.name(), view.name(), view.meaning())
        })
    });
    let head = "| place | chart | shows |\n|---|---|---|\n".to_owned();
    rows.fold(head, |text, row| text + &row)
}

/// The long names of the options that many commands have.
const SHARED: [&str; 7] = ["set", "control", "output", "format", "overwrite", "quiet", "strict"];

/// The expected options of [`SHARED`] for each command.
const MATRIX: [(&str, &str); 23] = [
    ("pulloff", "set control"),
    ("trace", "set control output format overwrite quiet strict"),
    ("unload", "set control output format overwrite quiet strict"),
    ("cycle", "set control output format overwrite quiet strict"),
    ("pull", "set control output format overwrite quiet strict"),
    ("map", "set control output format overwrite quiet strict"),
    ("fit", "set control output format overwrite quiet strict"),
    ("speeds", "set control output format overwrite quiet strict"),
    // A figure has a format of its own, named by its extension.
    ("plot", "set control output overwrite quiet strict"),
    // Their presets are those of the paper.
    ("figures", "output overwrite quiet strict"),
    // Rows are CSV and nothing else.
    ("sweep", "set control output overwrite quiet strict"),
    ("sweep merge", "output overwrite quiet strict"),
    ("sweep check", "quiet strict"),
    ("sweep quantities", ""),
    // It has its own problems and gives no warnings.
    ("verify", "output format overwrite"),
    // The lines of a script name files and formats.
    ("run", "set control overwrite quiet strict"),
    ("presets list", ""),
    ("presets show", ""),
    ("presets delete", ""),
    ("presets path", ""),
    ("sessions list", ""),
    ("sessions show", "format"),
    ("sessions delete", ""),
];

/// Each command of the program with its name after `pulloff`.
fn commands() -> Vec<(String, clap::Command)> {
    let mut whole = pulloff::cli::command();
    whole.build();
    let mut commands = vec![("pulloff".to_owned(), whole.clone())];
    for command in whole.get_subcommands().filter(|command| command.get_name() != "help") {
        let name = command.get_name();
        let inner = command.get_subcommands().filter(|inner| inner.get_name() != "help");
        if command.get_arguments().any(|argument| argument.get_id() != "help") || !command.has_subcommands() {
            commands.push((name.to_owned(), command.clone()));
        }
        commands.extend(inner.map(|inner| (format!("{name} {}", inner.get_name()), inner.clone())));
    }
    commands
}

fn option<'a>(command: &'a clap::Command, long: &str) -> Option<&'a clap::Arg> {
    command.get_arguments().find(|argument| argument.get_long() == Some(long))
}

/// The table of commands and options; commands with none of these are left out.
fn options() -> String {
    let mut text = String::from("| command |");
    for long in SHARED {
        let short = if long == "output" { "`-o`, " } else { "" };
        write!(text, " {short}`--{long}` |").unwrap();
    }
    writeln!(text, "\n|---|{}", "---|".repeat(SHARED.len())).unwrap();
    for (name, command) in commands() {
        if SHARED.iter().all(|long| option(&command, long).is_none()) {
            continue;
        }
        write!(text, "| `{name}` |").unwrap();
        for long in SHARED {
            let cell = match option(&command, long) {
                None => "",
                Some(argument) if long == "output" => &*argument.get_value_names().unwrap()[0],
                Some(_) => "yes",
            };
            write!(text, " {cell} |").unwrap();
        }
        text.push('\n');
    }
    text
}

#[test]
fn every_command_has_the_shared_options_that_it_has_something_for() {
    let commands = commands();
    let has = |command: &clap::Command| {
        let shared = SHARED.into_iter().filter(|long| option(command, long).is_some());
        shared.collect::<Vec<_>>().join(" ")
    };
    for (name, command) in &commands {
        let wanted = MATRIX.iter().find(|(known, _)| known == name).map_or("", |(_, wanted)| *wanted);
        assert_eq!(has(command), wanted, "{name}");
        // A command that writes can replace, one that takes values takes a control, and the options for warnings go together.
        for [one, other] in [["output", "overwrite"], ["set", "control"], ["quiet", "strict"]] {
            let [one, other] = [one, other].map(|long| option(command, long).is_some());
            assert!(one == other || name == "run" && other, "{name}");
        }
        // One word for one meaning.
        for former in ["json", "csv", "force", "out", "replace", "silent"] {
            assert!(option(command, former).is_none(), "{name} has --{former}");
        }
    }
    for (name, _) in MATRIX {
        assert!(commands.iter().any(|(known, _)| known == name), "there is no {name}");
    }
    // The same words, short form and values everywhere.
    for long in SHARED {
        let all = commands.iter().filter_map(|(name, command)| Some((name, option(command, long)?)));
        let own = ["figures", "sweep", "sweep merge"];
        let all: Vec<_> = all.filter(|(name, _)| long != "output" || !own.contains(&name.as_str())).collect();
        let said = |argument: &clap::Arg| {
            let values: Vec<_> =
                argument.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
            let help = argument.get_help().map(ToString::to_string);
            (help, argument.get_short(), values, argument.get_value_names().map(<[_]>::to_vec))
        };
        for (name, argument) in &all {
            assert_eq!(said(argument), said(all[0].1), "--{long} of {name}");
        }
    }
    let formats = option(&commands.iter().find(|(name, _)| name == "fit").unwrap().1, "format").unwrap();
    let names: Vec<_> =
        formats.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    assert_eq!(names, ["table", "csv", "json"]);
}

/// The text of a generated part.
fn generated(name: &str) -> String {
    let fenced = |language: &str, text: &str| format!("```{language}\n{text}```\n");
    match name.split_once(": ") {
        None if name == "options" => options(),
        None if name == "screen" => fenced("text", &screen()),
        None if name == "exit statuses" => pulloff::cli::Status::markdown(),
        None if name == "charts" => charts(),
        None if name == "keys" => pulloff::tui::keymap::markdown(),
        None if name == "preset keys" => key_table(),
        Some(("output", command)) => fenced("text", &shown(command)),
        Some(("code", file)) => fenced("rust", &text(file)),
        _ => panic!("nothing generates <!-- {name} -->"),
    }
}

/// `text` with its generated parts as they should be; their names are added to `seen`.
fn current(file: &str, text: &str, seen: &mut BTreeSet<String>) -> String {
    let mut whole = String::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        writeln!(whole, "{line}").unwrap();
        let Some(name) = line.strip_prefix("<!-- ").and_then(|line| line.strip_suffix(" -->")) else {
            continue;
        };
        let end = format!("<!-- /{name} -->");
        assert!(lines.any(|line| line == end), "{file}: {line} has no {end}");
        writeln!(whole, "{}{end}", generated(name)).unwrap();
        seen.insert(name.to_owned());
    }
    whole
}

#[test]
fn the_generated_parts_are_current() {
    let mut seen = BTreeSet::new();
    let mut old = Vec::new();
    for file in chapters().iter().map(String::as_str).chain(["README.md"]) {
        let before = text(file);
        let after = current(file, &before, &mut seen);
        if before == after {
            continue;
        }
        if std::env::var_os("UPDATE_DOCS").is_some() {
            fs::write(root().join(file), after).unwrap();
        } else {
            old.push(file.to_owned());
        }
    }
    assert_eq!(seen, PARTS.map(str::to_owned).into(), "each part is in some file, and no other is");
    assert!(
        old.is_empty(),
        "out of date: {old:?}; UPDATE_DOCS=1 cargo test --test program manual:: writes them"
    );
}

/// The lines of a page outside of its fenced code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The targets of the links and pictures of a page.
fn links(text: &str) -> Vec<String> {
    let line = |line: &str| -> Vec<String> {
        // Code contains no links.
        let bare: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        bare.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0.to_owned())).collect()
    };
    prose(text).flat_map(line).collect()
}

/// The anchors of a page's headings, as mdBook and GitHub make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let anchor = |heading: &str| -> String {
        let kept = heading.to_lowercase().replace(' ', "-");
        kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_')).collect()
    };
    prose(text)
        .filter(|line| line.starts_with('#'))
        .map(|line| anchor(line.trim_start_matches('#').trim()))
        .collect()
}

#[test]
fn every_link_leads_somewhere() {
    for file in chapters().iter().map(String::as_str).chain(PAGES) {
        let folder = Path::new(file).parent().unwrap();
        for link in links(&text(file)) {
            if link.starts_with("https://") {
                continue;
            }
            let (path, anchor) =
                link.split_once('#').map_or((&*link, None), |(path, anchor)| (path, Some(anchor)));
            let target = if path.is_empty() { PathBuf::from(file) } else { folder.join(path) };
            assert!(root().join(&target).is_file(), "{file}: {link} leads nowhere");
            // A book contains only what is in its folder.
            let is_chapter = file.starts_with(BOOK);
            assert!(!is_chapter || !path.starts_with(".."), "{file}: {link} leads out of the book");
            if let Some(anchor) = anchor {
                let there = anchors(&text(target.to_str().unwrap()));
                assert!(there.contains(anchor), "{file}: {link} names no heading of {there:?}");
            }
        }
    }
}

#[test]
fn the_table_of_contents_has_every_chapter_once() {
    let summary = format!("{BOOK}/SUMMARY.md");
    let mut listed = links(&text(&summary));
    listed.sort();
    let there: Vec<String> = chapters()
        .into_iter()
        .filter(|chapter| *chapter != summary)
        .map(|chapter| chapter[BOOK.len() + 1..].to_owned())
        .collect();
    assert_eq!(listed, there);
}

#[test]
fn the_readme_is_short() {
    let lines = text("README.md").lines().count();
    assert!(
        lines <= README_LINES,
        "README.md has {lines} lines, more than {README_LINES}: the book has room"
    );
}

/// A code span such as `src/store/presets.rs: Store::load, Loaded` names a file and items in it.
#[test]
fn the_paths_and_names_of_the_architecture_are_those_of_the_code() {
    const ROOTS: [&str; 11] = [
        "src/",
        "engine/",
        "python/",
        "tests/",
        "docs/",
        "presets/",
        "benches/",
        "fuzz/",
        "examples/",
        ".ci/",
        "Cargo.toml",
    ];
    for file in ["ARCHITECTURE.md", "CONTRIBUTING.md"] {
        let page = text(file);
        let spans = prose(&page).flat_map(|line| line.split('`').skip(1).step_by(2));
        for span in spans.filter(|span| ROOTS.iter().any(|root| span.starts_with(root))) {
            let (path, names) = span.split_once(": ").unwrap_or((span, ""));
            assert!(root().join(path).exists(), "{file}: there is no {path}");
            for name in names.split(", ").filter(|name| !name.is_empty()) {
                let name = name.rsplit("::").next().unwrap_or(name);
                let is_there =
                    text(path).split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
                assert!(is_there, "{file}: {path} has no {name}");
            }
        }
    }
}

/// The names at the root of the engine, its modules and exports, in ascending order.
fn public_items() -> Vec<String> {
    let source = text("engine/src/lib.rs");
    let mut names: Vec<String> = source
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .map(|name| format!("mod {name}"))
        .collect();
    for exported in source.split("\npub use ").skip(1).filter_map(|rest| rest.split(';').next()) {
        let (_, listed) = exported.rsplit_once("::").unwrap_or(("", exported));
        let all = exported.split_once('{').map_or(listed, |(_, all)| all.trim_end_matches('}'));
        names.extend(all.split(',').map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned));
    }
    names.sort();
    names
}

#[test]
fn the_public_items_of_the_engine_are_those_of_the_list() {
    const FILE: &str = "engine/public-items.txt";
    const MOST: usize = 250;
    let names = public_items();
    assert!(names.len() > 60 && names.len() <= MOST, "{} names, at most {MOST}", names.len());
    let list = names.iter().fold(String::new(), |list, name| list + name + "\n");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(root().join(FILE), &list).unwrap();
    }
    assert_eq!(text(FILE), list, "UPDATE_DOCS=1 cargo test --test program manual:: writes {FILE}");
    let source = text("engine/src/lib.rs") + &text("src/lib.rs");
    assert!(!source.contains("doc(hidden)"), "what is public is documented");
}
