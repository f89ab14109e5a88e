//! The program: everything it does is in the library's [`pulloff::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    pulloff::cli::run()
}
