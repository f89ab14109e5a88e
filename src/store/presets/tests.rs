//! Own presets: saved, read back, deleted, and what is refused.

use super::*;
use pulloff_engine::preset::model::BasisSpec;
use pulloff_engine::ritz::Grading;
use rustix::fs::{CWD, FileType, Mode, mknodat};
use std::os::unix::fs::{PermissionsExt, symlink};

fn wavy() -> Preset {
    crate::store::read("wavy", shipped::find("fig-9").unwrap().text).unwrap()
}

const COMMANDS: &[&str] = &["trace", "unload", "presets"];
const NONE: &[&str] = &[];

fn store() -> (tempfile::TempDir, Store) {
    let home = tempfile::tempdir().unwrap();
    let store = Store::at(home.path().join("config/pulloff/presets"), COMMANDS);
    (home, store)
}

fn with_rings(rings: usize) -> Preset {
    Preset { basis: BasisSpec::Rings { rings, grading: Grading::Uniform }, ..wavy() }
}

#[test]
fn a_saved_preset_is_found_loaded_and_listed() {
    let (_home, store) = store();
    assert!(store.list().presets.len() == SHIPPED.len() && store.list().notice.is_none());
    assert!(!store.folder().unwrap().exists(), "listing makes no folder");
    let (source, print) = store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
    assert_eq!(store.resolve("mine").unwrap(), source);
    let loaded = store.load(&source, NONE).unwrap();
    assert_eq!((&loaded.preset, loaded.fingerprint), (&wavy(), Some(print)));
    let rings = store.load(&source, &["basis.rings=50"]).unwrap().preset;
    assert_eq!(rings, with_rings(50));
    let listing = store.list();
    let last = listing.presets.last().unwrap();
    assert_eq!((last.name.as_str(), last.title.as_deref()), ("mine", Ok(&*wavy().title)));
    assert_eq!(store.folder().unwrap().metadata().unwrap().permissions().mode() & 0o777, 0o700);
}

#[test]
fn the_folder_is_below_xdg_config_home() {
    // All tests share the environment of this process, so another process does the check.
    let marker = "/nowhere/config";
    if std::env::var_os("XDG_CONFIG_HOME").is_some_and(|value| value == marker) {
        let folder = Store::open(COMMANDS).folder().map(Path::to_owned);
        assert_eq!(folder, Some(PathBuf::from("/nowhere/config/pulloff/presets")));
        return;
    }
    let child = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "store::presets::tests::the_folder_is_below_xdg_config_home"])
        .env("XDG_CONFIG_HOME", marker)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&child.stdout);
    assert!(child.status.success() && said.contains("1 passed"), "{said}");
}

#[test]
fn an_argument_is_a_name_or_a_path() {
    let (_home, store) = store();
    assert!(matches!(store.resolve("fig-9").unwrap(), Source::Shipped(s) if s.name == "fig-9"));
    for path in ["./fig-9", "fig-9.toml", "/dev/stdin", ".toml"] {
        assert_eq!(store.resolve(path).unwrap(), Source::File(PathBuf::from(path)));
    }
    let message = |argument: &str| store.resolve(argument).unwrap_err().to_string();
    assert_eq!(message("fig9"), "no preset is called \"fig9\"; did you mean fig-9?");
    assert_eq!(message("zzz"), "no preset is called \"zzz\"");
    assert_eq!(message("trase"), "no preset is called \"trase\"; did you mean the command trace?");
    assert!(message("trace").contains("is a command"));
    assert!(message("Fig-9\u{1b}").contains("is not a preset name"));
    assert!(message("").contains("is not a preset name"));
}

#[test]
fn names_that_are_taken_cannot_be_saved() {
    let (_home, store) = store();
    for name in ["fig-9", "trace", "../up", "a/b", "", "UP"] {
        let error = store.save(name, &wavy(), None, Overwrite::Always).unwrap_err();
        assert!(matches!(error, StoreError::Name(_)), "{error}");
    }
    assert!(!store.folder().unwrap().exists());
}

#[test]
fn only_ones_own_presets_are_deleted() {
    let (home, store) = store();
    let message = |name: &str| store.delete(name).unwrap_err().to_string();
    assert_eq!(message("mine"), "no preset is called \"mine\"");
    assert_eq!(message("fig-9"), "fig-9 comes with the program and cannot be deleted");
    store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
    store.save("other", &wavy(), None, Overwrite::Never).unwrap();
    let (outside, linked) = (home.path().join("outside.toml"), store.folder().unwrap().join("link.toml"));
    fs::write(&outside, "x").unwrap();
    symlink(&outside, &linked).unwrap();
    for path in [outside.to_str().unwrap(), "../outside", "./mine.toml", "mine.toml"] {
        assert!(matches!(store.delete(path), Err(StoreError::Name(_))), "{path}");
    }
    assert_eq!(store.delete("mine").unwrap(), store.path_of("mine").unwrap());
    store.delete("link").unwrap();
    assert!(outside.exists() && linked.symlink_metadata().is_err());
    assert_eq!(store.names().0, ["other"]);
    // While another saver holds the folder, nothing is deleted.
    let lock = FolderLock::acquire(store.folder().unwrap(), PATIENCE).unwrap();
    let waiting = std::thread::spawn({
        let store = store.clone();
        move || store.delete("other").map(drop)
    });
    assert!(lock.is_some() && store.names().0 == ["other"]);
    drop(lock);
    waiting.join().unwrap().unwrap();
    assert!(store.names().0.is_empty());
}

#[test]
fn an_invalid_preset_is_not_saved() {
    let (_home, store) = store();
    let error = store.save("mine", &with_rings(2), None, Overwrite::Always).unwrap_err();
    assert!(matches!(error, StoreError::Invalid(_)), "{error}");
}

#[test]
fn a_save_keeps_what_a_person_wrote_around_the_values() {
    let (home, store) = store();
    let mine = "# notes\n[gap] # first\nshape = 'wavy-sphere'\namplitude = 0.0025   # A\nwavelength = 0.05\n\
                radius_of_curvature = 1\n\n[material]\nwork_of_adhesion = 4e-3\neffective_modulus = 1 # E*\n";
    let path = home.path().join("mine.toml");
    fs::write(&path, mine).unwrap();
    let file = store.resolve(&path).unwrap();
    let loaded = store.load(&file, &["gap.amplitude=0.003"]).unwrap();
    // The comment stays in its column.
    let changed = mine.replace("0.0025 ", "0.003  ");
    let text = |source: &Source| fs::read_to_string(source.path().unwrap()).unwrap();
    // Back to the file, then under a name, and from there again.
    let known = Overwrite::IfUnchanged(loaded.fingerprint.unwrap());
    save_file(&path, &loaded.preset, Some(&file), known).unwrap();
    assert_eq!(text(&file), changed);
    let (named, print) = store.save("mine", &loaded.preset, Some(&file), Overwrite::Never).unwrap();
    assert_eq!(text(&named), changed);
    let mut turned = loaded.preset.clone();
    turned.assign("material.effective_modulus", "2").unwrap();
    store.save("mine", &turned, Some(&named), Overwrite::IfUnchanged(print)).unwrap();
    assert_eq!(text(&named), changed.replace("= 1 # E*", "= 2.0 # E*"));
    // Over another preset, the text is that of the saved one; a text through a pipe is the user's too.
    let piped = Source::Piped { name: "standard input".to_owned(), text: mine.into() };
    store.save("mine", &loaded.preset, Some(&piped), Overwrite::Always).unwrap();
    assert_eq!(text(&named), changed);
    // A shipped preset, one without a source, and one whose file is gone are written afresh.
    let shipped = store.resolve("wavy-sphere").unwrap();
    let gone = Source::File(home.path().join("gone.toml"));
    for from in [Some(&shipped), Some(&gone), None] {
        store.save("mine", &loaded.preset, from, Overwrite::Always).unwrap();
        assert_eq!(text(&named), write(&loaded.preset));
    }
}

#[test]
fn the_name_of_a_profile_follows_the_preset_and_its_comment_stays() {
    let (home, store) = store();
    let rows = (0..100).map(f64::from).map(|r| format!("{r} {}\n", r * r / 2000.0)).collect::<Vec<_>>();
    fs::write(home.path().join("scan.dat"), rows.concat()).unwrap();
    let text = "[material]\neffective_modulus = 1\nwork_of_adhesion = 0.003\n[gap]\nshape = \"profile\"\n\
                file = \"scan.dat\" # of May\n[path]\nstart_contact_radius = 50\n";
    let path = home.path().join("p.toml");
    fs::write(&path, text).unwrap();
    let file = store.resolve(&path).unwrap();
    let loaded = store.load(&file, NONE).unwrap();
    save_file(&path, &loaded.preset, Some(&file), Overwrite::Always).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), text);
    let (named, _) = store.save("mine", &loaded.preset, Some(&file), Overwrite::Never).unwrap();
    let saved = fs::read_to_string(named.path().unwrap()).unwrap();
    assert!(saved.contains("scan.dat\" # of May") && !saved.contains("\"scan.dat\""), "{saved}");
    let radius = |preset: &Preset| preset.gap.radius_of_curvature().unwrap().to_bits();
    assert_eq!(radius(&store.load(&named, NONE).unwrap().preset), radius(&loaded.preset));
}

#[test]
fn what_changed_on_disk_is_not_overwritten() {
    let (_home, store) = store();
    let (source, first) = store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
    let taken = store.save("mine", &wavy(), None, Overwrite::Never).unwrap_err();
    assert!(matches!(taken, StoreError::Write(WriteError::Exists { .. })), "{taken}");
    let (_, second) = store.save("mine", &with_rings(10), None, Overwrite::IfUnchanged(first)).unwrap();
    // Another editor changes the file.
    let path = source.path().unwrap();
    fs::write(path, write(&with_rings(20))).unwrap();
    let error = store.save("mine", &with_rings(30), None, Overwrite::IfUnchanged(second)).unwrap_err();
    assert!(matches!(error, StoreError::Write(WriteError::Changed { .. })), "{error}");
    assert_eq!(store.load(&source, NONE).unwrap().preset, with_rings(20));
    store.save("mine", &with_rings(30), None, Overwrite::Always).unwrap();
    assert_eq!(store.load(&source, NONE).unwrap().preset, with_rings(30));
}

#[test]
fn unreadable_presets_are_listed_with_the_reason_and_left_alone() {
    let (_home, store) = store();
    store.save("good", &wavy(), None, Overwrite::Never).unwrap();
    let at = |name: &str| store.folder().unwrap().join(name);
    fs::write(at("bad.toml"), "rings = ").unwrap();
    fs::write(at("Odd Name.toml"), write(&wavy())).unwrap();
    fs::write(at("fig-9.toml"), write(&wavy())).unwrap();
    fs::write(at(".hidden.toml"), "").unwrap();
    fs::write(at("notes.txt"), "").unwrap();
    mknodat(CWD, at("pipe.toml"), FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
    symlink("nowhere", at("dangling.toml")).unwrap();
    let listing = store.list();
    let reason = |name: &str| {
        let row = listing.presets[SHIPPED.len()..].iter().find(|row| row.name.ends_with(name));
        row.unwrap_or_else(|| panic!("{name}")).title.clone().unwrap_err()
    };
    assert_eq!(listing.presets.len(), SHIPPED.len() + 6);
    assert!(reason("bad").contains("bad.toml:1:"), "{}", reason("bad"));
    assert!(reason("Odd Name.toml").contains("is not a preset name"));
    assert!(reason("fig-9.toml").contains("comes with the program"));
    assert!(reason("pipe").contains("is a pipe"));
    assert!(reason("dangling").contains("No such file"));
    assert!(store.load(&store.resolve("bad").unwrap(), NONE).is_err());
    assert_eq!(fs::read_to_string(at("bad.toml")).unwrap(), "rings = ");
    let error = store.save("bad", &wavy(), None, Overwrite::Never).unwrap_err();
    assert!(matches!(error, StoreError::Write(WriteError::Exists { .. })), "{error}");
}

#[test]
fn messages_name_the_file_and_the_line() {
    let (home, store) = store();
    let path = home.path().join("w.toml");
    fs::write(&path, write(&wavy()).replace("rings = 200", "rings = 2")).unwrap();
    let error = store.load(&store.resolve(&path).unwrap(), NONE).unwrap_err().to_string();
    assert!(error.contains("w.toml:17: basis.rings = 2 is out of range"), "{error}");
    fs::write(&path, vec![b'#'; 1 << 20 | 1]).unwrap();
    let error = store.load(&Source::File(path), NONE).unwrap_err().to_string();
    assert!(error.contains("has 1048577 bytes, more than the 1048576"), "{error}");
}

#[test]
fn without_a_home_there_are_the_shipped_presets_and_a_notice() {
    let store = Store { folder: None, commands: Vec::new() };
    assert!(store.list().notice.is_some() && store.resolve("fig-8").is_ok());
    assert!(matches!(store.save("mine", &wavy(), None, Overwrite::Never), Err(StoreError::NoFolder)));
    assert!(matches!(store.resolve("mine"), Err(StoreError::NotFound { .. })));
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("file"), "").unwrap();
    let store = Store::at(home.path().join("file/presets"), COMMANDS);
    let error = store.save("mine", &wavy(), None, Overwrite::Never).unwrap_err();
    assert!(matches!(error, StoreError::Folder { .. }), "{error}");
    assert!(store.list().notice.is_some());
}

#[test]
fn savers_at_the_same_time_lose_nothing() {
    let (_home, store) = store();
    let (source, first) = store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
    let savers: Vec<_> = (0..8)
        .map(|i| {
            let store = store.clone();
            std::thread::spawn(move || {
                store.save("mine", &with_rings(10 + i), None, Overwrite::IfUnchanged(first))
            })
        })
        .collect();
    let results: Vec<_> = savers.into_iter().map(|saver| saver.join().unwrap()).collect();
    let winners: Vec<_> = (0..8).filter(|i| results[*i].is_ok()).collect();
    assert_eq!(winners.len(), 1, "all loaded the same file, so one save only may replace it");
    for result in results.iter().filter_map(|result| result.as_ref().err()) {
        assert!(matches!(result, StoreError::Write(WriteError::Changed { .. })), "{result}");
    }
    assert_eq!(store.load(&source, NONE).unwrap().preset, with_rings(10 + winners[0]));
    assert_eq!(fs::read_dir(store.folder().unwrap()).unwrap().count(), 1);
}

#[test]
fn a_folder_in_use_is_waited_for() {
    let (_home, store) = store();
    store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
    let held = FolderLock::acquire(store.folder().unwrap(), PATIENCE).unwrap();
    let other = store.clone();
    let saver = std::thread::spawn(move || other.save("mine", &with_rings(9), None, Overwrite::Always));
    drop(held);
    assert!(saver.join().unwrap().is_ok());
}
