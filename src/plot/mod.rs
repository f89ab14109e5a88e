//! Figures for print, as SVG.
//!
//! | file | what lives there |
//! |---|---|
//! | [`adhesion`] | what the range of adhesion changes, over `λ_M` |
//! | [`ink`] | the strokes, colours and signs of the roles: safe for the colour-blind, readable in grey |
//! | [`lines`] | lines in two numbers at which snaps begin, limit points over one |
//! | [`map`] | a quantity of a sweep over its two axes |
//! | [`paper`] | the figures of the paper, computed again |
//! | [`series`] | a quantity of a sweep over its one axis |
//! | [`svg`] | the one place that knows the drawing library |
//! | [`table`] | the data of a figure as CSV |
//!
//! A figure is drawn in its size on paper: 86 mm for one column of a journal, 178 mm for two, letters of 8 points.

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
    /// Two columns, a whole page.
    pub const TWO_COLUMNS: Self = Self(178.0);
    /// What can be asked for: below it the letters leave no room for the curve, above it is no paper.
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
