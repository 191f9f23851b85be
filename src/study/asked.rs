//! The problem that an exact solution or a score is asked for: a scene or a shelf problem, with its numbers.

use crate::case::Case;
use crate::study::check::Study;
use crate::study::overrides::{Assignments, Outputs, OverrideError, StudyLines};
use oedometer_exact::{ColumnParameters, ReferenceKind, ShelfParameters};
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::column_parameters;

/// What a result is compared with: a scene, or a problem of the shelf, with its numbers.
pub struct Asked {
    /// The scene with its column as a study of one case; of a problem of the shelf the column that it is told in.
    pub study: Study,
    /// Parameters of the references.
    pub parameters: ColumnParameters,
    /// References, the scene's own first.
    pub references: Vec<ReferenceKind>,
    /// Requested time factors; all if empty.
    pub requested: Vec<f64>,
}

impl Asked {
    /// The scene or problem of a name.
    ///
    /// # Errors
    /// What is wrong with the scene or an assignment.
    pub fn of_scene(scene: &str, outputs: &Outputs) -> Result<Self, OverrideError> {
        let on_shelf = scene.parse().ok().filter(|kind| matches!(kind, ReferenceKind::Shelf(_)));
        let mut outputs = outputs.clone();
        let mut shelf = ShelfParameters::default();
        if let Some(kind) = on_shelf {
            (outputs.set, shelf) = outputs.set.of_shelf(kind)?;
            if let Some(other) = outputs.reference.take().filter(|other| other != scene) {
                return Err(OverrideError::Typed(format!(
                    "`{scene}` has no reference `{other}`: it is its own"
                )));
            }
        }
        let name = on_shelf.map_or(scene, |kind| SceneKind::of_solution(kind).name());
        let mut lines = StudyLines::of("score", name, "`--scene`")?;
        lines.give_outputs(&outputs)?;
        let is_requested = lines.has("output.time_factors");
        let study = lines.theory_study()?;
        let case = &study.planned[0].case;
        let own = study.references.iter().map(|kind| kind.of_soil(&case.material)).collect();
        Ok(Self {
            parameters: ColumnParameters { shelf, ..column_parameters(&case.column, &case.material) },
            references: on_shelf.map_or(own, |kind| vec![kind]),
            requested: if is_requested { case.time_factors.to_vec() } else { Vec::new() },
            study,
        })
    }

    /// The default column of a solution with assignments; its reference is that for the equations that they choose.
    ///
    /// # Errors
    /// What is wrong with an assignment.
    pub fn of_solution(kind: ReferenceKind, set: &Assignments) -> Result<Self, OverrideError> {
        let (set, shelf) = set.of_shelf(kind)?;
        let mut lines = StudyLines::of("exact", SceneKind::of_solution(kind).name(), "the solution's name")?;
        lines.assign(&set)?;
        let study = lines.theory_study()?;
        let case = &study.planned[0].case;
        Ok(Self {
            parameters: ColumnParameters { shelf, ..column_parameters(&case.column, &case.material) },
            references: vec![kind.of_soil(&case.material)],
            requested: Vec::new(),
            study,
        })
    }

    /// The case.
    pub fn case(&self) -> &Case {
        &self.study.planned[0].case
    }
}
