//! What the lines and letters of a figure mean, in as many words as there is room for; and the cross-hair in words.

use super::marks::{letter, look};
use crate::explorer::Model;
use crate::figure::{Figure, Role, Sign, Subject, nearest, reading};
use crate::tui::theme::{Palette, Theme};
use pulloff_engine::problem::Control;

/// The legends of a figure, each shorter than the one before: the least wanted words go first.
pub fn legend(figure: &Figure, theme: Theme) -> Vec<String> {
    let mut words: Vec<(u8, String)> = Vec::new();
    let mut add = |rank: u8, word: String| {
        if !words.iter().any(|(_, other)| *other == word) {
            words.push((rank, word));
        }
    };
    let mut lines: Vec<_> = figure.lines.iter().filter(|line| !line.name.is_empty()).collect();
    // Stable first, overlays behind, pins last.
    lines.sort_by_key(|line| std::cmp::Reverse(line.role));
    lines.sort_by_key(|line| rank(line.role, theme) == 0);
    for line in lines {
        let (stroke, _) = look(line.role, theme.styles());
        add(rank(line.role, theme), format!("{} {}", stroke.glyph(theme), theme.symbols(&line.name)));
    }
    for mark in &figure.marks {
        if let Some((rank, word)) = meaning(mark.sign) {
            add(rank, format!("{} {word}", letter(mark.sign)));
        }
    }
    let worst = words.iter().map(|(rank, _)| *rank).max().unwrap_or(0);
    let up_to = |limit: u8| {
        let kept: Vec<&str> =
            words.iter().filter(|(rank, _)| *rank <= limit).map(|(_, word)| word.as_str()).collect();
        kept.join(", ")
    };
    (0..=worst).rev().map(up_to).collect()
}

/// How much a line's name is wanted, 0 the most.
fn rank(role: Role, theme: Theme) -> u8 {
    match role {
        // What colour would tell needs a word without it.
        Role::Stable | Role::Unstable if theme.palette == Palette::Mono => 1,
        Role::Pin(_) => 0,
        Role::Inadmissible
        | Role::Exact
        | Role::Loading
        | Role::Unloading
        | Role::Envelope
        | Role::Undeformed
        | Role::Barrier
        | Role::Device => 1,
        Role::Smooth | Role::Branch => 3,
        Role::Law | Role::Level | Role::Cusps | Role::Landings => 1,
        Role::Walk | Role::Jump => 5,
        _ => 4,
    }
}

/// What a sign means, and how much that is wanted.
fn meaning(sign: Sign) -> Option<(u8, &'static str)> {
    Some(match sign {
        Sign::Stray | Sign::Value => return None,
        Sign::OtherLimit(Control::Force) => (3, "limit of P"),
        Sign::OtherLimit(_) => (3, "limit of δ"),
        Sign::Limit => (1, "limit"),
        Sign::PullOff => (2, "pull-off"),
        Sign::Landing => (2, "landing"),
        Sign::Cusp => (1, "cusp"),
        Sign::Swallowtail => (2, "swallowtail"),
        Sign::Preset => (1, "preset"),
        Sign::Snaps(_) => (3, "snaps"),
        Sign::Touch => (2, "touch"),
        Sign::Turn => (2, "turn"),
        Sign::Crest => (3, "crest"),
        Sign::Edge => (3, "edge"),
        Sign::Minimum => (2, "minimum"),
        Sign::Maximum => (2, "maximum"),
        Sign::Barrier => (1, "barrier"),
        Sign::Walker => (1, "here"),
        Sign::Measured { loading: true } => (2, "measured approach"),
        Sign::Measured { loading: false } => (2, "measured retraction"),
    })
}

/// The cross-hair in words: on a curve the state near to it, then both coordinates.
pub fn reading(model: &Model) -> Option<String> {
    let (share, view) = (model.cross?, model.view);
    let subject = Subject::of(model)?;
    let figure = subject.figure(view);
    let bounds = figure.bounds.part(&model.window(view));
    let at = bounds.at(share);
    let here = reading::coordinates(&bounds, [&figure.x, &figure.y], at);
    Some(match nearest(&subject, view, &bounds, at) {
        // What it is first: that is new, and narrow screens cut the end.
        Some(nearest) => format!("* {}; + {here}", nearest.text(&subject.curve.setting.preset.units)),
        None => format!("+ {here}"),
    })
}
