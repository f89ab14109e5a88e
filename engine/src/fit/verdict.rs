//! What a fit comes to, in one word, and why.
//!
//! Every test here has a false-alarm rate of its own, and all of them together flag at most one right fit in a hundred.

use serde::Serialize;

/// The kind of the reason that the points do not show whether there is a law of speed.
pub(super) const UNTOLD: &str = "speed";

/// What a fit comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Nothing speaks against the model: values and errors may be believed.
    Describes,
    /// Something speaks against it; the values are those of a model that does not hold.
    DoesNotDescribe,
    /// The points do not tell the values apart.
    NotDetermined,
    /// The fit did not come to its end.
    NotConverged,
}

impl Verdict {
    /// The word used in documents.
    pub fn word(self) -> &'static str {
        match self {
            Self::Describes => "describes",
            Self::DoesNotDescribe => "does-not-describe",
            Self::NotDetermined => "not-determined",
            Self::NotConverged => "not-converged",
        }
    }

    /// The verdict of a word.
    pub fn of(word: &str) -> Option<Self> {
        [Self::Describes, Self::DoesNotDescribe, Self::NotDetermined, Self::NotConverged]
            .into_iter()
            .find(|verdict| verdict.word() == word)
    }

    /// The sentence above a result.
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Describes => "the model describes the points",
            Self::DoesNotDescribe => {
                "the model does NOT describe the points: do not believe the values or their errors"
            }
            Self::NotDetermined => "the points do NOT determine the values",
            Self::NotConverged => "the fit did NOT converge: these are the best values so far",
        }
    }

    /// The same for these reasons: that the points do not show a law of speed says nothing against the model.
    pub fn sentence_for(self, reasons: &[Reason]) -> &'static str {
        let is_untold = self == Self::DoesNotDescribe
            && !reasons.is_empty()
            && reasons.iter().all(|reason| reason.kind == UNTOLD);
        if is_untold {
            "the points do NOT show whether this model holds: do not believe the values or their errors"
        } else {
            self.sentence()
        }
    }
}

/// What speaks against a fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Reason {
    /// What was tested, one word for each test.
    pub kind: &'static str,
    /// What was found.
    pub sentence: String,
    /// The statistic, in its own units; `None` where there is none.
    pub value: Option<f64>,
}

impl Reason {
    /// What the test `kind` found.
    #[must_use]
    pub fn new(kind: &'static str, value: f64, sentence: impl Into<String>) -> Self {
        Self { kind, sentence: sentence.into(), value: Some(value).filter(|value| value.is_finite()) }
    }
}
