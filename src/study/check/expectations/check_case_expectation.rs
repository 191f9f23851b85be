//! Checks of what must become of single cases: the blocks `[[expect_case]]`.

use crate::case::tier::Tier;
use crate::study::case_expectation::{Bounds, CaseDemand, CaseExpectation, ErrorRange};
use crate::study::check::checker::Checker;
use crate::study::choice_tables::{Placed, Typed};
use crate::study::expectation::Measure;
use crate::study::file::{ExpectCaseTable, RangeTable};
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::run::results::outcome::FailureKind;
use oedometer_mpm::scene::SceneKind;
use toml::Spanned;

impl Checker<'_> {
    /// What single cases must do.
    pub(crate) fn case_expectation(
        &mut self,
        entry: &Spanned<ExpectCaseTable>,
        scene: SceneKind,
        references: &[ReferenceKind],
    ) -> Option<CaseExpectation> {
        let table = entry.get_ref();
        let before = self.diagnostics.len();
        let status = table.status.as_ref().and_then(|word| {
            let mut names = vec!["ok"];
            names.extend(FailureKind::ALL.map(FailureKind::name));
            self.word(word, "status", &names).map(|index| names[index].to_owned())
        });
        let error = table.error.as_ref().and_then(|range| self.error_range(table, range, scene, references));
        let bound = |c: &mut Self, typed: &Option<Placed<f64>>, name: &str| {
            typed.as_deref().map(|typed| c.positive(Some(typed), name, "", 1e-12))
        };
        let mut within = |range: &Typed<RangeTable>| range.as_ref().map(|range| self.bounds(range));
        let pore_water = within(&table.pore_water).map(|bounds| [bounds.above, bounds.below]);
        let largest_pressure = within(&table.largest_pressure);
        let peak_time_factor = within(&table.peak_time_factor);
        let peak_pressure = within(&table.peak_pressure);
        let demand = CaseDemand {
            status,
            critical_step_within: bound(self, &table.critical_step_within, "critical_step_within"),
            error,
            solid_drift_below: bound(self, &table.solid_drift_below, "solid_drift_below"),
            water_drift_below: bound(self, &table.water_drift_below, "water_drift_below"),
            pore_water,
            water_left_within: bound(self, &table.water_left_within, "water_left_within"),
            largest_pressure,
            one_layer_within: bound(self, &table.one_layer_within, "one_layer_within"),
            spurious_velocity: self.spurious_velocity(table, scene),
            peak_time_factor,
            peak_pressure,
        };
        if demand == CaseDemand::default() && self.diagnostics.len() == before {
            self.complain(
                entry.span(),
                "the expectation asks for nothing",
                "add `status = \"ok\"`, `critical_step_within = 0.02` or `error = { below = 1e-2 }`",
            );
        }
        let selection = self.selection(&table.inputs, scene);
        let tier = self.choice(table.tier.as_deref(), "tier", Tier::Ci)?;
        let line = self.source.text[..entry.span().start.min(self.source.text.len())].lines().count().max(1);
        (self.diagnostics.len() == before).then_some(CaseExpectation { selection, demand, tier, line })
    }

    /// Bounds on a velocity where there may be none.
    fn spurious_velocity(&mut self, table: &ExpectCaseTable, scene: SceneKind) -> Option<Bounds> {
        let range = table.spurious_velocity.as_ref()?;
        if !scene.is_at_rest() {
            self.complain(
                range.span(),
                format!("something is to move in the scene `{}`", scene.name()),
                "a spurious velocity is told of the scene \"at-rest\"",
            );
        }
        Some(self.bounds(range))
    }

    /// Bounds on one error of a case.
    fn error_range(
        &mut self,
        table: &ExpectCaseTable,
        range: &Spanned<RangeTable>,
        scene: SceneKind,
        references: &[ReferenceKind],
    ) -> Option<ErrorRange> {
        let (quantity, sample, norm) =
            self.measured(table.quantity.as_deref(), table.sample.as_deref(), table.norm.as_deref())?;
        let typed = table.reference.as_deref();
        let reference = self.expected_reference(typed, range.span(), scene, references)?;
        let Some(time_factor) = table.time_factor.as_ref().map(|typed| *typed.get_ref()) else {
            self.complain(range.span(), "the error names no time factor", "add `time_factor = 0.1`");
            return None;
        };
        let Bounds { above, below } = self.bounds(range);
        Some(ErrorRange {
            measure: Measure {
                quantity,
                sample,
                norm,
                reference: reference.name().to_owned(),
                time_factor,
                probe: None,
            },
            below,
            above,
        })
    }

    /// The bounds of a table, what is left out bounding nothing from above and 0 from below; a complaint where no value
    /// lies between them.
    fn bounds(&mut self, range: &Spanned<RangeTable>) -> Bounds {
        let RangeTable { above, below } = range.get_ref();
        let above = above.as_ref().map_or(0.0, |typed| *typed.get_ref());
        let below = below.as_ref().map_or(f64::MAX, |typed| *typed.get_ref());
        // What is no number is between none.
        let has_values = above < below;
        if !has_values {
            self.complain(
                range.span(),
                format!("no value lies from {above} on and below {below}"),
                "`above`, 0 where it is left out, must be smaller than `below`",
            );
        }
        Bounds { above, below }
    }
}
