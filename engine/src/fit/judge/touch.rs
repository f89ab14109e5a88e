//! Whether the bodies pull before they touch: at an edge without a range the first contact is at δ = 0, and the force before it is that of
//! bodies apart.
//!
//! A median of m rows is known to 1.2533 s/√m; a deviation beyond five of these is not chance.

use super::super::problem::Target;
use super::super::verdict::Reason;
use super::{Evidence, ROUNDING};
use crate::measured::branches::median;
use crate::measured::{Abscissa, Segment};
use crate::units::Quantity;
use crate::units::number::{said, short};

/// The fewest rows that pull.
const FEWEST: usize = 2;
/// The standard error of a median, in units of that of a mean.
const OF_MEDIAN: f64 = 1.2533;
/// Errors of the force beyond which it is not chance, and errors of the place of the first touch.
const NO_CHANCE: f64 = 5.0;
const BEFORE: f64 = 3.0;

/// Rows of an approach that pull where the model has the bodies apart.
pub(super) fn of_touch(Evidence { problem, solved, scatter, inner }: Evidence) -> Option<Reason> {
    if problem.abscissa == Abscissa::Radius {
        return None;
    }
    let s = scatter.contact?.max(solved.scale).max(ROUNDING);
    let instrument = problem.instrument_at(&solved.minimum.parameters);
    let offset = problem.parameters.iter().position(|parameter| parameter.target == Target::Offset);
    let error = offset.zip(inner).map_or(0.0, |(j, inner)| {
        s * inner[(j, j)].max(0.0).sqrt() * problem.parameters[j].scale.unwrap_or(0.0)
    });
    let margin = BEFORE * (error + problem.sigma[0]);
    let apart = |x: f64| instrument.offset - x;
    let of_branch = |branch: usize| -> Option<Reason> {
        let of = |free: bool| {
            problem.data.iter().filter(move |datum| {
                datum.branch == branch && datum.free == free && datum.segment == Segment::Approach
            })
        };
        // An approach that begins in contact has touched before.
        of(true).next()?;
        let early: Vec<_> = of(false).filter(|datum| apart(datum.point.x) > margin).collect();
        if early.len() < FEWEST {
            return None;
        }
        let force = |x: f64, force: f64| force - instrument.baseline - instrument.tilt * x;
        let pull = median(early.iter().map(|datum| force(datum.point.x, datum.point.force)).collect())?;
        let count = early.len() as f64 / scatter.correlation.rows();
        let t = pull / (OF_MEDIAN * s * problem.sigma[1] / count.max(1.0).sqrt());
        let most = early.iter().map(|datum| apart(datum.point.x)).fold(0.0, f64::max);
        let units = &problem.preset.units;
        (t < -NO_CHANCE).then(|| {
            let sentence = format!(
                "on the approach the bodies attract before they touch: {} rows, up to {} before the first \
                 contact of the model, have the force {} ({} standard errors). The adhesion has a range, or \
                 the force lags",
                early.len(),
                said(units, Quantity::Length, most),
                said(units, Quantity::Force, pull),
                short(t.abs(), 2)
            );
            Reason::new("touch", t, sentence)
        })
    };
    (0..problem.branches()).find_map(of_branch)
}
