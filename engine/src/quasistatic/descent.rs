//! The way down a solution at a slowly falling control: along it to the next minimum of the control, from there to
//! where the edge lands, and so on.

use super::jump::{self, EdgeDirection, Landing};
use super::monotone::Monotone;
use crate::disc::{Place, Solution};

/// A start this near to a limit point, relative to its radius, has its control value to rounding: comparing values
/// decides nothing there.
const AT_LIMIT: f64 = 3e-8;

/// An end this near to a landing is the landing.
pub const AT_END: f64 = 1e-12;

/// The edge running from a limit point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// The limit point.
    pub before: Place,
    /// The number of the stretch that ends there.
    pub stretch: usize,
    /// Where it lands; `None` where the bodies come apart.
    pub landing: Option<Landing>,
}

/// The way down.
#[derive(Debug, Clone, PartialEq)]
pub struct Descent {
    /// The jumps in order.
    pub jumps: Vec<Jump>,
    /// The stable pieces it follows, each from its outer end to its inner.
    pub pieces: Vec<[Place; 2]>,
    /// The radius below which there is no equilibrium, if that ends the way down.
    pub hole: Option<f64>,
}

impl Descent {
    /// The jumps that land.
    pub fn snaps(&self) -> usize {
        self.jumps.iter().filter(|jump| jump.landing.is_some()).count()
    }

    /// Whether the bodies come apart.
    pub fn pulls_off(&self) -> bool {
        self.jumps.last().is_some_and(|jump| jump.landing.is_none())
    }
}

/// The start at the radius `s`, or at the limit point that it matches to rounding; `None` where it is not stable.
pub fn stable_start(solution: &dyn Solution, monotone: &Monotone, s: f64) -> Option<Landing> {
    let at = monotone.stretch_of(s);
    let stretch = monotone.stretches.get(at)?;
    if stretch.rising {
        let place = if s <= stretch.radii[0] { stretch.inner } else { solution.place(s)? };
        return Some(Landing { place, stretch: at });
    }
    // Just outside a maximum the state is that of the limit point.
    let [maximum, limit] = stretch.radii;
    if stretch.joined && s - maximum <= AT_LIMIT * maximum {
        let inner = at.checked_sub(1)?;
        return Some(Landing { place: monotone.stretches[inner].outer, stretch: inner });
    }
    // Just inside a minimum the next stable state is equally far outside it.
    let outer = monotone.stretches.get(at + 1).filter(|next| next.rising && next.joined)?;
    if limit - s > AT_LIMIT * limit {
        return None;
    }
    let mirrored = (2.0 * limit - s).min(outer.radii[1]);
    let place = if mirrored <= limit { outer.inner } else { solution.place(mirrored)? };
    Some(Landing { place, stretch: at + 1 })
}

/// From the stable state `here` down to the radius `to`.
pub fn descend(solution: &dyn Solution, monotone: &Monotone, mut here: Landing, to: f64) -> Descent {
    let mut descent = Descent { jumps: Vec::new(), pieces: Vec::new(), hole: None };
    loop {
        let stretch = &monotone.stretches[here.stretch];
        let [inner, _] = stretch.radii;
        if inner < to {
            let end = solution.place(to).unwrap_or(stretch.inner);
            descent.pieces.push([here.place, end]);
            return descent;
        }
        descent.pieces.push([here.place, stretch.inner]);
        if !stretch.joined {
            // Without adhesion the disc shrinks to nothing; rings may have no equilibrium further in.
            descent.hole = Some(inner).filter(|inner| *inner > 0.0);
            return descent;
        }
        let landing =
            match jump::run(solution, monotone, here.stretch, stretch.values[0], EdgeDirection::Inward) {
                Ok(landing) => landing,
                Err(hole) => {
                    descent.hole = Some(hole);
                    return descent;
                }
            };
        // At a corner the limit point is that of the side further in.
        let before = here.stretch.checked_sub(1).map_or(stretch.inner, |at| monotone.stretches[at].outer);
        descent.jumps.push(Jump { before, stretch: here.stretch, landing });
        let Some(landing) = landing else { return descent };
        if solution.radius(landing.place) < to * (1.0 - AT_END) {
            descent.pieces.push([landing.place; 2]);
            return descent;
        }
        here = landing;
    }
}
