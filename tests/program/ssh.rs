//! The program over a real SSH connection: it starts, sends little, and is gone when the connection is.

use std::{
    collections::BTreeMap,
    fs::{self, File},
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use crate::support::pty::{LIMIT, Pty};
use crate::support::sshd::{Sshd, Wire};
use pulloff::store::lock::FolderLock;
use pulloff::store::{Overwrite, Source, Store, shipped};
use pulloff_engine::preset::Preset;
use rustix::process::Signal;
use serde_json::Value;

/// A home on the far side.
struct Far {
    sshd: Sshd,
    home: tempfile::TempDir,
}

/// A connection with the program at its other end.
struct Session {
    pty: Pty,
    wire: Wire,
    /// The file that holds the program's process number.
    number: PathBuf,
}

impl Far {
    fn new() -> Option<Self> {
        Some(Self { sshd: Sshd::start()?, home: tempfile::tempdir().expect("a home") })
    }

    fn at(&self, name: &str) -> PathBuf {
        self.home.path().join(name)
    }

    fn presets(&self) -> Store {
        Store::at(self.at("config/pulloff/presets"), &[])
    }

    /// Logs in and runs the program; `arguments` are words without spaces or quotes.
    fn start(&self, arguments: &str) -> Session {
        let (script, number) = (self.at("run"), self.at("number"));
        let text = format!(
            "echo $$ >{}\nexport HOME={home} XDG_CONFIG_HOME={home}/config XDG_STATE_HOME={home}/state LANG=C.UTF-8\n\
             exec {} {arguments}\n",
            number.display(),
            env!("CARGO_BIN_EXE_pulloff"),
            home = self.home.path().display(),
        );
        let _ = fs::remove_file(&number);
        fs::write(&script, text).expect("a script");
        let wire = self.sshd.wire();
        let pty = self.sshd.connect(&wire, &format!("/bin/sh {}", script.display()), 120, 40);
        Session { pty, wire, number }
    }

    /// Checks that there is no temporary file anywhere and no lock on the presets, and that the program starts again.
    fn assert_clean(&self) {
        let mut folders = vec![self.home.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("a folder") {
                let path = entry.expect("a file").path();
                let name = path.file_name().expect("a name").to_string_lossy().into_owned();
                assert!(!name.starts_with(".pulloff-"), "{} is left", path.display());
                folders.extend(path.is_dir().then_some(path));
            }
        }
        if let Some(folder) = self.presets().folder().filter(|folder| folder.exists()) {
            let lock = FolderLock::acquire(folder, Duration::ZERO).expect("a folder");
            assert!(lock.is_some(), "the presets are still locked");
        }
        let mut again = self.start("fig-3-jkr");
        again.wait_until_up();
        again.pty.keys("q");
        assert_eq!(again.pty.exit_code(), 0);
    }

    /// The documents of all sessions, by file.
    fn sessions(&self) -> BTreeMap<PathBuf, Value> {
        let files = fs::read_dir(self.at("state/pulloff/sessions")).into_iter().flatten();
        files
            .map(|file| file.expect("a file").path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "json"))
            .map(|path| {
                let text = fs::read_to_string(&path).expect("a session");
                let document = serde_json::from_str(&text).expect("a whole session");
                (path, document)
            })
            .collect()
    }

    /// Checks that the interrupted session resumes: left again, it is the same bit for bit.
    fn assert_resumes(&self) {
        let kept = |mut document: Value| {
            let ended = document["ended"].take();
            document["saved_at"] = Value::Null;
            // A walk that was cut short is no longer waited for.
            document["settled"] = Value::Null;
            (ended, document)
        };
        let mut before = self.sessions();
        before.retain(|_, document| document["ended"] == "dropped");
        assert_eq!(before.len(), 1, "one session was cut off");
        let mut again = self.start("--resume");
        again.pty.wait_for(|screen| screen.contains("resumed "), "the session");
        // Answers the question about unsaved changes, if there are any.
        again.pty.keys("qy");
        assert_eq!(again.pty.exit_code(), 0);
        let mut after = self.sessions();
        for (path, document) in before {
            let (_, before) = kept(document);
            let (ended, after) = kept(after.remove(&path).expect("the session"));
            assert_eq!(ended, "quit");
            assert!(before["nodes"].as_array().is_some_and(|nodes| !nodes.is_empty()));
            assert_eq!(before, after);
        }
    }
}

impl Session {
    fn wait_until_up(&self) {
        self.pty.wait_for(|screen| screen.contains("stable under displacement control"), "the first curve");
    }

    /// The program's folder below `/proc`.
    fn process(&self) -> PathBuf {
        let number = fs::read_to_string(&self.number).expect("the program has started");
        Path::new("/proc").join(number.trim())
    }

    /// Drops the connection and waits until the program is gone.
    fn drop_by(mut self, drop: Drop) {
        let process = self.process();
        assert!(is_running(&process), "the program was gone before the drop");
        match drop {
            Drop::KilledClient => self.pty.signal(Signal::KILL),
            Drop::Reset => self.wire.cut(),
        }
        let start = Instant::now();
        while is_running(&process) {
            assert!(start.elapsed() < LIMIT, "the program outlives its connection");
            std::thread::sleep(Duration::from_millis(5));
        }
        self.pty.exit_code();
    }
}

/// How a connection ends.
#[derive(Debug, Clone, Copy)]
enum Drop {
    KilledClient,
    Reset,
}

const DROPS: [Drop; 2] = [Drop::KilledClient, Drop::Reset];

/// A process that has ended may still wait for its parent to collect its status.
fn is_running(process: &Path) -> bool {
    fs::read_to_string(process.join("stat"))
        .is_ok_and(|stat| !stat.rsplit(')').next().unwrap_or_default().trim_start().starts_with('Z'))
}

fn wavy() -> Preset {
    let text = shipped::find("wavy-sphere").expect("shipped").text;
    pulloff::store::read("wavy-sphere", text).expect("shipped")
}

#[test]
fn it_starts_takes_keys_within_the_budget_and_gives_the_terminal_back() {
    let Some(far) = Far::new() else { return };
    let mut session = far.start("");
    session.wait_until_up();
    let pty = &mut session.pty;
    // The last of what is computed beside the curve: nothing of the first frames counts as an answer to a key.
    pty.wait_for(|screen| screen.contains("first snap A"), "the onset of snaps");
    let before = pty.raw().len();
    for _ in 0..10 {
        pty.keys("j");
        pty.wait_for(|screen| screen.contains(">λ"), "the next knob");
        pty.keys("k");
        pty.wait_for(|screen| screen.contains(">A"), "the knob above");
    }
    let moves = pty.raw().len() - before;
    assert!(moves < 20 * 300, "{moves} bytes for 20 moves");
    let before = pty.raw().len();
    for step in 1..=10 {
        pty.keys(" ");
        pty.wait_for(
            |screen| screen.contains(&format!("step {step} ")) || screen.contains(&format!("step {step}─")),
            "the step",
        );
    }
    let steps = pty.raw().len() - before;
    assert!(steps < 10 * 1500, "{steps} bytes for 10 steps");
    pty.keys("q");
    assert_eq!(pty.exit_code(), 0);
    pty.assert_restored();
}

#[test]
fn a_drop_while_idle() {
    let Some(far) = Far::new() else { return };
    for drop in DROPS {
        let mut session = far.start("");
        session.wait_until_up();
        session.pty.keys("     >");
        let is_settled = |screen: &str| screen.contains("unsaved") && screen.contains("step 6");
        session.pty.wait_for(is_settled, "a change and the state after it");
        session.drop_by(drop);
        far.assert_clean();
        far.assert_resumes();
    }
}

#[test]
fn a_drop_while_a_curve_is_computed() {
    let Some(far) = Far::new() else { return };
    for drop in DROPS {
        let session = far.start("--set basis.kind=rings --set basis.rings=2000");
        session.pty.wait_for(|screen| screen.contains("computing the equilibrium curve"), "the first frame");
        session.drop_by(drop);
        far.assert_clean();
    }
}

#[test]
fn a_drop_while_walking() {
    let Some(far) = Far::new() else { return };
    for drop in DROPS {
        let mut session = far.start("");
        session.wait_until_up();
        // Steps so short that there are thousands of them.
        session.pty.keys(&"[".repeat(12));
        session.pty.keys(":step 9999\r");
        // Before its first states there is nothing to keep.
        session.pty.wait_for(|screen| screen.contains("walking") && has_walked(screen), "the walk");
        session.drop_by(drop);
        far.assert_clean();
        far.assert_resumes();
    }
}

#[test]
fn a_drop_while_a_dialog_is_open() {
    let Some(far) = Far::new() else { return };
    for drop in DROPS {
        let mut session = far.start("");
        session.wait_until_up();
        // A walk with a jump, to be lost or kept.
        session.pty.keys("nx");
        session.pty.wait_for(|screen| screen.contains("Landed"), "the landing");
        session.pty.keys("\r0.003");
        session.pty.wait_for(|screen| screen.contains("> 0.003"), "the prompt");
        session.drop_by(drop);
        far.assert_clean();
        far.assert_resumes();
    }
}

#[test]
fn a_drop_while_saving() {
    let Some(far) = Far::new() else { return };
    let store = far.presets();
    let (source, _) = store.save("mine", &wavy(), None, Overwrite::Never).expect("a preset");
    let Source::User { path, .. } = &source else { panic!("not saved by name") };
    let old = fs::read(path).expect("a preset");
    for drop in DROPS {
        let mut session = far.start("mine");
        session.wait_until_up();
        // Every press changes the value: one that a busy machine has not answered yet does not affect the next.
        let changed = |screen: &str| screen.contains("unsaved");
        for _ in 0..10 {
            session.pty.keys("}");
            let pressed = Instant::now();
            while pressed.elapsed() < LIMIT / 10 && !changed(&session.pty.screen()) {
                std::thread::sleep(Duration::from_millis(5));
            }
            if changed(&session.pty.screen()) {
                break;
            }
        }
        // The change makes a state of its own; a resumed session would make it too, and not be the same.
        session.pty.wait_for(|screen| changed(screen) && has_walked(screen), "the state after a change");
        // The save waits for another saver in the same folder, so it is still under way at the drop.
        let folder = store.folder().expect("a folder");
        let ours = FolderLock::acquire(folder, LIMIT).expect("a lock").expect("a lock");
        session.pty.keys("s");
        let open = session.process().join("fd");
        session.pty.wait_until(|_| has_open(&open, folder), "the save");
        session.drop_by(drop);
        std::mem::drop(ours);
        assert_eq!(fs::read(path).expect("the preset"), old);
        far.assert_clean();
        far.assert_resumes();
    }
}

/// Whether there are states beyond the first.
fn has_walked(screen: &str) -> bool {
    !screen.contains("Here, step 0")
}

/// Whether one of the open files listed there is `file`.
fn has_open(list: &Path, file: &Path) -> bool {
    let wanted = File::open(file).and_then(|file| file.metadata()).expect("a file");
    let same = |path: PathBuf| {
        use std::os::unix::fs::MetadataExt;
        path.metadata().is_ok_and(|metadata| (metadata.dev(), metadata.ino()) == (wanted.dev(), wanted.ino()))
    };
    fs::read_dir(list).is_ok_and(|entries| entries.filter_map(Result::ok).any(|entry| same(entry.path())))
}
