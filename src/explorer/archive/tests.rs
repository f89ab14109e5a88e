use super::*;
use crate::explorer::session::FORMAT;
use crate::explorer::{Command, Id, Inline, Model, Reply, answer, open, update};
use crate::store::Store;
use crate::store::hash::sha256;
use std::fs::{File, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::sync::mpsc::channel;
use std::time::Instant;

struct Bench {
    folder: tempfile::TempDir,
    driver: Inline,
    model: Model,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::at(folder.path().join("presets"), &[]);
        let source = store.resolve("fig-3-jkr").unwrap();
        let assignments = ["basis.rings=20", "path.end_contact_radius=0.3"];
        let (mut model, effects) = open(store.load(&source, &assignments).unwrap());
        let driver = Inline::new(store);
        driver.settle(&mut model, effects);
        Self { folder, driver, model }
    }

    fn does(&mut self, command: impl Into<Command>) -> Snapshot {
        let effects = update(&mut self.model, command.into());
        self.driver.settle(&mut self.model, effects);
        Snapshot::of(&self.model)
    }

    fn archive(&self) -> Archive {
        Archive::at(self.folder.path().join("state/sessions"))
    }

    fn names(&self) -> Vec<String> {
        let listed = self.archive().list().unwrap();
        listed.into_iter().map(|entry| entry.name).collect()
    }

    /// An autosave whose thread has written one step.
    fn written(&mut self) -> Autosave {
        let autosave = Autosave::new(self.archive());
        autosave.start(|text| panic!("{text:?}")).unwrap();
        autosave.offer(self.does(Id::Step));
        let begun = Instant::now();
        while self.names().is_empty() {
            assert!(begun.elapsed() < PATIENCE, "nothing was written");
            std::thread::sleep(Duration::from_millis(5));
        }
        autosave
    }

    /// All files in the folder.
    fn files(&self) -> Vec<String> {
        let Ok(files) = fs::read_dir(self.archive().folder().unwrap()) else { return Vec::new() };
        let mut names: Vec<String> =
            files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

const PATIENCE: Duration = Duration::from_secs(20);

/// A session with a measured profile, saved twice with a step in between; returns its last snapshot.
fn with_profile(bench: &mut Bench, curvature: f64) -> Snapshot {
    let path = bench.folder.path().join("scan.csv");
    let rows: Vec<String> = (0..200)
        .map(|i| f64::from(i) / 100.0)
        .map(|r| format!("{r},{}", curvature * r * r + r / 3e5))
        .collect();
    fs::write(&path, rows.join("\n")).unwrap();
    let set = |key: &'static str, text: &str| Command::Set { key: key.into(), text: text.to_owned() };
    bench.does(set("gap.shape", "profile"));
    bench.does(set("gap.file", path.to_str().unwrap()));
    let mut claim = bench.archive().begin("scan").unwrap();
    claim.save(Document::new(&bench.does(Id::Step), Ended::Running, 0)).unwrap();
    let last = bench.does(Id::Step);
    claim.save(Document::new(&last, Ended::Quit, 0)).unwrap();
    fs::remove_file(path).unwrap();
    last
}

/// The data files of [`with_profile`]; the walk had also passed through the profile that comes with the program.
fn data(bench: &Bench) -> Vec<PathBuf> {
    let files = fs::read_dir(bench.archive().folder().unwrap().join("data"));
    let files = files.into_iter().flatten().map(|file| file.unwrap().path());
    files.filter(|file| fs::read_to_string(file).unwrap().contains("\n1.99,")).collect()
}

#[test]
fn the_rows_of_a_profile_are_written_once_beside_the_session_and_come_back_bit_for_bit() {
    let mut bench = Bench::new();
    let snapshot = with_profile(&mut bench, 0.5);
    let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
    let folder = bench.archive().folder().unwrap().to_owned();
    let session = folder.join("scan-1.json");
    let files = data(&bench);
    let [file] = &files[..] else { panic!("{files:?}") };
    assert_eq!(file.file_stem().unwrap().to_str().unwrap(), sha256(&fs::read(file).unwrap()));
    assert_eq!((mode(&folder.join("data")), mode(file)), (mode(&folder), mode(&session)));
    // The session names them and contains no rows itself.
    let text = fs::read_to_string(&session).unwrap();
    assert!(text.contains(file.file_stem().unwrap().to_str().unwrap()) && !text.contains("r,h"));
    // What is read back is written unchanged.
    let within = |snapshot: &Snapshot| Document::new(snapshot, Ended::Quit, 0).json().unwrap();
    let mut held = bench.archive().load("scan-1").unwrap();
    assert_eq!(held.snapshot.preset, snapshot.preset);
    assert_eq!(String::from_utf8(within(&held.snapshot)), String::from_utf8(within(&snapshot)));
    // Neither the resumed session nor another one with the same rows writes them again.
    let then = SystemTime::now() - Duration::from_secs(5000);
    File::options().write(true).open(file).unwrap().set_modified(then).unwrap();
    let before = (file.metadata().unwrap().modified().unwrap(), fs::read(file).unwrap());
    held.claim.save(Document::new(&held.snapshot, Ended::Running, 0)).unwrap();
    with_profile(&mut bench, 0.5);
    assert_eq!((file.metadata().unwrap().modified().unwrap(), fs::read(file).unwrap()), before);
    assert_eq!(data(&bench), files);
    // A document that was not laid aside contains its rows.
    let old = bench.archive().begin("old").unwrap();
    old.write(&within(&snapshot)).unwrap();
    drop(old);
    assert!(fs::read_to_string(folder.join("old-1.json")).unwrap().contains("\"text\":\"r,h\\n0.0,0.0\\n"));
    fs::remove_file(file).unwrap();
    assert_eq!(bench.archive().load("old-1").unwrap().snapshot.preset, snapshot.preset);
    // Data that disappear while the program runs are written again.
    held.claim.save(Document::new(&held.snapshot, Ended::Quit, 0)).unwrap();
    drop(held);
    assert_eq!((data(&bench), fs::read(file).unwrap()), (files, before.1));
}

#[test]
fn data_that_are_gone_or_altered_are_named() {
    let mut bench = Bench::new();
    with_profile(&mut bench, 0.5);
    let file = data(&bench).remove(0);
    let error = || bench.archive().load("scan-1").unwrap_err().to_string();
    let whole = fs::read_to_string(&file).unwrap();
    fs::write(&file, whole.replacen("0.02,", "0.021,", 1)).unwrap();
    assert!(
        error().contains("scan-1.json: the rows of its profile \"")
            && error().contains("scan.csv\" are lost: ")
            && error().ends_with(".csv was changed: its SHA-256 does not match its name"),
        "{}",
        error()
    );
    fs::remove_file(&file).unwrap();
    assert!(error().ends_with(".csv is gone"), "{}", error());
    // The session stays where it is, since the data may come back; the rest of it can still be read.
    assert_eq!(bench.archive().summary("scan-1").unwrap().steps, 4);
    // A name that leads elsewhere is not accepted.
    let session = bench.archive().folder().unwrap().join("scan-1.json");
    let text = fs::read_to_string(&session).unwrap();
    let hash = file.file_stem().unwrap().to_str().unwrap();
    fs::write(&session, text.replace(hash, "../../scan")).unwrap();
    assert!(error().ends_with("\"../../scan\" is not a SHA-256"), "{}", error());
    fs::write(&session, text).unwrap();
    fs::write(&file, whole).unwrap();
    bench.archive().load("scan-1").unwrap();
}

#[test]
fn data_go_with_the_last_session_that_uses_them() {
    let mut bench = Bench::new();
    with_profile(&mut bench, 0.5);
    with_profile(&mut bench, 0.5);
    with_profile(&mut bench, 0.25);
    // The third session walked in the first profile too.
    let names = |bench: &Bench| data(bench).len();
    assert_eq!(names(&bench), 2);
    bench.archive().delete("scan-1").unwrap();
    bench.archive().delete("scan-2").unwrap();
    assert_eq!(names(&bench), 2);
    let folder = bench.archive().folder().unwrap().to_owned();
    let damaged = folder.join("scan-3.damaged");
    fs::copy(folder.join("scan-3.json"), &damaged).unwrap();
    bench.archive().delete("scan-3").unwrap();
    assert_eq!(names(&bench), 2, "one kept aside counts");
    fs::remove_file(damaged).unwrap();
    // While anyone is between writing the data and writing the session, all data stay.
    let held = Data::beside(&folder).hold().unwrap();
    bench.archive().make_room("");
    assert_eq!(names(&bench), 2);
    drop(held);
    bench.archive().make_room("");
    assert_eq!(names(&bench), 0);
}

#[test]
fn nothing_is_written_before_there_is_something_to_lose() {
    let mut bench = Bench::new();
    let autosave = Autosave::new(bench.archive());
    autosave.offer(Snapshot::of(&bench.model));
    autosave.offer(bench.does(Id::NextView));
    autosave.finish(Ended::Quit, PATIENCE).unwrap();
    assert!(!bench.archive().folder().unwrap().exists());
}

#[test]
fn a_session_is_kept_under_a_name_of_its_own_and_taken_up_again() {
    let mut bench = Bench::new();
    for name in ["fig-3-jkr-1", "fig-3-jkr-2"] {
        let autosave = Autosave::new(bench.archive());
        autosave.offer(bench.does(Id::Step));
        autosave.finish(Ended::Dropped, PATIENCE).unwrap();
        assert_eq!(bench.names()[0], name);
    }
    assert_eq!(bench.files(), ["fig-3-jkr-1.json", "fig-3-jkr-2.json"], "no lock and no other file is left");
    let held = bench.archive().cut_off().unwrap().unwrap();
    assert_eq!((held.claim.name(), held.summary.steps), ("fig-3-jkr-2", 2));
    // It belongs to whoever resumed it.
    assert!(bench.archive().is_running("fig-3-jkr-2"));
    assert!(matches!(bench.archive().load("fig-3-jkr-2"), Err(ArchiveError::Running { .. })));
    assert!(matches!(bench.archive().delete("fig-3-jkr-2"), Err(ArchiveError::Running { .. })));
    assert_eq!(bench.archive().newest().unwrap().as_deref(), Some("fig-3-jkr-1"));
    // Left at once: only the fact that it ended well is written.
    let (model, _) = held.snapshot.resume(None);
    let autosave = Autosave::new(bench.archive());
    autosave.adopt(&Snapshot::of(&model), held.claim, held.summary.ended);
    autosave.offer(Snapshot::of(&model));
    autosave.finish(Ended::Quit, PATIENCE).unwrap();
    assert_eq!(bench.archive().summary("fig-3-jkr-2").unwrap().ended, Ended::Quit);
    assert_eq!(bench.names().len(), 2);
    // The newest session ended well: nothing is offered.
    assert!(bench.archive().cut_off().unwrap().is_none());
    bench.archive().delete("fig-3-jkr-2").unwrap();
    assert!(bench.archive().cut_off().unwrap().is_some_and(|held| held.claim.name() == "fig-3-jkr-1"));
    let message = bench.archive().delete("fig-3-jkr-9").unwrap_err().to_string();
    assert_eq!(message, "no session is called \"fig-3-jkr-9\"; did you mean fig-3-jkr-1?");
    assert!(matches!(bench.archive().load("../etc/passwd"), Err(ArchiveError::NotFound { .. })));
}

#[test]
fn the_thread_writes_what_is_left_with_it_and_a_killed_program_is_seen() {
    let mut bench = Bench::new();
    let autosave = bench.written();
    assert_eq!(bench.archive().summary("fig-3-jkr-1").unwrap().ended, Ended::Running);
    // A copy without its lock is what a killed program leaves behind.
    let folder = bench.archive().folder().unwrap().to_owned();
    fs::copy(folder.join("fig-3-jkr-1.json"), folder.join("fig-3-jkr-7.json")).unwrap();
    assert_eq!(bench.archive().summary("fig-3-jkr-7").unwrap().ended, Ended::Dropped);
    autosave.finish(Ended::Dropped, PATIENCE).unwrap();
}

#[test]
fn the_session_whose_connection_drops_last_is_the_newest() {
    let mut bench = Bench::new();
    let autosave = bench.written();
    let other = Autosave::new(bench.archive());
    other.offer(bench.does(Id::Step));
    other.finish(Ended::Dropped, PATIENCE).unwrap();
    assert_eq!(bench.names()[0], "fig-3-jkr-2");
    // Nothing has changed in it since it was written.
    autosave.finish(Ended::Dropped, PATIENCE).unwrap();
    assert_eq!(bench.names()[0], "fig-3-jkr-1");
    assert_eq!(bench.archive().cut_off().unwrap().unwrap().claim.name(), "fig-3-jkr-1");
}

#[test]
fn another_preset_is_another_session_and_the_one_before_is_whole() {
    let mut bench = Bench::new();
    let autosave = Autosave::new(bench.archive());
    autosave.offer(bench.does(Id::Step));
    autosave.offer(bench.does(Id::Step));
    autosave.offer(bench.does(Command::Open("fig-1-hertz".to_owned())));
    autosave.offer(bench.does(Id::Step));
    autosave.finish(Ended::Dropped, PATIENCE).unwrap();
    let told = |name: &str| {
        let summary = bench.archive().summary(name).unwrap();
        (summary.steps, summary.ended)
    };
    assert_eq!((told("fig-3-jkr-1"), told("fig-1-hertz-1")), ((2, Ended::Quit), (1, Ended::Dropped)));
}

#[test]
fn a_folder_that_cannot_be_written_is_a_notice() {
    let mut bench = Bench::new();
    // For a user who may write everywhere, the path must not be a folder at all.
    fs::write(bench.folder.path().join("state"), "").unwrap();
    let autosave = Autosave::new(bench.archive());
    let (sender, notices) = channel();
    autosave.start(move |text| sender.send(text).unwrap()).unwrap();
    autosave.offer(bench.does(Id::Step));
    let notice = notices.recv_timeout(PATIENCE).unwrap();
    let why = notice.clone().unwrap_err();
    assert!(why.contains("cannot make the folder"), "{why}");
    // The screen does not promise then that the session keeps anything.
    assert_eq!(bench.model.kept, Ok(()));
    answer(&mut bench.model, Reply::SessionSaved(notice));
    assert_eq!(bench.model.kept, Err(why));
    assert!(autosave.finish(Ended::Quit, PATIENCE).is_err());
}

#[test]
fn a_write_that_fails_leaves_the_one_before() {
    let mut bench = Bench::new();
    let autosave = Autosave::new(bench.archive());
    autosave.offer(bench.does(Id::Step));
    autosave.finish(Ended::Quit, PATIENCE).unwrap();
    let folder = bench.archive().folder().unwrap().to_owned();
    let before = fs::read(folder.join("fig-3-jkr-1.json")).unwrap();
    let held = bench.archive().load("fig-3-jkr-1").unwrap();
    fs::set_permissions(&folder, Permissions::from_mode(0o500)).unwrap();
    let is_root = File::create(folder.join("probe")).is_ok();
    let written = held.claim.write(b"torn");
    fs::set_permissions(&folder, Permissions::from_mode(0o700)).unwrap();
    if !is_root {
        assert!(written.is_err());
        assert_eq!(fs::read(folder.join("fig-3-jkr-1.json")).unwrap(), before);
    }
}

#[test]
fn a_damaged_session_is_kept_aside_and_said_once() {
    let mut bench = Bench::new();
    let autosave = Autosave::new(bench.archive());
    autosave.offer(bench.does(Id::Step));
    autosave.finish(Ended::Dropped, PATIENCE).unwrap();
    let folder = bench.archive().folder().unwrap().to_owned();
    let whole = fs::read(folder.join("fig-3-jkr-1.json")).unwrap();
    let half = &whole[..whole.len() / 2];
    fs::write(folder.join("fig-3-jkr-1.json"), half).unwrap();
    let error = bench.archive().load("fig-3-jkr-1").unwrap_err().to_string();
    assert!(error.contains("fig-3-jkr-1.json: the session is damaged: "), "{error}");
    let notice = bench.archive().cut_off().unwrap_err();
    assert!(
        notice.starts_with("fig-3-jkr-1 is kept as ") && notice.contains("fig-3-jkr-1.damaged"),
        "{notice}"
    );
    assert!(bench.archive().cut_off().unwrap().is_none());
    let autosave = Autosave::new(bench.archive());
    autosave.offer(bench.does(Id::Step));
    autosave.finish(Ended::Quit, PATIENCE).unwrap();
    assert_eq!(bench.files(), ["fig-3-jkr-1.damaged", "fig-3-jkr-2.json"]);
    assert_eq!(fs::read(folder.join("fig-3-jkr-1.damaged")).unwrap(), half);
    // A session of a later version is left where it is.
    let text =
        String::from_utf8(whole).unwrap().replacen(&format!("\"format\":{FORMAT}"), "\"format\":99", 1);
    fs::write(folder.join("fig-3-jkr-8.json"), &text).unwrap();
    assert!(bench.archive().cut_off().unwrap_err().contains("has format 99"));
    assert_eq!(fs::read_to_string(folder.join("fig-3-jkr-8.json")).unwrap(), text);
}

#[test]
fn old_sessions_make_room() {
    let mut bench = Bench::new();
    let folder = bench.archive().folder().unwrap().to_owned();
    let snapshot = bench.does(Id::Step);
    let document = Document::new(&snapshot, Ended::Quit, 0).json().unwrap();
    for number in 1..=u32::try_from(MOST).unwrap() + 5 {
        let claim = bench.archive().begin("a").unwrap();
        claim.write(&document).unwrap();
        let then = SystemTime::now() - Duration::from_secs(100_000 - u64::from(number));
        File::options()
            .write(true)
            .open(folder.join(format!("a-{number}.json")))
            .unwrap()
            .set_modified(then)
            .unwrap();
    }
    for left in [".pulloff-x.tmp", ".b-1.lock", "notes.txt"] {
        let file = File::create(folder.join(left)).unwrap();
        file.set_modified(SystemTime::now() - 2 * STALE).unwrap();
    }
    // A running session stays, however old.
    let running = bench.archive().load("a-1").unwrap();
    let autosave = Autosave::new(bench.archive());
    autosave.offer(snapshot);
    autosave.finish(Ended::Quit, PATIENCE).unwrap();
    drop(running);
    let names = bench.names();
    assert_eq!(names.len(), MOST + 1);
    assert!(
        names[0] == "fig-3-jkr-1" && names.last().unwrap() == "a-1" && !names.contains(&"a-6".to_owned())
    );
    assert!(names.contains(&"a-7".to_owned()));
    let others: Vec<String> = bench
        .files()
        .into_iter()
        .filter(|file| Path::new(file).extension().is_none_or(|ending| ending != ENDING))
        .collect();
    assert_eq!(others, ["notes.txt"]);
}

#[test]
fn a_name_follows_from_that_of_the_preset() {
    for (preset, name) in [
        ("fig-9", "fig-9"),
        ("/home/x/My Rough Sphere.toml", "myroughsphere"),
        ("../\u{1b}[2J", "2j"),
        ("___", "session"),
        ("", "session"),
    ] {
        assert_eq!(base_name(preset), name, "{preset}");
    }
    assert!(is_well_formed(&format!("{}-{}", base_name(&"a".repeat(200)), u32::MAX)));
}

#[test]
fn a_measured_curve_is_kept_as_its_file_beside_the_session() {
    let mut bench = Bench::new();
    let path = bench.folder.path().join("curve.csv");
    let rows: Vec<String> = (0..50).map(|i| format!("{i},{}", i * i)).collect();
    let text = format!("delta,force\n{}\n", rows.join("\n"));
    fs::write(&path, &text).unwrap();
    let name = path.to_str().unwrap().to_owned();
    let snapshot = bench.does(Command::Assign(vec![("data.file".into(), name)]));
    let mut claim = bench.archive().begin("scan").unwrap();
    claim.save(Document::new(&snapshot, Ended::Quit, 0)).unwrap();
    drop(claim);
    fs::remove_file(path).unwrap();
    let folder = bench.archive().folder().unwrap().to_owned();
    let kept = folder.join("data").join(format!("{}.csv", sha256(text.as_bytes())));
    assert_eq!(fs::read_to_string(&kept).unwrap(), text);
    assert!(!fs::read_to_string(folder.join("scan-1.json")).unwrap().contains("48,2304"));
    assert_eq!(bench.archive().load("scan-1").unwrap().snapshot.preset, snapshot.preset);
    fs::remove_file(kept).unwrap();
    let error = bench.archive().load("scan-1").unwrap_err().to_string();
    assert!(error.contains("curve.csv") && error.contains("is gone"), "{error}");
}
