//! What `-h` shows of each command: what a first use needs, on one screen. `--help` shows everything.

use clap::{ArgAction, Command};

/// By command, the flags of its short help; places without a name are always shown.
const SHOWN: [(&str, &[&str]); 12] = [
    ("show", &["moments", "body", "omega", "until", "against", "out"]),
    ("propagate", &["moments", "body", "omega", "until", "every", "times", "method", "step", "out"]),
    ("motion", &["moments", "body", "omega", "periods", "mode", "pole", "out"]),
    ("audit", &["moments", "body", "columns", "tolerance", "noise", "report"]),
    ("compare", &["moments", "body", "omega", "until", "methods", "steps", "figure"]),
    ("advise", &["moments", "body", "omega", "until", "attitude_error", "exclude", "check"]),
    ("fit", &["columns", "axes", "torque", "prior_inertia", "report", "out"]),
    ("attitude", &["columns", "kind", "start", "order", "samples", "noise", "against", "out"]),
    ("simulate", &["moments", "body", "omega", "until", "every", "noise", "out"]),
    ("inertia", &["mass", "density", "length_unit", "repair", "format", "out"]),
    ("ensemble", &["out", "shard"]),
    ("plot", &["moments", "body", "omega", "until", "out"]),
];

/// Examples of a short help.
const EXAMPLES: usize = 2;

/// `command` with the other flags left to `--help`.
pub(crate) fn shortened(command: Command) -> Command {
    SHOWN.into_iter().fold(command, |command, (name, shown)| {
        if command.find_subcommand(name).is_none() {
            return command;
        }
        command.mut_subcommand(name, |command| {
            let examples = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let command = command.after_help(first(&examples)).after_long_help(examples);
            command.mut_args(|flag| {
                let is_help =
                    matches!(flag.get_action(), ArgAction::Help | ArgAction::HelpShort | ArgAction::HelpLong);
                let is_shown = flag.is_positional() || is_help || shown.contains(&flag.get_id().as_str());
                flag.hide_short_help(!is_shown)
            })
        })
    })
}

/// The head and the first of the examples, each a line that begins with the name of the program, and what continues it.
fn first(examples: &str) -> String {
    let mut count = 0;
    let within = |line: &&str| {
        count += usize::from(line.trim_start().starts_with("polhode "));
        count <= EXAMPLES
    };
    examples.lines().take_while(within).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    /// Lines of a terminal.
    const SCREEN: usize = 50;

    #[test]
    fn every_short_help_fits_a_screen() {
        let mut command = shortened(crate::CommandLine::command());
        command.build();
        for short in command.get_subcommands_mut() {
            let text = short.render_help().to_string();
            assert!(text.lines().count() <= SCREEN, "{}:\n{text}", short.get_name());
        }
    }

    #[test]
    fn what_a_short_help_shows_are_flags_of_its_command() {
        let mut command = crate::CommandLine::command();
        command.build();
        for (name, shown) in SHOWN {
            let known = command.find_subcommand(name).map(|command| {
                command.get_arguments().map(|flag| flag.get_id().to_string()).collect::<Vec<_>>()
            });
            let known = known.unwrap_or_default();
            let unknown: Vec<_> = shown.iter().filter(|id| !known.contains(&(**id).to_owned())).collect();
            assert!(unknown.is_empty(), "{name}: {unknown:?} of {known:?}");
        }
    }
}
