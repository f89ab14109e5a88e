//! The edges of contacts with rings, followed through a change of the problem.
//!
//! Newton's method starts from the previous edges, with the same contacts. Where it does not converge, the change is
//! made in smaller parts, each starting from the edges of the previous part. If that fails too, there is no state, and
//! none is claimed.

use super::curve::CurveData;
use super::node::Node;
use pulloff_engine::annuli::Contacts;
use pulloff_engine::case::Case;
use pulloff_engine::preset::{Preset, Value};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::walk::{At, Emit, Walk, WalkFailure, Walked, edges};
use pulloff_engine::quasistatic::{Curve, Detail, State};

/// The smallest part of a change, and how many parts are tried.
const SMALLEST: f64 = 1.0 / 64.0;
const MOST: usize = 100;

/// A state with rings before a change, in the user's units.
#[derive(Debug, Clone, PartialEq)]
pub struct Before {
    /// Where the bodies touched.
    pub contacts: Contacts,
    /// The problem.
    pub preset: Preset,
}

impl Before {
    /// The edges of a state, if it has more than a disc has.
    pub fn of(node: &Node) -> Option<Box<Self>> {
        let contacts = scaled(&node.contacts(), node.setting.units().length);
        node.has_rings().then(|| Box::new(Self { contacts, preset: node.setting.preset.clone() }))
    }

    /// The state of the problem of `curve` with the same contacts, at the value that the control has in `state`.
    pub fn follow(&self, curve: &CurveData, state: &State, emit: &mut Emit<'_>) -> Walked {
        let last =
            |from: &Contacts, emit: &mut Emit<'_>| solved(&curve.case, &curve.base.curve, from, state, emit);
        let whole = last(&self.contacts, emit);
        if whole.is_ok() {
            return whole;
        }
        let (mut contacts, mut share, mut part) = (self.contacts.clone(), 0.0, 0.5);
        for _ in 0..MOST {
            let to = share + part;
            if to >= 1.0 {
                let end = last(&contacts, emit);
                if end.is_ok() {
                    return end;
                }
            } else if let Some(found) = self.part(&curve.setting.preset, to, &contacts, state) {
                (contacts, share) = (found, to);
                continue;
            }
            part *= 0.5;
            if part < SMALLEST {
                break;
            }
        }
        Err(WalkFailure::NotSolved)
    }

    /// The contacts after this share of the change to `preset`.
    fn part(&self, preset: &Preset, share: f64, from: &Contacts, state: &State) -> Option<Contacts> {
        let case = Case::new(&between(&self.preset, preset, share)?).ok()?;
        let curve = case.curve_in(Detail::Borders, &Unwatched).ok()?;
        let mut found = None;
        let end = solved(&case, &curve, from, state, &mut |reached| {
            let contacts = edges::contacts(&curve.equilibrium.scales, &reached.point);
            found = Some(scaled(&contacts, case.units().length));
            true
        });
        found.filter(|_| end.is_ok())
    }
}

/// Solves for the edges near `from` (in the user's units) on a curve.
fn solved(case: &Case, curve: &Curve, from: &Contacts, state: &State, emit: &mut Emit<'_>) -> Walked {
    let units = case.units();
    let walk = Walk {
        curve,
        range: [case.start, case.end],
        control: case.control,
        from: None,
        at: At::Nothing,
        inward: true,
        length: 0.0,
    };
    let value = case.control.value(state.approach / units.length, state.force / units.force);
    walk.solve_rings(value, &scaled(from, 1.0 / units.length), emit)
}

fn scaled(contacts: &Contacts, by: f64) -> Contacts {
    let radii: Vec<f64> = contacts.edges().iter().map(|edge| edge.radius * by).collect();
    contacts.with_edges(&radii)
}

/// The preset this share of the way from one to the other; `None` if they differ in more than numbers.
fn between(from: &Preset, to: &Preset, share: f64) -> Option<Preset> {
    let mut preset = to.clone();
    let mut changes = Vec::new();
    for row in to.rows().filter(|row| !row.key.starts_with("display.") && row.key != "title") {
        match (from.get(&row.key), to.get(&row.key)) {
            (Some(Value::Number(a)), Some(Value::Number(b))) if a.to_bits() != b.to_bits() => {
                changes.push((row.key.clone(), Value::Number(a + share * (b - a))));
            }
            (a, b) if a != b && !row.key.starts_with("path.") => return None,
            _ => {}
        }
    }
    preset.set_all(changes.iter().map(|(key, value)| (&**key, value.clone()))).ok()?;
    Some(preset)
}
