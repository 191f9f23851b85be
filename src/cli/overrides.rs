//! Studies from the command line: `--set`, lists and step rules become the text of a study file,
//! so that one checker judges both and its messages point at what was typed.

use crate::cli::exit::Ended;
use crate::study::check::Purpose;
use crate::study::check::Study;
use crate::study::file::StudySource;

/// Repeats are for the cases of a study.
pub const TIMING: (&str, &str) = ("timing.repeats", "cases are timed by `oedometer run` with a study file");
/// Keys about running, for commands that run nothing.
pub const OF_RUNS: [(&str, &str); 3] =
    [("task", "nothing is run"), ("case_seconds", "nothing is run"), ("timing.repeats", "nothing is run")];

/// Turns `KEY=VALUE` into a line of TOML; a value that is no TOML is taken for a word.
pub fn assignment(typed: &str) -> anyhow::Result<String> {
    let Some((key, value)) = typed.split_once('=') else {
        return Err(Ended::usage(format!(
            "`--set {typed}` has no value: write KEY=VALUE, like material.porosity=0.45"
        )));
    };
    let (key, value) = (key.trim(), value.trim());
    if value.contains(['\n', '\r']) {
        return Err(Ended::usage(format!("the value of `{key}` has more than one line")));
    }
    let parts_fit = key.split('.').all(|part| {
        !part.is_empty()
            && part.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-')
    });
    if !parts_fit {
        return Err(Ended::usage(format!(
            "`{key}` is no key: write the dotted key of a study file, like column.load"
        )));
    }
    let line = format!("{key} = {value}");
    if !value.is_empty() && toml::from_str::<toml::Table>(&line).is_ok() {
        return Ok(line);
    }
    Ok(format!("{key} = {}", quoted(value)))
}

/// The text of a study from options and `--set`, each key given once.
#[derive(Default)]
pub struct StudyLines {
    lines: Vec<String>,
    /// Keys so far, each with who gave it.
    given: Vec<(String, String)>,
}

impl StudyLines {
    /// The lines of a command about a scene, whose name `by` gave.
    pub fn of(command: &str, scene: &str, by: &str) -> anyhow::Result<Self> {
        let mut lines = Self::default();
        lines.give("title", &quoted(command), &format!("`{command}`"))?;
        lines.give("scene", &quoted(scene), by)?;
        Ok(lines)
    }

    /// The options of the outputs, where they were given.
    pub fn give_outputs(
        &mut self,
        reference: Option<&str>,
        time_factors: Option<&str>,
    ) -> anyhow::Result<()> {
        if let Some(typed) = time_factors {
            self.give("output.time_factors", &list("--time-factor", typed)?, "`--time-factor`")?;
        }
        if let Some(reference) = reference {
            self.give("output.references", &format!("[{}]", quoted(reference)), "`--reference`")?;
        }
        Ok(())
    }

    /// A key whose value comes from an option; `by` names it in messages.
    pub fn give(&mut self, key: &str, value: &str, by: &str) -> anyhow::Result<()> {
        if let Some((_, other)) = self.given.iter().find(|(given, _)| given == key) {
            let by = if other == by { "twice".to_owned() } else { format!("by {other} and by {by}") };
            return Err(Ended::usage(format!("`{key}` is given {by}: leave one out")));
        }
        self.given.push((key.to_owned(), by.to_owned()));
        self.lines.push(format!("{key} = {value}"));
        Ok(())
    }

    /// The keys typed as `--set KEY=VALUE`.
    pub fn assign(&mut self, typed: &[String]) -> anyhow::Result<()> {
        for one in typed {
            let line = assignment(one)?;
            let (key, value) = line.split_once(" = ").unwrap_or((&line, ""));
            self.give(key, value, "`--set`")?;
        }
        Ok(())
    }

    /// Whether a key is given already.
    pub fn has(&self, key: &str) -> bool {
        self.given.iter().any(|(given, _)| given == key)
    }

    /// Refuses keys that a study file may have and that change nothing here, each with what does.
    pub fn refuse_without_effect(&self, keys: &[(&str, &str)]) -> anyhow::Result<()> {
        match keys.iter().find(|(key, _)| self.has(key)) {
            Some((key, instead)) => Err(Ended::usage(format!("`--set {key}` has no effect here: {instead}"))),
            None => Ok(()),
        }
    }

    /// The study with one sweep of these lines.
    pub fn study_with(self, sweep: impl IntoIterator<Item = String>) -> anyhow::Result<Study> {
        self.study_for(Purpose::Solving, sweep)
    }

    /// The same for a purpose.
    pub fn study_for(
        mut self,
        purpose: Purpose,
        sweep: impl IntoIterator<Item = String>,
    ) -> anyhow::Result<Study> {
        self.lines.push("[[sweep]]".to_owned());
        self.lines.extend(sweep);
        let text = self.lines.join("\n") + "\n";
        crate::cli::commands::run::checked(&StudySource { name: "command line".to_owned(), text }, purpose)
    }
}

/// A word as a TOML string.
pub fn quoted(word: &str) -> String {
    toml::Value::String(word.to_owned()).to_string()
}

/// Turns `stable=0.5` into a step rule of a study file.
pub fn step_rule(typed: &str) -> anyhow::Result<String> {
    let rule = typed.split_once('=').map(|(rule, value)| (rule.trim(), value.trim()));
    match rule {
        Some((rule, value)) if value.parse::<f64>().is_ok() => Ok(format!("{{ {rule} = {} }}", float(value))),
        _ => Err(Ended::usage(format!(
            "`{typed}` is no step rule: write stable=0.5, courant=0.5, seconds=1e-6, growth=0.05 or tolerance=1e-4"
        ))),
    }
}

/// Turns `0.05,0.1` into a list of a study file; each entry must be a number.
pub fn list(name: &str, typed: &str) -> anyhow::Result<String> {
    let entries = typed.split(',').map(str::trim);
    let numbers: Vec<String> = entries
        .map(|entry| match entry.parse::<f64>() {
            Ok(_) => Ok(float(entry)),
            Err(_) => Err(Ended::usage(format!("`{entry}` in `{name} {typed}` is no number"))),
        })
        .collect::<anyhow::Result<_>>()?;
    Ok(format!("[{}]", numbers.join(", ")))
}

/// Numbers of a comma-separated list.
pub fn numbers(name: &str, typed: &str) -> anyhow::Result<Vec<f64>> {
    typed
        .split(',')
        .map(|entry| {
            let number = entry.trim().parse::<f64>();
            number.map_err(|_| Ended::usage(format!("`{entry}` in `{name} {typed}` is no number")))
        })
        .collect()
}

/// A number as TOML spells floats, digits untouched: `1` becomes `1.0`, `.5` becomes `0.5`.
fn float(typed: &str) -> String {
    let number: f64 = typed.parse().unwrap_or(f64::NAN);
    if number.is_nan() {
        return "nan".to_owned();
    }
    if number.is_infinite() {
        return if number > 0.0 { "inf" } else { "-inf" }.to_owned();
    }
    // Rust's shortest form reads back to the same bits.
    format!("{number:?}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assignments_become_toml() {
        let line = |typed: &str| assignment(typed).unwrap_or_default();
        assert_eq!(line("material.porosity=0.45"), "material.porosity = 0.45");
        assert_eq!(line("column.load=200e3"), "column.load = 200e3");
        assert_eq!(line("material.law=log-linear"), "material.law = \"log-linear\"");
        assert_eq!(line("integrator.mapping_back=false"), "integrator.mapping_back = false");
        assert!(assignment("material.porosity").is_err());
        assert!(assignment("a b=1").is_err());
    }

    #[test]
    fn a_value_cannot_smuggle_lines_in() {
        assert!(assignment("title=x\nscene = 1").is_err());
        assert!(assignment("column.load=1\nscene = 1").is_err());
    }

    #[test]
    fn a_key_is_given_once() {
        let mut lines = StudyLines::default();
        assert!(lines.give("output.time_factors", "[0.1]", "`--time-factor`").is_ok());
        let twice =
            lines.assign(&["output.time_factors=[0.2]".to_owned()]).map_err(|error| error.to_string());
        let told = "`output.time_factors` is given by `--time-factor` and by `--set`: leave one out";
        assert_eq!(twice, Err(told.to_owned()));
        let same = ["column.load=1.0".to_owned(), "column.load=2.0".to_owned()];
        assert!(lines.assign(&same).is_err_and(|error| error.to_string().contains("twice")));
    }

    #[test]
    fn numbers_keep_their_bits() {
        assert_eq!(list("--time-factor", "0.05, .1,1").unwrap_or_default(), "[0.05, 0.1, 1.0]");
        assert_eq!(step_rule("seconds=1e-6").unwrap_or_default(), "{ seconds = 1e-6 }");
        assert!(step_rule("seconds").is_err() && list("--zeta", "0.1,x").is_err());
    }
}
