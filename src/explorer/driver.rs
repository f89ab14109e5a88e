//! Effects, and the two drivers that run them.
//!
//! The inline driver is for tests and scripts: each effect is done before the next command, so nothing depends on
//! timing. The threaded driver is for the screen: the newest curve and the newest result of each kind win, walks are
//! done in order and stream their states, files have a lane of their own, and none of them waits for another. The
//! thread of a result lives only while it is computed: a sleeping one would keep the memory that it once took.

use super::backgrounds::KINDS;
use super::curve::{CurveData, ProblemCurve};
use super::effect::{Effect, Reply, Wish};
use super::files;
use super::job::Job;
use super::model::Model;
use super::node::NodeKind;
use super::progress::{ProgressPace, Staged, for_good};
use super::results::Task;
use super::saves::Saves;
use super::update::answer;
use super::walk::{self, Request};
use super::watch::Watch;
use crate::fault;
use crate::mend::WordedFault;
use crate::store::Store;
use pulloff_engine::case::CaseError;
use pulloff_engine::progress::{Stopped, Unwatched};
use std::cell::RefCell;
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

    /// Runs `effects` and everything that follows from them, until nothing is left.
    pub fn settle(&self, model: &mut Model, effects: Vec<Effect>) {
        let mut left = VecDeque::from(effects);
        while let Some(effect) = left.pop_front() {
            if let Some(reply) = self.run(effect) {
                left.extend(answer(model, reply));
            }
        }
    }

    /// Runs one effect; it is over when this returns, so there is nothing to stop. Intermediate results are left out.
    pub fn run(&self, effect: Effect) -> Option<Reply> {
        match effect {
            Effect::Curve(wish) => compute(&wish, &Staged::unwatched()),
            Effect::Compute(task) => {
                let mut last = None;
                if task.is_for_scripts {
                    task.run(&Unwatched, &mut |found| last = Some(Reply::Found(found)));
                }
                last
            }
            Effect::Walk(request) => {
                let mut made = Vec::new();
                let outcome = walk::walk(&request, &mut |state| {
                    made.push(state);
                    true
                });
                Some(Reply::Walked { id: request.id, made, outcome: Some(outcome) })
            }
            Effect::StopWalk(_) | Effect::StopCurve(_) | Effect::Stop { .. } | Effect::Pace(_) => None,
            Effect::File(job) => Some(Reply::File(Box::new(files::run(&self.store, *job)))),
        }
    }
}

fn compute(wish: &Wish, progress: &Staged<'_>) -> Option<Reply> {
    let result = match &wish.base {
        Some(base) => CurveData::under(Arc::clone(base), &wish.preset, progress),
        None => CurveData::compute(&wish.preset, progress),
    };
    match result {
        Err(CaseError::Stopped(Stopped)) => None,
        result => {
            let result = result.map(Arc::new).map_err(|error| WordedFault::of("", &error));
            Some(Reply::Curve { id: wish.id, result })
        }
    }
}

/// After this long, a curve is finished although a newer one waits, so that a held key shows curves.
const PATIENCE: Duration = Duration::from_millis(50);
/// The states of a run are sent in batches, one per frame.
const CHUNK: Duration = Duration::from_millis(30);

/// Receives the replies of all threads.
type Replies = Arc<dyn Fn(Reply) + Send + Sync>;

/// Runs effects on their own threads; all replies go to one function.
pub struct Workers {
    curve: Arc<RequestSlot<Box<Wish>>>,
    /// A lane for each kind of result, in the order of the list.
    lanes: Vec<Arc<ResultLane>>,
    walks: Sender<Box<Request>>,
    files: Sender<Box<Job>>,
    walking: Arc<Watch>,
    given_up: Arc<AtomicU64>,
    reply: Replies,
}

/// The lane of a kind of result.
#[derive(Debug, Default)]
struct ResultLane {
    /// The newest task that waits.
    next: Mutex<Option<Task>>,
    /// Whether a thread takes what waits. It changes only while `next` is locked.
    is_served: AtomicBool,
    /// Results up to this number must stop.
    stopped: AtomicU64,
}

impl ResultLane {
    fn lock(&self) -> MutexGuard<'_, Option<Task>> {
        self.next.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Replaces the task that waits; whether a thread is needed for it.
    fn put(&self, task: Task) -> bool {
        let mut next = self.lock();
        *next = Some(task);
        !self.is_served.swap(true, Ordering::AcqRel)
    }

    /// The task that waits. Where there is none, the lane is served no longer.
    fn take(&self) -> Option<Task> {
        let mut next = self.lock();
        let task = next.take();
        self.is_served.store(task.is_some(), Ordering::Release);
        task
    }
}

/// Holds only the newest request.
#[derive(Debug)]
struct RequestSlot<T> {
    wish: Mutex<Option<T>>,
    filled: Condvar,
}

impl<T> RequestSlot<T> {
    fn empty() -> Self {
        Self { wish: Mutex::new(None), filled: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, Option<T>> {
        self.wish.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn put(&self, wish: T) {
        *self.lock() = Some(wish);
        self.filled.notify_one();
    }

    /// Whether a newer request waits. There is no flag beside the request: set a moment late, it would stop the very
    /// request that it announced, and nobody would answer.
    fn is_waiting(&self) -> bool {
        self.lock().is_some()
    }

    fn take(&self) -> T {
        let mut wish = self.lock();
        loop {
            if let Some(taken) = wish.take() {
                return taken;
            }
            wish = self.filled.wait(wish).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Workers {
    /// Starts the threads that always wait for something; they end with the process.
    pub fn start(
        store: Store,
        reply: impl Fn(Reply) + Send + Sync + 'static,
    ) -> Result<Self, std::io::Error> {
        let reply: Replies = Arc::new(reply);
        let (curve, given_up) = (Arc::new(RequestSlot::empty()), Arc::new(AtomicU64::new(0)));
        let walking = Arc::new(Watch::default());
        let (walks, requests) = channel();
        let (files, jobs) = channel();
        let (slot, give_up, send) = (Arc::clone(&curve), Arc::clone(&given_up), Arc::clone(&reply));
        thread::Builder::new().name("curve".to_owned()).spawn(move || curves(&slot, &give_up, &*send))?;
        let lanes = KINDS.iter().map(|_| Arc::default()).collect();
        let (watch, send) = (Arc::clone(&walking), Arc::clone(&reply));
        thread::Builder::new().name("walk".to_owned()).spawn(move || walk_lane(&requests, &watch, &*send))?;
        let send = Arc::clone(&reply);
        thread::Builder::new().name("files".to_owned()).spawn(move || file_lane(&store, &jobs, &*send))?;
        Ok(Self { curve, lanes, walks, files, walking, given_up, reply })
    }

    /// The lane of a kind.
    fn lane(&self, name: &str) -> Option<&Arc<ResultLane>> {
        let at = KINDS.iter().position(|kind| kind.name == name)?;
        self.lanes.get(at)
    }

    /// Hands a task to its lane, and starts a thread for it if none is at work there.
    fn compute(&self, task: Task) {
        let Some(lane) = self.lane(task.name) else { return };
        let name = task.name.to_owned();
        if lane.put(task) {
            let (own, send) = (Arc::clone(lane), Arc::clone(&self.reply));
            let thread = thread::Builder::new().name(name).spawn(move || results(&own, &*send));
            // Where the system has no thread to give, the task waits for the next request.
            if thread.is_err() {
                lane.is_served.store(false, Ordering::Release);
            }
        }
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
            Effect::Curve(wish) => self.curve.put(wish),
            Effect::StopCurve(id) => drop(self.given_up.fetch_max(id, Ordering::AcqRel)),
            Effect::Compute(task) => self.compute(task),
            Effect::Stop { name, id } => {
                if let Some(lane) = self.lane(name) {
                    lane.stopped.fetch_max(id, Ordering::AcqRel);
                }
            }
            Effect::Walk(request) => {
                if let Some(pace) = request.pace {
                    self.walking.set(pace);
                }
                drop(self.walks.send(request));
            }
            Effect::Pace(pace) => self.walking.set(pace),
            Effect::StopWalk(id) => self.walking.stop(id),
            Effect::File(job) => drop(self.files.send(job)),
        }
    }
}

fn curves(slot: &RequestSlot<Box<Wish>>, given_up: &AtomicU64, reply: &dyn Fn(Reply)) {
    let mut last: Option<Arc<ProblemCurve>> = None;
    loop {
        let mut wish = slot.take();
        fault::point(fault::WORKER);
        // If only the control changed while the curve was computed, the last curve can be reused.
        let known = last.take_if(|base| wish.base.is_none() && base.is_of(&wish.preset));
        wish.base = wish.base.or(known);
        let begun = Instant::now();
        let pace = RefCell::new(ProgressPace::begin());
        let id = wish.id;
        let outdated = for_good(|| slot.is_waiting() && begun.elapsed() <= PATIENCE);
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

/// Computes results of one kind, each until a newer one waits or it is stopped, as long as any wait.
fn results(lane: &ResultLane, reply: &(dyn Fn(Reply) + Send + Sync)) {
    while let Some(task) = lane.take() {
        let begun = Instant::now();
        // Once set, it stays set.
        let outdated = AtomicBool::new(false);
        let stop = || {
            let is_early = task.patience.is_zero() || begun.elapsed() <= task.patience;
            let now = lane.lock().is_some() && is_early;
            outdated.fetch_or(now, Ordering::AcqRel) || now || lane.stopped.load(Ordering::Acquire) >= task.id
        };
        task.run(&stop, &mut |found| reply(Reply::Found(found)));
    }
}

fn walk_lane(requests: &Receiver<Box<Request>>, watch: &Watch, reply: &dyn Fn(Reply)) {
    while let Ok(request) = requests.recv() {
        let id = request.id;
        let is_paced = request.pace.is_some();
        if is_paced && watch.is_stopped(id) {
            reply(Reply::Walked { id, made: Vec::new(), outcome: Some(walk::WalkOutcome::Paused) });
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

#[cfg(test)]
mod tests {
    use super::RequestSlot;

    #[test]
    fn the_newest_request_is_taken_and_then_none_waits() {
        let slot = RequestSlot::empty();
        slot.put(1);
        slot.put(2);
        assert!(slot.is_waiting());
        assert_eq!(slot.take(), 2);
        assert!(!slot.is_waiting());
    }
}
