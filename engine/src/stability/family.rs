//! A preset with one or two of its numbers left open: the lines of a map are looked for in such a family.
//!
//! How a number enters decides what it costs. The work of adhesion and the device do not change the table of g. Where
//! the gap is linear in a number (a wave's amplitude), so is g, and two tables give it for all values. Any other number
//! needs the table of its own gap at each value.

use super::axis::{COMPLIANCE, MapAxis, is_blind, set_by};
use super::law::{EdgeJet, Law, root_of};
use crate::disc::blend::Blend;
use crate::disc::table::KeptTables;
use crate::disc::{ExactBasis, Panels, Table, TableError, waves};
use crate::gap::{Form, Gap, Shape, Wave};
use crate::preset::groups::are_rivals;
use crate::preset::{Invalid, Preset};
use crate::problem::{Control, Reduced, Start, Units};
use crate::progress::{Stopped, Unwatched};
use crate::quasistatic::monotone::weighted;
use crate::quasistatic::start::{StartError, contact_radius, end_contact_radius};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The values of the numbers left open, as shares of their axes.
pub type AxisShares<'a> = &'a [f64];

/// How a number enters.
#[derive(Debug, Clone, Copy, PartialEq)]
enum NumberRole {
    /// The reduced work of adhesion is the number times this factor.
    Adhesion(f64),
    /// It is the compliance of the device.
    Device,
    /// h is linear in it.
    Linear,
    /// In some other way.
    Other,
}

/// Number of radii at which a gap is tested for linearity in a number, and the difference that counts as rounding.
const ASKED: u32 = 24;
const ROUNDING: f64 = 1e-13;

/// A preset with numbers left open.
#[derive(Debug)]
pub struct Family {
    /// The preset.
    pub preset: Preset,
    /// The numbers left open, one or two.
    pub axes: Vec<MapAxis>,
    roles: Vec<NumberRole>,
    /// The unit of length, the same for all members.
    pub length: f64,
    /// The tables of the gaps at both ends of the number that enters linearly; for two such numbers at all four
    /// corners, the second number varying more slowly.
    ends: Vec<Arc<Table>>,
    /// What the gaps of all members are mixtures of, where that costs less than a table for each.
    blend: Option<Arc<Blend>>,
    /// The table of the gap, if no axis changes it.
    own: Option<Arc<Table>>,
    kept: KeptTables<Shape>,
    /// The preset as given.
    base: Arc<MemberCase>,
    /// The last members made, keyed by the bits of the numbers that change their gaps.
    made: Mutex<Vec<(Vec<u64>, Arc<MemberCase>)>>,
    /// The contact radii between which lines are looked for, reduced: the end and the start of the preset's path, or,
    /// once they are known, the smallest and the largest radius of all paths.
    pub radii: [f64; 2],
}

/// Members kept: the difference quotients at one place need three gaps.
const KEPT: usize = 4;

/// A preset with the gap of a member, and what follows from it; numbers that do not change the gap are not set.
#[derive(Debug)]
struct MemberCase {
    preset: Preset,
    reduced: Reduced,
    table: OnceLock<Arc<Table>>,
}

impl MemberCase {
    fn of(preset: Preset, length: f64) -> Arc<Self> {
        let reduced = preset.problem().reduced_by(length);
        Arc::new(Self { preset, reduced, table: OnceLock::new() })
    }
}

/// Why there is no family.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FamilyError {
    /// The preset does not allow a value.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// A gap cannot be tabulated.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The start state does not exist.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The result was no longer wanted.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// The key holds no number.
    #[error("{0}: an axis of a map must be a real number of the preset, a group, or compliance")]
    NoNumber(String),
    /// The key changes no state of the family.
    #[error(
        "{0}: it changes nothing on a map, whose states are the equilibria of one disc with an opening edge"
    )]
    Blind(String),
    /// The gap is too fine at an end of an axis.
    #[error(
        "{axis}: at {value:?} the disc at the start holds {count} waves; a map takes at most {MOST_FEATURES}"
    )]
    TooFine {
        /// The axis.
        axis: String,
        /// The value there, in base units.
        value: f64,
        /// How many waves, or features, the disc holds.
        count: f64,
    },
    /// Both axes give the same thing.
    #[error("{0} and {1} give the same value: the two axes of a map must be different keys")]
    Rivals(String, String),
}

/// Most waves, or other features of the gap, in the disc at the start: with more, a map would take minutes.
const MOST_FEATURES: f64 = 3000.0;

/// What the law needs to know of one state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalLaw {
    /// F with its derivatives.
    pub edge: EdgeJet,
    /// √(πγ/2): the state is a limit point where F equals it.
    pub root: f64,
    /// g.
    pub transform: f64,
    /// ∫g.
    pub area: f64,
    /// g'.
    pub slope: f64,
    /// s.
    pub contact_radius: f64,
    /// The device.
    pub control: Control,
}

impl LocalLaw {
    /// δ.
    pub fn approach(&self) -> f64 {
        self.transform - 2.0 * self.root * self.contact_radius.sqrt()
    }

    /// P.
    pub fn force(&self) -> f64 {
        2.0 * (self.approach() * self.contact_radius - self.area)
    }

    /// The weighted control.
    pub fn control_value(&self) -> f64 {
        weighted(self.control, self.approach(), self.force())
    }

    /// dδ/ds and dP/ds.
    pub fn slopes(&self) -> [f64; 2] {
        let s = self.contact_radius;
        [self.slope - self.root / s.sqrt(), 2.0 * (s * self.slope - 3.0 * self.root * s.sqrt())]
    }
}

impl Family {
    /// The family of `preset` along these axes.
    ///
    /// # Errors
    /// [`FamilyError`].
    pub fn new(preset: &Preset, axes: Vec<MapAxis>) -> Result<Self, FamilyError> {
        for (k, axis) in axes.iter().enumerate() {
            let are_rivals = |other: &&MapAxis| are_rivals(set_by(&other.key), set_by(&axis.key));
            if let Some(other) = axes[..k].iter().find(are_rivals) {
                return Err(FamilyError::Rivals(other.key.clone(), axis.key.clone()));
            }
            let number = |preset: &Preset| {
                preset.row(&axis.key).is_some_and(|row| row.kind.is_number())
                    && preset.get(&axis.key).is_none_or(|value| value.as_number().is_some())
            };
            if axis.key != COMPLIANCE && !number(preset) {
                // An unknown key is reported as such, with the nearest name.
                if preset.row(&axis.key).is_none() {
                    preset.clone().set(&axis.key, 1.0.into())?;
                }
                return Err(FamilyError::NoNumber(axis.key.clone()));
            }
            if is_blind(&axis.key) {
                return Err(FamilyError::Blind(axis.key.clone()));
            }
            if axis.key != COMPLIANCE {
                for end in axis.range {
                    preset.resolved(&axis.key, end.into())?;
                }
            }
        }
        let length = preset.reduced().units.length;
        let mut family = Self {
            preset: preset.clone(),
            axes,
            roles: Vec::new(),
            length,
            ends: Vec::new(),
            blend: None,
            own: None,
            kept: Mutex::default(),
            base: MemberCase::of(preset.clone(), length),
            made: Mutex::default(),
            radii: [0.0; 2],
        };
        family.roles = family.axes.iter().map(|axis| family.role(axis)).collect::<Result<_, _>>()?;
        let others = family.roles.contains(&NumberRole::Other);
        if family.roles.contains(&NumberRole::Linear) {
            if others {
                for role in family.roles.iter_mut().filter(|role| **role == NumberRole::Linear) {
                    *role = NumberRole::Other;
                }
            } else {
                family.blend = family.corners()?;
            }
        } else if !others {
            family.own = Some(family.table(&family.base)?);
        }
        let start = family.start_of(&family.base, family.base.reduced.work_of_adhesion)?;
        family.radii = [family.end_of(&family.base, start)?, start];
        family.check_features()?;
        Ok(family)
    }

    /// Tabulates the gaps at the ends of the numbers that enter linearly; returns their blend for all members, where it
    /// is worthwhile.
    fn corners(&mut self) -> Result<Option<Arc<Blend>>, FamilyError> {
        let linear: Vec<&MapAxis> = (0..self.axes.len())
            .filter(|k| self.roles[*k] == NumberRole::Linear)
            .map(|k| &self.axes[k])
            .collect();
        let mut corners: Vec<Vec<(&MapAxis, f64)>> = vec![Vec::new()];
        for axis in linear {
            let with =
                |value: f64| corners.iter().map(move |corner| [&corner[..], &[(axis, value)]].concat());
            corners = axis.range.into_iter().flat_map(with).collect();
        }
        let made: Vec<Arc<MemberCase>> = corners
            .iter()
            .map(|corner| Ok(MemberCase::of(self.with(corner)?, self.length)))
            .collect::<Result<_, Invalid>>()?;
        let blend = Blend::of(made.iter().map(|made| Arc::clone(&made.reduced.gap)).collect());
        let tables: Result<_, TableError> = made.iter().map(|made| self.table(made)).collect();
        self.ends = tables?;
        Ok(blend.map(Arc::new))
    }

    /// The weights of the corners at given values of the numbers left open.
    fn weights(&self, value: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let mut weights = vec![1.0];
        for k in (0..self.axes.len()).filter(|k| self.roles[*k] == NumberRole::Linear) {
            let [from, to] = self.axes[k].range;
            let share = (value(k) - from) / (to - from);
            weights =
                [1.0 - share, share].iter().flat_map(|by| weights.iter().map(move |w| w * by)).collect();
        }
        weights
    }

    /// Refuses an axis on which the gap becomes too fine to be tabulated over and over.
    fn check_features(&self) -> Result<(), FamilyError> {
        for (axis, _) in self.axes.iter().zip(&self.roles).filter(|(_, role)| **role == NumberRole::Other) {
            for end in axis.range {
                let Ok(preset) = self.with(&[(axis, end)]) else { continue };
                let made = MemberCase::of(preset, self.length);
                let feature = made.reduced.gap.feature_length().unwrap_or(f64::INFINITY);
                let count = self.radii[1] / feature;
                if count > MOST_FEATURES {
                    let axis = axis.to_string();
                    return Err(FamilyError::TooFine { axis, value: end, count: count.round() });
                }
            }
        }
        Ok(())
    }

    /// The preset with these values.
    fn with(&self, values: &[(&MapAxis, f64)]) -> Result<Preset, Invalid> {
        let mut preset = self.preset.clone();
        let changes = values.iter().filter(|(axis, _)| axis.key != COMPLIANCE);
        preset.set_all(changes.map(|(axis, value)| (axis.key.as_str(), (*value).into())))?;
        for (axis, value) in values {
            if axis.key == COMPLIANCE {
                preset.path.control = device(*value);
            }
        }
        Ok(preset)
    }

    /// The gap at these shares; the last few are kept.
    fn made(&self, at: AxisShares<'_>) -> Result<Arc<MemberCase>, FamilyError> {
        let values: Vec<(&MapAxis, f64)> = (0..self.axes.len())
            .filter(|k| !self.keeps_gap(*k))
            .map(|k| (&self.axes[k], self.axes[k].value(at[k])))
            .collect();
        if values.is_empty() {
            return Ok(Arc::clone(&self.base));
        }
        let key: Vec<u64> = values.iter().map(|(_, value)| value.to_bits()).collect();
        let lock = || self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, made)) = lock().iter().find(|(known, _)| *known == key) {
            return Ok(Arc::clone(made));
        }
        let made = MemberCase::of(self.with(&values)?, self.length);
        if let Some(blend) = &self.blend {
            let weights = self.weights(&|k| self.axes[k].value(at[k]));
            let table = Table::of_blend(Arc::clone(&made.reduced.gap), blend, weights);
            made.table.get_or_init(|| Arc::new(table));
        }
        let mut kept = lock();
        if kept.len() >= KEPT {
            kept.remove(0);
        }
        kept.push((key, Arc::clone(&made)));
        Ok(made)
    }

    fn table(&self, made: &MemberCase) -> Result<Arc<Table>, TableError> {
        let reach = self.reach(&made.preset);
        if let Some(table) = made.table.get() {
            table.up_to(reach)?;
            return Ok(Arc::clone(table));
        }
        let gap = &made.reduced.gap;
        let table = Table::shared(&self.kept, &made.preset.gap, gap, reach, &Unwatched)?;
        Ok(Arc::clone(made.table.get_or_init(|| table)))
    }

    fn reach(&self, preset: &Preset) -> f64 {
        match preset.path.start {
            Start::ContactRadius(s) => s / self.length,
            _ => self.radii[1].max(0.1),
        }
    }

    /// The radius at which the paths of all members start, reduced, before the edge runs away from it; `None` if they
    /// differ.
    pub fn start(&self) -> Option<f64> {
        let Start::ContactRadius(s) = self.preset.path.start else { return None };
        let is_free = self.axes.iter().any(|axis| axis.key.starts_with("path.start"));
        (!is_free).then_some(s / self.length)
    }

    /// Widens the radii between which lines are looked for, so that they include those of a path. If that would include
    /// more features of the gap than a map takes, they end there.
    ///
    /// # Errors
    /// A message about the radii that are left out.
    pub fn widen(&mut self, [end, start]: [f64; 2]) -> Result<(), String> {
        let most = self.wave().map_or(f64::INFINITY, |wave| MOST_FEATURES * wave);
        let [from, to] = self.radii;
        self.radii = [from.min(end), to.max(start.min(most))];
        if start > most {
            let [start, most] = [start, most].map(|s| s * self.length);
            return Err(format!(
                "a path starts at the contact radius {start:?}; lines are followed only up to {most:?}, \
                 {MOST_FEATURES} waves"
            ));
        }
        Ok(())
    }

    /// The contact radius at the start, reduced.
    fn start_of(&self, made: &MemberCase, work_of_adhesion: f64) -> Result<f64, FamilyError> {
        let reduced = made.reduced.clone();
        let (length, force) = (reduced.units.length, reduced.units.force);
        let wanted = match made.preset.path.start {
            Start::ContactRadius(s) => return Ok(s / length),
            Start::Approach(delta) => Start::Approach(delta / length),
            Start::Force(p) => Start::Force(p / force),
        };
        let basis = ExactBasis::new(self.table(made)?, self.reach(&made.preset));
        let reduced = Reduced { work_of_adhesion, ..reduced };
        Ok(contact_radius(&reduced, &basis, wanted, &Unwatched)?)
    }

    /// The contact radius at which the path of a member ends that starts at `start`.
    fn end_of(&self, made: &MemberCase, start: f64) -> Result<f64, FamilyError> {
        let given = made.preset.path.end_contact_radius.map(|end| end / self.length);
        Ok(end_contact_radius(&made.reduced, &*self.table(made)?, start, given, &Unwatched)?)
    }

    /// How an axis enters.
    fn role(&self, axis: &MapAxis) -> Result<NumberRole, FamilyError> {
        if axis.key == COMPLIANCE {
            return Ok(NumberRole::Device);
        }
        let [lo, hi] = axis.range;
        let middle = axis.value(0.5);
        // At the ends of the other axis too: it may change the scale of this one.
        let others: Vec<&MapAxis> = self.axes.iter().filter(|other| other.key != axis.key).collect();
        let ends = |other: &MapAxis| [0.0, 1.0].map(|share| other.value(share));
        let corners: Vec<Vec<(&MapAxis, f64)>> = match others.first() {
            Some(other) if other.key != COMPLIANCE => ends(other).map(|value| vec![(*other, value)]).to_vec(),
            _ => vec![Vec::new()],
        };
        let mut roles = Vec::new();
        for corner in &corners {
            let [a, b, m] =
                [lo, hi, middle].map(|value| self.with(&[&corner[..], &[(axis, value)]].concat()));
            let (a, b, m) = (a?, b?, m?);
            let factor = |preset: &Preset, value: f64| {
                preset.problem().reduced_by(self.length).work_of_adhesion / value
            };
            let same = |preset: &Preset| preset.material == b.material && preset.path == b.path;
            let proportional = (factor(&m, middle) / factor(&b, hi) - 1.0).abs() <= ROUNDING;
            let role = if a.gap == b.gap && a.path == b.path && factor(&b, hi) > 0.0 && proportional {
                NumberRole::Adhesion(factor(&b, hi))
            } else if same(&a) && self.is_linear(&a.gap, &b.gap, &m.gap, (middle - lo) / (hi - lo)) {
                NumberRole::Linear
            } else {
                NumberRole::Other
            };
            roles.push(role);
        }
        let first = roles.first().copied().unwrap_or(NumberRole::Other);
        let alike = roles.iter().all(|role| match (*role, first) {
            (NumberRole::Adhesion(a), NumberRole::Adhesion(b)) => (a / b - 1.0).abs() <= ROUNDING,
            (a, b) => a == b,
        });
        Ok(if alike { first } else { NumberRole::Other })
    }

    /// Whether the gap `m` lies at `share` of the way from `a` to `b`, at many radii.
    fn is_linear(&self, a: &Shape, b: &Shape, m: &Shape, share: f64) -> bool {
        let reach = match self.preset.path.start {
            Start::ContactRadius(s) => s,
            _ => self.length,
        };
        a != b
            && (1..=ASKED).all(|k| {
                let r = reach * f64::from(k) / f64::from(ASKED);
                let [a, b, m] = [a, b, m].map(|gap| gap.jet(r).first);
                let size = a.abs().max(b.abs()).max(m.abs());
                (a + share * (b - a) - m).abs() <= ROUNDING * size
            })
    }

    /// The index of the axis whose number enters the gap linearly.
    pub fn linear(&self) -> Option<usize> {
        self.roles.iter().position(|role| *role == NumberRole::Linear)
    }

    /// The index of the axis of the work of adhesion.
    pub fn adhesion(&self) -> Option<usize> {
        self.roles.iter().position(|role| matches!(role, NumberRole::Adhesion(_)))
    }

    /// The index of the axis of the compliance.
    pub fn compliance(&self) -> Option<usize> {
        self.roles.iter().position(|role| *role == NumberRole::Device)
    }

    /// Whether the gap is the same everywhere on the axis.
    pub fn keeps_gap(&self, axis: usize) -> bool {
        matches!(self.roles[axis], NumberRole::Adhesion(_) | NumberRole::Device)
    }

    /// The reduced work of adhesion divided by the number on its axis.
    pub fn adhesion_factor(&self) -> Option<f64> {
        self.roles.iter().find_map(|role| if let NumberRole::Adhesion(c) = role { Some(*c) } else { None })
    }

    /// The member at these shares: its adhesion and device, and its preset where some number requires it.
    ///
    /// # Errors
    /// [`FamilyError`] if the values are refused.
    pub fn member(&self, at: AxisShares<'_>) -> Result<Member<'_>, FamilyError> {
        let value = |k: usize| self.axes[k].value(at[k]);
        let (mut source, made) = if self.roles.contains(&NumberRole::Other) {
            let made = self.made(at)?;
            let source = match made.reduced.gap.form() {
                Form::Waves { curvature, waves } => TransformSource::Waves { curvature, waves },
                _ => TransformSource::One(
                    self.table(&made)?.up_to(self.radii[1].max(self.reach(&made.preset)))?,
                ),
            };
            (Some(source), made)
        } else {
            (None, Arc::clone(&self.base))
        };
        let units = made.reduced.units;
        let mut work_of_adhesion = made.reduced.work_of_adhesion;
        let mut control = made.preset.path.control.in_units(units.stiffness);
        for (k, role) in self.roles.iter().enumerate() {
            match role {
                NumberRole::Adhesion(factor) => work_of_adhesion = factor * value(k),
                NumberRole::Device => control = device(value(k)).in_units(units.stiffness),
                NumberRole::Linear => {
                    let reach = self.radii[1].max(self.reach(&self.preset));
                    let parts = self.weights(&value).into_iter().zip(&self.ends);
                    let parts = parts.map(|(weight, table)| Ok((weight, table.up_to(reach)?)));
                    source = Some(TransformSource::Mixed(parts.collect::<Result<_, TableError>>()?));
                }
                NumberRole::Other => {}
            }
        }
        let source = if let Some(source) = source {
            source
        } else {
            let reach = self.radii[1].max(self.reach(&self.preset));
            let own = self.own.as_ref().ok_or(Stopped)?;
            TransformSource::One(own.up_to(reach)?)
        };
        let root = root_of(work_of_adhesion);
        Ok(Member { family: self, source, root, work_of_adhesion, control, units })
    }
}

/// The device with this compliance.
fn device(compliance: f64) -> Control {
    if compliance <= 0.0 {
        Control::Displacement
    } else if compliance.is_finite() && compliance.recip() > 0.0 {
        Control::Stiffness(compliance.recip())
    } else {
        Control::Force
    }
}

/// Where g comes from.
#[derive(Debug, Clone)]
enum TransformSource {
    One(Arc<Panels>),
    /// A paraboloid with waves; a single radius needs no table.
    Waves {
        curvature: f64,
        waves: Vec<Wave>,
    },
    /// The tables at the corners of the numbers that enter linearly, each with its weight.
    Mixed(Vec<(f64, Arc<Panels>)>),
}

/// One problem of a family, reduced by the family's length.
#[derive(Debug, Clone)]
pub struct Member<'a> {
    family: &'a Family,
    source: TransformSource,
    /// √(πγ/2).
    pub root: f64,
    /// γ.
    pub work_of_adhesion: f64,
    /// The device.
    pub control: Control,
    /// Its units: that of the force follows E*, which may be a number of the family.
    pub units: Units,
}

impl Member<'_> {
    /// What the law needs at the radius `s`; `None` beyond the table, and where it is not a number.
    pub fn local(&self, s: f64) -> Option<LocalLaw> {
        let of = |panels: &Panels| {
            let place = (s > 0.0 && s <= panels.reach()).then(|| panels.place(s))?;
            let [transform, area] = panels.value_and_area(place);
            (place.panel > 0).then(|| (panels.slopes(place), [transform, area]))
        };
        let (slopes, [transform, area]) = match &self.source {
            TransformSource::One(panels) => of(panels)?,
            TransformSource::Waves { curvature, waves } => {
                let (whole, slopes) = waves::at(*curvature, waves, s);
                (slopes, whole)
            }
            TransformSource::Mixed(parts) => {
                let (mut slopes, mut whole) = ([0.0; 3], [0.0; 2]);
                for (weight, panels) in parts {
                    let (more, values) = of(panels)?;
                    for (sum, x) in slopes.iter_mut().zip(more).chain(whole.iter_mut().zip(values)) {
                        *sum += weight * x;
                    }
                }
                (slopes, whole)
            }
        };
        let edge = EdgeJet::of(self.control, s, slopes);
        let sound = edge.bend.is_finite() && edge.slope.is_finite() && transform.is_finite();
        sound.then_some(LocalLaw {
            edge,
            root: self.root,
            transform,
            area,
            slope: slopes[0],
            contact_radius: s,
            control: self.control,
        })
    }

    /// The law of this member, on the table of its own gap.
    ///
    /// # Errors
    /// The gap cannot be tabulated.
    pub fn law(&self, at: AxisShares<'_>) -> Result<Law, FamilyError> {
        let family = self.family;
        let panels = if let TransformSource::One(panels) = &self.source {
            Arc::clone(panels)
        } else {
            let made = family.made(at)?;
            family.table(&made)?.up_to(family.radii[1])?
        };
        Ok(Law { panels, control: self.control })
    }

    /// The exact basis on the table of the member's own gap, its problem, and the radii at which its path ends and
    /// starts; all reduced.
    ///
    /// # Errors
    /// [`FamilyError`].
    pub fn ground(&self, at: AxisShares<'_>) -> Result<(ExactBasis, Reduced, [f64; 2]), FamilyError> {
        let family = self.family;
        let made = family.made(at)?;
        let start = family.start_of(&made, self.work_of_adhesion)?;
        let end = family.end_of(&made, start)?;
        let reduced = Reduced { work_of_adhesion: self.work_of_adhesion, ..made.reduced.clone() };
        Ok((ExactBasis::new(family.table(&made)?, start), reduced, [end, start]))
    }
}
