//! The line of the loading device: why an instability happens.
//!
//! While its far end is held, the device gives the force P = k(Δ − δ): on the chart of P over δ, a line of slope −k
//! through the walker, vertical for displacement control and horizontal for force control. The contact follows its own
//! curve. Where the curve touches that line, the two have no more states in common on one side, and the edge runs along
//! the line to the next crossing.

use super::model::Model;
use pulloff_engine::problem::Control;

/// The ends (δ, P) of the line through the walker in the user's units; `None` if it is not shown.
///
/// At a limit point of the control it ends at the landing, otherwise where it leaves the range of the curve.
pub fn line(model: &Model) -> Option<[(f64, f64); 2]> {
    let node = model.walker().filter(|node| model.shows_device() && !node.is_apart())?;
    let (curve, control) = (model.curve.as_ref()?, model.control()?);
    let units = node.setting.units();
    let walker = node.state.in_units(units);
    let at = (walker.approach, walker.force);
    let landing = node.ahead.filter(|_| node.is_limit(control)).and_then(|ahead| ahead.after);
    if let Some(landing) = landing {
        let landing = landing.in_units(units);
        return Some([at, (landing.approach, landing.force)]);
    }
    let along = match control {
        Control::Displacement => (0.0, 1.0),
        Control::Force => (1.0, 0.0),
        Control::Stiffness(k) => (1.0, -k * units.stiffness),
    };
    let (mut low, mut high) = (at, at);
    for point in &curve.points {
        low = (low.0.min(point.approach), low.1.min(point.force));
        high = (high.0.max(point.approach), high.1.max(point.force));
    }
    // The distance along the line to each side of the range; a side parallel to the line is never met.
    let sides = [
        (low.0 - at.0, along.0),
        (high.0 - at.0, along.0),
        (low.1 - at.1, along.1),
        (high.1 - at.1, along.1),
    ];
    let met = sides.into_iter().filter(|(_, slope)| *slope != 0.0).map(|(away, slope)| away / slope);
    // The walker is inside: take the nearest side each way. An end at the walker itself counts for both ways.
    let (mut back, mut ahead) = (f64::NEG_INFINITY, f64::INFINITY);
    for t in met {
        if t >= 0.0 {
            ahead = ahead.min(t);
        }
        if t <= 0.0 {
            back = back.max(t);
        }
    }
    let point = |t: f64| (at.0 + t * along.0, at.1 + t * along.1);
    (back.is_finite() && ahead.is_finite()).then(|| [point(back), point(ahead)])
}
