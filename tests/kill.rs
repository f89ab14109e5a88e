//! Killed at any moment of a save, the program leaves the complete old or the complete new preset.

mod support;

use std::{
    fs,
    path::Path,
    time::{Duration, Instant},
};

use pulloff::store::{Overwrite, Source, Store, read, shipped};
use pulloff_engine::preset::{Preset, write};
use rustix::process::Signal;
use support::pty::{LIMIT, Pty};

/// The number of times that the program is killed, unless `PULLOFF_KILLS` says otherwise.
const KILLS: usize = 100;
/// The longest time from the first save of a round to its kill: a dozen saves.
const WINDOW: Duration = Duration::from_millis(60);

/// The only preset in the folder, which must be complete: reading and writing it again gives the same bytes.
fn whole(path: &Path) -> Preset {
    let text = fs::read_to_string(path).expect("a preset");
    let preset =
        read("mine", &text).map_err(|error| format!("torn: {error}\n{text}")).expect("a whole preset");
    assert_eq!(write(&preset), text, "not as it was written");
    preset
}

fn leftovers(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).expect("a folder").map(|e| e.expect("a file").file_name());
    names.map(|name| name.to_string_lossy().into_owned()).filter(|name| name != "mine.toml").collect()
}

#[test]
#[ignore = "takes half a minute; .ci/run runs it"]
fn a_kill_at_any_moment_leaves_a_whole_preset() {
    let kills = std::env::var("PULLOFF_KILLS").map_or(KILLS, |text| text.parse().expect("a number of kills"));
    let home = tempfile::tempdir().expect("a home");
    let store = Store::at(home.path().join("pulloff/presets"), &[]);
    let preset = read("wavy-sphere", shipped::find("wavy-sphere").expect("shipped").text).expect("shipped");
    let (source, _) = store.save("mine", &preset, None, Overwrite::Never).expect("a preset");
    let Source::User { path, .. } = source else { panic!("not saved by name") };
    let folder = path.parent().expect("a folder");
    let env = [("XDG_CONFIG_HOME", home.path().to_str().expect("Unicode"))];
    let mut random = fastrand::Rng::with_seed(7);
    let (mut between, mut swept) = (0, 0);
    for kill in 0..kills {
        let before = fs::read(&path).expect("a preset");
        let mut pty = Pty::spawn(Path::new(env!("CARGO_BIN_EXE_pulloff")), &["mine"], &env, 80, 24);
        pty.wait_for(|screen| screen.contains("mine"), "the first frame");
        // One value up and down, saved each time, so that a save is always under way.
        let keys = if kill % 2 == 0 { "}s{s" } else { "{s}s" };
        pty.keys(&keys.repeat(50));
        let start = Instant::now();
        while fs::read(&path).is_ok_and(|now| now == before) {
            assert!(start.elapsed() < LIMIT, "nothing is saved; the screen is:\n{}", pty.screen());
        }
        std::thread::sleep(WINDOW.mul_f64(random.f64()));
        pty.signal(Signal::KILL);
        pty.exit_code();
        let now = whole(&path);
        assert_eq!((&now.title, &now.basis), (&preset.title, &preset.basis), "another preset");
        // Leftovers are never taken for presets, and the saves of the next round remove them.
        let left = leftovers(folder);
        assert!(left.len() <= 1, "{left:?}");
        let own =
            store.list().presets.iter().filter(|listed| matches!(listed.source, Source::User { .. })).count();
        assert_eq!(own, 1, "{left:?}");
        between += usize::from(!left.is_empty());
        swept += usize::from(!left.is_empty() && kill + 1 < kills);
    }
    store.save("mine", &preset, None, Overwrite::Always).expect("a preset");
    assert_eq!(leftovers(folder), [] as [&str; 0]);
    assert_eq!(whole(&path), preset);
    println!(
        "{kills} kills, {between} of them in the middle of a save; {swept} leftovers removed by the next round"
    );
}
