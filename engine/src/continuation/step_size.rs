//! How far a step turned, and how long the next one may be.

use super::branch::Point;
use super::settings::Settings;
use super::system::Vector;

/// The turning of the step between two points, radians.
///
/// The larger of (i) the angle from the first tangent to the chord plus that from the chord to the second
/// tangent, because end tangents alone miss a whole S-bend, and (ii) the mean curvature times the
/// length, because it warns before the bend.
pub fn turning<const N: usize>(from: &Point<N>, to: &Point<N>) -> f64 {
    let chord = to.y - from.y;
    let length = chord.norm();
    let angle = |a: &Vector<N>, b: &Vector<N>| {
        // atan2 of the difference and sum: exact for small angles, where acos loses half the digits.
        let (a, b) = (a.normalize(), b.normalize());
        2.0 * (a - b).norm().atan2((a + b).norm())
    };
    let bends = angle(&from.frame.tangent, &chord) + angle(&chord, &to.frame.tangent);
    let arc = 0.5 * (from.frame.curvature.norm() + to.frame.curvature.norm()) * length;
    bends.max(arc)
}

/// The factor by which a step that turned by `turning` would have turned as wanted.
pub fn factor(turning: f64, settings: &Settings) -> f64 {
    let wanted = settings.safety * settings.turning;
    if turning > 0.0 { (wanted / turning).clamp(settings.cut, settings.growth) } else { settings.growth }
}

/// The longest step from `point` that no cap forbids.
pub fn longest<const N: usize>(point: &Point<N>, settings: &Settings) -> f64 {
    let mut longest = settings.longest;
    for (cap, rate) in settings.largest_increment.iter().zip(point.frame.tangent.iter()) {
        longest = longest.min(cap / rate.abs().max(f64::MIN_POSITIVE));
    }
    longest
}

/// Whether the step between two points exceeded a largest increment, with the room a bend may take.
pub fn exceeds_increment<const N: usize>(from: &Point<N>, to: &Point<N>, settings: &Settings) -> bool {
    const ROOM: f64 = 1.25;
    (to.y - from.y).iter().zip(&settings.largest_increment).any(|(change, cap)| change.abs() > ROOM * cap)
}
