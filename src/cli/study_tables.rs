//! The tables of a study, made of the records that its store keeps, one record at a time.

use crate::case::Case;
use crate::case::tier::Tier;
use crate::cli::stream::say;
use crate::record::Record;
use crate::record::csv::long_tables::{LongTable, columns_csv};
use crate::record::csv::machines_table::MachinesTable;
use crate::record::csv::packed_table::{packed_rows, write_packed_table};
use crate::record::csv::table_file::TableForm;
use crate::record::csv::tidy;
use crate::record::provenance::Provenance;
use crate::record::store::RecordStore;
use crate::record::whole_file::write_whole;
use crate::study::check::Study;
use std::borrow::Cow;
use std::collections::HashMap;
use std::collections::hash_map;
use std::path::PathBuf;

/// Cases up to which a table is plain CSV; that of more is compressed, to a fifteenth.
const MOST_PLAIN_CASES: usize = 2000;

/// Table of the machines and builds beside that of the measures.
const MACHINES: &str = "machines.csv";

/// What is written beside the tidy table of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// Nothing.
    Nothing,
    /// Tables of profiles, of settlement over time, and of what every column means; the first two in a form. Of a
    /// packed study the last alone: `oedometer records` prints the others.
    Tables(TableForm),
}

/// Writes the CSV of every record that a store keeps of a study, whichever run made it: a run of
/// one tier or shard takes nothing away from what others found. Those that are at hand are not
/// read again.
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
    let table = if is_compressed(store, cases.len()) {
        compressed_table(study, store, &cases)?
    } else {
        single_tables(study, store, at_hand, &cases, beside)?
    };
    if let Beside::Tables(_) = beside {
        write_whole(&store.folder().join("columns.csv"), columns_csv()?.as_bytes())?;
    }
    Ok(table)
}

/// Whether the table of a study of so many cases is compressed.
pub fn is_compressed(store: &RecordStore, cases: usize) -> bool {
    store.is_packed() && cases > MOST_PLAIN_CASES
}

/// Says how many records of a table are of other sources.
fn tell_of_foreign(study: &Study, foreign: usize) {
    if foreign > 0 {
        say!("{}: {foreign} older records in the table are of other sources", study.name);
    }
}

/// Makes rows with every record that there is of some cases, in their order.
fn with_records(
    store: &RecordStore,
    at_hand: &HashMap<&str, &Record>,
    cases: &[&Case],
    mut take: impl FnMut(&Record) -> std::io::Result<()>,
) -> std::io::Result<()> {
    for case in cases {
        let record = match at_hand.get(case.hash().as_str()) {
            Some(record) => Some(Cow::Borrowed(*record)),
            None => store.kept(case).map(Cow::Owned),
        };
        if let Some(record) = record {
            take(&record)?;
        }
    }
    Ok(())
}

fn single_tables(
    study: &Study,
    store: &RecordStore,
    at_hand: &[Record],
    cases: &[&Case],
    beside: Beside,
) -> anyhow::Result<PathBuf> {
    let at_hand: HashMap<&str, &Record> =
        at_hand.iter().map(|record| (record.hash.as_str(), record)).collect();
    let own = Provenance::of_this_program().sources;
    let (mut foreign, mut machines) = (0, MachinesTable::default());
    let form = match beside {
        Beside::Nothing => TableForm::Plain,
        Beside::Tables(form) => form,
    };
    let table = form.write(store.folder(), &study.name, &tidy::header_line(), |out| {
        with_records(store, &at_hand, cases, |record| {
            foreign += usize::from(record.provenance.sources != own);
            machines.add(record);
            out.write_all(tidy::rows_of(&study.name, record).as_bytes())
        })
    })?;
    tell_of_foreign(study, foreign);
    write_whole(&store.folder().join(MACHINES), machines.to_csv()?.as_bytes())?;
    let with_long_tables = beside != Beside::Nothing && !store.is_packed();
    for long in LongTable::ALL.into_iter().filter(|_| with_long_tables) {
        form.write(store.folder(), long.name(), &long.header_line(), |out| {
            with_records(store, &at_hand, cases, |record| Ok(long.write_rows(&mut *out, record)?))
        })?;
    }
    Ok(table)
}

/// Writes which machines and builds the records of a packed study are of.
///
/// # Errors
/// When the file system refuses.
pub fn write_machines(study: &Study, store: &RecordStore) -> anyhow::Result<()> {
    let mut machines = MachinesTable::default();
    let mut builds: HashMap<(u64, u64), Provenance> = HashMap::new();
    for case in study.cases(Tier::Full) {
        let Some((entry, wall)) = store.entry_and_wall(case) else { continue };
        let tags = (entry.program, entry.build);
        if let hash_map::Entry::Vacant(place) = builds.entry(tags)
            && let Some(origin) = store.origin(case)
        {
            place.insert(origin);
        }
        if let Some(origin) = builds.get(&tags) {
            machines.add_parts(origin, &wall);
        }
    }
    Ok(write_whole(&store.folder().join(MACHINES), machines.to_csv()?.as_bytes())?)
}

fn compressed_table(study: &Study, store: &RecordStore, cases: &[&Case]) -> anyhow::Result<PathBuf> {
    let own = Provenance::of_this_program();
    let mut foreign = 0;
    let entries = cases.iter().filter_map(|case| {
        let entry = store.entry(case)?;
        foreign += usize::from(entry.program != own.program_tag());
        Some((entry.rows(), *case))
    });
    let table = store.folder().join(format!("{}.csv.gz", study.name));
    let mut rows_at_hand = store.take_rows_at_hand();
    write_packed_table(&table, &tidy::header_line(), entries, |rows, case| {
        if let Some(member) = rows_at_hand.as_mut().and_then(|at_hand| at_hand.packed(rows)) {
            return Some(Ok(member));
        }
        let record = store.kept(case)?;
        Some(packed_rows(rows, &tidy::rows_of(&study.name, &record)))
    })?;
    tell_of_foreign(study, foreign);
    Ok(table)
}
