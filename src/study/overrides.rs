//! Studies from the command line: `--set`, lists and step rules become the text of a study file, so that one checker
//! judges both and its messages point at what was typed.

use crate::study::diagnostic::StudyError;
use crate::study::file::COMMAND_LINE;
use crate::study::synonyms::read_as;
use crate::study::units::{has_unit, in_si};
use crate::study::{Purpose, Study, StudySource};

/// Repeats are for the cases of a study.
pub const TIMING: (&str, &str) = ("timing.repeats", "cases are timed by `oedometer run` with a study file");
/// Keys about running, for commands that run nothing.
pub const OF_RUNS: [(&str, &str); 3] =
    [("task", "nothing is run"), ("case_seconds", "nothing is run"), ("timing.repeats", "nothing is run")];

/// Why what was typed makes no study.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OverrideError {
    /// An assignment, list or rule is wrong by itself.
    #[error("{0}")]
    Typed(String),
    /// The study that they make is wrong.
    #[error(transparent)]
    Study(#[from] StudyError),
}

impl OverrideError {
    pub(super) fn typed(message: impl Into<String>) -> Self {
        Self::Typed(message.into())
    }
}

/// Keys of a study file that are set at the command line.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Assignments {
    /// Set a dotted key of a study file, like material.porosity=0.45 or column.load="50 kPa"
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub assignments: Vec<String>,
}

/// Which results are compared with what.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Outputs {
    /// Compare the result with this reference only
    #[arg(long, value_name = "NAME")]
    pub reference: Option<String>,
    /// Time factors at which the result is compared, comma-separated
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub time_factor: Option<String>,
    /// Times at which the result is compared, comma-separated: in s, or with a unit, like 30d or "1 year"
    #[arg(long = "time", value_name = "LIST", allow_hyphen_values = true)]
    pub times: Option<String>,
    #[command(flatten)]
    pub set: Assignments,
}

/// Turns `KEY=VALUE` into a line of TOML; a value that is not TOML becomes a string.
pub(super) fn assignment(typed: &str) -> Result<(String, String), OverrideError> {
    let Some((key, value)) = typed.split_once('=') else {
        return Err(OverrideError::typed(format!(
            "`--set {typed}` has no value: write KEY=VALUE, like material.porosity=0.45"
        )));
    };
    let key = key.trim().split('.').map(read_as).collect::<Vec<_>>().join(".");
    let value = value.trim();
    if value.contains(['\n', '\r']) {
        return Err(OverrideError::typed(format!("the value of `{key}` has more than one line")));
    }
    let is_bare = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
    if !key.split('.').all(|part| !part.is_empty() && part.chars().all(is_bare)) {
        return Err(OverrideError::typed(format!(
            "`{key}` is not a key: write the dotted key of a study file, like column.load"
        )));
    }
    let is_toml = !value.is_empty() && toml::from_str::<toml::Table>(&format!("{key} = {value}")).is_ok();
    Ok((key, if is_toml { value.to_owned() } else { toml_of(value) }))
}

/// The text of a study from options and `--set`, each key given once.
#[derive(Default)]
pub struct StudyLines {
    lines: Vec<String>,
    /// Keys so far, each with the option that gave it.
    given: Vec<(String, String)>,
}

impl StudyLines {
    /// The lines of a command about a problem, whose name `by` gave.
    pub fn of(command: &str, scene: &str, by: &str) -> Result<Self, OverrideError> {
        let mut lines = Self::default();
        lines.give("title", &toml_of(command), &format!("`{command}`"))?;
        lines.give("scene", &toml_of(scene), by)?;
        Ok(lines)
    }

    /// Adds the options about outputs.
    pub fn give_outputs(&mut self, outputs: &Outputs) -> Result<(), OverrideError> {
        if let Some(typed) = &outputs.time_factor {
            let list = toml_of(numbers("--time-factor", typed)?);
            self.give("output.time_factors", &list, "`--time-factor`")?;
        }
        if let Some(typed) = &outputs.times {
            self.give("output.times", &toml_of(times("--time", typed)?), "`--time`")?;
        }
        if let Some(reference) = &outputs.reference {
            self.give("output.references", &toml_of(vec![reference.as_str()]), "`--reference`")?;
        }
        self.assign(&outputs.set)
    }

    /// Adds a key whose value comes from an option; `by` names the option in messages.
    pub fn give(&mut self, key: &str, value: &str, by: &str) -> Result<(), OverrideError> {
        if let Some((_, other)) = self.given.iter().find(|(given, _)| given == key) {
            let by = if other == by { "twice".to_owned() } else { format!("by {other} and by {by}") };
            return Err(OverrideError::typed(format!("`{key}` is given {by}: leave one out")));
        }
        self.given.push((key.to_owned(), by.to_owned()));
        self.lines.push(format!("{key} = {value}"));
        Ok(())
    }

    /// Adds the keys of `--set KEY=VALUE`.
    pub fn assign(&mut self, set: &Assignments) -> Result<(), OverrideError> {
        for typed in &set.assignments {
            let (key, value) = assignment(typed)?;
            self.give(&key, &value, "`--set`")?;
        }
        Ok(())
    }

    /// Whether a key has been given.
    pub fn has(&self, key: &str) -> bool {
        self.given.iter().any(|(given, _)| given == key)
    }

    /// Refuses keys that have no effect in this command, each with the reason.
    pub fn refuse_without_effect(&self, keys: &[(&str, &str)]) -> Result<(), OverrideError> {
        match keys.iter().find(|(key, _)| self.has(key)) {
            Some((key, reason)) => {
                Err(OverrideError::typed(format!("`--set {key}` has no effect here: {reason}")))
            }
            None => Ok(()),
        }
    }

    /// Checks the study of these lines with one sweep.
    pub fn study(
        mut self,
        purpose: Purpose,
        sweep: impl IntoIterator<Item = String>,
    ) -> Result<Study, OverrideError> {
        self.lines.push("[[sweep]]".to_owned());
        self.lines.extend(sweep);
        let text = self.lines.join("\n") + "\n";
        Ok(Study::check_for(&StudySource { name: COMMAND_LINE.to_owned(), text }, purpose)?)
    }

    /// Checks the study of one case that is not solved: no grid of this program has to fit its body.
    pub fn theory_study(self) -> Result<Study, OverrideError> {
        self.refuse_without_effect(&OF_RUNS)?;
        // Half of a footing has an even number of cells.
        let sweep = ["method = [\"GIMP-SRI-patch\"]", "cells = [2]"].map(str::to_owned);
        let study = self.study(Purpose::Theory, sweep)?;
        if study.planned.is_empty() {
            return Err(OverrideError::typed("the settings leave no column"));
        }
        Ok(study)
    }
}

/// What is said of a value that should be a number with a unit: the message, then what would be right.
pub(super) fn refused_quantity(key: &str, (message, help): (String, String)) -> OverrideError {
    OverrideError::typed(format!("`{key}`: {message}: {help}"))
}

/// A value as TOML spells it.
pub fn toml_of(value: impl Into<toml::Value>) -> String {
    value.into().to_string()
}

/// Turns `stable=0.5` into a step rule of a study file.
pub fn step_rule(typed: &str) -> Result<String, OverrideError> {
    // A number with a unit is judged as it is in files.
    let value_of = |text: &str| match text.parse::<f64>() {
        Ok(number) => Some(toml_of(number)),
        Err(_) => has_unit(text.trim_matches('"')).then(|| toml_of(text.trim_matches('"'))),
    };
    let rule = typed.split_once('=').and_then(|(rule, value)| Some((rule.trim(), value_of(value.trim())?)));
    match rule {
        Some((rule, value)) => Ok(format!("{{ {rule} = {value} }}")),
        None => Err(OverrideError::typed(format!(
            "`{typed}` is not a step rule: write stable=0.5, courant=0.5, seconds=1e-6, growth=0.05 or tolerance=1e-4"
        ))),
    }
}

/// Numbers of a comma-separated list.
pub fn numbers(name: &str, typed: &str) -> Result<Vec<f64>, OverrideError> {
    let number = |entry: &str| {
        let refusal = || format!("`{entry}` in `{name} {typed}` is not a number");
        entry.parse().map_err(|_| match in_si(entry, "s") {
            Ok(_) if name == "--time-factor" => format!("{}; a time is given by `--time {entry}`", refusal()),
            _ => refusal(),
        })
    };
    entries(name, typed)?.into_iter().map(|entry| number(entry).map_err(OverrideError::Typed)).collect()
}

/// Times of a comma-separated list, s: plain numbers, or numbers with a unit of time. A comma between digits before a unit may
/// begin a fraction, so that nothing is assumed.
pub fn times(name: &str, typed: &str) -> Result<Vec<f64>, OverrideError> {
    let begins_with_digit = |text: &str| text.starts_with(|letter: char| letter.is_ascii_digit());
    let parts: Vec<&str> = typed.split(',').collect();
    let joined = parts.windows(2).find(|pair| {
        pair[0].ends_with(|letter: char| letter.is_ascii_digit())
            && begins_with_digit(pair[1])
            && has_unit(pair[1])
    });
    if let Some([whole, rest]) = joined {
        let unit = rest.trim_start_matches(|letter: char| !letter.is_alphabetic()).trim();
        let whole = whole.trim();
        return Err(OverrideError::Typed(format!(
            "`{whole},{rest}` in `{name} {typed}` may be one time or two: write a decimal point, {whole}.{}, or a unit behind \
             each, {whole} {unit}, {}",
            rest.trim(),
            rest.trim()
        )));
    }
    let time = |entry: &str| {
        let parsed = entry.parse().or_else(|_| in_si(entry, "s"));
        parsed.map_err(|problem| refused_quantity(&format!("{name} {typed}"), problem))
    };
    entries(name, typed)?.into_iter().map(time).collect()
}

/// Entries of a comma-separated list. A number like `05` is what a decimal comma leaves.
fn entries<'a>(name: &str, typed: &'a str) -> Result<Vec<&'a str>, OverrideError> {
    let entries: Vec<&str> = typed.split(',').map(str::trim).collect();
    match entries.iter().find(|entry| has_leading_zero(entry)) {
        Some(entry) => Err(OverrideError::typed(format!(
            "`{entry}` in `{name} {typed}` begins with a zero: write decimals with a point, like 0.{}, \
             because a comma separates numbers",
            entry.trim_start_matches(['+', '-'])
        ))),
        None => Ok(entries),
    }
}

/// Whether a number begins with a zero and another digit.
pub fn has_leading_zero(entry: &str) -> bool {
    let mut letters = entry.trim_start_matches(['+', '-']).chars();
    letters.next() == Some('0') && letters.next().is_some_and(|letter| letter.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assignments_become_toml() {
        for (typed, key, value) in [
            ("material.porosity=0.45", "material.porosity", "0.45"),
            ("column.load=200e3", "column.load", "200e3"),
            ("material.law=log-linear", "material.law", "\"log-linear\""),
            ("integrator.mapping_back=false", "integrator.mapping_back", "false"),
            (" column.load = 5 kPa ", "column.load", "\"5 kPa\""),
            ("column.load=\"5 kPa\"", "column.load", "\"5 kPa\""),
            ("output.time_factors=[0.1, 0.2]", "output.time_factors", "[0.1, 0.2]"),
            ("title=", "title", "\"\""),
            ("title=a=b", "title", "\"a=b\""),
        ] {
            assert_eq!(assignment(typed).expect("a line"), (key.to_owned(), value.to_owned()));
        }
        let key = |typed: &str| {
            format!("`{typed}` is not a key: write the dotted key of a study file, like column.load")
        };
        for (wrong, told) in [
            (
                "material.porosity",
                "`--set material.porosity` has no value: write KEY=VALUE, like material.porosity=0.45"
                    .to_owned(),
            ),
            ("a b=1", key("a b")),
            ("=1", key("")),
            (".a=1", key(".a")),
            ("a[0]=1", key("a[0]")),
            ("title=x\nscene = 1", "the value of `title` has more than one line".to_owned()),
            ("column.load=1\rscene = 1", "the value of `column.load` has more than one line".to_owned()),
        ] {
            assert_eq!(assignment(wrong).map_err(|error| error.to_string()), Err(told), "{wrong}");
        }
    }

    #[test]
    fn a_key_is_given_once() {
        let mut lines = StudyLines::default();
        assert!(lines.give("output.time_factors", "[0.1]", "`--time-factor`").is_ok());
        let set =
            |typed: &[&str]| Assignments { assignments: typed.iter().map(|one| (*one).to_owned()).collect() };
        let twice = lines.assign(&set(&["output.time_factors=[0.2]"])).map_err(|error| error.to_string());
        let told = "`output.time_factors` is given by `--time-factor` and by `--set`: leave one out";
        assert_eq!(twice, Err(told.to_owned()));
        let same =
            lines.assign(&set(&["column.load=1.0", "column.load=2.0"])).map_err(|error| error.to_string());
        assert_eq!(same, Err("`column.load` is given twice: leave one out".to_owned()));
        assert!(lines.has("column.load") && lines.has("output.time_factors") && !lines.has("column"));
        for (key, why) in OF_RUNS {
            let mut lines = StudyLines::default();
            assert!(lines.refuse_without_effect(&OF_RUNS).is_ok());
            lines.give(key, "1", "`--set`").expect("a key");
            let told = lines.refuse_without_effect(&OF_RUNS).map_err(|error| error.to_string());
            assert_eq!(told, Err(format!("`--set {key}` has no effect here: {why}")));
        }
    }

    #[test]
    fn numbers_keep_their_bits() {
        let list = numbers("--time-factor", "0.05, .1,1,1e-300").expect("numbers");
        assert_eq!(list, [0.05, 0.1, 1.0, 1e-300]);
        for number in [0.1 + 0.2, 1e-300, 1e300, 1.0] {
            let text = format!("a = {}", toml_of(number));
            assert_eq!(toml::from_str::<toml::Table>(&text).expect("TOML")["a"].as_float(), Some(number));
        }
        assert_eq!(step_rule("courant=1").unwrap_or_default(), "{ courant = 1.0 }");
        assert_eq!(step_rule("seconds=2 min").unwrap_or_default(), "{ seconds = \"2 min\" }");
        for (typed, told) in [
            (
                "0,05",
                "`05` in `--zeta 0,05` begins with a zero: write decimals with a point, like 0.05, because \
                 a comma separates numbers",
            ),
            (
                "1,-007",
                "`-007` in `--zeta 1,-007` begins with a zero: write decimals with a point, like 0.007, \
                 because a comma separates numbers",
            ),
            ("1 d", "`1 d` in `--zeta 1 d` is not a number"),
        ] {
            assert_eq!(numbers("--zeta", typed).map_err(|error| error.to_string()), Err(told.to_owned()));
        }
        assert_eq!(numbers("--zeta", "0, 0.05,-0.5,0e1").expect("numbers"), [0.0, 0.05, -0.5, 0.0]);
        let told = "`1 d` in `--time-factor 1 d` is not a number; a time is given by `--time 1 d`";
        assert_eq!(numbers("--time-factor", "1 d").map_err(|error| error.to_string()), Err(told.to_owned()));
        assert_eq!(times("--time", "5, 2 min,1d").expect("times"), [5.0, 120.0, 86_400.0]);
        for (typed, right) in [
            ("1,5 years", "1.5 years, or a unit behind each, 1 years, 5 years"),
            ("1,5a", "1.5a"),
            ("2 d, 1,5 days", "1.5 days"),
            ("10,20,30 min", "may be one time or two"),
        ] {
            let told = times("--time", typed).expect_err(typed).to_string();
            assert!(told.contains(right), "{told}");
        }
        assert_eq!(times("--time", "1,5").expect("two plain times"), [1.0, 5.0]);
        for typed in ["05", "5 kPa", "soon", ""] {
            assert!(times("--time", typed).is_err(), "{typed}");
        }
        assert!(step_rule("seconds").is_err() && numbers("--zeta", "0.1,x").is_err());
    }
}
