//! Checks `[[expect]]` and `[[expect_case]]` blocks, and that some case can answer each.

use crate::case::keys::{MOST_CELLS, MOST_POINTS};
use crate::case::{Case, Norm, PlannedCase, Quantity, Sample, Task, Value};
use crate::study::Purpose;
use crate::study::check::Checker;
use crate::study::check::doubts::Basis;
use crate::study::diagnostic::Diagnostic;
use crate::study::expectation::{
    Axis, Bounds, CaseDemand, CaseExpectation, ErrorRange, Measure, NEXT_FINER, NO_REFERENCE, Selection,
    SeriesExpectation, UNSOUND,
};
use crate::study::file::{ExpectCaseTable, ExpectTable, LevelTable, RangeTable};
use crate::study::inputs::Inputs;
use crate::study::reading::{Placed, Typed};
use oedometer_convergence::{Class, ErrorBound, FloorBand, KnownFailure, OrderBand, SeriesDemand as Demand};
use oedometer_exact::reference::ReferenceKind;
use oedometer_problem::outcome::FailureKind;
use oedometer_scenes::Scene;
use oedometer_scenes::column::Column;
use oedometer_scenes::scene::{LoadKind, Question};
use oedometer_wording::count_of;
use std::ops::Range;

/// Half-width of an order's band where an expectation names none.
const DEFAULT_BAND: f64 = 0.1;
/// Levels of the shortest series.
const LEVELS_OF_A_SERIES: usize = 2;
/// Levels of the shortest series with an order, its finest window.
const LEVELS_OF_AN_ORDER: usize = 3;
/// Values that a diagnostic lists.
const MOST_LISTED: usize = 12;

/// What the expectations of a study are checked against.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    pub(super) scene: &'static Scene,
    /// References that the runs are compared with.
    pub(super) references: &'a [ReferenceKind],
    pub(super) planned: &'a [PlannedCase],
    /// Height of all cases, by which the levels of expectations are sized; none where they have several.
    pub(super) height: Option<f64>,
    /// Width of the plate that cells are counted over, m, where there is one.
    pub(super) plate_width: Option<f64>,
}

impl<'a> Subject<'a> {
    /// What the cases of a study, of whom one without a sweep has a column, have in common.
    pub(super) fn of(
        scene: &'static Scene,
        references: &'a [ReferenceKind],
        planned: &'a [PlannedCase],
        column: &Column,
    ) -> Self {
        let height = planned.first().map_or(column.height, |planned| planned.case.column.height);
        let is_common = planned.iter().all(|planned| planned.case.column.height == height);
        let plate_width = (scene.load == LoadKind::Pushed).then_some(column.footing.width);
        Self { scene, references, planned, height: is_common.then_some(height), plate_width }
    }
}

impl Checker<'_> {
    /// What a series must do.
    pub(super) fn expectation(
        &mut self,
        table: &Placed<ExpectTable>,
        subject: &Subject<'_>,
    ) -> Option<SeriesExpectation> {
        let before = self.complaints.len();
        // Whatever is wrong is told at once, and then nothing is made of it.
        let measured = self.measured(table.quantity, table.sample.as_ref(), table.norm.as_ref());
        let own_word = table.reference.as_deref().map(String::as_str);
        let own_word = own_word.filter(|word| [NEXT_FINER, NO_REFERENCE].contains(word));
        let reference = match own_word {
            Some(_) => None,
            None => Some(self.expected_reference(table.reference.as_ref(), table.span(), subject)),
        };
        let usual = if table.quantity.is_of_surface() { Sample::Surface } else { Sample::Points };
        self.own_words_fit(table, subject.scene, measured.map_or(usual, |(sample, _)| sample), own_word);
        let selection = self.selection(&table.inputs, subject.scene);
        let time_factor = self.expected_time_factor(
            [&table.time_factor, &table.time],
            table.span(),
            (&selection, table.axis.name()),
            subject.planned,
        );
        let height = self.height_of(&selection, table.span(), subject.height);
        let ((sample, norm), reference) = (measured?, reference.map_or(Some(None), |kind| kind.map(Some))?);
        let (time_factor, height) = (time_factor?, height?);
        let size = |cells: usize| match subject.plate_width {
            Some(width) => width / (cells + 1) as f64,
            None => height / cells as f64,
        };
        let demand = Demand {
            order: table.order.as_ref().map(|order| OrderBand {
                value: order.value,
                minus: order.minus.unwrap_or(DEFAULT_BAND),
                plus: order.plus.unwrap_or(DEFAULT_BAND),
            }),
            at: table.at.as_ref().and_then(|level| self.error_bound(level, table.axis, &size)),
            class: table.class,
            floor: table.floor.as_ref().map(|floor| FloorBand {
                above: floor.above.unwrap_or(0.0),
                below: floor.below.unwrap_or(f64::MAX),
            }),
            spread: table.spread.as_ref().and_then(|level| self.error_bound(level, table.axis, &size)),
            uncertainty_below: table.uncertainty.as_ref().map(|bound| bound.below),
            oscillation_below: table.oscillation.as_ref().map(|bound| bound.below),
            xfail: table.xfail.as_ref().map(|known| KnownFailure {
                strict: known.strict.unwrap_or(true),
                reason: known.reason.clone(),
            }),
        };
        for problem in demand.problems() {
            let place = table.place_of(problem.key).unwrap_or_else(|| table.span());
            self.complain(place, problem.sentence, problem.right());
        }
        self.series_is_there(table, &selection, time_factor, subject.planned);
        let expectation = SeriesExpectation {
            selection,
            measure: Measure {
                quantity: table.quantity,
                sample,
                norm,
                reference: reference.map_or(own_word.unwrap_or_default(), |kind| kind.name()).to_owned(),
                time_factor,
                probe: table.probe.as_deref().copied(),
            },
            reference,
            axis: table.axis,
            any_places: table.sample.is_none(),
            demand,
            tier: table.tier,
            line: self.line_of(table),
        };
        (self.complaints.len() == before).then_some(expectation)
    }

    /// What single cases must do.
    pub(super) fn case_expectation(
        &mut self,
        table: &Placed<ExpectCaseTable>,
        subject: &Subject<'_>,
    ) -> Option<CaseExpectation> {
        let before = self.complaints.len();
        let names: Vec<&str> = ["ok", UNSOUND].into_iter().chain(FailureKind::NAMES).collect();
        let status = table
            .status
            .as_ref()
            .and_then(|word| self.word(word, "status", &names).map(|index| names[index].to_owned()));
        if let Some(range) =
            table.spurious_velocity.as_ref().filter(|_| subject.scene.question != Question::Rest)
        {
            self.complain(
                range.span(),
                format!("the soil of the problem `{}` moves on its own", subject.scene.name),
                "a spurious velocity is measured only in the problem \"at-rest\"",
            );
        }
        let selection = self.selection(&table.inputs, subject.scene);
        let error =
            table.error.as_ref().and_then(|range| self.error_range(table, range, &selection, subject));
        let bound = |c: &mut Self, typed: &Typed<f64>, name: &str| {
            typed.as_ref().map(|typed| c.positive(Some(typed), name, "", 1e-12))
        };
        let demand = CaseDemand {
            status,
            critical_step_within: bound(self, &table.critical_step_within, "critical_step_within"),
            solid_drift_below: bound(self, &table.solid_drift_below, "solid_drift_below"),
            water_drift_below: bound(self, &table.water_drift_below, "water_drift_below"),
            pore_water: self.bounds(&table.pore_water),
            water_left_within: bound(self, &table.water_left_within, "water_left_within"),
            largest_pressure: self.bounds(&table.largest_pressure),
            one_set_within: bound(self, &table.one_set_within, "one_set_within"),
            spurious_velocity: self.bounds(&table.spurious_velocity),
            peak_time_factor: self.bounds(&table.peak_time_factor),
            peak_pressure: self.bounds(&table.peak_pressure),
            error,
        };
        if demand == CaseDemand::default() && self.complaints.len() == before {
            self.complain(
                table.span(),
                "the expectation demands nothing",
                "add `status = \"ok\"`, `critical_step_within = 0.02` or `error = { below = 1e-2 }`",
            );
        }
        if let Some(cases) = self.selected(&table.inputs, &selection, "", table.span(), subject.planned)
            && let Some(error) = &demand.error
        {
            let typed = table.time_factor.as_ref().or(table.time.as_ref());
            self.time_is_kept(&cases, error.measure.time_factor, typed.map_or(table.span(), Placed::span));
        }
        let line = self.line_of(table);
        let expectation = CaseExpectation { selection, demand, tier: table.tier, line };
        (self.complaints.len() == before).then_some(expectation)
    }

    /// Line of a block, for messages.
    fn line_of<T>(&self, block: &Placed<T>) -> usize {
        let start = block.span().start.min(self.source.text.len());
        self.source.text[..start].matches('\n').count() + 1
    }

    /// Height by which the levels of an expectation are sized: the one that it names, or that all cases have.
    fn height_of(&mut self, selection: &Selection, place: Range<usize>, common: Option<f64>) -> Option<f64> {
        let named = selection.0.iter().find_map(|(key, value)| match value {
            Value::Number(height) if key.name == "height" => Some(*height),
            _ => None,
        });
        let height = named.or(common);
        if height.is_none() && self.complaints.is_empty() {
            self.complain(
                place,
                "the cases have several heights, but the expectation names none",
                "add the one that is meant, like `height = 2.0`",
            );
        }
        height
    }

    /// Complains of keys that do not go with the reference: `probe` and `uncertainty` belong to one number without a
    /// reference; `at` and `oscillation` to an error.
    fn own_words_fit(
        &mut self,
        table: &Placed<ExpectTable>,
        scene: &'static Scene,
        sample: Sample,
        own_word: Option<&str>,
    ) {
        let is_value = own_word == Some(NO_REFERENCE);
        let is_field = !table.quantity.is_of_surface();
        let depth = table.probe.as_deref().copied().unwrap_or(0.5);
        let [probe, uncertainty, at, oscillation, reference] = [
            table.probe.as_ref().map(Placed::span),
            table.uncertainty.as_ref().map(Placed::span),
            table.at.as_ref().map(Placed::span),
            table.oscillation.as_ref().map(Placed::span),
            table.reference.as_ref().map(Placed::span),
        ];
        let no_error = |key: &str| format!("without a reference there is no error for `{key}` to bound");
        let without_probe = table.probe.is_none().then(|| table.span());
        let is_measured = (table.quantity, sample) == (Quantity::Pressure, Sample::Points);
        for (place, is_wrong, message, help) in [
            (
                reference,
                own_word == Some(NEXT_FINER) && table.axis != Axis::TimeStep,
                "the next finer level has its samples at other places".to_owned(),
                "\"next-finer\" is for `axis = \"time_step\"`; a settlement or a `probe` takes \"none\"",
            ),
            (
                probe.clone(),
                !(depth > 0.0 && depth < 1.0),
                format!("a probe at a depth of {depth}"),
                "it lies between 0, the surface, and 1, the base, both excluded",
            ),
            (
                probe,
                !is_value || !is_field || scene.body.is_plane(),
                "a probe is for a field of a column that is compared with no reference".to_owned(),
                "add `reference = \"none\"`, or leave the key out",
            ),
            (
                uncertainty,
                !is_value,
                "an error against a reference needs no uncertainty".to_owned(),
                "add `reference = \"none\"`, or bound the error itself with `at`",
            ),
            (
                without_probe,
                is_value && is_field,
                format!("without a reference the {} is not a single number", table.quantity.name()),
                if scene.body.is_plane() {
                    "ask for the settlement"
                } else {
                    "add a depth, like `probe = 0.5`"
                },
            ),
            (at, is_value, no_error("at"), "bound the `uncertainty`, or name a reference"),
            (
                oscillation.clone(),
                is_value,
                no_error("oscillation"),
                "bound the `uncertainty`, or name a reference",
            ),
            (
                oscillation,
                scene.body.is_plane() && !is_measured,
                format!(
                    "the problem `{}` measures the oscillation of the pressure at the points",
                    scene.name
                ),
                "leave `quantity` and `sample` out, or the oscillation",
            ),
        ] {
            if let Some(place) = place.filter(|_| is_wrong) {
                self.complain(place, message, help);
            }
        }
    }

    /// Which cases an expectation is about.
    fn selection(&mut self, inputs: &Inputs, scene: &'static Scene) -> Selection {
        let seed = Case::seed(Task::Solve, scene);
        let values = inputs.0.iter();
        Selection(
            values
                .filter_map(|(key, value)| Some((*key, self.input(key, value, key.name, &seed)?)))
                .collect(),
        )
    }

    /// Where a quantity is measured and in which norm: at the points in the mean square, but for the settlement.
    fn measured(
        &mut self,
        quantity: Quantity,
        sample: Option<&Placed<Sample>>,
        norm: Option<&Placed<Norm>>,
    ) -> Option<(Sample, Norm)> {
        let is_settlement = quantity.is_of_surface();
        let (usual, subject, help) = if is_settlement {
            (
                (Sample::Surface, Norm::Relative),
                if quantity == Quantity::Settlement { "a settlement" } else { "a bearing-capacity factor" },
                "it is measured at the \"surface\", \"relative\" to the exact one: leave the key out",
            )
        } else {
            (
                (Sample::Points, Norm::L2),
                "a field",
                "it is measured at \"points\", \"centres\" or \"nodes\", in the norm \"l1\", \"l2\" or \"linf\"",
            )
        };
        let before = self.complaints.len();
        if let Some(typed) = sample.filter(|typed| (***typed == Sample::Surface) != is_settlement) {
            self.complain(typed.span(), format!("{subject} has no `sample = \"{}\"`", typed.name()), help);
        }
        if let Some(typed) = norm.filter(|typed| (***typed == Norm::Relative) != is_settlement) {
            self.complain(typed.span(), format!("{subject} has no `norm = \"{}\"`", typed.name()), help);
        }
        let measured = (sample.map_or(usual.0, |typed| **typed), norm.map_or(usual.1, |typed| **typed));
        (self.complaints.len() == before).then_some(measured)
    }

    /// The reference of an expectation: the one that it names; else the first that the runs are compared with, which is
    /// the scene's own where it is among them.
    fn expected_reference(
        &mut self,
        typed: Option<&Placed<String>>,
        place: Range<usize>,
        subject: &Subject<'_>,
    ) -> Option<ReferenceKind> {
        if let Some(word) = typed {
            let names: Vec<&str> = subject.references.iter().map(|kind| kind.name()).collect();
            return Some(subject.references[self.word(word, "reference", &names)?]);
        }
        if subject.references.is_empty() {
            self.complain(
                place,
                "the runs are compared with no reference, and the expectation names none",
                format!("add `reference = \"{NO_REFERENCE}\"`, or list some in `output.references`"),
            );
        }
        subject.references.first().copied()
    }

    /// A bound at a level that is named in the words of its axis.
    fn error_bound(
        &mut self,
        level: &Placed<LevelTable>,
        axis: Axis,
        size: &dyn Fn(usize) -> f64,
    ) -> Option<ErrorBound> {
        let size = match axis {
            Axis::Cells => self.count(level.cells.as_ref(), "at.cells", 1..=MOST_CELLS).map(size),
            Axis::PointsPerCell => self
                .count(level.points_per_cell.as_ref(), "at.points_per_cell", 1..=MOST_POINTS)
                .map(|points| 1.0 / points as f64),
            Axis::TimeStep => level.seconds,
            Axis::WaterBulkModulus => level.water_bulk_modulus.map(|modulus| 1.0 / modulus),
        };
        let (Some(size), Some(below)) = (size, level.below) else {
            self.complain(
                level.span(),
                "the bound names no level of its axis, or no bound",
                "write it like { cells = 10, below = 5.0e-3 }",
            );
            return None;
        };
        let above = level.above.unwrap_or(0.0);
        self.question_whole_errors(level.span(), Bounds { above, below });
        Some(ErrorBound { size, below, above })
    }

    /// Asks about a bound that a result of zero meets.
    fn question_whole_errors(&mut self, place: Range<usize>, Bounds { above, below }: Bounds) {
        if (1.0..f64::MAX).contains(&below) && above == 0.0 {
            self.warn(&Diagnostic::at(
                place,
                format!("an error below {below} means {} %, which even a result of zero has", 100.0 * below),
                format!("did you mean \"{below} %\"?"),
            ));
        }
    }

    /// Bounds on one error of a case.
    fn error_range(
        &mut self,
        table: &Placed<ExpectCaseTable>,
        range: &Placed<RangeTable>,
        selection: &Selection,
        subject: &Subject<'_>,
    ) -> Option<ErrorRange> {
        let (sample, norm) = self.measured(table.quantity, table.sample.as_ref(), table.norm.as_ref())?;
        let reference = self.expected_reference(table.reference.as_ref(), range.span(), subject)?;
        let time_factor = self.expected_time_factor(
            [&table.time_factor, &table.time],
            range.span(),
            (selection, ""),
            subject.planned,
        )?;
        let bounds = self.bounds(&table.error)?;
        self.question_whole_errors(range.span(), bounds);
        let reference = reference.name().to_owned();
        let measure = Measure { quantity: table.quantity, sample, norm, reference, time_factor, probe: None };
        Some(ErrorRange { measure, any_places: table.sample.is_none(), bounds })
    }

    /// The bounds of a table: 0 where the lower one is left out, and none where the upper one is. A diagnostic where no
    /// value lies between them.
    #[expect(clippy::ref_option, reason = "as the file of a study has it")]
    fn bounds(&mut self, range: &Typed<RangeTable>) -> Option<Bounds> {
        let range = range.as_ref()?;
        let bounds = Bounds { above: range.above.unwrap_or(0.0), below: range.below.unwrap_or(f64::MAX) };
        let has_values = bounds.above < bounds.below;
        if !has_values {
            self.complain(
                range.span(),
                format!("no value is at least {} and below {}", bounds.above, bounds.below),
                "`above` (0 by default) must be smaller than `below`",
            );
        }
        Some(bounds)
    }

    /// Complains where no case of the study can answer an expectation of series.
    fn series_is_there(
        &mut self,
        table: &Placed<ExpectTable>,
        selection: &Selection,
        time_factor: f64,
        planned: &[PlannedCase],
    ) {
        let axis = table.axis.name();
        let Some(cases) = self.selected(&table.inputs, selection, axis, table.span(), planned) else {
            return;
        };
        let typed = table.time_factor.as_ref().or(table.time.as_ref());
        self.time_is_kept(&cases, time_factor, typed.map_or(table.span(), Placed::span));
        self.series_is_long_enough(table, selection, time_factor, planned);
        let wanted = table.at.as_ref().and_then(|level| level.cells.as_ref());
        let Some(wanted) = wanted.filter(|_| table.axis == Axis::Cells) else { return };
        if !cases.iter().any(|case| i64::try_from(case.cells) == Ok(**wanted)) {
            let levels = listed(cases.iter().map(|case| case.cells.to_string()));
            let message = format!("no case that the expectation names has {} cells", **wanted);
            self.complain(wanted.span(), message, format!("they have {levels}"));
        }
    }

    /// Complains where no series has the levels that an expectation needs, with the axis along which one has; and of an
    /// order of the time step that would be held against an exact solution.
    fn series_is_long_enough(
        &mut self,
        table: &Placed<ExpectTable>,
        selection: &Selection,
        time_factor: f64,
        planned: &[PlannedCase],
    ) {
        let is_next_finer = table.reference.as_deref().is_some_and(|word| word == NEXT_FINER);
        let needs_order = table.order.is_some() || table.uncertainty.is_some();
        // A path of one level at a time has an error there all the same.
        let is_kept = |case: &Case| !needs_order || case.time_factors.contains(&time_factor);
        let levels_along = |axis: Axis| {
            let cases = planned.iter().map(|planned| &planned.case);
            axis.levels(cases.filter(|case| selection.fits_along(axis.name(), case) && is_kept(case)))
        };
        let needed = if needs_order { LEVELS_OF_AN_ORDER } else { LEVELS_OF_A_SERIES };
        let levels = levels_along(table.axis);
        // None at all has a diagnostic of its own.
        if levels == 0 || table.class == Some(Class::NotEvaluable) {
            return;
        }
        if levels < needed + usize::from(is_next_finer) {
            let enough = |axis: &Axis| levels_along(*axis) >= needed;
            let help = match Axis::REFINEMENTS
                .iter()
                .filter(|axis| **axis != table.axis)
                .find(|count| enough(count))
            {
                Some(Axis::TimeStep) => {
                    format!(
                        "what is refined is the step: add `axis = \"time_step\"` and `reference = \"{NEXT_FINER}\"`"
                    )
                }
                Some(axis) => format!("what is refined is another key: add `axis = \"{}\"`", axis.name()),
                None => format!(
                    "add values of `{}` to the sweep, or bound single cases with `[[expect_case]]`",
                    table.axis.name()
                ),
            };
            let message = format!(
                "the expectation is judged along `{}` and needs {}: its cases have {levels}",
                table.axis.name(),
                count_of(needed + usize::from(is_next_finer), "level", "levels")
            );
            self.complain(table.span(), message, help);
        } else if table.axis == Axis::TimeStep
            && table.order.is_some()
            && table.class.is_none()
            && table.reference.is_none()
        {
            self.complain(
                table.span(),
                "errors against an exact solution cannot show an order in time: they stop falling at the \
                 error of the mesh",
                format!(
                    "add `reference = \"{NEXT_FINER}\"`, the differences from the next finer step, or name the exact solution where \
                     the mesh is fine enough for it"
                ),
            );
        }
    }

    /// The cases that a selection names along an axis; a diagnostic at the first key that leaves none. Nothing where
    /// there are diagnostics already: they may be why.
    fn selected<'a>(
        &mut self,
        inputs: &Inputs,
        selection: &Selection,
        axis: &str,
        place: Range<usize>,
        planned: &'a [PlannedCase],
    ) -> Option<Vec<&'a Case>> {
        if !self.complaints.is_empty() || self.purpose != Purpose::Solving {
            return None;
        }
        let mut cases: Vec<&Case> = planned.iter().map(|planned| &planned.case).collect();
        for (key, value) in selection.0.iter().filter(|(key, _)| key.name != axis) {
            let before = cases.clone();
            cases.retain(|case| key.get(case) == *value);
            if cases.is_empty() {
                let others = listed(before.iter().map(|case| key.get(case).to_string()));
                let with =
                    if selection.0.len() > 1 { " and the other inputs of the expectation" } else { "" };
                self.complain(
                    inputs.span(key.name).unwrap_or(place),
                    format!("no case of the study has `{} = {value}`{with}", key.name),
                    format!("the cases have {others}"),
                );
                return None;
            }
        }
        Some(cases)
    }

    /// Complains if no case has an output at a time factor.
    fn time_is_kept(&mut self, cases: &[&Case], time_factor: f64, place: Range<usize>) {
        let is_kept = |case: &&Case| case.task == Task::Stability || case.time_factors.contains(&time_factor);
        if !cases.iter().any(is_kept) {
            let factors =
                listed(cases.iter().flat_map(|case| case.time_factors.iter()).map(ToString::to_string));
            self.complain_by(
                Basis::Times,
                place,
                format!("no case has an output at T_v = {time_factor}"),
                format!("the outputs are at {factors}: name one of them, or add it to `output.time_factors`"),
            );
        }
    }
}

/// Words in the order in which they come, each once.
fn listed(words: impl Iterator<Item = String>) -> String {
    let mut once: Vec<String> = Vec::new();
    for word in words {
        if once.contains(&word) {
            continue;
        }
        if once.len() == MOST_LISTED {
            once.push("…".to_owned());
            break;
        }
        once.push(word);
    }
    once.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dozen_words_are_listed_and_of_more_there_is_a_sign() {
        let words =
            |count: usize| listed((0..count).flat_map(|word| [word, word]).map(|word| word.to_string()));
        let all: Vec<String> = (0..13).map(|word| word.to_string()).collect();
        assert_eq!(words(0), "");
        assert_eq!(words(1), "0");
        assert_eq!(words(12), all[..12].join(", "));
        assert_eq!(words(13), all[..12].join(", ") + ", …");
        assert_eq!(words(40), words(13));
    }
}
