//! What every figure owes its reader. The gallery is written to the temporary folder to be looked
//! at.

mod gallery;

use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size, Style};
use crate::render::palette::slots;
use gallery::{convergence, gallery, nothing};

fn svg(chart: &Chart) -> String {
    chart.svg().unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn every_kind_of_figure_is_drawn_and_always_the_same() {
    let folder = std::env::temp_dir().join("oedometer-gallery");
    std::fs::create_dir_all(&folder).unwrap_or_else(|e| panic!("{e}"));
    for (name, chart) in gallery() {
        let text = svg(&chart);
        assert_eq!(text, svg(&chart), "{name}");
        std::fs::write(folder.join(format!("{name}.svg")), text).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn figures_are_named_scalable_and_self_contained() {
    for (name, chart) in gallery() {
        let text = svg(&chart);
        assert!(text.starts_with("<svg xmlns="), "{name}");
        for wanted in ["viewBox=\"0 0 ", "role=\"img\"", "aria-label=\"", "<title>", "<desc>"] {
            assert!(text.contains(wanted), "{name}: {wanted}");
        }
        for unwanted in ["href", "url(", "<script", "NaN", "inf", " id=\""] {
            assert!(!text.contains(unwanted), "{name}: {unwanted}");
        }
        assert_eq!(text.matches("<g").count(), text.matches("</g>").count(), "{name}");
        assert_eq!(text.matches("<text").count(), text.matches("</text>").count(), "{name}");
        assert_eq!(text.matches("<tspan").count(), text.matches("</tspan>").count(), "{name}");
    }
}

#[test]
fn what_is_not_drawn_is_counted() {
    let text = svg(&convergence());
    assert!(
        text.contains("2 values not drawn: 1 not finite (MPM); 1 not positive on a logarithmic axis (MPM)."),
        "{text}"
    );
    let text = svg(&nothing());
    assert!(text.contains(">no data</text>"), "{text}");
    assert!(text.contains("3 values not drawn: 2 not finite (GIMP); 1 not positive"), "{text}");
    assert!(!text.contains("(no data)"), "{text}");
    let text =
        svg(&convergence().with(Series::new("CPDI", Vec::new())).with(Series::new("MPM2", Vec::new())));
    assert!(text.contains("Without data here: CPDI, MPM2."), "{text}");
}

#[test]
fn a_figure_names_its_series_in_groups_of_their_dashes_in_a_legend_and_to_those_who_cannot_see_it() {
    let line = |name: &str| Series::new(name, vec![(0.0, 1.0), (1.0, f64::from(name.as_bytes()[0]))]);
    let chart = Chart::new("t", ChartAxis::linear("x"), ChartAxis::linear("y"));
    let theory = Series { style: Style::Theory, ..line("exact") };
    let text = svg(&chart.clone().with(theory).with(line("a")).with(line("b")).with(line("b")));
    assert!(text.contains("<desc>y against x: exact, a, b.</desc>"), "{text}");
    for (dash, name) in [("", "exact"), ("", "a"), (" stroke-dasharray=\"75 35\"", "b")] {
        let group = format!("<g stroke-linejoin=\"round\"{dash}>\n<title>{name}</title>");
        assert!(text.contains(&group), "{group}: {text}");
        assert_eq!(text.matches(&format!("<g class=\"key\">\n<title>{name}</title>")).count(), 1, "{name}");
    }
    let told = |series: Series| svg(&chart.clone().with(series));
    let lost = told(Series::new("a", vec![(0.0, 1.0), (1.0, f64::NAN)]));
    assert!(lost.contains(">1 value not drawn: 1 not finite (a).</text>"), "{lost}");
    // A line is cut at the frame without a word, a marker is missed.
    let cut = Chart { y: ChartAxis::linear("y").between(0.0, 1.5), ..chart.clone() };
    let told =
        |style: Style| svg(&cut.clone().with(line("a").style(style))).contains("1 outside the axes (a)");
    assert_eq!(
        [Style::Line, Style::Theory, Style::Markers, Style::LineAndMarkers].map(told),
        [false, false, true, true]
    );
}

#[test]
fn points_outside_fixed_axes_are_counted_and_lines_cut() {
    let series = Series::new("a", vec![(0.0, 0.0), (1.0, 1e300), (0.5, 1e9)]);
    let chart =
        Chart::new("t", ChartAxis::linear("x"), ChartAxis::linear("y").between(0.0, 1.0)).with(series);
    let text = svg(&chart);
    assert!(text.contains("1 beyond 10^±150 (a); 1 outside the axes (a)"), "{text}");
}

#[test]
fn hostile_descriptions_still_make_a_figure() {
    let mut chart = convergence();
    chart.title = "a < b & \"c\" \u{0} \u{e000}".into();
    chart.size = Size { width: f64::NAN, plot_height: -5.0 };
    chart.x = chart.x.with_ticks(vec![f64::NAN, -1.0, 0.05]);
    chart.rules.push(Rule { at: -1.0, label: "x".into() });
    chart.rules.push(Rule { at: f64::NAN, label: "?".into() });
    chart.series.push(Series::new("one", vec![(0.1, 0.1)]));
    chart.series.push(Series::new("", Vec::new()));
    let text = svg(&chart);
    assert!(text.contains("a &lt; b &amp; &quot;c&quot;"), "{text}");
}

/// The value of an attribute of the element that `tag` opens.
fn attribute(tag: &str, name: &str) -> Option<String> {
    let (_, after) = tag.split_once(&format!(" {name}=\""))?;
    Some(after.split_once('"')?.0.to_owned())
}

fn number(tag: &str, name: &str) -> f64 {
    attribute(tag, name).and_then(|v| v.parse().ok()).unwrap_or_else(|| panic!("{name} in {tag}"))
}

fn without_tags(text: &str) -> String {
    let mut out = String::new();
    let mut inside = false;
    for c in text.chars() {
        match c {
            '<' => inside = true,
            '>' => inside = false,
            c if !inside => out.push(c),
            _ => {}
        }
    }
    out
}

#[test]
fn no_text_is_clipped() {
    for (name, chart) in gallery() {
        let text = svg(&chart);
        let (wide, high) = (10.0 * number(&text, "width"), 10.0 * number(&text, "height"));
        let mut seen = 0;
        for line in text.lines().filter(|l| l.contains("<text ")) {
            let (tag, words) = line.split_once('>').unwrap_or_else(|| panic!("{line}"));
            let length = number(tag, "font-size") * crate::render::script::width(&without_tags(words));
            let share = match attribute(tag, "text-anchor").as_deref() {
                Some("middle") => 0.5,
                Some("end") => 1.0,
                _ => 0.0,
            };
            let (x, y) = (number(tag, "x"), number(tag, "y"));
            if tag.contains("rotate(") {
                assert!(y - length / 2.0 > 0.0 && y + length / 2.0 < high, "{name}: {line}");
            } else {
                // The estimate of a bold title is tight, and the widths are upper bounds.
                assert!(x - share * length > -10.0, "{name}: {line}");
                assert!(x + (1.0 - share) * length < wide + 10.0, "{name}: {line}");
                assert!(y > 0.0 && y < high, "{name}: {line}");
            }
            seen += 1;
        }
        assert!(seen > 5, "{name}: {seen}");
    }
}

#[test]
fn theory_lies_above_other_lines_and_beneath_markers() {
    let chart = Chart::new("t", ChartAxis::linear("x"), ChartAxis::linear("y"))
        .with(Series::theory("exact", vec![(0.0, 0.0), (1.0, 1.0)]))
        .with(Series::new("a", vec![(0.0, 0.1), (1.0, 0.9)]));
    let text = svg(&chart);
    let line = |colour: &str| text.find(&format!("<polyline fill=\"none\" stroke=\"{colour}\"")).unwrap_or(0);
    let marker = text.find("<circle").unwrap_or(0);
    assert!(0 < line("#0072B2") && line("#0072B2") < line("#1A1A1A") && line("#1A1A1A") < marker, "{text}");
}

#[test]
fn depth_runs_downwards() {
    let rows = |axis: ChartAxis| {
        let points = vec![(0.0, 0.0), (1.0, 1.0)];
        let series = Series::new("a", points).style(Style::Markers);
        let text = svg(&Chart::new("t", ChartAxis::linear("x"), axis).with(series));
        let discs = text.lines().filter(|l| l.starts_with("<circle") && l.contains("#0072B2"));
        discs.map(|l| number(l, "cy")).collect::<Vec<_>>()
    };
    let (up, down) = (rows(ChartAxis::linear("y")), rows(ChartAxis::linear("depth").inverted()));
    assert!(up[0] > up[1], "{up:?}");
    assert!(down[0] < down[1], "{down:?}");
}

#[test]
fn every_point_has_a_row() {
    let chart = Chart::new("f", ChartAxis::linear("x, m"), ChartAxis::linear("y"))
        .with(Series::new("a \"b\"", vec![(0.1, 2.0), (0.3, 4.0)]));
    assert_eq!(chart.data_csv(), "series,\"x, m\",\"y\"\n\"a \"\"b\"\"\",0.1,2.0\n\"a \"\"b\"\"\",0.3,4.0\n");
}

#[test]
fn a_figure_that_says_one_number_is_not_telling() {
    use Style::{Line, LineAndMarkers, Markers, Theory};
    let telling = |series: &[(Style, &[(f64, f64)])]| {
        let mut chart = Chart::new("", ChartAxis::log10("x"), ChartAxis::linear("y"));
        chart
            .series
            .extend(series.iter().map(|(style, points)| Series::new("a", points.to_vec()).style(*style)));
        chart.is_telling()
    };
    let theory: (Style, &[(f64, f64)]) = (Theory, &[(1.0, 0.0), (2.0, 1.0), (4.0, 5.0)]);
    for (what, series, wanted) in [
        ("three values", &[theory, (LineAndMarkers, &[(1.0, 2.0), (2.0, 1.0), (4.0, 0.5)])][..], true),
        ("theory alone", &[theory], true),
        ("two values", &[theory, (Line, &[(1.0, 2.0), (2.0, 1.0)])], false),
        ("values above each other", &[theory, (Markers, &[(1.0, 2.0), (1.0, 1.0), (1.0, 0.5)])], false),
        ("a level line", &[theory, (Line, &[(1.0, 2.0), (2.0, 2.0), (4.0, 2.001)])], false),
        (
            "one value in each of three lines",
            &[(Line, &[(1.0, 2.0)]), (Line, &[(2.0, 1.0)]), (Line, &[(4.0, 0.5)])],
            false,
        ),
        (
            "three markers",
            &[(Markers, &[(1.0, 2.0)]), (Markers, &[(2.0, 1.0)]), (Markers, &[(4.0, 0.5)])],
            true,
        ),
        ("two that can be drawn", &[(Line, &[(0.0, 2.0), (2.0, 1.0), (4.0, 0.5)])], false),
    ] {
        assert_eq!(telling(series), wanted, "{what}");
    }
}

#[test]
fn a_line_upon_another_names_it_and_keeps_its_look() {
    let line = |name: &str, end: f64| Series::new(name, vec![(1.0, 0.0), (2.0, end)]);
    let chart = Chart::new("t", ChartAxis::linear("x"), ChartAxis::linear("y"))
        .with(line("GC-SRI-patch", 1.0))
        .with(line("MPM", 1.0))
        .with(line("GIMP", 2.0));
    let svg = chart.svg().expect("a figure");
    for name in ["GC-SRI-patch", "MPM = GC-SRI-patch", "GIMP"] {
        assert!(svg.contains(&format!(">{name}</text>")), "{name}: {svg}");
    }
    assert_eq!(slots(&["MPM = GC-SRI-patch"]), slots(&["MPM"]));
}
