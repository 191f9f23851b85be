use super::*;

fn sample() -> Table {
    let mut table = Table::of(
        "Pore pressure, T_v = 0.1",
        vec![
            TableColumn::text("method"),
            TableColumn::number("error").unit("–"),
            TableColumn::number("order"),
            TableColumn::number("fit"),
            TableColumn::number("steps"),
            TableColumn::number("settlement"),
            TableColumn::number("time"),
            TableColumn::text("verdict"),
        ],
        [],
    );
    table.rows = vec![
        vec![
            Cell::Code("GC-SRI-patch".into()),
            Cell::Error(5.623e-3),
            Cell::Order(1.998),
            Cell::Order(1.98),
            Cell::Count(81_750),
            Cell::Percent(-0.012),
            Cell::Measured(0.0123),
            Cell::Verdict(Mood::Pass, "asymptotic".into()),
        ],
        vec![
            Cell::Code("a|b".into()),
            Cell::Error(f64::NAN),
            Cell::Missing("unstable at step 12".into()),
            Cell::Missing("fewer than three levels".into()),
            Cell::Count(12),
            Cell::Percent(f64::INFINITY),
            Cell::Missing("unstable at step 12".into()),
            Cell::Verdict(Mood::Fail, "divergent".into()),
        ],
        vec![
            "<b> & *c*, \"d\"".into(),
            Cell::Number(1e6),
            Cell::Order(1.0),
            Cell::Missing(String::new()),
            Cell::Count(0),
            Cell::Percent(0.0),
            Cell::Measured(3600.0),
            Cell::Verdict(Mood::Note, "floor-limited".into()),
        ],
    ];
    table.notes.push("L_2 norm over the points.".into());
    table
}

fn written(result: Result<String, RenderError>) -> String {
    result.unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn as_text() {
    insta::assert_snapshot!(written(sample().to_text(80)));
}

#[test]
fn as_markdown() {
    insta::assert_snapshot!(written(sample().to_markdown()));
}

#[test]
fn as_html() {
    insta::assert_snapshot!(written(sample().to_html()));
}

#[test]
fn as_csv() {
    insta::assert_snapshot!(written(sample().to_csv()));
}

#[test]
fn a_ragged_row_is_refused_by_every_writer() {
    let mut table = sample();
    table.rows[1].pop();
    for write in [|table: &Table| table.to_text(80), Table::to_markdown, Table::to_html, Table::to_csv] {
        let told = write(&table).err().map(|e| e.to_string()).unwrap_or_default();
        assert_eq!(told, "table `Pore pressure, T_v = 0.1`: row 2 has 7 cells for 8 columns");
    }
}

#[test]
fn an_empty_table_is_a_header() {
    let table = Table::of("", vec![TableColumn::text("a")], []);
    assert_eq!(written(table.to_csv()), "a\n");
    assert_eq!(written(table.to_markdown()), "| a |\n| :--- |\n");
}

#[test]
fn shades_follow_the_ratio_footnotes_their_letters_and_long_words_a_wide_column() {
    use Shade::{Best, Good, Middling, Poor};
    let ratios = [0.5, 1.0, 1.01, 2.0, 2.01, 10.0, 10.1, f64::INFINITY, f64::NAN].map(Shade::of_ratio);
    assert_eq!(ratios, [Best, Best, Good, Good, Middling, Middling, Poor, Poor, Poor]);
    assert_eq!([0, 25, 26, 300].map(mark), ["a", "z", "27", "301"]);
    let shaded = |value: Option<f64>| {
        let (title, target) = ("a \"b\"".to_owned(), "s.html".to_owned());
        Cell::Shaded { shade: Poor, words: "12".to_owned(), value, title, target }
    };
    let table = |cell: Cell| Table::of("", columns("a"), [vec![cell]]);
    let html = |cell: Cell| written(table(cell).to_html());
    let dense = html(shaded(Some(0.12)));
    assert!(dense.starts_with("<div class=\"table dense\">"), "{dense}");
    let link = "<a href=\"s.html\" title=\"a &quot;b&quot;\">12</a>";
    assert!(dense.contains(&format!("<td class=\"l s4\" data-v=\"1.20000e-1\">{link}</td>")), "{dense}");
    assert_eq!(
        [60, 61].map(|letters| html("x".repeat(letters).into()).contains("<td class=\"l long\">")),
        [false, true]
    );
    let csv = |value: Option<f64>| written(table(shaded(value)).to_csv());
    assert_eq!([csv(Some(0.12)), csv(None)], ["a\n0.12\n", "a\n12\n"]);
    let read = columns("case | > step [s] | > n");
    assert_eq!(
        read,
        [TableColumn::text("case"), TableColumn::number("step").unit("s"), TableColumn::number("n")]
    );
}

#[test]
fn a_terminal_is_never_steered() {
    let mut table = Table::of("\u{1b}[31m", vec![TableColumn::text("a\n")], []);
    table.rows.push(vec!["\u{1b}]0;x\u{7}\r\n".into()]);
    let text = written(table.to_text(80));
    assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
}

#[test]
fn a_table_that_is_too_wide_becomes_a_list_that_loses_nothing() {
    let rows = [vec!["a value".into(), Cell::Count(5), Cell::missing("fewer than four levels")]];
    let table = Table::of("values", columns("value | > levels | > least squares"), rows).note("of a study");
    let grid = "values\nvalue    levels  least squares\na value       5          – [a]\n[a] fewer than four levels\nof a study\n";
    assert_eq!(written(table.to_text(40)), grid);
    let text = written(table.to_text(26));
    for part in ["values", "a value", "levels 5", "least squares – [a]", "[a] fewer", "of a study"] {
        assert!(text.replace("\n    ", " ").contains(part), "{part}: {text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 26), "{text}");
    assert!(written(table.shown(0).to_text(40)).contains("and 1 more row\n"));
}
