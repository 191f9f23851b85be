//! Checks of what is said about single cases: where their points lie, and what must become of them.

use crate::case::Task;
use crate::case::norm::Norm;
use crate::case::quantity::{Quantity, Sample};
use crate::case::tier::Tier;
use crate::exact::reference::ReferenceKind;
use crate::mpm::run::integrator::IntegratorKind;
use crate::mpm::run::outcome::FailureKind;
use crate::scene::SceneKind;
use crate::scene::arrangement::Arrangement;
use crate::study::case_expectation::{CaseDemand, CaseExpectation, ErrorRange, Selection};
use crate::study::check::{Checker, MOST_CELLS, MOST_POINTS};
use crate::study::expectation::Measure;
use crate::study::file::{ExpectCaseTable, PointsTable, RangeTable, StudyFile};
use toml::Spanned;

impl Checker<'_> {
    /// What is done with the cases.
    pub(crate) fn task(&mut self, file: &StudyFile) -> Option<Task> {
        match &file.task {
            Some(word) => Some(Task::ALL[self.word(word, "task", &Task::ALL.map(Task::name))?]),
            None => Some(Task::default()),
        }
    }

    /// What single cases must do, all of it.
    pub(crate) fn case_expectations(
        &mut self,
        file: &StudyFile,
        scene: SceneKind,
        references: &[ReferenceKind],
    ) -> Vec<CaseExpectation> {
        file.expect_case.iter().filter_map(|entry| self.case_expectation(entry, scene, references)).collect()
    }

    /// Where the points lie in their cells.
    pub(crate) fn arrangement(&mut self, table: &PointsTable) -> Arrangement {
        let regular = Arrangement::default();
        let filling = table.filling.as_ref().map_or(regular.filling, |typed| *typed.get_ref());
        if let Some(typed) = table.filling.as_ref().filter(|_| !(filling > 0.0 && filling <= 1.0)) {
            self.complain(
                typed.span(),
                format!("`points.filling` is {filling}"),
                "it is the share of the top cell that is filled: more than 0, at most 1",
            );
        }
        Arrangement {
            offset: table.offset.as_ref().map_or(Some(0.0), |typed| self.offset(typed)).unwrap_or(0.0),
            jitter: table.jitter.as_ref().map_or(Some(0.0), |typed| self.offset(typed)).unwrap_or(0.0).abs(),
            filling,
        }
    }

    /// A shift of points, in spacings.
    pub(crate) fn offset(&mut self, typed: &Spanned<f64>) -> Option<f64> {
        let offset = *typed.get_ref();
        if (-0.5..=0.5).contains(&offset) {
            // No shift downwards is none: both zeros are one case.
            return Some(offset + 0.0);
        }
        self.complain(
            typed.span(),
            format!("points shifted by {offset} spacings"),
            "half a spacing up or down, 0.5 or -0.5, is as far as they go",
        );
        None
    }

    /// What single cases must do.
    fn case_expectation(
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
        let bound = |c: &mut Self, typed: &Option<Spanned<f64>>, name: &str| {
            typed.as_ref().map(|typed| c.positive(Some(typed), name, "", 1e-12))
        };
        let demand = CaseDemand {
            status,
            critical_step_within: bound(self, &table.critical_step_within, "critical_step_within"),
            error,
            solid_drift_below: bound(self, &table.solid_drift_below, "solid_drift_below"),
            water_drift_below: bound(self, &table.water_drift_below, "water_drift_below"),
        };
        if demand == CaseDemand::default() && self.diagnostics.len() == before {
            self.complain(
                entry.span(),
                "the expectation asks for nothing",
                "add `status = \"ok\"`, `critical_step_within = 0.02` or `error = { below = 1e-2 }`",
            );
        }
        let integrator = table.integrator.as_ref().and_then(|word| {
            let names = IntegratorKind::ALL.map(IntegratorKind::name);
            self.word(word, "integrator", &names).map(|index| IntegratorKind::ALL[index])
        });
        let selection = Selection {
            method: table.method.as_ref().and_then(|typed| self.method(typed)),
            integrator,
            cells: self.count(table.cells.as_ref(), "cells", 1..=MOST_CELLS),
            points_per_cell: self.count(table.points_per_cell.as_ref(), "points_per_cell", 1..=MOST_POINTS),
            drag: table.drag.as_ref().and_then(|word| self.drag(word)),
            scheme: table.scheme.as_ref().and_then(|word| self.scheme(word)),
        };
        let tiers = Tier::ALL.map(Tier::name);
        let tier = table.tier.as_ref().map_or(Some(1), |word| self.word(word, "tier", &tiers))?;
        let line = self.source.text[..entry.span().start.min(self.source.text.len())].lines().count().max(1);
        (self.diagnostics.len() == before).then_some(CaseExpectation {
            selection,
            demand,
            tier: Tier::ALL[tier],
            line,
        })
    }

    /// Bounds on one error of a case.
    fn error_range(
        &mut self,
        table: &ExpectCaseTable,
        range: &Spanned<RangeTable>,
        scene: SceneKind,
        references: &[ReferenceKind],
    ) -> Option<ErrorRange> {
        let quantity =
            self.choice(table.quantity.as_ref(), "quantity", &Quantity::ALL.map(Quantity::name), 0)?;
        let quantity = Quantity::ALL[quantity];
        let at_surface = quantity == Quantity::Settlement;
        let (usual_sample, usual_norm) =
            if at_surface { (Sample::Surface, Norm::Relative) } else { (Sample::Points, Norm::L2) };
        let place = |all: &[Sample]| all.iter().position(|one| *one == usual_sample).unwrap_or(0);
        let usual = place(&Sample::ALL);
        let sample = self.choice(table.sample.as_ref(), "sample", &Sample::ALL.map(Sample::name), usual)?;
        let usual = Norm::ALL.iter().position(|one| *one == usual_norm).unwrap_or(0);
        let norm = self.choice(table.norm.as_ref(), "norm", &Norm::ALL.map(Norm::name), usual)?;
        let names: Vec<&str> = references.iter().map(|kind| kind.name()).collect();
        let reference = match &table.reference {
            Some(word) => references[self.word(word, "reference", &names)?],
            None => scene.references()[0],
        };
        let Some(time_factor) = table.time_factor.as_ref().map(|typed| *typed.get_ref()) else {
            self.complain(range.span(), "the error names no time factor", "add `time_factor = 0.1`");
            return None;
        };
        Some(ErrorRange {
            measure: Measure {
                quantity,
                sample: Sample::ALL[sample],
                norm: Norm::ALL[norm],
                reference: reference.name().to_owned(),
                time_factor,
                probe: None,
            },
            below: range.get_ref().below.as_ref().map_or(f64::MAX, |typed| *typed.get_ref()),
            above: range.get_ref().above.as_ref().map_or(0.0, |typed| *typed.get_ref()),
        })
    }
}
