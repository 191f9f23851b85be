//! `oedometer list`: what there is to choose from.

use super::exit::Exit;
use super::stream::print_data;
use crate::exact::ReferenceKind;
use crate::scene::SceneKind;
use crate::solver::method::Method;
use crate::study::{IntegratorKind, Study, shipped_studies};
use std::fmt::Write;

/// Prints scenes, methods, integrators, references and shipped studies.
pub fn run() -> anyhow::Result<Exit> {
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
    writeln!(out, "shipped studies")?;
    for source in shipped_studies() {
        let study = Study::check(&source)?;
        writeln!(out, "  {:<26} {}", study.name, study.title)?;
    }
    print_data(&out)?;
    Ok(Exit::Pass)
}
