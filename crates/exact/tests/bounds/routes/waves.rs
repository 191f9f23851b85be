//! Columns with inertia: each mode's four equations by the matrix exponential.

use crate::double::{Complex, Double, Matrix, ONE, PI, c, d, exponential};
use crate::routes::{Biot, mobility, seconds};
use crate::{Compared, Numbers, solution};
use oedometer_exact::{ColumnParameters, ReferenceKind};

/// Coupling modulus `Q` and the propagator of a mode's `u`, `U_w` and their velocities over a time.
fn propagator(column: &ColumnParameters, wave: Double, time: Double) -> (Double, Matrix<4>) {
    let soil = &column.soil;
    let (n, modulus) = (d(soil.porosity), Biot::new(column).modulus);
    let coupling = d(soil.water_bulk_modulus) / n;
    let solid = ONE - n;
    let [heavy, light] = [solid * d(soil.grain_density), n * d(soil.water_density)];
    let drag = n * n / mobility(column);
    let square = wave * wave;
    let stiffness = [
        [square * (modulus + coupling * solid * solid), square * coupling * n * solid],
        [square * coupling * n * solid, square * coupling * n * n],
    ];
    // Velocities in units of displacement over the time: entries of one size.
    let mut matrix = [[Complex::default(); 4]; 4];
    matrix[0][2] = c(ONE);
    matrix[1][3] = c(ONE);
    for (row, mass) in [heavy, light].into_iter().enumerate() {
        for place in 0..2 {
            let sign = if row == place { ONE } else { -ONE };
            matrix[2 + row][place] = c(-(stiffness[row][place] / mass * time * time));
            matrix[2 + row][2 + place] = c(-(sign * drag / mass * time));
        }
    }
    (coupling, exponential(&matrix))
}

/// Displacements of both phases after a time.
fn after(propagator: &Matrix<4>, state: [Double; 4]) -> [Double; 2] {
    [0, 1].map(|row| (0..4).fold(d(0.0), |sum, k| sum + (propagator[row][k] * c(state[k])).re))
}

/// A time of a few swings, in which the exponential keeps its digits: the time factor.
fn swings(numbers: &mut Numbers, column: &ColumnParameters, wave: Double) -> f64 {
    let soil = &column.soil;
    let density = (1.0 - soil.porosity) * soil.grain_density + soil.porosity * soil.water_density;
    let speed = ((Biot::new(column).modulus.value() + soil.coupling_modulus()) / density).sqrt();
    column.time_factor(numbers.decades(-1.0, 1.5) / (speed * wave.value()))
}

pub fn released(kind: ReferenceKind, numbers: &mut Numbers, column: &ColumnParameters) -> Option<Compared> {
    let column = ColumnParameters { soil: permeable(numbers, column), ..*column };
    let (soil, biot) = (&column.soil, Biot::new(&column));
    let (n, load) = (d(soil.porosity), d(column.load));
    let wave = PI * d(0.5) / d(column.height);
    let time_factor = swings(numbers, &column, wave);
    let time = seconds(&column, time_factor);
    let (coupling, propagator) = propagator(&column, wave, time);
    let start = if kind == ReferenceKind::StandingWave {
        let together = -(load / (coupling * wave));
        [together, together, d(0.0), d(0.0)]
    } else {
        let solid = load / (biot.modulus * wave);
        let mixture = -(load / (coupling * wave));
        let discharge = wave * mobility(&column) * load;
        let falls = -(biot.diffusivity_ratio() * discharge);
        [solid, (mixture - (ONE - n) * solid) / n, falls * time, (falls + discharge / n) * time]
    };
    let [solid, water] = after(&propagator, start);
    let zeta = numbers.between(0.0, 1.0);
    let shape = (PI * d(0.5) * d(zeta)).sincos()[0];
    let pressure = -(coupling * wave * ((ONE - n) * solid + n * water) * shape) / load;
    let (reference, bound) = solution(kind, &column, time_factor);
    let computed = reference.fields(time_factor, zeta).expect("inside").pressure / column.load;
    let degree = reference.degree_of_consolidation(time_factor).expect("a time");
    let settled = (start[0] - solid) / start[0];
    let pairs = vec![("pressure", computed, pressure.value()), ("settlement", degree, settled.value())];
    Some(Compared { pairs, bound })
}

/// A soil in which waves run and die within some modes.
fn permeable(numbers: &mut Numbers, column: &ColumnParameters) -> oedometer_soil::material::Material {
    let mut soil = column.soil;
    let (n, coupling) = (soil.porosity, soil.coupling_modulus());
    let speed = (coupling / soil.grain_density).sqrt();
    // Drag per mass beside the frequency of the slowest wave.
    let ratio = numbers.decades(-0.5, 2.5);
    let unit_weight = soil.unit_weight_of_water();
    soil.hydraulic_conductivity = n * n * unit_weight / (ratio * speed / column.height * soil.grain_density);
    soil
}

pub fn loaded(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let column = ColumnParameters { soil: permeable(numbers, &column), ..column };
    let biot = Biot::new(&column);
    let (n, load, height) = (d(column.soil.porosity), d(column.load), d(column.height));
    // When the waves of high modes have died out.
    let time_factor = numbers.decades(-1.5, 0.3);
    let (reference, bound) = solution(ReferenceKind::DynamicColumn, &column, time_factor);
    let terms = reference.accuracy(time_factor).expect("a time").terms;
    if terms > 60 || bound > 1e-6 {
        return None;
    }
    let zeta = numbers.between(0.0, 1.0);
    let time = seconds(&column, time_factor);
    let (mut pressure, mut settled) = (d(0.0), ONE);
    for mode in 0..terms + 4 {
        let eigenvalue = d(mode as f64 + 0.5) * PI;
        let wave = eigenvalue / height;
        let sign = if mode % 2 == 0 { ONE } else { -ONE };
        let solid = load / biot.modulus * sign * d(2.0) / (height * wave * wave);
        let (coupling, propagator) = propagator(&column, wave, time);
        let [solid, water] = after(&propagator, [solid, -((ONE - n) / n * solid), d(0.0), d(0.0)]);
        let cosine = sign * (eigenvalue * d(zeta)).sincos()[0];
        pressure = pressure - coupling * wave * ((ONE - n) * solid + n * water) * cosine / load;
        settled = settled - sign * solid * biot.modulus / (load * height);
    }
    let computed = reference.fields(time_factor, zeta).expect("inside").pressure / column.load;
    let degree = reference.degree_of_consolidation(time_factor).expect("a time");
    let pairs = vec![("pressure", computed, pressure.value()), ("settlement", degree, settled.value())];
    Some(Compared { pairs, bound })
}
