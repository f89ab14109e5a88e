//! Which states of the curve on the screen are admissible, found once no newer curve is being computed.

use super::background::{Background, Tell, Want, Watcher};
use super::command::Id;
use super::curve::CurveData;
use super::effect::Effect;
use super::model::Model;
use std::sync::Arc;

/// The same curve with its inadmissible states marked.
#[derive(Debug, Clone)]
pub struct AdmissibilityData(Arc<CurveData>);

impl Background for AdmissibilityData {
    type Key = Arc<CurveData>;
    const NAME: &'static str = "check";
    const ONLY_NEWEST: bool = true;

    fn wanted(model: &Model) -> Want<Self::Key> {
        let curve = model.curve.as_ref().filter(|curve| !model.is_computing() && !curve.is_checked());
        curve.cloned().map_or(Want::Not, Want::Now)
    }

    fn is_same(asked: &Self::Key, wanted: &Self::Key) -> bool {
        Arc::ptr_eq(asked, wanted)
    }

    fn compute(curve: &Self::Key, progress: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        curve.checked(progress).map(|curve| Self(Arc::new(curve)))
    }

    fn came(model: &mut Model, found: Arc<Self>) -> Vec<Effect> {
        model.curve = Some(Arc::clone(&found.0));
        Vec::new()
    }

    fn says(model: &Model) -> Option<String> {
        let is_under_way = model.results.under_way::<Self>().is_some() && !model.is_computing();
        is_under_way.then(|| format!("checking admissibility; {} cancels", Id::Cancel.named()))
    }

    fn given_up(model: &mut Model) -> Option<String> {
        let said = "cancelled: which states of this curve are admissible stays unknown";
        Self::says(model).map(|_| said.to_owned())
    }
}
