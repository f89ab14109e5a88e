//! Figures of a curve, a walk and a state, for any renderer.
//!
//! A [`Figure`] is lines, marks and areas in axis values, each with a role; the renderer chooses strokes, letters and
//! colours. Every figure is built by a pure function from a [`Subject`]; nothing is solved here.
//!
//! | file | what lives there |
//! |---|---|
//! | [`parts`] | lines, marks, areas, axes and their roles |
//! | [`bounds`] | the range of both axes, always finite and ascending |
//! | [`range`] | the part of an axis to show |
//! | [`scale`] | what the axes are divided by |
//! | [`curves`] | P over δ and Δ, P over s, s over δ |
//! | [`walk`] | the states walked, the jumps, the walker |
//! | [`unloading`] | the quasi-static path with what it dissipates, Fig. 10 |
//! | [`loops`] | the whole loop of loading and unloading, with what it dissipates |
//! | [`pull`] | the pull at a rate over the curve, and P over time |
//! | [`contact_map`] | the contacts over the travel of the control |
//! | [`differences`] | P minus that of the other curves |
//! | [`stability`] | the law of stability over the contact radius |
//! | `labels` | the placement of the labels of a map |
//! | [`places`] | the positions of numbers on an axis of a map |
//! | [`map`] | lines of a map of two parameters, limit points over one |
//! | [`study`] | a quantity over the range of one value |
//! | [`state`] | pressure, gap and potential of the walker's state |
//! | `contact` | the contact of that state from above |
//! | [`measured`] | measured points behind a curve |
//! | [`residuals`] | the distances of those points from it |
//! | [`speeds`] | their energy release rate over the speed of the edge |
//! | [`shape`] | the undeformed gap of a preset, for choosing a shape |
//! | [`reading`] | what a point of a figure means: the cross-hair's coordinates, the nearest state |

pub mod bounds;
mod contact;
pub mod contact_map;
pub mod curves;
pub mod differences;
mod labels;
pub mod loops;
pub mod map;
pub mod measured;
pub mod parts;
pub mod places;
pub mod pull;
pub mod range;
pub mod reading;
pub mod residuals;
pub mod scale;
pub mod shape;
pub mod speeds;
pub mod stability;
pub mod state;
pub mod study;
mod subject;
pub mod unloading;
pub mod walk;

pub use crate::explorer::View;
pub use bounds::Bounds;
pub use parts::{Area, Axis, AxisScale, Figure, Line, Mark, Meaning, Role, Sign};
pub use range::Range;
pub use reading::{NearestState, nearest};
pub use scale::Scale;
pub use subject::Subject;

impl Subject<'_> {
    /// The figure of `view`.
    pub fn figure(&self, view: View) -> Figure {
        let mut figure = match view {
            View::ForceApproach | View::ForcePosition | View::ForceRadius | View::RadiusApproach => {
                curves::figure(self, view)
            }
            View::Unloading => unloading::figure(self),
            View::Cycle => loops::figure(self),
            View::ForceTime => pull::figure(self),
            View::ContactMap => contact_map::figure(self),
            View::Stability => stability::figure(self),
            View::Map => stability::map(self),
            View::Residuals => residuals::figure(self),
            View::Speeds => speeds::figure(self),
            View::Differences => differences::figure(self),
            View::Walk => walk::table(),
            View::Study => study::figure(self),
            View::Pressure | View::Gap | View::Contact | View::Energy => state::figure(self, view),
        };
        if let Some(points) = &self.measured {
            points.lay(view, &mut figure, self.scale());
        }
        figure
    }
}

#[cfg(test)]
mod tests;
