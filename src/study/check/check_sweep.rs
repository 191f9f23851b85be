//! Checks of what is varied: the blocks `[[sweep]]`, axis by axis and together.

use crate::case::Case;
use crate::case::keys::Key;
use crate::study::check::checker::{Checker, Common};
use crate::study::file::SweepTable;
use crate::study::inputs::{One, TypedInput};
use crate::study::sweep::{Sweep, SweptKey};
use oedometer_mpm::method::Basis;
use oedometer_mpm::run::integrator::{Formulation, IntegratorKind};
use oedometer_mpm::run::time_step_rule::TimeStepRule;
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::Column;
use std::collections::HashMap;
use std::ops::Range;
use toml::Spanned;

/// Cases that a study may have, counted as its sweeps multiply out: as many as a machine holds and a person
/// can still mean.
const MOST_CASES: usize = 1_000_000;
/// Memory that a case may ask for, bytes: a workstation's.
const MOST_BYTES: f64 = 32e9;

impl Checker<'_> {
    pub(crate) fn sweep(
        &mut self,
        table: &SweepTable,
        span: Range<usize>,
        common: &Common,
        base: &Case,
    ) -> Option<Sweep> {
        let before = self.diagnostics.len();
        for (name, example) in [("method", "[\"GC-SRI-patch\"]"), ("cells", "[5, 10, 20]")] {
            if table.typed(name).is_none() {
                let message = format!("the sweep names no {name}");
                self.complain(span.start..span.start + 1, message, format!("add `{name} = {example}`"));
            }
        }
        // What the study gives stands with what is swept: an integrator would bring its own formulation.
        let values = |key: &'static Key| {
            let given =
                || common.given.iter().find(|(given, _)| *given == key).map(|(_, value)| vec![*value]);
            let one = |c: &mut Self, one: &One| c.input(key, one, key.name, &common.seed);
            table.typed(key.name).map(|list| self.list(list, key.name, one)).or_else(given)
        };
        let keys: Vec<_> = Key::of("sweep").map(values).zip(Key::of("sweep")).collect();
        let swept = keys.into_iter().filter_map(|(values, key)| Some(SweptKey { key, values: values? }));
        let keys = swept.collect();
        self.geometry_is_the_scenes(table, base.scene);
        let names: Vec<&str> = Key::of("sweep").map(|key| key.name).collect();
        let path = table.path.as_deref().map(|list| {
            self.list(list, "path", |c, word| c.word(word, "axis", &names).map(|at| names[at].to_owned()))
        });
        let sweep = Sweep { keys, path: path.unwrap_or_default() };
        self.path_is_even(table, &sweep);
        if self.diagnostics.len() == before && self.can_be_multiplied_out(&span, &sweep) {
            self.rules_fit(table, &sweep, base);
            self.formulations_fit(table, &span, &sweep, base);
            self.slopes_are_brought(table, &span, &sweep, base);
            self.stresses_slope(table, &span, &sweep, base);
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

    /// Complains where a formulation meets an integrator that cannot solve it.
    fn formulations_fit(&mut self, table: &SweepTable, span: &Range<usize>, sweep: &Sweep, base: &Case) {
        let scene = base.scene;
        if let Some(why) = sweep.cases(base).find_map(|one| scene.refuses_integrator(one.integrator)) {
            let place = table.typed("integrator").map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                why,
                "take `integrator = [\"explicit\"]`, or leave the key out",
            );
            return;
        }
        let refusal = |one: Case| one.integrator.refuses_formulation(one.formulation);
        if let Some(why) = sweep.cases(base).find_map(refusal) {
            let place = table.typed("formulation").map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                why,
                "give each integrator a [[sweep]] block of its own, or leave `formulation` out",
            );
        }
        let still = |one: &Case| one.formulation == Formulation::QuasiStatic;
        if scene.needs_inertia() && sweep.cases(base).any(|one| still(&one)) {
            let place = table.typed("formulation").map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                format!("the quasi-static formulation leaves out the waves that `{}` is about", scene.name()),
                "take \"v-w\" or \"u-p\", or the scene \"terzaghi\"",
            );
        }
    }

    /// Complains where slopes of velocities are asked for and nothing brings them.
    fn slopes_are_brought(&mut self, table: &SweepTable, span: &Range<usize>, sweep: &Sweep, base: &Case) {
        let brings = |one: &Case| {
            let configuration = one.method.configuration_or(one.scene.configuration());
            one.integrator == IntegratorKind::Explicit
                && configuration.moves_points()
                && !one.column.points.has_two_layers()
        };
        if sweep.cases(base).any(|one| one.settings.affine && !brings(&one)) {
            let place = table.typed("affine").map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                "slopes of velocities go from points to nodes where points move by explicit steps, in one layer: a \
                 case of this sweep has no such points",
                "leave `affine` out there, or give those methods and integrators a [[sweep]] block of their own",
            );
            return;
        }
        let slopes = |one: &Case| one.settings.affine;
        self.no_limit_is_asked_for((table, span), ("affine", "velocities"), slopes, (sweep, base));
    }

    /// Complains where stresses are to slope over domains that do not tile the body, or that no explicit step moves.
    fn stresses_slope(&mut self, table: &SweepTable, span: &Range<usize>, sweep: &Sweep, base: &Case) {
        let slope = |one: &Case| {
            let configuration = one.method.configuration_or(one.scene.configuration());
            one.integrator == IntegratorKind::Explicit
                && configuration.moves_points()
                && one.method.basis == Basis::Cpgimp
                && !one.column.points.has_two_layers()
        };
        if sweep.cases(base).any(|one| one.settings.stress_slopes && !slope(&one)) {
            let place = table.typed("stress_slopes").map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                "stresses slope over GIMP's domains that follow points which move by explicit steps, in one layer: a \
                 case of this sweep has no such domains",
                "leave `stress_slopes` out there, or give those methods and integrators a [[sweep]] block of their own",
            );
            return;
        }
        let slopes = |one: &Case| one.settings.stress_slopes;
        self.no_limit_is_asked_for((table, span), ("stress_slopes", "stresses"), slopes, (sweep, base));
    }

    /// Complains where a share is asked for of the critical step that is predicted without slopes: columns with slopes of
    /// velocities ended unstable at 0.8 of it.
    fn no_limit_is_asked_for(
        &mut self,
        (table, span): (&SweepTable, &Range<usize>),
        (key, of_what): (&'static str, &'static str),
        has_slopes: impl Fn(&Case) -> bool,
        (sweep, base): (&Sweep, &Case),
    ) {
        let by_limit = |one: &Case| matches!(one.time_step, TimeStepRule::Stable(_));
        if sweep.cases(base).any(|one| has_slopes(&one) && by_limit(&one)) {
            let place = table.typed(key).map(Spanned::span);
            self.complain(
                place.unwrap_or(span.start..span.start + 1),
                format!(
                    "the critical step with slopes of {of_what} is not predicted: no share of it can be taken"
                ),
                "name the step: `time_step = [{ courant = 0.4 }]`, or in seconds",
            );
        }
    }

    /// Complains where a step rule meets an integrator that cannot follow it.
    fn rules_fit(&mut self, table: &SweepTable, sweep: &Sweep, base: &Case) {
        let Some(list) = table.typed("time_step") else { return };
        let refused = sweep.cases(base).find_map(|one| one.integrator.refuses_rule(one.time_step));
        if let Some(why) = refused {
            self.complain(
                list.span(),
                why,
                "give each integrator a [[sweep]] block of its own, or tie both axes with `path`",
            );
        }
    }

    /// Square cells must fill the width: their number over the height decides their size.
    pub(crate) fn cells_fill_the_width(&mut self, table: &SweepTable, cases: impl Iterator<Item = Case>) {
        let gaps = cases.filter(|case| case.column.cells_across(case.cells).is_none());
        let gaps: HashMap<usize, (Column, SceneKind)> =
            gaps.map(|case| (case.cells, (*case.column, case.scene))).collect();
        for typed in table.typed("cells").into_iter().flat_map(Spanned::get_ref) {
            let TypedInput::Count(cells) = typed.get_ref() else { continue };
            let cells = usize::try_from(*cells).unwrap_or(0);
            let Some((column, scene)) = gaps.get(&cells) else { continue };
            let size = column.height / cells as f64;
            let [key, table] = if scene.is_a_layer() { ["length", "layer"] } else { ["width", "column"] };
            self.complain(
                typed.span(),
                format!("square cells of {size} m do not fill a {key} of {} m", column.horizontal_extent),
                format!(
                    "a {key} holds whole cells of every size: `{key} = {size}` in [{table}] is one of these"
                ),
            );
        }
    }

    /// Complains of a mesh whose run would end for want of memory, and the others with it.
    pub(crate) fn memory_fits(&mut self, table: &SweepTable, cases: impl Iterator<Item = Case>) {
        let largest = cases.max_by(|a, b| a.estimated_bytes().total_cmp(&b.estimated_bytes()));
        let (Some(case), Some(cells)) = (largest, table.typed("cells")) else { return };
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

    /// A list of values; empty lists are refused.
    fn list<T, U>(
        &mut self,
        list: &Spanned<Vec<T>>,
        name: &str,
        check: impl Fn(&mut Self, &T) -> Option<U>,
    ) -> Vec<U> {
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
