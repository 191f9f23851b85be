//! Where is the pressure wrong? Pressure fields of a plane layer beside the exact one.

use crate::case::Quantity;
use crate::judge::study_results::StudyResults;
use crate::measure::fields::PlaneField;
use crate::questions::finding::{Finding, Place, Question};
use crate::record::{Record, Status};
use crate::render::chart::{Chart, ChartAxis, ColourField, Size};
use crate::render::number;
use crate::render::page::{Block, Figure, slug};
use oedometer_exact::ExactError;

/// Where is the pressure wrong?
pub static FIELDS: Question = Question {
    id: "fields",
    heading: "Where is the pressure wrong?",
    template: include_str!("fields.md"),
    places: &[Place::Study],
    ask,
};

/// Every number and name of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Cells over the height.
    cells: usize,
    /// Poisson's ratio of the skeleton.
    poissons_ratio: f64,
    /// Time factor of the first output.
    time_factor: f64,
    /// Method whose pressure oscillates least.
    least: String,
    /// Its oscillation index: total variation over the exact one's, minus one.
    least_index: f64,
    /// Method whose pressure oscillates most.
    most: String,
    /// Its oscillation index.
    most_index: f64,
}

/// Cells over the height of the runs whose fields are drawn.
const SHOWN_CELLS: usize = 8;

/// Reach of the colours over the largest exact value.
const REACH: f64 = 1.25;

/// The exact field of a layer, and of the runs that oscillate least and most.
fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    let [one] = studies else { return Ok(None) };
    let scene = one.study.scene;
    if !scene.body.is_plane() || !scene.measures(Quantity::Pressure) || one.study.is_race {
        return Ok(None);
    }
    let mut fields: Vec<(f64, PlaneField, &Record)> = Vec::new();
    for record in shown_records(one.records) {
        if let Some(field) = PlaneField::of(record, record.case.time_factors[0])? {
            fields.push((field.oscillation_index(), field, record));
        }
    }
    fields.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(least), Some(most)) = (fields.first(), fields.last()) else { return Ok(None) };
    let name = |field: &(f64, PlaneField, &Record)| field.2.case.method.to_string();
    let case = &least.2.case;
    let facts = Facts {
        cells: SHOWN_CELLS,
        poissons_ratio: case.material.poissons_ratio,
        time_factor: case.time_factors[0],
        least: name(least),
        least_index: least.0,
        most: name(most),
        most_index: most.0,
    };
    let mut figures = vec![figure("Exact", &least.1, &least.1.exact, None)];
    figures.push(figure(&name(least), &least.1, &least.1.computed, Some(least.0)));
    if fields.len() > 1 {
        figures.push(figure(&name(most), &most.1, &most.1.computed, Some(most.0)));
    }
    Ok(Some(FIELDS.answer([one.study.name.as_str()], &facts).with(Block::Figures(figures))))
}

/// A field in the colours of the exact one, which reach a little beyond its values.
fn figure(name: &str, field: &PlaneField, values: &[f64], oscillation: Option<f64>) -> Figure {
    let reach = REACH * largest_size(&field.exact);
    let height = ChartAxis::linear("height above the base y/H (–)");
    let mut chart = Chart::new(name, ChartAxis::linear("x/H (–)"), height);
    chart.field = Some(ColourField {
        label: "p/q (–)".to_owned(),
        reach: Some(reach),
        x_edges: field.x_edges.clone(),
        y_edges: field.y_edges.clone(),
        values: values.to_vec(),
    });
    chart.size = Size { width: 380.0, plot_height: 240.0, equal_units: true };
    let largest = largest_size(values);
    let beyond = if largest > reach {
        format!(" Values reach {}, beyond the common scale.", number::number(largest))
    } else {
        String::new()
    };
    let caption = match oscillation {
        None => "Theory. All these fields share one scale.".to_owned(),
        Some(index) => format!("{name}: oscillation index {}.{beyond}", number::fixed(index, 2)),
    };
    Figure::new(slug(&format!("field-{name}")), chart, caption)
}

fn largest_size(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, f64::max)
}

/// The first sound run of each method on the shown mesh, in the undisturbed soil.
fn shown_records(records: &[Record]) -> Vec<&Record> {
    let mut shown: Vec<&Record> = Vec::new();
    for record in records {
        let case = &record.case;
        if case.cells == SHOWN_CELLS
            && record.status == Status::Ok
            && case.has_usual_compressibility()
            && shown.iter().all(|other| other.case.method != case.method)
        {
            shown.push(record);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::planned::Tier;

    #[test]
    fn fields_share_the_reach_of_the_exact_one_and_say_what_lies_beyond() {
        let text = "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\n\
                    method = ['GIMP-SRI', 'GIMP']\nintegrator = ['implicit']\ncells = [4, 8]\npoints_per_cell = [2, 3]\n\
                    time_step = [{ growth = 0.5 }]\n[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [8]\n\
                    poissons_ratio = [0.3]\ntime_step = [{ growth = 0.5 }]\n";
        let (study, records) = solved("s", text);
        let shown: Vec<_> = shown_records(&records)
            .iter()
            .map(|record| (record.case.method.to_string(), record.case.cells, record.case.points_per_cell))
            .collect();
        let first = [("GIMP-SRI".to_owned(), 8, 2), ("GIMP".to_owned(), 8, 2)];
        assert_eq!(shown, first, "the first run of each");
        let found =
            ask(&[StudyResults::new(&study, &records, Tier::Full)]).expect("theory").expect("a layer");
        let told = found.sentence().expect("a sentence");
        assert!(told.starts_with("At T_v = 0.1, on 8 cells and with ν = 0.25, the pressure of `"), "{told}");
        let [Block::Figures(figures)] = &found.parts[..] else { panic!("{found:?}") };
        let [least, most] = ["least", "most"].map(|end| slug(found.facts[end].as_str().expect("a method")));
        let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
        assert_eq!(names, ["field-exact".to_owned(), format!("field-{least}"), format!("field-{most}")]);
        assert!(found.facts["least_index"].as_f64() < found.facts["most_index"].as_f64());
        // The largest exact value is 2, so that the colours reach to 2.5.
        let field = PlaneField {
            columns: 2,
            x_edges: vec![0.0, 0.5, 1.0],
            y_edges: vec![0.0, 1.0],
            computed: vec![-2.6, 1.0],
            exact: vec![-2.0, 1.0],
        };
        let beyond = figure("GIMP", &field, &field.computed, Some(0.456));
        let caption = "GIMP: oscillation index 0.46. Values reach 2.6, beyond the common scale.";
        assert_eq!(beyond.caption, caption);
        assert_eq!(figure("GIMP", &field, &[2.5, -1.0], Some(1.0)).caption, "GIMP: oscillation index 1.00.");
        let of = |figure: &Figure| {
            let field = figure.chart.field.as_ref().expect("a field");
            (field.reach, field.values.clone(), figure.chart.size.width)
        };
        assert_eq!(of(&beyond), (Some(2.5), field.computed.clone(), 380.0));
        assert_eq!(of(&figure("Exact", &field, &field.exact, None)), (Some(2.5), field.exact.clone(), 380.0));
    }
}
