//! `oedometer completions`: what a shell needs to complete the command line.
//!
//! The scripts are clap's. It offers either the values that an argument can have or files, and a study is called by
//! the name of a shipped one or by its file: for bash, zsh and fish that is added to them.

use crate::cli::exit::Exit;
use crate::cli::stream::print_data;
use crate::study::shipped::shipped_names;
use clap::builder::PossibleValuesParser;
use clap_complete::Shell;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::method::Method;
use oedometer_mpm::run::integrator::IntegratorKind;
use oedometer_mpm::scene::SceneKind;

/// Commands whose arguments are studies.
const OF_STUDIES: [&str; 8] = ["run", "report", "check", "accept", "plan", "explain", "merge", "spread"];
/// Commands whose first argument is a scene.
const OF_SCENES: [&str; 2] = ["solve", "stability"];

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Shell to write for
    shell: Shell,
}

/// Names that live as long as the program: clap keeps them so.
fn lasting(names: Vec<String>) -> Vec<&'static str> {
    names.into_iter().map(|name| &*name.leak()).collect()
}

fn scenes() -> Vec<&'static str> {
    SceneKind::ALL.iter().map(|scene| scene.name()).collect()
}

/// Exact solutions: what `exact` takes for a scene, and `--reference` for a reference.
fn references() -> Vec<&'static str> {
    ReferenceKind::ALL.iter().map(|kind| kind.name()).collect()
}

/// The command with the names that its arguments take: a shell offers those, and no files.
fn with_names(mut command: clap::Command) -> clap::Command {
    let methods = lasting(Method::names());
    let integrators: Vec<_> = IntegratorKind::ALL.iter().map(|integrator| integrator.name()).collect();
    let in_solvers =
        [("scene", scenes()), ("method", methods), ("integrator", integrators), ("reference", references())];
    let mut named: Vec<(&str, &str, Vec<&'static str>)> = Vec::new();
    for subcommand in ["solve", "stability", "score"] {
        named.extend(in_solvers.iter().map(|(argument, names)| (subcommand, *argument, names.clone())));
    }
    named.push(("exact", "scene", references()));
    named.push(("list", "show", lasting(shipped_names())));
    for (subcommand, argument, names) in named {
        let has = command.find_subcommand(subcommand);
        if has.is_some_and(|found| found.get_arguments().any(|one| one.get_id() == argument)) {
            let takes = |argument: clap::Arg| argument.value_parser(PossibleValuesParser::new(names));
            command = command.mut_subcommand(subcommand, |found| found.mut_arg(argument, takes));
        }
    }
    command
}

/// Every option that wants a value behind it.
fn options_with_values(command: &clap::Command) -> String {
    let all = command.get_subcommands().flat_map(clap::Command::get_arguments);
    let with_values = all.filter(|argument| argument.get_action().takes_values());
    let mut names: Vec<String> =
        with_values.filter_map(|argument| Some(format!("--{}", argument.get_long()?))).collect();
    names.sort();
    names.dedup();
    names.join(" ")
}

/// Bash: behind a command of studies the shipped names, study files and folders, wherever no option wants a value.
fn for_bash(script: &str, command: &clap::Command) -> String {
    let (commands, names, options) =
        (OF_STUDIES.join(" "), shipped_names().join(" "), options_with_values(command));
    format!(
        r#"{script}
_oedometer_with_studies() {{
    local cur="$2" prev="$3"
    if [[ $COMP_CWORD -lt 2 || $cur == -* || " {commands} " != *" ${{COMP_WORDS[1]}} "* \
        || " {options} " == *" $prev "* ]]; then
        _oedometer "$@"
        return
    fi
    compopt -o filenames 2>/dev/null
    COMPREPLY=( $(compgen -W "{names}" -- "$cur") $(compgen -f -X '!*.toml' -- "$cur") $(compgen -d -- "$cur") )
}}
complete -F _oedometer_with_studies -o nosort -o bashdefault -o default oedometer 2>/dev/null \
    || complete -F _oedometer_with_studies -o bashdefault -o default oedometer
"#
    )
}

/// Zsh: the same by a function of its own in place of files.
fn for_zsh(script: &str) -> String {
    let names = shipped_names().join(" ");
    let function = format!(
        "\n_oedometer_studies() {{\n    local -a names\n    names=({names})\n    _alternative \\\n        \
         'names:shipped study:compadd -a names' \\\n        'files:study file:_files -g \"*.toml\"'\n}}\n"
    );
    let is_of_studies = |line: &str| line.trim_start().starts_with("'*::studies");
    let lines = script.lines().map(|line| {
        if is_of_studies(line) { line.replace(":_files'", ":_oedometer_studies'") } else { line.to_owned() }
    });
    let script = lines.collect::<Vec<_>>().join("\n");
    match script.split_once('\n') {
        // The first line tells zsh whose completions these are.
        Some((head, rest)) => format!("{head}\n{function}{rest}\n"),
        None => script,
    }
}

/// Fish: names beside the files that it offers by itself; clap writes it nothing about arguments without a dash.
fn for_fish(script: &str) -> String {
    let line = |subcommand: &&str, names: &str| {
        format!("complete -c oedometer -n \"__fish_seen_subcommand_from {subcommand}\" -a \"{names}\"\n")
    };
    let studies = shipped_names().join(" ");
    let of_studies = OF_STUDIES.iter().map(|subcommand| line(subcommand, &studies));
    let scenes = scenes().join(" ");
    let of_scenes = OF_SCENES.iter().map(|subcommand| line(subcommand, &scenes));
    let exact = line(&"exact", &references().join(" "));
    script.to_owned() + &of_studies.chain(of_scenes).chain([exact]).collect::<String>()
}

/// Prints the script with which a shell completes a command.
pub fn run(arguments: &Arguments, command: clap::Command) -> anyhow::Result<Exit> {
    let mut script = Vec::new();
    let mut command = with_names(command);
    clap_complete::generate(arguments.shell, &mut command, "oedometer", &mut script);
    let script = String::from_utf8(script)?;
    print_data(&match arguments.shell {
        Shell::Bash => for_bash(&script, &command),
        Shell::Zsh => for_zsh(&script),
        Shell::Fish => for_fish(&script),
        _ => script,
    })?;
    Ok(Exit::Pass)
}
