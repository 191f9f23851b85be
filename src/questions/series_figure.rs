//! One error of several methods over an axis of refinement as a figure: a line per path, guides of the orders that lines come near, and the
//! floor that they share.

use crate::case::Sample;
use crate::case::grouping::{distinct, grouped};
use crate::questions::series::{Measured, Series, SeriesTable};
use crate::questions::words;
use crate::render::chart::{self, Chart, ChartAxis, Rule, Size};
use crate::render::number;
use crate::render::page::Figure;
use crate::study::expectation::{Axis, NEXT_FINER};
use oedometer_convergence::Class;
use oedometer_soil::elementary;
use oedometer_wording::count_of;

/// Slopes of guides, of first and of second order, with the numbers of their dashes.
const SLOPES: [(f64, usize); 2] = [(1.0, 2), (2.0, 3)];
/// Distance of an order from a slope up to which its line has a guide.
const NEAR: f64 = 0.3;
/// Where a guide begins, over the error on the finest level: below its line.
const BELOW: f64 = 0.5;
/// Floors within this factor are one line in a figure.
const SAME_FLOOR: f64 = 1.1;
/// Most lines of a figure with several soils, and with one.
const MOST_LINES: [usize; 2] = [14, 60];

/// A figure per error of a table, side by side; none where no path has three levels.
pub fn figures(found: &SeriesTable<'_>) -> Vec<Figure> {
    let asked = found.series.iter().map(|one| one.measured);
    let asked: Vec<Measured> = distinct(asked.filter(|(_, sample)| *sample != Sample::Nodes));
    asked.into_iter().filter_map(|measured| figure(found, measured)).collect()
}

/// One error of all paths over an axis.
pub fn figure(found: &SeriesTable<'_>, measured: Measured) -> Option<Figure> {
    let (quantity, sample) = measured;
    // The nodes of another program stand beside the points of this one.
    let is_of = |one: &&Series<'_>| {
        let is_elsewhere = sample == Sample::Points && one.measured.1 == Sample::Nodes;
        one.measured == measured || is_elsewhere && one.measured.0 == quantity
    };
    let all: Vec<&Series<'_>> =
        found.series.iter().filter(is_of).filter(|one| points_of(one).len() > 1).collect();
    let lines = drawn(&all);
    if lines.is_empty() || lines.iter().all(|one| one.errors.len() < 3) {
        return None;
    }
    let names: Vec<String> = lines.iter().map(|one| name_of(one, sample)).collect();
    let ticks = words::ticks(lines.iter().flat_map(|one| points_of(one)).map(|point| point.0));
    let mut chart = Chart::new(
        title_of(found, &words::measured(quantity, sample), &lines, &names),
        ChartAxis::log10(words::axis(found.axis)).with_ticks(ticks),
        ChartAxis::log10(words::error_axis(quantity)),
    );
    let reference = if found.axis == Axis::TimeStep { NEXT_FINER } else { found.reference };
    chart.subtitle = Some(format!(
        "T_v = {}, against {}{}",
        number::time_factor(found.time_factor),
        words::solution(reference),
        words::subtitle_end(&found.shared)
    ));
    chart.size = Size::PANEL;
    chart
        .series
        .extend(lines.iter().zip(&names).map(|(one, name)| chart::Series::new(name.clone(), points_of(one))));
    if found.has_orders() {
        let guides = near(&lines).into_iter();
        chart.series.extend(guides.filter_map(|(slope, dashes, line)| guide(lines[line], slope, dashes)));
    }
    let floor = shared_floor(&lines).filter(|_| found.axis == Axis::Cells);
    chart.rules.extend(floor.map(|(at, line)| {
        let whose = line.map_or("all series", |line| &names[line]);
        let cause = found.model_difference.map_or_else(String::new, |cause| format!(": {cause}"));
        Rule { at, label: format!("plateau of {whose}{cause}") }
    }));
    let caption = match all.len() - lines.len() {
        0 => String::new(),
        more => format!("{} of other soils in the table.", count_of(more, "more series", "more series")),
    };
    let name = format!("{}-{}-{}", found.axis.name(), quantity.name(), sample.name());
    Some(Figure::new(crate::render::page::slug(&name), chart, caption))
}

/// What the lines show: over the mesh which ends with the least error, over the step which is of the highest order. An order
/// that has not settled, or of what does not converge, is no finding.
fn title_of(found: &SeriesTable<'_>, measured: &str, lines: &[&Series<'_>], names: &[String]) -> String {
    let order = |one: &Series<'_>| {
        one.order().filter(|_| found.has_orders() && one.class().is_none_or(Class::is_settled))
    };
    let of_step = found.axis == Axis::TimeStep;
    let ranked = lines.iter().zip(names).filter_map(|(one, name)| {
        let error = one.ends()?[1].1.abs();
        let order = order(one);
        let rank = if of_step { -order? } else { error };
        let order = order.map(|order| format!("order {}", number::order(order)));
        let off = (!of_step).then(|| format!("{} at the end", number::percent(error)));
        Some((rank, name, [order, off].into_iter().flatten().collect::<Vec<_>>().join(", ")))
    });
    let ranked: Vec<_> = ranked.collect();
    let Some((_, _, end)) = ranked.iter().reduce(|a, b| if b.0 < a.0 { b } else { a }) else {
        return format!("Error of the {measured}");
    };
    // Those that the digits do not tell apart share the place.
    let best: Vec<_> = ranked.iter().filter(|one| one.2 == *end).map(|one| one.1).collect();
    let who = match best[..] {
        _ if lines.len() == 1 => String::new(),
        [name] => format!("{name} is best, "),
        [name, ..] => format!("{name} and {} are best, ", count_of(best.len() - 1, "other", "others")),
        [] => unreachable!("the best is among them"),
    };
    format!("{}: {who}{end}", words::capitalised(measured))
}

/// Sizes of the levels with their finite errors: over the step with the differences between neighbouring steps.
fn points_of(one: &Series<'_>) -> Vec<(f64, f64)> {
    let finite = |error: Option<f64>| error.filter(|error| error.is_finite());
    let levels = one.summary.series.levels().iter();
    levels.filter_map(|level| Some((level.size, finite(level.error)?))).collect()
}

/// All series; if they are too many, those of the undisturbed soil, or else of the first soil.
fn drawn<'s, 'a>(all: &[&'s Series<'a>]) -> Vec<&'s Series<'a>> {
    let [most, most_of_a_soil] = MOST_LINES;
    if all.len() <= most {
        return all.to_vec();
    }
    let variant = |one: &Series<'_>| one.summary.path.records[0].case.variant();
    let soils = grouped(all.iter().copied(), |one| variant(one));
    let plain = soils.iter().find(|(soil, _)| soil.is_empty()).or(soils.first());
    let mut lines = plain.map_or(Vec::new(), |(_, lines)| lines.clone());
    lines.truncate(most_of_a_soil);
    lines
}

/// The label of a line, with the places of its errors where they are not those of the figure.
fn name_of(one: &Series<'_>, sample: Sample) -> String {
    if one.measured.1 == sample {
        one.label.clone()
    } else {
        format!("{}, {}", one.label, words::sample(one.measured.1))
    }
}

/// The slopes with the first line that comes near each, and the dashes of its guide.
fn near(lines: &[&Series<'_>]) -> Vec<(f64, usize, usize)> {
    let is_near = |one: &Series<'_>, slope: f64| {
        one.summary.finest.as_ref().is_ok_and(|order| (order - slope).abs() < NEAR)
    };
    let line = |slope: f64| lines.iter().position(|one| is_near(one, slope));
    SLOPES.into_iter().filter_map(|(slope, dashes)| Some((slope, dashes, line(slope)?))).collect()
}

/// A guide below a line, from its finest level to its coarsest.
fn guide(one: &Series<'_>, slope: f64, dashes: usize) -> Option<chart::Series> {
    let points = points_of(one);
    let ((coarse, _), (fine, error)) = (*points.first()?, *points.last()?);
    let start = BELOW * error;
    let end = start * elementary::powf(coarse / fine, slope);
    Some(chart::Series::theory(format!("order {slope}"), vec![(fine, start), (coarse, end)]).slot(dashes))
}

/// The floor that a figure shows as one line, and its owner: the only limited series, or all series where they end
/// within a tenth of each other. Other floors are in the table.
fn shared_floor(lines: &[&Series<'_>]) -> Option<(f64, Option<usize>)> {
    let floor = |one: &Series<'_>| Some(one.summary.classification.floor.as_ref()?.value);
    let floors: Vec<(f64, usize)> =
        lines.iter().enumerate().filter_map(|(place, one)| Some((floor(one)?, place))).collect();
    let (lowest, highest) = floors
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), (floor, _)| (low.min(*floor), high.max(*floor)));
    match floors.as_slice() {
        [(only, place)] => Some((*only, Some(*place))),
        [_, _, ..] if floors.len() == lines.len() && highest <= SAME_FLOOR * lowest => {
            Some(((lowest * highest).sqrt(), None))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, study_of};
    use crate::case::planned::Tier;
    use crate::judge::study_results::StudyResults;
    use oedometer_convergence::Floor;

    fn text_of(methods: &str, rest: &str) -> String {
        format!(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.2]\n[[sweep]]\nmethod = [{methods}]\n\
             integrator = ['implicit']\ncells = [2, 4, 8]\n{rest}"
        )
    }

    /// What a look makes of the pressures of three methods with the floors and the finest orders that are given.
    fn of<T>(given: [(Option<f64>, f64); 3], shown: usize, look: impl Fn(&[&Series<'_>]) -> T) -> T {
        let text = text_of("'MPM', 'GIMP', 'GIMP-SRI'", "");
        let (study, records) = (study_of("s", &text), records_of(&text));
        let results = StudyResults::new(&study, &records, Tier::Full);
        let mut found = SeriesTable::new(&results, Axis::Cells).expect("three methods");
        found.series.retain(|one| one.measured.1 == Sample::Points && one.measured.0.name() == "pressure");
        for (one, (floor, order)) in found.series.iter_mut().zip(given) {
            one.summary.classification.floor =
                floor.map(|value| Floor { value, fitted: true, limits_from: 0.25, limiter: None });
            one.summary.finest = Ok(order);
        }
        let lines: Vec<&Series<'_>> = found.series.iter().take(shown).collect();
        look(&lines)
    }

    #[test]
    fn a_floor_is_that_of_the_only_series_with_one_or_of_all_that_have_about_the_same() {
        let floors = |floors: [Option<f64>; 3], shown: usize| {
            of(floors.map(|floor| (floor, 1.0)), shown, shared_floor)
        };
        let floor = |[a, b]: [Option<f64>; 2]| floors([a, b, None], 2);
        assert_eq!(floor([None, None]), None);
        assert_eq!(floor([None, Some(0.3)]), Some((0.3, Some(1))));
        let (both, line) = floor([Some(0.4), Some(0.42)]).expect("about the same");
        assert!((both - 0.168_f64.sqrt()).abs() < 1e-15 && line.is_none(), "{both} {line:?}");
        assert_eq!(floor([Some(0.4), Some(0.8)]), None);
        assert_eq!(floor([Some(0.8), Some(0.4)]), None);
        let alike = [Some(0.42), Some(0.4), Some(0.41)];
        assert_eq!(floors(alike, 3).expect("about the same").1, None);
        for place in 0..3 {
            let with = |floor: Option<f64>, mut all: [Option<f64>; 3]| {
                all[place] = floor;
                floors(all, 3)
            };
            assert_eq!(with(None, alike), None, "two of three are neither one nor all: {place}");
            assert_eq!(with(Some(0.8), alike), None, "{place}");
            assert_eq!(with(Some(0.1), alike), None, "{place}");
            assert_eq!(with(Some(0.3), [None; 3]), Some((0.3, Some(place))));
        }
        let near = |[a, b]: [f64; 2]| {
            of([a, b, 9.0].map(|order| (None, order)), 2, |lines| {
                super::near(lines).into_iter().map(|(slope, _, line)| (slope, line)).collect::<Vec<_>>()
            })
        };
        assert_eq!(near([0.2, 3.0]), []);
        assert_eq!(near([2.1, 0.9]), [(1.0, 1), (2.0, 0)]);
        assert_eq!(near([1.8, 1.9]), [(2.0, 0)], "the first of several");
    }

    #[test]
    fn a_figure_shows_all_paths_or_those_of_one_soil_and_counts_the_others() {
        let shown = |rest: &str| {
            let text = text_of("'MPM', 'GIMP'", rest);
            let (study, records) = (study_of("s", &text), records_of(&text));
            let results = StudyResults::new(&study, &records, Tier::Full);
            let found = SeriesTable::new(&results, Axis::Cells).expect("paths");
            let figure = &figures(&found)[0];
            let lines = figure.chart.series.iter().filter(|one| one.style != chart::Style::Theory);
            (lines.count(), figure.caption.clone())
        };
        assert_eq!(shown("porosity = [0.3, 0.4]\n").0, 4);
        let (lines, more) = shown("porosity = [0.3, 0.32, 0.34, 0.36, 0.38, 0.4, 0.42, 0.44]\n");
        assert_eq!((lines, more.as_str()), (2, "14 more series of other soils in the table."));
        let jitter = |count: usize| {
            let all = (0..count).map(|one| format!("0.{one:02}")).collect::<Vec<_>>().join(", ");
            shown(&format!("jitter = [{all}]\n")).0
        };
        assert_eq!([jitter(7), jitter(8)], [14, 2], "the plain points are drawn");
    }
}
