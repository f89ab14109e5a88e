//! Background jobs: pinned curves, admissibility checks, the profile of the current state.

use super::command::Id;
use super::effect::Effect;
use super::model::{Checking, Level, Model};

/// Work beside the curve and the walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BackgroundJob {
    /// So many pinned curves of a resumed session are computed.
    Pins(usize),
    /// The admissibility of the curve's states is checked.
    Check,
    /// A fit is running and has come so far, in per cent.
    Fit(u8),
    /// Other random surfaces are computed for the study on the screen.
    Surfaces,
    /// The profile of the walker's state is computed; it is short and cannot be cancelled.
    Inside,
}

impl BackgroundJob {
    /// The job under way; of several, the longest.
    pub fn of(model: &Model) -> Option<Self> {
        let pins = model.pins.awaited().len();
        let is_inside_old = model
            .profile_wanted
            .as_ref()
            .is_some_and(|wanted| model.profile.as_ref().is_none_or(|shown| shown.id < wanted.id));
        if let Some(fitting) = &model.fitting {
            Some(Self::Fit(fitting.percent))
        } else if pins > 0 {
            Some(Self::Pins(pins))
        } else if surfaces_of(model).is_some() {
            Some(Self::Surfaces)
        } else if matches!(model.checking, Some(Checking::Asked(_))) && !model.is_computing() {
            Some(Self::Check)
        } else {
            is_inside_old.then_some(Self::Inside)
        }
    }

    /// In words, short, with the command that ends it.
    pub fn text(self) -> String {
        match self {
            Self::Pins(1) => format!("computing a pinned curve; {} gives up", Id::Cancel.named()),
            Self::Pins(count) => format!("computing {count} pinned curves; {} gives up", Id::Cancel.named()),
            Self::Check => format!("checking admissibility; {} gives up", Id::Cancel.named()),
            Self::Fit(percent) => {
                format!("fitting, {percent} %; {} takes the best so far", Id::Cancel.named())
            }
            Self::Surfaces => {
                format!("computing other surfaces; {} keeps those there are", Id::Cancel.named())
            }
            Self::Inside => "computing the state".to_owned(),
        }
    }
}

/// The study that is on the screen while other surfaces are computed for it.
fn surfaces_of(model: &Model) -> Option<u64> {
    let study = model.study.as_ref().filter(|study| study.done() == study.outcomes.len())?;
    let is_wanted = model.study_wanted.as_ref().is_some_and(|wanted| wanted.id == study.wish.id);
    (is_wanted && !study.is_whole()).then_some(study.wish.id)
}

/// Cancels the job under way, if it can be cancelled.
pub(super) fn give_up(model: &mut Model) -> Vec<Effect> {
    match (BackgroundJob::of(model), model.checking) {
        (Some(BackgroundJob::Pins(count)), _) => {
            model.pins.give_up();
            let curves = if count == 1 { "the pinned curve" } else { "the pinned curves" };
            model.tell(Level::Info, format!("cancelled: {curves} on the way will not be shown"));
            vec![Effect::StopPins]
        }
        (Some(BackgroundJob::Surfaces), _) => {
            let Some(id) = surfaces_of(model) else { return Vec::new() };
            // What is there is that of the preset: nothing asks for it again.
            model.study_wanted = None;
            model.tell(Level::Info, "the study keeps the surfaces that are there");
            vec![Effect::StopStudy(id)]
        }
        (Some(BackgroundJob::Check), Some(Checking::Asked(id))) => {
            model.checking = Some(Checking::GivenUp);
            model.tell(Level::Info, "cancelled: which states of this curve are admissible stays unknown");
            vec![Effect::StopCurve(id)]
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::background_jobs::*;
    use crate::explorer::driver::Inline;
    use crate::explorer::pins::Pins;
    use crate::explorer::{Command, Reply, Workers, answer, open, update};
    use crate::store::Store;
    use pulloff_engine::preset::Value;
    use std::sync::mpsc::channel;
    use std::time::Duration;

    /// A session whose curve has come, and its driver.
    fn session() -> (Model, Inline, Vec<Effect>) {
        let store = Store::at("/nowhere", &[]);
        let loaded = store.load(&store.resolve("fig-3-jkr").unwrap(), &[] as &[&str]).unwrap();
        let driver = Inline::new(store);
        let (mut model, effects) = open(loaded);
        let replies: Vec<_> = effects.into_iter().filter_map(|effect| driver.run(effect)).collect();
        let effects = replies.into_iter().flat_map(|reply| answer(&mut model, reply)).collect();
        (model, driver, effects)
    }

    #[test]
    fn a_check_is_told_of_and_given_up_for_its_curve_alone() {
        let (mut model, driver, effects) = session();
        let asked = |effects: &[Effect]| effects.iter().any(|effect| matches!(effect, Effect::Check(_)));
        assert!(asked(&effects), "{effects:?}");
        assert_eq!(BackgroundJob::of(&model), Some(BackgroundJob::Check));
        let Some(Checking::Asked(number)) = model.checking else { panic!("{:?}", model.checking) };
        let effects = update(&mut model, Id::Cancel.into());
        assert!(matches!(effects.as_slice(), [Effect::StopCurve(id)] if *id == number));
        assert_eq!(BackgroundJob::of(&model), None);
        assert!(model.status().1.contains("which states of this curve are admissible"));
        // Nothing that happens on this curve asks again.
        for effect in update(&mut model, Id::Step.into()) {
            let effects = driver.run(effect).map_or_else(Vec::new, |reply| answer(&mut model, reply));
            assert!(!asked(&effects), "{effects:?}");
        }
        assert!(update(&mut model, Id::Cancel.into()).is_empty());
        // Another curve is asked about.
        let set = Command::Set { key: "material.effective_modulus".into(), text: "2".to_owned() };
        let mut waiting = update(&mut model, set);
        let mut again = false;
        while let Some(effect) = waiting.pop() {
            again |= asked(std::slice::from_ref(&effect));
            waiting.extend(driver.run(effect).map_or_else(Vec::new, |reply| answer(&mut model, reply)));
        }
        assert!(again);
    }

    #[test]
    fn the_pins_of_a_resumed_session_are_given_up_together() {
        let (mut model, driver, effects) = session();
        driver.settle(&mut model, effects);
        assert_eq!(BackgroundJob::of(&model), None);
        model.pins = Pins::awaiting([(1, model.preset.clone()), (3, model.preset.clone())]);
        assert_eq!(BackgroundJob::of(&model), Some(BackgroundJob::Pins(2)));
        assert!(matches!(update(&mut model, Id::Cancel.into()).as_slice(), [Effect::StopPins]));
        assert!(BackgroundJob::of(&model).is_none() && model.pins.is_empty());
    }

    #[test]
    fn a_curve_that_is_given_up_is_not_computed_to_its_end() {
        let (model, ..) = session();
        let (send, replies) = channel();
        let workers =
            Workers::start(Store::at("/nowhere", &[]), move |reply| drop(send.send(reply))).unwrap();
        let mut large = model.preset.clone();
        large.set("basis.kind", "rings".into()).unwrap();
        large.set("basis.rings", Value::Integer(2000)).unwrap();
        workers.submit(Effect::Pin(1, Box::new(large)));
        workers.submit(Effect::StopPins);
        workers.submit(Effect::Pin(2, Box::new(model.preset)));
        let first = replies.recv_timeout(Duration::from_secs(120)).unwrap();
        assert!(matches!(first, Reply::Pinned(2, Some(_))), "{first:?}");
    }
}
