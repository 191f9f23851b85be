//! Labels that tell the cases of a study apart: what they differ in and would not say is named.

use crate::case::Case;
use crate::case::keys::Key;
use crate::case::planned::PlannedCase;
use crate::study::check::checker::Checker;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

impl Checker<'_> {
    /// Makes every case name the inputs that only tell some of them apart by their hashes. Golden values, tables and
    /// `explain` know a case by its label.
    pub(crate) fn tell_apart(planned: &mut [PlannedCase]) {
        // By the hash of its label: that two labels have one makes a name longer and no case another.
        let mut first_with: HashMap<u64, usize> = HashMap::new();
        let mut alike_so_far: Vec<&Key> = Key::of("sweep").collect();
        for (place, PlannedCase { case, .. }) in planned.iter().enumerate() {
            let first = *first_with.entry(hash_of(&case.label())).or_insert(place);
            if first != place {
                alike_so_far.retain(|key| key.get(&planned[first].case) == key.get(case));
            }
        }
        let differ = |key: &&Key| !alike_so_far.contains(key);
        let keys = Key::of("sweep").filter(differ).map(|key| key.name);
        let names: Arc<[&'static str]> = keys.filter(|name| is_of_the_scene(name, planned)).collect();
        for planned in planned {
            planned.case.swept = Arc::clone(&names);
        }
    }
}

fn hash_of(label: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(label.as_bytes());
    hasher.finish()
}

/// Whether a key is what its scene calls the input: a column has a width where a layer has a length, and a load where a
/// motion has a pressure.
fn is_of_the_scene(name: &str, planned: &[PlannedCase]) -> bool {
    let other_names = |case: &Case| {
        [
            if case.scene.is_a_layer() { "width" } else { "length" },
            if case.scene.is_manufactured() { "load" } else { "pressure" },
        ]
    };
    planned.first().is_none_or(|planned| !other_names(&planned.case).contains(&name))
}

#[cfg(test)]
mod tests {
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    fn labels(sweep: &str) -> Vec<String> {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\n[[sweep]]\nmethod = [\"MPM\"]\nintegrator = [\"implicit\"]\n\
             cells = [4]\ntime_step = [{{ growth = 0.1 }}]\n{sweep}\n"
        );
        let study = Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound");
        study.planned.iter().map(|planned| planned.case.label()).collect()
    }

    #[test]
    fn cases_that_would_be_called_alike_name_what_they_differ_in() {
        let plain = "MPM implicit cells=4 points=2 growth=0.1";
        assert_eq!(labels("youngs_modulus = [2e5]"), [plain], "one soil needs no name");
        assert_eq!(
            labels("youngs_modulus = [2e5, 1e6]\nporosity = [0.4]"),
            [format!("{plain} (youngs_modulus=200000)"), format!("{plain} (youngs_modulus=1000000)")]
        );
        assert_eq!(
            labels("height = [1.0, 2.0]\nload = [1, 1e5]"),
            ["1, load=1", "1, load=100000", "2, load=1", "2, load=100000"]
                .map(|values| format!("{plain} (height={values})"))
        );
    }

    #[test]
    fn the_name_is_no_part_of_the_identity() {
        let of = |sweep: &str| {
            let text = format!(
                "title = \"t\"\nscene = \"terzaghi\"\n[[sweep]]\nmethod = [\"MPM\"]\ncells = [4]\n{sweep}\n"
            );
            Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound").planned[0]
                .case
                .clone()
        };
        let (alone, among) = (of("porosity = [0.4]"), of("porosity = [0.4, 0.5]"));
        assert_ne!(alone.label(), among.label());
        assert_eq!(alone.hash(), among.hash());
    }
}
