//! Are the published equations right? A figure over time and one over the mesh, a line per pairing of law and continuity.

use crate::questions::answers::audit::{AuditFinding, PairingFinding};
use crate::questions::sentence;
use crate::questions::words;
use crate::render::RenderError;
use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size, SlopeTriangle};
use crate::render::page::{Block, Figure, Section};
use crate::report::answers::Question;

const QUESTION: Question = Question { heading: "Are the published equations right?", id: "audit" };

/// Which equations agree, the figures, and the boundary condition that the paper does not name.
pub fn section(audit: &AuditFinding) -> Result<Section, RenderError> {
    let figures = vec![over_time(audit), over_mesh(audit)];
    let blocks = vec![Block::Figures(figures), Block::Paragraph(sentence::sentence("mapping-back", audit)?)];
    Ok(QUESTION.answered(&sentence::sentence("audit", audit)?, [audit.study.as_str()], blocks))
}

/// Law and continuity of a pairing, in words.
fn name_of(pairing: &PairingFinding) -> String {
    let mark = if pairing.is_printed { " (as printed)" } else { "" };
    format!("{}, {}{mark}", pairing.law, pairing.continuity)
}

fn over_time(audit: &AuditFinding) -> Figure {
    let mut chart = Chart::new(
        "Settlement against Xie & Leo, over time",
        ChartAxis::log10("time factor T_v (–)"),
        ChartAxis::linear("settlement over the exact one, minus one (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(format!("{}, {} cells", audit.method, audit.cells));
    let series = |pairing: &PairingFinding| Series::new(name_of(pairing), pairing.settlement.clone());
    chart.series.extend(audit.pairings.iter().map(series));
    chart.rules.push(Rule { at: 0.0, label: "Xie & Leo".to_owned() });
    Figure::new("readme-audit-settlement", chart, "Zero is Xie & Leo's column.")
}

fn over_mesh(audit: &AuditFinding) -> Figure {
    let points = || audit.pairings.iter().flat_map(|pairing| &pairing.pressure);
    let mut chart = Chart::new(
        "Pressure against Xie & Leo, over the mesh",
        ChartAxis::log10("cell size h (m)").with_ticks(words::ticks(points().map(|(size, _)| *size))),
        ChartAxis::log10("relative L_2 error of the pressure at the points (–)"),
    );
    chart.size = Size::PANEL;
    chart.subtitle = Some(format!("{}, T_v = {}", audit.method, audit.time_factor));
    let series = |pairing: &PairingFinding| Series::new(name_of(pairing), pairing.pressure.clone());
    chart.series.extend(audit.pairings.iter().map(series));
    let falls = audit.pairings.iter().filter_map(|pairing| match pairing.pressure.as_slice() {
        [coarse, _, .., fine] => Some((coarse.1 / fine.1, name_of(pairing))),
        _ => None,
    });
    let steepest = falls.max_by(|a, b| a.0.total_cmp(&b.0));
    chart.triangles.extend(steepest.map(|(_, beside)| SlopeTriangle { slope: 2.0, beside }));
    let caption = "The error of the right equations falls with every mesh; that of wrong ones stops at the difference of the two \
                   theories. Triangle: second order.";
    Figure::new("readme-audit-pressure", chart, caption)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pairing_is_drawn_and_the_steepest_of_three_meshes_has_the_triangle() {
        let pairing = |law: &str, is_printed: bool, pressure: &[(f64, f64)]| PairingFinding {
            law: law.to_owned(),
            continuity: "c".to_owned(),
            is_printed,
            settlement: vec![(0.1, -0.1)],
            pressure: pressure.to_vec(),
            largest: None,
            agrees: false,
        };
        let audit = AuditFinding {
            study: "s".to_owned(),
            method: "M".to_owned(),
            cells: 4,
            time_factor: 0.5,
            agrees_within: 0.01,
            pairings: vec![
                // The steepest of all has two meshes.
                pairing("printed", true, &[(0.5, 1.0), (0.25, 0.001)]),
                pairing("flat", false, &[(0.5, 1.0), (0.25, 0.5), (0.125, 0.25)]),
                pairing("right", false, &[(0.5, 1.0), (0.25, 0.25), (0.125, 0.0625)]),
            ],
        };
        let [time, mesh] = [over_time(&audit), over_mesh(&audit)].map(|figure| figure.chart);
        let names: Vec<&str> = mesh.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["printed, c (as printed)", "flat, c", "right, c"]);
        assert_eq!(time.series[1].points, [(0.1, -0.1)]);
        assert_eq!(mesh.series[2].points, audit.pairings[2].pressure);
        let subtitles = [&time, &mesh].map(|chart| chart.subtitle.clone().unwrap_or_default());
        assert_eq!(subtitles, ["M, 4 cells", "M, T_v = 0.5"]);
        assert_eq!(mesh.triangles, [SlopeTriangle { slope: 2.0, beside: "right, c".to_owned() }]);
        assert_eq!(time.rules, [Rule { at: 0.0, label: "Xie & Leo".to_owned() }]);
    }
}
