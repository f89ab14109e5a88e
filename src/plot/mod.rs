//! Figures for print, as SVG.
//!
//! | file | what lives there |
//! |---|---|
//! | [`adhesion`] | the effect of the range of adhesion, over `λ_M` |
//! | [`ink`] | the strokes, colours and signs of the roles: safe for the colour-blind, readable in grey |
//! | [`lines`] | lines over two parameters at which snaps begin, limit points over one |
//! | [`map`] | a quantity of a sweep over its two axes |
//! | [`paper`] | the figures of the paper, computed again |
//! | [`series`] | a quantity of a sweep over its one axis |
//! | [`svg`] | the only file that knows the drawing library |
//! | [`table`] | the data of a figure as CSV |
//!
//! A figure is drawn at its size on paper: 86 mm for one column of a journal, 178 mm for two, with 8-point letters.

pub mod adhesion;
pub mod ink;
pub mod lines;
pub mod map;
pub mod paper;
pub mod picture;
pub mod series;
pub mod svg;
pub mod table;

/// The width of a figure on paper, in millimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Width(f64);

impl Width {
    /// One column of a journal.
    pub const ONE_COLUMN: Self = Self(86.0);
    /// Two columns, the width of a page.
    pub const TWO_COLUMNS: Self = Self(178.0);
    /// The allowed widths: below, the letters leave no room for the curve; above, paper is too small.
    pub const RANGE: std::ops::RangeInclusive<f64> = 50.0..=500.0;

    /// A width in millimetres; `None` outside [`Width::RANGE`].
    pub fn millimetres(mm: f64) -> Option<Self> {
        Self::RANGE.contains(&mm).then_some(Self(mm))
    }

    /// In millimetres.
    pub fn get(self) -> f64 {
        self.0
    }
}
