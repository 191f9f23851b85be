//! The column in space: a spectral element per layer; neighbouring elements share a point.
//!
//! In each layer, with the moduli `E` and conductivities `k` over those of the column's soil and `y = Y/H`,
//!
//! ```text
//! (E_0/E) [C(J) ∂r/∂T_v − C_s(J) dλ/dT_v] = ∂/∂y [(k/k_0) κ(J) ∂r/∂y]      r and the flux continuous
//! ```
//!
//! (docs/theory.md, Eq. 43). Its weak form at Lobatto's points leaves no equation over at an interface: what the one layer
//! gives there the other takes (Maday & Patera 1989). A column of one soil is the upper half of a layer with its mirror
//! image below the base, where nothing flows.

use nalgebra::{DMatrix, DVector};

use crate::exact_error::ExactError;
use crate::large_strain::diffusion::{Diffusion, LargeStrainModel, LoadAt};
use crate::large_strain::legendre::{Element, evaluate, integral_to_one};
use crate::parameters::ColumnParameters;
use oedometer_soil::continuity::Continuity;

/// A column of layers, ordered from the surface down, like its points.
#[derive(Clone, Debug)]
pub struct Layers {
    stack: Vec<Layer>,
    /// Points of a layer less one.
    order: usize,
    element: Element,
}

/// One layer with its points from its top down.
#[derive(Clone, Debug)]
struct Layer {
    diffusion: Diffusion,
    /// Heights of the element's ends over that of the column: its base and top, or the top and its mirror image.
    ends: [f64; 2],
    /// `E_0/E`.
    compliance: f64,
    /// `k/k_0`.
    conductivity: f64,
    /// Weights of the points, which add up to the thickness over the height of the column.
    weights: Vec<f64>,
    /// `∂/∂y` at the points.
    slope: DMatrix<f64>,
}

/// A state as functions of the height, layer by layer from the surface down.
#[derive(Clone, Debug)]
pub struct Profile(Vec<Piece>);

/// A state as functions of the height in a layer.
#[derive(Clone, Debug)]
struct Piece {
    ends: [f64; 2],
    /// Legendre coefficients of `r` from −1, the lower end, to 1.
    ratio: Vec<f64>,
    /// Those of `1 − J`.
    shrinkage: Vec<f64>,
}

impl Piece {
    /// The place of a height in the element, from −1 to 1; of one above it 1.
    fn place(&self, height: f64) -> f64 {
        let [base, top] = self.ends;
        (2.0 * (height - base) / (top - base) - 1.0).min(1.0)
    }
}

impl Profile {
    /// Pressure ratio at a depth.
    pub fn pressure_ratio(&self, zeta: f64) -> f64 {
        if zeta == 0.0 {
            return 0.0;
        }
        let height = 1.0 - zeta;
        let piece = self.0.iter().find(|piece| height >= piece.ends[0]).or(self.0.last());
        piece.map_or(f64::NAN, |piece| evaluate(&piece.ratio, piece.place(height)))
    }

    /// `∫_ζ^1 (1 − J) dζ`.
    pub fn shrinkage_below(&self, zeta: f64) -> f64 {
        let height = 1.0 - zeta;
        let of_piece = |piece: &Piece| {
            let above = |height: f64| integral_to_one(&piece.shrinkage, piece.place(height));
            0.5 * (piece.ends[1] - piece.ends[0]) * (above(piece.ends[0].max(0.0)) - above(height))
        };
        self.0.iter().filter(|piece| height > piece.ends[0]).map(of_piece).sum()
    }
}

/// `C`, `C_s` and `κ` of the points of a layer, with its factors.
type Coefficients = Vec<[f64; 3]>;

impl Layers {
    /// A column on `order + 1` points in each of its layers.
    ///
    /// # Errors
    /// When a soil is impossible or closes its pores; of several layers when they do not fill the column, the load acts at
    /// once, a weight acts, or the continuity needs a gradient of the porosity.
    pub fn new(
        parameters: &ColumnParameters,
        model: LargeStrainModel,
        order: usize,
    ) -> Result<Self, ExactError> {
        let height = parameters.height;
        if parameters.soils.is_empty() {
            let (element, diffusion) = (Element::new(2 * order), Diffusion::new(model, parameters, 1.0)?);
            let (weights, slope) = element.upper_half();
            let ends = [-1.0, 1.0];
            let layer = Layer { diffusion, ends, compliance: 1.0, conductivity: 1.0, weights, slope };
            return Ok(Self { stack: vec![layer], order, element });
        }
        if let Some(sum) = parameters.soils.misses(height) {
            return Err(ExactError::LayersDoNotFill { sum, height });
        }
        if parameters.loading_time == 0.0 {
            return Err(ExactError::Layers("takes a load that grows at large strain: give a loading time"));
        }
        if parameters.self_weight {
            return Err(ExactError::Layers("has no weight here: leave `self_weight` out"));
        }
        if model.continuity != Continuity::Conservative {
            return Err(ExactError::Layers("has jumps of the porosity: the continuity is `conservative`"));
        }
        let element = Element::new(order);
        let mut layers = Vec::with_capacity(parameters.soils.len());
        let mut base = 0.0;
        for layer in parameters.soils.iter() {
            let soil = layer.soil(&parameters.soil);
            let thickness = layer.thickness / height;
            layers.push(Layer {
                diffusion: Diffusion::new(model, &ColumnParameters { soil, ..*parameters }, 1.0)?,
                ends: [base, base + thickness],
                compliance: parameters.soil.oedometric_modulus() / soil.oedometric_modulus(),
                conductivity: soil.hydraulic_conductivity / parameters.soil.hydraulic_conductivity,
                weights: element.weights.iter().map(|weight| 0.5 * thickness * weight).collect(),
                slope: element.derivative() * (2.0 / thickness),
            });
            base += thickness;
        }
        layers.reverse();
        Ok(Self { stack: layers, order, element })
    }

    /// Points below the surface.
    pub fn len(&self) -> usize {
        self.stack.len() * self.order
    }

    /// Depths of the points.
    pub fn depths(&self) -> impl Iterator<Item = f64> {
        self.stack.iter().flat_map(|layer| {
            let [base, top] = layer.ends;
            self.element.points[..=self.order]
                .iter()
                .map(move |x| (1.0 - base - 0.5 * (top - base) * (1.0 + x)).max(0.0))
        })
    }

    /// `1 − J` at a depth where the skeleton lacks a share of the load; of the lower layer at an interface.
    pub fn shrinkage(&self, zeta: f64, lacking: f64) -> f64 {
        let at = self.stack.iter().position(|layer| 1.0 - zeta > layer.ends[0]);
        self.stack[at.unwrap_or(self.stack.len() - 1)].diffusion.shrinkage(lacking)
    }

    /// `∫ (1 − J) dζ` over the column at the end of consolidation.
    pub fn final_shrinkage(&self) -> f64 {
        self.stack
            .iter()
            .map(|layer| layer.weights.iter().sum::<f64>() * layer.diffusion.shrinkage(0.0))
            .sum()
    }

    /// Functions of the height through the values at the points below the surface.
    pub fn profile(&self, ratio: &DVector<f64>, absent: f64) -> Profile {
        let pieces = self.stack.iter().enumerate().map(|(at, layer)| {
            let values = self.of_layer(at, ratio);
            let shrinkage = values.map(|ratio| layer.diffusion.shrinkage(ratio + absent));
            Piece { ends: layer.ends, ratio: self.series(&values), shrinkage: self.series(&shrinkage) }
        });
        Profile(pieces.collect())
    }

    /// Coefficients of the polynomial through values at the points of a layer, and at those of its image where it has one.
    fn series(&self, values: &DVector<f64>) -> Vec<f64> {
        let image = values.iter().rev().skip(1).take(self.element.points.len() - values.len());
        self.element.coefficients(&values.iter().chain(image).copied().collect::<Vec<_>>())
    }

    /// `∂r/∂T_v` at the points below the surface.
    pub fn rate(&self, ratio: &DVector<f64>, load: LoadAt) -> DVector<f64> {
        let (taken, storage) = self.balance(ratio, load);
        taken.component_div(&storage)
    }

    /// Derivative of the rate.
    pub fn jacobian(&self, ratio: &DVector<f64>, load: LoadAt) -> DMatrix<f64> {
        let (taken, storage) = self.balance(ratio, load);
        let rate = taken.component_div(&storage);
        let mut jacobian = DMatrix::zeros(self.len(), self.len());
        for (at, layer) in self.stack.iter().enumerate() {
            let values = self.of_layer(at, ratio);
            let (coefficients, changes) = layer.coefficients_with_slopes(&values, load.absent);
            let gradient = &layer.slope * &values;
            let mut flux = layer.slope.clone();
            for q in 0..=self.order {
                flux.row_mut(q).scale_mut(layer.weights[q] * coefficients[q][2]);
                flux[(q, q)] += layer.weights[q] * changes[q][2] * gradient[q];
            }
            let given = layer.slope.tr_mul(&flux);
            for a in 0..=self.order {
                let Some(row) = self.unknown(at, a) else { continue };
                for b in 0..=self.order {
                    let Some(column) = self.unknown(at, b) else { continue };
                    jacobian[(row, column)] -= given[(a, b)];
                }
                jacobian[(row, row)] +=
                    layer.weights[a] * (changes[a][1] * load.rate - changes[a][0] * rate[row]);
            }
        }
        for (row, storage) in storage.iter().enumerate() {
            jacobian.row_mut(row).scale_mut(storage.recip());
        }
        jacobian
    }

    /// Inflow and storage of every point.
    fn balance(&self, ratio: &DVector<f64>, load: LoadAt) -> (DVector<f64>, DVector<f64>) {
        let (mut taken, mut storage) = (DVector::zeros(self.len()), DVector::zeros(self.len()));
        for (at, layer) in self.stack.iter().enumerate() {
            let values = self.of_layer(at, ratio);
            let coefficients = layer.coefficients(&values, load.absent);
            let mut flux = &layer.slope * &values;
            for q in 0..=self.order {
                flux[q] *= layer.weights[q] * coefficients[q][2];
            }
            let given = layer.slope.tr_mul(&flux);
            for a in 0..=self.order {
                let Some(row) = self.unknown(at, a) else { continue };
                taken[row] += layer.weights[a] * coefficients[a][1] * load.rate - given[a];
                storage[row] += layer.weights[a] * coefficients[a][0];
            }
        }
        (taken, storage)
    }

    /// Number of the pressure at a point of a layer; the surface has none.
    fn unknown(&self, at: usize, point: usize) -> Option<usize> {
        (at * self.order + point).checked_sub(1)
    }

    /// Values at the points of a layer.
    fn of_layer(&self, at: usize, ratio: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(self.order + 1, |point, _| self.unknown(at, point).map_or(0.0, |row| ratio[row]))
    }
}

impl Layer {
    /// `(E_0/E) C`, `(E_0/E) C_s` and `(k/k_0) κ` at the points.
    fn coefficients(&self, values: &DVector<f64>, absent: f64) -> Coefficients {
        values.iter().map(|ratio| self.scaled(self.diffusion.coefficients(ratio + absent))).collect()
    }

    /// The coefficients, and how they change with the pressure.
    fn coefficients_with_slopes(&self, values: &DVector<f64>, absent: f64) -> (Coefficients, Coefficients) {
        let at =
            |ratio: &f64| self.diffusion.with_slopes(ratio + absent).map(|three| self.scaled(three)).into();
        values.iter().map(at).unzip()
    }

    fn scaled(&self, [storage, skeleton, conductance]: [f64; 3]) -> [f64; 3] {
        [self.compliance * storage, self.compliance * skeleton, self.conductivity * conductance]
    }
}
