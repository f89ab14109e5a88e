//! The panels of a gap before there is a table on them, and why there may be none.

use crate::elementary::{ln, pow};
use crate::gap::Gap;
use crate::gap::{panels::Span, panels::Unresolved, panels::Variable};
use crate::problem::Printer;
use crate::progress::Stopped;

/// On a panel the slope of a gap grows by at most this factor; a panel is split into at most this many parts.
const GRADED: f64 = 1e3;
const MOST_PARTS: f64 = 64.0;

/// Why there is no table.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TableError {
    /// The gap has structure too fine for the most panels.
    #[error(transparent)]
    TooFine(Unresolved),
    /// The table was no longer wanted.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl TableError {
    /// Why, in words.
    pub fn words(&self, printer: &Printer) -> String {
        match self {
            Self::TooFine(refused) => refused.words(|r| printer.length(r)),
            Self::Stopped(stopped) => stopped.to_string(),
        }
    }
}

/// The panels of a gap, parted where its slope grows so much on one that its inner end had no relative digits: a gap may rise
/// like r^20.
pub(super) fn graded(gap: &dyn Gap, spans: Vec<Span>) -> Vec<Span> {
    let parted = |span: Span| {
        let [inner, outer] = [span.lo, span.hi].map(|r| gap.jet(r).first.abs());
        let growth = if span.variable == Variable::Radius && span.lo > 0.0 { outer / inner } else { 1.0 };
        // Where the slope vanishes at the inner end, no number of parts would do.
        let parts = if growth > GRADED { (ln(growth) / ln(GRADED)).ceil().min(MOST_PARTS) } else { 1.0 };
        let border = |k: f64| if k < parts { span.lo * pow(span.hi / span.lo, k / parts) } else { span.hi };
        let parts = std::iter::successors(Some(0.0), |k| Some(k + 1.0)).take_while(move |k| *k < parts);
        parts
            .map(move |k| Span { lo: if k < 0.5 { span.lo } else { border(k) }, hi: border(k + 1.0), ..span })
            .collect::<Vec<_>>()
    };
    spans.into_iter().flat_map(parted).collect()
}
