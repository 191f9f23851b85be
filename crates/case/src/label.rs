//! Labels of cases: the method, the meshes and what differs from the defaults.

use crate::{Case, Key, Task, USUAL_POINTS, Value};
use oedometer_problem::arrangement::Arrangement;
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::scene::Body;
use oedometer_soil::base::Drainage;
use oedometer_soil::conductivity::ConductivityMean;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::material::Material;
use oedometer_wording::typed;

impl Case {
    /// What is special about integration and equations: empty for the paper's integration of the
    /// scene's own equations.
    pub fn variant(&self) -> String {
        let (settings, usual) = (&self.settings, (self.scene.settings)());
        let named = [
            (self.formulation != self.integrator.default_formulation(), self.formulation.name().to_owned()),
            (settings.scheme != usual.scheme, settings.scheme.name().to_owned()),
            (settings.drag != usual.drag, format!("{} drag", settings.drag.name())),
            (settings.flip != usual.flip, format!("FLIP {}", settings.flip)),
            (settings.mapping_back != usual.mapping_back, "no mapping back".to_owned()),
            (settings.affine, "APIC".to_owned()),
            (settings.stress_slopes, "stress slopes".to_owned()),
            (self.column.dimensions == 2 && self.scene.body == Body::Column, "two dimensions".to_owned()),
            (self.column.drainage == Drainage::Both, "drained at both ends".to_owned()),
            (self.column.self_weight && !(self.scene.column)().self_weight, "own weight".to_owned()),
            (self.material.law != (self.scene.soil)().law, format!("{} law", self.material.law.name())),
            (self.material.continuity != Continuity::Conservative, "porosity gradient dropped".to_owned()),
            (self.material.conductivity_mean == ConductivityMean::Chord, "chord mean".to_owned()),
        ];
        let mut parts: Vec<String> =
            named.into_iter().filter(|(is_special, _)| *is_special).map(|(_, name)| name).collect();
        parts.extend(self.arrangement());
        let seed = Material::default();
        if self.scene.locks && self.material.water_bulk_modulus != seed.water_bulk_modulus {
            parts
                .push(format!("K_w/E {:e}", self.material.water_bulk_modulus / self.material.youngs_modulus));
        }
        if self.scene.locks && self.material.poissons_ratio != seed.poissons_ratio {
            parts.push(format!("ν {}", self.material.poissons_ratio));
        }
        if self.task == Task::Stability {
            parts.extend(self.departure_from_the_seed());
        }
        parts.extend(self.swept_inputs());
        parts.join(", ")
    }

    /// The inputs that tell it from other cases of its study, as `key=value`.
    fn swept_inputs(&self) -> impl Iterator<Item = String> {
        self.swept.iter().filter_map(|name| {
            let value = match Key::named(name, "sweep")?.get(self) {
                // A digit of round-off does not make another case.
                Value::Number(number) => typed(format!("{number:.7e}").parse().unwrap_or(number)),
                other => other.to_string(),
            };
            Some(format!("{name}={value}"))
        })
    }

    /// Where the points lie, where that is not the regular lattice in one set.
    fn arrangement(&self) -> Vec<String> {
        let (points, regular) = (&self.column.points, Arrangement::default());
        let sets = match points.water_per_cell {
            0 => None,
            of_water if of_water == self.points_per_cell => Some("two point sets".to_owned()),
            of_water => Some(format!("two point sets, {of_water} of the water")),
        };
        let places = [
            (points.offset, regular.offset, "points shifted by"),
            (points.jitter, regular.jitter, "points jittered by"),
            (points.filling, regular.filling, "top cell filled to"),
        ]
        .into_iter()
        .filter(|(value, usual, _)| value != usual)
        .map(|(value, _, what)| format!("{what} {value}"));
        let unequal = points.alternating.then(|| "one more point in every second cell".to_owned());
        sets.into_iter().chain(places).chain(unequal).collect()
    }

    /// Parameters that maps of the critical step sweep, where they are not the seed's.
    fn departure_from_the_seed(&self) -> Vec<String> {
        let (soil, seed) = (&self.material, Material::default());
        [
            (soil.hydraulic_conductivity, seed.hydraulic_conductivity, "k ="),
            (soil.water_bulk_modulus, seed.water_bulk_modulus, "K_w ="),
            (soil.porosity, seed.porosity, "n ="),
            (soil.youngs_modulus, seed.youngs_modulus, "E ="),
            (soil.poissons_ratio, seed.poissons_ratio, "ν ="),
            (soil.grain_density, seed.grain_density, "ρ_s ="),
            (soil.water_density, seed.water_density, "ρ_w ="),
            (soil.gravity, seed.gravity, "g ="),
        ]
        .into_iter()
        .filter(|(value, usual, _)| value != usual)
        .map(|(value, _, what)| format!("{what} {value:e}"))
        .collect()
    }

    /// Words by which a person knows the case within its study.
    pub fn label(&self) -> String {
        self.label_with(&self.time_step.to_string())
    }

    /// The label without the step, for a case whose step is the question.
    pub fn label_without_step(&self) -> String {
        self.label_with("")
    }

    fn label_with(&self, step: &str) -> String {
        let Self { method, cells, points_per_cell, .. } = self;
        let mut label = if self.has_integrator() {
            format!("{method} {} cells={cells} points={points_per_cell} {step}", self.integrator.name())
        } else {
            let is_step_given = matches!(self.time_step, TimeStep::Seconds(_));
            let points = match *points_per_cell {
                USUAL_POINTS => String::new(),
                points => format!(" points={points}"),
            };
            format!("{method} cells={cells}{points} {}", if is_step_given { step } else { "" })
        };
        let variant = self.variant();
        label.truncate(label.trim_end().len());
        if !variant.is_empty() {
            label = format!("{label} ({variant})");
        }
        label
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Attached, SolverName};
    use oedometer_problem::settings::Drag;
    use oedometer_scenes::TERZAGHI;

    #[test]
    fn a_label_names_unusual_inputs_and_the_step_unless_the_step_is_the_question() {
        type Change = fn(&mut Case);
        let other_soil: Change = |case| {
            case.task = Task::Stability;
            let soil = &mut case.material;
            (soil.hydraulic_conductivity, soil.water_bulk_modulus) = (2e-3, 3e9);
            (soil.porosity, soil.youngs_modulus, soil.poissons_ratio) = (0.4, 5e6, 0.125);
            (soil.grain_density, soil.water_density, soil.gravity) = (2700.0, 1025.0, 10.0);
        };
        let all = "k = 2e-3, K_w = 3e9, n = 4e-1, E = 5e6, ν = 1.25e-1, ρ_s = 2.7e3, ρ_w = 1.025e3, g = 1e1";
        let swept: Change = |case| {
            case.swept = ["drag", "porosity", "cells", "nothing"].into();
            (case.material.porosity, case.settings.flip) = (0.3 + 1e-12, 0.25);
        };
        for (change, variant) in [
            ((|_| {}) as Change, ""),
            (other_soil, all),
            (|case| case.material.poissons_ratio = 0.49, ""),
            (|case| case.column.points.water_per_cell = 3, "two point sets, 3 of the water"),
            (|case| case.settings.drag = Drag::Implicit, "implicit drag"),
            (swept, "FLIP 0.25, drag=explicit, porosity=0.3, cells=8"),
        ] {
            let mut case = Case { cells: 8, ..Case::seed(Task::Solve, &TERZAGHI) };
            case.time_step = TimeStep::Courant(0.4);
            change(&mut case);
            let rest = if variant.is_empty() { String::new() } else { format!(" ({variant})") };
            let label = format!("{} explicit cells=8 points=2", case.method);
            assert_eq!(case.label(), format!("{label} courant=0.4{rest}"));
            assert_eq!(case.label_without_step(), label + &rest);
        }
        let ogs = Attached::new("ogs", "0123456789abcdef").map(SolverName::Attached).expect("a plain name");
        let mut case = Case { method: ogs, cells: 8, ..Case::seed(Task::Solve, &TERZAGHI) };
        assert_eq!(case.label(), "ogs cells=8");
        (case.points_per_cell, case.time_step) = (1, TimeStep::Seconds(0.25));
        case.column.dimensions = 2;
        assert_eq!(case.label(), "ogs cells=8 points=1 seconds=2.5e-1 (two dimensions)");
        assert_eq!(case.label_without_step(), "ogs cells=8 points=1 (two dimensions)");
    }
}
