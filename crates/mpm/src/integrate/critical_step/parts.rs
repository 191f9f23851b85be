//! Parts of a step operator that do not mix. Where a body is its own mirror image, motions that are even across its middle
//! stay so, and odd ones too: two operators of half the size, whose powers cost a quarter.

use crate::integrate::assembled::step::Image;
use nalgebra::DMatrix;

/// Share of the largest entry by which a mirrored operator may differ from itself: round-off.
const ROUND_OFF: f64 = 1e-12;

/// The even and the odd part of an operator by the images of its unknowns; the whole where it is no image of itself.
pub(super) fn parts(operator: DMatrix<f64>, images: &[Image]) -> Vec<DMatrix<f64>> {
    if images.len() != operator.nrows() || !is_mirrored(&operator, images) {
        return vec![operator];
    }
    vec![part(&operator, images, 1.0), part(&operator, images, -1.0)]
}

fn is_mirrored(operator: &DMatrix<f64>, images: &[Image]) -> bool {
    let most = ROUND_OFF * operator.amax();
    operator.column_iter().zip(images).all(|(column, (image, column_sign))| {
        let mirrored = operator.column(*image);
        column.iter().zip(images).all(|(entry, (row, sign))| {
            // A NaN is no image of itself.
            (entry - sign * column_sign * mirrored[*row]).abs() <= most
        })
    })
}

/// The operator on unknowns whose images are `parity` times themselves, by the first of each pair; an unknown that is its own
/// image is in one part alone.
fn part(operator: &DMatrix<f64>, images: &[Image], parity: f64) -> DMatrix<f64> {
    let is_kept = |unknown: &usize| {
        let (image, sign) = images[*unknown];
        *unknown < image || *unknown == image && sign == parity
    };
    let kept: Vec<usize> = (0..images.len()).filter(is_kept).collect();
    DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
        let (row, column) = (kept[i], kept[j]);
        let (image, sign) = images[column];
        let alone = operator[(row, column)];
        if image == column { alone } else { alone + parity * sign * operator[(row, image)] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::assembled::step::AssembledStep;
    use crate::kernel::body::Body;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_problem::settings::ExplicitSettings;
    use oedometer_scenes::COSINE_LAYER;
    use oedometer_scenes::column::Column;
    use oedometer_soil::material::Material;

    /// Five unknowns: two pairs, and one in the middle that turns its sign.
    const IMAGES: [Image; 5] = [(1, 1.0), (0, 1.0), (4, -1.0), (3, -1.0), (2, -1.0)];

    /// Any operator, and its mean with its image.
    fn operators() -> [DMatrix<f64>; 2] {
        let any = DMatrix::from_fn(5, 5, |i, j| (1.7 * i as f64 + 0.6 * (j * j) as f64).sin());
        let mirrored = DMatrix::from_fn(5, 5, |i, j| {
            let ((row, row_sign), (column, column_sign)) = (IMAGES[i], IMAGES[j]);
            0.5 * (any[(i, j)] + row_sign * column_sign * any[(row, column)])
        });
        [any, mirrored]
    }

    #[test]
    fn the_parts_of_a_mirrored_operator_have_its_spectrum() {
        let [_, mirrored] = operators();
        let parts = parts(mirrored.clone(), &IMAGES);
        assert_eq!(parts.iter().map(DMatrix::nrows).collect::<Vec<_>>(), [2, 3]);
        let radius = |operator: &DMatrix<f64>| {
            operator.complex_eigenvalues().iter().map(|value| value.re.hypot(value.im)).fold(0.0, f64::max)
        };
        let largest = parts.iter().map(radius).fold(0.0, f64::max);
        assert!((largest / radius(&mirrored) - 1.0).abs() < 1e-12, "{largest}");
        let trace: f64 = parts.iter().map(DMatrix::trace).sum();
        assert!((trace - mirrored.trace()).abs() < 1e-14);
    }

    #[test]
    fn the_step_of_a_layer_falls_into_an_even_and_an_odd_part() {
        let method = Method::named("GC-SRI-patch").expect("a known method");
        let problem =
            column_problem::<2>(&COSINE_LAYER, &Column::layer(), &Material::default(), method, 4, 2);
        let step = AssembledStep::new(&Body::new(problem.expect("a layer")));
        let sizes = |images: &[Image]| -> Vec<usize> {
            let operator = step.operator(1e-5, &ExplicitSettings::default());
            parts(operator, images).iter().map(DMatrix::nrows).collect()
        };
        let images = step.images();
        let of_parts = sizes(&images);
        assert!(of_parts.len() == 2 && of_parts.iter().sum::<usize>() == step.unknowns(), "{of_parts:?}");
        // Motions along the layer turn their sign in a mirror.
        let unturned: Vec<Image> = images.iter().map(|(image, _)| (*image, 1.0)).collect();
        assert_eq!(sizes(&unturned), [step.unknowns()]);
    }

    #[test]
    fn an_operator_that_is_no_image_of_itself_stays_whole() {
        let [any, mirrored] = operators();
        assert_eq!(parts(any.clone(), &IMAGES), [any]);
        assert_eq!(parts(mirrored.clone(), &[]), [mirrored]);
    }
}
