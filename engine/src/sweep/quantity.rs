//! What a sweep can compute of a problem: the table of quantities, one row each.

use super::fault::Fault;
use super::stage::{Cell, CurveMinima, Fitting, OnPath, PresetValues};
use crate::preset::model::BasisSpec;
use crate::preset::{Preset, edge};
use crate::problem::{ContactKind, Control};
use crate::report::pull::RunReport;
use crate::text::{closest, quote};
use crate::units::Quantity;

/// One quantity.
#[derive(Debug)]
pub struct SweepQuantity {
    /// Its name in a spec and in the results.
    pub name: &'static str,
    /// Its symbol in formulas; empty if it has none.
    pub symbol: &'static str,
    /// The kind of quantity that gives its unit.
    pub unit: Quantity,
    /// Its meaning in one line, for tables.
    pub meaning: &'static str,
    /// Whether it is a whole number, which every row has unless it has a fault.
    pub is_count: bool,
    pub(super) of: Stage,
}

/// The unit of a quantity: counts are pure numbers.
macro_rules! unit {
    (Count) => {
        Quantity::Number
    };
    ($unit:ident) => {
        Quantity::$unit
    };
}

/// What a quantity is computed from. Each stage needs all the stages before it, except that the paths need only the
/// curve, the loop only the start, and the fit nothing.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stage {
    Preset(fn(&PresetValues) -> Option<Cell>),
    /// The state at the start: a basis and a search.
    Start(fn(&super::stage::StartState) -> Option<Cell>),
    Curve(fn(&CurveMinima) -> Result<Option<Cell>, Fault>),
    /// The limit points of a control on the curve.
    Limits,
    Unloading(fn(&OnPath) -> Option<Cell>),
    /// What is smallest along the unloading, force or approach, unless it is smaller in a contact larger than its start.
    Least(fn(&OnPath) -> Option<Cell>, Control),
    /// The states passed that are not admissible: finding them takes longer than everything else.
    Passed,
    /// The whole loop of loading and unloading, from energies alone.
    Loop(fn(&OnPath) -> Option<Cell>),
    /// The pull at `path.rate`, or by `path.steps`.
    Pull(fn(&RunReport) -> Option<Cell>),
    /// The fit to the measured curve of the preset.
    Fit(fn(&Fitting) -> Option<Cell>),
}

/// Makes [`QUANTITIES`] from the table: name, symbol, unit or `Count`, meaning, and what it is computed from; or,
/// after `fitted`, the key whose value a fit gives: then its standard error is a quantity too.
macro_rules! quantities {
    ($($name:literal $symbol:literal $unit:ident $meaning:literal $($fitted:ident $key:literal)? $(: $of:expr)?;)*) => {
        /// The quantities.
        pub static QUANTITIES: &[SweepQuantity] = &[$(
            SweepQuantity {
                name: $name, symbol: $symbol, unit: unit!($unit),
                is_count: matches!(stringify!($unit).as_bytes(), b"Count"),
                meaning: concat!(
                    $meaning, $(" ", stringify!($fitted), " to the measured curve; empty where it is not free")?
                ),
                of: $(Stage::Fit(|fit| fit.value($key)))? $($of)?,
            },
            $(SweepQuantity {
                name: concat!($name, "_error"), symbol: "", unit: unit!($unit), is_count: false,
                meaning: "its standard error",
                of: Stage::Fit(|fit| fit.error($key)),
            },)?
        )*];
    };
}

quantities! {
    "largest_pull" "P" Force "smallest force of the unloading from path.start_contact_radius, negative: the largest pull; 0 or empty where nothing pulls":
        Stage::Least(OnPath::largest_pull, Control::Force);
    "farthest" "δ" Length "smallest approach of the unloading": Stage::Least(OnPath::farthest, Control::Displacement);
    "last_contact_force" "P" Force "force at the last contact of the unloading":
        Stage::Unloading(|path| path.last_contact(|state| state.force));
    "last_contact_approach" "δ" Length "approach at the last contact":
        Stage::Unloading(|path| path.last_contact(|state| state.approach));
    "last_contact_radius" "s" Length "contact radius at the last contact":
        Stage::Unloading(|path| path.last_contact(|state| state.contact_radius));
    "snaps" "" Count "jumps inward of the unloading before the last contact": Stage::Unloading(|path| Some(path.snaps()));
    "snap_loss" "" Energy "energy lost in the jumps of the unloading": Stage::Unloading(|path| Some(path.snap_loss()));
    "last_contact_loss" "" Energy "energy lost at the last contact; empty under a dead load":
        Stage::Unloading(OnPath::last_contact_loss);
    "snap_off_approach" "δ" Length "approach at which the zone of adhesion with a range ends; empty for short-range \
                                    adhesion":
        Stage::Unloading(|path| path.snap_off(|state| state.approach));
    "inadmissible_share" "" Number "share of the unloading of one disc, by contact radius, on which the next crest would already touch":
        Stage::Passed;
    "cycle_loss" "" Energy "energy lost in the loop of loading and unloading, in its jumps and in a dead band; empty under a dead load":
        Stage::Loop(OnPath::loss);
    "cycle_largest_pull" "P" Force "smallest force of that loop, negative: its largest pull; 0 or empty where nothing pulls":
        Stage::Loop(OnPath::largest_pull);
    "cycle_snaps" "" Count "jumps inward of that loop before the last contact": Stage::Loop(|whole| Some(whole.snaps()));
    "jump_in_force" "P" Force "force after the jump into the zone of adhesion with a range; empty for short-range \
                               adhesion":
        Stage::Loop(|whole| whole.jump_in(|state| state.force));
    "jump_in_approach" "δ" Length "approach after that jump": Stage::Loop(|whole| whole.jump_in(|state| state.approach));
    "first_touch_force" "P" Force "force after the jump into contact at the first touch":
        Stage::Loop(|whole| whole.first_touch(|state| state.force));
    "first_touch_radius" "s" Length "outermost edge of the contact after that jump":
        Stage::Loop(|whole| whole.first_touch(|state| state.contact_radius));
    "touches" "" Count "crests that touched outside the contact on the way up, after the first touch":
        Stage::Loop(|whole| Some(whole.touches()));
    "rings_at_most" "" Count "most rings of contact at a time in the stable states of the loop, not counting a disc":
        Stage::Loop(|whole| Some(whole.rings_at_most()));
    "contact_share" "" Number "contact area at the turn over that of the circle within its outermost edge":
        Stage::Loop(OnPath::contact_share);
    "peak_force" "P" Force "largest pull at path.rate, or by path.steps, as the least force on the way; empty where it is a compression":
        Stage::Pull(|run| Some(run.peak.force).filter(|force| *force < 0.0).map(Cell::Number));
    "last_contact_time" "t" Time "time of that pull at which the bodies come apart":
        Stage::Pull(|run| run.last_contact.map(|last| Cell::Number(last.time)));
    "dissipated" "" Energy "what the edge dissipates in that pull; empty under a dead load":
        Stage::Pull(|run| run.dissipated.map(Cell::Number));
    "tension_peaks" "" Count "force minima of that pull with a fall and a rise of more than 1 % of P_c":
        Stage::Pull(|run| Some(Cell::Count(run.tension_peaks.len())));
    "top_edge_speed" "v" Speed "largest speed of the edge in the snaps of that pull, or at its peak":
        Stage::Pull(|run| run.top_edge_speed.map(Cell::Number));
    "limit_points" "" Count "limit points of the control on the curve": Stage::Limits;
    "start_contact_radius" "s" Length "contact radius at the start, the largest of the curve":
        Stage::Start(|start| Some(start.contact_radius()));
    "least_force" "P" Force "smallest force of the curve": Stage::Curve(|line| line.least(|s| s.force));
    "least_force_radius" "s" Length "contact radius at the smallest force":
        Stage::Curve(|line| line.least(|s| s.contact_radius));
    "least_approach" "δ" Length "smallest approach of the curve": Stage::Curve(CurveMinima::least_approach);
    "enhancement" "P_min/P_c" Number "smallest force over that of the smooth sphere, P_min/P_c in magnitude":
        Stage::Curve(CurveMinima::enhancement);
    "waves" "s/λ" Number "waves in the disc at the smallest force, s/lambda": Stage::Curve(CurveMinima::waves);
    "critical_force" "P_c" Force "P_c = 3/2 pi gamma R, the pull-off force of the smooth sphere":
        Stage::Preset(PresetValues::critical_force);
    "kesari_lew" "P_min/P_c" Number "estimate (1 + 1/(sqrt(pi) alpha))^2 of the enhancement, good for many waves; \
                                     for several waves the sum, a bound":
        Stage::Preset(PresetValues::kesari_lew);
    "guduru" "P_min/P_c" Number "bound on the enhancement of one disc: Guduru's force with every wave in its worst \
                                 phase":
        Stage::Preset(PresetValues::guduru);
    "johnson" "α" Number "alpha = sqrt(2 gamma lambda/(pi^2 E* A^2))":
        Stage::Preset(|ground| ground.groups.johnson.map(Cell::Number));
    "adhesion" "γ'" Number "gamma' = 2 pi gamma/(E* R)": Stage::Preset(|ground| ground.groups.adhesion.map(Cell::Number));
    "connectivity" "λ²/AR" Number "lambda^2/(A R); above 8.58 the gap rises monotonically":
        Stage::Preset(|ground| ground.groups.connectivity.map(Cell::Number));
    "tabor" "μ" Number "Tabor's mu, where the range of action is known":
        Stage::Preset(|ground| ground.groups.tabor.map(Cell::Number));
    "fitted_modulus" "E*" Stress "effective modulus" fitted "material.effective_modulus";
    "fitted_adhesion" "γ" EnergyPerArea "work of adhesion" fitted "material.work_of_adhesion";
    "fitted_radius" "R" Length "radius of curvature" fitted "gap.radius_of_curvature";
    "fitted_amplitude" "A" Length "amplitude" fitted "gap.amplitude";
    "fitted_wavelength" "λ" Length "wavelength" fitted "gap.wavelength";
    "fitted_stiffness" "k" ForcePerLength "stiffness of the device" fitted "path.control.stiffness";
    "fitted_offset" "δ₀" Length "offset of x" fitted "data.offset";
    "fitted_baseline" "P₀" Force "baseline of the force" fitted "data.baseline";
    "fitted_tilt" "" ForcePerLength "tilt of the baseline" fitted "data.tilt";
    "fit_chi_squared" "" Number "chi squared per degree of freedom of the fit": Stage::Fit(|fit| Some(fit.chi_squared()));
    "fit_outliers" "" Count "points far from the fitted curve": Stage::Fit(|fit| Some(fit.outliers()));
    "fit_verdict" "" Count "0 where the model describes the points, 4 where it does not; then no value can be \
                             trusted":
        Stage::Fit(|fit| Some(fit.verdict()));
    "fit_warnings" "" Count "number of reasons and warnings of the fit; pulloff fit lists them":
        Stage::Fit(|fit| Some(fit.warnings()));
}

/// The quantities of a spec that does not name any.
pub const USUAL: [&str; 6] =
    ["last_contact_force", "last_contact_approach", "snaps", "enhancement", "waves", "kesari_lew"];

/// The control under which a quantity is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Under {
    /// The preset's own, `path.control`.
    Own,
    /// Fixed grips.
    Displacement,
    /// A dead load.
    Force,
}

impl Under {
    /// All of them, each with its suffix to the name of a quantity.
    const ALL: [(Self, &'static str); 3] =
        [(Self::Own, ""), (Self::Displacement, "_displacement"), (Self::Force, "_force")];

    /// The control itself; `own` is that of the preset.
    pub fn control(self, own: Control) -> Control {
        match self {
            Self::Own => own,
            Self::Displacement => Control::Displacement,
            Self::Force => Control::Force,
        }
    }
}

/// A wanted quantity: a column of the results.
#[derive(Debug, Clone, Copy)]
pub struct QuantityColumn {
    /// The quantity.
    pub quantity: &'static SweepQuantity,
    /// The control it is wanted under, where that matters.
    pub under: Under,
}

impl PartialEq for QuantityColumn {
    fn eq(&self, other: &Self) -> bool {
        (self.quantity.name, self.under) == (other.quantity.name, other.under)
    }
}

impl SweepQuantity {
    /// Whether it depends on the control. Then `NAME` is under the preset's own, and `NAME_displacement` and
    /// `NAME_force` are under these two.
    pub fn is_of_control(&self) -> bool {
        matches!(
            self.of,
            Stage::Limits | Stage::Unloading(_) | Stage::Least(..) | Stage::Passed | Stage::Loop(_)
        )
    }

    /// Its columns, one under each control that matters.
    pub fn columns(&'static self) -> impl Iterator<Item = QuantityColumn> {
        let last = if self.is_of_control() { Under::ALL.len() } else { 1 };
        Under::ALL[..last].iter().map(move |(under, _)| QuantityColumn { quantity: self, under: *under })
    }
}

impl QuantityColumn {
    /// Whether it is of the unloading from the start, whatever the loop of the preset is.
    pub(super) fn is_of_unloading(&self) -> bool {
        matches!(self.quantity.of, Stage::Unloading(_) | Stage::Least(..))
    }

    /// Whether it is of an infinitely slow path and `key` of the edge's speed, so that it does not depend on it.
    pub fn is_blind_to(&self, key: &str) -> bool {
        let is_of_speed = edge::KEYS.contains(&key) && key != edge::CLOSING_ADHESION;
        is_of_speed && !matches!(self.quantity.of, Stage::Pull(_) | Stage::Fit(_))
    }

    /// Whether it is of an unloading of one disc, in problems like `preset`: whether its states are admissible is not
    /// looked for, which takes far longer.
    pub fn is_unchecked(&self, preset: &Preset) -> bool {
        let is_one_disc = preset.basis != BasisSpec::Exact || preset.path.contact == ContactKind::OneDisc;
        is_one_disc && self.is_of_unloading()
    }
}

/// The name of the quantity that may be meant by "pull-off", a word used for several things: the force at the last
/// contact, and the largest pull.
fn renamed(name: &str) -> Option<String> {
    name.strip_prefix("pull_off_").map(|rest| format!("last_contact_{rest}")).filter(|now| {
        let all = QUANTITIES.iter().flat_map(SweepQuantity::columns);
        all.into_iter().any(|column| column.name() == *now)
    })
}

impl QuantityColumn {
    /// The column with this name.
    ///
    /// # Errors
    /// What is wrong with the name, and the name that was probably meant.
    pub fn named(name: &str) -> Result<Self, String> {
        let all = || QUANTITIES.iter().flat_map(SweepQuantity::columns);
        all().find(|column| column.name() == name).ok_or_else(|| {
            let names: Vec<String> = all().map(|column| column.name()).collect();
            let meant = closest(name, names.iter().map(String::as_str));
            let hint = match (renamed(name), meant) {
                (Some(now), _) => format!("; it is {now}"),
                (None, Some(meant)) => format!("; did you mean {meant}?"),
                (None, None) => String::new(),
            };
            format!("no quantity is called \"{}\"{hint}", quote(name))
        })
    }

    /// Its name: that of the quantity, followed by the control.
    pub fn name(&self) -> String {
        let suffix = Under::ALL.iter().find(|(under, _)| *under == self.under).map_or("", |(_, name)| *name);
        format!("{}{suffix}", self.quantity.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_a_column_and_a_wrong_one_is_put_right() {
        for column in QUANTITIES.iter().flat_map(SweepQuantity::columns) {
            assert_eq!(QuantityColumn::named(&column.name()), Ok(column));
            assert!(column.quantity.meaning.is_ascii());
        }
        assert!(USUAL.iter().all(|name| QuantityColumn::named(name).is_ok()));
        assert_eq!(QuantityColumn::named("snaps_force").unwrap().under, Under::Force);
        for (wrong, message) in [
            ("largest_pul", "no quantity is called \"largest_pul\"; did you mean largest_pull?"),
            ("pull_off_force", "no quantity is called \"pull_off_force\"; it is last_contact_force"),
            (
                "pull_off_loss_force",
                "no quantity is called \"pull_off_loss_force\"; it is last_contact_loss_force",
            ),
            ("snap", "no quantity is called \"snap\"; did you mean snaps?"),
            ("enhancement_force", "no quantity is called \"enhancement_force\"; did you mean enhancement?"),
            ("x\u{1b}", "no quantity is called \"x\u{fffd}\""),
        ] {
            assert_eq!(QuantityColumn::named(wrong).unwrap_err(), message);
        }
    }
}
