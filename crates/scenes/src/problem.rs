//! A scene's problem: what a solver has to know of it, as plain data.

use crate::column::{Column, Undrained, column_parameters};
use crate::manufactured;
use crate::scene::{Body, LoadKind, Question, Scene, StartOf};
use oedometer_exact::exact_error::ExactError;
use oedometer_problem::method::Method;
use oedometer_problem::problem::{Faces, Load, Problem, Start, Weight};
use oedometer_soil::base::{Base, Drainage};
use oedometer_soil::material::Material;
use std::sync::Arc;

/// Share of its conductivity that a sealed soil keeps.
const SEALED: f64 = 1e-12;

impl Scene {
    /// The scene's problem on `cells` cells over the height with `points_per_cell` points each.
    ///
    /// # Errors
    /// When the parameters are impossible.
    pub fn problem(
        &self,
        column: &Column,
        soil: &Material,
        method: Method,
        cells: usize,
        points_per_cell: usize,
    ) -> Result<Problem, ExactError> {
        let load = self.load_of(column, soil);
        // Round-off is of the size of what weighs.
        let pressure = column.pressure_scale().abs();
        let pressure_scale = if column.self_weight {
            pressure.max(soil.mixture_density() * soil.gravity * column.height)
        } else {
            pressure
        };
        Ok(Problem {
            dimensions: column.dimensions,
            cell_size: column.cell_size(cells),
            cells: [column.cells_across(cells).unwrap_or(1), column.cells_up(cells)],
            height: column.height,
            points: column.points,
            points_per_cell,
            faces: self.faces(column),
            loading_time: column.loading_time,
            material: self.soil_under_load(soil),
            layers: column.soils,
            initial_stress: column.initial_stress,
            start: match &self.start {
                StartOf::OverDepth(start) => start(column, soil)?,
                StartOf::Undrained => Start::Undrained,
            },
            strain: self.strain,
            weight: column.self_weight.then(|| self.weight(column, soil)),
            forcing: self.motion.map(|model| manufactured::forcing(model, column, soil)).transpose()?,
            pressure_scale,
            method: method_under(method, load),
            load,
        })
    }

    fn faces(&self, column: &Column) -> Faces {
        match self.body {
            Body::Square => Faces::Closed,
            Body::Slab => Faces::MovableSide,
            Body::Column | Body::Layer if column.base() == Some(Base::Rough) => Faces::RoughBase,
            Body::Column if column.drainage == Drainage::Both => Faces::DrainedBase,
            Body::Column | Body::Layer => Faces::Oedometer,
        }
    }

    /// What acts on the body; a plate is pushed by its width in the time of `T_v = 1`.
    fn load_of(&self, column: &Column, soil: &Material) -> Load {
        match self.load {
            LoadKind::None => Load::None,
            LoadKind::Uniform => Load::Uniform(column.load),
            LoadKind::Plates => Load::Plate(column.load),
            LoadKind::Cosine => Load::Cosine { amplitude: column.load, length: column.extent() },
            LoadKind::Pushed => {
                let plate = &column.footing;
                Load::Push {
                    extent: 0.5 * plate.width,
                    velocity: plate.width / column_parameters(column, soil).time(1.0),
                    is_rough: plate.contact == Base::Rough,
                    has_water: plate.undrained == Undrained::TwoPhase,
                }
            }
        }
    }

    /// A scene's soil: what no water leaves is a soil that lets none through.
    fn soil_under_load(&self, soil: &Material) -> Material {
        let sealing = if self.sealed { SEALED } else { 1.0 };
        Material { hydraulic_conductivity: sealing * soil.hydraulic_conductivity, ..*soil }
    }

    fn weight(&self, column: &Column, soil: &Material) -> Weight {
        let parameters = column_parameters(column, soil);
        Weight {
            gravity: soil.gravity,
            stress: Arc::new(move |depth| parameters.initial_stress(depth)),
            // A column at rest is there to show what a method leaves unbalanced.
            is_balanced: self.question != Question::Rest,
        }
    }
}

/// The method under a load: of total stress there is one phase, whose volume goes the way that the water's would.
fn method_under(method: Method, load: Load) -> Method {
    let strain = match load {
        Load::Push { has_water: false, .. } => method.strain.with_bbar(),
        _ => None,
    };
    strain.map_or(method, |strain| Method { strain, ..method })
}
