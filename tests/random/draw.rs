//! Draws cases: scene, method, integrator, soil, mesh, points, load and times, over all that a user may type.

use crate::numbers::Numbers;
use crate::options::{Options, rounded};
use oedometer::Method;
use std::f64::consts::PI;
use std::fmt::Write;

/// Scenes, those of columns and layers more often than the others.
const SCENES: [&str; 24] = [
    "terzaghi",
    "terzaghi",
    "terzaghi",
    "single-mode",
    "xie-leo",
    "xie-leo",
    "cosine-layer",
    "cosine-layer",
    "cosine-layer",
    "dynamic-column",
    "dynamic-column",
    "dynamic-single-mode",
    "standing-wave",
    "mandel",
    "at-rest",
    "layered",
    "layered",
    "yield-front",
    "yield-front",
    "sealed-element",
    "footing",
    "manufactured-box",
    "manufactured-shear",
    "manufactured-vortex",
];

/// A soil, SI.
#[derive(Clone, Copy, Debug)]
pub struct Soil {
    youngs_modulus: f64,
    poissons_ratio: f64,
    porosity: f64,
    grain_density: f64,
    water_density: f64,
    water_bulk_modulus: f64,
    hydraulic_conductivity: f64,
    gravity: f64,
}

impl Soil {
    fn drawn(numbers: &mut Numbers) -> Self {
        let youngs_modulus = numbers.decades(4.0, 9.0);
        let poissons_ratio =
            if numbers.chance(0.1) { numbers.between(0.45, 0.4999) } else { numbers.between(-0.2, 0.45) };
        Self {
            youngs_modulus: rounded(youngs_modulus),
            poissons_ratio: rounded(poissons_ratio),
            porosity: rounded(numbers.between(0.1, 0.8)),
            grain_density: rounded(numbers.between(1500.0, 4000.0)),
            water_density: rounded(numbers.between(700.0, 1300.0)),
            water_bulk_modulus: rounded(youngs_modulus * numbers.decades(0.0, 4.5)),
            hydraulic_conductivity: rounded(numbers.decades(-10.0, -1.0)),
            gravity: if numbers.chance(0.5) { 9.81 } else { rounded(numbers.between(1.0, 100.0)) },
        }
    }

    /// The soil that options name.
    pub fn of(options: &Options) -> Option<Self> {
        let of = |key: &str| options.number(&format!("material.{key}"));
        Some(Self {
            youngs_modulus: of("youngs_modulus")?,
            poissons_ratio: of("poissons_ratio")?,
            porosity: of("porosity")?,
            grain_density: of("grain_density")?,
            water_density: of("water_density")?,
            water_bulk_modulus: of("water_bulk_modulus")?,
            hydraulic_conductivity: of("hydraulic_conductivity")?,
            gravity: of("gravity")?,
        })
    }

    fn set_in(&self, options: &mut Options) {
        for (key, value) in [
            ("youngs_modulus", self.youngs_modulus),
            ("poissons_ratio", self.poissons_ratio),
            ("porosity", self.porosity),
            ("grain_density", self.grain_density),
            ("water_density", self.water_density),
            ("water_bulk_modulus", self.water_bulk_modulus),
            ("hydraulic_conductivity", self.hydraulic_conductivity),
            ("gravity", self.gravity),
        ] {
            options.set_number(&format!("material.{key}"), value);
        }
    }

    pub fn oedometric_modulus(&self) -> f64 {
        let nu = self.poissons_ratio;
        self.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// Time, s, at which `T_v = 1`.
    fn time(&self, height: f64) -> f64 {
        let unit_weight = self.water_density * self.gravity;
        height * height * unit_weight / (self.hydraulic_conductivity * self.oedometric_modulus())
    }

    /// Stiffness of the water in the pores over that of the skeleton: strains of round-off make pressures of it.
    pub fn stiffness_ratio(&self) -> f64 {
        self.water_bulk_modulus / self.porosity / self.oedometric_modulus()
    }

    /// Time, s, in which a wave of skeleton and water together crosses a length.
    pub fn skeleton_step(&self, cell: f64) -> f64 {
        let density = (1.0 - self.porosity) * self.grain_density + self.porosity * self.water_density;
        cell / (self.oedometric_modulus() / density).sqrt()
    }

    /// Step, s, that explicit waves and explicit drag stand, about.
    pub fn explicit_step(&self, cell: f64, is_drag_explicit: bool) -> f64 {
        let (n, coupling) = (self.porosity, self.water_bulk_modulus / self.porosity);
        let (solid, water) = ((1.0 - n) * self.grain_density, n * self.water_density);
        let speed = (coupling * ((1.0 - n) * (1.0 - n) / solid + n * n / water)
            + self.oedometric_modulus() / solid)
            .sqrt();
        let drag = n * n * self.water_density * self.gravity / self.hydraulic_conductivity;
        let drag_step = 2.0 / (drag * (1.0 / solid + 1.0 / water));
        let wave_step = cell / speed;
        if is_drag_explicit { wave_step.min(drag_step) } else { wave_step }
    }
}

/// The options of a case.
pub fn drawn(seed: u64, index: u64) -> Options {
    let numbers = &mut Numbers::of(seed, index);
    let scene = numbers.one_of(&SCENES);
    let is_manufactured = scene.starts_with("manufactured");
    let needs_plane = is_manufactured || matches!(scene, "cosine-layer" | "mandel");
    let is_plane = needs_plane || numbers.chance(0.2);
    let methods = Method::names();
    let mut options = Options {
        scene,
        method: methods[numbers.count(0, methods.len() - 1)].clone(),
        integrator: numbers.one_of(&["explicit", "explicit", "semi-implicit", "implicit", "implicit"]),
        cells: if is_plane { numbers.count(2, 18) } else { numbers.count(2, 40) },
        points_per_cell: numbers.one_of(&[1, 2, 2, 2, 3, 4]),
        ..Options::default()
    };
    if is_manufactured {
        draw_motion(&mut options, numbers);
    } else if scene == "footing" {
        draw_footing(&mut options, numbers);
    } else {
        draw_column(&mut options, numbers, is_plane);
    }
    options.time_step = options.time_step.map(|(rule, number)| (rule, rounded(number)));
    for factor in &mut options.time_factors {
        *factor = rounded(*factor);
    }
    options
}

/// A chosen motion in the unit square, in a soil near the scene's own.
fn draw_motion(options: &mut Options, numbers: &mut Numbers) {
    options.integrator = numbers.one_of(&["explicit", "implicit"]);
    options.cells = numbers.count(4, 16);
    let frequency = options.set_rounded("manufactured.frequency", numbers.between(0.5, 3.0));
    if options.scene == "manufactured-vortex" {
        options.set_rounded("manufactured.amplitude", numbers.between(-1.5, 1.5));
    } else {
        options.set_rounded("manufactured.amplitude_x", numbers.between(-0.3, 0.3));
        options.set_rounded("manufactured.amplitude_y", numbers.between(-0.3, 0.3));
    }
    options.set_rounded("manufactured.pressure", numbers.between(0.05, 0.4));
    let last = numbers.between(0.1, 1.0);
    options.time_factors = vec![last];
    options.time_step = Some(if options.integrator == "explicit" {
        draw_slopes(options, numbers);
        ("courant", numbers.between(0.1, 0.5))
    } else {
        ("seconds", last * PI / frequency / numbers.count(20, 60) as f64)
    });
}

/// A plate of a few cells on a layer that is at least as large as its mechanism needs.
fn draw_footing(options: &mut Options, numbers: &mut Numbers) {
    options.integrator = "implicit";
    options.cells = numbers.one_of(&[2, 2, 4]);
    let width = options.set_rounded("layer.plate_width", numbers.decades(-1.0, 1.0));
    let cell = width / (options.cells + 1) as f64;
    for (key, least) in [("layer.length", 2.5), ("layer.height", 2.0)] {
        options.set_number(key, cell * (least * width / cell).ceil());
    }
    options.set("layer.plate", numbers.one_of(&["rough", "smooth"]));
    options.set("layer.undrained", numbers.one_of(&["total-stress", "two-phase"]));
    let strength = options.set_rounded("material.undrained_strength", numbers.decades(2.0, 6.0));
    options.set_rounded("material.youngs_modulus", strength * numbers.decades(2.0, 4.0));
    options.set_rounded("material.poissons_ratio", numbers.between(0.2, 0.4999));
    options.time_factors = vec![0.05];
    options.time_step = Some(("growth", numbers.between(0.08, 0.2)));
}

/// Layers of a column, none of them thinner than a tenth of it, which sum to its height.
fn draw_soils(options: &mut Options, numbers: &mut Numbers, soil: &Soil, height: f64) {
    let mut layers = Vec::new();
    let mut above = height;
    for left in (0..numbers.count(1, 2)).rev() {
        let thickness = rounded(above * numbers.between(0.1, 0.9 - 0.2 * left as f64));
        above -= thickness;
        layers.push(thickness);
    }
    layers.push(above);
    let described = layers.iter().map(|thickness| {
        let mut layer = format!("{{thickness={thickness:e}");
        let mut name = |key: &str, value: f64| write!(layer, ",{key}={:e}", rounded(value)).expect("memory");
        if numbers.chance(0.7) {
            name("hydraulic_conductivity", soil.hydraulic_conductivity * numbers.decades(-3.0, 3.0));
        }
        if numbers.chance(0.5) {
            name("youngs_modulus", soil.youngs_modulus * numbers.decades(0.0, 1.5));
        }
        if numbers.chance(0.5) {
            name("porosity", soil.porosity * numbers.between(0.7, 1.2));
        }
        layer + "}"
    });
    let described: Vec<String> = described.collect();
    options.set("column.soils", format!("[{}]", described.join(",")));
}

/// A clay that was loaded before, and its load beyond that: the front of yielding is far from the base at most times.
fn draw_preconsolidation(options: &mut Options, numbers: &mut Numbers, soil: &Soil) {
    let load = options.number("column.load").expect("it was drawn");
    let stiffer = soil.oedometric_modulus() * numbers.decades(0.0, 2.0);
    options.set_rounded("material.reload_modulus", stiffer);
    let initial = options.set_rounded("column.initial_stress", load * numbers.between(0.0, 1.0));
    options.set_rounded("material.preconsolidation", initial + load * numbers.between(0.05, 0.95));
}

/// Slopes of velocities and stresses where points may carry them.
fn draw_slopes(options: &mut Options, numbers: &mut Numbers) {
    let bare = options.method.trim_end_matches("-cells");
    let moves = !bare.starts_with("TL-") && options.value("points.sets").is_none();
    let follows = moves && !bare.starts_with('u') && !matches!(bare, "MPM") && !bare.starts_with('C');
    if moves && numbers.chance(0.3) {
        options.set("integrator.affine", true);
    }
    if follows && numbers.chance(0.3) {
        options.set("integrator.stress_slopes", true);
    }
}

/// A column, a layer or a slab.
fn draw_column(options: &mut Options, numbers: &mut Numbers, is_plane: bool) {
    let (scene, cells) = (options.scene, options.cells);
    let soil = Soil::drawn(numbers);
    soil.set_in(options);
    let table = if scene == "cosine-layer" { "layer" } else { "column" };
    let height = options.set_rounded(&format!("{table}.height"), numbers.decades(-1.5, 1.5));
    if is_plane {
        let across =
            if table == "layer" { numbers.count(cells.div_ceil(2), 2 * cells) } else { numbers.count(1, 3) };
        let extent = height * across as f64 / cells as f64;
        options.set_number(if table == "layer" { "layer.length" } else { "column.width" }, extent);
        if table == "layer" {
            options.set("layer.base", numbers.one_of(&["rough", "smooth"]));
        } else if scene != "mandel" {
            options.set("column.dimensions", 2);
        }
    }
    draw_load(options, numbers, &soil, table);
    draw_points(options, numbers);
    fill_width(options, table, height);
    let is_large = scene == "xie-leo";
    if scene == "layered" || is_large && numbers.chance(0.2) {
        draw_soils(options, numbers, &soil, height);
    }
    if scene == "yield-front" {
        draw_preconsolidation(options, numbers, &soil);
    }
    if is_large && numbers.chance(0.3) {
        options.set("material.law", numbers.one_of(&["porosity-dependent", "engineering", "log-linear"]));
        options.set("material.continuity", numbers.one_of(&["conservative", "constant-porosity-gradient"]));
    }
    if is_large && numbers.chance(0.2) && options.value("points.sets").is_none() {
        options.set("material.conductivity_mean", "chord");
    }
    if matches!(scene, "terzaghi" | "xie-leo" | "dynamic-column") && numbers.chance(0.12) {
        options.set("column.self_weight", true);
    }
    draw_times(options, numbers, &soil, height);
}

/// Makes a plane as wide as so many of its cells, which are larger where the top one is filled in part.
fn fill_width(options: &mut Options, table: &str, height: f64) {
    let key = if table == "layer" { "layer.length" } else { "column.width" };
    if let Some(width) = options.number(key).filter(|_| options.value("points.filling").is_some()) {
        let across = (width * options.cells as f64 / height).round();
        options.set_number(key, across * options.cell_size(height));
    }
}

/// A load far below the stiffness at small strain, and one that leaves pores at large strain.
fn draw_load(options: &mut Options, numbers: &mut Numbers, soil: &Soil, table: &str) {
    let share = if options.scene == "xie-leo" {
        let strain = soil.porosity.min(0.6) * numbers.between(0.02, 0.7);
        -(1.0 - strain).ln()
    } else {
        numbers.decades(-9.0, -4.0)
    };
    options.set_rounded(&format!("{table}.load"), share * soil.oedometric_modulus());
}

/// Points off their lattice, and a second set of them, now and then.
fn draw_points(options: &mut Options, numbers: &mut Numbers) {
    if options.scene == "mandel" {
        return;
    }
    match numbers.count(0, 11) {
        0 => _ = options.set_rounded("points.jitter", numbers.between(0.0, 0.4)),
        1 => _ = options.set_rounded("points.offset", numbers.between(-0.5, 0.5)),
        2 => _ = options.set_rounded("points.filling", numbers.between(0.1, 1.0)),
        3 if options.integrator == "explicit" => {
            options.set("points.sets", 2);
            options.set("points.water_per_cell", numbers.count(1, 4));
        }
        _ => {}
    }
}

/// Steps and the times that they lead to: of explicit steps some hundreds to ten thousands.
fn draw_times(options: &mut Options, numbers: &mut Numbers, soil: &Soil, height: f64) {
    let (scene, cells) = (options.scene, options.cells as f64);
    let has_waves = matches!(scene, "dynamic-column" | "dynamic-single-mode" | "standing-wave");
    let cell = height / cells;
    let one = soil.time(height);
    let wave = soil.explicit_step(cell, false);
    if options.integrator == "explicit" {
        let drag = numbers.one_of(&["explicit", "implicit", "implicit", "centred"]);
        options.set("integrator.drag", drag);
        if numbers.chance(0.25) {
            options.set("integrator.mapping_back", false);
        }
        if numbers.chance(0.25) {
            options.set("integrator.scheme", "leapfrog");
        }
        if numbers.chance(0.1) {
            options.set_rounded("integrator.flip", numbers.between(0.9, 1.0));
        }
        if scene == "xie-leo" {
            draw_slopes(options, numbers);
        }
        let slopes = options.value("integrator.affine").is_some()
            || options.value("integrator.stress_slopes").is_some();
        let share = numbers.between(0.2, 0.95);
        options.time_step = Some(if slopes { ("courant", 0.5 * share) } else { ("stable", share) });
        let steps = numbers.decades(1.5, 4.5);
        let last = steps * share * soil.explicit_step(cell, drag == "explicit") / one;
        options.time_factors = vec![last.min(2.0)];
        return;
    }
    let first = 4.0 / (cells * cells);
    let last = numbers.decades(first.min(0.5).log10(), 0.3);
    options.time_factors = if numbers.chance(0.5) { vec![last] } else { vec![0.3 * last, last] };
    let of_waves = if options.integrator == "implicit" { numbers.one_of(&["u-p", "v-w"]) } else { "v-w" };
    if options.integrator == "semi-implicit" {
        options.time_step = Some(("stable", numbers.between(0.05, 0.9)));
        if numbers.chance(0.3) {
            options.set("integrator.formulation", "u-p");
        }
    } else if has_waves || numbers.chance(0.15) {
        options.set("integrator.formulation", of_waves);
    }
    if has_waves {
        let steps = numbers.count(20, 400) as f64;
        options.time_factors = vec![(steps * wave / one).min(1.0)];
        if options.integrator == "implicit" {
            options.time_step = Some(("seconds", wave * numbers.between(0.3, 2.0)));
        }
    } else if options.integrator == "implicit" {
        options.time_step = match numbers.count(0, 3) {
            0 => None,
            1 => Some(("growth", numbers.between(0.01, 0.1))),
            2 => Some(("tolerance", numbers.decades(-5.0, -3.0))),
            _ => Some(("seconds", last * one / numbers.count(100, 400) as f64)),
        };
    }
}
