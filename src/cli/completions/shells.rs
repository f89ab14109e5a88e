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
const BASH: &str = r#"_BIN_complete() {
    local IFS=$' \t\n' line=${COMP_LINE:0:COMP_POINT} rest word text reply at
    local -a words=() replies=()
    rest=$line
    for ((at = 0; at <= COMP_CWORD; at++)); do
        word=${COMP_WORDS[at]}
        text=${rest#"${rest%%[![:space:]]*}"}
        # The last word goes to the cursor.
        ((at < COMP_CWORD)) || word=$text
        if ((at > 0)) && [[ $text == "$rest" && -n $text ]]; then
            words[${#words[@]} - 1]+=$word
        else
            words+=("$word")
        fi
        rest=${text#"$word"}
    done
    word=${words[${#words[@]} - 1]}
    # Readline replaces no more than its own last part.
    local kept=${word%"$2"}
    [[ -n $2 || $word == *[=:] ]] || kept=
    IFS=$'\v'
    replies=($(_CLAP_IFS=$'\v' _CLAP_COMPLETE_INDEX=$((${#words[@]} - 1)) VAR=bash COMPLETER -- "${words[@]}" 2>/dev/null)) || return
    IFS=$' \t\n'
    COMPREPLY=()
    for reply in "${replies[@]}"; do
        reply=${reply#"$kept"}
        case $reply in
            *[[:space:]\'\"\\\$\&\;\|\<\>\(\)\*\?\[\`\!]*) printf -v reply %q "$reply" ;;
        esac
        COMPREPLY+=("$reply")
    done
    # What ends so goes on.
    if ((${#COMPREPLY[@]} == 1)) && [[ ${COMPREPLY[0]} == *[=/:,] ]]; then
        compopt -o nospace 2>/dev/null
    fi
}
complete -o bashdefault -F _BIN_complete BIN
"#;

/// The text may be run by `source`, or be an autoloaded function file that zsh reads at the first Tab.
const ZSH: &str = r#"#compdef BIN
_BIN_complete() {
    local -a replies folders open whole
    local reply value
    replies=("${(@f)$(_CLAP_IFS=$'\n' _CLAP_COMPLETE_INDEX=$((CURRENT - 1)) VAR=zsh COMPLETER -- "${words[@]:0:$CURRENT}" 2>/dev/null)}")
    for reply in $replies; do
        # Its own colons are escaped, the one before the explanation is not.
        value=${reply%%[^\\]:*}
        [[ $value == $reply ]] || value=$value${${reply#$value}[1]}
        case $value in
            */) folders+=("${value%/}${reply#$value}") ;;
            *[=,]) open+=("$reply") ;;
            *) whole+=("$reply") ;;
        esac
    done
    [[ -z $folders ]] || _describe -V values folders -S / -r /
    [[ -z $open ]] || _describe -V values open -S ''
    [[ -z $whole ]] || _describe -V values whole
}
if [[ ${funcstack[1]} == _BIN ]]; then
    _BIN_complete "$@"
else
    compdef _BIN_complete BIN
fi
"#;

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
