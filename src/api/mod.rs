//! The interface for other languages: names, lists of numbers and `key=value` texts in, lists and plain values out.
//!
//! It computes nothing and calls what the command line calls, so that a number in Python is the number that
//! `oedometer` prints. Numbers are in SI; lists over places are `[time][place]`, one time after the other.

pub mod convergence;
pub mod exact;
pub mod read;
pub mod score;

use crate::case::keys::Key;
use oedometer_exact::reference::ReferenceKind;
use oedometer_exact::{ShelfKey, ShelfProblem};
use oedometer_mpm::scene::SceneKind;

/// A solution by its name, and the scene of its column.
///
/// # Errors
/// When no solution has the name: lists the names.
pub fn scene_of(solution: &str) -> Result<(ReferenceKind, SceneKind), String> {
    let kind: ReferenceKind = solution.parse().map_err(|_| {
        let shelf = ShelfProblem::ALL.map(ReferenceKind::Shelf);
        let names: Vec<&str> = ReferenceKind::ALL.iter().chain(&shelf).map(|kind| kind.name()).collect();
        format!("no exact solution is called `{solution}`; there are {}", names.join(", "))
    })?;
    Ok((kind, SceneKind::of_solution(kind)))
}

/// The dotted key of a study file for a bare name, such as `material.porosity` for `porosity`; a name with a dot stays.
/// Geometry and load belong to the column, or to the layer in a scene of a layer.
///
/// # Errors
/// When no scene, solution or input has the name: lists the names.
pub fn dotted_key(scene: &str, name: &str) -> Result<String, String> {
    if name.contains('.') {
        return Ok(name.to_owned());
    }
    let own = |problem: ShelfProblem, key: &&ShelfKey| {
        key.problems.contains(&problem) && key.key.rsplit('.').next() == Some(name)
    };
    if let Some(problem) = ShelfProblem::named(scene)
        && let Some(key) = ShelfKey::ALL.iter().find(|key| own(problem, key))
    {
        return Ok(key.key.to_owned());
    }
    let scene = match SceneKind::named(scene) {
        Some(scene) => scene,
        None => scene_of(scene)?.1,
    };
    let body = match scene.table_of_geometry() {
        "column" if scene.needs_two_dimensions() => "layer",
        table => table,
    };
    let tables = [body, "material", "integrator", "points"];
    let found = tables.iter().find(|table| Key::named(name, table).is_some());
    found.map(|table| format!("{table}.{name}")).ok_or_else(|| {
        let names: Vec<&str> =
            [body, "material"].iter().flat_map(|table| Key::of(table)).map(|key| key.name).collect();
        format!("no input of `{}` is called `{name}`; there are {}", scene.name(), names.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_name_finds_its_table() {
        for (scene, name, key) in [
            ("terzaghi", "porosity", "material.porosity"),
            ("terzaghi-incompressible", "load", "column.load"),
            ("cosine-layer", "load", "layer.load"),
            ("terzaghi", "column.load", "column.load"),
        ] {
            assert_eq!(dotted_key(scene, name).as_deref(), Ok(key));
        }
        let told = dotted_key("terzaghi", "permeability").expect_err("no such key");
        assert!(told.contains("`permeability`") && told.contains("hydraulic_conductivity"), "{told}");
    }
}
