//! The contenders of the race, one line each: what `method = ["race"]` runs.

use crate::case::{Case, Key, Solver, Value};
use oedometer_mpm::method::{Configuration, Memory, Method};
use oedometer_mpm::scene::SceneKind;
use std::sync::LazyLock;

/// The word that stands for all contenders among the methods of a sweep.
pub const RACE: &str = "race";
/// The paper's method.
pub const PAPERS: &str = "GC-SRI-patch";

/// Inputs of a contender beside its method.
type Inputs = &'static [(&'static str, Value)];

/// One contender: a method, with choices of the integrator where it has some of its own.
#[derive(Clone, Copy, Debug)]
pub struct Contender {
    /// Its name in tables.
    pub name: &'static str,
    method: Method,
    inputs: Inputs,
}

/// Choices that matter for points that move, and for no others.
const OF_MOVING_POINTS: [&str; 2] = ["affine", "stress_slopes"];
const SLOPES: Inputs = &[("affine", Value::Flag(true)), ("stress_slopes", Value::Flag(true))];

/// The lines: a name, which is that of a method where no other one is given, and its other inputs.
const LINES: [(&str, Option<&str>, Inputs); 29] = [
    ("MPM", None, &[]),
    ("GIMP", None, &[]),
    ("CPDI", None, &[]),
    ("GIMP-mean", None, &[]),
    ("GIMP-null-space", None, &[]),
    ("VP", None, &[]),
    ("PPP", None, &[]),
    ("GIMP-SRI", None, &[]),
    ("GIMP-SRI-nodal", None, &[]),
    ("GIMP-SRI-patch", None, &[]),
    ("uGIMP-SRI-patch", None, &[]),
    ("GC-SRI-patch", None, &[]),
    ("VP-Bbar", None, &[]),
    ("GIMP-Bbar", None, &[]),
    ("GIMP-Bbar-patch", None, &[]),
    ("GC-Bbar-patch", None, &[]),
    ("GIMP-SRI-patch-soils", None, &[]),
    ("CPDI-SRI-patch", None, &[]),
    ("CE-SRI-patch", None, &[]),
    ("CE-SRI-patch-cells", None, &[]),
    ("TL-GIMP-SRI-patch", None, &[]),
    ("TL-GC-SRI-patch", None, &[]),
    ("TL-GC-Bbar-patch", None, &[]),
    ("B2", None, &[]),
    ("B2-SRI-patch", None, &[]),
    ("B2-Bbar-patch", None, &[]),
    ("B3-SRI-patch", None, &[]),
    ("TL-MPM-SRI-patch-moments", None, &[]),
    ("GIMP-SRI-patch-slopes", Some("GIMP-SRI-patch"), SLOPES),
];

/// All contenders.
pub static CONTENDERS: LazyLock<Vec<Contender>> = LazyLock::new(|| {
    let of_line = |(name, method, inputs): &(&'static str, Option<&str>, Inputs)| {
        let method = Method::named(method.unwrap_or(name)).expect("a test names every method");
        Contender { name, method, inputs }
    };
    LINES.iter().map(of_line).collect()
});

impl Contender {
    /// Its method in a scene. Where nothing moves, shape functions are those of the initial configuration anyway, and the
    /// points of a cell stay its own: a method with the prefix `TL-` or the suffix `-cells` is the one without it.
    pub fn method_in(&self, scene: SceneKind) -> Solver {
        let is_plain = scene.configuration() == Configuration::Frozen;
        let configuration = self.method.configuration.filter(|_| !is_plain);
        let memory = if is_plain { Memory::Points } else { self.method.memory };
        Solver::Own(Method { configuration, memory, ..self.method })
    }

    /// Its value of an input in a scene, where it has one of its own.
    pub fn value(&self, key: &str, scene: SceneKind) -> Option<Value> {
        let is_idle = scene.configuration() == Configuration::Frozen && OF_MOVING_POINTS.contains(&key);
        let own = || self.inputs.iter().find(|(name, _)| *name == key).map(|(_, value)| *value);
        if key == "method" { Some(Value::Method(self.method_in(scene))) } else { own().filter(|_| !is_idle) }
    }

    /// Whether a case of the race is its own.
    pub fn runs(&self, case: &Case) -> bool {
        let contested = LINES.iter().flat_map(|line| line.2).map(|(name, _)| *name);
        case.method == self.method_in(case.scene)
            && contested.filter_map(|name| Key::named(name, "sweep")).all(|key| {
                let usual = || key.get(&Case::seed(case.task, case.scene));
                key.get(case) == self.value(key.name, case.scene).unwrap_or_else(usual)
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_contender_has_a_method_and_a_name_of_its_own() {
        assert!(CONTENDERS.len() >= 20);
        for (place, one) in CONTENDERS.iter().enumerate() {
            assert!(CONTENDERS[..place].iter().all(|other| other.name != one.name), "{}", one.name);
            assert!(one.inputs.iter().all(|(key, _)| Key::named(key, "sweep").is_some()), "{}", one.name);
        }
    }

    #[test]
    fn where_nothing_moves_a_total_method_and_one_with_cells_are_the_plain_ones() {
        let of = |name: &str, scene| {
            CONTENDERS.iter().find(|one| one.name == name).map(|one| one.method_in(scene))
        };
        assert_eq!(of("TL-GC-SRI-patch", SceneKind::Terzaghi), of("GC-SRI-patch", SceneKind::Terzaghi));
        assert_ne!(of("TL-GC-SRI-patch", SceneKind::XieLeo), of("GC-SRI-patch", SceneKind::XieLeo));
        assert_eq!(of("CE-SRI-patch-cells", SceneKind::Terzaghi), of("CE-SRI-patch", SceneKind::Terzaghi));
        assert_ne!(of("CE-SRI-patch-cells", SceneKind::XieLeo), of("CE-SRI-patch", SceneKind::XieLeo));
    }

    #[test]
    fn a_case_is_run_for_the_contenders_of_its_method_and_choices_only() {
        use SceneKind::{Terzaghi, XieLeo};
        let (plain, slopes) = (["GIMP-SRI-patch"], ["GIMP-SRI-patch-slopes"]);
        let all = ["GIMP-SRI-patch", "TL-GIMP-SRI-patch", "GIMP-SRI-patch-slopes"];
        for (scene, method, affine, stress_slopes, wanted) in [
            (XieLeo, "GIMP-SRI-patch", false, false, &plain[..]),
            (XieLeo, "GIMP-SRI-patch", true, true, &slopes),
            (XieLeo, "GIMP-SRI-patch", true, false, &[]),
            (XieLeo, "GIMP-SRI-patch", false, true, &[]),
            (XieLeo, "GC-SRI-patch", false, false, &["GC-SRI-patch"]),
            (XieLeo, "GC-SRI-patch", true, true, &[]),
            (XieLeo, "GC-SRI-patch", true, false, &[]),
            (XieLeo, "TL-GC-SRI-patch", false, false, &["TL-GC-SRI-patch"]),
            (XieLeo, "PPP", false, false, &[]),
            // Where nothing moves nobody has slopes, and a total method is the plain one.
            (Terzaghi, "GIMP-SRI-patch", false, false, &all),
            (Terzaghi, "GIMP-SRI-patch", true, true, &[]),
            (Terzaghi, "GIMP-SRI-patch", true, false, &[]),
            (Terzaghi, "GIMP-SRI-patch", false, true, &[]),
            (Terzaghi, "GC-SRI-patch", false, false, &["GC-SRI-patch", "TL-GC-SRI-patch"]),
        ] {
            let mut case = Case::seed(crate::case::Task::Solve, scene);
            case.method = Method::named(method).expect("a method").into();
            (case.settings.affine, case.settings.stress_slopes) = (affine, stress_slopes);
            // What no contender has of its own is free.
            (case.settings.flip, case.cells) = (0.5, 7);
            let found: Vec<_> = CONTENDERS.iter().filter(|one| one.runs(&case)).map(|one| one.name).collect();
            assert_eq!(found, wanted, "{scene:?} {method} {affine} {stress_slopes}");
        }
    }
}
