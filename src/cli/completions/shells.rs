//! What bash and zsh run at a Tab; the other shells run what `clap_complete` provides.

use clap::Command;
use clap_complete::env::{Bash, Elvish, EnvCompleter, Fish, Powershell, Zsh};
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::Path;

/// The known shells.
pub(super) const ALL: &[&dyn EnvCompleter] = &[
    &Scripted { answers: &Bash, script: BASH },
    &Elvish,
    &Fish,
    &Powershell,
    &Scripted { answers: &Zsh, script: ZSH },
];

/// A shell that is answered in the usual way but asks through a script of ours.
struct Scripted {
    answers: &'static dyn EnvCompleter,
    script: &'static str,
}

/// Bash splits words at `=` and `:`, which belong to words such as `gap.shape=sphere`. The script joins them again
/// before it asks the program, and removes from the answers what is already on the line.
const BASH: &str = include_str!("complete.bash");

/// The text may be run by `source`, or be an autoloaded function file that zsh reads at the first Tab.
const ZSH: &str = include_str!("complete.zsh");

impl EnvCompleter for Scripted {
    fn name(&self) -> &'static str {
        self.answers.name()
    }

    fn is(&self, name: &str) -> bool {
        self.answers.is(name)
    }

    fn write_registration(
        &self,
        var: &str,
        _name: &str,
        bin: &str,
        completer: &str,
        buf: &mut dyn Write,
    ) -> io::Result<()> {
        let script = self.script.replace("COMPLETER", completer).replace("VAR", var).replace("BIN", bin);
        buf.write_all(script.as_bytes())
    }

    fn write_complete(
        &self,
        cmd: &mut Command,
        args: Vec<OsString>,
        current_dir: Option<&Path>,
        buf: &mut dyn Write,
    ) -> io::Result<()> {
        self.answers.write_complete(cmd, args, current_dir, buf)
    }
}
