//! The interior of the walker's state: the contact pressure, the gap around the contacts, the contact from above, and
//! the potential over the radius.

use super::bounds::Bounds;
use super::contact;
use super::parts::{Axis, Figure, Line, Mark, Role, Sign};
use super::scale::Scale;
use super::subject::Subject;
use crate::explorer::View;
use crate::explorer::profile::StateInside;
use pulloff_engine::problem::Control;
use pulloff_engine::quasistatic::landscape::Stationary;
use pulloff_engine::quasistatic::profile::Outside;
use pulloff_engine::report::number::{loss, significant, with_unit};
use pulloff_engine::units::Quantity;

/// The pressure is singular at an adhesive edge, so the axes are fitted to the disc up to this share of its radius.
const FITTED: f64 = 0.99;
/// How much is shown outside the edge in the contact from above, as a share of the radius.
const AROUND: f64 = 0.1;
/// How much of the contact is shown in the gap, as a share of what is shown outside.
const INSIDE: f64 = 0.3;

/// Builds the view.
pub fn figure(subject: &Subject<'_>, view: View) -> Figure {
    let scale = subject.scale();
    let (x, y) = match view {
        View::Pressure => (scale.radius_axis("r"), scale.pressure_axis()),
        View::Gap => (scale.radius_axis("r"), scale.length_axis("gap")),
        View::Contact => (scale.radius_axis("x"), scale.radius_axis("y")),
        _ => (scale.radius_axis("s"), potential_axis(scale, subject.curve.case.control)),
    };
    let title =
        if view == View::Contact { "contact".to_owned() } else { format!("{} over {}", y.title(), x.symbol) };
    let mut figure = Figure { is_even: view == View::Contact, ..Figure::empty(title, x, y) };
    let Some(inside) = subject.inside else {
        figure.missing = Some(match subject.walk.last() {
            Some(node) if node.is_apart() => "the bodies are apart: there is no contact".to_owned(),
            Some(node) if !subject.is_on_curve(node) => "the state is for other values".to_owned(),
            _ => "computing".to_owned(),
        });
        return figure;
    };
    // A walk is watched in one fixed window, as wide as the largest contact of its curve.
    let radii = subject.curve.points.iter().map(|at| scale.radius(at.contact_radius));
    let widest = if subject.walk.is_empty() { 0.0 } else { radii.fold(0.0, f64::max) };
    let radius = scale.radius(inside.profile.contact_radius * inside.units.length);
    let drawing = Drawing { scale, inside, widest: widest.max(radius), along: subject.curve.along.is_some() };
    figure.title = format!("{}, {} {}", figure.title, scale.radius_axis("s").symbol, significant(radius, 4));
    if view == View::Contact {
        figure.title.push_str(", half of it");
    }
    match view {
        View::Pressure => drawing.pressure(subject.curve.base.theory.exact_name, &mut figure),
        View::Gap => drawing.gap(&mut figure),
        View::Contact => drawing.contact(&mut figure),
        _ => drawing.energy(&mut figure),
    }
    figure
}

/// The axis of the quantity that is smallest at a stable state when the control is held.
fn potential_axis(scale: Scale<'_>, control: Control) -> Axis {
    let symbol = match control {
        Control::Displacement => "U",
        Control::Force => "U-Pδ",
        Control::Stiffness(_) => "U+k(Δ-δ)²/2",
    };
    scale.axis(symbol, "energy", Quantity::Energy)
}

/// A state on the axes of a figure.
struct Drawing<'a> {
    scale: Scale<'a>,
    inside: &'a StateInside,
    /// The largest contact radius to show, on its axis.
    widest: f64,
    /// Whether the states lie on no single curve.
    along: bool,
}

impl Drawing<'_> {
    /// A reduced radius on its axis.
    fn radius(&self, r: f64) -> f64 {
        self.scale.radius(r * self.inside.units.length)
    }

    /// A reduced pressure on its axis.
    fn stress(&self, p: f64) -> f64 {
        self.scale.pressure(p * self.inside.units.pressure)
    }

    fn edge(&self) -> f64 {
        self.radius(self.inside.profile.contact_radius)
    }

    /// The contacts on the axis of radii.
    fn contacts(&self) -> Vec<[f64; 2]> {
        self.inside.profile.contacts.iter().map(|edges| edges.map(|r| self.radius(r))).collect()
    }

    fn contact(&self, figure: &mut Figure) {
        let profile = &self.inside.profile;
        let end = profile.outside.last().map_or(profile.contact_radius, |at| at.radius);
        let reach = (1.0 + AROUND) * self.widest;
        let crests = self.crests(0.0, end).map(|r| self.radius(r)).take_while(|r| *r <= reach);
        contact::lay(figure, &self.contacts(), &self.tensions(), crests, reach);
    }

    /// The zone outside the contact, on the axis of radii.
    fn zone(&self) -> Option<[f64; 2]> {
        let profile = &self.inside.profile;
        Some([profile.contact_radius, profile.zone?].map(|r| self.radius(r)))
    }

    /// Where the pressure in the contacts and the zone is negative, as ranges on the axis of radii.
    fn tensions(&self) -> Vec<[f64; 2]> {
        let inside = &self.inside.profile.inside;
        let mut all: Vec<[f64; 2]> = self
            .inside
            .profile
            .zone
            .map(|edge| [self.inside.profile.contact_radius, edge])
            .into_iter()
            .collect();
        for [inner, outer] in &self.inside.profile.contacts {
            let within = inside.iter().filter(|at| at.radius >= *inner && at.radius <= *outer);
            let places: Vec<(f64, f64)> = within.map(|at| (at.radius, at.pressure)).collect();
            let mut begun = places.first().filter(|at| at.1 < 0.0).map(|_| *inner);
            for pair in places.windows(2) {
                let [(a, p), (b, q)] = [pair[0], pair[1]];
                let zero = a + (b - a) * p / (p - q);
                match (p < 0.0, q < 0.0) {
                    (false, true) => begun = Some(zero),
                    (true, false) => all.extend(begun.take().map(|from| [from, zero])),
                    _ => {}
                }
            }
            all.extend(begun.map(|from| [from, *outer]));
        }
        all.into_iter().map(|edges: [f64; 2]| edges.map(|r| self.radius(r))).collect()
    }

    /// Marks the edges; the axis is not one.
    fn edges(&self, figure: &mut Figure) {
        let edges = self.contacts().into_iter().flatten().filter(|r| *r > 0.0);
        figure.marks.extend(edges.map(|r| Mark { sign: Sign::Edge, at: (r, 0.0) }));
    }

    fn pressure(&self, exact_name: &str, figure: &mut Figure) {
        let edge = self.edge();
        let place = |r: f64, p: f64| (self.radius(r), self.stress(p));
        let computed: Vec<(f64, f64)> =
            self.inside.profile.inside.iter().map(|at| place(at.radius, at.pressure)).collect();
        let exact: Vec<(f64, f64)> = self.inside.exact.iter().map(|(r, p)| place(*r, *p)).collect();
        let contacts = self.contacts();
        let is_seen = |at: &&(f64, f64)| {
            contacts.iter().any(|[inner, outer]| {
                let margin = (1.0 - FITTED) * (outer - inner);
                (*inner == 0.0 || at.0 >= inner + margin) && at.0 <= outer - margin && at.0 >= *inner
            })
        };
        let zone = self.zone().unwrap_or([f64::INFINITY; 2]);
        let in_zone = |at: &&(f64, f64)| zone[0] <= at.0 && at.0 <= zone[1];
        let seen = computed.iter().chain(&exact).filter(is_seen);
        let seen = seen.chain(computed.iter().filter(in_zone)).copied();
        figure.bounds = Bounds::of(seen.chain([(0.0, 0.0), (self.widest, 0.0)]));
        figure.lines.push(Line::new(Role::Zero, "", vec![(0.0, 0.0), (edge, 0.0)]));
        if !exact.is_empty() {
            figure.lines.push(Line::new(Role::Exact, exact_name, exact));
        }
        for [inner, outer] in &contacts {
            let of = computed.iter().filter(|at| at.0 >= *inner && at.0 <= *outer).copied().collect();
            figure.lines.push(Line::new(Role::Body, "pressure", of));
        }
        let pulled: Vec<(f64, f64)> = computed.iter().filter(in_zone).copied().collect();
        if !pulled.is_empty() {
            figure.lines.push(Line::new(Role::Zone, "zone", pulled));
        }
        let crests = self.crests(0.0, self.inside.profile.contact_radius);
        figure.marks.extend(crests.map(|r| Mark { sign: Sign::Crest, at: (self.radius(r), 0.0) }));
        self.edges(figure);
    }

    fn gap(&self, figure: &mut Figure) {
        let (edge, length) = (self.edge(), self.inside.units.length);
        let profile = &self.inside.profile;
        let line = |value: &dyn Fn(&Outside) -> f64| -> Vec<(f64, f64)> {
            profile
                .outside
                .iter()
                .map(|at| (self.radius(at.radius), self.scale.length(value(at) * length)))
                .collect()
        };
        let deformed = line(&|at| at.gap);
        // The distance above the other body if undeformed, at the same approach.
        let undeformed = line(&|at| at.undeformed - profile.approach);
        let end = profile.outside.last().map_or(profile.contact_radius, |at| at.radius);
        let last = self.radius(end);
        let contacts = self.contacts();
        let first = contacts.first().map_or(edge, |contact| contact[1]);
        let from = (first - INSIDE * (last - edge)).max(0.0);
        figure.bounds = Bounds::of(deformed.iter().chain(&undeformed).copied().chain([(from, 0.0)]));
        // The gaps between contacts, and the regions outside them.
        let holes = profile.contacts.windows(2).map(|pair| [pair[0][1], pair[1][0]]);
        let axis = profile.contacts.first().filter(|first| first[0] > 0.0).map(|first| [0.0, first[0]]);
        let gaps = axis.into_iter().chain(holes).chain([[profile.contact_radius, end]]);
        let gaps: Vec<[f64; 2]> = gaps.map(|ends| ends.map(|r| self.radius(r))).collect();
        let part = |line: &[(f64, f64)], [lo, hi]: [f64; 2]| -> Vec<(f64, f64)> {
            line.iter().filter(|at| at.0 >= lo && at.0 <= hi).copied().collect()
        };
        let crests: Vec<Mark> = self
            .crests(0.0, end)
            .filter_map(|r| {
                let at = self.radius(r);
                let gap = gaps.iter().find(|[lo, hi]| at > *lo && at < *hi)?;
                Some(Mark { sign: Sign::Crest, at: (at, between(&part(&deformed, *gap), at)?) })
            })
            .collect();
        figure.lines.push(Line::new(Role::Zero, "", vec![(edge, 0.0), (last, 0.0)]));
        let lines = |role, name: &str, line: &[(f64, f64)]| -> Vec<Line> {
            gaps.iter().map(|gap| Line::new(role, name, part(line, *gap))).collect()
        };
        figure.lines.extend(lines(Role::Undeformed, "undeformed", &undeformed));
        let touching = contacts.iter().map(|[inner, outer]| vec![(*inner, 0.0), (*outer, 0.0)]);
        figure.lines.extend(touching.map(|points| Line::new(Role::Contact, "contact", points)));
        figure.lines.extend(lines(Role::Body, "gap", &deformed));
        if let Some(ends) = self.zone() {
            figure.lines.push(Line::new(Role::Zone, "zone", part(&deformed, ends)));
        }
        figure.marks.extend(crests);
        self.edges(figure);
    }

    fn energy(&self, figure: &mut Figure) {
        let Some(landscape) = &self.inside.landscape else {
            let rings = self.inside.profile.contacts.len() > 1
                || self.inside.profile.contacts.iter().any(|at| at[0] > 0.0);
            let why = if rings {
                "with rings there is no single radius"
            } else if self.along {
                "it is that of one law of the edge: not of adhesion with a range, nor of an edge that rests"
            } else {
                "the state lies outside the curve"
            };
            figure.missing = Some(why.to_owned());
            return;
        };
        // Relative to the present state.
        let place = |s: f64, potential: f64| {
            (self.radius(s), self.scale.shown(Quantity::Energy, potential * self.inside.units.energy))
        };
        let points: Vec<(f64, f64)> =
            landscape.points.iter().map(|at| place(at.contact_radius, at.potential)).collect();
        let here = place(landscape.present, 0.0);
        figure.bounds = Bounds::of(points.iter().copied());
        figure.lines.push(Line::new(Role::Body, "potential", points));
        for at in &landscape.stationary {
            let sign = if at.stable { Sign::Minimum } else { Sign::Maximum };
            figure.marks.push(Mark { sign, at: place(at.contact_radius, at.potential) });
        }
        if let Some(height) = self.inside.barrier {
            let above = |at: &&Stationary| !at.stable && at.potential.total_cmp(&height).is_eq();
            let top = landscape.stationary.iter().find(above);
            figure.notes.push(format!(
                "barrier {}",
                with_unit(self.scale.units, Quantity::Energy, height * self.inside.units.energy, false, loss)
            ));
            if let Some(top) = top {
                let top = place(top.contact_radius, top.potential);
                figure.lines.push(Line::new(Role::Barrier, "height", vec![here, (top.0, here.1), top]));
                figure.marks.push(Mark { sign: Sign::Barrier, at: top });
            }
        }
        figure.marks.push(Mark { sign: Sign::Walker, at: here });
    }

    /// The crests r = mλ between two reduced radii.
    fn crests(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + use<> {
        /// More crests than this would form a band, not marks.
        const MOST: f64 = 60.0;
        let wave = self.inside.wave.filter(|wave| (to - from) / wave <= MOST);
        let first = wave.map(|wave| ((from / wave).floor() + 1.0, wave));
        first.into_iter().flat_map(move |(first, wave)| {
            std::iter::successors(Some(first), |m| Some(m + 1.0))
                .map(move |m| m * wave)
                .take_while(move |r| *r < to)
        })
    }
}

/// The value at `r` of a line with ascending radii.
fn between(line: &[(f64, f64)], r: f64) -> Option<f64> {
    line.windows(2).find(|pair| pair[0].0 <= r && r <= pair[1].0).map(|pair| {
        let width = pair[1].0 - pair[0].0;
        let share = if width > 0.0 { (r - pair[0].0) / width } else { 0.0 };
        pair[0].1 + (pair[1].1 - pair[0].1) * share
    })
}
