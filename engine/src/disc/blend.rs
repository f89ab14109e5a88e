//! Mixtures of gaps: where a gap is linear in some numbers, so is g, and the transforms of a few gaps on the same
//! panels give that of every mixture by one sum.

use super::chebyshev::ChebyshevRule;
use super::clusters::NODES;
use super::panels::Panels;
use super::sources::Sources;
use super::spans::{TableError, graded};
use crate::gap::{Form, Gap};
use crate::gap::{panels::Span, panels::divide};
use crate::progress::Progress;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// Borders of panels nearer to each other than this share of their radius count as one.
const SAME: f64 = 1e-12;

/// g and its slope at the nodes of a panel.
type PanelSamples = [[f64; NODES]; 2];

/// The transforms of some gaps on the same panels.
#[derive(Debug)]
struct Tabulated {
    spans: Vec<Span>,
    /// Whether slopes are with respect to the variable of the panel.
    steep: Vec<bool>,
    /// One list for each gap.
    samples: Vec<Vec<PanelSamples>>,
}

/// Gaps whose mixtures are tabulated.
pub struct Blend {
    gaps: Vec<Arc<dyn Gap>>,
    /// The transforms made so far, by the reach and the smallest radius.
    known: Mutex<Vec<([u64; 2], Arc<Tabulated>)>>,
}

impl fmt::Debug for Blend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Blend").field("gaps", &self.gaps).finish_non_exhaustive()
    }
}

impl Blend {
    /// Mixtures of `gaps`; `None` where one of them has a transform of its own that costs less.
    pub fn of(gaps: Vec<Arc<dyn Gap>>) -> Option<Self> {
        let sampled = gaps.iter().all(|gap| matches!(gap.form(), Form::Any));
        sampled.then(|| Self { gaps, known: Mutex::default() })
    }

    /// Adds the panels of the mixture with these weights, one for each gap, up to `reach`.
    ///
    /// # Errors
    /// [`TableError`].
    pub(super) fn fill(
        &self,
        weights: &[f64],
        panels: &mut Panels,
        reach: f64,
        progress: &dyn Progress,
    ) -> Result<(), TableError> {
        let tabulated = self.tabulated(reach, panels.smallest, progress)?;
        let rule = ChebyshevRule::of(NODES);
        for (k, span) in tabulated.spans.iter().enumerate() {
            let mut mixed: PanelSamples = [[0.0; NODES]; 2];
            for (weight, samples) in weights.iter().zip(&tabulated.samples) {
                for (sum, part) in mixed.as_flattened_mut().iter_mut().zip(samples[k].as_flattened()) {
                    *sum += weight * part;
                }
            }
            let [value, slope] = &mixed;
            panels.push(*span, rule, value, slope, tabulated.steep[k]);
        }
        Ok(())
    }

    fn tabulated(
        &self,
        reach: f64,
        smallest: f64,
        progress: &dyn Progress,
    ) -> Result<Arc<Tabulated>, TableError> {
        let key = [reach.to_bits(), smallest.to_bits()];
        let lock = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = lock().iter().find(|(known, _)| *known == key) {
            return Ok(Arc::clone(found));
        }
        let mut breaks: Vec<f64> = self.gaps.iter().flat_map(|gap| gap.breaks_up_to(reach)).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let divided = self.gaps.iter().map(|gap| {
            let spans = divide(&**gap, [0.0, reach], smallest, &breaks).map_err(TableError::TooFine)?;
            Ok(graded(&**gap, spans))
        });
        let spans = common(&divided.collect::<Result<Vec<_>, TableError>>()?);
        let mut steep = vec![false; spans.len()];
        let mut samples = Vec::with_capacity(self.gaps.len());
        let sources: Vec<Sources> = self
            .gaps
            .iter()
            .map(|gap| Sources::new(&**gap, &spans, &breaks, progress))
            .collect::<Result<_, _>>()?;
        for (steep, span) in steep.iter_mut().zip(&spans) {
            *steep = span.is_steep(|base| sources.iter().any(|sources| sources.jumps_at(base)));
        }
        let rule = ChebyshevRule::of(NODES);
        for (gap, sources) in self.gaps.iter().zip(&sources) {
            let mut of_gap = Vec::with_capacity(spans.len());
            for (span, steep) in spans.iter().zip(&steep) {
                progress.go_on()?;
                let mut own: PanelSamples = [[0.0; NODES]; 2];
                let by_variable = span.is_steep(|base| sources.jumps_at(base));
                for (j, x) in rule.nodes.iter().enumerate() {
                    let [value, slope] = sources.transform(&**gap, span, *x);
                    // All with respect to the variable of the panel where one of them is.
                    let stretch = if *steep && !by_variable { span.stretch(*x) } else { 1.0 };
                    (own[0][j], own[1][j]) = (value, slope * stretch);
                }
                of_gap.push(own);
            }
            samples.push(of_gap);
        }
        let made = Arc::new(Tabulated { spans, steep, samples });
        lock().push((key, Arc::clone(&made)));
        Ok(made)
    }
}

/// Panels with the borders of all these lists, which reach equally far and have the same breaks.
fn common(lists: &[Vec<Span>]) -> Vec<Span> {
    let mut borders: Vec<f64> = lists.iter().flatten().map(|span| span.hi).collect();
    borders.sort_by(f64::total_cmp);
    borders.dedup_by(|b, a| *b - *a <= SAME * *b);
    let mut spans = Vec::with_capacity(borders.len());
    let mut lo = 0.0;
    let Some(list) = lists.first() else { return spans };
    for hi in borders {
        let middle = 0.5 * (lo + hi);
        let at = list.partition_point(|span| span.hi < middle).min(list.len().saturating_sub(1));
        // How radius is measured follows from the breaks alone.
        let variable = list[at].variable;
        spans.push(Span { lo, hi, variable });
        lo = hi;
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disc::Table;
    use crate::gap::Shape;
    use crate::gap::formula::TypedGap;
    use crate::progress::Unwatched;

    fn formula(text: &str) -> Arc<dyn Gap> {
        Arc::new(Shape::Formula(Arc::new(TypedGap::new(text, Vec::new(), Some(0.6)).unwrap())))
    }

    #[test]
    fn a_mixture_has_the_table_of_its_own_gap() {
        // A corner, a narrow bump that only one of them has, and numbers in between.
        let text = |a: f64, b: f64| {
            format!("r^2/2 + {a:?}*abs(r-0.12) + {b:?}*exp(-((r-0.2)/0.003)^2) + 0.001*cos(60*r)")
        };
        let gaps = [text(0.0, 0.0), text(0.03, 0.0), text(0.0, 0.002), text(0.03, 0.002)];
        let blend = Arc::new(Blend::of(gaps.iter().map(|text| formula(text)).collect()).unwrap());
        let weights = vec![0.7 * 0.4, 0.3 * 0.4, 0.7 * 0.6, 0.3 * 0.6];
        let gap = formula(&text(0.3 * 0.03, 0.6 * 0.002));
        let mixed = Table::of_blend(Arc::clone(&gap), &blend, weights).up_to(0.5).unwrap();
        let own = Table::new(gap, 0.5, &Unwatched).unwrap().up_to(0.5).unwrap();
        assert_eq!(mixed.reach().to_bits(), own.reach().to_bits());
        for k in 1..400 {
            let a = 0.5 * f64::from(k) / 400.0;
            let [mixed, own] = [&mixed, &own].map(|panels| panels.values(panels.place(a)));
            for (m, o, size) in [
                (mixed.value, own.value, a * a),
                (mixed.slope, own.slope, own.slope.abs().max(1.0)),
                (mixed.area, own.area, a * a * a),
                (mixed.square, own.square, a.powi(5)),
            ] {
                assert!((m - o).abs() <= 3e-11 * size, "{a}: {m} {o}");
            }
        }
    }
}
