//! Tables from the file to their states: units, signs, places, and mistakes with their line.

use super::SampledState;
use crate::import::mapping::Mapping;
use crate::import::mapping::preset::{CONVENTION, PLANE_CONVENTION};
use crate::import::raw_row::SolvedBody;
use crate::import::runs::runs_of;
use crate::study::file::StudySource;

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
    let text = "t,id,y,p,u_y\n1,1,0.5,3,0\n1,2,0.5,3,0\n1,2,0.5,3,0\n1,3,0.25,3,0\n";
    let states = states(CONVENTION, text).expect("rows");
    assert_eq!(states[0].repeated, 1, "rows 1 and 2 differ in a column without meaning");
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
