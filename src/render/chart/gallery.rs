//! Figures of every kind from made-up data, written to the temporary folder to be looked at, and
//! held to what every figure owes its reader.
use super::*;
use std::f64::consts::PI;

/// Terzaghi's series, good enough for a picture.
fn pressure(z: f64, t: f64) -> f64 {
    (0..200)
        .map(|j| {
            let m = (f64::from(j) + 0.5) * PI;
            2.0 / m * (m * z).sin() * (-m * m * t).exp()
        })
        .sum()
}

fn consolidation(t: f64) -> f64 {
    1.0 - (0..200)
        .map(|j| {
            let m = (f64::from(j) + 0.5) * PI;
            2.0 / (m * m) * (-m * m * t).exp()
        })
        .sum::<f64>()
}

fn steps(n: u32) -> impl Iterator<Item = f64> {
    (0..=n).map(move |i| f64::from(i) / f64::from(n))
}

const METHODS: [&str; 5] = ["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "TL-GC-SRI-patch"];

fn convergence() -> Chart {
    let h = [0.2, 0.1, 0.05, 0.025, 0.0125];
    let mut chart = Chart::new(
        "Terzaghi: error of the pore pressure under mesh refinement",
        Axis::log10("cell size h/H (–)").with_ticks(h.to_vec()),
        Axis::log10("relative L_2 error of p at the points (–)"),
    );
    chart.subtitle = Some("T_v = 0.1, 2 points a cell, held against Terzaghi with compressible water".into());
    for (i, name) in METHODS.into_iter().enumerate() {
        let (c, p) = [(0.9, 0.9), (0.62, 1.0), (0.4, 1.0), (0.5, 1.9), (0.36, 2.0)][i];
        let mut points: Vec<(f64, f64)> = h.iter().map(|&h: &f64| (h, c * h.powf(p) + 1e-6)).collect();
        if i == 0 {
            points[3].1 = f64::NAN;
            points[4].1 = 0.0;
        }
        chart.series.push(Series::new(name, points));
    }
    chart.triangles = [(1.0, METHODS[2]), (2.0, METHODS[4])]
        .map(|(slope, name)| SlopeTriangle { slope, place: Place::Beside(name.into()) })
        .to_vec();
    chart.rules.push(Rule { axis: Direction::Y, at: 1.4e-4, label: "water storage: 1.4·10⁻⁴".into() });
    chart
}

fn isochrones() -> Chart {
    let mut chart = Chart::new(
        "Isochrones of excess pore pressure",
        Axis::linear("p/q (–)").between(0.0, 1.1),
        Axis::linear("depth ζ = 1 − Y/H (–)").inverted(),
    );
    for t in [0.02, 0.05, 0.1, 0.2, 0.5] {
        let theory = steps(80).map(|z| (pressure(z, t), z)).collect();
        chart.series.push(Series::theory("Terzaghi, compressible water", theory).tag(format!("T_v = {t}")));
        for (slot, name) in ["GIMP-SRI", "GC-SRI-patch"].into_iter().enumerate() {
            let off = [0.03, 0.0][slot];
            let points = (0..10).map(|i| (f64::from(i) + 0.5) / 10.0);
            let points = points.map(|z| (pressure(z, t) + off * (20.0 * z).sin(), z)).collect();
            chart.series.push(Series::new(name, points).style(Style::Markers));
        }
    }
    chart.size.plot_height = 420.0;
    chart
}

fn degree() -> Chart {
    let mut chart = Chart::new(
        "Degree of consolidation",
        Axis::log10("time factor T_v (–)"),
        Axis::linear("degree of consolidation U (–)").inverted(),
    );
    let times: Vec<f64> = (0..=80).map(|i| 10f64.powf(-3.0 + f64::from(i) / 20.0 * 0.85)).collect();
    chart.series.push(Series::theory("Terzaghi", times.iter().map(|&t| (t, consolidation(t))).collect()));
    chart.series.push(Series::theory(
        "Terzaghi, doubly drained",
        times.iter().map(|&t| (t, consolidation(4.0 * t))).collect(),
    ));
    for name in ["GIMP-SRI", "GC-SRI-patch"] {
        let points = times.iter().step_by(10).map(|&t| (t, consolidation(t) * 0.98)).collect();
        chart.series.push(Series::new(name, points).style(Style::Markers));
    }
    chart.bands.push(Band {
        name: "±5 %".into(),
        points: times.iter().map(|&t| (t, 0.95 * consolidation(t), 1.05 * consolidation(t))).collect(),
        colour: 6,
    });
    chart
}

fn work_precision() -> Chart {
    let mut chart = Chart::new(
        "Work and precision",
        Axis::log10("wall time, median of 5 (s)"),
        Axis::log10("relative L_2 error of p at T_v = 0.2 (–)"),
    );
    let mut front = Vec::new();
    for (i, name) in ["explicit", "semi-implicit", "implicit (SDIRK2)"].into_iter().enumerate() {
        let cost = [3.0, 0.05, 0.0004][i];
        let points: Vec<(f64, f64)> =
            (0..6).map(|k| (cost * 5f64.powi(k), 4e-2 * 0.26f64.powi(k) * (1.0 + 0.3 * i as f64))).collect();
        let mut series = Series::new(name, points.clone());
        series.bars = points.iter().map(|p| (p.1 * 0.8, p.1 * 1.25)).collect();
        if i == 2 {
            series.ringed = (0..6).collect();
            front = points;
        }
        chart.series.push(series);
    }
    chart.series.push(Series::theory("", front).style(Style::Stairs).slot(6));
    chart.ring = Some("on the Pareto front".into());
    chart
}

fn pressure_field() -> Chart {
    let edges: Vec<f64> = steps(24).collect();
    let mut chart = Chart::new("Pore pressure, full integration", Axis::linear("x/L (–)"), Axis::linear("y/H (–)"));
    let mut values = Vec::new();
    for r in 0..24 {
        for c in 0..24 {
            let (x, y) = ((f64::from(c) + 0.5) / 24.0, (f64::from(r) + 0.5) / 24.0);
            let checker = if (r + c) % 2 == 0 { 0.3 } else { -0.3 };
            values.push((PI * x).cos() * (1.0 - y) + checker * y);
        }
    }
    values[30] = f64::NAN;
    chart.field = Some(Field {
        label: "p/q (–)".into(),
        x_edges: edges.clone(),
        y_edges: edges,
        values,
        colours: Colours::Diverging(0.0),
        scale: Scale::Linear,
        range: Range::Auto,
    });
    chart.size = Size { width: 480.0, plot_height: 340.0, equal_units: true };
    chart
}

fn stability_map() -> Chart {
    let mut chart = Chart::new(
        "Critical step of GC-SRI-patch, explicit",
        Axis::log10("hydraulic conductivity k (m/s)"),
        Axis::log10("K_w/E (–)"),
    );
    let x_edges: Vec<f64> = (0..=20).map(|i| 10f64.powf(-12.0 + f64::from(i) / 2.0)).collect();
    let y_edges: Vec<f64> = (0..=15).map(|i| 10f64.powf(1.0 + f64::from(i) / 3.0)).collect();
    let mut values = Vec::new();
    for y in &y_edges[1..] {
        for x in &x_edges[1..] {
            values.push((2e-4 / y.sqrt()).min(x * 1e2));
        }
    }
    chart.field = Some(Field {
        label: "critical Δt (s)".into(),
        x_edges,
        y_edges,
        values,
        colours: Colours::Sequential,
        scale: Scale::Log10,
        range: Range::Auto,
    });
    let edge = (0..=10).map(|i| (3e-8 * 10f64.powf(-0.25 * f64::from(i)), 10f64.powf(1.0 + 0.5 * f64::from(i))));
    chart.series.push(Series::theory("drag and wave limits equal (predicted)", edge.clone().collect()));
    chart.series.push(Series::new("observed", edge.step_by(2).collect()).style(Style::Markers).slot(8));
    chart
}

fn nothing() -> Chart {
    let series = Series::new("GIMP", vec![(f64::NAN, 1.0), (1.0, -1.0), (f64::INFINITY, 2.0)]);
    Chart::new("Nothing to see", Axis::log10("h (m)"), Axis::log10("error (–)")).with(series)
}

fn gallery() -> Vec<(&'static str, Chart)> {
    vec![
        ("convergence", convergence()),
        ("isochrones", isochrones()),
        ("degree", degree()),
        ("work-precision", work_precision()),
        ("pressure-field", pressure_field()),
        ("stability-map", stability_map()),
        ("nothing", nothing()),
    ]
}

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
    assert!(text.contains("GIMP (no data)"), "{text}");
    assert!(svg(&pressure_field()).contains("1 cell without a value is grey."));
}

#[test]
fn points_outside_fixed_axes_are_counted_and_lines_cut() {
    let series = Series::new("a", vec![(0.0, 0.0), (1.0, 1e300), (0.5, 1e9)]);
    let chart = Chart::new("t", Axis::linear("x"), Axis::linear("y").between(0.0, 1.0)).with(series);
    let text = svg(&chart);
    assert!(text.contains("1 beyond 10^±150 (a); 1 outside the axes (a)"), "{text}");
}

#[test]
fn hostile_descriptions_still_make_a_figure() {
    let mut chart = convergence();
    chart.title = "a < b & \"c\" \u{0} \u{e000}".into();
    chart.size = Size { width: f64::NAN, plot_height: -5.0, equal_units: true };
    chart.x.ticks = Some(vec![f64::NAN, -1.0, 0.05]);
    chart.triangles.push(SlopeTriangle { slope: f64::NAN, place: Place::At(0.1, 0.1) });
    chart.triangles.push(SlopeTriangle { slope: 0.0, place: Place::At(-0.1, f64::NAN) });
    chart.rules.push(Rule { axis: Direction::X, at: -1.0, label: "x".into() });
    chart.annotations.push(Annotation { at: (f64::NAN, 1.0), text: "?".into() });
    chart.series[0].ringed = vec![999];
    chart.series[0].bars = vec![(f64::NAN, 0.0); 9];
    chart.series.push(Series::new("one", vec![(0.1, 0.1)]).tag("only"));
    chart.series.push(Series::new("", Vec::new()).tag("none"));
    chart.bands.push(Band { name: String::new(), points: vec![(f64::NAN, 0.0, -1.0)], colour: 99 });
    let text = svg(&chart);
    assert!(text.contains("a &lt; b &amp; &quot;c&quot;"), "{text}");
    let mut field = pressure_field();
    for values in [Vec::new(), vec![f64::NAN; 24 * 24], vec![1.0; 24 * 24]] {
        field.field.as_mut().unwrap_or_else(|| panic!("no field")).values = values;
        assert!(svg(&field).ends_with("</svg>\n"));
    }
}
