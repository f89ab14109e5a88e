//! How far a curve that is computed has come.

use std::mem::discriminant;
use std::time::{Duration, Instant};

/// What a curve is at; it passes these in order, without those that are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress {
    /// The basis is built: the share done, from 0 to 1.
    Basis(f64),
    /// The equilibria are computed: so many so far.
    Curve(usize),
    Limits,
    /// Its unloading is followed: the events found.
    Events(usize),
}

impl Progress {
    /// In words, short.
    pub fn text(self) -> String {
        // Never 100 %: a part is complete only when the next has begun.
        match self {
            Self::Basis(share) => format!("basis {:.0} %", (100.0 * share).floor().clamp(0.0, 99.0)),
            Self::Curve(done) => format!("point {done}"),
            Self::Limits => "limit points".to_owned(),
            Self::Events(found) => format!("event {}", found + 1),
        }
    }
}

/// When a computation is told of: not while it is short, and seldom enough to be read.
#[derive(Debug)]
pub struct Pace {
    begun: Instant,
    told: Option<(Instant, Progress)>,
}

/// Shorter computations report nothing.
const SHORT: Duration = Duration::from_millis(100);
/// Least time between two reports.
const BETWEEN: Duration = Duration::from_millis(250);

impl Pace {
    /// For a computation that begins now.
    pub fn begin() -> Self {
        Self { begun: Instant::now(), told: None }
    }

    /// Whether `progress` is to be told now; another part of the computation may be a long one, so it is told at once.
    pub fn is_due(&mut self, progress: Progress) -> bool {
        let is_due = match self.told {
            None => self.begun.elapsed() >= SHORT,
            Some((at, last)) => at.elapsed() >= BETWEEN || discriminant(&last) != discriminant(&progress),
        };
        if is_due {
            self.told = Some((Instant::now(), progress));
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::CurveData;
    use crate::store::{read, shipped};
    use pulloff_engine::preset::Value;

    #[test]
    fn a_curve_passes_its_parts_in_order_and_counts_every_point() {
        let mut preset = read("t", shipped::find("wavy-sphere").unwrap().text).unwrap();
        preset.set("basis.kind", "rings".into()).unwrap();
        preset.set("basis.rings", Value::Integer(137)).unwrap();
        let mut told = Vec::new();
        let curve = CurveData::compute(&preset, |progress| {
            told.push(progress);
            true
        });
        assert!(!curve.unwrap().points.is_empty());
        let part = |progress: &Progress| match progress {
            Progress::Basis(_) => 0,
            Progress::Curve(_) => 1,
            Progress::Limits => 2,
            Progress::Events(_) => 3,
        };
        assert!(told.is_sorted_by_key(part), "{told:?}");
        let counted: Vec<_> = told.iter().filter(|progress| part(progress) == 1).copied().collect();
        let expected: Vec<_> = (1..=counted.len()).map(Progress::Curve).collect();
        assert!(counted == expected && !counted.is_empty(), "{counted:?}");
        assert!(told.iter().any(|progress| part(progress) == 0), "the rings are built in blocks");
        assert!(told.contains(&Progress::Limits) && told.contains(&Progress::Events(5)));
        assert_eq!(Progress::Basis(0.999).text(), "basis 99 %");
    }
}
