//! All results that are computed in the background. Of several under way, the first is reported, and is given up first.

use super::admissibility::AdmissibilityData;
use super::background::ResultKind;
use super::effect::Effect;
use super::fit::FitOutcome;
use super::fitting::Distances;
use super::loops::LoopData;
use super::maps::MapData;
use super::model::Model;
use super::onset::FirstSnap;
use super::pinned::PinCurve;
use super::profile::StateInside;
use super::pulls::PullData;
use super::speeds::SpeedsData;
use super::studies::StudyData;

/// The kinds, in the order in which they are reported.
pub static KINDS: [ResultKind; 11] = [
    ResultKind::of::<FitOutcome>(),
    ResultKind::of::<PinCurve>(),
    ResultKind::of::<StudyData>(),
    ResultKind::of::<AdmissibilityData>(),
    ResultKind::of::<StateInside>(),
    ResultKind::of::<LoopData>(),
    ResultKind::of::<PullData>(),
    ResultKind::of::<MapData>(),
    ResultKind::of::<Distances>(),
    ResultKind::of::<SpeedsData>(),
    ResultKind::of::<FirstSnap>(),
];

/// Requests everything that is wanted now.
pub(super) fn want_all(model: &mut Model) -> Vec<Effect> {
    KINDS.iter().filter_map(|kind| (kind.want)(model)).collect()
}

/// The kind with this name.
pub(super) fn kind_of(name: &str) -> Option<&'static ResultKind> {
    KINDS.iter().find(|kind| kind.name == name)
}

/// Gives up the first one under way.
pub(super) fn give_up_first(model: &mut Model) -> Vec<Effect> {
    KINDS.iter().find_map(|kind| (kind.give_up)(model)).unwrap_or_default()
}

/// What is under way and worth reporting because it takes long: its name and the message.
pub fn under_way(model: &Model) -> Option<(&'static str, String)> {
    KINDS.iter().find_map(|kind| Some((kind.name, (kind.says)(model)?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explorer::driver::Inline;
    use crate::explorer::pins::Pins;
    use crate::explorer::results::Task;
    use crate::explorer::script::parse;
    use crate::explorer::{Command, Id, Reply, View, Workers, answer, open, update};
    use crate::store::Store;
    use pulloff_engine::preset::Value;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::mpsc::channel;
    use std::time::Duration;

    fn says(model: &Model, text: &str) -> bool {
        under_way(model).is_some_and(|(_, says)| says.contains(text))
    }

    /// A session whose curve has arrived, and its driver.
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
        let asked = |effects: &[Effect]| {
            effects.iter().any(|effect| matches!(effect, Effect::Compute(task) if task.name == "check"))
        };
        assert!(asked(&effects), "{effects:?}");
        assert!(says(&model, "checking admissibility"));
        let number = model.results.under_way::<AdmissibilityData>().unwrap();
        let effects = update(&mut model, Id::Cancel.into());
        assert!(
            matches!(effects.as_slice(), [Effect::Stop { name: "check", id }] if *id == number),
            "{effects:?}"
        );
        assert_eq!(under_way(&model), None);
        assert!(model.status().1.contains("which states of this curve are admissible"));
        // Nothing that happens on this curve requests the check again.
        for effect in update(&mut model, Id::Step.into()) {
            let effects = driver.run(effect).map_or_else(Vec::new, |reply| answer(&mut model, reply));
            assert!(!asked(&effects), "{effects:?}");
        }
        assert!(update(&mut model, Id::Cancel.into()).is_empty());
        // Another curve is checked anew.
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
        assert_eq!(under_way(&model), None);
        model.pins = Pins::awaiting([(1, model.preset.clone()), (3, model.preset.clone())]);
        assert!(says(&model, "computing 2 pinned curves"));
        let [Effect::Compute(first)] = &want_all(&mut model)[..] else { panic!("one after the other") };
        let effects = update(&mut model, Id::Cancel.into());
        assert!(matches!(effects.as_slice(), [Effect::Stop { name: "pins", id }] if *id == first.id));
        assert!(under_way(&model).is_none() && model.pins.is_empty());
    }

    #[test]
    fn a_map_says_how_far_it_is_and_stays_given_up_until_it_is_another() {
        let (mut model, driver, effects) = session();
        driver.settle(&mut model, effects);
        let asked = |effects: Vec<Effect>| {
            effects.into_iter().find_map(|effect| match effect {
                Effect::Compute(task) if task.name == "map" => Some(task),
                _ => None,
            })
        };
        let task = asked(update(&mut model, Command::Show(View::Map))).unwrap();
        assert!(says(&model, "computing the map, 0 %") && model.map().is_none());
        let (is_heard, mut heard) = (AtomicBool::new(false), Vec::new());
        task.run(&|| is_heard.load(Ordering::Acquire), &mut |found| {
            is_heard.store(true, Ordering::Release);
            heard.push(found);
        });
        for found in heard {
            assert!(answer(&mut model, Reply::Found(found)).is_empty());
        }
        assert!(says(&model, "computing the map, ") && !says(&model, ", 0 %"));
        let effects = update(&mut model, Id::Cancel.into());
        assert!(matches!(effects.as_slice(), [Effect::Stop { name: "map", .. }]), "{effects:?}");
        assert!(under_way(&model).is_none() && matches!(model.map(), Some(Err("it was given up"))));
        assert!(asked(want_all(&mut model)).is_none());
        let effects = update(&mut model, parse("map gamma=0.001..0.01").unwrap().unwrap());
        assert!(asked(effects).is_some() && model.map().is_none());
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
        let task = |model: &mut Model, number, preset| -> Task {
            model.pins = Pins::awaiting([(number, preset)]);
            match &want_all(model)[..] {
                [.., Effect::Compute(task)] => task.clone(),
                other => panic!("{other:?}"),
            }
        };
        let mut model = model;
        let small = model.preset.clone();
        let first = task(&mut model, 1, large);
        workers.submit(Effect::Compute(first.clone()));
        workers.submit(Effect::Stop { name: "pins", id: first.id });
        workers.submit(Effect::Compute(task(&mut model, 2, small)));
        let reply = replies.recv_timeout(Duration::from_secs(120)).unwrap();
        assert!(
            matches!(&reply, Reply::Found(found) if found.name == "pins" && found.id > first.id),
            "{reply:?}"
        );
    }
}
