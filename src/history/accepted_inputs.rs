//! The inputs that golden values were accepted for: those of the study at the commit of its golden file, or of the built-in one.

use crate::case::Case;
use crate::golden::GoldenFile;
use crate::golden::inputs::InputChange;
use crate::history::repository::Repository;
use crate::history::state::cases_of_study;
use crate::study::check::Study;
use crate::study::shipped::shipped_study;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// What differs between the inputs that golden values in a folder were accepted for and those of a study in a file. Empty where
/// nothing tells the earlier inputs: only cases that have the hashes of the golden values count as theirs.
pub(crate) fn changes_since(
    hashes: &BTreeMap<Arc<str>, String>,
    study: &Study,
    file: &Path,
    folder: &Path,
) -> Vec<InputChange> {
    let now: BTreeMap<String, Case> =
        study.planned.iter().map(|planned| (planned.case.label(), planned.case.clone())).collect();
    let is_accepted = |label: &String, case: &mut Case| hashes.get(label.as_str()) == Some(&case.hash());
    let built_in = || shipped_study(&study.name).map(|source| source.text);
    let earlier = [text_at_acceptance(study, file, folder), built_in()];
    let cases = earlier.into_iter().flatten().filter_map(|text| cases_of_study(&study.name, &text));
    let accepted = cases.map(|mut cases| {
        cases.retain(is_accepted);
        InputChange::between(&cases, &now)
    });
    accepted.into_iter().find(|changes| !changes.is_empty()).unwrap_or_default()
}

/// The text of a study at the last commit of its golden file.
fn text_at_acceptance(study: &Study, file: &Path, folder: &Path) -> Option<String> {
    let repository = Repository::around(folder).ok()?;
    let below = |path: &Path| {
        let path = path.canonicalize().ok()?;
        Some(path.strip_prefix(repository.root().canonicalize().ok()?).ok()?.to_str()?.replace('\\', "/"))
    };
    let golden = below(&GoldenFile::path(folder, &study.name))?;
    let commit = repository.run(&["log", "-1", "--format=%H", "--", &golden]).ok()?;
    let object = format!("{}:{}", commit.trim(), below(file)?);
    repository.texts(std::slice::from_ref(&object)).ok()?.remove(&object)
}
