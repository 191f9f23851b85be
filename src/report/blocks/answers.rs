//! What a study answers by itself: its setting and what comes within a bound at the head of its page; settlements by date and
//! who locks as its first sections.

use crate::questions::finding::Place;
use crate::questions::findings::QuantityWithin;
use crate::questions::sentence;
use crate::questions::setting::SETTING;
use crate::questions::study_findings::StudyFindings;
use crate::render::RenderError;
use crate::render::page::Block;
use crate::report::sections;
use serde::Serialize;

/// Setting and answers as paragraphs; the race answers elsewhere.
///
/// # Errors
/// If a template cannot be filled.
pub fn lead(study: &StudyFindings) -> Result<String, RenderError> {
    let setting = study.plain.findings.iter().find(|finding| finding.question == &SETTING);
    let mut lead = match setting {
        Some(setting) => setting.sentence()? + "\n\n",
        None => String::new(),
    };
    lead += &within(&study.answers.within)?;
    Ok(lead + "\n\n")
}

/// What the template is filled with.
#[derive(Serialize)]
struct Quantities<'a> {
    quantities: &'a [QuantityWithin],
}

/// What it takes to come within a bound: lightly marked paragraphs, one per quantity.
///
/// # Errors
/// If the template cannot be filled.
pub fn within(quantities: &[QuantityWithin]) -> Result<String, RenderError> {
    sentence::sentence("within", &Quantities { quantities })
}

/// The answers of the study, each below its question.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let mut blocks = Vec::new();
    for finding in study.plain.findings.iter().filter(|finding| finding.question != &SETTING) {
        blocks.push(Block::Heading(finding.question.heading.to_owned()));
        blocks.extend(sections::blocks(finding, Place::Study)?);
    }
    Ok(blocks)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Quantity, Sample};
    use crate::questions::findings::within::{BoundWithin, WithinFinding};

    #[test]
    fn a_quantity_is_told_with_method_mesh_step_and_time_or_with_the_least_error() {
        let choice = |error: f64, largest_step: f64| WithinFinding {
            is_confirmed: true,
            method: "GC-SRI-patch".to_owned(),
            integrator: "implicit".to_owned(),
            cells: 10,
            points_per_cell: 2,
            step_rule: "growth=0.02".to_owned(),
            largest_step,
            is_longest_tried: false,
            error,
            time_factor: 0.152_190_825_688_073_4,
            seconds: 180.0 * 86400.0,
            cost: 1e-3,
            case: "abc".to_owned(),
        };
        let told = |bounds: [Option<f64>; 2], step: f64| {
            let bounds = [0.01, 0.001].into_iter().zip(bounds);
            let bounds = bounds.map(|(bound, error)| BoundWithin {
                bound,
                choice: error.map(|error| choice(error, step)),
                others: Vec::new(),
                integrators: Vec::new(),
            });
            let quantity = QuantityWithin {
                quantity: Quantity::Settlement,
                sample: Sample::Surface,
                reference: "terzaghi".to_owned(),
                problems: 1,
                bounds: bounds.collect(),
                best: choice(0.02, step),
                far: Vec::new(),
            };
            within(&[quantity]).expect("filled").trim().to_owned()
        };
        let within = "**Settlement** within 1 % at every output: `GC-SRI-patch`, implicit, 10 cells";
        let largest = "(largest 0.40 %, at T_v = 0.1522, 180 days)";
        assert_eq!(
            told([Some(0.004), None], 864_000.0),
            format!("{within}, steps of `growth=0.02` up to 10 days {largest}; no run reaches 0.1 %.")
        );
        assert_eq!(told([Some(0.004), None], 0.0), format!("{within} {largest}; no run reaches 0.1 %."));
        assert_eq!(
            told([None, None], 0.0),
            "**Settlement**: no run reaches 1 %. The smallest error is 2.00 %, of `GC-SRI-patch`, implicit, \
             on 10 cells."
        );
    }
}
