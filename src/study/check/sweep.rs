//! Checks of what is varied: the blocks `[[sweep]]`, axis by axis and together.

use crate::case::tier::Tier;
use crate::case::{Case, Task};
use crate::mpm::explicit::ExplicitSettings;
use crate::mpm::run::integrator::{Formulation, IntegratorKind};
use crate::scene::SceneKind;
use crate::scene::arrangement::Arrangement;
use crate::scene::column::Column;
use crate::soil::material::Material;
use crate::study::check::{Checker, MOST_CASES, MOST_CELLS, MOST_POINTS};
use crate::study::file::SweepTable;
use crate::study::sweep::{AXES, Combination, Sweep};
use std::ops::Range;
use toml::Spanned;

/// Memory that a case may ask for, bytes: a workstation's.
const MOST_BYTES: f64 = 32e9;

/// What the cases of a study share where a sweep does not say otherwise.
#[derive(Clone, Copy)]
pub(crate) struct Common {
    pub(crate) task: Task,
    pub(crate) scene: SceneKind,
    pub(crate) column: Column,
    pub(crate) soil: Material,
    pub(crate) settings: ExplicitSettings,
    pub(crate) formulation: Option<Formulation>,
}

impl Common {
    /// The case of one combination of a sweep.
    pub(crate) fn case_of(&self, one: &Combination, time_factors: &[f64]) -> Case {
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

impl Checker<'_> {
    pub(crate) fn sweep(&mut self, table: &SweepTable, span: Range<usize>, common: &Common) -> Option<Sweep> {
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
        self.path_is_even(table, &sweep);
        if self.diagnostics.len() == before && self.can_be_multiplied_out(&span, &sweep) {
            self.rules_fit(table, &sweep);
            self.formulations_fit(table, &span, &sweep, scene);
        }
        (self.diagnostics.len() == before).then_some(sweep)
    }

    /// Complains where a path ties lists of different lengths.
    fn path_is_even(&mut self, table: &SweepTable, sweep: &Sweep) {
        if let (Some((key, own, first)), Some(path)) = (sweep.uneven_path(), &table.path) {
            self.complain(
                path.span(),
                format!("the path ties `{key}` with {own} values to an axis with {first}"),
                "give the axes of a path lists of one length",
            );
        }
    }

    /// Whether the sweeps so far have no more cases than a study may; a complaint where they do, before any
    /// is made.
    fn can_be_multiplied_out(&mut self, span: &Range<usize>, sweep: &Sweep) -> bool {
        let count = sweep.count();
        let so_far = self.multiplied_out;
        self.multiplied_out = count.map_or(usize::MAX, |count| so_far.saturating_add(count));
        if self.multiplied_out <= MOST_CASES {
            return true;
        }
        let others =
            if so_far > 0 { format!(", with {so_far} of the sweeps before it") } else { String::new() };
        let count =
            count.map_or("more cases than can be counted".to_owned(), |count| format!("{count} cases"));
        self.complain(
            span.start..span.start + 1,
            format!("the sweep multiplies out to {count}{others}"),
            format!(
                "a study has at most {MOST_CASES}: shorten its lists, tie axes with `path`, or part it into several"
            ),
        );
        false
    }

    pub(crate) fn tier(&mut self, table: &SweepTable) -> Tier {
        let names = Tier::ALL.map(Tier::name);
        let index = table.tier.as_ref().and_then(|word| self.word(word, "tier", &names));
        index.map_or(Tier::default(), |index| Tier::ALL[index])
    }

    /// Complains where a formulation meets an integrator that cannot solve it.
    fn formulations_fit(&mut self, table: &SweepTable, span: &Range<usize>, sweep: &Sweep, scene: SceneKind) {
        let refusal = |one: Combination| one.integrator.refuses_formulation(one.formulation);
        if let Some(why) = sweep.combinations().find_map(refusal) {
            let place = table.formulation.as_ref().map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                why,
                "give each integrator a [[sweep]] block of its own, or leave `formulation` out",
            );
        }
        let still = |one: &Combination| one.formulation == Formulation::QuasiStatic;
        if scene.has_waves() && sweep.combinations().any(|one| still(&one)) {
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
        let refused = sweep.combinations().find_map(|one| one.integrator.refuses_rule(one.time_step));
        if let Some(why) = refused {
            self.complain(
                list.span(),
                why,
                "give each integrator a [[sweep]] block of its own, or tie both axes with `path`",
            );
        }
    }

    /// Square cells must fill the width: their number over the height decides their size.
    pub(crate) fn cells_fill_the_width(&mut self, table: &SweepTable, column: &Column) {
        for typed in table.cells.iter().flat_map(Spanned::get_ref) {
            let cells = usize::try_from(*typed.get_ref()).unwrap_or(0);
            if cells == 0 || column.cells_across(cells).is_some() {
                continue;
            }
            let size = column.height / cells as f64;
            self.complain(
                typed.span(),
                format!("square cells of {size} m do not fill a width of {} m", column.horizontal_extent),
                format!("a width of {size} m is one cell wide, or take a number of cells that divides it"),
            );
        }
    }

    /// Complains of a mesh whose run would end for want of memory, and the others with it.
    pub(crate) fn memory_fits(&mut self, table: &SweepTable, cases: impl Iterator<Item = Case>) {
        let largest = cases.max_by(|a, b| a.estimated_bytes().total_cmp(&b.estimated_bytes()));
        let (Some(case), Some(cells)) = (largest, &table.cells) else { return };
        let bytes = case.estimated_bytes();
        if bytes > MOST_BYTES {
            self.complain(
                cells.span(),
                format!(
                    "{} cells over the height with {} points a cell need about {:.0} GB of memory",
                    case.cells,
                    case.points_per_cell,
                    1e-9 * bytes
                ),
                format!("take fewer: {:.0} GB is the most", 1e-9 * MOST_BYTES),
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
}
