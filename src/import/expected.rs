//! What every state of a result must have: a quantity that is gone has no error, and no gate would see it.

use crate::import::mapping::Mapping;
use crate::import::table::SampledState;

/// Columns of a preset that a file of its program has; others depend on the problem.
const PROMISED: [&str; 2] = ["p", "u_y"];

/// Quantities that the states of a result must have.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Expected {
    /// By the keys of a mapping.
    names: Vec<&'static str>,
    /// Whether a settlement curve has some of the times.
    pub settlement: bool,
}

/// A quantity that states lack.
#[derive(Clone, Debug, PartialEq)]
pub struct Absent {
    /// Its key in a mapping.
    pub name: &'static str,
    /// Places of the states that lack it.
    pub states: Vec<usize>,
    /// Whether all do.
    pub is_in_none: bool,
}

impl Expected {
    /// What a preset says that its program writes, and the user does not take out.
    pub fn promised(mapping: &Mapping) -> Self {
        let columns = &mapping.columns;
        let is_named = |name: &&str| match *name {
            "p" => columns.p.is_some(),
            _ => columns.u_y.is_some(),
        };
        let names =
            if mapping.is_of_preset { PROMISED.into_iter().filter(is_named).collect() } else { Vec::new() };
        Self { names, settlement: false }
    }

    /// What some of the states have.
    pub fn of_states(states: &[SampledState]) -> Self {
        let mut expected = Self::default();
        for state in states {
            let all = ["p", "effective_stress", "u_y", "u_x"];
            expected.add(all.into_iter().filter(|name| has(state, name)).collect());
        }
        expected
    }

    /// Adds what one state has.
    pub fn add(&mut self, names: Vec<&'static str>) {
        for name in names {
            if !self.names.contains(&name) {
                self.names.push(name);
            }
        }
    }

    /// What states lack, one entry a quantity.
    pub fn absent(&self, states: &[SampledState]) -> Vec<Absent> {
        let names = self.names.iter().copied().chain(self.settlement.then_some("settlement"));
        let of_name = |name: &'static str| {
            let lacks = |(_, state): &(usize, &SampledState)| !has(state, name);
            let states_that: Vec<usize> =
                states.iter().enumerate().filter(lacks).map(|(place, _)| place).collect();
            let is_in_none = states_that.len() == states.len();
            (!states_that.is_empty()).then_some(Absent { name, states: states_that, is_in_none })
        };
        names.filter_map(of_name).collect()
    }
}

fn has(state: &SampledState, name: &str) -> bool {
    match name {
        "p" => !state.pressure.is_empty(),
        "effective_stress" => !state.effective_stress.is_empty(),
        "u_y" => !state.displacement.is_empty(),
        "u_x" => !state.horizontal_displacement.is_empty(),
        _ => state.surface_displacement.is_some(),
    }
}

impl Absent {
    /// A sentence on it, with the times as the caller writes them.
    pub fn sentence(&self, when: impl Fn(usize) -> String) -> String {
        let Self { name, states, .. } = self;
        if *name == "settlement" {
            let first = states.first().map_or(String::new(), |place| when(*place));
            return format!(
                "the settlement curve has no {first}{}, and it has other times",
                more(states.len())
            );
        }
        let out = format!("`{name} = \"\"` in [columns] of a mapping takes it out on purpose");
        match states.first() {
            Some(first) if !self.is_in_none => {
                format!(
                    "there is no `{name}` at {}{}, and other states have it; {out}",
                    when(*first),
                    more(states.len())
                )
            }
            _ => format!("there is no `{name}` at any time; {out}"),
        }
    }
}

fn more(count: usize) -> String {
    if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::mapping::preset::Preset;
    use crate::study::file::StudySource;

    fn states(pressures: [usize; 3]) -> Vec<SampledState> {
        let state = |count| SampledState {
            pressure: vec![1.0; count],
            displacement: vec![0.0],
            ..SampledState::default()
        };
        pressures.map(state).into()
    }

    #[test]
    fn what_one_state_has_all_must_have_whichever_lacks_it() {
        let when = |place: usize| format!("state {place}");
        for (lacking, pressures) in [(0, [0, 1, 1]), (1, [1, 0, 1]), (2, [1, 1, 0])] {
            let states = states(pressures);
            let absent = Expected::of_states(&states).absent(&states);
            assert_eq!(absent, [Absent { name: "p", states: vec![lacking], is_in_none: false }]);
            let told = absent[0].sentence(when);
            assert!(told.starts_with(&format!("there is no `p` at state {lacking}, and other")), "{told}");
        }
        let whole = states([1, 1, 1]);
        assert_eq!(Expected::of_states(&whole).absent(&whole), []);
        // Found in a state that is not scored: the start.
        let mut expected = Expected::of_states(&states([0, 0, 0]));
        expected.add(vec!["p"]);
        let absent = expected.absent(&states([0, 0, 0]));
        assert!(
            absent.len() == 1 && absent[0].is_in_none && absent[0].sentence(when).contains("at any time")
        );
    }

    #[test]
    fn a_preset_promises_a_pressure_and_a_displacement_and_a_mapping_takes_them_out() {
        let of = |text: &str| {
            let own = StudySource { name: "map.toml".to_owned(), text: text.to_owned() };
            Expected::promised(&Preset::Ogs.mapping(Some(&own), false).expect("a mapping")).names
        };
        assert_eq!(of(""), ["p", "u_y"]);
        assert_eq!(of("[columns]\np = \"\"\n"), ["u_y"]);
        assert_eq!(of("[columns]\nu_y = \"\"\n"), ["p"]);
        assert_eq!(Expected::promised(&Mapping::convention(false).expect("a constant")).names, [""; 0]);
    }

    #[test]
    fn a_curve_that_ends_early_lacks_the_later_times() {
        let mut states = states([1, 1, 1]);
        states[0].surface_displacement = Some(-1.0);
        let expected = Expected { settlement: true, ..Expected::of_states(&states) };
        let absent = expected.absent(&states);
        assert_eq!(absent, [Absent { name: "settlement", states: vec![1, 2], is_in_none: false }]);
        assert!(absent[0].sentence(|_| "T_v = 1".to_owned()).contains("has no T_v = 1 (and 1 more)"));
    }
}
