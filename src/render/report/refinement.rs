//! Errors under refinement: figures with slope triangles, and tables of orders.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::blocks::floors::shared_floor;
use crate::judge::levels::{LevelError, LevelValue, levels_of};
use crate::judge::path_labels::path_labels;
use crate::judge::paths::{Path, SeriesSummary, common_times, first_norm, shown_time};
use crate::judge::study_results::StudyResults;
use crate::record::Record;
use crate::render::chart::{Chart, ChartAxis, Rule, Series, Size, SlopeTriangle};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::figure_of;
use crate::render::report::labels;
use crate::render::report::labels::{DrawnPaths, drawn, first_measure, grouped};
use crate::render::table::{Cell, Table, TableColumn, columns};
use crate::study::expectation::{Axis, Measure, NEXT_FINER};
use oedometer_exact::reference::ReferenceKind;
use oedometer_mpm::scene::SceneKind;

/// Quantities of the figures, side by side: the settlement of a column, the displacement of a layer.
fn panels(results: &StudyResults<'_>) -> [(Quantity, Sample); 4] {
    let of_the_body = if results.study.scene == SceneKind::Footing {
        (Quantity::LoadFactor, Sample::Surface)
    } else if results.study.scene.has_plane_fields() {
        (Quantity::Displacement, Sample::Nodes)
    } else {
        (Quantity::Settlement, Sample::Surface)
    };
    [
        (Quantity::Pressure, Sample::Points),
        (Quantity::Pressure, Sample::Centres),
        (Quantity::EffectiveStress, Sample::Points),
        of_the_body,
    ]
}

/// Floors that are listed below a table before the rest is only counted.
const MOST_NOTES: usize = 20;

/// Figures and tables of a study along an axis; empty without refinement along it.
pub fn blocks(results: &StudyResults<'_>, axis: Axis) -> Vec<Block> {
    let all = results.refined(axis);
    if all.is_empty() {
        return Vec::new();
    }
    let times = common_times(&all);
    let Some(shown) = shown_time(&all) else { return Vec::new() };
    let mut blocks = vec![Block::Heading(heading(axis).to_owned())];
    let mut references: Vec<&str> = results.study.references.iter().map(|kind| kind.name()).collect();
    let expects_nothing = results.study.expectations.is_empty();
    if axis == Axis::TimeStep && (expects_nothing || results.asks_for(NEXT_FINER)) {
        references.insert(0, NEXT_FINER);
    }
    let own = references.first().copied().unwrap_or_default();
    let DrawnPaths { paths: few, note } = drawn(&all);
    let figures =
        panels(results).map(|(quantity, sample)| figure(results, &few, axis, quantity, sample, own, shown));
    blocks.push(Block::Figures(figures.into_iter().flatten().collect()));
    if let (true, Some(other)) = (floors_of_model(results), references.get(1)) {
        blocks.extend(
            figure(results, &few, axis, Quantity::Pressure, Sample::Points, other, shown).map(Block::Figure),
        );
    }
    blocks.extend(note.map(Block::Paragraph));
    blocks.push(Block::Table(orders_table(results, &all, axis, own, shown)));
    let mut more: Vec<Block> = times
        .iter()
        .filter(|time| **time != shown)
        .map(|time| Block::Table(orders_table(results, &all, axis, own, *time)))
        .collect();
    for other in references.iter().skip(1) {
        more.push(Block::Table(orders_table(results, &all, axis, other, shown)));
    }
    if !more.is_empty() {
        blocks.push(Block::Details { summary: "The other times and references".to_owned(), blocks: more });
    }
    blocks
}

/// The figure of one error over the mesh, against the scene's own solution; `None` without refinement.
pub fn mesh_figure(
    results: &StudyResults<'_>,
    quantity: Quantity,
    sample: Sample,
    time_factor: f64,
) -> Option<Figure> {
    let all = results.refined(Axis::Cells);
    let own = results.study.references.first()?.name();
    let few = drawn(&all).paths;
    if few.is_empty() { None } else { figure(results, &few, Axis::Cells, quantity, sample, own, time_factor) }
}

/// Whether the study has expectations against another model than its own.
fn floors_of_model(results: &StudyResults<'_>) -> bool {
    let own = results.study.references.first().copied();
    results.study.expectations.iter().any(|one| one.reference.is_some() && one.reference != own)
}

fn heading(axis: Axis) -> &'static str {
    match axis {
        Axis::Cells => "Error against the mesh",
        Axis::TimeStep => "Error against the time step",
        Axis::PointsPerCell => "Error against the points in a cell",
        Axis::WaterBulkModulus => "Error against the compressibility of the water",
    }
}

fn figure(
    results: &StudyResults<'_>,
    all: &[Path<'_>],
    axis: Axis,
    quantity: Quantity,
    sample: Sample,
    reference: &str,
    time_factor: f64,
) -> Option<Figure> {
    let measure = first_measure(quantity, sample, reference, time_factor);
    let all = &measured(all, &measure);
    let summaries: Vec<SeriesSummary<'_>> =
        all.iter().map(|path| path.summary(&path.own_measure(&measure))).collect();
    if summaries.iter().all(|summary| summary.series.levels().iter().all(|level| level.error.is_none())) {
        return None;
    }
    let sizes = summaries.iter().flat_map(|summary| summary.series.levels()).map(|level| level.size);
    let ticks = labels::ticks(sizes);
    let mut chart = Chart::new(
        format!("Error of the {}", labels::measure(&measure)),
        ChartAxis::log10(labels::axis(axis)).with_ticks(ticks),
        ChartAxis::log10(labels::error_axis(&measure)),
    );
    let labels = path_labels(all).with_places(&summaries, sample);
    chart.subtitle = Some(format!(
        "T_v = {}, against {}{}",
        number::time_factor(time_factor),
        labels::solution(reference),
        labels.subtitle_end()
    ));
    chart.size = Size::PANEL;
    for (summary, label) in summaries.iter().zip(&labels.each) {
        let points: Vec<(f64, f64)> =
            summary.series.levels().iter().filter_map(|level| Some((level.size, level.error?))).collect();
        chart.series.push(Series::new(label.clone(), points));
    }
    if shows_orders(axis, reference) {
        add_triangles(&mut chart, &summaries, &labels.each);
    }
    if axis == Axis::Cells
        && let Some((at, whose)) = shared_floor(&summaries, &labels.each)
    {
        let kind: Option<ReferenceKind> = reference.parse().ok();
        let cause = kind.and_then(|kind| {
            results.study.scene.model_difference(kind, &summaries[0].path.records[0].case.material)
        });
        let cause = cause.map_or_else(String::new, |cause| format!(": {cause}"));
        chart.rules.push(Rule { at, label: format!("floor of {whose}{cause}") });
    }
    let name = format!("{}-{}-{}-{reference}", axis.name(), quantity.name(), sample.name());
    let caption = if axis == Axis::PointsPerCell {
        "More points refine the quadrature, not the mesh: the error tends to that of the mesh.".to_owned()
    } else {
        captions(&summaries, &labels.each)
    };
    Some(figure_of(results, &name, chart, caption))
}

/// The paths of this program, and those of others that have an error of the kind.
fn measured<'a>(all: &[Path<'a>], measure: &Measure) -> Vec<Path<'a>> {
    let has = |path: &&Path<'_>| {
        let measure = path.own_measure(measure);
        path.records.iter().all(|record| record.case.has_integrator())
            || path.series(&measure).levels().iter().any(|level| level.error.is_some())
    };
    all.iter().filter(has).cloned().collect()
}

/// Whether errors along the axis fall with an order instead of ending in the error of the mesh.
fn shows_orders(axis: Axis, reference: &str) -> bool {
    axis == Axis::Cells || axis == Axis::TimeStep && reference == NEXT_FINER
}

/// One triangle for each order that a series comes near.
fn add_triangles(chart: &mut Chart, summaries: &[SeriesSummary<'_>], labels: &[String]) {
    for slope in [1.0, 2.0] {
        let near = summaries
            .iter()
            .zip(labels)
            .find(|(summary, _)| summary.finest.as_ref().is_ok_and(|order| (order - slope).abs() < 0.3));
        if let Some((_, label)) = near {
            chart.triangles.push(SlopeTriangle { slope, beside: label.clone() });
        }
    }
}

/// The series of a figure by their class.
fn captions(summaries: &[SeriesSummary<'_>], labels: &[String]) -> String {
    let said = summaries.iter().zip(labels).map(|(summary, label)| {
        let class = &summary.classification;
        let order = class.order.filter(|_| shows_orders(summary.path.axis, &summary.measure.reference));
        let order = order.map_or(String::new(), |order| format!(" (order {})", number::order(order)));
        (class.class.name(), format!("{label}{order}"))
    });
    let parts = grouped(said).into_iter().map(|(class, series)| format!("*{class}*: {}", series.join("; ")));
    parts.collect::<Vec<_>>().join(". ") + "."
}

/// Errors at every level with pairwise orders, fit, finest window and class.
fn orders_table(
    results: &StudyResults<'_>,
    all: &[Path<'_>],
    axis: Axis,
    reference: &str,
    time_factor: f64,
) -> Table {
    let levels = levels_of(all, axis);
    let labels = path_labels(all);
    let mut columns = columns("method | error of");
    columns.extend(levels.iter().map(|(_, record)| TableColumn::number(level_name(record, axis))));
    if shows_orders(axis, reference) {
        columns.extend(
            ["order from level to level", "order fitted to all, 95 %", "order of the finest 3"]
                .map(TableColumn::number),
        );
    }
    if axis != Axis::PointsPerCell {
        columns.push(TableColumn::text("class"));
    }
    let mut rows = Vec::new();
    let mut notes = Vec::new();
    for (quantity, sample) in panels(results) {
        let asked = first_measure(quantity, sample, reference, time_factor);
        for (path, label) in all.iter().zip(&labels.each) {
            let measure = path.own_measure(&asked);
            let summary = path.summary(&measure);
            if measured(std::slice::from_ref(path), &asked).is_empty() {
                continue;
            }
            let told = summary.classification.floor.as_ref().filter(|_| axis != Axis::PointsPerCell);
            if let (Some(floor), Some(advice)) = (told, &summary.classification.advice) {
                notes.push(format!(
                    "{label}, {}: floor {:.1e}; {advice}",
                    labels::measure(&measure),
                    floor.value
                ));
            }
            rows.push(orders_row(&summary, label, &measure, &levels, axis));
        }
    }
    if notes.len() > MOST_NOTES {
        let more = notes.len() - MOST_NOTES;
        notes.truncate(MOST_NOTES);
        notes.push(format!("and {more} floors more, of the series whose class says so"));
    }
    notes.push(format!(
        "{} over the volume; settlement |s/s_exact − 1|",
        first_norm(Quantity::Pressure).formula()
    ));
    if !labels.shared.is_empty() {
        notes.insert(0, format!("all with {}", labels.shared));
    }
    let title =
        format!("T_v = {}, against {}", number::time_factor(time_factor), labels::solution(reference));
    Table::of(title, columns, rows).notes(notes)
}

fn orders_row(
    summary: &SeriesSummary<'_>,
    label: &str,
    measure: &Measure,
    levels: &[(LevelValue, &Record)],
    axis: Axis,
) -> Vec<Cell> {
    let mut row = vec![Cell::Code(label.to_owned()), labels::measure(measure).into()];
    row.extend(levels.iter().map(|(level, _)| {
        match summary.path.error_at(level, measure, &summary.series) {
            LevelError::Measured(error) => Cell::Error(error),
            LevelError::NotMeasured => Cell::missing("no error was measured"),
            LevelError::NotAsked => Cell::missing("not asked for at this time"),
            LevelError::NoFiner => Cell::missing("no finer level to compare with"),
            LevelError::NotRun => Cell::missing("not run"),
        }
    }));
    if shows_orders(axis, &measure.reference) {
        let pairs: Vec<String> = summary
            .pairs
            .iter()
            .map(|order| order.as_ref().map_or("–".to_owned(), |order| number::order(*order)))
            .collect();
        row.push(pairs.join(", ").into());
        row.push(summary.slope.as_ref().map_or_else(
            |undefined| Cell::Missing(undefined.to_string()),
            |fit| fit.half_width.map_or(Cell::Order(fit.order), |half| Cell::OrderWithin(fit.order, half)),
        ));
        let finest = summary.finest.as_ref();
        row.push(finest.map_or_else(|why| Cell::Missing(why.to_string()), |order| Cell::Order(*order)));
    }
    if axis != Axis::PointsPerCell {
        row.push(summary.classification.class.name().into());
    }
    row
}

/// The name of a run's level.
fn level_name(record: &Record, axis: Axis) -> String {
    match axis {
        Axis::Cells => record.case.cells.to_string(),
        Axis::TimeStep => labels::step(record),
        Axis::PointsPerCell => format!("m = {}", record.case.points_per_cell),
        Axis::WaterBulkModulus => format!("K_w = {:e} Pa", record.case.material.water_bulk_modulus),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, study_of};
    use crate::case::planned::Tier;
    use crate::judge::paths::StudyPaths;
    use oedometer_convergence::{Floor, Undefined};

    /// Series of methods with the floors and the finest orders that are given.
    fn summaries<'a, const N: usize>(
        records: &'a [Record],
        given: [(Option<f64>, f64); N],
    ) -> Vec<SeriesSummary<'a>> {
        let paths = StudyPaths::of(records);
        let measure = first_measure(Quantity::Pressure, Sample::Points, "terzaghi", 0.2);
        let summary = |(path, (floor, order)): (&Path<'a>, (Option<f64>, f64))| {
            let mut summary = path.summary(&measure);
            summary.classification.floor =
                floor.map(|value| Floor { value, fitted: true, limits_from: 0.25, limiter: None });
            summary.finest = Ok::<f64, Undefined>(order);
            summary
        };
        paths.along(Axis::Cells).iter().zip(given).map(summary).collect()
    }

    #[test]
    fn a_floor_is_that_of_the_only_series_with_one_or_of_all_that_have_about_the_same() {
        let records = records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\n\
             method = ['MPM', 'GIMP', 'GIMP-SRI']\nintegrator = ['implicit']\ncells = [2, 4]\n",
        );
        let labels = ["a", "b", "c"].map(str::to_owned);
        let floors = |floors: &[Option<f64>; 3], shown: usize| {
            let all = summaries(&records, floors.map(|floor| (floor, 1.0)));
            assert_eq!(all.len(), 3);
            shared_floor(&all[..shown], &labels[..shown])
        };
        let floor = |[a, b]: [Option<f64>; 2]| floors(&[a, b, None], 2);
        assert_eq!(floor([None, None]), None);
        assert_eq!(floor([None, Some(0.3)]), Some((0.3, "b".to_owned())));
        let (both, name) = floor([Some(0.4), Some(0.42)]).expect("about the same");
        assert!((both - 0.168_f64.sqrt()).abs() < 1e-15 && name == "all series", "{both} {name}");
        assert_eq!(floor([Some(0.4), Some(0.8)]), None);
        assert_eq!(floor([Some(0.8), Some(0.4)]), None);
        let alike = [Some(0.42), Some(0.4), Some(0.41)];
        assert_eq!(floors(&alike, 3).expect("about the same").1, "all series");
        for place in 0..3 {
            let with = |floor: Option<f64>, rest: [Option<f64>; 3]| {
                let mut all = rest;
                all[place] = floor;
                floors(&all, 3)
            };
            assert_eq!(with(None, alike), None, "two of three are neither one nor all: {place}");
            assert_eq!(with(Some(0.8), alike), None, "{place}");
            assert_eq!(with(Some(0.1), alike), None, "{place}");
            assert_eq!(with(Some(0.3), [None; 3]), Some((0.3, labels[place].clone())));
        }

        let triangles = |orders: [f64; 2]| {
            let mut chart = Chart::new("c", ChartAxis::log10("h"), ChartAxis::log10("e"));
            add_triangles(&mut chart, &summaries(&records, orders.map(|order| (None, order))), &labels);
            chart.triangles.iter().map(|one| (one.slope, one.beside.clone())).collect::<Vec<_>>()
        };
        assert_eq!(triangles([0.2, 3.0]), []);
        assert_eq!(triangles([2.1, 0.9]), [(1.0, "b".to_owned()), (2.0, "a".to_owned())]);
        assert_eq!(triangles([1.8, 1.9]), [(2.0, "a".to_owned())], "the first of several");
    }

    #[test]
    fn the_middle_of_the_times_that_all_paths_have_is_shown_and_levels_have_the_names_of_their_axis() {
        let of = |times: &str, sweep: &str| records_of(&text_of(times, sweep));
        let shown = |times: [&str; 2]| {
            let records = times.map(|times| of(times, "cells = [2, 4]")).concat();
            let paths: Vec<Path<'_>> = records
                .chunks(2)
                .map(|own| Path { axis: Axis::Cells, records: own.iter().collect(), smaller_step: None })
                .collect();
            shown_time(&paths)
        };
        for (times, middle) in [
            (["[0.1]"; 2], Some(0.1)),
            (["[0.1, 0.2]"; 2], Some(0.1)),
            (["[0.1, 0.2, 0.3]"; 2], Some(0.2)),
            (["[0.1, 0.2, 0.3, 0.4]"; 2], Some(0.2)),
            (["[0.1, 0.2, 0.3]", "[0.2, 0.3, 0.4]"], Some(0.2)),
            (["[0.1, 0.2, 0.3]", "[0.3, 0.4]"], Some(0.3)),
            (["[0.1]", "[0.2]"], None),
        ] {
            assert_eq!(shown(times), middle, "{times:?}");
        }
        assert_eq!(shown_time(&[]), None);
        for (axis, sweep, names) in [
            (Axis::Cells, "cells = [2, 4, 8]", ["2", "4", "8"]),
            (Axis::PointsPerCell, "cells = [2]\npoints_per_cell = [1, 2, 3]", ["m = 1", "m = 2", "m = 3"]),
            (
                Axis::TimeStep,
                "cells = [2]\ntime_step = [{ seconds = 0.2 }, { seconds = 0.1 }, { seconds = 0.05 }]",
                ["Δt = 0.2 s", "Δt = 0.1 s", "Δt = 0.05 s"],
            ),
        ] {
            let records = of("[0.1]", sweep);
            let paths = StudyPaths::of(&records);
            let shorter =
                Path { axis, records: paths.along(axis)[0].records[..2].to_vec(), smaller_step: None };
            let both = [shorter, paths.along(axis)[0].clone()];
            let found: Vec<String> =
                levels_of(&both, axis).iter().map(|(_, record)| level_name(record, axis)).collect();
            assert_eq!(found, names);
            let study = study_of("s", &text_of("[0.1]", sweep));
            let results = StudyResults::new(&study, &records, Tier::Full);
            // Along the points of a cell the error ends in that of the mesh: there is no order and no class.
            let Some(Block::Table(table)) =
                blocks(&results, axis).into_iter().find(|one| matches!(one, Block::Table(_)))
            else {
                panic!("{axis:?}")
            };
            let has = |header: &str| table.columns.iter().any(|column| column.header == header);
            let has_orders = axis != Axis::PointsPerCell;
            assert_eq!((has("class"), has("order of the finest 3")), (has_orders, has_orders), "{axis:?}");
        }
        assert!(!shows_orders(Axis::TimeStep, "terzaghi") && shows_orders(Axis::TimeStep, NEXT_FINER));
        assert!(shows_orders(Axis::Cells, "terzaghi") && !shows_orders(Axis::PointsPerCell, NEXT_FINER));
    }

    fn text_of(times: &str, sweep: &str) -> String {
        format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = {times}\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\n{sweep}\n"
        )
    }
}
