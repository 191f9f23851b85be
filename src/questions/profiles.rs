//! How does the pressure fall? Isochrones of the pore pressure and the degree of consolidation of a column beside theory's.

use crate::case::grouping::grouped;
use crate::case::quantity::{Quantity, Sample};
use crate::judge::paths::{first_error, first_measure};
use crate::judge::study_results::StudyResults;
use crate::measure::statistics::largest;
use crate::measure::theory::{
    TheoryIsochrone, computed_consolidation, computed_isochrone, theory_consolidation, theory_isochrones,
};
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::published_equations::QUOTED_CELLS;
use crate::questions::words;
use crate::record::{Record, Status};
use crate::render::chart::{Chart, ChartAxis, Series, Size, Style};
use crate::render::number;
use crate::render::page::{Block, Figure, slug};
use crate::study::expectation::Axis;
use oedometer_exact::ExactError;
use oedometer_exact::reference::ReferenceKind;
use oedometer_scenes::scene::{Clock, Question as SceneQuestion};

/// How does the pressure fall?
pub static PROFILES: Question = Question {
    id: "profiles",
    heading: "How does the pressure dissipate?",
    template: include_str!("profiles.md"),
    places: &[Place::Study],
    ask,
};

/// Every number and name of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Cells over the height of all runs that are shown.
    cells: usize,
    /// Number of their methods.
    methods: usize,
    /// Their names; the first and the last have isochrones.
    shown: Vec<String>,
}

/// Points per cell of the runs whose profiles are drawn: the first of these that a study has.
const SHOWN_POINTS: [usize; 2] = [2, 4];

/// Of the runs of a study on the paper's mesh, one per method; nothing of one method alone, of a plane or of a race.
fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    let [one] = studies else { return Ok(None) };
    let scene = one.study.scene;
    let shown = shown_records(one.records, scene.question == SceneQuestion::Layers);
    if shown.len() < 2 || scene.body.is_plane() || one.study.is_race {
        return Ok(None);
    }
    let own = one.study.references[0];
    // The first and the last method of the study: the plainest and the paper's.
    let ends = shown.first().into_iter().chain(shown.last());
    let mut figures = ends.map(|record| isochrones(record, own)).collect::<Result<Vec<_>, _>>()?;
    for (figure, record) in figures.iter_mut().zip([shown[0], shown[shown.len() - 1]]) {
        figure.caption += &too_coarse(record, one.records, own).unwrap_or_default();
    }
    // Neither a half-space nor a free wave has a settlement in the end.
    let has_end = scene.clock != Clock::HalfSpace && (scene.is_loaded() || !scene.waves);
    if has_end && !coincide(own, &shown) {
        figures.push(consolidation(&shown, own)?);
    }
    let (cells, methods) = (shown[0].case.cells, shown.len());
    let shown = shown.iter().map(|record| record.case.method.to_string()).collect();
    let facts = Facts { cells, methods, shown };
    Ok(Some(PROFILES.answer([one.study.name.as_str()], &facts).with(Block::Figures(figures))))
}

/// Time factor of an isochrone, with the degree of consolidation where large strains make that the measure of progress.
fn isochrone_name(is_large_strain: bool, theory: &TheoryIsochrone) -> String {
    if is_large_strain {
        format!("T_v = {:.3}, U = {}", theory.time_factor, number::rounded_percent(theory.degree))
    } else {
        format!("T_v = {}", number::time_factor(theory.time_factor))
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

/// Time factors that have a colour of their own in every figure.
const COLOURED: [f64; 8] = [0.01, 0.06, 0.1, 0.2, 0.45, 0.85, 1.0, 2.0];

/// The colours of time factors: that of the nearest coloured one by its ratio, or the next that is free.
fn slots_of_times(times: &[f64]) -> Vec<usize> {
    let distance = |time: f64, place: usize| {
        let ratio = time.max(f64::MIN_POSITIVE) / COLOURED[place];
        ratio.max(1.0 / ratio)
    };
    let mut slots: Vec<usize> = Vec::new();
    for time in times {
        let free = (0..COLOURED.len()).filter(|place| !slots.contains(place));
        let nearest = free.min_by(|a, b| distance(*time, *a).total_cmp(&distance(*time, *b)));
        slots.push(nearest.unwrap_or(slots.len()));
    }
    slots
}

/// The paper's Figs 3a and 4a: `p/q` against depth, at every output or a few from the first to the last.
///
/// # Errors
/// When the reference refuses the case.
pub fn isochrones(record: &Record, own: ReferenceKind) -> Result<Figure, ExactError> {
    let case = &record.case;
    let (method, has_waves) = (case.method.to_string(), case.scene.waves);
    let pressure = ChartAxis::linear("excess pore pressure p/q (–)");
    let off = largest_error(record, Quantity::Pressure, record.main_sample(), own.name());
    let mut chart = Chart::new(
        words::capitalised(&off_theory("pressure", &method, off)),
        if has_waves { pressure } else { pressure.between(0.0, 1.05) },
        ChartAxis::linear(depth_name(own.name())).between(0.0, 1.0).inverted(),
    );
    chart.size = Size::PANEL;
    let reference = words::theory(own.name());
    let shown = few(theory_isochrones(case, own)?);
    let slots = slots_of_times(&shown.iter().map(|theory| theory.time_factor).collect::<Vec<_>>());
    for (place, (slot, theory)) in slots.into_iter().zip(shown).enumerate() {
        let name = isochrone_name(case.scene.is_large_strain(), &theory);
        let computed = computed_isochrone(record, theory.time_factor);
        chart.series.push(if has_waves {
            // Lines of waves cross: each has the colour of its time.
            let name = if place == 0 { reference.as_str() } else { "" };
            Series::new(name, theory.line).style(Style::Line).slot(slot)
        } else {
            Series::theory(reference.as_str(), theory.line).slot(0)
        });
        chart.series.push(Series::new(name, computed).style(Style::Markers).slot(slot));
    }
    let sample = if case.has_integrator() { "material points" } else { record.main_sample().name() };
    let colours = if has_waves { ", in the colour of its time" } else { "" };
    let caption = format!("Markers: {sample} of {method} on {} cells. Lines: theory{colours}.", case.cells);
    Ok(Figure::new(slug(&format!("isochrones-{method}")), chart, caption))
}

/// The end of an axis of degrees of consolidation: all of it, or the tenth beyond all that is drawn, so that an early part fills
/// the figure.
fn end_of_axis(all: &[Series]) -> f64 {
    let degrees = all.iter().flat_map(|series| &series.points).map(|(_, degree)| *degree);
    ((10.0 * degrees.fold(0.0, f64::max)).floor() + 1.0).clamp(1.0, 10.0) / 10.0
}

/// The paper's Figs 3b and 4b: degree of consolidation by settlement against the time factor.
///
/// # Errors
/// When the reference refuses a case.
pub fn consolidation(shown: &[&Record], own: ReferenceKind) -> Result<Figure, ExactError> {
    let ends = shown.iter().filter_map(|record| record.case.time_factors.last());
    let end = ends.copied().reduce(f64::max).unwrap_or(1.0);
    let line = theory_consolidation(&shown[0].case, own, end)?;
    let title = consolidation_title(shown, &line);
    let theory = Series::theory(words::theory(own.name()), line);
    let run = |(slot, record): (usize, &&Record)| {
        let points = thinned(&computed_consolidation(record), slot, shown.len());
        Series::new(record.case.method.to_string(), points).style(Style::Markers)
    };
    let series: Vec<Series> = std::iter::once(theory).chain(shown.iter().enumerate().map(run)).collect();
    let degree = ChartAxis::linear("degree of consolidation by settlement U (–)");
    let mut chart = Chart::new(
        title,
        ChartAxis::log10("time factor T_v (–)"),
        degree.between(0.0, end_of_axis(&series)).inverted(),
    );
    chart.size = Size::PANEL;
    chart.series = series;
    Ok(Figure::new("consolidation", chart, "Settlement over its final value."))
}

/// How far a result is from theory at the output where it is farthest.
pub fn off_theory(what: &str, method: &str, found: Option<(f64, f64)>) -> String {
    found.map_or(format!("{what} of {method} beside theory"), |(error, time)| {
        format!(
            "{what} of {method} is up to {} off, at T_v = {}",
            number::percent(error),
            number::time_factor(time)
        )
    })
}

/// How far the curve of the method that is nearest to a line of theory is from it, and that of the farthest.
pub fn consolidation_title(shown: &[&Record], theory: &[(f64, f64)]) -> String {
    let name = |record: &Record| record.case.method.to_string();
    let mut ranked: Vec<(&Record, (f64, f64))> =
        shown.iter().filter_map(|record| Some((*record, largest_distance(record, theory)?))).collect();
    ranked.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
    let Some((nearest, (distance, time))) = ranked.first() else {
        return "Settlement beside theory".to_owned();
    };
    let distance = number::significant(*distance, 2);
    let nearest =
        format!("U of {} is up to {distance} off, at T_v = {}", name(nearest), number::time_factor(*time));
    let farthest = ranked.last().filter(|_| ranked.len() > 1);
    let farthest = farthest.map(|(record, (distance, _))| {
        format!("; of {} up to {}", name(record), number::significant(*distance, 2))
    });
    nearest + &farthest.unwrap_or_default()
}

/// The largest distance of a run's degrees of consolidation from a line of theory over its times, and its time factor.
fn largest_distance(record: &Record, theory: &[(f64, f64)]) -> Option<(f64, f64)> {
    let off = |(time, degree): (f64, f64)| {
        let after = theory.iter().position(|(at, _)| *at >= time)?;
        let ((start, low), (end, high)) = (theory[after.saturating_sub(1)], theory[after]);
        let share = if end > start { (time - start) / (end - start) } else { 0.0 };
        Some(((degree - low - share * (high - low)).abs(), time)).filter(|_| time >= start)
    };
    let distances = computed_consolidation(record).into_iter().filter_map(off);
    distances.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// The largest error over all outputs, and its time factor.
pub fn largest_error(
    record: &Record,
    quantity: Quantity,
    sample: Sample,
    reference: &str,
) -> Option<(f64, f64)> {
    let error = |time: &f64| Some(first_error(record, quantity, sample, reference, *time)?.abs());
    let errors = record.case.time_factors.iter().filter_map(|time| Some((error(time)?, *time)));
    errors.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Error of a pressure beyond which a figure says that a finer mesh has less.
const COARSE: f64 = 0.1;

/// That the mesh of a figure is too coarse, and how far off the finest of the same runs is; `None` where it is not.
fn too_coarse(record: &Record, records: &[Record], own: ReferenceKind) -> Option<String> {
    let off = |record: &Record| largest_error(record, Quantity::Pressure, record.main_sample(), own.name());
    let shared = |record: &Record| Axis::Cells.what_is_shared(&record.case);
    let is_alike = |one: &&Record| one.status == Status::Ok && shared(one) == shared(record);
    let finest = records.iter().filter(is_alike).max_by_key(|one| one.case.cells)?;
    let ((off, _), (least, _)) = (off(record)?, off(finest)?);
    (off > COARSE && least < off / 2.0).then(|| {
        let [cells, finest] = [record, finest].map(|record| record.case.cells);
        format!(
            " {cells} cells are too few here: on {finest} the pressure is up to {} off.",
            number::percent(least)
        )
    })
}

/// Relative difference up to which settlements share one marker.
const ONE_MARKER: f64 = 0.01;

/// Whether the settlements of all runs coincide at every output, so that their curves show no difference.
fn coincide(own: ReferenceKind, shown: &[&Record]) -> bool {
    shown[0].case.time_factors.iter().all(|time| {
        let measure = first_measure(Quantity::Settlement, Sample::Surface, own.name(), *time);
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
    let runs = records.iter().filter(is_shown);
    grouped(runs, |record| record.case.method.to_string()).into_iter().map(|(_, own)| own[0]).collect()
}

/// Most isochrones of a figure: as many as a reader tells apart.
const MOST_CURVES: usize = 6;

/// A few of many items, evenly spread, with the first and the last.
fn few<T>(items: Vec<T>) -> Vec<T> {
    let last = items.len().saturating_sub(1);
    let kept: Vec<usize> = (0..MOST_CURVES).map(|place| (place * last).div_ceil(MOST_CURVES - 1)).collect();
    let is_kept = |place: usize| last < MOST_CURVES || kept.contains(&place);
    items.into_iter().enumerate().filter(|(place, _)| is_kept(*place)).map(|(_, item)| item).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;

    const TIMES: [f64; 3] = [0.05, 0.1, 0.2];

    #[test]
    fn a_time_has_the_same_colour_in_every_figure() {
        assert_eq!(slots_of_times(&[0.05, 0.1, 0.2, 0.5, 1.0]), [1, 2, 3, 4, 6]);
        assert_eq!(slots_of_times(&[0.00785, 0.0707, 0.197, 0.403, 0.848, 1.0]), [0, 1, 3, 4, 5, 6]);
        let crowded = slots_of_times(&[0.1; 9]);
        assert_eq!(crowded.iter().collect::<std::collections::BTreeSet<_>>().len(), 9, "{crowded:?}");
    }

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
            let results = [StudyResults::new(&study, &records, Tier::Full)];
            let shown = shown_records(&records, false);
            assert_eq!(shown.len(), 3);
            let found = ask(&results).expect("theory").expect("three methods");
            let [Block::Figures(figures)] = &found.parts[..] else { panic!("{found:?}") };
            let answer = coincide(study.references[0], &shown);
            assert_eq!(figures.len(), if answer { 2 } else { 3 }, "the figure shows the difference");
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
    fn six_isochrones_of_many_are_shown_with_the_first_and_the_last() {
        let shown = |count: usize| few((0..count).collect());
        assert_eq!(shown(6), [0, 1, 2, 3, 4, 5]);
        assert_eq!(shown(7), [0, 2, 3, 4, 5, 6]);
        assert_eq!(shown(12), [0, 3, 5, 7, 9, 11]);
        assert_eq!([shown(0), shown(1)], [vec![], vec![0]]);
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
    fn the_first_sound_run_of_each_method_is_shown_on_ten_cells_or_the_coarsest() {
        let of = |methods: &str, more: &str| {
            solved(
                "t",
                &format!(
                    "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = {methods}\n\
                     integrator = ['implicit']\ncells = [5, 10]\ntime_step = [{{ growth = 0.5 }}]\n{more}\n"
                ),
            )
        };
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
    }

    #[test]
    fn an_axis_of_consolidation_ends_beyond_all_that_it_shows() {
        let end = |theory: f64, run: f64| {
            let theory = Series::new("theory", vec![(0.01, 0.5 * theory), (0.1, theory)]);
            end_of_axis(&[theory, Series::new("GIMP", vec![(0.1, run)])])
        };
        assert_eq!([end(0.02, 0.01), end(0.12, 0.21), end(0.34, 0.3), end(0.97, 0.9)], [0.1, 0.3, 0.4, 1.0]);
    }

    #[test]
    fn the_first_and_the_last_method_have_their_isochrones_and_one_method_has_none() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.4]\n[[sweep]]\n\
                    method = ['GC-SRI-patch', 'GIMP-SRI', 'MPM']\nintegrator = ['implicit']\ncells = [10]\n\
                    time_step = [{ growth = 0.5 }]\n";
        let (study, records) = solved("t", text);
        let found =
            |records: &[Record]| ask(&[StudyResults::new(&study, records, Tier::Full)]).expect("theory");
        let answer = found(&records).expect("three methods");
        assert_eq!(
            answer.sentence().expect("a sentence"),
            "Pressure over depth on 10 cells, compared with theory, for 3 methods: `GC-SRI-patch`, `GIMP-SRI`, `MPM`."
        );
        let [Block::Figures(figures)] = &answer.parts[..] else { panic!("{answer:?}") };
        let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
        assert_eq!(names[..2], ["isochrones-gc-sri-patch", "isochrones-mpm"]);
        assert_eq!(
            figures[0].caption,
            "Markers: material points of GC-SRI-patch on 10 cells. Lines: theory."
        );
        assert_eq!(found(&records[..1]), None);
        assert_eq!(depth_name("mandel"), "distance from the drained side (a − x)/a (–)");
        assert_eq!(depth_name("terzaghi"), "depth below the surface (H − Y)/H (–)");
    }
}
