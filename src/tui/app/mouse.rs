//! What the mouse does; a key does each of these too. Nothing unless the mouse was taken.
//!
//! | | click | wheel |
//! |---|---|---|
//! | Problem | selects the value | turns it finely |
//! | Charts | the walker goes to the state of the curve there | zooms about the pointer |
//! | Log | selects; a second click goes to the event | selects the one above or below |
//! | a list | selects; a second click takes it | selects the one above or below |
//! | header | goes to a place | |
//! | footer | does what the word says | |
//!
//! A position outside the screen, or outside what is drawn, does nothing. A question is answered only by keys.

use super::state::App;
use crate::explorer::model::Level;
use crate::explorer::pins::letter;
use crate::explorer::{Command, Effect, Id, ScreenPanel, View, reach};
use crate::figure::reading::What;
use crate::figure::{Subject, map, nearest, study};
use crate::tui::layout::Regions;
use crate::tui::overlay::{Choose, Dialog, Prompt};
use crate::tui::terminal::{KeyCode, MouseEvent, MouseEventKind};
use crate::tui::view::status::{self, Does};
use crate::tui::view::{cells, charts, header, log, overlays, places, problem, states};
use ratatui::layout::{Position, Rect};

/// A click goes to a state of the curve within this many character widths; a row counts as two.
const NEAR: f64 = 6.0;

/// The table at this position of the screen.
fn table(regions: &Regions, at: Position) -> Option<Rect> {
    regions.charts.iter().find(|(view, area)| view.is_table() && area.contains(at)).map(|(_, area)| *area)
}

/// A plot, and a position on it in shares of its window.
type PlotPlace = (Rect, (f64, f64));

impl App {
    /// Takes the mouse, or leaves it to the terminal.
    pub(super) fn switch_mouse(&mut self) -> Vec<Effect> {
        self.mouse = !self.mouse;
        if !self.mouse {
            return self.say(Level::Info, "the mouse is left to the terminal, to select text");
        }
        let back = Id::Mouse.named();
        let told = format!("the mouse is taken: click and wheel; {back} leaves it to the terminal again");
        self.say(Level::Info, told)
    }

    /// The mouse was pressed or its wheel turned.
    pub fn mouse(&mut self, mouse: MouseEvent) -> Vec<Effect> {
        let at = Position::new(mouse.column, mouse.row);
        if !self.mouse || !self.screen.contains(at) {
            return Vec::new();
        }
        let up = match mouse.kind {
            MouseEventKind::ScrollUp => Some(true),
            MouseEventKind::ScrollDown => Some(false),
            _ => None,
        };
        if up.is_none()
            && !matches!(self.overlay, Some(Dialog::Confirm(_)))
            && let Some(effects) = self.click_word(at)
        {
            return effects;
        }
        match (&self.overlay, up) {
            (None, Some(up)) => self.wheel(at, up),
            (None, None) => self.click(at),
            (Some(Dialog::Prompt(prompt)), None) => {
                self.click_item(overlays::entry_at(prompt, self.screen, at), prompt.selected)
            }
            // Above the list are the lines typed earlier, which the wheel does not bring back.
            (Some(Dialog::Prompt(prompt)), Some(true)) if prompt.selected.is_none() => Vec::new(),
            (Some(Dialog::Choose(_) | Dialog::Help(_) | Dialog::Prompt(_)), Some(up)) => {
                self.key(if up { KeyCode::Up } else { KeyCode::Down }.into())
            }
            (Some(Dialog::Choose(choose)), None) => {
                self.click_item(overlays::line_at(choose, self.screen, at), Some(choose.selected))
            }
            _ => Vec::new(),
        }
    }

    /// A click on a word of the footer, or on a place in the header.
    fn click_word(&mut self, at: Position) -> Option<Vec<Effect>> {
        if at.y + 1 == self.screen.bottom() {
            return Some(match status::word_at(self, self.screen.width, at.x)? {
                Does::Command(id) => self.act(id),
                Does::Place(home) => {
                    self.going = false;
                    self.run(Command::Go(home))
                }
                Does::Key(code) => self.key(code.into()),
            });
        }
        let home = (at.y == self.screen.y && self.overlay.is_none())
            .then(|| header::place_at(self, self.screen, at.x));
        home.flatten().map(|home| self.run(Command::Go(home)))
    }

    /// Takes the selected line of the list that lies over the screen, or selects another.
    fn click_item(&mut self, line: Option<usize>, selected: Option<usize>) -> Vec<Effect> {
        let Some(line) = line else { return Vec::new() };
        if Some(line) == selected {
            return self.key(KeyCode::Enter.into());
        }
        match self.overlay.take() {
            Some(Dialog::Choose(choose)) => return self.lay_list(Choose { selected: line, ..choose }),
            Some(Dialog::Prompt(prompt)) => {
                return self.lay(Dialog::Prompt(Prompt { selected: Some(line), ..prompt }));
            }
            other => self.overlay = other,
        }
        Vec::new()
    }

    fn pick(&mut self, panel: ScreenPanel, line: Option<usize>) -> Vec<Effect> {
        self.run(Command::Pick { panel, line })
    }

    fn click(&mut self, at: Position) -> Vec<Effect> {
        let Some(regions) = places(self, self.screen) else { return Vec::new() };
        let inside = |area: Option<Rect>| area.filter(|area| area.contains(at));
        // A shared wall has the title of the pane below it.
        if let Some(area) = inside(regions.log) {
            let line = log::line_at(self, area, at.y);
            if line == Some(self.model.event) && self.model.panel == ScreenPanel::Log {
                return self.run(Id::Edit.into());
            }
            return self.pick(ScreenPanel::Log, line);
        }
        for (panel, area) in [(ScreenPanel::Here, regions.here), (ScreenPanel::Result, regions.result)] {
            if inside(area).is_some() {
                return self.pick(panel, None);
            }
        }
        if let Some(area) = inside(regions.problem) {
            let line = self.value_at(&regions, area, at);
            return self.pick(ScreenPanel::Problem, line);
        }
        if let Some(area) = table(&regions, at) {
            let line = states::line_at(&self.model, area, at.y);
            if line == Some(reach::walk_line(&self.model)) && self.model.panel == ScreenPanel::Charts {
                return self.run(Id::Edit.into());
            }
            return self.pick(ScreenPanel::Charts, line);
        }
        let Some((view, place)) = self.place(&regions, at) else { return Vec::new() };
        let mut effects = self.pick(ScreenPanel::Charts, None);
        if let Some((plot, share)) = place {
            effects.extend(self.go_to(view, share, Some(plot)));
        }
        effects
    }

    fn wheel(&mut self, at: Position, up: bool) -> Vec<Effect> {
        let Some(regions) = places(self, self.screen) else { return Vec::new() };
        let inside = |area: Option<Rect>| area.filter(|area| area.contains(at));
        if let Some(area) = inside(regions.problem) {
            let Some(line) = self.value_at(&regions, area, at) else { return Vec::new() };
            let mut effects = self.pick(ScreenPanel::Problem, Some(line));
            effects.extend(self.run(if up { Id::More } else { Id::Less }.into()));
            return effects;
        }
        if inside(regions.log).is_some() {
            let line = if up { self.model.event.saturating_sub(1) } else { self.model.event + 1 };
            return self.pick(ScreenPanel::Log, Some(line));
        }
        if table(&regions, at).is_some() {
            let line = reach::walk_line(&self.model);
            return self.pick(ScreenPanel::Charts, Some(if up { line.saturating_sub(1) } else { line + 1 }));
        }
        match self.place(&regions, at) {
            Some((view, Some((_, about)))) => self.run(Command::Zoom { view, closer: up, about }),
            _ => Vec::new(),
        }
    }

    /// The value at a position in Problem.
    fn value_at(&self, regions: &Regions, area: Rect, at: Position) -> Option<usize> {
        if regions.is_stacked { cells::value_at(self, area, at) } else { problem::line_at(self, area, at.y) }
    }

    /// The chart at a position of the screen, and, on its plot, the plot and the position in shares of the window.
    fn place(&self, regions: &Regions, at: Position) -> Option<(View, Option<PlotPlace>)> {
        let (view, area) = regions.charts.iter().find(|(_, area)| area.contains(at))?;
        let subject = Subject::of(&self.model);
        let plot = subject.and_then(|subject| {
            let figure = subject.figure(*view).on_screen();
            charts::chart(&figure, *view, &self.model.window(*view), self.theme).plot(*area)
        });
        let share = |at: u16, from: u16, count: u16| (f64::from(at - from) + 0.5) / f64::from(count);
        let place = plot
            .filter(|plot| plot.contains(at))
            .map(|plot| (plot, (share(at.x, plot.x, plot.width), 1.0 - share(at.y, plot.y, plot.height))));
        Some((*view, place))
    }

    /// The walker goes to the state of the curve at the cross-hair.
    pub(super) fn go_to_cross_hair(&mut self) -> Vec<Effect> {
        let view = self.model.view;
        match self.model.cross {
            Some(_) if !view.is_table() && !view.leads_somewhere() => {
                let text =
                    format!("no point of {} is a state to go to: views of the curve have them", view.name());
                self.say(Level::Info, text)
            }
            Some(share) if !self.model.view.is_table() => self.go_to(self.model.view, share, None),
            _ => self.run(Id::Edit.into()),
        }
    }

    /// The walker goes to the state of the curve nearest to a position in a view, if that is near in the plot.
    fn go_to(&mut self, view: View, share: (f64, f64), plot: Option<Rect>) -> Vec<Effect> {
        let Some(subject) = Subject::of(&self.model) else { return Vec::new() };
        let figure = subject.figure(view).on_screen();
        let bounds = figure.bounds.part(&self.model.window(view));
        let at = figure.values_at(bounds.at(share));
        if let (View::Map, Some(Ok(report))) = (view, subject.map) {
            let taken = map::taken(report, &self.model.preset, at);
            return self.run(Command::Assign(taken));
        }
        if let (View::Study, Some(Ok(data))) = (view, &subject.study) {
            let taken = study::taken(data, subject.preset, at.0);
            let text = taken.map(|(at, _)| (data.wish.key.clone(), data.wish.values[at].to_string()));
            return text.map_or_else(Vec::new, |assignment| self.run(Command::Assign(vec![assignment])));
        }
        let Some(found) = nearest(&subject, view, &bounds, bounds.at(share)) else { return Vec::new() };
        let is_near = plot.is_none_or(|plot| {
            bounds.share(found.at).is_some_and(|(x, y)| {
                let across = (x - share.0) * f64::from(plot.width);
                across.hypot(2.0 * (y - share.1) * f64::from(plot.height)) <= NEAR
            })
        });
        if is_near {
            let pin = if let What::Pin(number) = found.what { Some(number) } else { None };
            let before = self.model.walking.map(|walking| walking.id);
            let effects = self.run(Command::MoveTo(format!("{:?}", found.contact_radius)));
            match (pin, &mut self.model.walking) {
                (Some(number), Some(walking)) if before != Some(walking.id) => {
                    walking.instead_of = Some(number);
                }
                // It has to wait.
                (Some(number), _) if self.model.message.is_none() => {
                    let text =
                        format!("the walker will go to the present curve, not to pin {}", letter(number));
                    self.model.message = Some((Level::Info, text));
                }
                _ => {}
            }
            return effects;
        }
        self.say(Level::Info, "no state of the curve is near there")
    }
}
