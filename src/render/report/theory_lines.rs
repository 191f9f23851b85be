//! Isochrones of the pore pressure and the degree of consolidation, with the theory line.

use crate::case::quantity::{Norm, Quantity, Sample};
use crate::judge::answers::QUOTED_CELLS;
use crate::judge::study_results::StudyResults;
use crate::measure::statistics::largest;
use crate::measure::theory::{
    TheoryIsochrone, computed_consolidation, computed_isochrone, constant_recovery_error,
    theory_consolidation, theory_isochrones,
};
use crate::record::{Record, Status};
use crate::render::chart::{Chart, ChartAxis, Series, Size, Style};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::figure_of;
use crate::render::report::labels::{first_measure, grouped};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::scene::SceneKind;

/// Points per cell of the runs whose profiles are drawn: the first of these that a study has.
const SHOWN_POINTS: [usize; 2] = [2, 4];

/// Profiles of the runs of a study on the paper's mesh, one run per method; empty for a study of one method.
pub fn blocks(results: &StudyResults<'_>) -> Result<Vec<Block>, ExactError> {
    let scene = results.study.scene;
    let shown = shown_records(results.records, matches!(scene, SceneKind::Layered | SceneKind::YieldFront));
    if shown.len() < 2 || scene.has_plane_fields() {
        return Ok(Vec::new());
    }
    let heading = match shown[0].case.cells {
        QUOTED_CELLS => "Profiles on ten cells".to_owned(),
        cells => format!("Profiles on {cells} cells"),
    };
    let mut blocks = vec![Block::Heading(heading)];
    let mut figures = Vec::new();
    // The first and the last method of the study: the plainest and the paper's.
    for record in shown.first().into_iter().chain(shown.last()) {
        figures.push(isochrones(results, record)?);
    }
    // A half-space has no settlement in the end.
    let is_half_space = scene == SceneKind::YieldFront;
    if !is_half_space && !coincide(results, &shown) {
        figures.push(consolidation(results, &shown)?);
    }
    blocks.push(Block::Figures(figures));
    if !is_half_space && shown[0].case.column.soils.is_empty() {
        blocks.extend(sampling_note(&shown).map(Block::Paragraph));
    }
    Ok(blocks)
}

/// Relative difference up to which settlements share one marker.
const ONE_MARKER: f64 = 0.01;

/// Whether the settlements of all runs coincide at every output, so that their curves show no difference.
fn coincide(results: &StudyResults<'_>, shown: &[&Record]) -> bool {
    let own = results.study.references[0].name();
    shown[0].case.time_factors.iter().all(|time| {
        let measure = first_measure(Quantity::Settlement, Sample::Surface, own, *time);
        let errors = shown.iter().filter_map(|record| Some(measure.error(record)?.value));
        // Numbers that are none differ from all.
        let highest = |sign: f64| largest(errors.clone().map(|error| sign * error));
        highest(1.0).zip(highest(-1.0)).is_none_or(|(high, low)| high + low < ONE_MARKER)
    })
}

/// The first sound run of each method on the paper's mesh; where pressures have a kink, on the coarsest of the study.
fn shown_records(records: &[Record], has_kink: bool) -> Vec<&Record> {
    let coarsest = records.iter().map(|record| record.case.cells).min().filter(|_| has_kink);
    let cells = coarsest.unwrap_or(QUOTED_CELLS);
    let is_sound = |record: &&Record| record.case.cells == cells && record.status == Status::Ok;
    let with =
        |points: &usize| records.iter().filter(is_sound).any(|record| record.case.points_per_cell == *points);
    let points_per_cell = SHOWN_POINTS.into_iter().find(with);
    let is_shown =
        |record: &&Record| is_sound(record) && Some(record.case.points_per_cell) == points_per_cell;
    let runs = records.iter().filter(is_shown).map(|record| (record.case.method, record));
    grouped(runs).into_iter().map(|(_, own)| own[0]).collect()
}

/// Time factor of an isochrone, with the degree of consolidation where large strains make that the
/// measure of progress.
fn isochrone_name(results: &StudyResults<'_>, theory: &TheoryIsochrone) -> String {
    if results.study.scene.is_large_strain() {
        format!("T_v = {:.3}, U = {:.0} %", theory.time_factor, 100.0 * theory.degree)
    } else {
        format!("T_v = {}", number::time_factor(theory.time_factor))
    }
}

/// Label of the depth axis; water leaves a slab between plates at its sides.
fn depth_name(own: ReferenceKind) -> &'static str {
    if own == ReferenceKind::Mandel {
        "distance from the drained side (a − x)/a (–)"
    } else {
        "depth below the surface (H − Y)/H (–)"
    }
}

/// The paper's Figs 3a and 4a: `p/q` against depth.
pub fn isochrones(results: &StudyResults<'_>, record: &Record) -> Result<Figure, ExactError> {
    let own = results.study.references[0];
    let mut chart = Chart::new(
        format!("Isochrones, {}", record.case.method),
        if results.study.scene.has_waves() {
            ChartAxis::linear("excess pore pressure p/q (–)")
        } else {
            ChartAxis::linear("excess pore pressure p/q (–)").between(0.0, 1.05)
        },
        ChartAxis::linear(depth_name(own)).between(0.0, 1.0).inverted(),
    );
    chart.size = Size::PANEL;
    for (slot, theory) in theory_isochrones(&record.case, own)?.into_iter().enumerate() {
        let computed = computed_isochrone(record, theory.time_factor);
        let name = isochrone_name(results, &theory);
        chart.series.push(if results.study.scene.has_waves() {
            // Lines of waves cross: each has the colour of its time.
            let name = if slot == 0 { own.name() } else { "" };
            Series::new(name, theory.line).style(Style::Line).slot(slot)
        } else {
            Series::theory(own.name(), theory.line).slot(0)
        });
        chart.series.push(Series::new(name, computed).style(Style::Markers).slot(slot));
    }
    let caption = format!(
        "Markers: {} of {} on {} cells. Lines: theory{}.",
        if record.case.has_integrator() { "material points" } else { record.main_sample().name() },
        record.case.method,
        record.case.cells,
        if results.study.scene.has_waves() { ", in the colour of its time" } else { "" }
    );
    Ok(figure_of(results, &format!("isochrones-{}", record.case.method), chart, caption))
}

/// The paper's Figs 3b and 4b: degree of consolidation against the time factor.
pub fn consolidation(results: &StudyResults<'_>, shown: &[&Record]) -> Result<Figure, ExactError> {
    let own = results.study.references[0];
    let case = &shown[0].case;
    let ends = shown.iter().filter_map(|record| record.case.time_factors.last());
    let end = ends.copied().reduce(f64::max).unwrap_or(1.0);
    let mut chart = Chart::new(
        "Degree of consolidation",
        ChartAxis::log10("time factor T_v (–)"),
        ChartAxis::linear("degree of consolidation by settlement U (–)").between(0.0, 1.0).inverted(),
    );
    chart.size = Size::PANEL;
    chart.series.push(Series::theory(own.name(), theory_consolidation(case, own, end)?));
    for (slot, record) in shown.iter().enumerate() {
        let points = thinned(&computed_consolidation(record), slot, shown.len());
        chart
            .series
            .push(Series::new(record.case.method.to_string(), points).style(Style::Markers).slot(slot));
    }
    let caption = "Settlement over its final value, downward as engineers draw it.";
    Ok(figure_of(results, "consolidation", chart, caption))
}

/// Markers of one run on a curve of consolidation.
const MARKERS: usize = 12;

/// Every so many of the points, with those of other runs between them, so that the line is seen and no run hides
/// another.
fn thinned(points: &[(f64, f64)], slot: usize, runs: usize) -> Vec<(f64, f64)> {
    let stride = (points.len() / MARKERS).max(1);
    let first = stride * slot / runs.max(1);
    points.iter().skip(first).step_by(stride).copied().collect()
}

/// Why a constant in each cell is of first order at the points and of second at the centres, with numbers.
fn sampling_note(shown: &[&Record]) -> Option<String> {
    let record = shown
        .iter()
        .find(|record| record.case.method.own().is_some_and(|method| method.has_constant_recovery()))?;
    let own = record.references.first()?.name.as_str();
    let time_factor = *record.case.time_factors.iter().rfind(|factor| **factor <= 0.2)?;
    let error =
        |sample| record.error(Quantity::Pressure, sample, Norm::L2, own, time_factor).map(|row| row.value);
    Some(format!(
        "**The sampling points decide the order.** {} gives every point of a cell the value at its centre. That value is of \
         second order at the centre (error {:.2e} at T_v = {time_factor}), but a point beside it is off by the slope times \
         its distance: a profile of slope (π/2) q/H gives (π/2)(h/H)√((1 − 1/m²)/12) = {:.2e} with m = {} points per cell, \
         and {:.2e} is measured. Both are errors of the same run; recovery over a patch restores the slope at the points.",
        record.case.method,
        error(Sample::Centres)?,
        constant_recovery_error(&record.case),
        record.case.points_per_cell,
        error(Sample::Points)?,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;

    const TIMES: [f64; 3] = [0.05, 0.1, 0.2];

    #[test]
    fn curves_coincide_where_they_do_so_at_every_output_and_for_every_method() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.1, 0.2]\n[[sweep]]\n\
                    method = ['MPM', 'GIMP', 'GIMP-SRI']\nintegrator = ['implicit']\ncells = [10]\n\
                    time_step = [{ growth = 0.5 }]\n";
        let (study, records) = solved("t", text);
        // Errors of the settlement, by method and output.
        let found = |errors: [[f64; 3]; 3]| {
            let mut records = records.clone();
            for (record, errors) in records.iter_mut().zip(errors) {
                for row in record.errors.iter_mut().filter(|row| row.quantity == Quantity::Settlement) {
                    let place = TIMES.iter().position(|time| *time == row.time_factor).expect("an output");
                    row.value = errors[place];
                }
            }
            let results = StudyResults::new(&study, &records, Tier::Full);
            let shown = shown_records(&records, false);
            assert_eq!(shown.len(), 3);
            let drawn = blocks(&results).expect("theory").iter().any(|block| {
                matches!(block, Block::Figures(all) if all.iter().any(|one| one.name.contains("consolidation")))
            });
            let answer = coincide(&results, &shown);
            assert_eq!(drawn, !answer, "the figure shows the difference");
            answer
        };
        // All are off alike, and more at one output than at another.
        let alike = [[0.2, -0.3, 0.01]; 3];
        assert!(found(alike));
        for (method, output) in (0..3).flat_map(|method| (0..3).map(move |output| (method, output))) {
            for (change, coincide) in
                [(0.02, false), (-0.02, false), (0.005, true), (-0.005, true), (f64::NAN, false)]
            {
                let mut errors = alike;
                errors[method][output] += change;
                assert_eq!(found(errors), coincide, "{method} {output} {change}");
            }
        }
    }

    #[test]
    fn markers_of_runs_are_thinned_and_stand_beside_each_other() {
        let points: Vec<(f64, f64)> = (0..48).map(|place| (f64::from(place), 0.0)).collect();
        let places = |slot: usize, runs: usize, count: usize| -> Vec<f64> {
            thinned(&points[..count], slot, runs).into_iter().map(|point| point.0).collect()
        };
        assert_eq!(places(0, 1, 48), (0..12).map(|marker| f64::from(4 * marker)).collect::<Vec<_>>());
        assert_eq!([places(0, 2, 48)[0], places(1, 2, 48)[0], places(3, 4, 48)[0]], [0.0, 2.0, 3.0]);
        assert_eq!(places(1, 2, 5), [0.0, 1.0, 2.0, 3.0, 4.0], "few are all shown");
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
        let found = blocks(&results).expect("theory");
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
        assert!(blocks(&StudyResults::new(&study, &records[..2], Tier::Full)).expect("theory").is_empty());
        let shown = |records: &[Record], has_kink: bool| {
            let case = |record: &&Record| {
                (record.case.method.to_string(), record.case.cells, record.case.points_per_cell)
            };
            shown_records(records, has_kink).iter().map(case).collect::<Vec<_>>()
        };
        let is = |method: &str, cells: usize, points: usize| (method.to_owned(), cells, points);
        let (_, mut points) = of("['MPM', 'GIMP']", "points_per_cell = [3, 4, 2]");
        assert_eq!(shown(&points, false), [is("MPM", 10, 2), is("GIMP", 10, 2)]);
        assert_eq!(shown(&points, true), [is("MPM", 5, 2), is("GIMP", 5, 2)], "kinks show on the coarsest");
        points.retain(|record| record.case.points_per_cell != 2);
        assert_eq!(shown(&points, false), [is("MPM", 10, 4), is("GIMP", 10, 4)]);
        points.retain(|record| record.case.points_per_cell != 4);
        assert_eq!(shown(&points, false), []);
        assert_eq!(depth_name(ReferenceKind::Mandel), "distance from the drained side (a − x)/a (–)");
        assert_eq!(depth_name(ReferenceKind::Terzaghi), "depth below the surface (H − Y)/H (–)");
    }
}
