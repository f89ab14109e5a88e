//! The problem that a state of the walk solves.

use pulloff_engine::preset::{BasisSpec, Preset};
use pulloff_engine::problem::{Begin, Control, Reduced, Units};
use pulloff_engine::quasistatic::Scales;
use pulloff_engine::units::UnitSystem;

/// The problem a node was solved in: the parameters may change from node to node.
///
/// Its basis is not here. It belongs to the curve, which is computed anew when the walker comes back to the problem:
/// so a long walk through many problems stays small, and a saved one is read without computing any of them.
#[derive(Debug, Clone)]
pub struct Setting {
    pub preset: Preset,
    /// The problem in reduced units.
    pub reduced: Reduced,
    /// What is controlled, in reduced units.
    pub control: Control,
    /// The units of the unknowns: those of the curve on which the nodes lie.
    pub scales: Scales,
}

impl Setting {
    /// The problem of `preset` on a curve with these scales.
    pub fn new(preset: Preset, scales: Scales) -> Self {
        let reduced = preset.reduced();
        let control = preset.path.control.in_units(reduced.units.stiffness);
        Self { preset, reduced, control, scales }
    }

    /// The same problem with its numbers shown in `units`.
    #[must_use]
    pub fn shown_in(&self, units: &UnitSystem) -> Self {
        let mut preset = self.preset.clone();
        preset.units = units.clone();
        Self { preset, ..self.clone() }
    }

    /// The factors to the user's units.
    pub fn units(&self) -> &Units {
        &self.reduced.units
    }

    /// A control in the user's units.
    pub fn shown_control(&self, control: Control) -> Control {
        control.as_given(self.units().stiffness)
    }
}

/// Whether two presets have the same equilibrium curve: material, gap, basis, start and end are equal.
pub(super) fn same_curve(a: &Preset, b: &Preset) -> bool {
    let closing = |preset: &Preset| preset.edge.closing_work_of_adhesion;
    (a.material, closing(a), &a.gap, basis(a), a.path.start, a.path.end_contact_radius)
        == (b.material, closing(b), &b.gap, basis(b), b.path.start, b.path.end_contact_radius)
}

/// The basis in which a preset is walked: a loop has no ring elements, as everywhere.
pub(super) fn basis(preset: &Preset) -> BasisSpec {
    if preset.path.begin == Begin::Apart { BasisSpec::Exact } else { preset.basis }
}
