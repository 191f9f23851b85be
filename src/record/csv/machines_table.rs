//! Which machines and builds the records of a study are of: what may differ between them, in one table.

use crate::record::machines::Machine;
use crate::record::provenance::Provenance;
use crate::record::{Record, WallSample};
use std::collections::BTreeMap;

/// Its columns.
const COLUMNS: [&str; 10] =
    ["node", "processor", "version", "sources", "commit", "tree", "compiler", "target", "profile", "cases"];

/// Cases by machine and build.
#[derive(Clone, Debug, Default)]
pub struct MachinesTable {
    rows: BTreeMap<(Option<Machine>, [String; 7]), usize>,
}

impl MachinesTable {
    /// Counts a record with the machine that ran it first.
    pub fn add(&mut self, record: &Record) {
        self.add_parts(&record.provenance, &record.wall);
    }

    /// Counts a record of which only this is known.
    pub fn add_parts(&mut self, origin: &Provenance, wall: &[WallSample]) {
        let tree = if origin.dirty { "changed" } else { "committed" };
        let words = [
            &origin.version,
            &origin.sources,
            &origin.commit,
            tree,
            &origin.compiler,
            &origin.target,
            &origin.profile,
        ];
        let machine = wall.first().and_then(|sample| sample.machine.clone());
        let row = self.rows.entry((machine, words.map(|word: &str| word.to_owned()))).or_default();
        *row += 1;
    }

    /// The table; what is not known is empty.
    ///
    /// # Errors
    /// Never for plain words; the writer's own otherwise.
    pub fn to_csv(&self) -> Result<String, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(COLUMNS)?;
        for ((machine, words), cases) in &self.rows {
            let of_machine = match machine {
                Some(machine) => [machine.node.as_str(), &machine.processor],
                None => ["", ""],
            };
            let cases = cases.to_string();
            let words = words.iter().map(String::as_str);
            writer.write_record(of_machine.into_iter().chain(words).chain([cases.as_str()]))?;
        }
        let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}
