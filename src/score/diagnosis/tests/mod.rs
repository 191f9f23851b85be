mod changes;
mod table;

use super::*;
use crate::import::mapping::preset::{CONVENTION, PLANE_CONVENTION};
use crate::study::file::StudySource;
use oedometer_exact::Reference;

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

/// On a coarse mesh the factors of stresses and displacements are each off a little.
#[test]
fn factors_that_nearly_agree_are_that_of_the_load() {
    let of = |pressure: f64, displacement: f64| {
        told(&changed(0.0, |state| {
            scale(&mut state.pressure, pressure);
            scale(&mut state.effective_stress, pressure);
            scale(&mut state.displacement, displacement);
        }))
    };
    for (pressure, displacement) in [(1.1, 1.1), (1.098, 1.104), (0.902, 0.897)] {
        let told = of(pressure, displacement);
        assert!(
            told.len() == 1
                && told[0].starts_with("each of your p, effective_stress and u_y matches the exact one of")
                && told[0].contains("is the load"),
            "{told:?}"
        );
    }
    for apart in [of(1.1, 1.3), of(1.01, 1.0)] {
        assert!(!apart.is_empty() && apart.iter().all(|told| !told.contains("is the load")), "{apart:?}");
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
            "your p is 0.001 × the exact one: is it in kPa where Pa is declared",
        );
        one(
            changed(off, |state| scale(&mut state.displacement, -1e3)),
            "your u_y is −1000 × the exact one: is it in mm where m is declared, and is the sign",
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
                "is the hydrostatic part left in?",
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
            minutes[0].starts_with("each of your p, effective_stress and u_y matches")
                || minutes[0].contains("60 × the time: are times in min where s is declared"),
            "{minutes:?}"
        );
    }
    let seconds = told_by(&states(&TIMES, |time| 60.0 * time, 0.0), &CONVENTION.replace("\"s\"", "\"min\""));
    assert!(seconds.iter().any(|told| told.contains("are times in s where min is declared")), "{seconds:?}");
    // So late that nothing is left of the exact pressure; and beside a displacement that is wrong by itself.
    let days = told_by(&states(&TIMES, |time| 86_400.0 * time, 0.0), &CONVENTION.replace("\"s\"", "\"d\""));
    assert!(days.iter().any(|told| told.contains("are times in s where d is declared")), "{days:?}");
    let mut mixed = states(&TIMES, |time| time / 60.0, 0.0);
    for state in &mut mixed {
        state
            .displacement
            .iter_mut()
            .zip(&state.initial_height)
            .for_each(|(u, y)| *u = 1e-6 * (9.0 * y).sin());
    }
    let mixed = told(&mixed);
    let shared = "each of your p and effective_stress matches the exact one at 60 × the time";
    assert!(mixed[0].starts_with(shared) && mixed[1].starts_with("your u_y does not match"), "{mixed:?}");
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
    // Steps that are too long: of backward Euler, whose modes lag the more the faster they are.
    for steps in [20, 50, 200] {
        assert_eq!(told(&backward_euler(steps)), [""; 0], "{steps} steps");
    }
    // A locked or a soft one, and one that forgets the last digits.
    for factor in [0.3, 0.7, 1.4, 3.0] {
        let wrong = changed(0.1, |state| {
            scale(&mut state.displacement, factor);
            scale(&mut state.pressure, 1.0 / factor);
        });
        assert_eq!(told(&wrong), [""; 0], "{factor} × the fields");
    }
    // Long after, when nothing is left to be seen.
    assert_eq!(told(&states(&[30.0, 40.0], |time| time, 0.9)), [""; 0]);
}

#[test]
fn an_array_of_zeros_is_named() {
    only(
        &changed(0.0, |state| scale(&mut state.pressure, 0.0)),
        &["your p is 0 everywhere: is it the wrong array?"],
    );
    // Less than a micrometre, as four decimals show it.
    only(
        &changed(0.0, |state| scale(&mut state.displacement, 0.0)),
        &["your u_y is 0 everywhere: is it the wrong array, or written with too few decimals?"],
    );
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
    let sign = "your p is −1.00 × the exact one: is the sign declared wrongly, or does `x` count from the other end?";
    assert_eq!(told, [sign]);
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

/// A column of forty finite volumes after so many backward Euler steps to `T_v` = 1.
fn backward_euler(steps: usize) -> Vec<SampledState> {
    let column = ColumnParameters::default();
    let (cells, share) = (40, 1600.0 / steps as f64);
    let mut pressure = vec![1.0_f64; cells];
    let mut states = Vec::new();
    for step in 1..=steps {
        let mut diagonal = vec![1.0 + 2.0 * share; cells];
        (diagonal[0], diagonal[cells - 1]) = (1.0 + share, 1.0 + 3.0 * share);
        for cell in 1..cells {
            let factor = -share / diagonal[cell - 1];
            diagonal[cell] += factor * share;
            pressure[cell] -= factor * pressure[cell - 1];
        }
        pressure[cells - 1] /= diagonal[cells - 1];
        for cell in (0..cells - 1).rev() {
            pressure[cell] = (pressure[cell] + share * pressure[cell + 1]) / diagonal[cell];
        }
        if step % (steps / 10) == 0 {
            states.push(SampledState {
                time: column.time(step as f64 / steps as f64),
                initial_height: (0..cells).map(|cell| (cell as f64 + 0.5) / cells as f64).collect(),
                volume: vec![1.0; cells],
                pressure: pressure.clone(),
                ..SampledState::default()
            });
        }
    }
    states
}

fn only(states: &[SampledState], words: &[&str]) {
    let told = told(states);
    assert_eq!(told.len(), words.len(), "{words:?}: {told:?}");
    for (told, words) in told.iter().zip(words) {
        assert!(told.contains(words), "{words}: {told}");
    }
}

#[test]
fn another_stress_in_the_place_of_the_pressure_is_named() {
    for off in [0.0, 1e-3, 0.05] {
        only(
            &changed(off, |state| state.pressure = state.effective_stress.iter().map(|s| -s).collect()),
            &["your p matches the exact effective stress: is it given instead of the pore pressure"],
        );
        only(
            &changed(off, |state| state.pressure.clone_from(&state.effective_stress)),
            &["your p is −1.00 × the exact effective stress: is it given instead of the pore pressure?"],
        );
        let total = |state: &SampledState| -> Vec<f64> {
            state.pressure.iter().zip(&state.effective_stress).map(|(p, s)| p - s).collect()
        };
        only(
            &changed(off, |state| state.pressure = total(state)),
            &["your p matches the exact total stress: is it given instead of the pore pressure?"],
        );
    }
}

#[test]
fn another_load_is_named_where_all_fields_have_it() {
    for off in [0.0, 1e-3, 0.02] {
        only(
            &changed(off, |state| {
                scale(&mut state.pressure, 2.0);
                scale(&mut state.effective_stress, 2.0);
                scale(&mut state.displacement, 2.0);
            }),
            &[
                "each of your p, effective_stress and u_y matches the exact one of 2 × the load: is the load 2 × that of the problem?",
            ],
        );
        only(
            &changed(off, |state| scale(&mut state.displacement, 2.0)),
            &["your u_y is 2 × the exact one: is it doubled where it is written?"],
        );
    }
}

#[test]
fn another_stiffness_and_another_permeability_are_named() {
    // E_oed = 1.2 E: all is slower by 1.2 and settles 1.2 times as much.
    let slower = |off: f64| {
        let late = states(&TIMES.map(|time| time / 1.2), |time| 1.2 * time, off);
        late.into_iter().map(|mut state| {
            scale(&mut state.displacement, 1.2);
            state
        })
    };
    for off in [0.0, 1e-3] {
        only(
            &slower(off).collect::<Vec<_>>(),
            &[
                "each of your p, effective_stress and u_y matches the exact one with 0.833 × the stiffness: is E taken for E_oed?",
            ],
        );
    }
    only(
        &changed(1e-3, |state| scale(&mut state.displacement, 1.2)),
        &["your u_y is 1.2 × the exact one: is E taken for E_oed where displacements are computed?"],
    );
    // μ = 1e-3 Pa s.
    for (factor, words) in [
        (1e3, "is k/μ taken for the hydraulic conductivity k"),
        (1e-3, "is k divided by μ where it should not be"),
    ] {
        let times = if factor > 1.0 { [2e-3, 4e-3, 8e-3, 1.6e-2] } else { TIMES };
        let exact = times.map(|time| factor * time);
        let told = told(&states(&exact, |time| time / factor, 1e-3));
        assert!(told.len() == 1 && told[0].contains(words), "{factor}: {told:?}");
    }
    for factor in [9810.0, 1.0 / 9810.0] {
        let times = if factor > 1.0 { [5e-6, 1e-5, 5e-5, 1e-4] } else { TIMES };
        let exact = times.map(|time| factor * time);
        let told = told(&states(&exact, |time| time / factor, 0.0));
        let words = if factor > 1.0 {
            "is k taken for k/γ_w"
        } else {
            "is k/γ_w, or k/μ in place of it, taken for the hydraulic conductivity k"
        };
        assert!(told.iter().any(|told| told.contains(words)), "{factor}: {told:?}");
    }
}

#[test]
fn with_a_porosity_of_a_half_a_factor_of_two_has_both_causes() {
    let mut column = ColumnParameters::default();
    column.soil.porosity = 0.5;
    for (factor, words) in [
        (2.0, "is k divided by the porosity, or are the times off?"),
        (0.5, "is k multiplied by the porosity, or are the times off?"),
    ] {
        let states = states(&TIMES.map(|time| factor * time), |time| time / factor, 1e-3);
        let told = diagnosis(&column, ReferenceKind::Terzaghi, &states, &mapping(CONVENTION));
        assert!(told.len() == 1 && told[0].contains(words), "{factor}: {told:?}");
    }
}

#[test]
fn times_that_are_off_by_a_factor_or_from_another_moment_are_named() {
    for (factor, said) in
        [(1.1, "at 1.1 × the time"), (0.9, "at 0.9 × the time"), (0.5, "at 0.5 × the time"), (2.5, "2.5 ×")]
    {
        for off in [0.0, 1e-3] {
            let told = told(&states(&TIMES.map(|time| factor * time), |time| time / factor, off));
            assert!(
                told.len() == 1 && told[0].contains(said) && told[0].contains("are the times off?"),
                "{factor}, {off}: {told:?}"
            );
        }
    }
    // T_v = 0.02 is 1.635 s.
    for (offset, moment, sense) in [(0.02, "after", "too early?"), (-0.02, "before", "too late?")] {
        for off in [0.0, 1e-3] {
            let told = told(&states(&TIMES.map(|time| time + offset), |time| time - offset, off));
            let told = told.join("; ");
            let seconds = told.split("matches the exact one ").nth(1).and_then(|rest| rest.split(' ').next());
            let seconds = seconds.and_then(|seconds| seconds.parse::<f64>().ok());
            assert!(
                seconds.is_some_and(|seconds| (seconds / 1.635 - 1.0).abs() < 0.02)
                    && told.contains(&format!("s {moment}: do your times start at another moment"))
                    && told.ends_with(sense),
                "{offset}, {off}: {told}"
            );
        }
    }
}

/// Right numbers of a solver whose drained node begins at 0, so that half a cell is empty at the start; and of one whose error
/// on five cells has one sign below and another above.
#[test]
fn what_a_coarse_mesh_makes_is_no_mistake() {
    let off = |times: &[f64], sign: f64| {
        let written: Vec<f64> = times.iter().map(|time| time + sign * 4.9e-4).collect();
        states(&written, |time| time - sign * 4.9e-4, 0.0)
    };
    for times in [&TIMES[..], &TIMES[1..2]] {
        assert_eq!([1.0, -1.0].map(|sign| told(&off(times, sign))), [[""; 0]; 2]);
    }
    let mut in_kilopascals = off(&TIMES, 1.0);
    for state in &mut in_kilopascals {
        scale(&mut state.pressure, -1e-3);
    }
    only(&in_kilopascals, &["your p is −0.001 × the exact one: is it in kPa"]);
    let five_cells = changed(0.0, |state| {
        for list in
            [&mut state.initial_height, &mut state.volume, &mut state.pressure, &mut state.displacement]
        {
            *list = list.iter().step_by(4).copied().collect();
        }
        state.effective_stress.clear();
        let (below, above) = state.pressure.split_at_mut(3);
        scale(below, 1.02);
        scale(above, 0.98);
    });
    assert_eq!(told(&five_cells), [""; 0]);
}

#[test]
fn two_or_three_wrong_units_and_signs_together_are_named() {
    let minutes = |off: f64, change: &dyn Fn(&mut SampledState)| {
        let mut states = states(&TIMES, |time| time / 60.0, off);
        for state in &mut states {
            state.effective_stress.clear();
            state.displacement.clear();
            change(state);
        }
        states
    };
    for off in [0.0, 1e-3, 0.02] {
        only(
            &minutes(off, &|state| scale(&mut state.pressure, 1e-3)),
            &[
                "your p is 0.001 × the exact one at 60 × the time: is it in kPa where Pa is declared, and are times in min where s is",
            ],
        );
        only(
            &minutes(off, &|state| scale(&mut state.pressure, -1e-3)),
            &[
                "your p is −0.001 × the exact one at 60 × the time: is it in kPa where Pa is declared, and is the sign declared \
               wrongly, and are times in min where s is declared",
            ],
        );
    }
}

#[test]
fn a_slab_without_a_plate_is_named() {
    let column = ColumnParameters::default();
    let slab = Reference::new(ReferenceKind::Mandel, &column, &TIMES).expect("a slab");
    let start = slab.fields(1e-6, 1.0).expect("inside").pressure;
    let bare = Reference::new(ReferenceKind::TerzaghiIncompressible, &column, &TIMES).expect("a column");
    let state = |of: &dyn Fn(f64, f64) -> f64, time: f64| {
        let heights: Vec<f64> = (0..=20).map(|node| f64::from(node) / 20.0).collect();
        SampledState {
            time: column.time(time),
            volume: vec![1.0; 21],
            pressure: heights.iter().map(|height| of(time, 1.0 - height)).collect(),
            initial_height: heights,
            ..SampledState::default()
        }
    };
    let told = |of: &dyn Fn(f64, f64) -> f64| {
        let states = TIMES.map(|time| state(of, time));
        diagnosis(&column, ReferenceKind::Mandel, &states, &mapping(CONVENTION))
    };
    let without = told(&|time, zeta| start * bare.fields(time, zeta).expect("inside").pressure);
    let bends = "your p matches the exact one of a slab whose load does not move to its middle: is the top held plane by a rigid plate?";
    assert_eq!(without, [bends]);
    let with = told(&|time, zeta| {
        slab.fields(time, zeta).expect("inside").pressure * (1.0 + 0.2 * (7.0 * zeta).sin())
    });
    assert_eq!(with, [""; 0]);
}

#[test]
fn a_wrong_unit_is_named_beside_the_one_that_was_declared_for_that_quantity() {
    // Units of lengths and displacements as declared, what that makes of a value in another unit, and what is said of it.
    for (length, displacement, written, words) in [
        ("m", Some("mm"), 1e-3, "is 0.001 × the exact one: is it in m where mm is declared?"),
        ("mm", Some("m"), 1e3, "is 1000 × the exact one: is it in mm where m is declared?"),
        ("m", Some("cm"), 10.0, "is 10 × the exact one: is it in mm where cm is declared?"),
        ("m", Some("mm"), 0.1, "is 0.1 × the exact one: is it in cm where mm is declared?"),
        ("mm", Some("cm"), 1e-2, "is 0.01 × the exact one: is it in m where cm is declared?"),
        ("cm", Some("m"), 100.0, "is 100 × the exact one: is it in cm where m is declared?"),
        ("mm", None, 1e-3, "is 0.001 × the exact one: is it in m where mm is declared?"),
        ("cm", None, 10.0, "is 10 × the exact one: is it in mm where cm is declared?"),
        ("m", None, 1e3, "is 1000 × the exact one: is it in mm where m is declared?"),
    ] {
        let displacement = displacement.map_or(String::new(), |unit| format!("displacement = \"{unit}\""));
        let text = CONVENTION
            .replace("displacement = \"m\"", &displacement)
            .replace("length = \"m\"", &format!("length = \"{length}\""));
        for off in [0.0, 0.05] {
            let states = changed(off, |state| scale(&mut state.displacement, written));
            assert_eq!(told_by(&states, &text), [format!("your u_y {words}")], "{length} {displacement}");
        }
    }
    for (declared, written, words) in [
        ("stress = \"kPa\"", 1e3, "is 1000 × the exact one: is it in Pa where kPa is declared?"),
        ("stress = \"Pa\"", 1e-3, "is 0.001 × the exact one: is it in kPa where Pa is declared?"),
        ("", 1e-6, "is 1e−6 × the exact one: is it in MPa where Pa is declared?"),
        ("stress = \"MPa\"", 1e3, "is 1000 × the exact one: is it in kPa where MPa is declared?"),
    ] {
        let text = CONVENTION.replace("stress = \"Pa\"", declared);
        let states = changed(0.0, |state| {
            scale(&mut state.pressure, written);
            scale(&mut state.effective_stress, written);
        });
        let expected = format!("each of your p and effective_stress {words}");
        assert_eq!(told_by(&states, &text), [expected], "{declared}");
    }
}

#[test]
fn a_top_that_is_not_plane_is_told_with_its_ends_from_two_percent_of_the_settlement_on() {
    let settled = ColumnParameters::default().final_settlement();
    for (share, is_told) in [(0.019, false), (0.021, true), (-0.5, true)] {
        let mut states = states(&TIMES, |time| time, 0.0);
        let last = states.last_mut().expect("a state");
        let moved = last.displacement[0];
        let other = moved + share * settled;
        last.initial_height.push(1.0);
        last.volume.push(1.0);
        last.pressure.push(0.0);
        last.effective_stress.push(last.effective_stress[0]);
        last.displacement.push(other);
        let (least, most) = (rounded(moved.min(other)), rounded(moved.max(other)));
        let sentence = format!(
            "your top is not plane: at y = 1 m u_y lies between {least} and {most} m: are the sides on rollers, and does the \
             load press evenly?"
        );
        let wanted: &[String] = if is_told { &[sentence] } else { &[] };
        assert_eq!(told(&states), wanted, "{share}");
    }
}
