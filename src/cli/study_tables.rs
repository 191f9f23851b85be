//! Writes the tables of a study from its stored records.

use crate::case::Case;
use crate::case::planned::Tier;
use crate::cli::stream::say;
use crate::record::Record;
use crate::record::csv::long_tables::{LongTable, columns_csv};
use crate::record::csv::table_file::TableForm;
use crate::record::csv::tidy;
use crate::record::provenance::Provenance;
use crate::record::store::RecordStore;
use crate::record::whole_file::write_whole;
use crate::study::check::Study;
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Cases up to which a table is plain CSV; that of more is compressed, to a fifteenth.
const MOST_PLAIN_CASES: usize = 2000;

/// Whether the tables of a study are compressed, whatever was asked for.
pub fn is_compressed(study: &Study, store: &RecordStore) -> bool {
    store.is_packed() && study.planned.len() > MOST_PLAIN_CASES
}

/// Writes the CSV of every record that a store keeps of a study, whichever run made it: a run of one tier or shard takes
/// nothing away from what others found. Those that are at hand are not read again. With a form for the tables beside it
/// those of profiles, of settlement over time, and of what every column means are written too; of a packed study the
/// last alone: `oedometer records` prints the others.
pub fn write_table(
    study: &Study,
    store: &RecordStore,
    at_hand: &[Record],
    beside: Option<TableForm>,
) -> anyhow::Result<PathBuf> {
    store.refresh();
    for damage in store.damages() {
        say!("{}: {damage}", study.name);
    }
    let cases = study.cases(Tier::Full);
    let asked = beside.unwrap_or(TableForm::Plain);
    let form = if is_compressed(study, store) { TableForm::Compressed } else { asked };
    let at_hand: HashMap<&str, &Record> =
        at_hand.iter().map(|record| (record.hash.as_str(), record)).collect();
    let record_of = |case: &Case| match at_hand.get(case.hash().as_str()) {
        Some(record) => Some(Cow::Borrowed(*record)),
        None => store.kept(case).map(Cow::Owned),
    };
    let write = |name: &str, header, rows: &(dyn Fn(&Record) -> csv::Result<String> + Sync)| {
        form.write(store.folder(), name, header, &cases, |case| match record_of(case) {
            Some(record) => Ok(rows(&record)?),
            None => Ok(String::new()),
        })
    };
    let own = Provenance::of_this_program().sources;
    let foreign = AtomicUsize::new(0);
    let table = write(&study.name, tidy::header_line(), &|record| {
        foreign.fetch_add(usize::from(record.provenance.sources != own), Ordering::Relaxed);
        tidy::rows_of(&study.name, record)
    })?;
    let foreign = foreign.into_inner();
    if foreign > 0 {
        say!("{}: {foreign} older records in the table are of other sources", study.name);
    }
    if beside.is_some() {
        for long in LongTable::ALL.into_iter().filter(|_| !store.is_packed()) {
            write(long.name(), long.header_line(), &|record| long.rows_of(record))?;
        }
        write_whole(&store.folder().join("columns.csv"), columns_csv()?.as_bytes())?;
    }
    Ok(table)
}
