//! Figures of every kind from made-up data.
use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size, Style};
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

pub(super) fn convergence() -> Chart {
    let h = [0.2, 0.1, 0.05, 0.025, 0.0125];
    let mut chart = Chart::new(
        "Terzaghi: error of the pore pressure under mesh refinement",
        ChartAxis::log10("cell size h/H (–)").with_ticks(h.to_vec()),
        ChartAxis::log10("relative L_2 error of p at the points (–)"),
    );
    chart.subtitle = Some("T_v = 0.1, 2 points per cell, against Terzaghi with compressible water".into());
    for (i, name) in METHODS.into_iter().enumerate() {
        let (c, p) = [(0.9, 0.9), (0.62, 1.0), (0.4, 1.0), (0.5, 1.9), (0.36, 2.0)][i];
        let mut points: Vec<(f64, f64)> = h.iter().map(|&h: &f64| (h, c * h.powf(p) + 1e-6)).collect();
        if i == 0 {
            points[3].1 = f64::NAN;
            points[4].1 = 0.0;
        }
        chart.series.push(Series::new(name, points));
    }
    for slope in [1, 2] {
        let guide = vec![(h[4], 1e-5), (h[0], 1e-5 * 16f64.powi(slope))];
        chart.series.push(Series::theory(format!("order {slope}"), guide));
    }
    chart.rules.push(Rule { at: 1.4e-4, label: "water storage: 1.4·10⁻⁴".into() });
    chart
}

fn isochrones() -> Chart {
    let mut chart = Chart::new(
        "Isochrones of excess pore pressure",
        ChartAxis::linear("p/q (–)").between(0.0, 1.1),
        ChartAxis::linear("depth ζ = 1 − Y/H (–)").inverted(),
    );
    for t in [0.02, 0.05, 0.1, 0.2, 0.5] {
        let theory = steps(80).map(|z| (pressure(z, t), z)).collect();
        chart.series.push(Series::theory("Terzaghi, compressible water", theory));
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
        ChartAxis::log10("time factor T_v (–)"),
        ChartAxis::linear("degree of consolidation U (–)").inverted(),
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
    chart
}

fn work_precision() -> Chart {
    let mut chart = Chart::new(
        "Work and precision",
        ChartAxis::log10("wall time, median of 5 (s)"),
        ChartAxis::log10("relative L_2 error of p at T_v = 0.2 (–)"),
    );
    let mut front = Vec::new();
    for (i, name) in ["explicit", "semi-implicit", "implicit (SDIRK2)"].into_iter().enumerate() {
        let cost = [3.0, 0.05, 0.0004][i];
        let points: Vec<(f64, f64)> =
            (0..6).map(|k| (cost * 5f64.powi(k), 4e-2 * 0.26f64.powi(k) * (1.0 + 0.3 * i as f64))).collect();
        chart.series.push(Series::new(name, points.clone()));
        front = points;
    }
    chart.series.push(Series::theory("", front).slot(6));
    chart
}

pub(super) fn nothing() -> Chart {
    let series = Series::new("GIMP", vec![(f64::NAN, 1.0), (1.0, -1.0), (f64::INFINITY, 2.0)]);
    Chart::new("Nothing to see", ChartAxis::log10("h (m)"), ChartAxis::log10("error (–)")).with(series)
}

/// More than a figure should hold, with long words everywhere.
fn crowd() -> Chart {
    let mut chart = Chart::new(
        "Everything at once: fourteen methods with long names, over sixteen decades of error, so that a title needs two lines and the legend all of its room",
        ChartAxis::log10("time step over the predicted limit of the explicit scheme, Δt/Δt_crit (–)"),
        ChartAxis::log10("relative L_∞ error of the effective vertical stress σ'_yy at the cell centres (–)"),
    );
    for i in 0..14_u8 {
        let name = format!("TL-{}-patch-with-long-name-{i}", METHODS[usize::from(i % 5)]);
        let p = 1.0 + 0.25 * f64::from(i);
        let points =
            (0..6).map(|k| 2f64.powi(-2 * k)).map(|h| (h, 10f64.powi(2 - i32::from(i) / 3) * h.powf(p)));
        chart.series.push(Series::new(name, points.collect()));
    }
    chart.rules.push(Rule { at: 1e-6, label: "round-off".into() });
    chart
}

pub(super) fn gallery() -> Vec<(&'static str, Chart)> {
    vec![
        ("crowd", crowd()),
        ("convergence", convergence()),
        ("isochrones", isochrones()),
        ("degree", degree()),
        ("work-precision", work_precision()),
        ("nothing", nothing()),
    ]
}
