//! How long a step may be.

use super::branch::Point;
use super::settings::Settings;

/// The factor by which to change a step that turned by `turning` so that it turns as wanted.
pub fn factor(turning: f64, settings: &Settings) -> f64 {
    let wanted = settings.safety * settings.turning;
    if turning > 0.0 { (wanted / turning).clamp(settings.cut, settings.growth) } else { settings.growth }
}

/// The longest step from `point` that no cap forbids.
pub fn longest(point: &Point, settings: &Settings) -> f64 {
    let mut longest = settings.longest;
    for (cap, rate) in settings.largest_increment.iter().zip(point.tangent().as_slice()) {
        longest = longest.min(cap / rate.abs().max(f64::MIN_POSITIVE));
    }
    longest
}

/// Whether the step between two points exceeded a largest increment, with the room a bend may take.
pub fn exceeds_increment(from: &Point, to: &Point, settings: &Settings) -> bool {
    const ROOM: f64 = 1.25;
    let (from, to) = (from.y(), to.y());
    let ends = from.as_slice().iter().zip(to.as_slice());
    ends.zip(&settings.largest_increment).any(|((from, to), cap)| (to - from).abs() > ROOM * cap)
}
