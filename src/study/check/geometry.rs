//! Checks of where the soil is and what loads it: the tables `[column]` and `[layer]`.

use crate::case::keys::{Key, Value};
use crate::case::planned::PlannedCase;
use crate::case::{Case, Task};
use crate::study::check::checker::Checker;
use crate::study::diagnostic::Diagnostic;
use crate::study::file::{StudyFile, SweepTable};
use crate::study::inputs::{One, TypedInput};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::xie_leo::XieLeo;
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::column_parameters;
use oedometer_soil::elementary;
use std::ops::Range;
use toml::Spanned;

/// Final strain `m_vl q` up to which small-strain theory is taken without a word.
const LARGEST_SMALL_STRAIN: f64 = 1e-2;

impl Checker<'_> {
    /// The values of the column's or the layer's table, whichever the scene is about; the other is refused.
    pub(crate) fn geometry(&mut self, file: &StudyFile, seed: &Case) -> Vec<(&'static Key, Value)> {
        let (scene, name) = (seed.scene, seed.scene.name());
        if scene.is_manufactured() {
            return self.motion(file, seed);
        }
        if let Some(motion) = &file.manufactured {
            self.complain(
                motion.span(),
                format!("the motion of `{name}` is not chosen: the scene has no [manufactured]"),
                "it belongs to \"manufactured-box\", \"manufactured-shear\" and \"manufactured-vortex\"",
            );
        }
        if scene.is_a_layer() {
            if let Some(span) =
                file.column.inputs.iter().map(|(_, typed)| typed.span()).min_by_key(|s| s.start)
            {
                self.complain(
                    span,
                    format!("the scene `{name}` has no [column]"),
                    "its geometry and load stand in the table [layer]: length, height, base, load",
                );
            }
            let layer = file.layer.as_ref().map(|layer| layer.get_ref());
            return self.inputs("layer", layer.map_or(&[], |layer| &layer.inputs), seed);
        }
        if let Some(layer) = &file.layer {
            self.complain(
                layer.span(),
                format!("the scene `{name}` has no [layer]"),
                "its geometry and load stand in the table [column]: height, width, load, dimensions",
            );
        }
        if let Some(typed) = file.column.typed("loading_time").filter(|_| !scene.takes_loading_time()) {
            self.complain(
                typed.span(),
                format!("the load of `{name}` acts at once"),
                "a load that grows belongs to the scenes \"xie-leo\" and \"dynamic-column\"",
            );
        }
        if let Some(typed) = file.column.typed("self_weight").filter(|_| !scene.takes_self_weight()) {
            self.complain(
                typed.span(),
                format!("the soil of `{name}` has no weight"),
                "own weight belongs to the scenes \"terzaghi\", \"xie-leo\", \"dynamic-column\" and \"at-rest\"",
            );
        }
        let has_weight = |typed: &&One| matches!(typed.get_ref(), TypedInput::Flag(true));
        let of_stability = seed.task == Task::Stability && scene.takes_self_weight();
        if let Some(typed) = file.column.typed("self_weight").filter(has_weight).filter(|_| of_stability) {
            self.complain(
                typed.span(),
                "a weight is a force that does not change: the critical step is that of the weightless column",
                "leave `self_weight` out of a study of stability",
            );
        }
        let in_a_line = |typed: &&One| !matches!(typed.get_ref(), TypedInput::Count(2));
        if let Some(typed) =
            file.column.typed("dimensions").filter(|_| scene.needs_two_dimensions()).filter(in_a_line)
        {
            self.complain(
                typed.span(),
                format!("`{name}` has two dimensions"),
                "leave the key out: the plate presses across the direction in which the water flows",
            );
        }
        self.inputs("column", &file.column.inputs, seed)
    }

    /// The values of the table of a chosen motion; the other tables of geometry are refused, for the body is the unit
    /// square and its points begin on the regular lattice.
    fn motion(&mut self, file: &StudyFile, seed: &Case) -> Vec<(&'static Key, Value)> {
        let name = seed.scene.name();
        let of_column = file.column.inputs.iter().map(|(_, typed)| typed.span());
        let of_column = of_column.chain(file.column.strain.as_ref().map(|typed| typed.span()));
        let of_points = file.points.inputs.iter().map(|(_, typed)| typed.span());
        for (table, place) in [
            ("column", of_column.min_by_key(|span| span.start)),
            ("layer", file.layer.as_ref().map(|layer| layer.span())),
            ("points", of_points.min_by_key(|span| span.start)),
        ] {
            if let Some(place) = place {
                self.complain(
                    place,
                    format!("the scene `{name}` has no [{table}]"),
                    "its body is the unit square, points on the regular lattice; what it does stands in the table \
                     [manufactured]: amplitudes, frequency, pressure",
                );
            }
        }
        let Some(table) = &file.manufactured else { return Vec::new() };
        for (key, typed) in &table.get_ref().inputs {
            self.moves_by(key, typed.span(), seed.scene);
        }
        self.inputs("manufactured", &table.get_ref().inputs, seed)
    }

    /// Complains where a motion has no such amplitude.
    fn moves_by(&mut self, key: &Key, place: Range<usize>, scene: SceneKind) {
        if let Some(why) = scene.refuses_input_of_motion(key.name) {
            self.complain(place, format!("the scene `{}` has no `{}`", scene.name(), key.name), why);
        }
    }

    /// Complains where a sweep names an input of another kind of body: a width of a layer, a base of a column.
    pub(crate) fn geometry_is_the_scenes(&mut self, table: &SweepTable, scene: SceneKind) {
        let own = scene.table_of_geometry();
        let is_foreign = |key: &Key| {
            let of_geometry =
                ["column", "layer", "manufactured"].iter().any(|table| key.tables.contains(table));
            let of_points = scene.is_manufactured() && key.tables.contains(&"points");
            of_points || of_geometry && !key.tables.contains(&own)
        };
        for (key, list) in &table.inputs {
            self.moves_by(key, list.span(), scene);
            if is_foreign(key) {
                let names: Vec<&str> = Key::of(own).map(|key| key.name).collect();
                self.complain(
                    list.span(),
                    format!("the scene `{}` has no `{}`", scene.name(), key.name),
                    if scene.is_manufactured() {
                        format!(
                            "its points begin on the regular lattice of the unit square; it has {}",
                            names.join(", ")
                        )
                    } else {
                        format!("its geometry and load are {}", names.join(", "))
                    },
                );
            }
        }
    }

    /// A load that would press out more water than the pores hold has no end state: the exact
    /// solutions say so before anything runs.
    pub(crate) fn porosity_at_the_end(&mut self, file: &StudyFile, base: &Case) {
        let Case { scene, column, material: soil, .. } = base;
        if !scene.is_large_strain() || scene.is_manufactured() || !self.diagnostics.is_empty() {
            return;
        }
        let parameters = column_parameters(column, soil);
        if let Err(error @ ExactError::LoadClosesPores { limit, .. }) = XieLeo::new(&parameters) {
            if let Some(strain) = &file.column.strain {
                let (value, porosity) = (strain.get_ref(), soil.porosity);
                self.complain(
                    strain.span(),
                    format!("a strain of {value} leaves no pores: the porosity is {porosity}"),
                    format!("write `strain` below {porosity}, or in [material] a `porosity` above {value}"),
                );
                return;
            }
            let typed = file.column.typed("load").or(file.material.typed("porosity"));
            let typed = typed.or(file.material.typed("youngs_modulus")).map(Spanned::span);
            let most = limit * soil.oedometric_modulus();
            let least = -elementary::exp_m1(-column.load / soil.oedometric_modulus());
            self.complain(
                typed.unwrap_or_else(|| file.scene.span()),
                error.to_string(),
                format!("load less than {most:.4e} Pa, or give a porosity above {least:.4}"),
            );
        }
    }

    /// A load under which a theory of small strain is off by more than a percent.
    pub(crate) fn large_for_small_strain(&mut self, file: &StudyFile, planned: &[PlannedCase]) {
        let small = planned.iter().map(|planned| &planned.case).filter(|case| !case.scene.is_large_strain());
        let strains = small.map(|case| case.column.load / case.material.oedometric_modulus());
        let strain = strains.fold(0.0, f64::max);
        if strain <= LARGEST_SMALL_STRAIN {
            return;
        }
        let typed = file.column.typed("load").or(file.material.typed("youngs_modulus")).map(Spanned::span);
        let diagnostic = Diagnostic::at(
            typed.unwrap_or_else(|| file.scene.span()),
            format!(
                "the load strains the column by m_vl q = {strain:.2e}: real soil is off this scene's small-strain \
                 theory by a share of that size"
            ),
            "the errors printed are against small-strain theory all the same; the scene `xie-leo` is of large strain",
        );
        self.warnings.push(diagnostic.warning(&self.source.name, &self.source.text));
    }
}
