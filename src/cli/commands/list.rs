//! `oedometer list`: the names of scenes, methods, integrators, references and shipped studies.

use crate::cli::exit::{Ended, Exit};
use crate::cli::output::print_data;
use crate::study::diagnostic::nearest;
use crate::study::shipped::{shipped_names, shipped_study, shipped_titles};
use oedometer_exact::{ReferenceKind, ShelfProblem};
use oedometer_mpm::method::Method;
use oedometer_mpm::run::integrator::IntegratorKind;
use oedometer_mpm::scene::SceneKind;
use std::fmt::Write;

/// Arguments of `list`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Print the file of a shipped study
    #[arg(long, value_name = "STUDY")]
    show: Option<String>,
}

/// Prints all names, or the file of one shipped study.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    if let Some(name) = &arguments.show {
        let Some(study) = shipped_study(name) else {
            let names = shipped_names();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let near = nearest(name, names.iter().copied());
            let help = near
                .map_or("`oedometer list` names them".to_owned(), |near| format!("did you mean `{near}`?"));
            return Err(Ended::usage(format!("no shipped study is called `{name}`: {help}")));
        };
        print_data(&study.text)?;
        return Ok(Exit::Pass);
    }
    let mut out = String::new();
    writeln!(out, "scenes")?;
    for scene in SceneKind::ALL {
        writeln!(out, "  {:<26} {}", scene.name(), scene.summary())?;
    }
    writeln!(out, "methods")?;
    for name in Method::names() {
        let parts = Method::named(&name).map(|method| method.choices()).unwrap_or_default();
        writeln!(out, "  {name:<26} {parts}")?;
    }
    writeln!(out, "integrators")?;
    for integrator in IntegratorKind::ALL {
        writeln!(out, "  {}", integrator.name())?;
    }
    writeln!(out, "references")?;
    for kind in ReferenceKind::ALL {
        writeln!(out, "  {}", kind.name())?;
    }
    writeln!(out, "exact problems without a solver")?;
    for problem in ShelfProblem::ALL {
        writeln!(out, "  {problem}")?;
    }
    writeln!(out, "shipped studies")?;
    for (name, title) in shipped_titles() {
        writeln!(out, "  {name:<26} {title}")?;
    }
    print_data(&out)?;
    Ok(Exit::Pass)
}
