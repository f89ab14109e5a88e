//! Command lines with outputs that nobody should name: links, folders, devices, pipes, the same file twice.
//!
//! `cargo test --test program hostile_outputs::` runs a tenth of them. To run all, or some by number:
//!
//! ```text
//! cargo test --test program hostile_outputs:: -- --ignored --nocapture
//! PULLOFF_HOSTILE=17..18 cargo test --test program hostile_outputs:: -- --ignored --nocapture
//! ```
//!
//! Whatever is named: no panic, no program that must be killed, no success without its output, nothing left behind, and
//! no byte lost from a file that is read or that `--overwrite` does not release.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use rustix::fs::{CWD, FileType, Mode, mknodat};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, Permissions};
use std::io::Read;
use std::ops::Range;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::{Child, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// The number of command lines.
const ALL: u64 = 150;
/// Anything slower hangs: this is a hundred times the slowest run.
const PATIENCE: Duration = Duration::from_secs(120);

const SPEC: &str = "preset = \"fig-3-jkr\"\nquantities = [\"critical_force\"]\n[[axis]]\nkey = \"material.work_of_adhesion\"\n\
    values = [0.01, 0.02]\n";
const LENS: &str = include_str!("../../presets/data/lens.csv");
/// Existing content that no command may replace.
const MINE: &str = "mine\n";

/// Commands with `@` where an output is named, and `%` where a second one may follow.
const COMMANDS: [&str; 13] = [
    "trace p.toml -o @",
    "trace - -o @",
    "unload p.toml -o @",
    "map p.toml --x-key groups.adhesion=log:0.005..0.2 --y approach -o @",
    "fit points.csv lens --free E* --no-scan -o @ --residuals %",
    "fit points.csv lens --free E* --no-scan --table @ --residuals %",
    "plot p.toml -o @",
    "plot p.toml --data -o @",
    "plot --sweep r.csv --quantity critical_force -o @",
    "sweep s.toml -o @ --status %",
    "sweep merge 1.csv 2.csv -o @",
    "run w.pulloff --preset p.toml @",
    "verify --only uniform -o @",
];

/// Names of outputs; `home` creates what they lead to.
const NAMES: [&str; 36] = [
    "new.csv",
    "new.json",
    "new.txt",
    "new",
    "new.svg",
    "new.png",
    "new.toml",
    "new.xlsx",
    "NEW.CSV",
    "old.csv",
    "old.json",
    "old.svg",
    "to-old.csv",
    "to-new.csv",
    "to-preset.csv",
    "hard-preset.csv",
    "to-spec.json",
    "to-points.csv",
    "hard-points.csv",
    "to-part.csv",
    "hard-results.csv",
    "circle.csv",
    "folder",
    "folder.csv/",
    "new/",
    "missing/x.csv",
    "marked.csv",
    "pipe",
    "pipe.csv",
    "socket.csv",
    "/dev/full",
    "/dev/null",
    "/dev/stdout",
    "-",
    "",
    "s.toml/x.csv",
];

/// What may follow a command.
const MORE: [&str; 10] = [
    "",
    "",
    "--overwrite",
    "--overwrite",
    "--overwrite",
    "--quiet",
    "--strict",
    "--format json",
    "--format csv --overwrite",
    "--format table",
];

struct Random(fastrand::Rng);

impl Random {
    fn of<T: Copy>(&mut self, these: &[T]) -> T {
        these[self.0.usize(..these.len())]
    }
}

/// A name that is not in [`NAMES`].
fn odd(random: &mut Random) -> OsString {
    match random.0.usize(..6) {
        0 => OsString::from_vec(b"not-\xff-utf8.csv".to_vec()),
        1 => format!("{}.csv", "long".repeat(80)).into(),
        2 => "two\nlines \u{1b}[31m.csv".into(),
        3 => "..".into(),
        4 => ".".into(),
        _ => "/proc/self/nothing.csv".into(),
    }
}

/// A command line, by its number.
fn drawn(number: u64) -> Vec<OsString> {
    let random =
        &mut Random(fastrand::Rng::with_seed(0x006F_7574 ^ number.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
    let command = COMMANDS[usize::try_from(number).unwrap() % COMMANDS.len()];
    let name = |random: &mut Random| {
        if random.0.usize(..9) == 0 { odd(random) } else { OsString::from(random.of(&NAMES)) }
    };
    let first = name(random);
    // Often the same name again.
    let second = if random.0.bool() { first.clone() } else { name(random) };
    let more = random.of(&MORE);
    let words = command.split(' ').chain(more.split(' ')).filter(|word| !word.is_empty());
    words
        .map(|word| match word {
            "@" => first.clone(),
            "%" => second.clone(),
            word => word.into(),
        })
        .collect()
}

/// A home with inputs, and with everything that a name may lead to.
fn home() -> Home {
    let home = Home::new();
    let path = |name: &str| home.path(name);
    let preset = home.run(&["presets", "show", "fig-3-jkr"]).out;
    home.file("p.toml", &preset);
    home.file("s.toml", SPEC);
    home.file("points.csv", LENS);
    for line in ["1.csv --shard 1/2", "2.csv --shard 2/2", "r.csv"] {
        let line = format!("sweep s.toml --jobs 1 --quiet -o {line}");
        home.quiet(&line.split(' ').collect::<Vec<_>>());
    }
    for name in ["old.csv", "old.json", "old.svg", "marked.csv"] {
        home.file(name, MINE);
    }
    fs::set_permissions(path("marked.csv"), Permissions::from_mode(0o444)).unwrap();
    for (to, name) in [
        ("old.csv", "to-old.csv"),
        ("later.csv", "to-new.csv"),
        ("p.toml", "to-preset.csv"),
        ("s.toml", "to-spec.json"),
        ("points.csv", "to-points.csv"),
        ("1.csv", "to-part.csv"),
        ("circle.csv", "circle.csv"),
    ] {
        symlink(to, path(name)).unwrap();
    }
    for (to, name) in
        [("p.toml", "hard-preset.csv"), ("points.csv", "hard-points.csv"), ("r.csv", "hard-results.csv")]
    {
        fs::hard_link(path(to), path(name)).unwrap();
    }
    fs::create_dir(path("folder")).unwrap();
    fs::create_dir(path("folder.csv")).unwrap();
    for (name, kind) in
        [("pipe", FileType::Fifo), ("pipe.csv", FileType::Fifo), ("socket.csv", FileType::Socket)]
    {
        mknodat(CWD, path(name), kind, Mode::from_raw_mode(0o600), 0).unwrap();
    }
    home
}

/// The regular files of the home by name, with their bytes; links with their targets.
fn files(home: &Home) -> BTreeMap<OsString, Vec<u8>> {
    let entries = fs::read_dir(home.folder()).unwrap().map(Result::unwrap);
    entries
        .filter_map(|entry| {
            let kind = entry.file_type().unwrap();
            let bytes = if kind.is_symlink() {
                fs::read_link(entry.path()).unwrap().into_os_string().into_vec()
            } else {
                kind.is_file().then(|| fs::read(entry.path()).unwrap())?
            };
            Some((entry.file_name(), bytes))
        })
        .collect()
}

/// The exit status; `None` if the process had to be killed.
fn ended(child: &mut Child) -> Option<i32> {
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status.code().unwrap_or(-1));
        }
        thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    None
}

/// Reads a whole stream in a thread of its own.
fn read(stream: impl Read + Send + 'static) -> thread::JoinHandle<Vec<u8>> {
    let mut stream = stream;
    thread::spawn(move || {
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        bytes
    })
}

/// Judges how a command line ends.
fn judge(number: u64) -> Result<i32, String> {
    let mut arguments = drawn(number);
    let home = home();
    if arguments[0] == "run" {
        // The output name is written into the script.
        let name = arguments.remove(4);
        let replace =
            if arguments.iter().any(|argument| argument == "--overwrite") { " replace" } else { "" };
        home.file("w.pulloff", &format!("export curve \"{}\"{replace}\n", name.to_string_lossy()));
    }
    let before = files(&home);
    let mut command = home.command(&[]);
    command.args(&arguments).stdin(fs::File::open(home.path("p.toml")).unwrap());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // The test holds both ends of each pipe open, so that no command waits.
    let ends: Vec<_> = ["pipe", "pipe.csv"]
        .map(|name| fs::File::options().read(true).write(true).open(home.path(name)).unwrap())
        .into_iter()
        .collect();
    let mut drains = Vec::new();
    for end in &ends {
        let mut end = end.try_clone().unwrap();
        drains.push(thread::spawn(move || {
            let mut bytes = [0; 4096];
            while end.read(&mut bytes).is_ok_and(|count| bytes[..count].last() != Some(&0)) {}
        }));
    }
    let (out, err) = (read(child.stdout.take().unwrap()), read(child.stderr.take().unwrap()));
    let status = ended(&mut child);
    for end in &ends {
        // A final byte ends the reader.
        std::io::Write::write_all(&mut &*end, &[0]).unwrap();
    }
    for drain in drains {
        drain.join().unwrap();
    }
    let (out, err) = (out.join().unwrap(), String::from_utf8_lossy(&err.join().unwrap()).into_owned());
    let after = files(&home);
    let line = format!("{number}: {arguments:?}: {status:?}\n{err}");
    let wrong = |what: &str| Err(format!("{what}: {line}"));
    let Some(status) = status else { return wrong("it hangs") };
    if !(0..=4).contains(&status) || err.contains("panicked") {
        return wrong("no proper end");
    }
    if status == 2 && err.is_empty() {
        return wrong("refused without a word");
    }
    if err.contains('\x1b') {
        return wrong("a name was shown as it is");
    }
    if after.keys().any(|name| name.to_string_lossy().starts_with(".pulloff-")) {
        return wrong("a temporary is left");
    }
    let overwrite = arguments.iter().any(|argument| argument == "--overwrite");
    let command = COMMANDS[usize::try_from(number).unwrap() % COMMANDS.len()];
    // Standard input is the preset.
    let reads = |name: &str| {
        command.split(' ').any(|word| word == name || word == "-" && name == "p.toml")
            || command.contains("s.toml") && name == "p.toml"
    };
    for (name, bytes) in &before {
        let name = name.to_string_lossy();
        // What the command reads, the file beside it, and other names of both must not change; links stay links.
        let own = match name.strip_suffix(".spec.toml").unwrap_or(&name) {
            "hard-preset.csv" => "p.toml",
            "hard-points.csv" => "points.csv",
            "hard-results.csv" => "r.csv",
            own => own,
        };
        let may_change = overwrite && !reads(own) && !name.starts_with("to-") && name != "marked.csv";
        match after.get(&OsString::from(&*name)) {
            None => return wrong(&format!("{name} is gone")),
            Some(now) if now != bytes && !may_change => return wrong(&format!("{name} was changed")),
            Some(now) if now.is_empty() && !bytes.is_empty() => return wrong(&format!("{name} was emptied")),
            Some(_) => {}
        }
    }
    // A success leaves its output in a new or changed file, in a pipe or device, or on standard output.
    let has_gone_elsewhere = arguments.iter().any(|argument| {
        let name = argument.to_string_lossy();
        name.starts_with("/dev/") || name.starts_with("pipe")
    });
    if status == 0 && out.is_empty() && before == after && !has_gone_elsewhere {
        return wrong("a success without an output");
    }
    let full = arguments.iter().any(|argument| argument == "/dev/full");
    if status == 0 && full {
        return wrong("a full disk is a success");
    }
    Ok(status)
}

fn run(numbers: impl Iterator<Item = u64>) {
    let statuses = crate::support::hostile::run(numbers, judge);
    assert!(statuses.contains_key(&0) && statuses.contains_key(&2), "{statuses:?}");
}

#[test]
fn a_tenth_of_the_hostile_command_lines_end_as_they_should() {
    run((0..ALL).step_by(10));
}

#[test]
#[ignore = "takes a minute"]
fn all_hostile_command_lines_end_as_they_should() {
    let asked = std::env::var("PULLOFF_HOSTILE").ok().map(|text| {
        let (from, to) = text.split_once("..").unwrap();
        Range { start: from.parse().unwrap(), end: to.parse().unwrap() }
    });
    run(asked.unwrap_or(0..ALL));
}
