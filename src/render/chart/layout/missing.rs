//! What a chart could not show, in words.
use crate::render::chart::canvas::Px;
use crate::render::chart::describe::{Chart, Series, Style};
use crate::render::chart::layout::clip::PixelFrame;
use crate::render::chart::layout::scale::{Reason, Ruler};
use std::collections::BTreeMap;

/// The places of the points of each series, and what is to be said about those without one.
pub(crate) struct PlacedNote {
    pub points: Vec<Vec<Option<Px>>>,
    pub notes: Vec<String>,
}

/// How many points are lost for each reason, and to which series.
type Lost<'a> = BTreeMap<Reason, (usize, Vec<&'a str>)>;

/// Puts every point of every series in its place.
pub(crate) fn place(chart: &Chart, x: &Ruler, y: &Ruler, frame: &PixelFrame) -> PlacedNote {
    let mut lost = Lost::new();
    let mut lose = |reason: Reason, name| {
        let (count, names) = lost.entry(reason).or_default();
        *count += 1;
        if !names.contains(&name) {
            names.push(name);
        }
    };
    let mut points = Vec::new();
    for series in &chart.series {
        let has_markers = matches!(series.style, Style::Markers | Style::LineAndMarkers);
        let mut places = Vec::new();
        for &(a, b) in &series.points {
            let place = match (x.px(a), y.px(b)) {
                (Ok(px), Ok(py)) => {
                    if has_markers && !frame.grown(0.5).holds((px, py)) {
                        lose(Reason::Outside, series.name.as_str());
                    }
                    Some((px, py))
                }
                (Err(reason), _) | (_, Err(reason)) => {
                    lose(reason, series.name.as_str());
                    None
                }
            };
            places.push(place);
        }
        points.push(places);
    }
    let mut notes = sentence(&lost).into_iter().collect::<Vec<_>>();
    notes.extend(without_data(chart));
    notes.extend(chart.field.as_ref().and_then(|field| match (field.shape(), field.missing()) {
        (None, _) => Some("The field's edges and values do not belong together.".to_owned()),
        (_, 0) => None,
        (_, 1) => Some("1 cell without a value is grey.".to_owned()),
        (_, n) => Some(format!("{n} cells without a value are grey.")),
    }));
    PlacedNote { points, notes }
}

/// One sentence on the series that have no points at all, where others have.
fn without_data(chart: &Chart) -> Option<String> {
    let mut names: Vec<&str> = Vec::new();
    for series in &chart.series {
        let has_data = |other: &&Series| other.name == series.name && !other.points.is_empty();
        if !series.name.is_empty()
            && !chart.series.iter().any(|other| has_data(&other))
            && !names.contains(&series.name.as_str())
        {
            names.push(&series.name);
        }
    }
    let some = chart.series.iter().any(|series| !series.points.is_empty());
    (some && !names.is_empty()).then(|| format!("Without data here: {}.", names.join(", ")))
}

fn sentence(lost: &Lost<'_>) -> Option<String> {
    let total: usize = lost.values().map(|(n, _)| n).sum();
    let reasons: Vec<String> = lost
        .iter()
        .map(|(reason, (n, names))| {
            let named: Vec<&str> = names.iter().copied().filter(|n| !n.is_empty()).collect();
            let more = if named.len() > 3 { ", …" } else { "" };
            let who = named.iter().take(3).copied().collect::<Vec<_>>().join(", ");
            if who.is_empty() {
                format!("{n} {}", reason.words())
            } else {
                format!("{n} {} ({who}{more})", reason.words())
            }
        })
        .collect();
    let values = if total == 1 { "value" } else { "values" };
    (total > 0).then(|| format!("{total} {values} not drawn: {}.", reasons.join("; ")))
}
