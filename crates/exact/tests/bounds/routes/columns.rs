//! Columns: the transform of diffusion, and closed forms.

use crate::double::{Complex, Double, ONE, PI, ZERO, c, d, inverse};
use crate::routes::{Biot, mobility, seconds};
use crate::{Compared, Numbers, compared, solution};
use oedometer_exact::{ColumnParameters, ReferenceKind, TextbookProblem};
use oedometer_soil::layers::{SoilLayer, SoilLayers};

/// `W(ζ, T)` and `U(T)`.
fn diffused(zeta: f64, time: Double) -> [Double; 2] {
    inverse(time, |s| {
        let root = s.sqrt();
        let isochrone = (c(ONE) - root.cosh_ratio(ONE - d(zeta))) / s;
        [isochrone, root.tanh() / (root * s)]
    })
    .map(d)
}

/// A time factor and a depth; now and then a place on a face.
fn place(numbers: &mut Numbers) -> [f64; 2] {
    let zeta = numbers.between(-0.05, 1.05).clamp(0.0, 1.0);
    [numbers.decades(-5.0, 0.9), zeta]
}

/// A Biot coefficient, grains, or both.
pub fn with_grains(numbers: &mut Numbers, mut column: ColumnParameters) -> ColumnParameters {
    let soil = Biot::new(&column);
    let alpha = numbers.between(column.soil.porosity, 1.0);
    let choice = numbers.between(0.0, 3.0);
    if choice < 2.0 {
        column.textbook.biot_coefficient = Some(alpha);
    }
    if choice > 1.0 {
        column.textbook.grain_bulk_modulus =
            Some(soil.bulk.value() / (1.0 - alpha) * numbers.between(1.0, 3.0));
    }
    column
}

/// Terzaghi's column of any water and grains.
pub fn terzaghi(kind: ReferenceKind, numbers: &mut Numbers, column: &ColumnParameters) -> Option<Compared> {
    let [time, zeta] = place(numbers);
    let column = if kind == ReferenceKind::Textbook(TextbookProblem::BiotColumn) {
        with_grains(numbers, *column)
    } else {
        *column
    };
    let soil = if kind == ReferenceKind::TerzaghiIncompressible {
        Biot::incompressible(&column)
    } else {
        Biot::new(&column)
    };
    let [isochrone, degree] = diffused(zeta, soil.diffusivity_ratio() * d(time));
    let at_once = soil.fixed / soil.storage;
    let settled = at_once + (ONE - at_once) * degree;
    let pressure = soil.alpha * soil.diffusivity_ratio() * isochrone;
    Some(compared(kind, &column, [time, zeta], [pressure.value(), settled.value()]))
}

pub fn single_mode(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let [time, zeta] = place(numbers);
    let mode = PI * d(0.5);
    let decay = (-(mode * mode * Biot::new(&column).diffusivity_ratio() * d(time))).exp();
    let pressure = decay * (mode * d(zeta)).sincos()[0];
    Some(compared(
        ReferenceKind::SingleMode,
        &column,
        [time, zeta],
        [pressure.value(), (ONE - decay).value()],
    ))
}

/// Large strain of the log-linear soil in incompressible water.
pub fn xie_leo(kind: ReferenceKind, numbers: &mut Numbers, mut column: ColumnParameters) -> Option<Compared> {
    let modulus = Biot::new(&column).modulus;
    column.load = modulus.value() * -(-column.soil.porosity * numbers.between(0.02, 0.9)).ln_1p();
    let [time, zeta] = [numbers.decades(-3.0, 0.5), numbers.between(0.0, 1.0)];
    let [isochrone, degree] = diffused(zeta, d(time));
    let strain = d(column.load) / modulus;
    let pressure = (ONE + (strain.exp() - ONE) * isochrone).ln() / strain;
    Some(compared(kind, &column, [time, zeta], [pressure.value(), degree.value()]))
}

pub fn davis_raymond(numbers: &mut Numbers, mut column: ColumnParameters) -> Option<Compared> {
    let [time, zeta] = place(numbers);
    let initial = column.load * numbers.decades(-1.5, 1.5);
    column.textbook.initial_stress = Some(initial);
    let [isochrone, degree] = diffused(zeta, d(time));
    let (start, end) = (d(initial), d(initial) + d(column.load));
    let pressure = (end - end * (isochrone * (start / end).ln()).exp()) / d(column.load);
    let kind = ReferenceKind::Textbook(TextbookProblem::DavisRaymond);
    Some(compared(kind, &column, [time, zeta], [pressure.value(), degree.value()]))
}

pub fn seabed(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let mut column = with_grains(numbers, column);
    let [time, zeta] = [numbers.decades(-3.0, 0.5), numbers.between(0.0, 1.0)];
    let soil = Biot::new(&column);
    let period = seconds(&column, 1.0) * d(numbers.decades(-2.0, 1.0));
    column.textbook.wave_period = period.value();
    let turns = seconds(&column, 1.0) / d(column.textbook.wave_period);
    let root = Complex { re: ZERO, im: d(2.0) * PI * turns / soil.diffusivity_ratio() }.sqrt();
    let [sine, cosine] = (d(2.0) * PI * turns * d(time)).sincos();
    let turned = Complex { re: cosine, im: sine };
    let at_once = soil.alpha * soil.diffusivity_ratio();
    let pressure = (c(at_once) + c(ONE - at_once) * root.cosh_ratio(ONE - d(zeta))) * turned;
    let drained = c(soil.alpha * (ONE - at_once)) * root.tanh() / root;
    let settled = (c(ONE - soil.alpha * at_once) - drained) * turned;
    let kind = ReferenceKind::Textbook(TextbookProblem::Seabed);
    Some(compared(kind, &column, [time, zeta], [pressure.re.value(), settled.re.value()]))
}

pub fn sealed(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let [time, zeta] = place(numbers);
    let soil = Biot::new(&column);
    Some(compared(
        ReferenceKind::SealedElement,
        &column,
        [time, zeta],
        [soil.diffusivity_ratio().value(), 1.0],
    ))
}

/// Neumann's solution by its formulas, the front by regula falsi.
pub fn yield_front(numbers: &mut Numbers, mut column: ColumnParameters) -> Option<Compared> {
    let soil = Biot::new(&column);
    column.soil.reload_modulus = soil.modulus.value() * numbers.decades(0.05, 1.5);
    column.uniform_stress = column.load * numbers.between(0.0, 1.0);
    let reload = d(column.soil.reload_modulus);
    let of_water = d(column.soil.porosity) / d(column.soil.water_bulk_modulus);
    let storages = [ONE / soil.modulus + of_water, ONE / reload + of_water];
    let start = d(column.load) / (reload * storages[1]);
    let yields = start * d(numbers.between(0.05, 0.95));
    column.soil.preconsolidation = column.uniform_stress + column.load - yields.value();
    let yields = d(column.uniform_stress) + d(column.load) - d(column.soil.preconsolidation);
    let speeds = storages.map(|storage| (mobility(&column) / storage).sqrt());
    let flux = |a: Double| {
        let b = a * speeds[0] / speeds[1];
        let leaves = yields * (-(a * a)).exp() / (a.erf() * speeds[0]);
        (start - yields) * (-(b * b)).exp() / (b.erfc() * speeds[1]) - leaves
    };
    let (mut low, mut high) = (d(1e-6), d(4.0));
    if flux(high).value() < 0.0 || flux(low).value() > 0.0 {
        return None;
    }
    for _ in 0..110 {
        let middle = (low + high) * d(0.5);
        if flux(middle).value() < 0.0 { low = middle } else { high = middle }
    }
    let (a, b) = (low, low * speeds[0] / speeds[1]);
    // Times at which the base feels little.
    let reach = d(column.height) / (d(2.0) * speeds[1]);
    let root = reach / d(numbers.between(5.5, 40.0));
    let time_factor = column.time_factor((root * root).value());
    let root = seconds(&column, time_factor).sqrt();
    let zeta = numbers.between(0.0, 1.0) * numbers.between(0.0, 1.0);
    let depth = d(zeta) * d(column.height);
    let [first, second] = speeds.map(|speed| depth / (d(2.0) * speed * root));
    let pressure = if first.value() < a.value() {
        yields * first.erf() / a.erf()
    } else {
        start - (start - yields) * second.erfc() / b.erfc()
    };
    // What has left, less what the water gave back: ∫ (p_0 − p) from both sides of the front.
    let left = d(2.0) * mobility(&column) * yields * root / (a.erf() * PI.sqrt() * speeds[0]);
    let front = d(2.0) * a * speeds[0] * root;
    let risen = a * a.erf() - (ONE - (-(a * a)).exp()) / PI.sqrt();
    let above = start * front - yields * d(2.0) * speeds[0] * root * risen / a.erf();
    let tail = (-(b * b)).exp() / PI.sqrt() - b * b.erfc();
    let below = (start - yields) * d(2.0) * speeds[1] * root * tail / b.erfc();
    let height = d(column.height);
    let settled = (d(column.load) - start) / reload * height + left - of_water * (above + below);
    let end = ((d(column.load) - yields) / reload + yields / soil.modulus) * height;
    let ratios = [(pressure / d(column.load)).value(), (settled / end).value()];
    Some(compared(ReferenceKind::YieldFront, &column, [time_factor, zeta], ratios))
}

/// Layers from the base up that differ in every key.
fn layered_column(numbers: &mut Numbers, column: &ColumnParameters) -> ColumnParameters {
    let count = if numbers.between(0.0, 1.0) < 0.5 { 2 } else { 3 };
    let shares: Vec<f64> = (0..count).map(|_| numbers.between(0.3, 1.0)).collect();
    let sum: f64 = shares.iter().sum();
    let layers: Vec<SoilLayer> = shares
        .iter()
        .map(|share| SoilLayer {
            thickness: column.height * share / sum,
            youngs_modulus: Some(column.soil.youngs_modulus * numbers.decades(-1.0, 1.0)),
            poissons_ratio: Some(numbers.between(-0.2, 0.45)),
            porosity: Some(numbers.between(0.1, 0.7)),
            water_bulk_modulus: Some(column.soil.water_bulk_modulus * numbers.decades(-1.0, 1.0)),
            hydraulic_conductivity: Some(column.soil.hydraulic_conductivity * numbers.decades(-1.5, 1.5)),
        })
        .collect();
    ColumnParameters { soils: SoilLayers::from_slice(&layers).expect("a few"), ..*column }
}

/// The transform by shooting from the base, where no water flows.
pub fn layered(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let column = layered_column(numbers, &column);
    let soils: Vec<(Double, Biot, Double)> = column
        .soils
        .iter()
        .map(|layer| {
            let layer_column = ColumnParameters { soil: layer.soil(&column.soil), ..column };
            (d(layer.thickness), Biot::new(&layer_column), mobility(&layer_column))
        })
        .collect();
    let span = soils.iter().map(|(thick, soil, mobility)| *thick * (soil.storage / *mobility).sqrt());
    let span = span.fold(ZERO, |sum, part| sum + part).value();
    // Shooting loses what grows: from a time on, at which this is 1e10 at most.
    let second = span * span * numbers.decades(-0.9, 0.9);
    let time_factor = column.time_factor(second);
    let second = seconds(&column, time_factor);
    let zeta = numbers.between(0.0, 1.0);
    let height = (ONE - d(zeta)) * d(column.height);
    let [pressure, settled] = inverse(second, |s| {
        // Pressure and flux κ dP/dy as A times one solution and another.
        let (mut state, mut bottom) = ([[c(ONE), Complex::default()], [Complex::default(); 2]], ZERO);
        let (mut here, mut shortening) = ([Complex::default(); 2], [Complex::default(); 2]);
        for (thick, soil, mobility) in &soils {
            let start = c(soil.diffusivity_ratio()) / s;
            let number = (s * c(soil.storage / *mobility)).sqrt();
            let admittance = number * c(*mobility);
            let after = |state: [[Complex; 2]; 2], way: Double| {
                let grown = (number * c(way)).exp();
                let fallen = c(ONE) / grown;
                let (cosine, sine) = ((grown + fallen) * c(d(0.5)), (grown - fallen) * c(d(0.5)));
                let [mut homogeneous, particular] = state;
                let above = particular[0] - start;
                let step = |[pressure, flux]: [Complex; 2]| {
                    [
                        pressure * cosine + flux * sine / admittance,
                        pressure * admittance * sine + flux * cosine,
                    ]
                };
                homogeneous = step(homogeneous);
                let [pressure, flux] = step([above, particular[1]]);
                [homogeneous, [pressure + start, flux]]
            };
            let top = bottom + *thick;
            if height.value() > bottom.value() && height.value() <= top.value() {
                here = after(state, height - bottom).map(|solution| solution[0]);
            }
            let next = after(state, *thick);
            for part in 0..2 {
                // s S ∫ P − S p_0 t = flux out of the top less that into the bottom.
                let flow = (next[part][1] - state[part][1]) / (s * c(soil.storage));
                let still = if part == 1 { (c(ONE) / s - start) * c(*thick) } else { Complex::default() };
                shortening[part] = shortening[part] + (still - flow) / c(soil.modulus);
            }
            (state, bottom) = (next, top);
        }
        let base = -state[1][0] / state[0][0];
        [base * here[0] + here[1], base * shortening[0] + shortening[1]]
    });
    let end = soils.iter().fold(ZERO, |sum, (thick, soil, _)| sum + *thick / soil.modulus);
    Some(compared(ReferenceKind::Layered, &column, [time_factor, zeta], [pressure, settled / end.value()]))
}

/// Early, layers of one stiffness and water: a half-space under the top, whatever lies below.
pub fn layered_early(numbers: &mut Numbers, column: ColumnParameters) -> Option<Compared> {
    let mut column = layered_column(numbers, &column);
    let layers: Vec<SoilLayer> = column
        .soils
        .iter()
        .map(|layer| SoilLayer {
            thickness: layer.thickness,
            hydraulic_conductivity: layer.hydraulic_conductivity,
            ..SoilLayer::default()
        })
        .collect();
    column.soils = SoilLayers::from_slice(&layers).expect("a few");
    let top = layers.last().expect("a layer");
    let top_column = ColumnParameters { soil: top.soil(&column.soil), ..column };
    let (soil, mobility) = (Biot::new(&top_column), mobility(&top_column));
    // The face below is 14 lengths of diffusion away.
    let length = d(top.thickness) / d(numbers.decades(1.15, 4.0)) * d(0.5);
    let second = length * length * soil.storage / mobility;
    let time_factor = column.time_factor(second.value());
    let second = seconds(&column, time_factor);
    let length = (second * mobility / soil.storage).sqrt();
    let zeta = (length.value() / column.height * numbers.between(0.0, 6.0)).min(1.0);
    let reached = d(zeta) * d(column.height) / (d(2.0) * length);
    let at_once = soil.diffusivity_ratio();
    let lost = d(2.0) * length / PI.sqrt() * at_once;
    let settled = soil.fixed / soil.storage + lost / d(column.height);
    let pressure = at_once * reached.erf();
    let place = [time_factor, zeta];
    // So early a settlement is small, and has digits of its own.
    let (reference, bound) = solution(ReferenceKind::Layered, &column, time_factor);
    let computed = reference.degree_of_consolidation(time_factor).expect("a time");
    let mut all = compared(ReferenceKind::Layered, &column, place, [pressure.value(), settled.value()]);
    let scale = bound / 1e-11;
    all.pairs.push(("settlement over itself", scale * computed / settled.value(), scale));
    Some(all)
}
