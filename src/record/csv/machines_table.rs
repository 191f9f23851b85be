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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;

    #[test]
    fn every_machine_and_build_has_its_row_with_its_cases() {
        let mut records = records_of(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\n\
             method = [\"MPM\"]\nintegrator = [\"implicit\"]\ncells = [2, 3, 4, 5]\n",
        );
        let other = Machine { node: "node-7".to_owned(), processor: "Another, 3 GHz".to_owned() };
        records[1].wall[0].machine = Some(other);
        records[2].provenance.compiler = "rustc 0.0.0".to_owned();
        let mut table = MachinesTable::default();
        for record in &records {
            table.add(record);
        }
        let text = table.to_csv().expect("a table");
        let rows: Vec<csv::StringRecord> =
            csv::Reader::from_reader(text.as_bytes()).records().map(|row| row.expect("a row")).collect();
        let cases: Vec<&str> = rows.iter().map(|row| &row[9]).collect();
        assert_eq!((rows.len(), cases.iter().filter(|count| **count == "2").count()), (3, 1), "{text}");
        let node = rows.iter().find(|row| &row[0] == "node-7").expect("a row");
        assert_eq!((&node[1], &node[9]), ("Another, 3 GHz", "1"));
        assert!(rows.iter().any(|row| &row[6] == "rustc 0.0.0" && row[0] == Machine::this().node));
    }
}
