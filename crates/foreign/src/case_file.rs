//! Writes `case.json`, which describes the problem to an attached solver.

use oedometer_case::{Case, Key};
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::Scene;
use oedometer_scenes::column::column_parameters;
use oedometer_soil::base::Drainage;
use oedometer_soil::elementary::powi;
use oedometer_soil::layers::SoilLayer;
use oedometer_soil::material::Material;
use serde::Serialize;
use std::collections::BTreeMap;

/// Version of the layout of a case file.
pub const SCHEMA: u32 = 1;
/// Suggested step of the time factor on ten cells, which falls with the square of the cells: the error of backward
/// Euler then falls as that of the mesh.
const STEP_ON_TEN_CELLS: f64 = 1e-3;
/// Fewest suggested steps to the first output.
const STEPS_TO_FIRST: f64 = 20.0;

/// A case for an attached solver. SI throughout; `units` names the unit of each number.
#[derive(Clone, Debug, PartialEq, Serialize, schemars::JsonSchema)]
pub struct CaseFile {
    /// Version of this layout, 1.
    pub schema: u32,
    /// Identity of the case: a hash over its meaning.
    pub case: String,
    /// Words by which a person knows the case.
    pub label: String,
    /// Name of the attached solver; of a case of this program its method.
    pub solver: String,
    /// Physical problem.
    pub scene: &'static Scene,
    /// The problem in a sentence.
    pub problem: String,
    /// Where `y` and `x` of a result count from, and what happens at the sides.
    pub axes: String,
    /// Geometry and load.
    pub column: CaseColumn,
    /// The soil.
    pub material: Material,
    /// Cells over the height.
    pub cells: usize,
    /// Material points per cell and direction, for solvers that have any.
    pub points_per_cell: usize,
    /// What follows from column, soil and cells.
    pub derived: Derived,
    /// Outputs as time factors `T_v = c_v t/H²`, ascending; 0 is the undrained start.
    pub time_factors: Vec<f64>,
    /// Times of the outputs, s.
    pub times: Vec<f64>,
    /// Suggested time step, s: that of the study where it names one in seconds; else `T_v` = 0.1 over the square of
    /// the cells, and a twentieth of the first output at most.
    pub time_step: f64,
    /// Unit of every number that has one, by its place in this file.
    pub units: BTreeMap<String, String>,
}

/// Geometry and load.
#[derive(Clone, Debug, PartialEq, Serialize, schemars::JsonSchema)]
pub struct CaseColumn {
    /// Initial height, m; of a slab half its width, from the middle to the drained side.
    pub height: f64,
    /// Width of a column (`column.width` of the study), or length of a layer (`layer.length`), m; in one dimension it has
    /// no effect. Of a slab half the distance of its
    /// plates.
    pub width: f64,
    /// Load on the surface, Pa, compression positive; the amplitude of the initial pressure in scenes without a load.
    pub load: f64,
    /// Time over which the load grows, s; 0 where it acts at once.
    pub loading_time: f64,
    /// Whether skeleton and water have a weight; the water level stands in the surface at the start. Pressures of a
    /// result are excess pressures in either case.
    pub self_weight: bool,
    /// Which ends let the water out: `top`, or `both`, top and base; then `T_v = c_v t/(H/2)²`.
    pub drainage: Drainage,
    /// Directions that this program would solve, 1 or 2.
    pub dimensions: usize,
    /// How a layer rests on its base, `rough` or `smooth`; of a column nothing.
    pub base: Option<String>,
    /// Layers of soil from the base up: thickness, m, and what differs from `material`; empty for a column of one soil.
    pub soils: Vec<SoilLayer>,
    /// Vertical effective stress of the start, Pa, compression positive, of a preconsolidated soil; 0 of others. Effective
    /// stresses of a result are counted from it.
    pub initial_stress: f64,
}

/// What follows from column, soil and cells.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, schemars::JsonSchema)]
pub struct Derived {
    /// `E_oed = E(1 − ν)/((1 + ν)(1 − 2ν))`, Pa.
    pub oedometric_modulus: f64,
    /// `γ_w = ρ_w g`, N/m³.
    pub unit_weight_of_water: f64,
    /// `c_v = k E_oed/γ_w`, drained, m²/s.
    pub coefficient_of_consolidation: f64,
    /// `H²/c_v`, or `(H/2)²/c_v` of a column drained at both ends, the time at which `T_v = 1`, s.
    pub seconds_per_time_factor: f64,
    /// Edge of a cell over the height, m.
    pub cell_size: f64,
    /// Settlement in the end under the linear law, `q H/E_oed`, m.
    pub final_settlement: f64,
}

impl CaseFile {
    /// The file of a case.
    pub fn of(case: &Case) -> Self {
        let (column, soil) = (&case.column, &case.material);
        let parameters = column_parameters(column, soil);
        Self {
            schema: SCHEMA,
            case: case.hash(),
            label: case.label(),
            solver: case.method.to_string(),
            scene: case.scene,
            problem: case.scene.summary.to_owned(),
            axes: axes_of(case).to_owned(),
            column: CaseColumn {
                height: column.height,
                width: column.extent(),
                load: column.pressure_scale(),
                loading_time: column.loading_time,
                self_weight: column.self_weight,
                drainage: column.drainage,
                dimensions: column.dimensions,
                base: column.base().map(|base| base.name().to_owned()),
                soils: column.soils.to_vec(),
                initial_stress: column.initial_stress,
            },
            material: **soil,
            cells: case.cells,
            points_per_cell: case.points_per_cell,
            derived: Derived {
                oedometric_modulus: soil.oedometric_modulus(),
                unit_weight_of_water: soil.unit_weight_of_water(),
                coefficient_of_consolidation: soil.coefficient_of_consolidation(),
                seconds_per_time_factor: case.seconds_per_time_factor(),
                cell_size: case.cell_size(),
                final_settlement: parameters.final_settlement(),
            },
            time_factors: case.time_factors.to_vec(),
            times: case.time_factors.iter().map(|factor| parameters.time(*factor)).collect(),
            time_step: suggested_step(case),
            units: units(),
        }
    }

    /// Its text.
    ///
    /// # Errors
    /// Never for plain numbers and words; the writer's own otherwise.
    pub fn text(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|text| text + "\n")
    }
}

/// What a solver has to know of the sides of a body, and whoever writes its result of the axes.
fn axes_of(case: &Case) -> &'static str {
    match case.column.drainage {
        Drainage::Top => case.scene.axes,
        Drainage::Both => {
            "y is measured upward from the base, fixed and drained, to the drained surface, which carries a uniform load; along x \
             there is neither flow nor motion"
        }
    }
}

/// The time step that a solver may take, s.
pub fn suggested_step(case: &Case) -> f64 {
    if let TimeStep::Seconds(seconds) = case.time_step {
        return seconds;
    }
    let of_mesh = STEP_ON_TEN_CELLS * powi(10.0 / case.cells as f64, 2);
    let first = case.time_factors.iter().copied().find(|factor| *factor > 0.0);
    let factor = first.map_or(of_mesh, |first| of_mesh.min(first / STEPS_TO_FIRST));
    factor * case.seconds_per_time_factor()
}

/// Units by places: those of the keys of study files, and of what is derived.
fn units() -> BTreeMap<String, String> {
    let of_table = |table: &'static str, place: &'static str| {
        Key::in_table(table)
            .filter(|key| !key.unit.is_empty() && key.in_place_of.is_empty())
            .map(move |key| (format!("{place}.{}", key.name), key.unit.to_owned()))
    };
    let derived = [
        ("derived.oedometric_modulus", "Pa"),
        ("derived.unit_weight_of_water", "N/m³"),
        ("derived.coefficient_of_consolidation", "m²/s"),
        ("derived.seconds_per_time_factor", "s"),
        ("derived.cell_size", "m"),
        ("derived.final_settlement", "m"),
        ("times", "s"),
        ("time_step", "s"),
    ];
    let derived = derived.map(|(place, unit)| (place.to_owned(), unit.to_owned()));
    of_table("column", "column").chain(of_table("material", "material")).chain(derived).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_case::Task;
    use oedometer_scenes::{COSINE_LAYER, MANDEL, TERZAGHI};
    use serde_json::Value;

    fn seed() -> Case {
        Case { cells: 20, time_factors: vec![0.0, 0.05, 1.0].into(), ..Case::seed(Task::Solve, &TERZAGHI) }
    }

    #[test]
    fn a_case_file_has_seconds_and_what_follows_from_the_soil() {
        let file = CaseFile::of(&seed());
        // c_v = 1e-4 · 1.2e6/9810 m²/s, so that T_v = 1 is 81.75 s.
        assert!((file.derived.coefficient_of_consolidation - 120.0 / 9810.0).abs() < 1e-15);
        assert!((file.derived.oedometric_modulus - 1.2e6).abs() < 1e-6);
        assert_eq!(file.times[0], 0.0);
        assert!((file.times[2] - 81.75).abs() < 1e-10 && (file.times[1] - 4.0875).abs() < 1e-11);
        assert!((file.derived.final_settlement - 1.0 / 1.2e6).abs() < 1e-18);
        assert!((file.derived.cell_size - 0.05).abs() < 1e-15);
    }

    #[test]
    fn the_suggested_step_is_the_studys_or_falls_with_the_mesh() {
        let step = |cells: usize| suggested_step(&Case { cells, ..seed() });
        assert!((step(10) - 1e-3 * 81.75).abs() < 1e-12);
        assert!((step(10) / step(40) - 16.0).abs() < 1e-9);
        assert!((step(1) - 0.05 / 20.0 * 81.75).abs() < 1e-12, "a twentieth of the first output at most");
        let given = Case { time_step: TimeStep::Seconds(0.5), ..seed() };
        assert_eq!(suggested_step(&given), 0.5);
    }

    /// Every number of a value by its place.
    fn numbers(value: &Value, at: &str, found: &mut Vec<String>) {
        match value {
            Value::Number(_) => found.push(at.to_owned()),
            Value::Object(fields) => {
                for (name, field) in fields {
                    let place = if at.is_empty() { name.clone() } else { format!("{at}.{name}") };
                    numbers(field, &place, found);
                }
            }
            Value::Array(list) => list.first().into_iter().for_each(|one| numbers(one, at, found)),
            _ => {}
        }
    }

    #[test]
    fn every_number_has_a_unit_or_is_known_to_have_none() {
        let file = CaseFile::of(&seed());
        let mut found = Vec::new();
        numbers(&serde_json::to_value(&file).expect("plain"), "", &mut found);
        let without = ["schema", "cells", "points_per_cell", "time_factors", "column.dimensions"];
        let ratios = ["material.porosity", "material.poissons_ratio"];
        for place in &found {
            let is_bare = without.contains(&place.as_str()) || ratios.contains(&place.as_str());
            assert!(file.units.contains_key(place) != is_bare, "{place}");
        }
        // What only a soil that remembers or yields has.
        let of_memory =
            ["material.reload_modulus", "material.preconsolidation", "material.undrained_strength"];
        for place in file.units.keys().filter(|place| !of_memory.contains(&place.as_str())) {
            assert!(found.contains(place), "the unit of {place}, which is not there");
        }
    }

    #[test]
    fn the_axes_are_those_of_the_body_and_its_numbers_stand_at_their_keys() {
        for (scene, part) in [
            (&TERZAGHI, "which carries a uniform load"),
            (&COSINE_LAYER, "from the crest of the load"),
            (&MANDEL, "from the middle of the slab"),
        ] {
            let file = CaseFile::of(&Case::seed(Task::Solve, scene));
            assert!(file.axes.contains(part), "{scene:?}: {}", file.axes);
            assert_eq!(file.column.base.is_some(), scene == &COSINE_LAYER, "{scene:?}");
        }
        let mut case = seed();
        (case.column.height, case.column.load) = (2.0, 7e3);
        (case.column.loading_time, case.column.initial_stress) = (3.0, 5e3);
        case.points_per_cell = 3;
        let file = CaseFile::of(&case);
        let column = &file.column;
        assert_eq!(
            [column.height, column.load, column.loading_time, column.initial_stress],
            [2.0, 7e3, 3.0, 5e3]
        );
        assert_eq!((file.cells, file.points_per_cell, column.self_weight), (20, 3, false));
        assert_eq!((file.derived.cell_size, file.derived.unit_weight_of_water), (0.1, 9810.0));
        assert_eq!((file.case, file.label), (case.hash(), case.label()));
        assert_eq!(file.times[2], file.derived.seconds_per_time_factor, "T_v = 1");
    }
}
