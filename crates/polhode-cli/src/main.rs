//! The command `polhode`.

use std::process::ExitCode;

fn main() -> ExitCode {
    polhode_cli::command()
}
