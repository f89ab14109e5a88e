//! Writes the newest state of a session every few seconds, and at its end.
//!
//! Whatever changes the session leaves a snapshot here, which takes no time; a separate thread writes it. Whatever ends
//! the program, from any thread, asks for the last write and waits for it only as long as it can afford.

use super::{Archive, ArchiveError, Claim};
use crate::explorer::session::{Document, Ended, Snapshot};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// The least time between two writes,
const PAUSE: Duration = Duration::from_secs(3);
/// and the least multiple of the time the last one took: a large session on a slow disk is written less often.
const SHARE: u32 = 20;

/// Keeps the session of a program on disk.
#[derive(Debug, Clone)]
pub struct Autosave(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    archive: Archive,
    desk: Mutex<Desk>,
    filled: Condvar,
    /// Held while a session is written; together with the desk only for a moment.
    writer: Mutex<SessionWriter>,
}

/// What is waiting to be written.
#[derive(Debug, Default)]
struct Desk {
    newest: Option<Arc<Snapshot>>,
    count: u64,
    /// The last snapshots of the sessions that the person has left for another.
    left: Vec<Arc<Snapshot>>,
    /// A resumed session as its file has it, the right to write it, and how it had ended.
    resumed: Option<(Snapshot, Claim, Ended)>,
    is_over: bool,
}

/// The session being written.
#[derive(Debug, Default)]
struct SessionWriter {
    session: u64,
    claim: Option<Claim>,
    /// What is in the file, without the walk, and the ending recorded there.
    written: Option<(Snapshot, Ended)>,
    /// How a resumed session had ended, until it is written again.
    before: Option<Ended>,
}

impl Autosave {
    /// Writes nothing until [`Autosave::start`].
    pub fn new(archive: Archive) -> Self {
        let (desk, writer) = (Mutex::default(), Mutex::default());
        Self(Arc::new(Shared { archive, desk, filled: Condvar::new(), writer }))
    }

    /// Starts the thread that writes; what the person should know goes to `tell`.
    pub fn start(&self, tell: impl Fn(Result<(), String>) + Send + 'static) -> std::io::Result<()> {
        let keeper = self.clone();
        thread::Builder::new().name("session".to_owned()).spawn(move || keeper.work(&tell))?;
        Ok(())
    }

    /// The session of `snapshot` is resumed: it is in the file of `claim` and had ended as `before`.
    pub fn adopt(&self, snapshot: &Snapshot, claim: Claim, before: Ended) {
        self.desk().resumed = Some((snapshot.mark(), claim, before));
    }

    /// Leaves the newest state of a session here to be written.
    pub fn offer(&self, snapshot: Snapshot) {
        let mut desk = self.desk();
        if desk.newest.as_ref().is_some_and(|newest| newest.is_like(&snapshot)) {
            return;
        }
        desk.count += 1;
        let last = desk.newest.replace(Arc::new(snapshot));
        let session = desk.newest.as_ref().map(|newest| newest.session);
        desk.left.extend(last.filter(|last| Some(last.session) != session));
        self.0.filled.notify_one();
    }

    /// Writes the newest state for the last time, from any thread, and gives up the session; waits at most
    /// `patience` for a write that is under way.
    /// Errors: Why it was not written. The file is unchanged.
    pub fn finish(&self, ended: Ended, patience: Duration) -> Result<(), String> {
        let until = Instant::now() + patience;
        let busy = || "the last one is still being written".to_owned();
        let (newest, left) = {
            let mut desk = patiently(&self.0.desk, until).ok_or_else(busy)?;
            desk.is_over = true;
            (desk.newest.clone(), std::mem::take(&mut desk.left))
        };
        let mut writer = patiently(&self.0.writer, until).ok_or_else(busy)?;
        for last in left {
            self.write(&mut writer, &last, Ended::Quit).map_err(|error| error.to_string())?;
        }
        let result = newest.map_or(Ok(()), |newest| self.write(&mut writer, &newest, ended));
        writer.claim = None;
        result.map_err(|error| error.to_string())
    }

    fn desk(&self) -> MutexGuard<'_, Desk> {
        self.0.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes what arrives, until the session is over.
    fn work(&self, tell: &dyn Fn(Result<(), String>)) {
        let mut told = Ok(());
        let mut seen = 0;
        loop {
            let Some((newest, left)) = self.next(&mut seen) else { return };
            let begun = Instant::now();
            let result = {
                let mut writer = self.0.writer.lock().unwrap_or_else(PoisonError::into_inner);
                // The session ended meanwhile: another thread made the last write.
                if self.desk().is_over {
                    return;
                }
                let mut result = Ok(());
                for last in left {
                    result = result.and(self.write(&mut writer, &last, Ended::Quit));
                }
                result.and(self.write(&mut writer, &newest, Ended::Running))
            };
            drop(newest);
            let result = result.map_err(|error| error.brief());
            if result != told {
                tell(result.clone());
                told = result;
            }
            thread::sleep(PAUSE.max(begun.elapsed() * SHARE));
        }
    }

    /// The newest snapshot and those left behind, once there are more than `seen`; `None` when it is over.
    fn next(&self, seen: &mut u64) -> Option<(Arc<Snapshot>, Vec<Arc<Snapshot>>)> {
        let mut desk = self.desk();
        loop {
            if desk.is_over {
                return None;
            }
            if let Some(newest) = desk.newest.clone().filter(|_| desk.count > *seen) {
                *seen = desk.count;
                return Some((newest, std::mem::take(&mut desk.left)));
            }
            desk = self.0.filled.wait(desk).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Writes a snapshot if it holds anything that is not in the file.
    fn write(
        &self,
        writer: &mut SessionWriter,
        snapshot: &Snapshot,
        ended: Ended,
    ) -> Result<(), ArchiveError> {
        if writer.session != snapshot.session {
            *writer = SessionWriter { session: snapshot.session, ..SessionWriter::default() };
        }
        let resumed = self.desk().resumed.take_if(|(resumed, ..)| resumed.session == snapshot.session);
        if let Some((resumed, claim, before)) = resumed {
            (writer.claim, writer.before) = (Some(claim), Some(before));
            writer.written = Some((resumed, before));
        }
        let known = writer.written.as_ref().is_some_and(|(written, how)| {
            // A connection that drops is written even where nothing else is new: the session used last is resumed first.
            let is_said = *how == ended || (ended == Ended::Running && writer.before == Some(*how));
            is_said && written.is_like(snapshot)
        });
        if known || (writer.claim.is_none() && !snapshot.is_worth_keeping()) {
            return Ok(());
        }
        let is_new = writer.claim.is_none();
        if is_new {
            writer.claim = Some(self.0.archive.begin(&snapshot.source.shown())?);
        }
        let Some(claim) = &mut writer.claim else { return Ok(()) };
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        claim.save(Document::new(snapshot, ended, now))?;
        (writer.written, writer.before) = (Some((snapshot.mark(), ended)), None);
        if is_new {
            self.0.archive.make_room(claim.name());
        }
        Ok(())
    }
}

/// Waits for a lock until `until`, since its holder may be stuck.
fn patiently<T>(mutex: &Mutex<T>, until: Instant) -> Option<MutexGuard<'_, T>> {
    loop {
        match mutex.try_lock() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(guard)) => return Some(guard.into_inner()),
            Err(TryLockError::WouldBlock) if Instant::now() < until => {
                thread::sleep(Duration::from_millis(2));
            }
            Err(TryLockError::WouldBlock) => return None,
        }
    }
}
