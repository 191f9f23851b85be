//! The discretised body: points, nodes and the operators that join them.

use crate::actions::Actions;
use crate::actions::apic::VelocityGradients;
use crate::actions::cell_averages::CellAverages;
use crate::actions::forcing::{Forced, Forcing};
use crate::actions::rigid_plate::RigidPlate;
use crate::actions::self_weight::SelfWeight;
use crate::actions::stress_slopes::StressPlanes;
use crate::actions::surface_load::{LoadShape, LoadedSurface};
use crate::entries::of_dimension;
use crate::operators::Operators;
use crate::operators::basis::Shapes;
use crate::operators::corners::build_corners;
use crate::operators::stacked_points::StackedPoints;
use crate::state::cells::Cells;
use crate::state::grid::Grid;
use crate::state::nodes::{Nodes, Support};
use crate::state::points::Points;
use oedometer_problem::method::{Configuration, Memory, Method, Recovery};
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::StressLaw;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::{Tensor, Vector, product};
use std::sync::Arc;

/// A problem to solve: geometry, material, load, initial state and operators.
#[derive(Clone, Debug)]
pub struct Discrete<const D: usize> {
    /// Background grid.
    pub grid: Grid<D>,
    /// Faces that are held.
    pub support: Support<D>,
    /// Points in their initial state.
    pub points: Points<D>,
    /// Points of the water in their initial state, where it has points of its own.
    pub water: Option<Points<D>>,
    /// Soil that scales are made of, and what all soils have in common: water, gravity, density of the grains, law,
    /// continuity and mean of the conductivity.
    pub material: Material,
    /// Soils by the number that points have of theirs; `[material]` where the body is of one.
    pub soils: Vec<Material>,
    /// Operators.
    pub method: Method,
    /// Configuration of the shape functions.
    pub configuration: Configuration,
    /// Load on the surface, Pa.
    pub load: f64,
    /// Variation of the load along the surface.
    pub load_shape: LoadShape,
    /// Mean pressure, Pa, under a rigid plate on the upper face of the first direction, where there is one.
    pub plate_load: Option<f64>,
    /// Rigid plate that is pushed into the surface, where there is one.
    pub driven_plate: Option<DrivenPlate>,
    /// Gravity, m/s², that skeleton and water weigh with, where they do; the pressures of the points are those
    /// beyond the hydrostatic one, and their stresses are those of the weight.
    pub weight: Option<f64>,
    /// Effective stresses of the weight at the points, Pa, where these integrate it inexactly and the start is to be in
    /// balance all the same; none elsewhere.
    pub balanced_weight: Vec<Tensor<D>>,
    /// Whether the body is to find its undrained equilibrium under the load before it starts.
    pub undrained_start: bool,
    /// Time over which the load grows linearly, s; 0 where it acts at once.
    pub loading_time: f64,
    /// Displacement gradient of the start against the unloaded state.
    pub initial_gradient: Tensor<D>,
    /// Pressure that this problem is about, Pa: what leaves it a thousandfold has blown up.
    pub pressure_scale: f64,
    /// Body forces and source of water that act on every point, where a motion is made by them.
    pub forcing: Option<Arc<dyn Forcing<D>>>,
    /// Whether a result that the scene cannot reach ends the run; not where growth is the question.
    pub is_bounded: bool,
}

impl<const D: usize> Discrete<D> {
    /// The least of a quantity over the soils.
    pub fn least_of_soils(&self, quantity: impl Fn(&Material) -> f64) -> f64 {
        self.soils.iter().map(quantity).fold(f64::INFINITY, f64::min)
    }

    /// The most of a quantity over the soils.
    pub fn most_of_soils(&self, quantity: impl Fn(&Material) -> f64) -> f64 {
        self.soils.iter().map(quantity).fold(0.0, f64::max)
    }
}

/// A rigid plate that settles at a given velocity; its place is that of the support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivenPlate {
    /// Velocity, downward positive, m/s.
    pub velocity: f64,
    /// Whether the soil is skeleton and water that stays where it is, and not one phase of total stress.
    pub has_water: bool,
}

/// The discretised body during a run.
#[derive(Clone, Debug)]
pub struct Body<const D: usize> {
    /// Background grid.
    pub grid: Grid<D>,
    /// Material points.
    pub points: Points<D>,
    /// Nodal fields.
    pub nodes: Nodes<D>,
    /// Cell fields.
    pub cells: Cells<D>,
    /// Soil that scales are made of, and what all soils have in common: water, gravity, density of the grains, law,
    /// continuity and mean of the conductivity. What depends on the place is asked of [`soil_of`](Self::soil_of).
    pub material: Material,
    /// Soils by the number that points have of theirs.
    pub soils: Vec<Material>,
    /// Law of each soil with its stiffness.
    pub stress_laws: Vec<StressLaw>,
    /// Choices of operators.
    pub method: Method,
    /// Configuration of the shape functions.
    pub configuration: Configuration,
    /// Whether gradients are pushed forward from where the shape functions were built: on the initial
    /// configuration always, and within an implicit step that moves points.
    pub is_pushed_forward: bool,
    /// Actions on the body.
    pub actions: Actions<D>,
    /// Operators between points, nodes and cells where the points are.
    pub operators: Operators<D>,
    /// Faces that are held.
    support: Support<D>,
    /// Values at the sites on their way to the points: pressure increments, Pa, or rates of dilation, 1/s;
    /// `[cell]`, `[point]` or `[node]`.
    pub site_values: Vec<f64>,
    /// The skeleton's volumetric rate at the points, 1/s, where the method is B-bar.
    pub dilation_rates: Vec<f64>,
    /// Velocity gradients at the points by the method's strain, 1/s, while these are strained.
    pub velocity_gradients: Vec<Tensor<D>>,
    /// Mixture that passed the surface since the start, `∫ v_s + n(v_w − v_s) dt`, m.
    pub surface_flux: f64,
}

/// Cells, nodes or points that may be a site of a method's divergence.
fn site_places<const D: usize>(method: Method, grid: &Grid<D>, points: usize) -> usize {
    match (method.pressure.is_by_cells(), method.has_projection()) {
        (true, _) => grid.cell_count(),
        (false, true) => grid.node_count(),
        (false, false) => points,
    }
}

/// What other crates call of a body.
struct Entries<const D: usize> {
    new: fn(Discrete<D>) -> Body<D>,
    build_operators: fn(&mut Body<D>),
}

static LINE: Entries<1> = Entries::TABLE;
static PLANE: Entries<2> = Entries::TABLE;

impl<const D: usize> Entries<D> {
    const TABLE: Self = Self { new: Body::made_of, build_operators: Body::place_operators };
}

impl<const D: usize> Body<D> {
    /// Discretises a problem: builds operators and nodal masses on the initial configuration and
    /// maps the points' velocities to the nodes.
    pub fn new(problem: Discrete<D>) -> Self {
        let entries: &Entries<D> = of_dimension(&LINE, &PLANE);
        (entries.new)(problem)
    }

    fn made_of(problem: Discrete<D>) -> Self {
        let Discrete {
            grid,
            support,
            mut points,
            material,
            soils,
            method,
            configuration,
            load,
            load_shape,
            plate_load,
            weight,
            balanced_weight,
            initial_gradient,
            forcing,
            ..
        } = problem;
        let count = points.len();
        points.take_soils(&soils);
        let solid_cell_mass = (0..D).map(|_| grid.cell_size).product::<f64>()
            * (1.0 - material.porosity)
            * material.grain_density;
        let sites = site_places(method, &grid, count);
        let operators = Operators::new(method, configuration, &grid, &points);
        // Domains that turn have lengths of their own.
        let is_stacked = load_shape == LoadShape::Uniform
            && plate_load.is_none()
            && forcing.is_none()
            && operators.domains.is_none();
        let stacked = is_stacked.then(|| StackedPoints::new(&points, method.domains_follow()));
        let mut body = Self {
            nodes: Nodes::new(&grid, &support, solid_cell_mass),
            cells: Cells::new(&grid, count),
            stress_laws: soils.iter().map(Material::stress_law).collect(),
            actions: Actions {
                surface: LoadedSurface::new(&points, load)
                    .shaped(load_shape, &points)
                    .spread_by(method.basis, support)
                    .stretching(configuration.moves_points() && !method.domains_follow()),
                plate: None,
                weight: weight.map(|gravity| SelfWeight::new(gravity, &points)),
                forcing: forcing.map(|acting| Forced::new(acting, &grid, &points)),
                cell_averages: (method.memory == Memory::Cells).then(|| CellAverages::new(&grid, stacked)),
                weight_carried: Vec::new(),
                velocity_gradients: None,
                stress_planes: None,
            },
            operators,
            support,
            site_values: vec![0.0; sites],
            dilation_rates: vec![0.0; if method.strain.is_bbar() { count } else { 0 }],
            velocity_gradients: vec![[[0.0; D]; D]; count],
            surface_flux: 0.0,
            grid,
            points,
            material,
            soils,
            method,
            configuration,
            is_pushed_forward: configuration == Configuration::Total,
        };
        body.displace(&initial_gradient);
        body.add_hydrostatic_pressure();
        body.place_operators();
        // Where points move, other cells are cut at every step.
        if body.recovers_by_soils() && !configuration.moves_points() {
            body.share_stress_at_interfaces();
        }
        body.map_masses();
        if !balanced_weight.is_empty() {
            body.carry_what_weight_leaves(balanced_weight);
        }
        if let Some(load) = plate_load {
            let volumes = body.points.initial_volume.iter().copied();
            body.actions.plate = Some(RigidPlate::new(load, &body.grid, &body.nodes, volumes));
            body.apply_loads();
        }
        body.map_velocities();
        body
    }

    /// Displaces points and nodes by a uniform gradient; where strains are finite, the points take
    /// their volumes with them, and where they move, their places and domains.
    fn displace(&mut self, gradient: &Tensor<D>) {
        let moved = |place: &Vector<D>| -> Vector<D> {
            std::array::from_fn(|d| (0..D).map(|e| gradient[d][e] * place[e]).sum())
        };
        for node in 0..self.nodes.len() {
            self.nodes.displacement[node] = moved(&self.grid.node_position(node));
        }
        let configuration = self.configuration;
        let follow = self.method.domains_follow();
        let points = &mut self.points;
        for point in 0..points.len() {
            points.displacement[point] = moved(&points.initial_position[point]);
            for d in 0..D {
                if configuration.deforms() {
                    points.volume_ratio[point] *= 1.0 + gradient[d][d];
                    points.inverse_deformation[point][d][d] /= 1.0 + gradient[d][d];
                }
                if configuration.moves_points() {
                    points.position[point][d] += points.displacement[point][d];
                    if follow {
                        points.half_length[point][d] *= 1.0 + gradient[d][d];
                    }
                }
            }
        }
        self.turn_domains();
    }

    /// Makes points bring the gradients of their velocities to the nodes, from those of the present nodal velocities on.
    pub fn use_apic(&mut self) {
        let gradients =
            VelocityGradients::new(self.points.len(), &self.grid, &self.operators.basis, &self.nodes);
        self.actions.velocity_gradients = Some(gradients);
    }

    /// Lets stresses slope over the points' domains.
    pub fn slope_stresses(&mut self) {
        self.actions.stress_planes = Some(StressPlanes::new(&self.grid));
    }

    /// Switches to domains that turn with the points' deformation since the start of the run.
    pub(crate) fn turn_domains(&mut self) {
        if let Some(domains) = &mut self.operators.domains {
            domains.follow(&self.points.inverse_deformation);
        }
    }

    /// Whether it has several soils.
    #[inline]
    pub(crate) fn is_layered(&self) -> bool {
        self.soils.len() > 1
    }

    /// Whether it has several soils, and patches that keep to them.
    fn recovers_by_soils(&self) -> bool {
        self.is_layered() && self.method.recovery == Recovery::PatchSoils
    }

    /// Soil of a point.
    #[inline]
    pub fn soil_of(&self, point: usize) -> &Material {
        self.points.soil_among(&self.soils, point)
    }

    /// Law of a point's soil with its stiffness.
    #[inline]
    pub fn stress_law_of(&self, point: usize) -> &StressLaw {
        &self.stress_laws[usize::from(self.points.soil[point])]
    }

    /// Whether the law of its soils has a history.
    #[inline]
    pub fn has_history(&self) -> bool {
        !self.points.history.is_empty()
    }

    /// Updates operators and masses to the points' places and volumes: all of them where points
    /// move, what follows the volumes where shape functions stay on the initial configuration.
    pub fn follow_points(&mut self) {
        self.follow_places();
        if self.configuration.deforms() {
            self.map_masses();
        }
    }

    /// Updates the operators alone to the points' places and volumes.
    pub(crate) fn follow_places(&mut self) {
        if self.is_pushed_forward {
            self.cells.sum_volumes(&self.points, &self.soils);
            self.cells.average_deformation(&self.points);
        } else if self.configuration.moves_points() {
            self.place_operators();
        }
    }

    /// Velocity or displacement of a point under a nodal field: the value of the basis, or the mean of its domain's ends where
    /// its strain is the difference of these ends.
    #[inline]
    pub fn carrying(&self, point: usize, field: &[Vector<D>], of_basis: Vector<D>) -> Vector<D> {
        let stride = self.grid.node_stride();
        self.operators
            .strain
            .carrier()
            .map_or(of_basis, |ends| ends.of_point(point).values(stride, [field])[0])
    }

    /// Divergence of a nodal field at a point, on the present configuration.
    #[inline]
    pub fn divergence_at_point(&self, point: usize, field: &[Vector<D>]) -> f64 {
        if !self.is_pushed_forward {
            return self.operators.basis.divergence(self.grid.node_stride(), point, field);
        }
        let gradient = self.operators.basis.gradient(self.grid.node_stride(), point, field);
        let gradient = product(&gradient, &self.points.inverse_deformation[point]);
        (0..D).map(|d| gradient[d][d]).sum()
    }

    /// Divergence of a nodal field at a cell's centre, on the present configuration.
    #[inline]
    pub fn divergence_at_centre(&self, cell: usize, field: &[Vector<D>]) -> f64 {
        if self.is_pushed_forward {
            self.cells.deformed_centre_divergence(&self.grid, cell, field)
        } else {
            self.cells.centre_divergence(&self.grid, cell, field)
        }
    }

    /// Builds every operator of the method on the points' present places, and puts the load on
    /// the surface there.
    pub fn build_operators(&mut self) {
        let entries: &Entries<D> = of_dimension(&LINE, &PLANE);
        (entries.build_operators)(self);
    }

    fn place_operators(&mut self) {
        self.cells.locate(&self.grid, &self.points, &self.soils);
        if self.method.strain.is_composite() {
            self.cells.find_reached(&self.grid, &self.points);
        }
        self.end_splines();
        if let Some(domains) = &self.operators.domains {
            build_corners(&mut self.operators.basis, &self.grid, &self.cells.place, &domains.half_edges);
        } else {
            let places = [&self.cells.place[..], &self.points.half_length[..]];
            self.method.basis.build(&mut self.operators.basis, &self.grid, &self.support, places);
        }
        self.operators.strain.build(&self.grid, &self.cells, &self.points.half_length);
        self.operators.recovery.build(&self.grid, &self.cells);
        if self.recovers_by_soils() {
            self.operators.recovery.keep_to_soils(&self.grid, &self.cells, &self.points.soil);
        }
        if self.is_pushed_forward {
            self.cells.average_deformation(&self.points);
        }
        self.apply_loads();
    }

    /// Ends splines at a surface that moves through the grid, and at one whose cells have one point each: that beyond the
    /// surface would take its share of the load, and no point would carry it.
    fn end_splines(&mut self) {
        let is_alone = |half: &Vector<D>| half[D - 1] > 0.49 * self.grid.cell_size;
        let is_reached = self.points.half_length.first().is_none_or(|half| !is_alone(half));
        if self.method.basis.is_spline() && (self.configuration.moves_points() || !is_reached) {
            self.support = self.actions.surface.end_splines(&self.grid, &self.points);
            self.cells.end_at(&self.grid, self.support.outermost.unwrap_or(usize::MAX));
        }
    }

    /// Updates an explicit step's operators to the points' places, sums what the points give to the nodes in the same
    /// pass, and puts the load on the surface. The rows of gradient and recovery are left to the passes that take them.
    pub(crate) fn follow_moved_points(&mut self) {
        self.end_splines();
        self.build_basis_and_sum_points();
        if self.method.strain.is_composite() {
            self.cells.find_reached(&self.grid, &self.points);
        }
        if self.operators.strain.carrier().is_some() {
            self.operators.strain.build(&self.grid, &self.cells, &self.points.half_length);
        }
        if self.recovers_by_soils() {
            self.operators.recovery.build(&self.grid, &self.cells);
            self.operators.recovery.keep_to_soils(&self.grid, &self.cells, &self.points.soil);
        } else {
            self.operators.recovery.look_around(&self.grid, &self.cells);
        }
        self.apply_loads();
    }

    /// Gives the points of every cell that an interface cuts the modulus of its soils in series, under which they share the
    /// vertical stress that is continuous across the interface: soils of their own.
    fn share_stress_at_interfaces(&mut self) {
        let mut sums = vec![[0.0; 2]; self.grid.cell_count()];
        for point in 0..self.points.len() {
            let volume = self.points.volume(point);
            let sum = &mut sums[self.cells.of_point[point]];
            sum[0] += volume;
            sum[1] += volume / self.soil_of(point).oedometric_modulus();
        }
        for point in 0..self.points.len() {
            let [volume, compliance] = sums[self.cells.of_point[point]];
            let soil = *self.soil_of(point);
            let share = volume / compliance / soil.oedometric_modulus();
            if (share - 1.0).abs() < 1e-9 {
                continue;
            }
            let shared = Material { youngs_modulus: share * soil.youngs_modulus, ..soil };
            let number = self.soils.iter().position(|soil| *soil == shared).unwrap_or(self.soils.len());
            // More kinds than there are numbers keep their own.
            if let Ok(small) = u8::try_from(number) {
                if number == self.soils.len() {
                    self.soils.push(shared);
                    self.stress_laws.push(shared.stress_law());
                }
                self.points.soil[point] = small;
            }
        }
    }

    /// Faces that are held, and where splines end.
    pub fn support(&self) -> Support<D> {
        self.support
    }

    /// Last node of splines that end at a surface on its way through the grid.
    pub fn last_spline_node(&self) -> Option<usize> {
        self.support.outermost
    }

    /// Displacement of the skeleton at the place of a node, m: that of the node itself, but for splines,
    /// whose coefficients are not nodal values.
    pub fn displacement_at_node(&self, node: usize) -> Vector<D> {
        if !self.method.basis.is_spline() {
            return self.nodes.displacement[node];
        }
        let position = self.grid.node_position(node);
        let place = self.grid.held_in_cells(&position);
        let mut value = [0.0; D];
        self.method.basis.visit_surface(&self.grid, &self.support, &place, |node, weight| {
            for d in 0..D {
                value[d] += weight * self.nodes.displacement[node][d];
            }
        });
        value
    }

    /// Largest nodal velocity of either phase, m/s; infinite where one is not finite.
    pub fn largest_velocity(&self) -> f64 {
        let velocities = self.nodes.solid_velocity.iter().chain(&self.nodes.water_velocity);
        velocities.flatten().fold(0.0, |largest: f64, velocity| {
            if velocity.is_finite() { largest.max(velocity.abs()) } else { f64::INFINITY }
        })
    }

    /// Rate of the volume that the mixture gains, 1/s, from the divergence at a place: the bracket of
    /// docs/theory.md, Eq. 4 or 4' (Zheng et al. Eq. 6).
    #[inline]
    pub fn volume_rate(&self, porosity: f64, divergence: impl Fn(&[Vector<D>]) -> f64) -> f64 {
        match self.material.continuity {
            Continuity::Conservative => divergence(&self.nodes.flux),
            Continuity::ConstantPorosityGradient => {
                (1.0 - porosity) * divergence(&self.nodes.solid_velocity)
                    + porosity * divergence(&self.nodes.water_velocity)
            }
        }
    }
}
