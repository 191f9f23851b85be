//! The cases that a study named when it was last run or merged, beside its records: a folder that is kept has the records of
//! earlier states of the study too.

use crate::case::{Case, Key};
use crate::record::Record;
use crate::record::atomic_file::{StoreError, write_rebuildable};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Name of the file in the folder of a study's results.
const FILE: &str = "named-cases.json";

/// The cases of a study in its present state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NamedCases {
    /// Inputs that the labels of the cases name, by their keys.
    swept: Vec<String>,
    /// Their hashes.
    cases: BTreeSet<String>,
}

impl NamedCases {
    /// Those of all cases of a study.
    pub fn from_cases(cases: &[&Case]) -> Self {
        let swept = cases.first().map(|case| case.swept.iter().map(|name| (*name).to_owned()).collect());
        Self { swept: swept.unwrap_or_default(), cases: cases.iter().map(|case| case.hash()).collect() }
    }

    /// Those of the study whose results lie in a folder; `None` where no run wrote them.
    pub fn read(folder: &Path) -> Option<Self> {
        serde_json::from_slice(&fs::read(folder.join(FILE)).ok()?).ok()
    }

    /// Writes them into the folder of a study's results, unless they are there already: the shares of a large study name the
    /// same cases.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, folder: &Path) -> Result<(), StoreError> {
        if Self::read(folder).as_ref() == Some(self) {
            return Ok(());
        }
        let path = folder.join(FILE);
        let json =
            serde_json::to_vec(self).map_err(|source| StoreError::Json { path: path.clone(), source })?;
        write_rebuildable(&path, &json)
    }

    /// Whether a record is of a case of the study; if so its label becomes that which it has in the study.
    pub fn names(&self, record: &mut Record) -> bool {
        let name = |key: &String| Key::named(key, "sweep").map(|key| key.name);
        record.case.swept = self.swept.iter().filter_map(name).collect();
        self.cases.contains(&record.hash)
    }
}
