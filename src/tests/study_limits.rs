//! Every limit of the study checker: values inside and at it are taken, values beyond it are refused, by literal numbers.

use crate::study::check::Study;
use crate::study::file::StudySource;

/// A study with places for what is tried.
const STUDY: &str = "title = 't'\nscene = 'terzaghi'\n{tables}\noutput.time_factors = [0.1]\n[[sweep]]\n\
                     method = ['GIMP']\nintegrator = ['implicit']\ncells = [4, 8, 16]\n{sweep}\n{tail}\n";

/// A double-point study.
const LAYERS: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\n\
                      method = ['GIMP-SRI-patch']\ncells = [4]\n{sweep}\n{tail}\n";

/// What is said of a study in which the places have these texts.
fn said(study: &str, tables: &str, sweep: &str, tail: &str) -> Option<String> {
    let text = study.replace("{tables}", tables).replace("{sweep}", sweep).replace("{tail}", tail);
    let source = StudySource { name: "t.toml".to_owned(), text };
    Study::check(&source).err().map(|error| error.to_string())
}

/// Texts with a place `#` for the value, values that are taken, values that are refused.
type Limit = (&'static str, &'static [&'static str], &'static [&'static str]);

fn held(limits: &[Limit], of: impl Fn(&str) -> Option<String>) {
    for (text, taken, refused) in limits {
        for value in *taken {
            assert_eq!(of(&text.replace('#', value)), None, "{text} with {value}");
        }
        for value in *refused {
            assert!(of(&text.replace('#', value)).is_some(), "{text} with {value} is taken");
        }
    }
}

#[test]
fn inputs_of_cases_are_taken_up_to_their_limits_and_no_further() {
    const INPUTS: [Limit; 17] = [
        ("points_per_cell = [#]", &["1", "2", "16"], &["0", "-1", "17"]),
        ("offset = [#]", &["-0.5", "0.1", "0.5"], &["-0.500001", "0.500001", "nan"]),
        ("jitter = [#]", &["-0.5", "0.1", "0.5"], &["-0.500001", "0.500001", "nan"]),
        ("filling = [#]", &["0.001", "1.0"], &["0.0", "1.000001", "-0.1", "nan"]),
        ("poissons_ratio = [#]", &["-0.999", "0.0", "0.4999"], &["-1.0", "0.5", "nan"]),
        ("porosity = [#]", &["0.001", "0.999"], &["0.0", "1.0", "-0.1", "nan"]),
        ("youngs_modulus = [#]", &["1e7"], &["0.0", "-1.0", "inf", "nan"]),
        ("grain_density = [#]", &["2650.0"], &["0.0", "-1.0", "inf", "nan"]),
        ("water_density = [#]", &["1000.0"], &["0.0", "-1.0", "inf", "nan"]),
        ("water_bulk_modulus = [#]", &["1e9"], &["0.0", "-1.0", "inf", "nan"]),
        ("hydraulic_conductivity = [#]", &["1e-5"], &["0.0", "-1.0", "inf", "nan"]),
        ("gravity = [#]", &["9.8"], &["0.0", "-1.0", "inf", "nan"]),
        ("height = [#]", &["2.0"], &["0.0", "-1.0", "inf", "nan"]),
        ("load = [#]", &["100.0"], &["0.0", "-1.0", "inf", "nan"]),
        (
            "time_step = [{ growth = # }]",
            &["1e-9", "0.5", "1.0"],
            &["0.0", "-1.0", "9e-10", "1.000001", "nan"],
        ),
        ("time_step = [{ seconds = # }]", &["1e-12", "1.0"], &["0.0", "-1.0", "inf", "nan"]),
        ("time_step = [{ tolerance = # }]", &["1e-12", "1e-4"], &["9e-13", "0.0", "-1.0", "inf", "nan"]),
    ];
    held(&INPUTS, |sweep| said(STUDY, "", sweep, ""));
    held(&[("[#]", &["1", "2", "100000"], &["0", "-1", "100001"])], |cells| {
        said(&STUDY.replace("[4, 8, 16]", cells), "", "", "")
    });
    let explicit = STUDY.replace("implicit", "explicit");
    let of_explicit: [Limit; 3] = [
        ("flip = [#]", &["0.0", "0.5", "1.0"], &["-0.000001", "1.000001", "nan"]),
        ("time_step = [{ stable = # }]", &["1e-9", "0.8", "1.3"], &["9e-10", "0.0", "-1.0", "inf", "nan"]),
        ("time_step = [{ courant = # }]", &["1e-9", "0.5"], &["9e-10", "0.0", "-1.0", "inf", "nan"]),
    ];
    held(&of_explicit, |sweep| said(&explicit, "", sweep, ""));
    held(&[("sets = [#]", &["1", "2"], &["0", "3"])], |sweep| said(LAYERS, "", sweep, ""));
    held(&[("sets = [2]\nwater_per_cell = [#]", &["1", "2", "16"], &["-1", "17"])], |sweep| {
        said(LAYERS, "", sweep, "")
    });
    let vortex = STUDY.replace("terzaghi", "manufactured-vortex");
    held(&[("amplitude = [#]", &["-4.0", "0.05", "4.0"], &["-4.000001", "4.000001"])], |sweep| {
        said(&vortex, "", sweep, "")
    });
}

#[test]
fn a_sealed_soil_takes_no_explicit_drag_in_explicit_steps() {
    let sealed = STUDY.replace("terzaghi", "sealed-element");
    let of = |integrator: &str, drag: &str| {
        let study = sealed.replace("'implicit'", &format!("'{integrator}'"));
        said(&study, &format!("integrator.drag = '{drag}'"), "", "")
    };
    for drag in ["implicit", "centred"] {
        assert_eq!(of("explicit", drag), None, "{drag}");
    }
    assert_eq!(of("implicit", "explicit"), None);
    let told = of("explicit", "explicit").expect("refused");
    assert!(told.contains("nearly impermeable soil") && told.contains("drag = \"implicit\""), "{told}");
}

#[test]
fn tables_of_a_study_are_taken_up_to_their_limits_and_no_further() {
    const TABLES: [Limit; 4] = [
        ("case_seconds = #", &["0.001"], &["0.0", "-1.0", "inf", "nan"]),
        ("timing.repeats = #", &["0", "5", "1000"], &["-1", "1001"]),
        ("column.dimensions = #", &["1"], &["0", "3"]),
        ("output.references = [#]", &["'terzaghi'"], &["'terzaghi', 'terzaghi'", "'none'"]),
    ];
    held(&TABLES, |tables| match tables.strip_prefix("output.") {
        // The table of the outputs is there once.
        Some(references) => {
            let both = format!("output = {{ time_factors = [0.1], {references} }}");
            said(&STUDY.replace("output.time_factors = [0.1]", &both), "", "", "")
        }
        None => said(STUDY, tables, "", ""),
    });
    held(&[("[#]", &["0.0", "1e-15", "0.1", "100.0"], &["9e-16", "100.001", "-1.0", "nan"])], |times| {
        said(&STUDY.replace("[0.1]", times), "", "", "")
    });
    held(&[("loading_time = #", &["0.0", "1.0"], &["-0.001", "inf", "nan"])], |time| {
        said(&STUDY.replace("terzaghi", "xie-leo"), &format!("column = {{ load = 1e5, {time} }}"), "", "")
    });
}

#[test]
fn expectations_are_taken_up_to_their_limits_and_no_further() {
    const OF_SERIES: [Limit; 13] = [
        ("order = { value = # }", &["0.001", "2.0"], &["0.0", "-1.0", "inf", "nan"]),
        ("order = { value = 2.0, minus = # }", &["0.0", "1.0"], &["-0.001", "inf", "nan"]),
        ("order = { value = 2.0, plus = # }", &["0.0", "1.0"], &["-0.001", "inf", "nan"]),
        ("at = { cells = 8, below = # }", &["0.001"], &["0.0", "-1.0", "inf", "nan"]),
        ("at = { cells = 8, below = 0.1, above = # }", &["0.0", "0.099"], &["0.1", "0.2", "-0.001", "nan"]),
        ("at = { cells = #, below = 0.1 }", &["4", "16"], &["0", "5", "100001"]),
        ("floor = { below = # }", &["0.001"], &["0.0", "-1.0", "nan"]),
        ("floor = { below = 0.1, above = # }", &["0.0", "0.1"], &["0.100001", "-0.001", "nan"]),
        ("oscillation = { below = # }", &["0.1", "-0.1"], &["inf", "nan"]),
        (
            "reference = 'none'\nprobe = #\nuncertainty = { below = 1e-3 }",
            &["0.000001", "0.999999"],
            &["0.0", "1.0"],
        ),
        (
            "reference = 'none'\nquantity = 'settlement'\nuncertainty = { below = # }",
            &["0.001"],
            &["0.0", "-1.0", "inf"],
        ),
        ("class = #", &["'exact'"], &["'asymptotics'"]),
        ("order = { value = 2.0 }\nxfail = { reason = # }", &["'known'"], &["' '"]),
    ];
    const OF_CASES: [Limit; 9] = [
        ("solid_drift_below = #", &["1e-9"], &["0.0", "-1.0", "inf", "nan"]),
        ("water_drift_below = #", &["1e-9"], &["0.0", "-1.0", "inf", "nan"]),
        ("time_factor = 0.1\nerror = { below = # }", &["1e-2"], &["0.0", "-1.0", "nan"]),
        ("time_factor = 0.1\nerror = { below = 0.1, above = # }", &["0.0", "0.099"], &["0.1", "nan"]),
        ("peak_pressure = { above = 0.5, below = # }", &["0.6"], &["0.5", "0.4", "nan"]),
        ("peak_time_factor = { above = 0.5, below = # }", &["0.6"], &["0.5", "0.4", "nan"]),
        ("pore_water = { above = 0.5, below = # }", &["0.6"], &["0.5", "0.4", "nan"]),
        ("largest_pressure = { above = 0.5, below = # }", &["0.6"], &["0.5", "0.4", "nan"]),
        ("status = #", &["'ok'", "'unstable'"], &["'fine'"]),
    ];
    held(&OF_SERIES, |asked| said(STUDY, "", "", &format!("[[expect]]\ntime_factor = 0.1\n{asked}")));
    held(&[("#", &["1", "4", "16"], &["0", "-1", "17"])], |points| {
        let at = format!("axis = 'points_per_cell'\nat = {{ points_per_cell = {points}, below = 0.1 }}");
        let sweep = "points_per_cell = [1, 4, 16]";
        said(STUDY, "", sweep, &format!("[[expect]]\ntime_factor = 0.1\ncells = 4\n{at}"))
    });
    held(&[("time_factor = #", &["0.1", "0.1000999"], &["0.100101", "0.0"])], |time| {
        said(STUDY, "", "", &format!("[[expect]]\n{time}\norder = {{ value = 2.0 }}"))
    });
    held(&OF_CASES, |asked| said(STUDY, "", "", &format!("[[expect_case]]\n{asked}")));
    held(&[("one_set_within = #", &["1e-9"], &["0.0", "-1.0", "nan"])], |asked| {
        said(LAYERS, "", "sets = [1, 2]", &format!("[[expect_case]]\n{asked}"))
    });
}

#[test]
fn one_bad_value_of_a_sweep_is_refused_wherever_it_stands() {
    let plane = STUDY.replace("cells = [4, 8, 16]\n", "");
    for (study, tables, sweep, good, bad, part) in [
        (STUDY, "", "porosity", ["0.3", "0.4", "0.5"], "1.0", "`porosity` is 1"),
        (STUDY, "", "filling", ["0.5", "0.6", "1.0"], "0.0", "`points.filling` is 0"),
        ("xie-leo", "", "load", ["1e5", "2e5", "3e5"], "1e8", "the pores close"),
        ("xie-leo", "column.load = 1e5", "youngs_modulus", ["1e6", "2e6", "3e6"], "1e3", "the pores close"),
        (
            &plane,
            "column = { dimensions = 2, width = 1.0 }",
            "cells",
            ["4", "8", "16"],
            "90000",
            "GB of memory",
        ),
        (
            &plane,
            "column = { dimensions = 2, width = 0.5 }",
            "cells",
            ["4", "8", "16"],
            "5",
            "do not fill a width",
        ),
    ] {
        let study = if study == "xie-leo" { STUDY.replace("terzaghi", study) } else { study.to_owned() };
        let of = |values: [&str; 3]| said(&study, tables, &format!("{sweep} = [{}]", values.join(", ")), "");
        assert_eq!(of(good), None, "{sweep}");
        for place in 0..3 {
            let mut values = good;
            values[place] = bad;
            assert!(
                of(values).is_some_and(|told| told.contains(part)),
                "{sweep}: {bad} at {place}: {:?}",
                of(values)
            );
        }
    }
    for place in 0..3 {
        let mut loads = ["1e2", "2e2", "3e2"];
        loads[place] = "9e5";
        let text = STUDY.replace("{tables}", "").replace("{tail}", "");
        let text = text.replace("{sweep}", &format!("load = [{}]", loads.join(", ")));
        let study = Study::check(&StudySource { name: "t.toml".to_owned(), text }).expect("sound");
        assert!(format!("{:?}", study.warnings).contains("7.50e-1"), "{place}: {:?}", study.warnings);
    }
}
