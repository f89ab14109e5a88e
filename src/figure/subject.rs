//! What figures are built from.

use super::measured::MeasuredMarks;
use super::scale::Scale;
use crate::explorer::branches::{WalkBranch, branches};
use crate::explorer::fitting::Distances;
use crate::explorer::model::is_on_curve;
use crate::explorer::pins::{Pin, name_among};
use crate::explorer::profile::StateInside;
use crate::explorer::pulls::PullData;
use crate::explorer::speeds::SpeedsData;
use crate::explorer::studies::StudyData;
use crate::explorer::study::study_range;
use crate::explorer::{Axes, CurveData, Model, Node, Overlays, View, device};
use pulloff_engine::fit::residuals::Residual;
use pulloff_engine::measured::Abscissa;
use pulloff_engine::preset::{BasisSpec, Preset};
use pulloff_engine::report::{MapReport, PathReport};

/// What figures are built from.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    pub curve: &'a CurveData,
    /// The states that led to the walker, which is the last of them.
    pub walk: Vec<&'a Node>,
    pub branches: Vec<WalkBranch<'a>>,
    /// The interior of the walker's state, where it is known.
    pub inside: Option<&'a StateInside>,
    /// The ends (δ, P) of the line of the loading device through the walker, where it is shown.
    pub device: Option<[(f64, f64); 2]>,
    /// The path of the device from its start, where there is one.
    pub path: Option<&'a PathReport>,
    /// The loop of loading and unloading, where there is one.
    pub cycle: Option<&'a PathReport>,
    /// The pull at the rate of the preset, where there is one.
    pub pull: Option<&'a PullData>,
    /// The map of two parameters, or why there is none, where it is known.
    pub map: Option<Result<&'a MapReport, &'a str>>,
    /// The number of the selected event on the path.
    pub event: Option<usize>,
    /// The measured points, where there are any.
    pub measured: Option<MeasuredMarks>,
    /// Their distances from the curve, or why there are none, where they are known.
    pub distances: Option<&'a Result<(Abscissa, Vec<Residual>), String>>,
    /// Their energy release rate and the speed of the edge, where they are known.
    pub speeds: Option<&'a SpeedsData>,
    /// The study of the selected value, or why there is none, where it is known.
    pub study: Option<Result<&'a StudyData, String>>,
    /// The pinned curves on the same axes.
    pub pins: Vec<&'a Pin>,
    /// The numbers of those in other units.
    pub other_pins: Vec<usize>,
    pub preset: &'a Preset,
    /// The theory to draw.
    pub overlays: Overlays,
    /// What the axes are divided by.
    pub axes: Axes,
}

impl<'a> Subject<'a> {
    /// What the screen of a session shows; `None` before its first curve.
    pub fn of(model: &'a Model) -> Option<Self> {
        let (pins, other_pins) = model.pins.beside(&model.preset);
        Some(Self {
            curve: model.curve.as_deref()?,
            walk: model.history.path().into_iter().map(|(_, node)| node).collect(),
            branches: branches(&model.history).into_iter().filter(|branch| !branch.is_here).collect(),
            inside: model.shown_profile(),
            device: device::line(model),
            path: model.path(),
            cycle: model.cycle().and_then(|cycle| cycle.report()),
            pull: model.pull(),
            map: model.map(),
            event: model.log().entries.get(model.event).and_then(|entry| entry.number),
            measured: MeasuredMarks::of(&model.preset).and_then(Result::ok),
            distances: model.results.found::<Distances>().map(|distances| &distances.found),
            speeds: model.results.found(),
            study: study(model),
            pins,
            other_pins,
            preset: &model.preset,
            overlays: model.overlays,
            axes: model.axes,
        })
    }

    /// A curve without a walk, with its theory.
    pub fn alone(curve: &'a CurveData, overlays: Overlays) -> Self {
        Self {
            curve,
            walk: Vec::new(),
            branches: Vec::new(),
            inside: None,
            device: None,
            path: curve.report.as_ref(),
            cycle: None,
            pull: None,
            map: None,
            event: None,
            measured: None,
            distances: None,
            speeds: None,
            study: None,
            pins: Vec::new(),
            other_pins: Vec::new(),
            preset: &curve.setting.preset,
            overlays,
            axes: Axes::Reduced,
        }
    }

    /// The divisors of the axes.
    pub fn scale(&self) -> Scale<'a> {
        Scale::of(self.curve, self.axes)
    }

    /// Whether the view shows one disc of the exact equation: the preset's elements are not rings, and neither are the
    /// walker's contacts.
    pub fn is_one_disc(&self) -> bool {
        self.preset.basis == BasisSpec::Exact && !self.walk.last().is_some_and(|node| node.has_rings())
    }

    /// A name that distinguishes the curve from the pinned ones beside it, in their style; `None` without any.
    pub fn own_name(&self) -> Option<String> {
        name_among(&self.curve.setting.preset, &self.pins)
    }

    /// Whether a state solves the problem of this curve.
    pub fn is_on_curve(&self, node: &Node) -> bool {
        is_on_curve(self.curve, node)
    }
}

/// The study of the selected value, where the view is on the screen; while it is being computed, that of the previous values.
fn study(model: &Model) -> Option<Result<&StudyData, String>> {
    if !model.shown_views().contains(&View::Study) {
        return None;
    }
    match study_range(model) {
        Err(why) => Some(Err(why)),
        Ok((key, _)) => {
            let is_it = |study: &&StudyData| study.wish.key == key && study.wish.column == model.studied;
            model.results.found::<StudyData>().filter(is_it).map(Ok)
        }
    }
}
