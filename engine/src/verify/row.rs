//! One comparison: a number of ours with the exact one, or two numbers of ours that theory says are the same.

/// One number compared with theory, or with another number of ours.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifyRow {
    /// What the number is.
    pub what: String,
    /// The engine's number; NaN if it could not be computed.
    pub ours: f64,
    /// The exact number; NaN if ours is compared with another number of ours.
    pub exact: f64,
    /// The other number of ours, if that is what it is compared with.
    pub other: Option<f64>,
    /// (ours − exact)/scale or (ours − other)/scale, with the scale that the group states.
    pub difference: f64,
    /// The largest absolute difference that passes.
    pub bound: f64,
}

/// Rows that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// What is compared, with the basis.
    pub title: String,
    /// What its differences are divided by.
    pub measure: &'static str,
    /// The comparisons.
    pub rows: Vec<VerifyRow>,
}

impl Group {
    /// The rows against theory, and, under a heading that says so, the rows that compare two numbers of ours, whose
    /// differences are divided as `own_measure` says.
    pub fn apart(self, own_measure: &'static str) -> [Self; 2] {
        let Self { title, measure, rows } = self;
        let (own, exact) = rows.into_iter().partition(|row| row.other.is_some());
        let own_title = format!("Self-consistency: {title}");
        [Self { title, measure, rows: exact }, Self { title: own_title, measure: own_measure, rows: own }]
    }
}

impl VerifyRow {
    /// `ours` compared with `exact`, the difference divided by `scale > 0`.
    pub fn new(what: impl Into<String>, ours: f64, exact: f64, scale: f64, bound: f64) -> Self {
        Self { what: what.into(), ours, exact, other: None, difference: (ours - exact) / scale, bound }
    }

    /// `ours` compared with another number of ours that theory says is the same, the difference divided by `scale > 0`.
    pub fn own(what: impl Into<String>, ours: f64, other: f64, scale: f64, bound: f64) -> Self {
        let row = Self::new(what, ours, other, scale, bound);
        Self { exact: f64::NAN, other: Some(other), ..row }
    }

    /// `ours` compared with `exact`, the difference divided by the exact number.
    pub fn relative(what: impl Into<String>, ours: f64, exact: f64, bound: f64) -> Self {
        Self::new(what, ours, exact, exact.abs(), bound)
    }

    /// The pair `(ours, exact)` that differs most, the difference divided by `scale`. A NaN counts as the worst, and no
    /// pair at all fails.
    pub fn worst(
        what: impl Into<String>,
        pairs: impl IntoIterator<Item = (f64, f64)>,
        scale: f64,
        bound: f64,
    ) -> Self {
        let off = |&(ours, exact): &(f64, f64)| (ours - exact).abs();
        let worst = pairs.into_iter().max_by(|a, b| off(a).total_cmp(&off(b)));
        let (ours, exact) = worst.unwrap_or((f64::NAN, f64::NAN));
        Self::new(what, ours, exact, scale, bound)
    }

    /// Whether the difference is within its bound; NaN is not.
    pub fn passes(&self) -> bool {
        self.difference.abs() <= self.bound
    }
}

#[cfg(test)]
mod tests {
    use super::{Group, VerifyRow};

    #[test]
    fn within_the_bound_passes_and_what_is_no_number_fails() {
        assert!(VerifyRow::relative("", 1.01, 1.0, 0.02).passes());
        assert!(VerifyRow::new("", 8.0, 8.0, 1.0, 0.0).passes());
        assert!(!VerifyRow::relative("", 0.97, 1.0, 0.02).passes());
        assert!(!VerifyRow::relative("", f64::NAN, 1.0, 0.02).passes());
        assert!(!VerifyRow::worst("", [], 1.0, 1.0).passes());
        let worst = VerifyRow::worst("", [(1.0, 1.1), (3.0, 2.8), (2.0, 2.0)], 2.0, 0.05);
        assert!(
            (worst.ours - 3.0).abs() < 1e-15 && (worst.difference - 0.1).abs() < 1e-15 && !worst.passes()
        );
        assert!(!VerifyRow::worst("", [(1.0, 1.0), (f64::NAN, 2.0)], 1.0, 1.0).passes());
    }

    #[test]
    fn two_numbers_of_ours_are_never_called_exact() {
        let own = VerifyRow::own("area", 1.02, 1.0, 1.0, 0.05);
        assert!(own.exact.is_nan() && own.other == Some(1.0) && own.passes());
        assert!(!VerifyRow::own("area", f64::NAN, f64::NAN, 1.0, 0.05).passes());
        let group = Group {
            title: "A".to_owned(),
            measure: "relative",
            rows: vec![own, VerifyRow::relative("", 1.0, 1.0, 0.0)],
        };
        let [exact, own] = group.apart("over all");
        assert_eq!((&*exact.title, exact.rows.len()), ("A", 1));
        assert_eq!((&*own.title, own.measure, own.rows.len()), ("Self-consistency: A", "over all", 1));
    }
}
