//! Mappings: what is left out, what is taken for granted, and what no file can have.

use super::*;
use crate::import::mapping::preset::{CONVENTION, PLANE_CONVENTION};

fn read(text: &str) -> Result<Mapping, String> {
    Mapping::read(&StudySource { name: "map.toml".to_owned(), text: text.to_owned() })
        .map_err(|error| error.to_string())
}

#[test]
fn the_convention_is_a_mapping() {
    for axes in [Axes::Column, Axes::Layer] {
        let mapping = Mapping::convention(axes).expect("a constant");
        assert_eq!(mapping.columns.get(Column::Up).map(String::as_str), Some("u_y"));
        assert_eq!(mapping.columns.x.is_some(), axes == Axes::Layer);
        assert_eq!(mapping.position.y, StatedPlace::Reference);
    }
}

/// x of a slab is the direction along which its fields vary, whatever the file calls it; y lies across.
#[test]
fn the_axes_of_a_slab_are_those_of_the_literature() {
    use crate::import::raw_row::{RawRow, SolvedBody};

    let of = |text: &str| {
        let source = StudySource { name: "map.toml".to_owned(), text: text.to_owned() };
        Mapping::resolve(None, Some(&source), Axes::Slab).map_err(|error| error.to_string())
    };
    let body = SolvedBody { height: 5.0, length: None, seconds_per_time_factor: 1.0 };
    let row = RawRow {
        x: Some(2.0),
        y: 0.5,
        pressure: Some(7.0),
        displacement: Some(-0.25),
        horizontal_displacement: Some(0.125),
        ..RawRow::default()
    };
    let columns = "columns = { x = \"a\", y = \"b\", p = \"p\", u_x = \"c\", u_y = \"d\" }\n";
    // As a column of the table reads it: where x stands and u_x, y and u_y.
    for (sign, wanted) in [
        ("", [2.0, 0.125, 0.5, -0.25]),
        ("sign = { x = \"left\" }\n", [3.0, 0.125, 0.5, -0.25]),
        ("sign = { u_x = \"left\" }\n", [2.0, -0.125, 0.5, -0.25]),
        ("sign = { u_y = \"down\" }\n", [2.0, 0.125, 0.5, 0.25]),
        ("origin = { x = 0.5, y = 0.125 }\n", [1.5, 0.125, 0.375, -0.25]),
    ] {
        let mapping = of(&format!("{columns}{sign}")).expect("a mapping");
        let names = [&mapping.columns.y, mapping.columns.x.as_ref().expect("across")];
        assert_eq!(names, ["a", "b"], "the place along which fields vary stands first");
        // The reader takes the column that is kept as y from the file's x.
        let read = RawRow {
            x: Some(row.y),
            y: row.x.expect("given"),
            displacement: row.horizontal_displacement,
            horizontal_displacement: row.displacement,
            ..row
        };
        let refused = |why: String| oedometer_formats::ImportError::content(std::path::Path::new("a"), why);
        let sample = read.sample(&mapping, body, &refused).expect("inside");
        let kept = [
            sample.initial_height,
            sample.displacement,
            sample.initial_distance,
            sample.horizontal_displacement,
        ];
        assert_eq!(kept, wanted, "{sign}");
    }
    let told = of("[columns]\ny = \"x\"\np = \"p\"\n").expect_err("no x");
    assert!(told.contains("the axes are exchanged") && told.contains("no column `x`"), "{told}");
    let convention = Mapping::convention(Axes::Slab).expect("a constant");
    let up = convention.columns.get(Column::Up).map(String::as_str);
    assert_eq!((convention.columns.y.as_str(), up), ("x", Some("u_x")));
    assert_eq!(convention.shown(Column::Y), Column::X);
}

#[test]
fn what_is_left_out_is_that_of_the_convention() {
    let short = read("[columns]\nt = \"t\"\np = \"p\"\nu_y = \"u_y\"\n").expect("all the rest is left out");
    let convention = Mapping::convention(Axes::Column).expect("a constant");
    assert_eq!((short.columns, short.position), (convention.columns, convention.position));
    assert_eq!((short.units.time, short.units.length), (convention.units.time, convention.units.length));
    let pressure = |mapping: &Mapping| mapping.columns.get(Column::Pressure).cloned().unwrap_or_default();
    assert_eq!(pressure(&read("").expect("an empty file")), "p");
    let without = read("[columns]\np = \"p\"\nu_y = \"\"\n").expect("an empty name takes a column out");
    assert_eq!((pressure(&without).as_str(), &without.columns.u_y), ("p", &None));
}

#[test]
fn all_faults_are_told_at_once() {
    let current = PLANE_CONVENTION.replace("\"reference\"", "\"current\"").replacen("u_x = \"u_x\"\n", "", 1);
    let wrong = format!("whole_volume = 0.0\nstress = {{ is = \"total\" }}\n{current}[time]\nstep = -1.0\n");
    let error = read(&wrong).expect_err("four faults");
    for told in [
        "to find the initial `x`",
        "`whole_volume` is not positive",
        "`step` of [time]",
        "a total stress needs the pore pressure",
    ] {
        assert!(error.contains(told), "{told}: {error}");
    }
    let current = CONVENTION.replace("\"reference\"", "\"current\"").replacen("u_y = \"u_y\"\n", "", 1);
    assert!(read(&current).is_err_and(|error| error.contains("current places need the displacement")));
    assert!(read("[columns]\ny = \"y\"\n").is_err_and(|error| error.contains("no column to score")));
}

#[test]
fn unknown_words_are_told_at_their_place() {
    let error = read(&CONVENTION.replace("\"Pa\"", "\"kpa\"")).expect_err("no unit");
    assert!(error.contains("map.toml:13:") && error.contains('^') && error.contains("kPa"), "{error}");
    let error = read(&CONVENTION.replace("length =", "lenght =")).expect_err("no key");
    assert!(error.contains("did you mean `length`?"), "{error}");
}

#[test]
fn each_fault_of_a_mapping_is_told_alone_in_its_own_sentence() {
    let faults = |text: &str| {
        let source = StudySource { name: "map.toml".to_owned(), text: text.to_owned() };
        let mut mapping: Mapping = source.read().expect("known keys and words");
        mapping.columns.leave_out_empty();
        mapping.faults().into_iter().map(|fault| fault.message).collect::<Vec<_>>()
    };
    let places = "the patterns of `join` do not have the same number of `*`, at least one";
    let pattern = "the `pattern` of [time] does not have `{step}` once";
    let step = "the `step` of [time] is not positive";
    let list = "a time in [time] is invalid: expected a finite number";
    let origin = "an origin is invalid: expected a finite number";
    let mark = "the delimiter or the comment mark is not an ASCII character";
    let weight = "the `unit_weight` of [hydrostatic] is not positive";
    let whole = "`whole_volume` is not positive";
    let total = "a total stress needs the pore pressure to become effective";
    let (x, y) = (
        "current places need the displacement to find the initial `x`",
        "current places need the displacement to find the initial `y`",
    );
    for (text, told) in [
        ("", &[][..]),
        ("columns = { p = '', u_y = '' }", &["no column to score is named"]),
        ("columns = { p = '', u_y = '', u_x = 'u' }", &[]),
        ("columns = { p = '', u_y = '', effective_stress = 's' }", &[]),
        ("columns = { p = '', u_y = '' }\ndisplacement.from = 'first-frame'", &[]),
        ("columns = { p = 'p', u_y = '' }\nposition.y = 'current'", &[y]),
        ("columns = { x = 'x', p = 'p', u_y = 'u' }\nposition.y = 'current'", &[x]),
        ("columns = { x = 'x', u_x = 'v', u_y = 'u' }\nposition.y = 'current'", &[]),
        ("columns = { x = 'x', u_y = '' }\nposition.y = 'current'\ndisplacement.from = 'first-frame'", &[]),
        ("origin.x = nan", &[origin]),
        ("origin.y = inf", &[origin]),
        ("whole_volume = 0.0", &[whole]),
        ("whole_volume = inf", &[whole]),
        ("whole_volume = 0.5", &[]),
        ("csv.delimiter = '\u{b7}'", &[mark]),
        ("csv.comment = '\u{b7}'", &[mark]),
        ("time.step = 0.0", &[step]),
        ("time.step = nan", &[step]),
        ("time.list = [1.0, nan]", &[list]),
        ("time.files = { a = inf }", &[list]),
        ("time.pattern = 'a'", &[pattern]),
        ("time.pattern = '{step}-{step}'", &[pattern]),
        ("time.pattern = '{step}'", &[]),
        ("join = ['a']", &[places]),
        ("join = ['a_*', 'b_*_*']", &[places]),
        ("join = ['a_*', 'b_*']", &[]),
        ("hydrostatic.unit_weight = 0.0", &[weight]),
        ("hydrostatic.unit_weight = nan", &[weight]),
        ("stress.is = 'total'", &[total]),
        ("stress.is = 'total'\ncolumns = { p = '', effective_stress = 's' }", &[total]),
        ("stress.is = 'total'\ncolumns = { p = 'p', effective_stress = 's' }", &[]),
        ("origin.x = nan\nwhole_volume = -1.0\ntime.step = -1.0", &[origin, whole, step]),
    ] {
        assert_eq!(faults(text), told, "{text}");
    }
}

#[test]
fn what_is_taken_for_granted_is_each_unit_and_sign_of_a_column_that_is_there() {
    let columns = "columns = { x = 'x', p = 'p', u_x = 'u', u_y = 'v', effective_stress = 's' }\n";
    let (unit, p, stress) = (
        "the unit of stresses, taken as Pa where the file states none",
        "the sign of `p`, taken as compression-positive",
        "the sign of `effective_stress`, taken as compression-positive",
    );
    let (up, along, end) = (
        "the sign of `u_y`, taken as up",
        "the sign of `u_x`, taken as right",
        "the end from which `x` counts, taken as the crest",
    );
    let stress_alone = "columns = { p = '', u_y = '', effective_stress = 's' }\n";
    let up_alone = "columns = { p = '', u_y = 'v' }\n";
    let signs = "sign = { x = 'left', p = 'tension-positive', u_x = 'left', u_y = 'down', effective_stress = 'tension-positive' }\n";
    for (text, of_column, of_plane) in [
        (columns.to_owned(), vec![unit, p, stress, up], vec![unit, p, stress, up, along, end]),
        (format!("{columns}units.stress = 'kPa'\n"), vec![p, stress, up], vec![p, stress, up, along, end]),
        (format!("{columns}{signs}"), vec![unit], vec![unit]),
        (format!("{columns}{signs}units.stress = 'Pa'\n"), vec![], vec![]),
        (stress_alone.to_owned(), vec![unit, stress], vec![unit, stress]),
        (up_alone.to_owned(), vec![up], vec![up]),
    ] {
        let mapping = read(&text).expect("a mapping");
        for (is_plane, taken) in [(false, of_column), (true, of_plane)] {
            let told = (!taken.is_empty()).then(|| taken.join("; "));
            assert_eq!(mapping.taken_for_granted(is_plane), told, "{text} {is_plane}");
        }
    }
    for is_plane in [false, true] {
        let axes = if is_plane { Axes::Layer } else { Axes::Column };
        let convention = Mapping::convention(axes).expect("a constant");
        assert_eq!(convention.taken_for_granted(is_plane), None);
        let given = Mapping { units: Units::default(), ..convention };
        assert_eq!(given.taken_for_granted(is_plane), None, "whoever declares it is no user");
    }
}

#[test]
fn files_may_lack_what_is_left_out_unless_something_else_is_made_of_it() {
    use Quantity::{Displacement, EffectiveStress, LoadFactor, Pressure, Settlement};
    let columns = "columns = { x = 'x', p = 'p', u_x = 'u', u_y = 'v', effective_stress = 's' }\n\
                   settlement.file = 'a.csv'\n";
    let (total, current) = ("stress.is = 'total'\n", "position.y = 'current'\n");
    for (more, without, lacking, has_curve) in [
        ("", &[][..], &[][..], true),
        ("", &[Pressure], &["p"], true),
        ("", &[EffectiveStress], &["effective_stress"], true),
        ("", &[Displacement], &["u_x", "u_y"], true),
        ("", &[Settlement], &[], false),
        ("", &[LoadFactor], &[], true),
        (total, &[Pressure, EffectiveStress], &["effective_stress"], true),
        (current, &[Displacement, Pressure], &["p"], true),
        (total, &[Displacement], &["u_x", "u_y"], true),
        (current, &[Pressure, Settlement], &["p"], false),
    ] {
        let mut mapping = read(&format!("{columns}{more}")).expect("a mapping");
        mapping.let_lack(without);
        assert_eq!(
            (&mapping.optional[..], mapping.settlement.is_some()),
            (&lacking.iter().map(|one| (*one).to_owned()).collect::<Vec<_>>()[..], has_curve),
            "{more} {without:?}"
        );
    }
}
