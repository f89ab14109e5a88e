//! Command lines with values that nobody should type: numbers beyond all bounds, units of other quantities, inverted
//! ranges, names with control characters, text that is not valid text.
//!
//! `cargo test --test program hostile_values::` runs a tenth of them. To run all, or some by number:
//!
//! ```text
//! cargo test --test program hostile_values:: -- --ignored --nocapture
//! PULLOFF_HOSTILE=17..18 cargo test --test program hostile_values:: -- --ignored --nocapture
//! ```
//!
//! Whatever is typed: no panic, no program that must be killed, no silent refusal, no success without a result, and no
//! control character from the command line in a message.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use std::ffi::OsString;
use std::ops::Range;
use std::os::unix::ffi::OsStringExt;
use std::time::Duration;

/// The number of command lines.
const ALL: u64 = 150;
/// Anything slower hangs.
const PATIENCE: Duration = Duration::from_secs(120);

/// Commands with `@` in place of a value, and `%` in place of an assignment.
const COMMANDS: [&str; 22] = [
    "trace cone --set %",
    "unload fig-3-jkr --set % --set %",
    "cycle exact-sphere --set %",
    "map fig-3-jkr --set % --x-key groups.adhesion=log:0.005..0.2 --y approach",
    "trace fig-3-jkr --control @",
    "unload fig-9-si --set basis.kind=exact --control @",
    "cycle exact-sphere --to-radius=@",
    "cycle exact-sphere --to-control=@",
    "map fig-3-jkr --x-key groups.adhesion=@..@ --y force",
    "map fig-3-jkr --x-key @=0..1 --y force",
    "fit shipped:lens.csv lens --free E* --no-scan --sigma-x=@",
    "fit shipped:lens.csv lens --free @ --no-scan",
    "fit shipped:lens.csv lens --free E* --no-scan --range x=@..@",
    "fit shipped:lens.csv lens --free E* --no-scan --columns @",
    "fit shipped:lens.csv lens --free E* --no-scan --poisson=@",
    "plot fig-3-jkr --view @ -o new.svg",
    "plot fig-3-jkr --view gap --contact-radius=@ -o new.svg",
    "plot fig-3-jkr --width=@ -o new.svg",
    "sweep s.toml -o new.csv --shard=@ --row-limit=@",
    "sweep s.toml -o new.csv --set %",
    "presets show @",
    "verify --only @",
];

const KEYS: [&str; 18] = [
    "gap.shape",
    "gap.radius_of_curvature",
    "gap.slope",
    "gap.formula",
    "gap.file",
    "material.effective_modulus",
    "material.work_of_adhesion",
    "material.range_of_action",
    "groups.adhesion",
    "path.control",
    "path.start_contact_radius",
    "path.start_approach",
    "path.end_contact_radius",
    "basis.kind",
    "units",
    "format",
    "data.columns",
    "gap.nothing",
];

const VALUES: [&str; 40] = [
    "0",
    "-0",
    "-1",
    "1",
    "0.3",
    "1e-320",
    "1e-30",
    "1e-9",
    "1e9",
    "1e30",
    "1e308",
    "1e999",
    "-1e999",
    "nan",
    "inf",
    "-inf",
    "infinity",
    "0x10",
    "1_000",
    "1,5",
    "1.2.3",
    "1e",
    "٣",
    "½",
    "5 um",
    "5 N",
    "5 furlongs",
    "5 N/m",
    "none",
    "auto",
    "force",
    "stiffness=0",
    "stiffness=1e-300",
    "1/0",
    "r^2/2",
    "((((((((((1",
    "sin(r)^1e9",
    "x=1,force=1",
    "3/2",
    "1e-40s",
];

struct Random(fastrand::Rng);

impl Random {
    fn of<T: Copy>(&mut self, these: &[T]) -> T {
        these[self.0.usize(..these.len())]
    }

    /// A value; now and then one that is in no list.
    fn value(&mut self) -> OsString {
        match self.0.usize(..24) {
            0 => OsString::from_vec(b"\xff\xfe".to_vec()),
            1 => "9".repeat(5000).into(),
            2 => "\u{1b}[2J\u{7}".into(),
            3 => "".into(),
            4 => "(".repeat(3000).into(),
            _ => self.of(&VALUES).into(),
        }
    }

    fn assignment(&mut self) -> OsString {
        let mut text = OsString::from(if self.0.usize(..12) == 0 { "" } else { self.of(&KEYS) });
        text.push(if self.0.usize(..12) == 0 { "" } else { "=" });
        text.push(self.value());
        text
    }
}

/// A command line, by its number.
fn drawn(number: u64) -> Vec<OsString> {
    let random =
        &mut Random(fastrand::Rng::with_seed(0x0076_616C ^ number.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
    let command = COMMANDS[usize::try_from(number).unwrap() % COMMANDS.len()];
    let mut word = |word: &str| {
        let mut made = OsString::new();
        for (at, part) in word.split('@').enumerate() {
            if at > 0 {
                made.push(random.value());
            }
            made.push(if part == "%" { random.assignment() } else { part.into() });
        }
        made
    };
    command.split(' ').map(&mut word).collect()
}

/// Judges how a command line ends.
fn judge(number: u64) -> Result<i32, String> {
    let arguments = drawn(number);
    let home = Home::new();
    let spec = "preset = \"fig-3-jkr\"\nquantities = [\"critical_force\"]\n[[axis]]\nkey = \"gap.radius_of_curvature\"\n\
                values = [1.0, 2.0]\n";
    home.file("s.toml", spec);
    let Some(ended) = home.within(&arguments, PATIENCE) else {
        return Err(format!("it hangs: {number}: {arguments:?}"));
    };
    let wrong = |what: &str| Err(format!("{what}: {number}: {arguments:?}: {}\n{}", ended.status, ended.err));
    if !(0..=4).contains(&ended.status) || ended.err.contains("panicked") {
        return wrong("no proper end");
    }
    if ended.status == 2 && ended.err.is_empty() {
        return wrong("refused without a word");
    }
    if ended.err.contains(['\x1b', '\x07']) {
        return wrong("a value was shown as it is");
    }
    if ended.err.len() > 20_000 {
        return wrong("a message that nobody reads");
    }
    let made = ["new.svg", "new.csv"].iter().any(|name| home.path(name).exists());
    if ended.status == 0 && ended.out.is_empty() && !made {
        return wrong("a success without a result");
    }
    Ok(ended.status)
}

fn run(numbers: impl Iterator<Item = u64>) {
    let statuses = crate::support::hostile::run(numbers, judge);
    assert!(statuses.contains_key(&2), "{statuses:?}");
}

#[test]
fn a_tenth_of_the_hostile_values_end_as_they_should() {
    run((3..ALL).step_by(10));
}

#[test]
#[ignore = "takes minutes"]
fn all_hostile_values_end_as_they_should() {
    let asked = std::env::var("PULLOFF_HOSTILE").ok().map(|text| {
        let (from, to) = text.split_once("..").unwrap();
        Range { start: from.parse().unwrap(), end: to.parse().unwrap() }
    });
    run(asked.unwrap_or(0..ALL));
}
