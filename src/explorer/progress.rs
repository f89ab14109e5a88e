//! How far the computation of a curve has come.

use pulloff_engine::progress::Progress;
use std::cell::Cell;
use std::mem::discriminant;
use std::time::{Duration, Instant};

/// The stage that a curve has reached; the stages come in this order, without those whose results are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CurveStage {
    /// The basis is being built: the share done, from 0 to 1.
    Basis(f64),
    /// The equilibria are being computed: the number of the current one, from 1.
    Curve(usize),
    Limits,
    /// The path is being followed for its events.
    Events,
}

impl CurveStage {
    /// A short text for it.
    pub fn text(self) -> String {
        // Never 100 %: a part is complete only when the next has begun.
        match self {
            Self::Basis(share) => format!("basis {:.0} %", (100.0 * share).floor().clamp(0.0, 99.0)),
            Self::Curve(done) => format!("point {done}"),
            Self::Limits => "limit points".to_owned(),
            Self::Events => "events".to_owned(),
        }
    }
}

/// Reports the stages of a curve, once for each question of the engine.
pub struct Staged<'a> {
    stage: Cell<CurveStage>,
    stop: &'a dyn Fn(CurveStage) -> bool,
}

impl<'a> Staged<'a> {
    /// Reports them to `stop`, which says whether to end the computation.
    pub fn new(stop: &'a dyn Fn(CurveStage) -> bool) -> Self {
        Self { stage: Cell::new(CurveStage::Basis(0.0)), stop }
    }

    /// Reports to nobody, and continues to the end.
    pub fn unwatched() -> Self {
        Self::new(&|_| false)
    }

    /// Begins a stage.
    pub fn enter(&self, stage: CurveStage) {
        self.stage.set(stage);
    }
}

impl Progress for Staged<'_> {
    fn report(&self, share: f64) {
        if let CurveStage::Basis(_) = self.stage.get() {
            self.stage.set(CurveStage::Basis(share));
        }
    }

    fn stop(&self) -> bool {
        let stage = self.stage.get();
        self.stage.set(match stage {
            CurveStage::Curve(number) => CurveStage::Curve(number + 1),
            stage => stage,
        });
        (self.stop)(stage)
    }
}

/// Turns `stop` into a signal that stays on once it has been given.
pub fn for_good(stop: impl Fn() -> bool) -> impl Fn() -> bool {
    let stopped = Cell::new(false);
    move || {
        stopped.set(stopped.get() || stop());
        stopped.get()
    }
}

/// When to report on a computation: not while it is short, and rarely enough to be readable.
#[derive(Debug)]
pub struct ProgressPace {
    begun: Instant,
    told: Option<(Instant, CurveStage)>,
}

/// Shorter computations report nothing.
const SHORT: Duration = Duration::from_millis(100);
/// The least time between two reports.
const BETWEEN: Duration = Duration::from_millis(250);

impl ProgressPace {
    /// The pace for a computation that begins now.
    pub fn begin() -> Self {
        Self { begun: Instant::now(), told: None }
    }

    /// Whether to report `stage` now; a new stage may take long, so it is reported at once.
    pub fn is_due(&mut self, stage: CurveStage) -> bool {
        let is_due = match self.told {
            None => self.begun.elapsed() >= SHORT,
            Some((at, last)) => at.elapsed() >= BETWEEN || discriminant(&last) != discriminant(&stage),
        };
        if is_due {
            self.told = Some((Instant::now(), stage));
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
    use std::cell::RefCell;

    #[test]
    fn a_curve_passes_its_parts_in_order_and_counts_every_point() {
        let mut preset = read("t", shipped::find("wavy-sphere").unwrap().text).unwrap();
        preset.set("basis.kind", "rings".into()).unwrap();
        preset.set("basis.rings", Value::Integer(137)).unwrap();
        let heard = RefCell::new(Vec::new());
        let hear = |stage| {
            heard.borrow_mut().push(stage);
            false
        };
        let curve = CurveData::compute(&preset, &Staged::new(&hear));
        let told = heard.into_inner();
        assert!(!curve.unwrap().points.is_empty());
        let part = |stage: &CurveStage| match stage {
            CurveStage::Basis(_) => 0,
            CurveStage::Curve(_) => 1,
            CurveStage::Limits => 2,
            CurveStage::Events => 3,
        };
        assert!(told.is_sorted_by_key(part), "{told:?}");
        let counted: Vec<_> = told.iter().filter(|stage| part(stage) == 1).copied().collect();
        let expected: Vec<_> = (1..=counted.len()).map(CurveStage::Curve).collect();
        assert!(counted == expected && !counted.is_empty(), "{counted:?}");
        assert!(told.iter().any(|stage| part(stage) == 0), "the rings are built in blocks");
        assert!(told.contains(&CurveStage::Limits) && told.contains(&CurveStage::Events));
        assert_eq!(CurveStage::Basis(0.999).text(), "basis 99 %");
    }
}
