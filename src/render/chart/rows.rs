//! Dot plots with words: a row a problem, markers on a logarithmic scale, beside them why a series has none, and columns of
//! words at the right. On a narrow screen the words stand below the markers.

use crate::render::chart::looks::{FONT, Legend, Look, draw_marker, looks};
use crate::render::chart::svg::{Area, Drawn, Font, NARROW, Px, group, layer, line, stroke, write};
use crate::render::chart::{Chart, Series};
use crate::render::palette::{FRAME, GRID, QUIET, SCREEN};
use crate::render::script::width;
use oedometer_soil::elementary;
use plotters::style::text_anchor::HPos;

/// The rows of a dot plot, from the top: a point of a series lies in the row of its second number.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChartRows {
    /// Head of the words of series without a point.
    pub without: String,
    /// Heads of the columns at the right.
    pub heads: Vec<String>,
    /// The rows.
    pub rows: Vec<ChartRow>,
}

/// A row of a dot plot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChartRow {
    /// Its name.
    pub name: String,
    /// The letter of its family, whose rows stand together.
    pub family: String,
    /// Per series why it has no point, in a word.
    pub without: Vec<String>,
    /// Words at the right, one per head, or a single one that takes all of them; the first is strong.
    pub words: Vec<String>,
}

const STRONG: Font = Font { is_bold: true, ..FONT };
const SMALL: Font = Font { size: 10.5, ..FONT };
const ROW: f64 = 21.0;
const BETWEEN_FAMILIES: f64 = 6.0;
/// Height of the lines that say what stands below the markers.
const NARROW_HEADS: f64 = 32.0;
const RADIUS: f64 = 4.6;
/// Markers nearer than this share the height of their row.
const NEAR: f64 = 8.0;

/// Where the parts of a row lie, px.
struct Places {
    width: f64,
    /// Ends of the scale.
    scale: (f64, f64),
    /// Left edge and width of a column of words of the gutter.
    gutter: (f64, f64),
    /// Left edges of the columns at the right.
    columns: Vec<f64>,
}

const PAD: f64 = 8.0;

impl Places {
    fn wide(chart: &Chart, rows: &ChartRows) -> Self {
        // Letters of these words are narrower than those that widths are estimated for.
        let longest = |words: &mut dyn Iterator<Item = &str>, font: Font| {
            words.map(|word| 0.93 * font.size * width(word)).fold(0.0, f64::max)
        };
        let names = longest(&mut rows.rows.iter().map(|row| row.name.as_str()), FONT);
        let gutter =
            longest(&mut rows.rows.iter().flat_map(|row| row.without.iter().map(String::as_str)), SMALL)
                + 3.0;
        let whole = |row: &&ChartRow| row.words.len() == rows.heads.len();
        let column = |(place, head): (usize, &String)| {
            let words = rows.rows.iter().filter(whole).map(|row| row.words[place].as_str());
            longest(&mut words.chain([head.as_str()]), FONT) + 10.0
        };
        let columns: Vec<f64> = rows.heads.iter().enumerate().map(column).collect();
        let families = longest(&mut rows.rows.iter().map(|row| row.family.as_str()), STRONG);
        let left = PAD + families + 6.0 + names + 14.0;
        let at_right = chart.size.width - PAD - columns.iter().sum::<f64>();
        let first = at_right - 8.0 - gutter * chart.series.len() as f64;
        let places = columns.iter().scan(at_right, |at, width| {
            let place = *at;
            *at += width;
            Some(place)
        });
        Self {
            width: chart.size.width,
            scale: (left, (first - 14.0).max(left + 60.0)),
            gutter: (first, gutter),
            columns: places.collect(),
        }
    }

    fn narrow() -> Self {
        Self {
            width: NARROW,
            scale: (PAD + 8.0, NARROW - PAD - 16.0),
            gutter: (PAD, 0.0),
            columns: Vec::new(),
        }
    }

    /// The place of a value on the scale.
    fn x(&self, chart: &Chart, value: f64) -> f64 {
        let (low, high) = chart.x.range.unwrap_or((1.0, 100.0));
        let share = elementary::ln(value.clamp(low, high) / low) / elementary::ln(high / low);
        self.scale.0 + share * (self.scale.1 - self.scale.0)
    }
}

/// Size and elements of a dot plot; for a phone where it is narrow.
pub(super) fn elements(chart: &Chart, rows: &ChartRows, is_narrow: bool) -> Result<(Px, String), String> {
    let looks = looks(chart);
    let places = if is_narrow { Places::narrow() } else { Places::wide(chart, rows) };
    let legend = Legend::of(chart, &looks, |_| true, places.width - 2.0 * PAD);
    let head = legend.height() + if is_narrow { 34.0 + NARROW_HEADS } else { 40.0 };
    let tops = tops(rows, head, is_narrow);
    let bottom = tops.last().copied().unwrap_or(head);
    let size = (places.width, (bottom + PAD).ceil());
    let mut out = layer(size, |area| {
        area.fill(&SCREEN.light)?;
        heads(area, chart, rows, (&places, &looks), (head, bottom), is_narrow)
    })?;
    out += &legend.elements(size, (PAD, 4.0))?;
    for (place, row) in rows.rows.iter().enumerate() {
        let top = tops[place];
        let drawn = layer(size, |area| {
            let starts = place == 0 || rows.rows[place - 1].family != row.family;
            if starts {
                let at = top - if place == 0 { 0.0 } else { BETWEEN_FAMILIES / 2.0 };
                line(area, &[(PAD, at), (places.width - PAD, at)], stroke(FRAME.light, 0.7))?;
                if !is_narrow {
                    write(area, &row.family, (PAD, top + ROW / 2.0), STRONG, HPos::Left)?;
                }
            }
            if is_narrow {
                narrow_row(area, (chart, rows), (place, row), (&places, &looks), top)
            } else {
                wide_row(area, chart, (place, row), (&places, &looks), top)
            }
        })?;
        out += &group("", &description(chart, place, row), &drawn);
    }
    Ok((size, out))
}

/// The upper edge of each row, and the lower one of the last.
fn tops(rows: &ChartRows, head: f64, is_narrow: bool) -> Vec<f64> {
    let mut tops = vec![head];
    for (place, row) in rows.rows.iter().enumerate() {
        let ends = rows.rows.get(place + 1).is_some_and(|next| next.family != row.family);
        let lines = if is_narrow {
            3.0 + f64::from(u8::from(row.without.iter().any(|word| !word.is_empty())))
        } else {
            1.0
        };
        let height = if is_narrow { 17.0 * lines + 8.0 } else { ROW };
        tops.push(tops[place] + height + if ends { BETWEEN_FAMILIES } else { 0.0 });
    }
    tops
}

/// The words above the columns, and the scale with its lines.
fn heads(
    area: &Area<'_>,
    chart: &Chart,
    rows: &ChartRows,
    (places, looks): (&Places, &[Look]),
    (head, bottom): (f64, f64),
    is_narrow: bool,
) -> Drawn {
    let upper = head - if is_narrow { 24.0 } else { 28.0 };
    let left = if is_narrow { PAD } else { places.scale.0 };
    write(area, &chart.x.label, (left, upper), STRONG, HPos::Left)?;
    for (value, label) in chart.x.ticks.iter().flatten() {
        let x = places.x(chart, *value);
        line(area, &[(x, head), (x, bottom)], stroke(GRID.light, 1.0))?;
        let label = label.clone().unwrap_or_default();
        write(area, &label, (x, head - 8.0), Font { colour: QUIET.light, ..SMALL }, HPos::Center)?;
    }
    if is_narrow {
        let below = [
            format!("below each scale: {}", rows.heads.join(" · ")),
            format!("below that: {}", rows.without),
        ];
        for (words, y) in below.iter().zip([upper - 32.0, upper - 16.0]) {
            write(area, words, (PAD, y), SMALL, HPos::Left)?;
        }
        return Ok(());
    }
    write(area, &rows.without, (places.gutter.0, upper), STRONG, HPos::Left)?;
    for (place, look) in looks.iter().enumerate() {
        let at = (places.gutter.0 + (place as f64 + 0.5) * places.gutter.1, head - 9.0);
        draw_marker(area, at, look.marker.unwrap_or(place), RADIUS, look.colour)?;
    }
    for (head_words, x) in rows.heads.iter().zip(&places.columns) {
        write(area, head_words, (*x, head - 8.0), STRONG, HPos::Left)?;
    }
    Ok(())
}

fn wide_row(
    area: &Area<'_>,
    chart: &Chart,
    (place, row): (usize, &ChartRow),
    (places, looks): (&Places, &[Look]),
    top: f64,
) -> Drawn {
    let y = top + ROW / 2.0;
    write(area, &row.name, (places.scale.0 - 14.0, y), FONT, HPos::Right)?;
    line(area, &[(places.scale.0, y), (places.scale.1, y)], stroke(GRID.light, 0.8))?;
    markers(area, chart, (place, looks), places, y)?;
    for (series, (word, look)) in row.without.iter().zip(looks).enumerate() {
        let x = places.gutter.0 + (series as f64 + 0.5) * places.gutter.1;
        write(area, word, (x, y), Font { colour: look.colour, ..SMALL }, HPos::Center)?;
    }
    for (number, (word, x)) in row.words.iter().zip(&places.columns).enumerate() {
        write(area, word, (*x, y), if number == 0 { STRONG } else { FONT }, HPos::Left)?;
    }
    Ok(())
}

fn narrow_row(
    area: &Area<'_>,
    (chart, rows): (&Chart, &ChartRows),
    (place, row): (usize, &ChartRow),
    (places, looks): (&Places, &[Look]),
    top: f64,
) -> Drawn {
    let line_at = |number: f64| top + 4.0 + 17.0 * (number + 0.5);
    let name = format!("{} {}", row.family, row.name);
    write(area, name.trim_start(), (PAD, line_at(0.0)), STRONG, HPos::Left)?;
    line(area, &[(places.scale.0, line_at(1.0)), (places.scale.1, line_at(1.0))], stroke(GRID.light, 0.8))?;
    markers(area, chart, (place, looks), places, line_at(1.0))?;
    // A number has the head of its column behind it.
    let with_head = |(word, head): (&String, &String)| {
        if word.starts_with(|c: char| c.is_ascii_digit()) { format!("{word} {head}") } else { word.clone() }
    };
    let words = row.words.iter().zip(&rows.heads).map(with_head).collect::<Vec<_>>().join(" · ");
    write(area, &words, (PAD, line_at(2.0)), FONT, HPos::Left)?;
    let mut x = PAD + 5.0;
    for (series, (word, look)) in
        row.without.iter().zip(looks).enumerate().filter(|(_, (word, _))| !word.is_empty())
    {
        draw_marker(area, (x, line_at(3.0)), look.marker.unwrap_or(series), 3.8, look.colour)?;
        write(area, word, (x + 8.0, line_at(3.0)), Font { colour: look.colour, ..SMALL }, HPos::Left)?;
        x += 8.0 + SMALL.size * width(word) + 7.0;
    }
    Ok(())
}

/// The points of a row. Those that lie upon each other stand above and below its line.
fn markers(area: &Area<'_>, chart: &Chart, (row, looks): (usize, &[Look]), places: &Places, y: f64) -> Drawn {
    let in_row = |series: &Series| series.points.iter().find(|(_, at)| *at == row as f64).map(|(x, _)| *x);
    let found = chart.series.iter().zip(looks).enumerate();
    let mut found: Vec<(f64, usize, &Look)> = found
        .filter_map(|(place, (series, look))| {
            Some((places.x(chart, in_row(series)?), look.marker.unwrap_or(place), look))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut start = 0;
    while start < found.len() {
        let count = 1 + found[start..].windows(2).take_while(|pair| pair[1].0 - pair[0].0 < NEAR).count();
        let apart = [0.0, 0.0, 7.0, 5.2, 4.0, 3.2][count.min(5)];
        for (number, (x, slot, look)) in found[start..start + count].iter().enumerate() {
            let above = (number as f64 - 0.5 * (count - 1) as f64) * apart;
            draw_marker(area, (*x, y + above), *slot, if count > 1 { 3.9 } else { RADIUS }, look.colour)?;
        }
        start += count;
    }
    Ok(())
}

/// What a row says, for a pointer that rests on it and for those who cannot see it.
fn description(chart: &Chart, place: usize, row: &ChartRow) -> String {
    let series = chart.series.iter().enumerate().map(|(number, series)| {
        let at = series.points.iter().find(|(_, at)| *at == place as f64);
        let word = row.without.get(number).map_or("", String::as_str);
        let value = at
            .map_or_else(|| word.to_owned(), |(x, _)| format!("× {}", crate::render::number::two_digits(*x)));
        format!("{}: {value}", series.name.split(", ").next().unwrap_or_default())
    });
    format!("{}: {}. {}", row.name, row.words.join(", "), series.collect::<Vec<_>>().join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::chart::{ChartAxis, Style};

    fn chart() -> Chart {
        let mut chart = Chart::new(
            "no method is the cheapest everywhere",
            ChartAxis::log10("work over the least")
                .between(1.0, 100.0)
                .with_labelled_ticks([(1.0, "×1".to_owned())]),
            ChartAxis::linear(""),
        )
        .with(Series::new("MPM, 2 of 2", vec![(1.0, 0.0)]).style(Style::Markers))
        .with(Series::new("GIMP", vec![(1.0, 0.0), (50.0, 1.0)]).style(Style::Markers));
        let row = |name: &str, family: &str, without: [&str; 2], words: &[&str]| ChartRow {
            name: name.to_owned(),
            family: family.to_owned(),
            without: without.map(str::to_owned).to_vec(),
            words: words.iter().map(|word| (*word).to_owned()).collect(),
        };
        chart.rows = Some(ChartRows {
            without: "does not arrive".to_owned(),
            heads: vec!["cheapest".to_owned(), "cells".to_owned()],
            rows: vec![row("a", "F", ["", ""], &["MPM", "8"]), row("b", "G", ["locks", ""], &["none"])],
        });
        chart
    }

    #[test]
    fn a_row_has_its_markers_reasons_and_words_and_a_phone_has_them_below_each_other() {
        let (wide, narrow) =
            (chart().svg().expect("a figure"), chart().narrow_svg().expect("drawn").expect("narrow"));
        for svg in [&wide, &narrow] {
            for words in [">MPM, 2 of 2</text>", ">locks</text>", ">none</text>", "× 50"] {
                assert!(svg.contains(words), "{words}: {svg}");
            }
        }
        assert!(wide.contains(">b</text>") && wide.contains(">G</text>") && narrow.contains(">G b</text>"));
        assert!(wide.contains(">MPM</text>") && narrow.contains(">MPM · 8 cells</text>"), "{narrow}");
        assert!(narrow.contains(&format!("width=\"{NARROW}\"")), "{narrow}");
        for head in [">below each scale: cheapest · cells</text>", ">below that: does not arrive</text>"] {
            assert!(narrow.contains(head), "{head}: {narrow}");
        }
        // Two equal points stand above each other; a lone one lies on its line.
        let rows = chart().rows.expect("rows");
        let tops = tops(&rows, 0.0, false);
        assert_eq!(tops, [0.0, ROW + BETWEEN_FAMILIES, 2.0 * ROW + BETWEEN_FAMILIES]);
    }
}
