//! What a device sees of a body: approach and retraction at constant speed, quasi-static or with an edge that has a
//! speed.

use super::bodies::{Body, State};
use std::f64::consts::TAU;

/// The direction in which the device moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// The bodies come together.
    In,
    /// The bodies move apart.
    Out,
}

/// One sample.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// The direction in which the device moves.
    pub way: Way,
    /// When it is taken: in seconds, or in steps for a quasi-static device.
    pub time: f64,
    /// The travel of its far end, δ + P/k.
    pub position: f64,
    /// The state of the body; P and s are 0 where the bodies are apart.
    pub state: State,
}

/// A spring and its rows of samples.
#[derive(Debug, Clone, Copy)]
pub struct Device {
    /// k in N/m; infinite for fixed grips.
    pub stiffness: f64,
    /// Rows in each direction.
    pub rows: usize,
    /// The share of the rows of the retraction at which the bodies are apart.
    pub apart: f64,
}

/// Cells in which the state for a position is looked for.
const CELLS: u32 = 4000;

impl Device {
    fn position(&self, state: &State) -> f64 {
        state.approach + state.force / self.stiffness
    }

    /// Approach and retraction.
    pub fn cycle(&self, body: &Body) -> Vec<Sample> {
        let at = |cell: u32| f64::from(cell) / f64::from(CELLS);
        let positions: Vec<f64> = (0..=CELLS).map(|cell| self.position(&body.at(at(cell)))).collect();
        let top = positions[positions.len() - 1];
        let off = positions.iter().copied().fold(f64::INFINITY, f64::min);
        let bottom = off - self.apart / (1.0 - self.apart) * (top - off);
        // The state between two neighbouring cells at which the position is reached.
        let between = |inner: usize, position: f64| {
            let (mut lo, mut hi) = (at(u32::try_from(inner).unwrap()), at(u32::try_from(inner + 1).unwrap()));
            let rises = positions[inner + 1] > positions[inner];
            for _ in 0..60 {
                let middle = 0.5 * (lo + hi);
                if (self.position(&body.at(middle)) > position) == rises { hi = middle } else { lo = middle }
            }
            body.at(0.5 * (lo + hi))
        };
        let apart = |position: f64| State { approach: position, force: 0.0, radius: 0.0 };
        let mut samples = Vec::new();
        // Outward: the first state that reaches as far as the device.
        let mut cell = 0;
        for i in 0..self.rows {
            let position = bottom + (i as f64 + 0.5) / self.rows as f64 * (top - bottom);
            let state = if position < positions[0] {
                apart(position)
            } else {
                while positions[cell + 1] < position {
                    cell += 1;
                }
                between(cell, position)
            };
            samples.push(Sample { way: Way::In, time: samples.len() as f64, position, state });
        }
        // Inward: the first state that is no farther than the device.
        let mut cell = positions.len() - 1;
        for i in 0..self.rows {
            let position = top - (i as f64 + 0.5) / self.rows as f64 * (top - bottom);
            while cell > 0 && positions[cell - 1] > position {
                cell -= 1;
            }
            let state =
                if position < off || cell == 0 { apart(position) } else { between(cell - 1, position) };
            samples.push(Sample { way: Way::Out, time: samples.len() as f64, position, state });
        }
        samples
    }
}

/// A retraction of a sphere whose work of adhesion grows with the speed v of the edge, G = w (1 + (v/v₀)ⁿ): A. N. Gent and
/// J. Schultz, J. Adhesion 3, 281 (1972); D. Maugis and M. Barquins, J. Phys. D 11, 1989 (1978).
#[derive(Debug, Clone, Copy)]
pub struct Peel {
    pub radius: f64,
    pub modulus: f64,
    pub adhesion: f64,
    pub exponent: f64,
    /// v₀ in m/s.
    pub reference: f64,
    /// The speed of the device, m/s.
    pub speed: f64,
    /// k in N/m.
    pub stiffness: f64,
    /// The contact radius at which the retraction begins, in equilibrium.
    pub begin: f64,
}

/// The quantity in which samples are evenly spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum By {
    Time,
    Radius,
}

impl Peel {
    fn approach(&self, s: f64, position: f64) -> f64 {
        let (e, k) = (self.modulus, self.stiffness);
        (position + 2.0 * e * s.powi(3) / (3.0 * self.radius * k)) / (1.0 + 2.0 * e * s / k)
    }

    fn state(&self, s: f64, position: f64) -> State {
        let approach = self.approach(s, position);
        let force = 2.0 * self.modulus * (approach * s - s.powi(3) / (3.0 * self.radius));
        State { approach, force, radius: s }
    }

    /// The speed of the edge.
    fn edge(&self, s: f64, position: f64) -> f64 {
        // An edge under pressure does not open.
        let open = (s * s / self.radius - self.approach(s, position)).max(0.0);
        let released = self.modulus * open * open / (TAU * s);
        self.reference * (released / self.adhesion - 1.0).max(0.0).powf(1.0 / self.exponent)
    }

    /// `rows` samples in contact, evenly spaced in time or in contact radius, down to the share `last` of the first
    /// contact radius.
    pub fn samples(&self, rows: usize, last: f64, by: By) -> Vec<Sample> {
        let whole = self.whole(last);
        let end = whole.len() - 1;
        let radius = |i: usize| whole[i].state.radius;
        let share = |i: usize| i as f64 / (rows - 1) as f64;
        let place = |i: usize| match by {
            By::Time => i * end / (rows - 1),
            By::Radius => {
                let wanted = radius(0) + share(i) * (radius(end) - radius(0));
                whole.partition_point(|sample| sample.state.radius > wanted).min(end)
            }
        };
        (0..rows).map(|i| whole[place(i)]).collect()
    }

    /// Very many samples in contact, down to the share `last` of the first contact radius.
    fn whole(&self, last: f64) -> Vec<Sample> {
        const STEPS: usize = 40_000;
        let s = self.begin;
        let approach = s * s / self.radius - (TAU * self.adhesion * s / self.modulus).sqrt();
        let force = 2.0 * self.modulus * (approach * s - s.powi(3) / (3.0 * self.radius));
        let begin = approach + force / self.stiffness;
        // The travel is several approaches long; it ends where the contact does.
        let step = 4.0 * (s * s / self.radius) / STEPS as f64;
        let time = step / self.speed;
        let (mut s, mut position) = (s, begin);
        let mut whole = Vec::new();
        for _ in 0..20 * STEPS {
            position -= step;
            // Implicit: the edge has the speed that it has at the end of the step.
            let (mut lo, mut hi) = (0.0, s);
            for _ in 0..50 {
                let middle = 0.5 * (lo + hi);
                if middle + time * self.edge(middle, position) > s { hi = middle } else { lo = middle }
            }
            s = 0.5 * (lo + hi);
            if s < last * self.begin {
                break;
            }
            let state = self.state(s, position);
            whole.push(Sample { way: Way::Out, time: whole.len() as f64 * time, position, state });
        }
        whole
    }
}

#[cfg(test)]
mod tests {
    use super::super::bodies::Gap;
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_slow_edge_is_at_equilibrium_and_a_fast_one_holds_more() {
        let (r, e, w) = (1e-3, 1.6e6, 0.06);
        let peel = |speed| Peel {
            radius: r,
            modulus: e,
            adhesion: w,
            exponent: 0.5,
            reference: 1e-6,
            speed,
            stiffness: 1e9,
            begin: 1.2e-4,
        };
        let least = |speed| {
            let samples = peel(speed).samples(2000, 0.3, By::Time);
            samples.iter().map(|sample| sample.state.force).fold(f64::INFINITY, f64::min)
        };
        let critical = -1.5 * PI * w * r;
        assert!((least(1e-12) / critical - 1.0).abs() < 0.02, "{}", least(1e-12) / critical);
        assert!(least(1e-6) / critical > 2.0, "{}", least(1e-6) / critical);
    }

    #[test]
    fn a_spring_is_passed_quasi_statically() {
        let body = Body::adhesive(Gap::Sphere { radius: 1e-3 }, 1.6e6, 0.06, 1.5e-4);
        let device = Device { stiffness: 300.0, rows: 400, apart: 0.2 };
        let samples = device.cycle(&body);
        let apart = samples[400..].iter().filter(|sample| sample.state.radius == 0.0).count();
        assert_eq!(apart, 80);
        for sample in &samples {
            let seen = sample.state.approach + sample.state.force / 300.0;
            assert!((seen - sample.position).abs() < 1e-12);
        }
    }
}
