//! The recording of the explorer in the book: keys pressed in a real pseudo-terminal, and the resulting screens as an
//! animated SVG. `UPDATE_DOCS=1 cargo test --test program recording::` records it; without that, each key must lead to
//! the recorded screen.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::pty::Pty;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

const FILE: &str = "docs/src/recording.svg";

const COLS: u16 = 80;
const ROWS: u16 = 24;

/// The keys of each step, and the text shown below the screen meanwhile.
const STEPS: [(&str, &str); 9] = [
    ("", "pulloff wavy-sphere"),
    ("n", "n: the edge recedes to where it loses its hold"),
    ("n", "n: it snaps to the next crest"),
    ("nn", "n n: and again"),
    ("nn", "n n: and again"),
    ("<<<<<<", "<: lower waves, and the curve follows"),
    (">>>>>>", ">: and higher ones"),
    ("g", "g: inside the contact"),
    ("?", "?: every key"),
];

/// How long a screen is shown, in seconds.
const SHOWN: f64 = 1.8;

/// A screen that has not changed for this long is settled. Only a recording waits for this.
const SETTLED: Duration = Duration::from_millis(700);

/// The size of a cell in pixels.
const CELL: [f64; 2] = [8.4, 17.0];

/// The appearance of a cell: its colour on this screen, whether it is bold, whether it is reversed.
type Look = (String, bool, bool);

/// A row as runs of equal appearance: the starting column and the text.
type Row = Vec<(u16, Look, String)>;

/// The sixteen colours of a terminal with a dark background.
const COLOURS: [&str; 16] = [
    "#1c1c1c", "#e06c75", "#98c379", "#e5c07b", "#61afef", "#c678dd", "#56b6c2", "#c8ccd4", "#7f848e",
    "#e06c75", "#98c379", "#e5c07b", "#61afef", "#c678dd", "#56b6c2", "#ffffff",
];

fn colour(colour: vt100::Color) -> String {
    const STEPS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    match colour {
        vt100::Color::Default => COLOURS[7].to_owned(),
        vt100::Color::Idx(index @ 0..16) => COLOURS[usize::from(index)].to_owned(),
        vt100::Color::Idx(index @ 16..232) => {
            let [r, g, b] =
                [(index - 16) / 36, (index - 16) / 6 % 6, (index - 16) % 6].map(|k| STEPS[usize::from(k)]);
            format!("#{r:02x}{g:02x}{b:02x}")
        }
        vt100::Color::Idx(index) => {
            let grey = 8 + 10 * (index - 232);
            format!("#{grey:02x}{grey:02x}{grey:02x}")
        }
        vt100::Color::Rgb(r, g, b) => format!("#{r:02x}{g:02x}{b:02x}"),
    }
}

/// The rows of a screen.
fn rows(screen: &vt100::Screen) -> Vec<Row> {
    (0..ROWS)
        .map(|row| {
            let mut runs: Row = Vec::new();
            for col in 0..COLS {
                let cell = screen.cell(row, col).unwrap();
                let look = (colour(cell.fgcolor()), cell.bold(), cell.inverse());
                let text = if cell.has_contents() { cell.contents().to_owned() } else { " ".to_owned() };
                match runs.last_mut() {
                    Some((_, last, run)) if *last == look => run.push_str(&text),
                    _ => runs.push((col, look, text)),
                }
            }
            runs.retain(|(_, look, text)| look.2 || !text.trim().is_empty());
            runs
        })
        .collect()
}

/// The text of a screen as it is in the file.
fn text(rows: &[Row]) -> String {
    rows.iter().map(|row| row.iter().map(|(_, _, text)| text.as_str()).collect::<String>() + "\n").collect()
}

/// A text without blanks, whose appearance, which splits rows into runs, depends on what was drawn before.
fn squeezed(text: &str) -> String {
    text.split_whitespace().collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// One row, drawn at the top.
fn drawn(row: &Row) -> String {
    let mut out = String::new();
    for (col, (colour, bold, inverse), text) in row {
        let (x, width) = (f64::from(*col) * CELL[0], text.chars().count() as f64 * CELL[0]);
        let fill = if *inverse {
            write!(
                out,
                "<rect x=\"{x:.1}\" width=\"{width:.1}\" height=\"{:.0}\" fill=\"{colour}\"/>",
                CELL[1]
            )
            .unwrap();
            COLOURS[0]
        } else {
            colour
        };
        let weight = if *bold { " font-weight=\"bold\"" } else { "" };
        write!(
            out,
            "<text x=\"{x:.1}\" y=\"13\" textLength=\"{width:.1}\" fill=\"{fill}\"{weight}>{}</text>",
            escaped(text)
        )
        .unwrap();
    }
    out
}

/// All screens in turn, repeating. A row shared by several screens appears once.
fn animation(screens: &[Vec<Row>]) -> String {
    let [width, height] = [f64::from(COLS) * CELL[0] + 16.0, f64::from(ROWS + 1) * CELL[1] + 20.0];
    let whole = SHOWN * screens.len() as f64;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"DejaVu Sans Mono, \
         Menlo, Consolas, monospace\" font-size=\"14\">\n<title>The explorer, key by key</title>\n<style>text{{white-space:pre}}\
         .s{{opacity:0;animation:shown {whole:.1}s step-end infinite}}@keyframes shown{{0%{{opacity:1}}{:.4}%{{opacity:0}}\
         100%{{opacity:0}}}}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n<defs>\n",
        100.0 / screens.len() as f64,
        COLOURS[0]
    );
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    for row in screens.iter().flatten() {
        let drawn = drawn(row);
        let next = known.len();
        if let std::collections::btree_map::Entry::Vacant(entry) = known.entry(drawn) {
            writeln!(out, "<g id=\"r{next}\">{}</g>", entry.key()).unwrap();
            entry.insert(next);
        }
    }
    out += "</defs>\n";
    for (at, screen) in screens.iter().enumerate() {
        writeln!(out, "<g class=\"s\" style=\"animation-delay:{:.1}s\">", SHOWN * at as f64).unwrap();
        for (row, runs) in screen.iter().enumerate() {
            writeln!(
                out,
                "<use href=\"#r{}\" transform=\"translate(8 {:.0})\"/>",
                known[&drawn(runs)],
                8.0 + row as f64 * CELL[1]
            )
            .unwrap();
        }
        let below = 8.0 + (f64::from(ROWS) + 0.9) * CELL[1];
        writeln!(
            out,
            "<text x=\"8\" y=\"{below:.0}\" fill=\"{}\">{}</text></g>",
            COLOURS[3],
            escaped(STEPS[at].1)
        )
        .unwrap();
    }
    out + "</svg>\n"
}

/// The texts of the screens of a recording.
fn recorded(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let texts = |node: roxmltree::Node<'_, '_>| {
        node.descendants()
            .filter(|node| node.has_tag_name("text"))
            .filter_map(|text| text.text())
            .collect::<String>()
    };
    let groups = || document.descendants().filter(|node| node.has_tag_name("g"));
    let rows: BTreeMap<&str, String> =
        groups().filter_map(|group| Some((group.attribute("id")?, texts(group)))).collect();
    let screens = groups().filter(|group| group.attribute("class") == Some("s"));
    screens
        .map(|screen| {
            let used = screen.children().filter_map(|row| row.attribute("href")?.strip_prefix('#'));
            used.map(|row| rows[row].clone() + "\n").collect()
        })
        .collect()
}

#[test]
fn the_recording_shows_what_the_keys_lead_to() {
    let records = std::env::var_os("UPDATE_DOCS").is_some();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(FILE);
    let wanted = if records { Vec::new() } else { recorded(&fs::read_to_string(&file).unwrap()) };
    let mut pty = Pty::spawn(Path::new(env!("CARGO_BIN_EXE_pulloff")), &["wavy-sphere"], &[], COLS, ROWS);
    let shown = |pty: &Pty| pty.with_screen(rows);
    let mut screens = Vec::new();
    for (at, (keys, what)) in STEPS.iter().enumerate() {
        pty.keys(keys);
        if records {
            if at == 0 {
                pty.wait_for(|screen| screen.contains("wavy-sphere"), "the explorer");
            }
            let mut before = Vec::new();
            while before != shown(&pty) {
                before = shown(&pty);
                thread::sleep(SETTLED);
            }
            screens.push(before);
        } else {
            pty.wait_until(
                |pty| squeezed(&text(&shown(pty))) == squeezed(&wanted[at]),
                &format!("the screen of \"{what}\", which UPDATE_DOCS=1 cargo test --test program recording:: would record anew:\n{}", wanted[at]),
            );
        }
    }
    if records {
        let svg = animation(&screens);
        let texts: Vec<String> = screens.iter().map(|screen| text(screen)).collect();
        assert_eq!(recorded(&svg), texts, "what is written is what was seen");
        fs::write(&file, svg).unwrap();
    } else {
        assert_eq!(wanted.len(), STEPS.len());
    }
}
