//! Figures of a curve, a walk and a state, for any renderer.
//!
//! A [`Figure`] is lines, marks and areas in axis values, each with a role; strokes, letters and colours are the
//! renderer's. Every figure is built by a pure function from a [`Subject`]; nothing is solved here.
//!
//! | file | what lives there |
//! |---|---|
//! | [`parts`] | lines, marks, areas, axes and their roles |
//! | [`bounds`] | the range of both axes, always finite and ascending |
//! | [`scale`] | what the axes are divided by |
//! | [`curves`] | P over δ, s over P, s over δ |
//! | [`walk`] | the states walked, the jumps, the walker |
//! | [`unloading`] | the quasi-static path with what it dissipates, Fig. 10 |
//! | [`state`] | pressure, gap and potential of the walker's state |
//! | [`shape`] | the undeformed gap of a preset, to choose a shape by |
//! | [`reading`] | what a point of a figure means: the cross-hair's coordinates, the state near to it |

pub mod bounds;
pub mod curves;
pub mod parts;
pub mod reading;
pub mod scale;
pub mod shape;
pub mod state;
pub mod unloading;
pub mod walk;

pub use crate::explorer::View;
pub use bounds::Bounds;
pub use parts::{Area, Axis, Figure, Line, Mark, Role, Sign};
pub use reading::{Nearest, nearest};
pub use scale::Scale;

use crate::explorer::branches::{Branch, branches};
use crate::explorer::model::is_on_curve;
use crate::explorer::pins::{Pin, name_among};
use crate::explorer::profile::Inside;
use crate::explorer::{Axes, CurveData, Model, Node, Overlays, device};
use pulloff_engine::preset::Preset;

/// What figures are built from.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    /// The curve with its theory and its path.
    pub curve: &'a CurveData,
    /// The states that led to the walker, which is the last.
    pub walk: Vec<&'a Node>,
    /// The other branches of the walk.
    pub branches: Vec<Branch<'a>>,
    /// The inside of the walker's state, where it is known.
    pub inside: Option<&'a Inside>,
    /// The ends (δ, P) of the line of the loading device through the walker, where it is shown.
    pub device: Option<[(f64, f64); 2]>,
    /// The curves to compare with.
    pub pins: &'a [Pin],
    /// The preset by which the pins are named.
    pub preset: &'a Preset,
    /// The theory to draw.
    pub overlays: Overlays,
    /// What the axes are divided by.
    pub axes: Axes,
}

impl<'a> Subject<'a> {
    /// What is on the screen of a session; `None` before its first curve.
    pub fn of(model: &'a Model) -> Option<Self> {
        Some(Self {
            curve: model.curve.as_deref()?,
            walk: model.history.path().into_iter().map(|(_, node)| node).collect(),
            branches: branches(&model.history).into_iter().filter(|branch| !branch.is_here).collect(),
            inside: model.shown_profile(),
            device: device::line(model),
            pins: model.pins.all(),
            preset: &model.preset,
            overlays: model.overlays,
            axes: model.axes,
        })
    }

    /// A curve nobody walks on, with its theory.
    pub fn alone(curve: &'a CurveData, overlays: Overlays) -> Self {
        Self {
            curve,
            walk: Vec::new(),
            branches: Vec::new(),
            inside: None,
            device: None,
            pins: &[],
            preset: &curve.setting.preset,
            overlays,
            axes: Axes::Reduced,
        }
    }

    /// The figure of `view`.
    pub fn figure(&self, view: View) -> Figure {
        match view {
            View::ForceApproach | View::RadiusForce | View::RadiusApproach => curves::figure(self, view),
            View::Unloading => unloading::figure(self),
            View::Pressure | View::Gap | View::Energy => state::figure(self, view),
        }
    }

    /// The divisors of the axes.
    pub fn scale(&self) -> Scale<'a> {
        Scale::of(self.curve, self.axes)
    }

    /// What tells the curve from the pinned ones beside it, named as they are; `None` without any.
    pub fn own_name(&self) -> Option<String> {
        name_among(&self.curve.setting.preset, self.pins)
    }

    /// Whether a state solves the problem of the curve.
    pub fn is_on_curve(&self, node: &Node) -> bool {
        is_on_curve(self.curve, node)
    }
}

#[cfg(test)]
mod tests;
