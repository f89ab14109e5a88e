//! Our numbers against theory, as rows that pass or fail.
//!
//! A row compares a number of the engine with the exact one, which comes from the closed forms of
//! [`theory`](crate::theory) and never from the engine; see the files for the source of each. Where instead two numbers
//! of the engine are compared that theory says are the same, they are in groups of their own that say so.
//!
//! | file | what is compared |
//! |---|---|
//! | [`row`] | one comparison, and groups of them |
//! | [`settings`] | the bases that are verified, and what each is held to |
//! | [`cases`] | the problems: the smooth sphere, Fig. 8 and Fig. 9 |
//! | [`smooth`] | Hertz and JKR in the exact basis |
//! | [`convergence`] | Hertz and JKR in rings: errors, and the observed order |
//! | [`newton`] | the rounds of Newton-Raphson from a threefold contact radius |
//! | [`figures`] | the smallest force and approach of Figs. 8 and 9 |
//! | [`unloading`] | every limit point, landing and loss of Fig. 9 under three controls |
//! | [`stability`] | the law of stability and its cusps on Fig. 9 |
//! | [`loops`] | a rigid annulus, and the whole loop with and without rings |
//! | [`range`] | the sphere whose adhesion has a range |
//! | [`rate`] | an edge with a speed against the laws of slow pulls |
//! | [`balance`] | the work of the device against what is stored and lost |
//!
//! All problems have E* = R = 1, so reduced and user's units are the same.

pub mod balance;
pub mod cases;
pub mod convergence;
pub mod figures;
pub mod loops;
pub mod newton;
pub mod range;
pub mod rate;
pub mod row;
pub mod settings;
pub mod smooth;
pub mod stability;
pub mod unloading;

pub use row::{Group, VerifyRow};
pub use settings::{VerifyError, VerifySettings};

/// All comparisons; takes seconds.
///
/// A number that could not be computed makes a row that fails, not an error.
///
/// ```
/// use pulloff_engine::{VerifyReport, verify};
///
/// let report = VerifyReport::new(&[verify::smooth::group()?], None);
/// assert_eq!(report.passed, report.total, "{}", report.verdict());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`VerifyError`] if a basis of `settings` cannot be made.
pub fn verify(settings: &VerifySettings) -> Result<Vec<Group>, VerifyError> {
    let fig_9 = settings.candidates(&cases::fig_9())?;
    let fig_8 = settings.candidates(&cases::fig_8())?;
    let mut groups = vec![smooth::group()?];
    groups.extend(convergence::groups(settings)?);
    groups.push(newton::group(settings)?);
    for (figure, candidates) in [(cases::fig_8(), fig_8), (cases::fig_9(), fig_9.clone())] {
        groups.extend(candidates.iter().map(|candidate| figures::group(&figure, candidate)));
    }
    let mut own = Vec::new();
    for candidate in &fig_9 {
        for group in unloading::groups(&cases::fig_9(), candidate) {
            let [exact, ours] = group.apart(balance::OWN_MEASURE);
            groups.push(exact);
            own.push(ours);
        }
    }
    groups.push(range::group());
    let [slow, own_pulls] = rate::groups();
    groups.push(slow);
    groups.push(stability::group(&cases::fig_9())?);
    let loops = loops::groups()?;
    let is_own = |group: &Group| group.rows.iter().any(|row| row.other.is_some());
    let (own_loops, loops): (Vec<Group>, Vec<Group>) = loops.into_iter().partition(is_own);
    groups.extend(loops);
    groups.extend(own);
    groups.extend(own_loops);
    groups.push(own_pulls);
    Ok(groups)
}
