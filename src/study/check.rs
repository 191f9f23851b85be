//! From what was typed to what will run: every value judged, every complaint at its place.

mod case;

use super::case::{Case, Task};
use super::diagnostic::{Diagnostic, StudyError, one_of};
use super::expectation::{Axis, Expectation, Measure, NEXT_FINER};
use super::file::{
    ColumnTable, ExpectTable, IntegratorTable, LayerTable, LevelTable, MaterialTable, MethodEntry,
    MethodTable, OutputTable, StudyFile, StudySource, SweepTable, TimeStepTable,
};
use super::sweep::{AXES, Combination, Sweep};
use crate::assess::case_expectation::CaseExpectation;
use crate::assess::class::Class;
use crate::assess::expectation::{Band, ErrorBound, Expectation as Demand, FloorBand, KnownFailure};
use crate::assess::norms::Norm;
use crate::exact::cosine_layer::Base;
use crate::exact::xie_leo::XieLeo;
use crate::exact::{ExactError, ReferenceKind};
use crate::record::{Quantity, Record, Sample};
use crate::scene::{Arrangement, Column, SceneKind, column_parameters};
use crate::solver::explicit::{Drag, ExplicitSettings};
use crate::solver::integrator::{Formulation, IntegratorKind};
use crate::solver::material::{Continuity, Law, Material};
use crate::solver::method::{
    Basis, Configuration, Memory, Method, PressureIntegration, Recovery, StrainGradient,
};
use crate::solver::run::TimeStepRule;
use crate::solver::scheme::Scheme;
use std::ops::{Range, RangeInclusive};
use toml::Spanned;

/// Time factors where a study names none.
const DEFAULT_TIME_FACTORS: [f64; 5] = [0.05, 0.1, 0.2, 0.5, 1.0];
/// Longest wall time of a case, s, where a study names none.
const DEFAULT_CASE_SECONDS: f64 = 3600.0;
/// Half-width of an order's band where an expectation names none.
const DEFAULT_BAND: f64 = 0.1;
/// Final strain `m_vl q` up to which small-strain theory is taken without a word.
const LARGEST_SMALL_STRAIN: f64 = 1e-2;
/// More cells than a column is ever given on purpose.
const MOST_CELLS: i64 = 100_000;
/// More points a cell and direction than any scheme uses.
const MOST_POINTS: i64 = 16;

/// How much of a study is run: a tier includes those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// Seconds.
    Smoke,
    /// What a CI runs.
    #[default]
    Ci,
    /// Everything.
    Full,
}

impl Tier {
    /// Every tier, the smallest first.
    pub const ALL: [Self; 3] = [Self::Smoke, Self::Ci, Self::Full];

    /// Name in study files and at the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smoke => "smoke",
            Self::Ci => "ci",
            Self::Full => "full",
        }
    }
}

/// A case with the tier from which on it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedCase {
    /// What to run.
    pub case: Case,
    /// Smallest tier that includes it.
    pub tier: Tier,
}

/// A study that can run.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// File stem, the name of its results.
    pub name: String,
    /// Title.
    pub title: String,
    /// What question it answers.
    pub summary: String,
    /// Scene.
    pub scene: SceneKind,
    /// References its results are held against.
    pub references: Vec<ReferenceKind>,
    /// Cases in the order of the sweeps, each once.
    pub planned: Vec<PlannedCase>,
    /// What it expects of its results.
    pub expectations: Vec<Expectation>,
    /// What it expects of single cases.
    pub case_expectations: Vec<CaseExpectation>,
    /// Longest wall time of a case, s.
    pub case_seconds: f64,
    /// Times each case is run alone for its wall time; 0 where it is not timed.
    pub timing_repeats: usize,
    /// What is odd and runs all the same, as a person reads it.
    pub warnings: Vec<String>,
}

impl Study {
    /// Checks a study.
    ///
    /// # Errors
    /// Every complaint with its place.
    pub fn check(source: &StudySource) -> Result<Self, StudyError> {
        Self::check_for(source, Purpose::Solving)
    }

    /// Checks a study for a purpose.
    ///
    /// # Errors
    /// Every complaint with its place.
    pub fn check_for(source: &StudySource, purpose: Purpose) -> Result<Self, StudyError> {
        let file = source.parse()?;
        let mut checker = Checker { source, diagnostics: Vec::new(), column_height: None, purpose };
        let study = checker.study(&file);
        match study {
            Some(study) if checker.diagnostics.is_empty() => Ok(study),
            _ => Err(source.error(checker.diagnostics)),
        }
    }

    /// Whether an expectation says that a record is to end as it did.
    pub fn foresees(&self, record: &Record) -> bool {
        self.case_expectations.iter().any(|expectation| expectation.foresees(record))
    }

    /// The cases of a tier.
    pub fn cases(&self, tier: Tier) -> Vec<&Case> {
        self.planned.iter().filter(|planned| planned.tier <= tier).map(|planned| &planned.case).collect()
    }
}

/// What a study is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Its cases are to be solved.
    Solving,
    /// Only its problem is wanted, for an exact solution: no grid has to fit it.
    Theory,
}

/// What the cases of a study share where a sweep does not say otherwise.
#[derive(Clone, Copy)]
struct Common {
    task: Task,
    scene: SceneKind,
    column: Column,
    soil: Material,
    settings: ExplicitSettings,
    formulation: Option<Formulation>,
}

impl Common {
    /// The case of one combination of a sweep.
    fn case_of(&self, one: &Combination, time_factors: &[f64]) -> Case {
        Case {
            task: self.task,
            scene: self.scene,
            column: Column {
                points: Arrangement { offset: one.offset, ..self.column.points },
                ..self.column
            },
            material: Material {
                law: one.law,
                continuity: one.continuity,
                hydraulic_conductivity: one.hydraulic_conductivity,
                water_bulk_modulus: one.water_bulk_modulus,
                porosity: one.porosity,
                poissons_ratio: one.poissons_ratio,
                ..self.soil
            },
            method: one.method,
            integrator: one.integrator,
            formulation: one.formulation,
            settings: ExplicitSettings {
                scheme: one.scheme,
                drag: one.drag,
                flip: one.flip,
                mapping_back: one.mapping_back,
            },
            cells: one.cells,
            points_per_cell: one.points_per_cell,
            time_step: one.time_step,
            time_factors: time_factors.to_vec(),
        }
    }
}

/// Complaints as they come up; every method gives a usable value or none.
struct Checker<'a> {
    source: &'a StudySource,
    diagnostics: Vec<Diagnostic>,
    /// Height by which the levels of expectations are sized, once it is known.
    column_height: Option<f64>,
    purpose: Purpose,
}

impl Checker<'_> {
    fn complain(&mut self, span: Range<usize>, message: impl Into<String>, help: impl Into<String>) {
        self.diagnostics.push(Diagnostic::at(span, message, help));
    }

    fn study(&mut self, file: &StudyFile) -> Option<Study> {
        let scene = self.scene(&file.scene)?;
        let column = Column { points: self.arrangement(&file.points), ..self.geometry(file, scene) };
        self.column_height = Some(column.height);
        let material = self.material(&file.material, scene);
        self.porosity_at_the_end(file, scene, &column, &material);
        let warnings = self.large_for_small_strain(file, scene, &column, &material).into_iter().collect();
        let task = self.task(file)?;
        let settings = self.settings(&file.integrator);
        let typed = file.integrator.formulation.as_ref().and_then(|word| self.formulation(word));
        let formulation = typed.or(scene.has_waves().then_some(Formulation::VW));
        let common = Common { task, scene, column, soil: material, settings, formulation };
        let time_factors = match &file.output.time_factors {
            Some(list) => self.time_factors(list),
            None => DEFAULT_TIME_FACTORS.to_vec(),
        };
        let references = self.references(&file.output, scene);
        if file.sweep.is_empty() {
            let end = self.source.text.trim_end().len();
            let last_line = self.source.text[..end].rfind('\n').map_or(0, |newline| newline + 1);
            self.complain(
                last_line..end,
                "the study ends here without a [[sweep]] block",
                "add one with at least `method` and `cells`",
            );
        }
        let mut planned: Vec<PlannedCase> = Vec::new();
        for block in &file.sweep {
            let table = block.get_ref();
            let Some(sweep) = self.sweep(table, block.span(), &common) else { continue };
            if self.purpose == Purpose::Solving {
                self.cells_fill_the_width(table, &column);
            }
            let time_factors = match &table.time_factors {
                Some(list) => self.time_factors(list),
                None => time_factors.clone(),
            };
            let tier = self.tier(table);
            for one in sweep.combinations() {
                let case = common.case_of(&one, &time_factors);
                match planned.iter_mut().find(|other| other.case == case) {
                    Some(other) => other.tier = other.tier.min(tier),
                    None => planned.push(PlannedCase { case, tier }),
                }
            }
        }
        let expectations =
            file.expect.iter().filter_map(|entry| self.expectation(entry, scene, &references)).collect();
        let case_expectations = self.case_expectations(file, scene, &references);
        let case_seconds =
            self.positive(file.case_seconds.as_ref(), "case_seconds", "s", DEFAULT_CASE_SECONDS);
        let timing_repeats =
            self.count(file.timing.repeats.as_ref(), "timing.repeats", 0..=1000).unwrap_or(0);
        Some(Study {
            name: self.stem(),
            title: file.title.get_ref().clone(),
            summary: file.summary.clone().unwrap_or_default(),
            scene,
            references,
            planned,
            expectations,
            case_expectations,
            case_seconds,
            timing_repeats,
            warnings,
        })
    }

    /// File name without folders and extension.
    fn stem(&self) -> String {
        let file = self.source.name.rsplit(['/', '\\']).next().unwrap_or_default();
        file.strip_suffix(".toml").unwrap_or(file).to_owned()
    }

    fn scene(&mut self, typed: &Spanned<String>) -> Option<SceneKind> {
        let names = SceneKind::ALL.map(SceneKind::name);
        let index = self.word(typed, "scene", &names)?;
        Some(SceneKind::ALL[index])
    }

    /// The column's or the layer's table, whichever the scene is about; the other is refused.
    fn geometry(&mut self, file: &StudyFile, scene: SceneKind) -> Column {
        if scene.is_plane() {
            if let Some(span) = file.column.typed() {
                let name = scene.name();
                self.complain(
                    span,
                    format!("the scene `{name}` has no [column]"),
                    "its geometry and load stand in the table [layer]: length, height, base, load",
                );
            }
            return self.layer(file.layer.as_ref().map(Spanned::get_ref));
        }
        if let Some(layer) = &file.layer {
            self.complain(
                layer.span(),
                format!("the scene `{}` has no [layer]", scene.name()),
                "its geometry and load stand in the table [column]: height, width, load, dimensions",
            );
        }
        self.column(&file.column, scene)
    }

    fn layer(&mut self, table: Option<&LayerTable>) -> Column {
        let seed = Column::layer();
        let Some(table) = table else { return seed };
        let base = table.base.as_ref().and_then(|word| self.word(word, "base", &Base::ALL.map(Base::name)));
        Column {
            height: self.positive(table.height.as_ref(), "layer.height", "m", seed.height),
            width: self.positive(table.length.as_ref(), "layer.length", "m", seed.width),
            load: self.positive(table.load.as_ref(), "layer.load", "Pa", seed.load),
            base: base.map_or(seed.base, |index| Some(Base::ALL[index])),
            ..seed
        }
    }

    fn column(&mut self, table: &ColumnTable, scene: SceneKind) -> Column {
        let seed = Column::default();
        if let Some(typed) = table.loading_time.as_ref().filter(|_| scene != SceneKind::DynamicColumn) {
            self.complain(
                typed.span(),
                format!("the load of `{}` acts at once", scene.name()),
                "a load that grows belongs to the scene \"dynamic-column\"",
            );
        }
        Column {
            dimensions: self
                .count(table.dimensions.as_ref(), "column.dimensions", 1..=2)
                .unwrap_or(seed.dimensions),
            base: None,
            height: self.positive(table.height.as_ref(), "column.height", "m", seed.height),
            width: self.positive(table.width.as_ref(), "column.width", "m", seed.width),
            load: self.positive(table.load.as_ref(), "column.load", "Pa", seed.load),
            loading_time: self.not_negative(table.loading_time.as_ref(), "column.loading_time", "s"),
            points: Arrangement::default(),
        }
    }

    /// Square cells must fill the width: their number over the height decides their size.
    fn cells_fill_the_width(&mut self, table: &SweepTable, column: &Column) {
        for typed in table.cells.iter().flat_map(Spanned::get_ref) {
            let cells = usize::try_from(*typed.get_ref()).unwrap_or(0);
            if cells == 0 || column.cells_across(cells).is_some() {
                continue;
            }
            let size = column.height / cells as f64;
            self.complain(
                typed.span(),
                format!("square cells of {size} m do not fill a width of {} m", column.width),
                format!("a width of {size} m is one cell wide, or take a number of cells that divides it"),
            );
        }
    }

    fn material(&mut self, table: &MaterialTable, scene: SceneKind) -> Material {
        let seed = Material::default();
        let law = table.law.as_ref().and_then(|word| self.law(word, scene));
        let continuity = table.continuity.as_ref().and_then(|word| self.continuity(word));
        let soil = Material {
            law: law.unwrap_or(scene.default_law()),
            youngs_modulus: self.positive(
                table.youngs_modulus.as_ref(),
                "material.youngs_modulus",
                "Pa",
                seed.youngs_modulus,
            ),
            poissons_ratio: self.between(
                table.poissons_ratio.as_ref(),
                "material.poissons_ratio",
                -1.0,
                0.5,
                seed.poissons_ratio,
            ),
            porosity: self.between(table.porosity.as_ref(), "material.porosity", 0.0, 1.0, seed.porosity),
            grain_density: self.positive(
                table.grain_density.as_ref(),
                "material.grain_density",
                "kg/m³",
                seed.grain_density,
            ),
            water_density: self.positive(
                table.water_density.as_ref(),
                "material.water_density",
                "kg/m³",
                seed.water_density,
            ),
            water_bulk_modulus: self.positive(
                table.water_bulk_modulus.as_ref(),
                "material.water_bulk_modulus",
                "Pa",
                seed.water_bulk_modulus,
            ),
            hydraulic_conductivity: self.positive(
                table.hydraulic_conductivity.as_ref(),
                "material.hydraulic_conductivity",
                "m/s",
                seed.hydraulic_conductivity,
            ),
            gravity: self.positive(table.gravity.as_ref(), "material.gravity", "m/s²", seed.gravity),
            continuity: continuity.unwrap_or(seed.continuity),
        };
        self.units_of_thought(table);
        soil
    }

    fn law(&mut self, word: &Spanned<String>, scene: SceneKind) -> Option<Law> {
        let law = Law::ALL[self.word(word, "law", &Law::ALL.map(Law::name))?];
        if let Some(why) = scene.refuses_law(law) {
            let fit = Law::ALL.into_iter().filter(|law| scene.refuses_law(*law).is_none());
            let names: Vec<&str> = fit.map(Law::name).collect();
            self.complain(
                word.span(),
                why,
                format!("the scene `{}` takes {}", scene.name(), names.join(", ")),
            );
            return None;
        }
        Some(law)
    }

    fn continuity(&mut self, word: &Spanned<String>) -> Option<Continuity> {
        let index = self.word(word, "continuity", &Continuity::ALL.map(Continuity::name))?;
        Some(Continuity::ALL[index])
    }

    /// A load that would press out more water than the pores hold has no end state: the exact
    /// solutions say so before anything runs.
    fn porosity_at_the_end(&mut self, file: &StudyFile, scene: SceneKind, column: &Column, soil: &Material) {
        if scene != SceneKind::XieLeo || !self.diagnostics.is_empty() {
            return;
        }
        let parameters = column_parameters(column, soil);
        if let Err(error @ ExactError::LoadClosesPores { limit, .. }) = XieLeo::new(&parameters) {
            let typed = file.column.load.as_ref().or(file.material.porosity.as_ref());
            let typed = typed.or(file.material.youngs_modulus.as_ref()).map(Spanned::span);
            let most = limit * soil.oedometric_modulus();
            let least = -(-column.load / soil.oedometric_modulus()).exp_m1();
            self.complain(
                typed.unwrap_or_else(|| file.scene.span()),
                error.to_string(),
                format!("load less than {most:.4e} Pa, or give a porosity above {least:.4}"),
            );
        }
    }

    /// A load under which a theory of small strain is off by more than a percent.
    fn large_for_small_strain(
        &self,
        file: &StudyFile,
        scene: SceneKind,
        column: &Column,
        soil: &Material,
    ) -> Option<String> {
        let strain = column.load / soil.oedometric_modulus();
        if !scene.is_small_strain() || strain <= LARGEST_SMALL_STRAIN {
            return None;
        }
        let typed = file.column.load.as_ref().or(file.material.youngs_modulus.as_ref()).map(Spanned::span);
        let diagnostic = Diagnostic::at(
            typed.unwrap_or_else(|| file.scene.span()),
            format!(
                "the load strains the column by m_vl q = {strain:.2e}: real soil is off this scene's small-strain \
                 theory by a share of that size"
            ),
            "the errors printed are against small-strain theory all the same; the scene `xie-leo` is of large strain",
        );
        Some(diagnostic.warning(&self.source.name, &self.source.text))
    }

    /// Values that are legal numbers and no soil's: a unit of thought.
    fn units_of_thought(&mut self, table: &MaterialTable) {
        let rows = [
            (
                &table.hydraulic_conductivity,
                10.0..f64::INFINITY,
                "a hydraulic conductivity of {} m/s is no soil's",
                "give metres a second: gravel has 1e-2, clay 1e-10",
            ),
            (
                &table.youngs_modulus,
                f64::MIN_POSITIVE..1e2,
                "a Young's modulus of {} Pa is no soil's",
                "give pascals, not kPa or MPa: 1000 kPa is 1.0e6",
            ),
            (
                &table.water_bulk_modulus,
                f64::MIN_POSITIVE..1e3,
                "a bulk modulus of {} Pa is no liquid's",
                "give pascals: water has 2.2e9",
            ),
        ];
        for (typed, strange, message, help) in rows {
            if let Some(typed) = typed.as_ref().filter(|typed| strange.contains(typed.get_ref())) {
                self.complain(typed.span(), message.replace("{}", &typed.get_ref().to_string()), help);
            }
        }
    }

    fn settings(&mut self, table: &IntegratorTable) -> ExplicitSettings {
        let default = ExplicitSettings::default();
        ExplicitSettings {
            scheme: table.scheme.as_ref().and_then(|word| self.scheme(word)).unwrap_or(default.scheme),
            drag: table.drag.as_ref().and_then(|word| self.drag(word)).unwrap_or(default.drag),
            flip: table.flip.as_ref().map_or(default.flip, |flip| self.flip(flip)),
            mapping_back: table.mapping_back.as_ref().map_or(default.mapping_back, |typed| *typed.get_ref()),
        }
    }

    fn integrator(&mut self, word: &Spanned<String>) -> Option<IntegratorKind> {
        let index = self.word(word, "integrator", &IntegratorKind::ALL.map(IntegratorKind::name))?;
        Some(IntegratorKind::ALL[index])
    }

    fn formulation(&mut self, word: &Spanned<String>) -> Option<Formulation> {
        let index = self.word(word, "formulation", &Formulation::ALL.map(Formulation::name))?;
        Some(Formulation::ALL[index])
    }

    fn drag(&mut self, word: &Spanned<String>) -> Option<Drag> {
        Some(Drag::ALL[self.word(word, "drag", &Drag::ALL.map(Drag::name))?])
    }

    fn scheme(&mut self, word: &Spanned<String>) -> Option<Scheme> {
        Some(Scheme::ALL[self.word(word, "scheme", &Scheme::ALL.map(Scheme::name))?])
    }

    fn flip(&mut self, typed: &Spanned<f64>) -> f64 {
        let flip = *typed.get_ref();
        if !(0.0..=1.0).contains(&flip) {
            self.complain(
                typed.span(),
                format!("a FLIP share of {flip}"),
                "it lies between 0 (PIC) and 1 (FLIP)",
            );
        }
        flip
    }

    fn time_factors(&mut self, list: &Spanned<Vec<Spanned<f64>>>) -> Vec<f64> {
        if list.get_ref().is_empty() {
            self.complain(list.span(), "no time factor", "name at least one, like [0.05, 0.1, 0.2]");
        }
        let mut factors = Vec::new();
        for typed in list.get_ref() {
            let factor = *typed.get_ref();
            if factor.is_finite() && (0.0..=100.0).contains(&factor) {
                factors.push(factor);
            } else {
                self.complain(
                    typed.span(),
                    format!("a time factor of {factor}"),
                    "T_v = c_v t/H² lies between 0 and 100; the column is consolidated at 2",
                );
            }
        }
        factors.sort_by(f64::total_cmp);
        factors.dedup();
        factors
    }

    fn references(&mut self, table: &OutputTable, scene: SceneKind) -> Vec<ReferenceKind> {
        let own = scene.references();
        let Some(list) = &table.references else { return own.to_vec() };
        let names: Vec<&str> = own.iter().map(|kind| kind.name()).collect();
        list.get_ref()
            .iter()
            .filter_map(|typed| self.word(typed, "reference", &names))
            .map(|i| own[i])
            .collect()
    }

    fn tier(&mut self, table: &SweepTable) -> Tier {
        let names = Tier::ALL.map(Tier::name);
        let index = table.tier.as_ref().and_then(|word| self.word(word, "tier", &names));
        index.map_or(Tier::default(), |index| Tier::ALL[index])
    }

    fn sweep(&mut self, table: &SweepTable, span: Range<usize>, common: &Common) -> Option<Sweep> {
        let Common { scene, column, soil, settings, formulation, .. } = *common;
        let before = self.diagnostics.len();
        if table.method.is_none() {
            self.complain(
                span.start..span.start + 1,
                "the sweep names no method",
                "add `method = [\"GC-SRI-patch\"]`",
            );
        }
        if table.cells.is_none() {
            self.complain(
                span.start..span.start + 1,
                "the sweep names no cells",
                "add `cells = [5, 10, 20]`",
            );
        }
        let sweep = Sweep {
            method: self.list(table.method.as_ref(), "method", &[], |c, typed| {
                c.method(typed).filter(|method| c.configuration_fits(typed, scene, *method))
            }),
            integrator: self.list(
                table.integrator.as_ref(),
                "integrator",
                &[IntegratorKind::Explicit],
                Self::integrator,
            ),
            formulation: self.list(table.formulation.as_ref(), "formulation", &[formulation], |c, word| {
                c.formulation(word).map(Some)
            }),
            cells: self.list(table.cells.as_ref(), "cells", &[], |c, typed| {
                c.count(Some(typed), "cells", 1..=MOST_CELLS)
            }),
            points_per_cell: self.list(
                table.points_per_cell.as_ref(),
                "points_per_cell",
                &[2],
                |c, typed| c.count(Some(typed), "points_per_cell", 1..=MOST_POINTS),
            ),
            time_step: self.list(table.time_step.as_ref(), "time_step", &[None], |c, typed| {
                c.time_step(typed).map(Some)
            }),
            scheme: self.list(table.scheme.as_ref(), "scheme", &[settings.scheme], Self::scheme),
            drag: self.list(table.drag.as_ref(), "drag", &[settings.drag], Self::drag),
            flip: self.list(table.flip.as_ref(), "flip", &[settings.flip], |c, typed| Some(c.flip(typed))),
            mapping_back: self.list(
                table.mapping_back.as_ref(),
                "mapping_back",
                &[settings.mapping_back],
                |_, typed| Some(*typed.get_ref()),
            ),
            law: self.list(table.law.as_ref(), "law", &[soil.law], |c, word| c.law(word, scene)),
            porosity: self.list(table.porosity.as_ref(), "porosity", &[soil.porosity], |c, typed| {
                Some(c.between(Some(typed), "porosity", 0.0, 1.0, soil.porosity))
            }),
            hydraulic_conductivity: self.list(
                table.hydraulic_conductivity.as_ref(),
                "hydraulic_conductivity",
                &[soil.hydraulic_conductivity],
                |c, typed| {
                    let usual = soil.hydraulic_conductivity;
                    Some(c.positive(Some(typed), "hydraulic_conductivity", "m/s", usual))
                },
            ),
            water_bulk_modulus: self.list(
                table.water_bulk_modulus.as_ref(),
                "water_bulk_modulus",
                &[soil.water_bulk_modulus],
                |c, typed| Some(c.positive(Some(typed), "water_bulk_modulus", "Pa", soil.water_bulk_modulus)),
            ),
            offset: self.list(table.offset.as_ref(), "offset", &[column.points.offset], Self::offset),
            continuity: self.list(
                table.continuity.as_ref(),
                "continuity",
                &[soil.continuity],
                Self::continuity,
            ),
            poissons_ratio: self.list(
                table.poissons_ratio.as_ref(),
                "poissons_ratio",
                &[soil.poissons_ratio],
                |c, typed| Some(c.between(Some(typed), "poissons_ratio", -1.0, 0.5, 0.25)),
            ),
            path: self.list(table.path.as_ref(), "path", &[], |c, word| {
                c.word(word, "axis", &AXES).map(|index| AXES[index].to_owned())
            }),
        };
        if let (Some((key, own, first)), Some(path)) = (sweep.uneven_path(), &table.path) {
            self.complain(
                path.span(),
                format!("the path ties `{key}` with {own} values to an axis with {first}"),
                "give the axes of a path lists of one length",
            );
        }
        if self.diagnostics.len() == before {
            self.rules_fit(table, &sweep);
            self.formulations_fit(table, &span, &sweep, scene);
        }
        (self.diagnostics.len() == before).then_some(sweep)
    }

    /// Complains where a formulation meets an integrator that cannot solve it.
    fn formulations_fit(&mut self, table: &SweepTable, span: &Range<usize>, sweep: &Sweep, scene: SceneKind) {
        let refusal = |one: Combination| one.integrator.refuses_formulation(one.formulation);
        if let Some(why) = sweep.combinations().into_iter().find_map(refusal) {
            let place = table.formulation.as_ref().map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                why,
                "give each integrator a [[sweep]] block of its own, or leave `formulation` out",
            );
        }
        let still = |one: &Combination| one.formulation == Formulation::QuasiStatic;
        if scene.has_waves() && sweep.combinations().iter().any(still) {
            let place = table.formulation.as_ref().map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                format!("the quasi-static formulation leaves out the waves that `{}` is about", scene.name()),
                "take \"v-w\" or \"u-p\", or the scene \"terzaghi\"",
            );
        }
    }

    /// Complains where a step rule meets an integrator that cannot follow it.
    fn rules_fit(&mut self, table: &SweepTable, sweep: &Sweep) {
        let Some(list) = &table.time_step else { return };
        let refused =
            sweep.combinations().into_iter().find_map(|one| one.integrator.refuses_rule(one.time_step));
        if let Some(why) = refused {
            self.complain(
                list.span(),
                why,
                "give each integrator a [[sweep]] block of its own, or tie both axes with `path`",
            );
        }
    }

    /// A list of choices, or the default where it is not given; empty lists are refused.
    fn list<T, C: Clone>(
        &mut self,
        typed: Option<&Spanned<Vec<Spanned<T>>>>,
        name: &str,
        default: &[C],
        check: impl Fn(&mut Self, &Spanned<T>) -> Option<C>,
    ) -> Vec<C> {
        let Some(list) = typed else { return default.to_vec() };
        if list.get_ref().is_empty() {
            self.complain(
                list.span(),
                format!("`{name}` is empty"),
                "give at least one value, or leave the key out",
            );
        }
        list.get_ref().iter().filter_map(|one| check(self, one)).collect()
    }

    fn method(&mut self, typed: &Spanned<MethodEntry>) -> Option<Method> {
        match typed.get_ref() {
            MethodEntry::Name(name) => {
                let method = Method::named(name);
                if method.is_none() {
                    let names = Method::names();
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    self.complain(
                        typed.span(),
                        format!("no method is called `{name}`"),
                        one_of(name, &names),
                    );
                }
                method
            }
            MethodEntry::Choices(table) => self.method_of_choices(table, typed.span()),
        }
    }

    /// Whether a scene takes the configuration that a method insists on.
    fn configuration_fits(&mut self, typed: &Spanned<MethodEntry>, scene: SceneKind, method: Method) -> bool {
        let refused =
            method.configuration.and_then(|configuration| scene.refuses_configuration(configuration));
        if let Some(why) = refused {
            let place = match typed.get_ref() {
                MethodEntry::Choices(table) => table.configuration.as_ref().map(Spanned::span),
                MethodEntry::Name(_) => None,
            };
            self.complain(
                place.unwrap_or_else(|| typed.span()),
                why,
                "take \"updated\" or \"total\", or leave the key out",
            );
        }
        refused.is_none()
    }

    fn method_of_choices(&mut self, table: &MethodTable, span: Range<usize>) -> Option<Method> {
        let mut pick = |word: &Option<Spanned<String>>, name: &str, choices: &[&str]| {
            if let Some(word) = word {
                self.word(word, name, choices)
            } else {
                self.complain(
                    span.clone(),
                    format!("the method names no `{name}`"),
                    format!("it can be {}", choices.join(", ")),
                );
                None
            }
        };
        let basis = pick(&table.basis, "basis", &["hat", "ugimp", "cpgimp", "cpdi", "bspline2", "bspline3"]);
        let strain = pick(&table.strain, "strain", &StrainGradient::ALL.map(StrainGradient::name));
        let pressure =
            pick(&table.pressure, "pressure", &PressureIntegration::ALL.map(PressureIntegration::name));
        let recovery = match (&table.recovery, pressure) {
            (None, Some(0)) => Some(0),
            (word, _) => pick(word, "recovery", &Recovery::ALL.map(Recovery::name)),
        };
        let memory = match &table.memory {
            Some(word) => Memory::ALL[self.word(word, "memory", &["points", "cells"])?],
            None => Memory::Points,
        };
        let configuration = match &table.configuration {
            Some(word) => {
                Some(self.word(word, "configuration", &Configuration::ALL.map(Configuration::name))?)
            }
            None => None,
        };
        let (pressure, recovery) = (PressureIntegration::ALL[pressure?], Recovery::ALL[recovery?]);
        if let (Some(why), Some(word)) = (recovery.refuses(pressure), &table.recovery) {
            self.complain(word.span(), why, "leave the key out, or take another");
            return None;
        }
        Some(Method {
            basis: Basis::ALL[basis?],
            strain: StrainGradient::ALL[strain?],
            pressure,
            recovery,
            memory,
            configuration: configuration.map(|index| Configuration::ALL[index]),
        })
    }

    fn time_step(&mut self, typed: &Spanned<TimeStepTable>) -> Option<TimeStepRule> {
        let table = typed.get_ref();
        let given = [
            table.stable.as_ref().map(|value| (TimeStepRule::Stable(*value.get_ref()), value)),
            table.courant.as_ref().map(|value| (TimeStepRule::Courant(*value.get_ref()), value)),
            table.seconds.as_ref().map(|value| (TimeStepRule::Seconds(*value.get_ref()), value)),
            table.growth.as_ref().map(|value| (TimeStepRule::Growth(*value.get_ref()), value)),
            table.tolerance.as_ref().map(|value| (TimeStepRule::Tolerance(*value.get_ref()), value)),
        ];
        let given: Vec<_> = given.into_iter().flatten().collect();
        let [(rule, value)] = given.as_slice() else {
            self.complain(
                typed.span(),
                format!("a time step by {} rules", given.len()),
                "give exactly one: { stable = 0.5 }, { courant = 0.5 }, { seconds = 1e-6 }, { growth = 0.05 } or \
                 { tolerance = 1e-4 }",
            );
            return None;
        };
        if value.get_ref().is_finite() && *value.get_ref() > 0.0 {
            return Some(*rule);
        }
        self.complain(
            value.span(),
            format!("a time step of {}", value.get_ref()),
            "it must be positive and finite",
        );
        None
    }

    fn expectation(
        &mut self,
        entry: &Spanned<ExpectTable>,
        scene: SceneKind,
        references: &[ReferenceKind],
    ) -> Option<Expectation> {
        let table = entry.get_ref();
        let before = self.diagnostics.len();
        let quantity =
            self.choice(table.quantity.as_ref(), "quantity", &Quantity::ALL.map(Quantity::name), 0)?;
        let quantity = Quantity::ALL[quantity];
        let default_sample = if quantity == Quantity::Settlement { Sample::Surface } else { Sample::Points };
        let samples = Sample::ALL.map(Sample::name);
        let sample = table.sample.as_ref().map(|word| self.word(word, "sample", &samples));
        let sample = sample.map_or(Some(default_sample), |index| index.map(|index| Sample::ALL[index]))?;
        let default_norm = if quantity == Quantity::Settlement { Norm::Relative } else { Norm::L2 };
        let norms = Norm::ALL.map(Norm::name);
        let norm = table.norm.as_ref().map(|word| self.word(word, "norm", &norms));
        let norm = norm.map_or(Some(default_norm), |index| index.map(|index| Norm::ALL[index]))?;
        let Some(time_factor) = table.time_factor.as_ref().map(|typed| *typed.get_ref()) else {
            self.complain(entry.span(), "the expectation names no time factor", "add `time_factor = 0.1`");
            return None;
        };
        let axis = Axis::ALL[self.choice(table.axis.as_ref(), "axis", &Axis::ALL.map(Axis::name), 0)?];
        let reference = if self.is_held_against_itself(table, axis)? {
            None
        } else {
            Some(self.expected_reference(table, scene, references)?)
        };
        let method = match &table.method {
            Some(typed) => Some(self.method(typed)?),
            None => None,
        };
        let height = self.column_height?;
        let demand = Demand {
            order: table.order.as_ref().map(|order| Band {
                value: *order.get_ref().value.get_ref(),
                minus: order.get_ref().minus.as_ref().map_or(DEFAULT_BAND, |typed| *typed.get_ref()),
                plus: order.get_ref().plus.as_ref().map_or(DEFAULT_BAND, |typed| *typed.get_ref()),
            }),
            at: table.at.as_ref().and_then(|level| self.error_bound(level, axis, height)),
            class: match &table.class {
                Some(word) => Some(Class::ALL[self.word(word, "class", &Class::ALL.map(Class::name))?]),
                None => None,
            },
            floor: table.floor.as_ref().map(|floor| FloorBand {
                above: floor.get_ref().above.as_ref().map_or(0.0, |typed| *typed.get_ref()),
                below: floor.get_ref().below.as_ref().map_or(f64::MAX, |typed| *typed.get_ref()),
            }),
            spread: table.spread.as_ref().and_then(|level| self.error_bound(level, axis, height)),
            oscillation_below: table.oscillation.as_ref().map(|bound| *bound.get_ref().below.get_ref()),
            xfail: table.xfail.as_ref().map(|known| KnownFailure {
                strict: known.get_ref().strict.as_ref().is_none_or(|typed| *typed.get_ref()),
                reason: known.get_ref().reason.get_ref().clone(),
            }),
        };
        for problem in demand.problems() {
            self.complain(entry.span(), problem, "see the other expectations of the shipped studies");
        }
        let tiers = Tier::ALL.map(Tier::name);
        let tier = table.tier.as_ref().map_or(Some(1), |word| self.word(word, "tier", &tiers));
        let expectation = Expectation {
            method,
            integrator: table.integrator.as_ref().and_then(|word| self.integrator(word)),
            cells: self.count(table.cells.as_ref(), "cells", 1..=MOST_CELLS),
            points_per_cell: self.count(table.points_per_cell.as_ref(), "points_per_cell", 1..=MOST_POINTS),
            law: table.law.as_ref().and_then(|word| self.law(word, scene)),
            continuity: table.continuity.as_ref().and_then(|word| self.continuity(word)),
            water_bulk_modulus: table.water_bulk_modulus.as_ref().map(|typed| *typed.get_ref()),
            poissons_ratio: table.poissons_ratio.as_ref().map(|typed| *typed.get_ref()),
            scheme: table.scheme.as_ref().and_then(|word| self.scheme(word)),
            drag: table.drag.as_ref().and_then(|word| self.drag(word)),
            mapping_back: table.mapping_back.as_ref().map(|typed| *typed.get_ref()),
            measure: Measure {
                quantity,
                sample,
                norm,
                reference: reference.map_or(NEXT_FINER, |kind| kind.name()).to_owned(),
                time_factor,
            },
            reference,
            axis,
            demand,
            tier: Tier::ALL[tier?],
            line: self.source.text[..entry.span().start.min(self.source.text.len())].matches('\n').count()
                + 1,
        };
        (self.diagnostics.len() == before).then_some(expectation)
    }

    /// Whether an expectation holds a series against itself; none where its axis forbids it.
    fn is_held_against_itself(&mut self, table: &ExpectTable, axis: Axis) -> Option<bool> {
        let asked = table.reference.as_ref().filter(|word| word.get_ref() == NEXT_FINER);
        match asked {
            Some(word) if axis != Axis::TimeStep => {
                self.complain(
                    word.span(),
                    "the next finer level has other places",
                    "\"next-finer\" is for `axis = \"time_step\"`",
                );
                None
            }
            asked => Some(asked.is_some()),
        }
    }

    /// The reference of an expectation, the scene's own where it names none.
    fn expected_reference(
        &mut self,
        table: &ExpectTable,
        scene: SceneKind,
        references: &[ReferenceKind],
    ) -> Option<ReferenceKind> {
        let names: Vec<&str> = references.iter().map(|kind| kind.name()).collect();
        match &table.reference {
            Some(word) => Some(references[self.word(word, "reference", &names)?]),
            None => Some(scene.references()[0]),
        }
    }

    /// A bound at a level that is named in the words of its axis.
    fn error_bound(&mut self, level: &Spanned<LevelTable>, axis: Axis, height: f64) -> Option<ErrorBound> {
        let table = level.get_ref();
        let size = match axis {
            Axis::Cells => self
                .count(table.cells.as_ref(), "at.cells", 1..=MOST_CELLS)
                .map(|cells| height / cells as f64),
            Axis::PointsPerCell => self
                .count(table.points_per_cell.as_ref(), "at.points_per_cell", 1..=MOST_POINTS)
                .map(|points| 1.0 / points as f64),
            Axis::TimeStep => table.seconds.as_ref().map(|typed| *typed.get_ref()),
            Axis::WaterBulkModulus => table.water_bulk_modulus.as_ref().map(|typed| 1.0 / *typed.get_ref()),
        };
        let (Some(size), Some(below)) = (size, &table.below) else {
            self.complain(
                level.span(),
                "the bound names no level of its axis, or no bound",
                "write like { cells = 10, below = 5.0e-3 }",
            );
            return None;
        };
        let above = table.above.as_ref().map_or(0.0, |typed| *typed.get_ref());
        Some(ErrorBound { size, below: *below.get_ref(), above })
    }

    /// Index of an optional word, or that of the default.
    fn choice(
        &mut self,
        typed: Option<&Spanned<String>>,
        name: &str,
        choices: &[&str],
        default: usize,
    ) -> Option<usize> {
        typed.map_or(Some(default), |word| self.word(word, name, choices))
    }

    /// Index of a word among its choices.
    fn word(&mut self, typed: &Spanned<String>, name: &str, choices: &[&str]) -> Option<usize> {
        let word = typed.get_ref();
        let index = choices.iter().position(|choice| choice == word);
        if index.is_none() {
            self.complain(typed.span(), format!("no {name} is called `{word}`"), one_of(word, choices));
        }
        index
    }

    fn count(
        &mut self,
        typed: Option<&Spanned<i64>>,
        name: &str,
        range: RangeInclusive<i64>,
    ) -> Option<usize> {
        let typed = typed?;
        let count = *typed.get_ref();
        if !range.contains(&count) {
            let (least, most) = (range.start(), range.end());
            self.complain(
                typed.span(),
                format!("`{name}` is {count}"),
                format!("it must lie between {least} and {most}"),
            );
            return None;
        }
        usize::try_from(count).ok()
    }

    fn positive(&mut self, typed: Option<&Spanned<f64>>, name: &str, unit: &str, default: f64) -> f64 {
        let Some(typed) = typed else { return default };
        let value = *typed.get_ref();
        if !(value.is_finite() && value > 0.0) {
            self.complain(
                typed.span(),
                format!("`{name}` is {value} {unit}"),
                format!("it must be positive and finite; the seed column has {default} {unit}"),
            );
        }
        value
    }

    fn not_negative(&mut self, typed: Option<&Spanned<f64>>, name: &str, unit: &str) -> f64 {
        let Some(typed) = typed else { return 0.0 };
        let value = *typed.get_ref();
        if !(value.is_finite() && value >= 0.0) {
            self.complain(
                typed.span(),
                format!("`{name}` is {value} {unit}"),
                "it must be 0 or positive, and finite",
            );
        }
        value
    }

    fn between(
        &mut self,
        typed: Option<&Spanned<f64>>,
        name: &str,
        least: f64,
        most: f64,
        default: f64,
    ) -> f64 {
        let Some(typed) = typed else { return default };
        let value = *typed.get_ref();
        if !(value > least && value < most) {
            self.complain(
                typed.span(),
                format!("`{name}` is {value}"),
                format!(
                    "it must lie between {least} and {most}, both excluded; the seed column has {default}"
                ),
            );
        }
        value
    }
}
