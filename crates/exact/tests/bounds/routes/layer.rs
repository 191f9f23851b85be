//! The layer under a cosine load, as a two-point problem by the matrix exponential.

use crate::double::{Complex, Matrix, ONE, PI, c, d, exponential, inverse, solved};
use crate::routes::{Biot, mobility, seconds};
use crate::{Compared, Numbers, solution};
use oedometer_exact::{Base, ColumnParameters, ReferenceKind};

/// `u_x`, `u_z` (down), `p`, `τ`, `σ_zz` and the flux down, over `z/H`, each of the size of the load.
fn system(column: &ColumnParameters, soil: &Biot, s: Complex) -> Matrix<6> {
    let height = d(column.height);
    let wave = PI * height / d(column.length);
    let (lame, modulus, shear) = (soil.lame, soil.modulus, soil.shear);
    let scales = [height / modulus, height / modulus, ONE, ONE, ONE, mobility(column) / height];
    let mut a = [[Complex::default(); 6]; 6];
    let (b, storage) = (wave / height, soil.fixed);
    let slope =
        [c(-(lame * b / modulus)), c(d(0.0)), c(ONE / modulus), c(d(0.0)), c(ONE / modulus), c(d(0.0))];
    a[0][1] = c(b);
    a[0][3] = c(ONE / shear);
    a[2][5] = c(-(ONE / mobility(column)));
    a[4][3] = c(-b);
    for j in 0..6 {
        a[1][j] = slope[j];
        a[3][j] = c(b * lame) * slope[j];
        a[5][j] = -(s * slope[j]);
    }
    a[3][0] = a[3][0] + c(b * b * modulus);
    a[3][2] = a[3][2] - c(b);
    a[5][0] = a[5][0] - s * c(b);
    a[5][2] = a[5][2] - c(mobility(column) * b * b) - s * c(storage);
    for (i, row) in a.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = *entry * c(scales[j] / scales[i] * height);
        }
    }
    a
}

pub fn cosine_layer(
    kind: ReferenceKind,
    numbers: &mut Numbers,
    column: &ColumnParameters,
) -> Option<Compared> {
    let mut column = *column;
    // Not so short a wave, nor so early, that shooting through the layer loses its digits.
    column.length = column.height * numbers.decades(-0.3, 0.8);
    let soil =
        if kind == ReferenceKind::CosineLayer { Biot::new(&column) } else { Biot::incompressible(&column) };
    let time = (numbers.decades(-0.3, 1.3) / soil.diffusivity_ratio().value()).min(90.0);
    let zeta = if numbers.between(0.0, 1.0) < 0.3 { 0.0 } else { numbers.between(0.0, 1.0) };
    let shot = |s: Complex, depth: f64| {
        let matrix = system(&column, &soil, s);
        let propagator = exponential(&matrix);
        let part = exponential(&matrix.map(|row| row.map(|entry| entry * c(d(depth)))));
        // At the top p = τ = 0 and σ = −q; at the base u_z, the flux and u_x or τ are nothing.
        let (known, unknown) = ([0, 0, 0, 0, -1, 0].map(|value| c(d(f64::from(value)))), [0, 1, 5]);
        let rows = [1, 5, if column.base == Base::Rough { 0 } else { 3 }];
        let mut small = [[Complex::default(); 3]; 3];
        let mut right = [Complex::default(); 3];
        for (i, row) in rows.into_iter().enumerate() {
            for (j, place) in unknown.into_iter().enumerate() {
                small[i][j] = propagator[row][place];
            }
            right[i] = propagator[row][4];
        }
        let computed = solved(small, right);
        let mut state = known;
        for (place, value) in unknown.into_iter().zip(computed) {
            state[place] = value;
        }
        part.map(|row| (0..6).fold(Complex::default(), |sum, k| sum + row[k] * state[k]))
    };
    let second = inverse(seconds(&column, time), |s| {
        let at = shot(s, zeta);
        let top = shot(s, 0.0);
        [at[2] / s, (at[4] + at[2]) / s, top[1] / s]
    });
    let (reference, bound) = solution(kind, &column, time);
    let fields = reference.fields(time, zeta).expect("inside");
    let settled = reference.settlement(time).expect("a time");
    let end = reference.displacement_scale().expect("a layer");
    let scale = column.load * column.height / soil.modulus.value();
    let pairs = vec![
        ("pressure", fields.pressure / column.load, second[0]),
        ("stress", fields.effective_stress / column.load, second[1]),
        ("settlement", settled / end, second[2] * scale / end),
    ];
    Some(Compared { pairs, bound })
}
