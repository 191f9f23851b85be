//! Rows of the table that one column or the structure of a file show, exact and with noise.

use super::{TIMES, changed, told};
use crate::import::{Beside, SampledState};
use oedometer_exact::{ColumnParameters, Reference, ReferenceKind};

/// An edit of all outputs of an exact result.
type Edit = fn(&mut Vec<SampledState>);

/// Noise of a share of the largest value of each column, the same in every run.
fn noisy(mut states: Vec<SampledState>, share: f64) -> Vec<SampledState> {
    let mut seed = 1.0_f64;
    for list in [0, 1, 2] {
        let of = |state: &mut SampledState| -> Vec<f64> {
            std::mem::take([&mut state.pressure, &mut state.effective_stress, &mut state.displacement][list])
        };
        let all: Vec<Vec<f64>> = states.iter_mut().map(of).collect();
        let largest = all.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
        for (state, values) in states.iter_mut().zip(all) {
            let noise = |value: f64| {
                seed = (seed * 12.9898).sin() * 43_758.545_3;
                value + share * largest * (2.0 * (seed - seed.floor()) - 1.0)
            };
            *[&mut state.pressure, &mut state.effective_stress, &mut state.displacement][list] =
                values.into_iter().map(noise).collect();
        }
    }
    states
}

fn each(states: &mut [SampledState], edit: impl Fn(&mut SampledState)) {
    states.iter_mut().for_each(edit);
}

/// Of every output the pressures of a solution at other times, or a sum of them.
fn pressures(states: &mut [SampledState], of: impl Fn(&dyn Fn(f64, f64) -> f64, f64, f64) -> f64) {
    let column = ColumnParameters::default();
    let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[]).expect("the seed column");
    let at = |time: f64, depth: f64| reference.fields(time, depth).expect("inside").pressure;
    for state in states {
        let time = column.time_factor(state.time);
        state.pressure = state.initial_height.iter().map(|y| of(&at, time, 1.0 - y)).collect();
    }
}

fn increments(states: &mut [SampledState]) {
    for later in (1..states.len()).rev() {
        let (before, here) = states.split_at_mut(later);
        for (here, before) in here[0].displacement.iter_mut().zip(&before[later - 1].displacement) {
            *here -= before;
        }
    }
}

/// The question, the column, the largest noise that leaves enough of it, and the edit.
const ROWS: [(&str, &str, f64, Edit); 23] = [
    ("is it in bar where Pa", "p", 1e-2, |states| {
        each(states, |state| super::scale(&mut state.pressure, 1e-5));
    }),
    ("is it in atm where Pa", "p", 1e-3, |states| {
        each(states, |state| super::scale(&mut state.pressure, 1.0 / 101_325.0));
    }),
    ("is it a head in mm", "p", 1e-2, |states| {
        each(states, |state| super::scale(&mut state.pressure, 1.0 / 9.81));
    }),
    ("is it in in where m", "u_y", 1e-2, |states| {
        each(states, |one| super::scale(&mut one.displacement, 1.0 / 0.0254));
    }),
    ("is it divided by the final settlement", "u_y", 1e-2, |states| {
        each(states, |state| super::scale(&mut state.displacement, 1.2e6));
    }),
    ("is it doubled where it is written", "effective_stress", 1e-2, |states| {
        each(states, |state| super::scale(&mut state.effective_stress, 2.0));
    }),
    ("is it the horizontal component", "effective_stress", 1e-2, |states| {
        each(states, |state| super::scale(&mut state.effective_stress, 1.0 / 3.0));
    }),
    ("is a factor missing where it is written", "p", 1e-3, |states| {
        each(states, |one| super::scale(&mut one.pressure, 0.731));
    }),
    ("is it given instead of the effective stress", "effective_stress", 1e-2, |states| {
        each(states, |state| state.effective_stress.clone_from(&state.pressure));
    }),
    ("is the strain given instead", "p", 1e-2, |states| {
        each(states, |state| {
            state.pressure = state.effective_stress.iter().map(|stress| stress / 1.2e6).collect();
        });
    }),
    ("is it reset after the first output", "u_y", 1e-3, |states| {
        let first = states[0].displacement.clone();
        each(&mut states[1..], |state| {
            state.displacement.iter_mut().zip(&first).for_each(|(u, first)| *u -= first);
        });
    }),
    ("is it the increment since the previous output", "u_y", 1e-2, |states| increments(states)),
    ("is it counted from a later time, 1.6", "u_y", 0.0, |states| {
        let column = ColumnParameters::default();
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[]).expect("the seed column");
        let early = |y: &f64| reference.fields(0.02, 1.0 - y).expect("inside").displacement;
        each(states, |state| {
            let heights = state.initial_height.clone();
            state.displacement.iter_mut().zip(&heights).for_each(|(u, y)| *u -= early(y));
        });
    }),
    ("is it that of the previous output", "p", 1e-2, |states| {
        pressures(states, |at, time, depth| {
            let before = TIMES.iter().copied().filter(|other| *other < 0.999 * time).fold(0.0, f64::max);
            at(before, depth)
        });
    }),
    ("is it integrated over time", "p", 1e-2, |states| {
        pressures(states, |at, time, depth| {
            let parts = (0..400).map(|part| (f64::from(part) + 0.5) / 400.0);
            let seconds = ColumnParameters::default().time(time);
            parts.map(|share| at(share * time, depth) * seconds / 400.0).sum()
        });
    }),
    ("is only this column written from the other end", "p", 1e-2, |states| {
        each(states, |one| one.pressure.reverse());
    }),
    ("the right values of every output in another order", "p", 0.0, |states| {
        each(states, |one| one.pressure.rotate_left(7));
    }),
    (
        "all of t = 40.88 s, where it should not be, and right at the others: was this output not written",
        "p",
        1e-3,
        |all| {
            super::scale(&mut all[2].pressure, 0.0);
        },
    ),
    (
        "all of y = 0 m, where it should not be, and right at the others: is it a fill value",
        "p",
        1e-2,
        |all| {
            // The base is the last place.
            each(all, |state| *state.pressure.last_mut().expect("a base") = -999.0);
        },
    ),
    ("are these node or cell numbers", "p", 0.0, |states| {
        each(states, |state| state.pressure = (1..=21).map(f64::from).collect());
    }),
    ("is it the same state at all outputs, that of 8.1", "p", 0.0, |states| {
        let second = states[1].pressure.clone();
        each(states, |state| state.pressure.clone_from(&second));
    }),
    ("is the porosity given instead", "p", 0.0, |states| {
        each(states, |one| {
            one.pressure = one.effective_stress.iter().map(|s| 0.3 + 0.7 * s / 1.2e6).collect();
        });
    }),
    ("is it the rate (velocity)", "p", 0.0, |states| {
        pressures(states, |at, time, depth| {
            let near = 1e-4 * time;
            (at(time + near, depth) - at(time - near, depth)) / (2.0 * ColumnParameters::default().time(near))
        });
    }),
];

#[test]
fn what_one_column_holds_is_named_and_nothing_of_the_others() {
    let mut wrong = Vec::new();
    for noise in [0.0, 1e-3, 1e-2] {
        for (words, column, largest, edit) in ROWS {
            if noise > largest {
                continue;
            }
            let mut states = noisy(changed(0.0, |_| ()), noise);
            edit(&mut states);
            let told = told(&states);
            let names = |sentence: &String| {
                sentence.starts_with(&format!("your {column} ")) && sentence.contains(words)
            };
            if !(told.len() == 1 && names(&told[0])) {
                wrong.push(format!("{noise} {words}: {told:?}"));
            }
        }
        assert_eq!(told(&noisy(changed(0.0, |_| ()), noise)), [""; 0], "noise of {noise}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn noise_changes_no_cause_that_all_columns_share() {
    let at = |factor: f64| super::states(&TIMES.map(|time| factor * time), |time| time / factor, 0.0);
    let loaded = changed(0.0, |state| {
        for list in [&mut state.pressure, &mut state.effective_stress, &mut state.displacement] {
            super::scale(list, 2.0);
        }
    });
    let turned = changed(0.0, |state| state.initial_height.iter_mut().for_each(|y| *y = 1.0 - *y));
    for (states, words) in [
        (at(5.0), "5 × the time"),
        (at(0.1), "power of ten"),
        (loaded, "is the load 2 × that of the problem?"),
        (turned, "is `y` counted from the other end?"),
    ] {
        for noise in [0.0, 1e-3] {
            let told = told(&noisy(states.clone(), noise));
            assert!(told.len() == 1 && told[0].contains(words), "{noise} {words}: {told:?}");
        }
    }
}

#[test]
fn the_structure_of_a_file_is_looked_at_before_anything_is_fitted() {
    let numbered = |first: usize| {
        let mut states = changed(0.0, |_| ());
        for (number, state) in (first..).zip(&mut states) {
            state.time = number as f64;
        }
        states
    };
    let still = vec![changed(0.0, |_| ())[1].clone(); 4];
    let still = still.into_iter().zip(TIMES).map(|(state, time)| SampledState { time, ..state });
    let mut twice = changed(0.0, |_| ());
    let late = super::states(&TIMES.map(|time| 0.1 * time), |time| 10.0 * time, 0.0);
    twice.extend(late.into_iter().map(|state| SampledState { time: state.time * (1.0 + 1e-8), ..state }));
    twice.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut some = changed(0.0, |_| ());
    let slow = super::states(&TIMES.map(|time| 0.5 * time), |time| 2.0 * time, 0.0);
    some[1] = slow[1].clone();
    some[3] = slow[3].clone();
    for (states, words) in [
        (
            numbered(1),
            "your times count outputs (1, 2, 3, …): are they step numbers instead of times? At T_v = 0.05, \
             0.1, 0.5, 1 ",
        ),
        (numbered(0), "your times count outputs (0, 1, 2, …)"),
        (still.collect(), "matches the exact one of 8.17 s at all outputs: is the same state written"),
        (
            twice,
            "there are 2 runs in one file, with other values at the same times: run 1 is right; in run 2 each of your p,",
        ),
        (some, "is right at t = 4.088, 40.88 s and wrong only at t = 8.175, 81.75 s: there each of your p,"),
    ] {
        let told = told(&states);
        assert!(told.len() == 1 && told[0].contains(words), "{words}: {told:?}");
    }
}

/// Stresses at centres of cells beside pressures at nodes are a column at places of their own.
#[test]
fn stress_in_cells_beside_nodal_pressure_is_diagnosed() {
    let column = ColumnParameters::default();
    let reference = Reference::new(ReferenceKind::Terzaghi, &column, &TIMES).expect("the seed column");
    let told = |sign: f64| {
        let mut states = changed(0.0, |state| state.displacement.clear());
        for state in &mut states {
            let time = column.time_factor(state.time);
            let heights: Vec<f64> = (0..20).map(|cell| (f64::from(cell) + 0.5) / 20.0).collect();
            let stress = |y: &f64| sign * reference.fields(time, 1.0 - y).expect("inside").effective_stress;
            let cells = SampledState {
                volume: vec![1.0; 20],
                effective_stress: heights.iter().map(stress).collect(),
                initial_height: heights,
                ..SampledState::default()
            };
            state.effective_stress.clear();
            state.beside = vec![Beside { sample: None, state: cells }];
        }
        told(&states)
    };
    assert_eq!(told(1.0), [""; 0]);
    assert_eq!(told(-1.0), ["your effective_stress is −1.00 × the exact one: is the sign declared wrongly?"]);
}
