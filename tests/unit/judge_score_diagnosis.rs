use super::*;
use crate::import::mapping::convention::{CONVENTION, PLANE_CONVENTION};
use crate::study::file::StudySource;

fn mapping(text: &str) -> Mapping {
    Mapping::read(&StudySource { name: "map.toml".to_owned(), text: text.to_owned() }).expect("a mapping")
}

/// The exact column at its nodes, as if written at `written(T_v)` and off by a share.
fn states(times: &[f64], written: impl Fn(f64) -> f64, off: f64) -> Vec<SampledState> {
    let column = ColumnParameters::default();
    let reference = Reference::new(ReferenceKind::Terzaghi, &column, times).expect("the seed column");
    let one = |time: &f64| {
        let mut state = SampledState { time: column.time(written(*time)), ..SampledState::default() };
        for node in 0..=20 {
            let zeta = f64::from(node) / 20.0;
            let fields = reference.fields(*time, zeta).expect("inside");
            // An error that no mistake looks like: it waves.
            let wave = 1.0 + off * (7.0 * zeta + 3.0 * time).sin();
            state.initial_height.push(1.0 - zeta);
            state.volume.push(1.0);
            state.pressure.push(fields.pressure * wave);
            state.effective_stress.push(fields.effective_stress * wave);
            state.displacement.push(fields.displacement * wave);
        }
        state
    };
    times.iter().map(one).collect()
}

const TIMES: [f64; 4] = [0.05, 0.1, 0.5, 1.0];

fn told_by(states: &[SampledState], text: &str) -> Vec<String> {
    diagnosis(&ColumnParameters::default(), ReferenceKind::Terzaghi, states, &mapping(text))
        .expect("a column")
}

fn told(states: &[SampledState]) -> Vec<String> {
    told_by(states, CONVENTION)
}

fn changed(off: f64, change: impl Fn(&mut SampledState)) -> Vec<SampledState> {
    let mut states = states(&TIMES, |time| time, off);
    for state in &mut states {
        change(state);
    }
    states
}

fn scale(list: &mut [f64], factor: f64) {
    for value in list {
        *value *= factor;
    }
}

#[test]
fn every_mistake_is_named_in_good_and_in_mediocre_results() {
    for off in [0.0, 1e-3, 0.05] {
        let one = |states: Vec<SampledState>, words: &str| {
            let told = told(&states);
            assert!(told.len() == 1 && told[0].contains(words), "{off} {words}: {told:?}");
        };
        one(changed(off, |state| scale(&mut state.pressure, -1.0)), "your p is −1.00 × the exact one");
        one(
            changed(off, |state| scale(&mut state.pressure, 1e-3)),
            "your p is 0.001 × the exact one: is it in kPa where Pa is declared?",
        );
        one(
            changed(off, |state| scale(&mut state.displacement, -1e3)),
            "your u_y is −1000 × the exact one: is it in mm where m is declared? And is the sign",
        );
        one(
            changed(off, |state| {
                let total = state.effective_stress.iter().zip(&state.pressure).map(|(s, p)| s - p);
                state.effective_stress = total.collect();
            }),
            "your effective_stress matches the exact total stress",
        );
        for level in [0.0, 0.3] {
            one(
                changed(off, |state| {
                    for (pressure, height) in state.pressure.iter_mut().zip(&state.initial_height) {
                        *pressure += 9810.0 * (1.0 + level - height);
                    }
                }),
                "constant gradient of 9810 Pa/m: is the hydrostatic part left in?",
            );
        }
    }
    for off in [0.0, 1e-3] {
        let upside_down = told(&changed(off, |state| {
            state.initial_height.iter_mut().for_each(|height| *height = 1.0 - *height);
        }));
        assert!(upside_down.iter().all(|told| told.contains("upside down")) && !upside_down.is_empty());
        let minutes = told(&states(&TIMES, |time| time / 60.0, off));
        assert_eq!(minutes.len(), 1, "{minutes:?}");
        assert!(
            minutes[0].starts_with("your p and your effective_stress and your u_y matches")
                || minutes[0].contains("60 × the time: are times in min where s is declared?"),
            "{minutes:?}"
        );
    }
    let seconds = told_by(&states(&TIMES, |time| 60.0 * time, 0.0), &CONVENTION.replace("\"s\"", "\"min\""));
    assert!(seconds.iter().any(|told| told.contains("are times in s where min is declared?")), "{seconds:?}");
}

#[test]
fn nodes_without_a_value_are_named() {
    for off in [0.0, 0.05] {
        let told = told(&changed(off, |state| {
            state.pressure.iter_mut().skip(1).step_by(2).for_each(|pressure| *pressure = 0.0);
        }));
        assert!(told.len() == 1 && told[0].contains("exactly 0 at 40 of 80 samples"), "{told:?}");
    }
}

#[test]
fn an_inaccurate_solver_is_told_nothing() {
    for off in [0.0, 1e-3, 0.05, 0.2, 0.6, 2.0] {
        assert_eq!(told(&states(&TIMES, |time| time, off)), [""; 0], "waves of {off}");
    }
    // Too slow or too fast, as with a wrong permeability or too few steps.
    for factor in [0.5, 0.8, 0.95, 1.1, 1.5, 3.0] {
        assert_eq!(told(&states(&TIMES, |time| factor * time, 0.0)), [""; 0], "{factor} × the time");
    }
    // A locked or a soft one, and one that forgets the last digits.
    for factor in [0.3, 0.7, 1.4, 2.0] {
        let wrong = changed(0.02, |state| {
            scale(&mut state.displacement, factor);
            scale(&mut state.pressure, factor);
        });
        assert_eq!(told(&wrong), [""; 0], "{factor} × the fields");
    }
    let zero = changed(0.0, |state| {
        scale(&mut state.pressure, 0.0);
        scale(&mut state.displacement, 0.0);
    });
    assert_eq!(told(&zero), [""; 0], "nothing at all");
    // Long after, when nothing is left to be seen.
    assert_eq!(told(&states(&[30.0, 40.0], |time| time, 0.9)), [""; 0]);
}

#[test]
fn in_a_layer_the_other_end_may_look_like_the_other_sign() {
    let layer = ColumnParameters::default();
    let solution = Reference::new(ReferenceKind::CosineLayer, &layer, &[]).expect("a layer");
    let exact = solution.plane_state(0.1).expect("a state").expect("in the plane");
    let mut state = SampledState { time: layer.time(0.1), ..SampledState::default() };
    for (x, y) in (0..=8).flat_map(|i| (0..=8).map(move |j| (f64::from(i) / 8.0, f64::from(j) / 8.0))) {
        let fields = exact.fields(1.0 - x, y).expect("inside");
        state.initial_distance.push(x);
        state.initial_height.push(y);
        state.volume.push(1.0);
        state.pressure.push(fields.pressure);
    }
    let told = diagnosis(&layer, ReferenceKind::CosineLayer, &[state], &mapping(PLANE_CONVENTION));
    let told = told.expect("a layer");
    assert!(told.len() == 1 && told[0].contains("does `x` count from the other end?"), "{told:?}");
}

#[test]
fn mistakes_of_very_many_samples_are_seen_in_some_of_them() {
    let column = ColumnParameters::default();
    let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[0.1]).expect("the seed column");
    let nodes = 40_000;
    let mut state = SampledState { time: column.time(0.1), ..SampledState::default() };
    for node in 0..=nodes {
        let fields = reference.fields(0.1, f64::from(node) / f64::from(nodes)).expect("inside");
        state.initial_height.push(1.0 - f64::from(node) / f64::from(nodes));
        state.volume.push(1.0);
        // Every other node is in the middle of a side, and the displacements are in mm.
        state.pressure.push(if node % 2 == 1 { 0.0 } else { fields.pressure });
        state.displacement.push(1e3 * fields.displacement);
    }
    let told = told(&[state]);
    assert_eq!(told.len(), 2, "{told:?}");
    let zeros = told.iter().find(|told| told.contains("mid-side")).expect("the zeros");
    let count: f64 =
        zeros.split(" at ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok()).expect("a count");
    // Of 5000 without a rhythm: half of them, and neither none nor all.
    assert!((2400.0..2600.0).contains(&count) && zeros.contains("samples looked at"), "{zeros}");
    assert!(told.iter().any(|told| told.contains("1000 × the exact one: is it in mm")), "{told:?}");
}
