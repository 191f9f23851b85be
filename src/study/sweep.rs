//! Sweeps: lists of choices, multiplied out or tied to a path.

use crate::case::{Case, Key, Value};

/// The values of one key in a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptKey {
    /// The key.
    pub key: &'static Key,
    /// Its values in turn.
    pub values: Vec<Value>,
}

/// One block of a study, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// What is varied, in the order of the table of keys: the slowest first.
    pub keys: Vec<SweptKey>,
    /// Keys that step together, by name.
    pub path: Vec<String>,
}

impl Sweep {
    /// A key of a path that has not as many values as its first, with both numbers: a path has one length.
    pub fn uneven_path(&self) -> Option<(String, usize, usize)> {
        let length = |name: &String| {
            self.keys.iter().find(|swept| swept.key.name == name).map_or(1, |swept| swept.values.len())
        };
        let first = length(self.path.first()?);
        self.path.iter().find_map(|name| {
            let own = length(name);
            (own != first).then(|| (name.clone(), own, first))
        })
    }

    fn is_tied(&self, at: usize) -> bool {
        self.path.iter().any(|name| name == self.keys[at].key.name)
    }

    /// The key at whose place the path counts as one: its first member.
    fn leader(&self) -> Option<usize> {
        (0..self.keys.len()).find(|at| self.is_tied(*at))
    }

    /// Keys that turn on their own, the slowest first.
    fn turning(&self) -> Vec<usize> {
        let leader = self.leader();
        (0..self.keys.len()).filter(|at| !self.is_tied(*at) || Some(*at) == leader).collect()
    }

    /// How many combinations there are; none where no machine could count them.
    pub fn count(&self) -> Option<usize> {
        let length = |at: usize| self.keys[at].values.len();
        self.turning().into_iter().try_fold(1_usize, |count, at| count.checked_mul(length(at)))
    }

    /// A case for every combination, the first key slowest; what is not varied it has from `base`. The keys of
    /// a path step together. None at all where they cannot be counted.
    pub fn cases(&self, base: &Case) -> impl Iterator<Item = Case> {
        let (turning, leader) = (self.turning(), self.leader());
        (0..self.count().unwrap_or(0)).map(move |number| {
            let mut place = vec![0; self.keys.len()];
            let mut rest = number;
            for at in turning.iter().rev() {
                place[*at] = rest % self.keys[*at].values.len();
                rest /= self.keys[*at].values.len();
            }
            let mut case = base.clone();
            for (at, swept) in self.keys.iter().enumerate() {
                let tied = leader.filter(|_| self.is_tied(at));
                swept.key.set(&mut case, swept.values[tied.map_or(place[at], |leader| place[leader])]);
            }
            case
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_mpm::method::Method;
    use oedometer_mpm::run::TimeStepRule;
    use oedometer_mpm::scene::SceneKind;

    const STEPS: [f64; 3] = [4e-6, 2e-6, 1e-6];

    fn swept(name: &str, values: Vec<Value>) -> SweptKey {
        SweptKey { key: Key::named(name, "sweep").expect("a key"), values }
    }

    fn sweep(path: &[&str]) -> Sweep {
        let methods = ["GIMP", "GC-SRI-patch"].iter().filter_map(|name| Method::named(name));
        Sweep {
            keys: vec![
                swept("method", methods.map(|method| Value::Method(method.into())).collect()),
                swept("cells", [5, 10, 20].map(Value::Count).to_vec()),
                swept("time_step", STEPS.map(|s| Value::TimeStep(TimeStepRule::Seconds(s))).to_vec()),
            ],
            path: path.iter().map(|key| (*key).to_owned()).collect(),
        }
    }

    fn cases(sweep: &Sweep) -> Vec<Case> {
        sweep.cases(&Case::seed(Task::Solve, SceneKind::Terzaghi)).collect()
    }

    #[test]
    fn a_product_has_every_combination_once() {
        let all = cases(&sweep(&[]));
        assert_eq!(all.len(), 2 * 3 * 3);
        for (index, one) in all.iter().enumerate() {
            assert!(!all[..index].contains(one));
        }
    }

    #[test]
    fn a_path_steps_its_axes_together() {
        let tied = sweep(&["cells", "time_step"]);
        assert_eq!(cases(&tied).len(), 2 * 3);
        assert_eq!(tied.count(), Some(2 * 3));
        for one in cases(&tied) {
            let place = [5, 10, 20].iter().position(|cells| *cells == one.cells);
            assert_eq!(place.map(|place| TimeStepRule::Seconds(STEPS[place])), Some(one.time_step));
        }
    }

    #[test]
    fn more_combinations_than_can_be_counted_are_none_and_no_few() {
        let many = |length: usize| {
            let mut many = sweep(&["time_step", "method"]);
            many.keys[1].values = vec![Value::Count(5); length];
            for name in ["porosity", "flip", "offset", "poissons_ratio", "water_bulk_modulus", "gravity"] {
                many.keys.push(swept(name, vec![Value::Number(0.3); length]));
            }
            many.keys.push(swept("mapping_back", vec![Value::Flag(true); length]));
            many
        };
        // Eight axes of 256 values wrap a product of 64 bits to nothing.
        assert_eq!(many(256).count(), None);
        assert_eq!(cases(&many(256)).len(), 0);
        assert_eq!(many(2).count(), Some(256 * 2));
    }

    #[test]
    fn an_uneven_path_is_named() {
        let mut uneven = sweep(&["cells", "time_step"]);
        uneven.keys[2].values.pop();
        assert_eq!(uneven.uneven_path(), Some(("time_step".to_owned(), 2, 3)));
        assert_eq!(sweep(&["cells", "time_step"]).uneven_path(), None);
    }
}
