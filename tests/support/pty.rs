//! A program in a pseudo-terminal: keys in, a parsed screen out.
//!
//! Nothing here sleeps for a fixed time in the hope that something has happened by then: every wait is for a condition,
//! ends as soon as the condition holds, and after [`LIMIT`] fails with the screen as it was.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::{
    fs::OpenOptions,
    io::{ErrorKind, Read, Write},
    num::NonZeroU16,
    os::unix::fs::OpenOptionsExt,
    path::Path,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use rustix::{
    fs::OFlags,
    process::{Pid, Signal, kill_process},
};

/// How long any wait may take, even on a machine that stalls for a while.
pub const LIMIT: Duration = Duration::from_secs(60);

/// How many of the last bytes a failed wait shows.
const TAIL: usize = 500;

/// The pause between two checks of a condition.
const LOOK: Duration = Duration::from_millis(2);

/// The environment variables that a program starts with, unless a test sets others.
const ENVIRONMENT: [(&str, &str); 3] =
    [("TERM", "xterm-256color"), ("LANG", "C.UTF-8"), ("PATH", "/usr/bin:/bin")];

/// Runs `"$@"` as a shell with job control does, then reports how it ended and waits for a line; `fg` continues a
/// stopped program. So the program does not lead the session, and can be stopped.
const SHELL: &str = r#"
set -m
"$@"
status=$?
while [ "$status" -eq 147 ]; do # 128 + SIGSTOP
    echo "[stopped]"; stty -a; read -r _; fg >/dev/null; status=$?
done
echo "[ended $status]"; stty -a; read -r _
exit "$status"
"#;

/// A program in a pseudo-terminal.
pub struct Pty {
    child: Box<dyn Child + Send + Sync>,
    /// `None` once the terminal is closed.
    master: Option<Box<dyn MasterPty + Send>>,
    writer: Option<Box<dyn Write + Send>>,
    reader: Option<JoinHandle<()>>,
    stop: Arc<AtomicBool>,
    paused: Arc<AtomicBool>,
    output: Arc<Mutex<Output>>,
    modes_at_start: String,
    /// The program's home, unless a test gives it another: nothing outlives a test or comes from an earlier one.
    _home: tempfile::TempDir,
}

/// All that the program has written.
struct Output {
    raw: Vec<u8>,
    parser: vt100::Parser,
}

impl Pty {
    /// Starts a program as the leader of its session, as `ssh host program` does: Ctrl-Z has no effect on it.
    pub fn spawn(program: &Path, args: &[&str], env: &[(&str, &str)], cols: u16, rows: u16) -> Self {
        let mut command = CommandBuilder::new(program);
        command.args(args);
        Self::start(command, env, cols, rows)
    }

    /// Starts a program under a shell with job control, which can stop and continue it.
    pub fn spawn_in_shell(program: &Path, args: &[&str], env: &[(&str, &str)], cols: u16, rows: u16) -> Self {
        let mut command = CommandBuilder::new("/bin/sh");
        command.args(["-c", SHELL, "sh"]);
        command.arg(program);
        command.args(args);
        Self::start(command, env, cols, rows)
    }

    /// Starts a program that ignores SIGHUP, as under `nohup`.
    pub fn spawn_ignoring_hup(
        program: &Path,
        args: &[&str],
        env: &[(&str, &str)],
        cols: u16,
        rows: u16,
    ) -> Self {
        let mut command = CommandBuilder::new("/bin/sh");
        command.args(["-c", r#"trap "" HUP; exec "$@""#, "sh"]);
        command.arg(program);
        command.args(args);
        Self::start(command, env, cols, rows)
    }

    fn start(mut command: CommandBuilder, env: &[(&str, &str)], cols: u16, rows: u16) -> Self {
        let home = tempfile::tempdir().expect("a home");
        command.env_clear();
        command.env("HOME", home.path());
        for (name, value) in ENVIRONMENT.iter().chain(env) {
            command.env(name, value);
        }
        command.cwd(std::env::temp_dir());
        let pair = native_pty_system().openpty(size(cols, rows)).expect("a pseudo-terminal");
        let modes_at_start = modes_of(&*pair.master);
        let child = pair.slave.spawn_command(command).expect("the program starts");
        drop(pair.slave);
        let output = Arc::new(Mutex::new(Output { raw: Vec::new(), parser: parser(cols, rows) }));
        let stop = Arc::new(AtomicBool::new(false));
        let paused = Arc::new(AtomicBool::new(false));
        let mut source = pair.master.try_clone_reader().expect("a reader");
        let reader = thread::spawn({
            let (output, stop, paused) = (Arc::clone(&output), Arc::clone(&stop), Arc::clone(&paused));
            move || {
                let mut buffer = [0; 4096];
                loop {
                    let count = match source.read(&mut buffer) {
                        Ok(count @ 1..) => count,
                        Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                        _ => return,
                    };
                    if stop.load(Ordering::SeqCst) {
                        return;
                    }
                    let mut output = output.lock().unwrap_or_else(PoisonError::into_inner);
                    output.raw.extend_from_slice(&buffer[..count]);
                    output.parser.process(&buffer[..count]);
                    drop(output);
                    while paused.load(Ordering::SeqCst) {
                        thread::park();
                    }
                }
            }
        });
        Self {
            child,
            writer: Some(pair.master.take_writer().expect("a writer")),
            master: Some(pair.master),
            reader: Some(reader),
            stop,
            paused,
            output,
            modes_at_start,
            _home: home,
        }
    }

    /// Types. Escape sequences are written out: `\x1b[A` is the up key.
    pub fn keys(&mut self, keys: &str) {
        let writer = self.writer.as_mut().expect("the terminal is open");
        writer.write_all(keys.as_bytes()).expect("the terminal takes keys");
        writer.flush().expect("the terminal takes keys");
    }

    /// Pastes, with the marks that a terminal adds around.
    pub fn paste(&mut self, text: &str) {
        self.keys(&format!("\x1b[200~{text}\x1b[201~"));
    }

    /// Waits until the screen's text meets the condition.
    pub fn wait_for(&self, wanted: impl Fn(&str) -> bool, what: &str) {
        self.wait_until(|pty| wanted(&pty.screen()), what);
    }

    /// Waits until anything about the terminal meets the condition.
    pub fn wait_until(&self, wanted: impl Fn(&Self) -> bool, what: &str) {
        let start = Instant::now();
        while !wanted(self) {
            assert!(start.elapsed() < LIMIT, "still waiting for {what}; {}", self.account());
            thread::sleep(LOOK);
        }
    }

    /// Presses a key until the screen is as wanted, each time after the mark that the key moves has changed place.
    /// Whatever is computed meanwhile changes the rest of the screen and is not an answer to the key.
    pub fn press_until(
        &mut self,
        key: &str,
        mark: impl Fn(&str) -> Option<String>,
        wanted: impl Fn(&str) -> bool,
    ) {
        while !wanted(&self.screen()) {
            let before = mark(&self.screen());
            self.keys(key);
            // At the end of a list nothing moves, and this fails. Half a frame may have no mark, or half of it, so a
            // second look must find the same.
            let moved = |pty: &Self| mark(&pty.screen()).filter(|now| before.as_ref() != Some(now));
            self.wait_until(
                |pty| {
                    let first = moved(pty);
                    thread::sleep(LOOK);
                    first.is_some() && moved(pty) == first
                },
                "the mark moved",
            );
        }
    }

    /// The screen's text, a line per row.
    pub fn screen(&self) -> String {
        self.with_screen(vt100::Screen::contents)
    }

    /// Looks at the parsed screen: cells with their styles, the cursor, the modes.
    pub fn with_screen<R>(&self, look: impl FnOnce(&vt100::Screen) -> R) -> R {
        look(self.output.lock().unwrap_or_else(PoisonError::into_inner).parser.screen())
    }

    /// The state of affairs, for reading why a wait failed.
    fn account(&self) -> String {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.pid().as_raw_nonzero()));
        let state = stat.ok().and_then(|stat| Some(stat.rsplit_once(") ")?.1.chars().next()?.to_string()));
        let raw = self.raw();
        let tail = String::from_utf8_lossy(&raw[raw.len().saturating_sub(TAIL)..]).into_owned();
        let state = state.unwrap_or_else(|| "gone".to_owned());
        format!(
            "its process is {state} (Z: ended); the last bytes are {tail:?}; the screen is:\n{}",
            self.screen()
        )
    }

    /// Every byte written so far.
    pub fn raw(&self) -> Vec<u8> {
        self.output.lock().unwrap_or_else(PoisonError::into_inner).raw.clone()
    }

    /// Whether these bytes were written.
    pub fn wrote(&self, bytes: &[u8]) -> bool {
        self.raw().windows(bytes.len()).any(|window| window == bytes)
    }

    /// The private modes that the program has left in another state than it found them, by number: 1049 is the alternate screen.
    ///
    /// Read from the bytes, so that modes unknown to the parser are seen too.
    pub fn modes_left(&self) -> Vec<u16> {
        let raw = self.raw();
        let mut changed = Vec::new();
        for sequence in String::from_utf8_lossy(&raw).split("\x1b[?").skip(1) {
            let Some(end) = sequence.find(|c: char| !(c.is_ascii_digit() || c == ';')) else { continue };
            let on = match sequence.as_bytes()[end] {
                b'h' => true,
                b'l' => false,
                _ => continue,
            };
            for mode in sequence[..end].split(';').filter_map(|mode| mode.parse().ok()) {
                changed.retain(|&other| other != mode);
                // Line wrap and the cursor are on by default.
                if on != [7, 25].contains(&mode) {
                    changed.push(mode);
                }
            }
        }
        changed.sort_unstable();
        changed
    }

    /// The terminal's line modes (`stty`), as text to compare.
    pub fn line_modes(&self) -> String {
        modes_of(&**self.master.as_ref().expect("the terminal is open"))
    }

    /// Fails unless the terminal is as the program found it: no mode left on, line modes as before, cursor shown.
    pub fn assert_restored(&self) {
        assert_eq!(self.modes_left(), [] as [u16; 0], "modes left on");
        assert_eq!(self.line_modes(), self.modes_at_start, "line modes changed");
        self.with_screen(|screen| {
            assert!(!screen.alternate_screen(), "still on the alternate screen");
            assert!(!screen.hide_cursor(), "the cursor is hidden");
        });
    }

    /// Sets another window size; a 0 in either is passed to the program, while the parser keeps one cell.
    pub fn resize(&mut self, cols: u16, rows: u16) {
        // The parser first, because what the program draws next is for the new size.
        let (parser_rows, parser_cols) = (at_least_one(rows), at_least_one(cols));
        let mut output = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        output.parser.set_size(parser_rows, parser_cols);
        drop(output);
        self.master.as_ref().expect("the terminal is open").resize(size(cols, rows)).expect("a new size");
    }

    /// Reads one last piece from the program and then no more, like a connection that has fallen silent.
    pub fn stop_reading(&self) {
        self.paused.store(true, Ordering::SeqCst);
    }

    /// Undoes [`stop_reading`](Self::stop_reading).
    pub fn go_on_reading(&self) {
        self.paused.store(false, Ordering::SeqCst);
        if let Some(reader) = &self.reader {
            reader.thread().unpark();
        }
    }

    /// Sends a signal to the program, or to the shell above it.
    pub fn signal(&self, signal: Signal) {
        kill_process(self.pid(), signal).expect("the program runs");
    }

    /// The process of the program, or of the shell above it.
    pub fn pid(&self) -> Pid {
        let pid = self.child.process_id().and_then(|pid| i32::try_from(pid).ok());
        pid.and_then(Pid::from_raw).expect("a process")
    }

    /// Waits for the end and returns the exit status. Death by a signal counts as 1 here, because programs should exit.
    pub fn exit_code(&mut self) -> u32 {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().expect("the program can be waited for") {
                break status;
            }
            assert!(start.elapsed() < LIMIT, "the program does not end; {}", self.account());
            thread::sleep(LOOK);
        };
        if self.master.is_some() && !self.paused.load(Ordering::SeqCst) {
            // Once the last of its processes is gone, the reader finishes, and everything written is parsed.
            self.join_reader();
        }
        status.exit_code()
    }

    /// Takes the terminal away, as a broken connection does.
    pub fn close_terminal(&mut self) {
        // The reader holds the terminal open, so it must go first; something to read wakes it up.
        self.stop.store(true, Ordering::SeqCst);
        let name =
            self.master.as_ref().and_then(|master| master.tty_name()).expect("the terminal has a name");
        let no_control = i32::try_from(OFlags::NOCTTY.bits()).expect("a flag");
        if let Ok(mut terminal) = OpenOptions::new().write(true).custom_flags(no_control).open(name) {
            let _ = terminal.write_all(b" ");
        }
        self.join_reader();
        // When dropped, the writer types an end-of-file, which a program in raw mode takes for keys.
        self.writer = None;
        self.master = None;
    }

    fn join_reader(&mut self) {
        if let Some(reader) = self.reader.take() {
            let start = Instant::now();
            while !reader.is_finished() {
                assert!(start.elapsed() < LIMIT, "the terminal is still held open");
                thread::sleep(LOOK);
            }
            reader.join().expect("the reader");
        }
    }
}

impl Drop for Pty {
    fn drop(&mut self) {
        // Only for what remains after a failed test.
        if let Ok(None) = self.child.try_wait() {
            let _ = kill_process(self.pid(), Signal::KILL);
            let _ = self.child.wait();
        }
    }
}

fn size(cols: u16, rows: u16) -> PtySize {
    PtySize { rows, cols, pixel_width: 0, pixel_height: 0 }
}

fn at_least_one(length: u16) -> NonZeroU16 {
    NonZeroU16::new(length).unwrap_or(NonZeroU16::MIN)
}

fn parser(cols: u16, rows: u16) -> vt100::Parser {
    vt100::Parser::new(at_least_one(rows), at_least_one(cols), 0)
}

fn modes_of(master: &dyn MasterPty) -> String {
    format!("{:?}", master.get_termios())
}
