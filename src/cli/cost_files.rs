//! Tables of costs: learned from the records of a folder, and read from a file.

use crate::campaign::costs::CostTable;
use crate::case::tier::Tier;
use crate::cli::exit::{Ended, Exit};
use crate::record::store::RecordStore;
use crate::study::check::Study;
use oedometer_formats::input_file;
use std::path::Path;

/// What finished cases took over what was estimated.
///
/// # Errors
/// When there are too few of them.
pub fn learned_from(studies: &[Study], tier: Tier, folder: &Path) -> anyhow::Result<CostTable> {
    let costs = CostTable::learned(studies.iter().flat_map(|study| {
        let store = RecordStore::for_cases(folder, &study.name, study.planned.len());
        study.cases(tier).into_iter().filter_map(move |case| store.finished(case))
    }));
    if costs.is_empty() {
        let reason =
            format!("{} has too few finished cases of these studies to learn from", folder.display());
        return Err(Ended::with(Exit::NothingSelected, reason));
    }
    Ok(costs)
}

/// The costs of a file, or those by formula.
///
/// # Errors
/// When the file is no table of costs.
pub fn costs_of(file: Option<&Path>) -> anyhow::Result<CostTable> {
    let Some(path) = file else { return Ok(CostTable::default()) };
    let text = input_file::read_text(path)
        .map_err(|error| Ended::usage(format!("cannot read the costs {}: {error}", path.display())))?;
    CostTable::parse(&text).map_err(|error| Ended::usage(format!("{}: {error}", path.display())))
}
