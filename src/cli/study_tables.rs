//! Writes the tables of a study from its stored records.

use crate::case::Case;
use crate::case::tier::Tier;
use crate::cli::stream::say;
use crate::record::Record;
use crate::record::csv::long_tables::{LongTable, MachinesTable, columns_csv};
use crate::record::csv::table_file::TableForm;
use crate::record::csv::tidy;
use crate::record::provenance::Provenance;
use crate::record::store::RecordStore;
use crate::record::whole_file::write_whole;
use crate::study::check::Study;
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// Cases up to which a table is plain CSV; that of more is compressed, to a fifteenth.
const MOST_PLAIN_CASES: usize = 2000;

/// What is written beside the tidy table of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// The table of machines alone.
    Machines,
    /// Tables of profiles, of settlement over time, and of what every column means too; the first two in a form. Of a
    /// packed study the last alone: `oedometer records` prints the others.
    Tables(TableForm),
}

/// Whether the tables of a study are compressed, whatever was asked for.
pub fn is_compressed(study: &Study, store: &RecordStore) -> bool {
    store.is_packed() && study.planned.len() > MOST_PLAIN_CASES
}

/// Writes the CSV of every record that a store keeps of a study, whichever run made it: a run of one tier or shard takes
/// nothing away from what others found. Those that are at hand are not read again.
pub fn write_table(
    study: &Study,
    store: &RecordStore,
    at_hand: &[Record],
    beside: Beside,
) -> anyhow::Result<PathBuf> {
    store.refresh();
    for damage in store.damages() {
        say!("{}: {damage}", study.name);
    }
    let cases = study.cases(Tier::Full);
    let form = match beside {
        _ if is_compressed(study, store) => TableForm::Compressed,
        Beside::Machines => TableForm::Plain,
        Beside::Tables(form) => form,
    };
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
    let counts = Mutex::new((MachinesTable::default(), 0_usize));
    let table = write(&study.name, tidy::header_line(), &|record| {
        let mut counts = counts.lock().unwrap_or_else(PoisonError::into_inner);
        counts.0.add(record);
        counts.1 += usize::from(record.provenance.sources != own);
        drop(counts);
        tidy::rows_of(&study.name, record)
    })?;
    let (machines, foreign) = counts.into_inner().unwrap_or_else(PoisonError::into_inner);
    if foreign > 0 {
        say!("{}: {foreign} older records in the table are of other sources", study.name);
    }
    write_whole(&store.folder().join("machines.csv"), machines.to_csv()?.as_bytes())?;
    if let Beside::Tables(_) = beside {
        for long in LongTable::ALL.into_iter().filter(|_| !store.is_packed()) {
            write(long.name(), long.header_line(), &|record| long.rows_of(record))?;
        }
        write_whole(&store.folder().join("columns.csv"), columns_csv()?.as_bytes())?;
    }
    Ok(table)
}
