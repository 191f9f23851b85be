//! `oedometer list`: what there is to choose from.

use crate::cli::exit::Exit;
use crate::cli::stream::print_data;
use crate::exact::reference::ReferenceKind;
use crate::mpm::method::Method;
use crate::mpm::run::integrator::IntegratorKind;
use crate::scene::SceneKind;
use crate::study::check::Study;
use crate::study::shipped::shipped_studies;
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
