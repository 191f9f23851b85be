//! Quantities that every state of a result must have; a missing one would pass unseen.

use crate::import::mapping::{Column, DeclaredBy, Mapping};
use crate::import::samples::SampledState;
use oedometer_case::quantity::Quantity;

/// Quantities of a result.
const QUANTITIES: [Column; 4] = [Column::Pressure, Column::EffectiveStress, Column::Up, Column::Along];

/// Quantities that the states of a result must have.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Expected {
    columns: Vec<Column>,
    /// Whether a settlement curve has some of the times.
    pub settlement: bool,
}

/// A quantity that states lack.
#[derive(Clone, Debug, PartialEq)]
pub struct Absent {
    /// Its column; a settlement curve has none.
    pub column: Option<Column>,
    /// Places of the states that lack it.
    pub states: Vec<usize>,
    /// Whether all of them do.
    pub is_in_none: bool,
}

impl Expected {
    /// What files of a preset's program always have, unless the user takes it out; other columns depend on the problem.
    pub fn promised(mapping: &Mapping) -> Self {
        let mut expected = Self::default();
        if matches!(mapping.declared_by, DeclaredBy::Preset(_)) {
            let promised = [Column::Pressure, Column::Up].into_iter();
            expected.add(promised.filter(|column| mapping.columns.get(*column).is_some()));
        }
        expected
    }

    /// What some of the states have.
    pub fn of_states(states: &[SampledState]) -> Self {
        let mut expected = Self::default();
        for state in states {
            expected.add(QUANTITIES.into_iter().filter(|column| has(state, *column)));
        }
        expected
    }

    /// Takes a quantity out.
    pub fn leave_out(&mut self, quantity: Quantity) {
        self.columns.retain(|column| column.quantity() != Some(quantity));
        self.settlement &= quantity != Quantity::Settlement;
    }

    /// Adds columns that a state has.
    pub fn add(&mut self, columns: impl IntoIterator<Item = Column>) {
        for column in columns {
            if QUANTITIES.contains(&column) && !self.columns.contains(&column) {
                self.columns.push(column);
            }
        }
    }

    /// Columns that every state must have.
    pub fn columns(&self) -> Vec<Column> {
        self.columns.clone()
    }

    /// What states lack, one entry per quantity.
    pub fn absent(&self, states: &[SampledState]) -> Vec<Absent> {
        let absent = |column: Option<Column>, has: &dyn Fn(&SampledState) -> bool| {
            let lacking: Vec<usize> = (0..states.len()).filter(|place| !has(&states[*place])).collect();
            let is_in_none = lacking.len() == states.len();
            (!lacking.is_empty()).then_some(Absent { column, states: lacking, is_in_none })
        };
        let columns = self.columns.iter().map(|column| absent(Some(*column), &|state| has(state, *column)));
        let curve = self.settlement.then(|| absent(None, &|state| state.surface_displacement.is_some()));
        columns.chain(curve).flatten().collect()
    }
}

fn has(state: &SampledState, column: Column) -> bool {
    let beside = || state.beside.iter().any(|set| has(&set.state, column));
    let list = match column {
        Column::Pressure => &state.pressure,
        Column::EffectiveStress => &state.effective_stress,
        Column::Up => &state.displacement,
        _ => &state.horizontal_displacement,
    };
    !list.is_empty() || beside()
}

impl Absent {
    /// A sentence about it; `when` writes the time of a state.
    pub fn sentence(&self, when: impl Fn(usize) -> String) -> String {
        let first = self.states.first().map_or(String::new(), |place| when(*place));
        let more = match self.states.len() {
            0 | 1 => String::new(),
            count => format!(" (and {} more)", count - 1),
        };
        let Some((column, quantity)) = self.column.and_then(|column| Some((column, column.quantity()?)))
        else {
            return format!("the settlement curve has no {first}{more}, and it has other times");
        };
        let place = if self.is_in_none {
            "any time".to_owned()
        } else {
            format!("{first}{more}, and other states have it")
        };
        format!("there is no `{}` at {place}; to leave it out, {}", column.name(), left_out(column, quantity))
    }
}

/// How a user leaves the quantity of a column out, after "to leave it out, ".
pub fn left_out(column: Column, quantity: Quantity) -> String {
    format!(
        "call `score --without {}`, or write `{} = \"\"` into [columns] of a mapping",
        quantity.name(),
        column.name()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::mapping::Axes;
    use crate::solver::Preset;
    use clap::ValueEnum;
    use oedometer_input::source::StudySource;

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
        let how = "to leave it out, call `score --without pressure`, or write `p = \"\"` into [columns] of a mapping";
        for (lacking, pressures, first) in [
            (vec![0], [0, 1, 1], "0"),
            (vec![1], [1, 0, 1], "1"),
            (vec![2], [1, 1, 0], "2"),
            (vec![0, 2], [0, 1, 0], "0 (and 1 more)"),
            (vec![1, 2], [1, 0, 0], "1 (and 1 more)"),
        ] {
            let states = states(pressures);
            let absent = Expected::of_states(&states).absent(&states);
            let wanted = Absent { column: Some(Column::Pressure), states: lacking, is_in_none: false };
            assert_eq!(absent, [wanted]);
            let told = format!("there is no `p` at state {first}, and other states have it; {how}");
            assert_eq!(absent[0].sentence(when), told);
        }
        let whole = states([1, 1, 1]);
        assert_eq!(Expected::of_states(&whole).absent(&whole), []);
        // Found in a state that is not scored: the start.
        let mut expected = Expected::of_states(&states([0, 0, 0]));
        expected.add([Column::Pressure]);
        let absent = expected.absent(&states([0, 0, 0]));
        assert!(
            absent.len() == 1 && absent[0].is_in_none && absent[0].sentence(when).contains("at any time")
        );
    }

    #[test]
    fn a_preset_promises_a_pressure_and_a_displacement_and_a_mapping_takes_them_out() {
        let of = |text: &str| {
            let own = StudySource { name: "map.toml".to_owned(), text: text.to_owned() };
            let ogs = Preset::from_str("ogs", false).expect("a preset");
            let mapping = Mapping::resolve(Some(ogs), Some(&own), Axes::Column).expect("a mapping");
            Expected::promised(&mapping).columns.iter().map(|column| column.name()).collect::<Vec<_>>()
        };
        assert_eq!(of(""), ["p", "u_y"]);
        assert_eq!(of("[columns]\np = \"\"\n"), ["u_y"]);
        assert_eq!(of("[columns]\nu_y = \"\"\n"), ["p"]);
        assert_eq!(Expected::promised(&Mapping::convention(Axes::Column).expect("a constant")).columns, []);
    }

    #[test]
    fn a_curve_that_ends_early_lacks_the_later_times() {
        let mut states = states([1, 1, 1]);
        states[0].surface_displacement = Some(-1.0);
        let expected = Expected { settlement: true, ..Expected::of_states(&states) };
        let absent = expected.absent(&states);
        assert_eq!(absent, [Absent { column: None, states: vec![1, 2], is_in_none: false }]);
        let told = absent[0].sentence(|place| format!("T_v = {place}"));
        assert_eq!(told, "the settlement curve has no T_v = 1 (and 1 more), and it has other times");
    }
}
