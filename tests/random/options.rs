//! The options of one call of `oedometer solve`: as a command that a person repeats, and as the study that it describes.

use oedometer::{Study, StudySource};
use std::fmt::Write;

/// A number to four digits.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().expect("a number")
}

/// What `oedometer solve` is asked.
#[derive(Clone, Debug, Default)]
pub struct Options {
    pub scene: &'static str,
    pub method: String,
    pub integrator: &'static str,
    pub cells: usize,
    pub points_per_cell: usize,
    /// Rule and its number; the integrator's own where there is none.
    pub time_step: Option<(&'static str, f64)>,
    pub time_factors: Vec<f64>,
    /// Dotted keys of a study file and their values.
    pub settings: Vec<(String, String)>,
}

impl Options {
    /// Sets a key, in place of what it was.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "keys are set to texts, numbers and switches as they stand"
    )]
    pub fn set(&mut self, key: &str, value: impl ToString) {
        self.settings.retain(|(other, _)| other != key);
        self.settings.push((key.to_owned(), value.to_string()));
    }

    /// Sets a key to a number of four digits, which a person types.
    pub fn set_rounded(&mut self, key: &str, value: f64) -> f64 {
        let rounded = rounded(value);
        self.set_number(key, rounded);
        rounded
    }

    /// Sets a key to a number, whose shortest text reads back to the same bits.
    pub fn set_number(&mut self, key: &str, value: f64) {
        self.set(key, format!("{value:e}"));
    }

    /// The value of a key, where it is set.
    pub fn value(&self, key: &str) -> Option<&str> {
        self.settings.iter().find(|(other, _)| other == key).map(|(_, value)| value.as_str())
    }

    /// The number of a key that is set.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.value(key)?.parse().ok()
    }

    /// Size of a cell of a body of this height, m.
    pub fn cell_size(&self, height: f64) -> f64 {
        height / ((self.cells - 1) as f64 + self.number("points.filling").unwrap_or(1.0))
    }

    /// The command that repeats it.
    pub fn command(&self) -> String {
        let mut text = format!(
            "oedometer solve {} --method {} --integrator {} --cells {} --points-per-cell {}",
            self.scene, self.method, self.integrator, self.cells, self.points_per_cell
        );
        if let Some((rule, number)) = self.time_step {
            write!(text, " --time-step {rule}={number:e}").expect("memory");
        }
        write!(text, " --time-factor {}", self.listed_times(",")).expect("memory");
        for (key, value) in &self.settings {
            write!(text, " --set {key}={value}").expect("memory");
        }
        text
    }

    /// The options of a command that [`command`](Self::command) wrote.
    ///
    /// # Panics
    /// Where it is no such command.
    pub fn of_command(command: &str) -> Self {
        let words: Vec<&str> = command.split_whitespace().collect();
        let scene = words[2].to_owned().leak();
        let mut options = Self { scene, ..Self::default() };
        for pair in words[3..].chunks(2) {
            let (key, value) = (pair[0], pair[1].to_owned());
            let parts = value.split_once('=').map(|(one, other)| (one.to_owned(), other.to_owned()));
            match (key, parts) {
                ("--method", _) => options.method = value,
                ("--integrator", _) => options.integrator = value.leak(),
                ("--cells", _) => options.cells = value.parse().expect("a count"),
                ("--points-per-cell", _) => options.points_per_cell = value.parse().expect("a count"),
                ("--time-factor", _) => {
                    options.time_factors =
                        value.split(',').map(|one| one.parse().expect("a number")).collect();
                }
                ("--time-step", Some((rule, number))) => {
                    options.time_step = Some((rule.leak(), number.parse().expect("a number")));
                }
                ("--set", Some((key, value))) => options.set(&key, value),
                _ => panic!("`{key} {value}` is no option of the sweep"),
            }
        }
        assert_eq!(options.command(), command, "read back");
        options
    }

    fn listed_times(&self, between: &str) -> String {
        let times: Vec<String> = self.time_factors.iter().map(|factor| format!("{factor:e}")).collect();
        times.join(between)
    }

    /// The study that the command describes.
    ///
    /// # Errors
    /// What the checker has against it.
    pub fn study(&self) -> Result<Study, String> {
        let mut text = format!("title = \"random\"\nscene = \"{}\"\n", self.scene);
        writeln!(text, "output.time_factors = [{}]", self.listed_times(", ")).expect("memory");
        for (key, value) in &self.settings {
            let is_word =
                value.parse::<f64>().is_err() && value.parse::<bool>().is_err() && !value.starts_with('[');
            let value = if is_word { format!("{value:?}") } else { value.clone() };
            writeln!(text, "{key} = {value}").expect("memory");
        }
        write!(
            text,
            "[[sweep]]\nmethod = [\"{}\"]\nintegrator = [\"{}\"]\ncells = [{}]\npoints_per_cell = [{}]\n",
            self.method, self.integrator, self.cells, self.points_per_cell
        )
        .expect("memory");
        if let Some((rule, number)) = self.time_step {
            writeln!(text, "time_step = [{{ {rule} = {number:e} }}]").expect("memory");
        }
        let source = StudySource { name: "random.toml".to_owned(), text };
        Study::check(&source).map_err(|error| error.to_string())
    }
}
