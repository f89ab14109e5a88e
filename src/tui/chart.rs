//! One chart: axes with round ticks, curves, shaded areas, marks.
//!
//! No non-finite number reaches a cell, and nothing outside the window is drawn.

use super::marks::{letter, look, style};
use super::raster::{self, Layer, Meets};
use super::theme::Theme;
use super::ticks::ticks;
use crate::figure::{self, Area, AxisScale, Bounds, Figure, Meaning, Role, Sign};
use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Position, Rect};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Widget, Wrap};

/// An entry of the legend: what a line or a letter looks like, and what it means.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendRow {
    pub glyph: String,
    pub style: Style,
    pub meaning: String,
}

impl LegendRow {
    fn width(&self) -> usize {
        self.glyph.chars().count() + 1 + self.meaning.chars().count()
    }
}

/// A figure drawn in the cells of a screen.
#[derive(Debug)]
pub struct Chart<'a> {
    pub figure: &'a Figure,
    pub theme: Theme,
    /// The title in its upper wall.
    pub title: String,
    /// The visible part of the figure.
    pub bounds: Bounds,
    /// Whether its lines are curves to be compared: those share the cells in which they meet.
    pub compares: bool,
    /// The meaning of lines and letters, the most important first.
    pub legend: Vec<LegendRow>,
    /// The mark that stands out, by its index among the marks of the figure.
    pub selected: Option<usize>,
    pub cross: Option<(f64, f64)>,
    /// The state nearest to the cross-hair.
    pub nearest: Option<(f64, f64)>,
    /// Whether it stands beside another chart with the same vertical axis: both keep the same rows for the legend, so that
    /// equal values are on one row.
    pub is_paired: bool,
    /// Whether the parts of a contact under tension look like the others.
    pub hides_tension: bool,
}

/// Takes from `rest` the entries that fit into a row, the most important first.
fn next_row<'a>(rest: &mut Vec<&'a LegendRow>, room: usize) -> Vec<&'a LegendRow> {
    let mut used = 0;
    let (row, left) = rest.drain(..).partition(|entry| {
        let width = entry.width() + if used == 0 { 0 } else { 2 };
        let fits = used + width <= room;
        used += if fits { width } else { 0 };
        fits
    });
    *rest = left;
    row
}

/// A chart with fewer rows inside has no row for its legend.
const LEGEND_ROWS: u16 = 8;
/// The legend may take one row for each of these inside.
const ROWS_PER_LEGEND_ROW: u16 = 4;
/// The same for curves, up to the most that they have: their lines are the same in every chart, and rows are what they
/// need.
const ROWS_PER_LEGEND_ROW_OF_CURVES: u16 = 8;
const MOST_OF_CURVES: u16 = 2;

impl Chart<'_> {
    /// Draws the chart with its frame into `area`.
    pub fn draw(&self, frame: &mut Frame<'_>, area: Rect, selected: bool) {
        let theme = self.theme;
        let title = theme.whole_words(&theme.text(&self.title), usize::from(area.width.saturating_sub(2)));
        let mut block: Block<'_> = theme.block(selected).title(Span::styled(title, theme.title(selected)));
        let note = self.note();
        if self.legend_fits(area) {
            let mut spans = self.legend_spans(&self.legend);
            if !note.is_empty() && !spans.is_empty() {
                spans.push(Span::raw("  "));
            }
            spans.push(Span::styled(note, theme.dim()));
            block = block.title_top(Line::from(spans).right_aligned());
        } else if self.heading() + 3 <= usize::from(area.width) {
            block = block.title_top(Line::styled(note, theme.dim()).right_aligned());
        }
        let inner = block.inner(area);
        frame.render_widget(block, area);
        let buffer = frame.buffer_mut();
        if let Some(reason) = &self.figure.missing {
            let reason = Paragraph::new(theme.text(reason)).wrap(Wrap { trim: true }).style(theme.dim());
            reason.render(inner.inner(Margin::new(1, 1)), buffer);
            return;
        }
        let Some(plot) = self.plot(area) else { return };
        for (y, row) in (inner.y..).zip(self.legend_rows(area, inner, plot.width).0) {
            let line = Line::from(self.legend_spans(row));
            buffer.set_line(plot.x, y, &line, plot.width);
        }
        if self.has_note_row(area, inner) {
            let note = self.note_within(usize::from(inner.width - 2));
            buffer.set_string(inner.x + 1, plot.y - 1, note, theme.dim());
        }
        for (at, region) in self.figure.areas.iter().enumerate() {
            self.fill(buffer, plot, at, region);
        }
        self.draw_zero(buffer, plot);
        let taken = raster::draw(&self.layers(plot), buffer, plot, theme.charts);
        self.draw_cross(buffer, plot);
        self.draw_labels(buffer, inner, plot);
        self.draw_marks(buffer, plot, &taken);
        let is_marked = self.figure.marks.iter().any(|mark| self.place(mark.at, plot).is_some());
        if !is_marked && taken.iter().all(Option::is_none) && !self.figure.lines.is_empty() {
            let text = theme.whole_words("nothing of the figure is here", usize::from(plot.width));
            buffer.set_string(plot.x, plot.y + plot.height / 2, text, theme.dim());
        }
    }

    /// The notes of the figure, shown at the right end of the title's line if they fit.
    fn note(&self) -> String {
        self.theme.text(&self.figure.notes.join(", "))
    }

    /// As many whole notes as fit, and how many do not, or the words of the first: half a note may lack its number.
    fn note_within(&self, room: usize) -> String {
        let notes = &self.figure.notes;
        let within = |count: usize| {
            let left = notes.len() - count;
            let rest = if left > 0 { format!(", +{left}") } else { String::new() };
            self.theme.text(&format!("{}{rest}", notes[..count].join(", ")))
        };
        let fits = (1..=notes.len()).rev().map(within).find(|text| text.chars().count() <= room);
        fits.unwrap_or_else(|| self.theme.whole_words(&self.note(), room))
    }

    /// The width of the title with the note.
    pub fn heading(&self) -> usize {
        self.title.chars().count() + self.note().chars().count()
    }

    /// The curves, each with all its parts; the curve of the problem comes last of those that share cells.
    fn layers(&self, plot: Rect) -> Vec<Layer> {
        let mut all: Vec<(Role, Layer)> = Vec::new();
        // A chart draws its zero lines itself; a level with a name is another thing.
        let is_drawn = |line: &&figure::Line| line.role != Role::Zero || !line.name.is_empty();
        for line in self.figure.lines.iter().filter(is_drawn) {
            // The stable and the unstable parts are one curve.
            let curve = if line.role == Role::Unstable { Role::Stable } else { line.role };
            let at = all.iter().position(|(other, _)| *other == curve).unwrap_or_else(|| {
                all.push((curve, Layer::new(look(curve, self.theme), plot)));
                all.len() - 1
            });
            let is_broken = line.is_broken || look(line.role, self.theme).is_broken;
            all[at].1.add(&line.points, is_broken, &self.bounds, plot, self.theme.charts);
        }
        all.sort_by_key(|(role, _)| (*role == Role::Stable, *role));
        for (role, layer) in &mut all {
            // Curves of states are not compared: the computed one stays visible where others agree with it.
            let is_own = matches!(role, Role::Stable | Role::Body | Role::Edges);
            if !self.compares && !is_own && layer.stroke.meets == Meets::Shares {
                layer.stroke.meets = Meets::Beneath;
            }
        }
        all.into_iter().map(|(_, layer)| layer).collect()
    }

    /// Whether the whole legend fits into the upper wall.
    fn legend_fits(&self, area: Rect) -> bool {
        let legend: usize = self.legend.iter().map(|entry| entry.width() + 2).sum();
        !self.is_paired && self.heading() + legend + 4 <= usize::from(area.width)
    }

    /// Continues the legend of the chart beside it, in `area`, from where that one ran out of room; keeps its own if that
    /// one was complete.
    pub fn go_on_with_legend(&mut self, beside: &Chart<'_>, area: Rect) {
        let Some(plot) = beside.plot(area) else { return };
        let (.., left) = beside.legend_rows(area, area.inner(Margin::new(1, 1)), plot.width);
        let is_new = |entry: &&LegendRow| !beside.legend.iter().any(|other| other.meaning == entry.meaning);
        let rest: Vec<LegendRow> =
            left.into_iter().chain(self.legend.iter().filter(is_new)).cloned().collect();
        if !rest.is_empty() {
            self.legend = rest;
        }
    }

    /// These entries of the legend.
    fn legend_spans<'b>(&self, entries: impl IntoIterator<Item = &'b LegendRow>) -> Vec<Span<'static>> {
        let theme = self.theme;
        let mut spans = Vec::new();
        for (at, entry) in entries.into_iter().enumerate() {
            spans.push(Span::raw(if at == 0 { "" } else { "  " }));
            spans.push(Span::styled(entry.glyph.clone(), entry.style));
            spans.push(Span::styled(format!(" {}", theme.text(&entry.meaning)), theme.dim()));
        }
        spans
    }

    /// How many rows inside the legend may take.
    fn most_legend_rows(&self, inner: Rect) -> u16 {
        match inner.height {
            0..LEGEND_ROWS => 0,
            height if self.is_paired || self.compares => {
                (height / ROWS_PER_LEGEND_ROW_OF_CURVES).min(MOST_OF_CURVES)
            }
            height => height / ROWS_PER_LEGEND_ROW,
        }
    }

    /// The entries of the legend in each row of a plot of this width, the number of rows kept for them, and the entries
    /// left: one that does not fit is left out whole, the least important first.
    fn legend_rows(
        &self,
        area: Rect,
        inner: Rect,
        width: u16,
    ) -> (Vec<Vec<&LegendRow>>, u16, Vec<&LegendRow>) {
        let most = if self.legend_fits(area) { 0 } else { self.most_legend_rows(inner) };
        let mut rest: Vec<&LegendRow> = self.legend.iter().collect();
        let rows = (0..most).map(|_| next_row(&mut rest, usize::from(width)));
        let rows: Vec<_> = rows.take_while(|row| !row.is_empty()).collect();
        // The plots of a pair have equal heights.
        let used = u16::try_from(rows.len()).unwrap_or(most);
        (rows, if self.is_paired { most } else { used }, rest)
    }

    /// Whether one of the rows inside is used for the note, which does not fit into the wall; the plots of a pair have
    /// equal heights.
    fn has_note_row(&self, area: Rect, inner: Rect) -> bool {
        let is_in_wall = self.heading() + 3 <= usize::from(area.width);
        inner.height > LEGEND_ROWS && !self.is_paired && !self.note().is_empty() && !is_in_wall
    }

    /// The ticks of y in a frame with this interior.
    fn y_ticks(&self, inner: Rect) -> Vec<(f64, String)> {
        ticks(self.bounds.y, self.figure.y.run, usize::from(inner.height / 3).clamp(2, 8))
    }

    /// Where the curves are drawn, with the frame in `area`; `None` if there is no room for them.
    pub fn plot(&self, area: Rect) -> Option<Rect> {
        let inner = area.inner(Margin::new(1, 1));
        if inner.width < 12 || inner.height < 3 {
            return None;
        }
        let gutter = self.y_ticks(inner).iter().map(|(_, label)| label.len()).max().unwrap_or(0);
        let gutter = u16::try_from(gutter + 1).unwrap_or(u16::MAX).min(inner.width / 3);
        let (_, legend, _) = self.legend_rows(area, inner, inner.width - gutter);
        let above = legend + u16::from(self.has_note_row(area, inner));
        Some(Rect {
            x: inner.x + gutter,
            y: inner.y + above,
            width: inner.width - gutter,
            height: inner.height - 1 - above,
        })
    }

    /// Widens the axes so that a circle looks round in a frame of this area: a cell is twice as high as it is wide.
    pub fn make_even(&mut self, area: Rect) {
        let Some(plot) = self.plot(area) else { return };
        let [x, y] = [self.bounds.x, self.bounds.y].map(|[lo, hi]| hi - lo);
        let (across, upwards) = (f64::from(plot.width), 2.0 * f64::from(plot.height));
        let unit = (x / across).max(y / upwards);
        let spare = 0.5 * (unit * across - x);
        self.bounds.x = [self.bounds.x[0] - spare, self.bounds.x[1] + spare];
        self.bounds.y[1] = self.bounds.y[0] + unit * upwards;
    }

    /// Fills the cells whose centre is inside an outline, which is the `at`-th of the figure.
    fn fill(&self, buffer: &mut Buffer, plot: Rect, at: usize, region: &Area) {
        let (theme, styles) = (self.theme, self.theme.styles());
        let (style, shade) = match region.meaning {
            // Neighbours differ.
            Meaning::Lost if at.is_multiple_of(2) => (styles.lost, theme.shade("░", "/")),
            Meaning::Lost => (styles.lost, theme.shade("▒", "\\")),
            Meaning::Tension if self.hides_tension => return,
            Meaning::Tension | Meaning::Most => (styles.curve, theme.shade("░", "-")),
            Meaning::Contact | Meaning::Half => (styles.curve, theme.shade("▒", "#")),
        };
        if region.outline.iter().any(|(x, y)| !(x.is_finite() && y.is_finite())) {
            return;
        }
        for row in 0..plot.height {
            let up = 1.0 - (f64::from(row) + 0.5) / f64::from(plot.height);
            let (_, y) = self.bounds.at((0.0, up));
            let crossings = crossings(&region.outline, y);
            if crossings.is_empty() {
                continue;
            }
            for column in 0..plot.width {
                let (x, _) = self.bounds.at(((f64::from(column) + 0.5) / f64::from(plot.width), 0.0));
                // Inside if an odd number of sides lies to the left.
                if crossings.iter().filter(|crossing| **crossing < x).count() % 2 == 1 {
                    put(buffer, (plot.x + column, plot.y + row), shade, style);
                }
            }
        }
    }

    /// Draws the axes through zero, in the empty cells.
    fn draw_zero(&self, buffer: &mut Buffer, plot: Rect) {
        let theme = self.theme;
        // On a logarithmic axis there is no zero.
        let has_zero = [&self.figure.x, &self.figure.y].map(|axis| axis.run != AxisScale::Logarithmic);
        let column = cell(0.0, self.bounds.x, plot.width, false).filter(|_| has_zero[0]);
        let row = cell(0.0, self.bounds.y, plot.height, true).filter(|_| has_zero[1]);
        let across = row.into_iter().flat_map(|row| (0..plot.width).map(move |i| (i, row)));
        let across = across.map(|at| (at, theme.glyph("┈", "-")));
        let upwards = column.into_iter().flat_map(|column| (0..plot.height).map(move |j| (column, j)));
        let upwards = upwards.map(|at| (at, theme.glyph("┊", ":")));
        for ((i, j), line) in across.chain(upwards) {
            let place = &mut buffer[(plot.x + i, plot.y + j)];
            if place.symbol() == " " {
                place.set_symbol(line).set_style(theme.dim());
            }
        }
    }

    /// Draws each label on its row or column with its tick, or not at all.
    fn draw_labels(&self, buffer: &mut Buffer, inner: Rect, plot: Rect) {
        let theme = self.theme;
        let gutter = plot.x - inner.x;
        for (value, label) in &self.y_ticks(inner) {
            let room = usize::from(gutter.saturating_sub(1));
            if let Some(row) = cell(*value, self.bounds.y, plot.height, true)
                && label.len() <= room
            {
                let text = format!("{label:>room$}");
                buffer.set_stringn(inner.x, plot.y + row, text, room, theme.dim());
                buffer.set_stringn(plot.x - 1, plot.y + row, theme.glyph("╶", "-"), 1, theme.dim());
            }
        }
        let below = plot.y + plot.height;
        let title = theme.text(&self.figure.x.title());
        let title_width = u16::try_from(title.chars().count()).unwrap_or(u16::MAX);
        let end = inner.right().saturating_sub(title_width + 1);
        let most = usize::from(plot.width / 12).clamp(2, 10);
        let placed = |most: usize| {
            let mut free = inner.x;
            let ticks = ticks(self.bounds.x, self.figure.x.run, most).into_iter();
            let place = ticks.filter_map(|(value, label)| {
                let width = u16::try_from(label.len()).unwrap_or(u16::MAX);
                let column = plot.x + cell(value, self.bounds.x, plot.width, false)?;
                let x = column.checked_sub(width / 2)?;
                let fits = x >= free && x + width <= end;
                fits.then(|| {
                    free = x + width + 1;
                    (column, x, label)
                })
            });
            place.collect::<Vec<_>>()
        };
        // If the title takes the room of the second number, numbers stand closer together.
        let few = placed(most);
        for (column, x, label) in if few.len() < 2 { placed(2 * most) } else { few } {
            buffer.set_stringn(x, below, &label, label.len(), theme.dim());
            let tick = &mut buffer[(column, below - 1)];
            if tick.symbol() == " " {
                tick.set_symbol(theme.glyph("╷", "|")).set_style(theme.dim());
            }
        }
        let x = inner.right().saturating_sub(title_width).max(inner.x);
        buffer.set_stringn(x, below, title, usize::from(inner.width), theme.strong());
    }

    /// Draws the marks; a mark that stands beside its point takes a free cell there, if there is one. The label of a
    /// region or a line is left out where it would touch another mark.
    fn draw_marks(&self, buffer: &mut Buffer, plot: Rect, taken: &[Option<usize>]) {
        let mut marked: Vec<Position> = Vec::new();
        let is_label = |sign| matches!(sign, Sign::OfCrest(_) | Sign::Snaps(_));
        let all = || self.figure.marks.iter().enumerate();
        let labels_last = all()
            .filter(|(_, mark)| !is_label(mark.sign))
            .chain(all().filter(|(_, mark)| is_label(mark.sign)));
        for (number, mark) in labels_last {
            let Some(own) = self.place(mark.at, plot) else { continue };
            let is_free = |at: &Position| {
                let index = usize::from(at.y - plot.y) * usize::from(plot.width) + usize::from(at.x - plot.x);
                taken.get(index).is_some_and(Option::is_none) && !marked.contains(at)
            };
            let beside = [(-1, 0), (1, 0), (0, -1), (0, 1)].into_iter().filter_map(|(right, down)| {
                let at = Position::new(own.x.checked_add_signed(right)?, own.y.checked_add_signed(down)?);
                plot.contains(at).then_some(at)
            });
            // What it marks stays visible.
            let is_beside = matches!(
                mark.sign,
                Sign::OtherLimit(_)
                    | Sign::Limit
                    | Sign::Event(_)
                    | Sign::Passing(_)
                    | Sign::LastContact(_)
                    | Sign::LargestPull
                    | Sign::Farthest
            );
            let found = if is_beside { beside.into_iter().find(is_free) } else { None };
            let at = found.unwrap_or(own);
            if is_beside && marked.contains(&at) {
                continue;
            }
            // One letter per cell; a longer label stays inside the plot.
            let label = letter(mark.sign, self.theme);
            let width = u16::try_from(label.chars().count()).unwrap_or(1);
            let first = at.x.min(plot.right().saturating_sub(width)).max(plot.x);
            let touches =
                |other: &Position| other.y == at.y && (first..first + width + 2).contains(&(other.x + 1));
            if is_label(mark.sign) && marked.iter().any(touches) {
                continue;
            }
            marked.extend((first..first + width).map(|x| Position::new(x, at.y)));
            let mut style = style(mark.sign, self.theme);
            if self.selected == Some(number) {
                style = style.add_modifier(Modifier::REVERSED);
            }
            for (x, letter) in (first..plot.right()).zip(label.chars()) {
                put(buffer, (x, at.y), letter.encode_utf8(&mut [0; 4]), style);
            }
        }
        if let Some(at) = self.nearest.and_then(|at| self.place(at, plot)) {
            put(buffer, at.into(), "*", self.theme.styles().nearest);
        }
    }

    /// The cell of a point, if visible.
    fn place(&self, (x, y): (f64, f64), plot: Rect) -> Option<Position> {
        let column = cell(x, self.bounds.x, plot.width, false)?;
        let row = cell(y, self.bounds.y, plot.height, true)?;
        Some(Position::new(plot.x + column, plot.y + row))
    }

    /// Draws the cross-hair: lines in the empty cells of its row and column.
    fn draw_cross(&self, buffer: &mut Buffer, plot: Rect) {
        let theme = self.theme;
        let Some((x, y)) = self.cross else { return };
        let column = cell(x, self.bounds.x, plot.width, false);
        let row = cell(y, self.bounds.y, plot.height, true);
        let (Some(column), Some(row)) = (column, row) else { return };
        let across = (0..plot.width).map(|i| (i, row, theme.glyph("─", "-")));
        let upwards = (0..plot.height).map(|j| (column, j, theme.glyph("│", "|")));
        let free = [" ", theme.glyph("┈", "-"), theme.glyph("┊", ":")];
        for (i, j, line) in across.chain(upwards) {
            let place = &mut buffer[(plot.x + i, plot.y + j)];
            if free.contains(&place.symbol()) {
                place.set_symbol(line).set_style(theme.dim());
            }
        }
        put(buffer, (plot.x + column, plot.y + row), "+", theme.strong());
    }
}

/// Where the sides of the outline cross the level `y`.
fn crossings(outline: &[(f64, f64)], y: f64) -> Vec<f64> {
    let next = outline.iter().cycle().skip(1);
    outline
        .iter()
        .zip(next)
        .filter(|(a, b)| (a.1 > y) != (b.1 > y))
        .map(|(a, b)| a.0 + (b.0 - a.0) * (y - a.1) / (b.1 - a.1))
        .collect()
}

/// Puts a letter in place of what is drawn there: the background of a block would show through.
fn put(buffer: &mut Buffer, at: (u16, u16), letter: &str, style: Style) {
    let cell = &mut buffer[at];
    cell.reset();
    cell.set_symbol(letter).set_style(style);
}

/// The cell, out of `count`, in which `value` falls; counted from the far end if `flipped`.
fn cell(value: f64, [lo, hi]: [f64; 2], count: u16, flipped: bool) -> Option<u16> {
    let share = (value - lo) / (hi - lo);
    if count == 0 || !(0.0..=1.0).contains(&share) {
        return None;
    }
    // Between 0 and count.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let at = ((share * f64::from(count)) as u16).min(count - 1);
    Some(if flipped { count - 1 - at } else { at })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_is_filled_inside_and_nowhere_else() {
        // A square with a notch.
        let outline = vec![(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (2.0, 1.5), (1.0, 3.0)];
        for (y, expected) in
            [(2.0, vec![1.0, 5.0 / 3.0, 7.0 / 3.0, 3.0]), (0.5, vec![]), (1.2, vec![1.0, 3.0])]
        {
            let mut found = crossings(&outline, y);
            found.sort_by(f64::total_cmp);
            assert_eq!(found.len(), expected.len(), "{y}");
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        }
    }
}
