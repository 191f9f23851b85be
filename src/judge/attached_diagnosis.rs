//! Likely causes of wrong results of attached solvers, as `score` reports them for files.

use crate::case::Case;
use crate::foreign::reading::mapping_of;
use crate::import::SampledState;
use crate::judge::score::diagnosis::diagnosis;
use crate::record::Record;
use crate::study::check::Study;
use oedometer_exact::ReferenceKind;
use oedometer_mpm::run::results::snapshot::Snapshot;
use oedometer_mpm::scene::column::column_parameters;
use std::collections::BTreeMap;

/// Sentences on the attached solvers among records; of each with the same soil and body the finest mesh is looked at.
pub fn diagnoses(study: &Study, records: &[Record]) -> Vec<String> {
    let mut finest: BTreeMap<String, &Record> = BTreeMap::new();
    for record in records.iter().filter(|record| record.attached.is_some()) {
        let rest = Case { cells: 0, ..record.case.clone() };
        let known = finest.entry(rest.label()).or_insert(record);
        if known.case.cells < record.case.cells {
            *known = record;
        }
    }
    let told = |record: &Record| {
        let label = record.case.label();
        of_record(study, record).into_iter().map(move |sentence| format!("{label}: {sentence}"))
    };
    finest.into_values().flat_map(told).collect()
}

/// Sentences on one record: none where its result is missing, or no reference is known for it.
fn of_record(study: &Study, record: &Record) -> Vec<String> {
    let case = &record.case;
    let reference = record.references.first().and_then(|used| used.name.parse::<ReferenceKind>().ok());
    let mapping =
        study.solver_of(case).and_then(|solver| mapping_of(solver, study.scene.has_plane_fields()).ok());
    let (Some(reference), Some(mapping)) = (reference, mapping) else { return Vec::new() };
    let states: Vec<SampledState> =
        record.snapshots.iter().map(|snapshot| state_of(snapshot, record)).collect();
    let parameters = column_parameters(&case.column, &case.material);
    diagnosis(&parameters, reference.of_soil(&case.material), &states, &mapping).unwrap_or_default()
}

/// A snapshot of an attached solver as the state that it was made of.
fn state_of(snapshot: &Snapshot, record: &Record) -> SampledState {
    let Some(samples) = record.main_sample().of(snapshot) else { return SampledState::default() };
    let plane = samples.plane.clone().unwrap_or_default();
    SampledState {
        time: snapshot.time,
        initial_distance: plane.initial_distance,
        initial_height: samples.initial_height.clone(),
        volume: samples.volume.clone(),
        pressure: samples.pressure.clone(),
        effective_stress: samples.effective_stress.clone(),
        displacement: samples.displacement.clone(),
        horizontal_displacement: plane.horizontal_displacement,
        surface_displacement: None,
        repeated: 0,
    }
}
