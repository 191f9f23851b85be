//! Tests of the checks of a study, on texts.

use crate::study::check::Study;
use crate::study::file::StudySource;

/// The study of a text, or what is wrong with it.
fn of_text(text: String) -> Result<Study, String> {
    Study::check(&StudySource { name: "t.toml".to_owned(), text }).map_err(|error| error.to_string())
}

mod point_sets {
    use super::*;

    fn checked(scene: &str, method: &str, more: &str) -> Result<Study, String> {
        let text = format!(
            "title = \"t\"\nscene = \"{scene}\"\ncolumn.load = 1e3\n[[sweep]]\nmethod = [{method}]\ncells = [4]\n{more}\n"
        );
        of_text(text)
    }

    #[test]
    fn what_does_not_go_with_two_point_sets_is_refused_with_a_sentence() {
        let two = "sets = [2]";
        for (method, more, why) in [
            ("\"GIMP\"", "sets = [2]\nintegrator = [\"implicit\"]", "integrated explicitly only"),
            ("\"TL-GIMP\"", two, "stay with the skeleton"),
            ("\"GIMP-SRI-patch-cells\"", two, "cell averages need points that carry both phases"),
            ("\"MPM\"", two, "the domains of this basis do not"),
            ("\"uGIMP\"", two, "the domains of this basis do not"),
            (
                "\"GIMP\"",
                "sets = [2]\nconductivity_mean = [\"chord\"]",
                "the chord mean is taken over points",
            ),
            ("\"GIMP\"", "sets = [2]\noffset = [0.25]", "do not end where the soil does"),
            ("\"GIMP\"", "sets = [2]\njitter = [0.25]", "do not end where the soil does"),
            ("\"GIMP\"", "water_per_cell = [3]", "every case has one set for both phases"),
            ("\"GIMP\"", "sets = [3]", "`sets` is 3"),
        ] {
            let error = checked("xie-leo", method, more).expect_err(why);
            assert!(error.contains(why) && error.contains("--> t.toml:"), "{error}");
        }
        for (scene, why) in [
            ("xie-leo\"\ncolumn.self_weight = true #", "the weight of a column needs points"),
            ("mandel\"\n#", "needs a single point set"),
        ] {
            let error = checked(scene, "\"GIMP\"", "sets = [2]\nintegrator = [\"explicit\"]").expect_err(why);
            assert!(error.contains(why), "{error}");
        }
    }

    #[test]
    fn what_does_not_go_with_layers_or_an_integrator_is_refused_with_a_sentence() {
        let of = |scene: &str, column: &str| {
            format!("{scene}\"\ncolumn.soils = [{{ thickness = 0.5 }}, {{ thickness = 0.5 }}]\n{column} #")
        };
        let growing = of("xie-leo", "column.loading_time = 20.0");
        let explicit = "integrator = [\"explicit\"]\n";
        for (scene, more, why) in [
            (of("layered", ""), format!("{explicit}sets = [2]"), "need a single soil"),
            (growing.clone(), format!("{explicit}sets = [2]"), "need a single soil"),
            (growing.clone(), "conductivity_mean = [\"chord\"]".to_owned(), "compression of a single soil"),
            (growing.replace("20.0", "20.0\ncolumn.self_weight = true"), String::new(), "has no weight here"),
            (growing.replace("20.0", "20.0\ncolumn.strain = 0.2"), String::new(), "have different strains"),
            (of("xie-leo", ""), String::new(), "give a loading time"),
            (of("terzaghi", ""), String::new(), "has no `soils`"),
            (of("layered", ""), format!("{explicit}formulation = [\"u-p\"]"), "its pressure diffuses"),
            (of("layered", ""), format!("{explicit}formulation = [\"quasi-static\"]"), "cannot be neglected"),
        ] {
            let error = checked(&scene, "\"GIMP\"", &more).expect_err(why);
            assert!(error.contains(why) && error.contains("--> t.toml:"), "{error}");
        }
        assert!(checked(&growing, "\"GIMP\"", "").is_ok());
    }

    #[test]
    fn points_off_their_lattice_carry_no_weight() {
        let scene = "xie-leo\"\ncolumn.self_weight = true #";
        let error = checked(scene, "\"GIMP\"", "offset = [0.25]").expect_err("a shifted lattice");
        assert!(
            error.contains("do not integrate self-weight exactly") && error.contains("--> t.toml:"),
            "{error}"
        );
        assert!(checked(scene, "\"GIMP\"", "jitter = [0.1]").is_ok());
    }

    #[test]
    fn the_water_has_as_many_points_as_the_skeleton_where_nothing_is_said() {
        let study = checked("terzaghi", "\"MPM\"", "sets = [1, 2]\npoints_per_cell = [3]").expect("sound");
        let of_water: Vec<usize> =
            study.planned.iter().map(|planned| planned.case.column.points.water_per_cell).collect();
        assert_eq!(of_water, [0, 3]);
        let named = checked("terzaghi", "\"MPM\"", "sets = [2]\npoints_per_cell = [3]\nwater_per_cell = [3]");
        assert_eq!(named.expect("sound").planned[0].case.hash(), study.planned[1].case.hash());
        let plain = checked("terzaghi", "\"MPM\"", "points_per_cell = [3]").expect("sound");
        assert_eq!(plain.planned[0].case.hash(), study.planned[0].case.hash());
        assert_eq!(
            study.planned[1].case.label(),
            "MPM explicit cells=4 points=3 stable=0.8 (two point sets)"
        );
    }
}

mod strains {
    use super::*;

    fn checked(column: &str, sweep: &str) -> Result<Study, String> {
        let text = format!(
            "title = \"t\"\nscene = \"xie-leo\"\n[column]\n{column}\n[[sweep]]\nmethod = [\"MPM\"]\n\
             integrator = [\"implicit\"]\ncells = [4]\n{sweep}\n"
        );
        of_text(text)
    }

    #[test]
    fn a_strain_gives_each_case_the_load_of_its_own_soil() {
        let study = checked(
            "strain = 0.2",
            "law = [\"log-linear\", \"porosity-dependent\"]\nyoungs_modulus = [1e6, 2e6]",
        );
        let study = study.expect("sound");
        assert_eq!(study.planned.len(), 4);
        for planned in &study.planned {
            let case = &planned.case;
            assert!((super::super::geometry::final_strain(case) - 0.2).abs() < 1e-14, "{}", case.label());
        }
        // Of the logarithmic law: σ = E_oed ln(1/J), E_oed = 1.2 E at ν = 0.25.
        let load = study.planned[0].case.column.load;
        assert!((load - 1.2e6 * 1.25_f64.ln()).abs() < 1e-6 * load, "{load}");
    }

    #[test]
    fn a_strain_beyond_the_pores_or_beside_a_load_is_refused() {
        let refused = |column: &str, sweep: &str| checked(column, sweep).expect_err("refused");
        assert!(refused("strain = 0.3\nload = 1e5", "").contains("a `load` and a `strain`"));
        assert!(refused("strain = 1.2", "").contains("`column.strain` is 1.2"));
        // The seed's porosity is 0.3.
        for (strain, line) in [("0.35", 4), ("0.3", 4)] {
            let told = refused(&format!("strain = {strain}"), "");
            assert!(
                told.contains(&format!("strains the column by {strain}: the pores close at 0.3")),
                "{told}"
            );
            assert!(
                told.contains(&format!("t.toml:{line}:")) && told.contains("`strain` in [column]"),
                "{told}"
            );
        }
        assert!(checked("strain = 0.25", "").is_ok());
        // One of the swept soils is too soft for the load, though the study's own is not.
        let told = refused("load = 2e5", "youngs_modulus = [1e6, 3e5]");
        assert!(told.contains("E = 300000 Pa") || told.contains("E = 3e5 Pa"), "{told}");
        assert!(checked("load = 2e5", "youngs_modulus = [1e6, 7e5]").is_ok());
    }
}

mod labels {
    use super::*;

    fn labels(sweep: &str) -> Vec<String> {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\n[[sweep]]\nmethod = [\"MPM\"]\nintegrator = [\"implicit\"]\n\
             cells = [4]\ntime_step = [{{ growth = 0.1 }}]\n{sweep}\n"
        );
        let study = of_text(text).expect("sound");
        study.planned.iter().map(|planned| planned.case.label()).collect()
    }

    #[test]
    fn cases_that_would_be_called_alike_name_what_they_differ_in() {
        let plain = "MPM implicit cells=4 points=2 growth=0.1";
        assert_eq!(labels("youngs_modulus = [2e5]"), [plain], "one soil needs no name");
        assert_eq!(
            labels("youngs_modulus = [2e5, 1e6]\nporosity = [0.4]"),
            [format!("{plain} (youngs_modulus=200000)"), format!("{plain} (youngs_modulus=1000000)")]
        );
        assert_eq!(
            labels("height = [1.0, 2.0]\nload = [1, 1e5]"),
            ["1, load=1", "1, load=100000", "2, load=1", "2, load=100000"]
                .map(|values| format!("{plain} (height={values})"))
        );
    }

    #[test]
    fn the_name_is_no_part_of_the_identity() {
        let of = |sweep: &str| {
            let text = format!(
                "title = \"t\"\nscene = \"terzaghi\"\n[[sweep]]\nmethod = [\"MPM\"]\ncells = [4]\n{sweep}\n"
            );
            of_text(text).expect("sound").planned[0].case.clone()
        };
        let (alone, among) = (of("porosity = [0.4]"), of("porosity = [0.4, 0.5]"));
        assert_ne!(alone.label(), among.label());
        assert_eq!(alone.hash(), among.hash());
    }
}

mod answers {
    use super::*;

    fn said(expectation: &str) -> Option<String> {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1, 0.2]\n\n[[sweep]]\n\
             method = [\"MPM\", \"GIMP\"]\nintegrator = [\"implicit\"]\ncells = [4, 8, 16]\n\n{expectation}\n"
        );
        of_text(text).err()
    }

    #[test]
    fn an_expectation_that_no_case_can_answer_is_refused_at_its_line() {
        let series = "[[expect]]\nmethod = \"GIMP\"\ntime_factor = 0.1\norder = { value = 2.0 }";
        assert_eq!(said(series), None);
        for (from, to, parts) in [
            (
                "\"GIMP\"",
                "\"GIMP-SRI\"",
                ["no case of the study has `method = GIMP-SRI`", "the cases have MPM, GIMP"],
            ),
            ("0.1", "0.15", ["no case has an output at T_v = 0.15", "the outputs are at 0.1, 0.2"]),
            ("0.1", "0.1\nintegrator = \"explicit\"", ["`integrator = explicit`", "the cases have implicit"]),
            ("order", "at = { cells = 10, below = 0.1 }\norder", ["has 10 cells", "they have 4, 8, 16"]),
        ] {
            let told = said(&series.replacen(from, to, 1)).expect("refused");
            assert!(parts.iter().all(|part| told.contains(part)) && told.contains("t.toml:1"), "{told}");
        }
        let case = "[[expect_case]]\ncells = 4\nstatus = \"ok\"";
        assert_eq!(said(case), None);
        assert!(said(&case.replacen('4', "5", 1)).expect("refused").contains("`cells = 5`"));
    }
}

mod results {
    use super::*;

    fn checked(result: &str) -> Result<Study, String> {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n\n[[result]]\n{result}\n"
        );
        of_text(text)
    }

    #[test]
    fn a_result_is_a_case_a_mesh_without_a_sweep() {
        let sound = "name = \"ogs\"\nfiles = [\"ogs-{cells}/col.pvd\"]\ncells = [10, 20]\npreset = \"ogs\"\n";
        let study = checked(sound).expect("sound");
        let labels: Vec<String> = study.planned.iter().map(|planned| planned.case.label()).collect();
        assert_eq!(labels, ["ogs cells=10", "ogs cells=20"]);
        let expect = "\n[[expect_case]]\nmethod = \"ogs\"\ncells = 20\nstatus = \"ok\"";
        assert!(checked(&format!("{sound}{expect}")).is_ok());
        let other = expect.replace("20", "40");
        assert!(checked(&format!("{sound}{other}")).is_err_and(|told| told.contains("`cells = 40`")));
        assert_ne!(
            checked(&sound.replace("\"ogs\"\n", "\"meshio\"\n").replacen("meshio", "ogs", 1))
                .expect("sound")
                .planned,
            study.planned,
            "another meaning is another case"
        );
    }

    #[test]
    fn what_is_wrong_with_a_result_is_told_at_its_place() {
        let sound = "name = \"ogs\"\nfiles = [\"ogs-{cells}/col.pvd\"]\ncells = [10, 20]\n";
        for (from, to, told) in [
            ("\"ogs\"", "\"MPM\"", "`MPM` is a method"),
            ("\"ogs\"", "\"o g s\"", "cannot be called `o g s`"),
            ("-{cells}", "", "2 meshes have the same files"),
            ("{cells}", "{cell}", "`{cell}` has no meaning"),
            ("[10, 20]", "[]", "no mesh"),
            ("[10, 20]", "[0]", "0"),
            ("cells = [10, 20]", "cells = [10, 20]\ntime_step = -1.0", "time_step"),
            ("cells = [10, 20]", "cells = [10, 20]\npreset = \"ogx\"", "ogs"),
            ("cells = [10, 20]", "cells = [10, 20]\nmapping = \"none.toml\"", "there is no file"),
        ] {
            let refused = checked(&sound.replacen(from, to, 1)).expect_err(to);
            assert!(refused.contains(told) && refused.contains("t.toml:"), "{to}: {refused}");
        }
    }
}

mod expectations_that_cannot_be_judged {
    use super::*;

    /// A study of meshes or of steps with an expectation.
    fn checked(swept: &str, expected: &str) -> Result<Study, String> {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = [\"MPM\"]\n\
             integrator = [\"implicit\"]\n{swept}\n\n[[expect]]\ntime_factor = 0.1\n{expected}\n"
        );
        of_text(text)
    }

    const STEPS: &str = "cells = [8]\ntime_step = [{ growth = 0.1 }, { growth = 0.05 }, { growth = 0.025 }, { growth = 0.0125 }]";
    const MESHES: &str = "cells = [4, 8, 16]";
    const ORDER: &str = "order = { value = 1.0 }";
    const NEXT_FINER: &str = "axis = \"time_step\"\nreference = \"next-finer\"\norder = { value = 1.0 }";

    #[test]
    fn are_refused_at_their_line_with_the_key_that_is_missing() {
        for (swept, expected, parts) in [
            (STEPS, ORDER, &["needs 3 levels: its cases have 1", "axis = \"time_step\"", "next-finer"][..]),
            (STEPS, "at = { cells = 8, below = 0.5 }", &["needs 2 levels", "axis = \"time_step\""]),
            (
                STEPS,
                "axis = \"time_step\"\norder = { value = 1.0 }",
                &["at the error of the mesh", "\"next-finer\""],
            ),
            (MESHES, "axis = \"time_step\"\norder = { value = 1.0 }", &["have 1", "add `axis = \"cells\"`"]),
            ("cells = [4, 8]", ORDER, &["needs 3 levels: its cases have 2", "add values of `cells`"]),
            // Differences from the next finer step are one fewer than the steps.
            (
                "cells = [8]\ntime_step = [{ growth = 0.1 }, { growth = 0.05 }, { growth = 0.025 }]",
                NEXT_FINER,
                &["needs 4 levels: its cases have 3"],
            ),
        ] {
            let error = checked(swept, expected).expect_err(expected);
            assert!(error.contains("--> t.toml:") && error.contains("[[expect]]"), "{error}");
            for part in parts {
                assert!(error.contains(part), "{part}: {error}");
            }
        }
    }

    #[test]
    fn are_taken_once_it_is_there() {
        for (swept, expected) in
            [(STEPS, NEXT_FINER), (MESHES, ORDER), ("cells = [4, 8]", "at = { cells = 8, below = 0.5 }")]
        {
            checked(swept, expected).expect(expected);
        }
    }
}

mod defaults {
    use super::*;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\ncase_seconds = 77.0\noutput.time_factors = [0.1]\n\
                         {solver}\n[[sweep]]\nmethod = ['MPM', 'toy']\nintegrator = ['implicit']\n\
                         cells = [4, 8, 16]\n[[expect]]\nmethod = 'MPM'\ntime_factor = 0.1\n{demand}\n";
    const SOLVER: &str = "[[solver]]\nname = 'toy'\ncommand = ['true']\nresult = '{out}/r.csv'\n";

    fn checked(solver: &str, demand: &str) -> Study {
        let text = STUDY.replace("{solver}", &format!("{SOLVER}{solver}")).replace("{demand}", demand);
        let study = of_text(text);
        study.unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn a_solver_has_the_time_of_a_case_one_run_and_a_warm_up_before_several() {
        for (typed, timeout, repeats, warm_up) in [
            ("", 77.0, 1, false),
            ("timeout = 5.0", 5.0, 1, false),
            ("repeats = 3", 77.0, 3, true),
            ("repeats = 3\nwarm_up = false", 77.0, 3, false),
            ("warm_up = true", 77.0, 1, true),
        ] {
            let study = checked(typed, "order = { value = 1.0 }");
            let solver = &study.solvers[0];
            assert_eq!(
                (solver.timeout, solver.repeats, solver.warm_up),
                (timeout, repeats, warm_up),
                "{typed}"
            );
            assert_eq!((solver.at_once, solver.solve_unit, solver.time_step), (1, 1.0, None));
        }
    }

    #[test]
    fn a_demand_has_a_tenth_on_both_sides_no_lower_bound_and_a_strict_mark() {
        let demand = |typed: &str| checked("", typed).expectations[0].demand.clone();
        let order = |typed: &str| {
            let band = demand(typed).order.expect("an order");
            [band.value, band.minus, band.plus]
        };
        assert_eq!(order("order = { value = 1.5 }"), [1.5, 0.1, 0.1]);
        assert_eq!(order("order = { value = 1.5, minus = 0.3 }"), [1.5, 0.3, 0.1]);
        assert_eq!(order("order = { value = 1.5, plus = 0.3 }"), [1.5, 0.1, 0.3]);
        let level = demand("at = { cells = 8, below = 0.5 }").at.expect("a level");
        assert_eq!((level.size, level.below, level.above), (1.0 / 8.0, 0.5, 0.0));
        let floor = |typed: &str| demand(typed).floor.map(|band| [band.above, band.below]);
        assert_eq!(floor("floor = { below = 0.5 }"), Some([0.0, 0.5]));
        assert_eq!(floor("floor = { above = 0.5 }"), Some([0.5, f64::MAX]));
        for (typed, strict) in [("", true), (", strict = false", false), (", strict = true", true)] {
            let known = demand(&format!("order = {{ value = 1.0 }}\nxfail = {{ reason = 'known'{typed} }}"));
            assert_eq!(known.xfail.map(|known| known.strict), Some(strict), "{typed}");
        }
    }

    #[test]
    fn a_failure_is_foreseen_for_the_cases_that_are_selected_and_no_other() {
        use crate::case::planned::Tier;
        use crate::record::Status;
        use oedometer_problem::outcome::{Failure, FailureKind};

        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [2, 4, 8]\n[[expect_case]]\ncells = 4\nstatus = 'unstable'\n";
        let study = of_text(text.to_owned()).expect("sound");
        assert_eq!(study.cases(Tier::Full).len(), 3);
        for mut record in crate::campaign::runner::records_of(text) {
            for kind in [FailureKind::Unstable, FailureKind::TimedOut] {
                record.status = Status::Failed(Failure::of_attached(kind, String::new()));
                let is_foreseen = record.case.cells == 4 && kind == FailureKind::Unstable;
                assert_eq!(study.foresees(&record), is_foreseen, "{} {kind:?}", record.case.cells);
            }
        }
    }
}

mod questions {
    use super::*;
    use crate::study::file::GoldenRule;

    fn checked(head: &str, tables: &str) -> Result<Study, String> {
        let text = format!(
            "title = 't'\nscene = 'terzaghi'\n{head}\noutput.time_factors = [0.1]\n{tables}\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [4, 8]\n"
        );
        of_text(text)
    }

    #[test]
    fn a_number_without_a_unit_that_is_likely_in_another_one_is_asked_for() {
        for (tables, asked) in [
            ("material.youngs_modulus = 10000\ncolumn.load = '50 kPa'", Some("did you mean \"10000 kPa\"?")),
            ("material.youngs_modulus = '10 MPa'\ncolumn.load = 50", Some("did you mean \"50 kPa\"?")),
            ("material.youngs_modulus = '10 MPa'\ncolumn.height = 500", Some("did you mean \"500 mm\"?")),
            ("material.youngs_modulus = '10 MPa'\ncolumn.load = '50 Pa'\ncolumn.height = '500 m'", None),
            ("material.youngs_modulus = 1e7\ncolumn.load = 5e4\ncolumn.height = 5", None),
        ] {
            let warnings = checked("", tables).expect("sound").warnings.join("\n");
            let told = warnings.contains("did you mean");
            assert!(asked.map_or(!told, |words| warnings.contains(words)), "{tables}: {warnings}");
        }
        let bound = |below: &str| {
            let expects = format!("[[expect]]\ntime_factor = 0.1\nat = {{ cells = 8, below = {below} }}");
            checked("", &expects).expect("sound").warnings.join("\n")
        };
        assert!(bound("1").contains("did you mean \"1 %\"?"), "{}", bound("1"));
        assert_eq!(bound("0.9"), "");
    }

    #[test]
    fn golden_values_may_be_left_out_or_given_a_tolerance_and_nothing_else() {
        let expects = "[[expect_case]]\ntime_factor = 0.1\nerror = { below = 0.5 }";
        let rule = |head: &str, tables: &str| checked(head, tables).map(|study| study.golden);
        assert_eq!(rule("", ""), Ok(GoldenRule::Measured));
        assert_eq!(rule("golden = 'none'", expects), Ok(GoldenRule::None));
        assert_eq!(rule("golden.tolerance = 1e-6", ""), Ok(GoldenRule::Within(1e-6)));
        for (head, tables, words) in [
            ("golden = 'none'", "", "nothing would be judged"),
            ("golden = 'some'", expects, "no golden is called `some`"),
            ("golden.tolerance = 0.1", "", "is not between 0 and 0.01"),
            ("golden.tolerance = -1e-6", "", "is not between 0 and 0.01"),
            ("golden.bound = 1e-6", "", "bound"),
        ] {
            let error = rule(head, tables).expect_err(words);
            assert!(error.contains(words), "{error}");
        }
    }
}
