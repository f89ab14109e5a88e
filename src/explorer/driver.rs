//! Effects, and the two drivers that run them.
//!
//! Inline for tests and scripts: each effect is done before the next command, so nothing depends on timing. On
//! threads for the screen: the newest curve and the newest profile win, walks are done in order and stream their
//! states, files have a lane of their own, and none of them waits for another. Which states of a curve are admissible
//! is found in the lane of the curves, until another curve is wanted.

use super::curve::{CurveData, ProblemCurve};
use super::effect::{Check, Effect, Reply, Wish};
use super::files;
use super::fitting::FitWish;
use super::job::Job;
use super::loops::LoopWish;
use super::maps::MapWish;
use super::model::Model;
use super::node::NodeKind;
use super::onset::SnapsFrom;
use super::profile::{Ask, Inside};
use super::progress::{Pace, Staged, for_good};
use super::saves::Saves;
use super::studies::{StudyWish, threads};
use super::update::answer;
use super::walk::{self, Request};
use super::watch::Watch;
use crate::fault;
use crate::mend::Reason;
use crate::store::Store;
use pulloff_engine::case::CaseError;
use pulloff_engine::preset::Preset;
use pulloff_engine::progress::{Progress, Unwatched};
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Runs every effect at once, on the caller's thread.
#[derive(Debug)]
pub struct Inline {
    store: Store,
}

impl Inline {
    /// A driver that saves to `store`.
    pub fn new(store: Store) -> Self {
        Self { store }
    }

    /// Does `effects` and all that follows from them, until nothing is left.
    pub fn settle(&self, model: &mut Model, effects: Vec<Effect>) {
        let mut left = VecDeque::from(effects);
        while let Some(effect) = left.pop_front() {
            if let Some(reply) = self.run(effect) {
                left.extend(answer(model, reply));
            }
        }
    }

    /// Does one effect; it is over when this returns, so there is nothing to stop.
    pub fn run(&self, effect: Effect) -> Option<Reply> {
        match effect {
            Effect::Curve(wish) => compute(&wish, &Staged::unwatched()),
            Effect::Check(check) => check.run(&Unwatched),
            Effect::Loop(wish) => wish
                .is_shown
                .then(|| wish.run(&Unwatched))
                .flatten()
                .map(|found| Reply::Loop(Arc::new(found))),
            Effect::Map(wish) => wish.run(&Unwatched).map(|found| Reply::Map(Arc::new(found))),
            Effect::Fit(wish) => Some(Reply::Fitted { id: wish.id, result: wish.fit(&Unwatched) }),
            Effect::Distances(wish) => Some(Reply::Distances(Arc::new(wish.distances()))),
            Effect::Study(wish) => {
                let found = wish.run(threads(), &Unwatched, &mut |_| {});
                found.map(|found| Reply::Study(Arc::new(found)))
            }
            Effect::Profile(ask) => Some(Reply::Profile(Arc::new(Inside::compute(&ask)))),
            Effect::Walk(request) => {
                let mut made = Vec::new();
                let outcome = walk::walk(&request, &mut |state| {
                    made.push(state);
                    true
                });
                Some(Reply::Walked { id: request.id, made, outcome: Some(outcome) })
            }
            Effect::StopWalk(_)
            | Effect::StopCurve(_)
            | Effect::StopStudy(_)
            | Effect::StopFit(_)
            | Effect::StopPins
            | Effect::Pace(_) => None,
            Effect::Pin(number, preset) => Some(pinned(number, &preset, &Staged::unwatched())),
            Effect::File(job) => Some(Reply::File(Box::new(files::run(&self.store, *job)))),
        }
    }
}

fn pinned(number: usize, preset: &Preset, progress: &Staged<'_>) -> Reply {
    Reply::Pinned(number, CurveData::compute(preset, progress).ok().map(Arc::new))
}

impl Check {
    fn run(&self, progress: &dyn Progress) -> Option<Reply> {
        let curve = Arc::new(self.curve.checked(progress)?);
        let snaps_from = if self.with_onset {
            Some(Arc::new(SnapsFrom::find(&self.curve.setting.preset, progress)?))
        } else {
            None
        };
        Some(Reply::Checked { id: self.id, curve, snaps_from })
    }
}

fn compute(wish: &Wish, progress: &Staged<'_>) -> Option<Reply> {
    let result = match &wish.base {
        Some(base) => CurveData::under(Arc::clone(base), &wish.preset, progress),
        None => CurveData::compute(&wish.preset, progress),
    };
    match result {
        Err(CaseError::Cancelled) => None,
        result => {
            let result = result.map(Arc::new).map_err(|error| Reason::of("", &error));
            Some(Reply::Curve { id: wish.id, result })
        }
    }
}

/// A curve computed this long is finished though a newer one waits, so that a held key shows curves.
const PATIENCE: Duration = Duration::from_millis(50);
/// The states of a run are sent in batches, one per frame.
const CHUNK: Duration = Duration::from_millis(30);

/// Runs effects on threads of their own; replies go to one function.
#[derive(Debug)]
pub struct Workers {
    curve: Arc<Slot<Task>>,
    profile: Arc<Slot<Box<Ask>>>,
    loops: Arc<Slot<Box<LoopWish>>>,
    maps: Arc<Slot<Box<MapWish>>>,
    fits: Arc<Slot<Box<FitWish>>>,
    distances: Arc<Slot<Box<FitWish>>>,
    fits_stopped: Arc<AtomicU64>,
    studies: Arc<Slot<Box<StudyWish>>>,
    studies_stopped: Arc<AtomicU64>,
    walks: Sender<Box<Request>>,
    files: Sender<Box<Job>>,
    pins: Sender<(u64, usize, Box<Preset>)>,
    /// Counts cancellations: pins asked for before the last one are not computed.
    pins_given_up: Arc<AtomicU64>,
    walking: Arc<Watch>,
    given_up: Arc<AtomicU64>,
}

/// What the curve lane does: a curve that waits takes the place of a check, which is asked for only when none does.
#[derive(Debug)]
enum Task {
    Curve(Box<Wish>),
    Check(Check),
}

/// Holds the newest request only.
#[derive(Debug)]
struct Slot<T> {
    wish: Mutex<Option<T>>,
    filled: Condvar,
    waiting: AtomicBool,
}

impl<T> Slot<T> {
    fn empty() -> Arc<Self> {
        Arc::new(Self { wish: Mutex::new(None), filled: Condvar::new(), waiting: AtomicBool::new(false) })
    }

    fn lock(&self) -> MutexGuard<'_, Option<T>> {
        self.wish.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn put(&self, wish: T) {
        *self.lock() = Some(wish);
        self.waiting.store(true, Ordering::Release);
        self.filled.notify_one();
    }

    fn take(&self) -> T {
        let mut wish = self.lock();
        loop {
            if let Some(taken) = wish.take() {
                self.waiting.store(false, Ordering::Release);
                return taken;
            }
            wish = self.filled.wait(wish).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Workers {
    /// Starts the threads; they end with the process.
    pub fn start(
        store: Store,
        reply: impl Fn(Reply) + Send + Clone + 'static,
    ) -> Result<Self, std::io::Error> {
        let (curve, profile, loops, maps) = (Slot::empty(), Slot::empty(), Slot::empty(), Slot::empty());
        let (studies, studies_stopped) = (Slot::empty(), Arc::new(AtomicU64::new(0)));
        let (walking, given_up) = (Arc::new(Watch::default()), Arc::new(AtomicU64::new(0)));
        let (walks, requests) = channel();
        let (files, jobs) = channel();
        let (pins, pinnings) = channel::<(u64, usize, Box<Preset>)>();
        let pins_given_up = Arc::new(AtomicU64::new(0));
        let (slot, give_up, send) = (Arc::clone(&curve), Arc::clone(&given_up), reply.clone());
        thread::Builder::new().name("curve".to_owned()).spawn(move || curves(&slot, &give_up, &send))?;
        let (slot, send) = (Arc::clone(&profile), reply.clone());
        thread::Builder::new().name("profile".to_owned()).spawn(move || profiles(&slot, &send))?;
        let (slot, send) = (Arc::clone(&loops), reply.clone());
        thread::Builder::new().name("loop".to_owned()).spawn(move || loop_lane(&slot, &send))?;
        let (slot, send) = (Arc::clone(&maps), reply.clone());
        thread::Builder::new().name("map".to_owned()).spawn(move || map_lane(&slot, &send))?;
        let (fits, distances) = (Slot::empty(), Slot::empty());
        let fits_stopped = Arc::new(AtomicU64::new(0));
        let (slot, stop, send) = (Arc::clone(&fits), Arc::clone(&fits_stopped), reply.clone());
        thread::Builder::new().name("fit".to_owned()).spawn(move || fit_lane(&slot, &stop, &send))?;
        let (slot, send) = (Arc::clone(&distances), reply.clone());
        thread::Builder::new().name("distances".to_owned()).spawn(move || distance_lane(&slot, &send))?;
        let (slot, stop, send) = (Arc::clone(&studies), Arc::clone(&studies_stopped), reply.clone());
        thread::Builder::new().name("study".to_owned()).spawn(move || study_lane(&slot, &stop, &send))?;
        let (times, send) = (Arc::clone(&pins_given_up), reply.clone());
        thread::Builder::new().name("pins".to_owned()).spawn(move || {
            while let Ok((asked, number, preset)) = pinnings.recv() {
                let is_given_up = || times.load(Ordering::Acquire) != asked;
                if is_given_up() {
                    continue;
                }
                let answer = pinned(number, &preset, &Staged::new(&|_| is_given_up()));
                // If cancelled meanwhile, another pin may have this number now.
                if !is_given_up() {
                    send(answer);
                }
            }
        })?;
        let (watch, send) = (Arc::clone(&walking), reply.clone());
        thread::Builder::new().name("walk".to_owned()).spawn(move || walk_lane(&requests, &watch, &send))?;
        thread::Builder::new().name("files".to_owned()).spawn(move || file_lane(&store, &jobs, &reply))?;
        Ok(Self {
            curve,
            profile,
            loops,
            maps,
            fits,
            distances,
            fits_stopped,
            studies,
            studies_stopped,
            walks,
            files,
            pins,
            pins_given_up,
            walking,
            given_up,
        })
    }

    /// Hands every effect to its lane, in order.
    pub fn submit_all(&self, effects: Vec<Effect>) {
        for effect in effects {
            self.submit(effect);
        }
    }

    /// Hands an effect to its lane.
    pub fn submit(&self, effect: Effect) {
        // A lane ends only with the process, so a send cannot fail.
        match effect {
            Effect::Curve(wish) => self.curve.put(Task::Curve(wish)),
            Effect::Check(check) => self.curve.put(Task::Check(check)),
            Effect::StopCurve(id) => drop(self.given_up.fetch_max(id, Ordering::AcqRel)),
            Effect::Profile(ask) => self.profile.put(ask),
            Effect::Loop(wish) => self.loops.put(wish),
            Effect::Map(wish) => self.maps.put(wish),
            Effect::Fit(wish) => self.fits.put(wish),
            Effect::StopFit(id) => drop(self.fits_stopped.fetch_max(id, Ordering::AcqRel)),
            Effect::Distances(wish) => self.distances.put(wish),
            Effect::Study(wish) => self.studies.put(wish),
            Effect::StopStudy(id) => drop(self.studies_stopped.fetch_max(id, Ordering::AcqRel)),
            Effect::Walk(request) => {
                if let Some(pace) = request.pace {
                    self.walking.set(pace);
                }
                drop(self.walks.send(request));
            }
            Effect::Pace(pace) => self.walking.set(pace),
            Effect::StopWalk(id) => self.walking.stop(id),
            Effect::Pin(number, preset) => {
                let asked = self.pins_given_up.load(Ordering::Acquire);
                drop(self.pins.send((asked, number, preset)));
            }
            Effect::StopPins => drop(self.pins_given_up.fetch_add(1, Ordering::AcqRel)),
            Effect::File(job) => drop(self.files.send(job)),
        }
    }
}

fn curves(slot: &Slot<Task>, given_up: &AtomicU64, reply: &dyn Fn(Reply)) {
    let mut last: Option<Arc<ProblemCurve>> = None;
    loop {
        let mut wish = match slot.take() {
            Task::Curve(wish) => {
                fault::point(fault::WORKER);
                wish
            }
            Task::Check(check) => {
                // Ends at once when another curve is wanted.
                let stop =
                    || slot.waiting.load(Ordering::Acquire) || given_up.load(Ordering::Acquire) >= check.id;
                if let Some(answer) = check.run(&stop) {
                    reply(answer);
                }
                continue;
            }
        };
        // If only the control changed while the curve was computed, the last curve serves.
        let known = last.take_if(|base| wish.base.is_none() && base.is_of(&wish.preset));
        wish.base = wish.base.or(known);
        let begun = Instant::now();
        let pace = RefCell::new(Pace::begin());
        let id = wish.id;
        let outdated = for_good(|| slot.waiting.load(Ordering::Acquire) && begun.elapsed() <= PATIENCE);
        let stop = |stage| {
            if pace.borrow_mut().is_due(stage) {
                reply(Reply::Stage { id, stage });
            }
            outdated() || given_up.load(Ordering::Acquire) >= id
        };
        if let Some(answer) = compute(&wish, &Staged::new(&stop)) {
            if let Reply::Curve { result: Ok(curve), .. } = &answer {
                last = Some(Arc::clone(&curve.base));
            }
            reply(answer);
        }
    }
}

fn profiles(slot: &Slot<Box<Ask>>, reply: &dyn Fn(Reply)) {
    loop {
        reply(Reply::Profile(Arc::new(Inside::compute(&slot.take()))));
    }
}

fn loop_lane(slot: &Slot<Box<LoopWish>>, reply: &dyn Fn(Reply)) {
    loop {
        let wish = slot.take();
        let begun = Instant::now();
        let stop = for_good(|| slot.waiting.load(Ordering::Acquire) && begun.elapsed() <= PATIENCE);
        if let Some(found) = wish.run(&stop) {
            reply(Reply::Loop(Arc::new(found)));
        }
    }
}

fn map_lane(slot: &Slot<Box<MapWish>>, reply: &dyn Fn(Reply)) {
    loop {
        let wish = slot.take();
        let stop = || slot.waiting.load(Ordering::Acquire);
        if let Some(found) = wish.run(&stop) {
            reply(Reply::Map(Arc::new(found)));
        }
    }
}

/// Watches a fit.
struct Fitted<'a> {
    id: u64,
    told: Cell<u8>,
    stopped: &'a AtomicU64,
    reply: &'a dyn Fn(Reply),
}

impl Progress for Fitted<'_> {
    fn report(&self, share: f64) {
        // A share of a hundred; every fifth is enough for who waits.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let percent = (share.clamp(0.0, 1.0) * 100.0) as u8;
        if percent >= self.told.get() + 5 {
            self.told.set(percent);
            (self.reply)(Reply::Fitting { id: self.id, percent });
        }
    }

    fn stop(&self) -> bool {
        self.stopped.load(Ordering::Acquire) >= self.id
    }
}

fn fit_lane(slot: &Slot<Box<FitWish>>, stopped: &AtomicU64, reply: &dyn Fn(Reply)) {
    loop {
        let wish = slot.take();
        let id = wish.id;
        let result = wish.fit(&Fitted { id, told: Cell::new(0), stopped, reply });
        reply(Reply::Fitted { id, result });
    }
}

fn distance_lane(slot: &Slot<Box<FitWish>>, reply: &dyn Fn(Reply)) {
    loop {
        reply(Reply::Distances(Arc::new(slot.take().distances())));
    }
}

fn study_lane(slot: &Slot<Box<StudyWish>>, stopped: &AtomicU64, reply: &dyn Fn(Reply)) {
    loop {
        let wish = slot.take();
        let stop = || slot.waiting.load(Ordering::Acquire) || stopped.load(Ordering::Acquire) >= wish.id;
        let mut told = |data| reply(Reply::Study(Arc::new(data)));
        if let Some(found) = wish.run(threads(), &stop, &mut told) {
            reply(Reply::Study(Arc::new(found)));
        }
    }
}

fn walk_lane(requests: &Receiver<Box<Request>>, watch: &Watch, reply: &dyn Fn(Reply)) {
    while let Ok(request) = requests.recv() {
        let id = request.id;
        let is_paced = request.pace.is_some();
        if is_paced && watch.is_stopped(id) {
            reply(Reply::Walked { id, made: Vec::new(), outcome: Some(walk::Outcome::Paused) });
            continue;
        }
        let mut made = Vec::new();
        let mut sent = Instant::now();
        let outcome = walk::walk(&request, &mut |state| {
            let ends = matches!(state.kind, NodeKind::Limit | NodeKind::Touch(_));
            made.push(state);
            if is_paced || sent.elapsed() > CHUNK {
                reply(Reply::Walked { id, made: std::mem::take(&mut made), outcome: None });
                sent = Instant::now();
            }
            if is_paced && !ends { watch.wait(id, sent) } else { !watch.is_stopped(id) }
        });
        reply(Reply::Walked { id, made, outcome: Some(outcome) });
    }
}

fn file_lane(store: &Store, jobs: &Receiver<Box<Job>>, reply: &dyn Fn(Reply)) {
    let mut saves = Saves::default();
    while let Ok(job) = jobs.recv() {
        reply(Reply::File(Box::new(saves.run(store, *job))));
    }
}
