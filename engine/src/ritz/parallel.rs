//! Work shared evenly among all cores.

use std::num::NonZeroUsize;
use std::thread;

/// Number of parts that run at the same time.
pub fn cores() -> usize {
    thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// Does `work` on all parts at the same time, the first on the caller's thread; returns when all are done.
pub fn each<T: Send>(parts: impl IntoIterator<Item = T>, work: impl Fn(T) + Sync) {
    let mut parts = parts.into_iter();
    let Some(own) = parts.next() else { return };
    let work = &work;
    thread::scope(|scope| {
        for part in parts {
            scope.spawn(move || work(part));
        }
        work(own);
    });
}
