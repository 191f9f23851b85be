//! Whether the states that a solver left can be compared: one at each output, with lists that belong to each other.

use crate::Case;
use crate::outcome::{Outcome, Status};
use oedometer_problem::outcome::{Failure, FailureKind};
use oedometer_problem::snapshot::{Samples, Snapshot};
use oedometer_wording::{count_of, rounded, typed};

/// How far, relative, a state may lie from the output that it stands for.
pub const SAME_TIME: f64 = 1e-3;

impl Outcome {
    /// The outcome, or its failure where its states are not whole: nothing of them is compared then.
    #[must_use]
    pub fn held_to(self, case: &Case) -> Self {
        let is_open = self.status == Status::Ok && self.inside.is_none();
        match is_open.then(|| lack_of(case, &self.snapshots)).flatten() {
            Some(why) => Self {
                status: Status::Failed(Failure::of_attached(FailureKind::Incomplete, why)),
                snapshots: Vec::new(),
                ..self
            },
            None => self,
        }
    }
}

/// What states lack of a case, as a sentence.
fn lack_of(case: &Case, states: &[Snapshot]) -> Option<String> {
    let outputs = &case.time_factors;
    if states.len() != outputs.len() {
        let left = count_of(states.len(), "state", "states");
        return Some(format!(
            "the solver returned {left} for {}",
            count_of(outputs.len(), "output", "outputs")
        ));
    }
    outputs.iter().zip(states).find_map(|(output, state)| {
        let time_factor = state.time / case.seconds_per_time_factor();
        let is_near = (time_factor - output).abs() <= SAME_TIME * output;
        let other = || Some(format!("the state is that of T_v = {}", rounded(time_factor)));
        let lack = if is_near { lack_of_state(state) } else { other() };
        lack.map(|lack| format!("at T_v = {}, {lack}", typed(*output)))
    })
}

fn lack_of_state(state: &Snapshot) -> Option<String> {
    let kinds = [("points", &state.points), ("centres", &state.centres), ("nodes", &state.nodes)];
    let is_bare = |samples: &Samples| samples.initial_height.is_empty();
    if kinds.iter().all(|(_, samples)| is_bare(samples)) && state.settlement.is_nan() {
        return Some("there is neither a sample nor a settlement".to_owned());
    }
    kinds.into_iter().find_map(|(kind, samples)| {
        lack_of_samples(samples)
            .map(|lack| format!("{lack} for {}", count_of(places_in(samples), kind, kind)))
    })
}

fn places_in(samples: &Samples) -> usize {
    samples.initial_height.len()
}

/// A list that is not a field of its places: its length differs, or a value is not a number.
fn lack_of_samples(samples: &Samples) -> Option<String> {
    let places = places_in(samples);
    let plane = samples.plane.as_ref();
    let of_displacement = samples.displacement_height.as_ref().map_or(places, Vec::len);
    let lists = [
        ("heights", &samples.initial_height[..], places, true),
        ("volumes", &samples.volume, places, true),
        ("pressures", &samples.pressure, places, false),
        ("effective stresses", &samples.effective_stress, places, false),
        ("displacements", &samples.displacement, of_displacement, false),
        ("distances", plane.map_or(&[], |plane| &plane.initial_distance), places, plane.is_some()),
        (
            "horizontal displacements",
            plane.map_or(&[], |plane| &plane.horizontal_displacement),
            plane.and_then(|plane| plane.displacement_distance.as_ref()).map_or(places, Vec::len),
            false,
        ),
    ];
    lists.into_iter().find_map(|(name, list, wanted, is_needed)| {
        if list.len() != wanted && (is_needed || !list.is_empty()) {
            return Some(format!("the list of {name} has {}", count_of(list.len(), "number", "numbers")));
        }
        let wrong = list.iter().find(|value| !value.is_finite());
        wrong.map(|value| format!("the list of {name} has {value}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Sample, Task};
    use oedometer_scenes::TERZAGHI;

    /// What is wrong with states.
    type Change<'a> = &'a dyn Fn(&mut Vec<Snapshot>);

    #[test]
    fn incomplete_states_fail_and_name_what_is_missing() {
        let case = Case { cells: 2, time_factors: vec![0.1].into(), ..Case::seed(Task::Solve, &TERZAGHI) };
        let mut complete = Snapshot { time: 0.1 * case.seconds_per_time_factor(), ..Snapshot::default() };
        complete.settlement = f64::NAN;
        complete.points.initial_height = vec![0.25, 0.75];
        complete.points.pressure = vec![0.5, 0.2];
        let lack = |change: &dyn Fn(&mut Vec<Snapshot>)| {
            let mut states = vec![complete.clone()];
            change(&mut states);
            let outcome = Outcome::of_states(states, Sample::Points).held_to(&case);
            assert_eq!(outcome.snapshots.is_empty(), outcome.status != Status::Ok);
            outcome.status.failure().map(|failure| failure.reason.clone())
        };
        let rows: [(Change<'_>, &str); 10] = [
            (&|states| states.clear(), "the solver returned 0 states for 1 output"),
            (&|states| states.extend_from_within(..), "the solver returned 2 states for 1 output"),
            (&|states| states[0].time *= 1.002, "at T_v = 0.1, the state is that of T_v = 0.1002"),
            (&|states| states[0].time *= 0.998, "at T_v = 0.1, the state is that of T_v = 0.0998"),
            (&|states| states[0].time = f64::NAN, "at T_v = 0.1, the state is that of T_v = NaN"),
            (
                &|states| states[0].points = Samples::default(),
                "at T_v = 0.1, there is neither a sample nor a settlement",
            ),
            (
                &|states| states[0].points.pressure.truncate(1),
                "at T_v = 0.1, the list of pressures has 1 number for 2 points",
            ),
            (
                &|states| states[0].points.volume = vec![1.0],
                "at T_v = 0.1, the list of volumes has 1 number for 2 points",
            ),
            (
                &|states| states[0].points.pressure[1] = f64::NAN,
                "at T_v = 0.1, the list of pressures has NaN for 2 points",
            ),
            (
                &|states| states[0].nodes.displacement = vec![0.0],
                "at T_v = 0.1, the list of displacements has 1 number for 0 nodes",
            ),
        ];
        for (change, wanted) in rows {
            assert_eq!(lack(change).as_deref(), Some(wanted));
        }
        assert_eq!(lack(&|_| ()), None);
        for near in [0.9991, 1.0009] {
            assert_eq!(lack(&|states| states[0].time *= near), None, "near enough");
        }
        let curve = |states: &mut Vec<Snapshot>| {
            (states[0].points, states[0].settlement) = (Samples::default(), 1e-6);
        };
        assert_eq!(lack(&curve), None, "a settlement alone");
    }
}
