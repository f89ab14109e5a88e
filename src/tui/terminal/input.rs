//! One queue for everything that happens: keys, pastes, sizes, and the program's own messages.

use std::{
    io, iter,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{Receiver, SyncSender, sync_channel},
    },
    thread,
    time::{Duration, Instant},
};

use crossterm::event::{self, Event, KeyEvent, KeyEventKind, MouseButton, MouseEvent, MouseEventKind};

use super::end::{HUNG_UP, end};
use super::tty::Tty;
use crate::fault;

/// Messages that may wait. Beyond that, keys wait in the terminal and replies in the worker.
const CAPACITY: usize = 256;

/// Something that happened; `T` is the program's own message, for instance a worker's reply.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Incoming<T> {
    Key(KeyEvent),
    /// The first button was pressed, or the wheel turned; the position may be outside the screen.
    Mouse(MouseEvent),
    /// Text was pasted. It is text, never a command.
    Paste(String),
    /// The window has another size: call [`Display::repaint`](super::Display::repaint) and draw; the frame has the new
    /// size.
    Resized,
    /// The program was stopped and continues: call [`Display::repaint`](super::Display::repaint) and draw.
    Resumed,
    App(T),
}

/// What travels in the queue.
enum Post<T> {
    Message(Incoming<T>),
    Notice,
}

/// What happened to the window. These are flags, since any number of resizes counts as one, and a full queue must not
/// block the thread that answers signals.
#[derive(Default)]
struct Notices {
    resized: AtomicBool,
    resumed: AtomicBool,
}

/// The receiving end, for the main loop.
pub struct Inbox<T> {
    receiver: Receiver<Post<T>>,
    /// Kept so that the queue never counts as closed.
    sender: SyncSender<Post<T>>,
    notices: Arc<Notices>,
}

impl<T: Send + 'static> Inbox<T> {
    /// A queue with nothing in it.
    pub fn empty() -> Self {
        let (sender, receiver) = sync_channel(CAPACITY);
        Self { receiver, sender, notices: Arc::default() }
    }

    /// The next thing that happened. Sleeps until there is one, or until `deadline`, when it returns `None`.
    pub fn next(&self, deadline: Option<Instant>) -> Option<Incoming<T>> {
        loop {
            if let Some(notice) = self.notice() {
                return Some(notice);
            }
            let post = match deadline {
                None => self.receiver.recv().ok(),
                Some(deadline) => {
                    self.receiver.recv_timeout(deadline.saturating_duration_since(Instant::now())).ok()
                }
            };
            if let Post::Message(message) = post? {
                return Some(message);
            }
        }
    }

    /// What else has happened by now, without waiting; at most one queue full, so that a frame gets its turn.
    pub fn pending(&self) -> impl Iterator<Item = Incoming<T>> + '_ {
        iter::from_fn(|| {
            loop {
                if let Some(notice) = self.notice() {
                    return Some(notice);
                }
                if let Post::Message(message) = self.receiver.try_recv().ok()? {
                    return Some(message);
                }
            }
        })
        .take(CAPACITY)
    }

    /// A sending end for a worker.
    ///
    /// Not for the thread that receives: with a full queue it would wait for itself.
    pub fn sender(&self) -> Sender<T> {
        Sender(self.sender.clone())
    }

    /// A stand-in, in tests, for the thread that reads the terminal.
    ///
    /// # Panics
    /// If nobody reads any more.
    #[cfg(test)]
    pub fn typist(&self) -> impl Fn(Incoming<T>) + Send + 'static {
        let sender = self.sender.clone();
        move |incoming| sender.send(Post::Message(incoming)).unwrap()
    }

    /// A sending end for the thread that answers signals.
    pub(super) fn notifier(&self) -> Notifier {
        let sender = self.sender.clone();
        // With a full queue nobody needs waking up, and with a closed one there is nobody to wake.
        Notifier {
            notices: Arc::clone(&self.notices),
            wake: Box::new(move || drop(sender.try_send(Post::Notice))),
        }
    }

    pub(super) fn read_terminal(&self, line: &'static Tty) -> io::Result<()> {
        let sender = self.sender.clone();
        thread::Builder::new().name("input".to_owned()).spawn(move || {
            loop {
                if let Ok(false) = event::poll(Duration::ZERO) {
                    line.remind_of_input();
                }
                let message = match event::read() {
                    Ok(Event::Key(key)) if key.kind != KeyEventKind::Release => Incoming::Key(key),
                    Ok(Event::Paste(text)) => Incoming::Paste(text),
                    Ok(Event::Mouse(mouse)) if is_wanted(mouse.kind) => Incoming::Mouse(mouse),
                    // Sizes come from the signal itself: this reader misses a resize that arrives within a sequence.
                    Ok(_) => continue,
                    Err(_) => end(HUNG_UP),
                };
                fault::point(fault::INPUT);
                if sender.send(Post::Message(message)).is_err() {
                    return;
                }
            }
        })?;
        Ok(())
    }

    fn notice(&self) -> Option<Incoming<T>> {
        // A resume comes first: it draws everything, at the new size too.
        if self.notices.resumed.swap(false, Ordering::SeqCst) {
            Some(Incoming::Resumed)
        } else if self.notices.resized.swap(false, Ordering::SeqCst) {
            Some(Incoming::Resized)
        } else {
            None
        }
    }
}

fn is_wanted(kind: MouseEventKind) -> bool {
    use MouseEventKind::{Down, ScrollDown, ScrollUp};
    matches!(kind, Down(MouseButton::Left) | ScrollUp | ScrollDown)
}

/// A sending end for the program's own messages. Waits while the queue is full.
pub struct Sender<T>(SyncSender<Post<T>>);

impl<T> Sender<T> {
    /// Sends a message; false if nobody receives any more, and the worker may end.
    pub fn send(&self, message: T) -> bool {
        self.0.send(Post::Message(Incoming::App(message))).is_ok()
    }
}

impl<T> Clone for Sender<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

/// Tells the main loop about the window; never waits.
pub(super) struct Notifier {
    notices: Arc<Notices>,
    wake: Box<dyn Fn() + Send>,
}

impl Notifier {
    pub(super) fn resized(&self) {
        self.notices.resized.store(true, Ordering::SeqCst);
        (self.wake)();
    }

    pub(super) fn resumed(&self) {
        self.notices.resumed.store(true, Ordering::SeqCst);
        (self.wake)();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_arrive_in_order_and_the_wait_ends_at_the_deadline() {
        let inbox = Inbox::empty();
        let sender = inbox.sender();
        assert!(sender.send(1) && sender.send(2));
        assert_eq!(inbox.next(None), Some(Incoming::App(1)));
        assert_eq!(inbox.pending().collect::<Vec<_>>(), [Incoming::App(2)]);
        assert_eq!(inbox.next(Some(Instant::now())), None);
    }

    #[test]
    fn notices_collapse_and_pass_a_full_queue() {
        let inbox = Inbox::empty();
        let (sender, notifier) = (inbox.sender(), inbox.notifier());
        for number in 0..CAPACITY {
            assert!(sender.send(number));
        }
        for _ in 0..3 {
            notifier.resized();
        }
        notifier.resumed();
        assert_eq!(inbox.next(None), Some(Incoming::Resumed));
        assert_eq!(inbox.next(None), Some(Incoming::Resized));
        assert_eq!(inbox.next(None), Some(Incoming::App(0)));
    }

    #[test]
    fn a_notice_wakes_a_waiting_loop() {
        let inbox = Inbox::<()>::empty();
        let notifier = inbox.notifier();
        let waker = thread::spawn(move || notifier.resized());
        assert_eq!(inbox.next(None), Some(Incoming::Resized));
        waker.join().unwrap();
        assert_eq!(inbox.pending().count(), 0);
    }

    #[test]
    fn one_round_takes_at_most_one_queue_full() {
        let inbox = Inbox::empty();
        let sender = inbox.sender();
        let worker = thread::spawn(move || (0..CAPACITY + 10).all(|number| sender.send(number)));
        let first = inbox.next(None);
        assert!(first.is_some() && inbox.pending().count() <= CAPACITY);
        while inbox.next(Some(Instant::now() + Duration::from_millis(50))).is_some() {}
        assert!(worker.join().unwrap());
    }
}
