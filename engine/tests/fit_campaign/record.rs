//! What an instrument writes from samples, with its faults, and the text of its file.

use super::device::{Sample, Way};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Random numbers from one seed.
pub struct Random(fastrand::Rng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(0x6669_7473 ^ seed.wrapping_mul(0x9E37_79B9_7F4A_7C15)))
    }

    pub fn even(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.0.f64()
    }

    /// Uniform in the logarithm.
    pub fn scale(&mut self, lo: f64, hi: f64) -> f64 {
        self.even(lo.ln(), hi.ln()).exp()
    }

    /// Normal, with standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.0.f64(), self.0.f64());
        (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
    }
}

/// What is written beside the force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    Approach,
    Position,
    Radius,
}

/// The rows of a file, in SI.
#[derive(Debug, Clone)]
pub struct Record {
    seen: Seen,
    pub x: Vec<f64>,
    pub force: Vec<f64>,
    pub ways: Vec<Way>,
    /// When each row was taken.
    times: Vec<f64>,
    /// Whether a column holds the times.
    pub has_times: bool,
    /// Whether a column names the direction of the device.
    pub names_ways: bool,
}

impl Record {
    pub fn of(samples: &[Sample], seen: Seen) -> Self {
        let x = samples.iter().map(|sample| match seen {
            Seen::Approach => sample.state.approach,
            Seen::Position => sample.position,
            Seen::Radius => sample.state.radius,
        });
        Self {
            seen,
            x: x.collect(),
            force: samples.iter().map(|sample| sample.state.force).collect(),
            ways: samples.iter().map(|sample| sample.way).collect(),
            times: samples.iter().map(|sample| sample.time).collect(),
            has_times: false,
            names_ways: true,
        }
    }

    /// The rows that `keep` selects by their numbers.
    pub fn kept(&self, keep: impl Fn(usize) -> bool) -> Self {
        self.ordered(&(0..self.x.len()).filter(|i| keep(*i)).collect::<Vec<_>>())
    }

    /// The rows with these numbers, in their order.
    pub fn ordered(&self, rows: &[usize]) -> Self {
        Self {
            x: rows.iter().map(|i| self.x[*i]).collect(),
            force: rows.iter().map(|i| self.force[*i]).collect(),
            ways: rows.iter().map(|i| self.ways[*i]).collect(),
            times: rows.iter().map(|i| self.times[*i]).collect(),
            ..*self
        }
    }

    /// The retraction before the approach.
    pub fn turned_round(&self) -> Self {
        let of = |way: Way| (0..self.x.len()).filter(move |i| self.ways[*i] == way);
        self.ordered(&of(Way::Out).chain(of(Way::In)).collect::<Vec<_>>())
    }

    /// Every row twice in succession.
    pub fn doubled(&self) -> Self {
        self.ordered(&(0..2 * self.x.len()).map(|i| i / 2).collect::<Vec<_>>())
    }

    /// This record followed by another one.
    pub fn then(mut self, other: &Self) -> Self {
        self.x.extend(&other.x);
        self.force.extend(&other.force);
        self.ways.extend(&other.ways);
        self.times.extend(&other.times);
        self
    }

    /// Only one direction.
    pub fn only(&self, way: Way) -> Self {
        self.kept(|i| self.ways[i] == way)
    }

    /// x and P replaced by `change`, which gets the number of the row and both values.
    pub fn changed(mut self, mut change: impl FnMut(usize, f64, f64) -> [f64; 2]) -> Self {
        for i in 0..self.x.len() {
            [self.x[i], self.force[i]] = change(i, self.x[i], self.force[i]);
        }
        self
    }

    pub fn noisy(self, sigma: f64, random: &mut Random) -> Self {
        self.changed(|_, x, force| [x, force + sigma * random.normal()])
    }

    /// Noise of which the share `memory` carries over from row to row.
    pub fn correlated(self, sigma: f64, memory: f64, random: &mut Random) -> Self {
        let mut noise = random.normal();
        self.changed(|_, x, force| {
            noise = memory * noise + (1.0 - memory * memory).sqrt() * random.normal();
            [x, force + sigma * noise]
        })
    }

    /// The share `share` of the rows is off by `by`, in either direction.
    pub fn with_outliers(self, share: f64, by: f64, random: &mut Random) -> Self {
        self.changed(|_, x, force| {
            let off = if random.even(0.0, 1.0) < share { by * random.normal().signum() } else { 0.0 };
            [x, force + off]
        })
    }

    /// Rounded to the nearest step of a converter.
    pub fn quantized(self, step: f64) -> Self {
        self.changed(|_, x, force| [x, (force / step).round() * step])
    }

    /// The text of the file.
    pub fn text(&self) -> String {
        let mut text = String::from(match self.seen {
            Seen::Approach => "approach [m]",
            Seen::Position => "position [m]",
            Seen::Radius => "contact radius [m]",
        });
        text.push_str(",force [N]");
        text.push_str(if self.has_times { ",time [ms]" } else { "" });
        text.push_str(if self.names_ways { ",segment\n" } else { "\n" });
        for (i, (x, force)) in self.x.iter().zip(&self.force).enumerate() {
            write!(text, "{x:.9e},{force:.9e}").unwrap();
            if self.has_times {
                write!(text, ",{:.9e}", 1e3 * self.times[i]).unwrap();
            }
            text.push_str(match self.ways[i] {
                _ if !self.names_ways => "\n",
                Way::In => ",approach\n",
                Way::Out => ",retraction\n",
            });
        }
        text
    }
}
