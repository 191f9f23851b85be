//! Tables from the file to their states: units, signs, places, and mistakes with their line.

use super::SampledState;
use crate::import::mapping::preset::{CONVENTION, PLANE_CONVENTION};
use crate::import::mapping::{Axes, Mapping, TableLayout};
use crate::import::raw_row::SolvedBody;
use crate::import::runs::runs_of;
use oedometer_input::source::StudySource;

const STRANGE: &str = r#"
[columns]
t = "day"
y = "depth"
p = "pwp"
u_y = "settled"
effective_stress = "sig"
[units]
time = "d"
length = "cm"
displacement = "mm"
stress = "kPa"
[sign]
y = "down"
p = "tension-positive"
u_y = "down"
effective_stress = "compression-positive"
[position]
y = "current"
[csv]
delimiter = ";"
"#;

fn states(mapping: &str, text: &str) -> Result<Vec<SampledState>, String> {
    let source = StudySource { name: "map.toml".to_owned(), text: mapping.to_owned() };
    let mapping = Mapping::read(&source).expect("a mapping");
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("result.csv");
    std::fs::write(&path, text).expect("a file");
    let frame = SolvedBody {
        height: 1.0,
        length: mapping.columns.x.is_some().then_some(2.0),
        seconds_per_time_factor: 81.75,
    };
    let runs = runs_of(&[vec![path]], &mapping, frame);
    runs.map(|mut runs| runs.remove(0).states).map_err(|error| error.to_string())
}

#[test]
fn units_and_signs_become_those_of_this_program() {
    let text = "# by a stranger\nday; depth; pwp; settled; sig\n1; 25; -3; 2; 4\n0.5; 50; -5; 1; 0\n";
    let states = states(STRANGE, text).expect("rows");
    assert_eq!(states.len(), 2, "by time");
    assert_eq!(states[0].time, 43_200.0);
    let later = &states[1];
    assert_eq!((later.pressure[0], later.effective_stress[0]), (3e3, -4e3));
    assert_eq!(later.displacement[0], -2e-3);
    assert!((later.initial_height[0] - 0.752).abs() < 1e-15, "a point at 0.75 m has sunk by 2 mm");
}

#[test]
fn what_is_no_number_or_outside_is_told_with_its_line() {
    for (row, told) in [
        ("1; 25; NaN; 2; 4", "result.csv:2: `NaN` in the column `pwp`"),
        ("1; 25; ; 2; 4", "result.csv:2: `` in the column `pwp`"),
        ("-1; 25; 3; 2; 4", "the time is negative"),
        ("1; 250; 3; 2; 4", "outside the column of 1 m"),
        ("1; 25; 3", "result.csv"),
    ] {
        let error = states(STRANGE, &format!("day; depth; pwp; settled; sig\n{row}\n")).expect_err(row);
        assert!(error.contains(told), "{row}: {error}");
    }
    let error = states(STRANGE, "day; depth; pwp; settled\n").expect_err("a column is missing");
    assert!(error.contains("no column `sig` (to leave it out, call"), "{error}");
    assert!(error.contains("; the header has `day`, `depth`"), "{error}");
    let error = states(STRANGE, "day; depth; pwp; settled; sig\n").expect_err("no rows");
    assert!(error.contains("there are no rows"), "{error}");
}

#[test]
fn places_along_a_layer_have_an_end_an_origin_and_a_range() {
    let mapping = PLANE_CONVENTION
        .replace("x = \"right\"\ny", "x = \"left\"\ny")
        .replace("u_x = \"right\"", "u_x = \"left\"")
        .replace("x = 0.0", "x = 5.0")
        .replace("y = 0.0", "y = 2.0");
    let text = "t,x,y,p,u_x,u_y\n1,5.5,2.25,3,0.1,0\n";
    let states = states(&mapping, text).expect("a row");
    assert_eq!((states[0].initial_distance[0], states[0].initial_height[0]), (1.5, 0.25));
    assert_eq!(states[0].horizontal_displacement, [-0.1]);
    let error = self::states(&mapping, "t,x,y,p,u_x,u_y\n1,7.5,2.25,3,0.1,0\n").expect_err("beyond");
    assert!(error.contains("-0.5 m from the crest is outside the layer of 2 m"), "{error}");
}

#[test]
fn a_repeated_row_is_told_from_a_second_column_of_samples() {
    let text = "t,id,y,p,u_y\n1,1,0.5,3,0\n1,2,0.5,3,0\n1,2,0.5,4,0\n1,2,0.5,3,0\n1,3,0.25,3,0\n";
    let state = &states(CONVENTION, text).expect("rows")[0];
    assert_eq!(state.repeated, 1, "rows 1 and 2 differ in a column without meaning");
    assert_eq!(
        (
            state.pressure.len(),
            state.repeated_at.as_ref().is_some_and(|at| at.starts_with("y = 0.5 m: p is 3 Pa ("))
        ),
        (4, true),
        "equal values count once"
    );
}

#[test]
fn a_table_may_begin_before_the_load() {
    let wide = "[columns]\nt = 'time'\nu_y = ''\np = { p0 = 0.0, p1 = 0.5 }\n";
    for (mapping, text, times) in [
        (CONVENTION, "t,y,p,u_y\n0,0,0,0\n0,1,0,0\n1,0,3,0\n1,1,0,0\n", &[1.0][..]),
        (CONVENTION, "t,y,p,u_y\n0,0,3,0\n0,1,0,0\n1,0,2,0\n1,1,0,0\n", &[0.0, 1.0]),
        (wide, "time,p0,p1\n0,0,0\n0.5,3,2\n", &[0.5]),
    ] {
        let states = states(mapping, text).expect("rows");
        assert_eq!(states.iter().map(|state| state.time).collect::<Vec<_>>(), times, "{text}");
    }
}

#[test]
fn files_whose_times_are_listed_come_in_the_order_of_their_numbers() {
    let listed = "[columns]\ny = 'y'\np = 'p'\nu_y = ''\n[time]\nlist = [1.0, 2.0]\n";
    let named =
        "[columns]\ny = 'y'\np = 'p'\nu_y = ''\n[time]\nfiles = { 'a_9.csv' = 1.0, 'a_10.csv' = 2.0 }\n";
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for name in ["a_9.csv", "a_10.csv"] {
        std::fs::write(at(name), "y,p\n0,1\n1,0\n").expect("a file");
    }
    let body = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 1.0 };
    for (mapping, names, is_read) in [
        (listed, ["a_9.csv", "a_10.csv"], true),
        (listed, ["a_10.csv", "a_9.csv"], false),
        (named, ["a_10.csv", "a_9.csv"], true),
    ] {
        let source = StudySource { name: "map.toml".to_owned(), text: mapping.to_owned() };
        let mapping = Mapping::read(&source).expect("a mapping");
        let read = runs_of(&[names.map(at).to_vec()], &mapping, body).map_err(|error| error.to_string());
        assert_eq!(read.is_ok(), is_read, "{names:?} {read:?}");
        assert!(read.map_or_else(|why| why.contains("a quoted pattern"), |_| true));
    }
}

#[test]
fn an_origin_is_in_the_unit_of_the_places() {
    let mapping = PLANE_CONVENTION
        .replace("length = \"m\"", "length = \"cm\"")
        .replace("x = 0.0", "x = 500.0")
        .replace("y = 0.0", "y = 200.0");
    assert!(mapping.contains("cm") && mapping.contains("500.0"), "{mapping}");
    let states = states(&mapping, "t,x,y,p,u_x,u_y\n1,550,225,3,0.1,0.2\n").expect("a row");
    assert!((states[0].initial_distance[0] - 0.5).abs() < 1e-12, "{states:?}");
    assert!((states[0].initial_height[0] - 0.25).abs() < 1e-12, "{states:?}");
}

#[test]
fn a_settlement_is_that_of_the_nearest_time_within_a_thousandth_of_it() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mapping = format!("{STRANGE}[settlement]\nfile = \"curve.csv\"\nt = \"day\"\ns = \"mm\"\n");
    let source = StudySource { name: "map.toml".to_owned(), text: mapping };
    let mapping = Mapping::read(&source).expect("a mapping");
    let rows = [1, 2, 3].map(|day| format!("{day}; 25; -3; 2; 4\n")).concat();
    std::fs::write(at("result.csv"), format!("day; depth; pwp; settled; sig\n{rows}")).expect("a file");
    // Half a thousandth off, two thousandths off, and two of which the nearer counts.
    std::fs::write(at("curve.csv"), "day; mm\n1.0005; 7\n1.996; 8\n2.999; 9\n3.002; 10\n").expect("a file");
    let body = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 81.75 };
    let run = runs_of(&[vec![at("result.csv")]], &mapping, body).expect("rows").remove(0);
    let found: Vec<Option<f64>> = run.states.iter().map(|state| state.surface_displacement).collect();
    assert_eq!(found, [Some(-7.0 * 1e-3), None, Some(-9.0 * 1e-3)]);
}

#[test]
fn a_settlement_curve_has_its_sign_and_unit_and_tells_what_it_lacks() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("result.csv"), "t,y,p,u_y\n60,0.5,3,0\n120,0.5,3,0\n").expect("a file");
    let body = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 60.0 };
    let run = |more: &str, curve: &str| {
        std::fs::write(at("curve.csv"), curve).expect("a file");
        let text = format!("settlement = {{ file = 'curve.csv'{more}\n");
        let mapping = Mapping::read(&StudySource { name: "map.toml".to_owned(), text }).expect("a mapping");
        runs_of(&[vec![at("result.csv")]], &mapping, body)
            .map(|mut runs| runs.remove(0))
            .map_err(|error| error.to_string())
    };
    for (more, curve, found) in [
        (" }", "t,s\n60,0.25\n120,0.5\n", [Some(-0.25), Some(-0.5)]),
        (", sign = 'down' }", "t,s\n120,0.5\n60,0.25\n", [Some(-0.25), Some(-0.5)]),
        (", sign = 'up' }", "t,s\n60,-0.25\n", [Some(-0.25), None]),
        (", t = 's', s = 't' }", "t,s\n0.5,120\n", [None, Some(-0.5)]),
        (" }\nunits = { length = 'cm' }", "t,s\n60,25\n", [Some(-0.25), None]),
        (" }\nunits = { length = 'cm', displacement = 'mm' }", "t,s\n60,250\n", [Some(-0.25), None]),
        (" }", "t,s\n61,0.25\n", [None, None]),
    ] {
        let run = run(more, curve).unwrap_or_else(|told| panic!("{more}: {told}"));
        let curves: Vec<Option<f64>> = run.states.iter().map(|state| state.surface_displacement).collect();
        assert_eq!(curves, found, "{more}");
        let matched = found.iter().flatten().count();
        assert_eq!(run.expected.settlement, matched > 0, "{more}");
        let note =
            format!("settlement from curve.csv at {matched} of 2 times, each the nearest within 0.1 %");
        assert_eq!((run.notes, run.unended), (vec![note], vec![]), "{more}");
    }
    assert_eq!(run(" }", "t,s\n60,0.25").expect("states").unended, [at("curve.csv")], "it may be cut");
    let lacking = format!(
        "{}: there is no column `s` of the settlement curve; the header has `t`, `w`",
        at("curve.csv").display()
    );
    assert_eq!(run(" }", "t,w\n60,0.25\n").err(), Some(lacking));
    let empty = run(" }", "t,s\n").err();
    assert!(empty.is_some_and(|told| told.ends_with("curve.csv: there are no rows")));
}

#[test]
fn a_column_that_is_missing_is_told_with_the_first_thirty_there_are() {
    let names: Vec<String> = (0..32).map(|number| format!("c{number}")).collect();
    let told = |header: &str| states(CONVENTION, &format!("{header}\n1\n")).expect_err("no column");
    let listed =
        |names: &[String]| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let time = |listed: String| format!("result.csv: there is no column `t`; the header has {listed}");
    assert!(told(&names[..30].join(",")).ends_with(&time(listed(&names[..30]))));
    assert!(told(&names.join(",")).ends_with(&time(format!("{}, and 2 more", listed(&names[..30])))));
    let told = told("t,y,u_y");
    let how =
        "to leave it out, call `score --without pressure`, or write `p = \"\"` into [columns] of a mapping";
    assert!(
        told.ends_with(&format!(
            "result.csv: there is no column `p` ({how}); the header has `t`, `y`, `u_y`"
        )),
        "{told}"
    );
    let untimed = states("[columns]\ny = \"y\"\np = \"p\"\n", "y,p\n0.5,3\n").expect_err("no time");
    let how = "add \"result.csv\" = … to [time] files, name a column `t`, or give --set-time-step if the \
               name has a step number";
    assert!(untimed.ends_with(&format!("result.csv: its time is declared nowhere: {how}")), "{untimed}");
    let named =
        states("[columns]\ny = \"y\"\np = \"p\"\nu_y = \"\"\n", "t,y,p\n2,0.5,3\n").expect("a column `t`");
    assert_eq!(named[0].time, 2.0);
    // Of several names the first that is there, in their order.
    let named = |p: &str| {
        let mapping = CONVENTION.replace("p = \"p\"", &format!("p = \"{p}\""));
        states(&mapping, "t,y,q,p0,u_y\n1,0.5,3,7,0\n").map(|states| states[0].pressure[0])
    };
    for (names, value) in [("p0", 7.0), ("p|p0", 7.0), ("q | p0", 3.0), ("p0|q", 7.0), ("p|r|q", 3.0)] {
        assert_eq!(named(names), Ok(value), "{names}");
    }
    assert!(named("p|r").is_err_and(|told| told.contains("there is no column `p|r`")));
    // Rows that do not count are none, and rows of one value alone do.
    let rows = "t,y,p,u_y,layer\n1,0.25,3,0,1\n1,0.5,4,0,2\n1,0.75,5,0,1\n";
    let of = |layer: &str| states(&format!("{CONVENTION}[rows]\nequals = {{ layer = {layer} }}\n"), rows);
    assert_eq!(of("1.0").expect("two rows")[0].pressure, [3.0, 5.0]);
    assert_eq!(of("2.0").expect("a row")[0].pressure, [4.0]);
    assert!(of("3.0").is_err_and(|told| told.ends_with("result.csv: there are no rows")));
    let corners = states(&format!("{CONVENTION}[rows]\ncorners = true\n"), rows).expect_err("no cells");
    assert!(corners.ends_with("result.csv: a table has no cells: remove `corners` from [rows]"), "{corners}");
}

#[test]
fn a_ragged_line_and_a_column_that_is_there_twice_are_told_at_their_place() {
    let cut = "a value is missing, or the line is cut";
    let long = "there is one value too many; if commas are decimal separators, use another column separator";
    for (text, told) in [
        (
            "t,y,p,u_y\n1,0.5,3,0\n# note\n\n1,0.7,3\n",
            format!("result.csv:5: the line has 3 fields, and those above have 4: {cut}"),
        ),
        (
            "t,y,p,u_y\n1,0.5,3,0\n1\n",
            format!("result.csv:3: the line has 1 field, and those above have 4: {cut}"),
        ),
        (
            "t,y,p,u_y\n1,0.5,3,0\n1,0,7,3,0\n",
            format!("result.csv:3: the line has 5 fields, and those above have 4: {long}"),
        ),
        (
            "t,y,p,u_y,p\n1,0.5,3,0,4\n",
            "result.csv: the header has `p` more than once: rename the columns that are not meant".to_owned(),
        ),
    ] {
        let found = states(CONVENTION, text).expect_err(text);
        assert!(found.ends_with(&told), "{text}: {found}");
    }
    assert!(states(CONVENTION, "t,y,p,u_y,of,of\n1,0.5,3,0,4,5\n").is_ok(), "nobody asks for these");
}

#[test]
fn a_table_ends_with_a_line_break_of_any_kind_or_has_nothing() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.csv");
    for (text, is_ended) in [
        ("t,y\n1,2\n", true),
        ("t,y\r\n1,2\r\n", true),
        ("t,y\r1,2\r", true),
        ("t,y\n1,2", false),
        ("t,y\n1,2 ", false),
        ("t y\n1 2", false),
    ] {
        std::fs::write(&path, text).expect("a file");
        let read = crate::import::csv_text::CsvText::read(&path, &TableLayout::default()).expect("a table");
        assert_eq!(read.is_ended, is_ended, "{text:?}");
    }
    let what = "does not end with a line break, so it may be cut off inside its last number: end the last line with one";
    assert_eq!(super::not_ended(&path), format!("{} {what}", path.display()));
}

#[test]
fn patterns_stand_for_files_by_folder_and_number_and_a_name_with_a_star_for_itself() {
    use crate::import::given_files::{are_tables, files_of};
    let folder = tempfile::TempDir::new().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for name in ["b/s_2.csv", "a/s_10.csv", "a/s_9.csv", "b/s_1.csv", "a/s.csv", "a/s_*.csv"] {
        std::fs::create_dir_all(at(name).parent().expect("a folder")).expect("made");
        std::fs::write(at(name), "t\n").expect("a file");
    }
    std::fs::create_dir(at("a/s_3.csv")).expect("a folder");
    std::fs::write(at("a/x.vtk"), "# vtk DataFile Version 3.0\n").expect("a file");
    let found = |pattern: &str| {
        files_of(&[at(pattern)]).map(|mut all| all.remove(0)).map_err(|error| error.to_string())
    };
    let all = |names: &[&str]| Ok(names.iter().map(|name| at(name)).collect::<Vec<_>>());
    assert_eq!(found("?/s_[0-9]*.csv"), all(&["a/s_9.csv", "a/s_10.csv", "b/s_1.csv", "b/s_2.csv"]));
    assert_eq!(found("a/s_*.csv"), all(&["a/s_*.csv"]), "it is there");
    assert_eq!(found("a/s?9.csv"), all(&["a/s_9.csv"]));
    assert_eq!(found("none.csv"), all(&["none.csv"]), "whoever opens it tells that");
    let told = format!("{}: no file matches this pattern", at("c/*.csv").display());
    assert_eq!(found("c/*.csv"), Err(told));
    let two = files_of(&[at("b/s_?.csv"), at("a/s.csv")]).expect("files");
    assert_eq!(two.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1], "each argument for itself");
    assert_eq!(are_tables(&two).ok(), Some(true));
    assert_eq!(are_tables(&[vec![at("a/s.csv"), at("a/x.vtk")]]).ok(), Some(false));
    assert!(are_tables(&[vec![at("none.csv")]]).is_err());
    // Tables do not stand among arrays, wherever they are given.
    let mapping = Mapping::convention(Axes::Column).expect("a constant");
    let body = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 1.0 };
    let told =
        runs_of(&[vec![at("a/s.csv")], vec![at("a/x.vtk")]], &mapping, body).expect_err("both").to_string();
    let why = "it is a table among files with arrays: score it separately";
    assert_eq!(told, format!("{}: {why}", at("a/s.csv").display()));
}

#[test]
fn what_is_left_out_is_in_no_state_and_expected_of_none() {
    use crate::import::expected::Expected;
    use crate::import::run::Run;
    use oedometer_case::quantity::Quantity;
    let state = || SampledState {
        pressure: vec![1.0],
        effective_stress: vec![1.0],
        displacement: vec![1.0],
        horizontal_displacement: vec![1.0],
        surface_displacement: Some(1.0),
        ..SampledState::default()
    };
    for (quantity, left) in [
        (Quantity::Pressure, [false, true, true, true, true]),
        (Quantity::EffectiveStress, [true, false, true, true, true]),
        (Quantity::Displacement, [true, true, false, false, true]),
        (Quantity::Settlement, [true, true, true, true, false]),
        (Quantity::LoadFactor, [true; 5]),
    ] {
        let states = vec![state(), state()];
        let mut expected = Expected::of_states(&states);
        expected.settlement = true;
        let mut run = Run { states, expected, ..Run::default() };
        run.leave_out(&[quantity]);
        for state in &run.states {
            let found = [
                !state.pressure.is_empty(),
                !state.effective_stress.is_empty(),
                !state.displacement.is_empty(),
                !state.horizontal_displacement.is_empty(),
                state.surface_displacement.is_some(),
            ];
            assert_eq!(found, left, "{quantity:?}");
        }
        assert_eq!((run.expected.absent(&run.states), run.without), (vec![], vec![quantity]));
        let bare = run.expected.absent(&[SampledState::default()]).len();
        assert_eq!(bare, left.iter().filter(|is_left| **is_left).count(), "{quantity:?}");
    }
}

/// What a table with a settlement curve in it contradicts, as told.
fn contradictions(mapping: &str, text: &str) -> (usize, Vec<String>) {
    let source = StudySource { name: "map.toml".to_owned(), text: mapping.to_owned() };
    let mapping = Mapping::read(&source).expect("a mapping");
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.csv");
    std::fs::write(&path, text).expect("a file");
    let body = SolvedBody { height: 4.0, length: None, seconds_per_time_factor: 1.0 };
    let run = runs_of(&[vec![path]], &mapping, body).expect("a run").remove(0);
    let plain = |told: &String| told.replace(&format!("{}/", folder.path().display()), "");
    (run.states.len(), run.contradictions.iter().map(plain).collect())
}

#[test]
fn a_comma_beside_points_may_stand_between_thousands_or_begin_a_fraction() {
    let source = |decimal: &str| StudySource {
        name: "map.toml".to_owned(),
        text: format!("[columns]\nt = \"t\"\ny = \"y\"\np = \"p\"\nu_y = \"\"\n{decimal}"),
    };
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("result.csv");
    let frame = SolvedBody { height: 1.0, length: None, seconds_per_time_factor: 81.75 };
    let told = |rows: &str, decimal: &str| {
        std::fs::write(&path, format!("t;y;p\n{rows}")).expect("a file");
        let mapping = Mapping::read(&source(decimal)).expect("a mapping");
        let run = runs_of(&[vec![path.clone()]], &mapping, frame).expect("a run").remove(0);
        (run.states[0].pressure[0], run.doubts.join(" "))
    };
    let (comma, point) = ("[csv]\ndecimal = \",\"\n", "[csv]\ndecimal = \".\"\n");
    let doubtful = "4.0875;0.25;996,869\n4.0875;0.5;856,241\n";
    let (pressure, doubt) = told(doubtful, "");
    assert!(doubt.contains(":2: the comma of `996,869`") && doubt.contains("read as 996.869"), "{doubt}");
    assert_eq!(pressure, 996.869);
    for (rows, decimal, read) in [
        (doubtful, comma, 996.869),
        ("4;0;996,869\n4;1;856,241\n", "", 996.869),
        ("4.0875;0.25;996,869\n4.0875;0.5;856,24\n", "", 996.869),
        ("4.0875;0,25;996,869\n4.0875;0,5;856,241\n", "", 996.869),
        ("4.0875;0.25;0,869\n4.0875;0.5;0,241\n", "", 0.869),
    ] {
        assert_eq!(told(rows, decimal), (read, String::new()), "{rows} {decimal}");
    }
    assert_eq!(told(doubtful, point).0, 996_869.0);
}

#[test]
fn states_of_one_time_must_agree_and_times_must_not_go_back() {
    let table = |blocks: &[(f64, f64)]| -> String {
        let rows = blocks.iter().flat_map(|(time, factor)| {
            [0.5, 1.5, 2.5, 3.5].map(|y: f64| format!("{time:e},{y},{},0\n", factor * (16.0 - y * y)))
        });
        "t,y,p,u_y\n".to_owned() + &rows.collect::<String>()
    };
    let twice = "two states have the same time, t = 2 s and 2.000000004 s, and contradict each other at y = \
                 0.5 m: p is 15.75 Pa \
                 (a.csv:6) and 12.6 Pa (a.csv:18): keep the right run";
    for (blocks, states, told) in [
        (&[(1.0, 1.0), (2.0, 1.0), (3.0, 0.9)][..], 3, None),
        // Another run, at times of its own; the last digit of a time decides nothing.
        (&[(1.0, 1.0), (2.0, 1.0), (3.0, 0.9), (1.0, 1.0), (2.0 * (1.0 + 2e-9), 0.8)], 4, Some(twice)),
        (&[(1.0, 1.0), (2.0, 1.0), (2.001, 0.9), (9.0, 0.8)], 4, Some("t = 2 s and 2.001 s")),
        // The same state again is one state; what a thousandth of the time explains is none.
        (&[(1.0, 1.0), (2.0, 1.0), (3.0, 0.9), (2.0 * (1.0 + 2e-9), 1.0)], 3, None),
        (&[(1.0, 1.0), (2.0, 1.0), (2.001, 0.996), (9.0, 0.8)], 4, None),
        // Steps that are as small all through are steps.
        (&[(100.0, 1.0), (100.05, 0.7), (100.1, 0.4), (100.15, 0.1)], 4, None),
        // A restart goes back; a table in falling order does not.
        (
            &[(1.0, 1.0), (2.0, 0.9), (3.0, 0.8), (2.5, 0.85), (3.5, 0.7)],
            5,
            Some("t = 2.5 s (a.csv:14) comes after t = 3 s (a.csv:10)"),
        ),
        (&[(3.0, 0.8), (2.0, 0.9), (1.0, 1.0)], 3, None),
    ] {
        let (found, sentences) = contradictions(CONVENTION, &table(blocks));
        assert_eq!(found, states, "{blocks:?}");
        let agrees =
            sentences.first().map_or(told.is_none(), |first| told.is_some_and(|told| first.contains(told)));
        assert!(agrees, "{blocks:?}: {sentences:?}");
    }
}

#[test]
fn runs_at_places_of_their_own_are_told_and_columns_place_by_place_are_not() {
    let row = |time: f64, y: f64, factor: f64| format!("{time},{y},{},0\n", factor * (16.0 - y * y) / time);
    let head = "t,y,p,u_y\n";
    let run = |places: &[f64], factor: f64| -> String {
        [1.0, 2.0].iter().flat_map(|time| places.iter().map(|y| row(*time, *y, factor))).collect()
    };
    let (one, other) = ([0.5, 1.2, 1.7, 2.4, 2.9, 3.5], [0.6, 1.1, 1.8, 2.3, 3.0, 3.4]);
    for (rows, told) in [
        (run(&one, 1.0) + &run(&other, 1.0), false),
        (run(&one, 1.0) + &run(&other, 0.8), true),
        (run(&other, 0.8) + &run(&one, 1.0), true),
        // Halves of the height are parts of one run, and so are columns written place by place.
        (run(&one[..3], 1.0) + &run(&one[3..], 1.0), false),
        (one.iter().flat_map(|y| [1.0, 2.0, 3.0].map(|time| row(time, *y, 1.0))).collect(), false),
    ] {
        let (_, sentences) = contradictions(CONVENTION, &(head.to_owned() + &rows));
        let is_told = sentences.first().is_some_and(|first| first.contains("it holds two runs: p is"));
        assert!(is_told == told && sentences.is_empty() != told, "{rows}: {sentences:?}");
    }
    // Probes and curves.
    let wide = "[columns]\nt = 'time'\nu_y = ''\np = { p0 = 0.0, p1 = 2.0 }\n";
    let curve = "[columns]\np = ''\nu_y = ''\n[settlement]\nt = 'time'\ns = 'p0'\n";
    for (rows, told) in [
        ("1,5,4\n2,4,3\n3,3,2\n", None),
        ("1,5,4\n2,4,3\n3,3,2\n2,4,3\n", None),
        ("1,5,4\n2,4,3\n3,3,2\n2.5,3.5,2\n4,3,1\n", Some(("its times decrease", "its times decrease"))),
        (
            "1,5,4\n2,4,3\n3,3,2\n2.000001,3,3\n",
            Some(("p is 4 Pa (a.csv:3) and 3 Pa (a.csv:5)", "s is -4 m (a.csv:3) and -3 m (a.csv:5)")),
        ),
    ] {
        for (mapping, is_curve) in [(wide, false), (curve, true)] {
            let (_, sentences) = contradictions(mapping, &format!("time,p0,p1\n{rows}"));
            let wanted = told.map(|(probes, curve)| if is_curve { curve } else { probes });
            let agrees = sentences
                .first()
                .map_or(wanted.is_none(), |first| wanted.is_some_and(|told| first.contains(told)));
            assert!(agrees, "{mapping} {rows}: {sentences:?}");
        }
    }
    let (_, sentences) = contradictions(curve, "time,p0,p1\n1,5,4\n2,4,3\n2,3,3\n");
    assert!(
        sentences[0]
            .contains("at t = 2 s it has two values, at y = 4 m: s is -4 m (a.csv:3) and -3 m (a.csv:4)"),
        "{sentences:?}"
    );
}

#[test]
fn records_keep_the_order_of_their_rows_and_tell_of_two_runs() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("a.npy");
    let source = StudySource { name: "map.toml".to_owned(), text: CONVENTION.to_owned() };
    let mapping = Mapping::read(&source).expect("a mapping");
    let run = |places: &[f64], factor: f64| -> Vec<[f64; 4]> {
        let row = |time: f64, y: f64| [time, y, factor * (16.0 - y * y) / time, 0.0];
        [1.0, 2.0].iter().flat_map(|time| places.iter().map(move |y| row(*time, *y))).collect()
    };
    let (one, other) = ([0.5, 1.2, 1.7, 2.4, 2.9, 3.5], [0.6, 1.1, 1.8, 2.3, 3.0, 3.4]);
    for (factor, told) in [(1.0, false), (0.8, true)] {
        let rows = [run(&one, 1.0), run(&other, factor)].concat();
        let header = format!(
            "{{'descr': [('t', '<f8'), ('y', '<f8'), ('p', '<f8'), ('u_y', '<f8')], 'fortran_order': False, 'shape': ({},), }}\n",
            rows.len()
        );
        let length = u16::try_from(header.len()).expect("short").to_le_bytes();
        let numbers: Vec<u8> = rows.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
        std::fs::write(&path, [b"\x93NUMPY\x01\0", &length[..], header.as_bytes(), &numbers].concat())
            .expect("a file");
        let body = SolvedBody { height: 4.0, length: None, seconds_per_time_factor: 1.0 };
        let found = runs_of(&[vec![path.clone()]], &mapping, body).expect("a run").remove(0).contradictions;
        let is_told = found
            .first()
            .is_some_and(|first| first.contains("it holds two runs: p is") && first.contains("a.npy, row "));
        assert!(is_told == told && found.is_empty() != told, "{found:?}");
    }
}
