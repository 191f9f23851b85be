//! Help texts: commands in groups, two examples per command, expert options in a separate section.

use clap::builder::StyledStr;
use std::fmt::Write;

/// A group of the overview: its title, and each command with its examples.
type Group = (&'static str, &'static [(&'static str, [&'static str; 2])]);

const GROUPS: [Group; 5] = [
    (
        "Start",
        &[
            ("new", ["new my-study", "new my-layer --scene cosine-layer"]),
            ("list", ["list", "list --show terzaghi-mesh"]),
            ("exact", ["exact terzaghi --time-factor 0.1", "exact xie-leo --degree 0.5,0.9"]),
            (
                "solve",
                [
                    "solve terzaghi --integrator implicit --cells 20",
                    "solve xie-leo --method GC-SRI-patch --set column.load=5e4",
                ],
            ),
        ],
    ),
    (
        "Studies",
        &[
            ("plan", ["plan my-study.toml", "plan my-study.toml --missing out"]),
            ("run", ["run my-study.toml", "run my-study.toml --shard 1/4 --out out-1"]),
            ("check", ["check my-study.toml", "check --junit results.xml"]),
            ("report", ["report", "report my-study.toml --out pages"]),
            (
                "accept",
                ["accept my-study.toml --reason \"First results\"", "accept race --reason \"Add a method\""],
            ),
            ("explain", ["explain 3f2a my-study.toml", "explain \"GC-SRI-patch cells=20\" terzaghi-mesh"]),
        ],
    ),
    (
        "Your own solver",
        &[
            ("new-solver", ["new-solver mine", "new-solver mine --language shell"]),
            (
                "score",
                [
                    "score result.vtu --preset ogs --scene terzaghi",
                    "score a.csv b.csv --cells 10,20 --scene terzaghi --below 5e-3",
                ],
            ),
            (
                "stability",
                ["stability terzaghi --cells 8,16", "stability terzaghi --method MPM,GC-SRI-patch"],
            ),
        ],
    ),
    (
        "Over time",
        &[
            (
                "compare",
                ["compare HEAD~1 HEAD", "compare --commands './a {case} {out}' './b {case} {out}' gate.toml"],
            ),
            ("history", ["history", "history terzaghi-mesh --format csv"]),
            (
                "bisect",
                [
                    "bisect studies/gate.toml --good v1.0 --bad HEAD --allow-solvers",
                    "bisect gate --good v1.0 --bad HEAD --build make --run './run {out}'",
                ],
            ),
        ],
    ),
    (
        "Records and tools",
        &[
            ("records", ["records out/my-study", "records out/my-study 3f2a"]),
            ("merge", ["merge out-1 out-2", "merge my-study.toml out-1 out-2 --out merged"]),
            ("schema", ["schema", "schema mapping"]),
            ("completions", ["completions bash", "completions zsh"]),
        ],
    ),
];

/// Heading of the options for clusters, other builds and the development of methods.
pub const EXPERT: &str = "Expert options";

/// The command line with its help texts.
pub fn dressed(command: clap::Command) -> clap::Command {
    let overview = overview(&command);
    let command = command.mut_subcommands(|command| {
        let of_command = |(name, examples): &(&str, [&str; 2])| {
            (*name == command.get_name())
                .then(|| format!("Examples:\n  oedometer {}\n  oedometer {}", examples[0], examples[1]))
        };
        let examples = GROUPS.iter().flat_map(|(_, commands)| *commands).find_map(of_command);
        command.after_help(examples.unwrap_or_default())
    });
    plain(command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n{overview}\n\nOptions:\n{{options}}{{after-help}}"
    )))
}

/// The commands by group, each with its first sentence.
fn overview(command: &clap::Command) -> String {
    let mut out = String::new();
    for (title, commands) in GROUPS {
        let _ = write!(out, "\n{title}:");
        for (name, _) in commands {
            let about = command.find_subcommand(name).and_then(clap::Command::get_about);
            let _ = write!(out, "\n  {name:<12} {}", about.map(StyledStr::to_string).unwrap_or_default());
        }
        out.push('\n');
    }
    out.trim_end().to_owned()
}

/// Help texts without the backticks of the source's comments.
fn plain(command: clap::Command) -> clap::Command {
    let words = |help: &StyledStr| help.to_string().replace('`', "");
    let of_argument = |argument: clap::Arg| {
        let (help, long) = (argument.get_help().map(words), argument.get_long_help().map(words));
        let argument = argument.help(help.unwrap_or_default());
        match long {
            Some(long) => argument.long_help(long),
            None => argument,
        }
    };
    command.mut_args(of_argument).mut_subcommands(plain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::command;

    #[test]
    fn every_command_is_in_one_group_and_its_examples_are_taken() {
        let commands = command();
        let mut grouped: Vec<&str> =
            GROUPS.iter().flat_map(|(_, commands)| commands.iter().map(|(name, _)| *name)).collect();
        let mut all: Vec<&str> = commands.get_subcommands().map(clap::Command::get_name).collect();
        grouped.sort_unstable();
        all.sort_unstable();
        assert_eq!(grouped, all);
        for (name, examples) in GROUPS.iter().flat_map(|(_, commands)| *commands) {
            for example in examples {
                assert_eq!(example.split(' ').next(), Some(*name), "{example}");
                assert!("  oedometer ".len() + example.len() <= 80, "{example}: would be broken in two");
                let mut quoted = example.split(['"', '\'']);
                let mut words = vec!["oedometer".to_owned()];
                while let Some(bare) = quoted.next() {
                    words.extend(bare.split_whitespace().map(str::to_owned));
                    words.extend(quoted.next().map(str::to_owned));
                }
                if let Err(error) = command().try_get_matches_from(&words) {
                    panic!("{example}: {error}");
                }
            }
        }
    }
}
