//! The walk of a session: every node, in the order in which they were made.
//!
//! A node holds what cannot be recovered without its curve: its unknowns, the frame of the curve there, its energy and
//! what the basis said of it. The state follows from the unknowns and their scales, which are powers of two.

use super::number::{Real, floats, reals};
use crate::explorer::history::History;
use crate::explorer::node::{Node, NodeKind};
use crate::explorer::setting::Setting;
use pulloff_engine::annuli::MOST_CONTACTS;
use pulloff_engine::continuation::{ColumnView, Columns};
use pulloff_engine::quasistatic::admissible::Crest;
use pulloff_engine::quasistatic::path::Direction;
use pulloff_engine::quasistatic::walk::{Ahead, edges};
use pulloff_engine::quasistatic::{
    Admissibility, Event, EventKind, PathState, Stability, State, StatePoint, Stiffness,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The number of unknowns of a disc, and of the most contacts.
const FEWEST: usize = 3;
const MOST: usize = 2 + 2 * MOST_CONTACTS;

/// A node.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct SavedNode {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    parent: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    forward: Option<usize>,
    kind: SavedKind,
    setting: usize,
    step: usize,
    /// δ, P and every edge, scaled.
    y: Vec<Real>,
    tangent: Vec<Real>,
    curvature: Vec<Real>,
    positive: bool,
    length: Real,
    turning: Real,
    rounds: usize,
    energy: Real,
    stiffness: [Real; 3],
    /// With rings, the slopes that decide the stability; for one disc they follow from its tangent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    slopes: Option<[Real; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    ahead: Option<Lead>,
    /// r, the gap, and the number of the nearest crest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    crest: Option<(Real, Real, Option<u64>)>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    least_pressure: Option<[Real; 2]>,
    admissible: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    known_to: Option<Real>,
    digits: Real,
    from_exact: Real,
    /// The number of the state on the path along which it was walked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    on_path: Option<usize>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    begins: bool,
    request: u64,
}

/// How a node came about.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum SavedKind {
    Start,
    Step,
    Limit,
    Touch(Real),
    Jump(Box<Leap>),
    Moved,
    Solved,
    Stale(String),
}

/// A jump.
#[derive(Debug, Serialize, Deserialize)]
struct Leap {
    kind: String,
    loading: bool,
    control_value: Real,
    radius: Option<Real>,
    before: Option<LeapEnd>,
    after: Option<LeapEnd>,
    dissipated: Option<Real>,
    by_area: Option<Real>,
}

/// A state at which a jump begins or ends.
#[derive(Debug, Serialize, Deserialize)]
struct LeapEnd {
    state: [Real; 4],
    contacts: Vec<[Real; 2]>,
    area: Real,
    held_stiffness: Real,
    stable: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    slopes: Option<[Real; 2]>,
    control_value: Real,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    zone: Option<Real>,
}

impl LeapEnd {
    fn of(state: &PathState) -> Self {
        Self {
            state: state_out(&state.state()),
            contacts: state.contacts.iter().map(|edges| edges.map(Real)).collect(),
            area: Real(state.contact_area),
            held_stiffness: Real(state.held_stiffness),
            stable: state.stable,
            slopes: state.slopes.map(|slopes| reals([slopes.approach, slopes.force])),
            control_value: Real(state.control_value),
            zone: state.zone.map(Real),
        }
    }

    fn back(self, direction: Direction) -> PathState {
        let State { contact_radius, approach, force, energy } = state_in(self.state);
        PathState {
            zone: self.zone.map(|edge| edge.0),
            contact_radius,
            approach,
            force,
            energy,
            contacts: self.contacts.into_iter().map(|edges| edges.map(|r| r.0)).collect(),
            contact_area: self.area.0,
            held_stiffness: self.held_stiffness.0,
            stable: self.stable,
            slopes: self.slopes.map(|slopes| {
                let [approach, force] = floats(slopes);
                Stability { approach, force }
            }),
            control_value: self.control_value.0,
            direction,
            piece: 0,
        }
    }
}

/// Where a jump would lead.
#[derive(Debug, Serialize, Deserialize)]
struct Lead {
    after: Option<[Real; 4]>,
    dissipated: Option<Real>,
}

fn state_out(state: &State) -> [Real; 4] {
    reals([state.contact_radius, state.approach, state.force, state.energy])
}

fn state_in(numbers: [Real; 4]) -> State {
    let [contact_radius, approach, force, energy] = floats(numbers);
    State { contact_radius, approach, force, energy }
}

impl SavedKind {
    fn of(kind: &NodeKind) -> Self {
        match kind {
            NodeKind::Start => Self::Start,
            NodeKind::Step => Self::Step,
            NodeKind::Limit => Self::Limit,
            NodeKind::Touch(radius) => Self::Touch(Real(*radius)),
            NodeKind::Jump(event) => Self::Jump(Box::new(Leap {
                kind: event.kind.name().to_owned(),
                loading: event.direction == Direction::Loading,
                control_value: Real(event.control_value),
                radius: event.radius.map(Real),
                before: event.before.as_ref().map(LeapEnd::of),
                after: event.after.as_ref().map(LeapEnd::of),
                dissipated: event.dissipated.map(Real),
                by_area: event.dissipated_by_area.map(Real),
            })),
            NodeKind::Moved => Self::Moved,
            NodeKind::Solved => Self::Solved,
            NodeKind::Stale(reason) => Self::Stale(reason.clone()),
        }
    }

    fn back(self) -> NodeKind {
        match self {
            Self::Start => NodeKind::Start,
            Self::Step => NodeKind::Step,
            Self::Limit => NodeKind::Limit,
            Self::Touch(radius) => NodeKind::Touch(radius.0),
            Self::Jump(leap) => {
                let direction = if leap.loading { Direction::Loading } else { Direction::Unloading };
                let kind = EventKind::ALL.into_iter().find(|kind| kind.name() == leap.kind);
                NodeKind::Jump(Box::new(Event {
                    kind: kind.unwrap_or(EventKind::Snap),
                    direction,
                    control_value: leap.control_value.0,
                    radius: leap.radius.map(|r| r.0),
                    before: leap.before.map(|end| end.back(direction)),
                    after: leap.after.map(|end| end.back(direction)),
                    dissipated: leap.dissipated.map(|x| x.0),
                    dissipated_by_area: leap.by_area.map(|x| x.0),
                    passed: Vec::new(),
                }))
            }
            Self::Moved => NodeKind::Moved,
            Self::Solved => NodeKind::Solved,
            Self::Stale(reason) => NodeKind::Stale(reason),
        }
    }
}

impl SavedNode {
    fn of(node: &Node, setting: usize, forward: Option<usize>) -> Self {
        let Node { point, stiffness, admissibility, .. } = node;
        let numbers = |column: ColumnView<'_>| column.iter().map(|x| Real(*x)).collect();
        Self {
            parent: node.parent,
            forward,
            kind: SavedKind::of(&node.kind),
            setting,
            step: node.step,
            y: numbers(point.y()),
            tangent: numbers(point.tangent()),
            curvature: numbers(point.curvature()),
            positive: point.positive,
            length: Real(point.length),
            turning: Real(point.turning),
            rounds: point.rounds,
            energy: Real(node.state.energy),
            stiffness: reals([stiffness.contact, stiffness.tangent, stiffness.area_slope]),
            slopes: node.has_rings().then(|| reals([node.stability.approach, node.stability.force])),
            ahead: node.ahead.map(|ahead| Lead {
                after: ahead.after.as_ref().map(state_out),
                dissipated: ahead.dissipated.map(Real),
            }),
            crest: admissibility.nearest.map(|crest| (Real(crest.radius), Real(crest.gap), crest.wave)),
            least_pressure: admissibility.least_pressure.map(|(radius, least)| reals([radius, least])),
            admissible: admissibility.holds,
            known_to: admissibility.known_to.map(Real),
            digits: Real(node.digits),
            from_exact: Real(node.from_exact),
            on_path: node.on_path,
            begins: node.begins,
            request: node.request,
        }
    }

    fn back(self, settings: &[Arc<Setting>]) -> Option<(Node, Option<usize>)> {
        let setting = Arc::clone(settings.get(self.setting)?);
        let columns = [self.y, self.tangent, self.curvature];
        let unknowns = columns[0].len();
        let right =
            (FEWEST..=MOST).contains(&unknowns) && columns.iter().all(|column| column.len() == unknowns);
        let columns = right.then(|| columns.concat().iter().map(|x| x.0).collect())?;
        let mut point = StatePoint::of(Columns::from_vec(columns), self.positive);
        (point.length, point.rounds, point.turning) = (self.length.0, self.rounds, self.turning.0);
        let scales = &setting.scales;
        let [approach, force] = edges::device(scales, &point);
        let contacts = edges::contacts(scales, &point);
        // If there is only a zone, there is no contact.
        if self.on_path.is_none() || contacts.outermost() > 0.0 {
            contacts.check().ok()?;
        }
        let contact_radius = contacts.outermost();
        let stability = match self.slopes {
            Some(slopes) => {
                let [approach, force] = floats(slopes);
                Stability { approach, force }
            }
            None if unknowns > FEWEST => return None,
            None => scales.stability(&point),
        };
        let [contact, tangent, area_slope] = floats(self.stiffness);
        let node = Node {
            parent: self.parent,
            kind: self.kind.back(),
            control: setting.control,
            state: State { contact_radius, approach, force, energy: self.energy.0 },
            setting,
            stability,
            point,
            step: self.step,
            stiffness: Stiffness { contact, tangent, area_slope },
            ahead: self.ahead.map(|lead| Ahead {
                after: lead.after.map(state_in),
                dissipated: lead.dissipated.map(|x| x.0),
            }),
            admissibility: Admissibility {
                nearest: self.crest.map(|(radius, gap, wave)| Crest { radius: radius.0, gap: gap.0, wave }),
                least_pressure: self.least_pressure.map(|[radius, least]| (radius.0, least.0)),
                holds: self.admissible,
                known_to: self.known_to.map(|radius| radius.0),
            },
            digits: self.digits.0,
            from_exact: self.from_exact.0,
            on_path: self.on_path,
            begins: self.begins,
            request: self.request,
        };
        Some((node, self.forward))
    }
}

/// The nodes of a tree; `setting` numbers their settings.
pub(super) fn nodes(history: &History, mut setting: impl FnMut(&Arc<Setting>) -> usize) -> Vec<SavedNode> {
    let nodes = history.nodes().enumerate();
    nodes.map(|(at, node)| SavedNode::of(node, setting(&node.setting), history.forward(at))).collect()
}

/// The tree of these nodes; `None` if they do not form one.
pub(super) fn history(
    nodes: Vec<SavedNode>,
    cursor: Option<usize>,
    settings: &[Arc<Setting>],
) -> Option<History> {
    let nodes = nodes.into_iter().map(|node| node.back(settings)).collect::<Option<Vec<_>>>()?;
    History::of(nodes, cursor)
}
