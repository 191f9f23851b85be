//! Small multiples: a figure with more series than colours becomes panels with one scale. Each panel has a few series in
//! colour, over the others in grey.

use crate::case::grouping::{distinct, grouped};
use crate::render::chart::draw::ends;
use crate::render::chart::svg::Px;
use crate::render::chart::{Chart, Series, Style};
use crate::render::palette::slots;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Most series of a panel besides theory: as many as there are colours that a colour-blind reader tells apart.
const MOST_SERIES: usize = 7;

/// Width of a panel, px: two stand side by side.
const PANEL_WIDTH: f64 = 450.0;

/// Columns of panels and their width, where there is room.
pub(super) const SIDE_BY_SIDE: (usize, f64) = (2, PANEL_WIDTH);

impl Chart {
    /// The panels of a figure with more series than colours; empty if one plot serves.
    pub(super) fn panels(&self) -> Vec<Self> {
        let counted = || self.series.iter().filter(|series| is_counted(series));
        let names = distinct(counted().map(|series| series.name.as_str()));
        let slots: Option<BTreeSet<usize>> = counted().map(|series| series.slot).collect();
        let colours = slots.map_or(names.len(), |slots| slots.len());
        if colours <= MOST_SERIES {
            return Vec::new();
        }
        let shown = by_method(&names);
        let panel = |(number, names_shown): (usize, &Vec<&str>)| self.panel(&names, names_shown, number);
        shown.iter().enumerate().map(panel).collect()
    }

    fn panel(&self, names: &[&str], shown: &[&str], number: usize) -> Self {
        let (x, y) = ends(self);
        let is_shown = |name: &str| shown.contains(&name);
        let context = self
            .series
            .iter()
            .filter(|series| is_counted(series) && series.style != Style::Markers && !is_shown(&series.name));
        let grey = |series: &Series| Series::new("", series.points.clone()).style(Style::Context);
        let coloured = self.series.iter().filter(|series| !is_counted(series) || is_shown(&series.name));
        let slots = slots(names);
        let placed = |series: &Series| {
            let place = names.iter().position(|name| *name == series.name);
            Series { slot: series.slot.or(place.map(|place| slots[place])), ..series.clone() }
        };
        let series: Vec<Series> = context.map(grey).chain(coloured.map(placed)).collect();
        let mut panel = self.clone();
        panel.series = series;
        // The statement stands once, above the first; the others say whose lines they colour.
        if number > 0 {
            panel.title = methods_in_words(shown);
        }
        panel.x = panel.x.between(x.low, x.high);
        panel.y = panel.y.between(y.low, y.high);
        panel.size.width = PANEL_WIDTH;
        panel
    }
}

/// The method that a label begins with.
fn method_of(name: &str) -> &str {
    name.split_once(", ").map_or(name, |(method, _)| method)
}

/// The methods of a panel, the first and the last of more than two.
fn methods_in_words(names: &[&str]) -> String {
    match distinct(names.iter().map(|name| method_of(name)))[..] {
        [one] => one.to_owned(),
        [one, other] => format!("{one} and {other}"),
        [first, .., last] => format!("{first} to {last}"),
        [] => String::new(),
    }
}

/// Names in panels of nearly the same number. The series of a method stay together, unless they alone are too many.
fn by_method<'a>(names: &[&'a str]) -> Vec<Vec<&'a str>> {
    let fair = names.len().div_ceil(names.len().div_ceil(MOST_SERIES));
    let groups = grouped(names.iter().copied(), |name| method_of(name));
    let mut panels: Vec<Vec<&str>> = Vec::new();
    for part in groups.iter().flat_map(|(_, names)| names.chunks(MOST_SERIES)) {
        match panels.last_mut() {
            Some(panel) if panel.len() + part.len() <= fair => panel.extend(part),
            _ => panels.push(part.to_vec()),
        }
    }
    panels
}

/// Whether a series takes a colour: theory is dark, and what has no name has no entry in the legend.
fn is_counted(series: &Series) -> bool {
    !matches!(series.style, Style::Theory | Style::Context) && !series.name.is_empty()
}

/// Panels side by side in columns of a width, row by row: the size of the whole and its elements.
pub(super) fn side_by_side(panels: &[(Px, String)], (columns, wide): (usize, f64)) -> (Px, String) {
    let (mut elements, mut top) = (String::new(), 0.0);
    for row in panels.chunks(columns) {
        for (place, ((width, height), panel)) in row.iter().enumerate() {
            let [x, y, w, h] = [place as f64 * wide, top, *width, *height].map(|px| px * 10.0);
            let _ = write!(
                elements,
                "<svg x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n{panel}</svg>\n"
            );
        }
        top += row.iter().map(|((_, height), _)| *height).fold(0.0, f64::max);
    }
    ((wide * columns.min(panels.len()) as f64, top), elements)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::chart::ChartAxis;

    fn chart(series: usize) -> Chart {
        let mut chart = Chart::new("E", ChartAxis::log10("h"), ChartAxis::log10("e"))
            .with(Series::theory("exact", vec![(0.1, 1.0), (1.0, 2.0)]));
        for place in 0..series {
            let error = 10.0 * (place + 1) as f64;
            chart =
                chart.with(Series::new(format!("method {place}"), vec![(0.1, error), (1.0, 2.0 * error)]));
        }
        chart
    }

    #[test]
    fn as_many_series_as_colours_stay_in_one_plot() {
        assert!(chart(MOST_SERIES).panels().is_empty());
        assert_eq!(chart(MOST_SERIES + 1).panels().len(), 2);
    }

    #[test]
    fn every_series_is_coloured_in_one_panel_and_grey_in_the_others_on_one_scale() {
        let whole = chart(15);
        let panels = whole.panels();
        assert_eq!(panels.len(), 3);
        for panel in &panels {
            assert_eq!((panel.x.range, panel.y.range), (panels[0].x.range, panels[0].y.range));
            let count = |style| panel.series.iter().filter(|series| series.style == style).count();
            assert_eq!(
                (count(Style::Theory), count(Style::Context), count(Style::LineAndMarkers)),
                (1, 10, 5)
            );
        }
        let mut names: Vec<_> =
            panels.iter().flat_map(|panel| &panel.series).filter(|one| is_counted(one)).collect();
        names.dedup_by_key(|series| &series.name);
        assert_eq!(names.len(), 15);
        let part = |height: f64, text: &str| ((450.0, height), text.to_owned());
        let (size, drawn) =
            side_by_side(&[part(300.0, "a"), part(320.0, "b"), part(310.0, "c")], SIDE_BY_SIDE);
        assert_eq!(size, (900.0, 630.0), "two in a row, each row as high as its highest");
        let places: Vec<&str> =
            drawn.lines().filter(|line| line.starts_with("<svg")).map(|line| &line[5..20]).collect();
        assert_eq!(places, ["x=\"0\" y=\"0\" wid", "x=\"4500\" y=\"0\" ", "x=\"0\" y=\"3200\" "]);
        assert_eq!(side_by_side(&[part(300.0, "a")], SIDE_BY_SIDE).0, (450.0, 300.0));
        let svg = whole.svg().expect("it is drawn");
        let titles: Vec<&str> = panels.iter().map(|panel| panel.title.as_str()).collect();
        assert_eq!(titles, ["E", "method 5 to method 9", "method 10 to method 14"]);
        assert!(svg.contains("<title>method 0</title>") && svg.contains("<title>method 14</title>"));
    }

    #[test]
    fn the_series_of_a_method_share_a_panel_and_series_of_few_colours_share_a_plot() {
        let names = ["A, 1", "A, 2", "A, 3", "A, 4", "B, 1", "B, 2", "C", "D"];
        assert_eq!(by_method(&names), [names[..4].to_vec(), names[4..].to_vec()]);
        let many: Vec<String> = (0..9).map(|one| format!("A, {one}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let panels = by_method(&many);
        assert_eq!(panels.iter().map(Vec::len).collect::<Vec<_>>(), [7, 2]);
        let mut whole = chart(0);
        whole.series.extend(many.iter().map(|name| Series::new(*name, vec![(0.1, 1.0)])));
        assert_eq!(whole.panels()[1].title, "A");
        for (place, series) in whole.series.iter_mut().enumerate() {
            series.slot = Some(place % 3);
        }
        assert_eq!(whole.panels().len(), 0);
    }
}
