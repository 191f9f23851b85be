//! The contenders of the race, one line each: what `method = ["race"]` runs, by the names that `solve` takes.

use crate::{Case, SolverName};
use oedometer_problem::method::{Configuration, Method, Recovery};
use oedometer_scenes::scene::Clock;
use std::sync::LazyLock;

/// The word that stands for all contenders among the methods of a sweep.
pub const RACE: &str = "race";
/// The paper's method.
pub const PAPERS: &str = "GC-SRI-patch";

/// One contender.
#[derive(Clone, Copy, Debug)]
pub struct Contender {
    /// Its name.
    pub name: &'static str,
    method: Method,
}

/// The names: the paper's ladder and its sources, the field's cures, and of our own those that are the fastest somewhere or
/// the only ones to arrive.
const NAMES: [&str; 19] = [
    "MPM",
    "GIMP",
    "GIMP-null-space",
    "VP",
    "GIMP-SRI",
    "GIMP-SRI-patch",
    "GC-SRI-patch",
    "GIMP-Bbar",
    "GIMP-Bbar-patch",
    "VP-Bbar",
    "PPP",
    "B2-Bbar-patch",
    "CE-SRI-patch",
    "CE-SRI-patch-cells",
    "GC-Bbar-patch",
    "MPM-SRI-patch-moments",
    "TL-GIMP-SRI-patch",
    "TL-GC-SRI-patch",
    "TL-GC-Bbar-patch",
];

/// All contenders.
pub static CONTENDERS: LazyLock<Vec<Contender>> = LazyLock::new(|| {
    let contender = |name: &&'static str| Contender {
        name,
        method: Method::named(name).expect("a test names every method"),
    };
    NAMES.iter().map(contender).collect()
});

impl Contender {
    /// Its method: the same in every scene.
    pub fn method(&self) -> SolverName {
        SolverName::Own(self.method)
    }

    /// Whether a case of the race is its own.
    pub fn runs(&self, case: &Case) -> bool {
        case.method == self.method()
    }

    /// Why it does not race in a case: a limit of how this program has it, that would be judged instead of the method.
    pub fn unfit(&self, case: &Case) -> Option<&'static str> {
        let is_wave = matches!(case.scene.clock, Clock::Wave | Clock::Consolidation) && case.scene.waves;
        (is_wave && self.method.recovery == Recovery::Ppp).then_some(
            "the published projection parameter is quasi-static (White & Borja 2008): its storage slows waves",
        )
    }

    /// Whether its mesh follows the soil.
    pub fn is_total(&self) -> bool {
        self.method.configuration == Some(Configuration::Total)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_scenes::{TERZAGHI, XIE_LEO};

    #[test]
    fn every_contender_has_a_method_and_a_name_of_its_own_and_races_as_itself_in_every_scene() {
        assert!((14..=20).contains(&CONTENDERS.len()));
        for (place, contender) in CONTENDERS.iter().enumerate() {
            assert!(
                CONTENDERS[..place].iter().all(|other| other.name != contender.name),
                "{}",
                contender.name
            );
            assert_eq!(contender.method().to_string(), contender.name);
            assert_eq!(contender.is_total(), contender.name.starts_with("TL-"), "{}", contender.name);
            for scene in [&TERZAGHI, &XIE_LEO] {
                let mut case = Case::seed(crate::Task::Solve, scene);
                case.method = Method::named(contender.name).expect("a method").into();
                let running: Vec<&str> =
                    CONTENDERS.iter().filter(|other| other.runs(&case)).map(|other| other.name).collect();
                assert_eq!(running, [contender.name], "no alias, in {scene:?}");
            }
        }
        assert!(CONTENDERS.iter().any(|contender| contender.name == PAPERS));
    }
}
