//! Loading with rings of contact against ring elements without a notion of edges: elements of constant pressure are
//! added as long as the energy falls. A coarse and entirely different method.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use nalgebra::{DMatrix, DVector};
use pulloff_engine::annuli::Ground;
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::problem::Turn;
use pulloff_engine::problem::{Control, Problem};
use pulloff_engine::quasistatic::path::{Direction, Losses, PathSetting, PathState, cycle_on};
use pulloff_engine::ritz::kernel::disc_interaction;
use std::f64::consts::PI;
use std::sync::Arc;

const WAVELENGTH: f64 = 0.05;
const GAMMA: f64 = 1e-4;
/// Number of elements, and how far out they reach.
const ELEMENTS: usize = 240;
const REACH: f64 = 0.2;
/// Values of the approach between two that are compared.
const STEPS: usize = 12;

/// Elements of equal width, each in contact or not.
struct Elements {
    interaction: DMatrix<f64>,
    areas: Vec<f64>,
    /// ∫ h dS.
    gaps: Vec<f64>,
    touching: Vec<bool>,
}

impl Elements {
    fn new(gap: &dyn Gap) -> Self {
        let edge = |i: usize| REACH * i as f64 / ELEMENTS as f64;
        let disc = |a: f64, b: f64| disc_interaction(a.min(b), a.max(b));
        let ring = |i: usize, j: usize| {
            let (a, b, c, d) = (edge(i), edge(i + 1), edge(j), edge(j + 1));
            disc(b, d) - disc(a, d) - disc(b, c) + disc(a, c)
        };
        let gap_of = |i: usize| {
            let n = 20;
            let width = (edge(i + 1) - edge(i)) / f64::from(n);
            let radii = (0..n).map(|k| edge(i) + (f64::from(k) + 0.5) * width);
            radii.map(|r| 2.0 * PI * r * width * gap.jet(r).value).sum()
        };
        Self {
            interaction: DMatrix::from_fn(ELEMENTS, ELEMENTS, ring),
            areas: (0..ELEMENTS).map(|i| PI * (edge(i + 1).powi(2) - edge(i).powi(2))).collect(),
            gaps: (0..ELEMENTS).map(gap_of).collect(),
            touching: vec![false; ELEMENTS],
        }
    }

    /// Adds elements at this approach as long as one overlaps or lowers the energy; returns the force.
    fn settle(&mut self, approach: f64) -> f64 {
        let wanted: Vec<f64> =
            self.areas.iter().zip(&self.gaps).map(|(area, gap)| approach * area - gap).collect();
        loop {
            let inside: Vec<usize> = (0..ELEMENTS).filter(|i| self.touching[*i]).collect();
            let outside: Vec<usize> = (0..ELEMENTS).filter(|i| !self.touching[*i]).collect();
            let block = |rows: &[usize], columns: &[usize]| {
                DMatrix::from_fn(rows.len(), columns.len(), |i, j| self.interaction[(rows[i], columns[j])])
            };
            let between = block(&inside, &outside);
            let solver = block(&inside, &inside).cholesky().unwrap();
            let pressure =
                solver.solve(&DVector::from_iterator(inside.len(), inside.iter().map(|i| wanted[*i])));
            let response = solver.solve(&between);
            // Holding an element costs ½ r²/s of elastic energy and gains γ on its area.
            let change = |k: usize| {
                let i = outside[k];
                let overlap = wanted[i] - between.column(k).dot(&pressure);
                let stiffness = self.interaction[(i, i)] - between.column(k).dot(&response.column(k));
                let beside = i.checked_sub(1).is_some_and(|inner| self.touching[inner])
                    || self.touching.get(i + 1).is_some_and(|outer| *outer);
                if overlap > 0.0 {
                    f64::NEG_INFINITY
                } else if !beside {
                    // Adhesion has no range: away from a contact, only an element that touches begins a new one.
                    f64::INFINITY
                } else {
                    0.5 * overlap * overlap / stiffness - GAMMA * self.areas[i]
                }
            };
            let best = (0..outside.len()).map(|k| (k, change(k))).min_by(|a, b| a.1.total_cmp(&b.1));
            match best {
                Some((k, change)) if change < 0.0 => self.touching[outside[k]] = true,
                _ => return inside.iter().zip(pressure.iter()).map(|(i, p)| self.areas[*i] * p).sum(),
            }
        }
    }

    /// The contacts formed by the elements.
    fn contacts(&self) -> Vec<[f64; 2]> {
        let width = REACH / ELEMENTS as f64;
        let mut contacts: Vec<[f64; 2]> = Vec::new();
        for i in (0..ELEMENTS).filter(|i| self.touching[*i]) {
            let [a, b] = [i as f64 * width, (i + 1) as f64 * width];
            match contacts.last_mut() {
                Some(last) if (last[1] - a).abs() < 0.5 * width => last[1] = b,
                _ => contacts.push([a, b]),
            }
        }
        contacts
    }
}

#[test]
fn elements_added_while_the_energy_falls_find_the_same_contacts() {
    let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: WAVELENGTH };
    let gap = Problem { effective_modulus: 1.0, work_of_adhesion: 0.0, shape }.reduced().gap;
    let ground = Ground::of(Arc::clone(&gap), 0.5).unwrap();
    let turn = Turn::Approach(0.03);
    let setting = PathSetting { losses: Losses::Once, ..PathSetting::new(Control::Displacement) };
    let found = cycle_on(&ground, GAMMA, turn, &setting, &pulloff_engine::progress::Unwatched).unwrap();
    let loading = |state: &&PathState| state.direction == Direction::Loading;
    let pieces = found.states.iter().filter(loading).map(|state| state.piece).max().unwrap();
    // The middle of each stretch of loading, because limit points move with the width of an element.
    let middles: Vec<&PathState> = (0..=pieces)
        .filter_map(|piece| {
            let states: Vec<_> = found.states.iter().filter(loading).filter(|s| s.piece == piece).collect();
            let [first, last] = [states.first()?, states.last()?].map(|state| state.approach);
            states.into_iter().min_by(|a, b| {
                let away = |state: &PathState| (state.approach - 0.5 * (first + last)).abs();
                away(a).total_cmp(&away(b))
            })
        })
        // Wide enough for the elements, and within their reach.
        .filter(|state| (0.2 * REACH..0.9 * REACH).contains(&state.contact_radius))
        .collect();
    assert!(middles.len() >= 4 && middles.iter().any(|state| state.contacts.len() > 1));
    let mut elements = Elements::new(&*gap);
    elements.touching[0] = true;
    let width = REACH / ELEMENTS as f64;
    let mut from = 0.0;
    for state in middles {
        let mut force = 0.0;
        for step in 1..=STEPS {
            force = elements.settle(from + (state.approach - from) * step as f64 / STEPS as f64);
        }
        from = state.approach;
        let contacts = elements.contacts();
        println!("{from:.5}: {force:.6e} {:.6e} {contacts:.4?} {:.4?}", state.force, state.contacts);
        assert_eq!(contacts.len(), state.contacts.len(), "{contacts:?} {:?}", state.contacts);
        for (ours, theirs) in contacts.iter().flatten().zip(state.contacts.iter().flatten()) {
            assert!((ours - theirs).abs() < 1.5 * width, "{contacts:?} {:?}", state.contacts);
        }
        let size = 2.0 * state.approach * state.contact_radius;
        assert!((force - state.force).abs() < 0.02 * size, "{force} {}", state.force);
    }
}
