//! What a point of a figure means: its coordinates, and on a view of the curve the state nearest to it.

use super::Subject;
use super::bounds::Bounds;
use super::curves::place;
use super::parts::Axis;
use crate::explorer::View;
use crate::report::number::{significant, with_unit};
use crate::units::{Quantity, UnitSystem};

/// The state of the curve nearest to a point of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Where it stands in the view.
    pub at: (f64, f64),
    /// δ, in the user's units.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// s.
    pub contact_radius: f64,
    /// Stable under the control.
    pub stable: bool,
}

impl Nearest {
    /// The state in words.
    pub fn text(&self, units: &UnitSystem) -> String {
        let shown = |quantity, x| with_unit(units, quantity, x, false, |x| significant(x, 5));
        format!(
            "δ {} P {} s {} {}",
            shown(Quantity::Length, self.approach),
            shown(Quantity::Force, self.force),
            shown(Quantity::Length, self.contact_radius),
            if self.stable { "stable" } else { "unstable" }
        )
    }
}

/// The point of the curve nearest to `at`, as seen in a window of these bounds; `None` on a view of something else.
pub fn nearest(subject: &Subject<'_>, view: View, bounds: &Bounds, at: (f64, f64)) -> Option<Nearest> {
    if !view.is_curve() {
        return None;
    }
    let scale = subject.scale();
    let away = |(x, y): (f64, f64)| {
        let share = |[lo, hi]: [f64; 2], by: f64| by / (hi - lo);
        share(bounds.x, x - at.0).hypot(share(bounds.y, y - at.1))
    };
    subject
        .curve
        .points
        .iter()
        .map(|point| Nearest {
            at: scale.place(view, place(point)),
            approach: point.approach,
            force: point.force,
            contact_radius: point.contact_radius,
            stable: point.stable,
        })
        .min_by(|a, b| away(a.at).total_cmp(&away(b.at)))
}

/// Both coordinates of a point in words, with as many digits as a window of these bounds tells apart.
pub fn coordinates(bounds: &Bounds, [x, y]: [&Axis; 2], at: (f64, f64)) -> String {
    /// Places told apart across a window.
    const PLACES: f64 = 1e3;
    let shown = |[lo, hi]: [f64; 2], value: f64| {
        let digits = (lo.abs().max(hi.abs()) / (hi - lo) * PLACES).log10().ceil().clamp(3.0, 16.0);
        // Between 3 and 16.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        significant(value, digits as usize)
    };
    format!("{} {}, {} {}", x.title(), shown(bounds.x, at.0), y.title(), shown(bounds.y, at.1))
}
