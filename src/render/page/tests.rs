use super::*;
use crate::render::chart::{ChartAxis, Series};
use crate::render::table::{Cell, TableColumn, columns};

fn chart() -> Chart {
    Chart::new("Error <of> p", ChartAxis::log10("h (m)"), ChartAxis::log10("error (–)"))
        .with(Series::new("GIMP", vec![(0.1, 1e-2), (0.05, 5e-3)]))
}

fn page() -> Page {
    let mut table = Table::of("Orders", vec![TableColumn::text("method"), TableColumn::number("order")], []);
    table.rows.push(vec![Cell::Code("GIMP".into()), Cell::Order(1.0)]);
    let hostile = "<script>alert(1)</script> & \"quotes\"";
    Page {
        title: format!("Report {hostile}"),
        lead: "First **line**.\n\nSecond, T_v = 0.1.".into(),
        callout: Some((Mood::Fail, format!("Not so. {hostile}\n\nTwo."))),
        sections: vec![
            Section {
                heading: format!("Mesh {hostile}"),
                id: "mesh".into(),
                mood: Some(Mood::Pass),
                blocks: vec![
                    Block::Paragraph(format!("`{hostile}` {hostile}")),
                    Block::Heading("Tables".into()),
                    Block::Table(table),
                    Block::Figure(Figure::new("mesh", chart(), "Errors of *p*.")),
                ],
            },
            Section {
                heading: "Time".into(),
                id: "time".into(),
                mood: None,
                blocks: vec![
                    Block::List(vec!["one".into(), "two `x`".into()]),
                    Block::Details {
                        summary: format!("More {hostile}"),
                        blocks: vec![Block::Figures(vec![
                            Figure::new("left", chart(), ""),
                            Figure::new("right", chart(), "Right."),
                        ])],
                    },
                ],
            },
            Section { heading: "End".into(), id: "end".into(), mood: Some(Mood::Fail), blocks: vec![] },
        ],
        footer: "Made by `oedometer`.".into(),
        ..Page::default()
    }
}

fn written<T>(result: Result<T, RenderError>) -> T {
    result.unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn as_markdown() {
    insta::assert_snapshot!(written(render_markdown(&page())));
}

#[test]
fn html_is_self_contained_and_escaped() {
    let html = written(render_html(&page()));
    assert_eq!(html, written(render_html(&page())));
    assert!(html.starts_with("<!DOCTYPE html>\n"));
    // One script of its own, which sorts and filters; the page reads without it.
    assert_eq!(html.matches("<script").count(), 1);
    for unwanted in ["src=", "@import", "url(", "<link"] {
        assert!(!html.contains(unwanted), "{unwanted}");
    }
    let outside = html.lines().filter(|l| l.contains("http"));
    for line in outside {
        assert!(line.contains("xmlns=\"http://www.w3.org/2000/svg\""), "{line}");
    }
    assert_eq!(html.matches("&lt;script&gt;").count(), 8, "{html}");
    for wanted in
        ["<title>Report &lt;script", "<section id=\"mesh\">", "href=\"#time\"", "Figure 3.", "T<sub>v</sub>"]
    {
        assert!(html.contains(wanted), "{wanted}");
    }
}

#[test]
fn elements_are_closed() {
    let html = written(render_html(&page()));
    for name in
        ["section", "div", "figure", "table", "details", "aside", "ul", "pre", "p", "svg", "nav", "main"]
    {
        let opened = html.matches(&format!("<{name}>")).count() + html.matches(&format!("<{name} ")).count();
        assert_eq!(opened, html.matches(&format!("</{name}>")).count(), "{name}");
    }
}

#[test]
fn figures_are_the_same_in_both_pages() {
    let page = page();
    let listed = written(figures(&page));
    let names: Vec<&str> = listed.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["mesh.svg", "left.svg", "right.svg"]);
    let (html, markdown) = (written(render_html(&page)), written(render_markdown(&page)));
    for (name, svg) in &listed {
        assert!(markdown.contains(&format!("(figures/{name})")), "{name}");
        assert!(html.contains(svg.as_str()), "{name}");
    }
}

#[test]
fn a_figure_is_never_shown_larger_than_it_is() {
    let mut page = page();
    let mut slim = chart();
    slim.size.width = 300.0;
    let figure = Figure::new("slim", slim, "");
    page.sections[2].blocks.push(Block::Figure(figure));
    let html = written(render_html(&page));
    assert!(html.contains("style=\"--own: 300px\""), "{html}");
    assert_eq!(html.matches("style=\"--own: 760px\"").count(), 3);
}

#[test]
fn names_must_be_safe_and_differ() {
    for bad in ["", "../x", ".hidden", "A", "a b", "a/b", "ä"] {
        let mut page = page();
        page.sections[0].id = bad.into();
        assert!(matches!(render_html(&page), Err(RenderError::Name { .. })), "{bad}");
        let mut page = self::page();
        page.sections[2].blocks.push(Block::Figure(Figure::new(bad, chart(), "")));
        assert!(matches!(figures(&page), Err(RenderError::Name { .. })), "{bad}");
    }
    let mut page = page();
    page.sections[1].id = "mesh".into();
    assert!(matches!(render_markdown(&page), Err(RenderError::Duplicate { .. })));
    let mut page = self::page();
    page.sections[2].blocks.push(Block::Figure(Figure::new("left", chart(), "")));
    assert!(matches!(figures(&page), Err(RenderError::Duplicate { .. })));
}

#[test]
fn a_ragged_table_anywhere_is_refused() {
    let mut page = page();
    let mut table = Table::of("t", vec![TableColumn::text("a")], []);
    table.rows.push(Vec::new());
    page.sections[2]
        .blocks
        .push(Block::Details { summary: String::new(), blocks: vec![Block::Table(table)] });
    assert!(matches!(render_html(&page), Err(RenderError::Ragged { .. })));
    assert!(matches!(render_markdown(&page), Err(RenderError::Ragged { .. })));
}

#[test]
fn slugs_are_usable_names() {
    assert_eq!(slug("GC-SRI-patch, T_v = 0.1"), "gc-sri-patch-t_v-0.1");
    assert_eq!(slug("../Été!"), "t");
    assert_eq!(slug("—"), "");
}

#[test]
fn a_page_shows_the_first_rows_of_a_long_table_and_leads_to_the_rest() {
    let rows = (0..250).map(|row| vec![Cell::Count(row)]);
    let table = Table::of("Long", vec![TableColumn::number("n")], rows);
    let section = Section {
        heading: "A".into(),
        id: "a".into(),
        blocks: vec![Block::Table(table)],
        ..Section::default()
    };
    let page = Page { sections: vec![section], files: Some("s".to_owned()), ..Page::default() };
    let (html, markdown) = (written(render_html(&page)), written(render_markdown(&page)));
    assert_eq!(html.matches("<td ").count(), 200);
    assert!(html.contains("of 250 rows: <a href=\"tables/s-table-1.csv\">"), "{html}");
    assert_eq!(markdown.matches("\n| ").count(), 200 + 2);
    assert!(markdown.contains("of 250 rows: [the whole table](tables/s-table-1.csv)"));
    // The file has them all, and a page without files too.
    assert_eq!(tables(&page)[0].1.to_csv().expect("a table").lines().count(), 251);
    let alone = Page { files: None, ..page };
    assert_eq!(written(render_html(&alone)).matches("<td ").count(), 250);
}

#[test]
fn two_hundred_rows_are_whole_and_two_to_twenty_sections_are_listed() {
    let long = |rows: u64| Table::of("", columns("> n"), (0..rows).map(|row| vec![Cell::Count(row)]));
    for (rows, file, shown) in [(200, Some("f"), 200), (201, Some("f"), 200), (201, None, 201)] {
        let table = long(rows);
        let (found, rest) = shown_rows(&table, file);
        assert_eq!((&found.rows[..], rest.is_some()), (&table.rows[..shown], shown < table.rows.len()));
    }
    for (sections, in_html, in_markdown) in [(1, 0, 0), (2, 2, 0), (3, 3, 3), (20, 20, 20), (21, 0, 21)] {
        let section = |place: usize| Section::new(format!("S{place}"), format!("s{place}"), Vec::new());
        let page = Page { sections: (0..sections).map(section).collect(), ..Page::default() };
        assert_eq!(written(render_html(&page)).matches("<li><a href=\"#s").count(), in_html, "{sections}");
        assert_eq!(written(render_markdown(&page)).matches("](#s").count(), in_markdown, "{sections}");
    }
}

#[test]
fn figures_and_tables_are_counted_wherever_they_stand() {
    let table =
        |rows: u64| Block::Table(Table::of("", columns("> n"), (0..rows).map(|row| vec![Cell::Count(row)])));
    let figure = |name: &str| Block::Figure(Figure::new(name, chart(), "C."));
    let view = |word: &str, rows: u64| (word.to_owned(), vec![table(rows), figure(word)]);
    let hidden = Block::Details { summary: "more".to_owned(), blocks: vec![table(3), figure("c")] };
    let blocks = vec![Block::Switch(vec![view("a", 1), view("b", 2)]), hidden, figure("d")];
    let page = Page {
        sections: vec![Section::new("S", "s", blocks)],
        files: Some("p".to_owned()),
        ..Page::default()
    };
    let files: Vec<_> = tables(&page).into_iter().map(|(name, table)| (name, table.rows.len())).collect();
    assert_eq!(files, [1, 2, 3].map(|number| (format!("p-table-{number}"), number)));
    assert_eq!(tables(&Page { files: None, ..page.clone() }).len(), 0, "a page without files");
    let html = written(render_html(&page));
    for (number, name) in [(1, "a"), (1, "b"), (2, "c"), (3, "d")] {
        let link = format!("<a href=\"figures/{name}.svg\">SVG</a> <a href=\"figures/{name}.csv\">data</a>");
        let told = format!("<b>Figure {number}.</b> C. <span class=\"files\">{link}</span>");
        assert!(html.contains(&told), "{told}");
    }
    for (number, _) in files {
        let link = format!("<a href=\"tables/{number}.csv\">CSV</a>");
        assert!(html.contains(&link), "{link}");
    }
    assert!(
        html.contains("id=\"view-1-0\" checked>") && html.contains("id=\"view-1-1\">"),
        "the first is shown"
    );
}

#[test]
fn a_figure_is_drawn_once_and_anew_where_its_chart_changes() {
    let figure = Figure::new("f", chart(), "");
    let drawn = written(figure.svg());
    // Its file adapts to the screen, at its root alone.
    let (root, rest) = drawn.split_once('>').expect("a root");
    let file = written(figure.standalone_svg());
    let style = file.strip_prefix(root).and_then(|file| file.strip_suffix(rest)).expect("in between");
    assert!(style.starts_with(">\n<style>@media (prefers-color-scheme: dark) {\n:root [fill="), "{style}");
    assert_eq!(drawn.as_ptr(), written(figure.svg()).as_ptr());
    let other = figure.clone().with_chart(|chart| "Another".clone_into(&mut chart.title));
    assert!(written(other.svg()).contains("Another") && !drawn.contains("Another"));
}
