//! What is computed in the background: the last answers, and the work that brings new ones.

use pulloff_engine::progress::Progress;
use std::any::{Any, TypeId};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

pub(super) type AnyResult = Arc<dyn Any + Send + Sync>;

/// A question, and the last answer.
#[derive(Debug, Clone, Default)]
pub(super) struct AnswerSlot {
    pub asked: Option<(u64, AnyResult)>,
    pub found: Option<(u64, AnyResult)>,
    /// How much of the answer is done, in per cent.
    pub percent: u8,
    /// The number of the last question that was answered completely, or given up.
    pub over: u64,
}

/// All results of a session.
#[derive(Debug, Clone, Default)]
pub struct Results(BTreeMap<TypeId, AnswerSlot>);

impl Results {
    pub(super) fn slot<R: 'static>(&self) -> Option<&AnswerSlot> {
        self.0.get(&TypeId::of::<R>())
    }

    pub(super) fn slot_mut<R: 'static>(&mut self) -> &mut AnswerSlot {
        self.0.entry(TypeId::of::<R>()).or_default()
    }

    /// The last answer, which can be that of earlier values.
    pub fn found<R: 'static>(&self) -> Option<&R> {
        self.slot::<R>()?.found.as_ref()?.1.downcast_ref()
    }

    /// The same, shared.
    pub fn share<R: Send + Sync + 'static>(&self) -> Option<Arc<R>> {
        Arc::clone(&self.slot::<R>()?.found.as_ref()?.1).downcast().ok()
    }

    /// The last answer, while one is wanted.
    pub fn shown<R: 'static>(&self) -> Option<&R> {
        self.slot::<R>()?.asked.as_ref()?;
        self.found()
    }

    /// What has been done so far of the computation under way.
    pub fn so_far<R: 'static>(&self) -> Option<&R> {
        let (id, found) = self.slot::<R>()?.found.as_ref()?;
        if self.under_way::<R>() == Some(*id) { found.downcast_ref() } else { None }
    }

    /// How much of the computation under way is done, in per cent; `None` where none is under way.
    pub fn percent<R: 'static>(&self) -> Option<u8> {
        self.under_way::<R>()?;
        Some(self.slot::<R>()?.percent)
    }

    /// The key of the last request, if it is still wanted.
    pub fn asked<R: 'static, K: 'static>(&self) -> Option<&K> {
        self.slot::<R>()?.asked.as_ref()?.1.downcast_ref()
    }

    /// The number of the request that is neither complete nor given up.
    pub fn under_way<R: 'static>(&self) -> Option<u64> {
        let slot = self.slot::<R>()?;
        slot.asked.as_ref().map(|(id, _)| *id).filter(|id| *id > slot.over)
    }
}

/// Work for a thread.
#[derive(Clone)]
pub struct Task {
    /// The kind of result.
    pub name: &'static str,
    pub id: u64,
    pub patience: Duration,
    /// Whether it is done even where nobody looks, as in scripts.
    pub is_for_scripts: bool,
    pub(super) work: Arc<Computation>,
}

pub(super) type Computation =
    dyn Fn(&(dyn Progress + Sync), &mut dyn FnMut(AnyResult)) -> Option<AnyResult> + Send + Sync;

impl fmt::Debug for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Task({} {})", self.name, self.id)
    }
}

/// An answer, or how far it has come.
#[derive(Debug, Clone)]
pub struct Found {
    pub name: &'static str,
    pub id: u64,
    pub(super) what: Answer,
}

#[derive(Debug, Clone)]
pub(super) enum Answer {
    Whole(AnyResult),
    /// What is done so far.
    Part(AnyResult),
    Percent(u8),
}

/// Receives answers.
pub(super) type TellFound<'a> = &'a mut (dyn FnMut(Found) + Send);

/// Watches a task, and passes on how far it has come.
struct TaskProgress<'a> {
    progress: &'a (dyn Progress + Sync),
    reply: Mutex<TellFound<'a>>,
    task: &'a Task,
    percent: AtomicU8,
}

impl TaskProgress<'_> {
    fn tell(&self, what: Answer) {
        let mut reply = self.reply.lock().unwrap_or_else(PoisonError::into_inner);
        reply(Found { name: self.task.name, id: self.task.id, what });
    }
}

impl Progress for TaskProgress<'_> {
    /// Every five per cent is enough for someone waiting.
    fn report(&self, share: f64) {
        // From 0 to 100.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let percent = (share.clamp(0.0, 1.0) * 100.0) as u8;
        let told = self.percent.load(Ordering::Acquire);
        let is_more = percent >= told + 5;
        if is_more
            && self.percent.compare_exchange(told, percent, Ordering::AcqRel, Ordering::Acquire).is_ok()
        {
            self.tell(Answer::Percent(percent));
        }
    }

    fn stop(&self) -> bool {
        self.progress.stop()
    }
}

impl Task {
    /// Does the work, and hands over its results.
    pub fn run(&self, progress: &(dyn Progress + Sync), reply: TellFound<'_>) {
        let told = TaskProgress { progress, reply: Mutex::new(reply), task: self, percent: AtomicU8::new(0) };
        if let Some(what) = (self.work)(&told, &mut |part| told.tell(Answer::Part(part))) {
            told.tell(Answer::Whole(what));
        }
    }
}
