//! Consolidation of a column of layers: small strain, compressible water, drained top, base impermeable or drained.
//!
//! With the storage `S = 1/E_oed + n/K_w` and the mobility `κ = k/γ_w` of each layer,
//!
//! ```text
//! S ∂p/∂t = ∂/∂y (κ ∂p/∂y)     p and κ ∂p/∂y continuous     p(y, 0) = q/(E_oed S)
//! ```
//!
//! Two independent methods: the eigenfunctions of the whole column (Schiffman & Stein 1970), and the Laplace transform
//! with the admittances of the layers, inverted on Talbot's contour. The series is used once the modes beyond
//! [`MOST_MODES`] are below round-off, the transform before that; tests compare the two.

use core::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Complex;

use crate::exact_error::{ExactError, checked_depth, checked_time_factor, held_within, normal, positive};
use crate::inputs::{COLUMN_KEYS, DRAINAGE_KEY, LAW_KEY, WATER_KEYS};
use crate::numerics::bisected;
use crate::parameters::{ColumnParameters, Drainage};
use crate::row::Row;
use crate::solution::{Accuracy, FieldValues, Solution};
use crate::talbot::{NODES, talbot_contour};
use oedometer_soil::elementary;
use oedometer_soil::material::Material;

/// The row of the solution.
pub(crate) static LAYERED: Row = Row {
    name: "layered",
    words: "the exact column of layers",
    inputs: &[COLUMN_KEYS, DRAINAGE_KEY, WATER_KEYS, LAW_KEY, &["soils"]],
    adds_up: true,
    ..Row::COLUMN
};

/// Modes beyond which the transform takes over.
const MOST_MODES: usize = 1000;
/// Bound on the contribution of omitted modes to the pressure over the load.
const NEGLIGIBLE: f64 = 1e-17;
/// Error of the inverted transform over the load: more than twice the largest difference from the series.
const INVERSION_ERROR: f64 = 1e-12;

/// A layer of soil, from the base up one of several.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layer {
    /// Height of its lower face above the base, m.
    bottom: f64,
    /// Thickness, m.
    thickness: f64,
    /// Oedometric modulus `E_oed`, Pa.
    modulus: f64,
    /// `S = 1/E_oed + n/K_w`, 1/Pa.
    storage: f64,
    /// `n/K_w`, 1/Pa.
    of_water: f64,
    /// `κ = k/γ_w`, m²/(Pa s).
    mobility: f64,
}

impl Layer {
    /// Pressure of the undrained start over the load, `1/(E_oed S)`.
    fn undrained(&self) -> f64 {
        1.0 / (self.modulus * self.storage)
    }

    /// Share of the load that the skeleton carries undrained, `1 − 1/(E_oed S)`, without cancellation.
    fn immediate(&self) -> f64 {
        self.of_water / self.storage
    }

    /// `√(S/κ)`: the wave number of a mode that decays by `e^{−t}`, √s/m.
    fn slowness(&self) -> f64 {
        (self.storage / self.mobility).sqrt()
    }

    /// `√(S κ)`: flux over pressure of such a mode.
    fn admittance(&self) -> f64 {
        (self.storage * self.mobility).sqrt()
    }
}

/// One eigenfunction: `R cos(θ + μ(y − bottom))` in each layer.
#[derive(Clone, Debug)]
struct Mode {
    /// Rate of decay `λ`, 1/s.
    rate: f64,
    /// Share of the initial pressure over the load in this mode.
    coefficient: f64,
    /// Amplitude `R` and phase `θ` at the bottom of each layer.
    waves: Vec<(f64, f64)>,
}

/// A column of layers under a load that acts at once.
#[derive(Clone, Debug)]
pub struct LayeredColumn {
    layers: Vec<Layer>,
    height: f64,
    load: f64,
    drainage: Drainage,
    modes: Vec<Mode>,
    /// Seconds of a unit of the time factor, where the column has one.
    seconds: f64,
}

impl LayeredColumn {
    /// The layers of a column, whose own soil defines the time factor; a single layer if the column has none.
    ///
    /// # Errors
    /// When a parameter is impossible, or the layers do not fill the column.
    pub fn from_parameters(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        let height = parameters.height;
        if let Some(sum) = parameters.soils.misses(height) {
            return Err(ExactError::LayersDoNotFill { sum, height });
        }
        let mut layers: Vec<(f64, Material)> =
            parameters.soils.iter().map(|layer| (layer.thickness, layer.soil(&parameters.soil))).collect();
        for (_, soil) in &layers {
            ColumnParameters { soil: *soil, ..*parameters }.validate()?;
        }
        if layers.is_empty() {
            layers.push((height, parameters.soil));
        }
        Ok(Self {
            seconds: parameters.time(1.0),
            ..Self::new(parameters.load, &layers, parameters.drainage)?
        })
    }

    /// The column of `layers`, thickness in m and soil of each from the base up, under `load` Pa, drained at these ends.
    ///
    /// # Errors
    /// When there is no layer, or a thickness, the load or a soil is impossible.
    pub fn new(load: f64, layers: &[(f64, Material)], drainage: Drainage) -> Result<Self, ExactError> {
        let mut bottom = 0.0;
        let mut stack = Vec::with_capacity(layers.len());
        for &(thickness, soil) in layers {
            let modulus = normal("oedometric modulus of a layer", soil.oedometric_modulus())?;
            let of_water = soil.porosity / soil.water_bulk_modulus;
            let storage = 1.0 / modulus + of_water;
            let mobility = soil.hydraulic_conductivity / soil.unit_weight_of_water();
            stack.push(Layer {
                bottom,
                thickness: normal("thickness of a layer", thickness)?,
                modulus,
                storage: normal("storage of a layer", storage)?,
                of_water,
                mobility: normal("mobility of the water in a layer", mobility)?,
            });
            bottom += thickness;
        }
        let mut column = Self {
            layers: stack,
            height: positive("height", bottom)?,
            load: normal("load", load)?,
            drainage,
            modes: Vec::new(),
            seconds: 1.0,
        };
        column.modes = (0..MOST_MODES).map(|index| column.mode(index)).collect();
        Ok(column)
    }

    /// Pressure, effective stress and displacement at the height `y` above the base, `seconds` after the load.
    ///
    /// On an interface these are the fields of the lower layer; only the initial pressure jumps there.
    ///
    /// # Errors
    /// When `seconds` is negative or not finite, or `y` outside of the column.
    pub fn fields_after(&self, seconds: f64, y: f64) -> Result<FieldValues, ExactError> {
        let y = held_within(y, self.height).ok_or(ExactError::OutsideLayer { y, height: self.height })?;
        self.fields_at(seconds, y, self.height - y)
    }

    /// The fields at a height and a depth, m: near the top the height has lost the digits of the depth.
    fn fields_at(&self, seconds: f64, y: f64, depth: f64) -> Result<FieldValues, ExactError> {
        let state = self.at(seconds)?;
        let pressure = state.pressure(y, depth);
        Ok(FieldValues {
            pressure: self.load * pressure,
            effective_stress: self.load * (pressure - 1.0),
            displacement: -self.load * state.shortening(y),
        })
    }

    /// Settlement of the top, downward positive, m.
    ///
    /// # Errors
    /// When `seconds` is negative or not finite.
    pub fn settlement_after(&self, seconds: f64) -> Result<f64, ExactError> {
        Ok(self.load * self.at(seconds)?.shortening(self.height))
    }

    /// Number of terms used at a time, and a bound on the contribution of the others to the pressure over the load.
    ///
    /// # Errors
    /// When `seconds` is negative or not finite.
    pub fn accuracy_after(&self, seconds: f64) -> Result<Accuracy, ExactError> {
        Ok(match self.at(seconds)?.form {
            Form::Start => Accuracy::new(0, 0.0),
            Form::Series { terms, .. } => Accuracy {
                phase_bound: self.round_off(seconds, terms),
                ..Accuracy::new(terms, self.tail(seconds, terms))
            },
            Form::Transform(_) => Accuracy::new(NODES / 2, INVERSION_ERROR),
        })
    }

    /// The column at one time, by the method that is accurate there.
    fn at(&self, seconds: f64) -> Result<State<'_>, ExactError> {
        if !(seconds.is_finite() && seconds >= 0.0) {
            return Err(ExactError::TimeFactor(seconds));
        }
        let form = if seconds == 0.0 {
            Form::Start
        } else if self.tail(seconds, MOST_MODES) <= NEGLIGIBLE {
            // The bound falls with the number of modes.
            let mut terms = MOST_MODES;
            while terms > 1 && self.tail(seconds, terms / 2) <= NEGLIGIBLE {
                terms /= 2;
            }
            Form::Series { terms, seconds }
        } else {
            Form::Transform(self.transform(seconds))
        };
        Ok(State { column: self, form })
    }

    /// Bound on the pressure over the load of all modes from `terms` on.
    ///
    /// A mode's coefficient is at most `‖p₀‖/‖Z‖` (Bessel), and `|Z| ≤ √(λ Σ t/κ) ‖Z‖`, for `Z` vanishes at the top and
    /// `∫ κ Z'² = λ ‖Z‖²`, norms with the weight `S`. Root `m` is at least `(m + 1 − n/2)π/Σ t√(S/κ)` in a stack of `n`
    /// layers: a face moves the phase by less than a right angle.
    fn tail(&self, seconds: f64, terms: usize) -> f64 {
        let sum = |quantity: fn(&Layer) -> f64| self.layers.iter().map(quantity).sum::<f64>();
        let resistance = sum(|layer| layer.thickness / layer.mobility);
        let span = sum(|layer| layer.thickness * layer.slowness());
        let energy = sum(|layer| layer.storage * layer.thickness * layer.undrained() * layer.undrained());
        let first = (terms as f64 + 1.0 - 0.5 * self.layers.len() as f64) * PI / span;
        if first <= 0.0 || first * first * seconds < 1.0 {
            // The root's own bound says nothing, or terms rise before they fall.
            return f64::INFINITY;
        }
        // Σ x e^{−x²t} over the roots x, PI/span apart: at most the first term and the integral behind it.
        let first_term = first * elementary::exp(-first * first * seconds);
        let rest = elementary::exp(-first * first * seconds) * span / (2.0 * PI * seconds);
        (resistance * energy).sqrt() * (first_term + rest)
    }

    /// Round-off error of the sum of modes over the load: each phase has a round-off error of its own.
    fn round_off(&self, seconds: f64, terms: usize) -> f64 {
        let of_mode = |(index, mode): (usize, &Mode)| {
            let amplitude = mode.waves.iter().fold(0.0_f64, |most, wave| most.max(wave.0));
            let (phase, decay) = ((index as f64 + 0.5) * PI, mode.rate * seconds);
            mode.coefficient.abs() * amplitude * (2.0 + phase + decay) * elementary::exp(-decay)
        };
        4.0 * f64::EPSILON * self.modes[..terms].iter().enumerate().map(of_mode).sum::<f64>()
    }

    /// Phase of the wave of `√λ = root` at the top, and amplitude and phase at each bottom; at the base the amplitude is 1, and
    /// the phase 0 of no flux, or −π/2 of no pressure.
    fn waves(&self, root: f64) -> (f64, Vec<(f64, f64)>) {
        let mut waves = Vec::with_capacity(self.layers.len());
        let (mut amplitude, mut phase) = (1.0, self.phase_at_base());
        let mut below: Option<&Layer> = None;
        for layer in &self.layers {
            if let Some(below) = below {
                // p = R cos θ and κ ∂p/∂y = −√(λSκ) R sin θ are continuous; the quadrant of θ stays.
                let (sine, cosine) = (elementary::sin(phase), elementary::cos(phase));
                let turned = below.admittance() / layer.admittance() * sine;
                let turns = 2.0 * PI * (phase / (2.0 * PI)).round();
                let mut within = atan2(turned, cosine);
                let reduced = phase - turns;
                if within - reduced > PI {
                    within -= 2.0 * PI;
                } else if within - reduced < -PI {
                    within += 2.0 * PI;
                }
                amplitude *= elementary::hypot(turned, cosine);
                phase = turns + within;
            }
            waves.push((amplitude, phase));
            phase += root * layer.slowness() * layer.thickness;
            below = Some(layer);
        }
        (phase, waves)
    }

    fn phase_at_base(&self) -> f64 {
        match self.drainage {
            Drainage::Top => 0.0,
            Drainage::Both => -FRAC_PI_2,
        }
    }

    /// Mode `index`: its phase at the drained top is `(index + ½)π`, and grows with the root.
    fn mode(&self, index: usize) -> Mode {
        let wanted = (index as f64 + 0.5) * PI;
        let span: f64 = self.layers.iter().map(|layer| layer.thickness * layer.slowness()).sum();
        let margin = FRAC_PI_2 * self.layers.len() as f64;
        let turn = wanted - self.phase_at_base();
        let bracket = [(turn - margin).max(0.0) / span, (turn + margin) / span];
        let root = bisected(bracket[0], bracket[1], |root| self.waves(root).0 - wanted);
        let waves = self.waves(root).1;
        let (mut start, mut norm) = (0.0, 0.0);
        for (layer, &(amplitude, phase)) in self.layers.iter().zip(&waves) {
            let number = root * layer.slowness();
            let turned = number * layer.thickness;
            start += amplitude / layer.modulus * sine_step(phase, turned) / number;
            norm += layer.storage
                * amplitude
                * amplitude
                * (0.5 * layer.thickness + 0.25 * sine_step(2.0 * phase, 2.0 * turned) / number);
        }
        Mode { rate: root * root, coefficient: start / norm, waves }
    }

    /// The transform of the pressure over the load on Talbot's contour for one time.
    fn transform(&self, seconds: f64) -> Vec<Image> {
        talbot_contour(NODES)
            .map(|(z, weight)| Image::new(&self.layers, self.drainage, z / seconds, weight / seconds))
            .collect()
    }

    /// The layer at a height; the lower one on a face.
    fn layer_at(&self, y: f64) -> usize {
        self.layers.iter().rposition(|layer| y > layer.bottom).unwrap_or(0)
    }
}

impl Solution for LayeredColumn {
    fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let seconds = checked_time_factor(time_factor)? * self.seconds;
        let zeta = checked_depth(zeta)?;
        self.fields_at(seconds, (1.0 - zeta) * self.height, zeta * self.height)
    }

    fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        self.settlement_after(checked_time_factor(time_factor)? * self.seconds)
    }

    /// `q Σ t/E_oed`.
    fn final_settlement(&self) -> Result<f64, ExactError> {
        Ok(self.load * self.layers.iter().map(|layer| layer.thickness / layer.modulus).sum::<f64>())
    }

    fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        self.accuracy_after(checked_time_factor(time_factor)? * self.seconds)
    }
}

/// `sin(phase + turn) − sin(phase)` without cancellation.
fn sine_step(phase: f64, turn: f64) -> f64 {
    2.0 * elementary::cos(phase + 0.5 * turn) * elementary::sin(0.5 * turn)
}

/// The angle of the point `(x, y)` in (−π, π].
fn atan2(y: f64, x: f64) -> f64 {
    let angle = elementary::atan(y / x);
    if x >= 0.0 {
        angle
    } else if y >= 0.0 {
        angle + PI
    } else {
        angle - PI
    }
}

/// The column at one time.
struct State<'a> {
    column: &'a LayeredColumn,
    form: Form,
}

/// How the state is computed.
enum Form {
    /// The undrained start.
    Start,
    /// The first `terms` modes at `seconds`.
    Series { terms: usize, seconds: f64 },
    /// The transform, one image per node of the contour.
    Transform(Vec<Image>),
}

impl State<'_> {
    /// Pressure over the load at the height `y`, which is at a depth.
    fn pressure(&self, y: f64, depth: f64) -> f64 {
        let column = self.column;
        let at = column.layer_at(y);
        let layer = &column.layers[at];
        let above = y - layer.bottom;
        let below_face = if at + 1 == column.layers.len() { depth } else { layer.thickness - above };
        let is_drained = depth <= 0.0 || y <= 0.0 && column.drainage == Drainage::Both;
        match &self.form {
            Form::Start | Form::Transform(_) if is_drained => 0.0,
            Form::Start => layer.undrained(),
            Form::Series { terms, seconds } => self.over_modes(*terms, *seconds, |mode, root| {
                let (amplitude, phase) = mode.waves[at];
                amplitude * elementary::cos(phase + root * layer.slowness() * above)
            }),
            Form::Transform(images) => {
                layer.undrained()
                    + images.iter().map(|image| image.pressure(layer, at, [above, below_face])).sum::<f64>()
            }
        }
    }

    /// Shortening of the column between the base and the height `y` per load, m/Pa: `∫ (1 − p/q)/E_oed dy`.
    fn shortening(&self, y: f64) -> f64 {
        let column = self.column;
        let mut total = 0.0;
        for (at, layer) in column.layers.iter().enumerate() {
            let above = (y - layer.bottom).min(layer.thickness);
            if above <= 0.0 {
                break;
            }
            // ∫ (1 − p/q) over the layer.
            let carried = match &self.form {
                Form::Start => layer.immediate() * above,
                Form::Series { terms, seconds } => {
                    above
                        - self.over_modes(*terms, *seconds, |mode, root| {
                            let (amplitude, phase) = mode.waves[at];
                            let number = root * layer.slowness();
                            amplitude * sine_step(phase, number * above) / number
                        })
                }
                Form::Transform(images) => {
                    let lost = images.iter().map(|image| image.integral(layer, at, above)).sum::<f64>();
                    layer.immediate() * above - lost
                }
            };
            total += carried / layer.modulus;
        }
        total
    }

    /// Sum over the modes of `term(mode, √λ)`, weighted by the coefficient and the decay of the mode, smallest first.
    fn over_modes(&self, terms: usize, seconds: f64, term: impl Fn(&Mode, f64) -> f64) -> f64 {
        let modes = self.column.modes[..terms].iter().rev();
        modes
            .map(|mode| {
                mode.coefficient * elementary::exp(-mode.rate * seconds) * term(mode, mode.rate.sqrt())
            })
            .sum()
    }
}

/// The transform of the pressure over the load at one node of the contour: in layer `i` it is `1/(E_oed S s)` and a
/// part that its values on both faces determine.
struct Image {
    /// Laplace variable `s`, 1/s.
    s: Complex<f64>,
    /// Weight of the node.
    weight: Complex<f64>,
    /// That part on the lower and the upper face of each layer.
    faces: Vec<[Complex<f64>; 2]>,
}

impl Image {
    /// An upward sweep finds the flux `Y w + j` of the part `w` (`Y = j = 0` at an impermeable base; of a drained one the value
    /// is known in the place of the flux), a downward sweep the values from `p = 0` at the top.
    fn new(layers: &[Layer], drainage: Drainage, s: Complex<f64>, weight: Complex<f64>) -> Self {
        let zero = Complex::new(0.0, 0.0);
        let root = elementary::sqrt_complex(s);
        let (mut admittance, mut flux, mut steady_below) = (zero, zero, zero);
        // Per layer: its Y and j at the bottom.
        let mut below = Vec::with_capacity(layers.len());
        let is_drained = |at: usize| at == 0 && drainage == Drainage::Both;
        for (at, layer) in layers.iter().enumerate() {
            let steady = Complex::new(layer.undrained(), 0.0) / s;
            // The part above a face is `steady_below − steady` more than the one below it.
            flux += admittance * (steady - steady_below);
            steady_below = steady;
            below.push((admittance, flux));
            let [layer_admittance, tangent, secant] = Self::layer_functions(layer, root);
            if is_drained(at) {
                admittance = layer_admittance / tangent;
                flux = admittance * secant * steady;
                continue;
            }
            let share = (layer_admittance + admittance * tangent).inv() * layer_admittance;
            let next = (layer_admittance * tangent + admittance) * share;
            flux = flux * secant * share;
            admittance = next;
        }
        let mut faces = vec![[zero; 2]; layers.len()];
        // Pressure on the face above: zero at the top.
        let mut pressure_above = zero;
        for (at, layer) in layers.iter().enumerate().rev() {
            let steady = Complex::new(layer.undrained(), 0.0) / s;
            let [layer_admittance, tangent, secant] = Self::layer_functions(layer, root);
            let (admittance, flux) = below[at];
            let top = pressure_above - steady;
            let bottom = if is_drained(at) {
                -steady
            } else {
                (top * secant - flux * tangent / layer_admittance) * layer_admittance
                    / (layer_admittance + admittance * tangent)
            };
            faces[at] = [bottom, top];
            pressure_above = bottom + steady;
        }
        Self { s, weight, faces }
    }

    /// `κμ`, `tanh μt` and `1/cosh μt` of a layer.
    fn layer_functions(layer: &Layer, root: Complex<f64>) -> [Complex<f64>; 3] {
        let turned = root * (layer.slowness() * layer.thickness);
        let fall = elementary::exp_complex(-turned);
        let unit = Complex::new(1.0, 0.0);
        let under = (unit + fall * fall).inv();
        [root * layer.admittance(), -elementary::exp_m1_complex(-2.0 * turned) * under, 2.0 * fall * under]
    }

    /// Contribution of this node to the pressure over the load, beyond the initial one, at distances in m above the bottom
    /// and below the top of layer `at`.
    fn pressure(&self, layer: &Layer, at: usize, [above, below]: [f64; 2]) -> f64 {
        let [bottom, top] = self.faces[at];
        let number = self.number(layer);
        (self.weight * (bottom * sinh_ratio(number, below, above) + top * sinh_ratio(number, above, below)))
            .re
    }

    /// Contribution of this node to the integral of that part from the bottom of layer `at` to `above` m over it.
    fn integral(&self, layer: &Layer, at: usize, above: f64) -> f64 {
        let [bottom, top] = self.faces[at];
        let number = self.number(layer);
        // ∫ sinh μ(t − y)/sinh μt and ∫ sinh μy/sinh μt over (0, above).
        let full = cosh_ratio(number, layer.thickness, layer.thickness);
        let lower = full - cosh_ratio(number, layer.thickness - above, layer.thickness);
        let upper = cosh_ratio(number, above, layer.thickness) - cosh_ratio(number, 0.0, layer.thickness);
        (self.weight * (bottom * lower + top * upper) / number).re
    }

    /// `μ = √(sS/κ)`.
    fn number(&self, layer: &Layer) -> Complex<f64> {
        elementary::sqrt_complex(self.s) * layer.slowness()
    }
}

/// `sinh μa/sinh μ(a + rest)`.
fn sinh_ratio(number: Complex<f64>, a: f64, rest: f64) -> Complex<f64> {
    elementary::exp_complex(-rest * number) * elementary::exp_m1_complex(-2.0 * a * number)
        / elementary::exp_m1_complex(-2.0 * (a + rest) * number)
}

/// `cosh μa/sinh μb` for `0 ≤ a ≤ b`.
fn cosh_ratio(number: Complex<f64>, a: f64, b: f64) -> Complex<f64> {
    let unit = Complex::new(1.0, 0.0);
    elementary::exp_complex(number * (a - b)) * (unit + elementary::exp_complex(-2.0 * a * number))
        / -elementary::exp_m1_complex(-2.0 * b * number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terzaghi::Terzaghi;

    fn soil(modulus: f64, conductivity: f64, porosity: f64) -> Material {
        Material {
            youngs_modulus: modulus,
            hydraulic_conductivity: conductivity,
            porosity,
            ..Material::default()
        }
    }

    /// The three columns of the table: name, thickness and soil of each layer from the base up.
    fn columns() -> [(&'static str, Vec<(f64, Material)>); 3] {
        let seed = Material::default();
        [
            ("clay-over-sand", vec![(0.5, seed), (0.5, soil(1e6, 1e-6, 0.3))]),
            ("sand-over-clay", vec![(0.5, soil(1e6, 1e-6, 0.3)), (0.5, seed)]),
            ("sandwich", vec![(0.3, soil(1e7, 1e-4, 0.3)), (0.4, soil(5e5, 1e-7, 0.5)), (0.3, seed)]),
        ]
    }

    #[test]
    fn pressures_and_settlements_match_forty_digits() {
        let seconds_per_time_factor = ColumnParameters::default().time(1.0);
        for (name, layers) in columns() {
            let column = LayeredColumn::new(1.0, &layers, Drainage::Top).unwrap();
            let rows: Vec<Vec<&str>> = include_str!("../tests/reference/layered.csv")
                .lines()
                .map(|line| line.split(',').collect::<Vec<_>>())
                .filter(|row| row[0] == name)
                .collect();
            assert_eq!(rows.len(), 24);
            for row in rows {
                let [time_factor, y, pressure, settlement] =
                    [1, 2, 3, 4].map(|cell| row[cell].parse::<f64>().unwrap());
                let seconds = time_factor * seconds_per_time_factor;
                let computed = column.fields_after(seconds, y).unwrap().pressure;
                assert!((computed - pressure).abs() < 1e-13, "{row:?}: {computed}");
                let computed = column.settlement_after(seconds).unwrap() / column.final_settlement().unwrap();
                assert!((computed - settlement).abs() < 1e-13, "{row:?}: {computed}");
                assert!(column.accuracy_after(seconds).unwrap().bound() < 1e-12);
            }
        }
    }

    #[test]
    fn the_series_and_the_transform_agree_wherever_both_hold() {
        for ((name, layers), drainage) in
            columns().into_iter().flat_map(|one| Drainage::ALL.map(|drainage| (one.clone(), drainage)))
        {
            let column = LayeredColumn::new(1.0, &layers, drainage).unwrap();
            let slowest = 1.0 / column.modes[0].rate;
            for share in [1e-4, 1e-3, 0.02, 0.3, 2.0] {
                let seconds = share * slowest;
                if column.tail(seconds, MOST_MODES) > NEGLIGIBLE {
                    continue;
                }
                let series = State { column: &column, form: Form::Series { terms: MOST_MODES, seconds } };
                let transform = State { column: &column, form: Form::Transform(column.transform(seconds)) };
                for step in 0..=20_u8 {
                    let y = f64::from(step) / 20.0;
                    let difference =
                        series.pressure(y, column.height - y) - transform.pressure(y, column.height - y);
                    assert!(difference.abs() < INVERSION_ERROR, "{name} {share} {y}: {difference:e}");
                    let difference =
                        (series.shortening(y) - transform.shortening(y)) / column.final_settlement().unwrap();
                    assert!(difference.abs() < INVERSION_ERROR, "{name} {share} {y}: {difference:e}");
                }
            }
        }
    }

    #[test]
    fn the_bound_of_the_tail_covers_the_modes_that_are_left_out() {
        for (name, layers) in columns() {
            let column = LayeredColumn::new(1.0, &layers, Drainage::Top).unwrap();
            let seconds = 0.02 / column.modes[0].rate;
            let pressure = |terms, y| {
                State { column: &column, form: Form::Series { terms, seconds } }
                    .pressure(y, column.height - y)
            };
            for terms in 1..6 {
                let heights = (0..=40).map(|step| f64::from(step) / 40.0);
                let left_out = heights.map(|y| (pressure(terms, y) - pressure(MOST_MODES, y)).abs());
                let (bound, left_out) = (column.tail(seconds, terms), left_out.fold(0.0, f64::max));
                assert!(left_out <= bound, "{name}: {left_out:e} beyond {terms} modes, at most {bound:e}");
            }
        }
    }

    #[test]
    fn layers_of_one_soil_are_terzaghis_column_at_early_and_late_times() {
        let seed = ColumnParameters { load: 3e3, ..ColumnParameters::default() };
        let terzaghi = Terzaghi::compressible(&seed).unwrap();
        let soil = Material::default();
        let column =
            LayeredColumn::new(3e3, &[(0.2, soil), (0.5, soil), (0.3, soil)], Drainage::Top).unwrap();
        for time_factor in [0.0, 1e-9, 1e-6, 1e-4, 0.01, 0.3, 2.0, 30.0] {
            let seconds = seed.time(time_factor);
            for y in [0.0, 0.1, 0.2, 0.69, 0.9, 0.999, 1.0] {
                let expected = terzaghi.fields(time_factor, 1.0 - y).unwrap();
                let computed = column.fields_after(seconds, y).unwrap();
                let difference = (computed.pressure - expected.pressure) / 3e3;
                assert!(difference.abs() < 1e-12, "{time_factor} {y}: {difference:e}");
                let difference = (computed.displacement - expected.displacement) / seed.final_settlement();
                assert!(difference.abs() < 1e-12, "{time_factor} {y}: {difference:e}");
            }
        }
    }

    #[test]
    fn forty_layers_of_one_soil_are_terzaghis_column() {
        let seed = ColumnParameters::default();
        let terzaghi = Terzaghi::compressible(&seed).unwrap();
        let column = LayeredColumn::new(1.0, &[(0.025, Material::default()); 40], Drainage::Top).unwrap();
        for time_factor in [1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0] {
            let expected = terzaghi.fields(time_factor, 0.5).unwrap().pressure;
            let computed = column.fields_after(seed.time(time_factor), 0.5).unwrap().pressure;
            assert!((computed - expected).abs() < 1e-12, "{time_factor}: {computed} {expected}");
            assert!(column.accuracy_after(seed.time(time_factor)).unwrap().bound() >= 0.0);
        }
    }

    #[test]
    fn pressure_and_flux_are_continuous_and_the_start_is_undrained() {
        let layers = [(0.3, soil(3e7, 1e-8, 0.2)), (0.7, soil(1e6, 1e-4, 0.4))];
        let column = LayeredColumn::new(1.0, &layers, Drainage::Top).unwrap();
        let seconds = 0.01 / column.modes[0].rate;
        let step = 1e-6;
        let slope = |from: f64| {
            let at = |y: f64| column.fields_after(seconds, y).unwrap().pressure;
            (at(from + step) - at(from)) / step
        };
        let (below, above) = (slope(0.3 - step) * 1e-8, slope(0.3 + 1e-12) * 1e-4);
        assert!((below / above - 1.0).abs() < 1e-3, "{below:e} {above:e}");
        let start = column.fields_after(0.0, 0.1).unwrap().pressure;
        let coupling = layers[0].1.coupling_modulus();
        assert!((start - coupling / (coupling + layers[0].1.oedometric_modulus())).abs() < 1e-15);
    }

    /// The four layers of Schiffman & Stein (1970), from the top down, with values of the Python package geotecha 0.2.2.
    #[test]
    fn layers_drained_at_both_ends_are_those_of_schiffman_and_stein() {
        let (thicknesses, c_v) = ([10.0, 20.0, 30.0, 20.0], [0.0411, 0.1918, 0.0548, 0.0686]);
        let m_v = [3.07e-3, 1.95e-3, 9.74e-4, 1.95e-3];
        let unit_weight = Material::default().unit_weight_of_water();
        let soil = |at: usize| Material {
            youngs_modulus: 1.0 / m_v[at],
            poissons_ratio: 0.0,
            water_bulk_modulus: 1e18,
            hydraulic_conductivity: c_v[at] * m_v[at] * unit_weight,
            ..Material::default()
        };
        let layers: Vec<_> = (0..4).rev().map(|at| (thicknesses[at], soil(at))).collect();
        let column = LayeredColumn::new(100.0, &layers, Drainage::Both).unwrap();
        let pressure = column.fields_after(740.0, 75.0).unwrap().pressure;
        let settlement = column.settlement_after(740.0).unwrap();
        assert!((pressure - 48.69).abs() < 5e-3, "{pressure}");
        assert!((settlement - 3.481).abs() < 1e-3, "{settlement}");
    }

    #[test]
    fn impossible_layers_are_refused() {
        assert!(LayeredColumn::new(1.0, &[], Drainage::Top).is_err());
        assert!(LayeredColumn::new(1.0, &[(0.0, Material::default())], Drainage::Top).is_err());
        assert!(LayeredColumn::new(f64::NAN, &[(1.0, Material::default())], Drainage::Top).is_err());
        let column = LayeredColumn::new(1.0, &[(1.0, Material::default())], Drainage::Top).unwrap();
        assert!(column.fields_after(-1.0, 0.5).is_err() && column.fields_after(1.0, 1.1).is_err());
    }
}
