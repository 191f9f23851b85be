//! Checks of what a study expects of its series: the blocks `[[expect]]`.

use crate::case::keys::{Key, MOST_CELLS, MOST_POINTS, Value};
use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::case::tier::Tier;
use crate::case::{Case, Task};
use crate::study::check::checker::Checker;
use crate::study::choice_tables::Named;
use crate::study::expectation::{Axis, Measure, NEXT_FINER, NO_REFERENCE, Selection, SeriesExpectation};
use crate::study::file::{ExpectTable, LevelTable};
use crate::study::inputs::One;
use oedometer_convergence::{ErrorBound, FloorBand, KnownFailure, OrderBand, SeriesDemand as Demand};
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::scene::SceneKind;
use std::ops::Range;
use toml::Spanned;

/// Half-width of an order's band where an expectation names none.
const DEFAULT_BAND: f64 = 0.1;

impl Checker<'_> {
    pub(crate) fn expectation(
        &mut self,
        entry: &Spanned<ExpectTable>,
        scene: SceneKind,
        references: &[ReferenceKind],
    ) -> Option<SeriesExpectation> {
        let table = entry.get_ref();
        let before = self.diagnostics.len();
        let (quantity, sample, norm) =
            self.measured(table.quantity.as_deref(), table.sample.as_deref(), table.norm.as_deref())?;
        let Some(time_factor) = table.time_factor.as_ref().map(|typed| *typed.get_ref()) else {
            self.complain(entry.span(), "the expectation names no time factor", "add `time_factor = 0.1`");
            return None;
        };
        let axis = self.choice(table.axis.as_deref(), "axis", Axis::Cells)?;
        let own_word = table.reference.as_ref().map(|word| word.get_ref().as_str());
        let own_word = own_word.filter(|word| [NEXT_FINER, NO_REFERENCE].contains(word));
        let reference = match own_word {
            Some(NEXT_FINER) if !self.can_be_held_against_itself(table, axis) => return None,
            Some(_) => None,
            None => {
                let place = entry.span();
                Some(self.expected_reference(table.reference.as_deref(), place, scene, references)?)
            }
        };
        let is_value = own_word == Some(NO_REFERENCE);
        self.value_is_one_number(entry, scene, quantity, is_value);
        self.oscillation_is_measured(table, scene, quantity, sample);
        let selection = self.selection(&table.inputs, scene);
        let height = self.height_of(&selection, entry.span())?;
        let demand = Demand {
            order: table.order.as_ref().map(|order| OrderBand {
                value: *order.get_ref().value.get_ref(),
                minus: order.get_ref().minus.as_ref().map_or(DEFAULT_BAND, |typed| *typed.get_ref()),
                plus: order.get_ref().plus.as_ref().map_or(DEFAULT_BAND, |typed| *typed.get_ref()),
            }),
            at: table.at.as_ref().and_then(|level| self.error_bound(level, axis, height)),
            class: match &table.class {
                Some(word) => Some(self.named(word, "class")?),
                None => None,
            },
            floor: table.floor.as_ref().map(|floor| FloorBand {
                above: floor.get_ref().above.as_ref().map_or(0.0, |typed| *typed.get_ref()),
                below: floor.get_ref().below.as_ref().map_or(f64::MAX, |typed| *typed.get_ref()),
            }),
            spread: table.spread.as_ref().and_then(|level| self.error_bound(level, axis, height)),
            uncertainty_below: table.uncertainty.as_ref().map(|bound| *bound.get_ref().below.get_ref()),
            oscillation_below: table.oscillation.as_ref().map(|bound| *bound.get_ref().below.get_ref()),
            xfail: table.xfail.as_ref().map(|known| KnownFailure {
                strict: known.get_ref().strict.as_ref().is_none_or(|typed| *typed.get_ref()),
                reason: known.get_ref().reason.get_ref().clone(),
            }),
        };
        for problem in demand.problems() {
            self.complain(entry.span(), problem, "see the other expectations of the shipped studies");
        }
        let tier = self.choice(table.tier.as_deref(), "tier", Tier::Ci);
        let expectation = SeriesExpectation {
            selection,
            measure: Measure {
                quantity,
                sample,
                norm,
                reference: reference.map_or(own_word.unwrap_or_default(), |kind| kind.name()).to_owned(),
                time_factor,
                probe: table.probe.as_ref().map(|typed| *typed.get_ref()),
            },
            reference,
            axis,
            demand,
            tier: tier?,
            line: self.source.text[..entry.span().start.min(self.source.text.len())].matches('\n').count()
                + 1,
        };
        (self.diagnostics.len() == before).then_some(expectation)
    }

    /// Height by which the levels of an expectation are sized: the one that all cases have, or that it names.
    fn height_of(&mut self, selection: &Selection, place: Range<usize>) -> Option<f64> {
        let named = selection.0.iter().find_map(|(key, value)| match value {
            Value::Number(height) if key.name == "height" => Some(*height),
            _ => None,
        });
        let height = named.or(self.column_height);
        if height.is_none() && self.diagnostics.is_empty() {
            self.complain(
                place,
                "the cases have several heights, and the expectation names none",
                "add the one that it is about, like `height = 2.0`",
            );
        }
        height
    }

    /// Whether a series may be held against its own next finer level; a complaint where not.
    fn can_be_held_against_itself(&mut self, table: &ExpectTable, axis: Axis) -> bool {
        let Some(word) = table.reference.as_ref().filter(|_| axis != Axis::TimeStep) else { return true };
        self.complain(
            word.span(),
            "the next finer level has other places",
            "\"next-finer\" is for `axis = \"time_step\"`; a settlement or a `probe` takes \"none\"",
        );
        false
    }

    /// Complains where a quantity without a reference is more than one number, and where one with a
    /// reference is asked what only such a number has.
    fn value_is_one_number(
        &mut self,
        entry: &Spanned<ExpectTable>,
        scene: SceneKind,
        quantity: Quantity,
        is_value: bool,
    ) {
        let table = entry.get_ref();
        let is_field = quantity != Quantity::Settlement;
        if let Some(probe) = &table.probe {
            let depth = *probe.get_ref();
            if !(depth > 0.0 && depth < 1.0) {
                self.complain(
                    probe.span(),
                    format!("a probe at a depth of {depth}"),
                    "it lies between 0, the surface, and 1, the base, both excluded",
                );
            }
            if !is_value || !is_field || scene.has_plane_fields() {
                self.complain(
                    probe.span(),
                    "a probe is for a field of a column that is held against no reference",
                    "add `reference = \"none\"`, or leave the key out",
                );
            }
        }
        if !is_value {
            if let Some(typed) = &table.uncertainty {
                self.complain(
                    typed.span(),
                    "an error against a reference needs no uncertainty",
                    "add `reference = \"none\"`, or bound the error itself with `at`",
                );
            }
            return;
        }
        if is_field && table.probe.is_none() {
            self.complain(
                entry.span(),
                format!("without a reference the {} is no single number", quantity.name()),
                if scene.has_plane_fields() {
                    "ask for the settlement"
                } else {
                    "add a depth, like `probe = 0.5`"
                },
            );
        }
        for (key, place) in [
            ("at", table.at.as_ref().map(|typed| typed.span())),
            ("oscillation", table.oscillation.as_ref().map(|typed| typed.span())),
        ] {
            if let Some(place) = place {
                let message = format!("without a reference there is no error for `{key}` to bound");
                self.complain(place, message, "bound the `uncertainty`, or name a reference");
            }
        }
    }

    /// Complains where the oscillation of a plane is asked of anything but what it is measured of.
    fn oscillation_is_measured(
        &mut self,
        table: &ExpectTable,
        scene: SceneKind,
        quantity: Quantity,
        sample: Sample,
    ) {
        let is_measured = (quantity, sample) == (Quantity::Pressure, Sample::Points);
        if let Some(typed) = table.oscillation.as_ref().filter(|_| scene.has_plane_fields() && !is_measured) {
            self.complain(
                typed.span(),
                format!("the scene `{}` measures the wiggle of the pressure at the points", scene.name()),
                "leave `quantity` and `sample` out, or the oscillation",
            );
        }
    }

    /// Which cases an expectation is about.
    pub(crate) fn selection(&mut self, inputs: &[(&'static Key, One)], scene: SceneKind) -> Selection {
        let seed = Case::seed(Task::Solve, scene);
        let value = |(key, typed): &(&'static Key, One)| {
            self.input(key, typed, key.name, &seed).map(|value| (*key, value))
        };
        Selection(inputs.iter().filter_map(value).collect())
    }

    /// What is measured, where and in which norm: at the points in the mean square, but for the settlement.
    pub(crate) fn measured(
        &mut self,
        quantity: Option<&Spanned<Named<Quantity>>>,
        sample: Option<&Spanned<Named<Sample>>>,
        norm: Option<&Spanned<Named<Norm>>>,
    ) -> Option<(Quantity, Sample, Norm)> {
        let quantity = self.choice(quantity, "quantity", Quantity::Pressure)?;
        let (usual_sample, usual_norm) = match quantity {
            Quantity::Settlement => (Sample::Surface, Norm::Relative),
            _ => (Sample::Points, Norm::L2),
        };
        let is_settlement = quantity == Quantity::Settlement;
        let places = [sample.map(Spanned::span), norm.map(Spanned::span)];
        let sample = self.choice(sample, "sample", usual_sample)?;
        let norm = self.choice(norm, "norm", usual_norm)?;
        let fits = [(sample == Sample::Surface) == is_settlement, (norm == Norm::Relative) == is_settlement];
        let words = [format!("sample = \"{}\"", sample.name()), format!("norm = \"{norm}\"")];
        let (subject, help) = if is_settlement {
            (
                "a settlement",
                "it is measured at the \"surface\", \"relative\" to the exact one: leave the key out",
            )
        } else {
            (
                "a field",
                "it is measured at \"points\", \"centres\" or \"nodes\", in the norm \"l1\", \"l2\" or \"linf\"",
            )
        };
        for ((place, fits), word) in places.into_iter().zip(fits).zip(words) {
            if let Some(place) = place.filter(|_| !fits) {
                self.complain(place, format!("{subject} has no `{word}`"), help);
            }
        }
        fits.iter().all(|fits| *fits).then_some((quantity, sample, norm))
    }

    /// The reference of an expectation: the one that it names; else the scene's own where the runs are held against it, or
    /// the only one that they are held against. Of others none is taken by the order in which they stand.
    pub(crate) fn expected_reference(
        &mut self,
        typed: Option<&Spanned<String>>,
        place: Range<usize>,
        scene: SceneKind,
        references: &[ReferenceKind],
    ) -> Option<ReferenceKind> {
        let names: Vec<&str> = references.iter().map(|kind| kind.name()).collect();
        if let Some(word) = typed {
            return Some(references[self.word(word, "reference", &names)?]);
        }
        let own = scene.references().first().filter(|own| references.contains(own));
        match (own, references) {
            (Some(own), _) | (None, [own]) => Some(*own),
            (None, []) => {
                self.complain(
                    place,
                    "the runs are held against no reference, and the expectation names none",
                    format!("add `reference = \"{NO_REFERENCE}\"`, or list some in `output.references`"),
                );
                None
            }
            (None, _) => {
                self.complain(
                    place,
                    format!(
                        "the runs are held against {}, and the expectation names none",
                        names.join(" and ")
                    ),
                    format!("add `reference = \"{}\"`", names[0]),
                );
                None
            }
        }
    }

    /// A bound at a level that is named in the words of its axis.
    fn error_bound(&mut self, level: &Spanned<LevelTable>, axis: Axis, height: f64) -> Option<ErrorBound> {
        let table = level.get_ref();
        let size = match axis {
            Axis::Cells => self
                .count(table.cells.as_deref(), "at.cells", 1..=MOST_CELLS)
                .map(|cells| height / cells as f64),
            Axis::PointsPerCell => self
                .count(table.points_per_cell.as_deref(), "at.points_per_cell", 1..=MOST_POINTS)
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
}
