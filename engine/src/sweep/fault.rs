//! Why a row has no result, or only part of one.

use crate::case::CaseError;
use crate::fit::FitError;
use crate::preset::Invalid;
use crate::progress::Stopped;
use crate::quasistatic::path::PathError;
use crate::report::pull::PullError;
use crate::text::sanitize;
use std::any::Any;
use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

/// The longest text of a fault, in characters.
const LONGEST: usize = 300;

/// What went wrong in a row: one of a few reasons, and the full text in words. On one line and safe to show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// One of [`REASONS`].
    pub reason: &'static str,
    text: String,
}

/// All reasons.
pub const REASONS: [&str; 14] = [
    "refused value",
    "no basis",
    "no start",
    "unstable start",
    "incomplete",
    "small start",
    "panic",
    "no loop",
    "row limit",
    "no fit",
    "members",
    "no pull",
    "range",
    "early end",
];

impl Fault {
    fn new(reason: &'static str, text: &str) -> Self {
        Self { reason, text: sanitize(&text.replace('\n', " "), LONGEST) }
    }

    /// A value that the preset does not take.
    #[must_use]
    pub fn of_value(invalid: &Invalid) -> Self {
        Self::new(REASONS[0], &invalid.to_string())
    }

    /// A case that could not be computed.
    #[must_use]
    pub fn of_case(error: &CaseError) -> Self {
        let reason = match error {
            CaseError::Basis(_) | CaseError::Table { .. } => REASONS[1],
            CaseError::Start { .. } | CaseError::EndOutsideStart { .. } => REASONS[2],
            CaseError::Path { error, .. } if matches!(**error, PathError::UnstableStart { .. }) => REASONS[3],
            CaseError::Path { .. } => REASONS[7],
            CaseError::Stopped(Stopped) => REASONS[4],
            CaseError::HasRange { .. } => REASONS[12],
        };
        Self::new(reason, &error.to_string())
    }

    /// A pull that cannot be made.
    #[must_use]
    pub fn of_pull(error: &PullError) -> Self {
        match error {
            PullError::Case(error) => Self::of_case(error),
            error => Self::new(REASONS[11], &error.to_string()),
        }
    }

    /// A pull that starts from a disc that cannot exist.
    #[must_use]
    pub fn overlapping_start() -> Self {
        Self::new(REASONS[11], "the bodies would overlap outside the disc from which the pull starts")
    }

    /// A measured curve that cannot be fitted.
    #[must_use]
    pub fn of_fit(error: &FitError) -> Self {
        Self::new(REASONS[9], &error.to_string())
    }

    /// A fit whose values are not usable.
    #[must_use]
    pub fn bad_fit(why: &str) -> Self {
        Self::new(REASONS[9], why)
    }

    /// A path that stopped early.
    #[must_use]
    pub fn incomplete(why: &str) -> Self {
        Self::new(REASONS[4], why)
    }

    /// A point of an ensemble with missing members: how many there are, of how many in all, and the reasons of those
    /// that have a fault.
    pub fn of_members([there, of]: [u64; 2], refused: &BTreeMap<&str, u64>) -> Option<Self> {
        let counts: Vec<String> = refused.iter().map(|(reason, count)| format!("{count} {reason}")).collect();
        let total: u64 = refused.values().sum();
        match (there < of, total > 0) {
            (false, false) => None,
            (true, false) => Some(Self::new(REASONS[4], &format!("{there} of {of} members"))),
            (true, true) => {
                let counts = counts.join(", ");
                Some(Self::new(
                    REASONS[4],
                    &format!("{there} of {of} members, {total} of them with an error ({counts})"),
                ))
            }
            (false, true) => Some(Self::new(
                REASONS[10],
                &format!("{total} of {of} with an error ({})", counts.join(", ")),
            )),
        }
    }

    /// A row that took longer than allowed.
    #[must_use]
    pub fn of_limit(limit: Duration) -> Self {
        Self::new(REASONS[8], &format!("it took longer than {} s", limit.as_secs_f64()))
    }

    /// A curve on which the start cuts off the state at which something is smallest.
    #[must_use]
    pub fn small_start() -> Self {
        Self::new(
            REASONS[5],
            "a contact larger than that at the start has, or may have, a smaller value: start further out",
        )
    }

    /// A path that ends in contact while something still falls.
    #[must_use]
    pub fn early_end() -> Self {
        Self::new(
            REASONS[13],
            "a contact smaller than that at the end has, or may have, a smaller value: decrease path.end_contact_radius, or \
             set it to none",
        )
    }

    /// A panic, which is a fault of the program itself.
    #[must_use]
    pub fn of_panic(payload: &(dyn Any + Send)) -> Self {
        let words = payload.downcast_ref::<String>().map(String::as_str);
        let words = words.or_else(|| payload.downcast_ref::<&str>().copied());
        Self::new(REASONS[6], words.unwrap_or("no message"))
    }

    /// The reason that a written fault begins with.
    pub fn reason_of(text: &str) -> Option<&'static str> {
        let reason = text.split_once(": ")?.0;
        REASONS.into_iter().find(|known| *known == reason)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.reason, self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_one_line_that_begins_with_its_reason() {
        let fault = Fault::new(REASONS[2], "a\nb\u{1b}[2Jc");
        assert_eq!(fault.to_string(), "no start: a b\u{fffd}[2Jc");
        assert_eq!(Fault::reason_of(&fault.to_string()), Some("no start"));
        assert_eq!(Fault::reason_of("nothing of ours: x"), None);
        let caught = std::panic::catch_unwind(|| panic!("at {}", 7)).unwrap_err();
        assert_eq!(Fault::of_panic(caught.as_ref()).to_string(), "panic: at 7");
    }
}
