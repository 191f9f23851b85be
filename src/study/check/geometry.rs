//! Checks geometry, material and loads: the tables `[column]`, `[layer]`, `[manufactured]` and `[material]`.

use crate::case::{Case, Key, PlannedCase, Task, Value};
use crate::study::check::{Checker, Purpose};
use crate::study::diagnostic::Diagnostic;
use crate::study::file::{InputTable, StudyFile};
use crate::study::inputs::{Inputs, TypedInput};
use crate::study::reading::{Placed, Typed};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_scenes::column::column_parameters;
use oedometer_scenes::scene::{Body, Clock};
use oedometer_scenes::{SCENES, Scene};
use oedometer_soil::layers::{MOST_LAYERS, SoilLayer, SoilLayers};
use oedometer_wording::rounded;
use std::ops::Range;

/// Young's moduli of soils, from soft peat to rock, Pa.
const SOIL_MODULUS: [f64; 2] = [1e4, 1e11];

/// Hydraulic conductivities of soils, from clay to coarse gravel, m/s.
const SOIL_CONDUCTIVITY: [f64; 2] = [1e-14, 0.3];

/// A number of a soil.
type SoilNumber = fn(&oedometer_soil::material::Material) -> f64;

/// Final strain `m_vl q` up to which small-strain theory is taken without a warning.
const LARGEST_SMALL_STRAIN: f64 = 1e-2;
/// Share of a wave's speed below which a projection is warned of.
const LEAST_WAVE_SPEED: f64 = 0.9;

/// Share by which a strain may miss the one that its load was made of.
const ROUND_OFF: f64 = 1e-12;

/// Problems that a diagnostic lists.
const MOST_LISTED: usize = 4;

/// Share of the load by which the base of a column may change the pressures of a front in a half-space.
const MOST_FELT_OF_BASE: f64 = 1e-2;

/// Values outside the range of any soil, usually a unit mistake: key, range, message, help.
const UNIT_MISTAKES: [(&str, Range<f64>, &str, &str); 3] = [
    (
        "hydraulic_conductivity",
        10.0..f64::INFINITY,
        "no soil has a hydraulic conductivity of {} m/s",
        "give metres per second: gravel has 1e-2, clay 1e-10",
    ),
    (
        "youngs_modulus",
        f64::MIN_POSITIVE..1e2,
        "no soil has a Young's modulus of {} Pa",
        "write it with its unit, like \"5 MPa\", or in pascals, like 5.0e6",
    ),
    (
        "water_bulk_modulus",
        f64::MIN_POSITIVE..1e3,
        "no liquid has a bulk modulus of {} Pa",
        "write it with its unit, like \"2.2 GPa\", or in pascals: water has 2.2e9",
    ),
];

/// What is said of a key or table that a problem does not have: which problems have it, or what this one has instead.
fn elsewhere(key: &str, scene: &Scene) -> String {
    let takers: Vec<String> = SCENES.into_iter().filter(|other| other.takes(key)).map(quoted).collect();
    match takers.as_slice() {
        [] => contents_of(scene),
        takers if takers.len() > MOST_LISTED => contents_of(scene),
        [only] => format!("only {only} has it"),
        [others @ .., last] => format!("{} and {last} have it", others.join(", ")),
    }
}

fn quoted(scene: &Scene) -> String {
    format!("\"{}\"", scene.name)
}

/// What belongs in the table of a problem's geometry.
fn contents_of(scene: &Scene) -> String {
    let table = scene.body.table();
    let keys: Vec<&str> = Key::in_table(table).map(|key| key.name).filter(|key| scene.takes(key)).collect();
    format!("the geometry and load of `{}` are in [{table}]: {}", scene.name, keys.join(", "))
}

impl Checker<'_> {
    /// The inputs of the table that the scene's geometry stands in; other tables of geometry are refused.
    pub(super) fn geometry(&mut self, file: &StudyFile, seed: &Case) -> Vec<(&'static Key, Value)> {
        let (scene, own) = (seed.scene, seed.scene.body.table());
        let of_table = |table: &Typed<InputTable>| table.as_ref().map(Placed::span);
        let strain = file.column.strain.as_ref().map(Placed::span).filter(|_| scene.body == Body::Square);
        let of_points = file.points.inputs.first_span().filter(|_| !scene.takes("points"));
        for (table, place) in [
            ("column", file.column.inputs.first_span().or(strain)),
            ("layer", of_table(&file.layer)),
            ("manufactured", of_table(&file.manufactured)),
            ("points", of_points),
        ] {
            if let Some(place) = place.filter(|_| table != own) {
                let message = format!("the problem `{}` has no [{table}]", scene.name);
                self.complain(place, message, contents_of(scene));
            }
        }
        let inputs = match own {
            "layer" => file.layer.as_ref().map(|table| &table.inputs),
            "manufactured" => file.manufactured.as_ref().map(|table| &table.inputs),
            _ => Some(&file.column.inputs),
        };
        self.problem_takes(&file.material.inputs, scene);
        let Some(inputs) = inputs else { return Vec::new() };
        self.problem_takes(inputs, scene);
        self.column_is_possible(inputs, seed);
        self.inputs(own, inputs, seed)
    }

    /// Complains of each key that other problems have and this one has not: of its geometry, its history and its points.
    pub(super) fn problem_takes(&mut self, inputs: &Inputs, scene: &Scene) {
        for (key, typed) in &inputs.0 {
            let name = if key.tables.contains(&"points") { "points" } else { key.name };
            let is_of_problems = SCENES.into_iter().any(|other| other.takes(name));
            if is_of_problems && !scene.takes(name) {
                let message = format!("the problem `{}` has no `{}`", scene.name, key.name);
                self.complain(typed.span(), message, elsewhere(name, scene));
            }
        }
    }

    /// Complains of values of `[column]` that the problem or its task cannot have.
    fn column_is_possible(&mut self, inputs: &Inputs, seed: &Case) {
        let is =
            |key: &str, wanted: fn(&TypedInput) -> bool| inputs.typed(key).is_some_and(|typed| wanted(typed));
        for (key, is_refused, message, help) in [
            (
                "self_weight",
                seed.task == Task::Stability
                    && is("self_weight", |typed| matches!(typed, TypedInput::Flag(true))),
                "self-weight does not change the critical step: it is that of the weightless column"
                    .to_owned(),
                "leave `self_weight` out of a study of stability",
            ),
            (
                "dimensions",
                seed.scene.body != Body::Column
                    && is("dimensions", |typed| !matches!(typed, TypedInput::Count(2))),
                format!("`{}` has two dimensions", seed.scene.name),
                "leave the key out: the plate presses perpendicular to the flow of the water",
            ),
        ] {
            if let Some(place) = inputs.span(key).filter(|_| is_refused && seed.scene.takes(key)) {
                self.complain(place, message, help);
            }
        }
    }

    /// The layers of `[[column.soils]]`, where the scene takes them; a sweep may still give their soils what they do not
    /// name.
    pub(super) fn soils(&mut self, file: &StudyFile, base: &Case) -> SoilLayers {
        let typed = &file.column.soils;
        let (Some(first), Some(last)) = (typed.first(), typed.last()) else { return SoilLayers::default() };
        let whole = first.span().start..last.span().end;
        let list: Vec<SoilLayer> = typed.iter().map(|layer| **layer).collect();
        let height = base.column.height;
        for (number, layer) in typed.iter().enumerate() {
            let soil = layer.soil(&base.material);
            let column = ColumnParameters { height: layer.thickness, soil, ..ColumnParameters::default() };
            if let Err(error) = column.validate() {
                let message = error.to_string().replace("the height", "the thickness");
                let layer_number = number + 1;
                let help =
                    format!("it is layer {layer_number} from the base: see [column.soils] and [material]");
                self.complain(layer.span(), message, help);
            }
        }
        if !base.scene.takes("soils") {
            self.complain(
                whole,
                format!("the problem `{}` has no `soils`", base.scene.name),
                elsewhere("soils", base.scene),
            );
            return SoilLayers::default();
        }
        let Some(layers) = SoilLayers::from_slice(&list) else {
            let count = list.len();
            self.complain(
                whole,
                format!("{count} layers of soil"),
                format!("at most {MOST_LAYERS} are allowed"),
            );
            return SoilLayers::default();
        };
        if let Some(sum) = layers.misses(height) {
            let error = ExactError::LayersDoNotFill { sum, height };
            let (thickness, rest) = (last.thickness, height - sum);
            let help = if thickness + rest > 0.0 {
                format!(
                    "make the last layer {} m thick, or the column {sum} m high",
                    rounded(thickness + rest)
                )
            } else {
                format!("make the column {sum} m high, or the layers thinner")
            };
            self.complain(whole, error.to_string(), help);
        }
        layers
    }

    /// Refuses values outside the range of any soil; where nothing is solved the problem may be dimensionless, and
    /// it warns.
    pub(super) fn units_are_si(&mut self, material: &Inputs) {
        for (name, strange, message, help) in UNIT_MISTAKES {
            let Some(typed) = material.typed(name) else { continue };
            if let TypedInput::Number(number) = &**typed
                && strange.contains(number)
            {
                let message = message.replace("{}", &number.to_string());
                if self.purpose == Purpose::Theory {
                    let help = format!("in a dimensionless problem it is right; otherwise {help}");
                    self.warn(&Diagnostic::at(typed.span(), message, help));
                } else {
                    self.complain(typed.span(), message, help);
                }
            }
        }
    }

    /// The strain that a study gives in place of its load.
    pub(super) fn given_strain(&mut self, file: &StudyFile, seed: &Case) -> Option<f64> {
        let typed = file.column.strain.as_ref()?;
        let has_load = file.column.inputs.typed("load").is_some()
            || file.sweep.iter().any(|block| block.inputs.typed("load").is_some());
        let (message, help) = if !file.column.soils.is_empty() {
            ("the layers of a column have different strains".to_owned(), "give a `load`")
        } else if has_load {
            (
                "the column has a `load` and a `strain`".to_owned(),
                "leave one of them out: each determines the other",
            )
        } else if !seed.scene.is_loaded() {
            (
                format!("no load acts in the problem `{}`, so it has no strain", seed.scene.name),
                "leave `strain` out",
            )
        } else if **typed > 0.0 && **typed < 1.0 {
            return Some(**typed);
        } else {
            (
                format!("`column.strain` is {}", **typed),
                "it is the shortening over the height: between 0 and 1, both excluded",
            )
        };
        self.complain(typed.span(), message, help);
        None
    }

    /// Complains of a case whose pores would close before its end, where its load is typed, and of a motion that cannot
    /// be. Whether it did.
    pub(super) fn has_no_end(&mut self, place: &Range<usize>, load: &Range<usize>, case: &Case) -> bool {
        if let Some(error) = case.scene.refuses_motion(&case.column, &case.material) {
            let help = "the case is impossible: see the tables [manufactured] and [material]";
            self.complain(place.clone(), error.to_string(), help);
            return true;
        }
        if case.scene.clock == Clock::HalfSpace && self.has_no_front(place, case) {
            return true;
        }
        let is_loaded = case.scene.is_large_strain() && case.scene.motion.is_none();
        if is_loaded && !case.column.soils.is_empty() {
            let kind = case.scene.references[0].kind.for_soil(&case.material);
            let reference = Reference::new(kind, &column_parameters(&case.column, &case.material), &[]);
            if let Err(error) = &reference {
                self.complain(load.clone(), error.to_string(), "see [column], [column.soils] and [material]");
            }
            return reference.is_err();
        }
        let (soil, strain) = (&case.material, final_strain(case));
        if !is_loaded || strain < (1.0 - ROUND_OFF) * soil.porosity {
            return false;
        }
        self.complain(
            load.clone(),
            format!(
                "with E = {} Pa, ν = {} and n = {} the load {} Pa strains the column by {}: the pores close at {}",
                rounded(soil.youngs_modulus),
                soil.poissons_ratio,
                soil.porosity,
                rounded(case.column.load),
                rounded(strain),
                soil.porosity
            ),
            format!(
                "use a load below {} Pa, or instead of it a `strain` in [column] below {}",
                rounded(load_of(soil.porosity, case)),
                soil.porosity
            ),
        );
        true
    }

    /// Complains of a column in which no yield front runs, or whose base it has reached. Whether it did.
    fn has_no_front(&mut self, place: &Range<usize>, case: &Case) -> bool {
        let parameters = column_parameters(&case.column, &case.material);
        let last = case.time_factors.last().copied().unwrap_or(0.0);
        let bound = Reference::new(ReferenceKind::YieldFront, &parameters, &[])
            .and_then(|front| Ok(front.accuracy(last)?.bound()));
        let (message, help) = match bound {
            Ok(bound) if bound <= MOST_FELT_OF_BASE => return false,
            Ok(bound) => (
                format!(
                    "the solution is for a half-space, but at T_v = {last} the base may change the \
                     pressures by {bound:.1e} of the load"
                ),
                "ask for earlier time factors".to_owned(),
            ),
            Err(error) => (error.to_string(), "see [column] and [material]".to_owned()),
        };
        self.complain(place.clone(), message, help);
        true
    }

    /// Asks where a number without a unit is likely to be in another one: a stiffness below the load, a load of some pascals, a
    /// height of hundreds of metres, and a bound of 100 %.
    pub(super) fn units_are_meant(&mut self, file: &StudyFile, planned: &[PlannedCase]) {
        let Some(case) = planned.first().map(|planned| &planned.case) else { return };
        if case.scene.motion.is_some() {
            return;
        }
        let plain = |inputs: &Inputs, key: &str| {
            let span = inputs.span(key)?;
            let typed = self.source.text.get(span.clone())?.trim().to_owned();
            let is_plain = typed.parse::<f64>().is_ok();
            is_plain.then_some((span, typed))
        };
        let load = case.column.load;
        let questions = [
            (
                plain(&file.material.inputs, "youngs_modulus"),
                2.0 * case.material.youngs_modulus < load,
                "kPa",
            ),
            (plain(&file.column.inputs, "load"), (5.0..1000.0).contains(&load), "kPa"),
            (plain(&file.column.inputs, "height"), (100.0..=5000.0).contains(&case.column.height), "mm"),
        ];
        let asked = questions.into_iter().filter(|(_, is_odd, _)| *is_odd);
        let asked: Vec<_> = asked.filter_map(|(typed, _, unit)| Some((typed?, unit))).collect();
        for ((span, typed), unit) in asked {
            let si = if unit == "mm" { "m" } else { "Pa" };
            self.warn(&Diagnostic::at(
                span,
                format!("a number without a unit is in {si}: {typed} {si} is unusual for the other inputs"),
                format!("did you mean \"{typed} {unit}\"? Write \"{typed} {si}\" if not"),
            ));
        }
    }

    /// Warns of a load under which a theory of small strain is off by more than a percent.
    pub(super) fn large_for_small_strain(&mut self, file: &StudyFile, planned: &[PlannedCase]) {
        let small = planned.iter().map(|planned| &planned.case).filter(|case| !case.scene.is_large_strain());
        // Of layers the softest strains most.
        let strains = small.flat_map(|case| {
            let load = case.column.load;
            case.soils().iter().map(|(_, soil)| load / soil.oedometric_modulus()).collect::<Vec<_>>()
        });
        let strain = strains.fold(0.0, f64::max);
        if strain <= LARGEST_SMALL_STRAIN {
            return;
        }
        let place = file.column.inputs.span("load").or(file.material.inputs.span("youngs_modulus"));
        let diagnostic = Diagnostic::at(
            place.unwrap_or_else(|| file.scene.span()),
            format!(
                "the load strains the column by m_vl q = {strain:.2e}: this problem uses small-strain \
                 theory, from which real soil departs by about that fraction"
            ),
            "the errors are taken against small-strain theory; `xie-leo` is the problem at large strain",
        );
        self.warn(&diagnostic);
    }

    /// Warns of a stiffness or a conductivity that no soil has: a number in another unit.
    pub(super) fn unlike_any_soil(&mut self, file: &StudyFile, planned: &[PlannedCase]) {
        // A manufactured motion has numbers of its own scale.
        if planned.iter().any(|planned| planned.case.scene.motion.is_some()) {
            return;
        }
        let soils = || planned.iter().flat_map(|planned| planned.case.soils());
        let ranges: [(&str, &str, [f64; 2], &str, SoilNumber); 2] = [
            ("youngs_modulus", "Pa", SOIL_MODULUS, "kPa or MPa", |soil| soil.youngs_modulus),
            ("hydraulic_conductivity", "m/s", SOIL_CONDUCTIVITY, "m/d or cm/s", |soil| {
                soil.hydraulic_conductivity
            }),
        ];
        for (key, unit, [least, most], other, of) in ranges {
            let numbers = soils().map(|(_, soil)| of(&soil)).filter(|value| !(least..=most).contains(value));
            let Some(odd) = numbers.reduce(f64::max) else { continue };
            // Said already.
            if UNIT_MISTAKES.iter().any(|(name, strange, ..)| *name == key && strange.contains(&odd)) {
                continue;
            }
            let place = file.material.inputs.span(key).unwrap_or_else(|| file.scene.span());
            self.warn(&Diagnostic::at(
                place,
                format!(
                    "`{key}` = {} {unit} is outside the range of soils, {} to {} {unit}",
                    rounded(odd),
                    rounded(least),
                    rounded(most)
                ),
                format!("write the unit if it is {other}, as in \"5 MPa\" or \"1e-9 m/s\""),
            ));
        }
    }

    /// Warns of a pressure projection that slows the waves that a scene is about.
    pub(super) fn projection_slows_waves(&mut self, file: &StudyFile, planned: &[PlannedCase]) {
        let cases = planned.iter().map(|planned| &planned.case).filter(|case| case.scene.waves);
        let shares = cases.filter_map(|case| {
            let method = case.method.built_in()?;
            let share = method.share_of_wave_speed(&case.material, case.cells);
            Some((share, method, case.cells))
        });
        let slowest =
            shares.filter(|(share, ..)| *share < LEAST_WAVE_SPEED).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((share, method, cells)) = slowest else { return };
        let message = format!(
            "the pressure projection of `{method}` stores more than the water: on {cells} cells the longest wave travels at \
             {:.0} % of its speed",
            100.0 * share
        );
        self.warn(&Diagnostic::at(
            file.scene.span(),
            message,
            "its errors are those of slower waves; use a method without a projection, or more cells",
        ));
    }
}

/// Load, Pa, under which a case ends with a vertical strain, by the law of its soil.
pub(super) fn load_of(strain: f64, case: &Case) -> f64 {
    let soil = &case.material;
    let compression =
        if case.scene.is_large_strain() { -soil.law.uniaxial_stress_ratio(-strain) } else { strain };
    soil.oedometric_modulus() * compression
}

/// Vertical strain at the end of a case, by the law of its soil.
pub(super) fn final_strain(case: &Case) -> f64 {
    case.material.law.shrinkage(case.column.load / case.material.oedometric_modulus())
}
