//! What the checker says of a study that it refuses or warns of, whole, and what it makes of one that it takes.

use crate::Tier;
use crate::case::Value;
use crate::case::work_estimate::estimated_seconds;
use crate::study::check::Study;
use crate::study::diagnostic::Diagnostic;
use crate::study::file::StudySource;
use oedometer_wording::duration;

/// A study of a scene with places for what is tried.
fn text(scene: &str, tables: &str, sweep: &str, tail: &str) -> String {
    format!(
        "title = 't'\nscene = '{scene}'\n{tables}\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n{sweep}\n{tail}\n"
    )
}

fn checked(text: &str) -> Result<Study, Vec<Diagnostic>> {
    let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
    Study::check(&source).map_err(|error| error.diagnostics)
}

/// What is said of a study, and what helps.
fn said(text: &str) -> Vec<(String, String)> {
    let found = checked(text).err().unwrap_or_default();
    found.into_iter().map(|one| (one.message, one.help.unwrap_or_default())).collect()
}

const IMPLICIT: &str = "integrator = ['implicit']\ncells = [4, 8, 16]";

/// Scene, tables, sweep and expectation of a study, with ⏎ for the end of a line; what is wrong, and what helps.
const COMPLAINTS: &str = r#"
xie-leo ¦ output.references = ['xie-leo']⏎column.loading_time = 5.0 ¦ cells = [4] ¦  ¦ the load of `xie-leo` is sudden, but this column's grows ¦ compare it with "large-strain"
at-rest ¦ column.strain = 0.1 ¦ cells = [4] ¦  ¦ no load acts in the problem `at-rest`, so it has no strain ¦ leave `strain` out
terzaghi ¦ column.strain = 0.1 ¦ cells = [4]⏎load = [1.0, 2.0] ¦  ¦ the column has a `load` and a `strain` ¦ leave one of them out: each determines the other
mandel ¦ column.dimensions = 1 ¦ cells = [10] ¦  ¦ `mandel` has two dimensions ¦ leave the key out: the plate presses perpendicular to the flow of the water
layered ¦ column = { height = 2.5, soils = [{ thickness = 3.0 }, { thickness = 1.5 }] } ¦ cells = [4] ¦  ¦ the layers are 4.5 m thick together, but the column is 2.5 m high: they must fill it ¦ make the column 4.5 m high, or the layers thinner
layered ¦ column = { height = 2.5, soils = [{ thickness = 1.0 }, { thickness = 0.5 }] } ¦ cells = [4] ¦  ¦ the layers are 1.5 m thick together, but the column is 2.5 m high: they must fill it ¦ make the last layer 1.5 m thick, or the column 1.5 m high
layered ¦ column.soils = [NINE] ¦ cells = [4] ¦  ¦ 9 layers of soil ¦ at most 8 are allowed
terzaghi ¦ solver = [{ name = 'a', command = ['b'], result = '{out}/c', solve_seconds = 'LONG' }] ¦ cells = [4] ¦  ¦ the pattern has more than 500 letters ¦ write a short one, like "It took ([0-9.e+-]+) s"
cosine-layer ¦  ¦ cells = [4, 8, 16] ¦ reference = 'none'⏎probe = 0.5⏎uncertainty = { below = 0.1 } ¦ a probe is for a field of a column that is compared with no reference ¦ add `reference = "none"`, or leave the key out
terzaghi ¦  ¦ cells = [4, 8]⏎height = [1.0, 2.0] ¦ at = { cells = 8, below = 0.5 } ¦ the cases have several heights, but the expectation names none ¦ add the one that is meant, like `height = 2.0`
terzaghi ¦  ¦ cells = [4, 8]⏎[[sweep]]⏎method = ['MPM']⏎integrator = ['implicit']⏎cells = [4, 8]⏎porosity = [0.4] ¦ method = 'GIMP'⏎porosity = 0.4⏎at = { cells = 8, below = 0.5 } ¦ no case of the study has `porosity = 0.4` and the other inputs of the expectation ¦ the cases have 0.3
terzaghi ¦  ¦ cells = [4]⏎time_step = [{ seconds = 1.0 }, { seconds = 0.5 }] ¦ axis = 'time_step'⏎class = 'asymptotic'⏎at = { cells = 4, below = 0.5 } ¦ the bound names no level of its axis, or no bound ¦ write it like { cells = 10, below = 5.0e-3 }
terzaghi ¦  ¦ cells = [4, 8] ¦ quantity = 'settlement'⏎norm = 'l2'⏎at = { cells = 8, below = 0.5 } ¦ a settlement has no `norm = "l2"` ¦ it is measured at the "surface", "relative" to the exact one: leave the key out
footing ¦  ¦ cells = [4, 8] ¦ quantity = 'load_factor'⏎sample = 'nodes'⏎at = { cells = 8, below = 0.5 } ¦ a bearing-capacity factor has no `sample = "nodes"` ¦ it is measured at the "surface", "relative" to the exact one: leave the key out
"#;

#[test]
fn what_a_study_cannot_have_is_told_once_with_what_helps() {
    // The most layers and the longest pattern that there may be, and one more.
    let (layers, patterns) = (["{ thickness = 0.125 }"; 9].join(", "), ["(.)"; 167].concat());
    for row in COMPLAINTS.trim().lines() {
        let row = row.replace("NINE", &layers).replace("LONG", &patterns);
        let fields: Vec<String> = row.split(" ¦ ").map(|field| field.replace('⏎', "\n")).collect();
        let [scene, tables, sweep, asked, message, help] = &fields[..] else { panic!("{row}") };
        let tail =
            if asked.is_empty() { String::new() } else { format!("[[expect]]\ntime_factor = 0.1\n{asked}") };
        let found = said(&text(scene, tables, &format!("integrator = ['implicit']\n{sweep}"), &tail));
        assert_eq!(found, [(message.clone(), help.clone())], "{row}");
        let fewer = tables.replacen("{ thickness = 0.125 }, ", "", 1).replacen("(.)", "", 1);
        if fewer != *tables {
            assert_eq!(said(&text(scene, &fewer, IMPLICIT, "")), [], "{fewer}");
        }
    }
    let told = said(&text("terzaghi", "task = 'stability'\ncolumn.self_weight = true", "cells = [4]", ""));
    let why = "self-weight does not change the critical step: it is that of the weightless column";
    assert_eq!(told, [(why.to_owned(), "leave `self_weight` out of a study of stability".to_owned())]);
}

#[test]
fn a_table_of_another_body_is_refused_at_the_first_value_that_is_typed() {
    let study = text("cosine-layer", "column = { width = 0.5, load = 2.0, height = 3.0 }", IMPLICIT, "");
    let found = checked(&study).expect_err("another body");
    let places: Vec<&str> = found.iter().map(|one| &study[one.span.clone().expect("a place")]).collect();
    assert_eq!(places, ["0.5"]);
}

#[test]
fn a_method_is_what_its_choices_say_or_refused_with_the_choice_that_is_wrong() {
    let of = |scene: &str, choices: &str| {
        let study = format!(
            "title = 't'\nscene = '{scene}'\n[[sweep]]\nmethod = [{{ {choices} }}]\nintegrator = ['implicit']\ncells = [4]\n"
        );
        match checked(&study) {
            Ok(study) => Ok(study.planned[0].case.method.built_in().expect("a method")),
            Err(found) => {
                assert_eq!(found.len(), 1, "{found:?}");
                Err((found[0].message.clone(), found[0].help.clone().unwrap_or_default()))
            }
        }
    };
    let gimp = "basis = 'cpgimp', strain = 'standard'";
    for (choices, message, help) in [
        (
            format!("{gimp}, pressure = 'sri'"),
            "the method names no `recovery`",
            "it can be constant, patch, patch-soils, nodal, null-space, ppp",
        ),
        (
            format!("{gimp}, pressure = 'points', recovery = 'patch'"),
            "values at the points need no recovery from cells",
            "leave the key out, or choose another",
        ),
        (
            format!("{gimp}, pressure = 'points', quadrature = 'moments'"),
            "moments are fitted over cells, but the domains or splines of this basis reach beyond them",
            "use the basis \"hat\", or leave `quadrature` out",
        ),
        (
            format!("{gimp}, pressure = 'points', recovery = 'nodal', projection = 1.0"),
            "this recovery has no projection",
            "leave `projection` out, or use the recovery \"ppp\"",
        ),
    ] {
        assert_eq!(of("terzaghi", &choices), Err((message.to_owned(), help.to_owned())), "{choices}");
    }
    let frozen = of("xie-leo", &format!("{gimp}, pressure = 'points', configuration = 'frozen'"));
    assert_eq!(frozen.expect_err("large strain").1, "use \"updated\" or \"total\", or leave the key out");
    for (choices, name) in [
        (format!("{gimp}, pressure = 'points'"), "GIMP"),
        (format!("{gimp}, pressure = 'sri', recovery = 'constant'"), "GIMP-SRI"),
        (format!("{gimp}, pressure = 'sri', recovery = 'patch', memory = 'cells'"), "GIMP-SRI-patch-cells"),
        (
            "basis = 'hat', strain = 'standard', pressure = 'points', quadrature = 'moments'".to_owned(),
            "MPM-moments",
        ),
        (format!("{gimp}, pressure = 'points', recovery = 'ppp', projection = 1.0"), "PPP"),
    ] {
        assert_eq!(of("terzaghi", &choices).expect("sound").to_string(), name, "{choices}");
    }
    let ppp = |projection: &str| {
        let choices = format!("{gimp}, pressure = 'points', recovery = 'ppp', projection = {projection}");
        of("terzaghi", &choices).map(|method| method.projection)
    };
    for (typed, thousandths) in
        [("0.001", 1), ("0.0014", 1), ("0.0016", 2), ("0.25", 250), ("1000.0", 1_000_000)]
    {
        assert_eq!(ppp(typed), Ok(thousandths), "{typed}");
    }
    for typed in ["0.00099", "1000.1", "0.0", "-1.0", "nan"] {
        let told = ppp(typed).expect_err(typed);
        assert_eq!(
            told.0, "the parameter of a projection is between 0.001 and 1000 times the published value",
            "{typed}"
        );
        assert_eq!(told.1, "use 1, or leave it out");
    }
}

#[test]
fn a_level_is_as_large_as_what_is_refined_there() {
    for (sweep, expected, size) in [
        ("cells = [4, 8]", "at = { cells = 8, below = 0.5 }", 0.3125),
        ("cells = [4, 8]\nheight = [1.0, 2.0]", "height = 2.0\nat = { cells = 8, below = 0.5 }", 0.25),
        (
            "cells = [8]\npoints_per_cell = [2, 4]",
            "axis = 'points_per_cell'\nat = { points_per_cell = 4, below = 0.5 }",
            0.25,
        ),
        (
            "cells = [8]\ntime_step = [{ seconds = 1.0 }, { seconds = 0.5 }]",
            "axis = 'time_step'\nat = { seconds = 0.5, below = 0.5 }",
            0.5,
        ),
        (
            "cells = [8]\ntime_step = [{ seconds = 60.0 }, { seconds = 120.0 }]",
            "axis = 'time_step'\nat = { seconds = '2 min', below = 0.5 }",
            120.0,
        ),
        (
            "cells = [8]\nwater_bulk_modulus = [1e9, 2e9]",
            "axis = 'water_bulk_modulus'\nat = { water_bulk_modulus = '2 GPa', below = 0.5 }",
            5e-10,
        ),
    ] {
        for key in ["at", "spread"] {
            let sweep = format!("integrator = ['implicit']\n{sweep}");
            let tail =
                format!("[[expect]]\ntime_factor = 0.1\n{}", expected.replace("at = ", &format!("{key} = ")));
            let study = checked(&text("terzaghi", "column.height = 2.5", &sweep, &tail)).expect(&tail);
            let demand = &study.expectations[0].demand;
            let [asked, other] =
                if key == "at" { [&demand.at, &demand.spread] } else { [&demand.spread, &demand.at] };
            assert_eq!(
                asked.as_ref().map(|bound| (bound.size, bound.below, bound.above)),
                Some((size, 0.5, 0.0))
            );
            assert!(other.is_none(), "{tail}");
        }
    }
}

#[test]
fn every_block_has_the_inputs_and_the_tier_of_its_own() {
    let sweep = |cells: usize, tier: &str| {
        format!(
            "[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [{cells}]\ntier = '{tier}'\n"
        )
    };
    let expect = |block: &str, cells: usize, tier: &str, demand: &str| {
        format!("[[{block}]]\ncells = {cells}\ntier = '{tier}'\n{demand}\n")
    };
    let text = format!(
        "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n{}{}{}{}{}{}{}{}{}",
        sweep(4, "full"),
        sweep(5, "smoke"),
        sweep(6, "ci"),
        expect("expect", 5, "full", "time_factor = 0.1\nclass = 'not-evaluable'"),
        expect("expect", 6, "smoke", "time_factor = 0.1\nclass = 'not-evaluable'"),
        expect("expect", 4, "ci", "time_factor = 0.1\nclass = 'not-evaluable'"),
        expect("expect_case", 6, "ci", "status = 'ok'"),
        expect("expect_case", 4, "full", "status = 'ok'"),
        expect("expect_case", 5, "smoke", "status = 'ok'"),
    );
    let study = checked(&text).expect("sound");
    for (tier, cells) in [(Tier::Smoke, &[5][..]), (Tier::Ci, &[5, 6]), (Tier::Full, &[4, 5, 6])] {
        let found: Vec<usize> = study.cases(tier).into_iter().map(|case| case.cells).collect();
        assert_eq!(found, cells, "{tier:?}");
    }
    let cells_of = |selection: &crate::study::expectation::Selection| match selection.0[..] {
        [(key, Value::Count(cells))] if key.name == "cells" => cells,
        ref other => panic!("{other:?}"),
    };
    let series: Vec<_> =
        study.expectations.iter().map(|one| (cells_of(&one.selection), one.tier, one.line)).collect();
    assert_eq!(series, [(5, Tier::Full, 19), (6, Tier::Smoke, 24), (4, Tier::Ci, 29)]);
    let single: Vec<_> =
        study.case_expectations.iter().map(|one| (cells_of(&one.selection), one.tier, one.line)).collect();
    assert_eq!(single, [(6, Tier::Ci, 34), (4, Tier::Full, 38), (5, Tier::Smoke, 42)]);
}

#[test]
fn a_load_is_warned_of_from_a_hundredth_of_strain_on_where_it_is_typed() {
    let warned = |tables: &str, sweep: &str| {
        let study = checked(&text(
            "terzaghi",
            tables,
            &format!("integrator = ['implicit']\ncells = [4]\n{sweep}"),
            "",
        ));
        let warnings = study.expect("sound").warnings.join("\n");
        let place = warnings.lines().nth(1).map(|line| line.trim().replace("--> t.toml:", ""));
        assert!(warnings.is_empty() || warnings.contains("by about that fraction"), "{warnings}");
        place
    };
    // The seed's oedometric modulus is 1.2 MPa.
    assert_eq!(warned("column.load = 12000.0", ""), None);
    assert_eq!(warned("column.load = 12001.0", "").as_deref(), Some("3:15"));
    assert_eq!(warned("material.youngs_modulus = 101.0", "load = [1.0, 2.0]").as_deref(), Some("3:27"));
    assert_eq!(warned("", "load = [1.0, 2e5, 1.0]").as_deref(), Some("2:9"));
    assert_eq!(
        warned("material.youngs_modulus = 1e3\ncolumn.load = 13.0", "").as_deref(),
        Some("4:15"),
        "the load before the soil"
    );
}

#[test]
fn a_bound_that_a_result_of_zero_meets_is_asked_about_wherever_it_stands() {
    for (block, is_asked) in [
        ("[[expect]]\ntime_factor = 0.1\nat = { cells = 4, below = 1 }", true),
        ("[[expect]]\ntime_factor = 0.1\nat = { cells = 4, below = 0.99 }", false),
        ("[[expect]]\ntime_factor = 0.1\nat = { cells = 4, below = 2, above = 1 }", false),
        ("[[expect_case]]\ntime_factor = 0.1\nerror = { below = 1 }", true),
        ("[[expect_case]]\ntime_factor = 0.1\nerror = { below = 0.99 }", false),
        ("[[expect_case]]\ntime_factor = 0.1\nerror = { above = 0.5 }", false),
    ] {
        let study = checked(&text("terzaghi", "", "integrator = ['implicit']\ncells = [4, 8]", block));
        let warnings = study.expect("sound").warnings.join("\n");
        assert_eq!(warnings.contains("did you mean \"1 %\"?"), is_asked, "{block}: {warnings}");
    }
}

#[test]
fn the_slowest_of_the_projected_waves_is_told_wherever_it_stands() {
    for cells in ["[4, 16, 64]", "[16, 4, 64]", "[64, 16, 4]"] {
        let sweep = format!("cells = {cells}\ntime_factors = [1e-6]");
        let study = text("standing-wave", "", &sweep, "").replace("'GIMP'", "'VP', 'PPP'");
        let warnings = checked(&study).expect("sound").warnings;
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(
            warnings[0].starts_with(
                "warning: the pressure projection of `PPP` stores more than the water: on 4 cells the longest wave travels at "
            ),
            "{warnings:?}"
        );
        let share = warnings[0].split("travels at ").nth(1).and_then(|rest| rest.split(' ').next());
        assert!(
            share
                .and_then(|share| share.parse::<f64>().ok())
                .is_some_and(|share| share > 1.0 && share < 90.0)
        );
    }
}

#[test]
fn who_names_no_integrator_is_told_both_times() {
    let study = |sweep: &str| checked(&text("terzaghi", "", sweep, "")).expect("sound");
    let longest = |study: &Study| {
        let seconds = study.planned.iter().map(|planned| estimated_seconds(&planned.case));
        duration(seconds.fold(0.0, f64::max))
    };
    let taken = study("cells = [640, 5]\ntime_factors = [1.0]");
    let explicit = study("integrator = ['explicit']\ncells = [640, 5]\ntime_factors = [1.0]");
    let told = format!(
        "no integrator is given, and `explicit` would take {} for its longest case: `implicit` is used, {}",
        longest(&explicit),
        longest(&taken)
    );
    assert_ne!(longest(&explicit), longest(&taken));
    let found = taken.warnings.join("\n").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(found.starts_with(&format!("warning: {told} --> t.toml:5:1 ")), "{found} for {told}");
    let help = "write `integrator = [\"implicit\"]` to confirm it, or `integrator = [\"explicit\"]` to solve explicitly";
    assert!(found.ends_with(help), "{found}");
}
