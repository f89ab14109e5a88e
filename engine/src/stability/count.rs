//! The snaps of a member's own quasi-static path, from the limit points and landings of its table alone, and where
//! their number changes along an axis.

use super::family::{AxisShares, Family, FamilyError};
use super::law::Cusp;
use crate::disc::Basis;
use crate::progress::{Progress, Unwatched};
use crate::quasistatic::descent::{descend, stable_start};
use crate::quasistatic::path::{PathSetting, unload};
use crate::quasistatic::{Curve, Detail, EventKind, Losses, Monotone};
use std::sync::Arc;

/// Halvings that locate a change along an axis: down to rounding.
pub const EXACTLY: usize = 40;
/// Halvings that suffice as a starting point for Newton's method.
pub const NEARLY: usize = 12;

/// The path of one member.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// The snaps, not counting the loss of the last contact.
    pub snaps: usize,
    /// Radius s and weighted control at the minima of the control between the end and the start of the path, ascending.
    pub minima: Vec<[f64; 2]>,
    /// The maxima further out than the start, if the start is one from which the edge first runs outward.
    pub crests: Vec<[f64; 2]>,
    /// The limit points between the end and the start, of both kinds.
    pub limits: usize,
    /// The s of those from which the edge snaps.
    pub jumps: Vec<f64>,
    /// s at the end and at the start of the path; for an unstable start, the s that the edge runs to.
    pub radii: [f64; 2],
}

/// What makes the number of snaps change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cause {
    /// A pair of limit points is born, or dies, at this s.
    Cusp(f64),
    /// The jump from the first of these limit points just reaches the crest of the second, or just passes over it.
    Landing([f64; 2]),
    /// A limit point passes the start of the path.
    Start,
}

/// A change in the number of snaps along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Where it is, as a share of the axis.
    pub share: f64,
    /// The snaps before and after.
    pub snaps: [usize; 2],
    /// Why.
    pub cause: Cause,
}

impl Family {
    /// The path of the member at these shares; `None` where it has no start or no stable state to start from.
    pub fn passage(&self, at: AxisShares<'_>) -> Option<Passage> {
        self.try_passage(at).ok().flatten()
    }

    fn try_passage(&self, at: AxisShares<'_>) -> Result<Option<Passage>, FamilyError> {
        let member = self.member(at)?;
        let (basis, problem, [end, start]) = member.ground(at)?;
        let Ok(Some(solution)) = basis.solution(&problem, end, start, &Unwatched) else { return Ok(None) };
        let mut monotone = Monotone::of(&*solution, member.control);
        let mut from = start;
        let (snaps, jumps) = if let Some(here) = stable_start(&*solution, &monotone, start) {
            let descent = descend(&*solution, &monotone, here, end);
            if descent.hole.is_some() {
                return Ok(None);
            }
            let landed = descent.jumps.iter().filter(|jump| jump.landing.is_some());
            let radius = |place| solution.radius(place);
            (descent.snaps(), landed.map(|jump| radius(jump.before)).collect())
        } else {
            // The edge runs outward first; the path of the whole unloading knows how far.
            let table = Arc::clone(basis.table());
            let of = Arc::new(basis.clone());
            let curve = Curve::new(problem.clone(), of, table, [start, end], Detail::Borders, &Unwatched);
            let Ok(Some(curve)) = curve else { return Ok(None) };
            let (losses, detail) = (Losses::Once, Detail::Borders);
            let setting = PathSetting { losses, detail, ..PathSetting::one_disc(member.control) };
            match unload(&curve, &setting, &Unwatched) {
                Ok(path) => {
                    let snaps = path.events.iter().filter(|event| event.kind == EventKind::Snap);
                    let jumps: Vec<f64> =
                        snaps.filter_map(|event| Some(event.before.as_ref()?.contact_radius)).collect();
                    from = path.start().map_or(from, |start| start.contact_radius);
                    let Ok(Some(longer)) = basis.solution(&problem, end, from, &Unwatched) else {
                        return Ok(None);
                    };
                    monotone = Monotone::of(&*longer, member.control);
                    (jumps.len(), jumps)
                }
                Err(_) => return Ok(None),
            }
        };
        let within = |s: f64| end <= s && s <= from;
        let minima = monotone.stretches.iter().filter(|stretch| stretch.rising && stretch.joined);
        let minima = minima.map(|stretch| [stretch.radii[0], stretch.values[0]]);
        let crests = monotone.stretches.iter().filter(|stretch| stretch.rising && stretch.radii[1] > start);
        let crests = crests.map(|stretch| [stretch.radii[1], stretch.values[1]]);
        Ok(Some(Passage {
            snaps,
            minima: minima.filter(|[s, _]| within(*s)).collect(),
            crests: if from > start { crests.collect() } else { Vec::new() },
            limits: monotone.limits.iter().filter(|limit| within(limit.contact_radius)).count(),
            jumps,
            radii: [end, from],
        }))
    }

    /// The changes in the number of snaps along `axis`, with the other number held at its share in `at`. They are
    /// looked for between neighbours in `samples` (ascending shares) and located with this many halvings. `progress` is
    /// asked before each sample; on a stop, what was found until then is returned.
    pub fn changes(
        &self,
        axis: usize,
        at: AxisShares<'_>,
        samples: &[f64],
        halvings: usize,
        progress: &dyn Progress,
    ) -> Vec<Change> {
        let place = |share: f64| {
            let mut place = at.to_vec();
            place[axis] = share;
            place
        };
        let mut found = Vec::new();
        let mut before: Option<(f64, Passage)> = None;
        for share in samples {
            if progress.stop() {
                break;
            }
            let Some(here) = self.passage(&place(*share)) else {
                before = None;
                continue;
            };
            if let Some((from, old)) = before {
                self.between(&place, [(from, old), (*share, here.clone())], halvings, &mut found);
            }
            before = Some((*share, here));
        }
        found
    }

    /// The changes between two shares with different numbers of snaps.
    fn between(
        &self,
        place: &dyn Fn(f64) -> Vec<f64>,
        [mut lo, hi]: [(f64, Passage); 2],
        halvings: usize,
        found: &mut Vec<Change>,
    ) {
        while lo.1.snaps != hi.1.snaps {
            // The first of the changes.
            let (mut a, mut b) = (lo.clone(), hi.clone());
            for _ in 0..halvings {
                let middle = 0.5 * (a.0 + b.0);
                let Some(here) = self.passage(&place(middle)) else { break };
                if here.snaps == lo.1.snaps {
                    a = (middle, here);
                } else {
                    b = (middle, here);
                }
            }
            let share = 0.5 * (a.0 + b.0);
            let cause = self.cause(&place(share), &a.1, &b.1);
            found.push(Change { share, snaps: [a.1.snaps, b.1.snaps], cause });
            if b.0 >= hi.0 {
                return;
            }
            lo = b;
        }
    }

    fn cause(&self, at: AxisShares<'_>, before: &Passage, after: &Passage) -> Cause {
        let born = before.limits.abs_diff(after.limits);
        if born >= 2 {
            let root = self.member(at).map_or(f64::NAN, |member| member.root);
            let off = |cusp: &Cusp| (cusp.value - root).abs();
            let cusps = self.cusps(at);
            let nearest = cusps.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
            return nearest.map_or(Cause::Start, |cusp| Cause::Cusp(cusp.contact_radius));
        }
        if born == 1 {
            return Cause::Start;
        }
        // Among the minima from which the edge snaps on either side: the one whose control is nearest to that of a
        // minimum further in.
        let jumps: Vec<f64> = before.jumps.iter().chain(&after.jumps).copied().collect();
        let minima = &after.minima;
        let is_jump = |s: f64| jumps.iter().any(|jump| (jump - s).abs() <= 1e-4 * s);
        let pairs = minima.iter().enumerate().flat_map(|(j, outer)| {
            minima[..j].iter().map(move |inner| (outer, inner)).filter(|(outer, _)| is_jump(outer[0]))
        });
        let nearest = pairs.min_by(|(a, b), (c, d)| (a[1] - b[1]).abs().total_cmp(&(c[1] - d[1]).abs()));
        nearest.map_or(Cause::Start, |(outer, inner)| Cause::Landing([outer[0], inner[0]]))
    }

    /// The cusps of the member at these shares, between the end and the start of the path.
    pub fn cusps(&self, at: AxisShares<'_>) -> Vec<Cusp> {
        let law = self.member(at).and_then(|member| member.law(at));
        law.map_or_else(|_| Vec::new(), |law| law.cusps(self.radii).0)
    }
}

/// Shares spread evenly over an axis.
pub fn even(count: u32) -> Vec<f64> {
    (0..=count).map(|k| f64::from(k) / f64::from(count)).collect()
}
