//! Methods that solved the same column on several meshes: one path per method, all at one time, so that their errors can
//! be compared.

use crate::case::Case;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::{Path, SeriesSummary};
use crate::measure::statistics::largest;
use crate::render::report::StudyResults;
use crate::render::report::labels::{
    CONVERGENCE, QUOTED_CELLS, distinct, first_measure, grouped, is_settled,
};
use crate::study::expectation::Axis;
use oedometer_convergence::WINDOW;
use oedometer_mpm::scene::SceneKind;
use oedometer_soil::elementary;
use std::collections::BTreeMap;

/// The path that represents a method.
pub struct MethodPath<'a> {
    /// The method.
    pub method: String,
    /// The study that ran it.
    pub study: &'a str,
    /// Its runs, from coarse to fine.
    pub path: Path<'a>,
}

/// Methods on one column with one soil.
pub struct Regime<'a> {
    /// One path per method, in the order of their studies.
    pub methods: Vec<MethodPath<'a>>,
    /// The time factor at which most of them have errors.
    pub time_factor: f64,
    /// The solution of the scene's own equations.
    pub reference: &'static str,
    /// The finest mesh that most of the methods ran.
    pub finest_cells: usize,
}

/// The column that most methods consolidated at small strain, without waves.
pub fn small_strain<'a>(results: &'a [StudyResults<'a>]) -> Option<Regime<'a>> {
    regime(results, &|case| {
        !case.scene.is_large_strain()
            && !case.scene.has_waves()
            && !case.scene.has_plane_fields()
            && case.scene.is_loaded()
    })
}

/// The column that most methods consolidated at large strain.
pub fn large_strain<'a>(results: &'a [StudyResults<'a>]) -> Option<Regime<'a>> {
    regime(results, &|case| case.scene.is_large_strain())
}

/// Paths alike in everything but method, step and integrator, of the column with most methods, the classic one first.
fn regime<'a>(results: &'a [StudyResults<'a>], fits: &dyn Fn(&Case) -> bool) -> Option<Regime<'a>> {
    let mut groups: BTreeMap<String, (bool, &'static str, Vec<MethodPath<'a>>)> = BTreeMap::new();
    for one in results {
        let Some(reference) = one.study.references.first() else { continue };
        let is_candidate = |path: &Path<'_>| {
            let case = &path.records[0].case;
            path.records.len() >= WINDOW && case.column.dimensions == 1 && fits(case) && is_plain(case)
        };
        for path in one.paths.along(Axis::Cells).iter().filter(|path| is_candidate(path)) {
            let case = &path.records[0].case;
            let key =
                format!("{:?} {:?} {:?} {}", case.scene, case.column, case.material, case.points_per_cell);
            let method = case.method.to_string();
            let is_classic = matches!(case.scene, SceneKind::Terzaghi | SceneKind::XieLeo);
            let group = groups.entry(key).or_insert_with(|| (is_classic, reference.name(), Vec::new()));
            group.2.push(MethodPath { method, study: &one.study.name, path: path.clone() });
        }
    }
    let (_, reference, all) = groups.into_values().max_by_key(|(is_classic, _, all)| {
        (distinct(all.iter().map(|one| &one.method)).len(), *is_classic)
    })?;
    let time_factor = time_of_most(&all)?;
    let methods = best_of_each(all, reference, time_factor);
    let finest_cells = mesh_of_most(&methods)?;
    Some(Regime { methods, time_factor, reference, finest_cells })
}

/// Whether a case is of the scene's own equations, on regular points, however it is integrated.
fn is_plain(case: &Case) -> bool {
    let variant = case.variant();
    variant.is_empty() || variant.split(", ").all(|part| part.ends_with(" drag"))
}

/// The value that most methods have; the largest of several.
fn value_of_most(all: &[MethodPath<'_>], values_of: &dyn Fn(&MethodPath<'_>) -> Vec<f64>) -> Option<f64> {
    let values = all.iter().flat_map(|one| values_of(one).into_iter().map(|value| (value, &one.method)));
    let known = grouped(values).into_iter().map(|(value, methods)| (value, distinct(methods)));
    let known: Vec<(f64, Vec<&String>)> = known.collect();
    let most = known.iter().map(|(_, methods)| methods.len()).max()?;
    known.iter().filter(|(_, methods)| methods.len() == most).map(|(value, _)| *value).reduce(f64::max)
}

/// The time factor that three levels of most methods have.
fn time_of_most(all: &[MethodPath<'_>]) -> Option<f64> {
    value_of_most(all, &|one| {
        let records = &one.path.records;
        let times = records.iter().flat_map(|record| record.case.time_factors.iter()).copied();
        let asked =
            |time: &f64| records.iter().filter(|record| record.case.time_factors.contains(time)).count();
        times.filter(|time| *time > 0.0 && asked(time) >= WINDOW).collect()
    })
}

/// The finest mesh of most methods.
fn mesh_of_most(all: &[MethodPath<'_>]) -> Option<usize> {
    let finest =
        value_of_most(all, &|one| one.path.records.iter().map(|record| record.case.cells as f64).collect())?;
    all.iter()
        .flat_map(|one| &one.path.records)
        .map(|record| record.case.cells)
        .find(|cells| *cells as f64 == finest)
}

/// Rank of a path: three levels, the quoted mesh, number of series with a settled order, levels.
type Worth = (bool, bool, usize, usize);

/// The best path of each method.
fn best_of_each<'a>(all: Vec<MethodPath<'a>>, reference: &str, time_factor: f64) -> Vec<MethodPath<'a>> {
    let worth = |one: &MethodPath<'_>| {
        let series = CONVERGENCE.map(|(quantity, sample)| {
            one.path.summary(&first_measure(quantity, sample, reference, time_factor))
        });
        let settled = series.iter().filter(|summary| is_settled(summary.classification.class)).count();
        let levels = series[0].series.levels().iter().filter(|level| level.error.is_some()).count();
        let has_quoted = one.path.records.iter().any(|record| record.case.cells == QUOTED_CELLS);
        (levels >= WINDOW, has_quoted, settled, levels)
    };
    let by_method = grouped(all.into_iter().map(|one| (one.method.clone(), (worth(&one), one))));
    // The first of those with the most.
    let best =
        |own: Vec<(Worth, MethodPath<'a>)>| own.into_iter().reduce(|a, b| if b.0 > a.0 { b } else { a });
    by_method.into_iter().filter_map(|(_, own)| best(own)).map(|(_, one)| one).collect()
}

impl Regime<'_> {
    /// The series of a method's error.
    pub fn summary<'s>(&self, one: &MethodPath<'s>, quantity: Quantity, sample: Sample) -> SeriesSummary<'s> {
        one.path.summary(&first_measure(quantity, sample, self.reference, self.time_factor))
    }

    /// A method's error on a mesh.
    pub fn error(
        &self,
        one: &MethodPath<'_>,
        quantity: Quantity,
        sample: Sample,
        cells: usize,
    ) -> Option<f64> {
        let measure = first_measure(quantity, sample, self.reference, self.time_factor);
        let record = one.path.records.iter().find(|record| record.case.cells == cells)?;
        Some(measure.error(record)?.value.abs())
    }

    /// The largest of a method's errors on the finest mesh of most: of pressure and effective stress at the
    /// points, and of the settlement; `None` if one is missing.
    pub fn largest_error(&self, one: &MethodPath<'_>) -> Option<f64> {
        let errors = [
            (Quantity::Pressure, Sample::Points),
            (Quantity::EffectiveStress, Sample::Points),
            (Quantity::Settlement, Sample::Surface),
        ]
        .map(|(quantity, sample)| self.error(one, quantity, sample, self.finest_cells));
        largest(errors.into_iter().collect::<Option<Vec<f64>>>()?)
    }

    /// The method of a name.
    pub fn method(&self, name: &str) -> Option<&MethodPath<'_>> {
        self.methods.iter().find(|one| one.method == name)
    }

    /// The settlement in the end over the height, where the scene tells it by its load.
    pub fn strain(&self) -> Option<f64> {
        let case = &self.methods.first()?.path.records.first()?.case;
        Some(1.0 - elementary::exp(-case.column.load / case.material.oedometric_modulus()))
    }
}
