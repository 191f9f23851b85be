//! Isochrones of the pore pressure and the degree of consolidation, with the theory line.

use crate::case::quantity::Sample;
use crate::questions::answers::QUOTED_CELLS;
use crate::questions::blocks::profiles::{Consolidation, Isochrone, Isochrones};
use crate::questions::sentence;
use crate::questions::study_findings::StudyFindings;
use crate::questions::words;
use crate::render::chart::{Chart, ChartAxis, Series, Size, Style};
use crate::render::page::{Block, Figure};
use crate::render::{RenderError, number};
use crate::report::blocks::figure_of;

/// Profiles of a column; empty where there are none.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let Some(profiles) = &study.plain.blocks.profiles else { return Ok(Vec::new()) };
    let heading = match profiles.cells {
        QUOTED_CELLS => "Profiles on ten cells".to_owned(),
        cells => format!("Profiles on {cells} cells"),
    };
    let mut figures: Vec<Figure> =
        profiles.isochrones.iter().map(|one| isochrones(&study.name, one)).collect();
    figures.extend(profiles.consolidation.as_ref().map(|curves| consolidation(&study.name, curves)));
    let mut blocks = vec![Block::Heading(heading), Block::Figures(figures)];
    if let Some(sampling) = &profiles.sampling {
        blocks.push(Block::Paragraph(sentence::sentence("sampling", sampling)?));
    }
    Ok(blocks)
}

/// Time factor of an isochrone, with the degree of consolidation where large strains make that the
/// measure of progress.
fn isochrone_name(is_large_strain: bool, curve: &Isochrone) -> String {
    if is_large_strain {
        format!("T_v = {:.3}, U = {}", curve.time_factor, number::rounded_percent(curve.degree))
    } else {
        format!("T_v = {}", number::time_factor(curve.time_factor))
    }
}

/// Label of the depth axis; water leaves a slab between plates at its sides.
fn depth_name(reference: &str) -> &'static str {
    if reference == "mandel" {
        "distance from the drained side (a − x)/a (–)"
    } else {
        "depth below the surface (H − Y)/H (–)"
    }
}

/// The paper's Figs 3a and 4a: `p/q` against depth.
pub fn isochrones(study: &str, found: &Isochrones) -> Figure {
    let has_waves = found.has_waves;
    let pressure = ChartAxis::linear("excess pore pressure p/q (–)");
    let mut chart = Chart::new(
        format!("Isochrones, {}", found.method),
        if has_waves { pressure } else { pressure.between(0.0, 1.05) },
        ChartAxis::linear(depth_name(&found.reference)).between(0.0, 1.0).inverted(),
    );
    chart.size = Size::PANEL;
    let reference = words::theory(&found.reference);
    for (slot, curve) in found.curves.iter().enumerate() {
        let theory = curve.theory.clone();
        chart.series.push(if has_waves {
            // Lines of waves cross: each has the colour of its time.
            let name = if slot == 0 { reference.as_str() } else { "" };
            Series::new(name, theory).style(Style::Line).slot(slot)
        } else {
            Series::theory(reference.as_str(), theory).slot(0)
        });
        let name = isochrone_name(found.is_large_strain, curve);
        chart.series.push(Series::new(name, curve.computed.clone()).style(Style::Markers).slot(slot));
    }
    let caption = format!(
        "Markers: {} of {} on {} cells. Lines: theory{}.",
        found.sample.map_or("material points", Sample::name),
        found.method,
        found.cells,
        if has_waves { ", in the colour of its time" } else { "" }
    );
    figure_of(study, &format!("isochrones-{}", found.method), chart, caption)
}

/// The end of an axis of degrees of consolidation: all of it, or the tenth beyond all that is drawn, so that an early part fills
/// the figure.
fn end_of_axis(found: &Consolidation) -> f64 {
    let runs = found.runs.iter().flat_map(|run| &run.points);
    let most = found.theory.iter().chain(runs).map(|(_, degree)| *degree).fold(0.0, f64::max);
    ((10.0 * most).floor() + 1.0).clamp(1.0, 10.0) / 10.0
}

/// The paper's Figs 3b and 4b: degree of consolidation against the time factor.
pub fn consolidation(study: &str, found: &Consolidation) -> Figure {
    let mut chart = Chart::new(
        "Degree of consolidation",
        ChartAxis::log10("time factor T_v (–)"),
        ChartAxis::linear("degree of consolidation by settlement U (–)")
            .between(0.0, end_of_axis(found))
            .inverted(),
    );
    chart.size = Size::PANEL;
    chart.series.push(Series::theory(words::theory(&found.reference), found.theory.clone()));
    for (slot, run) in found.runs.iter().enumerate() {
        let series = Series::new(run.method.as_str(), run.points.clone());
        chart.series.push(series.style(Style::Markers).slot(slot));
    }
    let caption = "Settlement over its final value.";
    figure_of(study, "consolidation", chart, caption)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;
    use crate::case::quantity::Quantity;
    use crate::questions::blocks::profiles::ConsolidationRun;
    use crate::questions::study_results::StudyResults;

    fn found_blocks(results: &StudyResults<'_>) -> Vec<Block> {
        blocks(&results.findings().expect("theory")).expect("filled")
    }

    #[test]
    fn an_axis_of_consolidation_ends_beyond_all_that_it_shows() {
        let end = |theory: f64, run: f64| {
            let run = ConsolidationRun { method: "GIMP".to_owned(), points: vec![(0.1, run)] };
            let theory = vec![(0.01, 0.5 * theory), (0.1, theory)];
            end_of_axis(&Consolidation { reference: "terzaghi".to_owned(), theory, runs: vec![run] })
        };
        assert_eq!([end(0.02, 0.01), end(0.12, 0.21), end(0.34, 0.3), end(0.97, 0.9)], [0.1, 0.3, 0.4, 1.0]);
    }

    #[test]
    fn the_first_and_the_last_method_have_their_profiles_and_a_constant_in_each_cell_its_note() {
        let of = |methods: &str, more: &str| {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.2, 0.4]\n[[sweep]]\nmethod = {methods}\n\
                 integrator = ['implicit']\ncells = [5, 10]\ntime_step = [{{ growth = 0.5 }}]\n{more}\n"
            );
            let (study, mut records) = solved("t", &text);
            for record in &mut records {
                for row in record.errors.iter_mut().filter(|row| row.quantity == Quantity::Pressure) {
                    row.value = row.time_factor * if row.sample == Sample::Points { 0.1 } else { 0.01 };
                }
            }
            (study, records)
        };
        let (study, records) = of("['GC-SRI-patch', 'GIMP-SRI', 'MPM']", "");
        let results = StudyResults::new(&study, &records, Tier::Full);
        let found = found_blocks(&results);
        let Block::Figures(figures) = &found[1] else { panic!("{found:?}") };
        assert_eq!(found[0], Block::Heading("Profiles on ten cells".to_owned()));
        let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
        assert_eq!(names, ["t-isochrones-gc-sri-patch", "t-isochrones-mpm"]);
        assert_eq!(
            figures[0].caption,
            "Markers: material points of GC-SRI-patch on 10 cells. Lines: theory."
        );
        // (π/2)(1/10)√((1 − 1/4)/12) = 0.0393; the errors are those at T_v = 0.2.
        let Some(Block::Paragraph(note)) = found.get(2) else { panic!("{found:?}") };
        assert!(
            note.starts_with("**The sampling points decide the order.** GIMP-SRI gives every point"),
            "{note}"
        );
        let told = "(error 2.00e-3 at T_v = 0.2), but";
        let measured =
            "(π/2)(h/H)√((1 − 1/m²)/12) = 3.93e-2 with m = 2 points per cell, and 2.00e-2 is measured.";
        assert!(note.contains(told) && note.contains(measured), "{note}");
        assert!(found_blocks(&StudyResults::new(&study, &records[..2], Tier::Full)).is_empty());
        assert_eq!(depth_name("mandel"), "distance from the drained side (a − x)/a (–)");
        assert_eq!(depth_name("terzaghi"), "depth below the surface (H − Y)/H (–)");
    }
}
